//! Find a thing that another agent was told about: one knows the goal, the others can reach it.
//!
//! The guide is told the class of a thing, and stands still if it likes; the followers begin in its room and are told nothing. What the
//! guide says is all that they can know of the goal. Who guides and who follows is said by the setting `role`.

use super::goal_cells::LargestIslandIndex;
use super::navigation::{Leg, NavigationGoal, NavigationRules, navigation_settings};
use super::object_nav::class_goals;
use super::others::{Patrol, PatrolState, position};
use super::point_nav::check_success_distance;
use super::standing_room::FreeStartCells;
use super::{ExecutedAction, Task, TaskKind, TaskSetup, door_leaves::DoorLeaves, random_yaw_rad};
use crate::actions::DiscreteAction;
use crate::episode::{Episode, EpisodeGoal, GoalField, StepResult, category_of_class};
use crate::error::WorldError;
use crate::metrics::NavigationMetrics;
use crate::schema;
use crate::world::World;
use dwell_acoustics::utterance::MAX_TOKENS;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, Id, Pose};
use dwell_semantics::{english, vocabulary};
use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

const NAME: &str = "Cooperate";
/// The instruction of those who are told nothing.
const FOLLOWER_INSTRUCTION: &str = "Find the thing.";
/// Most classes to choose from.
const MOST_CHOICES: u32 = 16;
/// Distance of the others' starts from the first, straight m.
const TOGETHER_M: f32 = 4.0;
/// Distance of others below which the scripted guide makes way, m.
const MAKE_WAY_M: f32 = 1.0;
/// Times that the scripted follower hears a word before it goes.
const HEARINGS: u32 = 2;
/// Steps that it waits for words before it guesses: 15 s at the usual rate.
const PATIENCE_STEPS: u32 = 300;

pub(super) const KIND: TaskKind = TaskKind {
    name: NAME,
    version: 0,
    about: "One agent knows of which class a thing is that the others are to find; they know what they hear of it.",
    has_goal: true,
    min_agents: 2,
    goal_parts: &[GoalField::Class],
    max_steps: 1500,
    actions: DiscreteAction::DEFAULT,
    sensors: &[
        "rgb",
        "depth",
        "heard_tokens",
        "heard_directions",
        "instruction_tokens",
    ],
    measures: &[],
    settings: schema::fields_of::<CooperateSettings>,
    build,
};

/// What an agent does in the task.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Role {
    /// It is told the goal.
    Guide,
    /// It is to reach the goal.
    Follower,
}

navigation_settings! {
    /// The task's settings.
    CooperateSettings {
        /// `guide` (is told the goal) or `follower` (is to reach it); by default agent 0 guides and all others follow.
        role: Option<Role> = None,
        /// How many classes of things an episode chooses among, 2 to 16; default 4. Who hears nothing is right once in so many.
        choices: u32 = 4,
        /// Success within this distance of the thing's outline, seen from above, m; default 1.
        success_distance_m: f64 = 1.0,
    }
}

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let (settings, rules) = CooperateSettings::parse(value)?;
    check_success_distance(settings.success_distance_m)?;
    if !(2..=MOST_CHOICES).contains(&settings.choices) {
        return Err(WorldError::Config {
            field: "choices",
            found: settings.choices.to_string(),
            allowed: format!("2 to {MOST_CHOICES}"),
        });
    }
    let role = settings.role.unwrap_or(match setup.agent.index() {
        0 => Role::Guide,
        _ => Role::Follower,
    });
    Ok(Box::new(CooperateTask {
        settings,
        rules,
        setup,
        role,
        offers: Vec::new(),
        active: None,
    }))
}

/// A class that can be said in one word, and where its things are reached.
#[derive(Clone, Debug)]
struct Offer {
    word: u32,
    goal: Arc<NavigationGoal>,
}

