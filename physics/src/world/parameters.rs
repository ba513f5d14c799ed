//! Parameters that change while a world runs.

use super::PhysicsWorld;
use crate::body::BodyStatus;
use crate::contact::{ContactProperties, ContactTable};
use crate::dynamics::{self, BodyMasses};
use crate::error::PhysicsError;
use crate::hands::HeldObject;
use crate::joints::{self, ImposedJointState};
use crate::laws;
use crate::model::CollisionPiece;
use dwell_scene::{AgentId, Id, State};
use glam::Vec3;
use rapier3d::dynamics::{MassProperties, RigidBody};
use rapier3d::geometry::ColliderHandle;

impl PhysicsWorld {
    /// Applies the state's overrides and laws: masses, friction and restitution of pairs and materials, gravity, all joint
    /// parameters of [`State::joint_parameters`]. All sleeping bodies are woken if something changed. Where a link's length or
    /// a joint's axis changed, jointed bodies move there, in `state` too; a joint beyond a new limit is put at it, at rest.
    /// Agents get the bodies of the state.
    ///
    /// # Errors
    /// [`PhysicsError::Scene`] or [`PhysicsError::LawTarget`] for a law that cannot be installed, [`PhysicsError::Range`]
    /// for an agent's body that does not fit at the agent's place; nothing has changed then.
    pub fn apply_parameters(&mut self, state: &mut State) -> Result<(), PhysicsError> {
        self.check_state(state)?;
        let laws = laws::install(&self.dynamics.model, state, &self.dynamics.laws)?;
        self.agents.check_resize(&self.dynamics, state)?;
        let model = self.dynamics.model.clone();
        let table = ContactTable::new(&model.house, state);
        let weights = BodyMasses::new(&model, state, &laws);
        let gravity = Vec3::new(0.0, -state.gravity_m_s2(), 0.0);
        // Changes of shapes, masses or joints are applied by a step of zero length, which computes all contacts anew;
        // changes that only act from the next step on are not, so that setting a value and setting it back leaves no trace.
        let mut changed =
            weights != self.dynamics.masses || table.pairs_differ(&self.dynamics.table);
        let values = laws.contact_properties(&model.house, &table);
        let (mut longer, mut shifted) = (false, Vec::new());
        let statics = model.static_pieces.iter().map(|piece| (piece, None));
        let moving = model
            .bodies
            .iter()
            .enumerate()
            .flat_map(|(body, plan)| plan.pieces.iter().map(move |piece| (piece, Some(body))));
        // Entries are in the order of insertion: statics, bodies, agents; in houses of many pieces bodies, statics, agents.
        let mut pieces: Vec<(&CollisionPiece, Option<usize>)> = Vec::new();
        if model.inserts_statics_last() {
            pieces.extend(moving.chain(statics));
        } else {
            pieces.extend(statics.chain(moving));
        }
        for (index, (piece, body)) in pieces.into_iter().enumerate() {
            self.dynamics.entries[index].surface = table.surface_materials(&piece.materials);
            let density = body.map(|body| {
                let factor = model.bodies[body].mass_factor_of(piece, &weights.factors[body]);
                dynamics::density(piece, factor, weights.overridden[body].as_ref())
            });
            changed |= self.update_collider(index, values, density);
        }
        for (index, inertia) in weights.overridden.iter().enumerate() {
            if *inertia == self.dynamics.masses.overridden[index] {
                // Other mass ratios of the parts move the centre of mass.
                let uneven = |factors: &[f32]| factors.iter().any(|factor| *factor != factors[0]);
                let (new, old) = (
                    &weights.factors[index],
                    &self.dynamics.masses.factors[index],
                );
                if new != old && (uneven(new) || uneven(old)) {
                    shifted.push(index);
                }
                continue;
            }
            let properties = inertia.map_or_else(MassProperties::default, |i| i.properties());
            let handle = self.dynamics.bodies[index].handle;
            let held =
                |grip: &HeldObject| grip.body as usize == index && grip.has_kinematic_grasp();
            let held = self.hands.held_objects.iter().any(held);
            if let Some(rigid) = self.dynamics.engine.bodies.get_mut(handle) {
                rigid.set_additional_mass_properties(properties, false);
                let scale = inertia.map_or(1.0, |i| i.gravity_scale);
                rigid.set_gravity_scale(if held { 0.0 } else { scale }, false);
                shifted.push(index);
            }
        }
        for agent in 0..self.agents.list.len() {
            let entry = self.agents.list[agent].entry as usize;
            self.dynamics.entries[entry].surface = table.agent_material();
            changed |= self.update_collider(entry, values, None);
            changed |= self.agents.apply_resize(
                &mut self.dynamics,
                agent,
                &state.agents[AgentId::from_index(agent)],
            );
        }
        for joint in &mut self.articulation.joints {
            let before = (joint.values.parent_from_joint, joint.values.axis);
            changed |=
                joints::update_joint_parameters(&mut self.dynamics.engine, &model, joint, state);
            longer |= (joint.values.parent_from_joint, joint.values.axis) != before;
            let position = state.joint_position[joint.id];
            let within = joint.values.clamp(position);
            if within != position {
                state.joint_position[joint.id] = within;
                state.joint_velocity[joint.id] = 0.0;
                let child = joint.child as usize;
                joints::release(
                    &mut self.dynamics.engine,
                    &self.dynamics.bodies[child],
                    &mut self.dynamics.statuses[child],
                );
                longer = true;
            }
        }
        longer |= self.preserve_part_motion(state, &shifted);
        let acts_anew =
            gravity != self.dynamics.engine.gravity || laws.specs() != self.dynamics.laws.specs();
        self.dynamics.engine.gravity = gravity;
        self.dynamics
            .engine
            .set_compliance(&self.dynamics.settings, laws.compliance);
        self.dynamics.table = table;
        self.dynamics.masses = weights;
        self.applied.clone_from(&state.overrides);
        *self.dynamics.laws = laws;
        if changed || longer || acts_anew {
            self.dynamics.engine.wake_cached();
        }
        if changed {
            self.dynamics.flush();
        }
        // Only now, that contacts are computed under the new laws.
        if longer {
            self.reposition_jointed_bodies(state);
        }
        if changed || acts_anew {
            self.wake_sleepers(changed);
        }
        Ok(())
    }

