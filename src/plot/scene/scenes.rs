//! From a request to pictures: views of some snapshots with one camera, frame and colours.

use std::ops::Range;

use super::buffer::Seen;
use super::camera::Camera;
use super::cut::Cuts;
use super::render::{MOST_PIXELS, RADIUS, Stage};
use super::survey::{Numbered, Survey};
use super::triad;
use crate::PlotError;
use crate::canvas::{Canvas, Frame, Rgb};
use crate::colour;
use crate::length_bar;
use crate::picture::bar::ColourBar;
use crate::picture::layout::Layout;
use crate::picture::sheet::{Colours, Sheet};
use crate::picture::titles::Titles;
use crate::picture::view::View;
use crate::sequence::Sequence;
use crate::snapshots::bodies::Bodies;
use crate::snapshots::field::Drawn;
use crate::snapshots::grains::Selection;
use crate::snapshots::snapshot::Snapshot;
use crate::snapshots::source::Source;
use crate::style::whole;
use results::Opener;

/// A request for views, as typed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SceneRequest {
    /// From where: a name or `AZIMUTH,ELEVATION`.
    pub from: String,
    /// `LEFT:RIGHT,BOTTOM:TOP` of the picture's plane; everything if absent.
    pub part: Option<String>,
    /// `body`, a field, `FIELD.COMPONENT` or `von_mises`; bodies if absent.
    pub field: Option<String>,
    /// `LOW:HIGH` of the colours; all values if absent.
    pub range: Option<String>,
    /// `true` to reflect at planes of symmetry.
    pub mirror: bool,
    /// Planes that open the model; if there are none, planes of symmetry where it is mirrored.
    pub cuts: Vec<String>,
    /// Bodies that are drawn; all if there are none.
    pub bodies: Vec<String>,
    /// Bodies that let others be seen through them.
    pub transparent: Vec<String>,
}

/// The message for a flat model.
const FLAT: &str =
    "a view needs a model of three dimensions: a flat one is drawn as it is, without a view";

/// Views of some snapshots.
#[derive(Debug)]
pub struct Scenes {
    opener: &'static dyn Opener,
    titles: Titles,
    selection: Selection,
    camera: Camera,
    cuts: Cuts,
    transparent: Vec<usize>,
    caption: String,
    colours: Colours,
    view: View,
    depth: f64,
    /// Numbers of the bodies that there are to see.
    seen: Vec<usize>,
    /// Each snapshot, with the numbers of its bodies.
    snapshots: Vec<Numbered>,
}

impl Scenes {
    /// Looks at one or more snapshots of one or more runs; the first one decides the planes.
    ///
    /// # Errors
    /// Any [`PlotError`] but those of writing: a snapshot that cannot be read, a request that
    /// cannot be understood, a flat model, or nothing to see.
    pub fn new(
        opener: &'static dyn Opener,
        sources: &[Source],
        request: &SceneRequest,
    ) -> Result<Self, PlotError> {
        let mut paths = sources.iter().flat_map(|s| &s.snapshots);
        let path = paths
            .next()
            .ok_or(PlotError::Options("no snapshot to draw"))?;
        let first = Snapshot::open(opener, path)?;
        let camera = Camera::parse(&request.from)?;
        let cuts = if request.cuts.is_empty() && request.mirror {
            Cuts::open(&camera, &first)
        } else {
            Cuts::parse(&request.cuts, &camera, &first)?
        };
        let drawn = Drawn::find(&first, request.field.as_deref().unwrap_or("body"))?;
        let range = drawn.range(request.range.as_deref())?;
        let part = request.part.as_deref().map(View::parse).transpose()?;

        let mut selection = Selection {
            bodies: Bodies::new(&request.bodies),
            drawn,
            mirror: request.mirror,
        };
        let mut survey = Survey::new(RADIUS);
        survey.look(opener, sources, &mut selection, &camera, &cuts, FLAT)?;
        let view = survey.view().ok_or(PlotError::Options(
            "there is nothing to see: choose another --cut, or other --bodies",
        ))?;
        Ok(Self {
            opener,
            titles: Titles::new(first.title.clone(), sources, &survey.times),
            transparent: selection.bodies.numbers(&request.transparent)?,
            caption: caption(&camera, &cuts, &selection, &first),
            colours: match &selection.drawn {
                Drawn::Body => Colours::Bodies(selection.bodies.names.clone()),
                Drawn::Field(field) => {
                    let scale = survey.values.scale(range);
                    let lost = survey.values.lost;
                    Colours::Bar(ColourBar::new(scale, &field.label, &field.unit, lost))
                }
            },
            view: part.unwrap_or(view),
            depth: survey.depth(),
            seen: survey.bodies(),
            selection,
            camera,
            cuts,
            snapshots: survey.snapshots,
        })
    }

