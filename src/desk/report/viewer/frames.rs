//! A snapshot as the viewer is sent it: places, bodies, sizes and values of the particles that are kept, in few
//! bytes.
//!
//! Of n particles in the order of ids there are, one after the other: for each axis n high and n low bytes of
//! the differences of places from particle to particle, in 65536ths of the frame's box, since neighbours by id are
//! neighbours in space; n bodies; n sizes in 255ths of the largest; and for each field n values, 1 to 255 over its
//! range, 0 where there is none. All of it deflated (zlib) and in base64.

use std::io::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;

use super::chosen::Chosen;
use plot::{Drawn, PlotError, Snapshot};

/// The kept data of a snapshot.
#[derive(Debug, Default)]
pub struct Kept {
    /// Time (s).
    pub time: f64,
    /// Particles that could be chosen: those that are part of the model still, at known places.
    pub whole: usize,
    /// Positions (m).
    pub positions: Vec<[f64; 3]>,
    /// Bodies by number; beyond 255 the last.
    pub bodies: Vec<u8>,
    /// Edges of particles (m).
    pub sizes: Vec<f32>,
    /// A value of each for each field, in SI.
    pub values: Vec<Vec<f32>>,
}

impl Kept {
    /// Reads a snapshot: what is chosen of it and is part of the model still, at most so many.
    pub fn read(
        snapshot: &Snapshot,
        fields: &[Drawn],
        chosen: Chosen,
        most: usize,
    ) -> Result<Self, PlotError> {
        let mut kept = Self {
            time: snapshot.time,
            values: vec![Vec::new(); fields.len()],
            ..Self::default()
        };
        let has_ids = snapshot.has("id")?;
        for rows in snapshot.chunks() {
            let numbers = if has_ids {
                snapshot.file.scalar("id", 0, rows.clone())?
            } else {
                rows.clone().map(|row| row as f64).collect()
            };
            let bears = Drawn::Body.bearers(snapshot, rows.clone())?;
            let points = snapshot.file.points(rows.clone())?;
            let bodies = snapshot.body_of(rows.clone())?;
            let sizes = snapshot.sizes(rows.clone(), &bodies)?;
            let values: Result<Vec<Vec<f64>>, _> = fields
                .iter()
                .map(|field| field.values(snapshot, rows.clone()))
                .collect();
            let values = values?;
            for row in 0..points.len() {
                let finite = points[row].iter().all(|x| x.is_finite());
                if !(bears[row] && finite) {
                    continue;
                }
                kept.whole += 1;
                if !chosen.keeps(id(numbers[row])) || kept.bodies.len() == most {
                    continue;
                }
                kept.add(points[row], bodies[row], sizes[row]);
                for (own, values) in kept.values.iter_mut().zip(&values) {
                    own.push(single(values[row]));
                }
            }
        }
        Ok(kept)
    }

    fn add(&mut self, point: [f64; 3], body: usize, size: f64) {
        self.positions.push(point);
        self.bodies.push(u8::try_from(body).unwrap_or(u8::MAX));
        self.sizes.push(single(size));
    }

    /// Ends of the places along each axis (m); without a share of the particles at each.
    pub fn ends(&self, without: f64) -> Ends {
        [0, 1, 2].map(|axis| {
            let mut coordinates: Vec<f64> =
                self.positions.iter().map(|point| point[axis]).collect();
            let Some(last) = coordinates.len().checked_sub(1) else {
                return [0.0; 2];
            };
            let cut = part(without * last as f64);
            [cut, last - cut].map(|k| *coordinates.select_nth_unstable_by(k, f64::total_cmp).1)
        })
    }
}

/// Ends of places along each axis (m).
pub type Ends = [[f64; 2]; 3];

/// A frame of the viewer.
#[derive(Debug)]
pub struct Frame {
    /// Time (s).
    pub time: f64,
    /// Particles.
    pub count: usize,
    /// Lower corner of their box (m).
    pub lower: [f64; 3],
    /// Upper corner (m).
    pub upper: [f64; 3],
    /// Their bytes, see above.
    pub packed: String,
}

