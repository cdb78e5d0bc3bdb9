//! Shapes of bodies, alone and together.

use serde::Deserialize;
use toml::Spanned;

use super::{AxisParams, MeshFileParams, Point, TurnsParams};
use crate::input::quantity::{Angle, Extent, Placed};

tables! {
    /// `shape`: exactly one of the forms.
    ShapeParams {
        /// Axis-aligned box.
        r#box: Option<Spanned<BoxParams>>,
        /// Ball; a disc in two dimensions.
        sphere: Option<Spanned<SphereParams>>,
        /// Circular cylinder or tube.
        cylinder: Option<Spanned<CylinderParams>>,
        /// Ellipsoid; an ellipse in two dimensions.
        ellipsoid: Option<Spanned<EllipsoidParams>>,
        /// Cone or frustum.
        cone: Option<Spanned<ConeParams>>,
        /// Shank with a tangent ogive as its nose.
        ogive: Option<Spanned<OgiveParams>>,
        /// Ring with a circle as its section.
        torus: Option<Spanned<TorusParams>>,
        /// Prism of a polygon; the polygon in two dimensions.
        prism: Option<Spanned<PrismParams>>,
        /// Closed surface of triangles from an STL file.
        stl: Option<Spanned<MeshFileParams>>,
        /// Closed surface of triangles and polygons from an OBJ file.
        obj: Option<Spanned<MeshFileParams>>,
        /// What any of some shapes holds.
        union: Option<Spanned<Vec<Spanned<ShapeParams>>>>,
        /// What all of some shapes hold.
        intersection: Option<Spanned<Vec<Spanned<ShapeParams>>>>,
        /// What the first of some shapes holds and none of the others.
        difference: Option<Spanned<Vec<Spanned<ShapeParams>>>>,
        /// Turns it; none if absent.
        turn: Option<Spanned<TurnsParams>>,
        /// Moves it, once it is turned; none if absent.
        shift: Option<Point>,
    }

    /// `shape.box`: two corners, or size and centre.
    BoxParams {
        /// Corner of smallest coordinates.
        lower: Option<Point>,
        /// Corner of largest coordinates.
        upper: Option<Point>,
        /// Centre; the origin if absent.
        centre: Option<Point>,
        /// Edges.
        size: Option<Point>,
    }

    /// `shape.sphere`
    SphereParams {
        /// Centre; the origin if absent.
        centre: Option<Point>,
        /// Radius.
        radius: Spanned<Extent>,
        /// Radius of a hole in the middle; none if absent.
        inner_radius: Option<Spanned<Extent>>,
    }

    /// `shape.cylinder`
    CylinderParams {
        /// Middle of the axis; the origin if absent.
        centre: Option<Point>,
        /// Direction of the axis; z if absent.
        axis: Option<Spanned<AxisParams>>,
        /// Radius.
        radius: Spanned<Extent>,
        /// Radius of the bore of a tube; none if absent.
        inner_radius: Option<Spanned<Extent>>,
        /// Length along the axis.
        length: Spanned<Extent>,
    }

    /// `shape.ellipsoid`
    EllipsoidParams {
        /// Centre; the origin if absent.
        centre: Option<Point>,
        /// Half its extents along the axes.
        semi_axes: Point,
    }

    /// `shape.cone`
    ConeParams {
        /// Middle of the axis; the origin if absent.
        centre: Option<Point>,
        /// From the base to the top; z if absent.
        axis: Option<Spanned<AxisParams>>,
        /// Radius of the base.
        radius: Spanned<Extent>,
        /// Radius of the top of a frustum; zero if absent.
        top_radius: Option<Spanned<Extent>>,
        /// Length along the axis.
        length: Spanned<Extent>,
    }

    /// `shape.ogive`
    OgiveParams {
        /// Middle of the whole length; the origin if absent.
        centre: Option<Point>,
        /// Where the tip points; z if absent.
        axis: Option<Spanned<AxisParams>>,
        /// Radius of the shank.
        radius: Spanned<Extent>,
        /// Length of the nose.
        nose: Spanned<Extent>,
        /// Whole length.
        length: Spanned<Extent>,
    }

    /// `shape.torus`
    TorusParams {
        /// Centre; the origin if absent.
        centre: Option<Point>,
        /// Axis of the ring; z if absent.
        axis: Option<Spanned<AxisParams>>,
        /// From the axis to the middle of the section.
        radius: Spanned<Extent>,
        /// Radius of the section.
        tube_radius: Spanned<Extent>,
    }

    /// `shape.prism`
    PrismParams {
        /// Where the corners count from, half way along the length; the origin if absent.
        centre: Option<Point>,
        /// Direction of the length; z if absent.
        axis: Option<Spanned<AxisParams>>,
        /// Corners of the section.
        corners: Spanned<Vec<Point>>,
        /// Length along the axis; none in two dimensions.
        length: Option<Spanned<Extent>>,
    }

    /// `turn` of a shape
    TurnsTable {
        /// Axis of the turn.
        axis: Spanned<AxisParams>,
        /// By how much, right-handed.
        angle: Placed<Angle>,
        /// A point of the axis; the middle of the shape if absent.
        about: Option<Point>,
    }
}
