//! Values that may be a word or a number in place of a table.

use std::fmt;

use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer, StrDeserializer};
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor};
use toml::Spanned;

use super::Point;
use super::choices::Direction;
use crate::input::quantity::{Angle, AngularRate, Placed};
use crate::model::LatticeKind;

tables! {
    /// `lattice` as a table.
    LatticeTable {
        /// Kind of stacking.
        kind: Spanned<LatticeKind>,
        /// Turn about z.
        angle: Option<Placed<Angle>>,
    }

    /// `angular_velocity` as a table.
    AngularVelocityTable {
        /// About x, y and z; in two dimensions about z.
        rate: Spanned<Vec<Placed<AngularRate>>>,
        /// A point that it turns about.
        about: Point,
    }

    /// `friction` as a table.
    FrictionTable {
        /// Of faces that stick.
        r#static: Spanned<f64>,
        /// Of faces that slide.
        kinetic: Spanned<f64>,
    }
}

optional_tables! {
    /// `contact.self_contact` as a table.
    SelfContactTable {
        /// Spacings between the beginnings of particles that can fold onto each other.
        folds: Option<Spanned<f64>>,
    }
}

/// `"cubic"`, or a table with more.
#[derive(Debug)]
pub struct LatticeParams {
    /// Kind of stacking.
    pub kind: LatticeKind,
    /// Turn about z.
    pub angle: Option<Placed<Angle>>,
}

typed_as! {
    LatticeParams: "\"cubic\", \"hexagonal\", \"rings\" or a table with `kind` and `angle`" {
        word: |kind| LatticeParams { kind, angle: None };
        table: |table: LatticeTable| LatticeParams {
            kind: table.kind.into_inner(),
            angle: table.angle,
        };
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

/// Whether there is self-contact, or a table of what it does.
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
