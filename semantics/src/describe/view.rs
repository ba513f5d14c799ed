//! The description of a view.

use super::item::items;
use super::text::{GroundedText, TextWriter};
use crate::check::{Checker, Listener};
use crate::form::{Clause, Description, Form, Modifier, Noun, Phrase, Quantifier};
use crate::predicates;
use crate::refer::room_phrase;
use crate::scene::{SemanticScene, Term};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, ObjectId};

/// The sides of a viewer, in the order of telling.
const SIDES: [&str; 3] = ["on_left", "straight_ahead", "on_right"];

/// The description of what a listener sees, side by side: "You are in the kitchen. On your left you see a table." Without a viewer
/// nothing is seen. `wording` draws the wordings.
pub fn describe_view(
    scene: &SemanticScene<'_>,
    listener: Listener,
    wording: Option<RandomKey>,
) -> GroundedText {
    let checker = Checker::new(scene, listener);
    let mut writer = TextWriter::new(&checker, wording);
    let room = listener
        .agent
        .and_then(|agent: AgentId| scene.room_of_agent(agent));
    if let Some(room) = room {
        writer.say(Form::Claim(Clause::Holds {
            predicate: "in_room".to_owned(),
            arguments: vec![Phrase::Listener, room_phrase(scene, room)],
        }));
    }
    let holds = |name: &str, object: &ObjectId| {
        let viewer = listener.viewer.as_ref();
        predicates::find(name).is_ok_and(|predicate| {
            let truth = predicate.holds(scene, &[Term::Object(*object)], viewer);
            truth.is_true()
        })
    };
    let objects = scene.house().objects.ids();
    let visible: Vec<ObjectId> = objects.filter(|object| holds("visible", object)).collect();
    let seen = Modifier::new("visible", []);
    for side in SIDES {
        let here: Vec<ObjectId> = visible
            .iter()
            .copied()
            .filter(|object| holds(side, object))
            .collect();
        let place = [Modifier::new(side, []), seen.clone()];
        writer.there_are(&items(scene, &here, &here), &place);
    }
    if visible.is_empty() && listener.viewer.is_some() {
        let nothing = Noun::Object(Noun::ANY_OBJECT.to_owned());
        writer.there_are(&[Description::new(Quantifier::No, nothing)], &[seen]);
    }
    writer.finish()
}
