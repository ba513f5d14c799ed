//! Go to a room of a kind, such as a kitchen; then stop in it.

use super::goal_cells::LargestIslandIndex;
use super::navigation::{GoalKind, NavigationGoal, NavigationTask, navigation_settings};
use super::{Task, TaskKind, TaskSetup};
use crate::actions::DiscreteAction;
use crate::episode::{EpisodeGoal, GoalField};
use crate::episode_spec::StatedGoal;
use crate::error::WorldError;
use crate::schema;
use crate::world::World;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, RoomId};
use dwell_semantics::english;
use dwell_semantics::instruct::InstructionGoal;
use dwell_semantics::room_kind::room_kinds;
use std::collections::BTreeMap;

pub(super) const KIND: TaskKind = TaskKind {
    name: RoomNav::NAME,
    version: 0,
    about: "Go to a room of a kind, such as a kitchen, then stop in it.",
    has_goal: true,
    min_agents: 1,
    goal_parts: &[GoalField::Room],
    max_steps: 1000,
    actions: DiscreteAction::DEFAULT,
    sensors: &["rgb", "depth", "gps", "compass", "roomgoal"],
    measures: &[],
    settings: schema::fields_of::<RoomNavSettings>,
    build,
};

navigation_settings! {
    /// The task's settings.
    RoomNavSettings {
        /// Kinds of rooms to draw from, by the names of `assets/rooms.csv`; default all that the house has.
        rooms: Vec<String> = Vec::new(),
    }
}

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let (settings, rules) = RoomNavSettings::parse(value)?;
    let rows = room_kinds().rows();
    if let Some(name) =
        (settings.rooms.iter()).find(|name| rows.iter().all(|row| row.name != **name))
    {
        return Err(WorldError::Unknown {
            kind: "kind of room",
            name: name.clone(),
            known: rows.iter().map(|row| row.name.to_owned()).collect(),
        });
    }
    Ok(Box::new(NavigationTask::new(
        RoomNav { settings },
        rules,
        setup,
    )))
}

#[derive(Debug)]
struct RoomNav {
    settings: RoomNavSettings,
}

impl GoalKind for RoomNav {
    const NAME: &'static str = "RoomNav";
    const LACKS: &'static str =
        "it has no room of the kinds that are asked for, or none in which one can stand";

    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn survey(
        &self,
        world: &World,
        agent: AgentId,
        ground: &LargestIslandIndex<'_>,
    ) -> Vec<NavigationGoal> {
        let (semantics, rows) = (world.engines().semantics(), room_kinds().rows());
        let mut by_kind: BTreeMap<usize, Vec<RoomId>> = BTreeMap::new();
        for room in world.house().rooms.ids() {
            let kind = semantics.room(room).kind;
            let row = kind.and_then(|kind| rows.iter().position(|row| row.name == kind.name));
            if let Some(row) = row {
                by_kind.entry(row).or_default().push(room);
            }
        }
        let asked = &self.settings.rooms;
        let goals = by_kind.into_iter().filter_map(|(row, rooms)| {
            if !(asked.is_empty() || asked.iter().any(|name| name == rows[row].name)) {
                return None;
            }
            let goal = InstructionGoal::rooms(rooms.clone());
            let told = EpisodeGoal {
                kind: "room",
                rooms,
                room_kind: row as i32 + 1,
                ..EpisodeGoal::default()
            };
            NavigationGoal::from_instruction_goal((world, agent), ground, goal, told)
        });
        goals.collect()
    }

    fn begin(
        &self,
        _world: &mut World,
        goal: &NavigationGoal,
        _asked: Option<&StatedGoal>,
        _key: RandomKey,
    ) -> Result<String, WorldError> {
        let row = &room_kinds().rows()[goal.told.room_kind as usize - 1];
        Ok(format!("Go to {}.", english::with_article(row.singular)))
    }
}
