//! An equation of state as a table of densities and temperatures, such as ANEOS makes.
//!
//! The text is a record 301 of [SESAME](super::sesame), or that which SWIFT and its `WoMa` read, in SI units: lines of comments that begin with `#`, a version,
//! the numbers of densities and temperatures, the densities, the temperatures, and then for each temperature,
//! and for each density at it, specific energy, pressure, sound speed and specific entropy. Rows of zero
//! density or temperature are left out.
//!
//! Between four entries pressure and specific energy are bilinear in density and in the place between the
//! temperatures. At a density the specific energy rises with the temperature, so that the place of a
//! given energy is found by halving and one division; where a table has an energy that falls, it is that of
//! the next higher temperature. Derivatives are those of this surface,
//!
//! ```text
//! ∂p/∂e|ᵨ = p_g/e_g,    ∂p/∂ρ|ₑ = p_ρ − p_g e_ρ/e_g
//! ```
//!
//! with the place g. Above the last temperature and density the surface goes on as in the last cell; below the first
//! temperature pressure is that of the first; below the first density it falls with the density to nothing.
//!
//! # Consistency
//!
//! A table that belongs together has `ρ² ∂e/∂ρ|_T = p − T ∂p/∂T|ᵨ`, since both come of one free energy. The cells of a
//! table hold it to their differences; if the median of their errors is beyond [`MOST_ERROR`], the table is
//! refused: its units or columns are others.

use std::sync::Arc;

use super::{EquationOfState, PointResponse, sesame};
use crate::Listed;
use crate::declare::{Constants, Value};

/// Largest median error of consistency of the cells, over the sum of the magnitudes of the terms.
pub const MOST_ERROR: f64 = 0.1;
/// Most densities, and most temperatures.
const MOST_NODES: u32 = 10_000;

/// An equation of state from a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    grid: Arc<Grid>,
    /// Temperature of the reference state (K).
    reference_temperature: f64,
    /// File that it comes from: its absolute path and its digest.
    pub file: [String; 2],
}

/// The numbers of a table: energies and pressures of each density, temperature by temperature.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    densities: Vec<f64>,
    temperatures: Vec<f64>,
    energies: Vec<f64>,
    pressures: Vec<f64>,
}

/// A place in a cell.
#[derive(Debug, Clone, Copy)]
struct Cell {
    row: usize,
    across: f64,
}

