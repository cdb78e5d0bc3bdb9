//! Many discs as pixels: where each of them would be an element, nobody could open the picture.

use super::frame::{Frame, Rgb};
use super::pixels::Pixels;

/// A filled disc, with a rim inside of its edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// In pixels from the upper left corner of the picture.
    pub centre: (f32, f32),
    /// Of its outer edge (pixels).
    pub radius: f32,
    pub colour: Rgb,
    /// Width (pixels) and colour of its rim, if it has one.
    pub rim: Option<(f32, Rgb)>,
}

/// The pixels of a frame, on which discs lie one over the other.
#[derive(Debug, Clone)]
pub struct Dots {
    /// First column and row in the picture.
    left: usize,
    top: usize,
    columns: usize,
    pixels: Vec<[u8; 4]>,
}

impl Dots {
    /// Those of the pixels that a frame covers, at least in part, of a picture of a size.
    pub fn new(frame: &Frame, (width, height): (u32, u32)) -> Self {
        let whole = |low: f32, high: f32, most: u32| {
            let most = most as usize;
            let first = floor(low).min(most);
            first..floor(high.ceil()).clamp(first, most)
        };
        let xs = whole(frame.left, frame.right(), width);
        let ys = whole(frame.top, frame.bottom(), height);
        Self {
            left: xs.start,
            top: ys.start,
            columns: xs.len(),
            pixels: vec![[0; 4]; xs.len() * ys.len()],
        }
    }

    /// The frame and the pixels; nothing if there are none.
    pub fn image(&self) -> Option<(Frame, Pixels)> {
        let rows = self.pixels.len().checked_div(self.columns)?;
        let frame = Frame {
            left: self.left as f32,
            top: self.top as f32,
            width: self.columns as f32,
            height: rows as f32,
        };
        let size = [self.columns, rows].map(u32::try_from);
        let [Ok(width), Ok(height)] = size else {
            return None;
        };
        let pixels = Pixels {
            width,
            height,
            rgba: self.pixels.concat(),
        };
        (rows > 0).then_some((frame, pixels))
    }

    /// Lays a disc over the others.
    pub fn add(&mut self, disc: &Disc) {
        match disc.rim {
            None => self.fill(disc.centre, disc.radius, disc.colour),
            Some((width, colour)) => {
                self.fill(disc.centre, disc.radius, colour);
                self.fill(disc.centre, disc.radius - width, disc.colour);
            }
        }
    }

    /// A filled disc with smooth edges.
    ///
    /// A pixel's cover is taken from its centre's distance to the edge, or for small discs from
    /// a grid of samples: exact enough for the eye, and far faster than a general path.
    fn fill(&mut self, (x, y): (f32, f32), radius: f32, colour: Rgb) {
        let reach = radius + 0.5;
        let (x, y) = (x - self.left as f32, y - self.top as f32);
        let range = |middle: f32, most: usize| {
            floor(middle - reach).min(most)..floor((middle + reach).ceil()).min(most)
        };
        let rows = self.pixels.chunks_mut(self.columns.max(1));
        let count = rows.len();
        let ys = range(y, count);
        for (row, pixels) in rows.enumerate().take(ys.end).skip(ys.start) {
            let dy = row as f32 + 0.5 - y;
            for column in range(x, self.columns) {
                let dx = column as f32 + 0.5 - x;
                let cover = if radius < 3.0 {
                    sampled_cover(dx, dy, radius)
                } else {
                    (reach - (dx * dx + dy * dy).sqrt()).clamp(0.0, 1.0)
                };
                if cover > 0.0 {
                    blend(&mut pixels[column], colour, cover);
                }
            }
        }
    }
}

/// A place as a number of pixels; none before the first.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates, and what is no number is 0"
)]
fn floor(value: f32) -> usize {
    value.floor().max(0.0) as usize
}

/// The share of a pixel within a disc, from 4 × 4 samples; the pixel's centre lies at (dx, dy)
/// from the disc's.
fn sampled_cover(dx: f32, dy: f32, radius: f32) -> f32 {
    let offsets = [-0.375, -0.125, 0.125, 0.375];
    let inside = |x: f32, y: f32| x * x + y * y <= radius * radius;
    let samples = offsets
        .iter()
        .flat_map(|v| offsets.map(|u| inside(dx + u, dy + v)));
    samples.filter(|&hit| hit).count() as f32 / 16.0
}

/// Lays a colour over a pixel, which may be clear.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a mean of two bytes is a byte"
)]
fn blend(pixel: &mut [u8; 4], colour: Rgb, cover: f32) {
    let below = f32::from(pixel[3]) / 255.0 * (1.0 - cover);
    let all = cover + below;
    for (old, new) in pixel.iter_mut().zip(colour) {
        *old = ((f32::from(*old) * below + f32::from(new) * cover) / all).round() as u8;
    }
    pixel[3] = (255.0 * all).round() as u8;
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Frame = Frame {
        left: 10.0,
        top: 0.0,
        width: 40.0,
        height: 40.0,
    };

    fn disc(centre: (f32, f32), radius: f32) -> Disc {
        Disc {
            centre,
            radius,
            colour: [0, 50, 0],
            rim: None,
        }
    }

    #[test]
    fn a_disc_covers_its_area() {
        for radius in [0.4_f32, 1.0, 3.3, 10.0] {
            let mut dots = Dots::new(&FRAME, (100, 100));
            dots.add(&disc((30.3, 19.8), radius));
            let ink: f32 = dots.pixels.iter().map(|p| f32::from(p[3]) / 255.0).sum();
            let area = std::f32::consts::PI * radius * radius;
            // 8 of 16 samples fall into the smallest; larger discs are better, and the cover by
            // distance adds π/12 pixels.
            let bound = 0.3 / area;
            assert!((ink / area - 1.0).abs() < bound, "{radius}: {ink} {area}");
        }
    }

    #[test]
    fn discs_stay_inside_their_frame_and_have_their_colours() {
        let mut dots = Dots::new(&FRAME, (30, 100));
        for centre in [(10.0, 20.0), (-50.0, 20.0), (10.0, 1e9), (f32::NAN, 3.0)] {
            dots.add(&disc(centre, 5.0));
        }
        let (frame, pixels) = dots.image().unwrap();
        assert_eq!((frame.left, frame.width, frame.height), (10.0, 20.0, 40.0));
        let at = |x: usize, y: usize| &pixels.rgba[4 * (20 * y + x)..][..4];
        assert_eq!(at(0, 20), [0, 50, 0, 255]);
        assert_eq!(at(10, 20), [0; 4]);
        // A pixel that is half covered has the whole colour.
        let edge = pixels.rgba.chunks(4).find(|p| (1..255).contains(&p[3]));
        assert_eq!(edge.unwrap()[..3], [0, 50, 0]);
    }

    #[test]
    fn nothing_is_drawn_beyond_the_picture() {
        let beyond = Frame {
            left: 200.0,
            ..FRAME
        };
        assert!(Dots::new(&beyond, (100, 100)).image().is_none());
    }
}
