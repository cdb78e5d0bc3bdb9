//! All spacings of a case, made finer or coarser together.

use toml::{Table, Value as Toml};

use model::units;

/// Growth of a graded spacing if the case says nothing: each layer so many times as thick as the one before it.
const RATIO: f64 = 1.1;

/// What is set in a resolved case beside `spacing` (m), so that every body with a spacing of its own changes as the
/// case does. With `s` of the case and `k = spacing/s` they are k times as large; a graded one grows by
/// `1 + k (ratio − 1)` from layer to layer, so that it is k times as large at each place.
///
/// # Errors
/// A message on a case without a spacing, and on particles of a file, which stay as they are.
pub fn scaled(case: &Table, spacing: f64) -> Result<Vec<String>, String> {
    let bodies = case.get("body").and_then(Toml::as_array);
    let bodies: Vec<&Table> = bodies
        .into_iter()
        .flatten()
        .filter_map(Toml::as_table)
        .collect();
    let finest = bodies.iter().filter_map(|body| {
        let own = body.get("spacing")?;
        length(own.get("inner").unwrap_or(own))
    });
    let of_case = case.get("spacing").and_then(length);
    let of_case = of_case.or_else(|| finest.reduce(f64::min));
    let Some(of_case) = of_case else {
        return Err("the case has no `spacing`".to_owned());
    };
    let by = spacing / of_case;
    let mut settings = Vec::new();
    for (k, body) in bodies.iter().enumerate() {
        if body.contains_key("particles") {
            let name = body.get("name").and_then(Toml::as_str).unwrap_or_default();
            return Err(format!(
                "the body `{name}` has the particles of a file, which would stay as they are"
            ));
        }
        let mut set = |key: &str, value: &Toml| {
            if let Some(length) = length(value) {
                settings.push(format!("body.{k}.spacing{key}={:?} m", length * by));
            }
        };
        match body.get("spacing") {
            Some(Toml::Table(graded)) => {
                for key in ["inner", "outer"] {
                    if let Some(value) = graded.get(key) {
                        set(&format!(".{key}"), value);
                    }
                }
                let ratio = graded.get("ratio").and_then(|ratio| match ratio {
                    Toml::Float(ratio) => Some(*ratio),
                    _ => None,
                });
                let ratio = 1.0 + by * (ratio.unwrap_or(RATIO) - 1.0);
                settings.push(format!("body.{k}.spacing.ratio={ratio:?}"));
            }
            Some(even) => set("", even),
            None => {}
        }
    }
    Ok(settings)
}

/// A length (m) as a resolved case has it.
fn length(value: &Toml) -> Option<f64> {
    Some(units::parse(value.as_str()?).ok()?.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<Vec<String>, String> {
        scaled(&text.parse().unwrap(), 2e-4)
    }

    #[test]
    fn bodies_change_as_the_case_does() {
        let text = r#"
            spacing = "0.4 mm"
            [[body]]
            name = "plain"
            [[body]]
            name = "even"
            spacing = "0.8 mm"
            [[body]]
            name = "graded"
            spacing = { inner = "0.4 mm", outer = "2 mm", at = [0, 0, 0] }
            [[body]]
            name = "steep"
            spacing = { inner = "0.4 mm", outer = "2 mm", ratio = 1.5, face = "+z" }
        "#;
        let settings = [
            "body.1.spacing=0.0004 m",
            "body.2.spacing.inner=0.0002 m",
            "body.2.spacing.outer=0.001 m",
            "body.2.spacing.ratio=1.05",
            "body.3.spacing.inner=0.0002 m",
            "body.3.spacing.outer=0.001 m",
            "body.3.spacing.ratio=1.25",
        ];
        assert_eq!(of(text).unwrap(), settings);
        // Without one of the case the finest body gives the scale.
        let text = "[[body]]\nspacing = \"0.8 mm\"\n[[body]]\nspacing.inner = \"0.4 mm\"";
        assert_eq!(of(text).unwrap()[0], "body.0.spacing=0.0004 m");
    }

    #[test]
    fn what_cannot_change_is_refused() {
        assert!(
            of("[[body]]\nname = \"a\"")
                .unwrap_err()
                .contains("no `spacing`")
        );
        let text = "spacing = \"1 mm\"\n[[body]]\nname = \"a\"\nparticles.file = \"a.k\"";
        assert!(of(text).unwrap_err().contains("`a` has the particles"));
    }
}
