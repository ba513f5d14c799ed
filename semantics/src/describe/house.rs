//! The description of a house.

use super::room::describe_room;
use crate::english::{be, count, counted, list};
use crate::scene::SemanticScene;
use dwell_scene::{LevelId, RoomId};

fn rooms_by_noun(scene: &SemanticScene<'_>) -> Vec<String> {
    let mut groups: Vec<(&str, &str, usize)> = Vec::new();
    for room in scene.house().rooms.ids() {
        let facts = scene.semantics.room(room);
        match groups.iter_mut().find(|(noun, _, _)| *noun == facts.noun) {
            Some((_, _, number)) => *number += 1,
            None => groups.push((&facts.noun, &facts.plural, 1)),
        }
    }
    groups.sort_by(|p, q| p.0.cmp(q.0));
    groups
        .into_iter()
        .map(|(one, many, number)| counted(number, one, many))
        .collect()
}

/// The description of a house: its rooms, then each of them, storey by storey.
pub fn describe_house(scene: &SemanticScene<'_>) -> String {
    let house = scene.house();
    let (rooms, objects) = (house.rooms.len(), house.objects.len());
    let mut paragraphs = Vec::new();
    let storeys = house.levels.len().max(1);
    let storeys = if storeys == 1 {
        String::new()
    } else {
        format!(" on {} storeys", count(storeys))
    };
    let opening = match rooms {
        0 => "This house has no rooms.".to_owned(),
        1 => format!(
            "This house has one room{storeys}: {}.",
            list(&rooms_by_noun(scene))
        ),
        _ => format!(
            "This house has {} rooms{storeys}: {}.",
            count(rooms),
            list(&rooms_by_noun(scene))
        ),
    };
    let things = if objects == 1 { "thing" } else { "things" };
    paragraphs.push(format!(
        "{opening} There {} {} {things} in it.",
        be(objects),
        count(objects)
    ));
    let mut order: Vec<RoomId> = house.rooms.ids().collect();
    order.sort_by_key(|room| (house.rooms[*room].level, *room));
    let mut last: Option<LevelId> = None;
    for room in order {
        let level = house.rooms[room].level;
        let mut text = describe_room(scene, room);
        if house.levels.len() > 1 && last != Some(level) {
            text = format!("{}: {text}", storey(level));
            last = Some(level);
        }
        paragraphs.push(text);
    }
    paragraphs.join("\n")
}

fn storey(level: LevelId) -> String {
    match level.0 {
        0 => "On the ground floor".to_owned(),
        k => format!("On the {} floor", crate::english::ordinal(k as usize)),
    }
}
