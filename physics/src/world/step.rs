//! One control step.

use super::PhysicsWorld;
use crate::actions;
use crate::agents::{AgentControl, MovementRecord, finish_movement};
use crate::contact::ContactEvent;
use crate::error::PhysicsError;
use dwell_scene::{State, interrupt};

/// Awake bodies times physics steps from which on a control step counts as long: some milliseconds, many times what a copy of the
/// world takes.
const LONG_BODY_STEPS: usize = 400;

impl PhysicsWorld {
    /// Returns whether the next [`PhysicsWorld::step`] may take so long that a copy of the world beforehand costs little beside it.
    pub fn is_next_step_long(&self) -> bool {
        let awake = self.dynamics.engine.islands.num_active_bodies();
        awake * self.dynamics.settings.steps_per_control as usize >= LONG_BODY_STEPS
    }

    /// Makes one control step: agents move by `controls` (those without one stand still), then bodies, joints and contacts;
    /// `state` is updated, and impacts, sliding and rolling are appended to `events` in the order of time and pair: at most
    /// [`max_events_per_step`](crate::PhysicsConfig::max_events_per_step), see [`PhysicsWorld::events_beyond_limit`].
    ///
    /// The state's `time_s` and `step` belong to the caller and are left alone. A cancellation ([`interrupt`]) may leave the step
    /// half made: go on with copies of world and state that were taken before.
    ///
    /// # Errors
    /// [`PhysicsError::ForeignState`] for another world's state, [`PhysicsError::UnknownAgent`] for more controls than
    /// agents, [`PhysicsError::Range`] for a control that is not finite or that the agent's body cannot follow. Nothing has
    /// happened then.
    pub fn step(
        &mut self,
        state: &mut State,
        controls: &[AgentControl],
        events: &mut Vec<ContactEvent>,
    ) -> Result<(), PhysicsError> {
        self.check_state(state)?;
        self.check_controls(state, controls)?;
        self.notices.clear();
        let (tick_before, first_event) = (self.dynamics.tick, events.len());
        let slept = self.dynamics.engine.islands.num_active_bodies() == 0;
        self.articulation.read_coordinates(state);
        self.hands
            .drop_too_heavy(&mut self.dynamics, state, &mut self.notices);
        self.articulation
            .set_actuation(&mut self.dynamics, state, &mut self.notices);
        let mut ways = MovementRecord::all(state);
        let mut placed = false;
        for substep in 0..self.dynamics.settings.steps_per_control {
            interrupt::unwind_if_cancelled();
            self.move_agents(state, controls, &mut ways, substep == 0);
            placed = self.physics_step(state, events);
            self.hands.undo_wall_penetration(&mut self.dynamics);
        }
        self.cache_sleepers(tick_before, placed);
        self.contacts
            .emit_remaining_events(&self.dynamics, events, first_event);
        finish_movement(&self.dynamics, state, &ways);
        self.hands
            .restore_holder_collisions(&mut self.dynamics, state);
        // A body that slept all the time is as it was written.
        if !slept || self.dynamics.engine.islands.num_active_bodies() > 0 {
            self.articulation.write_coordinates(state);
            self.articulation
                .write_bodies_and_joints(&self.dynamics, state);
            self.dynamics.write_contacts(state);
        }
        Ok(())
    }

    /// Makes one physics step of bodies, joints and contacts. Returns whether something was placed at its end, so that
    /// colliders moved.
    fn physics_step(&mut self, state: &State, events: &mut Vec<ContactEvent>) -> bool {
        self.articulation.drive_motors(&mut self.dynamics, state);
        let lifted = self.hands.lifted_bodies(&self.dynamics);
        let agents = self.agents.list.iter().map(|agent| agent.handle);
        let led = agents.chain(lifted);
        self.dynamics.engine.wake_bodies_in_reach(led);
        self.articulation.update_resistance_laws(&mut self.dynamics);
        let efforts = self.articulation.apply_efforts(&mut self.dynamics);
        let floating_roots = efforts.floating_roots.clone();
        self.dynamics.apply_laws_before(&floating_roots);
        let solved = self.contacts.solve(&mut self.dynamics);
        let joints_before = self.articulation.joint_coordinates.clone();
        let mut placed = self
            .articulation
            .correct_positions(&mut self.dynamics, efforts);
        let rebounds = self.contacts.correct_restitution(
            &mut self.dynamics,
            &mut self.articulation,
            &solved,
            &joints_before,
        );
        placed |= rebounds.moved_trees;
        self.contacts
            .record_contacts(&self.dynamics, solved, &rebounds, events);
        self.dynamics.apply_laws_after(&floating_roots);
        self.dynamics.count_step();
        placed |= self.dynamics.update_rolling_contacts();
        placed |= self.recover_non_finite();
        placed
    }

    /// Moves agents, their held objects and their pushes, before a physics step; `first`: the first of its control step.
    fn move_agents(
        &mut self,
        state: &mut State,
        controls: &[AgentControl],
        ways: &mut [MovementRecord],
        first: bool,
    ) {
        let (dynamics, notices) = (&mut self.dynamics, &mut self.notices);
        self.agents.advance(
            (dynamics, &mut self.hands),
            state,
            controls,
            (ways, first),
            notices,
        );
        self.hands.step_held_objects(dynamics, state, notices);
        actions::advance_pushes(&mut self.pushes, dynamics, state, notices);
    }

    /// Caches bodies that fell asleep since `tick_before`. Where the last physics step placed something, its colliders
    /// follow, so that a snapshot continues with the same bits.
    fn cache_sleepers(&mut self, tick_before: u64, placed: bool) {
        let hands = &self.hands;
        self.dynamics
            .cache_sleeping(tick_before, |body| hands.holds_or_just_released(body));
        if placed {
            self.dynamics.flush();
        }
    }

    fn check_controls(&self, state: &State, controls: &[AgentControl]) -> Result<(), PhysicsError> {
        let count = self.agents.list.len();
        if controls.len() > count {
            let index = controls.len() - 1;
            return Err(PhysicsError::UnknownAgent { index, count });
        }
        for (index, (control, agent)) in controls.iter().zip(&state.agents).enumerate() {
            control.check(index, &agent.body.locomotion)?;
        }
        Ok(())
    }

    /// Returns the kinetic energy of all moving bodies, J: of their centres of mass and of their rotation.
    pub fn kinetic_energy_j(&self) -> f64 {
        self.dynamics.kinetic_energy_j()
    }

    /// Returns the speed of the fastest point of any body, m/s.
    pub fn max_speed_m_s(&self) -> f32 {
        self.dynamics.max_speed_m_s()
    }
}
