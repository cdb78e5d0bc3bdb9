//! A picture while it is drawn: discs, lines, text and pixels on white paper, kept as SVG. Positions
//! are pixels from the upper left corner.

use std::path::Path;

use base64::prelude::{BASE64_STANDARD, Engine as _};

use super::PlotError;
use super::discs::Discs;
use super::dots::{Disc, Dots};
use super::file;
use super::format::Format;
pub use super::frame::{Frame, Rgb};
use super::pixels::Pixels;
use super::stretch::stretches;
use super::svg::{Document, Element, hex, number, path, rect};
use model::readable::one_line;

/// Colour of text and axes.
pub const INK: Rgb = [32, 32, 32];

/// Colour of the paper.
pub const PAPER: Rgb = [255, 255, 255];

/// Length of lines beyond the frame that they are cut at (pixels): no end of one is seen.
const BEYOND: f32 = 50.0;

/// The point of a line of text that its position names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    Start,
    Middle,
    End,
}

/// A picture while it is drawn.
#[derive(Debug)]
pub struct Canvas {
    size: (u32, u32),
    document: Document,
    /// The discs that were drawn last.
    discs: Discs,
    /// The frame that cuts all that is drawn.
    clip: Option<Frame>,
}

impl Canvas {
    /// White paper of a size in pixels.
    ///
    /// # Errors
    /// [`PlotError::Size`] if it cannot be held.
    pub fn new(width: u32, height: u32) -> Result<Self, PlotError> {
        Self::fits(width, height)?;
        let mut canvas = Self {
            size: (width, height),
            document: Document::new(width, height),
            discs: Discs::default(),
            clip: None,
        };
        let page = Frame {
            width: width as f32,
            height: height as f32,
            ..Frame::PAGE
        };
        canvas.fill(&page, PAPER);
        Ok(canvas)
    }

    /// Checks that paper of a size in pixels takes no more than 2³¹ bytes.
    ///
    /// # Errors
    /// [`PlotError::Size`] if not.
    pub fn fits(width: u32, height: u32) -> Result<(), PlotError> {
        let pixels = u64::from(width) * u64::from(height);
        if pixels > 0 && pixels <= 1 << 29 {
            Ok(())
        } else {
            Err(PlotError::Size { width, height })
        }
    }

    /// Draws with `draw`, cut at a frame.
    pub fn within(&mut self, frame: &Frame, draw: impl FnOnce(&mut Self)) {
        let outer = self.clip.replace(*frame);
        draw(self);
        self.clip = outer;
    }

    /// A filled disc, cut at the borders of `clip`.
    pub fn disc(&mut self, centre: (f32, f32), radius: f32, colour: Rgb, clip: &Frame) {
        let disc = Disc {
            centre,
            radius,
            colour,
            rim: None,
        };
        self.add_disc(disc, clip);
    }

    /// The same with a rim of a width and a colour inside of its edge.
    pub fn bead(
        &mut self,
        centre: (f32, f32),
        radius: f32,
        colour: Rgb,
        rim: (f32, Rgb),
        clip: &Frame,
    ) {
        let disc = Disc {
            centre,
            radius,
            colour,
            rim: Some(rim),
        };
        self.add_disc(disc, clip);
    }

    fn add_disc(&mut self, disc: Disc, clip: &Frame) {
        if *clip != self.discs.clip {
            self.flush_discs();
            self.discs.clip = *clip;
        }
        self.discs.add(disc, self.size);
    }

    /// A filled rectangle.
    pub fn fill(&mut self, frame: &Frame, colour: Rgb) {
        let style = format!("fill=\"{}\"", hex(colour));
        self.put(&style, Element::new("rect", rect(frame)));
    }

    /// A rectangle of colours that change from its top to its bottom, at even shares.
    pub fn gradient(&mut self, frame: &Frame, colours: &[Rgb]) {
        let style = self.document.gradient(colours);
        self.put(&style, Element::new("rect", rect(frame)));
    }

    /// The pixels of a frame, row by row.
    pub fn image(&mut self, frame: &Frame, colours: &[Rgb]) {
        let [columns, _] = frame.pixels();
        let rows = colours.len() / columns;
        let colours = &colours[..rows * columns];
        let rgba = colours.iter().flat_map(|&[r, g, b]| [r, g, b, 255]);
        if let [Ok(width), Ok(height)] = [columns, rows].map(u32::try_from) {
            let frame = Frame {
                width: width as f32,
                height: height as f32,
                ..*frame
            };
            let pixels = Pixels {
                width,
                height,
                rgba: rgba.collect(),
            };
            self.flush_discs();
            put_image(&mut self.document, self.clip.as_ref(), &frame, &pixels);
        }
    }

    /// A filled polygon.
    pub fn polygon(&mut self, corners: &[(f32, f32)], colour: Rgb) {
        let style = format!("fill=\"{}\"", hex(colour));
        let attributes = format!("d=\"{}z\"", path(corners));
        self.put(&style, Element::new("path", attributes));
    }

    /// A line through points.
    pub fn line(&mut self, points: &[(f32, f32)], width: f32, colour: Rgb) {
        self.stroke(points, width, colour, "");
    }

    /// A line of dashes through points: the lengths of one, of the gap behind it, and so on (pixels).
    pub fn dashes(&mut self, points: &[(f32, f32)], width: f32, colour: Rgb, lengths: &[f32]) {
        let lengths: Vec<String> = lengths.iter().map(|&length| number(length)).collect();
        let dashes = format!(" stroke-dasharray=\"{}\"", lengths.join(" "));
        self.stroke(points, width, colour, &dashes);
    }

