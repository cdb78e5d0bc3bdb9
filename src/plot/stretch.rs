//! The parts of a line near a frame: the rest is not seen, and need not be in a picture.

use super::frame::Frame;

/// Places beyond it are moved there, so that products of them are numbers.
const FARTHEST: f64 = 1e30;

/// The stretches of a line through points that lie within a frame.
pub fn stretches(points: &[(f32, f32)], frame: &Frame) -> Vec<Vec<(f32, f32)>> {
    let mut all: Vec<Vec<(f32, f32)>> = Vec::new();
    let mut is_open = false;
    for pair in points.windows(2) {
        let Some([start, end]) = within(pair[0], pair[1], frame) else {
            is_open = false;
            continue;
        };
        match all.last_mut() {
            Some(last) if is_open && start == pair[0] => last.push(end),
            _ => all.push(vec![start, end]),
        }
        is_open = end == pair[1];
    }
    all
}

/// The part of a segment within a frame (Liang & Barsky 1984).
#[expect(
    clippy::cast_possible_truncation,
    reason = "back to where it came from"
)]
fn within(a: (f32, f32), b: (f32, f32), frame: &Frame) -> Option<[(f32, f32); 2]> {
    let clamped = |at: (f32, f32)| [at.0, at.1].map(|c| f64::from(c).clamp(-FARTHEST, FARTHEST));
    let (from, to) = (clamped(a), clamped(b));
    let low = [frame.left, frame.top].map(f64::from);
    let high = [frame.right(), frame.bottom()].map(f64::from);
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for k in 0..2 {
        let way = to[k] - from[k];
        let shares = [(low[k] - from[k]) / way, (high[k] - from[k]) / way];
        if way == 0.0 {
            if from[k] < low[k] || from[k] > high[k] {
                return None;
            }
        } else {
            first = first.max(shares[0].min(shares[1]));
            last = last.min(shares[0].max(shares[1]));
        }
    }
    let at = |share: f64| {
        let [x, y] = [0, 1].map(|k| from[k] + share * (to[k] - from[k]));
        (x as f32, y as f32)
    };
    let start = if first == 0.0 { a } else { at(first) };
    let end = if last == 1.0 { b } else { at(last) };
    (first <= last).then_some([start, end])
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Frame = Frame {
        left: 0.0,
        top: 0.0,
        width: 10.0,
        height: 10.0,
    };

    #[test]
    fn lines_are_cut_where_they_leave_the_frame() {
        let inside = [(1.0, 1.0), (2.0, 3.0), (4.0, 3.0)];
        assert_eq!(stretches(&inside, &FRAME), [inside.to_vec()]);
        let out_and_in = [(5.0, 5.0), (15.0, 5.0), (15.0, 8.0), (-5.0, 8.0)];
        let parts = stretches(&out_and_in, &FRAME);
        let known = [vec![(5.0, 5.0), (10.0, 5.0)], vec![(10.0, 8.0), (0.0, 8.0)]];
        assert_eq!(parts, known);
        assert!(stretches(&[(-1.0, -1.0), (-1.0, 20.0)], &FRAME).is_empty());
    }

    #[test]
    fn the_slope_stays_however_far_a_line_goes() {
        let parts = stretches(&[(5.0, 5.0), (1e20, 2e20)], &FRAME);
        assert_eq!(parts, [vec![(5.0, 5.0), (7.5, 10.0)]]);
        assert_eq!(
            stretches(&[(5.0, 5.0), (5.0, f32::INFINITY)], &FRAME)[0][1],
            (5.0, 10.0)
        );
    }
}
