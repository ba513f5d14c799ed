//! Penetration depths of convex pieces: an oracle that shares no code with the physics.

use dwell_scene::{Aabb, Collider, House, ObjectId, PartId, Pose};
use glam::Vec3;
use std::f32::consts::TAU;

/// A convex piece in the world, by its farthest extent along any direction.
#[derive(Clone, Debug)]
pub struct ConvexPiece {
    points: Vec<Vec3>,
    /// Added all round.
    radius: f32,
    /// Axis (unit length), half height and radius of a cylinder about the only point.
    cylinder: Option<(Vec3, f32, f32)>,
    /// Directions worth trying first.
    axes: Vec<Vec3>,
    /// The box around it, m.
    pub bounds: Aabb,
}

impl ConvexPiece {
    /// The piece of a part at this pose.
    ///
    /// # Panics
    /// At an exact mesh, which is not convex.
    pub fn new(collider: &Collider, world_from_part: &Pose) -> Self {
        let mut piece = Self {
            points: Vec::new(),
            radius: 0.0,
            cylinder: None,
            axes: Vec::new(),
            bounds: Aabb::EMPTY,
        };
        match collider {
            Collider::Cuboid {
                part_from_box,
                half_extents,
            } => {
                let pose = *world_from_part * *part_from_box;
                let corners = Aabb::new(-*half_extents, *half_extents).corners();
                piece.points = corners.map(|c| pose.transform_point(c)).to_vec();
                piece.axes = [Vec3::X, Vec3::Y, Vec3::Z]
                    .map(|axis| pose.transform_vector(axis))
                    .to_vec();
            }
            Collider::Ball { center, radius } => {
                piece.points = vec![world_from_part.transform_point(*center)];
                piece.radius = *radius;
            }
            Collider::Cylinder {
                part_from_cylinder,
                half_height,
                radius,
            } => {
                let pose = *world_from_part * *part_from_cylinder;
                piece.points = vec![pose.position];
                let axis = pose.transform_vector(Vec3::Y);
                piece.cylinder = Some((axis, *half_height, *radius));
                piece.axes = vec![axis];
            }
            Collider::Hull { points } => {
                piece.points = points
                    .iter()
                    .map(|p| world_from_part.transform_point(*p))
                    .collect();
            }
            Collider::ExactMesh => panic!("built-in things have convex pieces only"),
        }
        piece.update_bounds();
        piece
    }

    /// A box along the axes.
    pub fn cuboid(bounds: &Aabb) -> Self {
        Self::new(&Collider::cuboid(bounds.min, bounds.max), &Pose::IDENTITY)
    }

    fn update_bounds(&mut self) {
        let far = |d: Vec3| self.support(d);
        let max = Vec3::new(far(Vec3::X), far(Vec3::Y), far(Vec3::Z));
        let min = -Vec3::new(far(Vec3::NEG_X), far(Vec3::NEG_Y), far(Vec3::NEG_Z));
        self.bounds = Aabb { min, max };
    }

    /// The piece, moved by so many metres.
    #[must_use]
    pub fn moved(&self, by: Vec3) -> Self {
        let mut piece = self.clone();
        for point in &mut piece.points {
            *point += by;
        }
        piece.update_bounds();
        piece
    }

    /// The farthest coordinate along a unit direction.
    pub fn support(&self, direction: Vec3) -> f32 {
        let far = self
            .points
            .iter()
            .map(|p| p.dot(direction))
            .fold(f32::MIN, f32::max)
            + self.radius;
        let round = self.cylinder.map_or(0.0, |(axis, half, radius)| {
            let cosine = axis.dot(direction);
            half * cosine.abs() + radius * (1.0 - cosine * cosine).max(0.0).sqrt()
        });
        far + round
    }

    fn overlap_along(&self, other: &Self, direction: Vec3) -> f32 {
        self.support(direction) + other.support(-direction)
    }
}

