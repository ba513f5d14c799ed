//! Instructions that several things fit.

use super::DialogueTopic;
use crate::check::{Addressee, Checker};
use crate::form::{Description, Form, Modifier, Noun, Quantifier, RequestStep};
use crate::instruct::{self, is_search_target};
use crate::refer::room_phrase;
use crate::scene::{SemanticScene, Term};
use dwell_scene::{ObjectId, RoomId, interrupt};
use std::collections::BTreeSet;

/// "Find the chair.", of a house with several chairs.
#[derive(Clone, Debug, PartialEq)]
pub struct AmbiguousInstruction {
    /// The form, and the phrase that several things fit.
    pub topic: DialogueTopic,
    /// The words.
    pub text: String,
    /// The things that the phrase fits, ascending; at least two.
    pub things: Vec<ObjectId>,
}

/// Every instruction to find a thing by its noun, its noun and colour, or its noun and room that fits 2 to `most` things of a scene and is
/// undecided of none, in order.
///
/// All its things are such as are looked for, and lie in rooms. The ambiguity is that of the text as it is read.
pub fn ambiguous_instructions(scene: &SemanticScene<'_>, most: usize) -> Vec<AmbiguousInstruction> {
    let checker = Checker::new(scene, Addressee::default());
    let mut descriptions: BTreeSet<Description> = BTreeSet::new();
    for object in scene.house().objects.ids() {
        let facts = scene.facts(object);
        let (Some(room), true) = (
            scene.room_of(object),
            facts.category.is_some_and(is_search_target),
        ) else {
            continue;
        };
        let plain = Description::new(Quantifier::The, Noun::Object(facts.noun.clone()));
        if let Some((word, _)) = facts.spoken_colors().first() {
            let mut colored = plain.clone();
            colored.colors.push((*word).to_owned());
            descriptions.insert(colored);
        }
        descriptions.insert(in_room(scene, &plain, room));
        descriptions.insert(plain);
    }
    let found = descriptions.into_iter().filter_map(|description| {
        interrupt::unwind_if_cancelled();
        ambiguous(&checker, description, most)
    });
    found.collect()
}

fn in_room(scene: &SemanticScene<'_>, plain: &Description, room: RoomId) -> Description {
    let within = Modifier::new("in_room", [room_phrase(scene, room)]);
    plain.clone().with_modifier(within)
}

fn ambiguous(
    checker: &Checker<'_>,
    description: Description,
    most: usize,
) -> Option<AmbiguousInstruction> {
    let scene = checker.scene();
    let fits = checker.matching_terms(&description);
    if !(2..=most).contains(&fits.len()) || checker.possible_count(&description) != fits.len() {
        return None;
    }
    let things: Option<Vec<ObjectId>> = fits.iter().map(|term| term.object()).collect();
    let things = things?;
    let can_be_meant = |thing: &ObjectId| {
        let sought = scene.facts(*thing).category.is_some_and(is_search_target);
        sought && scene.room_of(*thing).is_some() && scene.holder(*thing).is_none()
    };
    if !things.iter().all(can_be_meant) {
        return None;
    }
    let form = Form::Request(vec![RequestStep::Do {
        verb: "find".to_owned(),
        object: description.into(),
    }]);
    let language = scene.semantics.language();
    let text = instruct::say(language, &form, None)?.text;
    // As whoever is told it reads it.
    let instruction = language.read(&text).ok()?.forms.into_iter().next()?;
    let [found] = &checker.ambiguities(&instruction)[..] else {
        return None;
    };
    let terms: Vec<Term> = things.iter().copied().map(Term::Object).collect();
    (found.terms == terms).then(|| AmbiguousInstruction {
        topic: DialogueTopic {
            phrase: found.phrase.clone(),
            instruction,
        },
        text,
        things,
    })
}
