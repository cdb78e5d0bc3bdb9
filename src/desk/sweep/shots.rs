//! The runs of a sweep as shots at a shield: how large, how fast, and whether it failed.

use std::fs;
use std::path::Path;

use super::SweepError;
use super::answers;
use super::condition::Condition;
use super::definition::Definition;
use files::input;
use files::output::{OutputError, Phase, RunFolder};
use model::{Body, Shape};

/// The condition if neither the sweep nor the caller gives one.
const FAILED: &str = "failed";

/// A run as a shot.
#[derive(Debug, Clone, PartialEq)]
pub struct Shot {
    /// Folder of the run, without those that it lies in.
    pub run: String,
    /// Diameter of the projectile (m).
    pub diameter: f64,
    /// Its speed (m/s).
    pub speed: f64,
    /// `true` if the condition holds after the run.
    pub failed: bool,
}

/// All finished runs of a sweep's folder, in the order of their speeds and diameters. The projectile is
/// the body of that name, or the only ball that flies; failure is the condition that is given, or the one
/// that the sweep bisects, or any plate's.
///
/// # Errors
/// [`SweepError`] if the folder is that of no sweep, a run has no such projectile, or its tables do not
/// answer the question.
pub fn shots(
    folder: &Path,
    projectile: Option<&str>,
    condition: Option<&str>,
) -> Result<Vec<Shot>, SweepError> {
    if !Definition::is_in(folder) {
        let folder = folder.display();
        return Err(SweepError::Typed(format!("{folder} has no sweep")));
    }
    let definition = Definition::read(folder)?;
    let text = condition.or(definition.bisect.as_deref());
    let condition = Condition::parse(text.unwrap_or(FAILED)).map_err(SweepError::Typed)?;
    let points = folder.join("points");
    let mut shots = Vec::new();
    for entry in fs::read_dir(&points).map_err(OutputError::io("read", &points))? {
        let path = entry.map_err(OutputError::io("read", &points))?.path();
        let run = RunFolder::at(&path);
        if path.is_dir() && matches!(run.status(), Ok(status) if status.state == Phase::Finished) {
            shots.push(shot(&run, projectile, &condition)?);
        }
    }
    shots.sort_by(|a, b| {
        let by_speed = a.speed.total_cmp(&b.speed);
        by_speed.then(a.diameter.total_cmp(&b.diameter))
    });
    Ok(shots)
}

fn shot(
    run: &RunFolder,
    projectile: Option<&str>,
    condition: &Condition,
) -> Result<Shot, SweepError> {
    let case = input::load(&run.case(), &[])?;
    let name = run.path().file_name().unwrap_or_default().to_string_lossy();
    let wrong = |why: String| SweepError::Typed(format!("{name}: {why}"));
    let (body, radius) = ball(&case.bodies, projectile).map_err(wrong)?;
    let answers = answers::of_run(run)?;
    Ok(Shot {
        run: name.to_string(),
        diameter: 2.0 * radius,
        speed: body.velocity.norm(),
        failed: condition.holds(&answers).map_err(wrong)?,
    })
}

/// The projectile and its radius (m).
fn ball<'a>(bodies: &'a [Body], name: Option<&str>) -> Result<(&'a Body, f64), String> {
    let balls = bodies.iter().filter_map(|body| match body.shape {
        Shape::Sphere { radius, .. } => Some((body, radius)),
        _ => None,
    });
    let wanted = |body: &Body| match name {
        Some(name) => body.name == name,
        None => body.velocity.norm() > 0.0,
    };
    let projectiles: Vec<_> = balls.filter(|(body, _)| wanted(body)).collect();
    match (&projectiles[..], name) {
        ([one], _) => Ok(*one),
        (_, Some(name)) => Err(format!("the case has no ball `{name}`")),
        ([], None) => Err("the case has no ball that flies".to_owned()),
        (_, None) => Err("several balls fly: name one with `--projectile`".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_projectile_is_the_only_ball_that_flies() {
        let text = |more: &str| {
            format!(
                "dimension = 3\nspacing = \"1 mm\"\nrun.end_time = \"1 us\"\n\
                 [material.copper]\nlibrary = \"copper\"\n\
                 [contact]\nmode = \"overlap\"\n\
                 [[body]]\nname = \"still\"\nmaterial = \"copper\"\n\
                 shape.sphere = {{ centre = [0, 0, 0], radius = \"3 mm\" }}\n\
                 [[body]]\nname = \"ball\"\nmaterial = \"copper\"\n\
                 shape.sphere = {{ centre = [0, 0, \"20 mm\"], radius = \"2 mm\" }}\n{more}"
            )
        };
        let case = |more: &str| input::parse("case", &text(more), &[]).unwrap();
        let flying = case("velocity = [0, \"-3 km/s\", \"-4 km/s\"]\n");
        let (body, radius) = ball(&flying.bodies, None).unwrap();
        assert_eq!((body.name.as_str(), radius), ("ball", 2e-3));
        assert!((body.velocity.norm() - 5e3).abs() < 1e-9);
        assert_eq!(ball(&flying.bodies, Some("still")).unwrap().1, 3e-3);
        assert!(ball(&flying.bodies, Some("wall")).is_err());
        assert!(ball(&case("").bodies, None).unwrap_err().contains("flies"));
    }
}