/// Returns how far two pieces reach into each other, m; negative: the gap between them. Never less than the truth: a direction
/// that separates the pieces is a proof, and the search for the best one stops at `enough`.
pub fn penetration_depth(a: &ConvexPiece, b: &ConvexPiece, enough: f32) -> f32 {
    let mut best = (f32::MAX, Vec3::Y);
    let mut attempt = |direction: Vec3| {
        let direction = direction.normalize_or(Vec3::Y);
        for direction in [direction, -direction] {
            let found = a.overlap_along(b, direction);
            if found < best.0 {
                best = (found, direction);
            }
        }
        best
    };
    for axis in [
        Vec3::X,
        Vec3::Y,
        Vec3::Z,
        a.bounds.center() - b.bounds.center(),
    ]
    .iter()
    .chain(&a.axes)
    .chain(&b.axes)
    {
        attempt(*axis);
    }
    for p in &a.axes {
        for q in &b.axes {
            attempt(p.cross(*q));
        }
    }
    if attempt(Vec3::Y).0 <= enough {
        return attempt(Vec3::Y).0;
    }
    for k in 0..160 {
        let y = (k as f32 + 0.5) / 160.0;
        let (sin, cos) = dwell_scene::math::sin_cos(TAU * 0.381_966 * k as f32);
        let r = (1.0 - y * y).sqrt();
        attempt(Vec3::new(r * sin, y, r * cos));
    }
    let mut step = 0.15;
    while step > 1e-4 {
        let (before, direction) = attempt(Vec3::Y);
        if before <= enough {
            return before;
        }
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            attempt(direction + axis * step);
            attempt(direction - axis * step);
        }
        if attempt(Vec3::Y).0 >= before {
            step *= 0.5;
        }
    }
    attempt(Vec3::Y).0
}

/// The pieces of a part that stands at `world_from_part`.
pub fn part_pieces(house: &House, part: PartId, world_from_part: &Pose) -> Vec<ConvexPiece> {
    house.parts[part]
        .colliders
        .iter()
        .map(|collider| ConvexPiece::new(collider, world_from_part))
        .collect()
}

/// The pieces of an object at the start.
pub fn object_pieces(house: &House, object: ObjectId) -> Vec<ConvexPiece> {
    house.objects[object]
        .parts()
        .flat_map(|part| part_pieces(house, part, &house.parts[part].world_from_part))
        .collect()
}

/// The largest depth between two sets of pieces, at least `enough`.
pub fn max_depth(a: &[ConvexPiece], b: &[ConvexPiece], enough: f32) -> f32 {
    let mut worst = enough;
    for p in a {
        let near = p.bounds.grown(-enough.min(0.0));
        for q in b.iter().filter(|q| near.intersects(&q.bounds)) {
            worst = worst.max(penetration_depth(p, q, worst));
        }
    }
    worst
}

#[test]
fn depth_of_boxes_and_balls_is_known() {
    let unit = ConvexPiece::cuboid(&Aabb::new(Vec3::ZERO, Vec3::ONE));
    let close = |a: f32, b: f32| assert!((a - b).abs() < 2e-3, "{a} instead of {b}");
    close(
        penetration_depth(&unit, &unit.moved(Vec3::new(0.9, 0.3, 0.2)), -1.0),
        0.1,
    );
    close(
        penetration_depth(&unit, &unit.moved(Vec3::new(1.25, 0.0, 0.0)), -1.0),
        -0.25,
    );
    let ball = ConvexPiece::new(
        &Collider::Ball {
            center: Vec3::ZERO,
            radius: 0.5,
        },
        &Pose::IDENTITY,
    );
    close(
        penetration_depth(&ball, &ball.moved(Vec3::new(0.6, 0.0, 0.4)), -1.0),
        1.0 - 0.52_f32.sqrt(),
    );
    let corner = Vec3::splat(1.0 + 0.4 / 3.0_f32.sqrt());
    close(penetration_depth(&unit, &ball.moved(corner), -1.0), 0.1);
    let post = ConvexPiece::new(
        &Collider::Cylinder {
            part_from_cylinder: Pose::IDENTITY,
            half_height: 1.0,
            radius: 0.5,
        },
        &Pose::IDENTITY,
    );
    close(
        penetration_depth(&post, &post.moved(Vec3::new(0.6, 1.5, 0.6)), -1.0),
        1.0 - 0.72_f32.sqrt(),
    );
}
