//! Three regimes of speed: the projectile stays whole, it shatters, it melts.

use super::handbook::{CM, Flight};

/// The state of a projectile behind the bumper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// In one piece: the faster, the worse.
    Ballistic,
    /// In pieces: linear between the other two, since more speed makes smaller ones.
    Shatter,
    /// As a cloud of droplets: the faster, the worse.
    Hypervelocity,
}

impl Regime {
    /// In a word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Ballistic => "ballistic",
            Self::Shatter => "shatter",
            Self::Hypervelocity => "hypervelocity",
        }
    }
}

/// The largest projectile that a shield stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Diameter d_c (m).
    pub diameter: f64,
    /// The regime of its speed.
    pub regime: Regime,
}

/// The limit at a flight's speed: `ballistic` (cm, of a flight) up to the first of two speeds (km/s),
/// `hypervelocity` from the second on, and between them a line in the speed from end to end.
pub(super) fn limit(
    flight: Flight,
    [low, high]: [f64; 2],
    ballistic: impl Fn(Flight) -> f64,
    hypervelocity: impl Fn(Flight) -> f64,
) -> Limit {
    let (diameter, regime) = if flight.speed <= low {
        (ballistic(flight), Regime::Ballistic)
    } else if flight.speed >= high {
        (hypervelocity(flight), Regime::Hypervelocity)
    } else {
        let [from, to] = [ballistic(flight.at(low)), hypervelocity(flight.at(high))];
        let part = (flight.speed - low) / (high - low);
        (from + (to - from) * part, Regime::Shatter)
    };
    Limit {
        diameter: diameter * CM,
        regime,
    }
}
