//! What a law can do to a world.

use crate::bases::WheelMotion;
use crate::body::BodyHandle;
use crate::contact::{ColliderEntry, ContactEntity, ContactTable};
use crate::engine::RapierWorld;
use crate::inertia::BodyInertia;
use crate::joints::JointActuation;
use crate::laws::target::ContactScope;
use crate::laws::{ExternalWrench, LinkStep};
use crate::model::BodyPlan;
use dwell_scene::{AgentId, House, JointCommand, JointId};
use glam::{Quat, Vec3};
use rapier3d::dynamics::RigidBody;
use std::fmt::Debug;

/// A law at work in a world. Every method has a default that does nothing; a law writes those it needs.
pub(crate) trait LawHooks: Debug + Send + Sync {
    /// Acts on bodies for half a physics step, before and after it (Strang's splitting).
    fn apply_half_step(&mut self, _stage: &mut LawContext<'_>, _half_dt_s: f32) {}

    /// Acts on bodies once before each physics step, with what the contacts of the last step carried.
    fn before_step(&mut self, _stage: &mut LawContext<'_>) {}

    /// Returns whether it pushes at bodies of trees of joints: [`LawHooks::push`].
    fn pushes(&self) -> bool {
        false
    }

    /// Returns how it pushes at a body that a joint moves, or that joints hang on and that is free. It is asked several times in a step, until the tree's course and what
    /// pushes at it fit.
    fn push(&self, _link: &LinkStep) -> ExternalWrench {
        ExternalWrench::default()
    }

    /// The contacts whose values it changes in [`LawHooks::shape_contact`]; `None`: none.
    fn scope(&self) -> Option<&ContactScope> {
        None
    }

    /// Changes the values of one contact plane (one manifold) within the scope, before it is solved. rapier has one
    /// friction, one restitution and one surface velocity for all points of a plane, and no stiffness of its own.
    fn shape_contact(&self, _touch: &LawContact<'_>, _values: &mut ContactValues) {}

    /// Changes mass, centre of mass or inertia of a body, once when laws or masses change.
    fn modify_mass_properties(&self, _body: u32, _inertia: &mut BodyInertia) {}

    /// Returns how all contacts of the world give; `None`: as the engine has it.
    fn compliance(&self) -> Option<ContactCompliance> {
        None
    }

    /// Returns whether it changes what motors do in each physics step: [`LawHooks::drive`] or [`LawHooks::modify_motor`].
    fn drives(&self) -> bool {
        false
    }

    /// Changes the command that a joint's motor follows in one physics step. It is asked for every motor in every step.
    fn drive(&mut self, _motor: &MotorStep, _command: &mut JointCommand) {}

    /// Changes what a joint's motor gives for its command in one physics step.
    fn modify_motor(&self, _joint: JointId, _pull: &mut JointActuation) {}

    /// Returns whether it remembers where joints have been: [`LawHooks::follow`].
    fn follows(&self) -> bool {
        false
    }

    /// A joint stands at `position` (rad or m) at the beginning of a physics step.
    fn follow(&mut self, _joint: JointId, _position: f32) {}

    /// A joint was put at `position` (rad or m) from outside, which is no motion.
    fn placed(&mut self, _joint: JointId, _position: f32) {}

    /// Returns whether it changes how joints resist: [`LawHooks::resist`].
    fn resists(&self) -> bool {
        false
    }

    /// Changes how a joint resists in one physics step. It is asked several times in a step, until what the joint resists
    /// with and what loads it fit.
    fn resist(&self, _joint: JointId, _load: &JointLoad, _resistance: &mut JointResistance) {}

    /// Changes how the two wheels of an agent's differential drive roll in one physics step.
    fn roll(&self, _agent: AgentId, _rolling: &mut WheelMotion) {}

    /// Returns what the gyro of an agent's base reads when it turns with `rate_rad_s`.
    fn gyro(&self, _agent: AgentId, rate_rad_s: f32) -> f32 {
        rate_rad_s
    }

    /// Returns what it remembers, for snapshots.
    fn memory(&self) -> Vec<f32> {
        Vec::new()
    }

    /// Takes back what [`LawHooks::memory`] gave.
    fn restore_memory(&mut self, _memory: &[f32]) {}

    /// A copy.
    fn clone_box(&self) -> Box<dyn LawHooks>;
}

/// A joint with a motor before a physics step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MotorStep {
    pub(crate) joint: JointId,
    /// rad or m.
    pub(crate) position: f32,
    /// rad/s or m/s.
    pub(crate) velocity: f32,
    /// Length of the step, s.
    pub(crate) dt_s: f32,
}

impl MotorStep {
    /// The number of a command of this kind that asks for what is there already.
    pub(crate) fn rest(&self, command: JointCommand) -> f32 {
        match command {
            JointCommand::Position(_) => self.position,
            JointCommand::Velocity(_) => self.velocity,
            JointCommand::Effort(_) | JointCommand::Off => 0.0,
        }
    }
}

/// What loads a joint in a physics step; efforts are positive along the joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointLoad {
    /// At the beginning of the step, rad or m.
    pub(crate) position: f32,
    /// At the middle of the step, rad/s or m/s.
    pub(crate) velocity: f32,
    /// What the motor or the hand gives, N·m or N.
    pub(crate) motor_effort: f32,
    /// What acts along the joint besides its motor and what it resists with: weight, air, contacts and stops, and what the
    /// motion of the other joints and of the root asks of it; N·m or N.
    pub(crate) external_effort: f32,
    /// Whether something drives it.
    pub(crate) is_driven: bool,
}

/// How a joint resists in one physics step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct JointResistance {
    /// The largest effort with which it holds or brakes whatever the speed, N·m or N.
    pub(crate) friction: f32,
    /// N·m·s/rad or N·s/m.
    pub(crate) damping: f32,
    /// Inertia of the joint's own, kg·m² or kg.
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

/// The world as a law sees it between steps.
pub(crate) struct LawContext<'a> {
    pub(crate) engine: &'a mut RapierWorld,
    /// By the number of the body's plan in the model.
    pub(crate) bodies: &'a [BodyHandle],
    pub(crate) plans: &'a [BodyPlan],
    /// Bodies that joints hang on and that answer to what these do: laws push at them as at links, through [`LawHooks::push`].
    pub(crate) floating_roots: &'a [u32],
    /// What each collider stands for, by its user data.
    pub(crate) entries: &'a [ColliderEntry],
    pub(crate) house: &'a House,
    pub(crate) table: &'a ContactTable,
    /// Length of a physics step, s.
    pub(crate) dt_s: f32,
    /// Physics steps since the world was made.
    pub(crate) tick: u64,
}

