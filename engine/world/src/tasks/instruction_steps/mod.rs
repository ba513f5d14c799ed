//! Do what an instruction says with feet and hands, one step after the other: go to rooms, find things, pick them up, open and close
//! them, switch them on and off, bring them elsewhere; then stop.
//!
//! Each step has a condition. A step is done as soon as its condition holds after the steps before it are done. At the end the
//! conditions of things must still hold (a fridge that was to be opened is open), but for those that a later step undoes; where the agent
//! is counts for the last step alone.

mod active_instruction;
mod step_places;

use super::door_leaves::DoorLeaves;
use super::navigation::{NavigationRules, navigation_settings};
use super::standing_room::FreeStartCells;
use super::{Task, TaskKind, TaskSetup, random_yaw_rad};
use crate::actions::{DiscreteAction, StepAction};
use crate::episode::{Episode, EpisodeGoal, StepResult};
use crate::error::WorldError;
use crate::metrics::NavigationMetrics;
use crate::schema;
use crate::world::World;
use active_instruction::{ActiveInstruction, StepOffer};
use dwell_scene::interrupt;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, Pose};
use dwell_semantics::instruct::{self, InstructionStep, StepCondition, StepKind};
use dwell_semantics::vocabulary;
use std::collections::BTreeMap;
use std::sync::Arc;
use step_places::StepPlaces;

const NAME: &str = "InstructionSteps";
/// Instructions that are tried for an episode.
const DRAWS: u64 = 64;

pub(super) const KIND: TaskKind = TaskKind {
    name: NAME,
    version: 0,
    about: "Follow an instruction with feet and hands: go, find, pick up, open, close, switch, bring, step by step, then stop.",
    has_goal: true,
    goal_parts: &[],
    max_steps: 1000,
    actions: DiscreteAction::DEFAULT,
    sensors: &[
        "rgb",
        "depth",
        "semantic",
        "audio",
        "instruction",
        "instruction_tokens",
    ],
    measures: &[],
    settings: schema::fields_of::<InstructionStepsSettings>,
    build,
};

navigation_settings! {
    /// The task's settings.
    InstructionStepsSettings {
        /// Kinds of steps to draw from; default all.
        kinds: Vec<StepKind> = StepKind::ALL.to_vec(),
        /// The least number of steps, 1 to 3; default 1.
        min_instruction_steps: u32 = 1,
        /// The greatest number of steps, up to 3; default 2.
        max_instruction_steps: u32 = 2,
        /// What every step that is done is paid, beside `reward`; default 0.5.
        step_done_reward: f64 = 0.5,
    }
}

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let (settings, rules) = InstructionStepsSettings::parse(value)?;
    let fault = |field: &'static str, found: String, allowed: &str| {
        Err(WorldError::Config {
            field,
            found,
            allowed: allowed.to_owned(),
        })
    };
    if settings.kinds.is_empty() {
        let names = StepKind::ALL.map(StepKind::name).join(", ");
        return fault(
            "kinds",
            "none".to_owned(),
            &format!("at least one of {names}"),
        );
    }
    let (least, most) = (
        settings.min_instruction_steps,
        settings.max_instruction_steps,
    );
    if !(1..=3).contains(&most) {
        return fault("max_instruction_steps", most.to_string(), "1 to 3");
    }
    if !(1..=most).contains(&least) {
        let allowed = format!("1 to max_instruction_steps, which is {most}");
        return fault("min_instruction_steps", least.to_string(), &allowed);
    }
    if settings.step_done_reward.is_nan() || settings.step_done_reward.abs() > 1e6 {
        let found = settings.step_done_reward.to_string();
        return fault("step_done_reward", found, "-1,000,000 to 1,000,000");
    }
    Ok(Box::new(InstructionSteps {
        settings,
        rules,
        setup,
        offers: BTreeMap::new(),
        active: None,
    }))
}

#[derive(Debug)]
struct InstructionSteps {
    settings: InstructionStepsSettings,
    rules: NavigationRules,
    setup: TaskSetup,
    /// Steps that are playable at the house's start, by kind; found once.
    offers: BTreeMap<StepKind, Vec<StepOffer>>,
    active: Option<ActiveInstruction>,
}

impl InstructionSteps {
    /// Some steps, drawn from `key`, that can be done one after the other by one hand; `None` where those that were drawn cannot.
    fn draw(&self, key: RandomKey) -> Option<Vec<StepOffer>> {
        let mut stream = key.stream();
        let (least, most) = (
            self.settings.min_instruction_steps,
            self.settings.max_instruction_steps,
        );
        let count = least as usize + stream.below((most - least) as usize + 1);
        let kinds: Vec<&Vec<StepOffer>> = self.offers.values().collect();
        let mut drawn: Vec<StepOffer> = Vec::new();
        for _ in 0..count {
            let of_kind = stream.choose(&kinds)?;
            drawn.push(stream.choose(of_kind)?.clone());
        }
        let fits = drawn.windows(2).all(|pair| {
            let (first, then) = (pair[0].step.condition, pair[1].step.condition);
            let hand_is_full = matches!(first, StepCondition::Held(_));
            let walks = matches!(then, StepCondition::AgentIn(_));
            let same = first.object().is_some() && first.object() == then.object();
            (!hand_is_full || walks) && !same && first != then
        });
        let holds_late = drawn
            .iter()
            .rev()
            .skip(2)
            .any(|offer| matches!(offer.step.condition, StepCondition::Held(_)));
        (fits && !holds_late).then_some(drawn)
    }
}

