//! Points that differ in constants of failure alone share the beginning of their runs: one of them runs from its start, with
//! checkpoints, and the others go on from where its matter is damaged.

use std::collections::{BTreeMap, BTreeSet};

use super::definition::Definition;
use super::point::Point;
use super::{Ended, SweepError};
use files::input::Compared;
use model::{Case, ClockInterval};

/// Checkpoints of a run that others go on from: each of these computes half an interval twice on the mean.
const CHECKPOINTS: u32 = 40;

/// A run with no more checkpoints has not kept them for others.
const FEW: usize = 10;

/// How many of them are kept, at least: a case may ask for more than those.
const MOST: usize = 1000;

/// How the run of a point begins.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Beginning {
    /// From the start of its case, with further settings.
    Start(Vec<String>),
    /// From a checkpoint of another point's run, with the settings of its own.
    Fork { from: String, settings: Vec<String> },
    /// Not yet: it will go on from a run that has not ended.
    Later,
}

/// What is known of which points may go on from which.
#[derive(Debug, Default)]
pub(super) struct Forks {
    /// By a point's name and another's: whether the latter may go on from the former.
    known: BTreeMap<[String; 2], bool>,
    /// By the name of a point: its case.
    cases: BTreeMap<String, Compared>,
    /// Names of points of which [`Self::needed`] has told.
    settled: BTreeSet<String>,
}

impl Forks {
    /// How the run of the point of a number begins, by what has ended so far and by the names of runs that were stopped. `kept` tells how
    /// many checkpoints the run of a point has.
    pub fn beginning(
        &mut self,
        definition: &Definition,
        keys: &[String],
        (points, at): (&[Point], usize),
        (ends, stopped): (&BTreeMap<String, Ended>, &[String]),
        kept: impl Fn(&Point) -> usize,
    ) -> Result<Beginning, SweepError> {
        let own = &points[at];
        let (mut begins, mut waits) = (false, false);
        // Of those that it may go on from the one with the most checkpoints.
        let mut donor: Option<(usize, &Point)> = None;
        for k in kin(keys, points, at) {
            let other = &points[k];
            if !self.may_follow(definition, other, own)? {
                begins |= self.may_follow(definition, own, other)?;
                continue;
            }
            begins = true;
            match ends.get(&other.name) {
                Some(Ended::Answered(_)) => {
                    let count = kept(other);
                    if donor.is_none_or(|(most, _)| count > most) {
                        donor = Some((count, other));
                    }
                }
                Some(Ended::Failed(_)) => {}
                None if stopped.contains(&other.name) => {}
                // Of two that may follow each other the first one begins.
                None => waits |= k < at || !self.may_follow(definition, own, other)?,
            }
        }
        if !begins {
            return Ok(Beginning::Start(Vec::new()));
        }
        // Asked again and again, as long as it waits.
        if waits && donor.is_none() {
            return Ok(Beginning::Later);
        }
        let case = definition.case_of(own)?;
        match donor {
            Some((count, donor)) if count > case.output.checkpoints_kept.min(FEW) => {
                Ok(Beginning::Fork {
                    from: donor.name.clone(),
                    settings: own.settings.iter().cloned().chain(usual(&case)).collect(),
                })
            }
            _ if waits => Ok(Beginning::Later),
            _ => Ok(Beginning::Start(often(&case))),
        }
    }

    /// How many checkpoints the run of the point of a number needs to keep from now on, once it and those that may go on from it
    /// are over; told once.
    pub fn needed(
        &mut self,
        definition: &Definition,
        keys: &[String],
        (points, at): (&[Point], usize),
        is_over: impl Fn(&Point) -> bool,
    ) -> Result<Option<usize>, SweepError> {
        if self.settled.contains(&points[at].name) {
            return Ok(None);
        }
        let mut kin = kin(keys, points, at).peekable();
        if kin.peek().is_none() || !is_over(&points[at]) || !kin.all(|k| is_over(&points[k])) {
            return Ok(None);
        }
        Ok(Some(
            definition.case_of(&points[at])?.output.checkpoints_kept,
        ))
    }

    fn may_follow(
        &mut self,
        definition: &Definition,
        first: &Point,
        then: &Point,
    ) -> Result<bool, SweepError> {
        let pair = [&first.name, &then.name].map(String::clone);
        if let Some(&known) = self.known.get(&pair) {
            return Ok(known);
        }
        for point in [first, then] {
            if !self.cases.contains_key(&point.name) {
                let case = Compared::of(&definition.case_of(point)?);
                self.cases.insert(point.name.clone(), case);
            }
        }
        let [a, b] = [first, then].map(|point| &self.cases[&point.name]);
        let may = a.apart_once_damaged(b).is_ok();
        self.known.insert(pair, may);
        Ok(may)
    }
}

