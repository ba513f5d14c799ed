//! Laws of joint resistance.

use super::StatefulLaw;
use dwell_scene::JointId;
use std::fmt::Debug;

/// A law that changes the resistance of joints.
pub(crate) trait ResistanceLaw: StatefulLaw + Debug + Send + Sync {
    /// Notes a joint's position (rad or m) at the beginning of a physics step.
    fn update_position(&mut self, _joint: JointId, _position: f32) {}

    /// Changes the resistance of a joint in one physics step. It is called several times in a step, until resistance and
    /// load agree.
    fn modify_resistance(&self, joint: JointId, load: &JointLoad, resistance: &mut JointResistance);

    /// Returns a copy.
    fn clone_box(&self) -> Box<dyn ResistanceLaw>;
}

impl Clone for Box<dyn ResistanceLaw> {
    fn clone(&self) -> Self {
        self.clone_box()
    }
}

/// The loads on a joint in a physics step; efforts are positive along the joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointLoad {
    /// At the beginning of the step, rad or m.
    pub(crate) position: f32,
    /// At the middle of the step, rad/s or m/s.
    pub(crate) velocity: f32,
    /// Effort of the motor or the hand, N·m or N.
    pub(crate) motor_effort: f32,
    /// Effort along the joint besides its motor and its resistance: weight, air, contacts and stops, and the inertial
    /// forces of the other joints and of the root; N·m or N.
    pub(crate) external_effort: f32,
    /// Set if a motor or a hand drives it.
    pub(crate) is_driven: bool,
}

/// The resistance of a joint in one physics step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct JointResistance {
    /// Largest effort of friction, whatever the speed, N·m or N.
    pub(crate) friction: f32,
    /// N·m·s/rad or N·s/m.
    pub(crate) damping: f32,
    /// Inertia of the joint itself, kg·m² or kg.
    pub(crate) armature: f32,
    /// A spring that slips.
    pub(crate) elastic: Option<SlipSpring>,
}

/// A spring at a joint that slips beyond its largest effort.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SlipSpring {
    /// At the beginning of the step, N·m or N.
    pub(crate) effort: f32,
    /// N·m/rad or N/m.
    pub(crate) stiffness: f32,
    /// N·m or N.
    pub(crate) max_effort: f32,
}
