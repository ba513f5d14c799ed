//! The rigid bodies of a world with their colliders and contact values.

mod assembly;
mod clearance;
mod sleeping;

pub(crate) use assembly::{
    AssembledWorld, BodyMasses, assemble, density, invalidate_contacts, set_contact_properties,
    update_collider_properties,
};
pub(crate) use clearance::{HolderCollision, SupportSurfaceFilter};

use crate::body::{self, BodyHandle, BodyStatus};
use crate::config::ResolvedConfig;
use crate::contact::{ColliderMetadata, CollisionExclusions, ContactHooks, ContactTable, rolling};
use crate::engine::RapierWorld;
use crate::laws::{BodyLaw, LawContext, LawSet};
use crate::model::PhysicsModel;
use dwell_scene::ObjectId;
use rapier3d::dynamics::RigidBodyHandle;
use std::sync::Arc;

/// The rigid bodies of a world.
#[derive(Clone)]
pub(crate) struct Dynamics {
    pub(crate) model: Arc<PhysicsModel>,
    pub(crate) settings: ResolvedConfig,
    pub(crate) engine: RapierWorld,
    /// The entry of each collider, by its user data.
    pub(crate) entries: Vec<ColliderMetadata>,
    pub(crate) table: ContactTable,
    /// Shape (body,).
    pub(crate) bodies: Vec<BodyHandle>,
    /// The current status of each body. Shape (body,).
    pub(crate) statuses: Vec<BodyStatus>,
    pub(crate) masses: BodyMasses,
    pub(crate) collision_exclusions: CollisionExclusions,
    pub(crate) laws: Box<LawSet>,
    /// Physics steps since the world was made.
    pub(crate) tick: u64,
}

impl Dynamics {
    /// Returns the index of the body with a rapier handle.
    pub(crate) fn body_of(&self, handle: RigidBodyHandle) -> Option<usize> {
        // They were inserted in order.
        let key = |body: &BodyHandle| body.handle.into_raw_parts();
        let place = self
            .bodies
            .binary_search_by_key(&handle.into_raw_parts(), key);
        place.ok()
    }

    /// Brings positions, contacts and queries up to date after a change from outside.
    pub(crate) fn flush(&mut self) {
        self.update_rolling_contacts();
        let hooks = ContactHooks {
            entries: &self.entries,
            properties: self.laws.contact_properties(&self.model.house, &self.table),
            excluded: &self.collision_exclusions,
            friction_storage: self.engine.friction_storage(),
            dt_s: 0.0,
        };
        self.engine.flush(&hooks);
    }

    /// Makes rapier ask the hook about the contacts of rolling cylinders. Returns whether some began or ceased to roll.
    pub(crate) fn update_rolling_contacts(&mut self) -> bool {
        let model = self.model.clone();
        let properties = self.laws.contact_properties(&model.house, &self.table);
        let mut changed = false;
        for roller in &model.rolling_cylinders {
            let handle = self.bodies[roller.body()].handle;
            let body = self.engine.bodies.get(handle);
            let (own, rolls) = (
                body.and_then(|body| roller.collider(body)),
                body.is_some_and(|body| roller.is_rolling(body)),
            );
            let entries = &self.entries;
            let asked = |index: usize| {
                entries
                    .get(index)
                    .is_some_and(|entry| properties.self_contact_and_hook(entry).1)
            };
            changed |= rolling::set_rolling_hook(&mut self.engine, rolls, own, asked);
        }
        changed
    }

    /// Applies laws to bodies before a physics step. `floating_roots`: free bodies that are roots of trees and react to their joints.
    pub(crate) fn apply_laws_before(&mut self, floating_roots: &[u32]) {
        let half = 0.5 * self.settings.dt_s;
        self.apply_laws(floating_roots, |law, stage| {
            law.apply_half_step(stage, half);
            law.before_step(stage);
        });
    }

    /// Applies laws to bodies after a physics step.
    pub(crate) fn apply_laws_after(&mut self, floating_roots: &[u32]) {
        let half = 0.5 * self.settings.dt_s;
        self.apply_laws(floating_roots, |law, stage| {
            law.apply_half_step(stage, half);
        });
    }

    fn apply_laws(
        &mut self,
        floating_roots: &[u32],
        mut each: impl FnMut(&dyn BodyLaw, &mut LawContext<'_>),
    ) {
        let mut stage = LawContext {
            engine: &mut self.engine,
            bodies: &self.bodies,
            plans: &self.model.bodies,
            floating_roots,
            entries: &self.entries,
            house: &self.model.house,
            table: &self.table,
            dt_s: self.settings.dt_s,
            tick: self.tick,
        };
        for law in &self.laws.bodies {
            each(&**law, &mut stage);
        }
    }

    /// Counts a completed physics step.
    pub(crate) fn count_step(&mut self) {
        self.tick += 1;
        self.engine.release_pair_memory(self.tick);
    }

    /// Returns the name of an object for people.
    pub(crate) fn name_of(&self, object: ObjectId) -> String {
        body::name_of(&self.model.house, object)
    }

    /// The bodies of an object.
    pub(crate) fn bodies_of(&self, object: ObjectId) -> Vec<usize> {
        let bodies = self.model.bodies.iter().enumerate();
        bodies
            .filter(|(_, plan)| plan.object == object)
            .map(|(index, _)| index)
            .collect()
    }

    /// Returns the kinetic energy of all moving bodies, J: of their centres of mass and of their rotation.
    pub(crate) fn kinetic_energy_j(&self) -> f64 {
        self.bodies
            .iter()
            .zip(&self.statuses)
            .filter(|(_, hold)| **hold == BodyStatus::Free)
            .filter_map(|(body, _)| self.engine.bodies.get(body.handle))
            .map(|rigid| f64::from(rigid.kinetic_energy()))
            .sum()
    }

    /// Returns the speed of the fastest point of any body, m/s.
    pub(crate) fn max_speed_m_s(&self) -> f32 {
        self.bodies
            .iter()
            .zip(&self.statuses)
            .filter(|(_, hold)| **hold == BodyStatus::Free)
            .filter_map(|(body, _)| self.engine.bodies.get(body.handle))
            .map(|rigid| {
                let reach = rigid.mass_properties().max_extent();
                rigid.linvel().length() + rigid.angvel().length() * reach
            })
            .fold(0.0, f32::max)
    }
}

impl ResolvedConfig {
    /// Returns the force from which rapier reports a contact, N.
    pub(crate) fn event_force_n(&self) -> f32 {
        // An impact may be spread over a few steps.
        0.25 * self.config.event_min_impulse_n_s / self.dt_s
    }
}
