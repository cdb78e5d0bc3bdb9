//! Shapes in metres.

use toml::Spanned;

use crate::input::quantity::{Extent, Placed};
use crate::input::schema::{BoxParams, CylinderParams, Point, ShapeParams, SphereParams};
use crate::input::source::Diagnostic;
use crate::model::{Axis, Shape, Vec3};

/// What the shape of one body is read with.
pub struct Shapes {
    pub dimension: usize,
    /// The body's particle spacing (m).
    pub spacing: f64,
}

/// A vector with the wrong number of components.
fn wrong_length<T>(key: &str, vector: &Spanned<Vec<T>>, dimension: usize) -> Diagnostic {
    let found = vector.get_ref().len();
    let s = if dimension == 1 { "" } else { "s" };
    let title = format!("`{key}` must have {dimension} component{s}, found {found}");
    Diagnostic::new(vector.span(), title)
}

/// The components of a vector in SI units; zero if absent.
pub fn vector<K>(
    key: &str,
    params: Option<&Spanned<Vec<Placed<K>>>>,
    dimension: usize,
) -> Result<[f64; 3], Diagnostic> {
    let mut vector = [0.0; 3];
    if let Some(params) = params {
        if params.get_ref().len() != dimension {
            return Err(wrong_length(key, params, dimension));
        }
        for (component, value) in vector.iter_mut().zip(params.get_ref()) {
            *component = value.get_ref().si;
        }
    }
    Ok(vector)
}

impl Shapes {
    /// The shape of a body, before `touch`.
    pub fn shape(&self, table: &Spanned<ShapeParams>) -> Result<Shape, Diagnostic> {
        let ShapeParams {
            r#box,
            sphere,
            cylinder,
        } = table.get_ref();
        match (r#box, sphere, cylinder) {
            (Some(params), None, None) => self.cuboid(params),
            (None, Some(params), None) if self.dimension > 1 => self.sphere(params.get_ref()),
            (None, None, Some(params)) if self.dimension > 2 => self.cylinder(params.get_ref()),
            (None, Some(params), None) => Err(self.unfit(params, "sphere", "a box")),
            (None, None, Some(params)) => Err(self.unfit(
                params,
                "cylinder",
                if self.dimension == 1 {
                    "a box"
                } else {
                    "a sphere, which is a disc,"
                },
            )),
            _ => Err(Diagnostic::new(
                table.span(),
                "`shape` must have exactly one of `box`, `sphere`, `cylinder`",
            )),
        }
    }

    fn unfit<T>(&self, table: &Spanned<T>, shape: &str, other: &str) -> Diagnostic {
        let title = format!("a {}-dimensional case has no {shape}", self.dimension);
        Diagnostic::new(table.span(), title).help(format!("take {other} instead"))
    }

    fn cuboid(&self, table: &Spanned<BoxParams>) -> Result<Shape, Diagnostic> {
        let BoxParams {
            lower,
            upper,
            centre,
            size,
        } = table.get_ref();
        let (lower, upper, at) = match (lower, upper, size) {
            (Some(lower), Some(upper), None) if centre.is_none() => (
                self.point(Some(lower), "lower")?,
                self.point(Some(upper), "upper")?,
                upper.span(),
            ),
            (None, None, Some(size)) => {
                let centre = self.point(centre.as_ref(), "centre")?;
                let half = self.point(Some(size), "size")? * 0.5;
                (centre - half, centre + half, size.span())
            }
            _ => {
                let title = "a box must have `lower` and `upper`, or `size` and perhaps `centre`";
                return Err(Diagnostic::new(table.span(), title));
            }
        };
        if (0..self.dimension).all(|a| lower[a] < upper[a]) {
            return Ok(Shape::Box { lower, upper });
        }
        Err(Diagnostic::new(at, "every edge of a box must be positive"))
    }

    fn sphere(&self, params: &SphereParams) -> Result<Shape, Diagnostic> {
        let centre = self.point(params.centre.as_ref(), "centre")?;
        let radius = self.positive(&params.radius, "radius")?;
        let Some(inner) = &params.inner_radius else {
            return Ok(Shape::Sphere { centre, radius });
        };
        let inner_radius = self.positive(inner, "inner_radius")?;
        if inner_radius < radius {
            return Ok(Shape::Shell {
                centre,
                radius,
                inner_radius,
            });
        }
        let title = "`inner_radius` must be smaller than `radius`";
        Err(Diagnostic::new(inner.span(), title))
    }

    fn cylinder(&self, params: &CylinderParams) -> Result<Shape, Diagnostic> {
        let axis = params.axis.as_ref();
        Ok(Shape::Cylinder {
            centre: self.point(params.centre.as_ref(), "centre")?,
            axis: axis.map_or(Ok(Axis::Z), |name| super::axis(name, self.dimension))?,
            radius: self.positive(&params.radius, "radius")?,
            length: self.positive(&params.length, "length")?,
        })
    }

    fn positive(&self, value: &Spanned<Extent>, key: &str) -> Result<f64, Diagnostic> {
        let metres = value.get_ref().metres(self.spacing);
        if metres > 0.0 {
            return Ok(metres);
        }
        Err(Diagnostic::new(
            value.span(),
            format!("`{key}` must be positive"),
        ))
    }

    /// A point; the origin if absent.
    fn point(&self, value: Option<&Point>, key: &str) -> Result<Vec3, Diagnostic> {
        let mut point = Vec3::zeros();
        if let Some(value) = value {
            if value.get_ref().len() != self.dimension {
                return Err(wrong_length(key, value, self.dimension));
            }
            for (component, extent) in point.iter_mut().zip(value.get_ref()) {
                *component = extent.get_ref().metres(self.spacing);
            }
        }
        Ok(point)
    }
}
