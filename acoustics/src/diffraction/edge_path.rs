//! Paths around one edge and around two.

use super::insertion_loss;
use crate::bands::BAND_COUNT;
use crate::planes::DiffractionEdge;
use glam::{DVec2, DVec3, Vec3};

/// Two edges whose directions differ by less count as parallel: the cosine of 11 degrees.
const PARALLEL: f64 = 0.98;

/// Tolerance for a point in a face, as a difference of cosines.
const AT_FACE: f64 = 0.01;

/// An edge with its local axes.
pub(super) struct EdgeFrame {
    start: DVec3,
    along: DVec3,
    length_m: f64,
    /// Perpendicular to the edge: away from the solid, and to its side.
    outward: DVec3,
    beside: DVec3,
    /// Cosine of half the angle of the air around it.
    open_cosine: f64,
}

/// A point in an edge's local axes.
#[derive(Clone, Copy)]
struct EdgeCoordinates {
    /// Along the edge from its start, m.
    along_m: f64,
    /// Outward and to the side, m.
    across: DVec2,
}

/// The shortest path from one point to another over the line of an edge.
pub(super) struct EdgePath {
    /// Its point on the edge, m.
    pub(super) point: DVec3,
    /// Its length beyond that of the straight line, m.
    pub(super) detour_m: f64,
    /// True if the straight line passes behind the edge, through the solid.
    pub(super) is_occluded: bool,
    /// Weight of the edge for a line in sight: 1 where the path around it goes straight on, 0 where it turns back.
    pub(super) forward_weight: f64,
    /// True for a point in the air around the edge: the first and the second.
    pub(super) ends_in_air: [bool; 2],
    /// Detours over the edge's ends re that over `at`, m; negative for an end that the path does not reach.
    pub(super) end_detours_m: [f64; 2],
}

/// The shortest path over two edges.
pub(super) struct DoubleEdgePath {
    pub(super) points: [DVec3; 2],
    pub(super) detour_m: f64,
    /// Detours at each edge alone, m.
    local_m: [f64; 2],
    ends_m: [f64; 2],
}

impl EdgeFrame {
    pub(super) fn new(edge: &DiffractionEdge) -> Self {
        let [a, b] = edge.ends.map(Vec3::as_dvec3);
        let along = (b - a).normalize_or_zero();
        let outward = edge.outward_direction.as_dvec3();
        Self {
            start: a,
            along,
            length_m: a.distance(b),
            outward,
            beside: along.cross(outward),
            open_cosine: libm::cos(0.5 * f64::from(edge.air_angle_rad)),
        }
    }

    fn to_local(&self, point: DVec3) -> EdgeCoordinates {
        let from_start = point - self.start;
        EdgeCoordinates {
            along_m: from_start.dot(self.along),
            across: DVec2::new(from_start.dot(self.outward), from_start.dot(self.beside)),
        }
    }

    fn clamped_point_at(&self, along_m: f64) -> DVec3 {
        self.start + self.along * along_m.clamp(0.0, self.length_m)
    }

    /// Returns a point on the line of the edge.
    fn point_on_line(&self, along_m: f64) -> DVec3 {
        self.start + self.along * along_m
    }

    pub(super) fn is_parallel(&self, other: &Self) -> bool {
        self.along.dot(other.along).abs() > PARALLEL
    }

    pub(super) fn direction(&self) -> DVec3 {
        self.along
    }

    pub(super) fn outward(&self) -> DVec3 {
        self.outward
    }

