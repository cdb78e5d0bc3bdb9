//! The arguments of `whipple limit`, quantities with units.

use super::laws::{self, Law};
use super::{Beside, Output};
use desk::ballistic::{
    Shield, Shot, crater, hole, modified_nno, nno, sizing, stuffed, thin_bumper,
};
use plot::parse_quantity;

/// The equations.
#[expect(clippy::doc_markdown, reason = "the comments are the help")]
#[derive(Debug, Clone, clap::Subcommand)]
pub(super) enum Equation {
    /// Christiansen's new non-optimum equation of the Whipple shield (1993)
    Nno(Whipple),
    /// The modified new non-optimum equation (Christiansen & Kerr 2001)
    #[command(name = "modified-nno")]
    ModifiedNno(Whipple),
    /// The new non-optimum equation reduced for bumpers that are too thin (Reimerdes 2006, NASA JSC)
    ThinBumper(Whipple),
    /// The stuffed Whipple shield (Christiansen & Kerr 2001)
    Stuffed(Stuffed),
    /// Christiansen's sizing: the bumper and the wall that stop a sphere from 7 km/s on
    Sizing(Sizing),
    /// Cour-Palais' crater in a single wall: spall that stays on, comes off, and holes
    Crater(Crater),
    /// Diameter of the hole in a thin plate: Maiden & McMillan, Sawle, Hill, and their mean
    Hole(Hole),
}

/// The projectile.
#[derive(Debug, Clone, clap::Args)]
pub(super) struct Projectile {
    /// Density of the projectile
    #[arg(long, value_name = "DENSITY", default_value = "2800 kg/m^3", value_parser = density)]
    projectile_density: f64,

    /// Angle from the normal, as in 45deg
    #[arg(long, value_name = "ANGLE", default_value = "0", value_parser = angle)]
    angle: f64,
}

/// A shield of two walls.
#[derive(Debug, Clone, clap::Args)]
pub(super) struct Whipple {
    /// Thickness of the bumper, as in 1.2mm
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    bumper: f64,

    /// Thickness of the wall
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    wall: f64,

    /// Distance from the bumper to the wall
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    gap: f64,

    /// Yield strength of the wall, as in 40ksi or 276MPa
    #[arg(long = "yield", value_name = "STRESS", value_parser = stress)]
    yield_strength: f64,

    /// Density of the bumper
    #[arg(long, value_name = "DENSITY", default_value = "2700 kg/m^3", value_parser = density)]
    bumper_density: f64,

    /// Density of the wall
    #[arg(long, value_name = "DENSITY", default_value = "2700 kg/m^3", value_parser = density)]
    wall_density: f64,

    #[command(flatten)]
    projectile: Projectile,

    #[command(flatten)]
    beside: Beside,

    #[command(flatten)]
    output: Output,
}

/// The same with something between them.
#[derive(Debug, Clone, clap::Args)]
pub(super) struct Stuffed {
    #[command(flatten)]
    whipple: Whipple,

    /// Areal mass of the stuffing, as in "8 kg/m^2"
    #[arg(long, value_name = "AREAL_MASS", value_parser = areal_mass)]
    stuffing: f64,
}

/// A shield to be sized.
#[derive(Debug, Clone, clap::Args)]
pub(super) struct Sizing {
    /// Diameter of the sphere
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    diameter: f64,

    /// Distance from the bumper to the wall
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    gap: f64,

    /// Yield strength of the wall
    #[arg(long = "yield", value_name = "STRESS", value_parser = stress)]
    yield_strength: f64,

    /// Density of the bumper
    #[arg(long, value_name = "DENSITY", default_value = "2700 kg/m^3", value_parser = density)]
    bumper_density: f64,

    #[command(flatten)]
    projectile: Projectile,

    #[command(flatten)]
    output: Output,
}

/// A single wall.
#[derive(Debug, Clone, clap::Args)]
#[group(id = "what", required = true, multiple = false, args = ["wall", "diameter"])]
pub(super) struct Crater {
    /// Thickness of the wall, for the spheres that it stops
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    wall: Option<f64>,

    /// Diameter of the sphere, for the walls that stop it
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    diameter: Option<f64>,

    /// Brinell hardness of the wall: 95 of 6061-T6
    #[arg(long, value_name = "NUMBER", value_parser = number)]
    brinell: f64,

    /// Speed of sound in the wall: 5.1km/s in aluminium
    #[arg(long, value_name = "SPEED", value_parser = speed)]
    sound_speed: f64,

    /// Density of the wall
    #[arg(long, value_name = "DENSITY", default_value = "2700 kg/m^3", value_parser = density)]
    wall_density: f64,

    #[command(flatten)]
    projectile: Projectile,

    #[command(flatten)]
    beside: Beside,

    #[command(flatten)]
    output: Output,
}

/// A thin plate.
#[derive(Debug, Clone, clap::Args)]
pub(super) struct Hole {
    /// Diameter of the sphere
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    diameter: f64,

    /// Thickness of the plate
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    bumper: f64,

    /// Speed of sound in the plate
    #[arg(long, value_name = "SPEED", value_parser = speed)]
    sound_speed: f64,

    /// Speed of sound in the sphere [default: that in the plate]
    #[arg(long, value_name = "SPEED", value_parser = speed)]
    projectile_sound_speed: Option<f64>,

    /// Density of the plate
    #[arg(long, value_name = "DENSITY", default_value = "2700 kg/m^3", value_parser = density)]
    bumper_density: f64,

    #[command(flatten)]
    projectile: Projectile,

    #[command(flatten)]
    output: Output,
}

impl Projectile {
    /// The shot, still without its speed.
    fn shot(&self) -> Shot {
        Shot {
            speed: 0.0,
            angle: self.angle,
            density: self.projectile_density,
        }
    }
}

