//! The rectangle of a picture that differs from the one before.

/// A rectangle of the pixels of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Patch {
    pub left: usize,
    pub top: usize,
    pub width: usize,
    pub height: usize,
}

impl Patch {
    /// The least that holds all pixels that differ in two pictures of a width, row by row; one pixel
    /// if none does, since a picture like the one before has its time.
    pub fn changed<P: PartialEq>(before: &[P], now: &[P], width: usize) -> Self {
        let differs = |k: &usize| now[*k] != before[*k];
        let indices = || (0..now.len()).filter(differs);
        let (first, last) = (
            indices().next().unwrap_or(0),
            indices().next_back().unwrap_or(0),
        );
        let (left, right) = indices().fold((width, 0), |(left, right), k| {
            (left.min(k % width), right.max(k % width))
        });
        let left = left.min(right);
        let (top, bottom) = (first / width, last / width);
        Self {
            left,
            top,
            width: right - left + 1,
            height: bottom - top + 1,
        }
    }

    /// The numbers of its pixels in a picture of a width, row by row.
    pub fn indices(self, width: usize) -> impl Iterator<Item = usize> {
        let row = move |row: usize| {
            let first = row * width + self.left;
            first..first + self.width
        };
        (self.top..self.top + self.height).flat_map(row)
    }
}
