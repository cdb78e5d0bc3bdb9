//! Contact: the default mode and the pairs with a mode of their own.

use std::ops::Range;

use toml::Spanned;

use crate::input::schema::contact::Choice;
use crate::input::schema::{
    BodyParams, ContactParams, FrictionParams, PairParams, SelfContactParams,
};
use crate::input::source::Diagnostic;
use model::{ContactMode, ContactPair, SelfContact, SphForm};

/// The default mode, the pairs, and contact of bodies with themselves.
type Contacts = (ContactMode, Vec<ContactPair>, Option<SelfContact>);

/// The default mode and the pairs, and self-contact, which what `tears` has without being asked
/// for; a pair takes what it does not give from the default.
pub fn contacts(
    params: &ContactParams,
    bodies: &[Spanned<BodyParams>],
    form: SphForm,
    ratio: f64,
    tears: bool,
) -> Result<Contacts, Diagnostic> {
    let default = params.choice(&Choice::default(), form)?;
    let tears = tears && form != SphForm::StressPoints;
    let own = self_contact(params, ratio, &default, tears)?;
    let modes = params.pair.iter().map(|pair| pair.mode);
    let mut modes = modes.chain([None]).map(|mode| default.of(mode));
    if own.is_none() && !modes.any(|mode| mode.resistance().is_some()) {
        refuse_resistance(params.friction.as_ref(), params.damping.as_ref())?;
    }
    let rigid = bodies.iter().find(|b| b.get_ref().rigid == Some(true));
    if let Some(body) = rigid {
        let name = &body.get_ref().name;
        check_fit(&default.mode(), name, name.span())?;
    }
    let mut pairs: Vec<ContactPair> = Vec::new();
    for given in &params.pair {
        let pair = pair(given, bodies, &default, form, &pairs)?;
        pairs.push(pair);
    }
    Ok((default.mode(), pairs, own))
}

/// A pair of its own, beside those `before`.
fn pair(
    params: &PairParams,
    bodies: &[Spanned<BodyParams>],
    default: &Choice,
    form: SphForm,
    before: &[ContactPair],
) -> Result<ContactPair, Diagnostic> {
    let [a, b] = indices(params, bodies)?;
    let mode = default.of(params.mode);
    for (body, named) in [a, b].into_iter().zip(params.bodies.get_ref()) {
        let body = bodies[body].get_ref();
        if body.rigid == Some(true) {
            check_fit(&mode, &body.name, named.span())?;
        }
    }
    if before
        .iter()
        .any(|p| p.bodies == [a, b] || p.bodies == [b, a])
    {
        let title = "this pair of bodies has a contact already";
        return Err(Diagnostic::new(params.bodies.span(), title));
    }
    if mode.resistance().is_none() {
        refuse_resistance(params.friction.as_ref(), params.damping.as_ref())?;
    }
    let mode = params.choice(default, form)?.mode();
    let joint = params.joint.as_ref();
    if let Some(joint) = joint.filter(|_| mode.class().is_none()) {
        let title = format!(
            "a joint needs contact with forces, and `{}` has none",
            mode.name()
        );
        return Err(Diagnostic::new(joint.span(), title)
            .help("set `mode = \"overlap\"`; bodies of mode \"kernel\" are one piece"));
    }
    Ok(ContactPair {
        bodies: [a, b],
        mode,
        joint: joint.map(|joint| joint.get_ref().joint()).transpose()?,
    })
}

/// Contact of bodies with themselves.
fn self_contact(
    params: &ContactParams,
    ratio: f64,
    default: &Choice,
    tears: bool,
) -> Result<Option<SelfContact>, Diagnostic> {
    let modes = params.pair.iter().map(|pair| pair.mode);
    let mut modes = modes.chain([None]).map(|mode| default.of(mode));
    let joined = modes.any(|mode| mode == ContactMode::Kernel);
    let overlap = default.laws.overlap;
    let Some(given) = &params.self_contact else {
        let is_default = tears && !joined && matches!(default.mode(), ContactMode::Overlap(_));
        return Ok(is_default.then_some(SelfContact {
            overlap,
            folds: None,
        }));
    };
    let folds = match given.get_ref() {
        SelfContactParams::Is(false) => return Ok(None),
        SelfContactParams::Is(true) => None,
        SelfContactParams::With(table) => table.folds.as_ref().zip(table.folds()?),
    };
    if joined {
        let title = "self-contact knows no bodies that are joined by `kernel` contact";
        return Err(Diagnostic::new(given.span(), title)
            .help("take another mode for all pairs, or leave `self_contact` out"));
    }
    // No pair that begins within the support may be a fold.
    let least = 2.0 * ratio;
    let folds = match folds {
        None => None,
        Some((folds, spacings)) => {
            if spacings < least {
                let title = format!("`folds` must be at least {least:.2} spacings, the support");
                return Err(Diagnostic::new(folds.span(), title).label("out of range"));
            }
            Some(spacings)
        }
    };
    Ok(Some(SelfContact { overlap, folds }))
}

/// A rigid body has no stress that could join the sums of another, and no sums that could tell its
/// boundary.
fn check_fit(
    mode: &ContactMode,
    body: &Spanned<String>,
    at: Range<usize>,
) -> Result<(), Diagnostic> {
    if !mode.needs_sums() {
        return Ok(());
    }
    let title = format!(
        "the rigid body `{}` cannot have contact of mode `{}`",
        body.get_ref(),
        mode.name()
    );
    let others = without_sums();
    Err(Diagnostic::new(at, title).help(format!("take {others} for its pairs")))
}

/// The modes with forces that do without sums over the particles of a body, in quotes.
pub(super) fn without_sums() -> String {
    let modes = ContactMode::with_forces();
    let fit = modes.iter().filter(|mode| !mode.needs_sums());
    let names: Vec<String> = fit.map(|mode| format!("\"{}\"", mode.name())).collect();
    names.join(" or ")
}

fn indices(pair: &PairParams, bodies: &[Spanned<BodyParams>]) -> Result<[usize; 2], Diagnostic> {
    let names = || bodies.iter().map(|b| b.get_ref().name.get_ref().as_str());
    let index = |name: &Spanned<String>| {
        names()
            .position(|known| known == name.get_ref())
            .ok_or_else(|| Diagnostic::unknown(name.span(), "body", name.get_ref(), names()))
    };
    match pair.bodies.get_ref().as_slice() {
        [a, b] if a != b => Ok([index(a)?, index(b)?]),
        _ => Err(Diagnostic::new(
            pair.bodies.span(),
            "`bodies` must name two different bodies",
        )),
    }
}

/// Not all modes know friction and damping.
fn refuse_resistance(
    friction: Option<&Spanned<FrictionParams>>,
    damping: Option<&Spanned<f64>>,
) -> Result<(), Diagnostic> {
    let at = [
        friction.map(|key| ("friction", key.span())),
        damping.map(|key| ("damping", key.span())),
    ];
    match at.into_iter().flatten().next() {
        None => Ok(()),
        Some((key, at)) => {
            let modes = ContactMode::with_forces();
            let modes = modes.iter().filter(|mode| mode.resistance().is_some());
            let names: Vec<String> = modes.map(|mode| format!("`{}`", mode.name())).collect();
            let names = names.join(" and ");
            let title = format!("`{key}` acts in no contact but that of the modes {names}");
            Err(Diagnostic::new(at, title).help("set `mode = \"overlap\"`, or leave it out"))
        }
    }
}
