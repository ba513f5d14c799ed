//! Shapes turned on a lathe: cylinders, cones, balls, vases.

use super::Solid;
use super::grid::{Vertex, add_grid};
use dwell_scene::{Collider, Mesh, Pose, math};
use glam::{Vec2, Vec3};
use std::f32::consts::TAU;

/// Two neighbouring lines of a profile whose directions differ by less make one smooth surface: cosine of 50 degrees.
const SMOOTH_COSINE: f32 = 0.64;
/// Points around a collision hull.
const HULL_SIDES: usize = 10;

/// A body of revolution about +Y. `profile`: (radius, height) in m, so that the body lies to the left of the way along it
/// (from the lower end of the axis outwards and up to the upper end; or around a closed loop whose last point is its first).
/// It collides as the convex hull.
pub(crate) fn lathe(profile: &[(f32, f32)], segments: usize) -> Solid {
    let mesh = surface(profile, segments);
    let points = hull_points(profile, HULL_SIDES);
    Solid::new(mesh, vec![Collider::Hull { points }])
}

/// A cylinder that stands on the origin.
pub(crate) fn cylinder(radius_m: f32, height_m: f32, segments: usize) -> Solid {
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
    Solid::new(surface(&profile, segments), vec![collider])
}

/// A truncated cone that stands on the origin.
pub(crate) fn cone(
    lower_radius_m: f32,
    upper_radius_m: f32,
    height_m: f32,
    segments: usize,
) -> Solid {
    let profile = [
        (0.0, 0.0),
        (lower_radius_m, 0.0),
        (upper_radius_m, height_m),
        (0.0, height_m),
    ];
    lathe(&profile, segments)
}

/// A ball about the origin.
pub(crate) fn ball(radius_m: f32, segments: usize) -> Solid {
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
    Solid::new(surface(&profile, segments), vec![collider])
}

/// The point of a profile at `segment` of `segments` around the axis.
pub(super) fn around((radius, height): (f32, f32), segment: usize, segments: usize) -> Vec3 {
    // The first angle comes again exactly, so that the seam is closed.
    let (sin, cos) = math::sin_cos(TAU * (segment % segments) as f32 / segments as f32);
    Vec3::new(radius * sin, height, radius * cos)
}

/// Corners of the hull: the profile's own points, each ring grown so that the polygon has the circle's area.
pub(super) fn hull_points(profile: &[(f32, f32)], sides: usize) -> Vec<Vec3> {
    // At most four rings: those that lie farthest out in one of four directions.
    let mut rings: Vec<(f32, f32)> = Vec::new();
    for (r, y) in [(0.3, -1.0), (1.0, -0.4), (1.0, 0.4), (0.3, 1.0)] {
        let far = |p: &&(f32, f32)| p.0 * r + p.1 * y;
        if let Some(best) = profile.iter().max_by(|a, b| far(a).total_cmp(&far(b)))
            && !rings.contains(best)
        {
            rings.push(*best);
        }
    }
    let corner = |ring: (f32, f32)| {
        let count = if ring.0 > 0.0 { sides } else { 1 };
        (0..count).map(move |k| around(ring, k, sides))
    };
    rings.into_iter().flat_map(corner).collect()
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
            let direction = around((1.0, 0.0), i, segments);
            let normal = direction * normals[j].x + Vec3::Y * normals[j].y;
            let uv = Vec2::new(
                TAU * wide * i as f32 / segments as f32,
                v + length * j as f32,
            );
            Vertex {
                position: around(end.into(), i, segments),
                normal,
                uv,
            }
        });
        v += length;
    }
    mesh
}