    /// Wakes sleeping bodies; with `all`, restarts the time until sleep of the others too.
    fn wake_sleepers(&mut self, all: bool) {
        for body in &self.dynamics.bodies {
            let rigid = self.dynamics.engine.bodies.get(body.handle);
            // rapier sorts its islands anew when it wakes an awake body, and solves in another order.
            if all || rigid.is_some_and(RigidBody::is_sleeping) {
                self.dynamics.engine.wake(body.handle);
            }
        }
    }

    /// Keeps the motion of parts of bodies whose centre of mass has moved. Returns whether some are jointed.
    fn preserve_part_motion(&mut self, state: &State, shifted: &[usize]) -> bool {
        let mut on_joints = false;
        for index in shifted {
            let plan = &self.dynamics.model.bodies[*index];
            on_joints |= plan.joint.is_some();
            let handle = self.dynamics.bodies[*index].handle;
            if let Some(rigid) = self.dynamics.engine.bodies.get_mut(handle) {
                rigid.recompute_mass_properties_from_colliders(&self.dynamics.engine.colliders);
                for collider in rigid.colliders() {
                    if let Some(collider) = self.dynamics.engine.colliders.get_mut(*collider) {
                        dynamics::invalidate_contacts(collider);
                    }
                }
            }
            if let Some(rigid) = self.dynamics.engine.bodies.get_mut(handle)
                && plan.joint.is_none()
                && self.dynamics.statuses[*index] == BodyStatus::Free
            {
                let velocity = state.part_velocity[plan.root()];
                let arm = rigid.center_of_mass() - rigid.position().translation;
                rigid.set_linvel(velocity.linear + velocity.angular.cross(arm), false);
            }
        }
        on_joints
    }

    /// Moves jointed bodies whose joint frames have changed; joints keep their positions and velocities.
    fn reposition_jointed_bodies(&mut self, state: &mut State) {
        let stands: Vec<ImposedJointState> = self
            .articulation
            .joints
            .iter()
            .map(|joint| ImposedJointState {
                position: state.joint_position[joint.id],
                velocity: state.joint_velocity[joint.id],
                force_update: true,
                is_latched: self.dynamics.statuses[joint.child as usize] == BodyStatus::Latched,
            })
            .collect();
        self.place_joints(state, &stands);
    }

    /// Puts all jointed bodies at these placements, and writes their poses. Shape of `stands`: (joint,).
    pub(super) fn place_joints(&mut self, state: &mut State, placements: &[ImposedJointState]) {
        for tree in &self.articulation.trees {
            joints::place_tree(
                &mut self.dynamics.engine,
                &self.articulation.joints,
                tree,
                placements,
            );
        }
        self.dynamics.flush();
        self.articulation
            .write_bodies_and_joints(&self.dynamics, state);
    }

    /// Returns whether a collider is a rolling cylinder: the hook is asked about its contacts whatever the materials are.
    fn is_rollable_cylinder(&self, collider: ColliderHandle) -> bool {
        self.dynamics.model.rolling_cylinders.iter().any(|roller| {
            let body = self.dynamics.bodies.get(roller.body());
            let body = body.and_then(|body| self.dynamics.engine.bodies.get(body.handle));
            body.is_some_and(|body| {
                roller.collider(body) == Some(collider) && roller.is_rolling(body)
            })
        })
    }

    /// Gives a collider its contact values and density. Returns whether they changed.
    fn update_collider(
        &mut self,
        entry: usize,
        values: ContactProperties<'_>,
        density: Option<f32>,
    ) -> bool {
        // Colliders are inserted in the order of entries and never removed.
        let Some((collider, handle)) = self.dynamics.engine.colliders.get_unknown_gen(entry as u32)
        else {
            return false;
        };
        let mut rule = values.self_contact_and_hook(&self.dynamics.entries[entry]);
        rule.1 |= self.is_rollable_cylinder(handle);
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
        if let Some(collider) = self.dynamics.engine.colliders.get_mut(handle) {
            if !same_rule {
                dynamics::update_collider_properties(collider, rule);
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
