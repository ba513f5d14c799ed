//! "Go to the kitchen."

use super::task::{Instruction, InstructionGoal, InstructionKind};
use crate::form::RequestStep;
use crate::refer::refer_to_room;
use crate::scene::SemanticScene;

pub(super) fn candidates(scene: &SemanticScene<'_>) -> Vec<Instruction> {
    let rooms = scene.house().rooms.ids();
    rooms
        .filter_map(|room| {
            let description = refer_to_room(scene, room)?;
            let goal = InstructionGoal::rooms(vec![room]);
            let step = RequestStep::GoTo(description.into());
            let language = scene.semantics.language();
            Instruction::new(language, InstructionKind::GoToRoom, step, goal)
        })
        .collect()
}
