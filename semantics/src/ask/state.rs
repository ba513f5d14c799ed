//! "Is the table lamp on?", "Is the refrigerator open?"

use super::asker::{Asker, Sight};
use super::{AskedQuestion, QuestionKind};
use crate::category::SemanticCategory;
use crate::form::{Clause, Quality, Question};
use crate::instruct::{is_opened, is_switched};
use dwell_scene::ObjectId;

/// A state of a thing that is arranged, so that a question about it has each of its answers as often.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StateToSet {
    /// A thing without a lever is switched on or off.
    Switch(ObjectId, bool),
    /// A thing is wide open, or closed.
    Open(ObjectId, bool),
}

/// How a state is set to be so, or not.
type SetState = fn(ObjectId, bool) -> StateToSet;

pub(super) fn candidates(asker: &Asker<'_>) -> Vec<AskedQuestion> {
    let mut found = Vec::new();
    for (object, room) in asker.things.iter().copied() {
        let is = |test: fn(&SemanticCategory) -> bool| {
            asker.scene.facts(object).category.is_some_and(test)
        };
        let shines = is(is_switched) && is_seen_to_be_on(asker, object);
        let opens = is(is_opened)
            && asker
                .scene
                .state
                .openness(asker.scene.house(), object)
                .is_some();
        let states: [(bool, &str, SetState); 2] = [
            (shines, "switched_on", StateToSet::Switch),
            (opens, "open", StateToSet::Open),
        ];
        let asked = states.iter().filter(|(applies, ..)| *applies);
        for (_, state, set) in asked {
            let Some(name) = asker.names(object).next() else {
                continue;
            };
            for (answer, is_so) in [("yes", true), ("no", false)] {
                let question = Question::Whether(Clause::Is {
                    subject: name.clone().into(),
                    quality: Quality::State((*state).to_owned()),
                });
                let sight = Sight {
                    seen: vec![object],
                    target: Some(object),
                    room,
                };
                let sets = (set(object, is_so), answer);
                found.extend(asker.ask_arranged(QuestionKind::State, question, sets, sight));
            }
        }
    }
    found
}

/// Returns whether a thing has a switch without a lever, and a light that shows whether it is on.
fn is_seen_to_be_on(asker: &Asker<'_>, object: ObjectId) -> bool {
    let house = asker.scene.house();
    let has_lever = || {
        let mut joints = house.joints_of(object);
        joints.any(|joint| house.joints[joint].toggles_switch)
    };
    let shines = || house.lights.iter().any(|light| light.object == object);
    house.objects[object].switch.is_some() && shines() && !has_lever()
}
