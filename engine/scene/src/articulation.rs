//! Joints: doors, drawers, lids, servos and robots, in one description.

use crate::ids::{ObjectId, PartId};
use crate::space::Pose;
use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum JointKind {
    /// Turns about the joint's axis; positions in rad.
    Hinge,
    /// Slides along the joint's axis; positions in m.
    Slide,
}

/// A position servo: effort = `stiffness` * (target - position) - `damping` * velocity, limited to `max_effort`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Servo {
    /// N·m/rad or N/m.
    pub stiffness: f32,
    /// N·m·s/rad or N·s/m.
    pub damping: f32,
    /// N·m or N.
    pub max_effort: f32,
}

/// A joint with one degree of freedom between two parts, from which physics builds constraints, eyes see parts and words
/// know states.
///
/// `world_from_child = world_from_parent * parent_from_joint * motion(position) * child_from_joint⁻¹`, where the motion
/// turns about or slides along `axis`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Articulation {
    /// The name, unique in its object.
    pub name: String,
    /// The object it belongs to.
    pub object: ObjectId,
    /// The part it hangs on; `None`: the house itself (then `parent_from_joint` is `world_from_joint`).
    pub parent: Option<PartId>,
    /// The part that moves.
    pub child: PartId,
    /// Turning or sliding.
    pub kind: JointKind,
    /// The axis in joint space, unit length.
    pub axis: Vec3,
    /// The joint's frame on the parent.
    pub parent_from_joint: Pose,
    /// The joint's frame on the child.
    pub child_from_joint: Pose,
    /// Lowest and highest position, rad or m.
    pub limits: [f32; 2],
    /// The position at which it counts as closed, inside the limits.
    pub closed: f32,
    /// The position at which it counts as fully open, inside the limits.
    pub open: f32,
    /// The position at the start, inside the limits.
    pub initial: f32,
    /// Coulomb friction, N·m or N.
    pub friction: f32,
    /// Viscous damping, N·m·s/rad or N·s/m.
    pub damping: f32,
    /// The motor, if it has one.
    pub servo: Option<Servo>,
}

impl Articulation {
    /// The movement of the joint at `position` (rad or m).
    pub fn motion(&self, position: f32) -> Pose {
        match self.kind {
            JointKind::Hinge => {
                let (s, c) = crate::math::sin_cos(position * 0.5);
                let v = self.axis * s;
                Pose::new(Vec3::ZERO, Quat::from_xyzw(v.x, v.y, v.z, c))
            }
            JointKind::Slide => Pose::from_position(self.axis * position),
        }
    }

    /// Where the child stands when the parent stands at `world_from_parent` and the joint at `position`.
    pub fn world_from_child(&self, world_from_parent: &Pose, position: f32) -> Pose {
        *world_from_parent
            * self.parent_from_joint
            * self.motion(position)
            * self.child_from_joint.inverse()
    }

    /// How far it is open: 0 closed, 1 fully open, clamped.
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::FRAC_PI_2;

    #[test]
    fn a_door_swings_about_its_hinge_line() {
        let door = Articulation {
            name: "hinge".into(),
            object: ObjectId(0),
            parent: None,
            child: PartId(0),
            kind: JointKind::Hinge,
            axis: Vec3::Y,
            parent_from_joint: Pose::from_position(Vec3::new(1.0, 0.0, 5.0)),
            child_from_joint: Pose::from_position(Vec3::new(-0.4, 0.0, 0.0)),
            limits: [0.0, FRAC_PI_2],
            closed: 0.0,
            open: FRAC_PI_2,
            initial: 0.0,
            friction: 0.0,
            damping: 0.0,
            servo: None,
        };
        let closed = door.world_from_child(&Pose::IDENTITY, 0.0);
        assert!((closed.position - Vec3::new(1.4, 0.0, 5.0)).length() < 1e-6);
        let open = door.world_from_child(&Pose::IDENTITY, FRAC_PI_2);
        assert!((open.position - Vec3::new(1.0, 0.0, 4.6)).length() < 1e-6);
        assert!((door.openness(door.position_at(0.3)) - 0.3).abs() < 1e-6);
    }
}