impl Whipple {
    fn shield(&self, stuffing: f64) -> Shield {
        Shield {
            bumper: self.bumper,
            wall: self.wall,
            gap: self.gap,
            yield_strength: self.yield_strength,
            bumper_density: self.bumper_density,
            wall_density: self.wall_density,
            stuffing,
        }
    }
}

impl Equation {
    /// The equation as a function of the speed, the destination of its answer, and a sweep to
    /// compare it with.
    pub(super) fn law(&self) -> Result<(Law, &Output, Option<&Beside>), String> {
        Ok(match self {
            Self::Nno(args) | Self::ModifiedNno(args) | Self::ThinBumper(args) => {
                (self.limit(args, 0.0), &args.output, Some(&args.beside))
            }
            Self::Stuffed(Stuffed { whipple, stuffing }) => (
                self.limit(whipple, *stuffing),
                &whipple.output,
                Some(&whipple.beside),
            ),
            Self::Sizing(args) => (args.law(), &args.output, None),
            Self::Crater(args) => {
                if args.wall.is_none() && args.beside.sweep.is_some() {
                    return Err("`--sweep` needs a limit: give `--wall`".to_owned());
                }
                (args.law(), &args.output, Some(&args.beside))
            }
            Self::Hole(args) => (args.law(), &args.output, None),
        })
    }

    /// The limit equation of a shield.
    fn limit(&self, args: &Whipple, stuffing: f64) -> Law {
        let (name, source, holds, equation): (_, _, _, laws::Equation) = match self {
            Self::ModifiedNno(_) => (
                "Modified new non-optimum equation",
                "Christiansen & Kerr 2001",
                modified_nno::HOLDS,
                modified_nno::critical_diameter,
            ),
            Self::ThinBumper(_) => (
                "New non-optimum equation with a thin bumper",
                "Reimerdes et al. 2006, Ryan & Christiansen 2011",
                thin_bumper::HOLDS,
                thin_bumper::critical_diameter,
            ),
            Self::Stuffed(_) => (
                "Stuffed Whipple shield",
                "Christiansen & Kerr 2001, NASA/TM-2009-214785 chapter 4",
                stuffed::HOLDS,
                stuffed::critical_diameter,
            ),
            _ => (
                "New non-optimum equation",
                "Christiansen 1993, NASA/TM-2009-214785 eqs. 4-23 to 4-26",
                nno::HOLDS,
                nno::critical_diameter,
            ),
        };
        let (shield, shot) = (args.shield(stuffing), args.projectile.shot());
        laws::limit(name, source, holds, shield, shot, equation)
    }
}

impl Sizing {
    fn law(&self) -> Law {
        let task = sizing::Task {
            diameter: self.diameter,
            gap: self.gap,
            yield_strength: self.yield_strength,
            bumper_density: self.bumper_density,
        };
        laws::sizing(task, self.projectile.shot())
    }
}

impl Crater {
    fn law(&self) -> Law {
        let wall = crater::Wall {
            density: self.wall_density,
            hardness: self.brinell,
            sound_speed: self.sound_speed,
        };
        let shot = self.projectile.shot();
        match (self.wall, self.diameter) {
            (Some(thickness), _) => laws::single_wall(wall, thickness, shot),
            (None, diameter) => laws::crater(wall, diameter.unwrap_or_default(), shot),
        }
    }
}

impl Hole {
    fn law(&self) -> Law {
        let pair = hole::Pair {
            diameter: self.diameter,
            thickness: self.bumper,
            density: self.bumper_density,
            sound_speed: self.sound_speed,
            projectile_sound_speed: self.projectile_sound_speed.unwrap_or(self.sound_speed),
        };
        laws::hole(pair, self.projectile.shot())
    }
}

/// Reads a positive quantity.
fn positive(text: &str, unit: &str) -> Result<f64, String> {
    let value = parse_quantity(text, unit).map_err(|error| error.to_string())?;
    if value > 0.0 {
        Ok(value)
    } else {
        Err("it must be positive".to_owned())
    }
}

fn length(text: &str) -> Result<f64, String> {
    positive(text, "m")
}

fn stress(text: &str) -> Result<f64, String> {
    positive(text, "Pa")
}

fn density(text: &str) -> Result<f64, String> {
    positive(text, "kg/m^3")
}

fn areal_mass(text: &str) -> Result<f64, String> {
    positive(text, "kg/m^2")
}

pub(super) fn speed(text: &str) -> Result<f64, String> {
    positive(text, "m/s")
}

fn number(text: &str) -> Result<f64, String> {
    positive(text, "1")
}

/// Reads an angle from the normal: at 90° nothing is struck.
fn angle(text: &str) -> Result<f64, String> {
    let angle = parse_quantity(text, "rad").map_err(|error| error.to_string())?;
    if (0.0..std::f64::consts::FRAC_PI_2).contains(&angle) {
        Ok(angle)
    } else {
        Err("it must be at least 0 and below 90 deg".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_have_units_and_are_positive() {
        assert!((length("1.2mm").unwrap() - 1.2e-3).abs() < 1e-18);
        assert!((stress("40ksi").unwrap() / 275.79e6 - 1.0).abs() < 1e-4);
        assert!((angle("50deg").unwrap() - 0.872_665).abs() < 1e-5);
        assert!((areal_mass("0.8 g/cm^2").unwrap() - 8.0).abs() < 1e-12);
        assert_eq!(number("95"), Ok(95.0));
        for wrong in ["0", "-1mm", "3", "3 Pa"] {
            assert!(length(wrong).is_err(), "{wrong}");
        }
        assert!(angle("90deg").is_err());
    }
}
