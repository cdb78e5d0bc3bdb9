//! A tornado chart: for each key a bar between the means to which its values move an answer, the longest on top.

use super::curves::{Quantity, Ruler};
use crate::PlotError;
use crate::axes::Axes;
use crate::canvas::{Align, Canvas, Frame, INK, PAPER};
use crate::colour::body as colour_of;
use crate::font;
use crate::header::{Header, shorten};
use crate::style::{Style, WIDTH, whole};

/// Marks of the lower axis.
const MARKS: f64 = 10.0;

/// A bar.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// Name of the key, to the left.
    pub name: String,
    /// The least and the largest mean, less the mean of the group, in the unit of the axis.
    pub ends: [f64; 2],
    /// The values of the key that give them.
    pub values: [String; 2],
}

impl Bar {
    /// By how much the key moves the answer.
    fn effect(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }
}

/// Bars about a mean.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Group {
    /// A line over its bars; none if empty.
    pub title: String,
    /// Its bars, in any order.
    pub bars: Vec<Bar>,
}

/// A tornado chart.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tornado {
    /// First line.
    pub title: String,
    /// Second line; none if empty.
    pub subtitle: String,
    /// The difference from the mean.
    pub x: Quantity,
    /// Groups from the top down.
    pub groups: Vec<Group>,
}

/// A line of the frame.
enum Line<'a> {
    Title(&'a str),
    Bar(&'a Bar),
}

impl Tornado {
    /// Draws the chart in a width in pixels.
    ///
    /// # Errors
    /// [`PlotError::Size`] if no such picture can be held.
    pub fn draw(&self, width: Option<u32>) -> Result<Canvas, PlotError> {
        let width = width.unwrap_or(WIDTH);
        let style = Style::new(width, WIDTH);
        let header = Header {
            title: &self.title,
            subtitle: &self.subtitle,
            legend: Vec::new(),
        };
        let lines = self.lines();
        let bars = || self.groups.iter().flat_map(|group| &group.bars);
        let fitting = |text: &str, share: f32| shorten(text, style.small(), share * width as f32);
        let widest = |texts: &mut dyn Iterator<Item = String>| {
            texts
                .map(|text| font::width(&text, style.small()))
                .fold(0.0, f32::max)
        };
        let names = widest(&mut bars().map(|bar| fitting(&bar.name, 0.3)));
        let left = style.margin() + names + style.gap();
        let top = header.draw(None, style, width as f32) + style.gap();
        let row = 2.2 * style.small();
        let frame = Frame {
            left: left.round(),
            top: top.round(),
            width: (width as f32 - left - 2.0 * style.margin()).round(),
            height: (row * (lines.len() as f32 + 0.5)).round(),
        };
        let total = whole(frame.bottom() + style.below() + 0.5 * style.margin());
        let mut canvas = Canvas::new(width, total)?;

        // Texts stand beside the ends of bars, so the axis goes on beyond the longest ones by as much.
        let beside = [0, 1].map(|k| {
            let text = widest(&mut bars().map(|bar| fitting(&bar.values[k], 0.15)));
            f64::from((text + 2.0 * style.gap()) / frame.width)
        });
        let mut x = self.x.clone();
        x.span = Some(span(bars().flat_map(|bar| bar.ends), beside));
        let ruler = Ruler::new(&x, std::iter::empty(), MARKS);
        let axes = Axes {
            frame,
            x: ruler.span,
            y: [0.0, 1.0],
        };
        let no_marks = crate::ticks::Ticks {
            values: Vec::new(),
            labels: Vec::new(),
        };
        axes.draw_grid(&mut canvas, style, &ruler.ticks, &no_marks);
        let at = |value: f64| axes.at(ruler.position(value), 0.0).0;
        for (k, line) in lines.iter().enumerate() {
            let middle = frame.top + row * (k as f32 + 0.75);
            let baseline = middle + 0.36 * style.small();
            match line {
                Line::Title(title) => {
                    let title = shorten(title, style.small(), frame.width - 2.0 * style.gap());
                    let place = (frame.left + style.gap(), baseline);
                    // No line of the grid goes through it.
                    let behind = Frame {
                        left: place.0,
                        top: middle - 0.5 * style.small(),
                        width: font::width(&title, style.small()),
                        height: style.small(),
                    };
                    canvas.fill(&behind, PAPER);
                    canvas.text(&title, place, style.small(), Align::Start);
                }
                Line::Bar(bar) => {
                    let ends = bar.ends.map(at);
                    for (k, (from, to)) in [(ends[0], at(0.0)), (at(0.0), ends[1])]
                        .into_iter()
                        .enumerate()
                    {
                        let half = Frame {
                            left: from,
                            top: middle - 0.3 * row,
                            width: (to - from).max(style.line()),
                            height: 0.6 * row,
                        };
                        canvas.fill(&half, colour_of(k));
                    }
                    let name = fitting(&bar.name, 0.3);
                    let place = (frame.left - style.gap(), baseline);
                    canvas.text(&name, place, style.small(), Align::End);
                    let [least, largest] = [0, 1].map(|k| fitting(&bar.values[k], 0.15));
                    let place = (ends[0] - style.gap(), baseline);
                    canvas.text(&least, place, style.small(), Align::End);
                    let place = (ends[1] + style.gap(), baseline);
                    canvas.text(&largest, place, style.small(), Align::Start);
                }
            }
        }
        // A line at the mean, but not through titles.
        for (k, line) in lines.iter().enumerate() {
            if let Line::Bar(_) = line {
                let top = frame.top + row * (k as f32 + 0.25);
                let ends = [(at(0.0), top), (at(0.0), top + row)];
                canvas.line(&ends, style.line(), INK);
            }
        }
        header.draw(Some(&mut canvas), style, width as f32);
        let label = ruler.unit.label(&self.x.label);
        axes.draw_x(&mut canvas, style, &ruler.ticks, Some(&label));
        Ok(canvas)
    }

    /// Titles and bars from the top down, the longest bar of a group first.
    fn lines(&self) -> Vec<Line<'_>> {
        let mut lines = Vec::new();
        for group in &self.groups {
            if !group.title.is_empty() {
                lines.push(Line::Title(&group.title));
            }
            let mut bars: Vec<&Bar> = group.bars.iter().collect();
            bars.sort_by(|a, b| b.effect().total_cmp(&a.effect()));
            lines.extend(bars.into_iter().map(Line::Bar));
        }
        lines
    }
}

