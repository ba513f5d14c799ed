//! Laws that act on bodies between physics steps.

use crate::body::BodyHandle;
use crate::contact::{ColliderMetadata, ContactTable};
use crate::engine::RapierWorld;
use crate::model::BodyDefinition;
use dwell_scene::House;
use rapier3d::dynamics::RigidBody;
use std::fmt::Debug;

/// A law that acts on bodies between physics steps.
pub(crate) trait BodyLaw: Debug + Send + Sync {
    /// Acts on bodies for half a physics step, before and after it (Strang splitting).
    fn apply_half_step(&self, _stage: &mut LawContext<'_>, _half_dt_s: f32) {}

    /// Acts on bodies once before each physics step, with the contact loads of the last step.
    fn before_step(&self, _stage: &mut LawContext<'_>) {}
}

/// The world as laws see it between steps.
pub(crate) struct LawContext<'a> {
    pub(crate) engine: &'a mut RapierWorld,
    /// By the index of the body's plan in the model.
    pub(crate) bodies: &'a [BodyHandle],
    pub(crate) plans: &'a [BodyDefinition],
    /// Free bodies that are roots of trees and react to their joints: laws exert wrenches on them as on links, through
    /// [`LinkLaw`](crate::joints::LinkLaw).
    pub(crate) floating_roots: &'a [u32],
    /// The entry of each collider, by its user data.
    pub(crate) entries: &'a [ColliderMetadata],
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

    /// Returns a body that moves, freely or with a joint; `None` for one that is latched, frozen or has no mass.
    pub(crate) fn movable_body(&mut self, body: u32) -> Option<&RigidBody> {
        let rigid = self.engine.bodies.get(self.bodies[body as usize].handle)?;
        let moves = rigid.is_dynamic()
            || self
                .engine
                .sleeping_cache
                .contains(self.bodies[body as usize].handle);
        (moves && rigid.mass() > 0.0).then_some(rigid)
    }

    /// Returns a body that is awake and moves without joints.
    pub(crate) fn free_body_mut(&mut self, body: u32) -> Option<&mut RigidBody> {
        let handle = self.bodies[body as usize].handle;
        let on_joint = self.plans[body as usize].joint.is_some();
        let answers = self.floating_roots.contains(&body);
        if on_joint
            || answers
            || self.movable_body(body).is_none()
            || self.engine.is_sleeping(handle)
        {
            return None;
        }
        self.engine.bodies.get_mut(handle)
    }

    /// Wakes a body and restarts its time until sleep.
    pub(crate) fn wake(&mut self, body: u32) {
        let handle = self.bodies[body as usize].handle;
        self.engine.wake(handle);
    }
}
