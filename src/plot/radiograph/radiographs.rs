//! From a request to pictures: radiographs of some snapshots with one frame and one scale.

use std::ops::Range;
use std::sync::OnceLock;

use super::spread::{Masses, REACH, Spot};
use crate::PlotError;
use crate::canvas::{Canvas, Rgb};
use crate::colour::Scale;
use crate::picture::bar::ColourBar;
use crate::picture::layout::Layout;
use crate::picture::sheet::{Colours, Sheet, draw_axes};
use crate::picture::titles::Titles;
use crate::picture::view::View;
use crate::scene::camera::Camera;
use crate::scene::cut::Cuts;
use crate::scene::survey::{Numbered, Survey};
use crate::sequence::Sequence;
use crate::snapshots::bodies::Bodies;
use crate::snapshots::field::Drawn;
use crate::snapshots::grains::{Selection, of_images};
use crate::snapshots::plane::Plane;
use crate::snapshots::sample::Sampled;
use crate::snapshots::snapshot::Snapshot;
use crate::snapshots::source::Source;
use crate::style::{Style, whole};
use crate::units::parse_span;
use model::Axis;
use results::Opener;

/// Unit of the drawn quantity.
const UNIT: &str = "kg/m^2";

/// The darkest colour is for this many times what a quarter of the pixels with matter fall short of: edges of plates
/// are black, as in a flash X-ray, and debris is seen.
const DARKEST: f64 = 8.0;

/// The message for a flat model.
const FLAT: &str = "a radiograph needs a model of three dimensions: this one has no depth";

/// A request for radiographs, as typed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RadiographRequest {
    /// Line of sight: `x`, `y` or `z`.
    pub along: String,
    /// `LEFT:RIGHT,BOTTOM:TOP`; everything if absent.
    pub part: Option<String>,
    /// `LOW:HIGH` of the colours; if absent from zero to the largest, or to less where most of the matter is thin.
    pub range: Option<String>,
    /// `true` to reflect at planes of symmetry.
    pub mirror: bool,
    /// Bodies that are drawn; all if there are none.
    pub bodies: Vec<String>,
}

/// Radiographs of some snapshots.
#[derive(Debug)]
pub struct Radiographs {
    opener: &'static dyn Opener,
    titles: Titles,
    selection: Selection,
    camera: Camera,
    axes: [&'static str; 2],
    caption: String,
    view: View,
    range: Option<[f64; 2]>,
    /// The meaning of colours, once a picture has been drawn: the same in all.
    colours: OnceLock<Colours>,
    /// Each snapshot, with the numbers of its bodies.
    snapshots: Vec<Numbered>,
}

impl Radiographs {
    /// Looks at one or more snapshots of one or more runs.
    ///
    /// # Errors
    /// Any [`PlotError`] but those of writing: a snapshot that cannot be read, a request that
    /// cannot be understood, a flat model, or nothing to see.
    pub fn new(
        opener: &'static dyn Opener,
        sources: &[Source],
        request: &RadiographRequest,
    ) -> Result<Self, PlotError> {
        let mut paths = sources.iter().flat_map(|s| &s.snapshots);
        let path = paths
            .next()
            .ok_or(PlotError::Options("no snapshot to draw"))?;
        let first = Snapshot::open(opener, path)?;
        let along = Axis::named(&request.along)
            .ok_or_else(|| PlotError::quantity(&request.along, "x, y or z"))?;
        let camera = Camera::parse(match along {
            Axis::X => "right",
            Axis::Y => "front",
            Axis::Z => "top",
        })?;
        let range = request.range.as_deref();
        let range = range.map(|text| parse_span(text, None, UNIT)).transpose()?;
        let part = request.part.as_deref().map(View::parse).transpose()?;
        let mut selection = Selection {
            bodies: Bodies::new(&request.bodies),
            drawn: Drawn::Body,
            mirror: request.mirror,
        };
        let mut survey = Survey::new(REACH);
        survey.look(
            opener,
            sources,
            &mut selection,
            &camera,
            &Cuts::default(),
            FLAT,
        )?;
        let view = survey
            .view()
            .ok_or(PlotError::Options("there is no matter to draw"))?;
        let mut caption = format!("radiograph along {}", request.along);
        let images = selection.caption(&first);
        if !images.is_empty() {
            caption = format!("{caption},  {images}");
        }
        let plane = Plane {
            axis: along,
            position: 0.0,
        };
        Ok(Self {
            opener,
            titles: Titles::new(first.title.clone(), sources, &survey.times),
            selection,
            camera,
            axes: plane.picture_axes().map(Axis::name),
            caption,
            view: part.unwrap_or(view),
            range,
            colours: OnceLock::new(),
            snapshots: survey.snapshots,
        })
    }

