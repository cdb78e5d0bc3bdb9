//! From values to colours.

use super::canvas::Rgb;

/// Colours of bodies: the set of Okabe & Ito (2008), which colour-blind readers can distinguish.
const BODIES: [Rgb; 7] = [
    [0, 114, 178],
    [230, 159, 0],
    [0, 158, 115],
    [213, 94, 0],
    [86, 180, 233],
    [204, 121, 167],
    [240, 228, 66],
];

/// Colour of rigid bodies in pictures of a field.
pub const RIGID: Rgb = [190, 190, 190];

/// Colour of a value that is not finite: in no colour map.
pub const NOT_FINITE: Rgb = [255, 0, 255];

/// The map "viridis" of van der Walt, Smith & Firing (2015), at even shares.
const VIRIDIS: [Rgb; 17] = [
    [68, 1, 84],
    [72, 24, 106],
    [71, 44, 122],
    [66, 63, 133],
    [58, 81, 139],
    [50, 98, 141],
    [44, 113, 142],
    [38, 129, 142],
    [32, 144, 140],
    [31, 159, 136],
    [39, 173, 128],
    [61, 187, 115],
    [92, 200, 98],
    [129, 211, 76],
    [170, 219, 49],
    [213, 226, 25],
    [253, 231, 37],
];

/// The map "cool to warm" of Moreland (2009) at even shares; its middle is grey, so that particles
/// at zero still differ from the paper.
const COOL_WARM: [Rgb; 17] = [
    [59, 76, 192],
    [78, 104, 215],
    [98, 130, 234],
    [119, 154, 247],
    [141, 176, 254],
    [163, 194, 255],
    [184, 208, 249],
    [204, 217, 238],
    [221, 221, 221],
    [236, 211, 198],
    [245, 196, 173],
    [247, 177, 148],
    [244, 154, 123],
    [236, 127, 99],
    [222, 97, 76],
    [203, 62, 56],
    [180, 4, 38],
];

/// From the paper to black, as much darker everywhere: a flash X-ray.
#[expect(clippy::cast_possible_truncation, reason = "seventeen bytes")]
const GREY: [Rgb; 17] = {
    let mut map = [[255; 3]; 17];
    let mut k = 0;
    while k < 17 {
        map[k] = [255 - 15 * k as u8; 3];
        k += 1;
    }
    map
};

/// Share of the particles at each end that may be cut off when they stretch the range.
const TAIL: f64 = 0.002;

/// Colour of a body by its index.
#[must_use]
pub fn body(index: usize) -> Rgb {
    let colour = BODIES[index % BODIES.len()];
    // Later rounds of the same seven are darker.
    let rounds = u8::try_from(index / BODIES.len()).unwrap_or(u8::MAX);
    colour.map(|c| c / rounds.saturating_add(1))
}

/// Colour of one of several curves in order, as of times: those of bodies while they last, else
/// even shares of a colour map.
pub fn series(index: usize, count: usize) -> Rgb {
    if count < BODIES.len() {
        BODIES[index]
    } else {
        sample(&VIRIDIS, 0.92 * index as f64 / (count - 1) as f64)
    }
}

/// A range of values and the colour map over it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Smallest value with a colour of its own.
    pub low: f64,
    /// Largest value with a colour of its own.
    pub high: f64,
    /// Values below `low` occur; they take its colour.
    pub below: bool,
    /// Values above `high` occur; they take its colour.
    pub above: bool,
    map: Map,
}

/// The colour maps of scales.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Map {
    /// Of one sign.
    Sequential,
    /// Of both signs, with grey at zero.
    Diverging,
    /// Dark on light.
    Grey,
}

impl Scale {
    /// From the paper at a value to black at a higher one, `above` which some may lie.
    #[must_use]
    pub fn grey([low, high]: [f64; 2], above: bool) -> Self {
        Self {
            low,
            high,
            below: false,
            above,
            map: Map::Grey,
        }
    }