impl Task for InstructionSteps {
    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn survey_house(&mut self, world: &World) -> Result<(), WorldError> {
        if !self.offers.is_empty() {
            return Ok(());
        }
        let body = self.setup.body(world, NAME)?;
        let grid = world.engines().nav_grid(&body)?;
        let places = StepPlaces::new(world, self.setup.agent, body, &grid);
        let scene = world.engines().semantics().scene(world.state());
        let possible = |kind, object| places.is_possible(kind, object);
        for step in instruct::steps(&scene, &self.settings.kinds, possible) {
            let kind = step.kind;
            if let Some(offer) = places.offer(step) {
                self.offers.entry(kind).or_default().push(offer);
            }
        }
        Ok(())
    }

    fn reset(
        &mut self,
        world: &mut World,
        placed: &[AgentId],
        key: RandomKey,
    ) -> Result<Episode, WorldError> {
        let (agent, stride) = (self.setup.agent, self.setup.stride);
        let body = self.setup.body(world, NAME)?;
        let grid: Arc<NavGrid> = world.engines().nav_grid(&body)?;
        self.rules.arrange_doors(world, &grid, &self.setup)?;
        let leaves = DoorLeaves::of(world, &grid);
        let room = FreeStartCells::excluding_agents(world, placed, &body);
        let engines = world.engines().clone();
        let language = engines.semantics().language();
        for k in 0..DRAWS {
            interrupt::unwind_if_cancelled();
            let key = key.child("instruction").child(k);
            let Some(steps) = self.draw(key.child("steps")) else {
                continue;
            };
            let asked: Vec<InstructionStep> =
                steps.iter().map(|offer| offer.step.clone()).collect();
            let wording = key.child("wording").child(world.house().name.as_str());
            let Some(sentence) = instruct::compose(language, &asked, Some(wording)) else {
                continue;
            };
            let mut active = ActiveInstruction::new(steps, (agent, &grid, stride));
            let allowed = |cell: NavCell| {
                grid.island(cell) == Some(0)
                    && active.way_from(cell).is_some_and(|way_m| {
                        self.rules.allow_start(way_m, || active.straight_from(cell))
                    })
                    && !leaves.is_blocked(&grid, cell)
            };
            let Some(start) = room.sample(&grid, key.child("start"), allowed) else {
                continue;
            };
            let yaw_rad = random_yaw_rad(key);
            let position = grid.position(start);
            world.place_agent(agent, position, yaw_rad)?;
            if active.advance(world, agent) > 0 {
                continue;
            }
            let distance_m = active.distance_m(world);
            let episode = Episode {
                agent,
                tokens: vocabulary::tokenize(&sentence.text)?,
                instruction: sentence.text,
                start: Pose::from_position_yaw(position, yaw_rad),
                progress: NavigationMetrics::new(position, distance_m),
                goal: told(&asked),
            };
            self.active = Some(active);
            return Ok(episode);
        }
        let house = world.house().name.clone();
        let why = if self.offers.is_empty() {
            "it has nothing to do of the kinds that are asked for, or nothing that one can go to and reach"
        } else {
            "no instruction of the kinds and numbers of steps that are asked for can be walked to from the asked distance"
        };
        Err(WorldError::TaskNotPlayable {
            task: NAME,
            house,
            why: why.to_owned(),
        })
    }

    fn snapshot(&self) -> Vec<u8> {
        let done = self.active.as_ref().map_or(0, |active| active.done);
        vec![done as u8]
    }

    fn restore(&mut self, world: &World, bytes: &[u8]) -> Result<(), WorldError> {
        match (&mut self.active, bytes) {
            (Some(active), [done]) if usize::from(*done) <= active.steps.len() => {
                active.done = usize::from(*done);
                active.advance(world, self.setup.agent);
                Ok(())
            }
            _ => Err(WorldError::Snapshot(format!(
                "the steps that are done are {bytes:?}; allowed is one number, up to the number of steps"
            ))),
        }
    }

    fn judge(&mut self, world: &World, episode: &mut Episode, action: &StepAction) -> StepResult {
        let id = self.setup.agent;
        let (Some(active), Some(agent)) = (&mut self.active, world.state().agents.get(id)) else {
            return StepResult::default();
        };
        let newly_done = active.advance(world, id);
        let left_m = active.distance_m(world);
        let gain_m = episode
            .progress
            .advance(agent.position, left_m, agent.collided);
        let stops = action.action == DiscreteAction::Stop;
        let is_reached = || active.is_fulfilled(world, id);
        let mut result = (self.rules).step_result((gain_m, agent.collided), stops, is_reached);
        result.reward += self.settings.step_done_reward * newly_done as f64;
        result
    }

    fn expert(&mut self, world: &mut World, _episode: &Episode) -> DiscreteAction {
        let active = self.active.as_mut();
        active.map_or(DiscreteAction::Stop, |active| active.expert(world))
    }
}

/// What sensors and infos tell of an instruction.
fn told(steps: &[InstructionStep]) -> EpisodeGoal {
    let kind = match steps {
        [only] => only.kind.name(),
        _ => "sequence",
    };
    let conditions = || steps.iter().map(|step| step.condition);
    EpisodeGoal {
        kind,
        objects: conditions().filter_map(StepCondition::object).collect(),
        rooms: conditions().filter_map(StepCondition::room).collect(),
        ..EpisodeGoal::default()
    }
}
