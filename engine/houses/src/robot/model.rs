//! A robot as its file has it, without regard to the format.

use std::sync::Arc;

use dwell_scene::{Mesh, Pose, Servo, Texture};
use glam::{DMat3, DVec3, Vec3};

/// A robot: links and the joints between them, checked to be a tree. Made by [`open_robot`](crate::open_robot).
#[derive(Clone, Debug)]
pub struct Robot {
    /// Its name in the file.
    pub(crate) name: String,
    /// The file.
    pub(crate) source: String,
    /// `"urdf"` or `"mjcf"`.
    pub(crate) format: &'static str,
    /// The root first, each after its parent.
    pub(crate) links: Vec<RobotLink>,
    /// One for each link but the root, in their order.
    pub(crate) joints: Vec<RobotJoint>,
    /// True if the file fixes the base.
    pub(crate) fixed_base: bool,
}

/// A rigid piece.
#[derive(Clone, Debug)]
pub(crate) struct RobotLink {
    pub(crate) name: String,
    pub(crate) inertial: Option<LinkInertia>,
    pub(crate) visuals: Vec<LinkShape>,
    pub(crate) collisions: Vec<LinkShape>,
}

/// Mass and its distribution.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkInertia {
    /// kg.
    pub(crate) mass: f64,
    /// Centre of mass in the link's frame, m.
    pub(crate) center: DVec3,
    /// Inertia about the centre, along the link's axes, kg·m².
    pub(crate) inertia: DMat3,
}

/// A shape on a link.
#[derive(Clone, Debug)]
pub(crate) struct LinkShape {
    pub(crate) link_from_shape: Pose,
    pub(crate) geometry: ShapeGeometry,
    /// sRGB and opacity.
    pub(crate) rgba: Option<[f32; 4]>,
    /// The name of its material in the file.
    pub(crate) material: String,
    /// The image of its material, for meshes with texture coordinates.
    pub(crate) image: Option<Arc<Texture>>,
}

/// The geometry of a shape; cylinders and capsules stand along their Z.
#[derive(Clone, Debug)]
pub(crate) enum ShapeGeometry {
    Cuboid { half: Vec3 },
    Ball { radius: f32 },
    Cylinder { half_height: f32, radius: f32 },
    Capsule { half_height: f32, radius: f32 },
    Ellipsoid { radii: Vec3 },
    Mesh { mesh: Arc<Mesh>, scale: Vec3 },
}

/// The kind of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RobotJointKind {
    Fixed,
    Hinge,
    Slide,
}

/// A joint between two links.
#[derive(Clone, Debug)]
pub(crate) struct RobotJoint {
    pub(crate) name: String,
    /// Positions in the robot's links.
    pub(crate) parent: usize,
    pub(crate) child: usize,
    pub(crate) kind: RobotJointKind,
    pub(crate) parent_from_joint: Pose,
    pub(crate) child_from_joint: Pose,
    pub(crate) axis: Vec3,
    pub(crate) limits: Option<[f32; 2]>,
    /// The position at the start, brought into the limits, rad or m.
    pub(crate) initial: f32,
    pub(crate) friction: f32,
    pub(crate) damping: f32,
    pub(crate) armature: f32,
    pub(crate) servo: Option<Servo>,
    /// The name of the joint it follows, multiplier, offset.
    pub(crate) mimic: Option<(String, f32, f32)>,
}

impl Robot {
    /// Its name in the file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The names of its links, the root first.
    pub fn link_names(&self) -> impl Iterator<Item = &str> {
        self.links.iter().map(|link| link.name.as_str())
    }

    /// Returns whether no joint of it has a motor.
    pub(crate) fn is_passive(&self) -> bool {
        self.joints.iter().all(|joint| joint.servo.is_none())
    }

    /// The names of the joints that move, in the order in which they get into a house.
    pub fn movable_joint_names(&self) -> impl Iterator<Item = &str> {
        let moving = self
            .joints
            .iter()
            .filter(|joint| joint.kind != RobotJointKind::Fixed);
        moving.map(|joint| joint.name.as_str())
    }

    /// Returns whether its file fixes the base: in MJCF a root without a free joint; URDF does not say, so `true`.
    pub fn has_fixed_base(&self) -> bool {
        self.fixed_base
    }
}
