//! Follow the one who makes the described sound, among others who make others.
//!
//! # Source
//! The example of S. Brodeur et al., "HoME: a Household Multimodal Environment", 2017: agents that are told apart by what they sound like.
//! That following is to stay within 2 m is as in the social navigation of X. Puig et al., "Habitat 3.0", 2023.

use super::audio_nav::{check_sounds, play_signal};
use super::others::{
    Patrol, episode_bytes, follower_to, place_anywhere, position, restored_episode,
};
use super::{ExecutedAction, Task, TaskKind, TaskSetup};
use crate::actions::DiscreteAction;
use crate::episode::{Episode, EpisodeGoal, StepResult, TaskMeasure};
use crate::error::WorldError;
use crate::metrics::NavigationMetrics;
use crate::schema;
use crate::sound::{SoundName, SoundPlace};
use crate::world::World;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, LevelId, Pose};
use dwell_semantics::vocabulary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

const NAME: &str = "PiedPiper";
/// The instruction of those who lead.
const PIPER_INSTRUCTION: &str = "Go.";
/// Sounds that have a name in the vocabulary and no pause of more than a second or two.
const SOUNDS: [&str; 5] = ["radio", "vacuum_cleaner", "kettle", "television", "alarm"];
/// A leader walks in one of so many steps, so that others keep up.
const WALKS_EVERY: u64 = 2;
/// Distance at which the scripted follower waits, m.
const KEEP_M: f32 = 1.2;

pub(super) const KIND: TaskKind = TaskKind {
    name: NAME,
    version: 0,
    about: "Follow the one of several moving agents who makes the sound that is named.",
    has_goal: true,
    min_agents: 2,
    goal_parts: &[],
    max_steps: 1000,
    actions: DiscreteAction::DEFAULT,
    sensors: &["rgb", "depth", "audio", "instruction", "instruction_tokens"],
    measures: &[
        TaskMeasure {
            name: "following",
            about: "Share of the steps of the episode's second half, so far, in which the follower was near the right one.",
        },
        TaskMeasure {
            name: "found_step",
            about: "The step in which it was near the right one for the first time.",
        },
    ],
    settings: schema::fields_of::<PiedPiperSettings>,
    build,
};

/// The task's settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct PiedPiperSettings {
    /// The numbers of the agents who lead, each with a sound of its own; default all but agent 0. All others follow.
    pipers: Option<Vec<u32>>,
    /// Signals to draw from, as `dwell.sounds.signals` names them, at least one for each who leads; default five. Those that a thing
    /// of the house makes at the start are drawn last.
    sounds: Vec<String>,
    /// Level at 1 m, dB SPL; default the typical level of each signal.
    level_db: Option<f32>,
    /// Nearer than this is near, straight m; default 2.
    follow_distance_m: f32,
    /// The least share of the second half of the steps near the right one that is success, above 0 to 1; default 0.5.
    success_share: f64,
    /// Whether agents begin on any storey and leaders walk to others; by default all begin on one, drawn by its floor, and leaders keep
    /// to it.
    across_storeys: bool,
    /// Steps of an episode, 2 to 100,000; default 600.
    steps: u64,
}

impl Default for PiedPiperSettings {
    fn default() -> Self {
        Self {
            pipers: None,
            sounds: SOUNDS.map(str::to_owned).to_vec(),
            level_db: None,
            follow_distance_m: 2.0,
            success_share: 0.5,
            across_storeys: false,
            steps: 600,
        }
    }
}

impl PiedPiperSettings {
    fn check(&self) -> Result<(), WorldError> {
        let fault = |field: &'static str, found: String, allowed: &str| {
            Err(WorldError::Config {
                field,
                found,
                allowed: allowed.to_owned(),
            })
        };
        check_sounds(&self.sounds, self.level_db)?;
        let mut names = self.sounds.iter().enumerate();
        if let Some((_, name)) = names.find(|(place, name)| self.sounds[..*place].contains(name)) {
            return fault("sounds", format!("{name:?} twice"), "each signal once");
        }
        if let Some(name) = self.sounds.iter().find(|name| instruction(name).is_err()) {
            return fault(
                "sounds",
                format!("{name:?}"),
                "signals whose names are words of the vocabulary",
            );
        }
        let distance_m = self.follow_distance_m;
        if !(distance_m > 0.0 && distance_m <= 100.0) {
            return fault(
                "follow_distance_m",
                distance_m.to_string(),
                "above 0 to 100",
            );
        }
        if !(self.success_share > 0.0 && self.success_share <= 1.0) {
            return fault(
                "success_share",
                self.success_share.to_string(),
                "above 0 to 1",
            );
        }
        if !(2..=100_000).contains(&self.steps) {
            return fault("steps", self.steps.to_string(), "2 to 100,000");
        }
        Ok(())
    }

    /// The agents who lead, rising.
    fn leaders(&self, world: &World) -> Result<Vec<AgentId>, WorldError> {
        let count = world.state().agents.len();
        let mut leaders: Vec<u32> = match &self.pipers {
            Some(named) => named.clone(),
            None => (1..count as u32).collect(),
        };
        leaders.sort_unstable();
        leaders.dedup();
        let known = leaders.iter().all(|leader| (*leader as usize) < count);
        let most = self.sounds.len().min(count.saturating_sub(1));
        if known && (1..=most).contains(&leaders.len()) {
            return Ok(leaders.into_iter().map(AgentId).collect());
        }
        Err(WorldError::Config {
            field: "pipers",
            found: format!("{leaders:?} of {count} agents, with {} sounds", self.sounds.len()),
            allowed: "numbers of agents, at least one, not all of them, and no more than there are sounds".to_owned(),
        })
    }
}