impl Grid {
    /// Reads the text of a table, in either layout.
    ///
    /// # Errors
    /// The fault, in words.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut grid = match sesame::states(text)? {
            Some(numbers) => Self::of_sesame(&numbers)?,
            None => Self::of_swift(text)?,
        };
        grid.drop_zeros();
        grid.check()?;
        Ok(grid)
    }

    /// From the numbers of a record of SESAME.
    fn of_sesame(numbers: &[f64]) -> Result<Self, String> {
        let count = |k: usize, what: &str| nodes(numbers.get(k).copied().unwrap_or(0.0), what);
        let columns = count(0, "the number of densities")?;
        let rows = count(1, "the number of temperatures")?;
        if numbers.len() < 2 + columns + rows + 2 * columns * rows {
            return Err(format!(
                "its record has {} numbers, too few for {columns} densities and {rows} temperatures",
                numbers.len()
            ));
        }
        let (densities, rest) = numbers[2..].split_at(columns);
        let (temperatures, rest) = rest.split_at(rows);
        // g/cm³, GPa and MJ/kg.
        let turned = |values: &[f64], unit: f64| {
            let by_density = (0..columns).flat_map(|c| (0..rows).map(move |r| r * columns + c));
            by_density.map(|k| values[k] * unit).collect()
        };
        Ok(Self {
            densities: densities.iter().map(|rho| rho * 1e3).collect(),
            temperatures: temperatures.to_vec(),
            pressures: turned(rest, 1e9),
            energies: turned(&rest[columns * rows..], 1e6),
        })
    }

    /// From the layout of SWIFT.
    fn of_swift(text: &str) -> Result<Self, String> {
        let body = text.lines().enumerate();
        let mut numbers = body
            .filter(|(_, line)| !line.trim_start().starts_with('#'))
            .flat_map(|(n, line)| line.split_ascii_whitespace().map(move |word| (n + 1, word)));
        let mut next = |what: &str| {
            let (line, word) = numbers
                .next()
                .ok_or_else(|| format!("it ends before {what}"))?;
            let number: f64 = word
                .parse()
                .map_err(|_| format!("line {line}: `{}` is no number", shortened(word)))?;
            if number.is_finite() {
                Ok(number)
            } else {
                Err(format!("line {line}: {number} is no finite number"))
            }
        };
        next("its version")?;
        let mut count = |what: &str| nodes(next(what)?, what);
        let columns = count("the number of densities")?;
        let rows = count("the number of temperatures")?;
        // Each number takes a digit and a space.
        let needs = columns * rows * 4 + columns + rows;
        if needs > text.len() / 2 + 1 {
            return Err(format!(
                "it is too short for {columns} densities and {rows} temperatures"
            ));
        }
        let mut densities = Vec::with_capacity(columns);
        for _ in 0..columns {
            densities.push(next("its densities")?);
        }
        let mut temperatures = Vec::with_capacity(rows);
        for _ in 0..rows {
            temperatures.push(next("its temperatures")?);
        }
        let mut energies = vec![0.0; columns * rows];
        let mut pressures = vec![0.0; columns * rows];
        for row in 0..rows {
            for column in 0..columns {
                energies[column * rows + row] = next("its energies")?;
                pressures[column * rows + row] = next("its pressures")?;
                next("its sound speeds")?;
                next("its entropies")?;
            }
        }
        if let Some((line, _)) = numbers.next() {
            return Err(format!("line {line}: more than its numbers say"));
        }
        Ok(Self {
            densities,
            temperatures,
            energies,
            pressures,
        })
    }

    /// Leaves out a first density and a first temperature of zero.
    fn drop_zeros(&mut self) {
        let rows = self.temperatures.len();
        if self.densities[0] == 0.0 {
            self.densities.remove(0);
            self.energies.drain(..rows);
            self.pressures.drain(..rows);
        }
        if self.temperatures[0] == 0.0 {
            self.temperatures.remove(0);
            let mut n = 0;
            let mut keeps = || {
                n += 1;
                (n - 1) % rows != 0
            };
            self.energies.retain(|_| keeps());
            let mut n = 0;
            let mut keeps = || {
                n += 1;
                (n - 1) % rows != 0
            };
            self.pressures.retain(|_| keeps());
        }
    }

    /// Refuses what is no table of one matter, and makes energies rise with the temperature.
    fn check(&mut self) -> Result<(), String> {
        for (values, what) in [
            (&self.densities, "densities"),
            (&self.temperatures, "temperatures"),
        ] {
            let rises = values.windows(2).all(|pair| pair[0] < pair[1]);
            if !(rises && values[0] > 0.0) {
                return Err(format!("its {what} are not positive, each above the last"));
            }
        }
        let rows = self.temperatures.len();
        for energies in self.energies.chunks_mut(rows) {
            for row in (0..rows - 1).rev() {
                if energies[row] > energies[row + 1] {
                    energies[row] = energies[row + 1];
                }
            }
            if energies[0] >= energies[rows - 1] {
                return Err("at a density its energy does not rise with the temperature".to_owned());
            }
        }
        let error = self.inconsistency();
        if error > MOST_ERROR {
            return Err(format!(
                "its pressures and energies do not belong together: the error of ρ² ∂e/∂ρ = p − T ∂p/∂T is {:.0} % \
                 in half of its cells, and may be {:.0} %; are its units those of its layout, and its columns \
                 in order?",
                1e2 * error,
                1e2 * MOST_ERROR
            ));
        }
        Ok(())
    }

    /// Median over all cells of the error of thermodynamic consistency, over the sum of the magnitudes of its terms.
    #[must_use]
    pub fn inconsistency(&self) -> f64 {
        let (rho, t) = (&self.densities, &self.temperatures);
        let mut errors = Vec::new();
        for column in 0..rho.len() - 1 {
            for row in 0..t.len() - 1 {
                let corners = |values: &[f64]| {
                    let at = |c: usize, r: usize| values[(column + c) * t.len() + row + r];
                    [at(0, 0), at(0, 1), at(1, 0), at(1, 1)]
                };
                let ([e00, e01, e10, e11], p) =
                    (corners(&self.energies), corners(&self.pressures));
                // In the middle of the cell: of the volume, for which cold energies are nearly linear.
                let (v0, v1) = (1.0 / rho[column], 1.0 / rho[column + 1]);
                let slope = -0.5 * (e10 + e11 - e00 - e01) / (v1 - v0);
                let middle = 0.25 * (p[0] + p[1] + p[2] + p[3]);
                let thermal = 0.25 * (t[row] + t[row + 1]) * (p[1] + p[3] - p[0] - p[2])
                    / (t[row + 1] - t[row]);
                let size = slope.abs() + middle.abs() + thermal.abs();
                if size > 0.0 {
                    errors.push((slope - middle + thermal).abs() / size);
                }
            }
        }
        errors.sort_by(f64::total_cmp);
        errors.get(errors.len() / 2).copied().unwrap_or(0.0)
    }

    /// The cell of a value among nodes; `across` may be beyond it.
    fn cell(nodes: &[f64], value: f64) -> Cell {
        let row = nodes.partition_point(|node| *node <= value);
        let row = row.clamp(1, nodes.len() - 1) - 1;
        let across = (value - nodes[row]) / (nodes[row + 1] - nodes[row]);
        Cell { row, across }
    }

    /// Energies or pressures of a temperature at both densities of a column.
    #[inline]
    fn pair(&self, values: &[f64], column: usize, row: usize) -> [f64; 2] {
        let rows = self.temperatures.len();
        [values[column * rows + row], values[(column + 1) * rows + row]]
    }

    /// Specific energy (J/kg) at a density (kg/m³) and temperature (K).
    fn energy(&self, density: f64, temperature: f64) -> f64 {
        let column = Self::cell(&self.densities, density);
        let row = Self::cell(&self.temperatures, temperature);
        let at = |row: usize| mix(self.pair(&self.energies, column.row, row), column.across);
        mix([at(row.row), at(row.row + 1)], row.across)
    }

    /// Pressure and derivatives at a density (kg/m³) and specific energy (J/kg).
    fn response(&self, density: f64, energy: f64) -> PointResponse {
        let thin = density < self.densities[0];
        let inside = if thin { self.densities[0] } else { density };
        let column = Self::cell(&self.densities, inside);
        let f = column.across;
        let energy_at = |row: usize| mix(self.pair(&self.energies, column.row, row), f);
        // The first row from the second on whose energy is above the given one.
        let (mut low, mut high) = (0, self.temperatures.len() - 1);
        while high - low > 1 {
            let middle = low.midpoint(high);
            if energy_at(middle) <= energy {
                low = middle;
            } else {
                high = middle;
            }
        }
        let (e0, e1) = (
            self.pair(&self.energies, column.row, low),
            self.pair(&self.energies, column.row, low + 1),
        );
        let (p0, p1) = (
            self.pair(&self.pressures, column.row, low),
            self.pair(&self.pressures, column.row, low + 1),
        );
        let rise = mix(e1, f) - mix(e0, f);
        // Two temperatures of one energy make no cell.
        let (g, per_energy) = if rise > 0.0 {
            ((energy - mix(e0, f)) / rise, 1.0 / rise)
        } else {
            (0.0, 0.0)
        };
        let g = if g < 0.0 { 0.0 } else { g };
        let width = self.densities[column.row + 1] - self.densities[column.row];
        let slope = |first: [f64; 2], second: [f64; 2]| {
            mix([first[1] - first[0], second[1] - second[0]], g) / width
        };
        let of_g = mix(p1, f) - mix(p0, f);
        let dp_de = of_g * per_energy;
        let pressure = mix([mix(p0, f), mix(p1, f)], g);
        if thin {
            let share = density / inside;
            return PointResponse {
                pressure: pressure * share,
                dp_drho: pressure / inside,
                dp_de: dp_de * share,
            };
        }
        PointResponse {
            pressure,
            dp_drho: slope(p0, p1) - dp_de * slope(e0, e1),
            dp_de,
        }
    }
}

