//! Find a person who walks about, and follow it without bumping into anybody.
//!
//! # Source
//! Social navigation of X. Puig et al., "Habitat 3.0: A Co-Habitat for Humans, Avatars and Robots", 2023: find the person, then keep 1 to 2 m away and
//! look at it. The names of the measures follow those of habitat-lab's `SocialNavStats`.

use super::others::{
    Patrol, episode_bytes, follower_to, place_anywhere, position, restored_episode, sees,
};
use super::{ExecutedAction, Task, TaskKind, TaskSetup};
use crate::actions::DiscreteAction;
use crate::episode::{Episode, EpisodeGoal, StepResult, TaskMeasure};
use crate::error::WorldError;
use crate::metrics::NavigationMetrics;
use crate::schema;
use crate::world::World;
use dwell_scene::math;
use dwell_scene::navigation::NavCell;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, Pose};
use dwell_semantics::vocabulary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f32::consts::FRAC_PI_4;

const NAME: &str = "SocialNav";
const INSTRUCTION: &str = "Find the person.";
const PERSON_INSTRUCTION: &str = "Go.";
/// Distances of following, m.
const BAND_M: [f32; 2] = [1.0, 2.0];
/// A person is found within this distance, in view, m.
const FOUND_M: f32 = 2.0;
/// Half of the angle of view in which somebody counts as seen, rad.
const HALF_VIEW_RAD: f32 = FRAC_PI_4;
/// Gap between two bodies up to which they touch, m.
const TOUCH_M: f32 = 0.03;
/// A person walks in one of so many steps, so that a robot keeps up.
const WALKS_EVERY: u64 = 2;
/// The scripted follower comes nearer above this distance, m.
const KEEP_M: f32 = 1.5;
/// Distances below which it begins to make way, and above which it has made way, m.
const MAKE_WAY_M: [f32; 2] = [1.0, 1.35];
/// Distances of the places to which it makes way, m.
const ASIDE_M: [f32; 2] = [1.5, 1.9];
/// Turn that the scripted follower leaves, rad.
const AIM_RAD: f32 = 0.2;

pub(super) const KIND: TaskKind = TaskKind {
    name: NAME,
    version: 0,
    about: "Find a person who walks about, and follow it at 1 to 2 m without bumping into anybody.",
    has_goal: true,
    min_agents: 2,
    goal_parts: &[],
    max_steps: 1500,
    actions: DiscreteAction::DEFAULT,
    sensors: &["rgb", "depth", "semantic", "gps", "compass"],
    measures: &[
        TaskMeasure {
            name: "found_step",
            about: "The step in which the person was found: within 2 m and in view.",
        },
        TaskMeasure {
            name: "following",
            about: "Share of the steps since then in which the robot followed: 1 to 2 m away, with the person in view.",
        },
        TaskMeasure {
            name: "bumps",
            about: "Steps in which it touched somebody.",
        },
    ],
    settings: schema::fields_of::<SocialNavSettings>,
    build,
};

/// The task's settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct SocialNavSettings {
    /// The number of the agent who is the person; default 1. All others are to find it.
    person: u32,
    /// The least share of the steps since it was found in which it was followed that is success, above 0 to 1; default 0.5.
    success_share: f64,
    /// Steps of an episode, 2 to 100,000; default 800.
    steps: u64,
}

impl Default for SocialNavSettings {
    fn default() -> Self {
        Self {
            person: 1,
            success_share: 0.5,
            steps: 800,
        }
    }
}

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let settings: SocialNavSettings = crate::parse_settings::parse_task_settings(value)?;
    let fault = |field: &'static str, found: String, allowed: &str| {
        Err(WorldError::Config {
            field,
            found,
            allowed: allowed.to_owned(),
        })
    };
    if !(settings.success_share > 0.0 && settings.success_share <= 1.0) {
        let found = settings.success_share.to_string();
        return fault("success_share", found, "above 0 to 1");
    }
    if !(2..=100_000).contains(&settings.steps) {
        return fault("steps", settings.steps.to_string(), "2 to 100,000");
    }
    Ok(Box::new(SocialNavTask {
        settings,
        setup,
        active: None,
    }))
}

#[derive(Debug)]
struct SocialNavTask {
    settings: SocialNavSettings,
    setup: TaskSetup,
    active: Option<ActiveEpisode>,
}

#[derive(Debug)]
struct ActiveEpisode {
    key: RandomKey,
    tour: Patrol,
    memory: Progress,
}

/// How an episode has gone so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Progress {
    steps: u64,
    found: Option<u64>,
    /// Steps since it was found in which it was followed.
    followed: u64,
    bumps: u64,
    /// Whether the scripted follower is making way.
    makes_way: bool,
    /// Distance to the person after the last step, m.
    distance_m: f32,
}

impl Progress {
    /// Share of the steps since it was found in which it was followed; NaN before.
    fn following(&self) -> f64 {
        self.found.map_or(f64::NAN, |found| {
            self.followed as f64 / (self.steps + 1 - found) as f64
        })
    }
}

impl SocialNavTask {
    fn person(&self) -> AgentId {
        AgentId(self.settings.person)
    }

    fn is_person(&self) -> bool {
        self.setup.agent == self.person()
    }

    fn distance_m(&self, world: &World) -> f32 {
        position(world, self.setup.agent).distance(position(world, self.person()))
    }

    /// Returns whether the agent touches another one.
    fn bumps(&self, world: &World) -> bool {
        let agents = &world.state().agents;
        let Some(own) = agents.get(self.setup.agent) else {
            return false;
        };
        agents.iter_ids().any(|(id, other)| {
            let apart_m = (own.position - other.position).with_y(0.0).length();
            let touch_m = own.body.radius_m + other.body.radius_m + TOUCH_M;
            id != self.setup.agent && apart_m < touch_m
        })
    }

