//! A control step of one discrete action.

use super::{DiscreteAction, StepSizes};
use crate::error::WorldError;
use crate::world::World;
use dwell_physics::{ActionOutcome, AgentControl, OutcomeCode};
use dwell_scene::AgentId;
use serde_json::Map;

impl World {
    /// Makes one control step of one agent's discrete action; all others stand still.
    ///
    /// # Errors
    /// [`WorldError::Usage`] for an agent that does not exist.
    pub fn act_discrete(
        &mut self,
        agent: AgentId,
        action: DiscreteAction,
        stride: &StepSizes,
    ) -> Result<ActionOutcome, WorldError> {
        let outcome = self.use_hand(agent, action)?;
        let mut controls = vec![AgentControl::default(); self.state().agents.len()];
        let Some(control) = controls.get_mut(agent.0 as usize) else {
            return Err(WorldError::Usage(format!(
                "no agent {}; there are {}",
                agent.0,
                controls.len()
            )));
        };
        *control = action.kind().control(stride, self.config().step_s());
        self.step(&controls)?;
        Ok(outcome.unwrap_or_else(|| {
            if self.state().agents[agent].collided {
                let sentence = "Something is in the way. Turn or step aside.";
                ActionOutcome::failed(OutcomeCode::Blocked, sentence, None)
            } else {
                ActionOutcome::done(OutcomeCode::Done, "", None)
            }
        }))
    }

    /// Returns the hand's action on the thing that the agent looks at; `None` for an action of the feet or neck.
    fn use_hand(
        &mut self,
        agent: AgentId,
        action: DiscreteAction,
    ) -> Result<Option<ActionOutcome>, WorldError> {
        let kind = action.kind();
        if !kind.is_of_hand() {
            return Ok(None);
        }
        let mut target = None;
        if kind.takes_target() {
            let Some(object) = self.gaze_target(agent) else {
                let sentence =
                    "You look at nothing that you could take, open or switch. Turn towards it.";
                let outcome = ActionOutcome::failed(OutcomeCode::NoTarget, sentence, None);
                return Ok(Some(outcome));
            };
            target = Some(object.into());
        }
        let action = kind.read(target, Map::new())?;
        Ok(Some(self.act(agent, &*action)))
    }
}
