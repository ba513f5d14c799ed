//! Shapes turned on a lathe: cylinders, cones, balls, vases.

use super::SolidMesh;
use super::grid::{Vertex, add_grid};
use dwell_scene::{Collider, Mesh, Pose, math};
use glam::{Vec2, Vec3};
use std::f32::consts::TAU;

/// Two neighbouring lines of a profile whose directions differ by less make one smooth surface: cosine of 50 degrees.
const SMOOTH_COSINE: f32 = 0.64;
/// Most cylinders that stand for a body of revolution, unless they are alike.
const MOST_CYLINDERS: usize = 4;

/// A body of revolution about +Y. `profile`: (radius, height) in m, so that the body lies to the left of the way along it
/// (from the lower end of the axis outwards and up to the upper end; or around a closed loop whose last point is its first).
/// It collides as a few
/// cylinders.
pub fn surface_of_revolution(profile: &[(f32, f32)], segments: usize) -> SolidMesh {
    SolidMesh::new(surface(profile, segments), cylinder_stack(profile))
}

/// A cylinder that stands on the origin.
pub fn cylinder(radius_m: f32, height_m: f32, segments: usize) -> SolidMesh {
    let profile = [
        (0.0, 0.0),
        (radius_m, 0.0),
        (radius_m, height_m),
        (0.0, height_m),
    ];
    let collider = Collider::Cylinder {
        part_from_cylinder: Pose::from_position(Vec3::Y * (height_m * 0.5)),
        half_height: height_m * 0.5,
        radius: radius_m,
    };
    SolidMesh::new(surface(&profile, segments), vec![collider])
}

/// A truncated cone that stands on the origin.
pub fn cone(lower_radius_m: f32, upper_radius_m: f32, height_m: f32, segments: usize) -> SolidMesh {
    let profile = [
        (0.0, 0.0),
        (lower_radius_m, 0.0),
        (upper_radius_m, height_m),
        (0.0, height_m),
    ];
    surface_of_revolution(&profile, segments)
}

/// A ball about the origin.
pub fn ball(radius_m: f32, segments: usize) -> SolidMesh {
    let rings = segments / 2;
    let profile: Vec<(f32, f32)> = (0..=rings)
        .map(|k| {
            let (sin, cos) = math::sin_cos(TAU * 0.5 * k as f32 / rings as f32);
            let radius = if k == 0 || k == rings {
                0.0
            } else {
                radius_m * sin
            };
            (radius, -radius_m * cos)
        })
        .collect();
    let collider = Collider::Ball {
        center: Vec3::ZERO,
        radius: radius_m,
    };
    SolidMesh::new(surface(&profile, segments), vec![collider])
}

/// The point of a profile at `segment` of `segments` around the axis.
pub(super) fn profile_point((radius, height): (f32, f32), segment: usize, segments: usize) -> Vec3 {
    // The first angle comes again exactly, so that the seam is closed.
    let (sin, cos) = math::sin_cos(TAU * (segment % segments) as f32 / segments as f32);
    Vec3::new(radius * sin, height, radius * cos)
}

