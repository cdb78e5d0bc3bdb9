//! Parts of a plane, by square cells: holes and rims.

use std::f64::consts::PI;

/// Cells of a rectangle that have some property.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mask {
    counts: [usize; 2],
    cells: Vec<bool>,
}

/// Diameter (m) of a circle of so many cells of an edge (m).
#[must_use]
pub fn diameter(cells: usize, edge: f64) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "counts are small")]
    let area = cells as f64 * edge * edge;
    (4.0 * area / PI).sqrt()
}

impl Mask {
    /// Of cells in rows.
    #[must_use]
    pub fn new(counts: [usize; 2], cells: Vec<bool>) -> Self {
        Self { counts, cells }
    }

    /// Number of cells that have the property.
    #[must_use]
    pub fn count(&self) -> usize {
        self.cells.iter().filter(|&&is| is).count()
    }

    /// The largest of the parts that share sides and do not reach the border; of several as large the first.
    #[must_use]
    pub fn largest_inside(&self) -> Self {
        let inside = |part: &&Part| !part.at_border;
        self.only(largest(self.parts().iter().filter(inside)))
    }

    /// Flags of cells that belong to parts that reach the border, and of all others there.
    #[must_use]
    pub fn at_border(&self) -> Vec<bool> {
        let [rows, across] = self.counts;
        let at_border = |cell: usize| {
            let (i, j) = (cell / across, cell % across);
            i == 0 || j == 0 || i + 1 == rows || j + 1 == across
        };
        let mut all: Vec<bool> = (0..self.cells.len()).map(at_border).collect();
        for part in self.parts().iter().filter(|part| part.at_border) {
            for &cell in &part.cells {
                all[cell as usize] = true;
            }
        }
        all
    }

    /// The largest of its parts; of several as large the first.
    #[must_use]
    pub fn largest_part(&self) -> Self {
        self.only(largest(self.parts().iter()))
    }

    /// The part that holds a cell; nothing if it has not the property.
    #[must_use]
    pub fn part_of(&self, cell: usize) -> Self {
        let mut seen = vec![false; self.cells.len()];
        let part = self.cells[cell].then(|| self.part(cell, &mut seen));
        self.only(part.as_ref())
    }

    /// Indices of its cells.
    pub fn cells(&self) -> impl Iterator<Item = usize> {
        let all = self.cells.iter().enumerate();
        all.filter(|(_, is)| **is).map(|(cell, _)| cell)
    }

    fn only(&self, part: Option<&Part>) -> Self {
        let mut cells = vec![false; self.cells.len()];
        for &cell in part.iter().flat_map(|part| &part.cells) {
            cells[cell as usize] = true;
        }
        Self::new(self.counts, cells)
    }

    /// All parts, in the order of their first cells.
    fn parts(&self) -> Vec<Part> {
        let mut seen = vec![false; self.cells.len()];
        let mut parts = Vec::new();
        for cell in 0..self.cells.len() {
            if self.cells[cell] && !seen[cell] {
                parts.push(self.part(cell, &mut seen));
            }
        }
        parts
    }

    fn part(&self, from: usize, seen: &mut [bool]) -> Part {
        let [rows, across] = self.counts;
        let index = |cell: usize| u32::try_from(cell).unwrap_or(u32::MAX);
        let mut part = Part {
            cells: vec![index(from)],
            at_border: false,
        };
        seen[from] = true;
        let mut next = 0;
        while let Some(&cell) = part.cells.get(next) {
            next += 1;
            let cell = cell as usize;
            let (i, j) = (cell / across, cell % across);
            part.at_border |= i == 0 || j == 0 || i + 1 == rows || j + 1 == across;
            let around = [
                (i > 0).then(|| cell - across),
                (i + 1 < rows).then(|| cell + across),
                (j > 0).then(|| cell - 1),
                (j + 1 < across).then(|| cell + 1),
            ];
            for other in around.into_iter().flatten() {
                if self.cells[other] && !seen[other] {
                    seen[other] = true;
                    part.cells.push(index(other));
                }
            }
        }
        part
    }
}

/// Cells that share sides.
struct Part {
    cells: Vec<u32>,
    at_border: bool,
}

fn largest<'a>(parts: impl Iterator<Item = &'a Part>) -> Option<&'a Part> {
    parts.reduce(|best, part| {
        if part.cells.len() > best.cells.len() {
            part
        } else {
            best
        }
    })
}

#[cfg(test)]
#[allow(clippy::cast_precision_loss, reason = "small numbers")]
mod tests {
    use super::*;

    fn drawn(rows: &[&str]) -> Mask {
        let cells = rows.iter().flat_map(|row| row.bytes()).map(|b| b == b'#');
        Mask::new([rows.len(), rows[0].len()], cells.collect())
    }

    #[test]
    fn parts_inside_and_what_they_enclose() {
        let mask = drawn(&[
            "#......", //
            "..###..", "..#.#.#", "..###..", ".......", ".##....", "......#",
        ]);
        assert_eq!(mask.largest_inside().count(), 8);
        assert_eq!(mask.largest_part().count(), 8);
        assert_eq!(mask.part_of(36).count(), 2);
        assert_eq!(mask.part_of(1).count(), 0);
        let others = mask.cells.iter().map(|is| !is).collect();
        assert_eq!(Mask::new(mask.counts, others).largest_inside().count(), 1);
        assert_eq!(mask.cells().next(), Some(0));
        // A border of 24 cells, and no part that reaches from there inwards.
        assert_eq!(mask.at_border().iter().filter(|is| **is).count(), 24);
    }

    #[test]
    fn a_circle_has_its_diameter() {
        let inside = |k: usize| {
            let (x, y) = ((k / 60) as f64 - 29.7, (k % 60) as f64 - 30.2);
            x * x + y * y < 400.0
        };
        let cells = (0..3600).filter(|&k| inside(k)).count();
        assert!((diameter(cells, 0.5) - 20.0).abs() < 0.2);
    }
}
