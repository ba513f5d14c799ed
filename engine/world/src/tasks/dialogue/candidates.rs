//! The ambiguous instructions that a house offers: those of which all things can be gone to.

use super::settings::DialogueSettings;
use crate::episode::EpisodeGoal;
use crate::tasks::goal_cells::LargestIslandIndex;
use crate::tasks::navigation::{NavigationGoal, SuccessRule, goal_region};
use crate::world::World;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::{AgentId, ObjectId};
use dwell_semantics::dialogue::{AmbiguousInstruction, ambiguous_instructions};
use dwell_semantics::instruct::InstructionGoal;
use std::collections::BTreeMap;
use std::sync::Arc;

/// An instruction, and where each of its things is reached.
#[derive(Clone, Debug)]
pub(super) struct DialogueCandidate {
    pub(super) asked: AmbiguousInstruction,
    /// Shape (thing,).
    pub(super) goals: Vec<Arc<NavigationGoal>>,
}

/// The kind of goal of an instruction that fits so many things.
pub(super) fn goal_kind(things: usize) -> &'static str {
    const KINDS: [&str; 7] = [
        "one_of_2", "one_of_3", "one_of_4", "one_of_5", "one_of_6", "one_of_7", "one_of_8",
    ];
    let place = things.checked_sub(2).and_then(|k| KINDS.get(k));
    place.copied().unwrap_or("object")
}

/// The instructions whose things can all be reached, by their number of things.
pub(super) fn enumerate_instructions(
    world: &World,
    agent: AgentId,
    grid: &NavGrid,
    settings: &DialogueSettings,
) -> BTreeMap<usize, Vec<DialogueCandidate>> {
    let scene = world.engines().semantics().scene(world.state());
    let ground = LargestIslandIndex::of(grid);
    let radius_m = settings.success_distance_m as f32;
    let mut places: BTreeMap<ObjectId, Vec<NavCell>> = BTreeMap::new();
    let mut offers: BTreeMap<usize, Vec<DialogueCandidate>> = BTreeMap::new();
    for asked in ambiguous_instructions(&scene, settings.max_candidates as usize) {
        let count = asked.things.len();
        if count < settings.min_candidates as usize {
            continue;
        }
        let mut goal = |thing: ObjectId| {
            let reached = InstructionGoal::objects(vec![thing], radius_m);
            let found = places
                .entry(thing)
                .or_insert_with(|| goal_region(world, agent, &ground, &reached));
            (!found.is_empty()).then(|| {
                Arc::new(NavigationGoal {
                    cells: found.clone(),
                    success: SuccessRule::Fulfilled(reached),
                    told: EpisodeGoal {
                        kind: goal_kind(count),
                        objects: vec![thing],
                        ..EpisodeGoal::default()
                    },
                    instruction: None,
                })
            })
        };
        let goals: Option<Vec<_>> = asked.things.iter().map(|thing| goal(*thing)).collect();
        if let Some(goals) = goals {
            let alike = offers.entry(count).or_default();
            alike.push(DialogueCandidate { asked, goals });
        }
    }
    offers
}
