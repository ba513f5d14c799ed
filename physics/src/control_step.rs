//! One control step.

use crate::actions::{ActionOutcome, DelayedOutcome, OutcomeCode};
use crate::agents::{self, AgentControl, MovementRecord};
use crate::body::BodyStatus;
use crate::contact::rolling;
use crate::contact::{
    ContactCollector, ContactEvent, ContactHooks, ContactProperties, RestitutionContext, bound,
    record_motion,
};
use crate::error::PhysicsError;
use crate::joints::{
    self, DriveProgress, ExternalWrench, HandDrive, JointDrivers, JointLoad, JointResistance,
    LinkStep, TreePrediction, commanded,
};
use crate::laws::{BodyLaw, LawContext};
use crate::world::{PhysicsWorld, joint_from_state};
use dwell_scene::{Aabb, AgentState, JointCommand, JointId, State, interrupt};
use glam::Vec3;

impl PhysicsWorld {
    /// Makes one control step: agents move as `controls` say (those without one stand still), then bodies, joints and
    /// contacts; `state` is brought up to date, and impacts, scrapes and rolling are appended to `events` in the order of time
    /// and pair: at most [`max_events_per_step`](crate::PhysicsConfig::max_events_per_step), see
    /// [`PhysicsWorld::merged_events`].
    ///
    /// The state's `time_s` and `step` belong to whoever runs the world and are left alone.
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
        if controls.len() > self.agents.len() {
            return Err(PhysicsError::UnknownAgent {
                index: controls.len() - 1,
                count: self.agents.len(),
            });
        }
        for (index, (control, agent)) in controls.iter().zip(&state.agents).enumerate() {
            control.check(index, &agent.body.locomotion)?;
        }
        self.notices.clear();
        let first_event = events.len();
        let joints_before = self.tick;
        let asleep = self.engine.islands.num_active_bodies() == 0;
        let joints = self.joints.iter();
        self.joint_coordinates = joints
            .map(|joint| joint_from_state(state, joint.id))
            .collect();
        self.drop_too_heavy(state);
        self.drive_joints(state);
        let mut ways = MovementRecord::all(state);
        let mut placed = false;
        for substep in 0..self.settings.steps_per_control {
            interrupt::check();
            self.move_agents(state, controls, &mut ways, substep == 0);
            self.carry_held(state);
            self.advance_pushes(state);
            placed = self.physics_step(state, events);
            self.keep_held_inside();
        }
        self.cache_sleeping(joints_before);
        if placed {
            // Colliders follow what was placed, so that a snapshot continues with the same bits.
            self.flush();
        }
        self.contact_tracker
            .emit_events(self.tick, &self.settings.config, &self.table, events);
        self.merged_events = bound(
            events,
            first_event,
            self.settings.config.max_events_per_step,
        );
        self.finish_movement(state, &ways);
        self.end_separations(state);
        // What slept all the time stands as it was written.
        if !asleep || self.engine.islands.num_active_bodies() > 0 {
            for (joint, joint_coordinates) in self.joints.iter().zip(&self.joint_coordinates) {
                state.joint_position[joint.id] = joint_coordinates.position as f32;
                state.joint_velocity[joint.id] = joint_coordinates.velocity as f32;
            }
            self.write_bodies(state);
            self.write_contacts(state);
        }
        Ok(())
    }

    /// Returns whether a tree of joints was put on its course at the end of the step.
    fn physics_step(&mut self, state: &State, events: &mut Vec<ContactEvent>) -> bool {
        self.drive_motors(state);
        let led = self.agents.iter().map(|agent| agent.handle);
        self.engine.wake_in_reach(led);
        self.follow_joints();
        for joint in &self.joints {
            joints::clear_efforts(&mut self.engine, joint);
        }
        let laws = &self.laws;
        let resist = |joint: JointId, load: &JointLoad, resistance: &mut JointResistance| {
            for law in &laws.resistances {
                law.effect.resist(joint, load, resistance);
            }
        };
        let time_s = self.tick as f64 * f64::from(self.settings.dt_s);
        let push = |link: LinkStep| {
            let link = LinkStep { time_s, ..link };
            let pushes = laws.links.iter().map(|law| law.push(&link));
            pushes.fold(ExternalWrench::default(), ExternalWrench::and)
        };
        let (pushing, resisting) = (!laws.links.is_empty(), !laws.resistances.is_empty());
        let drivers = JointDrivers {
            joints: &self.joints,
            pulls: &self.pulls,
            joint_coordinates: &self.joint_coordinates,
            resist: if resisting { Some(&resist) } else { None },
            push: if pushing { Some(&push) } else { None },
            dt_s: self.settings.dt_s,
        };
        let trees = self.trees.iter();
        let outlooks: Vec<Option<TreePrediction>> = trees
            .map(|tree| joints::apply_efforts(&mut self.engine, tree, &drivers))
            .collect();
        let trees = self.trees.iter();
        let floating_roots: Vec<u32> = trees
            .filter_map(|tree| tree.floating_root(&self.engine, &self.joints))
            .collect();
        let half = 0.5 * self.settings.dt_s;
        self.apply_laws(&floating_roots, |law, stage| {
            law.apply_half_step(stage, half);
            law.before_step(stage);
        });
        let flying = self.engine.in_free_flight();
        record_motion(
            &self.engine,
            &self.contact_tracker,
            &flying,
            &mut self.motion,
        );
        let hooks = ContactHooks {
            entries: &self.entries,
            properties: ContactProperties {
                house: &self.model.house,
                table: &self.table,
                laws: &self.laws.contacts,
                soft: self.laws.compliance.is_some(),
            },
            excluded: &self.excluded,
            kept: self.engine.friction_kept(),
            dt_s: self.settings.dt_s,
        };
        let config = &self.settings.config;
        let slowest = config.event_min_speed_m_s.min(config.slide_min_speed_m_s);
        let collector = ContactCollector::new(
            &self.entries,
            &self.motion,
            slowest,
            self.engine.friction_kept(),
        );
        let landed = self.engine.step(flying, &hooks, &collector);
        let mut placed = false;
        let joints_before = self.joint_coordinates.clone();
        for (tree, outlook) in self.trees.iter().zip(outlooks) {
            let (engine, joint_coordinates) = (&mut self.engine, &mut self.joint_coordinates);
            placed |= match outlook {
                Some(outlook) => {
                    joints::settle(engine, tree, &self.joints, outlook, joint_coordinates)
                }
                None => joints::project_woken(engine, tree, &self.joints, joint_coordinates),
            };
        }
        let rebounds = RestitutionContext {
            motions: &self.motion,
            entries: &self.entries,
            trees: &self.trees,
            joints: &self.joints,
            joints_before: &joints_before,
            dt_s: self.settings.dt_s,
        };
        let rebounds = rebounds.correct(&mut self.engine, &landed, &mut self.joint_coordinates);
        placed |= rebounds.placed;
        self.contact_tracker.settle(
            (collector, &rebounds.added),
            self.tick,
            config,
            &self.table,
            events,
        );
        self.contact_tracker
            .note_held_back(&self.engine, &self.motion, self.settings.dt_s);
        self.apply_laws(&floating_roots, |law, stage| {
            law.apply_half_step(stage, half);
        });
        self.tick += 1;
        self.engine.copy_pairs_at(self.tick);
        placed |= self.update_rolling_contacts();
        placed |= self.recover_non_finite();
        placed
    }

    /// Lets rapier ask about the contacts of what rolls. Returns whether something began or ceased to roll.
    pub(crate) fn update_rolling_contacts(&mut self) -> bool {
        let model = self.model.clone();
        let properties = ContactProperties {
            house: &model.house,
            table: &self.table,
            laws: &self.laws.contacts,
            soft: self.laws.compliance.is_some(),
        };
        let mut changed = false;
        for roller in &model.rollers {
            let handle = self.bodies[roller.body()].handle;
            let body = self.engine.bodies.get(handle);
            let (own, rolls) = (
                body.and_then(|body| roller.collider(body)),
                body.is_some_and(|body| roller.rolls(body)),
            );
            let entries = &self.entries;
            let asked = |index: usize| {
                entries
                    .get(index)
                    .is_some_and(|entry| properties.rule(entry).1)
            };
            changed |= rolling::set_rolling_hook(&mut self.engine, rolls, own, asked);
        }
        changed
    }

    /// Tells laws that remember it where joints stand.
    fn follow_joints(&mut self) {
        if self.laws.resistances.is_empty() {
            return;
        }
        for (joint, joint_coordinates) in self.joints.iter().zip(&self.joint_coordinates) {
            let position = joints::stands(&self.engine, joint, *joint_coordinates).position as f32;
            for law in &mut self.laws.resistances {
                law.effect.follow(joint.id, position);
            }
        }
    }

    /// Lets each law act on the world between steps.
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

    /// Sets what pulls at all joints from the state's targets.
    fn drive_joints(&mut self, state: &mut State) {
        let house = self.model.house.clone();
        let step_s = self.settings.dt_s * self.settings.steps_per_control as f32;
        let by_laws = !self.laws.motors.is_empty();
        for index in 0..self.joints.len() {
            let joint = self.joints[index];
            let articulation = &house.joints[joint.id];
            if by_laws && articulation.servo.is_some() {
                continue;
            }
            let command = commanded(state, joint.id);
            let child = joint.child as usize;
            let now = (
                state.joint_position[joint.id],
                state.joint_velocity[joint.id],
            );
            if articulation.servo.is_none()
                && let JointCommand::Position(goal) = command
            {
                let goal = joint.values.clamp(goal);
                let drive = self.drives.get(&joint.id);
                if drive.is_none_or(|drive| drive.goal != goal) {
                    self.drives
                        .insert(joint.id, HandDrive::new(goal, now.0, None));
                }
                if (goal - articulation.closed).abs() > joints::tolerance(joint.kind) {
                    let body = self.bodies[child];
                    joints::release(&mut self.engine, &body, &mut self.holds[child]);
                }
            } else if articulation.servo.is_none() {
                self.drives.remove(&joint.id);
            }
            let hand = self.drives.get_mut(&joint.id);
            let puller = hand.as_ref().and_then(|hand| hand.agent);
            let puller = puller.and_then(|agent| state.agents.get(agent));
            let effort = puller.map_or_else(|| state.hand_effort(), |agent| agent.body.hand_effort);
            let limits = (step_s, effort);
            let (pull, progress) =
                joints::advance(joint.kind, &joint.values, command, hand, now, limits);
            // A motor that lets go wakes what it held, too.
            if self.pulls[index] != pull {
                joints::wake(&mut self.engine, &joint);
            }
            self.pulls[index] = pull;
            if let Some(progress) = progress.filter(|progress| *progress != DriveProgress::Moving) {
                self.finish_drive(state, &joint, progress);
            }
        }
    }

    /// Takes back what was pressed through a sheet in the last physics step. Contacts stop what is held, but a hand that
    /// presses a thin card against a thin wall overcomes them.
    fn keep_held_inside(&mut self) {
        let mut moved = false;
        for place in 0..self.grips.len() {
            let grip = self.grips[place];
            let handle = self.bodies[grip.body as usize].handle;
            let Some(now) = self
                .engine
                .bodies
                .get(handle)
                .map(|rigid| *rigid.position())
            else {
                continue;
            };
            let middle = grip.middle_at(&now);
            if middle == grip.middle || self.first_obstacle(grip.middle, middle).is_none() {
                continue;
            }
            if let Some(rigid) = self.engine.bodies.get_mut(handle) {
                let mut back = now;
                back.translation += grip.middle - middle;
                rigid.set_position(back, true);
                rigid.set_linvel(Vec3::ZERO, true);
                moved = true;
            }
        }
        if moved {
            self.flush();
        }
    }

    fn carry_held(&mut self, state: &mut State) {
        let mut place = 0;
        while place < self.grips.len() {
            let agent = state.agents[self.grips[place].agent];
            let body = self.bodies[self.grips[place].body as usize];
            let grip = &mut self.grips[place];
            let dt_s = self.settings.dt_s;
            let slips = agents::carry(&mut self.engine, &body, grip, &agent, dt_s);
            if !slips {
                place += 1;
                continue;
            }
            let (holder, object) = (grip.agent, grip.object);
            self.ungrip(state, place);
            let name = self.call(object);
            self.notices.push(DelayedOutcome {
                agent: Some(holder),
                outcome: ActionOutcome::failed(
                    OutcomeCode::Slipped,
                    format!("The {name} was caught on something and slipped from your hand."),
                    Some(object),
                ),
            });
        }
    }

    /// Lets bodies and the agents that held them meet again once they are apart.
    fn end_separations(&mut self, state: &State) {
        if self.released_overlapping.is_empty() {
            return;
        }
        let mut still = Vec::new();
        for (body, agent) in std::mem::take(&mut self.released_overlapping) {
            let held_again = self
                .grips
                .iter()
                .any(|grip| (grip.body, grip.agent) == (body, agent));
            if held_again {
                continue;
            }
            let rigid = self.engine.bodies.get(self.bodies[body as usize].handle);
            let apart = rigid.is_none_or(|rigid| {
                let bounds = self.model.bodies[body as usize].bounds(rigid.position());
                !bounds.intersects(&agent_bounds(&state.agents[agent]).grown(0.01))
            });
            if apart {
                self.excluded.part(body, agent);
            } else {
                still.push((body, agent));
            }
        }
        self.released_overlapping = still;
    }

    /// The kinetic energy of everything that moves freely or on joints, J: that of the centres of mass and of the spins.
    pub fn kinetic_energy_j(&self) -> f64 {
        self.bodies
            .iter()
            .zip(&self.holds)
            .filter(|(_, hold)| **hold == BodyStatus::Free)
            .filter_map(|(body, _)| self.engine.bodies.get(body.handle))
            .map(|rigid| f64::from(rigid.kinetic_energy()))
            .sum()
    }

    /// The fastest point of any body, m/s.
    pub fn fastest_m_s(&self) -> f32 {
        self.bodies
            .iter()
            .zip(&self.holds)
            .filter(|(_, hold)| **hold == BodyStatus::Free)
            .filter_map(|(body, _)| self.engine.bodies.get(body.handle))
            .map(|rigid| {
                let reach = rigid.mass_properties().max_extent();
                rigid.linvel().length() + rigid.angvel().length() * reach
            })
            .fold(0.0, f32::max)
    }
}

fn agent_bounds(agent: &AgentState) -> Aabb {
    let r = agent.body.radius_m;
    Aabb::new(
        agent.position - Vec3::new(r, 0.0, r),
        agent.position + Vec3::new(r, agent.height_m(), r),
    )
}
