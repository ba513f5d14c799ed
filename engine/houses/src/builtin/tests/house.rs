//! Tables, names, meshes, bytes.

use super::support::apartment;
use crate::import::category;
use dwell_furniture::testing::meshes::assert_closed;
use dwell_furniture::testing::overlap::{ConvexPiece, object_pieces, penetration_depth};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::material::library;
use dwell_scene::rays::RayScene;
use dwell_scene::{Aabb, Mobility, ReceptacleKind, Room, State};
use glam::{Vec2, Vec3};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Instant;

#[test]
fn the_apartment_is_large_and_varied_enough() {
    let house = apartment();
    let kinds: BTreeSet<&str> = house.rooms.iter().map(Room::kind).collect();
    assert!(kinds.len() >= 5, "{kinds:?}");
    let categories: BTreeSet<&str> = house
        .objects
        .iter()
        .map(|object| object.category.coarse.as_str())
        .collect();
    let models: BTreeSet<&str> = house
        .objects
        .iter()
        .map(|object| object.model.as_str())
        .collect();
    let area: f32 = house.rooms.iter().map(Room::area_m2).sum();
    println!(
        "{} objects, {} categories, {} models, {} triangles, {} materials, {} textures, {area:.1} m2",
        house.objects.len(),
        categories.len(),
        models.len(),
        house.triangle_count(),
        house.materials.len(),
        house.textures.len(),
    );
    assert!(house.objects.len() >= 100 && categories.len() >= 40 && models.len() >= 60);
    assert!((80.0..=110.0).contains(&area), "{area} m2");
}

#[test]
fn every_name_means_something() {
    let house = apartment();
    for object in &house.objects {
        let row = category([object.category.coarse.as_str()])
            .unwrap_or_else(|| panic!("{}: no category", object.name));
        assert_eq!(
            row.name, object.category.coarse,
            "{}: an alias",
            object.name
        );
        assert_eq!(row.nyu40_name, object.category.nyu40, "{}", object.name);
        assert!(
            object.name.starts_with(&object.category.coarse),
            "{}",
            object.name
        );
        assert!(!object.name.contains('/') && object.part_count > 0);
    }
    for material in &house.materials {
        assert!(
            library().get(&material.substance).is_some(),
            "{}: {}",
            material.name,
            material.substance
        );
        assert!(!material.name.contains('/'), "{}", material.name);
    }
    let rooms = include_str!("../../../../../assets/rooms.csv");
    for room in &house.rooms {
        for kind in &room.kinds {
            let name = kind.replace(' ', "_");
            assert!(
                rooms
                    .lines()
                    .any(|line| line.starts_with(&format!("{name},"))),
                "{kind}"
            );
        }
    }
}

#[test]
fn every_mesh_is_closed_and_looks_outwards() {
    let house = apartment();
    let owners = house
        .structure
        .iter()
        .map(|piece| (piece.name.as_str(), piece.mesh));
    let parts = house
        .parts
        .iter()
        .map(|part| (house.objects[part.object].model.as_str(), part.mesh));
    for (name, mesh) in owners.chain(parts).collect::<BTreeSet<_>>() {
        let mesh = &house.meshes[mesh];
        assert_closed(name, mesh);
        assert!(
            mesh.enclosed_volume_m3() > 1e-9,
            "{name}: {} m3",
            mesh.enclosed_volume_m3()
        );
        assert!(
            mesh.normals.len() == mesh.positions.len() && mesh.uvs.len() == mesh.positions.len(),
            "{name}"
        );
    }
}

/// Seen from the middle of a room, walls, floors, ceilings, doors and windows fill the sphere: no ray gets out.
#[test]
fn the_shell_closes_every_room() {
    const RAYS: usize = 4000;
    let house = Arc::new(apartment().clone());
    let scene = RayScene::new(house.clone());
    let state = State::new(&house);
    let openings: Vec<Aabb> = house
        .objects
        .iter_ids()
        .filter(|(_, object)| ["door", "window"].contains(&object.category.coarse.as_str()))
        .map(|(id, _)| house.object_bounds(&state, id).grown(0.01))
        .collect();
    let mut met = BTreeMap::<String, usize>::new();
    for room in &house.rooms {
        let eye = room.bounds.center();
        assert!(room.contains_xz(Vec2::new(eye.x, eye.z)), "{}", room.name);
        'rays: for k in 0..RAYS {
            // Points of a Fibonacci lattice.
            let up = 1.0 - 2.0 * (k as f32 + 0.5) / RAYS as f32;
            let turn = k as f32 * 2.399_963_2;
            let level = (1.0 - up * up).sqrt();
            let toward = Vec3::new(level * turn.cos(), up, level * turn.sin());
            let mut ray = Ray::new(eye, toward);
            // Through furniture, up to the building, a door or a window.
            while let Some(hit) = scene.closest(&ray, RayMask::ALL) {
                let id = hit.id as usize - 1;
                if let Some(piece) = house.structure.iter().nth(id) {
                    *met.entry(format!("{:?}", piece.kind)).or_default() += 1;
                    continue 'rays;
                }
                let object = house.objects.iter().nth(id - house.structure.len());
                let category = object.unwrap().category.coarse.as_str();
                if ["door", "window"].contains(&category) {
                    *met.entry(category.to_owned()).or_default() += 1;
                    continue 'rays;
                }
                ray.near_m = hit.distance_m + 1e-3;
            }
            // Casements have joints of millimetres all round.
            let along = (0..2000_u16).map(|k| eye + toward * (0.01 * f32::from(k)));
            let joint = along
                .into_iter()
                .any(|p| openings.iter().any(|b| b.contains(p)));
            assert!(joint, "{}: {toward} leads out of the house", room.name);
        }
    }
    let names: Vec<&str> = met.keys().map(String::as_str).collect();
    assert_eq!(names, ["Ceiling", "Floor", "Wall", "door", "window"]);
}

