//! The conditions of bisections: `fragments.largest_mass<1 mg`, `history.interpenetrated==0`.

use super::answers::Answers;
use model::readable::shown;
use model::units;

/// A comparison operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Compared {
    Below,
    Above,
    Equal,
    Different,
}

/// Verdicts of plates that have failed, as designers of shields count them.
const FAILED: [&str; 2] = ["detached spall", "perforated"];

/// Verdicts that are none: of plates that nothing has reached, or that go on.
const NO_VERDICT: [&str; 2] = ["not_loaded", "still_moving"];

/// A condition on the answers of a run.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition {
    /// A comparison of an answer.
    Compares(Comparison),
    /// The failure of a plate: that of a name, or the only one.
    Failed(Option<String>),
}

/// An answer and what it is compared with.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    name: String,
    compared: Compared,
    with: String,
}

impl Condition {
    /// Reads `NAME<NUMBER`, `NAME>NUMBER`, `NAME==WORD` or `NAME!=WORD`, `failed` or `failed
    /// PLATE`.
    ///
    /// # Errors
    /// A message on a text of another form.
    pub fn parse(text: &str) -> Result<Self, String> {
        let signs = [
            ("==", Compared::Equal),
            ("!=", Compared::Different),
            ("<", Compared::Below),
            (">", Compared::Above),
        ];
        let text = text.trim();
        if let Some(rest) = text.strip_prefix("failed") {
            let name = rest.trim();
            if rest.is_empty() {
                return Ok(Self::Failed(None));
            }
            if rest.starts_with(' ') && !name.contains(['<', '>', '=']) {
                return Ok(Self::Failed(Some(name.to_owned())));
            }
        }
        let comparison = signs.iter().find_map(|&(sign, compared)| {
            let (name, with) = text.split_once(sign)?;
            Some((name.trim(), compared, with.trim()))
        });
        let Some((name, compared, with)) = comparison.filter(|(name, _, _)| !name.is_empty())
        else {
            return Err(format!(
                "`{text}` is no condition, such as `failed`, \
                 `bodies.sphere.largest_temperature>900 K` or `history.interpenetrated==0`"
            ));
        };
        if matches!(compared, Compared::Below | Compared::Above) {
            units::parse(with)?;
        }
        Ok(Self::Compares(Comparison {
            name: name.to_owned(),
            compared,
            with: with.to_owned(),
        }))
    }

    /// The table of the answer.
    #[must_use]
    pub fn table(&self) -> &str {
        match self {
            Self::Compares(comparison) => {
                let table = comparison.name.split('.').next();
                table.unwrap_or_default()
            }
            Self::Failed(_) => "measures",
        }
    }

    /// `true` if there is no such answer.
    #[must_use]
    pub fn is_unknown(&self, answers: &Answers) -> bool {
        match self {
            Self::Compares(comparison) => !answers.contains_key(&comparison.name),
            Self::Failed(name) => !answers.keys().any(|answer| {
                let plate = answer.strip_suffix(".verdict");
                let plate = plate.and_then(|answer| answer.strip_prefix("measures."));
                plate.is_some_and(|plate| name.as_deref().is_none_or(|name| name == plate))
            }),
        }
    }

    /// `true` if it holds.
    ///
    /// # Errors
    /// A message if the run has no such answer, or one that cannot be compared.
    pub fn holds(&self, answers: &Answers) -> Result<bool, String> {
        match self {
            Self::Compares(comparison) => comparison.holds(answers),
            Self::Failed(name) => has_failed(name.as_deref(), answers),
        }
    }
}

/// `true` if a plate has failed: that of a name, or the only one.
fn has_failed(name: Option<&str>, answers: &Answers) -> Result<bool, String> {
    let verdicts = answers.iter().filter_map(|(answer, value)| {
        let plate = answer.strip_prefix("measures.")?.strip_suffix(".verdict")?;
        Some((plate, value.text.as_str()))
    });
    let wanted = verdicts.filter(|(plate, _)| name.is_none_or(|name| name == *plate));
    match wanted.collect::<Vec<_>>()[..] {
        [(plate, verdict)] => {
            final_verdict(plate, answers)?;
            Ok(FAILED.contains(&verdict))
        }
        [] => Err("the run has no verdict on such a plate".to_owned()),
        [(first, _), ..] => Err(format!(
            "the run has verdicts on several plates: name one, as in `failed {first}`"
        )),
    }
}

