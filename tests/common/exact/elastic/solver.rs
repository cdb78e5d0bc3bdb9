//! From event to event: what arrives at an end, and how it answers.

use super::super::steps::Steps;
use super::{Bar, End, Joint, Link, ROUND_OFF, Row, Waves};

/// Goes from event to event.
pub(super) struct Solver<'a> {
    row: &'a Row,
    waves: Waves,
    /// Gap of each joint (m).
    gaps: Vec<f64>,
    /// Gaps narrower than this are none (m).
    touching: f64,
    /// Times closer than this are one (s).
    instant: f64,
    /// Velocities closer than this are one (m/s).
    speck: f64,
}

impl<'a> Solver<'a> {
    /// The row at the start.
    pub fn new(row: &'a Row) -> Self {
        let bars = &row.bars;
        let transits = bars.iter().map(Bar::transit);
        let given = row.ends.iter().flat_map(|end| match end {
            End::Free => &[][..],
            End::Moved(steps) => &steps[..],
        });
        let velocities = bars
            .iter()
            .map(|b| b.velocity)
            .chain(given.filter_map(|&(_, v)| v));
        let gap = |pair: &[Bar]| pair[1].left - (pair[0].left + pair[0].length);
        let mut gaps: Vec<f64> = bars.windows(2).map(gap).collect();
        for (gap, joint) in gaps.iter_mut().zip(&row.joints) {
            if *joint == Joint::Bonded {
                *gap = 0.0;
            }
        }
        Self {
            row,
            gaps,
            touching: ROUND_OFF * bars.iter().map(|b| b.length).fold(f64::INFINITY, f64::min),
            instant: ROUND_OFF * transits.fold(f64::INFINITY, f64::min),
            speck: ROUND_OFF * velocities.fold(0.0, |most, v| v.abs().max(most)),
            waves: Waves {
                bars: bars.clone(),
                sent: bars
                    .iter()
                    .map(|b| [0, 1].map(|_| Steps::new(b.velocity)))
                    .collect(),
                links: vec![Vec::new(); row.joints.len()],
            },
        }
    }

    /// Follows the row until `until` (s).
    pub fn run(mut self, until: f64) -> Waves {
        let mut now = 0.0;
        loop {
            self.answer(now);
            let next = self.next_event(now);
            if next > until {
                return self.waves;
            }
            for (gap, links) in self.gaps.iter_mut().zip(&self.waves.links) {
                let link = links.last().expect("a joint has its first state");
                *gap += (link.velocities[1] - link.velocities[0]) * (next - now);
            }
            now = next;
        }
    }

    /// Lets every end answer to what arrives at `now`.
    fn answer(&mut self, now: f64) {
        let last = self.row.bars.len() - 1;
        let left = self.end(0, self.arriving(0, 0, now), now);
        self.send(0, 0, now, left);
        for joint in 0..last {
            self.answer_at_joint(joint, now);
        }
        let right = self.end(1, self.arriving(last, 1, now), now);
        self.send(last, 1, now, right);
    }

    fn answer_at_joint(&mut self, joint: usize, now: f64) {
        let pair = [&self.row.bars[joint], &self.row.bars[joint + 1]];
        let [z_a, z_b] = pair.map(Bar::impedance);
        let r = self.arriving(joint, 1, now);
        let l = self.arriving(joint + 1, 0, now);
        let touch = match self.row.joints[joint] {
            Joint::Bonded => true,
            Joint::Contact => self.gaps[joint] <= self.touching && l - r < -self.speck,
        };
        let (velocities, stress) = if touch {
            self.gaps[joint] = 0.0;
            let common = (z_a * r + z_b * l) / (z_a + z_b);
            ([common; 2], z_a * z_b * (l - r) / (z_a + z_b))
        } else {
            ([r, l], 0.0)
        };
        self.send(joint, 1, now, 2.0 * velocities[0] - r);
        self.send(joint + 1, 0, now, 2.0 * velocities[1] - l);
        let link = Link {
            time: now,
            velocities,
            stress,
            gap: self.gaps[joint],
        };
        let links = &mut self.waves.links[joint];
        let same = |old: &Link| old.velocities == velocities && old.stress == stress;
        if !links.last().is_some_and(same) {
            links.push(link);
        }
    }

    /// What an outer end sends when `arrived` comes to it.
    fn end(&self, end: usize, arrived: f64, now: f64) -> f64 {
        match &self.row.ends[end] {
            End::Free => arrived,
            End::Moved(steps) => {
                let given = steps.iter().rev().find(|s| s.0 <= now + self.instant);
                given
                    .and_then(|s| s.1)
                    .map_or(arrived, |v| 2.0 * v - arrived)
            }
        }
    }

    /// What comes to an end (0 left, 1 right) of a bar from its other one.
    fn arriving(&self, bar: usize, end: usize, now: f64) -> f64 {
        let delay = self.row.bars[bar].transit();
        self.waves.sent[bar][1 - end].at(now - delay + self.instant)
    }

    fn send(&mut self, bar: usize, end: usize, now: f64, value: f64) {
        let steps = &mut self.waves.sent[bar][end];
        if (value - steps.last()).abs() > self.speck {
            steps.push(now, value);
        }
    }

    /// The next arrival, change of a given velocity, or closing of a gap after `now` (s).
    fn next_event(&self, now: f64) -> f64 {
        let mut next = f64::INFINITY;
        let mut vote = |time: f64| {
            if time > now + self.instant && time < next {
                next = time;
            }
        };
        for (bar, sent) in self.row.bars.iter().zip(&self.waves.sent) {
            for steps in sent {
                if let Some(time) = steps.first_after(now - bar.transit() + self.instant) {
                    vote(time + bar.transit());
                }
            }
        }
        for end in &self.row.ends {
            if let End::Moved(steps) = end {
                for &(time, _) in steps {
                    vote(time);
                }
            }
        }
        for (gap, links) in self.gaps.iter().zip(&self.waves.links) {
            let [a, b] = links.last().map_or([0.0; 2], |link| link.velocities);
            if *gap > self.touching && a - b > self.speck {
                vote(now + (gap / (a - b)).max(2.0 * self.instant));
            }
        }
        next
    }
}
