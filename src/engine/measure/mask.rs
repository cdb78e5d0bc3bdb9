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

    /// The cells of the parts that do not reach the border.
    #[must_use]
    pub fn inside(&self) -> Self {
        let at_border = self.at_border();
        let cells = self.cells.iter().zip(at_border);
        Self::new(
            self.counts,
            cells.map(|(&is, at_border)| is && !at_border).collect(),
        )
    }

    /// Number of cells in the largest disc of such cells, about a middle or a corner of any: of those that are nearer
    /// than the nearest cell without the property.
    #[must_use]
    pub fn largest_disc(&self) -> usize {
        let walls = Walls::new(self);
        let mut best = Disc::default();
        for cell in self.cells() {
            for half in [0, 1] {
                let [row, column] = self.place(cell);
                let middle = [row + half, column + half];
                let reach = walls.reach(middle, best.reach);
                if reach > best.reach {
                    best = Disc { middle, reach };
                }
            }
        }
        let nearer = |&cell: &usize| {
            let [row, column] = self.place(cell);
            let (down, aside) = (row - best.middle[0], column - best.middle[1]);
            down * down + aside * aside < best.reach
        };
        self.cells().filter(nearer).count()
    }

    /// Place of the middle of a cell (half cells).
    fn place(&self, cell: usize) -> [i64; 2] {
        let across = self.counts[1];
        [cell / across, cell % across].map(|at| 2 * signed(at))
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

/// A disc: its middle (half cells), and the square of how far it reaches.
#[derive(Debug, Clone, Copy, Default)]
struct Disc {
    middle: [i64; 2],
    reach: i64,
}

fn signed(count: usize) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}

/// The nearest cells without a property in each row, to the left and to the right of each cell; cells beyond the border
/// have none.
struct Walls {
    counts: [i64; 2],
    beside: Vec<[i64; 2]>,
}

impl Walls {
    fn new(mask: &Mask) -> Self {
        let across = mask.counts[1];
        let mut beside = vec![[-1, signed(across)]; mask.cells.len()];
        for (row, walls) in mask.cells.chunks(across).zip(beside.chunks_mut(across)) {
            let mut left = -1;
            for (column, (is, wall)) in row.iter().zip(walls.iter_mut()).enumerate() {
                left = if *is { left } else { signed(column) };
                wall[0] = left;
            }
            let mut right = signed(across);
            for (column, (is, wall)) in row.iter().zip(walls.iter_mut()).enumerate().rev() {
                right = if *is { right } else { signed(column) };
                wall[1] = right;
            }
        }
        Self {
            counts: mask.counts.map(signed),
            beside,
        }
    }

    /// Distance (half cells) in a row from a column (half cells) to the nearest wall.
    fn aside(&self, row: i64, column: i64) -> i64 {
        let [rows, across] = self.counts;
        let (before, after) = (column / 2, (column + 1) / 2);
        if !(0..rows).contains(&row) {
            return column - 2 * before;
        }
        let at = |column: i64| usize::try_from(row * across + column).unwrap_or_default();
        let left = self.beside[at(before)][0];
        let right = if after < across {
            self.beside[at(after)][1]
        } else {
            across
        };
        (column - 2 * left).min(2 * right - column)
    }

    /// Square of the distance (half cells) from a place to the nearest wall; if it is no more than `enough`, something
    /// that is no more.
    fn reach(&self, [row, column]: [i64; 2], enough: i64) -> i64 {
        let mut nearest = i64::MAX;
        for k in 0.. {
            for row_of_wall in [row / 2 - k, (row + 1) / 2 + k] {
                let (down, aside) = (2 * row_of_wall - row, self.aside(row_of_wall, column));
                nearest = nearest.min(down * down + aside * aside);
            }
            // The next rows are farther away.
            let next = 2 * k + 2;
            if nearest <= enough || next * next >= nearest {
                break;
            }
        }
        nearest
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
    fn the_largest_disc_is_what_a_rod_passes() {
        let disc = |rows: &[&str]| drawn(rows).largest_disc();
        assert_eq!(disc(&["....", "....", "...."]), 0);
        assert_eq!(disc(&["....", ".#..", "...."]), 1);
        // A slit is as narrow as it is, however long.
        assert_eq!(disc(&[".......", ".#####.", "......."]), 1);
        assert_eq!(disc(&["....", ".##.", ".##.", "...."]), 4);
        assert_eq!(disc(&["......", ".####.", ".####.", "......"]), 4);
        assert_eq!(disc(&[".....", "..#..", ".###.", "..#..", "....."]), 5);
        // At the border there is no more.
        assert_eq!(disc(&["##", "##"]), 4);
        // A slit beside a hole.
        assert_eq!(
            disc(&[
                "........", ".#..###.", ".#..###.", ".#..###.", ".#......", "........"
            ]),
            9
        );
        let inside = |k: usize| {
            let (x, y) = ((k / 60) as f64 - 29.7, (k % 60) as f64 - 30.2);
            x * x + y * y < 400.0
        };
        let round = Mask::new([60, 60], (0..3600).map(inside).collect());
        let rod = diameter(round.largest_disc(), 1.0);
        // Its rim is rough by a cell.
        assert!((39.0..40.0).contains(&rod), "{rod}");
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
