//! Several environments stepped together: all views in one submission, results in the caller's buffers.

use crate::actions::{DiscreteAction, StepAction};
use crate::batch_pictures::{self, PendingImages};
use crate::env::Env;
use crate::episode::{Answer, QuestionTokens, StepInfo};
use crate::episode_spec::EpisodeSpec;
use crate::error::WorldError;
use crate::first_use::FirstUse;
use crate::sensors::{Dtype, ObservationBuffer, SensorSpec};
use dwell_acoustics::utterance::MAX_TOKENS;
use dwell_scene::AgentId;
use dwell_scene::interrupt;
use dwell_scene::parallel::Threads;

/// Environments of one make: the same agents act in all, and shapes and types of their observations are the same.
#[derive(Debug)]
pub struct Batch {
    envs: Vec<Env>,
    threads: Threads,
    /// True if pictures are taken while other worlds step.
    overlaps: bool,
    /// Pictures under way, or the error at their start.
    under_way: Vec<Result<PendingImages, WorldError>>,
    /// True for environments whose pictures are under way and still show the world as it is. Shape (environment,).
    is_started: Vec<bool>,
}

/// Waves in which worlds step where pictures overlap with it: the adapter takes those of one while the next steps.
const WAVES: usize = 4;

/// In what two environments differ that a batch cannot join.
fn batch_mismatch(first: &Env, other: &Env) -> Option<&'static str> {
    let (agents, sensors) = (first.agents(), first.sensor_specs());
    if !agents.eq(other.agents()) {
        Some("agents")
    } else if sensors != other.sensor_specs() || first.sensor_agents() != other.sensor_agents() {
        Some("sensors")
    } else {
        None
    }
}

/// One environment of a batch, and what its part of a step came to.
struct EnvSlot<'a, R> {
    env: &'a mut Env,
    active: bool,
    result: Option<Result<R, WorldError>>,
}

impl Batch {
    /// Joins environments.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for none, or for environments whose agents or sensors differ.
    pub fn new(mut envs: Vec<Env>, threads: Threads) -> Result<Self, WorldError> {
        let Some(first) = envs.first() else {
            return Err(WorldError::InvalidCall(
                "a batch needs at least one environment".to_owned(),
            ));
        };
        for (k, env) in envs.iter().enumerate() {
            if let Some(what) = batch_mismatch(first, env) {
                return Err(WorldError::InvalidCall(format!(
                    "environment {k} has other {what} than environment 0"
                )));
            }
        }
        for env in &mut envs {
            env.world.set_threads(threads);
        }
        Ok(Self {
            is_started: vec![false; envs.len()],
            envs,
            threads,
            overlaps: false,
            under_way: Vec::new(),
        })
    }

    /// Sets whether an adapter takes the pictures of worlds that have stepped or begun while others still step. Observations are
    /// the same, of the same step; the error of a picture is returned by [`Self::observe`], which waits for it. A caller that
    /// steps without observing pays for pictures all the same. On the processor nothing changes.
    #[must_use]
    pub fn with_overlapped_rendering(mut self, overlaps: bool) -> Self {
        self.overlaps = overlaps;
        self
    }

    /// The environments.
    pub fn envs(&self) -> &[Env] {
        &self.envs
    }

    /// One environment, for reading.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an environment that does not exist.
    pub fn env(&self, index: usize) -> Result<&Env, WorldError> {
        let count = self.envs.len();
        self.envs.get(index).ok_or_else(|| {
            WorldError::InvalidCall(format!("no environment {index}; there are {count}"))
        })
    }

    /// One environment, to change its world between steps.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an environment that does not exist.
    pub fn env_mut(&mut self, index: usize) -> Result<&mut Env, WorldError> {
        let count = self.envs.len();
        // A world that may be changed has outdated pictures.
        if let Some(is_started) = self.is_started.get_mut(index) {
            *is_started = false;
        }
        self.envs.get_mut(index).ok_or_else(|| {
            WorldError::InvalidCall(format!("no environment {index}; there are {count}"))
        })
    }

    /// Replaces an environment and returns the old one: an episode may begin in another house.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an environment that does not exist or whose agents or sensors differ, [`WorldError::Render`] for
    /// a picture of it that was under way; nothing has changed then.
    pub fn replace_env(&mut self, index: usize, mut env: Env) -> Result<Env, WorldError> {
        if let Some(what) = batch_mismatch(self.env(index)?, &env) {
            let told = format!("put: the {what} differ from those of environment {index}");
            return Err(WorldError::InvalidCall(told));
        }
        // Pictures belong to environments by their indices, and the other one has other indices.
        let mut waiting = self.under_way.iter().flatten();
        if waiting.any(|own| own.env_indices().any(|number| number == index)) {
            self.finish_pictures()?;
        }
        self.is_started[index] = false;
        env.world.set_threads(self.threads);
        Ok(std::mem::replace(&mut self.envs[index], env))
    }