impl Frame {
    /// Packs what is kept: places between their ends, sizes over the largest of all frames, values over the
    /// range of each field.
    pub fn new(kept: &Kept, ends: Ends, largest: f64, ranges: &[[f64; 2]]) -> Self {
        let mut bytes = Vec::with_capacity(kept.bodies.len() * (8 + ranges.len()));
        for (axis, [low, high]) in ends.into_iter().enumerate() {
            let width = (high - low).max(f64::MIN_POSITIVE);
            let mut before = 0_u16;
            let difference = |point: &[f64; 3]| {
                let coordinate = sixteen((point[axis] - low) / width);
                let difference = coordinate.wrapping_sub(before);
                before = coordinate;
                difference.to_be_bytes()
            };
            let all: Vec<[u8; 2]> = kept.positions.iter().map(difference).collect();
            for byte in [0, 1] {
                bytes.extend(all.iter().map(|pair| pair[byte]));
            }
        }
        bytes.extend(&kept.bodies);
        bytes.extend(
            kept.sizes
                .iter()
                .map(|&size| eight(f64::from(size) / largest, 0.0)),
        );
        for (values, [low, high]) in kept.values.iter().zip(ranges) {
            let value = |&value: &f32| {
                let share = (f64::from(value) - low) / (high - low);
                if share.is_finite() {
                    eight(share, 1.0)
                } else {
                    0
                }
            };
            bytes.extend(values.iter().map(value));
        }
        Self {
            time: kept.time,
            count: kept.bodies.len(),
            lower: ends.map(|[low, _]| low),
            upper: ends.map(|[_, high]| high),
            packed: STANDARD.encode(deflated(&bytes)),
        }
    }
}

fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::new(7));
    packer.write_all(bytes).expect("memory takes it");
    packer.finish().expect("memory takes it")
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number that the file has as one; whatever it holds is merely mixed"
)]
fn id(number: f64) -> u64 {
    number as u64
}

#[expect(clippy::cast_possible_truncation, reason = "for the eye")]
fn single(value: f64) -> f32 {
    value as f32
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a small share of a length"
)]
fn part(coordinates: f64) -> usize {
    coordinates as usize
}

/// A share in 65535ths.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the range first"
)]
fn sixteen(share: f64) -> u16 {
    (65_535.0 * share.clamp(0.0, 1.0)).round() as u16
}

/// A share as a byte from `least` on.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the range first"
)]
fn eight(share: f64, least: f64) -> u8 {
    (least + (255.0 - least) * share.clamp(0.0, 1.0)).round() as u8
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use super::*;

    #[test]
    fn a_frame_is_unpacked_again() {
        let kept = Kept {
            positions: vec![[0.0, 5.0, -1.0], [1.0, 5.0, 1.0], [0.5, 5.0, 0.0]],
            bodies: vec![0, 1, 1],
            sizes: vec![1.0, 2.0, 0.5],
            values: vec![vec![0.0, f32::NAN, 9.0]],
            ..Kept::default()
        };
        let frame = Frame::new(&kept, kept.ends(0.0), 2.0, &[[0.0, 4.0]]);
        assert_eq!(
            (frame.count, frame.lower, frame.upper),
            (3, [0.0, 5.0, -1.0], [1.0, 5.0, 1.0])
        );
        let packed = STANDARD.decode(&frame.packed).unwrap();
        let mut bytes = Vec::new();
        flate2::read::ZlibDecoder::new(&packed[..])
            .read_to_end(&mut bytes)
            .unwrap();
        assert_eq!(bytes.len(), 3 * 9);
        let x: Vec<u16> = (0..3)
            .scan(0_u16, |sum, k| {
                *sum = sum.wrapping_add(u16::from_be_bytes([bytes[k], bytes[3 + k]]));
                Some(*sum)
            })
            .collect();
        assert_eq!(x, [0, 65_535, 32_768]);
        assert_eq!(bytes[18..], [0, 1, 1, 128, 255, 64, 1, 0, 255]);
    }
}
