//! One seed for the fillings of all bodies.

use toml::{Table, Value as Toml};

/// The key that stands for the seeds of all bodies.
pub const KEY: &str = "seed";

/// What is set in a resolved case so that each body that is filled with glass has a filling of its own by this seed.
///
/// # Errors
/// A message if the seed is no whole number, or no body is filled with glass.
pub fn of_all(case: &Table, seed: &str) -> Result<Vec<String>, String> {
    let seed: u32 = seed
        .parse()
        .map_err(|_| format!("the seed `{seed}` is no whole number"))?;
    let bodies = case.get("body").and_then(Toml::as_array);
    let bodies = bodies.into_iter().flatten().filter_map(Toml::as_table);
    let glass = bodies.enumerate().filter(|(_, body)| is_glass(case, body));
    // Bodies differ in their seeds.
    let settings: Vec<String> = glass
        .map(|(k, _)| {
            let own = u64::from(seed) + 1000 * k as u64;
            format!("body.{k}.lattice={{ kind = \"glass\", seed = {own} }}")
        })
        .collect();
    if settings.is_empty() {
        return Err("no body is filled with glass, which has seeds".to_owned());
    }
    Ok(settings)
}

/// True if a body is filled with glass, or with what bodies are filled with that say nothing.
fn is_glass(case: &Table, body: &Table) -> bool {
    let is_solid = case.get("dimension").and_then(Toml::as_integer) == Some(3);
    match body.get("lattice") {
        None => is_solid && !body.contains_key("particles"),
        Some(Toml::Table(lattice)) => lattice.get("kind").and_then(Toml::as_str) == Some("glass"),
        Some(word) => word.as_str() == Some("glass"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_of_glass_have_seeds_of_their_own() {
        let text = "dimension = 3\n[[body]]\nname = \"a\"\n[[body]]\nlattice = \"cubic\"\n\
                    [[body]]\nlattice = { kind = \"glass\", seed = 4 }";
        let settings = of_all(&text.parse().unwrap(), "7").unwrap();
        assert_eq!(
            settings,
            [
                "body.0.lattice={ kind = \"glass\", seed = 7 }",
                "body.2.lattice={ kind = \"glass\", seed = 2007 }"
            ]
        );
        let flat = text.replace("= 3", "= 2");
        assert_eq!(of_all(&flat.parse().unwrap(), "7").unwrap().len(), 1);
        assert!(
            of_all(&text.parse().unwrap(), "x")
                .unwrap_err()
                .contains("whole number")
        );
        let none = "dimension = 2\n[[body]]\nname = \"a\"";
        assert!(of_all(&none.parse().unwrap(), "1").is_err());
    }
}
