//! Placement of agents from outside, with any velocity that their bodies can have.

use super::PhysicsWorld;
use crate::agents::{self, FASTEST_FALL_M_S, PassiveVelocity, STEEPEST_LOOK_RAD};
use crate::bases::{PlanarTwist, WheelGeometry};
use crate::convert::to_rapier;
use crate::error::PhysicsError;
use crate::hands::held_body_target_pose;
use dwell_scene::{AgentId, AgentState, BaseState, DifferentialDrive, Id, Locomotion, State, math};
use glam::Vec3;

/// Largest coordinate of an agent, m: coordinates are exact to some millimetres there.
const FURTHEST_M: f32 = 32_768.0;
/// Highest yaw rate, rad/s.
const FASTEST_TURN_RAD_S: f32 = 100.0;

/// The pose of an agent, and its velocities.
///
/// Commanded motion is up to controls: an agent on legs that is given a velocity slides on (feet brake it) or flies on, and
/// its yaw rate is its gyro's present reading. The wheels of a differential drive turn as its forward speed and yaw rate
/// require, unless they are given, and it slides with the remaining velocity; a holonomic base takes all of it, within its
/// limits. A wheeled base in the air keeps its velocity until it lands, and then has that of its wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AgentPlacement {
    /// The agent.
    pub agent: AgentId,
    /// The point between its feet, m.
    pub position: Vec3,
    /// Heading, rad, positive to the left.
    pub yaw_rad: f32,
    /// Pitch of the view, rad, positive up; -1.5 to 1.5.
    pub pitch_rad: f32,
    /// m/s; at most 30 along each axis.
    pub velocity: Vec3,
    /// rad/s, positive to the left; at most 100 either way.
    pub yaw_rate_rad_s: f32,
    /// Reduction of its body's height, m: more than 0 while it crouches. Only on legs.
    pub crouched_by_m: f32,
    /// Speeds of the left and right wheel of a differential drive, rad/s, instead of a horizontal velocity and a yaw rate.
    pub wheel_rad_s: Option<[f32; 2]>,
}

impl AgentPlacement {
    /// At rest, upright, looking ahead.
    pub fn at_rest(agent: AgentId, position: Vec3, yaw_rad: f32) -> Self {
        Self {
            agent,
            position,
            yaw_rad,
            pitch_rad: 0.0,
            velocity: Vec3::ZERO,
            yaw_rate_rad_s: 0.0,
            crouched_by_m: 0.0,
            wheel_rad_s: None,
        }
    }

    fn refuse<T>(
        &self,
        field: &'static str,
        found: impl std::fmt::Display,
        allowed: &'static str,
    ) -> Result<T, PhysicsError> {
        Err(PhysicsError::Range {
            at: format!("agent {}", self.agent.index()),
            field,
            found: format!("{found}"),
            allowed,
        })
    }

    fn check(&self) -> Result<(), PhysicsError> {
        let (at, v) = (self.position, self.velocity);
        if !at.is_finite() || at.abs().max_element() > FURTHEST_M {
            return self.refuse(
                "position",
                at,
                "finite numbers within 32768 m of the origin",
            );
        }
        if !self.yaw_rad.is_finite() {
            return self.refuse("yaw_rad", self.yaw_rad, "a finite number");
        }
        if !(-STEEPEST_LOOK_RAD..=STEEPEST_LOOK_RAD).contains(&self.pitch_rad) {
            return self.refuse("pitch_rad", self.pitch_rad, "-1.5 to 1.5");
        }
        if !v.is_finite() || v.abs().max_element() > FASTEST_FALL_M_S {
            return self.refuse(
                "velocity",
                v,
                "finite numbers, at most 30 m/s along each axis",
            );
        }
        if !(-FASTEST_TURN_RAD_S..=FASTEST_TURN_RAD_S).contains(&self.yaw_rate_rad_s) {
            let found = self.yaw_rate_rad_s;
            return self.refuse("yaw_rate_rad_s", found, "at most 100 rad/s either way");
        }
        Ok(())
    }

    /// The velocity in the body's own frame.
    fn twist(&self) -> PlanarTwist {
        let forward = dwell_scene::space::forward_from_yaw(self.yaw_rad);
        let left = Vec3::new(forward.z, 0.0, -forward.x);
        PlanarTwist {
            forward_m_s: self.velocity.dot(forward).into(),
            left_m_s: self.velocity.dot(left).into(),
            yaw_rate_rad_s: self.yaw_rate_rad_s.into(),
        }
    }

