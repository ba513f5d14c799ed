//! A control step of discrete actions.

use super::{DiscreteAction, StepSizes};
use crate::error::WorldError;
use crate::world::World;
use dwell_physics::{ActionOutcome, AgentControl, OutcomeCode};
use dwell_scene::{AgentId, Id};
use serde_json::Map;

/// A discrete action of one agent in a control step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AgentAction {
    /// The agent.
    pub agent: AgentId,
    /// The action.
    pub action: DiscreteAction,
    /// Lengths and angles of its movement actions.
    pub step_sizes: StepSizes,
}

impl World {
    /// Makes one control step of one agent's discrete action; all others stand still.
    ///
    /// # Errors
    /// Those of [`World::step_discrete_actions`].
    pub fn act_discrete(
        &mut self,
        agent: AgentId,
        action: DiscreteAction,
        stride: &StepSizes,
    ) -> Result<ActionOutcome, WorldError> {
        let stride = *stride;
        let step = AgentAction {
            agent,
            action,
            step_sizes: stride,
        };
        let mut outcomes = self.step_discrete_actions(&[step])?;
        let none = || WorldError::InvalidCall("no action was made".to_owned());
        outcomes.pop().ok_or_else(none)
    }

    /// Makes one control step of several agents' discrete actions, at most one for each; all others stand still. Hands act
    /// before the step, one after the other in the order of the agents' numbers. Returns what became of each.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not exist; nothing has changed then.
    pub fn step_discrete_actions(
        &mut self,
        steps: &[AgentAction],
    ) -> Result<Vec<ActionOutcome>, WorldError> {
        let step_s = self.config().step_s();
        let mut controls = vec![AgentControl::default(); self.state().agents.len()];
        for step in steps {
            let count = controls.len();
            let Some(control) = controls.get_mut(step.agent.index()) else {
                return Err(WorldError::InvalidCall(format!(
                    "no agent {}; there are {count}",
                    step.agent.0
                )));
            };
            *control = step.action.kind().control(&step.step_sizes, step_s);
        }
        let mut order: Vec<usize> = (0..steps.len()).collect();
        order.sort_unstable_by_key(|place| steps[*place].agent);
        let mut hands = vec![None; steps.len()];
        for place in order {
            hands[place] = self.use_hand(steps[place].agent, steps[place].action)?;
        }
        self.step(&controls)?;
        let outcomes = steps.iter().zip(hands);
        Ok(outcomes
            .map(|(step, hand)| hand.unwrap_or_else(|| self.movement_outcome(step.agent)))
            .collect())
    }

    /// Returns what became of an action of the feet or neck in the step that has just been made.
    fn movement_outcome(&self, agent: AgentId) -> ActionOutcome {
        if self.state().agents[agent].collided {
            let sentence = "Something is in the way. Turn or step aside.";
            ActionOutcome::failed(OutcomeCode::Blocked, sentence, None)
        } else {
            ActionOutcome::done(OutcomeCode::Done, "", None)
        }
    }

    /// Returns the hand's action on the thing that the agent looks at; `None` for an action of the feet or neck.
    fn use_hand(
        &mut self,
        agent: AgentId,
        action: DiscreteAction,
    ) -> Result<Option<ActionOutcome>, WorldError> {
        let kind = action.kind();
        if !kind.is_hand_action() {
            return Ok(None);
        }
        let mut target = None;
        if kind.takes_target() {
            let Some(object) = self.object_in_view_centre(agent) else {
                let sentence =
                    "You look at nothing that you could take, open or switch. Turn towards it.";
                let outcome = ActionOutcome::failed(OutcomeCode::NoTarget, sentence, None);
                return Ok(Some(outcome));
            };
            target = Some(object.into());
        }
        let action = kind.parse_hand_action(target, Map::new())?;
        Ok(Some(self.act(agent, &*action)))
    }
}
