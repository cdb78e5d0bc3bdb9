//! `stated` in place of values: what the library states for a constant of the material that the case names.

use desk::sweep::{Definition, SweepError};
use material::{Material, Value, library};

use crate::materials::written;

/// The word in place of values.
const WORD: &str = "stated";

/// The texts of `--scatter` with the least number, the library's own and the largest in place of the word.
///
/// # Errors
/// [`SweepError::Typed`] where the key belongs to no material of the library or no range is stated, and those of the case.
pub(super) fn with_values(definition: &Definition) -> Result<Vec<String>, SweepError> {
    let key_of = |text: &str| {
        let (key, values) = text.split_once('=')?;
        (values.trim() == WORD).then(|| key.trim().to_owned())
    };
    if !definition.scatter.iter().any(|text| key_of(text).is_some()) {
        return Ok(definition.scatter.clone());
    }
    let case = definition.resolved()?;
    let texts = definition.scatter.iter().map(|text| {
        let Some(key) = key_of(text) else {
            return Ok(text.clone());
        };
        let library_key = |name: &str| format!("material.{name}.library");
        let varies = |name: &str| {
            let begin = library_key(name);
            let mut all = definition.vary.iter().chain(&definition.scatter);
            all.any(|text| text.split('=').next().map(str::trim) == Some(&begin))
        };
        let values = match part(&key) {
            Some((name, _)) if varies(name) => Err(format!("`{}` varies", library_key(name))),
            Some((name, constant)) => match taken(&case, name) {
                Some(of) => values(of, constant),
                None => Err(format!("the case has no `{}`", library_key(name))),
            },
            None => Err(
                "it is no constant of a material, as in material.NAME.failure.spall.pressure"
                    .to_owned(),
            ),
        };
        let values = values.map_err(|why| SweepError::Typed(format!("`{key}={WORD}`: {why}")))?;
        Ok(format!("{key}={}", values.join(", ")))
    });
    texts.collect()
}

/// The name and the constant of a key `material.NAME.CONSTANT`.
fn part(key: &str) -> Option<(&str, &str)> {
    key.strip_prefix("material.")?.split_once('.')
}

/// The name in the library of a material of a resolved case.
fn taken<'a>(case: &'a toml::Table, name: &str) -> Option<&'a str> {
    case.get("material")?.get(name)?.get("library")?.as_str()
}

/// The least, the own and the largest number of a constant, as a case takes them.
fn values(of: &str, key: &str) -> Result<Vec<String>, String> {
    let number = |material: &Material| {
        let constants = material.constants();
        let own = constants.iter().find(|constant| constant.key == key);
        own.map(|constant| constant.value)
    };
    let own = library::find(of).as_ref().and_then(number);
    let (Some([least, largest]), Some(Value::Number(own, unit))) = (library::range(of, key), own)
    else {
        let mut known: Vec<&str> = library::names();
        known.retain(|name| library::range(name, key).is_some());
        let known = match &known[..] {
            [] => String::new(),
            names => format!("; it does for {}", names.join(", ")),
        };
        return Err(format!(
            "the library states no range of `{key}` for {of}{known}"
        ));
    };
    let mut all = vec![least, own, largest];
    all.dedup();
    let texts = all
        .into_iter()
        .map(|number| written(Value::Number(number, unit)));
    Ok(texts
        .map(|text| text.trim_matches('"').to_owned())
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_stand_about_the_own_number() {
        let found = values("aluminium-2024-ductile", "failure.spall.pressure").unwrap();
        assert_eq!(found, ["-1.7 GPa", "-1.4 GPa", "-1.1 GPa"]);
        let why = values("aluminium-2024", "failure.spall.pressure").unwrap_err();
        assert!(
            why.contains("for aluminium-2024; it does for aluminium-2024-ductile, "),
            "{why}"
        );
        let why = values("copper-ductile", "density").unwrap_err();
        assert_eq!(
            why,
            "the library states no range of `density` for copper-ductile"
        );
    }

    #[test]
    fn keys_have_a_name_and_a_constant() {
        let key = "material.wall.failure.spall.pressure";
        assert_eq!(part(key), Some(("wall", "failure.spall.pressure")));
        assert_eq!(part("spacing"), None);
        let case = "[material.wall]\nlibrary = \"copper\"".parse().unwrap();
        assert_eq!(taken(&case, "wall"), Some("copper"));
        assert_eq!(taken(&case, "sphere"), None);
    }
}
