//! The equations as functions of the speed: columns of a table, curves of a chart.

use desk::ballistic::crater::{self, Failure, Wall};
use desk::ballistic::{Limit, Regime, Shield, Shot, hole, sizing};
use model::readable::shown;

/// A limit equation of a shield.
pub(super) type Equation = fn(&Shield, &Shot) -> Limit;

/// The values of an equation at a speed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    /// Lengths (m), one for each name.
    pub(super) values: Vec<f64>,
    /// A remark on this speed.
    pub(super) remark: &'static str,
}

/// An equation with all but the speed.
pub(super) struct Law {
    /// The subject.
    pub(super) title: String,
    /// The shield or projectile that it is asked of.
    pub(super) subtitle: String,
    /// Its publication.
    pub(super) source: &'static str,
    /// The data that it was fitted to.
    pub(super) holds: &'static str,
    /// The name of its values.
    pub(super) what: &'static str,
    /// The name of each value.
    pub(super) names: Vec<&'static str>,
    /// The value that separates failure from survival, if any.
    pub(super) limit: Option<usize>,
    /// Its values at a speed (m/s).
    pub(super) at: Box<dyn Fn(f64) -> Row>,
}

/// A limit equation of a shield.
pub(super) fn limit(
    name: &str,
    source: &'static str,
    holds: &'static str,
    shield: Shield,
    shot: Shot,
    equation: Equation,
) -> Law {
    let mut subtitle = format!(
        "bumper {}, wall {}, gap {}, yield {}",
        shown(shield.bumper, "m"),
        shown(shield.wall, "m"),
        shown(shield.gap, "m"),
        shown(shield.yield_strength, "Pa"),
    );
    if shield.stuffing > 0.0 {
        subtitle += ", stuffing ";
        subtitle += &shown(shield.stuffing, "kg/m^2");
    }
    let at = move |speed: f64| {
        let Limit { diameter, regime } = equation(&shield, &shot.at(speed));
        Row {
            values: vec![diameter],
            remark: Regime::word(regime),
        }
    };
    Law {
        title: format!("{name}{}", angle(&shot)),
        subtitle,
        source,
        holds,
        what: "critical diameter",
        names: vec!["critical diameter"],
        limit: Some(0),
        at: Box::new(at),
    }
}

/// Bumper and wall that stop a sphere.
pub(super) fn sizing(task: sizing::Task, shot: Shot) -> Law {
    let at = move |speed: f64| {
        let shot = shot.at(speed);
        let sized = sizing::sized(&task, &shot);
        let slow = speed * libm::cos(shot.angle) < sizing::SLOWEST;
        Row {
            values: vec![sized.bumper, sized.wall],
            remark: if slow { "too slow to hold" } else { "" },
        }
    };
    Law {
        title: format!(
            "Shield against a sphere of {}{}",
            shown(task.diameter, "m"),
            angle(&shot)
        ),
        subtitle: format!(
            "gap {}, yield {}",
            shown(task.gap, "m"),
            shown(task.yield_strength, "Pa")
        ),
        source: "Christiansen 1993, NASA/TM-2009-214785 chapter 4",
        holds: sizing::HOLDS,
        what: "thickness",
        names: vec!["bumper", "wall"],
        limit: None,
        at: Box::new(at),
    }
}

/// Failures of a single wall, the least first.
const FAILURES: [Failure; 3] = [
    Failure::AttachedSpall,
    Failure::DetachedSpall,
    Failure::Perforation,
];

/// The spheres that a wall of a thickness (m) stops.
pub(super) fn single_wall(wall: Wall, thickness: f64, shot: Shot) -> Law {
    let at = move |speed: f64| {
        let of = |failure| crater::critical_diameter(&wall, thickness, failure, &shot.at(speed));
        Row {
            values: FAILURES.map(of).to_vec(),
            remark: "",
        }
    };
    Law {
        title: format!("Single wall of {}{}", shown(thickness, "m"), angle(&shot)),
        what: "critical diameter",
        names: vec!["no spall", "no detached spall", "no perforation"],
        // Designers count spall that comes off as failure.
        limit: Some(1),
        at: Box::new(at),
        ..of_crater(&wall)
    }
}

/// The walls that stop a sphere of a diameter (m).
pub(super) fn crater(wall: Wall, diameter: f64, shot: Shot) -> Law {
    let at = move |speed: f64| {
        let depth = crater::depth(&wall, diameter, &shot.at(speed));
        let walls = FAILURES.map(|failure| failure.depths() * depth);
        Row {
            values: [vec![depth], walls.to_vec()].concat(),
            remark: "",
        }
    };
    Law {
        title: format!(
            "Crater of a sphere of {}{}",
            shown(diameter, "m"),
            angle(&shot)
        ),
        what: "depth or thickness",
        names: vec![
            "depth of the crater",
            "no spall",
            "no detached spall",
            "no perforation",
        ],
        limit: None,
        at: Box::new(at),
        ..of_crater(&wall)
    }
}

fn of_crater(wall: &Wall) -> Law {
    Law {
        title: String::new(),
        subtitle: format!(
            "Brinell hardness {}, sound {}, density {}",
            wall.hardness,
            shown(wall.sound_speed, "m/s"),
            shown(wall.density, "kg/m^3")
        ),
        source: "Cour-Palais, NASA/TM-2009-214785 eq. 4-1",
        holds: crater::HOLDS,
        what: "",
        names: Vec::new(),
        limit: None,
        at: Box::new(|_| Row {
            values: Vec::new(),
            remark: "",
        }),
    }
}

/// Holes in a thin plate.
pub(super) fn hole(pair: hole::Pair, shot: Shot) -> Law {
    let at = move |speed: f64| Row {
        values: hole::all(&pair, &shot.at(speed)).to_vec(),
        remark: "",
    };
    Law {
        title: format!(
            "Hole of a sphere of {} in a plate of {}{}",
            shown(pair.diameter, "m"),
            shown(pair.thickness, "m"),
            angle(&shot)
        ),
        subtitle: format!("sound in the plate {}", shown(pair.sound_speed, "m/s")),
        source: "Maiden & McMillan 1964, Sawle 1969, Hill 2004",
        holds: hole::HOLDS,
        what: "diameter of the hole",
        names: vec!["Maiden & McMillan", "Sawle", "Hill", "mean"],
        limit: None,
        at: Box::new(at),
    }
}

/// ` at 45 deg`, or nothing.
fn angle(shot: &Shot) -> String {
    let degrees = shot.angle.to_degrees();
    if degrees == 0.0 {
        return String::new();
    }
    format!(" at {} deg", model::readable::short(degrees))
}