#[derive(Debug)]
struct CooperateTask {
    settings: CooperateSettings,
    rules: NavigationRules,
    setup: TaskSetup,
    role: Role,
    /// What the house offers at its start; found once.
    offers: Vec<Offer>,
    active: Option<ActiveEpisode>,
}

/// An episode under way.
#[derive(Debug)]
struct ActiveEpisode {
    /// The classes to choose from; the first is the goal.
    choices: Vec<Offer>,
    /// The way to the goal, of a follower.
    leg: Leg,
    /// The way that the expert has chosen.
    chosen: Option<Leg>,
    /// Where the scripted guide goes to make way.
    tour: Patrol,
    key: RandomKey,
    memory: FollowerMemory,
}

/// What the scripted follower remembers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct FollowerMemory {
    /// How often it heard the word of each choice. Shape (choice,).
    heard: Vec<u32>,
    /// Steps so far.
    waited: u32,
    /// The choice that it goes to.
    chosen: Option<u32>,
}

impl ActiveEpisode {
    /// Counts what was heard in a step.
    fn listen(&mut self, world: &World, agent: AgentId) {
        for heard in world.heard_tokens(agent) {
            let known = self
                .choices
                .iter()
                .position(|choice| Some(choice.word) == heard.token);
            if let Some(count) = known.and_then(|place| self.memory.heard.get_mut(place)) {
                *count += 1;
            }
        }
        self.memory.waited = self.memory.waited.saturating_add(1);
    }

    /// Returns the choice to go to, as soon as a word was heard often enough or nothing was for long.
    fn decide(&self) -> Option<u32> {
        let heard = self.memory.heard.iter().zip(0..);
        let (most, best) =
            heard.max_by_key(|(count, place)| (**count, std::cmp::Reverse(*place)))?;
        if *most >= HEARINGS {
            return Some(best);
        }
        (self.memory.waited >= PATIENCE_STEPS).then(|| match most {
            0 => self.key.child("guess").stream().below(self.choices.len()) as u32,
            _ => best,
        })
    }
}

impl CooperateTask {
    /// A start: near the first of `placed`, in its room, where somebody has one.
    fn start(
        &self,
        world: &World,
        leg: &Leg,
        placed: &[AgentId],
        key: RandomKey,
    ) -> Option<NavCell> {
        let grid: &NavGrid = leg.guide.grid();
        let body = world.state().agents.get(self.setup.agent)?.body;
        let leaves = DoorLeaves::of(world, grid);
        let room = FreeStartCells::excluding_agents(world, placed, &body);
        let house = world.house();
        let first = placed.first().and_then(|id| world.state().agents.get(*id));
        let first_room = first.and_then(|agent| room_of(house, agent.position));
        let is_near = |cell: NavCell| {
            let at = grid.position(cell);
            first.is_none_or(|agent| {
                agent.position.distance(at) <= TOGETHER_M && room_of(house, at) == first_room
            })
        };
        let is_start = |cell: NavCell| {
            let way_m = leg.guide.distance_at(cell);
            let far = way_m.is_some_and(|way| self.rules.allow_start(way, || leg.straight_m(cell)));
            let free = grid.island(cell) == Some(0) && !leaves.is_blocked(grid, cell);
            free && (far || self.role == Role::Guide)
        };
        let near = room.sample(grid, key, |cell| is_near(cell) && is_start(cell));
        near.or_else(|| room.sample(grid, key.child("apart"), is_start))
    }
}

fn unplayable(world: &World, why: &str) -> WorldError {
    WorldError::TaskNotPlayable {
        task: NAME,
        house: world.house().name.clone(),
        why: why.to_owned(),
    }
}

/// Returns whether another agent is close.
fn is_in_the_way(world: &World, agent: AgentId) -> bool {
    let here = position(world, agent);
    let agents = world.state().agents.iter_ids();
    let mut others = agents.filter(|(id, _)| *id != agent);
    others.any(|(_, other)| other.position.distance(here) < MAKE_WAY_M)
}

