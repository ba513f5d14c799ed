//! "Go to the kitchen."

use super::task::{Instruction, InstructionGoal, InstructionKind};
use crate::refer::refer_to_room;
use crate::scene::SemanticScene;

pub(super) fn candidates(scene: &SemanticScene<'_>) -> Vec<Instruction> {
    let rooms = scene.house().rooms.ids();
    rooms
        .filter_map(|room| {
            let expression = refer_to_room(scene, room)?;
            let goal = InstructionGoal {
                rooms: vec![room],
                objects: Vec::new(),
                radius_m: 0.0,
                in_sight: false,
            };
            Some(Instruction::new(
                InstructionKind::GoToRoom,
                expression.definite(),
                goal,
            ))
        })
        .collect()
}
