//! Shapes in metres.

use std::ops::Range;
use std::path::Path;

use toml::Spanned;

use super::check::{outer_radius, radius};
use crate::input::quantity::{Extent, Placed};
use crate::input::schema::{
    AxisParams, BoxParams, CylinderParams, Point, ShapeParams, SphereParams,
};
use crate::input::source::Diagnostic;
use model::{Axis, Placement, Polygon, Primitive, Shape, Solid, Vec3, rotation};

/// Inputs of the reading of the shape of one body.
pub struct Shapes<'a> {
    pub dimension: usize,
    /// The body's particle spacing (m).
    pub spacing: f64,
    /// Folder of the files that the case names.
    pub folder: &'a Path,
}

/// A radius as it is typed, and the diameter that may stand in its place.
type Typed<'a> = [&'a Option<Spanned<Extent>>; 2];

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

/// The unit vector along an axis.
pub fn unit(axis: Axis) -> [f64; 3] {
    Axis::ALL.map(|other| f64::from(u8::from(other == axis)))
}

/// A unit vector; z if absent.
pub fn axis_vector(axis: Option<&Spanned<AxisParams>>) -> Result<Vec3, Diagnostic> {
    let Some(params) = axis else {
        return Ok(Vec3::z());
    };
    match params.get_ref() {
        AxisParams::Word(word) => {
            let (axis, sense) = word.sense();
            let mut unit = Vec3::zeros();
            unit[axis] = sense;
            Ok(unit)
        }
        AxisParams::Vector(vector) => match normalised("axis", vector, 3) {
            Ok(unit) => Ok(unit.into()),
            Err(title) => Err(Diagnostic::new(params.span(), title)),
        },
    }
}

/// A vector as long as one, or what is wrong with it.
pub fn normalised(key: &str, vector: &[f64], dimension: usize) -> Result<[f64; 3], String> {
    if vector.len() != dimension {
        return Err(format!(
            "`{key}` must have {dimension} components, found {}",
            vector.len()
        ));
    }
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    if !(length > 0.0 && length.is_finite()) {
        return Err(format!("`{key}` must be a vector of some length"));
    }
    let mut unit = [0.0; 3];
    for (component, x) in unit.iter_mut().zip(vector) {
        *component = x / length;
    }
    Ok(unit)
}

/// A form about z in its place: turned so that its axis points along a unit vector.
pub fn placed(form: Primitive, axis: &Vec3, centre: Vec3) -> Shape {
    let place = Placement::turned(onto(axis), centre);
    Shape::Solid(Solid::Primitive(form, place))
}

/// The matrix that turns z into a unit vector.
pub(super) fn onto(axis: &Vec3) -> nalgebra::Matrix3<f64> {
    let along = Axis::ALL.into_iter().find(|a| axis[a.index()].abs() == 1.0);
    let Some(along) = along else {
        let across = Vec3::z().cross(axis);
        return rotation(&across, libm::acos(axis.z.clamp(-1.0, 1.0)));
    };
    let onto = Shape::onto(along);
    if axis[along.index()] > 0.0 {
        return onto;
    }
    onto * nalgebra::Matrix3::from_diagonal(&Vec3::new(1.0, -1.0, -1.0))
}

