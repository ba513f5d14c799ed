//! Joints: doors, drawers, lids, servos and robots, in one description.

use crate::ids::{JointId, ObjectId, PartId};
use crate::space::Pose;
use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

/// The kind of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum JointKind {
    /// Turns about the joint's axis; positions in rad.
    Hinge,
    /// Slides along the joint's axis; positions in m.
    Slide,
}

/// The motor of a joint with its controller.
///
/// Position command: effort = `stiffness` * (target - position) - `damping` * velocity, and with `feed_forward` the effort
/// against gravity. Velocity command: effort = `velocity_gain` * (target - velocity), and the same. Effort command: that
/// effort. Always within `gear * max_effort`, and never driving the joint beyond `max_velocity / gear`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Servo {
    /// N·m/rad or N/m.
    pub stiffness: f32,
    /// N·m·s/rad or N·s/m.
    pub damping: f32,
    /// The motor's largest effort, N·m or N; `gear` times as much at the joint.
    pub max_effort: f32,
    /// N·m·s/rad or N·s/m; 0: it takes no velocity commands.
    pub velocity_gain: f32,
    /// The motor's highest speed, rad/s or m/s; 1 / `gear` times as much at the joint. `None`: no bound.
    pub max_velocity: Option<f32>,
    /// Turns of the motor for one of the joint; above 0.
    pub gear: f32,
    /// Makes its controller add the effort that carries the weight on the joint.
    pub feed_forward: bool,
}

impl Default for Servo {
    /// A motor with zero effort, gear 1.
    fn default() -> Self {
        Self {
            stiffness: 0.0,
            damping: 0.0,
            max_effort: 0.0,
            velocity_gain: 0.0,
            max_velocity: None,
            gear: 1.0,
            feed_forward: false,
        }
    }
}

impl Servo {
    /// Returns the largest effort at the joint, N·m or N.
    pub fn max_joint_effort(&self) -> f32 {
        self.gear * self.max_effort
    }

    /// Returns the highest speed to which it drives the joint, rad/s or m/s; infinite without a bound.
    pub fn max_joint_speed(&self) -> f32 {
        self.max_velocity
            .map_or(f32::INFINITY, |velocity| velocity / self.gear)
    }
}

/// A command to a joint's motor. A joint without a motor is moved by hand: it obeys positions only.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum JointCommand {
    /// No command: the joint swings freely.
    #[default]
    Off,
    /// Target position, rad or m.
    Position(f32),
    /// Target velocity, rad/s or m/s.
    Velocity(f32),
    /// Effort to exert, N·m or N.
    Effort(f32),
}

impl JointCommand {
    /// Returns the target of a position command.
    pub fn position(self) -> Option<f32> {
        match self {
            Self::Position(target) => Some(target),
            _ => None,
        }
    }

    /// Returns whether its number is finite.
    pub fn is_finite(self) -> bool {
        match self {
            Self::Off => true,
            Self::Position(x) | Self::Velocity(x) | Self::Effort(x) => x.is_finite(),
        }
    }
}

/// A joint coupled to another: `position = multiplier * leader's position + offset`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mimic {
    /// The joint it follows; it comes before this one in the house and follows none itself.
    pub leader: JointId,
    /// rad or m of this joint for one of the leader.
    pub multiplier: f32,
    /// rad or m.
    pub offset: f32,
}

/// A joint with one degree of freedom between two parts; physics builds constraints from it, cameras show its parts, and
/// language reads its state.
///
/// `world_from_child = world_from_parent * parent_from_joint * motion(position) * child_from_joint⁻¹`, where the motion
/// turns about or slides along `axis`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Joint {
    /// The name, unique in its object.
    pub name: String,
    /// The object it belongs to.
    pub object: ObjectId,
    /// The parent part; `None`: the house itself (then `parent_from_joint` is `world_from_joint`).
    pub parent: Option<PartId>,
    /// The child part, which moves.
    pub child: PartId,
    /// Hinge or slide.
    pub kind: JointKind,
    /// The axis in joint space, unit length.
    pub axis: Vec3,
    /// The joint's frame on the parent.
    pub parent_from_joint: Pose,
    /// The joint's frame on the child.
    pub child_from_joint: Pose,
    /// Lowest and highest position, rad or m; `None`: it turns or slides without end.
    pub limits: Option<[f32; 2]>,
    /// The position at which it counts as closed, inside the limits.
    pub closed: f32,
    /// The position at which it counts as fully open, inside the limits; equal to `closed` for a joint that neither opens
    /// nor closes, such as that of an arm.
    pub open: f32,
    /// The position at the start, inside the limits.
    pub initial: f32,
    /// Coulomb friction, N·m or N.
    pub friction: f32,
    /// Viscous damping, N·m·s/rad or N·s/m.
    pub damping: f32,
    /// Inertia of the joint itself, such as a rotor's times the square of its gear ratio, kg·m² or kg. It holds for the
    /// servo's gear here; another gear set at run time changes it by the square.
    #[serde(default)]
    pub armature: f32,
    /// The motor, if it has one.
    pub servo: Option<Servo>,
    /// The coupling of a mimic joint.
    #[serde(default)]
    pub mimic: Option<Mimic>,
    /// True for its object's switch, such as the lever of a tap: opening it switches the object on, closing it off.
    #[serde(default)]
    #[serde(rename = "switches")]
    pub toggles_switch: bool,
}

