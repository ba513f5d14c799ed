//! What the scripted carriers do: both take hold, walk at the same time from pose to pose, let go and stop.

use super::formation::{CarryFormation, yaw_between};
use crate::actions::{DiscreteAction, StepSizes};
use crate::world::World;
use dwell_scene::{AgentId, Pose, math};
use glam::Vec3;

/// A carrier is at its place within this distance, m; below half of the usual step and above what a step overshoots.
const THERE_M: f32 = 0.06;
/// The thing is where it belongs within this distance, m.
const PUT_M: f32 = 0.15;

/// What a carrier does next, if it has a way to go.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Next {
    There,
    Turn(DiscreteAction),
    Walk,
}

/// Where a carrier's next place is, seen from it.
fn next_of(world: &World, agent: AgentId, place: Vec3, stride: &StepSizes) -> Next {
    let Some(own) = world.state().agents.get(agent) else {
        return Next::There;
    };
    let way = (place - own.position).with_y(0.0);
    if way.length() <= THERE_M.max(0.55 * stride.forward_m) {
        return Next::There;
    }
    let error = math::wrap_angle(dwell_scene::space::yaw_from_forward(way) - own.yaw_rad);
    if error.abs() <= 0.51 * stride.turn_deg.to_radians() {
        return Next::Walk;
    }
    Next::Turn(if error > 0.0 {
        DiscreteAction::TurnLeft
    } else {
        DiscreteAction::TurnRight
    })
}

/// The scripted carriers of an episode.
#[derive(Clone, Debug)]
pub(super) struct Carriers {
    pub(super) agents: [AgentId; 2],
    pub(super) way: Vec<Pose>,
}

impl Carriers {
    /// Returns the next action of a carrier; `at`: the place on the way to which they go, which it moves on.
    pub(super) fn next_action(
        &self,
        world: &World,
        formation: &CarryFormation,
        (carrier, stride): (usize, &StepSizes),
        at: &mut usize,
    ) -> DiscreteAction {
        let state = world.state();
        let own = self.agents[carrier];
        let holds = |agent: AgentId| {
            let agent = state.agents.get(agent);
            agent.is_some_and(|agent| agent.holding == Some(formation.object))
        };
        let now = state.part_pose[formation.part];
        let last = self.way.len().saturating_sub(1);
        let goal = self.way.get(last).copied().unwrap_or(formation.start);
        let off_m = (now.transform_point(formation.middle)
            - goal.transform_point(formation.middle))
        .with_y(0.0)
        .length();
        let turned_rad = yaw_between(now.rotation, goal.rotation).abs();
        let is_put = off_m <= PUT_M && turned_rad <= 0.15;
        if !holds(own) {
            if is_put && *at >= last {
                // The other one lets go first, or has.
                let other = self.agents[1 - carrier];
                return if holds(other) {
                    DiscreteAction::Wait
                } else {
                    DiscreteAction::Stop
                };
            }
            return DiscreteAction::Grip;
        }
        if !holds(self.agents[1 - carrier]) {
            return if is_put && *at >= last {
                DiscreteAction::Drop
            } else {
                DiscreteAction::Wait
            };
        }
        loop {
            let Some(pose) = self.way.get(*at) else {
                return DiscreteAction::Drop;
            };
            let next = [0, 1].map(|k| {
                next_of(
                    world,
                    self.agents[k],
                    formation.carrier_position(pose, k),
                    stride,
                )
            });
            if next == [Next::There; 2] {
                if *at >= last {
                    return DiscreteAction::Drop;
                }
                *at += 1;
                continue;
            }
            let turns = next.iter().any(|next| matches!(next, Next::Turn(_)));
            return match next[carrier] {
                Next::Turn(turn) => turn,
                // Both walk at the same time.
                Next::Walk if !turns => DiscreteAction::MoveForward,
                _ => DiscreteAction::Wait,
            };
        }
    }
}
