//! Contact: the default mode and the pairs with a mode of their own.

use toml::Spanned;

use super::check::{Allowed, number};
use crate::input::schema::{
    BodyParams, ContactParams, DirectionName, FrictionParams, ModeName, OverlapParams, PairParams,
    PenaltyLawName, PenaltyParams, PotentialParams, RangeName, SelfContactParams,
};
use crate::input::source::Complaint;
use crate::model::{
    ContactDirection, ContactMode, ContactPair, Overlap, Penalty, PenaltyLaw, Potential,
    PotentialRange, Resistance, SelfContact, SphForm,
};

/// Largest exponent of the contact potential: beyond it a power of the kernel ratio says no more
/// than that particles are closer than the mean spacing or not.
const LARGEST_EXPONENT: u32 = 100;

/// A choice of mode with the parameters of all modes.
#[derive(Clone, Copy)]
struct Choice {
    mode: ModeName,
    overlap: Overlap,
    potential: Potential,
    resistance: Resistance,
    penalty: Penalty,
}

impl Choice {
    fn mode(self) -> ContactMode {
        match self.mode {
            ModeName::None => ContactMode::None,
            ModeName::Kernel => ContactMode::Kernel,
            ModeName::Potential => ContactMode::Potential(self.potential),
            ModeName::Overlap => ContactMode::Overlap(Overlap {
                resistance: self.resistance,
                ..self.overlap
            }),
            ModeName::Penalty => ContactMode::Penalty(Penalty {
                resistance: self.resistance,
                ..self.penalty
            }),
        }
    }
}

/// The default mode, the pairs, and contact of bodies with themselves.
type Contacts = (ContactMode, Vec<ContactPair>, Option<SelfContact>);

/// The default mode and the pairs, and self-contact; a pair takes what it does not give from the default.
pub fn contacts(
    params: &ContactParams,
    bodies: &[Spanned<BodyParams>],
    form: SphForm,
    ratio: f64,
) -> Result<Contacts, Complaint> {
    let default = Choice {
        mode: params.mode.unwrap_or(ModeName::Overlap),
        overlap: overlap(&params.overlap, Overlap::default(), form)?,
        potential: potential(&params.potential, Potential::default(), form)?,
        resistance: resistance(
            params.friction.as_ref(),
            params.damping.as_ref(),
            Resistance::default(),
        )?,
        penalty: penalty(&params.penalty, Penalty::default())?,
    };
    let own = self_contact(params, ratio, default)?;
    let modes = params.pair.iter().map(|pair| pair.mode);
    let used = |mode: Option<ModeName>| {
        let mode = mode.unwrap_or(default.mode);
        matches!(mode, ModeName::Overlap | ModeName::Penalty)
    };
    if own.is_none() && !modes.chain([None]).any(used) {
        refuse_resistance(params.friction.as_ref(), params.damping.as_ref())?;
    }
    let mut pairs: Vec<ContactPair> = Vec::new();
    let is_rigid = |b: usize| bodies[b].get_ref().rigid == Some(true);
    let rigid = bodies.iter().find(|b| b.get_ref().rigid == Some(true));
    if let (ModeName::Kernel | ModeName::Penalty, Some(body)) = (default.mode, rigid) {
        let at = body.get_ref().name.span();
        return Err(unfit(&body.get_ref().name, default.mode, at));
    }
    for pair in &params.pair {
        let indices = indices(pair, bodies)?;
        let [a, b] = indices;
        if let (Some(mode @ (ModeName::Kernel | ModeName::Penalty)), Some(n)) =
            (pair.mode, [a, b].into_iter().position(is_rigid))
        {
            let at = pair.bodies.get_ref()[n].span();
            return Err(unfit(&bodies[indices[n]].get_ref().name, mode, at));
        }
        if pairs
            .iter()
            .any(|p| p.bodies == [a, b] || p.bodies == [b, a])
        {
            let title = "this pair of bodies has a contact already";
            return Err(Complaint::new(pair.bodies.span(), title));
        }
        if !used(pair.mode) {
            refuse_resistance(pair.friction.as_ref(), pair.damping.as_ref())?;
        }
        let choice = Choice {
            mode: pair.mode.unwrap_or(default.mode),
            resistance: resistance(
                pair.friction.as_ref(),
                pair.damping.as_ref(),
                default.resistance,
            )?,
            overlap: overlap(&pair.overlap, default.overlap, form)?,
            potential: potential(&pair.potential, default.potential, form)?,
            penalty: penalty(&pair.penalty, default.penalty)?,
        };
        pairs.push(ContactPair {
            bodies: indices,
            mode: choice.mode(),
        });
    }
    Ok((default.mode(), pairs, own))
}

