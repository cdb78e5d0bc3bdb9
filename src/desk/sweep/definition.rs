//! The definition of a sweep, as it was typed and as its folder keeps it.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::SweepError;
use super::condition::Condition;
use super::plan::{Plan, Varied};
use super::point::Point;
use files::input;
use files::output::{OutputError, read_small, write_json};
use model::Case;

/// Name of the file in a sweep's folder.
const FILE: &str = "sweep.json";

/// A sweep as it was typed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Definition {
    /// The folder of the sweep.
    #[serde(skip)]
    pub folder: PathBuf,
    /// The case.
    pub case: PathBuf,
    /// Digest of the resolved case.
    #[serde(default)]
    pub digest: String,
    /// `--set` of all points.
    pub settings: Vec<String>,
    /// `--vary`.
    pub vary: Vec<String>,
    /// `--scatter`: keys whose values are repetitions of one question.
    #[serde(default)]
    pub scatter: Vec<String>,
    /// True if the only key is `spacing` and the spacings of bodies go with it.
    #[serde(default)]
    pub converges: bool,
    /// `--bisect`.
    pub bisect: Option<String>,
    /// Part of its range to which a bisection goes.
    pub within: f64,
    /// Names that answers of the table begin with; the default ones if empty.
    pub answers: Vec<String>,
}

impl Definition {
    /// `true` if a folder is that of a sweep.
    #[must_use]
    pub fn is_in(folder: &Path) -> bool {
        folder.join(FILE).is_file()
    }

    /// Reads what a folder keeps.
    ///
    /// # Errors
    /// [`SweepError::Output`].
    pub fn read(folder: &Path) -> Result<Self, SweepError> {
        let path = folder.join(FILE);
        let definition = serde_json::from_slice(&read_small(&path)?);
        let definition: Self =
            definition.map_err(|error| OutputError::damaged(&path, error.to_string()))?;
        Ok(Self {
            folder: folder.to_owned(),
            ..definition
        })
    }

    /// Keeps it in its folder, which there is. A folder of another case is refused: its runs would
    /// count as those of this one.
    ///
    /// # Errors
    /// [`SweepError::Typed`], [`SweepError::Case`], [`SweepError::Output`].
    pub fn keep(&mut self) -> Result<(), SweepError> {
        self.digest = format!("{:x}", Sha256::digest(self.text()?.as_bytes()));
        if Self::is_in(&self.folder) {
            let before = Self::read(&self.folder)?;
            if before.digest != self.digest || before.converges != self.converges {
                let folder = self.folder.display();
                return Err(SweepError::Typed(format!(
                    "{folder} has a sweep of another case or other settings: take another --out"
                )));
            }
        }
        Ok(write_json(&self.folder.join(FILE), self)?)
    }

    /// The points of it.
    ///
    /// # Errors
    /// A message on an invalid definition.
    pub fn plan(&self) -> Result<Plan, String> {
        let parse = |texts: &[String]| -> Result<Vec<Varied>, String> {
            texts.iter().map(|text| Varied::parse(text)).collect()
        };
        let (mut varied, scattered) = (parse(&self.vary)?, parse(&self.scatter)?);
        let bisect = self.bisect.as_ref().map(|text| Condition::parse(text));
        let bisect = bisect
            .transpose()?
            .map(|condition| (condition, self.within));
        if !(self.within > 0.0 && self.within < 1.0) {
            return Err("`--within` must lie between 0 and 1".to_owned());
        }
        // The key that is bisected stays the last one.
        let at = varied.len() - usize::from(bisect.is_some()).min(varied.len());
        varied.splice(at..at, scattered);
        Plan::new(&varied, bisect)
    }

    /// For each key of the plan, whether it is scattered.
    #[must_use]
    pub fn scattered(&self) -> Vec<bool> {
        let bisected = usize::from(self.bisect.is_some()).min(self.vary.len());
        let mut scattered = vec![false; self.vary.len() - bisected];
        scattered.extend(self.scatter.iter().map(|_| true));
        scattered.extend(vec![false; bisected]);
        scattered
    }

    /// The text of the resolved case, without the keys that vary.
    fn text(&self) -> Result<String, SweepError> {
        Ok(input::load(&self.case, &self.settings)?.resolved)
    }

    /// The resolved case.
    ///
    /// # Errors
    /// [`SweepError::Case`].
    pub fn resolved(&self) -> Result<toml::Table, SweepError> {
        let table = self.text()?.parse::<toml::Table>();
        table.map_err(|error| SweepError::Typed(error.to_string()))
    }

    /// Reads the case of a point.
    ///
    /// # Errors
    /// [`SweepError::Case`].
    pub fn case_of(&self, point: &Point) -> Result<Case, SweepError> {
        let all = self.settings.iter().chain(&point.settings);
        let settings: Vec<String> = all.cloned().collect();
        Ok(input::load(&self.case, &settings)?)
    }
}
