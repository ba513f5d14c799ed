//! Counted facts of one house.

use dwell_houses::generate::GeneratedHouse;
use dwell_scene::{House, Room, units};
use glam::Vec2;
use std::collections::BTreeSet;

/// One room.
#[derive(Clone, Debug)]
pub(crate) struct RoomFacts {
    /// Its name without a number.
    pub(crate) kind: String,
    pub(crate) objects: usize,
}

/// One house.
#[derive(Clone, Debug)]
pub(crate) struct Facts {
    pub(crate) seed: u64,
    pub(crate) rooms: Vec<RoomFacts>,
    pub(crate) objects: usize,
    pub(crate) categories: BTreeSet<String>,
    /// Colours of materials, to 16 steps a channel.
    pub(crate) colours: BTreeSet<String>,
    pub(crate) area_m2: f64,
    pub(crate) storeys: usize,
    /// The kinds of two rooms with a door or an opening between them, sorted. With repetition.
    pub(crate) links: Vec<String>,
    /// Kind of room and category of every thing in it, sorted. With repetition.
    pub(crate) things: Vec<(String, String)>,
}

impl Facts {
    pub(crate) fn of(seed: u64, generated: &GeneratedHouse) -> Self {
        let house = &generated.house;
        let mut rooms: Vec<RoomFacts> = house
            .rooms
            .iter()
            .map(|room| RoomFacts {
                kind: kind(room),
                objects: 0,
            })
            .collect();
        let mut things = Vec::new();
        for object in &house.objects {
            if let Some(room) = object.room {
                let room = &mut rooms[room.0 as usize];
                room.objects += 1;
                things.push((room.kind.clone(), object.category.coarse.clone()));
            }
        }
        things.sort_unstable();
        let colour = |linear: [f32; 3]| {
            let step = |c: f32| (units::srgb_from_linear(c) * 15.0).round() as u8;
            let [r, g, b] = linear.map(step);
            format!("{r:x}{g:x}{b:x}")
        };
        Self {
            seed,
            objects: house.objects.len(),
            categories: house
                .objects
                .iter()
                .map(|object| object.category.coarse.clone())
                .collect(),
            colours: house
                .materials
                .iter()
                .map(|material| {
                    let image = material
                        .texture
                        .map_or([1.0; 3], |id| house.textures[id].mean_linear());
                    colour([0, 1, 2].map(|k| material.base_color[k] * image[k]))
                })
                .collect(),
            area_m2: house
                .rooms
                .iter()
                .map(|room| f64::from(room.area_m2()))
                .sum(),
            storeys: house.levels.len(),
            links: links(house),
            rooms,
            things,
        }
    }
}

/// A room's name without the number that makes it unique.
fn kind(room: &Room) -> String {
    let name = room.name.as_str();
    match name.rsplit_once('_') {
        Some((kind, number)) if number.bytes().all(|b| b.is_ascii_digit()) => kind.to_owned(),
        _ => name.to_owned(),
    }
}

/// Rooms whose floors meet: halves of a doorway belong to the rooms on both sides.
fn links(house: &House) -> Vec<String> {
    let edges = |room: &Room| -> Vec<[Vec2; 2]> {
        let sides = room
            .footprint
            .iter()
            .flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]);
        sides.collect()
    };
    let all: Vec<(usize, [Vec2; 2])> = house
        .rooms
        .iter()
        .enumerate()
        .flat_map(|(k, room)| edges(room).into_iter().map(move |edge| (k, edge)))
        .collect();
    let mut found = BTreeSet::new();
    for (a, edge) in &all {
        for (b, other) in &all {
            let same = |p: Vec2, q: Vec2| (p - q).length() < 1e-3;
            let meet = same(edge[0], other[1]) && same(edge[1], other[0])
                || same(edge[0], other[0]) && same(edge[1], other[1]);
            let rooms = house.rooms.as_slice();
            if a < b && meet && rooms[*a].level == rooms[*b].level {
                found.insert((*a, *b));
            }
        }
    }
    let rooms = house.rooms.as_slice();
    let pair = |(a, b): (usize, usize)| {
        let mut kinds = [kind(&rooms[a]), kind(&rooms[b])];
        kinds.sort();
        kinds.join(" – ")
    };
    let mut links: Vec<String> = found.into_iter().map(pair).collect();
    links.sort_unstable();
    links
}
