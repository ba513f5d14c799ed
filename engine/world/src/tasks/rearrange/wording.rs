//! What is asked, in words.

use crate::episode::ObjectPlacement;
use crate::world::World;
use dwell_scene::ObjectId;
use dwell_semantics::form::{Form, Phrase, RequestStep};
use dwell_semantics::instruct::MAX_TEXT_LEN;
use dwell_semantics::refer::refer;
use dwell_semantics::vocabulary;
use std::collections::BTreeMap;

/// What is asked where the words for each thing are too many, or do not tell it apart.
const ASKED: &str = "Put all things back.";

/// The relation that a thing had to another one.
pub(super) type RestingRelation = (&'static str, ObjectId);

/// What a thing is in or on; `None` for what rests on the building.
pub(super) fn support_relation(world: &World, object: ObjectId) -> Option<RestingRelation> {
    let (house, state) = (world.house(), world.state());
    let boxes = house.object_boxes(state);
    let containers = state.containers_of(house, object, &boxes);
    let within = containers.first().map(|container| ("in", *container));
    let supports = state.supports_of(house, object);
    let on = supports.into_iter().flatten().next();
    within.or_else(|| on.map(|support| ("on", support)))
}

/// The instruction: what to do with each thing, where this is short and means exactly one thing; else to put all things back.
pub(super) fn instruction(
    world: &World,
    placements: &[ObjectPlacement],
    rested: &BTreeMap<ObjectId, RestingRelation>,
) -> String {
    let engines = world.engines();
    let scene = engines.semantics().scene(world.state());
    let phrase = |object: ObjectId| Some(Phrase::from(refer(&scene, object)?));
    let step = |one: &ObjectPlacement| {
        let object = phrase(one.object)?;
        if let Some(openness) = one.openness {
            let verb = if openness > 0.5 { "open" } else { "close" }.to_owned();
            return Some(RequestStep::Do { verb, object });
        }
        let (predicate, to) = rested.get(&one.object)?;
        Some(RequestStep::Put {
            object,
            predicate: (*predicate).to_owned(),
            to: phrase(*to)?,
        })
    };
    let said = || {
        let steps = placements.iter().map(step).collect::<Option<Vec<_>>>()?;
        let sentence = engines
            .semantics()
            .language()
            .say(&Form::Request(steps), None)?;
        let text = sentence.text;
        (text.len() <= MAX_TEXT_LEN && vocabulary::tokenize(&text).is_ok()).then_some(text)
    };
    said().unwrap_or_else(|| ASKED.to_owned())
}
