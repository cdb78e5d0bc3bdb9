//! From a request to pictures: sections of some snapshots with one plane, view and colours.

use std::ops::Range;
use std::path::PathBuf;

use super::bar::ColourBar;
use super::cells::Cell;
use super::figure::{Colours, Figure};
use super::section::{self, Cut, DrawnAs, Section};
use super::view::View;
use crate::model::Axis;
use crate::plot::PlotError;
use crate::plot::canvas::Canvas;
use crate::plot::colour::Scale;
use crate::plot::snapshots::field::Shown;
use crate::plot::snapshots::plane::Plane;
use crate::plot::snapshots::slice::{place, quantity, thickness};
use crate::plot::snapshots::snapshot::Snapshot;
use crate::plot::snapshots::source::Source;
use crate::plot::style::{PANELS_WIDTH, WIDTH};
use crate::plot::units::{self, Readable};

/// What to draw, as typed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Request {
    /// `body`, a field, `FIELD.COMPONENT` or `von_mises`; bodies if absent.
    pub field: Option<String>,
    /// `AXIS=POSITION` or `AXIS`; the best plane if absent.
    pub section: Option<String>,
    /// `cut` or `particles`; if absent a cut, or particles if there is a thickness.
    pub drawn_as: Option<String>,
    /// Thickness of the slice of particles; one spacing if absent.
    pub thickness: Option<String>,
    /// Whether to reflect at planes of symmetry.
    pub mirror: bool,
    /// `LOW:HIGH` of the colours; all values if absent.
    pub range: Option<String>,
    /// `LEFT:RIGHT,BOTTOM:TOP`; everything if absent.
    pub view: Option<String>,
}

/// Sections of some snapshots that share plane, view and colours.
#[derive(Debug)]
pub struct Pictures {
    title: String,
    /// Names of the runs that the snapshots belong to, if there are several.
    pub(super) names: Option<Vec<String>>,
    /// Names of the bodies by their numbers in the pictures.
    pub(super) bodies: Vec<String>,
    pub(super) cut: Cut,
    where_text: String,
    sections: Vec<Section>,
    colours: Colours,
    view: View,
}

impl Pictures {
    /// Takes the sections of one or more snapshots of one or more runs; the first one decides the
    /// plane.
    ///
    /// # Errors
    /// Any [`PlotError`] but those of writing: a snapshot that cannot be read, a request that
    /// cannot be understood, or a plane that misses all particles.
    pub fn new(sources: &[Source], request: &Request) -> Result<Self, PlotError> {
        let paths: Vec<&PathBuf> = sources.iter().flat_map(|s| &s.snapshots).collect();
        let path = paths
            .first()
            .ok_or(PlotError::Options("no snapshot to draw"))?;
        let first = Snapshot::open(path)?;
        let thickness = request.thickness.as_deref().map(thickness).transpose()?;
        let cut = Cut {
            plane: match request.section.as_deref() {
                Some(text) => Plane::parse(text, &first)?,
                None => Plane::best(&first)?,
            },
            drawn_as: drawn_as(request)?,
            thickness,
            mirror: request.mirror,
            shown: Shown::find(&first, request.field.as_deref().unwrap_or("body"))?,
        };
        let range = match (&request.range, &cut.shown) {
            (None, _) => None,
            (Some(text), Shown::Field(field)) => Some(units::parse_span(text, None, &field.unit)?),
            (Some(_), Shown::Body) => {
                return Err(PlotError::Options("--range needs a --field to colour by"));
            }
        };
        let view = request.view.as_deref().map(parse_view).transpose()?;

        let mut sections = Vec::with_capacity(paths.len());
        let mut bodies = Vec::new();
        for path in &paths {
            let snapshot = Snapshot::open(path)?;
            let numbers = numbers(&snapshot.bodies, &mut bodies);
            sections.push(cut.take(&snapshot, &numbers)?);
        }
        let mut cells = sections.iter().flat_map(|section| &section.cells);
        if !cells.any(Cell::is_cut) {
            return Err(cut.miss(&first));
        }
        Ok(Self {
            where_text: where_text(&cut, &first),
            colours: colours(&cut.shown, &bodies, &sections, range),
            bodies,
            view: view.unwrap_or_else(|| section::view(&sections)),
            names: (sources.len() > 1).then(|| {
                let names = sources
                    .iter()
                    .map(|s| vec![s.name.clone(); s.snapshots.len()]);
                names.flatten().collect()
            }),
            title: first.title,
            cut,
            sections,
        })
    }

    /// Where the sections are taken, as their pictures say it; nothing for flat models.
    #[must_use]
    pub fn place(&self) -> &str {
        &self.where_text
    }

