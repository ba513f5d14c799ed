//! Boxes that are turned with their things, and how far two of them overlap.

use dwell_scene::{Aabb, Pose};
use glam::{DMat3, DVec3, Vec3};

/// The least edge of a box, m: a sheet of paper has a volume, too.
const THINNEST_M: f32 = 0.001;

/// A box that is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OrientedBox {
    /// From the middle and the axes of the box to the world.
    pub(super) world_from_box: Pose,
    /// Half of its edges along its own axes, m.
    pub(super) half: Vec3,
}

impl OrientedBox {
    /// The box `bounds` of a frame that stands at `world_from_frame`.
    pub(super) fn of(world_from_frame: Pose, bounds: &Aabb) -> Self {
        Self {
            world_from_box: world_from_frame * Pose::from_position(bounds.center()),
            half: (0.5 * bounds.size()).max(Vec3::splat(0.5 * THINNEST_M)),
        }
    }

    /// Its corners, m.
    pub(super) fn corners(&self) -> [Vec3; 8] {
        let local = Aabb::new(-self.half, self.half).corners();
        local.map(|corner| self.world_from_box.transform_point(corner))
    }

    /// The least distance between a corner of one and a corner of the other, m.
    pub(super) fn corner_distance_m(&self, other: &Self) -> f64 {
        let theirs = other.corners();
        let pairs = self.corners().into_iter();
        let pairs = pairs.flat_map(|own| theirs.map(|their| own.distance(their)));
        f64::from(pairs.fold(f32::INFINITY, f32::min))
    }

    fn volume_m3(&self) -> f64 {
        let edges = 2.0 * self.half.as_dvec3();
        edges.x * edges.y * edges.z
    }

    /// The share of the volume of both together that is common to them, 0 to 1.
    pub(super) fn iou(&self, other: &Self) -> f64 {
        let common = self.common_volume_m3(other);
        let all = self.volume_m3() + other.volume_m3() - common;
        (common / all).clamp(0.0, 1.0)
    }

    /// The volume of the intersection, m³: this box, cut by the planes of the other one.
    fn common_volume_m3(&self, other: &Self) -> f64 {
        let turn = DMat3::from_quat(other.world_from_box.rotation.as_dquat()).transpose();
        let middle = other.world_from_box.position.as_dvec3();
        let own = DMat3::from_quat(self.world_from_box.rotation.as_dquat());
        let at = self.world_from_box.position.as_dvec3();
        let half = self.half.as_dvec3();
        let corner =
            |signs: [f64; 3]| turn * (at + own * (DVec3::from_array(signs) * half) - middle);
        let mut solid: Vec<Vec<DVec3>> = Vec::with_capacity(12);
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let around = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
                let face = around.map(|(u, v)| {
                    let mut signs = [0.0; 3];
                    signs[axis] = side;
                    signs[(axis + 1) % 3] = u;
                    signs[(axis + 2) % 3] = v;
                    corner(signs)
                });
                solid.push(face.to_vec());
            }
        }
        let reach = other.half.as_dvec3();
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                solid = cut(&solid, axis, side, reach[axis]);
            }
        }
        convex_volume(&solid)
    }
}

/// The part of a convex solid, given by its faces, where `side` times the coordinate along `axis` is at most `limit`.
fn cut(solid: &[Vec<DVec3>], axis: usize, side: f64, limit: f64) -> Vec<Vec<DVec3>> {
    let height = |point: &DVec3| side * point[axis] - limit;
    let mut rim: Vec<DVec3> = Vec::new();
    let mut kept: Vec<Vec<DVec3>> = Vec::with_capacity(solid.len() + 1);
    for face in solid {
        let mut rest = Vec::with_capacity(face.len() + 1);
        for (k, from) in face.iter().enumerate() {
            let to = &face[(k + 1) % face.len()];
            let (a, b) = (height(from), height(to));
            if a <= 0.0 {
                rest.push(*from);
            }
            if (a <= 0.0) != (b <= 0.0) {
                let crossing = from.lerp(*to, a / (a - b));
                rest.push(crossing);
                rim.push(crossing);
            }
        }
        if rest.len() >= 3 {
            kept.push(rest);
        }
    }
    if rim.len() >= 3 {
        kept.push(in_order_around(rim, axis));
    }
    kept
}

/// Points of a plane across `axis` in the order in which they lie around their middle.
fn in_order_around(mut points: Vec<DVec3>, axis: usize) -> Vec<DVec3> {
    let middle = points.iter().sum::<DVec3>() / points.len() as f64;
    // Rises with the angle, from 0 to 4.
    let turn = |point: &DVec3| {
        let away = *point - middle;
        let (u, v) = (away[(axis + 1) % 3], away[(axis + 2) % 3]);
        let length = u.abs() + v.abs();
        match (length > 0.0, v >= 0.0) {
            (false, _) => 0.0,
            (true, true) => 1.0 - u / length,
            (true, false) => 3.0 + u / length,
        }
    };
    points.sort_by(|a, b| turn(a).total_cmp(&turn(b)));
    points
}