#[test]
fn a_second_house_is_the_same_to_the_byte() {
    let start = Instant::now();
    let again = crate::builtin::build("apartment").unwrap();
    println!("built in {:.0} ms", start.elapsed().as_secs_f64() * 1e3);
    assert!(again == *apartment());
}

#[test]
fn every_room_is_lit_and_something_sounds() {
    let house = apartment();
    for (id, room) in house.rooms.iter_ids() {
        let lit = house.lights.iter().any(|light| {
            let object = &house.objects[light.object];
            object.room == Some(id) && object.switch == Some(true) && light.power_w > 0.0
        });
        assert!(lit, "{} has no light that is on", room.name);
    }
    let mut sounding = BTreeMap::new();
    for emitter in &house.emitters {
        if house.objects[emitter.object].switch != Some(false) {
            sounding.insert(emitter.signal.as_str(), emitter.level_db);
        }
    }
    assert!(
        sounding.contains_key("radio") && sounding.contains_key("television"),
        "{sounding:?}"
    );
}

#[test]
fn masses_and_sizes_are_those_of_a_household() {
    let house = apartment();
    for (id, object) in house.objects.iter_ids() {
        let mass: f32 = object
            .parts()
            .map(|part| house.parts[part].mass_kg.unwrap_or(0.0))
            .sum();
        if object.pickable {
            assert!(
                (0.01..8.0).contains(&mass),
                "{} weighs {mass} kg",
                object.name
            );
        }
        assert!(mass < 450.0, "{} weighs {mass} kg", object.name);
        if object.mobility == Mobility::Movable {
            let hung = house.joints.iter().filter(|j| j.object == id).count() as u32;
            assert_eq!(
                object.part_count,
                1 + hung,
                "{} would fall apart",
                object.name
            );
        }
    }
}

#[test]
fn things_stand_in_the_room_they_name() {
    let house = apartment();
    let state = State::new(house);
    for (id, object) in house.objects.iter_ids() {
        if ["door", "window"].contains(&object.category.coarse.as_str()) {
            continue;
        }
        let middle = house.object_bounds(&state, id).center();
        let room = &house.rooms[object.room.unwrap()];
        assert!(
            room.contains_xz(Vec2::new(middle.x, middle.z)),
            "{} at {middle} is not in {}",
            object.name,
            room.name
        );
    }
}

/// A ball of 4 mm on the floor of every receptacle touches it, and has free space above.
#[test]
fn receptacles_have_a_floor_and_free_space() {
    let house = apartment();
    for receptacle in &house.receptacles {
        let object = &house.objects[receptacle.object];
        let space = receptacle.space_in_part;
        let at = format!("{} {}", object.name, receptacle.name);
        assert!(
            space.size().min_element() > 0.02,
            "{at}: {:?}",
            space.size()
        );
        let floor = space.center().with_y(space.min.y);
        let world = house.parts[receptacle.part].world_from_part;
        let pieces = object_pieces(house, receptacle.object);
        let touches = |lift: f32| {
            let center = world.transform_point(floor + Vec3::Y * (0.004 + lift));
            let ball = ConvexPiece::new(
                &dwell_scene::Collider::Ball {
                    center,
                    radius: 0.004,
                },
                &dwell_scene::Pose::IDENTITY,
            );
            pieces
                .iter()
                .any(|piece| penetration_depth(&ball, piece, 0.0) > 0.0)
        };
        assert!(touches(-0.004), "{at}: nothing under its floor");
        assert!(!touches(0.004), "{at}: its floor is buried");
        assert!(matches!(
            receptacle.holding,
            ReceptacleKind::On | ReceptacleKind::In
        ));
    }
}
