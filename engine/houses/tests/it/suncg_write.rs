//! A house written as SUNCG and read back is the same house, apart from what the list of losses names.
#![allow(
    clippy::unwrap_used,
    reason = "tests stop at the first surprise and compare exact numbers"
)]

use crate::common;

use std::collections::BTreeMap;

use dwell_houses::{ExportLoss, LoadReport, WarningKind, open, suncg};
use dwell_scene::{Aabb, House, Material, Mobility, ObjectId, Room, State, units};

struct RoundTrip {
    again: House,
    report: LoadReport,
    losses: Vec<ExportLoss>,
}

fn round_trip(house: &House) -> RoundTrip {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("root");
    let losses = suncg::write(house, &root).unwrap();
    let (again, report) = open(&root.to_string_lossy()).unwrap();
    RoundTrip {
        again,
        report,
        losses,
    }
}

fn apartment() -> (House, RoundTrip) {
    let house = open("builtin:apartment").unwrap().0;
    let trip = round_trip(&house);
    (house, trip)
}

fn close(a: &Aabb, b: &Aabb, tolerance: f32) -> bool {
    a.min.abs_diff_eq(b.min, tolerance) && a.max.abs_diff_eq(b.max, tolerance)
}

type Look = (Option<(u32, u64)>, [u8; 3], u32);

/// Returns what the format keeps of a material: the image (its name may change), colour and opacity.
fn seen(house: &House, material: &Material) -> Look {
    let image = |rgba: &[u8]| {
        rgba.iter().fold(0_u64, |hash, byte| {
            hash.wrapping_mul(31).wrapping_add(u64::from(*byte))
        })
    };
    let texture = material
        .texture
        .map(|id| (house.textures[id].width, image(house.textures[id].rgba())));
    let color = material
        .base_color
        .map(|c| (units::srgb_from_linear(c) * 255.0).round() as u8);
    (texture, color, material.opacity.to_bits())
}

/// The objects stand in the same places, look the same and mean the same.
fn assert_objects_match(house: &House, again: &House) {
    assert_eq!(again.objects.len(), house.objects.len());
    let (start, start_again) = (State::new(house), State::new(again));
    let [looks, looks_again] = [house, again].map(|house| {
        house
            .materials
            .iter()
            .map(|m| seen(house, m))
            .collect::<Vec<Look>>()
    });
    for (id, object) in house.objects.iter_ids() {
        let twin = &again.objects[ObjectId(id.0)];
        let (a, b) = (
            house.object_bounds(&start, id),
            again.object_bounds(&start_again, id),
        );
        assert!(close(&a, &b, 1e-4), "{}: {a:?} became {b:?}", object.name);
        assert_eq!(twin.category, object.category, "{}", object.name);
        assert_eq!(twin.room, object.room, "{}", object.name);
        let shown = |house: &House, looks: &[Look], id: ObjectId| {
            let parts = house.objects[id].parts().map(|part| &house.parts[part]);
            let mut triangles: BTreeMap<_, usize> = BTreeMap::new();
            for part in parts {
                let mesh = &house.meshes[part.mesh];
                for k in 0..mesh.triangles.len() {
                    let material = part.materials[usize::from(mesh.slot(k))];
                    *triangles.entry(looks[material.0 as usize]).or_default() += 1;
                }
            }
            triangles
        };
        assert_eq!(
            shown(again, &looks_again, id),
            shown(house, &looks, id),
            "{}",
            object.name
        );
    }
    assert_eq!(again.triangle_count(), house.triangle_count());
}

#[test]
fn the_apartment_keeps_rooms_and_floors() {
    let (house, trip) = apartment();
    let rooms = |house: &House| -> Vec<(Vec<String>, f32, f32)> {
        house
            .rooms
            .iter()
            .map(|room| (room.kinds.clone(), room.floor_y, room.ceiling_y))
            .collect()
    };
    assert_eq!(rooms(&trip.again), rooms(&house));
    for (room, again) in house.rooms.iter().zip(&trip.again.rooms) {
        // The outline becomes that of the floor's slab, which reaches under the walls.
        let (before, after) = (room.area_m2(), again.area_m2());
        assert!(
            (0.99 * before..1.3 * before).contains(&after),
            "{}: {before} m2 became {after}",
            room.name
        );
    }
    assert_eq!(trip.again.structure.len(), house.structure.len());
    assert!(!trip.losses.is_empty());
}

#[test]
fn the_apartment_keeps_objects_places_looks_and_categories() {
    let (house, trip) = apartment();
    assert_objects_match(&house, &trip.again);
}

