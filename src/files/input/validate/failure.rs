//! Laws of failure: those of the table, and those of the library that it does not name.

use toml::Spanned;

use super::laws::law;
use crate::input::forms::OrNone;
use crate::input::schema::{FailureParams, failure_laws};
use crate::input::source::Diagnostic;
use material::{AfterSpall, Coupling, Effect, Eos, Failure, FailureOptions, Law, Molten, Strength};

macro_rules! failure {
    ($(
        $(#[$doc:meta])+ $law:ident: $table:ident => $made:ident { $(
            $(#[$key_doc:meta])+ $key:ident: $typed:ty
                $(= $value:expr)? $(, $allowed:ident)? $(=> $words:literal)?;
        )+ }
    )+) => {
        /// Laws of the table, with values of the library's where the table has none.
        fn laws(params: &FailureParams, base: &Failure) -> Result<Failure, Diagnostic> {
            Ok(Failure {
                $( $law: match &params.$law {
                    None => base.$law,
                    Some(table) => match table.get_ref() {
                        OrNone::None => None,
                        OrNone::Table(params) => {
                            let (at, base) = (table.span(), base.$law);
                            Some(law!(params, base, |_: &str| None::<f64>, at, $made { $($key [$($value)?])+ }))
                        }
                    },
                }, )+
                options: base.options,
            })
        }
    };
}
failure_laws!(failure);

/// Failure of a material of an equation of state and a strength: as the table says, and as that of the library's
/// material where it says nothing. A liquid of which neither says anything cavitates.
pub fn failure(
    table: Option<&Spanned<OrNone<FailureParams>>>,
    base: Option<&Failure>,
    (eos, strength): (&Eos, &Strength),
    dimension: usize,
) -> Result<Failure, Diagnostic> {
    let without = if is_liquid(eos, strength) {
        Failure::CAVITATES
    } else {
        Failure::NONE
    };
    let base = base
        .copied()
        .filter(|base| !base.is_none())
        .unwrap_or(without);
    let mut failure = match table.map(Spanned::get_ref) {
        None => base,
        Some(OrNone::None) => Failure::NONE,
        Some(OrNone::Table(params)) => laws(params, &base)?,
    };
    if !failure.is_none() || matches!(eos, Eos::Jwl(_)) {
        failure.options.dimension = u8::try_from(dimension).unwrap_or(3);
    }
    if let Some(table) = table
        && let OrNone::Table(params) = table.get_ref()
    {
        failure.options = options(params, &failure, strength)?;
        check(table, params, &failure, strength)?;
    }
    let stated = table.is_some_and(|table| match table.get_ref() {
        OrNone::Table(params) => params.effect.is_some(),
        OrNone::None => false,
    });
    if !stated && !failure.is_none() {
        failure.options.effect = natural_effect(&failure, strength);
    }
    Ok(failure)
}

/// What damage takes of a strength where nothing is said of it: friction stays where there is any.
fn natural_effect(failure: &Failure, strength: &Strength) -> Effect {
    let fades = failure.options.softens() || failure.grady_kipp.is_some();
    match failure.options.effect {
        _ if strength.keeps_friction() => Effect::FrictionKept,
        Effect::FrictionKept if fades => Effect::Scaled,
        Effect::FrictionKept => Effect::default(),
        other => other,
    }
}

/// True for what has no stiffness in shear and is held together by the cold part of its pressure.
fn is_liquid(eos: &Eos, strength: &Strength) -> bool {
    strength.shear_modulus() == 0.0
        && (matches!(eos, Eos::Tait(_)) || matches!(strength, Strength::Viscous(_)))
        && eos
            .modulus_over_pressure()
            .is_none_or(|[_, offset]| offset > 0.0)
}

/// Common options of the laws.
fn options(
    params: &FailureParams,
    failure: &Failure,
    strength: &Strength,
) -> Result<FailureOptions, Diagnostic> {
    let base = failure.options;
    let mut options = FailureOptions {
        fracture_energy: params.fracture_energy()?.unwrap_or(base.fracture_energy),
        scatter: params.scatter()?.unwrap_or(base.scatter),
        seed: params
            .seed
            .as_ref()
            .map_or(base.seed, |seed| *seed.get_ref()),
        molten: params
            .molten
            .as_ref()
            .map(|word| *word.get_ref())
            .or(base.molten),
        ..base
    };
    // What fades says so by itself.
    let coupled = (failure.johnson_cook).is_some_and(|law| law.coupling != Coupling::Uncoupled);
    let fades = options.softens() || coupled || failure.grady_kipp.is_some();
    let friction = strength.keeps_friction();
    let fading = if friction {
        Effect::FrictionKept
    } else {
        Effect::Scaled
    };
    options.effect = match &params.effect {
        Some(effect) if *effect.get_ref() == Effect::FrictionKept && !friction => {
            let title = "this strength has no friction that failed matter could keep";
            let help = "strengths that grow with pressure have, as `drucker_prager` and `collins`";
            return Err(Diagnostic::new(effect.span(), title).help(help));
        }
        Some(effect) if *effect.get_ref() == Effect::Scaled && friction => {
            let title = "damage takes its share of this strength by the strength's own rule";
            let help = "leave `effect` out, or say \"friction_kept\"";
            return Err(Diagnostic::new(effect.span(), title).help(help));
        }
        Some(effect) if fades && *effect.get_ref() != fading => {
            let title = "where cracks grow or matter softens, stress fades with damage";
            let help = format!("leave `effect` out, or say \"{}\"", fading.name());
            return Err(Diagnostic::new(effect.span(), title).help(help));
        }
        Some(effect) => *effect.get_ref(),
        None if fades => fading,
        // Without its energy what softens in the library fails at once.
        None if base.softens() => Effect::default(),
        None => base.effect,
    };
    Ok(options)
}

