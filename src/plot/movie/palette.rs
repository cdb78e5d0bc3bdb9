//! The colours of a GIF: exactly those of its pictures if they are few, else the frequent ones
//! exactly and others in place of the rest.

use color_quant::NeuQuant;
use rayon::prelude::*;

use crate::canvas::Rgb;

/// Colours of a palette; one more place is for what has not changed.
const MOST: usize = 255;

/// Frequent colours that stay as they are, at most: paper, text, lines, colours of the legend.
const PINNED: usize = 24;

/// Share of all pixels that makes a colour frequent.
const FREQUENT: f64 = 5e-4;

/// Pixels from which other colours are learnt, about.
const LEARNT: f64 = 300_000.0;

/// Number of colours there can be.
const ALL: usize = 1 << 24;

/// The number of uses of each colour.
pub struct Tally {
    counts: Vec<u32>,
}

impl Tally {
    /// None has been.
    pub fn new() -> Self {
        Self {
            counts: vec![0; ALL],
        }
    }

    /// Counts the pixels of a picture.
    pub fn add(&mut self, colours: &[Rgb]) {
        for colour in colours {
            let count = &mut self.counts[number(*colour)];
            *count = count.saturating_add(1);
        }
    }

    /// The colours that there are, with how often.
    fn used(&self) -> Vec<(Rgb, u32)> {
        let counts = self.counts.iter().enumerate();
        let used = counts.filter(|(_, count)| **count > 0);
        used.map(|(number, &count)| (colour(number), count))
            .collect()
    }
}

/// Up to [`MOST`] colours, and which of them replaces each that is used.
pub struct Palette {
    colours: Vec<Rgb>,
    /// By the number of a colour.
    indices: Vec<u8>,
}

impl Palette {
    /// Place of what is as in the picture before.
    pub const SAME: u8 = 255;

    /// The palette for all pictures that were counted.
    pub fn new(tally: &Tally) -> Self {
        let used = tally.used();
        let colours = if used.len() <= MOST {
            used.iter().map(|(colour, _)| *colour).collect()
        } else {
            chosen(&used)
        };
        let nearest = |(colour, _): &(Rgb, u32)| (number(*colour), nearest(&colours, *colour));
        let pairs: Vec<(usize, u8)> = used.par_iter().map(nearest).collect();
        let mut indices = vec![0; ALL];
        for (number, index) in pairs {
            indices[number] = index;
        }
        Self { colours, indices }
    }

    /// Red, green and blue of each place, of all 256.
    pub fn table(&self) -> Vec<u8> {
        let mut table = self.colours.concat();
        table.resize(3 * (MOST + 1), 0);
        table
    }

    /// The places of the colours of a picture that was counted.
    pub fn indices(&self, colours: &[Rgb]) -> Vec<u8> {
        let index = |colour: &Rgb| self.indices[number(*colour)];
        colours.iter().map(index).collect()
    }
}

/// Frequent colours, and others in place of the rest.
fn chosen(used: &[(Rgb, u32)]) -> Vec<Rgb> {
    let total: f64 = used.iter().map(|(_, count)| f64::from(*count)).sum();
    let mut frequent = used.to_vec();
    frequent.retain(|(_, count)| f64::from(*count) > FREQUENT * total);
    frequent.sort_by_key(|(colour, count)| (std::cmp::Reverse(*count), *colour));
    frequent.truncate(PINNED);
    let mut colours: Vec<Rgb> = frequent.into_iter().map(|(colour, _)| colour).collect();
    let others = used.iter().filter(|(colour, _)| !colours.contains(colour));
    let others: Vec<&(Rgb, u32)> = others.collect();
    let rest: f64 = others.iter().map(|(_, count)| f64::from(*count)).sum();
    let mut pixels = Vec::new();
    for (colour, count) in others {
        let copies = (f64::from(*count) * LEARNT / rest).ceil().max(1.0);
        let mut k = 0.0;
        while k < copies {
            pixels.extend([colour[0], colour[1], colour[2], 255]);
            k += 1.0;
        }
    }
    let learnt = NeuQuant::new(1, MOST - colours.len(), &pixels);
    let learnt = learnt.color_map_rgb();
    colours.extend(learnt.as_chunks::<3>().0);
    colours
}

/// Place of the colour that is nearest.
#[expect(
    clippy::cast_possible_truncation,
    reason = "places of a palette are bytes"
)]
fn nearest(colours: &[Rgb], wanted: Rgb) -> u8 {
    let distance = |colour: &Rgb| -> i32 {
        let parts = colour.iter().zip(wanted);
        parts
            .map(|(a, b)| (i32::from(*a) - i32::from(b)).pow(2))
            .sum()
    };
    let all = colours.iter().enumerate();
    let nearest = all.min_by_key(|(_, colour)| distance(colour));
    nearest.map_or(0, |(index, _)| index as u8)
}

fn number([red, green, blue]: Rgb) -> usize {
    (usize::from(red) << 16) | (usize::from(green) << 8) | usize::from(blue)
}

#[expect(clippy::cast_possible_truncation, reason = "bytes of a number")]
fn colour(number: usize) -> Rgb {
    [(number >> 16) as u8, (number >> 8) as u8, number as u8]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colours_stay_as_they_are() {
        let colours: Vec<Rgb> = (0..200).map(|k| [k, 255 - k, k / 2]).collect();
        let mut tally = Tally::new();
        tally.add(&colours);
        let palette = Palette::new(&tally);
        let table = palette.table();
        for (colour, index) in colours.iter().zip(palette.indices(&colours)) {
            assert_eq!(table[3 * usize::from(index)..][..3], *colour);
        }
    }

    #[test]
    fn of_many_the_frequent_stay_and_the_others_are_near() {
        let mut colours = vec![[255; 3]; 100_000];
        colours.extend((0..200_u8).flat_map(|r| (0..200).map(move |g| [r, g, 128])));
        let mut tally = Tally::new();
        tally.add(&colours);
        let palette = Palette::new(&tally);
        let table = palette.table();
        let mut distance = 0.0;
        for (colour, index) in colours.iter().zip(palette.indices(&colours)) {
            let taken = &table[3 * usize::from(index)..][..3];
            if *colour == [255; 3] {
                assert_eq!(taken, [255; 3]);
            }
            let parts = colour.iter().zip(taken);
            distance += parts.map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>();
        }
        // 254 colours over a square of 200 steps a side are some 13 apart.
        assert!(distance / 40_000.0 < 13.0, "{}", distance / 40_000.0);
    }
}