impl Joint {
    /// Returns the displacement of the joint at `position` (rad or m).
    pub fn motion(&self, position: f32) -> Pose {
        motion_along(self.kind, self.axis, position)
    }

    /// Returns the child's pose with the parent at `world_from_parent` and the joint at `position`.
    pub fn world_from_child(&self, world_from_parent: &Pose, position: f32) -> Pose {
        *world_from_parent
            * self.parent_from_joint
            * self.motion(position)
            * self.child_from_joint.inverse()
    }

    /// A joint between the house and `child` at the part's origin: without limits, friction, motor, and nothing to open.
    pub fn new(name: &str, object: ObjectId, child: PartId, kind: JointKind, axis: Vec3) -> Self {
        Self {
            name: name.to_owned(),
            object,
            parent: None,
            child,
            kind,
            axis,
            parent_from_joint: Pose::IDENTITY,
            child_from_joint: Pose::IDENTITY,
            limits: None,
            closed: 0.0,
            open: 0.0,
            initial: 0.0,
            friction: 0.0,
            damping: 0.0,
            armature: 0.0,
            servo: None,
            mimic: None,
            toggles_switch: false,
        }
    }

    /// `position` within the limits.
    pub fn clamp(&self, position: f32) -> f32 {
        self.limits
            .map_or(position, |[low, high]| position.clamp(low, high))
    }

    /// Returns whether it opens and closes by hand: a door, a drawer, a lid.
    pub fn is_openable(&self) -> bool {
        self.open != self.closed && self.servo.is_none() && self.mimic.is_none()
    }

    /// Returns how far it is open: 0 closed, 1 fully open, clamped.
    pub fn openness(&self, position: f32) -> f32 {
        let range = self.open - self.closed;
        if range == 0.0 {
            0.0
        } else {
            ((position - self.closed) / range).clamp(0.0, 1.0)
        }
    }

    /// The position at which it is open to `fraction` (0 to 1, clamped).
    pub fn position_at(&self, fraction: f32) -> f32 {
        self.closed + (self.open - self.closed) * fraction.clamp(0.0, 1.0)
    }
}

/// The displacement of a joint with the unit axis `axis` at `position` (rad or m).
pub(crate) fn motion_along(kind: JointKind, axis: Vec3, position: f32) -> Pose {
    match kind {
        JointKind::Hinge => {
            let (s, c) = crate::math::sin_cos(position * 0.5);
            let v = axis * s;
            Pose::new(Vec3::ZERO, Quat::from_xyzw(v.x, v.y, v.z, c))
        }
        JointKind::Slide => Pose::from_position(axis * position),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::FRAC_PI_2;

    #[test]
    fn a_door_swings_about_its_hinge_line() {
        let door = Joint {
            parent_from_joint: Pose::from_position(Vec3::new(1.0, 0.0, 5.0)),
            child_from_joint: Pose::from_position(Vec3::new(-0.4, 0.0, 0.0)),
            limits: Some([0.0, FRAC_PI_2]),
            open: FRAC_PI_2,
            ..Joint::new("hinge", ObjectId(0), PartId(0), JointKind::Hinge, Vec3::Y)
        };
        let closed = door.world_from_child(&Pose::IDENTITY, 0.0);
        assert!((closed.position - Vec3::new(1.4, 0.0, 5.0)).length() < 1e-6);
        let open = door.world_from_child(&Pose::IDENTITY, FRAC_PI_2);
        assert!((open.position - Vec3::new(1.0, 0.0, 4.6)).length() < 1e-6);
        assert!((door.openness(door.position_at(0.3)) - 0.3).abs() < 1e-6);
    }
}
