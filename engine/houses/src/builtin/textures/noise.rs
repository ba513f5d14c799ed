//! Noise that repeats, for textures without seams.

use dwell_scene::random::Key;

const TABLE: usize = 256;

/// Value noise on a lattice.
pub(super) struct Noise {
    values: [f32; TABLE],
    order: [u8; TABLE],
}

impl Noise {
    /// The noise of a key.
    pub(super) fn new(key: Key) -> Self {
        let mut stream = key.stream();
        let mut order: [u8; TABLE] = std::array::from_fn(|k| k as u8);
        stream.shuffle(&mut order);
        Self {
            values: std::array::from_fn(|_| stream.uniform_f32()),
            order,
        }
    }

    /// A value in [0, 1) for an integer place; equal places, equal values.
    pub(super) fn cell(&self, x: i32, y: i32) -> f32 {
        let column = self.order[x.rem_euclid(TABLE as i32) as usize];
        self.values[(i32::from(column) + y).rem_euclid(TABLE as i32) as usize]
    }

    /// Smooth noise in [0, 1): (`u`, `v`) in 0 to 1, `across` by `up` lattice cells in the square, repeating.
    pub(super) fn value(&self, u: f32, v: f32, across: i32, up: i32) -> f32 {
        let (x, y) = (u * across as f32, v * up as f32);
        let (x0, y0) = (x.floor(), y.floor());
        let ease = |t: f32| t * t * (3.0 - 2.0 * t);
        let (fx, fy) = (ease(x - x0), ease(y - y0));
        let wrap = |k: i32, period: i32| k.rem_euclid(period);
        let (i, j) = (x0 as i32, y0 as i32);
        let (i0, i1) = (wrap(i, across), wrap(i + 1, across));
        let (j0, j1) = (wrap(j, up), wrap(j + 1, up));
        let low = self.cell(i0, j0) + (self.cell(i1, j0) - self.cell(i0, j0)) * fx;
        let high = self.cell(i0, j1) + (self.cell(i1, j1) - self.cell(i0, j1)) * fx;
        low + (high - low) * fy
    }

    /// The sum of `octaves` noises, each twice as fine and half as strong; about 0 to 1.
    pub(super) fn cloud(&self, u: f32, v: f32, across: i32, up: i32, octaves: u32) -> f32 {
        let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
        for k in 0..octaves {
            sum += weight * self.value(u, v, across << k, up << k);
            total += weight;
            weight *= 0.5;
        }
        sum / total
    }
}
