//! Quantities of particles in snapshots.

use super::OutputError;
use model::{Case, SphForm};
use particles::{
    FIELDS, FRAGMENT, FieldInfo, FieldKind, Output, ParticleStore, TEMPERATURE, VON_MISES_STRESS,
};

/// A quantity that a snapshot holds for each particle, beside its position.
#[derive(Debug, Clone, Copy)]
pub enum Quantity {
    /// A field of the table.
    Field(&'static FieldInfo),
    /// `√(3/2 s:s)` of the deviatoric stress s.
    VonMisesStress,
    /// Temperature; NaN for materials without thermal constants.
    Temperature,
    /// Label of the fragment that it belongs to.
    Fragment,
}

impl Quantity {
    /// Its name in the file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Field(field) => field.name,
            Self::VonMisesStress => VON_MISES_STRESS,
            Self::Temperature => TEMPERATURE,
            Self::Fragment => FRAGMENT,
        }
    }

    pub(super) fn unit(self) -> &'static str {
        match self {
            Self::Field(field) => field.unit,
            Self::VonMisesStress => "Pa",
            Self::Temperature => "K",
            Self::Fragment => "",
        }
    }

    pub(super) fn description(self) -> String {
        match self {
            Self::Field(field) => match field.kind {
                FieldKind::Symmetric => {
                    format!("{} Components xx, yy, zz, xy, yz, xz.", field.description)
                }
                _ => field.description.to_owned(),
            },
            Self::VonMisesStress => "Von Mises equivalent stress.".to_owned(),
            Self::Temperature => {
                "Temperature; no number for materials without thermal constants.".to_owned()
            }
            Self::Fragment => {
                "Smallest id of the particles that it hangs together with; -1 of what belongs to \
                 no fragment."
                    .to_owned()
            }
        }
    }
}

/// The quantities of a case that `names` choose: as [`quantities`], but by default none that
/// `particles` have no use for, and the temperature and the fragment where the case tells them. The stress mass, which distinguishes stress points from particles, is
/// always there where a case has such points, and the mass where particles have several sizes.
///
/// # Errors
/// As [`quantities`].
pub fn quantities_of(
    case: &Case,
    names: &[String],
    particles: &ParticleStore,
) -> Result<Vec<Quantity>, OutputError> {
    let by_default = names.is_empty();
    let mut names = names.to_vec();
    if by_default {
        let mut chosen = quantities(&[])?;
        chosen.retain(|choice| match choice {
            Quantity::Field(field) => field.output != Output::IfHeld || particles.holds(field),
            _ => true,
        });
        names.extend(chosen.iter().map(|choice| choice.name().to_owned()));
    }
    if case.fragments.is_some() && by_default {
        names.push(FRAGMENT.to_owned());
    }
    if case.has_temperature() && by_default {
        names.push(TEMPERATURE.to_owned());
    }
    let role = "stress_mass".to_owned();
    if case.sph.form == SphForm::StressPoints && !names.contains(&role) {
        names.push(role);
    }
    let mass = "mass".to_owned();
    let is_uneven = case.bodies.iter().any(|b| b.lattice.sizes.is_some());
    if is_uneven && !names.contains(&mass) {
        names.push(mass);
    }
    quantities(&names)
}

/// The quantities of these names, and always id and body; the field table's defaults for an
/// empty list.
///
/// # Errors
/// [`OutputError::UnknownField`] names all choices.
pub fn quantities(names: &[String]) -> Result<Vec<Quantity>, OutputError> {
    let mut chosen: Vec<Quantity> = Vec::new();
    let mut choices: Vec<Quantity> = FIELDS
        .iter()
        .filter(|field| field.is_shown())
        .map(Quantity::Field)
        .collect();
    choices.extend([
        Quantity::VonMisesStress,
        Quantity::Temperature,
        Quantity::Fragment,
    ]);
    for name in names {
        let known = choices.iter().any(|choice| choice.name() == name);
        if !known && name != "position" {
            let names: Vec<&str> = choices.iter().map(|choice| choice.name()).collect();
            return Err(OutputError::UnknownField {
                name: name.clone(),
                allowed: names.join(", "),
            });
        }
    }
    for choice in choices {
        let by_default = matches!(
            choice,
            Quantity::Field(field) if matches!(field.output, Output::Default | Output::IfHeld)
        );
        let wanted = if names.is_empty() {
            by_default
        } else {
            ["id", "body"].contains(&choice.name()) || names.iter().any(|n| n == choice.name())
        };
        if wanted {
            chosen.push(choice);
        }
    }
    Ok(chosen)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_has_its_temperature_by_default() {
        let cube = |library: &str| {
            format!(
                "dimension = 3\nspacing = \"1 mm\"\nrun.end_time = \"1 us\"\n\
                 material.m.library = \"{library}\"\nmaterial.unused.library = \"aluminium-2024\"\n\
                 [[body]]\nname = \"cube\"\nmaterial = \"m\"\n\
                 shape.box.size = [\"9 mm\", \"9 mm\", \"9 mm\"]\n"
            )
        };
        for (library, expected) in [("aluminium-2024", true), ("copper-taylor-bar", false)] {
            let case = crate::input::parse("cube", &cube(library), &[]).unwrap();
            let store = engine::step::store_of(&case);
            let names = |fields: &[String]| {
                let chosen = quantities_of(&case, fields, &store).unwrap();
                chosen.iter().any(|q| q.name() == TEMPERATURE)
            };
            assert_eq!(names(&[]), expected, "{library}");
            assert!(!names(&["pressure".to_owned()]));
        }
    }

    #[test]
    fn names_choose_quantities_and_id_and_body_come_with_them() {
        let names = |list: &[Quantity]| list.iter().map(|q| q.name()).collect::<Vec<_>>();
        let default = quantities(&[]).unwrap();
        assert!(names(&default).starts_with(&["id", "body", "mass", "velocity"]));
        assert!(names(&default).contains(&"mass"));
        assert!(!names(&default).contains(&"sound_speed"));
        let chosen = ["von_mises_stress", "mass", "position"].map(String::from);
        let chosen = quantities(&chosen).unwrap();
        assert_eq!(names(&chosen), ["id", "body", "mass", "von_mises_stress"]);
        let error = quantities(&["presure".to_owned()]).unwrap_err();
        assert!(
            error
                .to_string()
                .contains("`presure`; choose from id, body")
        );
    }
}