/// The volume of a convex solid that is given by its faces: that of the pyramids from a point inside to each.
fn convex_volume(solid: &[Vec<DVec3>]) -> f64 {
    let count: usize = solid.iter().map(Vec::len).sum();
    if count == 0 {
        return 0.0;
    }
    let inside = solid.iter().flatten().sum::<DVec3>() / count as f64;
    let pyramid = |face: &Vec<DVec3>| {
        let fans = face.windows(2).skip(1);
        let fans = fans.map(|pair| {
            let (a, b, c) = (face[0] - inside, pair[0] - inside, pair[1] - inside);
            a.dot(b.cross(c)).abs() / 6.0
        });
        fans.sum::<f64>()
    };
    solid.iter().map(pyramid).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;
    use glam::Quat;

    fn upright(center: [f32; 3], size: [f32; 3], yaw_rad: f32) -> OrientedBox {
        OrientedBox {
            world_from_box: Pose::from_position_yaw(Vec3::from_array(center), yaw_rad),
            half: 0.5 * Vec3::from_array(size),
        }
    }

    #[test]
    fn boxes_overlap_as_worked_out_by_hand() {
        let cube = upright([0.0; 3], [1.0; 3], 0.0);
        let near = |found: f64, expected: f64| {
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        };
        near(cube.iou(&cube), 1.0);
        // Half of each in the other: a third of both together.
        near(
            cube.iou(&upright([0.5, 0.0, 0.0], [1.0; 3], 0.0)),
            1.0 / 3.0,
        );
        // One in the middle of the other.
        near(cube.iou(&upright([0.1, 0.0, -0.2], [0.5; 3], 0.0)), 0.125);
        // An eighth of a turn: the regular octagon of inradius 1/2 has the area 2 (sqrt(2) - 1).
        let octagon = 2.0 * (2.0_f64.sqrt() - 1.0);
        let turned = upright([0.0; 3], [1.0; 3], std::f32::consts::FRAC_PI_4);
        near(cube.iou(&turned), octagon / (2.0 - octagon));
        // Side by side, and far apart.
        near(cube.iou(&upright([1.0, 0.0, 0.0], [1.0; 3], 0.0)), 0.0);
        near(cube.iou(&upright([0.0, 7.0, 0.0], [1.0; 3], 0.3)), 0.0);
        // A quarter of a turn about another axis changes nothing of a cube.
        let tipped = OrientedBox {
            world_from_box: Pose::new(
                Vec3::ZERO,
                Quat::from_rotation_x(std::f32::consts::FRAC_PI_2),
            ),
            ..cube
        };
        near(cube.iou(&tipped), 1.0);
        near(
            upright([3.0, 0.0, 0.0], [1.0; 3], 0.0).corner_distance_m(&cube),
            2.0,
        );
    }

    /// Against the share of points of both boxes that lie in both, drawn at random.
    #[test]
    fn boxes_overlap_as_random_points_say() {
        let mut stream = RandomKey::root(7).stream();
        let mut common = 0;
        for _ in 0..60 {
            let mut any = |reach: f32| {
                Vec3::new(
                    stream.range(-reach, reach),
                    stream.range(-reach, reach),
                    stream.range(-reach, reach),
                )
            };
            let mut made = || {
                let turn = any(1.0);
                OrientedBox {
                    world_from_box: Pose::new(any(0.3), Quat::from_scaled_axis(3.0 * turn)),
                    half: any(0.4).abs() + Vec3::splat(0.1),
                }
            };
            let (a, b) = (made(), made());
            let mut inside = 0;
            let count = 20_000;
            for _ in 0..count {
                let point = a.world_from_box.transform_point(any(1.0) * a.half);
                let in_b = b.world_from_box.inverse().transform_point(point).abs();
                inside += u32::from(in_b.cmple(b.half).all());
            }
            let share = f64::from(inside) / f64::from(count);
            let both = share * a.volume_m3();
            let expected = both / (a.volume_m3() + b.volume_m3() - both);
            // Five standard deviations of a share of 20,000 points are below 0.018.
            assert!(
                (a.iou(&b) - expected).abs() < 0.02,
                "{} {expected}",
                a.iou(&b)
            );
            assert!((a.iou(&b) - b.iou(&a)).abs() < 1e-6);
            common += u32::from(expected > 0.0);
        }
        assert!(common > 20, "{common}");
    }
}