/// The numbers of the other points that differ from one in constants of failure alone.
fn kin<'a>(keys: &'a [String], points: &'a [Point], at: usize) -> impl Iterator<Item = usize> + 'a {
    let is_of_failure = |key: &str| key.starts_with("material.") && key.contains(".failure.");
    let is_kin = move |other: &Point| {
        let mut values = keys.iter().zip(points[at].values.iter().zip(&other.values));
        values.all(|(key, (a, b))| a == b || is_of_failure(key))
    };
    (0..points.len()).filter(move |&k| k != at && is_kin(&points[k]))
}

/// Settings by which a run keeps checkpoints for others, which change none of its bits.
fn often(case: &Case) -> Vec<String> {
    let output = &case.output;
    let every = case.run.end_time / f64::from(CHECKPOINTS);
    let own = output.checkpoint_every.unwrap_or(f64::INFINITY);
    let kept = output.checkpoints_kept.max(MOST);
    let mut settings = vec![
        format!("output.checkpoint_every={:e} s", every.min(own)),
        format!("output.checkpoints_kept={kept}"),
    ];
    // More of them would take the place of the first ones.
    let by_steps = output.checkpoint_every_steps;
    settings.extend(by_steps.map(|_| format!("output.checkpoint_every_steps={}", i64::MAX)));
    let by_clock = output.checkpoint_every_wall;
    settings.extend(by_clock.map(|_| "output.checkpoint_every_wall=1e9 s".to_owned()));
    settings
}

/// The settings of the case in place of those.
fn usual(case: &Case) -> Vec<String> {
    let output = &case.output;
    let every = output.checkpoint_every.unwrap_or(case.run.end_time);
    let mut settings = vec![
        format!("output.checkpoint_every={every:e} s"),
        format!("output.checkpoints_kept={}", output.checkpoints_kept),
    ];
    let by_steps = output.checkpoint_every_steps;
    settings.extend(by_steps.map(|steps| format!("output.checkpoint_every_steps={steps}")));
    let by_clock = output.checkpoint_every_wall.map(|interval| match interval {
        ClockInterval::Fixed(seconds) => format!("{seconds:e} s"),
        ClockInterval::Auto { .. } => "auto".to_owned(),
    });
    settings.extend(by_clock.map(|text| format!("output.checkpoint_every_wall={text}")));
    settings
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    const CASE: &str = "dimension = 3\nspacing = \"1 mm\"\nrun.end_time = \"1 us\"\n[material.a]\n\
         library = \"aluminium-2024-ductile\"\n[[body]]\nname = \"a\"\nmaterial = \"a\"\n\
         shape.sphere = { centre = [0, 0, 0], radius = \"3 mm\" }\n";

    fn definition(folder: &Path) -> Definition {
        let case = folder.join("case.toml");
        std::fs::write(&case, CASE).unwrap();
        Definition {
            folder: folder.join("sweep"),
            case,
            digest: String::new(),
            settings: Vec::new(),
            vary: vec!["material.a.failure.spall.pressure=-1.8, -1.4, -1 GPa".to_owned()],
            scatter: Vec::new(),
            converges: false,
            bisect: None,
            within: super::super::WITHIN,
            answers: Vec::new(),
        }
    }

    /// The weakest limit begins, and the others wait for it, unless it has failed or was stopped.
    #[test]
    fn points_wait_for_what_they_go_on_from_as_long_as_it_may_come() {
        let place = tempfile::tempdir().unwrap();
        let definition = definition(place.path());
        let plan = definition.plan().unwrap();
        let points = plan.points(&BTreeMap::new());
        let begin = |at: usize, ends: &BTreeMap<String, Ended>, stopped: &[String]| {
            let all = (&points[..], at);
            let mut forks = Forks::default();
            forks
                .beginning(&definition, &plan.keys, all, (ends, stopped), |_| 41)
                .unwrap()
        };
        let is_start =
            |beginning: Beginning| matches!(beginning, Beginning::Start(more) if more.len() == 2);
        let none = BTreeMap::new();
        assert!(is_start(begin(2, &none, &[])));
        assert_eq!(begin(0, &none, &[]), Beginning::Later);
        assert_eq!(begin(1, &none, &[]), Beginning::Later);
        let weakest = points[2].name.clone();
        assert!(is_start(begin(1, &none, std::slice::from_ref(&weakest))));
        let mut ends = BTreeMap::from([(weakest.clone(), Ended::Failed(String::new()))]);
        assert!(is_start(begin(1, &ends, &[])));
        ends.insert(weakest.clone(), Ended::Answered(BTreeMap::new()));
        let fork = begin(0, &ends, &[]);
        assert!(
            matches!(&fork, Beginning::Fork { from, .. } if *from == weakest),
            "{fork:?}"
        );
    }
}