/// What is asked of a follower.
fn instruction(sound: &str) -> Result<(String, Vec<i32>), WorldError> {
    let text = format!("Go near the {}.", sound.replace('_', " "));
    let tokens = vocabulary::tokenize(&text)?;
    Ok((text, tokens))
}

/// The signals that things of the house make.
fn sounds_of_things(world: &World) -> BTreeSet<String> {
    let own = world.sounds().into_iter();
    let own = own.filter(|sound| sound.on && sound.object.is_some());
    own.filter_map(|own| match own.sound {
        SoundName::Signal(name) => Some(name),
        SoundName::File(_) => None,
    })
    .collect()
}

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let settings: PiedPiperSettings = crate::parse_settings::parse_task_settings(value)?;
    settings.check()?;
    Ok(Box::new(PiedPiperTask {
        settings,
        setup,
        active: None,
    }))
}

#[derive(Debug)]
struct PiedPiperTask {
    settings: PiedPiperSettings,
    setup: TaskSetup,
    active: Option<ActiveEpisode>,
}

#[derive(Debug)]
struct ActiveEpisode {
    /// Whom to follow; of a leader itself.
    target: AgentId,
    leads: bool,
    key: RandomKey,
    tour: Patrol,
    memory: Progress,
}

/// How an episode has gone so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Progress {
    steps: u64,
    /// Steps of the second half near the right one.
    near: u64,
    found: Option<u64>,
    /// Distance to the right one after the last step, m.
    distance_m: f32,
}

impl PiedPiperTask {
    fn distance_m(&self, world: &World, target: AgentId) -> f32 {
        position(world, self.setup.agent).distance(position(world, target))
    }

    /// A storey of the largest piece of floor, as probable as it is large; `None` where nobody can stand.
    fn storey(world: &World, key: RandomKey) -> Result<Option<LevelId>, WorldError> {
        // By the floor of one of them, for all alike.
        let Some(first) = world.state().agents.iter().next() else {
            return Ok(None);
        };
        let grid = world.engines().nav_grid(&first.body)?;
        let cell = grid.sample(key, |cell| grid.island(cell) == Some(0));
        Ok(cell.and_then(|cell| grid.level(cell)))
    }

    /// Steps of the second half so far.
    fn second_half(&self, steps: u64) -> u64 {
        steps.saturating_sub(self.settings.steps / 2)
    }

    fn following(&self, memory: &Progress) -> f64 {
        match self.second_half(memory.steps) {
            0 => f64::NAN,
            half => memory.near as f64 / half as f64,
        }
    }
}

