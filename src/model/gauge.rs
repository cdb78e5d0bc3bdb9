//! Gauges and witness planes.

/// A gauge: the state of the material at a place.
#[derive(Debug, Clone, PartialEq)]
pub struct Gauge {
    /// Name in tables.
    pub name: String,
    /// Its position, or the initial one (m).
    pub at: [f64; 3],
    /// `true` if a particle carries it: that of an id, else the nearest at the start.
    pub moves: bool,
    /// Id of the particle that carries it, with whose readings go those of what stands around it.
    pub particle: Option<u64>,
    /// The body that it reads; all that deform if absent.
    pub body: Option<usize>,
    /// Names of what it reads, at least one.
    pub fields: Vec<String>,
    /// Unit vector along which it reads the normal stress, if it does.
    pub along: Option<[f64; 3]>,
    /// When it reads.
    pub every: Cadence,
}

/// The frequency of an action.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cadence {
    /// Every so many steps.
    Steps(u64),
    /// Every so much time (s).
    Time(f64),
}

/// A plane that counts what passes it.
#[derive(Debug, Clone, PartialEq)]
pub struct Witness {
    /// Name in tables.
    pub name: String,
    /// A point of it (m).
    pub point: [f64; 3],
    /// Unit normal: what moves along it passes forwards.
    pub normal: [f64; 3],
}

impl Witness {
    /// Most witness planes of a case: particles know their sides in as many bits.
    pub const MOST: usize = 32;

    /// The distance of a position (m) beyond the plane (m).
    #[must_use]
    pub fn beyond(&self, x: &[f64; 3]) -> f64 {
        (0..3)
            .map(|a| self.normal[a] * (x[a] - self.point[a]))
            .sum()
    }
}
