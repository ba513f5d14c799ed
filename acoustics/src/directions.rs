//! Cells of equal area on the sphere: directions of arrival of energy.

use crate::bands::{BAND_COUNT, BandValues};
use dwell_scene::math::sin_cos;
use dwell_scene::random::RandomStream;
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::f32::consts::FRAC_PI_4;

/// Rows of equal height, from straight down to straight up.
const ROWS: usize = 6;
/// Columns of 45 degrees.
const COLUMNS: usize = 8;

/// The number of cells.
pub const CELL_COUNT: usize = ROWS * COLUMNS;

/// Returns the cell that a unit vector points into.
///
/// Cells lie between heights -1, -2/3, ... 1 (of equal area by Archimedes' theorem of the sphere and the cylinder) and between
/// eighths of a turn from +X towards +Z: cell = 8 row + column.
pub fn direction_cell(direction: Vec3) -> usize {
    let row = ((direction.y + 1.0) * (0.5 * ROWS as f32)) as usize;
    let (x, z) = (direction.x, direction.z);
    let steep = z.abs() > x.abs();
    let column = match (x >= 0.0, z >= 0.0) {
        (true, true) => usize::from(steep),
        (false, true) => 2 + usize::from(!steep),
        (false, false) => 4 + usize::from(steep),
        (true, false) => 6 + usize::from(!steep),
    };
    row.min(ROWS - 1) * COLUMNS + column
}

/// Returns the unit vector at a place within a cell, `u` and `v` from 0 to 1; uniform over the cell where they are uniform.
pub fn direction_in_cell(cell: usize, u: f32, v: f32) -> Vec3 {
    let (row, column) = (cell / COLUMNS, cell % COLUMNS);
    let y = ((row as f32 + u) * (2.0 / ROWS as f32) - 1.0).clamp(-1.0, 1.0);
    let (sin, cos) = sin_cos((column as f32 + v) * FRAC_PI_4);
    let across = (1.0 - y * y).max(0.0).sqrt();
    Vec3::new(across * cos, y, across * sin)
}

/// Directional distribution of energy during a span of time.
///
/// Shares are per cell and band and need no sum of 1; a band without energy counts as diffuse.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DirectionalEnergy {
    /// Energy by cell and band. Shape (cell,).
    pub energy: Vec<BandValues>,
}

impl Default for DirectionalEnergy {
    fn default() -> Self {
        Self {
            energy: vec![[0.0; BAND_COUNT]; CELL_COUNT],
        }
    }
}

impl DirectionalEnergy {
    /// Sum over the cells. Shape (band,).
    pub fn total(&self) -> BandValues {
        let mut sum = [0.0; BAND_COUNT];
        for cell in &self.energy {
            for (total, e) in sum.iter_mut().zip(cell) {
                *total += e;
            }
        }
        sum
    }

    /// Returns the mean of the unit vectors of arrival of the energy of all bands: length 0 for a diffuse field, nearly 1
    /// for a single direction.
    pub fn mean_direction(&self) -> Vec3 {
        let (mut sum, mut all) = (Vec3::ZERO, 0.0);
        for (cell, energy) in self.energy.iter().enumerate() {
            let energy: f32 = energy.iter().sum();
            sum += cell_mean_direction(cell) * energy;
            all += energy;
        }
        if all > 0.0 { sum / all } else { Vec3::ZERO }
    }

    /// Returns a sampler of directions.
    pub(crate) fn sampler(&self) -> DirectionSampler {
        let total = self.total();
        let heard = total.iter().filter(|t| **t > 0.0).count();
        let even = 1.0 / CELL_COUNT as f32;
        let mut sampler = DirectionSampler {
            up_to: [0.0; CELL_COUNT],
            gain: vec![[1.0; BAND_COUNT]; CELL_COUNT],
        };
        let mut sum = 0.0;
        for (cell, energy) in self.energy.iter().enumerate() {
            let share: BandValues = std::array::from_fn(|band| {
                if total[band] > 0.0 {
                    energy[band] / total[band]
                } else {
                    even
                }
            });
            // The probability of a cell is the mean over the bands with energy; a band with another share is louder or
            // fainter from there, so that each band keeps its own directions.
            let chance = if heard == 0 {
                even
            } else {
                let bands = share.iter().zip(&total).filter(|(_, t)| **t > 0.0);
                bands.map(|(share, _)| share).sum::<f32>() / heard as f32
            };
            sum += chance;
            sampler.up_to[cell] = sum;
            if chance > 0.0 {
                sampler.gain[cell] = share.map(|share| (share / chance).sqrt());
            }
        }
        sampler
    }
}

