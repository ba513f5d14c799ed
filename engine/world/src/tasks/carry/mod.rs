//! Two carry a table, or another large thing, to where it belongs.
//!
//! # Source
//! Pieces of furniture that two agents move together are those of U. Jain et al., "A Cordial Sync: Going Beyond Marginal Policies for
//! Multi-Agent Embodied Tasks", ECCV 2020 (arXiv:2007.04979, `FurnMove`).

mod carriers;
mod formation;
mod search;
mod settings;

use super::others::place_anywhere;
use super::{ExecutedAction, Task, TaskKind, TaskSetup, door_leaves};
use crate::actions::{DiscreteAction, HandTarget};
use crate::episode::{Episode, EpisodeGoal, GoalField, ObjectPlacement, StepResult, TaskMeasure};
use crate::error::WorldError;
use crate::metrics::NavigationMetrics;
use crate::schema;
use crate::world::World;
use carriers::Carriers;
use dwell_scene::random::RandomKey;
use dwell_scene::space::yaw_from_forward;
use dwell_scene::{AgentId, Pose};
use dwell_semantics::vocabulary;
use formation::{CarryFormation, yaw_between};
use search::sample_path;
use serde::{Deserialize, Serialize};
use settings::CarrySettings;

const NAME: &str = "Carry";
const INSTRUCTION: &str = "Carry it there with the other.";
/// Things that are tried for one that can be carried somewhere.
const TRIES: usize = 8;

pub(super) const KIND: TaskKind = TaskKind {
    name: NAME,
    version: 0,
    about: "Two carry a table, or another thing that one alone cannot lift, to a place, and put it down there.",
    has_goal: true,
    min_agents: 2,
    goal_parts: &[GoalField::Placements],
    max_steps: 1500,
    actions: &[
        DiscreteAction::Stop,
        DiscreteAction::MoveForward,
        DiscreteAction::TurnLeft,
        DiscreteAction::TurnRight,
        DiscreteAction::LookUp,
        DiscreteAction::LookDown,
        DiscreteAction::Wait,
        DiscreteAction::Drop,
        DiscreteAction::Grip,
    ],
    sensors: &[
        "rgb",
        "depth",
        "instance",
        "gps",
        "compass",
        "rearrangegoal",
    ],
    measures: &[
        TaskMeasure {
            name: "goal_distance_m",
            about: "Level distance of the thing's middle from where it belongs, m.",
        },
        TaskMeasure {
            name: "goal_angle_deg",
            about: "Turn of the thing from how it belongs, degrees, 0 to 180.",
        },
        TaskMeasure {
            name: "lifted_share",
            about: "Share of the steps so far in which both held it.",
        },
    ],
    settings: schema::fields_of::<CarrySettings>,
    build,
};

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let settings: CarrySettings = crate::parse_settings::parse_task_settings(value)?;
    settings.check()?;
    Ok(Box::new(CarryTask {
        settings,
        setup,
        active: None,
    }))
}

#[derive(Debug)]
struct CarryTask {
    settings: CarrySettings,
    setup: TaskSetup,
    active: Option<ActiveEpisode>,
}

#[derive(Debug)]
struct ActiveEpisode {
    formation: CarryFormation,
    carriers: Carriers,
    /// The place of the agent among those who carry; `None` of others.
    carrier: Option<usize>,
    goal: Pose,
    memory: Progress,
}

/// How an episode has gone so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Progress {
    steps: u64,
    lifted: u64,
    /// Distance of the thing from the goal, m, and its turn, rad.
    distance_m: f32,
    angle_rad: f32,
    /// The place on the way to which the scripted carriers go.
    at: usize,
}

impl ActiveEpisode {
    /// Level distance of the thing from where it belongs, m, and its turn, rad.
    fn off(&self, world: &World) -> (f32, f32) {
        let now = world.state().part_pose[self.formation.part];
        let middle = self.formation.middle;
        let way = now.transform_point(middle) - self.goal.transform_point(middle);
        let angle_rad = yaw_between(now.rotation, self.goal.rotation).abs();
        (way.with_y(0.0).length(), angle_rad)
    }
}

impl CarryTask {
    /// Draws the thing and its way: of the episode, not of the agent.
    fn draw(&self, world: &World) -> Result<(CarryFormation, Vec<Pose>), WorldError> {
        let body = self.setup.body(world, NAME)?;
        let key = world.episode_key().child("carry");
        let mut things = CarryFormation::all(world, &body);
        let unplayable = |why: &str| WorldError::TaskNotPlayable {
            task: NAME,
            house: world.house().name.clone(),
            why: why.to_owned(),
        };
        if things.is_empty() {
            return Err(unplayable(
                "nothing in it is large, and too heavy for one and not for two to carry",
            ));
        }
        key.child("things").stream().shuffle(&mut things);
        let distances_m = [self.settings.min_distance_m, self.settings.max_distance_m];
        let ways = things.into_iter().take(TRIES).find_map(|formation| {
            let way = sample_path(world, &formation, distances_m, key.child("goal"))?;
            Some((formation, way))
        });
        ways.ok_or_else(|| unplayable("there is no way to carry anything as far as is asked"))
    }
}

