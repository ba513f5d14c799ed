//! Parameters that change while a world runs.

use crate::body;
use crate::contact::{ContactTable, Surface};
use crate::error::PhysicsError;
use crate::joints;
use crate::laws;
use crate::world::PhysicsWorld;
use dwell_scene::State;
use glam::Vec3;

impl PhysicsWorld {
    /// Takes over the state's overrides and laws: masses, friction and restitution of pairs and materials, gravity,
    /// joints' friction and damping. Everything that sleeps is woken if something changed.
    ///
    /// # Errors
    /// [`PhysicsError::Scene`] or [`PhysicsError::LawTarget`] for a law that cannot be installed; nothing has changed
    /// then.
    pub fn apply_parameters(&mut self, state: &State) -> Result<(), PhysicsError> {
        self.check_state(state)?;
        let laws = laws::install(&self.model, state, &self.laws)?;
        let model = self.model.clone();
        let table = ContactTable::new(&model.house, state);
        let factors = body::mass_factors(&model, state);
        let gravity = Vec3::new(0.0, -state.gravity_m_s2(), 0.0);
        let mut changed = gravity != self.engine.gravity
            || factors != self.mass_factors
            || table.differs(&self.table);
        let mut index = 0;
        let statics = model.statics.iter().map(|piece| (piece, None));
        let moving = model
            .bodies
            .iter()
            .enumerate()
            .flat_map(|(body, plan)| plan.pieces.iter().map(move |piece| (piece, Some(body))));
        // Entries stand in the order of insertion: statics, the last floor, bodies, agents.
        for (piece, body) in statics.chain(moving) {
            if body.is_some() && index == model.statics.len() {
                index += 1;
            }
            let surface = table.surface(&piece.cover);
            let density = body.map(|body| piece.density_kg_m3 * factors[body]);
            changed |= self.redress(index, surface, &table, density);
            index += 1;
        }
        for agent in 0..self.agents.len() {
            let entry = self.agents[agent].entry as usize;
            changed |= self.redress(entry, table.human(), &table, None);
        }
        for joint in &mut self.joints {
            let articulation = &model.house.joints[joint.id];
            changed |= joints::set_resistance(joint, articulation, state);
        }
        changed |= laws.len() != self.laws.len()
            || laws
                .iter()
                .zip(&self.laws)
                .any(|(new, old)| new.spec != old.spec);
        self.engine.gravity = gravity;
        self.table = table;
        self.mass_factors = factors;
        self.applied.clone_from(&state.overrides);
        self.laws = laws;
        if changed {
            self.flush();
            for body in &self.bodies {
                self.engine
                    .islands
                    .wake_up(&mut self.engine.bodies, body.handle, true);
            }
        }
        Ok(())
    }

    /// Gives a collider its contact values and density. Returns whether they were others before.
    fn redress(
        &mut self,
        entry: usize,
        surface: Surface,
        table: &ContactTable,
        density: Option<f32>,
    ) -> bool {
        let rule = table.rule(&surface);
        self.entries[entry].surface = surface;
        // Colliders are inserted in the order of entries and never removed.
        let Some((collider, handle)) = self.engine.colliders.get_unknown_gen(entry as u32) else {
            return false;
        };
        let same_rule = collider.friction() == rule.0.friction
            && collider.restitution() == rule.0.restitution
            && collider
                .active_hooks()
                .contains(rapier3d::pipeline::ActiveHooks::MODIFY_SOLVER_CONTACTS)
                == rule.1;
        let same_density = density.is_none_or(|density| collider.density() == density);
        if same_rule && same_density {
            return false;
        }
        if let Some(collider) = self.engine.colliders.get_mut(handle) {
            if !same_rule {
                body::redress(collider, rule);
            }
            if let Some(density) = density
                && !same_density
            {
                collider.set_density(density);
            }
        }
        true
    }
}
