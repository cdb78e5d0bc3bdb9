//! Ranges that sources state for numbers of the library.

/// Name, key, and the least and the largest number (SI) that the source of this number states.
pub(super) const RANGES: &[(&str, &str, [f64; 2])] = &[
    ("aluminium-2024-ductile", SPALL, [-1.7e9, -1.1e9]),
    ("aluminium-6061-ductile", SPALL, [-1.6e9, -1.0e9]),
    ("copper-ductile", SPALL, [-2.0e9, -1.2e9]),
    ("steel-4340-ductile", SPALL, [-5.0e9, -2.6e9]),
];

/// Tension is negative: the largest strength is the least pressure.
const SPALL: &str = "failure.spall.pressure";

#[cfg(test)]
mod tests {
    use super::RANGES;
    use crate::{Value, library};

    /// Each range encloses the number of the library, and its source states both ends.
    #[test]
    fn sources_state_the_ranges() {
        for &(name, key, [least, largest]) in RANGES {
            let material = library::find(name).unwrap();
            let constants = material.constants();
            let constant = constants.iter().find(|constant| constant.key == key);
            let Some(Value::Number(number, "Pa")) = constant.map(|constant| constant.value) else {
                panic!("{name}: no pressure at {key}");
            };
            assert!(least < number && number < largest, "{name}");
            let stated = format!("{:.1}-{:.1}", -largest / 1e9, -least / 1e9);
            let source = library::source(name, key).unwrap();
            assert!(source.contains(&stated), "{name}: {stated} in {source}");
            assert_eq!(library::range(name, key), Some([least, largest]));
        }
        assert_eq!(library::range("copper-ductile", "density"), None);
        assert_eq!(library::range("copper", "failure.spall.pressure"), None);
    }
}
