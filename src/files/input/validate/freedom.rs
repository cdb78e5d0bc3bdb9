//! The freedom of rigid bodies that forces move.

use toml::Spanned;

use super::shapes::vector;
use crate::input::schema::{AngularVelocityParams, BodyParams};
use crate::input::source::Diagnostic;
use model::{Axis, Freedom, Vec3};

/// The freedom that the text leaves a body with a velocity (m/s) and a spin (rad/s), in a case of so many symmetry planes.
pub fn freedom(
    params: &BodyParams,
    [velocity, spin]: [Vec3; 2],
    (dimension, planes): (usize, usize),
) -> Result<Freedom, Diagnostic> {
    let keys = [
        ("moves", params.moves.as_ref().map(Spanned::span)),
        ("turns", params.turns.as_ref().map(Spanned::span)),
        ("pivot", params.pivot.as_ref().map(Spanned::span)),
    ];
    let given = keys
        .iter()
        .find_map(|(key, span)| Some((key, span.clone()?)));
    if let Some((key, span)) = given.filter(|_| !params.is_free()) {
        let title = format!("only a free rigid body has `{key}`");
        return Err(Diagnostic::new(span, title));
    }
    let axes = |names: &[Spanned<Axis>]| {
        [Axis::X, Axis::Y, Axis::Z].map(|axis| names.iter().any(|name| *name.get_ref() == axis))
    };
    let mut free = Freedom::default();
    if let Some(names) = &params.moves {
        free.moves = axes(names.get_ref());
        let held = (0..dimension).find(|&a| velocity[a] != 0.0 && !free.moves[a]);
        if let Some(a) = held {
            let title = format!(
                "the body has a velocity along {}, and does not move along it",
                Axis::ALL[a].name()
            );
            return Err(Diagnostic::new(names.span(), title));
        }
    }
    if let Some(names) = &params.turns {
        free.turns = axes(names.get_ref());
        if free.turns.iter().filter(|turns| **turns).count() == 2 {
            let title = "a body turns about all axes, one or none";
            return Err(Diagnostic::new(names.span(), title));
        }
        let held = (0..3).find(|&a| spin[a] != 0.0 && !free.turns[a]);
        if let Some(a) = held {
            let title = format!(
                "the body has an angular velocity about {}, and does not turn about it",
                Axis::ALL[a].name()
            );
            return Err(Diagnostic::new(names.span(), title));
        }
    }
    if let Some(given) = &params.pivot {
        let refuse = |title: &str, span| Err(Diagnostic::new(span, title));
        if dimension == 1 {
            return refuse(
                "in one dimension nothing turns about a `pivot`",
                given.span(),
            );
        }
        if planes + 1 >= dimension {
            let title = "a body with a `pivot` would turn through the symmetry planes of the case";
            return refuse(title, given.span());
        }
        let speed = params.speed.as_ref().map(Spanned::span);
        let moves = params.moves.as_ref().map(Spanned::span);
        let velocity = params.velocity.as_ref().map(Spanned::span);
        if let Some(span) = velocity.or(speed).or(moves) {
            return refuse("a body with a `pivot` turns, and does nothing else", span);
        }
        if let Some(turn) = &params.angular_velocity
            && matches!(turn.get_ref(), AngularVelocityParams::About(_))
        {
            return refuse("a body with a `pivot` turns about that", turn.span());
        }
        free.pivot = Some(vector("pivot", Some(given), dimension)?.into());
    }
    Ok(free)
}
