//! Descriptions of rooms that mean exactly one.

use crate::english::with_article;
use crate::scene::SemanticScene;
use dwell_scene::RoomId;
use dwell_scene::interrupt;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A description of a room: its noun, and a kind of thing that it alone holds when there are several such rooms.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RoomExpression {
    /// Spoken noun.
    pub noun: String,
    /// Spoken noun of a thing in it.
    pub with: Option<String>,
}

impl RoomExpression {
    /// Every room that fits, in order.
    pub fn matches(&self, scene: &SemanticScene<'_>) -> Vec<RoomId> {
        let with = self.with.as_ref().map(|noun| scene.distractors(noun));
        let holds = |room: &RoomId| {
            let with = with.as_ref();
            with.is_none_or(|things| things.in_rooms().contains_key(room))
        };
        scene
            .house()
            .rooms
            .ids()
            .filter(|room| scene.semantics.room(*room).is_called(&self.noun))
            .filter(holds)
            .collect()
    }

    /// "the bedroom with a desk".
    pub fn definite(&self) -> String {
        let with = self
            .with
            .as_ref()
            .map_or_else(String::new, |noun| format!(" with {}", with_article(noun)));
        format!("the {}{with}", self.noun)
    }
}

/// The shortest description of `room` that fits no other; `None` when there is none, and for rooms without a kind.
///
/// Of the things that only this room holds, the largest kind is named: it is seen first.
pub fn refer_to_room(scene: &SemanticScene<'_>, room: RoomId) -> Option<RoomExpression> {
    let facts = scene.semantics.room(room);
    let unnamed = facts.kind.is_none_or(|kind| kind.name == "room");
    let unique = |expression: &RoomExpression| expression.matches(scene) == [room];
    let plain = RoomExpression {
        noun: facts.noun.clone(),
        with: None,
    };
    if !unnamed && unique(&plain) {
        return Some(plain);
    }
    let mut things: BTreeMap<&str, f32> = BTreeMap::new();
    for object in scene.objects_in(room).iter().copied() {
        let worth_naming = |row: &crate::category::SemanticCategory| {
            !row.structure
                && !["door", "window", "curtain", "blinds", "unknown"].contains(&row.name)
        };
        interrupt::check();
        if scene.facts(object).category.is_some_and(worth_naming) {
            let volume = scene.extent(object).bounds.volume();
            let largest = things.entry(&scene.facts(object).noun).or_insert(0.0);
            *largest = largest.max(volume);
        }
    }
    let mut things: Vec<(&str, f32)> = things.into_iter().collect();
    things.sort_by(|p, q| q.1.total_cmp(&p.1).then(p.0.cmp(q.0)));
    things
        .into_iter()
        .map(|(noun, _)| RoomExpression {
            noun: facts.noun.clone(),
            with: Some(noun.to_owned()),
        })
        .find(unique)
}
