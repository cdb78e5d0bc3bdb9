//! Functions of time that are constant between jumps.

/// A value for all times before the first jump, and one from each jump on.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Steps {
    /// Times, rising, and the values from then on; the first time is −∞.
    jumps: Vec<(f64, f64)>,
}

impl Steps {
    /// The same value for ever.
    pub fn new(value: f64) -> Self {
        Self {
            jumps: vec![(f64::NEG_INFINITY, value)],
        }
    }

    /// Another value from `time` on, which is later than all before.
    pub fn push(&mut self, time: f64, value: f64) {
        debug_assert!(time > self.jumps[self.jumps.len() - 1].0);
        self.jumps.push((time, value));
    }

    /// The value at a time.
    pub fn at(&self, time: f64) -> f64 {
        self.jumps[self.index(time)].1
    }

    /// The value from the last jump on.
    pub fn last(&self) -> f64 {
        self.jumps[self.jumps.len() - 1].1
    }

    /// The first jump later than a time.
    pub fn first_after(&self, time: f64) -> Option<f64> {
        self.jumps.get(self.index(time) + 1).map(|jump| jump.0)
    }

    /// Times of the jumps, rising.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        self.jumps[1..].iter().map(|jump| jump.0)
    }

    /// The integral over time from `a` to `b ≥ a`.
    pub fn integral(&self, a: f64, b: f64) -> f64 {
        let mut sum = 0.0;
        let mut start = a;
        for k in self.index(a)..self.jumps.len() {
            let end = self.jumps.get(k + 1).map_or(b, |next| next.0.min(b));
            sum += self.jumps[k].1 * (end - start);
            start = end;
            if end >= b {
                break;
            }
        }
        sum
    }

    /// The jump whose value holds at a time.
    fn index(&self, time: f64) -> usize {
        self.jumps.partition_point(|jump| jump.0 <= time) - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_integrals_follow_the_jumps() {
        let mut steps = Steps::new(1.0);
        steps.push(2.0, 3.0);
        steps.push(3.0, -1.0);
        assert_eq!(
            [-9.0, 1.9, 2.0, 2.9, 5.0].map(|t| steps.at(t)),
            [1.0, 1.0, 3.0, 3.0, -1.0]
        );
        assert_eq!(steps.integral(0.0, 5.0), 2.0 + 3.0 - 2.0);
        assert_eq!(steps.integral(2.25, 2.75), 1.5);
        assert_eq!(steps.integral(4.0, 4.0), 0.0);
        assert_eq!(steps.first_after(2.0), Some(3.0));
        assert_eq!(steps.first_after(3.0), None);
    }
}
