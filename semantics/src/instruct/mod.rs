//! Instructions in words, and the check whether they were fulfilled.
//!
//! To add a kind: a file here with its candidates, and a line in [`candidates`].

mod condition;
mod find_object;
mod go_to_room;
mod instruction_split;
mod needed_words;
mod route;
mod step_kind;
mod steps;
mod task;
mod thing_group;

pub use condition::{ConditionContext, StepCondition};
pub use find_object::is_search_target;
pub use instruction_split::InstructionSplit;
pub use needed_words::english_vocabulary;
pub use route::{
    DescribedPath, DynamicTimeWarping, RouteInstruction, RouteMilestone, RouteProgress, RouteStep,
    RouteTracker, room_changes,
};
pub use step_kind::{StepKind, states_of};
pub(crate) use step_kind::{is_openable, is_toggleable};
pub use steps::{InstructionStep, conditional};
pub(crate) use task::say;
pub use task::{Instruction, InstructionGoal, InstructionKind, InstructionProgress};
pub use thing_group::{ThingGroup, ThingSet, groups, thing_sets};

use crate::error::SemanticsError;
use crate::scene::SemanticScene;
use crate::semantics::Semantics;
use dwell_scene::random::RandomKey;

/// Largest length of a text, in characters.
pub const MAX_TEXT_LEN: usize = 120;
/// Every character that a text may have; new ones come last.
pub const CHARSET: &str = " ',-.ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz?";

/// Every instruction of a kind that the scene offers, with one fixed wording each, in order. Each means exactly one thing.
pub fn candidates(scene: &SemanticScene<'_>, kind: InstructionKind) -> Vec<Instruction> {
    match kind {
        InstructionKind::GoToRoom => go_to_room::candidates(scene),
        InstructionKind::FindObject => find_object::candidates(scene),
    }
}

/// One of `candidates`, in a wording of its own; `None` when there is none. Both are drawn from `key`, the wording from the house's
/// name, too: one key does not choose the same wording in every house.
///
/// # Determinism
/// Equal houses, candidates and keys give equal instructions.
pub fn choose(
    semantics: &Semantics,
    candidates: &[Instruction],
    key: RandomKey,
) -> Option<Instruction> {
    let key = key.child("instruction");
    let chosen = key.stream().choose(candidates)?;
    let wording = key.child("wording").child(semantics.house().name.as_str());
    Some(chosen.reworded(semantics.language(), wording))
}

/// An instruction of a kind.
///
/// # Errors
/// [`SemanticsError::NoInstruction`] when the scene offers none.
pub fn instruction(
    scene: &SemanticScene<'_>,
    kind: InstructionKind,
    key: RandomKey,
) -> Result<Instruction, SemanticsError> {
    choose(scene.semantics, &candidates(scene, kind), key).ok_or_else(|| {
        SemanticsError::NoInstruction {
            house: scene.house().name.clone(),
            kind: kind.name(),
            why: match kind {
                InstructionKind::GoToRoom => {
                    "no room can be told from all others by its kind and contents"
                }
                InstructionKind::FindObject => "no object can be told from all others by words",
            },
        }
    })
}