    /// Restores a snapshot in one environment.
    ///
    /// Stopped by [`interrupt`], its episode is over.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an environment that does not exist, and those of [`Env::restore`].
    pub fn restore(&mut self, index: usize, bytes: &[u8]) -> Result<(), WorldError> {
        self.env(index)?;
        let active: Vec<bool> = (0..self.envs.len()).map(|k| k == index).collect();
        self.end_episodes_on_interrupt(&active, |batch| batch.env_mut(index)?.restore(bytes))
    }

    /// Returns what each agent's scripted expert would do now. Shape (environment, agent).
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] before the first reset.
    pub fn expert_actions(&mut self) -> Result<Vec<DiscreteAction>, WorldError> {
        let all = vec![true; self.envs.len()];
        let actions = self.for_active(&all, |_, env| env.expert_actions())?;
        Ok(actions.into_iter().flatten().flatten().collect())
    }

    /// Returns what each agent's scripted expert would answer now. Shape (environment, agent).
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] before the first reset.
    pub fn expert_answers(&self) -> Result<Vec<Answer>, WorldError> {
        let answers = self.envs.iter().map(Env::expert_answers);
        Ok(answers.collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// Returns what each agent's scripted expert would say now, numbers of words up to the first 0. Shape (environment, agent).
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] before the first reset.
    pub fn expert_utterances(&self) -> Result<Vec<[u32; MAX_TOKENS]>, WorldError> {
        let said = self.envs.iter().map(Env::expert_utterances);
        Ok(said.collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// Returns what each agent's scripted expert would ask the oracle of its task now. Shape (environment, agent).
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] before the first reset.
    pub fn expert_questions(&self) -> Result<Vec<QuestionTokens>, WorldError> {
        let asked = self.envs.iter().map(Env::expert_questions);
        Ok(asked.collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// Returns the actions that are not ruled out, as [`Env::action_masks`]; all where no episode has begun. Shape (environment, agent).
    ///
    /// # Errors
    /// [`WorldError`] for an action that cannot be read.
    pub fn action_masks(&mut self) -> Result<Vec<[bool; DiscreteAction::ALL.len()]>, WorldError> {
        let all = vec![true; self.envs.len()];
        let masks = self.for_active(&all, |_, env| {
            if env.has_episode() {
                env.action_masks()
            } else {
                Ok(vec![[true; DiscreteAction::ALL.len()]; env.agents.len()])
            }
        })?;
        Ok(masks.into_iter().flatten().flatten().collect())
    }

    /// Returns who acts in every environment, in the order of actions. Shape (agent,).
    pub fn acting_agents(&self) -> impl ExactSizeIterator<Item = AgentId> + '_ {
        self.envs[0].agents()
    }

    /// Returns what every environment's sensors give, as [`Env::sensor_specs`]. Shape (sensor,).
    pub fn sensor_specs(&self) -> Vec<SensorSpec> {
        self.envs[0].sensor_specs()
    }

    /// Returns whose each sensor is, by the agent's place. Shape (sensor,).
    pub fn sensor_agents(&self) -> Vec<usize> {
        self.envs[0].sensor_agents()
    }

    /// Does `work` in the environments of `active`; then, where that is asked for, their pictures are under way.
    fn run_active_and_render<R: Send>(
        &mut self,
        active: &[bool],
        work: impl Fn(usize, &mut Env) -> Result<R, WorldError> + Sync,
    ) -> Result<Vec<Option<R>>, WorldError> {
        for (is_started, _) in self
            .is_started
            .iter_mut()
            .zip(active)
            .filter(|(_, on)| **on)
        {
            *is_started = false;
        }
        if !self.overlaps {
            return self.for_active(active, work);
        }
        // Pictures that nobody has observed.
        let mut waiting = self.under_way.iter().flatten();
        if waiting.any(|own| own.env_indices().any(|number| active[number])) {
            self.finish_pictures()?;
        }
        let count = self.envs.len();
        let waves = count.div_ceil(self.threads.count()).clamp(1, WAVES);
        let mut results: Vec<Option<R>> = Vec::with_capacity(count);
        let mut fault = None;
        for wave in 0..waves {
            let range = count * wave / waves..count * (wave + 1) / waves;
            let mut own = vec![false; count];
            own[range.clone()].copy_from_slice(&active[range.clone()]);
            match self.for_active(&own, &work) {
                Ok(some) => results.extend(some.into_iter().skip(range.start).take(range.len())),
                Err(error) => {
                    fault.get_or_insert(error);
                    continue;
                }
            }
            self.start_pictures(&own);
        }
        fault.map_or(Ok(results), Err)
    }

    /// Starts the pictures of some environments.
    fn start_pictures(&mut self, which: &[bool]) {
        let chosen = self.envs.iter_mut().enumerate();
        let chosen = chosen.filter(|(number, _)| which[*number]);
        match batch_pictures::start_rendering(chosen, self.threads) {
            Ok(some) => {
                let owners = some.iter().flat_map(PendingImages::env_indices);
                for number in owners {
                    self.is_started[number] = true;
                }
                self.under_way.extend(some.into_iter().map(Ok));
            }
            // One error is kept, however many steps nobody observes.
            Err(_) if self.under_way.iter().any(Result::is_err) => {}
            Err(error) => self.under_way.push(Err(error)),
        }
    }

    /// Waits for all pictures that are under way.
    fn finish_pictures(&mut self) -> Result<(), WorldError> {
        let mut finished = Ok(());
        for under_way in std::mem::take(&mut self.under_way) {
            let own = under_way.and_then(|own| own.finish(&mut self.envs, self.threads));
            finished = finished.and(own);
        }
        if finished.is_err() {
            self.is_started.fill(false);
        }
        finished
    }

    fn for_active<R: Send>(
        &mut self,
        active: &[bool],
        work: impl Fn(usize, &mut Env) -> Result<R, WorldError> + Sync,
    ) -> Result<Vec<Option<R>>, WorldError> {
        let threads = self.threads;
        let mut slots: Vec<EnvSlot<'_, R>> = self
            .envs
            .iter_mut()
            .zip(active)
            .map(|(env, active)| EnvSlot {
                env,
                active: *active,
                result: None,
            })
            .collect();
        threads.for_each(&mut slots, |k, slot| {
            if slot.active {
                slot.result = Some(work(k, slot.env));
            }
        });
        slots
            .into_iter()
            .map(|slot| slot.result.transpose())
            .collect()
    }

    fn check_count(&self, what: &str, found: usize) -> Result<(), WorldError> {
        if found == self.envs.len() {
            return Ok(());
        }
        Err(WorldError::InvalidCall(format!(
            "{what}: expected one for each of {} environments, found {found}",
            self.envs.len()
        )))
    }

    /// Does `work` in the environments of `active`. Where it is stopped, some have done it, some half and some not at all:
    /// then the episodes of all of them are over (a reset sets all of a world anew), and what was under way is forgotten.
    fn end_episodes_on_interrupt<R>(
        &mut self,
        active: &[bool],
        work: impl FnOnce(&mut Self) -> Result<R, WorldError>,
    ) -> Result<R, WorldError> {
        interrupt::catch_interrupt(|| work(self)).unwrap_or_else(|interrupted| {
            let stopped = self.envs.iter_mut().zip(active).filter(|(_, on)| **on);
            stopped.for_each(|(env, _)| env.clear_episodes());
            self.under_way.clear();
            self.is_started.fill(false);
            interrupted.resume_unwind()
        })
    }

    /// Starts new episodes where `seeds` has one; the others go on.
    ///
    /// Stopped by [`interrupt`], no episode runs where one was to start.
    ///
    /// # Errors
    /// [`WorldError`] of the first environment that cannot start.
    pub fn reset(&mut self, seeds: &[Option<u64>]) -> Result<(), WorldError> {
        self.reset_stated(seeds, &vec![Vec::new(); seeds.len()])
    }

    /// [`Self::reset`], where episodes state some of what is drawn else, as [`Env::reset_stated`] takes it. Shape (environment, agent),
    /// or (environment, 0).
    ///
    /// # Errors
    /// As [`Self::reset`].
    pub fn reset_stated(
        &mut self,
        seeds: &[Option<u64>],
        specs: &[Vec<EpisodeSpec>],
    ) -> Result<(), WorldError> {
        self.check_count("seeds", seeds.len())?;
        self.check_count("stated episodes", specs.len())?;
        let active: Vec<bool> = seeds.iter().map(Option::is_some).collect();
        let reset = |k: usize, env: &mut Env| {
            env.reset_stated_with_listeners(seeds[k].unwrap_or_default(), &specs[k])
        };
        let beginning = self.envs.iter().zip(&active).filter(|(_, on)| **on);
        let first_use = FirstUse::of(beginning.map(|(env, _)| env));
        self.end_episodes_on_interrupt(&active, |batch| {
            if first_use.is_empty() {
                return batch.run_active_and_render(&active, reset).map(|_| ());
            }
            let threads = batch.threads;
            let make = || first_use.make(threads);
            threads
                .join(make, || batch.run_active_and_render(&active, reset))
                .1?;
            Ok(())
        })
    }

    /// Steps the environments for which `actions` has any.
    ///
    /// `actions`: shape (environment, agent); those of an environment as [`Env::step`] takes them, or all none: it stays as it is.
    /// Returns what each agent's step came to, of the same shape; none for those of environments that stay.
    ///
    /// Stopped by [`interrupt`], the episodes of all of them are over: reset them.
    ///
    /// # Errors
    /// Those of [`Env::check_can_step`] for any environment; then none is stepped.
    pub fn step<A: Into<StepAction> + Copy + Sync>(
        &mut self,
        actions: &[Option<A>],
    ) -> Result<Vec<Option<StepInfo>>, WorldError> {
        let agents = self.acting_agents().len();
        if actions.len() != self.envs.len() * agents {
            return Err(WorldError::InvalidCall(format!(
                "actions: expected one for each of {agents} agents in each of {} environments, found {}",
                self.envs.len(),
                actions.len()
            )));
        }
        let own: Vec<&[Option<A>]> = actions.chunks(agents).collect();
        let active: Vec<bool> = own
            .iter()
            .map(|own| own.iter().any(Option::is_some))
            .collect();
        for ((env, own), _) in self
            .envs
            .iter()
            .zip(&own)
            .zip(&active)
            .filter(|(_, on)| **on)
        {
            env.check_can_step(own)?;
        }
        let infos = self.end_episodes_on_interrupt(&active, |batch| {
            batch.run_active_and_render(&active, |k, env| {
                let infos = env.step(own[k])?;
                env.enable_listeners()?;
                Ok(infos)
            })
        })?;
        let rows = infos.into_iter().flat_map(|infos| match infos {
            Some(infos) => infos.into_iter().map(Some).collect(),
            None => vec![None; agents],
        });
        Ok(rows.collect())
    }

    /// Writes the observations of the environments in `which`: all their views in one submission.
    ///
    /// `outs`: one for each sensor, in order, each with the elements of all environments one after the other (for text:
    /// use [`Self::text_observations`], and give an empty buffer).
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for wrong counts or lengths, [`WorldError::Render`] for what went wrong with a picture, also
    /// with one that an earlier call has started.
    pub fn observe(
        &mut self,
        which: &[bool],
        outs: &mut [ObservationBuffer<'_>],
    ) -> Result<(), WorldError> {
        self.check_count("which", which.len())?;
        let specs = self.sensor_specs();
        if outs.len() != specs.len() {
            return Err(WorldError::InvalidCall(format!(
                "observe: {} buffers for {} sensors",
                outs.len(),
                specs.len()
            )));
        }
        // Episodes go on whatever stops this: worlds are only read.
        self.end_episodes_on_interrupt(&vec![false; self.envs.len()], |batch| {
            batch.finish_pictures()?;
            let chosen = batch.envs.iter_mut().enumerate();
            let chosen = chosen.filter(|(number, _)| which[*number] && !batch.is_started[*number]);
            batch_pictures::render_images(chosen, batch.threads)
        })?;
        for (is_started, _) in self.is_started.iter_mut().zip(which).filter(|(_, on)| **on) {
            *is_started = false;
        }
        for (k, env) in self.envs.iter().enumerate().filter(|(k, _)| which[*k]) {
            for (s, (spec, out)) in specs.iter().zip(outs.iter_mut()).enumerate() {
                let range = k * spec.len()..(k + 1) * spec.len();
                let fault = || {
                    WorldError::InvalidCall(format!(
                        "observe: the buffer of {} is too short or of another type",
                        spec.name
                    ))
                };
                let part = match (spec.dtype, out) {
                    (Dtype::Uint8, ObservationBuffer::Uint8(out)) => {
                        ObservationBuffer::Uint8(out.get_mut(range).ok_or_else(fault)?)
                    }
                    (Dtype::Float32, ObservationBuffer::Float32(out)) => {
                        ObservationBuffer::Float32(out.get_mut(range).ok_or_else(fault)?)
                    }
                    (Dtype::Int32, ObservationBuffer::Int32(out)) => {
                        ObservationBuffer::Int32(out.get_mut(range).ok_or_else(fault)?)
                    }
                    (Dtype::Text, _) => continue,
                    _ => return Err(fault()),
                };
                env.observe(s, part)?;
            }
        }
        Ok(())
    }

    /// The text of sensor `sensor` in every environment; empty before its first reset.
    pub fn text_observations(&self, sensor: usize) -> Vec<String> {
        let mut texts = vec![String::new(); self.envs.len()];
        for (env, text) in self
            .envs
            .iter()
            .zip(&mut texts)
            .filter(|(env, _)| env.has_episode())
        {
            if let Err(error) = env.observe(sensor, ObservationBuffer::Text(text)) {
                tracing::warn!(%error, "no text");
            }
        }
        texts
    }
}