/// Cylinders that stand for a body of revolution: each has the volume of the slab that it replaces.
///
/// Cylinders, not hulls: contact solvers hold a hull's face by four corners at most, so that a round foot with more
/// corners tips over.
pub(super) fn cylinder_stack(profile: &[(f32, f32)]) -> Vec<Collider> {
    let mut heights: Vec<f32> = profile.iter().map(|p| p.1).collect();
    heights.sort_by(f32::total_cmp);
    heights.dedup_by(|a, b| (*a - *b).abs() < 1e-4);
    // Mean square of the outer radius between two heights: that of a truncated cone.
    let outer = |y: f32| {
        let crossing = |pair: &[(f32, f32)]| {
            let ([(r0, y0), (r1, y1)], span) = ([pair[0], pair[1]], pair[1].1 - pair[0].1);
            let inside = (y0.min(y1)..=y0.max(y1)).contains(&y) && span != 0.0;
            inside.then(|| r0 + (r1 - r0) * (y - y0) / span)
        };
        profile
            .windows(2)
            .filter_map(crossing)
            .fold(0.0_f32, f32::max)
    };
    let mut slabs: Vec<HorizontalSlice> = heights
        .windows(2)
        .map(|y| {
            let inset = 0.01 * (y[1] - y[0]);
            let (a, b) = (outer(y[0] + inset), outer(y[1] - inset));
            HorizontalSlice {
                low: y[0],
                high: y[1],
                square: (a * a + a * b + b * b) / 3.0,
            }
        })
        .collect();
    while slabs.len() > 1 {
        // The two neighbours that are most alike become one, until few are left that differ.
        let gap = |k: usize| (slabs[k].square.sqrt() - slabs[k + 1].square.sqrt()).abs();
        let Some(k) = (0..slabs.len() - 1).min_by(|a, b| gap(*a).total_cmp(&gap(*b))) else {
            break;
        };
        let widest = slabs
            .iter()
            .map(|slab| slab.square)
            .fold(0.0, f32::max)
            .sqrt();
        if slabs.len() <= MOST_CYLINDERS && gap(k) > 0.06 * widest {
            break;
        }
        let upper = slabs.remove(k + 1);
        slabs[k] = slabs[k].merged(&upper);
    }
    slabs
        .into_iter()
        .filter(|slab| slab.square > 0.0)
        .map(HorizontalSlice::cylinder)
        .collect()
}

/// A level slice of a body of revolution.
#[derive(Clone, Copy)]
struct HorizontalSlice {
    low: f32,
    high: f32,
    /// Mean square of the radius, m².
    square: f32,
}

impl HorizontalSlice {
    fn merged(self, upper: &Self) -> Self {
        let (a, b) = (self.high - self.low, upper.high - upper.low);
        let square = (self.square * a + upper.square * b) / (a + b);
        Self {
            low: self.low,
            high: upper.high,
            square,
        }
    }

    fn cylinder(self) -> Collider {
        Collider::Cylinder {
            part_from_cylinder: Pose::from_position(Vec3::Y * (0.5 * (self.low + self.high))),
            half_height: 0.5 * (self.high - self.low),
            radius: self.square.sqrt(),
        }
    }
}

/// The surface of a body of revolution.
pub(super) fn surface(profile: &[(f32, f32)], segments: usize) -> Mesh {
    let lines: Vec<[Vec2; 2]> = profile
        .windows(2)
        .map(|pair| [Vec2::from(pair[0]), Vec2::from(pair[1])])
        .filter(|[a, b]| a != b)
        .collect();
    let outward: Vec<Vec2> = lines
        .iter()
        .map(|[a, b]| Vec2::new(b.y - a.y, a.x - b.x).normalize_or_zero())
        .collect();
    let closed = profile.first() == profile.last() && profile[0].0 > 0.0;
    let joint = |k: usize, other: Option<usize>| {
        let own = outward[k];
        match other.map(|other| outward[other]) {
            Some(next) if own.dot(next) > SMOOTH_COSINE => (own + next).normalize_or_zero(),
            _ => own,
        }
    };
    let mut mesh = Mesh::default();
    let mut v = 0.0;
    for (k, [a, b]) in lines.iter().enumerate() {
        let before = if k > 0 {
            Some(k - 1)
        } else {
            closed.then(|| lines.len() - 1)
        };
        let after = if k + 1 < lines.len() {
            Some(k + 1)
        } else {
            closed.then_some(0)
        };
        let normals = [joint(k, before), joint(k, after)];
        let length = (*b - *a).length();
        let wide = a.x.max(b.x);
        add_grid(&mut mesh, segments + 1, 2, |i, j| {
            let end = if j == 0 { *a } else { *b };
            let direction = profile_point((1.0, 0.0), i, segments);
            let normal = direction * normals[j].x + Vec3::Y * normals[j].y;
            let position = profile_point(end.into(), i, segments);
            // Discs show their image flat, walls have it wrapped around.
            let uv = if outward[k].y.abs() > 0.8 {
                Vec2::new(position.x, -position.z)
            } else {
                Vec2::new(
                    TAU * wide * i as f32 / segments as f32,
                    v + length * j as f32,
                )
            };
            Vertex {
                position,
                normal,
                uv,
            }
        });
        v += length;
    }
    mesh
}
