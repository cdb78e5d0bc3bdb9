//! Materials that treat matter alike as long as nothing has damaged it.
//!
//! A law of failure whose damage grows with plastic flow or crushed pores (`failure.johnson_cook` and others) uses its constants
//! in no step that leaves damage at zero. A limit of tension at which matter fails at once uses its own when matter reaches it, and
//! damages that matter in the same step, also where matter softens: a larger limit has had no effect either. What matter
//! loses by damage, and how cracks take energy, comes later still.

use super::declare::Value;
use super::{Constant, Failure, Material};

/// Laws whose numbers matter in steps alone that add damage.
const BY_FLOW: [&str; 7] = [
    "failure.collins.",
    "failure.holmquist_johnson_cook.",
    "failure.ivanov.",
    "failure.johnson_cook.",
    "failure.johnson_holmquist_2.",
    "failure.plastic_strain.",
    "failure.riedel_hiermaier_thoma.",
];

impl Material {
    /// The first key at which a material differs from this one so that matter may feel it before this one has damaged any;
    /// none if all matter that is undamaged with this material has had the same bits with the other.
    #[must_use]
    pub fn differs_undamaged(&self, other: &Self) -> Option<String> {
        let same_law = Self {
            failure: other.failure,
            ..self.clone()
        };
        if same_law != *other {
            return Some(self.name.clone());
        }
        // A law that follows the temperature lets what melts fail.
        if self.failure.needs_temperature() != other.failure.needs_temperature() {
            return Some("failure".to_owned());
        }
        let (own, others) = (self.constants(), other.constants());
        // Flaws are drawn before there is any load, and cracks along directions are no damage of this kind.
        let Failure {
            grady_kipp,
            hashin,
            uncoupled,
            ..
        } = &self.failure;
        let others_act = grady_kipp.is_some() || hashin.is_some() || uncoupled.is_some();
        // What recompacts has been damaged and tells nothing of it.
        let forgets = own.iter().any(|constant| {
            constant.key == "failure.spall.after" && constant.value != Value::Word("failed")
        });
        let value = |list: &[Constant], key: &str| {
            let found = list.iter().find(|constant| constant.key == key);
            found.map(|constant| constant.value)
        };
        let more = others
            .iter()
            .filter(|other| value(&own, &other.key).is_none());
        let mut keys = own.iter().chain(more).map(|constant| &constant.key);
        let felt = keys.find(|key| {
            let [now, then] = [&own, &others].map(|list| value(list, key));
            now != then && (forgets || others_act || is_felt(key, now, then))
        });
        felt.cloned()
    }
}

/// True if matter may feel another value of a constant before the present one has damaged it.
fn is_felt(key: &str, now: Option<Value>, then: Option<Value>) -> bool {
    if key == "failure.seed" {
        // That of no text is one.
        return false;
    }
    let (Some(Value::Number(from, _)), Some(Value::Number(to, _))) = (now, then) else {
        return true;
    };
    match key {
        // Tension is negative here.
        "failure.spall.pressure" => to > from,
        "failure.principal_stress.limit" => to < from,
        "failure.fracture_energy" | "failure.scatter" => false,
        _ => !BY_FLOW.iter().any(|law| key.starts_with(law)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FailureOptions;
    use crate::library::find;

    /// That of the library, which fails at once here.
    fn aluminium() -> Material {
        let mut own = find("aluminium-2024-ductile").unwrap();
        own.failure.options = FailureOptions::DEFAULT;
        own
    }

    fn ductile(change: impl FnOnce(&mut Material)) -> Option<String> {
        let own = aluminium();
        let mut other = own.clone();
        change(&mut other);
        own.differs_undamaged(&other)
    }

    #[test]
    fn constants_of_failure_are_felt_by_what_is_damaged() {
        assert_eq!(ductile(|_| ()), None);
        let johnson_cook =
            |other: &mut Material| other.failure.johnson_cook.as_mut().unwrap().d1 += 0.1;
        assert_eq!(ductile(johnson_cook), None);
        assert_eq!(ductile(|other| other.failure.options.seed += 1), None);
        // A weaker limit may have been reached.
        for (factor, felt) in [
            (1.1, None),
            (0.9, Some("failure.spall.pressure".to_owned())),
        ] {
            let spall =
                |other: &mut Material| other.failure.spall.as_mut().unwrap().pressure *= factor;
            assert_eq!(ductile(spall), felt);
        }
    }

    #[test]
    fn other_matter_and_other_laws_are_felt_at_once() {
        assert!(ductile(|other| other.reference_density += 1.0).is_some());
        assert!(ductile(|other| other.failure.options.fracture_energy = 1.0).is_some());
        let melts = |other: &mut Material| other.failure.johnson_cook.as_mut().unwrap().d5 = 0.5;
        let own = {
            let mut own = aluminium();
            own.failure.johnson_cook.as_mut().unwrap().d5 = 0.0;
            own
        };
        let mut other = own.clone();
        melts(&mut other);
        assert!(own.differs_undamaged(&other).is_some());
        let mut soft = own.clone();
        soft.failure.options.fracture_energy = 1e4;
        let mut stronger = soft.clone();
        stronger.failure.options.fracture_energy = 2e4;
        assert_eq!(soft.differs_undamaged(&stronger), None);
        stronger.failure.spall.as_mut().unwrap().pressure *= 1.1;
        assert_eq!(soft.differs_undamaged(&stronger), None);
        assert!(ductile(|other| other.failure.johnson_cook = None).is_some());
        assert!(ductile(|other| other.failure.spall = None).is_some());
    }
}
