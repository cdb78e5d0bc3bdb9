//! `particles` of a body: those of a file.

use serde::Deserialize;
use toml::Spanned;

use super::{FormatName, NamesParams, PartsParams, Point, ShapeParams, TakeName, TurnsParams};
use crate::input::quantity::{Length, Mass, Placed, Time};
use model::Axis;

tables! {
    /// `particles`
    ParticlesParams {
        /// Path, from the folder of the case.
        file: Spanned<String>;
        /// What is in it.
        format: Option<Spanned<FormatName>> => "told by its ending";
        /// Names or numbers of its parts that the body is of.
        part: Option<Spanned<PartsParams>> => "the only one";
        /// What of a mesh becomes particles.
        take: Option<Spanned<TakeName>> = TakeName::Elements;
        /// Length of one unit of the file.
        unit: Option<Placed<Length>>, Positive;
        /// Mass of one unit of the file.
        mass_unit: Option<Placed<Mass>>, Positive;
        /// Time of one unit of the file.
        time_unit: Option<Placed<Time>>, Positive;
        /// What the file calls its columns or arrays.
        columns: Option<Spanned<ColumnsParams>>;
        /// Mirrors them, and all that has directions, across the origin along an axis, before they are turned.
        mirror: Option<Spanned<Axis>> => "none";
        /// Turns them.
        turn: Option<Spanned<TurnsParams>> => "none";
        /// Moves them, once they are turned.
        shift: Option<Point> => "none";
        /// SHA-256 that the file must have.
        sha256: Option<Spanned<String>>;
    }
}

optional_tables! {
    /// `particles.columns`
    ColumnsParams {
        /// Of places.
        position: Option<Spanned<NamesParams>>;
        /// Of masses.
        mass: Option<Spanned<NamesParams>>;
        /// Of volumes.
        volume: Option<Spanned<NamesParams>>;
        /// Of densities.
        density: Option<Spanned<NamesParams>>;
        /// Of velocities.
        velocity: Option<Spanned<NamesParams>>;
        /// Of specific energies.
        specific_energy: Option<Spanned<NamesParams>>;
        /// Of temperatures.
        temperature: Option<Spanned<NamesParams>>;
        /// Of deviatoric stresses.
        deviatoric_stress: Option<Spanned<NamesParams>>;
        /// Of plastic strains.
        plastic_strain: Option<Spanned<NamesParams>>;
        /// Of damages.
        damage: Option<Spanned<NamesParams>>;
        /// Of names or numbers of parts.
        part: Option<Spanned<NamesParams>>;
    }
}

impl super::BodyParams {
    /// Place of its geometry.
    pub fn form_span(&self) -> std::ops::Range<usize> {
        let shape = self.shape.as_ref().map(Spanned::span);
        let particles = self.particles.as_ref().map(Spanned::span);
        shape.or(particles).unwrap_or_else(|| self.name.span())
    }

    /// True if forces move it though it is rigid.
    pub fn is_free(&self) -> bool {
        self.free.as_ref().is_some_and(|free| *free.get_ref())
    }

    /// True if a file tells what it is.
    pub fn is_of_file(&self) -> bool {
        let of_file = |shape: &ShapeParams| shape.stl.is_some() || shape.obj.is_some();
        let shape = self.shape.as_ref();
        self.particles.is_some() || shape.is_some_and(|shape| of_file(shape.get_ref()))
    }
}
