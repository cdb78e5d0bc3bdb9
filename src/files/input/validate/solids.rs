//! Forms that are neither boxes, spheres nor straight cylinders; shapes together, turned and moved.

use toml::Spanned;

use super::check::required;
use super::meshes::MeshReader;
use super::shapes::{Shapes, axis_vector, onto, placed};
use crate::input::schema::{
    ConeParams, EllipsoidParams, MeshFileParams, OgiveParams, Point, PrismParams, RepeatName,
    RepeatParams, ShapeParams, TorusParams, TurnsParams, TurnsTable,
};
use crate::input::source::Diagnostic;
use crate::input::triangles::Format;
use model::{Placement, Polygon, Primitive, Repeat, Shape, Solid, Vec3, rotation};

/// Most corners of a polygon, and most shapes together.
const MOST_CORNERS: usize = 10_000;
const MOST_SHAPES: usize = 1000;

impl Shapes<'_> {
    pub(super) fn ellipsoid(&self, table: &Spanned<EllipsoidParams>) -> Result<Shape, Diagnostic> {
        let params = table.get_ref();
        let centre = self.point(params.centre.as_ref(), "centre")?;
        let mut semi = self.point(Some(&params.semi_axes), "semi_axes")?;
        if (0..self.dimension).any(|a| semi[a] <= 0.0) {
            let title = "every semi-axis of an ellipsoid must be positive";
            return Err(Diagnostic::new(params.semi_axes.span(), title));
        }
        if self.dimension == 2 {
            semi.z = f64::INFINITY;
        }
        let place = Placement::at(centre);
        Ok(Shape::Solid(Solid::Primitive(
            Primitive::Ellipsoid(semi),
            place,
        )))
    }

    pub(super) fn cone(&self, table: &Spanned<ConeParams>) -> Result<Shape, Diagnostic> {
        let params = table.get_ref();
        let centre = self.point(params.centre.as_ref(), "centre")?;
        let radius = self.outer_radius([&params.radius, &params.diameter], &table.span())?;
        let half = 0.5 * self.positive(&params.length, "length")?;
        let mut outline = vec![[0.0, -half], [radius, -half]];
        let top = [&params.top_radius, &params.top_diameter];
        let top = self.radius(top, ["top_radius", "top_diameter"], &table.span())?;
        outline.extend(top.map(|top| [top, half]));
        outline.push([0.0, half]);
        let profile = Polygon::new(outline).expect("a triangle or a trapezium");
        let axis = axis_vector(params.axis.as_ref())?;
        Ok(placed(Primitive::Revolved(profile), &axis, centre))
    }

    pub(super) fn ogive(&self, table: &Spanned<OgiveParams>) -> Result<Shape, Diagnostic> {
        let params = table.get_ref();
        let centre = self.point(params.centre.as_ref(), "centre")?;
        let radius = self.outer_radius([&params.radius, &params.diameter], &table.span())?;
        let nose = self.positive(&params.nose, "nose")?;
        let length = self.positive(&params.length, "length")?;
        if nose < radius {
            let title = "the `nose` of an ogive must be as long as its `radius` at least";
            return Err(Diagnostic::new(params.nose.span(), title)
                .help("one that is as long is half a ball; a flatter one is an `ellipsoid`"));
        }
        if length < nose {
            let title =
                "the `length` of an ogive, which counts its nose, must not be less than that";
            return Err(Diagnostic::new(params.length.span(), title));
        }
        let axis = axis_vector(params.axis.as_ref())?;
        let form = Primitive::Ogive {
            radius,
            arc: (radius * radius + nose * nose) / (2.0 * radius),
            nose,
            shank: length - nose,
        };
        // Its origin is where the nose begins.
        let origin = centre + axis * (0.5 * length - nose);
        Ok(placed(form, &axis, origin))
    }

    pub(super) fn torus(&self, table: &Spanned<TorusParams>) -> Result<Shape, Diagnostic> {
        let params = table.get_ref();
        let radius = self.outer_radius([&params.radius, &params.diameter], &table.span())?;
        let tube = [&params.tube_radius, &params.tube_diameter];
        let tube = self.radius(tube, ["tube_radius", "tube_diameter"], &table.span())?;
        let tube = required(tube, "tube_radius", &table.span())?;
        if tube >= radius {
            let title = "`tube_radius` must be smaller than `radius`";
            return Err(Diagnostic::new(table.span(), title));
        }
        let centre = self.point(params.centre.as_ref(), "centre")?;
        let axis = axis_vector(params.axis.as_ref())?;
        Ok(placed(Primitive::Torus { radius, tube }, &axis, centre))
    }

    pub(super) fn prism(&self, table: &Spanned<PrismParams>) -> Result<Shape, Diagnostic> {
        let params = table.get_ref();
        let centre = self.point(params.centre.as_ref(), "centre")?;
        let section = match (&params.corners, &params.sides) {
            (Some(corners), None) => self.polygon(corners)?,
            (None, Some(_)) => self.regular(params, table)?,
            (Some(_), Some(twice)) => {
                let title = "a prism has `corners`, or `sides` that are alike, not both";
                return Err(Diagnostic::new(twice.span(), title));
            }
            (None, None) => {
                let title = "the key `corners` is missing";
                return Err(Diagnostic::new(table.span(), title)
                    .label("in this table")
                    .help("or give it `sides` that are alike"));
            }
        };
        let half = match (&params.length, self.dimension) {
            (Some(length), 3) => 0.5 * self.positive(length, "length")?,
            (None, 2) => f64::INFINITY,
            (None, _) => {
                let title = "a prism must have a `length`";
                return Err(Diagnostic::new(table.span(), title));
            }
            (Some(length), _) => {
                let title = "in two dimensions a prism has no `length`";
                return Err(Diagnostic::new(length.span(), title));
            }
        };
        let axis = axis_vector(params.axis.as_ref())?;
        if let (2, Some(given)) = (self.dimension, &params.axis) {
            let title = "in two dimensions a prism has no `axis`";
            return Err(Diagnostic::new(given.span(), title));
        }
        Ok(placed(Primitive::Prism { section, half }, &axis, centre))
    }

    /// The section of a prism by its corners.
    fn polygon(&self, corners: &Spanned<Vec<Point>>) -> Result<Polygon, Diagnostic> {
        let refuse = |title: &str| Err(Diagnostic::new(corners.span(), title));
        if corners.get_ref().len() > MOST_CORNERS {
            return refuse("a polygon may have 10000 corners at most");
        }
        let flat = Self {
            dimension: 2,
            ..*self
        };
        let outline: Result<Vec<[f64; 2]>, Diagnostic> = (corners.get_ref().iter())
            .map(|corner| flat.point(Some(corner), "corners").map(|x| [x.x, x.y]))
            .collect();
        match Polygon::new(outline?) {
            Some(section) => Ok(section),
            None => refuse("`corners` must be those of a polygon whose edges do not cross"),
        }
    }

    /// A regular section of a prism, whose first side faces the first direction.
    fn regular(
        &self,
        params: &PrismParams,
        table: &Spanned<PrismParams>,
    ) -> Result<Polygon, Diagnostic> {
        let sides = params.sides()?.unwrap_or(0);
        let across = (params.across_flats.as_ref())
            .map(|across| self.positive(across, "across_flats"))
            .transpose()?;
        let across = required(across, "across_flats", &table.span())?;
        let refuse = |title: &str| {
            let at = params.sides.as_ref().map_or(table.span(), Spanned::span);
            Diagnostic::new(at, title)
        };
        let count = u32::try_from(sides).unwrap_or(u32::MAX);
        if count as usize > MOST_CORNERS {
            return Err(refuse("a polygon may have 10000 corners at most"));
        }
        let half = std::f64::consts::PI / f64::from(count);
        let radius = 0.5 * across / libm::cos(half);
        let corner = |n: u32| {
            let angle = f64::from(2 * n + 1) * half;
            [radius * libm::cos(angle), radius * libm::sin(angle)]
        };
        Polygon::new((0..count).map(corner).collect()).ok_or_else(|| refuse("no polygon"))
    }

    pub(super) fn stl(&self, table: &Spanned<MeshFileParams>) -> Result<Shape, Diagnostic> {
        self.mesh(table, Format::Stl)
    }

    pub(super) fn obj(&self, table: &Spanned<MeshFileParams>) -> Result<Shape, Diagnostic> {
        self.mesh(table, Format::Obj)
    }

    fn mesh(&self, table: &Spanned<MeshFileParams>, format: Format) -> Result<Shape, Diagnostic> {
        let reader = MeshReader {
            folder: self.folder,
            spacing: self.spacing,
            what: "body",
        };
        let mesh = Primitive::Mesh(reader.read(table, format)?);
        let place = Placement::at(Vec3::zeros());
        Ok(Shape::Solid(Solid::Primitive(mesh, place)))
    }

    pub(super) fn union(&self, parts: &Parts) -> Result<Shape, Diagnostic> {
        Ok(Shape::Solid(Solid::Union(self.parts(parts)?)))
    }

    pub(super) fn intersection(&self, parts: &Parts) -> Result<Shape, Diagnostic> {
        Ok(Shape::Solid(Solid::Intersection(self.parts(parts)?)))
    }

    pub(super) fn difference(&self, parts: &Parts) -> Result<Shape, Diagnostic> {
        let mut cuts = self.parts(parts)?;
        let base = Box::new(cuts.remove(0));
        Ok(Shape::Solid(Solid::Difference(base, cuts)))
    }

    /// A shape at the points of a lattice.
    pub(super) fn repeat(&self, table: &Spanned<RepeatParams>) -> Result<Shape, Diagnostic> {
        let params = table.get_ref();
        let lattice = *params.lattice.get_ref();
        let cell = self.positive(&params.cell, "cell")?;
        let refuse = |at: std::ops::Range<usize>, title: &str| Err(Diagnostic::new(at, title));
        let is_line = lattice == RepeatName::Line;
        let axis = match &params.axis {
            None if is_line => Vec3::x(),
            axis => axis_vector(axis.as_ref())?,
        };
        if let Some(given) = &params.axis
            && (lattice == RepeatName::Cubic
                || self.dimension == 2
                    && if is_line {
                        axis.z != 0.0
                    } else {
                        axis.z.abs() != 1.0
                    })
        {
            return refuse(given.span(), "this lattice has no such `axis`");
        }
        if lattice == RepeatName::Cubic && self.dimension == 2 {
            return refuse(
                params.lattice.span(),
                "in two dimensions cubes are squares: \"square\"",
            );
        }
        let turn = onto(&axis);
        let [first, second] = [Vec3::x(), Vec3::y()].map(|way| turn * way * cell);
        let steps = match lattice {
            RepeatName::Line => vec![axis * cell],
            RepeatName::Square => vec![first, second],
            RepeatName::Hexagonal => {
                let aslant = first * 0.5 + second * (0.5 * 3.0_f64.sqrt());
                vec![first, aslant]
            }
            RepeatName::Cubic => [Vec3::x(), Vec3::y(), Vec3::z()]
                .map(|way| way * cell)
                .to_vec(),
        };
        let region = (
            self.point(Some(&params.lower), "lower")?,
            self.point(Some(&params.upper), "upper")?,
        );
        let unit = self.shape(&params.unit)?.solid(self.dimension);
        let units = Repeat::new(unit, steps, region)
            .map_err(|title| Diagnostic::new(table.span(), title))?;
        let place = Placement::at(Vec3::zeros());
        Ok(Shape::Solid(Solid::Repeat(Box::new(units), place)))
    }

    fn parts(&self, parts: &Parts) -> Result<Vec<Solid>, Diagnostic> {
        let list = parts.get_ref();
        if list.is_empty() || list.len() > MOST_SHAPES {
            let title = "one shape at least and 1000 at most go together";
            return Err(Diagnostic::new(parts.span(), title));
        }
        list.iter()
            .map(|part| Ok(self.shape(part)?.solid(self.dimension)))
            .collect()
    }

    /// A shape turned, and then moved.
    pub(super) fn moved(&self, params: &ShapeParams, shape: &Shape) -> Result<Shape, Diagnostic> {
        let mut solid = shape.solid(self.dimension);
        for (turn, about) in turns(self, params.turn.as_ref(), shape.centre())? {
            solid.rotate(&turn, &about);
        }
        if params.shift.is_some() {
            solid.translate(&self.point(params.shift.as_ref(), "shift")?);
        }
        Ok(Shape::Solid(solid))
    }
}

