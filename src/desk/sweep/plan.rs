//! The points of a sweep: a grid of all values, or the halves of a range in which a condition
//! changes.
//!
//! A plan is a pure function of the known points, so a sweep that was killed goes on as if it had
//! not been.

use std::collections::BTreeMap;

use super::condition::Condition;
use super::point::Point;
use super::values::{Range, Value, Values};

/// Parts of a range at which a bisection ends.
pub const WITHIN: f64 = 1.0 / 16.0;
/// Points of a sweep at most.
const MOST: usize = 1_000_000;

/// A key and its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Varied {
    /// Dotted.
    pub key: String,
    /// Its values.
    pub values: Values,
}

impl Varied {
    /// Reads `key=values`.
    ///
    /// # Errors
    /// A message on a text of another form.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (key, values) = text
            .split_once('=')
            .ok_or_else(|| format!("`{text}` has no `=`: write key=values"))?;
        let key = key.trim();
        if key.is_empty() {
            return Err(format!("`{text}` has no key before its `=`"));
        }
        let values = Values::parse(values).map_err(|why| format!("`{key}`: {why}"))?;
        let key = key.to_owned();
        Ok(Self { key, values })
    }
}

/// A range that is bisected.
#[derive(Debug, Clone, PartialEq)]
pub struct Bisected {
    /// The range.
    pub range: Range,
    /// The condition that changes in it.
    pub condition: Condition,
    /// The tolerance of the change, as a share of the range.
    pub within: f64,
}

/// The points of a sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Keys in the order of the values of points; that of a bisection is the last one.
    pub keys: Vec<String>,
    /// Values of the keys of the grid.
    grid: Vec<Vec<Value>>,
    /// The bisection at each point of the grid.
    pub bisected: Option<Bisected>,
}

/// The condition at a point, by the point's name; nothing for a point that failed.
pub type Known = BTreeMap<String, Option<bool>>;

/// The state of a bisection.
#[derive(Debug, Clone, PartialEq)]
pub enum Bisection {
    /// Not yet all.
    Open,
    /// Between these two values the condition changes: where it does not hold, where it does.
    Between([Value; 2]),
    /// It holds at both ends, or at neither.
    Nowhere(bool),
    /// A run on the way to it failed.
    Failed,
}

impl Plan {
    /// The plan of some keys, the last of which is bisected if there is a condition.
    ///
    /// # Errors
    /// A message on keys or ranges that do not fit.
    pub fn new(varied: &[Varied], bisect: Option<(Condition, f64)>) -> Result<Self, String> {
        let keys: Vec<String> = varied.iter().map(|v| v.key.clone()).collect();
        if let Some(twice) = keys
            .iter()
            .enumerate()
            .find(|(k, key)| keys[..*k].contains(key))
        {
            return Err(format!("`{}` varies twice", twice.1));
        }
        let Some((last, others)) = varied.split_last() else {
            return Err("nothing varies: give --vary key=values".to_owned());
        };
        let (grid, bisected) = match bisect {
            None => (varied, None),
            Some((condition, within)) => {
                let Values::Range(range, _) = &last.values else {
                    return Err(format!(
                        "a bisection needs a range, as in {}=\"1..9 km/s\"",
                        last.key
                    ));
                };
                let range = range.clone();
                let bisected = Bisected {
                    range,
                    condition,
                    within,
                };
                (others, Some(bisected))
            }
        };
        let grid: Vec<Vec<Value>> = grid.iter().map(|v| v.values.all()).collect();
        let count = grid
            .iter()
            .try_fold(1_usize, |n, values| n.checked_mul(values.len()));
        if count.is_none_or(|count| count > MOST) {
            return Err(format!("more than {MOST} points"));
        }
        Ok(Self {
            keys,
            grid,
            bisected,
        })
    }

    /// Values of the grid, the last key fastest.
    #[must_use]
    pub fn combinations(&self) -> Vec<Vec<Value>> {
        let mut all = vec![Vec::new()];
        for values in &self.grid {
            let longer = all.iter().flat_map(|begin: &Vec<Value>| {
                values.iter().map(|value| {
                    let mut values = begin.clone();
                    values.push(value.clone());
                    values
                })
            });
            all = longer.collect();
        }
        all
    }

    /// The points that are wanted, as far as is known: all of a grid; of a bisection those that were and the
    /// next ones. In the order of the table.
    #[must_use]
    pub fn points(&self, known: &Known) -> Vec<Point> {
        let mut points = Vec::new();
        for values in self.combinations() {
            if self.bisected.is_some() {
                let (mut wanted, _) = self.search(&values, known);
                wanted.sort_by(|(a, _), (b, _)| a.total_cmp(b));
                points.extend(wanted.into_iter().map(|(_, point)| point));
            } else {
                points.push(Point::new(&self.keys, values));
            }
        }
        points
    }

    /// The bisection at some values of the grid.
    #[must_use]
    pub fn bisection(&self, values: &[Value], known: &Known) -> Bisection {
        self.search(values, known).1
    }

