//! Hiders stay out of the seekers' sight; seekers find them.
//!
//! # Source
//! Rewards, and seekers who cannot move at first, as in B. Baker et al., "Emergent Tool Use From Multi-Agent Autocurricula", ICLR 2020
//! (arXiv:1909.07528): in each step hiders get 1 if all of them are hidden and -1 if one is seen, seekers the reverse.

mod hiding_place;
mod settings;

use super::others::{
    Patrol, episode_bytes, follower_to, place_anywhere, position, restored_episode, sees,
};
use super::{ExecutedAction, Task, TaskKind, TaskSetup};
use crate::actions::DiscreteAction;
use crate::episode::{Episode, EpisodeGoal, StepResult, TaskMeasure};
use crate::error::WorldError;
use crate::expert::{ShortestPathFollower, action_towards_point};
use crate::metrics::NavigationMetrics;
use crate::schema;
use crate::world::World;
use dwell_scene::navigation::NavGrid;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, AgentState, Pose};
use dwell_semantics::vocabulary;
use glam::Vec3;
use hiding_place::hiding_place;
use serde::{Deserialize, Serialize};
use settings::{HideAndSeekSettings, SeekerExpert, Teams};
use std::sync::Arc;

const NAME: &str = "HideAndSeek";
const HIDER_INSTRUCTION: &str = "Go where you are not seen.";
const SEEKER_INSTRUCTION: &str = "Find the others.";
/// Share of the steps of the wait within which the scripted hider wants to be at its place, if it walked straight: it turns and opens
/// doors meanwhile.
const WALKING_SHARE: f64 = 0.5;
/// Turns of a scripted seeker that looks around.
const LOOK_AROUND_RAD: f32 = std::f32::consts::TAU;

pub(super) const KIND: TaskKind = TaskKind {
    name: NAME,
    version: 0,
    about: "Hiders stay out of sight; seekers, who wait at first, are to see them.",
    has_goal: true,
    min_agents: 2,
    goal_parts: &[],
    max_steps: 1000,
    actions: DiscreteAction::DEFAULT,
    sensors: &["rgb", "depth", "gps", "compass", "instruction_tokens"],
    measures: &[
        TaskMeasure {
            name: "hidden_share",
            about: "Share of the steps after the wait in which all hiders were hidden.",
        },
        TaskMeasure {
            name: "first_found_step",
            about: "The step in which a hider was seen for the first time.",
        },
        TaskMeasure {
            name: "found_share",
            about: "Share of the hiders that have been seen so far.",
        },
    ],
    settings: schema::fields_of::<HideAndSeekSettings>,
    build,
};

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let settings: HideAndSeekSettings = crate::parse_settings::parse_task_settings(value)?;
    settings.check()?;
    Ok(Box::new(HideAndSeekTask {
        settings,
        setup,
        active: None,
    }))
}

#[derive(Debug)]
struct HideAndSeekTask {
    settings: HideAndSeekSettings,
    setup: TaskSetup,
    active: Option<ActiveEpisode>,
}

#[derive(Debug)]
struct ActiveEpisode {
    teams: Teams,
    key: RandomKey,
    tour: Patrol,
    /// The way of the scripted hider.
    way: Option<ShortestPathFollower>,
    memory: Progress,
}

/// How an episode has gone so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Progress {
    steps: u64,
    /// Steps after the wait in which all were hidden.
    hidden: u64,
    /// The step in which the first was found.
    first: Option<u64>,
    /// Who has been found. Shape (hider,).
    found: Vec<bool>,
    /// Where the scripted hider hides, m.
    place: Option<[f32; 3]>,
    /// How far the scripted seeker is still to look around, rad.
    look_around_rad: f32,
}

impl Progress {
    fn has_found_all(&self) -> bool {
        self.found.iter().all(|found| *found)
    }
}

impl HideAndSeekTask {
    fn seeks(&self, teams: &Teams) -> bool {
        teams.seekers.contains(&self.setup.agent)
    }

    fn seeker_sees(&self, world: &World, seeker: AgentId, hider: AgentId) -> bool {
        let (half_view_rad, most_m) =
            (self.settings.half_view_rad(), self.settings.view_distance_m);
        sees(world, (seeker, hider), half_view_rad, most_m)
    }