    /// The scale over a given range, or over all values.
    ///
    /// Without a given range a few outliers, at most 0.2 % at each end, are cut off if the range
    /// of all others is less than half as wide. Values of both signs, the smaller at least a tenth
    /// of the larger, get a diverging map with grey at zero; all others viridis.
    pub fn new(values: impl Iterator<Item = f64>, range: Option<[f64; 2]>) -> Self {
        let mut values: Vec<f64> = values.filter(|v| v.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        let ends = match (values.first(), values.last()) {
            (Some(&low), Some(&high)) => [low, high],
            _ => [0.0, 1.0],
        };
        let [low, high] = range.unwrap_or_else(|| widen(without_tails(&values, ends)));
        let smaller = high.abs().min(low.abs());
        let larger = high.abs().max(low.abs());
        let map = if low < 0.0 && high > 0.0 && smaller >= 0.1 * larger {
            Map::Diverging
        } else {
            Map::Sequential
        };
        Self {
            low,
            high,
            below: ends[0] < low,
            above: ends[1] > high,
            map,
        }
    }

    /// The colour of a value.
    #[must_use]
    pub fn colour(&self, value: f64) -> Rgb {
        if !value.is_finite() {
            return NOT_FINITE;
        }
        let value = value.clamp(self.low, self.high);
        let share = (value - self.low) / (self.high - self.low);
        match self.map {
            Map::Diverging => {
                // Zero in the middle; an uneven range uses one half of the map only in part, so that
                // equal magnitudes are equally strong.
                let reach = self.high.max(-self.low);
                sample(&COOL_WARM, 0.5 + 0.5 * value / reach)
            }
            Map::Sequential => sample(&VIRIDIS, share),
            Map::Grey => sample(&GREY, share),
        }
    }
}

/// The colour at a share of a map, 0 to 1.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the map first; a mean of two bytes is a byte"
)]
fn sample(map: &[Rgb; 17], share: f64) -> Rgb {
    let position = 16.0 * share.clamp(0.0, 1.0);
    let first = (position as usize).min(15);
    let part = position - first as f64;
    let mix = |k: usize| {
        let (a, b) = (f64::from(map[first][k]), f64::from(map[first + 1][k]));
        (a + part * (b - a)).round() as u8
    };
    [mix(0), mix(1), mix(2)]
}

/// The ends of sorted values, without outliers if these take more than half of the range.
fn without_tails(sorted: &[f64], ends: [f64; 2]) -> [f64; 2] {
    if sorted.is_empty() {
        return ends;
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small share of a length"
    )]
    let cut = (TAIL * sorted.len() as f64) as usize;
    let inner = [sorted[cut], sorted[sorted.len() - 1 - cut]];
    if 2.0 * (inner[1] - inner[0]) < ends[1] - ends[0] && inner[0] < inner[1] {
        inner
    } else {
        ends
    }
}

/// A range of some width about a field that is constant but for round-off.
fn widen([low, high]: [f64; 2]) -> [f64; 2] {
    let size = low.abs().max(high.abs());
    if size == 0.0 {
        [0.0, 1.0]
    } else if high - low < 1e-9 * size {
        [low - 0.01 * size, high + 0.01 * size]
    } else {
        [low, high]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn viridis_runs_from_dark_to_light() {
        let scale = Scale::new([0.0, 10.0].into_iter(), None);
        assert_eq!(scale.colour(0.0), [68, 1, 84]);
        assert_eq!(scale.colour(10.0), [253, 231, 37]);
        assert_eq!(scale.colour(f64::NAN), NOT_FINITE);
    }

    #[test]
    fn signed_fields_are_grey_at_zero() {
        let scale = Scale::new([-1.0, 4.0].into_iter(), None);
        assert_eq!(scale.map, Map::Diverging);
        assert_eq!(scale.colour(0.0), [221, 221, 221]);
        let (low, high) = (scale.colour(-1.0), scale.colour(4.0));
        assert!(
            low[2] > low[0] && high[0] > high[2],
            "negative blue, positive red"
        );
        assert_eq!(high, [180, 4, 38]);
        assert_eq!(
            low,
            [184, 208, 249],
            "a quarter of the reach is a pale blue"
        );
    }

    #[test]
    fn a_little_tension_leaves_pressure_sequential() {
        assert!(Scale::new([-1.2, 97.0].into_iter(), None).map == Map::Sequential);
    }

    #[test]
    fn single_outliers_do_not_darken_the_picture() {
        let values = (0..2000).map(f64::from).chain([1e6]);
        let scale = Scale::new(values, None);
        assert!(scale.high < 2000.0 && scale.above && scale.low < 10.0);
        let even = Scale::new((0..2000).map(f64::from), None);
        assert!(!even.above && !even.below);
    }

    #[test]
    fn constant_fields_have_a_range() {
        for value in [0.0, -3.0, 2785.0] {
            let scale = Scale::new([value, value].into_iter(), None);
            assert!(scale.low < scale.high, "{value}");
        }
        let none = Scale::new(std::iter::empty(), None);
        assert!(none.low < none.high);
    }

    #[test]
    fn a_given_range_marks_what_lies_outside() {
        let scale = Scale::new([0.0, 10.0].into_iter(), Some([2.0, 20.0]));
        assert!(scale.below && !scale.above);
        assert_eq!(scale.colour(-5.0), scale.colour(2.0));
    }

    #[test]
    fn bodies_differ() {
        let colours: Vec<Rgb> = (0..14).map(body).collect();
        for (i, a) in colours.iter().enumerate() {
            assert!(!colours[..i].contains(a));
        }
    }
}
