//! Numbers of dimensions, as types of what is compiled for them.

/// A number of dimensions.
pub trait Dimension: Copy + Sync {
    /// The number.
    fn number(self) -> usize;
}

/// Three, of which the compiler knows.
#[derive(Debug, Clone, Copy)]
pub struct Three;

impl Dimension for Three {
    #[inline(always)]
    fn number(self) -> usize {
        3
    }
}

/// Any, told at run time.
#[derive(Debug, Clone, Copy)]
pub struct Any(usize);

impl Any {
    /// So many.
    #[must_use]
    pub fn new(number: usize) -> Self {
        Self(number)
    }
}

impl Dimension for Any {
    #[inline(always)]
    fn number(self) -> usize {
        self.0
    }
}