    /// Shares of the range that a bisection needs, with their points, and its state.
    fn search(&self, values: &[Value], known: &Known) -> (Vec<(f64, Point)>, Bisection) {
        let Some(bisected) = &self.bisected else {
            return (Vec::new(), Bisection::Open);
        };
        let [from, to] = bisected.range.ends;
        let value = |part: f64| bisected.range.value(from + (to - from) * part);
        let mut wanted = Vec::new();
        let mut want = |part: f64| -> Option<Option<bool>> {
            let mut values = values.to_vec();
            values.push(value(part));
            let point = Point::new(&self.keys, values);
            let answer = known.get(&point.name).copied();
            wanted.push((part, point));
            answer
        };
        let ends = [want(0.0), want(1.0)];
        let (Some(first), Some(last)) = (ends[0], ends[1]) else {
            return (wanted, Bisection::Open);
        };
        let (Some(first), Some(last)) = (first, last) else {
            return (wanted, Bisection::Failed);
        };
        if first == last {
            return (wanted, Bisection::Nowhere(first));
        }
        let (mut low, mut high) = (0.0, 1.0);
        while high - low > bisected.within {
            let half = 0.5 * (low + high);
            match want(half) {
                None => return (wanted, Bisection::Open),
                Some(None) => return (wanted, Bisection::Failed),
                Some(Some(holds)) if holds == first => low = half,
                Some(Some(_)) => high = half,
            }
        }
        let (no, yes) = if first { (high, low) } else { (low, high) };
        (wanted, Bisection::Between([value(no), value(yes)]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(vary: &[&str], bisect: Option<&str>) -> Result<Plan, String> {
        let varied: Result<Vec<Varied>, _> = vary.iter().map(|v| Varied::parse(v)).collect();
        let condition = bisect.map(|c| (Condition::parse(c).unwrap(), 0.125));
        Plan::new(&varied?, condition)
    }

    #[test]
    fn a_grid_has_all_pairs_the_last_key_fastest() {
        let plan = plan(&["a=1,2", "b=x,y,z"], None).unwrap();
        let points = plan.points(&Known::new());
        let texts: Vec<String> = points.iter().map(|p| p.settings.join(" ")).collect();
        assert_eq!(
            texts,
            [
                "a=1 b=x", "a=1 b=y", "a=1 b=z", "a=2 b=x", "a=2 b=y", "a=2 b=z"
            ]
        );
    }

    /// Wherever the condition changes, it is found between neighbours within the part asked for, and
    /// each point is asked once.
    #[test]
    fn a_bisection_finds_where_a_condition_changes() {
        for turned in [false, true] {
            let plan = plan(&["a=7", "v=0..8 m/s"], Some("x>1")).unwrap();
            let holds = |v: f64| (v > 5.3) != turned;
            let mut known = Known::new();
            let mut runs = 0;
            loop {
                let points = plan.points(&known);
                let open: Vec<_> = points
                    .iter()
                    .filter(|p| !known.contains_key(&p.name))
                    .collect();
                if open.is_empty() {
                    break;
                }
                for point in open {
                    runs += 1;
                    let v = point.values[1].number.unwrap().0;
                    known.insert(point.name.clone(), Some(holds(v)));
                }
            }
            assert_eq!(runs, 5);
            let values = &plan.combinations()[0];
            let bisection = plan.bisection(values, &known);
            let expected = if turned {
                ["6 m/s", "5 m/s"]
            } else {
                ["5 m/s", "6 m/s"]
            };
            assert_eq!(bisection, Bisection::Between(expected.map(Value::new)));
        }
    }

    #[test]
    fn ends_alike_and_failed_runs_end_a_bisection() {
        let plan = plan(&["v=0..8"], Some("x>1")).unwrap();
        let points = plan.points(&Known::new());
        assert_eq!(points.len(), 2);
        let all = |of: [Option<bool>; 2]| -> Known {
            points.iter().map(|p| p.name.clone()).zip(of).collect()
        };
        let bisection = |known: &Known| plan.bisection(&[], known);
        assert_eq!(
            bisection(&all([Some(true), Some(true)])),
            Bisection::Nowhere(true)
        );
        assert_eq!(bisection(&all([Some(true), None])), Bisection::Failed);
        assert_eq!(bisection(&Known::new()), Bisection::Open);
    }

    #[test]
    fn what_cannot_vary_is_refused() {
        for (vary, bisect, part) in [
            (&["a"][..], None, "no `=`"),
            (&["=1"], None, "no key"),
            (&["a=1..x"], None, "`a`"),
            (&["a=1", "a=2"], None, "twice"),
            (&[], None, "nothing varies"),
            (&["a=1,2"], Some("x>1"), "needs a range"),
            (&["a=0..1/99999", "b=0..1/99999"], None, "more than"),
        ] {
            let message = plan(vary, bisect).unwrap_err();
            assert!(message.contains(part), "{vary:?}: {message}");
        }
    }
}
