//! Where things belong, looked up apart from the engine: the rows of `assets/tidy_rules.csv`, and rays to what is below a thing.

use dwell::World;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::{ObjectId, StructureKind, SurfaceOwner};
use glam::Vec3;
use std::collections::BTreeSet;

/// The rows of the table: classes of things, classes of places, kinds of rooms.
///
/// # Panics
/// When a row has other than three fields.
pub fn rows() -> Vec<[BTreeSet<String>; 3]> {
    let text = include_str!("../../assets/tidy_rules.csv");
    let rows = text.lines().skip(1).map(|row| {
        let fields: Vec<BTreeSet<String>> = row
            .split(',')
            .map(|field| {
                field
                    .split(';')
                    .filter(|word| !word.is_empty())
                    .map(str::to_owned)
                    .collect()
            })
            .collect();
        fields.try_into().expect("three fields")
    });
    rows.collect()
}

/// What lies straight below points of a thing's foot: classes of furniture, through loose things, and the floor.
pub fn below(world: &World, object: ObjectId, deepest: usize) -> BTreeSet<String> {
    let (house, rays) = (world.house(), world.rays());
    let bounds = house.object_bounds(world.state(), object);
    let own = house.entity_of_object(object);
    let mut found = BTreeSet::new();
    for k in 0..25 {
        let share = |k: usize| 0.1 + 0.2 * k as f32;
        let x = bounds.min.x + bounds.size().x * share(k % 5);
        let z = bounds.min.z + bounds.size().z * share(k / 5);
        let ray = Ray::new(Vec3::new(x, bounds.min.y + 0.02, z), Vec3::NEG_Y).with_range(0.0, 0.08);
        let Some(hit) = rays.closest_excluding(&ray, RayMask::EYE, own) else {
            continue;
        };
        match rays.surface(&hit).owner {
            SurfaceOwner::Structure(piece) => {
                if house.structure[piece].kind == StructureKind::Floor {
                    found.insert("floor".to_owned());
                }
            }
            SurfaceOwner::Part(part) => {
                let other = house.parts[part].object;
                found.insert(house.objects[other].category.coarse.clone());
                if house.objects[other].pickable && deepest > 0 {
                    found.extend(below(world, other, deepest - 1));
                }
            }
        }
    }
    found
}

/// Whether a thing is where a row says; `None` without a row for it.
pub fn is_tidy(world: &World, object: ObjectId) -> Option<bool> {
    let house = world.house();
    let class = &house.objects[object].category.coarse;
    let own: Vec<_> = rows()
        .into_iter()
        .filter(|row| row[0].contains(class))
        .collect();
    if own.is_empty() {
        return None;
    }
    let middle = house.object_bounds(world.state(), object).center();
    let room = house.room_at(middle);
    let kind = room.and_then(|room| world.engines().semantics().room(room).kind);
    let places = below(world, object, 4);
    Some(own.iter().any(|row| {
        let fits_room = row[2].is_empty() || kind.is_some_and(|kind| row[2].contains(kind.name));
        fits_room && !row[1].is_disjoint(&places)
    }))
}