    /// Returns the placed agent, and its velocity that is not commanded. `truth`: its locomotion in this world.
    fn agent_state(
        &self,
        before: &AgentState,
        truth: &Locomotion,
    ) -> Result<(AgentState, PassiveVelocity), PhysicsError> {
        self.check()?;
        let most = before.body.height_m - 2.0 * before.body.radius_m;
        if !(0.0..=most.max(0.0)).contains(&self.crouched_by_m) {
            let allowed = "0 to the height above twice the radius";
            return self.refuse("crouched_by_m", self.crouched_by_m, allowed);
        }
        let mut agent = AgentState {
            position: self.position,
            yaw_rad: math::wrap_angle(self.yaw_rad),
            pitch_rad: self.pitch_rad,
            velocity: self.velocity,
            grounded: self.velocity.y == 0.0,
            collided: false,
            crouched_by_m: self.crouched_by_m,
            gyro_rad_s: self.yaw_rate_rad_s,
            base: BaseState::default(),
            ..*before
        };
        let walks = matches!(truth, Locomotion::Walking(_));
        if !walks && self.crouched_by_m != 0.0 {
            return self.refuse("crouched_by_m", self.crouched_by_m, "0: it has no legs");
        }
        if let Some(rates) = self.wheel_rad_s
            && !matches!(truth, Locomotion::DifferentialDrive(_))
        {
            let found = format!("{rates:?}");
            return self.refuse("wheel_rad_s", found, "nothing: it has no such wheels");
        }
        let mut slide = self.velocity.with_y(0.0);
        match (&before.body.locomotion, truth) {
            (Locomotion::DifferentialDrive(nominal), Locomotion::DifferentialDrive(truth)) => {
                slide -= self.turn_wheels(&mut agent, nominal, truth)?;
            }
            (_, Locomotion::Holonomic(base)) => {
                let twist = self.twist();
                let [forward, left] = [twist.forward_m_s, twist.left_m_s].map(|v| v as f32);
                let slow = forward.abs() <= base.max_forward_m_s
                    && left.abs() <= base.max_sideways_m_s
                    && self.yaw_rate_rad_s.abs() <= base.max_yaw_rate_rad_s;
                if !slow && agent.grounded {
                    let found = format!(
                        "{forward} m/s ahead, {left} m/s to the left, {} rad/s",
                        self.yaw_rate_rad_s
                    );
                    return self.refuse("velocity", found, "what its base's limits allow");
                }
                // In the air its wheels turn as fast as they can, and the body flies on.
                let within = |speed: f32, most: f32| speed.clamp(-most, most);
                agent.base.twist = [
                    within(forward, base.max_forward_m_s),
                    within(left, base.max_sideways_m_s),
                    within(self.yaw_rate_rad_s, base.max_yaw_rate_rad_s),
                ];
                slide = Vec3::ZERO;
            }
            _ => {}
        }
        // A wheeled base in the air keeps its velocity as a free body does.
        if !agent.grounded && !walks {
            slide = Vec3::ZERO;
        }
        let passive_velocities = PassiveVelocity {
            fall_m_s: -self.velocity.y,
            slide_m_s: slide,
        };
        Ok((agent, passive_velocities))
    }

    /// Gives the wheels of a differential drive their speeds. Returns the resulting velocity, m/s.
    fn turn_wheels(
        &self,
        agent: &mut AgentState,
        nominal: &DifferentialDrive,
        truth: &DifferentialDrive,
    ) -> Result<Vec3, PhysicsError> {
        let wheels = WheelGeometry::from(truth);
        let rates = if let Some(rates) = self.wheel_rad_s {
            if self.velocity.with_y(0.0) != Vec3::ZERO || self.yaw_rate_rad_s != 0.0 {
                let found = format!("{rates:?}");
                let allowed =
                    "either wheel speeds or a level velocity and a rate of turn, not both";
                return self.refuse("wheel_rad_s", found, allowed);
            }
            rates.map(f64::from)
        } else {
            let twist = self.twist();
            wheels.rates(twist.forward_m_s, twist.yaw_rate_rad_s)
        };
        let fastest = f64::from(truth.max_wheel_speed_rad_s);
        if !rates.iter().all(|rate| rate.abs() <= fastest) {
            let found = format!("{rates:?} rad/s (its wheels turn with up to {fastest})");
            return self.refuse("wheel_rad_s", found, "speeds that its wheels have");
        }
        agent.base.wheel_rad_s = rates.map(|rate| rate as f32);
        let believed = WheelGeometry::from(nominal).twist(rates);
        agent.base.twist = [
            believed.forward_m_s as f32,
            0.0,
            believed.yaw_rate_rad_s as f32,
        ];
        let twist = wheels.twist(rates);
        let forward = dwell_scene::space::forward_from_yaw(agent.yaw_rad);
        let own = forward * twist.forward_m_s as f32;
        if self.wheel_rad_s.is_some() {
            agent.velocity = own.with_y(self.velocity.y);
            agent.gyro_rad_s = twist.yaw_rate_rad_s as f32;
            return Ok(Vec3::ZERO);
        }
        Ok(own)
    }
}

