//! Models in other sizes.

use super::model::Model;
use dwell_scene::{Aabb, Collider, JointKind, LightShape, Mesh, Pose};
use glam::Vec3;
use std::f32::consts::TAU;
use std::sync::Arc;

/// Corners of the polygon that stands for a circle once it is none any more.
const SIDES: u8 = 16;
/// Rings of the hull that stands for a ball once it is none any more, its poles not counted.
const RINGS: u8 = 5;

impl Model {
    /// The same model, every length `factor` times as long, of the same densities; images keep their scale.
    #[must_use]
    pub fn resized(self, factor: f32) -> Self {
        self.stretched(Vec3::splat(factor))
    }

    /// The same model, its width, height and depth `by` times as long (above 0 each), of the same densities; images keep
    /// their scale. What was round becomes a hull.
    #[must_use]
    pub fn stretched(mut self, by: Vec3) -> Self {
        let uniform = by.x == by.y && by.y == by.z;
        for part in &mut self.parts {
            let mut mesh = Mesh::clone(&part.mesh);
            for position in &mut mesh.positions {
                *position *= by;
            }
            if !uniform {
                for normal in &mut mesh.normals {
                    *normal = (*normal / by).normalize_or(*normal);
                }
            }
            part.mesh = Arc::new(mesh);
            part.mass_kg *= by.x * by.y * by.z;
            for collider in &mut part.colliders {
                if uniform {
                    scale_collider(collider, by.x);
                } else {
                    *collider = stretch(collider, by);
                }
            }
        }
        for joint in &mut self.joints {
            joint.position *= by;
            if joint.kind == JointKind::Slide {
                let along = (joint.axis * by).length();
                joint.axis = (joint.axis * by).normalize_or(joint.axis);
                joint.open *= along;
                joint.initial *= along;
            }
        }
        for light in &mut self.lights {
            light.position *= by;
            if let LightShape::Line { end } = &mut light.shape {
                *end *= by;
            }
        }
        for sound in &mut self.sounds {
            sound.position *= by;
        }
        for space in &mut self.spaces {
            space.space = Aabb::new(space.space.min * by, space.space.max * by);
        }
        self
    }
}

fn scale_collider(collider: &mut Collider, factor: f32) {
    match collider {
        Collider::Cuboid {
            part_from_box,
            half_extents,
        } => {
            part_from_box.position *= factor;
            *half_extents *= factor;
        }
        Collider::Cylinder {
            part_from_cylinder,
            half_height,
            radius,
        } => {
            part_from_cylinder.position *= factor;
            *half_height *= factor;
            *radius *= factor;
        }
        Collider::Ball { center, radius } => {
            *center *= factor;
            *radius *= factor;
        }
        Collider::Hull { points } => points.iter_mut().for_each(|point| *point *= factor),
        Collider::ExactMesh => {}
    }
}

/// A collider after unequal stretching: a box along the axes stays one, everything else becomes a hull.
fn stretch(collider: &Collider, by: Vec3) -> Collider {
    let hull = |pose: &Pose, points: Vec<Vec3>| Collider::Hull {
        points: points
            .into_iter()
            .map(|point| pose.transform_point(point) * by)
            .collect(),
    };
    match collider {
        Collider::Cuboid {
            part_from_box,
            half_extents,
        } if part_from_box.rotation == glam::Quat::IDENTITY => Collider::Cuboid {
            part_from_box: Pose::from_position(part_from_box.position * by),
            half_extents: *half_extents * by,
        },
        Collider::Cuboid {
            part_from_box,
            half_extents,
        } => hull(
            part_from_box,
            Aabb::new(-*half_extents, *half_extents).corners().to_vec(),
        ),
        Collider::Cylinder {
            part_from_cylinder,
            half_height,
            radius,
        } => {
            let ends = [-half_height, *half_height];
            let rings = ends.into_iter().flat_map(|y| ring(y, *radius));
            hull(part_from_cylinder, rings.collect())
        }
        Collider::Ball { center, radius } => {
            let mut points = vec![Vec3::Y * *radius, Vec3::NEG_Y * *radius];
            for k in 1..=RINGS {
                let polar = std::f32::consts::PI * f32::from(k) / f32::from(RINGS + 1);
                let (s, c) = dwell_scene::math::sin_cos(polar);
                points.extend(ring(c * radius, s * radius));
            }
            hull(&Pose::from_position(*center), points)
        }
        Collider::Hull { points } => hull(&Pose::IDENTITY, points.clone()),
        Collider::ExactMesh => Collider::ExactMesh,
    }
}

fn ring(y: f32, radius: f32) -> impl Iterator<Item = Vec3> {
    (0..SIDES).map(move |k| {
        let (s, c) = dwell_scene::math::sin_cos(TAU * f32::from(k) / f32::from(SIDES));
        Vec3::new(c * radius, y, s * radius)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::finishes::Finish;
    use crate::model::PartBuilder;
    use crate::shapes::{block, cylinder};
    use crate::testing::meshes::{assert_closed, collider_bounds};

    #[test]
    fn a_stretched_cupboard_is_larger_in_each_direction_and_its_drawer_slides_further() {
        let wood = Finish::plain("oak", "wood", [150, 110, 70]);
        let model = Model::articulated("cupboard", "dresser")
            .part(
                PartBuilder::new("body")
                    .with(&wood, block([-0.5, 0.0, -0.2], [0.5, 0.8, 0.2]))
                    .with(&wood, cylinder(0.1, 0.4, 16)),
            )
            .part(PartBuilder::new("drawer").with(&wood, block([-0.4, 0.8, -0.2], [0.4, 1.0, 0.2])))
            .sliding("rail", Vec3::Z, 0.3);
        let by = Vec3::new(2.0, 0.5, 1.5);
        let large = model.clone().stretched(by);
        let (before, after) = (model.bounds(), large.bounds());
        assert!(after.size().abs_diff_eq(before.size() * by, 1e-5));
        for (part, small) in large.parts.iter().zip(&model.parts) {
            assert_closed(part.name, &part.mesh);
            let (felt, seen) = (
                collider_bounds(&part.colliders).unwrap(),
                part.mesh.bounds(),
            );
            assert!(felt.min.abs_diff_eq(seen.min, 1e-3) && felt.max.abs_diff_eq(seen.max, 1e-3));
            assert!((part.mass_kg / small.mass_kg - 1.5).abs() < 1e-5);
        }
        assert!((large.joints[0].open - 0.45).abs() < 1e-6);
        assert!(
            large.parts[0]
                .mesh
                .normals
                .iter()
                .all(|n| (n.length() - 1.0).abs() < 1e-5)
        );
    }
}
