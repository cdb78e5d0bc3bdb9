//! The columns of particles, by the names that files and plots know.

use super::ExportError;
use files::output::h5::{Array, Content, Element, RowType};
use plot::{Drawn, SYMMETRIC, Snapshot, TENSOR, VECTOR};

/// Group of a snapshot's particle fields.
const FIELDS: &str = "/VTKHDF/PointData";
/// Particles' places.
const POINTS: &str = "/VTKHDF/Points";
/// Components of rows that are neither a vector nor a tensor.
const NUMBERED: [&str; 9] = ["1", "2", "3", "4", "5", "6", "7", "8", "9"];
/// Fields that each file has where the snapshot does.
const ALWAYS: [&str; 2] = ["id", "body"];

/// A column, or several of one name.
#[derive(Debug, Clone)]
pub struct Column {
    /// Its name, as in `velocity`.
    pub name: String,
    /// Names of its components; of a single one empty.
    pub components: &'static [&'static str],
    /// Type of its values.
    pub element: Element,
    /// SI unit; empty for none.
    pub unit: String,
    /// One sentence.
    pub description: String,
    /// Its source.
    pub source: Source,
}

/// The source of a column.
#[derive(Debug, Clone)]
pub enum Source {
    /// A dataset of the snapshot.
    Stored { path: String, row: RowType },
    /// Particles' places.
    Position(RowType),
    /// Made from datasets, component by component, as plots do.
    Made(Vec<Drawn>),
    /// Half of the size of the cell that each particle fills.
    Radius,
    /// Its way from where it was at the start.
    Displacement,
    /// The number of an image.
    Image,
}

impl Column {
    /// Names of its components as columns of a table: `x`, `velocity_x`, `pressure`.
    pub fn names(&self) -> Vec<String> {
        let name = |component: &&str| match (&self.source, *component) {
            (_, "") => self.name.clone(),
            (Source::Position(_), component) => component.to_owned(),
            (_, component) => format!("{}_{component}", self.name),
        };
        self.components.iter().map(name).collect()
    }

    /// The positions of particles.
    pub fn positions(content: &Content) -> Result<Self, ExportError> {
        let array = content.array(POINTS)?;
        Ok(Self {
            name: "position".to_owned(),
            components: &VECTOR,
            element: array.row.element,
            unit: "m".to_owned(),
            description: "Position.".to_owned(),
            source: Source::Position(array.row),
        })
    }

    /// The radii of particles.
    pub fn radius() -> Self {
        let description = "Half the edge of the cell that the particle fills now.";
        Self::made("radius", &[""], "m", description, Source::Radius)
    }

    /// The image that a row belongs to.
    pub fn image() -> Self {
        let description =
            "Planes that it is an image behind: the sum of 1 (normal to x), 2 (y), 4 (z).";
        Self {
            element: Element::U8,
            ..Self::made("image", &[""], "", description, Source::Image)
        }
    }

    fn made(
        name: &str,
        components: &'static [&'static str],
        unit: &str,
        description: &str,
        source: Source,
    ) -> Self {
        Self {
            name: tidy(name),
            components,
            element: Element::F64,
            unit: unit.to_owned(),
            description: description.to_owned(),
            source,
        }
    }

    fn stored(array: &Array) -> Self {
        Self {
            name: tidy(&array.name),
            components: components(array.row.components),
            element: array.row.element,
            unit: array.unit.clone(),
            description: array.description.clone(),
            source: Source::Stored {
                path: format!("{FIELDS}/{}", array.name),
                row: array.row,
            },
        }
    }
}

/// The columns of these names, or of all fields of a snapshot: first what each file has.
pub fn columns(
    snapshot: &Snapshot,
    content: &Content,
    names: &[String],
) -> Result<Vec<Column>, ExportError> {
    let stored = snapshot.file.names()?;
    let always = ALWAYS.iter().map(|name| (*name).to_owned());
    let always = always.filter(|name| stored.contains(name));
    let all = if names.is_empty() { &stored } else { names };
    let mut columns: Vec<Column> = Vec::new();
    for name in always.chain(all.iter().cloned()) {
        let column = if stored.contains(&name) {
            // `true` if its rows are those of the points.
            snapshot.file.components(&name)?;
            Column::stored(&content.array(&format!("{FIELDS}/{name}"))?)
        } else {
            derived(snapshot, &name)?
        };
        if !columns.iter().any(|other| other.name == column.name) {
            columns.push(column);
        }
    }
    Ok(columns)
}

/// A column that is made from what the snapshot holds.
fn derived(snapshot: &Snapshot, name: &str) -> Result<Column, ExportError> {
    match name {
        "radius" => return Ok(Column::radius()),
        "displacement" => {
            let description = "Position less that of the same particle at the start of the run.";
            let source = Source::Displacement;
            return Ok(Column::made(name, &VECTOR, "m", description, source));
        }
        _ => {}
    }
    let whole = ["stress", "material_stress"].contains(&name);
    let parts: &'static [&'static str] = if whole { &SYMMETRIC } else { &[""] };
    let find = |part: &&str| {
        let name = if whole {
            format!("{name}.{part}")
        } else {
            name.to_owned()
        };
        Drawn::find(snapshot, &name)
    };
    let drawn = parts.iter().map(find).collect::<Result<Vec<_>, _>>()?;
    let (unit, label) = match drawn.first() {
        Some(Drawn::Field(field)) => (field.unit.clone(), field.label.clone()),
        _ => (String::new(), String::new()),
    };
    let label = if whole { name.replace('_', " ") } else { label };
    let description = format!("Made from the snapshot's fields: {label}.");
    Ok(Column::made(
        name,
        parts,
        &unit,
        &description,
        Source::Made(drawn),
    ))
}

fn components(count: usize) -> &'static [&'static str] {
    match count {
        1 => &[""],
        3 => &VECTOR,
        6 => &SYMMETRIC,
        9 => &TENSOR,
        _ => &NUMBERED[..count.min(NUMBERED.len())],
    }
}

/// A name of letters, digits and `_` alone, which every format can have.
fn tidy(name: &str) -> String {
    let sound = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    name.chars().map(sound).collect()
}