impl Shapes<'_> {
    /// The shape of a body, before `touch`.
    pub fn shape(&self, table: &Spanned<ShapeParams>) -> Result<Shape, Diagnostic> {
        let params = table.get_ref();
        let shape = self.form(table)?;
        if params.turn.is_none() && params.shift.is_none() {
            return Ok(shape);
        }
        self.moved(params, &shape)
    }

    /// The form of a shape, before it is turned and moved.
    fn form(&self, table: &Spanned<ShapeParams>) -> Result<Shape, Diagnostic> {
        let mut forms: Vec<Result<Shape, Diagnostic>> = Vec::new();
        macro_rules! take {
            ($($key:ident: $least:literal $other:literal $method:ident;)+) => { $(
                if let Some(params) = &table.get_ref().$key {
                    forms.push(if self.dimension < $least {
                        Err(self.unfit(params, stringify!($key).trim_start_matches("r#"), $other))
                    } else {
                        self.$method(params)
                    });
                }
            )+ };
        }
        take! {
            r#box: 1 "" cuboid;
            sphere: 2 "a box" sphere;
            cylinder: 3 "a sphere, which is a disc in two dimensions," cylinder;
            ellipsoid: 2 "a box" ellipsoid;
            cone: 3 "a prism, which is a polygon in two dimensions," cone;
            ogive: 3 "a prism, which is a polygon in two dimensions," ogive;
            torus: 3 "a sphere with an `inner_radius`, which is a ring in two dimensions," torus;
            prism: 2 "a box" prism;
            stl: 3 "a prism, which is a polygon in two dimensions," stl;
            obj: 3 "a prism, which is a polygon in two dimensions," obj;
            union: 2 "a box" union;
            intersection: 2 "a box" intersection;
            difference: 2 "a box" difference;
            repeat: 2 "a box" repeat;
        }
        let mut forms = forms.into_iter();
        match (forms.next(), forms.next()) {
            (Some(form), None) => form,
            _ => Err(Diagnostic::new(
                table.span(),
                "`shape` must have exactly one of `box`, `sphere`, `cylinder`, `ellipsoid`, `cone`, \
                 `ogive`, `torus`, `prism`, `stl`, `obj`, `union`, `intersection`, `difference`, `repeat`",
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

    fn sphere(&self, table: &Spanned<SphereParams>) -> Result<Shape, Diagnostic> {
        let params = table.get_ref();
        let centre = self.point(params.centre.as_ref(), "centre")?;
        let radius = self.outer_radius([&params.radius, &params.diameter], &table.span())?;
        let inner = [&params.inner_radius, &params.inner_diameter];
        let Some(inner_radius) = self.bore(inner, radius, &table.span())? else {
            return Ok(Shape::Sphere { centre, radius });
        };
        Ok(Shape::Shell {
            centre,
            radius,
            inner_radius,
        })
    }

    /// The radius of a hole, smaller than that of what it is in.
    fn bore(
        &self,
        inner: Typed<'_>,
        radius: f64,
        table: &Range<usize>,
    ) -> Result<Option<f64>, Diagnostic> {
        let inner_radius = self.radius(inner, ["inner_radius", "inner_diameter"], table)?;
        if inner_radius.is_none_or(|inner| inner < radius) {
            return Ok(inner_radius);
        }
        let title = "`inner_radius` must be smaller than `radius`";
        let at = inner[0].as_ref().or(inner[1].as_ref());
        Err(Diagnostic::new(
            at.map_or(table.clone(), Spanned::span),
            title,
        ))
    }

    /// The radius of a shape, which must have one.
    pub(super) fn outer_radius(
        &self,
        typed: Typed<'_>,
        table: &Range<usize>,
    ) -> Result<f64, Diagnostic> {
        outer_radius(self.lengths(typed, ["radius", "diameter"])?, table)
    }

    /// A radius (m) of two keys.
    pub(super) fn radius(
        &self,
        typed: Typed<'_>,
        keys: [&str; 2],
        table: &Range<usize>,
    ) -> Result<Option<f64>, Diagnostic> {
        radius(self.lengths(typed, keys)?, keys, table)
    }

    /// The lengths (m) of two keys, of those that are typed.
    fn lengths(&self, typed: Typed<'_>, keys: [&str; 2]) -> Result<[Option<f64>; 2], Diagnostic> {
        let mut values = [None; 2];
        for ((value, typed), key) in values.iter_mut().zip(typed).zip(keys) {
            let typed = typed.as_ref();
            *value = typed.map(|typed| self.positive(typed, key)).transpose()?;
        }
        Ok(values)
    }

    fn cylinder(&self, table: &Spanned<CylinderParams>) -> Result<Shape, Diagnostic> {
        let params = table.get_ref();
        let centre = self.point(params.centre.as_ref(), "centre")?;
        let radius = self.outer_radius([&params.radius, &params.diameter], &table.span())?;
        let length = self.positive(&params.length, "length")?;
        let inner = [&params.inner_radius, &params.inner_diameter];
        let bore = self.bore(inner, radius, &table.span())?;
        let axis = axis_vector(params.axis.as_ref())?;
        let along = Axis::ALL.into_iter().find(|a| axis[a.index()].abs() == 1.0);
        if let (None, Some(axis)) = (bore, along) {
            return Ok(Shape::Cylinder {
                centre,
                axis,
                radius,
                length,
            });
        }
        let (inner, half) = (bore.unwrap_or(0.0), 0.5 * length);
        let outline = vec![
            [inner, -half],
            [radius, -half],
            [radius, half],
            [inner, half],
        ];
        let profile = Polygon::new(outline).expect("a rectangle");
        Ok(placed(Primitive::Revolved(profile), &axis, centre))
    }

    pub(super) fn positive(&self, value: &Spanned<Extent>, key: &str) -> Result<f64, Diagnostic> {
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
    pub(super) fn point(&self, value: Option<&Point>, key: &str) -> Result<Vec3, Diagnostic> {
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