fn room_of(house: &dwell_scene::House, at: Vec3) -> Option<dwell_scene::RoomId> {
    house.room_at(at + Vec3::Y * 0.1)
}

impl Task for CooperateTask {
    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn survey_house(&mut self, world: &World) -> Result<(), WorldError> {
        if self.offers.is_empty() {
            let body = self.setup.body(world, NAME)?;
            let grid = world.engines().nav_grid(&body)?;
            let ground = LargestIslandIndex::of(&grid);
            let radius_m = self.settings.success_distance_m as f32;
            let goals = class_goals((world, self.setup.agent), &ground, &[], radius_m);
            let spoken = goals.into_iter().filter_map(|goal| {
                let noun = category_of_class(goal.told.class)?.singular;
                let tokens = vocabulary::tokenize(noun).ok()?;
                let alone = tokens.get(1) == Some(&vocabulary::PAD);
                alone.then(|| Offer {
                    word: tokens[0].cast_unsigned(),
                    goal: Arc::new(goal),
                })
            });
            self.offers = spoken.collect();
        }
        Ok(())
    }

    fn reset(
        &mut self,
        world: &mut World,
        placed: &[AgentId],
        key: RandomKey,
    ) -> Result<Episode, WorldError> {
        let agent = self.setup.agent;
        let grid = world.engines().nav_grid(&self.setup.body(world, NAME)?)?;
        self.rules.arrange_doors(world, &grid, &self.setup)?;
        // Of the episode, not of the agent: all have one goal.
        let shared = world.episode_key().child("cooperate");
        let mut choices = self.offers.clone();
        shared.child("choices").stream().shuffle(&mut choices);
        choices.truncate(self.settings.choices as usize);
        let Some(goal) = choices.first().map(|offer| offer.goal.clone()) else {
            let why = "it has no thing of a class with a name of one word that one can stand near and see";
            return Err(unplayable(world, why));
        };
        if choices.len() < self.settings.choices as usize {
            let why = format!(
                "it has things of {} classes to choose from, and choices is {}",
                choices.len(),
                self.settings.choices
            );
            return Err(unplayable(world, &why));
        }
        let leg = Leg::new(agent, grid.clone(), goal, self.setup.stride);
        let Some(cell) = self.start(world, &leg, placed, key.child("start")) else {
            let why = "no start lies as far from the goal as the settings ask for";
            return Err(unplayable(world, why));
        };
        let (feet, yaw_rad) = (grid.position(cell), random_yaw_rad(key));
        world.place_agent(agent, feet, yaw_rad)?;
        let told = leg.goal.told.clone();
        let instruction = match self.role {
            Role::Guide => {
                let noun = category_of_class(told.class).map_or("thing", |row| row.singular);
                format!("Find {}.", english::with_article(noun))
            }
            Role::Follower => FOLLOWER_INSTRUCTION.to_owned(),
        };
        let distance_m = leg.guide.distance_at(cell);
        let episode = Episode {
            agent,
            tokens: vocabulary::tokenize(&instruction)?,
            instruction,
            start: Pose::from_position_yaw(feet, yaw_rad),
            progress: NavigationMetrics::new(
                feet,
                distance_m.filter(|_| self.role == Role::Follower),
            ),
            // Sensors of goals tell it to the guide alone.
            goal: match self.role {
                Role::Guide => told,
                Role::Follower => EpisodeGoal {
                    kind: "object",
                    ..EpisodeGoal::default()
                },
            },
        };
        let memory = FollowerMemory {
            heard: vec![0; choices.len()],
            ..FollowerMemory::default()
        };
        self.active = Some(ActiveEpisode {
            choices,
            leg,
            chosen: None,
            tour: Patrol::default(),
            key,
            memory,
        });
        Ok(episode)
    }

    fn snapshot(&self) -> Vec<u8> {
        let active = self.active.as_ref();
        active.map_or(Vec::new(), |active| {
            postcard::to_stdvec(&(&active.memory, active.tour.memory()))
                .expect("plain data can always be written to memory")
        })
    }