/// Returns the middle of a cell, not of unit length: the mean of its unit vectors.
fn cell_mean_direction(cell: usize) -> Vec3 {
    // Over an eighth of a turn the mean of a vector is sin(pi/8)/(pi/8) of it; over the height it is nearly the middle's.
    const SPREAD: f32 = 0.974_495_4;
    let v = direction_in_cell(cell, 0.5, 0.5);
    Vec3::new(v.x * SPREAD, v.y, v.z * SPREAD)
}

/// A sampler of directions.
pub(crate) struct DirectionSampler {
    /// Cumulative probabilities of the cells.
    up_to: [f32; CELL_COUNT],
    /// Amplitude of a band over the mean of all, from each cell.
    gain: Vec<BandValues>,
}

impl DirectionSampler {
    /// Draws a direction of arrival, and the gain of its bands.
    pub(crate) fn draw(&self, stream: &mut RandomStream) -> (Vec3, &BandValues) {
        let place = stream.uniform_f32() * self.up_to[CELL_COUNT - 1];
        let cell = self.up_to.partition_point(|sum| *sum <= place);
        let cell = cell.min(CELL_COUNT - 1);
        let direction = direction_in_cell(cell, stream.uniform_f32(), stream.uniform_f32());
        (direction, &self.gain[cell])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;

    #[test]
    fn places_within_cells_are_found_in_them_again() {
        for cell in 0..CELL_COUNT {
            for u in [0.01, 0.5, 0.99] {
                for v in [0.01, 0.5, 0.99] {
                    let direction = direction_in_cell(cell, u, v);
                    assert!((direction.length() - 1.0).abs() < 1e-5);
                    assert_eq!(direction_cell(direction), cell, "{direction}");
                }
            }
        }
        for direction in [Vec3::Y, Vec3::NEG_Y, Vec3::X, Vec3::NEG_Z, Vec3::ZERO] {
            assert!(direction_cell(direction) < CELL_COUNT);
        }
    }

    /// Counts are binomial: within five standard errors in every cell.
    #[test]
    fn cells_are_of_equal_area() {
        let mut stream = RandomKey::root(4).stream();
        let n = 48_000;
        let mut count = [0.0; CELL_COUNT];
        for _ in 0..n {
            count[direction_cell(stream.direction())] += 1.0_f64;
        }
        let expected = f64::from(n) / CELL_COUNT as f64;
        assert!(
            count
                .iter()
                .all(|c| (c - expected).abs() < 5.0 * expected.sqrt())
        );
    }

    /// Two bands from opposite sides: draws give each band its own side and its whole energy.
    #[test]
    fn every_band_keeps_its_directions() {
        let mut directions = DirectionalEnergy::default();
        directions.energy[3][2] = 5.0;
        directions.energy[40][6] = 0.1;
        let sampler = directions.sampler();
        let mut stream = RandomKey::root(1).stream();
        let n = 20_000;
        let mut found = vec![[0.0_f64; BAND_COUNT]; CELL_COUNT];
        for _ in 0..n {
            let (direction, gain) = sampler.draw(&mut stream);
            for (sum, g) in found[direction_cell(direction)].iter_mut().zip(gain) {
                *sum += f64::from(g * g) / f64::from(n);
            }
        }
        // Half of the draws have energy 2: standard error 1 / sqrt(n).
        assert!((found[3][2] - 1.0).abs() < 0.04 && found[40][2] == 0.0);
        assert!((found[40][6] - 1.0).abs() < 0.04 && found[3][6] == 0.0);
        assert!(
            (directions.mean_direction().length() - cell_mean_direction(3).length()).abs() < 0.1
        );
    }

    #[test]
    fn without_energy_sound_comes_from_all_sides() {
        let sampler = DirectionalEnergy::default().sampler();
        let mut stream = RandomKey::root(2).stream();
        let n = 20_000;
        let sum: Vec3 = (0..n).map(|_| sampler.draw(&mut stream).0).sum();
        // Each component has a variance of a third.
        assert!(sum.length() / (n as f32) < 5.0 * (1.0 / n as f32).sqrt());
        assert_eq!(DirectionalEnergy::default().mean_direction(), Vec3::ZERO);
    }
}
