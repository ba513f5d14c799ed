//! The order of hands that act in one step.
//!
//! The nearest acts first, by the distance of its agent's eye from the surface of the thing that it reaches for; hands that reach for
//! nothing (`drop`, `place` on what is in view) act before all others. Of several who reach for one thing from exactly as near,
//! nobody gets it. Agents' numbers decide nothing.

use super::{AgentAction, DiscreteAction, HandTarget};
use crate::world::World;
use dwell_physics::{ActionOutcome, OutcomeCode, Target};
use dwell_scene::ObjectId;
use std::cmp::Ordering;

/// What a hand reaches for, and from where.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Reach {
    object: Option<ObjectId>,
    /// 0 where it reaches for nothing.
    distance_m: f32,
    /// The eye's position, m, and the yaw, rad: what tells apart those who are equally far from their things.
    from: [f32; 4],
}

impl Reach {
    fn compare(&self, other: &Self) -> Ordering {
        let from = self.from.iter().zip(&other.from);
        let places = from.map(|(a, b)| a.total_cmp(b));
        let nearer = self.distance_m.total_cmp(&other.distance_m);
        places.fold(nearer, Ordering::then)
    }

    /// Returns whether both are equally near to one thing.
    fn contests(&self, other: &Self) -> bool {
        self.object.is_some()
            && self.object == other.object
            && self.distance_m.total_cmp(&other.distance_m).is_eq()
    }
}

/// The places of `steps` in the order in which their hands act, and those whose hands get nothing. Shape (agent,) each.
#[derive(Debug)]
pub(super) struct HandActionOrder {
    pub(super) order: Vec<usize>,
    pub(super) contested: Vec<Option<ObjectId>>,
}

impl World {
    /// Returns the order of the hands of a step.
    pub(super) fn hand_order(&mut self, steps: &[AgentAction]) -> HandActionOrder {
        let mut order: Vec<usize> = (0..steps.len()).collect();
        let mut contested = vec![None; steps.len()];
        if steps.len() > 1 {
            let reaches: Vec<Reach> = steps.iter().map(|step| self.reach_of(step)).collect();
            order.sort_by(|a, b| reaches[*a].compare(&reaches[*b]));
            for (place, own) in reaches.iter().enumerate() {
                let mut others = reaches.iter().enumerate();
                if others.any(|(other, reach)| other != place && own.contests(reach)) {
                    contested[place] = own.object;
                }
            }
        }
        HandActionOrder { order, contested }
    }

    fn reach_of(&mut self, step: &AgentAction) -> Reach {
        let target = self.contestable_target(step);
        let found = target.and_then(|target| self.distance_to_target(step.agent, &target));
        let agent = self.state().agents.get(step.agent);
        let from = agent.map_or([0.0; 4], |agent| {
            let eye = agent.eye_position();
            [eye.x, eye.y, eye.z, agent.yaw_rad]
        });
        Reach {
            object: found.map(|(object, _)| object),
            distance_m: found.map_or(0.0, |(_, distance_m)| distance_m),
            from,
        }
    }

    /// Returns what an action is done to, if it is done to a thing that others may reach for, too.
    fn contestable_target(&self, step: &AgentAction) -> Option<Target> {
        let kind = step.action.kind();
        // Any number of agents may point at a thing, put something on it, or take hold of its edge.
        let shares = matches!(
            step.action,
            DiscreteAction::Place | DiscreteAction::Point | DiscreteAction::Grip
        );
        if !kind.is_hand_action() || !kind.takes_target() || shares {
            return None;
        }
        match step.target {
            HandTarget::At(target) => Some(target),
            HandTarget::Gaze | HandTarget::Pose(_) => {
                self.object_in_view_centre(step.agent).map(Target::from)
            }
            HandTarget::Nothing => None,
        }
    }

    /// Returns the refusal of a hand whose thing another reaches for from as near.
    pub(super) fn contested_outcome(&self, object: ObjectId) -> ActionOutcome {
        let own = self.house().objects.get(object);
        let name = own.map_or("thing", |own| own.name.as_str());
        let sentence = format!(
            "Another agent reaches for the {name} at the same moment, from as near as you. Step closer, or wait."
        );
        ActionOutcome::failed(OutcomeCode::Contested, sentence, Some(object))
    }
}