impl Task for PiedPiperTask {
    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn reset(
        &mut self,
        world: &mut World,
        placed: &[AgentId],
        key: RandomKey,
    ) -> Result<Episode, WorldError> {
        let agent = self.setup.agent;
        let leaders = self.settings.leaders(world)?;
        // Of the episode, not of the agent: all know the same sounds and storey.
        let shared = world.episode_key().child("pied_piper");
        let storey = if self.settings.across_storeys {
            None
        } else {
            Self::storey(world, shared.child("storey"))?
        };
        let (position, yaw_rad) =
            place_anywhere(world, placed, (&self.setup, NAME), (storey, key))?;
        let mut sounds = self.settings.sounds.clone();
        shared.child("sounds").stream().shuffle(&mut sounds);
        // "The radio" is the one who leads, and not a thing that plays the same, while there are other sounds.
        let of_things = sounds_of_things(world);
        sounds.sort_by_key(|name| of_things.contains(name));
        let own_place = leaders.iter().position(|leader| *leader == agent);
        let (target, text, tokens) = if let Some(place) = own_place {
            let place_of_sound = (SoundPlace::Agent(agent), self.settings.level_db, true);
            play_signal(world, &sounds[place], place_of_sound)?;
            let tokens = vocabulary::tokenize(PIPER_INSTRUCTION)?;
            (agent, PIPER_INSTRUCTION.to_owned(), tokens)
        } else {
            let chosen = shared.child("target").stream().below(leaders.len());
            let (text, tokens) = instruction(&sounds[chosen])?;
            (leaders[chosen], text, tokens)
        };
        let leads = own_place.is_some();
        self.active = Some(ActiveEpisode {
            target,
            leads,
            key,
            tour: Patrol::on_storey(storey),
            memory: Progress {
                distance_m: self.distance_m(world, target),
                ..Progress::default()
            },
        });
        Ok(Episode {
            agent,
            instruction: text,
            tokens,
            start: Pose::from_position_yaw(position, yaw_rad),
            progress: NavigationMetrics::new(position, None),
            goal: EpisodeGoal {
                kind: if leads { "lead" } else { "follow" },
                ..EpisodeGoal::default()
            },
        })
    }

    fn snapshot(&self) -> Vec<u8> {
        let active = self.active.as_ref();
        active.map_or(Vec::new(), |active| {
            episode_bytes(&active.memory, &active.tour)
        })
    }

    fn restore(&mut self, world: &World, bytes: &[u8]) -> Result<(), WorldError> {
        let (memory, tour) = restored_episode(world, (&self.setup, NAME), bytes)?;
        if let Some(active) = &mut self.active {
            (active.memory, active.tour) = (memory, tour);
        }
        Ok(())
    }

    fn judge(
        &mut self,
        world: &World,
        episode: &mut Episode,
        played: &ExecutedAction<'_>,
    ) -> StepResult {
        let Some(agent) = world.state().agents.get(self.setup.agent) else {
            return StepResult::default();
        };
        episode
            .progress
            .advance(agent.position, None, agent.collided);
        let Some((target, leads)) = self.active.as_ref().map(|own| (own.target, own.leads)) else {
            return StepResult::default();
        };
        let distance_m = self.distance_m(world, target);
        let is_near = distance_m < self.settings.follow_distance_m;
        let half = self.settings.steps / 2;
        let Some(active) = &mut self.active else {
            return StepResult::default();
        };
        let memory = &mut active.memory;
        memory.steps += 1;
        let gain_m = f64::from(memory.distance_m - distance_m);
        memory.distance_m = distance_m;
        if is_near {
            memory.found.get_or_insert(memory.steps);
            memory.near += u64::from(memory.steps > half);
        }
        let memory = *memory;
        let over = memory.steps >= self.settings.steps || played.is_stop();
        if leads {
            return StepResult {
                terminated: over,
                ..StepResult::default()
            };
        }
        let success = memory.steps >= self.settings.steps
            && self.following(&memory) >= self.settings.success_share;
        let bonus = if success { 2.5 } else { 0.0 };
        StepResult {
            reward: gain_m - 0.01 + if is_near { 0.02 } else { 0.0 } + bonus,
            terminated: over,
            success,
        }
    }

    fn measures(&self) -> Vec<f64> {
        let Some(active) = self.active.as_ref().filter(|active| !active.leads) else {
            return vec![f64::NAN; KIND.measures.len()];
        };
        let memory = &active.memory;
        let found = memory.found.map_or(f64::NAN, |step| step as f64);
        vec![self.following(memory), found]
    }

    /// A leader walks from place to place; a follower, who knows where the right one is, to it.
    fn expert(&mut self, world: &mut World, _episode: &Episode) -> DiscreteAction {
        let own = self.setup.agent;
        let Some(active) = &mut self.active else {
            return DiscreteAction::Stop;
        };
        let Some(body) = world.state().agents.get(own).map(|agent| agent.body) else {
            return DiscreteAction::Stop;
        };
        let Ok(grid) = world.engines().nav_grid(&body) else {
            return DiscreteAction::Wait;
        };
        if active.leads {
            if active.memory.steps % WALKS_EVERY != 0 {
                return DiscreteAction::Wait;
            }
            let site = (&self.setup, &grid);
            return active.tour.next_action(world, site, active.key);
        }
        let (here, there) = (position(world, own), position(world, active.target));
        if here.distance(there) < KEEP_M {
            return DiscreteAction::Wait;
        }
        // The right one moves on, and so does its place.
        let cell = grid.nearest(there, 1.0);
        let step =
            cell.and_then(|cell| follower_to(&self.setup, &grid, &[cell]).next_action(world));
        step.unwrap_or(DiscreteAction::Wait)
    }
}
