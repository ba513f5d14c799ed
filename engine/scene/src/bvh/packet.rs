//! Ray packets and their hits.

use glam::Vec3;

use super::ray::Ray;

/// Rays with a common origin, as those of a pinhole camera or to a lamp; fast when their directions are similar.
///
/// `N`: a power of two, at most 64. 16 (4 by 4 pixels) is best without wide instructions, 32 (8 by 4) with.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct RayPacket<const N: usize> {
    /// Unit length. Shape (axis, ray).
    pub direction: [[f32; N]; 3],
    /// Lower ends of the ranges, m; at least 0.
    pub near_m: [f32; N],
    /// Upper ends of the ranges, m; below `near_m` for an unused ray.
    pub far_m: [f32; N],
    /// Common origin, m.
    pub origin: Vec3,
}

impl<const N: usize> RayPacket<N> {
    /// A packet without active rays; fill `direction`, `near_m` and `far_m`.
    pub fn new(origin: Vec3) -> Self {
        const {
            assert!(
                N.is_power_of_two() && N <= 64,
                "packets hold 1, 2, 4, 8, 16, 32 or 64 rays"
            );
        };
        Self {
            direction: [[0.0; N]; 3],
            near_m: [0.0; N],
            far_m: [-1.0; N],
            origin,
        }
    }

    /// Sets one ray; its direction needs unit length.
    #[inline]
    pub fn set(&mut self, k: usize, direction: Vec3, near_m: f32, far_m: f32) {
        for axis in 0..3 {
            self.direction[axis][k] = direction[axis];
        }
        (self.near_m[k], self.far_m[k]) = (near_m, far_m);
    }

    /// One of the rays.
    #[inline]
    pub fn ray(&self, k: usize) -> Ray {
        Ray {
            origin: self.origin,
            direction: Vec3::new(
                self.direction[0][k],
                self.direction[1][k],
                self.direction[2][k],
            ),
            near_m: self.near_m[k],
            far_m: self.far_m[k],
        }
    }

    /// Returns the upper end of each ray's range; minus infinity for a ray that cannot hit anything.
    #[inline(always)]
    pub(super) fn effective_far(&self) -> [f32; N] {
        let mut far = [f32::NEG_INFINITY; N];
        if self.origin.is_finite() {
            let [x, y, z] = &self.direction;
            for k in 0..N {
                let size = (x[k].abs() + y[k].abs()) + z[k].abs();
                let usable = (size > 0.0) & (size < f32::INFINITY) & (self.near_m[k] >= 0.0);
                far[k] = if usable & (self.near_m[k] <= self.far_m[k]) {
                    self.far_m[k]
                } else {
                    f32::NEG_INFINITY
                };
            }
        }
        far
    }
}

/// The hits of a packet's rays; see [`Hit`](super::Hit).
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct PacketHits<const N: usize> {
    /// Distance along the ray, m; infinite without a hit.
    pub distance_m: [f32; N],
    /// The id; 0 without a hit.
    pub id: [i32; N],
    /// The triangle's position in its list.
    pub triangle: [u32; N],
    /// The instance plus 1; 0 for static geometry.
    pub(super) source: [u32; N],
    /// The triangle's place in its tree.
    pub(super) slot: [u32; N],
}

impl<const N: usize> PacketHits<N> {
    /// No hits.
    pub fn new() -> Self {
        Self {
            distance_m: [f32::INFINITY; N],
            id: [0; N],
            triangle: [0; N],
            source: [0; N],
            slot: [u32::MAX; N],
        }
    }

    /// Returns whether a ray hit something.
    #[inline]
    pub fn is_hit(&self, k: usize) -> bool {
        self.slot[k] != u32::MAX
    }

    /// Returns the rays that hit the same triangle of the same instance as ray `k`, as bits.
    #[inline]
    pub fn same_triangle_mask(&self, k: usize) -> u64 {
        let (source, slot) = (self.source[k], self.slot[k]);
        let mut bits = 0;
        for first in (0..N).step_by(8) {
            let mut eight = 0_u64;
            for lane in first..(first + 8).min(N) {
                let is_same = (self.source[lane] == source) & (self.slot[lane] == slot);
                eight |= u64::from(is_same) << (lane - first);
            }
            bits |= eight << first;
        }
        bits
    }

    /// Returns the instance that a ray hit; `None` for static geometry.
    #[inline]
    pub fn instance(&self, k: usize) -> Option<u32> {
        self.source[k].checked_sub(1)
    }
}

impl<const N: usize> Default for PacketHits<N> {
    fn default() -> Self {
        Self::new()
    }
}