/// The ends of the axis: about all values, with a share of the frame left free at either side.
fn span(values: impl Iterator<Item = f64>, beside: [f64; 2]) -> [f64; 2] {
    let finite = values.filter(|value| value.is_finite());
    let [low, high] = finite.fold([0.0_f64; 2], |[low, high], v| [low.min(v), high.max(v)]);
    let width = if high > low { high - low } else { 1.0 };
    let whole = width / (1.0 - beside[0] - beside[1]);
    [low - beside[0] * whole, high + beside[1] * whole]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axis_keeps_room_for_texts() {
        let [low, high] = span([-1.0, 3.0].into_iter(), [0.1, 0.1]);
        assert!((low + 1.5).abs() < 1e-12 && (high - 3.5).abs() < 1e-12);
        let [low, high] = span([0.0].into_iter(), [0.25, 0.25]);
        assert!(low < 0.0 && high > 0.0);
    }

    #[test]
    fn the_longest_bar_of_a_group_is_on_top() {
        let bar = |name: &str, end: f64| Bar {
            name: name.to_owned(),
            ends: [-end, end],
            values: ["1", "2"].map(str::to_owned),
        };
        let group = Group {
            title: "speed 5 km/s".to_owned(),
            bars: vec![bar("short", 1.0), bar("long", 2.0)],
        };
        let tornado = Tornado {
            groups: vec![group],
            ..Tornado::default()
        };
        let text = tornado.draw(Some(600)).unwrap().svg();
        let place = |part: &str| text.find(part).unwrap();
        assert!(place("speed 5 km/s") < place("long") && place("long") < place("short"));
    }
}