    /// Directions of the axes, and a length, below the panels.
    fn draw_scale(&self, canvas: &mut Canvas, layout: &Layout) {
        let (style, first) = (layout.style, layout.frames[0]);
        let bottom = layout.frames.iter().map(Frame::bottom).fold(0.0, f32::max);
        let middle = bottom + 0.5 * style.beneath();
        let at = first.left + 0.55 * style.beneath();
        triad::draw(canvas, style, (at, middle), &self.camera);
        let scale = f64::from(first.width) / layout.view.width();
        let at = (first.left + 1.3 * style.beneath(), middle);
        length_bar::draw(canvas, style, at, (scale, 0.3 * first.width));
    }

    fn colour(&self, seen: &Seen) -> Rgb {
        let body = usize::from(seen.body);
        match &self.colours {
            Colours::Bodies(_) => colour::body(body),
            Colours::Bar(_) if self.selection.bodies.rigid.get(body) == Some(&true) => {
                colour::RIGID
            }
            Colours::Bar(bar) => bar.scale.colour(f64::from(seen.value)),
        }
    }
}

impl Sequence for Scenes {
    fn titles(&self) -> &Titles {
        &self.titles
    }

    fn caption(&self) -> &str {
        &self.caption
    }

    fn draw(
        &self,
        chosen: Range<usize>,
        subtitle: &str,
        headings: &[String],
        width: u32,
    ) -> Result<Canvas, PlotError> {
        let sheet = Sheet {
            title: &self.titles.title,
            subtitle,
            headings,
            colours: &self.colours,
            width,
        };
        let snapshots = &self.snapshots[chosen];
        let count = snapshots.len();
        let layout = Layout::bare(sheet.style(count), width, count, self.view, sheet.has_bar());
        Canvas::fits(width, whole(layout.height))?;
        let size = layout.frames[0].pixels();
        if size[0] * size[1] > MOST_PIXELS {
            let height = whole(layout.height);
            return Err(PlotError::Size { width, height });
        }
        let stage = Stage {
            selection: &self.selection,
            camera: &self.camera,
            cuts: &self.cuts,
            transparent: &self.transparent,
            view: &layout.view,
            depth: self.depth,
        };
        let raster = |(path, numbers): &Numbered| {
            let snapshot = Snapshot::open(self.opener, path)?;
            stage.draw(&snapshot, numbers, size, |seen| self.colour(seen))
        };
        let rasters: Vec<Vec<Rgb>> = snapshots.iter().map(raster).collect::<Result<_, _>>()?;
        sheet.draw(layout, &self.seen, |canvas, layout, k| {
            canvas.image(&layout.frames[k], &rasters[k]);
            if k + 1 == count {
                self.draw_scale(canvas, layout);
            }
        })
    }
}

/// The viewpoint, the planes that cut and mirror, and the bodies that alone are drawn.
fn caption(camera: &Camera, cuts: &Cuts, selection: &Selection, snapshot: &Snapshot) -> String {
    let mut texts = vec![camera.name.clone(), cuts.caption(snapshot)];
    texts.push(selection.caption(snapshot));
    texts.retain(|text| !text.is_empty());
    texts.join(",  ")
}
