//! Values that may be a word or a number in place of a table.

use std::fmt;

use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer, StrDeserializer};
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor};
use toml::Spanned;

use super::choices::{AutoWord, AxisWord, Direction};
use super::{Point, TurnsTable};
use crate::input::quantity::{Angle, AngularRate, Extent, Length, Placed, Quantity};
use model::{Axis, LatticeKind};

tables! {
    /// `lattice` as a table.
    LatticeTable {
        /// Kind of stacking.
        kind: Spanned<LatticeKind>;
        /// Turn of a lattice with an order.
        angle: Option<Placed<Angle>>;
        /// About which it is turned.
        axis: Option<Spanned<AxisParams>> => "z";
        /// True if the lattice is stretched to fill a box.
        fit: Option<Spanned<bool>> = false;
        /// Which glass.
        seed: Option<Spanned<i64>> => "0";
    }

    /// `spacing` as a table.
    SpacingTable {
        /// The finest spacing.
        inner: Placed<Length>, Positive;
        /// The coarsest spacing.
        outer: Placed<Length>, Positive;
        /// How many times as thick a layer is as the one before it.
        ratio: Option<Spanned<f64>> = 1.1;
        /// Where the body is finest, or a point of the line along which it is.
        at: Option<Point>;
        /// Direction of that line.
        axis: Option<Spanned<AxisParams>>;
        /// The side of the body at which it is finest, in place of `at`.
        face: Option<Spanned<NormalParams>>;
        /// How far from there the spacing stays the finest.
        within: Option<Spanned<Extent>> => "nowhere";
    }

    /// `round` as a table.
    RoundTable {
        /// A point of the axis, or what the face is about.
        centre: Option<Spanned<Vec<Placed<Length>>>> => "the origin";
        /// Axis of a cylinder.
        axis: Option<Spanned<Axis>> => "a sphere";
        /// Radius.
        radius: Placed<Length>, Positive;
    }

    /// `overburden` as a table.
    OverburdenTable {
        /// Stress on the sides over that from above.
        lateral: Option<Spanned<f64>> = 1.0, Within(0.0, 10.0);
    }

    /// `angular_velocity` as a table.
    AngularVelocityTable {
        /// About x, y and z; in two dimensions about z.
        rate: Spanned<Vec<Placed<AngularRate>>>;
        /// A point that it turns about.
        about: Point;
    }

    /// `friction` as a table.
    FrictionTable {
        /// Of faces that stick.
        r#static: Spanned<f64>, NotNegative;
        /// Of faces that slide.
        kinetic: Spanned<f64>, NotNegative;
    }
}

optional_tables! {
    /// `contact.self_contact` as a table.
    SelfContactTable {
        /// Spacings between the beginnings of particles that can fold onto each other.
        folds: Option<Spanned<f64>>, Positive;
    }
}

/// `"cubic"`, or a table with more.
#[derive(Debug)]
pub struct LatticeParams {
    /// Kind of stacking.
    pub kind: LatticeKind,
    /// Turn of a lattice with an order.
    pub angle: Option<Placed<Angle>>,
    /// About which it is turned.
    pub axis: Option<Spanned<AxisParams>>,
    /// True if the lattice is stretched to fill a box.
    pub fit: Option<Spanned<bool>>,
    /// Number of the glass.
    pub seed: Option<Spanned<i64>>,
}

typed_as! {
    LatticeParams: "\"cubic\", \"glass\" and the like or a table with `kind`" {
        word: |kind| LatticeParams { kind, angle: None, axis: None, fit: None, seed: None };
        table: |table: LatticeTable| LatticeParams {
            kind: table.kind.into_inner(),
            angle: table.angle,
            axis: table.axis,
            fit: table.fit,
            seed: table.seed,
        };
    }
}

/// `"auto"`, or a number of levels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LevelsParams {
    /// Those of the smallest halo.
    Auto(AutoWord),
    /// As many.
    Number(f64),
}

typed_as! {
    LevelsParams: "\"auto\", 1, 2 or 3" {
        word: LevelsParams::Auto;
        number: LevelsParams::Number;
    }
}

/// The spacing of a body, or a table that says how it grows.
#[derive(Debug)]
pub enum SpacingParams {
    /// One everywhere.
    Even(Quantity<Length>),
    /// A number without its unit.
    Plain(f64),
    /// One that grows.
    Graded(Box<SpacingTable>),
}

typed_as! {
    SpacingParams: "a length such as \"0.02 mm\", or a table with `inner` and `outer`" {
        word: SpacingParams::Even;
        number: SpacingParams::Plain;
        table: |table| SpacingParams::Graded(Box::new(table));
    }
}

