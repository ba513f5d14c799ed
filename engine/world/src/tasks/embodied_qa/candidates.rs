//! The questions that a house offers: those whose answers one can go to and see.

use crate::episode::EpisodeGoal;
use crate::tasks::goal_cells::LargestIslandIndex;
use crate::tasks::navigation::{NavigationGoal, SuccessRule, goal_region};
use crate::world::World;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::{AgentId, ObjectId, RoomId};
use dwell_semantics::ask::{self, AskedQuestion, QuestionKind};
use dwell_semantics::instruct::{InstructionGoal, StepCondition};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A question, and where its answer is seen.
#[derive(Clone, Debug)]
pub(super) struct QuestionCandidate {
    pub(super) asked: AskedQuestion,
    pub(super) goal: Arc<NavigationGoal>,
}

impl QuestionCandidate {
    /// Returns whether an agent is in the room in which the answer is seen.
    pub(super) fn is_in_room(&self, world: &World, agent: AgentId) -> bool {
        let scene = world.engines().semantics().scene(world.state());
        scene.room_of_agent(agent) == Some(self.asked.room)
    }
}

/// The questions of some kinds whose things can all be gone to and seen, in order.
pub(super) fn enumerate_questions(
    world: &World,
    agent: AgentId,
    grid: &NavGrid,
    kinds: &[QuestionKind],
) -> Vec<QuestionCandidate> {
    let ground = LargestIslandIndex::of(grid);
    let engines = world.engines().clone();
    let scene = engines.semantics().scene(world.state());
    let mut places = Places {
        world,
        agent,
        ground,
        things: BTreeMap::new(),
        rooms: BTreeMap::new(),
    };
    let mut kinds = kinds.to_vec();
    kinds.sort_unstable();
    kinds.dedup();
    let mut offers = Vec::new();
    for kind in kinds {
        for asked in ask::candidates(&scene, kind) {
            let is_seen = asked
                .seen
                .iter()
                .all(|thing| !places.of_thing(*thing).is_empty());
            let cells = match asked.target {
                Some(target) => places.of_thing(target),
                None => places.in_room(asked.room),
            };
            if !is_seen || cells.is_empty() {
                continue;
            }
            let goal = NavigationGoal {
                cells,
                success: SuccessRule::Fulfilled(asked.goal()),
                told: EpisodeGoal {
                    kind: kind.name(),
                    rooms: vec![asked.room],
                    objects: asked.seen.clone(),
                    ..EpisodeGoal::default()
                },
                instruction: None,
            };
            offers.push(QuestionCandidate {
                asked,
                goal: Arc::new(goal),
            });
        }
    }
    offers
}

/// Where things are seen and rooms are entered, found when it is asked for.
struct Places<'a> {
    world: &'a World,
    agent: AgentId,
    ground: LargestIslandIndex<'a>,
    things: BTreeMap<ObjectId, Vec<NavCell>>,
    rooms: BTreeMap<RoomId, Vec<NavCell>>,
}

impl Places<'_> {
    fn of_thing(&mut self, thing: ObjectId) -> Vec<NavCell> {
        let found = self.things.entry(thing).or_insert_with(|| {
            let asked = StepCondition::find_object_goal(thing);
            goal_region(self.world, self.agent, &self.ground, &asked)
        });
        found.clone()
    }

    fn in_room(&mut self, room: RoomId) -> Vec<NavCell> {
        let found = self.rooms.entry(room).or_insert_with(|| {
            let asked = InstructionGoal::rooms(vec![room]);
            goal_region(self.world, self.agent, &self.ground, &asked)
        });
        found.clone()
    }
}
