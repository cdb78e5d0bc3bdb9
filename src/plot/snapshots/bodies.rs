//! Bodies of the snapshots of one picture: those of the same name are one.

use super::snapshot::Snapshot;
use crate::PlotError;

/// The bodies of a picture, and which of them are drawn.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Bodies {
    /// Names, in the order of the snapshots.
    pub names: Vec<String>,
    /// `true` for rigid ones.
    pub rigid: Vec<bool>,
    /// Names of those that are drawn; all if there are none.
    chosen: Vec<String>,
}

impl Bodies {
    /// Of no snapshot yet, of which those of some names will be drawn, or all.
    #[must_use]
    pub fn new(chosen: &[String]) -> Self {
        Self {
            chosen: chosen.to_vec(),
            ..Self::default()
        }
    }

    /// Takes up the bodies of a snapshot; returns the number in the picture of each.
    pub fn add(&mut self, snapshot: &Snapshot) -> Vec<usize> {
        let bodies = snapshot.bodies.iter().zip(&snapshot.rigid);
        let number = |(name, &rigid): (&String, &bool)| {
            self.names
                .iter()
                .position(|n| n == name)
                .unwrap_or_else(|| {
                    self.names.push(name.clone());
                    self.rigid.push(rigid);
                    self.names.len() - 1
                })
        };
        bodies.map(number).collect()
    }

    /// `true` if the body of a number is drawn.
    #[must_use]
    pub fn shows(&self, number: usize) -> bool {
        self.chosen.is_empty() || self.chosen.contains(&self.names[number])
    }

    /// Names of those that are drawn, if not all are.
    #[must_use]
    pub fn alone(&self) -> Option<&[String]> {
        (!self.chosen.is_empty()).then_some(&self.chosen[..])
    }

    /// The numbers of bodies by their names.
    ///
    /// # Errors
    /// [`PlotError::Body`] for a name that is in no snapshot.
    pub fn numbers(&self, names: &[String]) -> Result<Vec<usize>, PlotError> {
        let number = |name: &String| {
            let number = self.names.iter().position(|n| n == name);
            number.ok_or_else(|| PlotError::Body {
                name: name.clone(),
                known: self.names.clone(),
            })
        };
        names.iter().map(number).collect()
    }

    /// Checks that all chosen ones are there.
    ///
    /// # Errors
    /// [`PlotError::Body`] if not.
    pub fn check(&self) -> Result<(), PlotError> {
        self.numbers(&self.chosen).map(|_| ())
    }
}
