//! "Find the red chair in the bedroom."

use super::task::{FOUND_M, Instruction, InstructionGoal, InstructionKind};
use crate::category::SemanticCategory;
use crate::form::RequestStep;
use crate::refer::refer;
use crate::scene::SemanticScene;
use dwell_scene::interrupt;

/// Categories that are not looked for: parts of the building and things between rooms.
const NOT_SOUGHT: [&str; 9] = [
    "door",
    "garage_door",
    "window",
    "curtain",
    "blinds",
    "arch",
    "stairs",
    "switch",
    "ground",
];

/// Returns whether things of a category are looked for.
pub fn is_search_target(category: &SemanticCategory) -> bool {
    !category.structure && !category.is_vague() && !NOT_SOUGHT.contains(&category.name)
}

pub(super) fn candidates(scene: &SemanticScene<'_>) -> Vec<Instruction> {
    let objects = scene.house().objects.ids();
    objects
        .filter(|object| {
            scene.facts(*object).category.is_some_and(is_search_target)
                && scene.room_of(*object).is_some()
        })
        .filter_map(|object| {
            // Some milliseconds each.
            interrupt::unwind_if_cancelled();
            let description = refer(scene, object)?;
            let goal = InstructionGoal::objects(vec![object], FOUND_M);
            let step = RequestStep::Do {
                verb: "find".to_owned(),
                object: description.into(),
            };
            let language = scene.semantics.language();
            Instruction::new(language, InstructionKind::FindObject, step, goal)
        })
        .collect()
}
