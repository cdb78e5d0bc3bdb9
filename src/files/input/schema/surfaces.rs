//! `[[plane]]`, `[[surface]]` and what belongs to them.

use serde::Deserialize;
use toml::Spanned;

use super::MotionParams;
use super::choices::SideName;
use super::short::{FrictionParams, NormalParams};
use crate::input::forms::OneOrMany;
use crate::input::quantity::{Angle, AngularRate, Length, Placed, Time};
use model::Axis;

tables! {
    /// `[[plane]]`
    PlaneParams {
        /// Name in reports, as of a body; `plane-1` and so on if absent.
        name: Option<Spanned<String>>,
        /// To the side that the plane keeps.
        normal: Spanned<NormalParams>,
        /// A point of the plane; the origin if absent.
        point: Option<Spanned<Vec<Placed<Length>>>>,
        /// Names of the bodies that feel it; all if absent.
        bodies: Option<Vec<Spanned<String>>>,
        /// Stiffness κ; 2 if absent.
        stiffness: Option<Spanned<f64>>,
        /// Coefficients of friction; 0 if absent.
        friction: Option<Spanned<FrictionParams>>,
        /// Share of critical damping; 0 if absent.
        damping: Option<Spanned<f64>>,
        /// Motion of the plane; fixed if absent.
        motion: Option<Spanned<MotionParams>>,
    }

    /// `[[surface]]`
    SurfaceParams {
        /// Name in reports, as of a body; `surface-1` and so on if absent.
        name: Option<Spanned<String>>,
        /// Geometry.
        shape: Spanned<SurfaceShapeParams>,
        /// Where the particles are; `"outside"` if absent.
        side: Option<SideName>,
        /// Names of the bodies that feel it; all if absent.
        bodies: Option<Vec<Spanned<String>>>,
        /// Stiffness κ; 2 if absent.
        stiffness: Option<Spanned<f64>>,
        /// Coefficients of friction; 0 if absent.
        friction: Option<Spanned<FrictionParams>>,
        /// Share of critical damping; 0 if absent.
        damping: Option<Spanned<f64>>,
        /// Motion of the surface; fixed if absent.
        motion: Option<Spanned<MotionParams>>,
        /// Rotation of the surface; none if absent.
        rotation: Option<Spanned<RotationParams>>,
    }

    /// `shape` of a surface: exactly one of these.
    SurfaceShapeParams {
        /// Ball; a disc in two dimensions.
        sphere: Option<SurfaceSphereParams>,
        /// Circular cylinder.
        cylinder: Option<SurfaceCylinderParams>,
        /// Triangles from an STL file.
        stl: Option<Spanned<MeshFileParams>>,
        /// Triangles and polygons from an OBJ file.
        obj: Option<Spanned<MeshFileParams>>,
    }

    /// `shape.sphere` of a surface.
    SurfaceSphereParams {
        /// Centre; the origin if absent.
        centre: Option<Spanned<Vec<Placed<Length>>>>,
        /// Radius.
        radius: Placed<Length>,
    }

    /// `shape.cylinder` of a surface.
    SurfaceCylinderParams {
        /// Middle of the axis; the origin if absent.
        centre: Option<Spanned<Vec<Placed<Length>>>>,
        /// Direction of the axis; z if absent.
        axis: Option<Spanned<Axis>>,
        /// Radius.
        radius: Placed<Length>,
        /// Length along the axis; without ends if absent.
        length: Option<Placed<Length>>,
    }

    /// `shape.stl`, `shape.obj`, of surfaces and of bodies.
    MeshFileParams {
        /// Path, from the folder of the case.
        file: Spanned<String>,
        /// Length of one unit of the file.
        unit: Placed<Length>,
        /// Where the file's origin stands; the origin if absent.
        at: Option<Spanned<Vec<Placed<Length>>>>,
        /// Turns the surface about the file's origin, before it is placed; none if absent.
        turn: Option<TurnParams>,
        /// SHA-256 that the file must have.
        sha256: Option<Spanned<String>>,
    }

    /// `turn`
    TurnParams {
        /// Axis through the origin.
        axis: Spanned<Axis>,
        /// By how much.
        angle: Placed<Angle>,
    }

    /// `rotation`
    RotationParams {
        /// Axis of the rotation.
        axis: Spanned<Axis>,
        /// A point of the axis; the origin if absent.
        point: Option<Spanned<Vec<Placed<Length>>>>,
        /// Times of the table.
        times: Option<Spanned<Vec<Placed<Time>>>>,
        /// Rate, right-handed about the axis.
        rate: Spanned<OneOrMany<AngularRate>>,
    }
}