    fn restore(&mut self, _world: &World, bytes: &[u8]) -> Result<(), WorldError> {
        let refuse = || WorldError::Snapshot("what its follower has heard is none".to_owned());
        let (memory, tour): (FollowerMemory, PatrolState) =
            postcard::from_bytes(bytes).map_err(|_| refuse())?;
        let active = self.active.as_mut().ok_or_else(refuse)?;
        let count = active.choices.len();
        if memory.heard.len() != count || memory.chosen.is_some_and(|k| k as usize >= count) {
            return Err(refuse());
        }
        active.memory = memory;
        active.tour = Patrol::restored(tour, &self.setup, active.leg.guide.grid());
        active.chosen = None;
        Ok(())
    }

    fn judge(
        &mut self,
        world: &World,
        episode: &mut Episode,
        played: &ExecutedAction<'_>,
    ) -> StepResult {
        let own = self.setup.agent;
        let (Some(active), Some(agent)) = (&mut self.active, world.state().agents.get(own)) else {
            return StepResult::default();
        };
        if self.role == Role::Guide {
            episode
                .progress
                .advance(agent.position, None, agent.collided);
            return StepResult {
                reward: self.rules.rewards.step,
                terminated: played.is_stop(),
                success: false,
            };
        }
        active.listen(world, own);
        let left_m = active.leg.guide.distance_m(world);
        let gain_m = episode
            .progress
            .advance(agent.position, left_m, agent.collided);
        let stops = played.is_stop();
        let is_reached = || active.leg.is_reached(world, left_m);
        self.rules
            .step_result((gain_m, agent.collided), stops, is_reached)
    }

    /// The guide's episode ends with those of all others, in success if one of them found the thing.
    fn conclude(&mut self, verdicts: &[(AgentId, StepResult)]) -> Option<StepResult> {
        if self.role == Role::Follower {
            return None;
        }
        let mut others = verdicts
            .iter()
            .filter(|(agent, _)| *agent != self.setup.agent);
        let ended = others.clone().count() > 0 && others.clone().all(|(_, own)| own.terminated);
        let success = others.any(|(_, own)| own.success);
        let pay = &self.rules.rewards;
        ended.then_some(StepResult {
            reward: pay.step + if success { pay.success } else { 0.0 },
            terminated: true,
            success,
        })
    }

    fn expert(&mut self, world: &mut World, _episode: &Episode) -> DiscreteAction {
        let Some(active) = &mut self.active else {
            return DiscreteAction::Stop;
        };
        if self.role == Role::Guide {
            if !is_in_the_way(world, self.setup.agent) {
                return DiscreteAction::Wait;
            }
            let grid = active.leg.guide.grid().clone();
            return active
                .tour
                .next_action(world, (&self.setup, &grid), active.key);
        }
        if active.memory.chosen.is_none() {
            active.memory.chosen = active.decide();
        }
        let Some(chosen) = active.memory.chosen else {
            return DiscreteAction::Wait;
        };
        let goal = active.choices[chosen as usize].goal.clone();
        let leg = &active.leg;
        let leg = active.chosen.get_or_insert_with(|| leg.with_goal(goal));
        if let Some(step) = leg.approach(world) {
            return step;
        }
        let looks_in_vain = !leg.is_reached(world, None);
        if looks_in_vain && leg.exclude_goals_within(world, super::navigation::ELSEWHERE_M) {
            return DiscreteAction::Wait;
        }
        DiscreteAction::Stop
    }

    fn expert_utterance(&self, world: &World) -> [u32; MAX_TOKENS] {
        let mut tokens = [0; MAX_TOKENS];
        let active = self.active.as_ref().filter(|_| self.role == Role::Guide);
        if let Some(goal) = active.and_then(|active| active.choices.first())
            && !world.is_speaking(self.setup.agent)
        {
            tokens[0] = goal.word;
        }
        tokens
    }
}