/// Between two numbers, or beyond them.
#[inline]
fn mix([a, b]: [f64; 2], share: f64) -> f64 {
    (1.0 - share) * a + share * b
}

/// A count of nodes.
fn nodes(number: f64, what: &str) -> Result<usize, String> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the range
    if number.fract() == 0.0 && (3.0..=f64::from(MOST_NODES)).contains(&number) {
        Ok(number as usize)
    } else {
        Err(format!("{what} must be a whole number from 3 to {MOST_NODES}, and is {number}"))
    }
}

/// The first letters of a word of a file.
pub(super) fn shortened(word: &str) -> String {
    word.chars().take(20).collect()
}

impl Table {
    /// The law of a grid with a reference temperature (K), from a file of this path and digest.
    ///
    /// # Errors
    /// The fault, in words.
    pub fn new(
        grid: Grid,
        density: f64,
        reference_temperature: f64,
        file: [String; 2],
    ) -> Result<Self, String> {
        let within = |nodes: &[f64], value: f64| {
            nodes.first().is_some_and(|first| *first < value)
                && nodes.last().is_some_and(|last| value < *last)
        };
        if !within(&grid.densities, density) {
            return Err(format!("it does not hold the reference density {density} kg/m³"));
        }
        if !within(&grid.temperatures, reference_temperature) {
            return Err(format!(
                "it does not hold the reference temperature {reference_temperature} K"
            ));
        }
        let table = Self {
            grid: Arc::new(grid),
            reference_temperature,
            file,
        };
        let modulus = table.bulk_modulus(density);
        if modulus > 0.0 {
            Ok(table)
        } else {
            Err(format!(
                "at the reference density and temperature its bulk modulus is {modulus} Pa: state a `density` at which \
                 the matter is dense"
            ))
        }
    }
}

impl Listed for Table {
    fn constants(&self) -> Constants {
        vec![(
            "reference_temperature",
            Value::Number(self.reference_temperature, "K"),
        )]
    }
}

impl EquationOfState for Table {
    const APART: bool = true;

    /// `ρ c²` of the reference state.
    fn bulk_modulus(&self, rho0: f64) -> f64 {
        let at = self.grid.response(rho0, self.reference_energy(rho0));
        rho0 * at.dp_drho + at.pressure / rho0 * at.dp_de
    }

    /// That of the reference temperature.
    fn reference_energy(&self, rho: f64) -> f64 {
        self.grid.energy(rho, self.reference_temperature)
    }

    #[inline]
    fn at(&self, _rho0: f64, rho: f64, e: f64) -> PointResponse {
        self.grid.response(rho, e)
    }
}