/// Turns in their order, each with a point (m) that it is about; the middle (m) if none is stated.
pub(super) fn turns(
    shapes: &Shapes,
    params: Option<&Spanned<TurnsParams>>,
    middle: Vec3,
) -> Result<Vec<(nalgebra::Matrix3<f64>, Vec3)>, Diagnostic> {
    let turns: &[TurnsTable] = match params.map(Spanned::get_ref) {
        None => &[],
        Some(TurnsParams::One(turn)) => std::slice::from_ref(turn),
        Some(TurnsParams::Many(turns)) => turns,
    };
    let one = |turn: &TurnsTable| {
        let axis = axis_vector(Some(&turn.axis))?;
        if shapes.dimension < 2 || (shapes.dimension == 2 && axis.z.abs() != 1.0) {
            let title = match shapes.dimension {
                1 => "in one dimension nothing turns",
                _ => "in two dimensions a shape turns about z alone",
            };
            return Err(Diagnostic::new(turn.axis.span(), title));
        }
        let about = match &turn.about {
            Some(_) => shapes.point(turn.about.as_ref(), "about")?,
            None => middle,
        };
        Ok((rotation(&axis, turn.angle.get_ref().si), about))
    };
    turns.iter().map(one).collect()
}

/// Shapes that go together.
type Parts = Spanned<Vec<Spanned<ShapeParams>>>;
