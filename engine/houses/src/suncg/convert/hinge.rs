//! The hinge between the two states of a model.
//!
//! SUNCG stores a door twice, open and closed, and no joint. The part that is the same in both is the frame; the rest rotated
//! about a vertical line. Area, centre and main direction of a surface do not depend on how it is cut into vertices and
//! triangles, so the rotation follows from them even where the two files are meshed differently.

use dwell_scene::{Aabb, Mesh};
use glam::{DMat2, DVec2, Vec3};

use crate::import::ConnectedComponent;

/// Largest difference of the boxes of pieces that stand still, m.
const STILL_M: f32 = 1e-3;
/// Largest distance of the turned leaf from the other state's box, m.
const MISS_M: f32 = 0.015;
/// Smallest rotation of an opening, rad.
const LEAST_TURN_RAD: f64 = 0.05;

/// A vertical hinge in mesh space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MeshHinge {
    /// Position of the axis, (x, z), m.
    pub(super) point: DVec2,
    /// The rotation about +Y that leads to the other state, rad.
    pub(super) turn_rad: f64,
}

impl MeshHinge {
    /// The same hinge seen from the other state.
    pub(super) fn reversed(self) -> Self {
        Self {
            turn_rad: -self.turn_rad,
            ..self
        }
    }
}

/// A hinge and the triangles that move, in either state.
#[derive(Debug)]
pub(super) struct HingeFit {
    pub(super) hinge: MeshHinge,
    pub(super) moving: [Vec<u32>; 2],
}

/// Finds the hinge between two states; `None` when no single vertical hinge explains them.
pub(super) fn fit(meshes: [&Mesh; 2], pieces: &[Vec<ConnectedComponent>; 2]) -> Option<HingeFit> {
    let mut still_in_second = vec![false; pieces[1].len()];
    let mut moving = [Vec::new(), Vec::new()];
    for piece in &pieces[0] {
        let twin = (0..pieces[1].len())
            .find(|&k| !still_in_second[k] && same(&piece.bounds, &pieces[1][k].bounds, STILL_M));
        match twin {
            Some(k) => still_in_second[k] = true,
            None => moving[0].extend(&piece.triangles),
        }
    }
    for (piece, _) in pieces[1]
        .iter()
        .zip(&still_in_second)
        .filter(|(_, still)| !**still)
    {
        moving[1].extend(&piece.triangles);
    }
    let [first, second] = [
        PlanMoments::from_triangles(meshes[0], &moving[0])?,
        PlanMoments::from_triangles(meshes[1], &moving[1])?,
    ];
    // The states are meshed apart and may differ a little in hidden faces; the turned box below decides.
    if (first.area - second.area).abs() > 0.15 * first.area {
        return None;
    }
    // A main direction is known up to half a turn.
    let turn = second.direction_rad - first.direction_rad;
    let turns =
        [-2.0, -1.0, 0.0, 1.0, 2.0].map(|half_turns| turn + half_turns * std::f64::consts::PI);
    let candidates = turns
        .into_iter()
        .filter(|turn| (LEAST_TURN_RAD..3.0).contains(&turn.abs()));
    let hinges = candidates.filter_map(|turn_rad| {
        let rotation = rotation(turn_rad);
        // second = hinge + R (first - hinge), so (1 - R) hinge = second - R first.
        let point =
            (DMat2::IDENTITY - rotation).inverse() * (second.center - rotation * first.center);
        let hinge = MeshHinge { point, turn_rad };
        let turned = Aabb::from_points(points(meshes[0], &moving[0]).map(|p| turned(p, &hinge)));
        let there = Aabb::from_points(points(meshes[1], &moving[1]));
        // A hinge stands at the leaf's edge, not somewhere in the room.
        let near = there.grown(0.1);
        let beside = near.contains(Vec3::new(point.x as f32, near.center().y, point.y as f32));
        (point.is_finite() && beside && same(&turned, &there, MISS_M)).then_some(hinge)
    });
    let hinge = hinges.min_by(|a, b| a.turn_rad.abs().total_cmp(&b.turn_rad.abs()))?;
    Some(HingeFit { hinge, moving })
}

fn same(a: &Aabb, b: &Aabb, tolerance_m: f32) -> bool {
    (a.min - b.min)
        .abs()
        .max((a.max - b.max).abs())
        .max_element()
        < tolerance_m
}

fn points<'a>(mesh: &'a Mesh, triangles: &'a [u32]) -> impl Iterator<Item = Vec3> + 'a {
    triangles.iter().flat_map(|&k| mesh.corners(k as usize))
}