    /// The masses of the pixels of a panel.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read, [`PlotError::Snapshot`] if it has no
    /// masses.
    fn masses(&self, k: usize, size: [usize; 2], view: View) -> Result<Masses, PlotError> {
        let (path, numbers) = &self.snapshots[k];
        let snapshot = Snapshot::open(self.opener, path)?;
        let mirrors = self.selection.mirrors(&snapshot);
        let mut masses = Masses::new(size, view);
        for rows in snapshot.chunks() {
            let grains = self.selection.masses(&snapshot, numbers, rows)?;
            let spots = of_images(&grains, &mirrors, |grain, image| {
                let [right, up, _] = self.camera.project(&image.point);
                let shape = self.camera.shape(&image.shape);
                Some(Spot {
                    at: [right, up],
                    size: [0, 1].map(|axis| shape.size(axis)),
                    mass: grain.value,
                })
            });
            masses.add(&spots);
        }
        Ok(masses)
    }

    /// Mass per area of each pixel (kg/m²), row by row from the top, of a panel of columns and rows
    /// that holds the whole model.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read, [`PlotError::Snapshot`] if it has no
    /// masses.
    pub fn areal(&self, k: usize, size: [usize; 2]) -> Result<Vec<f64>, PlotError> {
        Ok(self.masses(k, size, self.view)?.areal())
    }

    /// Area of a pixel (m²) of such a panel.
    #[must_use]
    pub fn pixel_area(&self, size: [usize; 2]) -> f64 {
        Masses::new(size, self.view).area()
    }

    /// The meaning of colours: of all snapshots, of which those of `known` are drawn already.
    fn colours(
        &self,
        known: &[(usize, Vec<f64>)],
        draw: impl Fn(usize) -> Result<Vec<f64>, PlotError>,
    ) -> Result<&Colours, PlotError> {
        if let Some(colours) = self.colours.get() {
            return Ok(colours);
        }
        let mut sampled = Sampled::default();
        let mut add = |pixels: &[f64]| {
            let covered = pixels.iter().copied().filter(|&value| value > 0.0);
            sampled.extend(covered, pixels.len());
        };
        for k in 0..self.snapshots.len() {
            match known.iter().find(|(n, _)| *n == k) {
                Some((_, pixels)) => add(pixels),
                None => add(&draw(k)?),
            }
        }
        let all = sampled.scale(self.range);
        let [low, high] = self
            .range
            .unwrap_or_else(|| [0.0, darkest(&sampled, all.high)]);
        let scale = Scale::grey([low, high], all.above || high < all.high);
        let bar = ColourBar::new(scale, "mass per area", UNIT, false);
        Ok(self.colours.get_or_init(|| Colours::Bar(bar)))
    }
}

/// The value of black for masses per area of which all but a few are at most `high`.
fn darkest(covered: &Sampled, high: f64) -> f64 {
    high.min(DARKEST * covered.quantile(0.25))
}

impl Sequence for Radiographs {
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
        let count = chosen.len();
        let style = Style::of(width, count);
        let layout = Layout::new(style, width, count, self.view, true);
        Canvas::fits(width, whole(layout.height))?;
        let (size, view) = (layout.frames[0].pixels(), layout.view);
        let draw =
            |k: usize| -> Result<Vec<f64>, PlotError> { Ok(self.masses(k, size, view)?.areal()) };
        let rasters = chosen.map(|k| Ok((k, draw(k)?)));
        let rasters: Vec<(usize, Vec<f64>)> = rasters.collect::<Result<_, PlotError>>()?;
        let colours = self.colours(&rasters, draw)?;
        let sheet = Sheet {
            title: &self.titles.title,
            subtitle,
            headings,
            colours,
            width,
        };
        sheet.draw(layout, &[], |canvas, layout, k| {
            if let Colours::Bar(bar) = colours {
                let colour = |&value: &f64| bar.scale.colour(value);
                let pixels: Vec<Rgb> = rasters[k].1.iter().map(colour).collect();
                canvas.image(&layout.frames[k], &pixels);
            }
            draw_axes(canvas, layout, k, self.axes);
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(clippy::float_cmp, reason = "products of small numbers are exact")]
    fn debris_is_seen_beside_plates_and_a_lone_body_keeps_its_range() {
        let of = |values: &[f64]| {
            let mut covered = Sampled::default();
            covered.extend(values.iter().copied(), values.len());
            darkest(&covered, 256.0)
        };
        let debris = [vec![256.0; 60], vec![1.0; 40]].concat();
        assert_eq!(of(&debris), 8.0);
        let plate = [vec![256.0; 90], vec![1.0; 10]].concat();
        assert_eq!(of(&plate), 256.0);
    }
}
