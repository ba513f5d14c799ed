//! The step of an environment: one control step of all its agents together.

use crate::actions::{AgentAction, DiscreteAction};
use crate::env::{Env, no_agent, no_episode};
use crate::episode::StepInfo;
use crate::error::WorldError;

impl Env {
    /// Returns whether a step can be made by these actions.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] before the first reset, when all episodes have ended, and where the actions are not one for each
    /// agent whose episode goes on.
    pub fn check_can_step(&self, actions: &[Option<DiscreteAction>]) -> Result<(), WorldError> {
        if !self.has_episode() {
            return Err(no_episode("step"));
        }
        if self.agents.iter().all(|agent| agent.done) {
            let what = "step: the episode has ended; call reset first";
            return Err(WorldError::InvalidCall(what.to_owned()));
        }
        if actions.len() != self.agents.len() {
            return Err(WorldError::InvalidCall(format!(
                "step: expected one action for each of {} agents, found {}",
                self.agents.len(),
                actions.len()
            )));
        }
        let mut idle = self.agents.iter().zip(actions);
        match idle.find(|(agent, action)| !agent.done && action.is_none()) {
            None => Ok(()),
            Some((agent, _)) => Err(WorldError::InvalidCall(format!(
                "step: no action for agent {}, whose episode goes on",
                agent.id.0
            ))),
        }
    }

    /// Makes one control step of all agents together, without looking: a [`Batch`](crate::Batch) observes afterwards.
    ///
    /// `actions`: shape (agent,). Of an agent whose episode has ended none is looked at; it stands still, is paid nothing and
    /// reports how it ended.
    ///
    /// Hands act before the step, in the order of the agents' numbers.
    ///
    /// # Errors
    /// Those of [`Self::check_can_step`]; nothing has changed then.
    pub fn step(
        &mut self,
        actions: &[Option<DiscreteAction>],
    ) -> Result<Vec<StepInfo>, WorldError> {
        self.check_can_step(actions)?;
        let acting = self.agents.iter().zip(actions);
        let acting = acting.filter(|(agent, _)| !agent.done);
        let steps: Vec<AgentAction> = acting
            .filter_map(|(agent, action)| {
                Some(AgentAction {
                    agent: agent.id,
                    action: (*action)?,
                    step_sizes: agent.step_sizes,
                })
            })
            .collect();
        let outcomes = self.world.step_discrete_actions(&steps)?;
        self.steps += 1;
        let mut done = steps.into_iter().zip(outcomes);
        let mut infos = Vec::with_capacity(self.agents.len());
        for agent in &mut self.agents {
            let info = if agent.done {
                agent.step_info_after_end()
            } else {
                done.next()
                    .and_then(|(step, outcome)| agent.judge(&self.world, step.action, outcome))
            };
            infos.push(info.ok_or_else(|| no_episode("step"))?);
        }
        for agent in &mut self.agents {
            for sensor in &mut agent.sensors {
                sensor.advance(&self.world)?;
            }
        }
        Ok(infos)
    }

    /// Returns what each agent's scripted expert would do now. Shape (agent,).
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] before the first reset.
    pub fn expert_actions(&mut self) -> Result<Vec<DiscreteAction>, WorldError> {
        (0..self.agents.len())
            .map(|agent| self.expert_action(agent))
            .collect()
    }

    /// Returns what the scripted expert of one agent would do now.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not act, and before the first reset.
    pub fn expert_action(&mut self, agent: usize) -> Result<DiscreteAction, WorldError> {
        let count = self.agents.len();
        let own = self.agents.get_mut(agent);
        let own = own.ok_or_else(|| no_agent(agent, count))?;
        let episode = own.episode.as_ref().ok_or_else(|| no_episode("expert"))?;
        Ok(own.task.expert(&mut self.world, episode))
    }
}