impl Task for CarryTask {
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
        let body = self.setup.body(world, NAME)?;
        let grid = world.engines().nav_grid(&body)?;
        door_leaves::open_all(world, &grid)?;
        let (formation, way) = self.draw(world)?;
        let mut agents = [AgentId(0), AgentId(1)];
        let ends = world.episode_key().child("carry").child("ends");
        ends.stream().shuffle(&mut agents);
        let carrier = agents.iter().position(|own| *own == agent);
        let (feet, yaw_rad) = match carrier {
            Some(place) => {
                let feet = formation.carrier_position(&formation.start, place);
                let middle = formation.start.transform_point(formation.middle);
                let yaw_rad = yaw_from_forward((middle - feet).with_y(0.0));
                world.place_agent(agent, feet, yaw_rad)?;
                (feet, yaw_rad)
            }
            None => place_anywhere(world, placed, (&self.setup, NAME), (None, key))?,
        };
        let goal = *way.last().unwrap_or(&formation.start);
        let middle = goal.transform_point(formation.middle);
        let placement = ObjectPlacement {
            object: formation.object,
            world_from_box: Pose::new(middle, goal.rotation),
            size: formation.size,
            openness: None,
        };
        let mut active = ActiveEpisode {
            goal,
            carriers: Carriers { agents, way },
            carrier,
            memory: Progress::default(),
            formation,
        };
        (active.memory.distance_m, active.memory.angle_rad) = active.off(world);
        let object = active.formation.object;
        self.active = Some(active);
        Ok(Episode {
            agent,
            tokens: vocabulary::tokenize(INSTRUCTION)?,
            instruction: INSTRUCTION.to_owned(),
            start: Pose::from_position_yaw(feet, yaw_rad),
            progress: NavigationMetrics::new(feet, None),
            goal: EpisodeGoal {
                kind: "carry",
                position: Some(middle.with_y(feet.y)),
                objects: vec![object],
                placements: vec![placement],
                ..EpisodeGoal::default()
            },
        })
    }

    fn snapshot(&self) -> Vec<u8> {
        let active = self.active.as_ref();
        active.map_or(Vec::new(), |active| {
            postcard::to_stdvec(&active.memory).expect("plain data can always be written to memory")
        })
    }

    fn restore(&mut self, _world: &World, bytes: &[u8]) -> Result<(), WorldError> {
        let refuse = || WorldError::Snapshot("what Carry keeps of its episode is none".to_owned());
        let memory = postcard::from_bytes(bytes).map_err(|_| refuse())?;
        self.active.as_mut().ok_or_else(refuse)?.memory = memory;
        Ok(())
    }

    fn judge(
        &mut self,
        world: &World,
        episode: &mut Episode,
        played: &ExecutedAction<'_>,
    ) -> StepResult {
        let (Some(active), Some(agent)) =
            (&mut self.active, world.state().agents.get(self.setup.agent))
        else {
            return StepResult::default();
        };
        episode
            .progress
            .advance(agent.position, None, agent.collided);
        let (distance_m, angle_rad) = active.off(world);
        let object = active.formation.object;
        let holders = world.state().agents.iter();
        let holders = holders.filter(|own| own.holding == Some(object)).count();
        let memory = &mut active.memory;
        memory.steps += 1;
        memory.lifted += u64::from(holders >= 2);
        let gain_m = f64::from(memory.distance_m - distance_m);
        (memory.distance_m, memory.angle_rad) = (distance_m, angle_rad);
        let stops = played.is_stop();
        let success = stops
            && holders == 0
            && distance_m <= self.settings.success_distance_m
            && angle_rad.to_degrees() <= self.settings.success_angle_deg;
        StepResult {
            reward: gain_m - 0.01 + if success { 2.5 } else { 0.0 },
            terminated: stops,
            success,
        }
    }

    /// `grip` is used on the thing that is to be carried.
    fn hand_target(&self, _world: &World, action: DiscreteAction) -> Option<HandTarget> {
        let active = self.active.as_ref()?;
        let object = active.formation.object;
        (action == DiscreteAction::Grip).then(|| HandTarget::At(object.into()))
    }

    fn measures(&self) -> Vec<f64> {
        let Some(active) = &self.active else {
            return vec![f64::NAN; KIND.measures.len()];
        };
        let memory = &active.memory;
        let share = if memory.steps == 0 {
            f64::NAN
        } else {
            memory.lifted as f64 / memory.steps as f64
        };
        vec![
            memory.distance_m.into(),
            memory.angle_rad.to_degrees().into(),
            share,
        ]
    }

    /// Both carriers know the way by which the goal was found.
    fn expert(&mut self, world: &mut World, _episode: &Episode) -> DiscreteAction {
        let Some(active) = &mut self.active else {
            return DiscreteAction::Stop;
        };
        let Some(carrier) = active.carrier else {
            return DiscreteAction::Stop;
        };
        active.carriers.next_action(
            world,
            &active.formation,
            (carrier, &self.setup.stride),
            &mut active.memory.at,
        )
    }
}
