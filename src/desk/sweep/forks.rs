//! Points that differ in constants of failure alone share the beginning of their runs: one of them runs from its start, with
//! checkpoints, and the others go on from where its matter is damaged.

use std::collections::BTreeMap;

use super::definition::Definition;
use super::point::Point;
use super::{Ended, SweepError};
use files::input::apart_once_damaged;
use model::Case;

/// Checkpoints of a run that others go on from: each of these computes half an interval twice on the mean.
const CHECKPOINTS: f64 = 40.0;

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
    /// Points whose runs keep more checkpoints than their case asks for, and how many that are.
    pub trunks: Vec<(Point, usize)>,
}

impl Forks {
    /// How the run of the point of a number begins, by what has ended so far.
    pub fn beginning(
        &mut self,
        definition: &Definition,
        keys: &[String],
        points: &[Point],
        at: usize,
        ends: &BTreeMap<String, Ended>,
    ) -> Result<Beginning, SweepError> {
        let own = &points[at];
        let kin: Vec<usize> = (0..points.len())
            .filter(|&k| k != at && is_kin(keys, &points[k], own))
            .collect();
        let mut begins = false;
        let mut waits = false;
        for &k in &kin {
            let other = &points[k];
            if !self.may_follow(definition, other, own)? {
                begins |= self.may_follow(definition, own, other)?;
                continue;
            }
            match ends.get(&other.name) {
                Some(Ended::Answered(_)) => {
                    let case = definition.case_of(own)?;
                    return Ok(Beginning::Fork {
                        from: other.name.clone(),
                        settings: own.settings.iter().cloned().chain(usual(&case)).collect(),
                    });
                }
                Some(Ended::Failed(_)) => {}
                // Of two that may follow each other the first one begins.
                None => waits |= k < at || !self.may_follow(definition, own, other)?,
            }
            begins = true;
        }
        if waits {
            return Ok(Beginning::Later);
        }
        if !begins {
            return Ok(Beginning::Start(Vec::new()));
        }
        let case = definition.case_of(own)?;
        self.trunks
            .push((own.clone(), case.output.checkpoints_kept));
        Ok(Beginning::Start(often(&case)))
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
        let (a, b) = (definition.case_of(first)?, definition.case_of(then)?);
        let may = apart_once_damaged(&a, &b).is_ok();
        self.known.insert(pair, may);
        Ok(may)
    }
}

/// True if two points differ in constants of failure alone.
fn is_kin(keys: &[String], a: &Point, b: &Point) -> bool {
    let is_of_failure = |key: &str| key.starts_with("material.") && key.contains(".failure.");
    let mut values = keys.iter().zip(a.values.iter().zip(&b.values));
    values.all(|(key, (a, b))| a == b || is_of_failure(key))
}

/// Settings by which a run keeps checkpoints for others, which change none of its bits.
fn often(case: &Case) -> Vec<String> {
    let every = case.run.end_time / CHECKPOINTS;
    let own = case.output.checkpoint_every.unwrap_or(f64::INFINITY);
    // The last one is at the end, and each of those by steps or the clock comes on top.
    let kept = 4.0 * CHECKPOINTS;
    vec![
        format!("output.checkpoint_every={:e} s", every.min(own)),
        format!("output.checkpoints_kept={kept}"),
    ]
}

/// The settings of the case in place of those.
fn usual(case: &Case) -> [String; 2] {
    let output = &case.output;
    let every = output.checkpoint_every.unwrap_or(case.run.end_time);
    [
        format!("output.checkpoint_every={every:e} s"),
        format!("output.checkpoints_kept={}", output.checkpoints_kept),
    ]
}