    /// Returns the path from `a` to `b` over this edge; `None` for points on its line.
    pub(super) fn diffracted_path(&self, a: DVec3, b: DVec3) -> Option<EdgePath> {
        let (p, q) = (self.to_local(a), self.to_local(b));
        let (r, s) = (p.across.length(), q.across.length());
        if r < 1e-6 || s < 1e-6 {
            return None;
        }
        let along_m = p.along_m + (q.along_m - p.along_m) * (r / (r + s));
        let straight_m = a.distance(b);
        let over = |point: DVec3| a.distance(point) + point.distance(b);
        let least_m = over(self.point_on_line(along_m));
        // Faces themselves count as air: waves run along them.
        let open =
            |seen: &EdgeCoordinates, far: f64| seen.across.x >= far * (self.open_cosine - AT_FACE);
        // Where the straight line crosses the plane through the edge that points outward: behind the edge or in front of it.
        let crossing = p.across.x * q.across.y.abs() + q.across.x * p.across.y.abs();
        let ends = [
            (self.start, along_m),
            (self.point_on_line(self.length_m), self.length_m - along_m),
        ];
        Some(EdgePath {
            point: self.clamped_point_at(along_m),
            detour_m: (least_m - straight_m).max(0.0),
            is_occluded: p.across.y * q.across.y < 0.0 && crossing < 0.0,
            forward_weight: (-p.across.dot(q.across) / (r * s)).max(0.0),
            ends_in_air: [open(&p, r), open(&q, s)],
            end_detours_m: ends.map(|(end, before_m)| {
                let detour_m = (over(end) - least_m).max(0.0);
                if before_m < 0.0 { -detour_m } else { detour_m }
            }),
        })
    }

    /// Returns the path from `a` over this edge and then over `other`, which is parallel to it, to `b`; `None` where it
    /// does not bend around the solid at both.
    pub(super) fn doubly_diffracted_path(
        &self,
        other: &Self,
        a: DVec3,
        b: DVec3,
    ) -> Option<DoubleEdgePath> {
        let (p, q) = (self.to_local(a), self.to_local(b));
        let there = self.to_local(other.start);
        let (r, m, s) = (
            p.across.length(),
            there.across.length(),
            q.across.distance(there.across),
        );
        if r < 1e-6 || m < 1e-3 || s < 1e-6 {
            return None;
        }
        let rise = (q.along_m - p.along_m) / (r + m + s);
        let first = self.clamped_point_at(p.along_m + rise * r);
        let on_other = self.point_on_line(p.along_m + rise * (r + m));
        let second = other.clamped_point_at(other.to_local(on_other).along_m);
        let (here, then) = (
            self.diffracted_path(a, second)?,
            other.diffracted_path(first, b)?,
        );
        if !(here.is_occluded
            && then.is_occluded
            && here.ends_in_air == [true; 2]
            && then.ends_in_air == [true; 2])
        {
            return None;
        }
        let length_m = a.distance(first) + first.distance(second) + second.distance(b);
        Some(DoubleEdgePath {
            points: [first, second],
            detour_m: (length_m - a.distance(b)).max(0.0),
            local_m: [here.detour_m, then.detour_m],
            ends_m: [0, 1].map(|k| here.end_detours_m[k].min(then.end_detours_m[k])),
        })
    }
}

impl EdgePath {
    /// Returns the effect of an edge of this length over that of an infinite one. `n_per_m`: Fresnel number of a metre.
    pub(super) fn finite_length_factor(&self, n_per_m: f64) -> f64 {
        finite_edge_factor(self.end_detours_m, n_per_m)
    }

    /// Returns the fraction of a free path's energy that is diffracted. Shape (band,).
    pub(super) fn transmitted_energy(&self, n_per_m: &[f64; BAND_COUNT]) -> [f64; BAND_COUNT] {
        n_per_m.map(|n_per_m| {
            insertion_loss::transmitted_energy(n_per_m * self.detour_m)
                * self.finite_length_factor(n_per_m)
        })
    }
}

impl DoubleEdgePath {
    /// As [`EdgePath::transmitted_energy`].
    pub(super) fn transmitted_energy(&self, n_per_m: &[f64; BAND_COUNT]) -> [f64; BAND_COUNT] {
        let apart_m = self.points[0].distance(self.points[1]);
        n_per_m.map(|n_per_m| {
            let n = n_per_m * self.detour_m;
            let bends = self.local_m.map(|detour_m| n_per_m * detour_m);
            let thick = insertion_loss::second_edge_factor(n, 2.0 / n_per_m, apart_m, bends);
            insertion_loss::transmitted_energy(n) * thick * finite_edge_factor(self.ends_m, n_per_m)
        })
    }
}

/// An edge's end acts on the path around it as a screen: where the path passes far from the end, nothing is lost. The power
/// makes the four sides of a plate that is small against the wavelength together pass all of it.
fn finite_edge_factor(ends_m: [f64; 2], n_per_m: f64) -> f64 {
    let [a, b] = ends_m.map(|end_m| insertion_loss::transmitted_energy(-end_m * n_per_m));
    libm::pow(a * b, 0.7)
}
