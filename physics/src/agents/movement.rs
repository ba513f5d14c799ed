//! All agents' movements in one physics step.

use super::meeting::{AgentPath, collision_free_fractions};
use super::wheeled_step::{self, BaseMotion};
use super::{
    AgentControl, AgentCylinder, AgentQueries, Agents, CharacterController, CharacterPush,
};
use crate::bases::WheelMotion;
use crate::dynamics::Dynamics;
use crate::hands::Hands;
use crate::outcome::{DelayedOutcome, OutcomeCode, fail};
use dwell_scene::{AgentBody, AgentId, AgentState, Id, LeggedLocomotion, Locomotion, State};
use glam::Vec3;
use rapier3d::dynamics::RigidBodyHandle;

/// The commanded and the actual motion of an agent in a control step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MovementRecord {
    start: Vec3,
    /// Its locomotion in this world.
    locomotion: Locomotion,
    wanted_m: f32,
    made_m: f32,
    turned_rad: f32,
}

impl MovementRecord {
    /// Returns the records of all agents at the beginning of a control step.
    pub(crate) fn all(state: &State) -> Vec<Self> {
        let way = |(id, agent): (AgentId, &AgentState)| Self {
            start: agent.position,
            locomotion: state.locomotion(id),
            wanted_m: 0.0,
            made_m: 0.0,
            turned_rad: 0.0,
        };
        state.agents.iter_ids().map(way).collect()
    }
}

/// What an agent does in a physics step, before it is known whether others get in its way.
struct PlannedMove {
    /// The agent as the step leaves it.
    agent: AgentState,
    /// Its own displacement if nothing stops it, m.
    motion: Vec3,
    driven: Option<BaseMotion>,
    pushes: Vec<CharacterPush>,
    /// True where it only looks or turns.
    stands: bool,
}

impl Agents {
    /// Moves all agents for one physics step, at the same time; `first`: the first of its control step.
    ///
    /// Each finds its way with the others where they stood before the step; who would meet stops where they meet.
    pub(crate) fn advance(
        &mut self,
        (dynamics, hands): (&mut Dynamics, &mut Hands),
        state: &mut State,
        controls: &[AgentControl],
        (ways, first): (&mut [MovementRecord], bool),
        notices: &mut Vec<DelayedOutcome>,
    ) {
        let mut planned = Vec::with_capacity(ways.len());
        for (index, way) in ways.iter_mut().enumerate() {
            let id = AgentId::from_index(index);
            let control = controls.get(index).copied().unwrap_or_default();
            planned.push(self.plan_move(dynamics, state, (id, control), way, first, notices));
        }
        stop_at_meetings(state, &mut planned);
        if hands.has_edge_grips() {
            stay_at_edges((dynamics, hands), state, &mut planned);
        }
        let mut pushes = Vec::new();
        for (index, (plan, way)) in planned.into_iter().zip(ways).enumerate() {
            let id = AgentId::from_index(index);
            pushes.extend(self.finish_move(dynamics, state, id, plan, way));
        }
        apply_pushes(dynamics, pushes);
    }

    /// Finds the way of one agent past everything that stands.
    fn plan_move(
        &mut self,
        dynamics: &mut Dynamics,
        state: &State,
        (id, control): (AgentId, AgentControl),
        way: &mut MovementRecord,
        first: bool,
        notices: &mut Vec<DelayedOutcome>,
    ) -> PlannedMove {
        let dt_s = dynamics.settings.dt_s;
        let mut agent = state.agents[id];
        control.pitch_view(&mut agent, dt_s);
        let laws = |rolling: &mut WheelMotion| {
            for law in &dynamics.laws.bases {
                law.modify_wheel_motion(id, rolling);
            }
        };
        let driven = wheeled_step::drive(&mut agent, &way.locomotion, &control, laws, dt_s);
        let motion = match (&driven, way.locomotion) {
            (Some(motion), _) => {
                motion.turn(&mut agent);
                way.turned_rad += motion.turn_rad;
                motion.displacement
            }
            (None, Locomotion::Walking(gait)) => {
                way.turned_rad += control.apply_yaw(&mut agent, dt_s);
                if first {
                    let crouch = control.crouch;
                    let told = self.set_stance(dynamics, state, id, &mut agent, &gait, crouch);
                    notices.extend(told);
                }
                stride(&agent, &gait, &control, dt_s)
            }
            (None, _) => Vec3::ZERO,
        };
        let idle = motion == Vec3::ZERO
            && agent.grounded
            && self.passive_velocities[id.index()] == super::PassiveVelocity::default();
        let stands = idle && !first;
        let pushes = if stands {
            Vec::new()
        } else {
            self.walk(dynamics, state, id, &mut agent, motion)
        };
        PlannedMove {
            agent,
            motion,
            driven,
            pushes,
            stands,
        }
    }