    /// The picture of one snapshot, by its place among the paths, of a width in pixels.
    ///
    /// # Errors
    /// [`PlotError::Size`] if no such picture can be held.
    pub fn single(&self, index: usize, width: Option<u32>) -> Result<Canvas, PlotError> {
        let section = &self.sections[index..=index];
        let time = &self.times()[index];
        let subtitle = match self.where_text.as_str() {
            "" => format!("t = {time}"),
            place => format!("t = {time},  {place}"),
        };
        self.figure(section, subtitle, Vec::new(), width.unwrap_or(WIDTH))
            .draw()
    }

    /// One picture with a panel for each snapshot, of a width in pixels.
    ///
    /// # Errors
    /// [`PlotError::Size`] if no such picture can be held.
    pub fn panels(&self, width: Option<u32>) -> Result<Canvas, PlotError> {
        if self.sections.len() == 1 {
            return self.single(0, width);
        }
        let times = self.times();
        let heading = |(k, time): (usize, &String)| match &self.names {
            Some(names) => format!("{}, t = {time}", names[k]),
            None => format!("t = {time}"),
        };
        let headings = times.iter().enumerate().map(heading).collect();
        let width = width.unwrap_or(PANELS_WIDTH);
        self.figure(&self.sections, self.where_text.clone(), headings, width)
            .draw()
    }

    /// Some sections as one figure without words.
    pub(super) fn figure_of(&self, chosen: Range<usize>, width: Option<u32>) -> Figure<'_> {
        let usual = if chosen.len() > 1 {
            PANELS_WIDTH
        } else {
            WIDTH
        };
        let sections = &self.sections[chosen];
        self.figure(sections, String::new(), Vec::new(), width.unwrap_or(usual))
    }

    fn times(&self) -> Vec<String> {
        units::times(&self.sections.iter().map(|s| s.time).collect::<Vec<_>>())
    }

    fn figure<'a>(
        &'a self,
        sections: &'a [Section],
        subtitle: String,
        headings: Vec<String>,
        width: u32,
    ) -> Figure<'a> {
        Figure {
            title: &self.title,
            subtitle,
            sections,
            headings,
            axes: self.cut.plane.picture_axes().map(Axis::name),
            drawn_as: self.cut.drawn_as,
            colours: &self.colours,
            view: self.view,
            width,
        }
    }
}

/// Reads `LEFT:RIGHT,BOTTOM:TOP`; numbers without a unit take the last one's.
fn parse_view(text: &str) -> Result<View, PlotError> {
    let (x, y) = text.split_once(',').ok_or_else(|| {
        PlotError::quantity(text, "a view LEFT:RIGHT,BOTTOM:TOP, as in -1:1,0:2mm")
    })?;
    let unit = units::unit_behind(y.rsplit(':').next().unwrap_or_default());
    Ok(View {
        x: units::parse_span(x, Some(unit), "m")?,
        y: units::parse_span(y, None, "m")?,
    })
}

/// Where a section is taken, in units that suit the positions and the particle spacing.
fn where_text(cut: &Cut, snapshot: &Snapshot) -> String {
    let place = |axis: Axis, position: f64| place(axis.name(), position, snapshot.finest());
    let length = |length: f64| quantity(length, snapshot.finest());
    cut.caption(snapshot, place, length)
}

/// What `--as` says, and without it what `--thickness` asks for.
fn drawn_as(request: &Request) -> Result<DrawnAs, PlotError> {
    match (request.drawn_as.as_deref(), &request.thickness) {
        (None | Some("cut"), None) => Ok(DrawnAs::Cut),
        (None | Some("particles"), _) => Ok(DrawnAs::Particles),
        (Some("cut"), Some(_)) => Err(PlotError::Options(
            "a cut has no thickness: leave --thickness out, or draw the slice --as particles",
        )),
        (Some(other), _) => Err(PlotError::quantity(other, "cut or particles")),
    }
}

/// The numbers in the picture of a snapshot's bodies: those of the same name, of which `known`
/// takes up new ones.
fn numbers(bodies: &[String], known: &mut Vec<String>) -> Vec<usize> {
    let number = |name: &String| {
        known.iter().position(|n| n == name).unwrap_or_else(|| {
            known.push(name.clone());
            known.len() - 1
        })
    };
    bodies.iter().map(number).collect()
}

fn colours(
    shown: &Shown,
    bodies: &[String],
    sections: &[Section],
    range: Option<[f64; 2]>,
) -> Colours {
    match shown {
        Shown::Body => Colours::Bodies(bodies.to_vec()),
        Shown::Field(field) => {
            let values = || {
                let cells = sections.iter().flat_map(|s| &s.cells);
                cells
                    .filter(|cell| cell.is_cut())
                    .filter_map(|cell| cell.value)
            };
            let scale = Scale::new(values(), range);
            let unit = Readable::new(&field.unit, scale.high.abs().max(scale.low.abs()));
            let mut label = unit.label(&field.label);
            if values().any(|value| !value.is_finite()) {
                label += "; pink: not finite";
            }
            Colours::Bar(ColourBar { scale, unit, label })
        }
    }
}
