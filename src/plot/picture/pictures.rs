//! From a request to pictures: sections of some snapshots with one plane, view and colours.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::bar::ColourBar;
use super::cells::Cell;
use super::figure::Figure;
use super::section::{self, Cut, DrawnAs, Section};
use super::sheet::Colours;
use super::titles::Titles;
use super::view::View;
use crate::PlotError;
use crate::canvas::Canvas;
use crate::colour::Scale;
use crate::file;
use crate::sequence::Sequence;
use crate::snapshots::bodies::Bodies;
use crate::snapshots::field::Drawn;
use crate::snapshots::plane::Plane;
use crate::snapshots::slice::{position_text, quantity, thickness};
use crate::snapshots::snapshot::Snapshot;
use crate::snapshots::source::Source;
use crate::style::default_width;
use model::Axis;
use results::Opener;

/// A request for pictures, as typed.
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
    /// `true` to reflect at planes of symmetry.
    pub mirror: bool,
    /// `LOW:HIGH` of the colours; all values if absent.
    pub range: Option<String>,
    /// `LEFT:RIGHT,BOTTOM:TOP`; everything if absent.
    pub view: Option<String>,
}

/// Sections of some snapshots that share plane, view and colours.
#[derive(Debug)]
pub struct Pictures {
    pub(super) titles: Titles,
    /// Names of the bodies by their numbers in the pictures.
    pub(super) bodies: Vec<String>,
    pub(super) cut: Cut,
    section_text: String,
    sections: Vec<Section>,
    colours: Colours,
    view: View,
    /// Numbers of the bodies in any of several sections, which then have one legend.
    seen: Option<Vec<usize>>,
}

impl Pictures {
    /// Takes the sections of one or more snapshots of one or more runs; the first one decides the
    /// plane.
    ///
    /// # Errors
    /// Any [`PlotError`] but those of writing: a snapshot that cannot be read, a request that
    /// cannot be understood, or a plane that misses all particles.
    pub fn new(
        opener: &dyn Opener,
        sources: &[Source],
        request: &Request,
    ) -> Result<Self, PlotError> {
        let paths: Vec<&PathBuf> = sources.iter().flat_map(|s| &s.snapshots).collect();
        let path = paths
            .first()
            .ok_or(PlotError::Options("no snapshot to draw"))?;
        let first = Snapshot::open(opener, path)?;
        let thickness = request.thickness.as_deref().map(thickness).transpose()?;
        let cut = Cut {
            plane: match request.section.as_deref() {
                Some(text) => Plane::parse(text, &first)?,
                None => Plane::best(&first)?,
            },
            drawn_as: drawn_as(request)?,
            thickness,
            mirror: request.mirror,
            drawn: Drawn::find(&first, request.field.as_deref().unwrap_or("body"))?,
        };
        let range = cut.drawn.range(request.range.as_deref())?;
        let view = request.view.as_deref().map(View::parse).transpose()?;

        let mut sections = Vec::with_capacity(paths.len());
        let mut bodies = Bodies::default();
        for path in &paths {
            let snapshot = Snapshot::open(opener, path)?;
            let numbers = bodies.add(&snapshot);
            sections.push(cut.take(&snapshot, &numbers)?);
        }
        let mut cells = sections.iter().flat_map(|section| &section.cells);
        if !cells.any(Cell::is_cut) {
            return Err(cut.miss(&first));
        }
        // As it is drawn, for tables and the legend too.
        let view = view.unwrap_or_else(|| section::view(&sections)).drawn();
        Ok(Self {
            section_text: section_text(&cut, &first),
            colours: colours(&cut.drawn, &bodies.names, &sections, range),
            bodies: bodies.names,
            seen: (sections.len() > 1).then(|| section::bodies(&sections, &view)),
            view,
            titles: Titles::new(
                first.title,
                sources,
                &sections.iter().map(|s| s.time).collect::<Vec<_>>(),
            ),
            cut,
            sections,
        })
    }

    /// The plane of the sections, as a [`Request`] has it.
    #[must_use]
    pub fn section(&self) -> String {
        let plane = &self.cut.plane;
        format!("{}={:e}m", plane.axis.name(), plane.position)
    }

    /// Some sections as one figure without words.
    pub(super) fn figure_of(&self, chosen: Range<usize>, width: Option<u32>) -> Figure<'_> {
        let width = width.unwrap_or(default_width(chosen.len()));
        self.figure(chosen, "", &[], width)
    }

    fn figure<'a>(
        &'a self,
        chosen: Range<usize>,
        subtitle: &'a str,
        headings: &'a [String],
        width: u32,
    ) -> Figure<'a> {
        Figure {
            title: &self.titles.title,
            subtitle,
            sections: &self.sections[chosen],
            seen: self.seen.as_deref().filter(|_| headings.is_empty()),
            headings,
            axes: self.cut.plane.picture_axes().map(Axis::name),
            drawn_as: self.cut.drawn_as,
            colours: &self.colours,
            view: self.view,
            width,
        }
    }
}

impl Sequence for Pictures {
    fn titles(&self) -> &Titles {
        &self.titles
    }

    /// The sections; nothing for flat models.
    fn caption(&self) -> &str {
        &self.section_text
    }

    fn draw(
        &self,
        chosen: Range<usize>,
        subtitle: &str,
        headings: &[String],
        width: u32,
    ) -> Result<Canvas, PlotError> {
        self.figure(chosen, subtitle, headings, width).draw()
    }

    fn save_table(
        &self,
        chosen: Range<usize>,
        width: Option<u32>,
        path: &Path,
    ) -> Result<(), PlotError> {
        file::save_by(path, |file| {
            let written = self.write_table(chosen, width, file);
            written.map_err(|error| PlotError::unsaved(path, error))
        })
    }
}

/// The position of a section, in units that suit the positions and the particle spacing.
fn section_text(cut: &Cut, snapshot: &Snapshot) -> String {
    let position_text =
        |axis: Axis, position: f64| position_text(axis.name(), position, snapshot.finest());
    let length = |length: f64| quantity(length, snapshot.finest());
    cut.caption(snapshot, position_text, length)
}

/// The value of `--as`, or without it that of `--thickness`.
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

fn colours(
    drawn: &Drawn,
    bodies: &[String],
    sections: &[Section],
    range: Option<[f64; 2]>,
) -> Colours {
    match drawn {
        Drawn::Body => Colours::Bodies(bodies.to_vec()),
        Drawn::Field(field) => {
            let values = || {
                let cells = sections.iter().flat_map(|s| &s.cells);
                cells
                    .filter(|cell| cell.is_cut())
                    .filter_map(|cell| cell.value)
            };
            let scale = Scale::new(values(), range);
            let lost = values().any(|value| !value.is_finite());
            Colours::Bar(ColourBar::new(scale, &field.label, &field.unit, lost))
        }
    }
}
