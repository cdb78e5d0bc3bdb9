//! The text of an SVG picture: elements of one style in groups, numbers of few digits.

use std::fmt::Write as _;

use super::font;
use super::frame::{Frame, Rgb};

/// Steps of a coordinate in a pixel.
const STEPS: f64 = 100.0;

/// Coordinates (pixels) beyond it are moved there: far outside of every picture.
const FARTHEST: f64 = 1e6;

/// An element without its style.
#[derive(Debug, Clone, PartialEq)]
pub struct Element {
    pub tag: &'static str,
    /// `x="1" y="2"`, the values without `"`, `<` and `&`.
    pub attributes: String,
    /// Its text, as it is to be read.
    pub text: Option<String>,
}

impl Element {
    /// One that holds nothing.
    pub fn new(tag: &'static str, attributes: String) -> Self {
        Self {
            tag,
            attributes,
            text: None,
        }
    }
}

/// A picture in the making. What is put in is drawn in this order.
#[derive(Debug)]
pub struct Document {
    width: u32,
    height: u32,
    /// Frames that something is cut at, and gradients, by their numbers.
    clips: Vec<Frame>,
    gradients: Vec<String>,
    /// Groups that are closed.
    body: String,
    open: Open,
}

/// The group that is open: what it is cut at, its style, and its elements.
#[derive(Debug, Clone, Default)]
struct Open {
    clip: Option<usize>,
    is_clipping: bool,
    style: String,
    elements: Vec<Element>,
}

impl Document {
    /// Without anything on it, in pixels.
    pub fn new(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            clips: Vec::new(),
            gradients: Vec::new(),
            body: String::new(),
            open: Open::default(),
        }
    }

    /// Adds an element of a style, as `fill="#000"`, cut at a frame if there is one.
    pub fn put(&mut self, clip: Option<&Frame>, style: &str, element: Element) {
        let clip = clip.map(|frame| self.clip(frame));
        if (clip, style) != (self.open.clip, self.open.style.as_str()) {
            self.open.write_elements(&mut self.body);
            if clip != self.open.clip {
                self.open.write_end(&mut self.body);
            }
            self.open.clip = clip;
            style.clone_into(&mut self.open.style);
        }
        self.open.elements.push(element);
    }

    /// The number of a frame that something is cut at.
    fn clip(&mut self, frame: &Frame) -> usize {
        let known = self.clips.iter().position(|clip| clip == frame);
        known.unwrap_or_else(|| {
            self.clips.push(*frame);
            self.clips.len() - 1
        })
    }

    /// The style of a surface of colours that change from its top to its bottom, at even shares.
    pub fn gradient(&mut self, colours: &[Rgb]) -> String {
        let last = colours.len().saturating_sub(1).max(1);
        let mut stops = String::new();
        for (k, colour) in colours.iter().enumerate() {
            let share = number(k as f32 / last as f32 * 100.0);
            let colour = hex(*colour);
            let _ = write!(stops, "<stop offset=\"{share}%\" stop-color=\"{colour}\"/>");
        }
        self.gradients.push(stops);
        format!("fill=\"url(#g{})\"", self.gradients.len() - 1)
    }

    /// One that goes on where this one is, without what is in closed groups.
    pub fn tail(&self) -> Self {
        Self {
            clips: self.clips.clone(),
            gradients: self.gradients.clone(),
            body: String::new(),
            open: self.open.clone(),
            ..*self
        }
    }

    /// The whole picture, which ends with a `tail` of this one.
    pub fn text(&self, mut tail: Self) -> String {
        tail.open.write_elements(&mut tail.body);
        tail.open.write_end(&mut tail.body);
        let (width, height) = (self.width, self.height);
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"{}\" xml:space=\"preserve\">\n",
            font::FAMILIES,
        );
        if !(tail.clips.is_empty() && tail.gradients.is_empty()) {
            text += "<defs>\n";
            for (k, frame) in tail.clips.iter().enumerate() {
                let rect = rect(frame);
                let _ = writeln!(text, "<clipPath id=\"c{k}\"><rect {rect}/></clipPath>");
            }
            for (k, stops) in tail.gradients.iter().enumerate() {
                let down = "x1=\"0\" y1=\"0\" x2=\"0\" y2=\"1\"";
                let _ = writeln!(
                    text,
                    "<linearGradient id=\"g{k}\" {down}>{stops}</linearGradient>"
                );
            }
            text += "</defs>\n";
        }
        text += &self.body;
        text += &tail.body;
        text + "</svg>\n"
    }
}

