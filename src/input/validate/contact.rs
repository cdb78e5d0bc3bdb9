//! Contact: the default mode and the pairs with a mode of their own.

use toml::Spanned;

use super::check::{Allowed, number};
use crate::input::schema::{
    BodyParams, ContactParams, ModeName, OverlapParams, PairParams, PotentialParams, RangeName,
};
use crate::input::source::Complaint;
use crate::model::{ContactMode, ContactPair, Overlap, Potential, PotentialRange};

/// Largest exponent of the contact potential: beyond it a power of the kernel ratio says no more
/// than that particles are closer than the mean spacing or not.
const LARGEST_EXPONENT: u32 = 100;

/// A choice of mode with the parameters of all modes.
#[derive(Clone, Copy)]
struct Choice {
    mode: ModeName,
    overlap: Overlap,
    potential: Potential,
}

impl Choice {
    fn mode(self) -> ContactMode {
        match self.mode {
            ModeName::None => ContactMode::None,
            ModeName::Kernel => ContactMode::Kernel,
            ModeName::Potential => ContactMode::Potential(self.potential),
            ModeName::Overlap => ContactMode::Overlap(self.overlap),
        }
    }
}

/// The default mode and the pairs; a pair takes what it does not give from the default.
pub fn contacts(
    params: &ContactParams,
    bodies: &[Spanned<BodyParams>],
) -> Result<(ContactMode, Vec<ContactPair>), Complaint> {
    let default = Choice {
        mode: params.mode.unwrap_or(ModeName::Overlap),
        overlap: overlap(&params.overlap, Overlap::default())?,
        potential: potential(&params.potential, Potential::default())?,
    };
    let mut pairs: Vec<ContactPair> = Vec::new();
    let is_rigid = |b: usize| bodies[b].get_ref().rigid == Some(true);
    let rigid = bodies.iter().find(|b| b.get_ref().rigid == Some(true));
    if let (ModeName::Kernel, Some(body)) = (default.mode, rigid) {
        return Err(unjoined(&body.get_ref().name, body.get_ref().name.span()));
    }
    for pair in &params.pair {
        let indices = indices(pair, bodies)?;
        let [a, b] = indices;
        if let (Some(ModeName::Kernel), Some(n)) =
            (pair.mode, [a, b].into_iter().position(is_rigid))
        {
            let at = pair.bodies.get_ref()[n].span();
            return Err(unjoined(&bodies[indices[n]].get_ref().name, at));
        }
        if pairs
            .iter()
            .any(|p| p.bodies == [a, b] || p.bodies == [b, a])
        {
            let title = "this pair of bodies has a contact already";
            return Err(Complaint::new(pair.bodies.span(), title));
        }
        let choice = Choice {
            mode: pair.mode.unwrap_or(default.mode),
            overlap: overlap(&pair.overlap, default.overlap)?,
            potential: potential(&pair.potential, default.potential)?,
        };
        pairs.push(ContactPair {
            bodies: indices,
            mode: choice.mode(),
        });
    }
    Ok((default.mode(), pairs))
}

/// A rigid body has no stress that could join the sums of another.
fn unjoined(body: &Spanned<String>, at: std::ops::Range<usize>) -> Complaint {
    let title = format!(
        "the rigid body `{}` cannot have contact of mode `kernel`",
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

fn overlap(params: &OverlapParams, base: Overlap) -> Result<Overlap, Complaint> {
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

fn potential(params: &PotentialParams, base: Potential) -> Result<Potential, Complaint> {
    let stiffness = params.stiffness.as_ref();
    Ok(Potential {
        stiffness: number(stiffness, "stiffness", base.stiffness, Allowed::Positive)?,
        exponent: exponent(params.exponent.as_ref(), base.exponent)?,
        range: match params.range {
            Some(RangeName::Support) => PotentialRange::Support,
            Some(RangeName::Spacing) => PotentialRange::Spacing,
            None => base.range,
        },
    })
}