/// Fails with a message if the verdict on a plate is none, and says how long to run on.
fn final_verdict(plate: &str, answers: &Answers) -> Result<(), String> {
    let told = |figure: &str| answers.get(&format!("measures.{plate}.{figure}"));
    let verdict = told("verdict").map_or("", |answer| answer.text.as_str());
    if !NO_VERDICT.contains(&verdict) {
        return Ok(());
    }
    let number = |figure: &str| told(figure).and_then(|answer| answer.text.parse::<f64>().ok());
    Err(match (number("moving_speed"), number("settling_time")) {
        (Some(speed), Some(time)) if verdict == "still_moving" => format!(
            "`{plate}` still moves at {}: run on for {} or more",
            shown(speed, "m/s"),
            shown(time, "s")
        ),
        _ => format!("nothing has reached `{plate}` at the end: let the run go on"),
    })
}

impl Comparison {
    fn holds(&self, answers: &Answers) -> Result<bool, String> {
        let Some(answer) = answers.get(&self.name) else {
            return Err(format!("the run has no answer `{}`", self.name));
        };
        let plate = self.name.strip_prefix("measures.");
        if let Some(plate) = plate.and_then(|name| name.strip_suffix(".verdict"))
            && self.with != answer.text
        {
            final_verdict(plate, answers)?;
        }
        let is_equal = || match (answer.text.parse::<f64>(), units::parse(&self.with)) {
            (Ok(a), Ok((b, _))) => a == b,
            _ => answer.text == self.with,
        };
        let numbers = || {
            let value = answer.text.parse::<f64>();
            let value = value.map_err(|_| {
                format!(
                    "the answer `{}` is \"{}\", no number",
                    self.name, answer.text
                )
            })?;
            units::parse(&self.with).map(|(with, _)| (value, with))
        };
        Ok(match self.compared {
            Compared::Equal => is_equal(),
            Compared::Different => !is_equal(),
            Compared::Below => numbers().map(|(a, b)| a < b)?,
            Compared::Above => numbers().map(|(a, b)| a > b)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::answers::Answer;
    use super::*;

    fn holds(condition: &str, name: &str, text: &str) -> Result<bool, String> {
        let answer = Answer {
            text: text.to_owned(),
            unit: String::new(),
            ..Answer::default()
        };
        let answers = Answers::from([(name.to_owned(), answer)]);
        Condition::parse(condition)?.holds(&answers)
    }

    #[test]
    fn conditions_compare_numbers_and_words() {
        assert_eq!(holds("a.b < 1 mm", "a.b", "0.0005"), Ok(true));
        assert_eq!(holds("a.b>1 mm", "a.b", "0.0005"), Ok(false));
        assert_eq!(holds("a==0", "a", "0.0"), Ok(true));
        assert_eq!(holds("a!=held", "a", "held"), Ok(false));
    }

    #[test]
    fn plates_have_failed_by_their_verdicts() {
        let name = "measures.wall.verdict";
        assert_eq!(holds("failed", name, "detached spall"), Ok(true));
        assert_eq!(holds("failed wall", name, "attached spall"), Ok(false));
        assert!(holds("failed bumper", name, "held").is_err());
        assert_eq!(holds("failed_mass>1", "failed_mass", "2"), Ok(true));
        // A question that has no answer yet is not answered, but for itself.
        for word in ["not_loaded", "still_moving"] {
            assert!(holds("failed", name, word).is_err(), "{word}");
            assert!(holds("measures.wall.verdict!=held", name, word).is_err());
            let itself = format!("measures.wall.verdict=={word}");
            assert_eq!(holds(&itself, name, word), Ok(true));
        }
    }

    #[test]
    fn what_is_no_condition_is_refused() {
        assert!(holds("a", "a", "1").unwrap_err().contains("no condition"));
        assert!(holds("<1", "a", "1").unwrap_err().contains("no condition"));
        assert!(holds("a<x", "a", "1").is_err());
        assert!(
            holds("b<1", "a", "1")
                .unwrap_err()
                .contains("no answer `b`")
        );
        assert!(holds("a<1", "a", "held").unwrap_err().contains("no number"));
    }
}