    /// The turn that brings the person into the middle of the view; `None` once it is there.
    fn face_person(&self, world: &World) -> Option<DiscreteAction> {
        let own = world.state().agents.get(self.setup.agent)?;
        let way = position(world, self.person()) - own.position;
        let turn = math::wrap_angle(dwell_scene::space::yaw_from_forward(way) - own.yaw_rad);
        (turn.abs() > AIM_RAD).then_some(if turn > 0.0 {
            DiscreteAction::TurnLeft
        } else {
            DiscreteAction::TurnRight
        })
    }
}

impl Task for SocialNavTask {
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
        let count = world.state().agents.len();
        if self.settings.person as usize >= count {
            return Err(WorldError::Config {
                field: "person",
                found: self.settings.person.to_string(),
                allowed: format!("below the number of agents, {count}"),
            });
        }
        let (position, yaw_rad) = place_anywhere(world, placed, (&self.setup, NAME), (None, key))?;
        let text = if self.is_person() {
            PERSON_INSTRUCTION
        } else {
            INSTRUCTION
        };
        self.active = Some(ActiveEpisode {
            key,
            tour: Patrol::default(),
            memory: Progress {
                // Who is placed first does not know yet where the person begins.
                distance_m: f32::INFINITY,
                ..Progress::default()
            },
        });
        Ok(Episode {
            agent,
            tokens: vocabulary::tokenize(text)?,
            instruction: text.to_owned(),
            start: Pose::from_position_yaw(position, yaw_rad),
            progress: NavigationMetrics::new(position, None),
            goal: EpisodeGoal {
                kind: if self.is_person() { "walk" } else { "follow" },
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
        let (own, person) = (self.setup.agent, self.person());
        let Some(agent) = world.state().agents.get(own) else {
            return StepResult::default();
        };
        episode
            .progress
            .advance(agent.position, None, agent.collided);
        let (is_person, distance_m) = (self.is_person(), self.distance_m(world));
        let bumps = self.bumps(world);
        let in_view = !is_person && sees(world, (own, person), HALF_VIEW_RAD, 10.0);
        let Some(active) = &mut self.active else {
            return StepResult::default();
        };
        let memory = &mut active.memory;
        memory.steps += 1;
        let over = memory.steps >= self.settings.steps || played.is_stop();
        if is_person {
            return StepResult {
                terminated: over,
                ..StepResult::default()
            };
        }
        let gain_m = if memory.distance_m.is_finite() && distance_m > BAND_M[1] {
            f64::from(memory.distance_m - distance_m)
        } else {
            0.0
        };
        memory.distance_m = distance_m;
        memory.bumps += u64::from(bumps);
        if in_view && distance_m < FOUND_M {
            memory.found.get_or_insert(memory.steps);
        }
        let follows = in_view && (BAND_M[0]..=BAND_M[1]).contains(&distance_m);
        memory.followed += u64::from(follows && memory.found.is_some());
        let success = memory.steps >= self.settings.steps
            && memory.following() >= self.settings.success_share;
        let parts = [
            gain_m,
            -0.01,
            if follows { 0.02 } else { 0.0 },
            if bumps { -0.1 } else { 0.0 },
            if success { 2.5 } else { 0.0 },
        ];
        StepResult {
            reward: parts.iter().sum(),
            terminated: over,
            success,
        }
    }

    fn measures(&self) -> Vec<f64> {
        match self.active.as_ref().filter(|_| !self.is_person()) {
            Some(ActiveEpisode { memory, .. }) => vec![
                memory.found.map_or(f64::NAN, |step| step as f64),
                memory.following(),
                memory.bumps as f64,
            ],
            None => vec![f64::NAN; KIND.measures.len()],
        }
    }

    /// The person walks from place to place; the others, who know where it is, come near, make way and look at it.
    fn expert(&mut self, world: &mut World, _episode: &Episode) -> DiscreteAction {
        let Some(body) = world
            .state()
            .agents
            .get(self.setup.agent)
            .map(|own| own.body)
        else {
            return DiscreteAction::Stop;
        };
        let Ok(grid) = world.engines().nav_grid(&body) else {
            return DiscreteAction::Wait;
        };
        if self.is_person() {
            let Some(active) = &mut self.active else {
                return DiscreteAction::Stop;
            };
            if active.memory.steps % WALKS_EVERY != 0 {
                return DiscreteAction::Wait;
            }
            let site = (&self.setup, &grid);
            return active.tour.next_action(world, site, active.key);
        }
        let distance_m = self.distance_m(world);
        let seen = sees(
            world,
            (self.setup.agent, self.person()),
            std::f32::consts::PI,
            10.0,
        );
        let there = position(world, self.person());
        let Some(active) = &mut self.active else {
            return DiscreteAction::Stop;
        };
        let until = MAKE_WAY_M[usize::from(active.memory.makes_way)];
        active.memory.makes_way = distance_m < until;
        if active.memory.makes_way {
            let is_aside = |cell: &NavCell| {
                let apart_m = grid.position(*cell).distance(there);
                (ASIDE_M[0]..ASIDE_M[1]).contains(&apart_m)
            };
            let aside: Vec<NavCell> = grid.walkable().filter(is_aside).collect();
            let step = follower_to(&self.setup, &grid, &aside).next_action(world);
            return step.unwrap_or(DiscreteAction::Wait);
        }
        if seen && distance_m < KEEP_M {
            return self.face_person(world).unwrap_or(DiscreteAction::Wait);
        }
        let cell = grid.nearest(there, 1.0);
        let step =
            cell.and_then(|cell| follower_to(&self.setup, &grid, &[cell]).next_action(world));
        step.unwrap_or(DiscreteAction::Wait)
    }
}
