//! A shape and the pieces that stand for it in collisions.

use dwell_scene::{Collider, Mesh, Pose};
use glam::{Quat, Vec3};

/// A closed mesh with its convex collision pieces.
#[derive(Clone, Debug, Default)]
pub struct SolidMesh {
    /// The surface, faces outwards, one material slot.
    pub mesh: Mesh,
    /// The convex pieces.
    pub colliders: Vec<Collider>,
}

impl SolidMesh {
    /// A mesh and its pieces.
    pub fn new(mesh: Mesh, colliders: Vec<Collider>) -> Self {
        Self { mesh, colliders }
    }

    /// The same shape moved.
    #[must_use]
    pub fn translated(self, x: f32, y: f32, z: f32) -> Self {
        self.transformed(&Pose::from_position(Vec3::new(x, y, z)))
    }

    /// The same shape turned about the X axis, rad.
    #[must_use]
    pub fn rotated_x(self, angle_rad: f32) -> Self {
        self.transformed(&Pose::new(Vec3::ZERO, axis_rotation(Vec3::X, angle_rad)))
    }

    /// The same shape turned about the Y axis, rad.
    #[must_use]
    pub fn rotated_y(self, angle_rad: f32) -> Self {
        self.transformed(&Pose::new(Vec3::ZERO, axis_rotation(Vec3::Y, angle_rad)))
    }

    /// The same shape turned about the Z axis, rad.
    #[must_use]
    pub fn rotated_z(self, angle_rad: f32) -> Self {
        self.transformed(&Pose::new(Vec3::ZERO, axis_rotation(Vec3::Z, angle_rad)))
    }

    /// The same shape in the space that `pose` leads to.
    #[must_use]
    pub fn transformed(mut self, pose: &Pose) -> Self {
        for position in &mut self.mesh.positions {
            *position = pose.transform_point(*position);
        }
        for normal in &mut self.mesh.normals {
            *normal = pose.transform_vector(*normal);
        }
        for collider in &mut self.colliders {
            transform_collider(collider, pose);
        }
        self
    }

    /// The same shape, which nothing touches.
    #[must_use]
    pub fn visual_only(mut self) -> Self {
        self.colliders.clear();
        self
    }

    /// The same shape, which nobody sees: it stands for many thin things in collisions.
    #[must_use]
    pub fn collision_only(mut self) -> Self {
        self.mesh = Mesh::default();
        self
    }

    /// Both shapes.
    #[must_use]
    pub fn merged(mut self, other: Self) -> Self {
        if self.mesh.positions.is_empty() {
            return other;
        }
        self.mesh.append(&other.mesh, 0);
        self.colliders.extend(other.colliders);
        self
    }

    /// Volume of the collision pieces, m³; a hull counts as its share of the mesh.
    pub fn collider_volume_m3(&self) -> f32 {
        let known: Option<f32> = self.colliders.iter().map(Collider::volume_m3).sum();
        if self.colliders.is_empty() {
            0.0
        } else {
            known.unwrap_or_else(|| self.mesh.enclosed_volume_m3() as f32)
        }
    }
}

/// The rotation by `angle_rad` about a unit `axis`, with the same bits on every machine.
pub fn axis_rotation(axis: Vec3, angle_rad: f32) -> Quat {
    let (sin, cos) = dwell_scene::math::sin_cos(angle_rad * 0.5);
    Quat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos)
}

fn transform_collider(collider: &mut Collider, pose: &Pose) {
    match collider {
        Collider::Cuboid {
            part_from_box: p, ..
        }
        | Collider::Cylinder {
            part_from_cylinder: p,
            ..
        } => {
            *p = *pose * *p;
        }
        Collider::Ball { center, .. } => *center = pose.transform_point(*center),
        Collider::Hull { points } => {
            for point in points {
                *point = pose.transform_point(*point);
            }
        }
        Collider::ExactMesh => {}
    }
}
