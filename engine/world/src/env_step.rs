//! The step of an environment: one control step of all its agents together.

use crate::actions::{AgentAction, DiscreteAction, StepAction, StepUtterance};
use crate::env::{Env, no_episode};
use crate::episode::{
    Answer, AnswerField, GoalField, QuestionTokens, StepInfo, StepResult, TaskMeasure,
};
use crate::error::{WorldError, no_agent};
use dwell_acoustics::utterance::{MAX_TOKENS, VocalEffort};
use dwell_scene::AgentId;

impl Env {
    /// Returns whether a step can be made by these actions.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] before the first reset, when all episodes have ended, and where the actions are not one for each
    /// agent whose episode goes on.
    /// [`WorldError::Config`] for numbers out of range.
    pub fn check_can_step<A: Into<StepAction> + Copy>(
        &self,
        actions: &[Option<A>],
    ) -> Result<(), WorldError> {
        if !self.has_episode() {
            return Err(no_episode("step"));
        }
        let callers = self.agents.iter().filter(|agent| !agent.scripted);
        if callers.clone().count() > 0 && callers.clone().all(|agent| agent.done) {
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
        for action in actions.iter().flatten() {
            let action: StepAction = (*action).into();
            action.check()?;
        }
        let mut idle = self.agents.iter().zip(actions);
        match idle.find(|(agent, action)| agent.takes_actions() && action.is_none()) {
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
    /// reports how it ended. Scripted agents act as their experts say.
    ///
    /// Hands act before the step, the nearest to its thing first; nothing depends on the agents' numbers.
    ///
    /// # Errors
    /// Those of [`Self::check_can_step`]; nothing has changed then.
    pub fn step<A: Into<StepAction> + Copy>(
        &mut self,
        actions: &[Option<A>],
    ) -> Result<Vec<StepInfo>, WorldError> {
        self.check_can_step(actions)?;
        let taken = self.taken_actions(actions)?;
        let mut steps: Vec<AgentAction> = Vec::with_capacity(taken.len());
        for (agent, action) in self.agents.iter().zip(&taken) {
            let Some(action) = action else { continue };
            steps.push(agent.world_action(&self.world, action));
            if let Some(utterance) = action.utterance.and_then(|said| said.utterance()) {
                self.world.say(agent.id, utterance)?;
            }
        }
        let outcomes = self.world.step_discrete_actions(&steps)?;
        self.steps += 1;
        let mut outcomes = outcomes.into_iter();
        let mut infos = Vec::with_capacity(self.agents.len());
        for (agent, action) in self.agents.iter_mut().zip(&taken) {
            let info = match action {
                None => agent.step_info_after_end(&self.world),
                Some(action) => outcomes
                    .next()
                    .and_then(|outcome| agent.evaluate_step(&self.world, action, outcome)),
            };
            infos.push(info.ok_or_else(|| no_episode("step"))?);
        }
        self.conclude(&taken, &mut infos);
        for agent in &mut self.agents {
            for sensor in &mut agent.sensors {
                sensor.advance(&self.world)?;
            }
        }
        Ok(infos)
    }

    /// Returns what each agent does; nothing of one whose episode has ended. Shape (agent,).
    fn taken_actions<A: Into<StepAction> + Copy>(
        &mut self,
        actions: &[Option<A>],
    ) -> Result<Vec<Option<StepAction>>, WorldError> {
        let taken = actions.iter().enumerate().map(|(place, action)| {
            let agent = &self.agents[place];
            let is_held_still = agent.task.is_held_still();
            let chosen = match (agent.done, agent.scripted) {
                (true, _) => None,
                (false, true) => Some(self.expert_step(place)?),
                (false, false) => (*action).map(Into::into),
            };
            // Who is held still may speak.
            Ok(chosen.map(|chosen: StepAction| StepAction {
                utterance: chosen.utterance,
                ..if is_held_still {
                    DiscreteAction::Wait.into()
                } else {
                    chosen
                }
            }))
        });
        taken.collect()
    }

    /// Lets the tasks of those who acted look at how the others were judged.
    fn conclude(&mut self, taken: &[Option<StepAction>], infos: &mut [StepInfo]) {
        let verdicts: Vec<(AgentId, StepResult)> = self
            .agents
            .iter()
            .zip(infos.iter())
            .map(|(agent, info)| (agent.id, info.result))
            .collect();
        let acted = self.agents.iter_mut().zip(infos).zip(taken);
        for ((agent, info), _) in acted.filter(|(_, action)| action.is_some()) {
            if let Some(result) = agent.task.conclude(&verdicts) {
                info.result = result;
                agent.apply_step_result(result);
            }
        }
    }

    /// Returns, for each discrete action of each agent, whether nothing known beforehand rules it out: on what it looks at, or where
    /// actions have targets on everything within its reach. What is not ruled out may still fail. All are possible for an agent whose episode has ended. Shape (agent, [`DiscreteAction::ALL`]).
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] before the first reset.
    pub fn action_masks(&mut self) -> Result<Vec<[bool; DiscreteAction::ALL.len()]>, WorldError> {
        if !self.has_episode() {
            return Err(no_episode("action_masks"));
        }
        let mut masks = vec![[true; DiscreteAction::ALL.len()]; self.agents.len()];
        let agents = self.agents.iter().zip(&mut masks);
        for (agent, mask) in agents.filter(|(agent, _)| !agent.done) {
            *mask = self
                .world
                .possible_actions(agent.id, agent.step_sizes, agent.action_mode)?;
        }
        Ok(masks)
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

    /// Returns what each agent's scripted expert would answer now. Shape (agent,).
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] before the first reset.
    pub fn expert_answers(&self) -> Result<Vec<Answer>, WorldError> {
        if !self.has_episode() {
            return Err(no_episode("expert"));
        }
        let agents = self.agents.iter();
        Ok(agents
            .map(|agent| agent.task.expert_answer(&self.world))
            .collect())
    }

    /// Returns what each agent's scripted expert would say now, numbers of words up to the first 0. Shape (agent,).
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] before the first reset.
    pub fn expert_utterances(&self) -> Result<Vec<[u32; MAX_TOKENS]>, WorldError> {
        if !self.has_episode() {
            return Err(no_episode("expert"));
        }
        let agents = self.agents.iter();
        let said = agents.map(|agent| agent.task.expert_utterance(&self.world));
        Ok(said.collect())
    }

    /// Returns what each agent's scripted expert would ask the oracle of its task now. Shape (agent,).
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] before the first reset.
    pub fn expert_questions(&self) -> Result<Vec<QuestionTokens>, WorldError> {
        if !self.has_episode() {
            return Err(no_episode("expert"));
        }
        let agents = self.agents.iter();
        Ok(agents.map(|agent| agent.task.expert_question()).collect())
    }