impl Open {
    /// The elements so far, in a group if they are several.
    fn write_elements(&mut self, body: &mut String) {
        if self.elements.is_empty() {
            return;
        }
        if let (Some(clip), false) = (self.clip, self.is_clipping) {
            let _ = writeln!(body, "<g clip-path=\"url(#c{clip})\">");
            self.is_clipping = true;
        }
        let alone = self.elements.len() == 1;
        let style = std::mem::take(&mut self.style);
        if !alone {
            let _ = writeln!(body, "<g {style}>");
        }
        for Element {
            tag,
            attributes,
            text,
        } in self.elements.drain(..)
        {
            let _ = write!(body, "<{tag} ");
            if alone {
                let _ = write!(body, "{style} ");
            }
            body.push_str(&attributes);
            match text {
                Some(text) => {
                    body.push('>');
                    write_escaped(body, &text);
                    let _ = writeln!(body, "</{tag}>");
                }
                None => body.push_str("/>\n"),
            }
        }
        if !alone {
            body.push_str("</g>\n");
        }
    }

    /// The end of what is cut at a frame.
    fn write_end(&mut self, body: &mut String) {
        if std::mem::take(&mut self.is_clipping) {
            body.push_str("</g>\n");
        }
    }
}

/// Writes a text as XML has it.
fn write_escaped(body: &mut String, text: &str) {
    for c in text.chars() {
        match c {
            '<' => body.push_str("&lt;"),
            '>' => body.push_str("&gt;"),
            '&' => body.push_str("&amp;"),
            '\t' => body.push(' '),
            // XML has no way to write them.
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => body.push('\u{fffd}'),
            c => body.push(c),
        }
    }
}

/// `#0072b2`.
#[must_use]
pub fn hex([red, green, blue]: Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// The attributes of a rectangle.
pub fn rect(frame: &Frame) -> String {
    let [x, y] = [frame.left, frame.top].map(number);
    let [width, height] = [frame.width, frame.height].map(|length| number(length.max(0.0)));
    format!("x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"")
}

/// A length or place in pixels, with two decimals at most.
pub fn number(value: f32) -> String {
    let mut text = String::new();
    write_steps(&mut text, steps(value));
    text
}

/// A path through points: the first as it is, each other from the one before.
pub fn path(points: &[(f32, f32)]) -> String {
    let mut text = String::from("m");
    let mut before = (0, 0);
    for (k, &(x, y)) in points.iter().enumerate() {
        let at = (steps(x), steps(y));
        if k > 0 {
            text.push(' ');
        }
        write_steps(&mut text, at.0 - before.0);
        text.push(' ');
        write_steps(&mut text, at.1 - before.1);
        before = at;
    }
    text
}

/// A coordinate in whole steps.
#[expect(clippy::cast_possible_truncation, reason = "clamped")]
fn steps(value: f32) -> i64 {
    let value = f64::from(value).clamp(-FARTHEST, FARTHEST);
    (value * STEPS).round() as i64
}

/// Writes so many steps as pixels: `-.25`, `3`, `14.5`.
fn write_steps(text: &mut String, steps: i64) {
    if steps < 0 {
        text.push('-');
    }
    let (whole, part) = (steps.unsigned_abs() / 100, steps.unsigned_abs() % 100);
    if whole > 0 || part == 0 {
        let _ = write!(text, "{whole}");
    }
    if part > 0 {
        let _ = if part.is_multiple_of(10) {
            write!(text, ".{}", part / 10)
        } else {
            write!(text, ".{part:02}")
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_few_digits() {
        let all = [
            0.0,
            -0.001,
            0.25,
            -0.3,
            14.5,
            7.006,
            f32::NAN,
            f32::INFINITY,
        ];
        let texts = all.map(number);
        let known = ["0", "0", ".25", "-.3", "14.5", "7.01", "0", "1000000"];
        assert_eq!(texts, known);
        assert_eq!(
            path(&[(1.0, 2.0), (1.25, 1.5), (1.25, 1.5)]),
            "m1 2 .25 -.5 0 0"
        );
    }

    #[test]
    fn elements_of_one_style_and_frame_share_a_group() {
        let frame = Frame {
            left: 1.0,
            top: 2.0,
            width: 3.0,
            height: 4.0,
        };
        let mut document = Document::new(10, 20);
        let circle = || Element::new("circle", "r=\"1\"".to_owned());
        for _ in 0..2 {
            document.put(Some(&frame), "fill=\"#fff\"", circle());
        }
        document.put(Some(&frame), "fill=\"#000\"", circle());
        let word = Element {
            text: Some("a<b & \u{1b}c>\t".to_owned()),
            ..Element::new("text", "x=\"0\"".to_owned())
        };
        document.put(None, "fill=\"#000\"", word);
        let text = document.text(document.tail());
        let body: Vec<&str> = text.lines().skip(4).collect();
        let known = [
            "<g clip-path=\"url(#c0)\">",
            "<g fill=\"#fff\">",
            "<circle r=\"1\"/>",
            "<circle r=\"1\"/>",
            "</g>",
            "<circle fill=\"#000\" r=\"1\"/>",
            "</g>",
            "<text fill=\"#000\" x=\"0\">a&lt;b &amp; \u{fffd}c&gt; </text>",
            "</svg>",
        ];
        assert_eq!(body, known);
        assert!(
            text.contains("<clipPath id=\"c0\"><rect x=\"1\" y=\"2\" width=\"3\" height=\"4\"/>")
        );
    }
}