    /// Returns whether each hider is seen by a seeker. Shape (hider,).
    fn seen(&self, world: &World, teams: &Teams) -> Vec<bool> {
        let is_seen = |hider: &AgentId| {
            let mut seekers = teams.seekers.iter();
            seekers.any(|seeker| self.seeker_sees(world, *seeker, *hider))
        };
        teams.hiders.iter().map(is_seen).collect()
    }

    /// Returns whether the seekers still wait.
    fn waits(&self, memory: &Progress) -> bool {
        memory.steps < self.settings.wait_steps
    }

    /// The scripted hider goes to its place and stays there.
    fn hide(&mut self, world: &World, grid: &Arc<NavGrid>) -> DiscreteAction {
        let own = self.setup.agent;
        let (Some(active), Some(agent)) = (&mut self.active, world.state().agents.get(own)) else {
            return DiscreteAction::Wait;
        };
        if active.way.is_none() {
            if active.memory.place.is_none() {
                let here = grid.nearest(agent.position, 0.6);
                let field = here.map(|cell| grid.distance_field(&[cell]));
                let steps = (self.settings.wait_steps as f64).max(40.0);
                let most_m = WALKING_SHARE * steps * f64::from(self.setup.stride.forward_m);
                let seekers = active.teams.seekers.iter();
                let seekers: Vec<Vec3> = seekers.map(|id| position(world, *id)).collect();
                let place = hiding_place(
                    world,
                    grid,
                    (agent, &seekers),
                    self.settings.view_distance_m,
                    |cell| {
                        let way_m = field.as_ref().and_then(|field| field.at(cell));
                        way_m.is_some_and(|way_m| way_m <= most_m)
                    },
                    active.key.child("hide"),
                );
                let place = place.map_or(agent.position, |cell| grid.position(cell));
                active.memory.place = Some(place.to_array());
            }
            let place = active.memory.place.map(Vec3::from_array);
            let cell = place.and_then(|place| grid.nearest(place, 0.6));
            active.way = cell.map(|cell| follower_to(&self.setup, grid, &[cell]));
        }
        let step = active.way.as_mut().and_then(|way| way.next_action(world));
        step.unwrap_or(DiscreteAction::Wait)
    }

