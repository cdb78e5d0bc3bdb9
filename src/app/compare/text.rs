//! Differences of cases and of a run's own state, by key.

use serde_json::Value;

use model::differences::{Difference, differences};

/// Tables of a case that do not touch results.
const FREE: [&str; 5] = ["output", "fragments", "run", "domain", "measure"];

/// Differences of two resolved cases, but for output, measures, run control and distribution.
pub fn cases(a: &str, b: &str) -> Vec<String> {
    let parse = |text: &str| -> Result<Value, String> {
        let mut table: toml::Table = text.parse().map_err(|e: toml::de::Error| e.to_string())?;
        for name in FREE {
            table.remove(name);
        }
        serde_json::to_value(table).map_err(|e| e.to_string())
    };
    lines(&parse(a), &parse(b), a == b)
}

/// Differences of two texts of JSON.
pub fn states(a: &str, b: &str) -> Vec<String> {
    let parse = |text: &str| serde_json::from_str(text).map_err(|e| e.to_string());
    lines(&parse(a), &parse(b), a == b)
}

fn lines(a: &Result<Value, String>, b: &Result<Value, String>, same: bool) -> Vec<String> {
    match (a, b) {
        (Ok(a), Ok(b)) => {
            let show = |value: &Option<Value>| {
                (value.as_ref()).map_or_else(|| "nothing".to_owned(), Value::to_string)
            };
            let line = |difference: Difference| {
                format!(
                    "{}: {} against {}",
                    difference.path,
                    show(&difference.a),
                    show(&difference.b)
                )
            };
            differences(a, b).into_iter().map(line).collect()
        }
        _ if same => Vec::new(),
        (Err(error), _) | (_, Err(error)) => vec![format!("the texts differ ({error})")],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_differ_by_what_touches_results_only() {
        let a = "title = 'a'\n[run]\nend_time = '1 us'\n[[body]]\nname = 'x'\n";
        let b = a.replace("1 us", "2 us") + "size = 2\n[domain]\naxis = 'x'\n";
        assert_eq!(cases(a, &b), ["body[0].size: nothing against 2"]);
        assert!(cases(a, a).is_empty());
        assert_eq!(cases("no case", a).len(), 1);
    }

    #[test]
    fn states_differ_by_bits() {
        assert_eq!(
            states(r#"{"t": -0.0}"#, r#"{"t": 0.0}"#),
            ["t: -0.0 against 0.0"]
        );
        assert!(states(r#"{"t": 1.0, "n": 2}"#, r#"{"n":2,"t":1.0}"#).is_empty());
    }
}