/// Returns the effect of a rotation about +Y on (x, z).
fn rotation(turn_rad: f64) -> DMat2 {
    let (s, c) = turn_rad.sin_cos();
    DMat2::from_cols(DVec2::new(c, -s), DVec2::new(s, c))
}

fn turned(point: Vec3, hinge: &MeshHinge) -> Vec3 {
    let flat = DVec2::new(f64::from(point.x), f64::from(point.z));
    let flat = hinge.point + rotation(hinge.turn_rad) * (flat - hinge.point);
    Vec3::new(flat.x as f32, point.y, flat.y as f32)
}

/// A surface in plan view.
struct PlanMoments {
    /// m².
    area: f64,
    /// The area's centre, (x, z), m.
    center: DVec2,
    /// The angle about +Y of the direction along which it is longest, rad, in (-pi/2, pi/2].
    direction_rad: f64,
}

impl PlanMoments {
    fn from_triangles(mesh: &Mesh, triangles: &[u32]) -> Option<Self> {
        let (mut area, mut sum) = (0.0, DVec2::ZERO);
        let (mut xx, mut xz, mut zz) = (0.0, 0.0, 0.0);
        for &k in triangles {
            let corners = mesh.corners(k as usize).map(Vec3::as_dvec3);
            let [a, b, c] = corners;
            let weight = (b - a).cross(c - a).length() * 0.5;
            let [p, q, r] = corners.map(|v| DVec2::new(v.x, v.z));
            let total = p + q + r;
            area += weight;
            sum += total * (weight / 3.0);
            // The second moment of a triangle: sums over its corners and over their total.
            let moment = |f: fn(DVec2) -> f64| weight / 12.0 * (f(p) + f(q) + f(r) + f(total));
            xx += moment(|v| v.x * v.x);
            xz += moment(|v| v.x * v.y);
            zz += moment(|v| v.y * v.y);
        }
        if area < 1e-6 {
            return None;
        }
        let center = sum / area;
        let (xx, xz, zz) = (
            xx / area - center.x * center.x,
            xz / area - center.x * center.y,
            zz / area - center.y * center.y,
        );
        // A turn by +angle about +Y takes +X towards -Z.
        let direction_rad = -0.5 * (2.0 * xz).atan2(xx - zz);
        Some(Self {
            area,
            center,
            direction_rad,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::components;

    fn door(turn_rad: f64, hinge: DVec2) -> Mesh {
        let mut leaf = Mesh::cuboid(Vec3::new(-0.4, 0.0, -0.02), Vec3::new(0.36, 2.0, 0.02));
        leaf.append(
            &Mesh::cuboid(Vec3::new(0.25, 1.0, 0.02), Vec3::new(0.35, 1.05, 0.07)),
            0,
        );
        let hinge = MeshHinge {
            point: hinge,
            turn_rad,
        };
        leaf.positions
            .iter_mut()
            .for_each(|p| *p = turned(*p, &hinge));
        let mut mesh = Mesh::cuboid(Vec3::new(-0.5, 0.0, -0.1), Vec3::new(-0.42, 2.1, 0.1));
        mesh.append(
            &Mesh::cuboid(Vec3::new(0.42, 0.0, -0.1), Vec3::new(0.5, 2.1, 0.1)),
            0,
        );
        mesh.append(&leaf, 0);
        mesh
    }

    #[test]
    fn a_hinge_is_found_wherever_and_however_far_the_door_opens() {
        let point = DVec2::new(-0.4, 0.02);
        for turn in [-1.5, -0.9, -0.3, 0.2, 1.0, 1.57] {
            let (open, closed) = (door(turn, point), door(0.0, point));
            let fit = fit([&open, &closed], &[components(&open), components(&closed)]).unwrap();
            assert!(
                (fit.hinge.turn_rad + turn).abs() < 1e-4,
                "{turn}: {:?}",
                fit.hinge
            );
            assert!(
                (fit.hinge.point - point).length() < 1e-4,
                "{turn}: {:?}",
                fit.hinge
            );
            assert_eq!(fit.moving.map(|triangles| triangles.len()), [24, 24]);
        }
    }

    #[test]
    fn a_sliding_door_has_no_hinge() {
        let closed = door(0.0, DVec2::ZERO);
        let mut open = closed.clone();
        open.positions.iter_mut().skip(48).for_each(|p| p.x += 0.5);
        assert!(fit([&open, &closed], &[components(&open), components(&closed)]).is_none());
        assert!(
            fit(
                [&closed, &closed],
                &[components(&closed), components(&closed)]
            )
            .is_none()
        );
    }
}