/// Contact of bodies with themselves.
fn self_contact(
    params: &ContactParams,
    ratio: f64,
    default: Choice,
) -> Result<Option<SelfContact>, Complaint> {
    let Some(given) = &params.self_contact else {
        return Ok(None);
    };
    let folds = match given.get_ref() {
        SelfContactParams::Is(false) => return Ok(None),
        SelfContactParams::Is(true) => None,
        SelfContactParams::With(table) => table.folds.as_ref(),
    };
    let modes = params.pair.iter().map(|pair| pair.mode);
    if modes
        .chain([Some(default.mode)])
        .any(|mode| mode == Some(ModeName::Kernel))
    {
        let title = "self-contact knows no bodies that are joined by `kernel` contact";
        return Err(Complaint::new(given.span(), title)
            .help("take another mode for all pairs, or leave `self_contact` out"));
    }
    // No pair that begins within the support may be a fold.
    let least = 2.0 * ratio;
    let folds = match folds {
        None => None,
        Some(folds) => {
            let spacings = number(Some(folds), "folds", 0.0, Allowed::Positive)?;
            if spacings < least {
                let title = format!("`folds` must be at least {least:.2} spacings, the support");
                return Err(Complaint::new(folds.span(), title).label("out of range"));
            }
            Some(spacings)
        }
    };
    Ok(Some(SelfContact {
        overlap: Overlap {
            resistance: default.resistance,
            ..default.overlap
        },
        folds,
    }))
}

/// A rigid body has no stress that could join the sums of another, and no sums that could tell its
/// boundary.
fn unfit(body: &Spanned<String>, mode: ModeName, at: std::ops::Range<usize>) -> Complaint {
    let mode = match mode {
        ModeName::Kernel => "kernel",
        _ => "penalty",
    };
    let title = format!(
        "the rigid body `{}` cannot have contact of mode `{mode}`",
        body.get_ref()
    );
    Complaint::new(at, title).help("take \"overlap\" or \"potential\" for its pairs")
}

fn indices(pair: &PairParams, bodies: &[Spanned<BodyParams>]) -> Result<[usize; 2], Complaint> {
    let names = || bodies.iter().map(|b| b.get_ref().name.get_ref().as_str());
    let index = |name: &Spanned<String>| {
        names()
            .position(|known| known == name.get_ref())
            .ok_or_else(|| Complaint::unknown(name.span(), "body", name.get_ref(), names()))
    };
    match pair.bodies.get_ref().as_slice() {
        [a, b] if a != b => Ok([index(a)?, index(b)?]),
        _ => Err(Complaint::new(
            pair.bodies.span(),
            "`bodies` must name two different bodies",
        )),
    }
}

fn overlap(params: &OverlapParams, base: Overlap, form: SphForm) -> Result<Overlap, Complaint> {
    let [stiffness, core_stiffness, core_radius] = [
        params.stiffness.as_ref(),
        params.core_stiffness.as_ref(),
        params.core_radius.as_ref(),
    ];
    let or_zero = Allowed::NotNegative;
    let range = Allowed::Within(0.0, 1.0);
    Ok(Overlap {
        stiffness: number(stiffness, "stiffness", base.stiffness, Allowed::Positive)?,
        core_stiffness: number(
            core_stiffness,
            "core_stiffness",
            base.core_stiffness,
            or_zero,
        )?,
        core_radius: number(core_radius, "core_radius", base.core_radius, range)?,
        direction: direction(params.direction.as_ref(), base.direction, form)?,
        resistance: base.resistance,
    })
}

/// Two modes know friction and damping.
fn refuse_resistance(
    friction: Option<&Spanned<FrictionParams>>,
    damping: Option<&Spanned<f64>>,
) -> Result<(), Complaint> {
    let at = [
        friction.map(|key| ("friction", key.span())),
        damping.map(|key| ("damping", key.span())),
    ];
    match at.into_iter().flatten().next() {
        None => Ok(()),
        Some((key, at)) => {
            let title =
                format!("`{key}` acts in no contact but that of the modes `overlap` and `penalty`");
            Err(Complaint::new(at, title).help("set `mode = \"overlap\"`, or leave it out"))
        }
    }
}