impl LawContext<'_> {
    /// Time since the world was made, s.
    pub(crate) fn time_s(&self) -> f64 {
        self.tick as f64 * f64::from(self.dt_s)
    }

    /// A body that moves, freely or with a joint; `None` for one that is shut, frozen or has no mass.
    pub(crate) fn movable(&mut self, body: u32) -> Option<&RigidBody> {
        let rigid = self.engine.bodies.get(self.bodies[body as usize].handle)?;
        let moves = rigid.is_dynamic()
            || self
                .engine
                .sleeping_cache
                .has(self.bodies[body as usize].handle);
        (moves && rigid.mass() > 0.0).then_some(rigid)
    }

    /// A body that is awake and that moves without joints.
    pub(crate) fn free(&mut self, body: u32) -> Option<&mut RigidBody> {
        let handle = self.bodies[body as usize].handle;
        let on_joint = self.plans[body as usize].joint.is_some();
        let answers = self.floating_roots.contains(&body);
        if on_joint || answers || self.movable(body).is_none() || self.engine.sleeps(handle) {
            return None;
        }
        self.engine.bodies.get_mut(handle)
    }

    /// Wakes a body and keeps it awake for as long as one that was just woken.
    pub(crate) fn wake(&mut self, body: u32) {
        let handle = self.bodies[body as usize].handle;
        self.engine.wake(handle);
    }
}

/// One of the two things that touch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactSide<'a> {
    pub(crate) toucher: Option<ContactEntity>,
    /// What it is made of there, as the materials library names it.
    pub(crate) substance: &'a str,
    /// How its own frame is turned in the world; the identity for structure and fixed things.
    pub(crate) rotation: Quat,
}

/// Two surfaces that touch or are about to, at the beginning of a physics step. The surface is what the law's target names
/// first; without a name, structure comes before things and things stand in order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LawContact<'a> {
    pub(crate) surface: ContactSide<'a>,
    /// What slides or rolls over the surface, or hits it.
    pub(crate) other: ContactSide<'a>,
    /// From the surface to the other, unit length.
    pub(crate) normal: Vec3,
    /// The velocity of the other against the surface at the middle of the plane's points, m/s.
    pub(crate) relative_velocity: Vec3,
    /// The friction impulse on the other in the last substep, N·s.
    pub(crate) friction_impulse_n_s: Vec3,
}

impl LawContact<'_> {
    /// Returns how fast the two approach, m/s; negative when they part.
    pub(crate) fn approach_speed_m_s(&self) -> f32 {
        -self.relative_velocity.dot(self.normal)
    }

    /// Returns how the other slides over the surface, m/s.
    pub(crate) fn slip(&self) -> Vec3 {
        self.relative_velocity + self.normal * self.approach_speed_m_s()
    }

    /// The same seen from the other side.
    pub(crate) fn turned(self) -> Self {
        Self {
            surface: self.other,
            other: self.surface,
            normal: -self.normal,
            relative_velocity: -self.relative_velocity,
            friction_impulse_n_s: -self.friction_impulse_n_s,
        }
    }
}

/// The values of one contact plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ContactValues {
    pub(crate) friction: f32,
    pub(crate) restitution: f32,
    /// The slip towards which friction drives, m/s: as of a conveyor belt. 0 where no law says otherwise.
    pub(crate) surface_velocity: Vec3,
}

/// Contacts as springs with dampers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ContactCompliance {
    pub(crate) natural_frequency_hz: f32,
    pub(crate) damping_ratio: f32,
}