    fn stroke(&mut self, points: &[(f32, f32)], width: f32, colour: Rgb, dashes: &str) {
        if points.len() < 2 {
            return;
        }
        let (colour, width) = (hex(colour), number(width));
        let style = format!(
            "fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" \
             stroke-linejoin=\"round\"{dashes}"
        );
        let near = self.clip.map(|clip| clip.grown(BEYOND));
        let seen = near.map(|near| stretches(points, &near));
        let lines = seen.unwrap_or_else(|| vec![points.to_vec()]);
        for line in lines {
            let attributes = format!("d=\"{}\"", path(&line));
            self.put(&style, Element::new("path", attributes));
        }
    }

    /// The four sides of a frame.
    pub fn border(&mut self, frame: &Frame, width: f32, colour: Rgb) {
        let (colour, width) = (hex(colour), number(width));
        let style = format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"");
        self.put(&style, Element::new("rect", rect(frame)));
    }

    /// A line of text with its baseline at `at`.
    pub fn text(&mut self, text: &str, at: (f32, f32), size: f32, align: Align) {
        let [x, y] = [at.0, at.1].map(number);
        self.write(text, format!("x=\"{x}\" y=\"{y}\""), size, align);
    }

    /// A line of text that runs upwards, with its baseline at `at`.
    pub fn text_upwards(&mut self, text: &str, at: (f32, f32), size: f32, align: Align) {
        let [x, y] = [at.0, at.1].map(number);
        let transform = format!("transform=\"translate({x} {y})rotate(-90)\"");
        self.write(text, transform, size, align);
    }

    fn write(&mut self, text: &str, attributes: String, size: f32, align: Align) {
        let anchor = match align {
            Align::Start => "",
            Align::Middle => " text-anchor=\"middle\"",
            Align::End => " text-anchor=\"end\"",
        };
        let style = format!(
            "fill=\"{}\" font-size=\"{}\"{anchor}",
            hex(INK),
            number(size)
        );
        let element = Element {
            text: Some(one_line(text).into_owned()),
            ..Element::new("text", attributes)
        };
        self.put(&style, element);
    }

    /// Adds an element over the discs so far.
    fn put(&mut self, style: &str, element: Element) {
        self.flush_discs();
        self.document.put(self.clip.as_ref(), style, element);
    }

    /// Adds the discs so far.
    fn flush_discs(&mut self) {
        let discs = std::mem::take(&mut self.discs);
        put_discs(&mut self.document, &discs);
    }

    /// The picture as an SVG file.
    #[must_use]
    pub fn svg(&self) -> String {
        let mut tail = self.document.tail();
        put_discs(&mut tail, &self.discs);
        self.document.text(tail)
    }

    /// The pixels of the picture, on opaque paper.
    ///
    /// # Errors
    /// [`PlotError::Size`] if they cannot be held.
    pub fn pixels(&self) -> Result<Pixels, PlotError> {
        Pixels::of(&self.svg(), self.size.into())
    }

    /// Writes the picture as an SVG file if its name ends so, else as a PNG file. Its folder is made if
    /// it lacks.
    ///
    /// # Errors
    /// [`PlotError::Save`] if the system refuses.
    pub fn save(&self, path: &Path) -> Result<(), PlotError> {
        let bytes = if let Some(Format::Svg) = Format::of(path) {
            self.svg().into_bytes()
        } else {
            let packed = self.pixels()?.png();
            packed.map_err(|error| PlotError::unsaved(path, error))?
        };
        file::save(path, &bytes)
    }
}

/// Adds discs, one by one or as pixels.
fn put_discs(document: &mut Document, discs: &Discs) {
    let clip = (discs.clip != Frame::PAGE).then_some(&discs.clip);
    for disc in &discs.few {
        let (x, y) = disc.centre;
        let (colour, mut radius, mut rim) = (hex(disc.colour), disc.radius, String::new());
        if let Some((width, colour)) = disc.rim {
            radius -= 0.5 * width;
            let (colour, width) = (hex(colour), number(width));
            rim = format!(" stroke=\"{colour}\" stroke-width=\"{width}\"");
        }
        let [x, y, r] = [x, y, radius].map(number);
        let attributes = format!("cx=\"{x}\" cy=\"{y}\" r=\"{r}\"");
        let style = format!("fill=\"{colour}\"{rim}");
        document.put(clip, &style, Element::new("circle", attributes));
    }
    if let Some((frame, pixels)) = discs.many.as_ref().and_then(Dots::image) {
        put_image(document, None, &frame, &pixels);
    }
}

/// Adds pixels, which stay apart at any magnification.
fn put_image(document: &mut Document, clip: Option<&Frame>, frame: &Frame, pixels: &Pixels) {
    // Pixels that cannot be a PNG file are left out.
    let Ok(file) = pixels.fast_png() else { return };
    let attributes = format!(
        "{} preserveAspectRatio=\"none\" href=\"data:image/png;base64,{}\"",
        rect(frame),
        BASE64_STANDARD.encode(file),
    );
    let style = "style=\"image-rendering:optimizeSpeed;image-rendering:pixelated\"";
    document.put(clip, style, Element::new("image", attributes));
}
