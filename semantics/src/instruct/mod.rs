//! Instructions in words, and the check whether they were fulfilled.
//!
//! To add a kind: a file here with its candidates, and a line in [`candidates`].

mod find_object;
mod go_to_room;
mod needed_words;
mod task;

pub use needed_words::needed_words;
pub use task::{Instruction, InstructionGoal, InstructionKind, InstructionProgress};

use crate::error::SemanticsError;
use crate::scene::SemanticScene;
use dwell_scene::random::RandomKey;

/// Largest length of a text, in characters.
pub const MAX_TEXT_LEN: usize = 120;
/// Every character that a text may have.
pub const CHARSET: &str = " ',-.ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";

/// Every instruction of a kind that the scene offers, with one fixed wording each, in order. Each means exactly one thing.
pub fn candidates(scene: &SemanticScene<'_>, kind: InstructionKind) -> Vec<Instruction> {
    let found = match kind {
        InstructionKind::GoToRoom => go_to_room::candidates(scene),
        InstructionKind::FindObject => find_object::candidates(scene),
    };
    found
        .into_iter()
        .filter(|instruction| {
            let fits = instruction.text.len() <= MAX_TEXT_LEN;
            fits && instruction.text.chars().all(|c| CHARSET.contains(c))
                && instruction.tokens().is_ok()
        })
        .collect()
}

/// One of `candidates`, with a wording of its own, both drawn from `key`; `None` when there is none.
///
/// # Determinism
/// Equal candidates and keys give equal instructions.
pub fn choose(candidates: &[Instruction], key: RandomKey) -> Option<Instruction> {
    let mut stream = key.child("instruction").stream();
    let chosen = stream.choose(candidates)?;
    Some(chosen.reworded(stream.bits()))
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
    choose(&candidates(scene, kind), key).ok_or_else(|| SemanticsError::NoInstruction {
        house: scene.house().name.clone(),
        kind: kind.name(),
        why: match kind {
            InstructionKind::GoToRoom => {
                "no room can be told from all others by its kind and contents"
            }
            InstructionKind::FindObject => "no object can be told from all others by words",
        },
    })
}