    /// Makes a planned move; returns its pushes, each with the greatest force, N.
    fn finish_move(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut State,
        id: AgentId,
        plan: PlannedMove,
        way: &mut MovementRecord,
    ) -> Vec<(CharacterPush, f32)> {
        let (before, mut agent) = (state.agents[id], plan.agent);
        if plan.stands {
            state.agents[id] = agent;
            return Vec::new();
        }
        let length = plan.motion.length();
        if length > 0.0 {
            let made = (agent.position - before.position).dot(plan.motion / length);
            way.wanted_m += length;
            way.made_m += made.clamp(0.0, length);
        }
        if let Some(motion) = &plan.driven {
            motion.store_rounding_remainder(&mut agent, before.position);
            let passive_velocities = &mut self.passive_velocities[id.index()];
            if !agent.grounded {
                // In the air it has a single velocity.
                passive_velocities.slide_m_s = Vec3::ZERO;
            } else if !before.grounded {
                // On landing its wheels slip, and friction brakes it until they roll.
                passive_velocities.slide_m_s = motion.slips_m_s;
            }
        }
        state.agents[id] = agent;
        if agent.position != before.position
            && let Some(rigid) = dynamics.engine.bodies.get_mut(self.list[id.index()].handle)
        {
            rigid.set_next_kinematic_translation(agent.position);
        }
        let force_n = agent.body.push_force_n;
        plan.pushes
            .into_iter()
            .map(|push| (push, force_n))
            .collect()
    }

    fn walk(
        &mut self,
        dynamics: &Dynamics,
        state: &State,
        id: AgentId,
        agent: &mut AgentState,
        motion: Vec3,
    ) -> Vec<CharacterPush> {
        let mut passive_velocities = self.passive_velocities[id.index()];
        let others = other_agents(state, id);
        let mut walk = CharacterController {
            probe: current_agent_queries(dynamics, agent, id, &others),
            pushes: Vec::new(),
            dt_s: dynamics.settings.dt_s,
            gravity_m_s2: dynamics.engine.gravity.length(),
        };
        walk.step(agent, &mut passive_velocities, motion);
        let pushes = walk.pushes;
        self.passive_velocities[id.index()] = passive_velocities;
        pushes
    }

    /// Makes an agent crouch, or stand up where there is room.
    fn set_stance(
        &mut self,
        dynamics: &mut Dynamics,
        state: &State,
        id: AgentId,
        agent: &mut AgentState,
        gait: &LeggedLocomotion,
        crouch: bool,
    ) -> Option<DelayedOutcome> {
        let body = &agent.body;
        let lowest = gait.crouched_height_m.max(2.0 * body.radius_m);
        let wanted = if crouch {
            (body.height_m - lowest).max(0.0)
        } else {
            0.0
        };
        if wanted == agent.crouched_by_m {
            return None;
        }
        let up = agent.crouched_by_m - wanted;
        let others = other_agents(state, id);
        if up > 0.0
            && !current_agent_queries(dynamics, agent, id, &others).has_headroom(agent.position, up)
        {
            return Some(DelayedOutcome {
                agent: Some(id),
                outcome: fail(
                    OutcomeCode::Blocked,
                    "Something is overhead: you cannot stand up here. Move out from under it first.",
                    None,
                ),
            });
        }
        agent.crouched_by_m = wanted;
        super::resize_capsule(&mut dynamics.engine, &mut self.list[id.index()], agent);
        None
    }
}

/// Ends a control step: writes the result of each agent's movement.
pub(crate) fn finish_movement(dynamics: &Dynamics, state: &mut State, ways: &[MovementRecord]) {
    let step_s = dynamics.settings.dt_s * dynamics.settings.steps_per_control as f32;
    for (index, (agent, way)) in state.agents.iter_mut().zip(ways).enumerate() {
        agent.velocity = (agent.position - way.start) / step_s;
        agent.collided = way.made_m + 1e-4 + 1e-3 * way.wanted_m < way.wanted_m;
        let id = AgentId::from_index(index);
        let rate = way.turned_rad / step_s;
        // Only bases have gyros with errors.
        agent.gyro_rad_s = match way.locomotion {
            Locomotion::Walking(_) => rate,
            _ => dynamics
                .laws
                .bases
                .iter()
                .fold(rate, |rate, law| law.gyro_reading(id, rate)),
        };
    }
}

/// Returns the surroundings of an agent, for its present height.
pub(super) fn current_agent_queries<'a>(
    dynamics: &'a Dynamics,
    agent: &AgentState,
    id: AgentId,
    others: &'a [AgentCylinder],
) -> AgentQueries<'a> {
    agent_queries(dynamics, super::current_body(agent), id, others)
}

/// Returns the surroundings of an agent with a body of its present height.
pub(super) fn agent_queries<'a>(
    dynamics: &'a Dynamics,
    body: AgentBody,
    id: AgentId,
    others: &'a [AgentCylinder],
) -> AgentQueries<'a> {
    AgentQueries {
        engine: &dynamics.engine,
        model: &dynamics.model,
        entries: &dynamics.entries,
        bodies: &dynamics.bodies,
        statuses: &dynamics.statuses,
        excluded: &dynamics.collision_exclusions,
        others,
        agent: id,
        body,
    }
}