/// Refuses what does not go together.
fn check(
    table: &Spanned<OrNone<FailureParams>>,
    params: &FailureParams,
    failure: &Failure,
    strength: &Strength,
) -> Result<(), Diagnostic> {
    let options = &failure.options;
    if failure.is_none() {
        let given = [
            params.effect.as_ref().map(Spanned::span),
            params.fracture_energy.as_ref().map(Spanned::span),
            params.scatter.as_ref().map(Spanned::span),
            params.seed.as_ref().map(Spanned::span),
            params.molten.as_ref().map(Spanned::span),
        ];
        if let Some(at) = given.into_iter().flatten().next() {
            return Err(Diagnostic::new(
                at,
                "no law of failure that this could be said of",
            ));
        }
    }
    let at = params
        .fracture_energy
        .as_ref()
        .map_or_else(|| table.span(), Spanned::span);
    if let Some(word) = &params.molten
        && *word.get_ref() == Molten::Fails
        && !failure.has_memory()
    {
        let title = "matter that holds at its largest tension never fails, molten or not";
        return Err(Diagnostic::new(word.span(), title));
    }
    let localised = (failure.johnson_cook).is_some_and(|law| law.coupling == Coupling::Localised);
    if localised && !options.softens() {
        return Err(Diagnostic::new(
            table.span(),
            "what softens where it localises takes a `fracture_energy`",
        ));
    }
    if options.softens() {
        if failure.grady_kipp.is_some() {
            let title =
                "cracks of `grady_kipp` take no `fracture_energy`: how they grow is their law";
            return Err(Diagnostic::new(at, title));
        }
        if failure
            .spall
            .is_some_and(|s| s.after != AfterSpall::Failed || s.pressure == 0.0)
        {
            let title =
                "matter softens from a `spall.pressure` below zero on, and has `failed` then";
            return Err(Diagnostic::new(at, title));
        }
    }
    if options.scatter > 0.0 && !has_failure_strain(failure) {
        let at = (params.scatter.as_ref()).map_or_else(|| table.span(), Spanned::span);
        let title = "no failure strain that could scatter";
        let help = "a law that counts plastic strain has one, as `johnson_cook` and `ivanov`";
        return Err(Diagnostic::new(at, title).help(help));
    }
    let strengths = against_strength(failure, strength);
    strengths.map_or(Ok(()), |title| Err(Diagnostic::new(table.span(), title)))
}

/// True if a law has a failure strain.
fn has_failure_strain(failure: &Failure) -> bool {
    failure.johnson_cook.is_some()
        || failure.plastic_strain.is_some()
        || failure.ivanov.is_some()
        || failure.collins.is_some()
        || failure.johnson_holmquist_2.is_some()
        || failure.holmquist_johnson_cook.is_some()
        || failure.riedel_hiermaier_thoma.is_some()
}

/// True if there is another law than that of members, or options of another.
fn tears_otherwise(failure: &Failure) -> bool {
    let others = Failure {
        uncoupled: None,
        ..*failure
    };
    let options = &failure.options;
    !others.is_none() || options.softens() || options.effect != Effect::StrengthLost
}

/// Why a strength cannot fail that way.
fn against_strength(failure: &Failure, strength: &Strength) -> Option<&'static str> {
    let unscaled = matches!(strength, Strength::NeoHookean(_) | Strength::Viscous(_));
    let strains = has_failure_strain(failure);
    if failure.grady_kipp.is_some() && strength.shear_modulus() == 0.0 {
        Some("cracks grow in solids, and this material has no shear modulus")
    } else if failure.options.effect == Effect::Scaled && unscaled {
        Some(
            "stress that fades with damage needs a strength that is elastic, or elastic and plastic",
        )
    } else if failure.johnson_holmquist_2.is_some()
        && !matches!(strength, Strength::JohnsonHolmquist2(_))
    {
        Some("`johnson_holmquist_2` damages the strength of that name alone")
    } else if failure.holmquist_johnson_cook.is_some()
        && !matches!(strength, Strength::HolmquistJohnsonCook(_))
    {
        Some("`holmquist_johnson_cook` damages the strength of that name alone")
    } else if failure.riedel_hiermaier_thoma.is_some()
        && !matches!(strength, Strength::RiedelHiermaierThoma(_))
    {
        Some("`riedel_hiermaier_thoma` damages the strength of that name alone")
    } else if failure.hashin.is_some() && !matches!(strength, Strength::Orthotropic(_)) {
        Some("`hashin` cracks matter of the strength `orthotropic` alone")
    } else if failure.uncoupled.is_some() && !matches!(strength, Strength::Uncoupled(_)) {
        Some("`uncoupled` tears matter of the strength of that name alone")
    } else if matches!(strength, Strength::Uncoupled(_)) && tears_otherwise(failure) {
        Some("matter of the strength `uncoupled` tears by the failure of that name alone")
    } else if matches!(strength, Strength::Orthotropic(_)) && failure.spall.is_some() {
        Some("`spall` knows no directions: the strengths of `hashin` tell the largest tension")
    } else if matches!(strength, Strength::Orthotropic(_))
        && failure.options.effect != Effect::StrengthLost
    {
        Some(
            "matter with directions of its own loses strength at once, or by the cracks of `hashin`",
        )
    } else if strains && !strength.yields() {
        Some("a failure strain is a plastic one, and this material does not yield")
    } else {
        None
    }
}
