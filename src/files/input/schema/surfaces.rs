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
        /// Name in reports, as of a body.
        name: Option<Spanned<String>> => "`plane-1` and so on";
        /// To the side that the plane keeps.
        normal: Spanned<NormalParams>;
        /// A point of the plane.
        point: Option<Spanned<Vec<Placed<Length>>>> => "the origin";
        /// Names of the bodies that feel it.
        bodies: Option<Vec<Spanned<String>>> => "all";
        // Of a half spacing of material before the surface.
        /// Stiffness κ.
        stiffness: Option<Spanned<f64>> = 2.0, Positive;
        /// Coefficients of friction.
        friction: Option<Spanned<FrictionParams>> = 0.0, NotNegative;
        /// Share of critical damping.
        damping: Option<Spanned<f64>> = 0.0, Within(0.0, 1.0);
        /// Motion of the plane.
        motion: Option<Spanned<MotionParams>> => "fixed";
    }

    /// `[[surface]]`
    SurfaceParams {
        /// Name in reports, as of a body.
        name: Option<Spanned<String>> => "`surface-1` and so on";
        /// Geometry.
        shape: Spanned<SurfaceShapeParams>;
        /// Where the particles are.
        side: Option<SideName> = SideName::Outside;
        /// Names of the bodies that feel it.
        bodies: Option<Vec<Spanned<String>>> => "all";
        // Of a half spacing of material before the surface.
        /// Stiffness κ.
        stiffness: Option<Spanned<f64>> = 2.0, Positive;
        /// Coefficients of friction.
        friction: Option<Spanned<FrictionParams>> = 0.0, NotNegative;
        /// Share of critical damping.
        damping: Option<Spanned<f64>> = 0.0, Within(0.0, 1.0);
        /// Motion of the surface.
        motion: Option<Spanned<MotionParams>> => "fixed";
        /// Rotation of the surface.
        rotation: Option<Spanned<RotationParams>> => "none";
    }

    /// `shape` of a surface: exactly one of these.
    SurfaceShapeParams {
        /// Ball; a disc in two dimensions.
        sphere: Option<SurfaceSphereParams>;
        /// Circular cylinder.
        cylinder: Option<SurfaceCylinderParams>;
        /// Triangles from an STL file.
        stl: Option<Spanned<MeshFileParams>>;
        /// Triangles and polygons from an OBJ file.
        obj: Option<Spanned<MeshFileParams>>;
    }

    /// `shape.sphere` of a surface.
    SurfaceSphereParams {
        /// Centre.
        centre: Option<Spanned<Vec<Placed<Length>>>> => "the origin";
        /// Radius.
        radius: Option<Placed<Length>>, Positive;
        /// Diameter, in place of the radius.
        diameter: Option<Placed<Length>>, Positive;
    }

    /// `shape.cylinder` of a surface.
    SurfaceCylinderParams {
        /// Middle of the axis.
        centre: Option<Spanned<Vec<Placed<Length>>>> => "the origin";
        /// Direction of the axis.
        axis: Option<Spanned<Axis>> => "z";
        /// Radius.
        radius: Option<Placed<Length>>, Positive;
        /// Diameter, in place of the radius.
        diameter: Option<Placed<Length>>, Positive;
        /// Length along the axis.
        length: Option<Placed<Length>>, Positive => "without ends";
    }

    /// `shape.stl`, `shape.obj`, of surfaces and of bodies.
    MeshFileParams {
        /// Path, from the folder of the case.
        file: Spanned<String>;
        /// Length of one unit of the file.
        unit: Placed<Length>, Positive;
        /// Mirrors the surface across the file's origin along an axis, before it is turned.
        mirror: Option<Spanned<Axis>> => "none";
        /// Where the file's origin stands.
        at: Option<Spanned<Vec<Placed<Length>>>> => "the origin";
        /// Turns the surface about the file's origin, before it is placed.
        turn: Option<TurnParams> => "none";
        /// SHA-256 that the file must have.
        sha256: Option<Spanned<String>>;
    }

    /// `turn`
    TurnParams {
        /// Axis through the origin.
        axis: Spanned<Axis>;
        /// By how much.
        angle: Placed<Angle>;
    }

    /// `rotation`
    RotationParams {
        /// Axis of the rotation.
        axis: Spanned<Axis>;
        /// A point of the axis.
        point: Option<Spanned<Vec<Placed<Length>>>> => "the origin";
        /// Times of the table.
        times: Option<Spanned<Vec<Placed<Time>>>>;
        /// Rate, right-handed about the axis.
        rate: Spanned<OneOrMany<AngularRate>>;
    }
}
