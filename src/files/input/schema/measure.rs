//! Measures of a run, as they are typed.

use serde::Deserialize;
use toml::Spanned;

use super::SidesParams;
use super::short::NormalParams;
use crate::input::quantity::{ArealMass, Length, Placed, Pressure, Time};
use model::Include;

tables! {
    /// `[[gauge]]`
    GaugeParams {
        /// Name in tables, as of a body.
        name: Option<Spanned<String>> => "`gauge-1` and so on";
        /// Where it is, or begins.
        at: Option<Spanned<Vec<Placed<Length>>>> => "that of `particle`";
        /// True if the particle nearest at the start carries it, in place of being fixed in space.
        moves: Option<Spanned<bool>> => "`false`";
        /// In place of a position, the id of the particle that carries it; it also reads the neighbours of that particle.
        particle: Option<Spanned<i64>>, AtLeast(0) => "none";
        /// Name of the body whose matter it reads.
        body: Option<Spanned<String>> => "all that deform";
        /// Names of what it reads.
        fields: Option<Spanned<Vec<Spanned<String>>>> => "pressure, density and velocity";
        /// Direction of the normal stress that it reads.
        along: Option<Spanned<NormalParams>> => "none";
        /// Time between readings.
        every: Option<Placed<Time>>, Positive;
        /// Steps between readings.
        every_steps: Option<Spanned<i64>>, AtLeast(1) => "each step, without a time";
    }

    /// `[[witness]]`
    WitnessParams {
        /// Name in tables, as of a body.
        name: Option<Spanned<String>> => "`witness-1` and so on";
        /// To the side to which matter passes forwards.
        normal: Spanned<NormalParams>;
        /// A point of the plane.
        point: Option<Spanned<Vec<Placed<Length>>>> => "the origin";
    }
}

tables! {
    /// `[[measure.plate]]` and `[[measure.target]]`
    SlabParams {
        /// Name in tables.
        name: Option<Spanned<String>> => "that of the body";
        /// Name of the body.
        body: Spanned<String>;
        /// Direction out of the face that is struck.
        normal: Option<Spanned<NormalParams>> => "told by what moves towards it";
        /// What can remain of it.
        include: Option<Include> => "of a plate what is intact, of a target all";
    }

    /// `[[measure.bar]]`
    BarParams {
        /// Name in tables.
        name: Option<Spanned<String>> => "that of the body";
        /// Name of the body.
        body: Spanned<String>;
        /// Direction to its foot.
        foot: Option<Spanned<NormalParams>> => "told by how it moves";
    }

    /// `[[measure.debris]]`
    DebrisParams {
        /// Name in tables.
        name: Option<Spanned<String>> => "`debris-1` and so on";
        /// Name of the plate or target that it leaves; what remains of that is no debris.
        of: Option<Spanned<String>>;
        /// Direction of flight.
        direction: Spanned<NormalParams>;
        /// A point of the plane beyond which it is.
        point: Option<Spanned<Vec<Placed<Length>>>> => "on that plate, else the origin";
        /// Names of the bodies whose matter it may be.
        bodies: Option<Spanned<Vec<Spanned<String>>>> => "all that deform";
        /// Areal mass of the outline.
        outline: Option<Placed<ArealMass>>, Positive => "2 % of the plate's, else half a layer of particles";
    }

    /// `[[measure.region]]`
    ZoneParams {
        /// Name in tables.
        name: Option<Spanned<String>> => "`region-1` and so on";
        /// Smallest coordinates.
        above: Option<Spanned<SidesParams>> => "open";
        /// Largest coordinates.
        below: Option<Spanned<SidesParams>> => "open";
        /// Centre of a ball, in place of sides.
        centre: Option<Spanned<Vec<Placed<Length>>>>;
        /// Radius of the ball.
        radius: Option<Placed<Length>>, Positive;
        /// True if it is what begins there and moves, in place of being fixed in space.
        moves: Option<bool> = false;
        /// Name of the body whose matter it reads.
        body: Option<Spanned<String>> => "all that deform";
        /// Names of what it reads.
        fields: Option<Spanned<Vec<Spanned<String>>>> => "pressure, density and velocity";
    }

    /// `[[measure.front]]`
    FrontParams {
        /// Name in tables.
        name: Option<Spanned<String>> => "`front-1` and so on";
        /// Where the line begins.
        from: Spanned<Vec<Placed<Length>>>;
        /// Where it ends.
        to: Spanned<Vec<Placed<Length>>>;
        /// How far from the line matter counts.
        radius: Option<Placed<Length>>, Positive => "1.5 spacings";
        /// Pressure of the front.
        pressure: Option<Placed<Pressure>>, Positive => "half the largest on the line";
    }
}

optional_tables! {
    /// `[measure]`
    MeasureParams {
        /// True if `bodies.csv` is written.
        bodies: Option<bool> = true;
        /// True if plates, targets and bars are found by their shapes.
        usual: Option<bool> = true;
        /// Time between rows of `measures.csv`.
        every: Option<Placed<Time>>, Positive => "a tenth of the run";
        /// Plates.
        plate: Vec<Spanned<SlabParams>>;
        /// Targets.
        target: Vec<Spanned<SlabParams>>;
        /// Bars.
        bar: Vec<Spanned<BarParams>>;
        /// Debris.
        debris: Vec<Spanned<DebrisParams>>;
        /// Regions.
        region: Vec<Spanned<ZoneParams>>;
        /// Fronts.
        front: Vec<Spanned<FrontParams>>;
        /// Pressure that counts as the arrival of a shock.
        arrival_pressure: Option<Placed<Pressure>>, Positive => "that of each material";
    }
}