impl PhysicsWorld {
    /// Places an agent, at rest, together with its held object.
    ///
    /// # Errors
    /// As [`PhysicsWorld::set_agents`].
    pub fn place_agent(
        &mut self,
        state: &mut State,
        agent: AgentId,
        position: Vec3,
        yaw_rad: f32,
    ) -> Result<(), PhysicsError> {
        self.set_agents(state, &[AgentPlacement::at_rest(agent, position, yaw_rad)])
    }

    /// Places agents with poses and velocities, together with their held objects. They may be placed inside things; they
    /// then work their way out. The state then holds exactly the values that were set.
    ///
    /// # Errors
    /// [`PhysicsError::UnknownAgent`]; [`PhysicsError::Range`] for numbers that are not finite or that the agent's body cannot
    /// have. Nothing has changed then.
    pub fn set_agents(
        &mut self,
        state: &mut State,
        placements: &[AgentPlacement],
    ) -> Result<(), PhysicsError> {
        self.check_state(state)?;
        let mut put = Vec::with_capacity(placements.len());
        for placement in placements {
            let id = placement.agent;
            let Some(before) = state.agents.get(id) else {
                return Err(PhysicsError::UnknownAgent {
                    index: id.index(),
                    count: self.agents.list.len(),
                });
            };
            let (agent, passive_velocities) =
                placement.agent_state(before, &state.locomotion(id))?;
            put.push((id, agent, passive_velocities));
        }
        for (id, agent, passive_velocities) in put {
            let restands = state.agents[id].crouched_by_m != agent.crouched_by_m;
            state.agents[id] = agent;
            self.agents.passive_velocities[id.index()] = passive_velocities;
            let own = &mut self.agents.list[id.index()];
            if let Some(rigid) = self.dynamics.engine.bodies.get_mut(own.handle) {
                rigid.set_translation(agent.position, true);
            }
            if restands {
                agents::resize_capsule(&mut self.dynamics.engine, own, &agent);
            }
            if let Some(place) = self
                .hands
                .held_objects
                .iter()
                .position(|grip| grip.agent == id)
            {
                if self.hands.held_objects[place].edge().is_some() {
                    // Nobody is put elsewhere with a table in its hands.
                    self.hands.open_hand(&mut self.dynamics, state, place);
                } else {
                    self.bring_held(state, place, &agent);
                }
            }
        }
        self.dynamics.flush();
        self.articulation
            .write_bodies_and_joints(&self.dynamics, state);
        Ok(())
    }

    /// Brings an agent's held object to its hand: as near as nothing is in the way, never beyond a wall. Where there is no
    /// room at all, the agent releases it, and it stays.
    fn bring_held(&mut self, state: &mut State, place: usize, here: &AgentState) {
        let grip = self.hands.held_objects[place];
        let body = grip.body as usize;
        let hand = to_rapier(&held_body_target_pose(&grip, here));
        let mut eye = hand;
        let middle = self.dynamics.model.bodies[body].bounds(&hand).center();
        eye.translation += here.eye_position() - middle;
        let clear = self.dynamics.first_clear_pose(body, here, &eye, &hand);
        if clear.is_none() {
            self.hands.open_hand(&mut self.dynamics, state, place);
        }
        let handle = self.dynamics.bodies[body].handle;
        if let Some(rigid) = self.dynamics.engine.bodies.get_mut(handle) {
            rigid.set_position(clear.unwrap_or(*rigid.position()), true);
            rigid.set_linvel(here.velocity, true);
            rigid.set_angvel(Vec3::ZERO, true);
        }
    }
}
