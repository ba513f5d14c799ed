//! A robot of another size.

use dwell_scene::Pose;

use super::model::{LinkShape, Robot, RobotJointKind, ShapeGeometry};

impl Robot {
    /// The same robot with all lengths multiplied by `factor` and all masses by `mass_factor`.
    ///
    /// Positions of slides are lengths and are scaled; forces and torques of joints and motors stay.
    #[must_use]
    pub(crate) fn scaled(mut self, factor: f32, mass_factor: f32) -> Self {
        let moved = |pose: Pose| Pose::new(pose.position * factor, pose.rotation);
        for link in &mut self.links {
            if let Some(weight) = &mut link.inertial {
                let (length, mass) = (f64::from(factor), f64::from(mass_factor));
                weight.mass *= mass;
                weight.center *= length;
                weight.inertia *= mass * length * length;
            }
            for shape in link.visuals.iter_mut().chain(&mut link.collisions) {
                *shape = LinkShape {
                    link_from_shape: moved(shape.link_from_shape),
                    geometry: shape.geometry.scaled(factor),
                    ..shape.clone()
                };
            }
        }
        for joint in &mut self.joints {
            joint.parent_from_joint = moved(joint.parent_from_joint);
            joint.child_from_joint = moved(joint.child_from_joint);
            if joint.kind == RobotJointKind::Slide {
                joint.limits = joint
                    .limits
                    .map(|limits| limits.map(|limit| limit * factor));
            }
        }
        self
    }
}

impl ShapeGeometry {
    fn scaled(&self, factor: f32) -> Self {
        match self.clone() {
            Self::Cuboid { half } => Self::Cuboid {
                half: half * factor,
            },
            Self::Ball { radius } => Self::Ball {
                radius: radius * factor,
            },
            Self::Cylinder {
                half_height,
                radius,
            } => Self::Cylinder {
                half_height: half_height * factor,
                radius: radius * factor,
            },
            Self::Capsule {
                half_height,
                radius,
            } => Self::Capsule {
                half_height: half_height * factor,
                radius: radius * factor,
            },
            Self::Ellipsoid { radii } => Self::Ellipsoid {
                radii: radii * factor,
            },
            Self::Mesh { mesh, scale } => Self::Mesh {
                mesh,
                scale: scale * factor,
            },
        }
    }
}
