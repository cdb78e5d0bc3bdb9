//! Velocities prescribed as functions of time.

/// A prescribed velocity: on each axis free, or a table of time, linear between its entries and
/// constant before the first and after the last. Two entries of the same time are a jump, at
/// which the later one holds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Motion {
    /// Times (s), none before the one ahead of it.
    pub times: Vec<f64>,
    /// Velocities at these times (m/s) on each axis; an axis without is free.
    pub velocities: [Option<Vec<f64>>; 3],
}

impl Motion {
    /// A constant velocity (m/s) on all axes.
    #[must_use]
    pub fn constant(velocity: [f64; 3]) -> Self {
        Self {
            times: vec![0.0],
            velocities: velocity.map(|v| Some(vec![v])),
        }
    }

    /// `true` if the velocity along an axis is prescribed.
    #[must_use]
    pub fn has(&self, axis: usize) -> bool {
        self.velocities[axis].is_some()
    }

    /// Largest speed (m/s), or somewhat more.
    #[must_use]
    pub fn largest_speed(&self) -> f64 {
        let axes = self.velocities.iter().flatten();
        let largest = axes.map(|values| values.iter().fold(0.0_f64, |most, v| most.max(v.abs())));
        largest.map(|v| v * v).fold(0.0, |sum, v| sum + v).sqrt()
    }

    /// Velocity along an axis (m/s) at time `t` (s); zero on a free axis.
    #[must_use]
    pub fn velocity(&self, axis: usize, t: f64) -> f64 {
        let Some(values) = &self.velocities[axis] else {
            return 0.0;
        };
        self.on_segment(values, self.times.partition_point(|&x| x <= t), t)
    }

    /// Mean velocity along an axis (m/s) from time `from` to `to` (s); the velocity at `from` if
    /// that is not before `to`.
    #[must_use]
    pub fn mean(&self, axis: usize, from: f64, to: f64) -> f64 {
        let Some(values) = &self.velocities[axis] else {
            return 0.0;
        };
        if from >= to {
            return self.velocity(axis, from);
        }
        let first = self.times.partition_point(|&x| x <= from);
        let last = self.times.partition_point(|&x| x < to);
        let mean = |segment, a, b| {
            0.5 * (self.on_segment(values, segment, a) + self.on_segment(values, segment, b))
        };
        if first == last {
            return mean(first, from, to);
        }
        // About the first value, so that a constant stays one to the bit.
        let base = self.on_segment(values, first, from);
        let mut moved = 0.0;
        let mut a = from;
        for segment in first..=last {
            let b = if segment == last {
                to
            } else {
                self.times[segment]
            };
            moved += (mean(segment, a, b) - base) * (b - a);
            a = b;
        }
        base + moved / (to - from)
    }

    /// Smallest and largest velocity along an axis (m/s) from time `from` to `to` (s), if it is
    /// prescribed.
    #[must_use]
    pub fn range(&self, axis: usize, from: f64, to: f64) -> Option<[f64; 2]> {
        let values = self.velocities[axis].as_ref()?;
        let entries = self.times.iter().zip(values);
        let within = entries.filter(|(time, _)| (from..=to).contains(*time));
        let ends = [from, to].map(|t| self.velocity(axis, t));
        let all = within.map(|(_, &value)| value).chain(ends);
        Some(
            all.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], v| {
                [least.min(v), most.max(v)]
            }),
        )
    }

    /// The value at `t` on the line between entries `segment − 1` and `segment`.
    fn on_segment(&self, values: &[f64], segment: usize, t: f64) -> f64 {
        let last = values.len() - 1;
        if segment == 0 || segment > last {
            return values[segment.min(last)];
        }
        let (a, b) = (self.times[segment - 1], self.times[segment]);
        let (from, to) = (values[segment - 1], values[segment]);
        if b > a {
            from + (to - from) * ((t - a) / (b - a))
        } else {
            to
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(points: &[(f64, f64)]) -> Motion {
        Motion {
            times: points.iter().map(|p| p.0).collect(),
            velocities: [Some(points.iter().map(|p| p.1).collect()), None, None],
        }
    }

    /// Values that are exact in doubles are held exactly.
    fn same(a: f64, b: f64) {
        assert_eq!(a.to_bits(), b.to_bits(), "{a} is not {b}");
    }

    #[test]
    fn a_constant_is_constant_to_the_bit() {
        let motion = Motion::constant([0.1, 0.2, 0.3]);
        for (from, to) in [(0.0, 0.7), (1e-9, 3e5), (2.0, 2.0)] {
            same(motion.velocity(1, from), 0.2);
            same(motion.mean(2, from, to), 0.3);
        }
        let ends = table(&[(0.0, 0.1), (1.0, 0.1)]);
        same(ends.mean(0, 0.3, 1.7), 0.1);
        same(ends.velocity(1, 0.5), 0.0);
        assert!(!ends.has(1));
    }

    #[test]
    fn ranges_hold_all_that_comes_between() {
        let motion = table(&[(1.0, 2.0), (3.0, 4.0), (3.0, 8.0), (4.0, 8.0), (4.0, 0.0)]);
        assert_eq!(motion.range(0, 0.0, 2.0), Some([2.0, 3.0]));
        assert_eq!(motion.range(0, 2.5, 3.5), Some([3.5, 8.0]));
        assert_eq!(motion.range(0, 3.9, 4.0), Some([0.0, 8.0]));
        assert_eq!(motion.range(0, 5.0, f64::INFINITY), Some([0.0, 0.0]));
        assert_eq!(motion.range(1, 0.0, 9.0), None);
    }

    #[test]
    fn between_entries_lines_and_at_equal_times_jumps() {
        let motion = table(&[(1.0, 2.0), (3.0, 4.0), (3.0, 8.0), (4.0, 8.0), (4.0, 0.0)]);
        for (t, v) in [
            (0.0, 2.0),
            (1.0, 2.0),
            (2.0, 3.0),
            (3.0, 8.0),
            (3.5, 8.0),
            (4.0, 0.0),
        ] {
            same(motion.velocity(0, t), v);
        }
        same(motion.velocity(0, 9.0), 0.0);
        same(motion.mean(0, 1.0, 3.0), 3.0);
        same(motion.mean(0, 2.0, 3.0), 3.5);
        // 2·1 before the table, 3·2 in it, 8·1 after the jump, then rest.
        same(motion.mean(0, 0.0, 8.0), 2.0);
        same(motion.mean(0, 3.5, 4.5), 4.0);
    }
}