impl SpacingParams {
    /// The finest one, if it has a unit.
    pub fn finest(&self) -> Option<&Quantity<Length>> {
        match self {
            Self::Even(length) => Some(length),
            Self::Plain(_) => None,
            Self::Graded(table) => Some(table.inner.get_ref()),
        }
    }
}

/// The components of an angular velocity, or a table with the point that a body turns about.
#[derive(Debug)]
pub enum AngularVelocityParams {
    /// About the centre.
    Own(Vec<Placed<AngularRate>>),
    /// About any point.
    About(AngularVelocityTable),
}

typed_as! {
    AngularVelocityParams: "an array of angular rates, or a table with `rate` and `about`" {
        list: AngularVelocityParams::Own;
        table: AngularVelocityParams::About;
    }
}

/// A coefficient of friction, or one of faces that stick and one of faces that slide.
#[derive(Debug)]
pub enum FrictionParams {
    /// One for both.
    One(f64),
    /// One for each.
    Two(FrictionTable),
}

typed_as! {
    FrictionParams: "a number, or a table with `static` and `kinetic`" {
        number: FrictionParams::One;
        table: FrictionParams::Two;
    }
}

/// True if there is self-contact, or a table of what it does.
#[derive(Debug)]
pub enum SelfContactParams {
    /// With parts alone, or not at all.
    Is(bool),
    /// With more.
    With(SelfContactTable),
}

typed_as! {
    SelfContactParams: "true, false, or a table with `folds`" {
        truth: SelfContactParams::Is;
        table: SelfContactParams::With;
    }
}

/// True if a zone has a round face: the shape's own, or one of a table.
#[derive(Debug)]
pub enum RoundParams {
    /// The shape's own, or none.
    Is(bool),
    /// Another one.
    Of(RoundTable),
}

typed_as! {
    RoundParams: "true, false, or a table with `centre`, `axis` and `radius`" {
        truth: RoundParams::Is;
        table: RoundParams::Of;
    }
}

/// True if there is a weight above, or a table of what it does.
#[derive(Debug)]
pub enum OverburdenParams {
    /// As much on the sides, or none.
    Is(bool),
    /// Another share on the sides.
    Of(OverburdenTable),
}

typed_as! {
    OverburdenParams: "true, false, or a table with `lateral`" {
        truth: OverburdenParams::Is;
        table: OverburdenParams::Of;
    }
}

/// `"+x"`, or the components of a vector of any length.
#[derive(Debug)]
pub enum NormalParams {
    /// Along an axis.
    Axis(Direction),
    /// Any other.
    Vector(Vec<f64>),
}

typed_as! {
    NormalParams: "\"+z\" and the like, or an array of numbers" {
        word: NormalParams::Axis;
        list: NormalParams::Vector;
    }
}

/// `"z"`, `"-z"`, or the components of a vector of any length.
#[derive(Debug)]
pub enum AxisParams {
    /// Along an axis.
    Word(AxisWord),
    /// Any other.
    Vector(Vec<f64>),
}

typed_as! {
    AxisParams: "\"z\", \"-z\" and the like, or an array of numbers" {
        word: AxisParams::Word;
        list: AxisParams::Vector;
    }
}

/// One turn, or several in their order.
#[derive(Debug)]
pub enum TurnsParams {
    /// One.
    One(Box<TurnsTable>),
    /// Several.
    Many(Vec<TurnsTable>),
}

typed_as! {
    TurnsParams: "a table with `axis` and `angle`, or an array of such" {
        table: |turn| TurnsParams::One(Box::new(turn));
        list: TurnsParams::Many;
    }
}

/// One name, or several.
#[derive(Debug, Clone)]
pub enum NamesParams {
    /// Of all components together, or of a quantity that has one.
    One(String),
    /// One for each component.
    Many(Vec<String>),
}

typed_as! {
    NamesParams: "a name in quotes, or an array of such" {
        word: NamesParams::One;
        list: NamesParams::Many;
    }
}

/// Name or number of a part of a file.
#[derive(Debug, Clone)]
pub enum PartParams {
    /// Its name, or its number in quotes.
    Name(String),
    /// Its number.
    Number(f64),
}

typed_as! {
    PartParams: "a name in quotes or a number" {
        word: PartParams::Name;
        number: PartParams::Number;
    }
}

/// One part of a file, or several.
#[derive(Debug, Clone)]
pub enum PartsParams {
    /// By its name.
    Name(String),
    /// By its number.
    Number(f64),
    /// Several.
    Many(Vec<PartParams>),
}

typed_as! {
    PartsParams: "the name or the number of a part, or an array of such" {
        word: PartsParams::Name;
        number: PartsParams::Number;
        list: PartsParams::Many;
    }
}
