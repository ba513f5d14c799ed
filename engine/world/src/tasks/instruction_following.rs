//! Do what the instruction says: go to a room, or find a thing; then stop.
//!
//! Reward: the decrease of the geodesic distance to the goal (m), minus 0.01 a step, plus 2.5 for stopping where the
//! instruction is fulfilled. The episode ends with `stop`.

use super::goal_cells::LargestIslandIndex;
use super::navigation::{GoalKind, NavigationGoal, NavigationTask, navigation_settings};
use super::{Task, TaskKind, TaskSetup};
use crate::actions::DiscreteAction;
use crate::episode::EpisodeGoal;
use crate::episode_spec::StatedGoal;
use crate::error::WorldError;
use crate::schema;
use crate::world::World;
use dwell_scene::AgentId;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_semantics::instruct::{self, InstructionKind};

pub(super) const KIND: TaskKind = TaskKind {
    name: InstructionFollowing::NAME,
    version: 0,
    about: "Follow an instruction: go to a room or find a thing, then stop.",
    has_goal: true,
    min_agents: 1,
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
    settings: schema::fields_of::<InstructionFollowingSettings>,
    build,
};

navigation_settings! {
    /// The task's settings.
    InstructionFollowingSettings {
        /// Kinds of instructions to draw from; default all.
        kinds: Vec<InstructionKind> = InstructionKind::ALL.to_vec(),
    }
}

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let (settings, rules) = InstructionFollowingSettings::parse(value)?;
    if settings.kinds.is_empty() {
        let allowed = "at least one of go_to_room, find_object".to_owned();
        return Err(WorldError::Config {
            field: "kinds",
            found: "none".to_owned(),
            allowed,
        });
    }
    Ok(Box::new(NavigationTask::new(
        InstructionFollowing { settings },
        rules,
        setup,
    )))
}

#[derive(Debug)]
struct InstructionFollowing {
    settings: InstructionFollowingSettings,
}

impl GoalKind for InstructionFollowing {
    const NAME: &'static str = "InstructionFollowing";
    const LACKS: &'static str =
        "no room or thing that one can go to can be told from all others by words";

    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn survey(
        &self,
        world: &World,
        agent: AgentId,
        ground: &LargestIslandIndex<'_>,
    ) -> Vec<NavigationGoal> {
        let engines = world.engines().clone();
        let scene = engines.semantics().scene(world.state());
        let kinds = self.settings.kinds.iter();
        let asked: Vec<_> = kinds
            .flat_map(|kind| {
                let all = instruct::candidates(&scene, *kind).into_iter();
                all.map(|instruction| (kind.name(), instruction))
            })
            .collect();
        let offers = Threads::default().map(asked.len(), |k| {
            let (kind, instruction) = &asked[k];
            let asked = instruction.goal.clone();
            let told = EpisodeGoal {
                kind,
                rooms: asked.rooms.clone(),
                objects: asked.objects.clone(),
                ..EpisodeGoal::default()
            };
            let offer = NavigationGoal::from_instruction_goal((world, agent), ground, asked, told)?;
            Some(NavigationGoal {
                instruction: Some(instruction.clone()),
                ..offer
            })
        });
        offers.into_iter().flatten().collect()
    }

    fn begin(
        &self,
        world: &mut World,
        goal: &NavigationGoal,
        _asked: Option<&StatedGoal>,
        key: RandomKey,
    ) -> Result<String, WorldError> {
        let offered = goal.instruction.as_slice();
        let worded = instruct::choose(world.engines().semantics(), offered, key);
        let no_wording = || WorldError::TaskNotPlayable {
            task: Self::NAME,
            house: world.house().name.clone(),
            why: "no wording fits".to_owned(),
        };
        Ok(worded.ok_or_else(no_wording)?.text)
    }
}