    /// The scripted seeker that knows the hiders' places: to the nearest that was not found, or else to the nearest, so that it stays seen.
    fn chase(&self, world: &World, grid: &Arc<NavGrid>) -> DiscreteAction {
        let Some(active) = &self.active else {
            return DiscreteAction::Wait;
        };
        let here = position(world, self.setup.agent);
        let hiders = active.teams.hiders.iter().zip(&active.memory.found);
        let distances = hiders.map(|(hider, found)| {
            let there = position(world, *hider);
            (*found, there.distance(here), there, *hider)
        });
        let nearest = distances.min_by(|a, b| {
            (a.0, a.1)
                .partial_cmp(&(b.0, b.1))
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        let Some((.., there, hider)) = nearest else {
            return DiscreteAction::Wait;
        };
        let most_m = self.settings.view_distance_m;
        if sees(
            world,
            (self.setup.agent, hider),
            std::f32::consts::PI,
            most_m,
        ) {
            let head = world
                .state()
                .agents
                .get(hider)
                .map(AgentState::eye_position);
            let turn = head.and_then(|head| {
                action_towards_point(world, self.setup.agent, head, &self.setup.stride)
            });
            return turn.unwrap_or(DiscreteAction::Wait);
        }
        let cell = grid.nearest(there, 1.0);
        let step = cell.and_then(|cell| follower_to(&self.setup, grid, &[cell]).next_action(world));
        step.unwrap_or(DiscreteAction::Wait)
    }

    /// The scripted seeker that knows the house alone: from place to place, with a look around at each.
    fn tour(&mut self, world: &World, grid: &Arc<NavGrid>) -> DiscreteAction {
        let turn_rad = self.setup.stride.turn_deg.to_radians();
        let Some(active) = &mut self.active else {
            return DiscreteAction::Wait;
        };
        if active.memory.look_around_rad > 0.0 {
            active.memory.look_around_rad -= turn_rad;
            return DiscreteAction::TurnLeft;
        }
        let site = (&self.setup, grid);
        let step = active.tour.next_action(world, site, active.key);
        if step == DiscreteAction::Wait {
            // A new place was chosen: it has come to the last one.
            active.memory.look_around_rad = LOOK_AROUND_RAD;
        }
        step
    }
}

impl Task for HideAndSeekTask {
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
        let teams = Teams::of(&self.settings, world)?;
        let (position, yaw_rad) = place_anywhere(world, placed, (&self.setup, NAME), (None, key))?;
        let seeks = self.seeks(&teams);
        let text = if seeks {
            SEEKER_INSTRUCTION
        } else {
            HIDER_INSTRUCTION
        };
        let memory = Progress {
            found: vec![false; teams.hiders.len()],
            ..Progress::default()
        };
        self.active = Some(ActiveEpisode {
            teams,
            key,
            tour: Patrol::default(),
            way: None,
            memory,
        });
        Ok(Episode {
            agent,
            tokens: vocabulary::tokenize(text)?,
            instruction: text.to_owned(),
            start: Pose::from_position_yaw(position, yaw_rad),
            progress: NavigationMetrics::new(position, None),
            goal: EpisodeGoal {
                kind: if seeks { "seek" } else { "hide" },
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
        let (memory, tour): (Progress, Patrol) =
            restored_episode(world, (&self.setup, NAME), bytes)?;
        if let Some(active) = &mut self.active {
            if memory.found.len() != active.teams.hiders.len() {
                let why = "it is of an episode with another number of hiders";
                return Err(WorldError::Snapshot(why.to_owned()));
            }
            (active.memory, active.tour, active.way) = (memory, tour, None);
        }
        Ok(())
    }

    fn is_held_still(&self) -> bool {
        let active = self.active.as_ref();
        active.is_some_and(|active| self.seeks(&active.teams) && self.waits(&active.memory))
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
        let Some(active) = &self.active else {
            return StepResult::default();
        };
        let (seeks, waited) = (self.seeks(&active.teams), self.waits(&active.memory));
        let seen = if waited {
            vec![false; active.teams.hiders.len()]
        } else {
            self.seen(world, &active.teams)
        };
        let Some(active) = &mut self.active else {
            return StepResult::default();
        };
        let memory = &mut active.memory;
        memory.steps += 1;
        let hidden = !seen.contains(&true);
        if !hidden {
            memory.first.get_or_insert(memory.steps);
        }
        memory.hidden += u64::from(hidden && !waited);
        for (found, seen) in memory.found.iter_mut().zip(&seen) {
            *found |= seen;
        }
        let all = memory.has_found_all();
        let over = all || memory.steps >= self.settings.steps;
        StepResult {
            reward: match (waited, hidden == seeks) {
                (true, _) => 0.0,
                (false, true) => -1.0,
                (false, false) => 1.0,
            },
            terminated: over || played.is_stop(),
            success: over && all == seeks,
        }
    }

    fn measures(&self) -> Vec<f64> {
        let Some(active) = &self.active else {
            return vec![f64::NAN; KIND.measures.len()];
        };
        let memory = &active.memory;
        let hunted = memory.steps.saturating_sub(self.settings.wait_steps);
        let found = memory.found.iter().filter(|found| **found).count();
        vec![
            if hunted == 0 {
                f64::NAN
            } else {
                memory.hidden as f64 / hunted as f64
            },
            memory.first.map_or(f64::NAN, |step| step as f64),
            found as f64 / memory.found.len() as f64,
        ]
    }

    /// A hider goes to the place that is seen least, and stays; a seeker to the nearest hider, or from place to place.
    fn expert(&mut self, world: &mut World, _episode: &Episode) -> DiscreteAction {
        let agents = &world.state().agents;
        let (Some(body), Some(active)) = (
            agents.get(self.setup.agent).map(|own| own.body),
            &self.active,
        ) else {
            return DiscreteAction::Stop;
        };
        let Ok(grid) = world.engines().nav_grid(&body) else {
            return DiscreteAction::Wait;
        };
        if !self.seeks(&active.teams) {
            return self.hide(world, &grid);
        }
        if self.waits(&active.memory) {
            return DiscreteAction::Wait;
        }
        match self.settings.seeker_expert {
            SeekerExpert::Knows => self.chase(world, &grid),
            SeekerExpert::Tours => self.tour(world, &grid),
        }
    }
}
