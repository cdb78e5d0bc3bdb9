//! Shapes of bodies, alone and together.

use serde::Deserialize;
use toml::Spanned;

use super::{AxisParams, MeshFileParams, Point, RepeatName, TurnsParams};
use crate::input::quantity::{Angle, Extent, Placed};

tables! {
    /// `shape`: exactly one of the forms.
    ShapeParams {
        /// Axis-aligned box.
        r#box: Option<Spanned<BoxParams>>;
        /// Ball; a disc in two dimensions.
        sphere: Option<Spanned<SphereParams>>;
        /// Circular cylinder or tube.
        cylinder: Option<Spanned<CylinderParams>>;
        /// Ellipsoid; an ellipse in two dimensions.
        ellipsoid: Option<Spanned<EllipsoidParams>>;
        /// Cone or frustum.
        cone: Option<Spanned<ConeParams>>;
        /// Shank with a tangent ogive as its nose.
        ogive: Option<Spanned<OgiveParams>>;
        /// Ring with a circle as its section.
        torus: Option<Spanned<TorusParams>>;
        /// Prism of a polygon; the polygon in two dimensions.
        prism: Option<Spanned<PrismParams>>;
        /// Closed surface of triangles from an STL file.
        stl: Option<Spanned<MeshFileParams>>;
        /// Closed surface of triangles and polygons from an OBJ file.
        obj: Option<Spanned<MeshFileParams>>;
        /// What any of some shapes holds.
        union: Option<Spanned<Vec<Spanned<ShapeParams>>>>;
        /// What all of some shapes hold.
        intersection: Option<Spanned<Vec<Spanned<ShapeParams>>>>;
        /// What the first of some shapes holds and none of the others.
        difference: Option<Spanned<Vec<Spanned<ShapeParams>>>>;
        /// A shape over and over at the points of a lattice.
        repeat: Option<Spanned<RepeatParams>>;
        /// Turns it.
        turn: Option<Spanned<TurnsParams>> => "none";
        /// Moves it, once it is turned.
        shift: Option<Point> => "none";
    }

    /// `shape.box`: two corners, or size and centre.
    BoxParams {
        /// Corner of smallest coordinates.
        lower: Option<Point>;
        /// Corner of largest coordinates.
        upper: Option<Point>;
        /// Centre.
        centre: Option<Point> => "the origin";
        /// Edges.
        size: Option<Point>;
    }

    /// `shape.sphere`
    SphereParams {
        /// Centre.
        centre: Option<Point> => "the origin";
        /// Radius.
        radius: Option<Spanned<Extent>>;
        /// Diameter, in place of the radius.
        diameter: Option<Spanned<Extent>>;
        /// Radius of a hole in the middle.
        inner_radius: Option<Spanned<Extent>> => "none";
        /// Diameter of that hole, in place of its radius.
        inner_diameter: Option<Spanned<Extent>> => "none";
    }

    /// `shape.cylinder`
    CylinderParams {
        /// Middle of the axis.
        centre: Option<Point> => "the origin";
        /// Direction of the axis.
        axis: Option<Spanned<AxisParams>> => "z";
        /// Radius.
        radius: Option<Spanned<Extent>>;
        /// Diameter, in place of the radius.
        diameter: Option<Spanned<Extent>>;
        /// Radius of the bore of a tube.
        inner_radius: Option<Spanned<Extent>> => "none";
        /// Diameter of the bore, in place of its radius.
        inner_diameter: Option<Spanned<Extent>> => "none";
        /// Length along the axis.
        length: Spanned<Extent>;
    }

    /// `shape.ellipsoid`
    EllipsoidParams {
        /// Centre.
        centre: Option<Point> => "the origin";
        /// Half its extents along the axes.
        semi_axes: Point;
    }

    /// `shape.cone`
    ConeParams {
        /// Middle of the axis.
        centre: Option<Point> => "the origin";
        /// From the base to the top.
        axis: Option<Spanned<AxisParams>> => "z";
        /// Radius of the base.
        radius: Option<Spanned<Extent>>;
        /// Diameter of the base, in place of its radius.
        diameter: Option<Spanned<Extent>>;
        /// Radius of the top of a frustum.
        top_radius: Option<Spanned<Extent>> => "zero";
        /// Diameter of that top, in place of its radius.
        top_diameter: Option<Spanned<Extent>> => "zero";
        /// Length along the axis.
        length: Spanned<Extent>;
    }

    /// `shape.ogive`
    OgiveParams {
        /// Middle of the whole length.
        centre: Option<Point> => "the origin";
        /// Where the tip points.
        axis: Option<Spanned<AxisParams>> => "z";
        /// Radius of the shank.
        radius: Option<Spanned<Extent>>;
        /// Diameter of the shank, in place of its radius.
        diameter: Option<Spanned<Extent>>;
        /// Length of the nose.
        nose: Spanned<Extent>;
        /// Whole length.
        length: Spanned<Extent>;
    }

    /// `shape.torus`
    TorusParams {
        /// Centre.
        centre: Option<Point> => "the origin";
        /// Axis of the ring.
        axis: Option<Spanned<AxisParams>> => "z";
        /// From the axis to the middle of the section.
        radius: Option<Spanned<Extent>>;
        /// Twice that, in place of it.
        diameter: Option<Spanned<Extent>>;
        /// Radius of the section.
        tube_radius: Option<Spanned<Extent>>;
        /// Diameter of the section, in place of its radius.
        tube_diameter: Option<Spanned<Extent>>;
    }

    /// `shape.prism`
    PrismParams {
        /// Where the corners count from, half way along the length.
        centre: Option<Point> => "the origin";
        /// Direction of the length.
        axis: Option<Spanned<AxisParams>> => "z";
        /// Corners of the section.
        corners: Option<Spanned<Vec<Point>>>;
        /// Sides of a regular section, in place of `corners`; the first of them faces the first direction across the axis.
        sides: Option<Spanned<i64>>, AtLeast(3);
        /// Diameter of the circle that touches these sides: of a hexagon its width across flats.
        across_flats: Option<Spanned<Extent>>;
        /// Length along the axis; none in two dimensions.
        length: Option<Spanned<Extent>>;
    }

    /// `shape.repeat`: a shape with its origin at each point of a lattice through the origin.
    RepeatParams {
        /// The shape.
        unit: Box<Spanned<ShapeParams>>;
        /// Points along a line, in squares or triangles of a plane, or in cubes.
        lattice: Spanned<RepeatName>;
        /// From point to nearest point.
        cell: Spanned<Extent>;
        /// Direction of a line, or across a plane, in which a row runs along x if that is in it.
        axis: Option<Spanned<AxisParams>> => "z, of a line x";
        /// Smallest coordinates of points.
        lower: Point;
        /// Largest coordinates of points; those along which the lattice does not go do not count.
        upper: Point;
    }

    /// `turn` of a shape
    TurnsTable {
        /// Axis of the turn.
        axis: Spanned<AxisParams>;
        /// By how much, right-handed.
        angle: Placed<Angle>;
        /// A point of the axis.
        about: Option<Point> => "the middle of the shape";
    }
}
