//! "Is the table lamp on?", "Is the refrigerator open?"

use super::question_generator::{AnswerEvidence, QuestionGenerator};
use super::{AskedQuestion, QuestionKind};
use crate::category::SemanticCategory;
use crate::form::{Clause, Quality, Question};
use crate::instruct::{is_openable, is_toggleable};
use dwell_scene::ObjectId;

/// A state of a thing that is arranged, so that a question about it has each of its answers as often.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StateArrangement {
    /// A thing without a lever is switched on or off.
    Switch(ObjectId, bool),
    /// A thing is wide open, or closed.
    Open(ObjectId, bool),
}

/// How a state is set to be so, or not.
type SetState = fn(ObjectId, bool) -> StateArrangement;

pub(super) fn candidates(asker: &QuestionGenerator<'_>) -> Vec<AskedQuestion> {
    let mut found = Vec::new();
    for (object, room) in asker.things.iter().copied() {
        let is = |test: fn(&SemanticCategory) -> bool| {
            asker.scene.facts(object).category.is_some_and(test)
        };
        let shines = is(is_toggleable) && is_seen_to_be_on(asker, object);
        let opens = is(is_openable)
            && asker
                .scene
                .state
                .openness(asker.scene.house(), object)
                .is_some();
        let states: [(bool, &str, SetState); 2] = [
            (shines, "switched_on", StateArrangement::Switch),
            (opens, "open", StateArrangement::Open),
        ];
        let asked = states.iter().filter(|(applies, ..)| *applies);
        for (_, state, set) in asked {
            let Some(name) = asker.referring_expressions(object).next() else {
                continue;
            };
            for (answer, is_so) in [("yes", true), ("no", false)] {
                let question = Question::Whether(Clause::Is {
                    subject: name.clone().into(),
                    quality: Quality::State((*state).to_owned()),
                });
                let sight = AnswerEvidence {
                    seen: vec![object],
                    target: Some(object),
                    room,
                };
                let sets = (set(object, is_so), answer);
                found.extend(asker.compose_rearranged(QuestionKind::State, question, sets, sight));
            }
        }
    }
    found
}

/// Returns whether a thing has a switch without a lever, and a light that shows whether it is on.
fn is_seen_to_be_on(asker: &QuestionGenerator<'_>, object: ObjectId) -> bool {
    let house = asker.scene.house();
    let has_lever = || {
        let mut joints = house.joints_of(object);
        joints.any(|joint| house.joints[joint].toggles_switch)
    };
    let shines = || house.lights.iter().any(|light| light.object == object);
    house.objects[object].switch.is_some() && shines() && !has_lever()
}