/// Cuts short the movements of agents who hold the edges of things, and moves what they carry.
fn stay_at_edges(
    (dynamics, hands): (&mut Dynamics, &mut Hands),
    state: &State,
    planned: &mut [PlannedMove],
) {
    let ends = |planned: &[PlannedMove]| -> Vec<Vec3> {
        planned.iter().map(|plan| plan.agent.position).collect()
    };
    let put = |planned: &mut [PlannedMove], ends: &[Vec3]| {
        for (plan, end) in planned.iter_mut().zip(ends) {
            plan.agent.position = *end;
        }
    };
    let wanted = ends(planned);
    let mut limited = wanted.clone();
    hands.limit_holder_movements(dynamics, state, &mut limited);
    if limited != wanted {
        // Who stops earlier may be in somebody's way.
        put(planned, &limited);
        stop_at_meetings(state, planned);
        let mut made = ends(planned);
        for group in hands.holder_groups(dynamics) {
            let is_cut = |id: &AgentId| made[id.index()] != limited[id.index()];
            if group.iter().any(is_cut) {
                for id in &group {
                    made[id.index()] = state.agents[*id].position;
                }
            }
        }
        put(planned, &made);
        limited = made;
    }
    hands.move_carried(dynamics, state, &limited);
}

/// Stops agents who would meet where they meet.
fn stop_at_meetings(state: &State, planned: &mut [PlannedMove]) {
    if planned.len() < 2 {
        return;
    }
    let path = |(plan, before): (&PlannedMove, &AgentState)| AgentPath {
        from: before.position,
        to: plan.agent.position,
        radius_m: plan.agent.body.radius_m,
        height_m: plan.agent.height_m(),
    };
    let paths: Vec<AgentPath> = planned.iter().zip(&state.agents).map(path).collect();
    for ((plan, path), share) in planned
        .iter_mut()
        .zip(&paths)
        .zip(collision_free_fractions(&paths))
    {
        if share < 1.0 {
            plan.agent.position = path.from.lerp(path.to, share);
        }
    }
}

/// Pushes light bodies. Those who push one body share the work, whatever their numbers.
fn apply_pushes(dynamics: &mut Dynamics, mut pushes: Vec<(CharacterPush, f32)>) {
    // By body, then by place.
    let key = |push: &CharacterPush| (push.body, push.point.to_array().map(f32::to_bits));
    pushes.sort_by_key(|(push, _)| key(push));
    for group in pushes.chunk_by(|(a, _), (b, _)| a.body == b.body) {
        let share = 1.0 / group.len() as f32;
        let impulses: Vec<_> = group
            .iter()
            .filter_map(|(push, force_n)| push_impulse(dynamics, push, *force_n, share))
            .collect();
        for (handle, impulse, point) in impulses {
            dynamics.engine.wake(handle);
            if let Some(rigid) = dynamics.engine.bodies.get_mut(handle) {
                rigid.apply_impulse_at_point(impulse, point, false);
            }
        }
    }
}

/// Returns the body that a push is on, the impulse, N s, and the point where it acts: `share` of what gives the body the agent's speed,
/// with at most the agent's force.
fn push_impulse(
    dynamics: &Dynamics,
    push: &CharacterPush,
    force_n: f32,
    share: f32,
) -> Option<(RigidBodyHandle, Vec3, Vec3)> {
    let body = push.body as usize;
    let handle = dynamics.bodies[body].handle;
    let most = force_n * dynamics.settings.dt_s;
    let jointed = dynamics.model.bodies[body].joint.is_some();
    let rigid = dynamics.engine.bodies.get(handle)?;
    // A free body is pushed at the height of its centre of mass, so that it slides instead of tipping.
    let mut point = push.point;
    if !jointed {
        point.y = rigid.center_of_mass().y;
    }
    let speed = push.speed_m_s - rigid.velocity_at_point(point).dot(push.direction);
    // A leaf on a hinge resists at its edge like a third of its mass.
    let mass = if jointed {
        rigid.mass() / 3.0
    } else {
        rigid.mass()
    };
    let impulse = (speed * mass * share).min(most);
    (impulse > 0.0).then_some((handle, push.direction * impulse, point))
}

/// Returns the displacement of a walking agent in one physics step if nothing stops it: as commanded, up to its highest speed.
fn stride(agent: &AgentState, gait: &LeggedLocomotion, control: &AgentControl, dt_s: f32) -> Vec3 {
    let fastest = if agent.crouched_by_m > 0.0 {
        gait.max_crouched_speed_m_s.min(gait.max_speed_m_s)
    } else {
        gait.max_speed_m_s
    };
    let motion = control.displacement(agent.yaw_rad, dt_s);
    motion.clamp_length_max(fastest * dt_s)
}

pub(super) fn other_agents(state: &State, except: AgentId) -> Vec<AgentCylinder> {
    state
        .agents
        .iter_ids()
        .filter(|(id, _)| *id != except)
        .map(|(_, agent)| AgentCylinder {
            feet: agent.position,
            radius_m: agent.body.radius_m,
            height_m: agent.height_m(),
        })
        .collect()
}
