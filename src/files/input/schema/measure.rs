//! What is measured in a run, as it is typed.

use serde::Deserialize;
use toml::Spanned;

use super::SidesParams;
use super::short::NormalParams;
use crate::input::quantity::{ArealMass, Length, Placed, Pressure, Time};
use model::Include;

tables! {
    /// `[[gauge]]`
    GaugeParams {
        /// Name in tables, as of a body; `gauge-1` and so on if absent.
        name: Option<Spanned<String>>,
        /// Where it is, or begins.
        at: Spanned<Vec<Placed<Length>>>,
        /// Whether the particle nearest at the start carries it, in place of being fixed in space; `false` if absent.
        moves: Option<bool>,
        /// Name of the body whose matter it reads; all that deform if absent.
        body: Option<Spanned<String>>,
        /// Names of what it reads; pressure, density and velocity if absent.
        fields: Option<Spanned<Vec<Spanned<String>>>>,
        /// Direction of the normal stress that it reads; none if absent.
        along: Option<Spanned<NormalParams>>,
        /// Time between readings.
        every: Option<Placed<Time>>,
        /// Steps between readings; each step, without a time, if absent.
        every_steps: Option<Spanned<i64>>,
    }

    /// `[[witness]]`
    WitnessParams {
        /// Name in tables, as of a body; `witness-1` and so on if absent.
        name: Option<Spanned<String>>,
        /// To the side to which matter passes forwards.
        normal: Spanned<NormalParams>,
        /// A point of the plane; the origin if absent.
        point: Option<Spanned<Vec<Placed<Length>>>>,
    }
}

tables! {
    /// `[[measure.plate]]` and `[[measure.target]]`
    SlabParams {
        /// Name in tables; that of the body if absent.
        name: Option<Spanned<String>>,
        /// Name of the body.
        body: Spanned<String>,
        /// Direction out of the face that is struck; told by what moves towards it if absent.
        normal: Option<Spanned<NormalParams>>,
        /// What can remain of it; of a plate what is intact, of a target all if absent.
        include: Option<Include>,
    }

    /// `[[measure.bar]]`
    BarParams {
        /// Name in tables; that of the body if absent.
        name: Option<Spanned<String>>,
        /// Name of the body.
        body: Spanned<String>,
        /// Direction to its foot; told by how it moves if absent.
        foot: Option<Spanned<NormalParams>>,
    }

    /// `[[measure.debris]]`
    DebrisParams {
        /// Name in tables; `debris-1` and so on if absent.
        name: Option<Spanned<String>>,
        /// Name of the plate or target that it leaves; what remains of that is no debris.
        of: Option<Spanned<String>>,
        /// Direction of flight.
        direction: Spanned<NormalParams>,
        /// A point of the plane beyond which it is; on that plate, else the origin if absent.
        point: Option<Spanned<Vec<Placed<Length>>>>,
        /// Names of the bodies whose matter it may be; all that deform if absent.
        bodies: Option<Spanned<Vec<Spanned<String>>>>,
        /// Areal mass of the outline; 2 % of the plate's, else half a layer of particles if absent.
        outline: Option<Placed<ArealMass>>,
    }

    /// `[[measure.region]]`
    ZoneParams {
        /// Name in tables; `region-1` and so on if absent.
        name: Option<Spanned<String>>,
        /// Smallest coordinates; open if absent.
        above: Option<Spanned<SidesParams>>,
        /// Largest coordinates; open if absent.
        below: Option<Spanned<SidesParams>>,
        /// Centre of a ball, in place of sides.
        centre: Option<Spanned<Vec<Placed<Length>>>>,
        /// Radius of the ball.
        radius: Option<Placed<Length>>,
        /// Whether it is what begins there and moves, in place of being fixed in space; `false` if absent.
        moves: Option<bool>,
        /// Name of the body whose matter it reads; all that deform if absent.
        body: Option<Spanned<String>>,
        /// Names of what it reads; pressure, density and velocity if absent.
        fields: Option<Spanned<Vec<Spanned<String>>>>,
    }

    /// `[[measure.front]]`
    FrontParams {
        /// Name in tables; `front-1` and so on if absent.
        name: Option<Spanned<String>>,
        /// Where the line begins.
        from: Spanned<Vec<Placed<Length>>>,
        /// Where it ends.
        to: Spanned<Vec<Placed<Length>>>,
        /// How far from the line matter counts; 1.5 spacings if absent.
        radius: Option<Placed<Length>>,
        /// Pressure of the front; half the largest on the line if absent.
        pressure: Option<Placed<Pressure>>,
    }
}

optional_tables! {
    /// `[measure]`
    MeasureParams {
        /// Whether `bodies.csv` is written; `true` if absent.
        bodies: Option<bool>,
        /// Whether plates, targets and bars are found by their shapes; `true` if absent.
        usual: Option<bool>,
        /// Time between rows of `measures.csv`; a tenth of the run if absent.
        every: Option<Placed<Time>>,
        /// Plates.
        plate: Vec<Spanned<SlabParams>>,
        /// Targets.
        target: Vec<Spanned<SlabParams>>,
        /// Bars.
        bar: Vec<Spanned<BarParams>>,
        /// Debris.
        debris: Vec<Spanned<DebrisParams>>,
        /// Regions.
        region: Vec<Spanned<ZoneParams>>,
        /// Fronts.
        front: Vec<Spanned<FrontParams>>,
        /// Pressure that counts as the arrival of a shock; that of each material if absent.
        arrival_pressure: Option<Placed<Pressure>>,
    }
}
