//! Rays, ray masks and hits.

use glam::Vec3;

/// The surfaces that a ray can hit: bits shared by the ray and the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RayMask(pub u8);

impl RayMask {
    /// Cameras.
    pub const EYE: Self = Self(1);
    /// Sound.
    pub const EAR: Self = Self(2);
    /// Agents' bodies and navigation.
    pub const AGENT: Self = Self(4);
    /// Cameras that see agents' bodies, too: together with [`Self::EYE`].
    pub const BODY: Self = Self(0x80);
    /// Every ray except those for bodies.
    pub const ALL: Self = Self(0x7f);
    /// No ray.
    pub const NONE: Self = Self(0);

    /// Returns whether a ray and a surface share a bit.
    #[inline]
    pub fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// The bits of both.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// A ray, or a segment of one, in world space.
///
/// A ray whose origin or direction is not finite, whose direction is zero, or whose range is empty or not a number hits
/// nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin, m.
    pub origin: Vec3,
    /// Direction; unit length.
    pub direction: Vec3,
    /// Lower end of its range, m; at least 0. A ray that leaves a surface starts a little off it.
    pub near_m: f32,
    /// Upper end of its range, m; may be infinite.
    pub far_m: f32,
}

impl Ray {
    /// The whole ray from `origin` along `direction`, which need not be normalized.
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self {
            origin,
            direction: direction.normalize_or_zero(),
            near_m: 0.0,
            far_m: f32::INFINITY,
        }
    }

    /// Returns the part of this ray between two distances, m.
    #[must_use]
    pub fn with_range(self, near_m: f32, far_m: f32) -> Self {
        Self {
            near_m,
            far_m,
            ..self
        }
    }

    /// The segment from `start` to `end`, less `margin_m` at either end.
    pub fn segment(start: Vec3, end: Vec3, margin_m: f32) -> Self {
        Self::new(start, end - start).with_range(margin_m, (end - start).length() - margin_m)
    }

    /// The point at `distance_m`.
    pub fn point_at(&self, distance_m: f32) -> Vec3 {
        self.origin + self.direction * distance_m
    }

    /// Returns whether the ray can hit anything at all.
    #[inline]
    pub(super) fn is_usable(&self) -> bool {
        self.origin.is_finite()
            && self.direction.is_finite()
            && self.direction != Vec3::ZERO
            && self.near_m >= 0.0
            && self.near_m <= self.far_m
    }
}

/// The closest hit of a ray.
///
/// Surfaces coincide where a farther one's plane lies within 10 µm plus a millionth of the distance of the nearest hit
/// (along the ray at most 32 times as much, so that it holds at grazing angles, too). They count as one, and the lowest id is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray to the nearest surface, m.
    pub distance_m: f32,
    /// Weight of the triangle's second corner.
    pub u: f32,
    /// Weight of the triangle's third corner; the first has `1 - u - v`.
    pub v: f32,
    /// The id given with the static triangle or with the instance.
    pub id: i32,
    /// The instance of the set; `None` for static geometry.
    pub instance: Option<u32>,
    /// Position of the triangle in the list from which its tree was built.
    pub triangle: u32,
}