#[test]
fn the_apartment_reads_back_without_damage() {
    let (_, trip) = apartment();
    let serious = |damage: &WarningKind| {
        !matches!(
            damage,
            WarningKind::DegenerateTriangles
                | WarningKind::Simplified { .. }
                | WarningKind::Unmapped { .. }
                | WarningKind::MissingField { .. }
        )
    };
    let serious: Vec<_> = trip
        .report
        .warnings()
        .iter()
        .filter(|w| serious(&w.kind))
        .collect();
    assert!(serious.is_empty(), "{serious:#?}");
}

#[test]
fn the_apartment_keeps_its_hinged_doors() {
    let (house, trip) = apartment();
    let doors = |house: &House| -> Vec<(usize, f32)> {
        let hinged = house
            .joints
            .iter()
            .filter(|joint| house.objects[joint.object].category.coarse == "door");
        hinged
            .map(|joint| {
                (
                    joint.object.0 as usize,
                    (joint.initial - joint.closed).abs(),
                )
            })
            .collect()
    };
    let (before, after) = (doors(&house), doors(&trip.again));
    assert!(!before.is_empty());
    assert_eq!(
        before.len(),
        after.len(),
        "{before:?} became {after:?}\n{}\n{:#?}",
        trip.report,
        trip.losses
    );
    for ((object, ajar), (object_again, ajar_again)) in before.into_iter().zip(after) {
        assert_eq!(object, object_again);
        assert!(
            (ajar - ajar_again).abs() < 0.02,
            "object {object}: {ajar} became {ajar_again}"
        );
    }
}

#[test]
fn the_apartment_keeps_lights_and_sounds() {
    let (house, trip) = apartment();
    let lights = |house: &House| -> Vec<(ObjectId, [i32; 3], f32)> {
        let place = |light: &dwell_scene::Light| {
            let world = house.parts[light.part]
                .world_from_part
                .transform_point(light.position);
            (
                light.object,
                world.to_array().map(|x| (x * 1000.0).round() as i32),
                light.power_w,
            )
        };
        let mut lights: Vec<_> = house.lights.iter().map(place).collect();
        lights.sort_by_key(|(object, place, _)| (*object, *place));
        lights
    };
    assert_eq!(lights(&trip.again), lights(&house));
    let signals = |house: &House| -> Vec<(ObjectId, String)> {
        let mut signals: Vec<_> = house
            .emitters
            .iter()
            .map(|e| (e.object, e.signal.clone()))
            .collect();
        signals.sort();
        signals
    };
    assert_eq!(signals(&trip.again), signals(&house));
}

#[test]
fn the_real_house_survives_two_languages() {
    let Some(real) = common::real() else { return };
    let trip = round_trip(&real.house);
    assert_objects_match(&real.house, &trip.again);
    let mobility = |house: &House| {
        house
            .objects
            .iter()
            .map(|o| o.mobility)
            .collect::<Vec<Mobility>>()
    };
    assert_eq!(mobility(&trip.again), mobility(&real.house));
    let rooms = |house: &House| house.rooms.iter().map(Room::area_m2).collect::<Vec<f32>>();
    assert_eq!(rooms(&trip.again), rooms(&real.house));
    let names = |house: &House| {
        house
            .structure
            .iter()
            .map(|piece| piece.name.clone())
            .collect::<Vec<String>>()
    };
    assert_eq!(names(&trip.again), names(&real.house));
}

#[test]
fn nothing_is_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let house = House::shoebox([4.0, 2.5, 3.0], &dwell_scene::ShoeboxMaterials::default()).unwrap();
    let error = suncg::write(&house, folder.path()).unwrap_err().to_string();
    assert!(
        error.ends_with(
            "cannot be written: something else stands there already; it is not replaced"
        ),
        "{error}"
    );
}

#[test]
fn a_shoebox_becomes_a_room() {
    let house = House::shoebox([4.0, 2.5, 3.0], &dwell_scene::ShoeboxMaterials::default()).unwrap();
    let trip = round_trip(&house);
    assert_eq!(trip.again.structure.len(), 6);
    assert!((trip.again.rooms.as_slice()[0].area_m2() - 12.0).abs() < 1e-4);
    let substances = |house: &House| {
        house
            .structure
            .iter()
            .map(|p| house.materials[p.materials[0]].substance.clone())
            .collect::<std::collections::BTreeSet<_>>()
    };
    assert_eq!(substances(&trip.again), substances(&house));
}