    /// Returns whether an agent's task has an oracle that takes questions.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not act.
    pub fn takes_questions(&self, agent: usize) -> Result<bool, WorldError> {
        let parts = self.agent(agent)?.kind.goal_parts;
        Ok(parts.contains(&GoalField::Replies))
    }

    /// Returns what the scripted expert of one agent would do now, its answer included.
    ///
    /// # Errors
    /// As [`Self::expert_action`].
    pub fn expert_step(&mut self, agent: usize) -> Result<StepAction, WorldError> {
        let action = self.expert_action(agent)?;
        let task = &self.agents[agent].task;
        let answer = task.expert_answer(&self.world);
        let utterance = StepUtterance {
            tokens: task.expert_utterance(&self.world),
            effort: VocalEffort::Normal,
        };
        Ok(StepAction {
            answer,
            utterance: (utterance.tokens[0] != 0).then_some(utterance),
            question: task.expert_question(),
            ..action.into()
        })
    }

    /// Returns the fields of the answer that an agent's task expects with `stop`.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not act.
    pub fn answer_fields(&self, agent: usize) -> Result<Vec<AnswerField>, WorldError> {
        Ok(self.agent(agent)?.task.answer_fields())
    }

    /// Returns what an agent's task measures beside distance and path.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not act.
    pub fn task_measures(&self, agent: usize) -> Result<&'static [TaskMeasure], WorldError> {
        Ok(self.agent(agent)?.kind.measures)
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
