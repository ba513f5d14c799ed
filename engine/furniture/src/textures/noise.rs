//! Noise that repeats, for textures without seams.

use dwell_scene::random::RandomKey;

const TABLE: usize = 256;

/// The largest whole number not above `x`; quicker than `f32::floor`, which is a call on plain x86-64.
#[inline]
pub(super) fn floor(x: f32) -> i32 {
    let cut = x as i32;
    cut - i32::from(x < cut as f32)
}

/// Value noise on a lattice.
pub(super) struct ValueNoise {
    values: [f32; TABLE],
    order: [u8; TABLE],
}

impl ValueNoise {
    /// The noise of a key.
    pub(super) fn new(key: RandomKey) -> Self {
        let mut stream = key.stream();
        let mut order: [u8; TABLE] = std::array::from_fn(|k| k as u8);
        stream.shuffle(&mut order);
        Self {
            values: std::array::from_fn(|_| stream.uniform_f32()),
            order,
        }
    }

    /// A value in [0, 1) for an integer place; equal places, equal values.
    #[inline]
    pub(super) fn lattice_value(&self, x: i32, y: i32) -> f32 {
        // The table's length is a power of two, so that masking is the remainder, of negative numbers too.
        let mask = TABLE as i32 - 1;
        let column = self.order[(x & mask) as usize];
        self.values[((i32::from(column) + y) & mask) as usize]
    }

    /// Smooth noise in [0, 1): (`u`, `v`) in 0 to 1, `across` by `up` lattice cells in the square, repeating.
    #[inline]
    pub(super) fn value_at(&self, u: f32, v: f32, across: i32, up: i32) -> f32 {
        let [(i0, i1, fx), (j0, j1, fy)] = [(u, across), (v, up)].map(|(t, period)| {
            let x = t * period as f32;
            let cell = floor(x);
            let first = if (0..period).contains(&cell) {
                cell
            } else {
                cell.rem_euclid(period)
            };
            let second = if first + 1 == period { 0 } else { first + 1 };
            let f = x - cell as f32;
            (first, second, f * f * (3.0 - 2.0 * f))
        });
        let low = self.lattice_value(i0, j0)
            + (self.lattice_value(i1, j0) - self.lattice_value(i0, j0)) * fx;
        let high = self.lattice_value(i0, j1)
            + (self.lattice_value(i1, j1) - self.lattice_value(i0, j1)) * fx;
        low + (high - low) * fy
    }

    /// The sum of `octaves` noises, each twice as fine and half as strong; about 0 to 1.
    pub(super) fn fractal(&self, u: f32, v: f32, across: i32, up: i32, octaves: u32) -> f32 {
        let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
        for k in 0..octaves {
            sum += weight * self.value_at(u, v, across << k, up << k);
            total += weight;
            weight *= 0.5;
        }
        sum / total
    }
}