/// Friction and damping; what is not given is that of `base`.
pub(super) fn resistance(
    friction: Option<&Spanned<FrictionParams>>,
    damping: Option<&Spanned<f64>>,
    base: Resistance,
) -> Result<Resistance, Complaint> {
    let of = |value: &Spanned<f64>, key: &str| {
        number(Some(value), key, 0.0, Allowed::NotNegative).map(Some)
    };
    let [sticking, sliding] = match friction.map(|f| (f.get_ref(), f.span())) {
        None => [None, None],
        Some((&FrictionParams::One(value), at)) => [of(&Spanned::new(at, value), "friction")?; 2],
        Some((FrictionParams::Two(table), _)) => {
            let [sticking, sliding] = [
                of(&table.r#static, "static")?,
                of(&table.kinetic, "kinetic")?,
            ];
            if sliding > sticking {
                let title = "`kinetic` must be at most `static`";
                return Err(Complaint::new(table.kinetic.span(), title).label("out of range"));
            }
            [sticking, sliding]
        }
    };
    Ok(Resistance {
        static_friction: sticking.unwrap_or(base.static_friction),
        kinetic_friction: sliding.unwrap_or(base.kinetic_friction),
        damping: number(damping, "damping", base.damping, Allowed::Within(0.0, 1.0))?,
    })
}

/// The exponent of the contact potential.
fn exponent(value: Option<&Spanned<i64>>, base: u32) -> Result<u32, Complaint> {
    let Some(value) = value else {
        return Ok(base);
    };
    let exponent = u32::try_from(*value.get_ref()).ok();
    let allowed = exponent.filter(|n| (1..=LARGEST_EXPONENT).contains(n));
    allowed.ok_or_else(|| {
        let title = format!("`exponent` must be between 1 and {LARGEST_EXPONENT}");
        Complaint::new(value.span(), title).label("out of range")
    })
}

fn potential(
    params: &PotentialParams,
    base: Potential,
    form: SphForm,
) -> Result<Potential, Complaint> {
    let stiffness = params.stiffness.as_ref();
    let potential = Potential {
        stiffness: number(stiffness, "stiffness", base.stiffness, Allowed::Positive)?,
        exponent: exponent(params.exponent.as_ref(), base.exponent)?,
        range: match params.range.as_ref().map(Spanned::get_ref) {
            Some(RangeName::Support) => PotentialRange::Support,
            Some(RangeName::Spacing) => PotentialRange::Spacing,
            None => base.range,
        },
        direction: direction(params.direction.as_ref(), base.direction, form)?,
    };
    check_range(params, &potential)?;
    Ok(potential)
}

/// The force that sets in at the spacing is that of the exponent less that of an exponent of one.
fn check_range(params: &PotentialParams, potential: &Potential) -> Result<(), Complaint> {
    if potential.range == PotentialRange::Support || potential.exponent > 1 {
        return Ok(());
    }
    let spans = [
        params.exponent.as_ref().map(Spanned::span),
        params.range.as_ref().map(Spanned::span),
    ];
    // One of the two is new: the combination was refused where it was inherited from.
    let at = spans.into_iter().flatten().next().unwrap_or_default();
    let title = "a potential of `range = \"spacing\"` needs an `exponent` of 2 or more";
    let help = "with 1 its force would begin with a jump: take \"support\", or a larger exponent";
    Err(Complaint::new(at, title).help(help))
}

fn penalty(params: &PenaltyParams, base: Penalty) -> Result<Penalty, Complaint> {
    let stiffness = params.stiffness.as_ref();
    Ok(Penalty {
        stiffness: number(stiffness, "stiffness", base.stiffness, Allowed::Positive)?,
        law: match params.law {
            Some(PenaltyLawName::Hertz) => PenaltyLaw::Hertz,
            Some(PenaltyLawName::Pinball) => PenaltyLaw::Pinball,
            None => base.law,
        },
        resistance: base.resistance,
    })
}

/// Normals are those of corrected gradients.
fn direction(
    name: Option<&Spanned<DirectionName>>,
    base: ContactDirection,
    form: SphForm,
) -> Result<ContactDirection, Complaint> {
    let Some(name) = name else {
        return Ok(base);
    };
    match (name.get_ref(), form) {
        (DirectionName::Pair, _) => Ok(ContactDirection::Pair),
        (DirectionName::Normal, SphForm::Normalised) => Ok(ContactDirection::Normal),
        (
            DirectionName::Normal,
            SphForm::Conventional | SphForm::Corrected | SphForm::StressPoints,
        ) => {
            let title = "contact along normals needs the corrected gradients of normalised SPH";
            let help = "set `form = \"normalised\"` in [sph], or take \"pair\"";
            Err(Complaint::new(name.span(), title).help(help))
        }
    }
}
