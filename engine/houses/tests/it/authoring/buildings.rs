//! Buildings from plans.

use dwell_houses::HousesError;
use dwell_houses::authoring::{FileAccess, HousePlan, build};
use dwell_scene::{Collider, House, Mesh, StructureKind};
use glam::Vec3;
use serde_json::{Value, json};

fn built(plan: Value) -> House {
    let plan: HousePlan = serde_json::from_value(plan).unwrap();
    build(&plan, &FileAccess::Anywhere).unwrap().0
}

fn refused(building: Value) -> String {
    let plan: HousePlan = serde_json::from_value(json!({"building": building})).unwrap();
    let error: HousesError = build(&plan, &FileAccess::Anywhere).unwrap_err();
    error.to_string()
}

fn rect(name: &str, [x0, z0, x1, z1]: [f32; 4]) -> Value {
    json!({"name": name, "outline": [[x0, z0], [x1, z0], [x1, z1], [x0, z1]]})
}

/// Two rooms with a door, a window and an L-shaped third.
fn flat() -> Value {
    let corner = json!({"name": "hall", "kind": "hallway", "outline": [[0, 3.1], [7.1, 3.1], [7.1, 5], [2, 5], [2, 6], [0, 6]]});
    let mut kitchen = rect("kitchen", [0.0, 0.0, 4.0, 3.0]);
    kitchen["floor"] = json!({"substance": "ceramic_tile"});
    kitchen["walls"] = json!({"substance": "acoustic_panel", "srgb": [200, 160, 90]});
    json!({"name": "flat", "building": {"style": "nordic", "storeys": [{
        "rooms": [kitchen, rect("bedroom", [4.1, 0.0, 7.1, 3.0]), corner],
        "doors": [
            {"rooms": ["kitchen", "hall"], "open": 1.0, "name": "kitchen_door"},
            {"rooms": ["bedroom", "hall"], "hinge": "right", "leaf": "glazed"},
            {"rooms": ["hall", "outside"], "side": "south", "at_m": 1.0},
        ],
        "windows": [{"room": "kitchen", "side": "north"}, {"room": "bedroom", "width_m": 0.8, "frosted": true, "name": "eye"}],
    }]}})
}

#[test]
fn rooms_have_the_floors_and_heights_that_were_asked_for() {
    let house = built(
        json!({"building": {"storeys": [{"height_m": 3.0, "rooms": [rect("study", [1.0, 2.0, 5.0, 4.5])]}]}}),
    );
    let room = &house.rooms.as_slice()[0];
    assert!((room.area_m2() - 10.0).abs() < 1e-4);
    assert_eq!(
        (room.floor_y, room.ceiling_y, room.kind()),
        (0.0, 3.0, "office")
    );
    // Rays from the middle meet the room's own faces: 4 by 3 by 2.5 m, closed.
    let rays = dwell_scene::rays::RayScene::new(std::sync::Arc::new(house));
    let eye = Vec3::new(3.0, 1.5, 3.25);
    for (direction, metres) in [
        (Vec3::X, 2.0),
        (Vec3::NEG_X, 2.0),
        (Vec3::Y, 1.5),
        (Vec3::NEG_Y, 1.5),
        (Vec3::Z, 1.25),
        (Vec3::NEG_Z, 1.25),
    ] {
        let ray = dwell_scene::bvh::Ray::new(eye, direction);
        let hit = rays.closest(&ray, dwell_scene::bvh::RayMask::EYE).unwrap();
        assert!(
            (hit.distance_m - metres).abs() < 1e-4,
            "{direction}: {}",
            hit.distance_m
        );
    }
    for k in 0..500 {
        let turn = |step: f32| (k as f32 * step).rem_euclid(2.0) - 1.0;
        let direction = Vec3::new(turn(0.377), turn(0.731), turn(0.913));
        let ray = dwell_scene::bvh::Ray::new(eye, direction);
        assert!(
            rays.closest(&ray, dwell_scene::bvh::RayMask::EYE).is_some(),
            "{direction} leads out"
        );
    }
}

#[test]
fn walls_are_closed_and_rooms_have_their_coverings() {
    let house = built(flat());
    assert_eq!(house.rooms.len(), 3);
    let area = |name: &str| {
        house
            .rooms
            .iter()
            .find(|room| room.name == name)
            .unwrap()
            .area_m2()
    };
    // Floors, and halves of doorways of 0.98 m in walls of 0.1 m, and of 0.2 m outside.
    assert!(
        (area("kitchen") - (12.0 + 0.049)).abs() < 1e-3,
        "{}",
        area("kitchen")
    );
    assert!(
        (area("hall") - (7.1 * 1.9 + 2.0 + 2.0 * 0.049 + 0.098)).abs() < 1e-3,
        "{}",
        area("hall")
    );
    for piece in &house.structure {
        let mesh = &house.meshes[piece.mesh];
        assert!(
            mesh.enclosed_volume_m3() > 0.0,
            "{} is inside out",
            piece.name
        );
        assert!(is_closed(mesh), "{}", piece.name);
    }
    // Walls and floors together take the box around the flat but for its rooms and what is out of doors.
    let walls = house
        .structure
        .iter()
        .filter(|piece| piece.kind == StructureKind::Wall);
    let walls: f64 = walls
        .map(|piece| house.meshes[piece.mesh].enclosed_volume_m3())
        .sum();
    let holes = 2.06 * 0.98 * (0.1 + 0.1 + 0.2) + 1.2 * 1.2 * 0.2 + 0.8 * 1.2 * 0.2;
    let outside = 7.5 * (5.2 + 0.2) + (2.0 + 0.4) * 1.0 - (12.0 + 9.0 + 7.1 * 1.9 + 2.0);
    assert!(
        (walls - (f64::from(outside as f32) * 2.6 - holes)).abs() < 0.02,
        "{walls} {outside} {holes}"
    );
    let of = |name: &str| {
        house
            .structure
            .iter()
            .find(|piece| piece.name == name)
            .unwrap()
    };
    let floor = &house.materials[of("floor_kitchen").materials[0]];
    assert_eq!(floor.substance, "ceramic_tile");
    let cork = house
        .materials
        .iter()
        .find(|material| material.substance == "acoustic_panel")
        .unwrap();
    assert!(
        (cork.base_color[0] - dwell_scene::units::linear_from_srgb(200.0 / 255.0)).abs() < 1e-3
    );
}

/// Returns whether every edge belongs to as many triangles in one sense as in the other.
fn is_closed(mesh: &Mesh) -> bool {
    use std::collections::BTreeMap;
    let mut edges: BTreeMap<[[u32; 3]; 2], i32> = BTreeMap::new();
    for k in 0..mesh.triangles.len() {
        let corners = mesh
            .corners(k)
            .map(|p| (p + Vec3::ZERO).to_array().map(f32::to_bits));
        for side in 0..3 {
            let (a, b) = (corners[side], corners[(side + 1) % 3]);
            *edges.entry([a, b]).or_default() += 1;
            *edges.entry([b, a]).or_default() -= 1;
        }
    }
    edges.values().all(|count| *count == 0)
}

#[test]
fn doors_and_windows_stand_in_their_walls() {
    let house = built(flat());
    let count = |category: &str| {
        house
            .objects
            .iter()
            .filter(|object| object.category.coarse == category)
            .count()
    };
    assert_eq!((count("door"), count("window")), (3, 2));
    let door = house.object_named("kitchen_door").unwrap();
    let joint = house
        .joints
        .iter()
        .find(|joint| joint.object == door)
        .unwrap();
    assert!((joint.openness(joint.initial) - 1.0).abs() < 1e-6);
    let frame = &house.parts[house.objects[door].first_part];
    assert!((frame.world_from_part.position - Vec3::new(2.0, 0.0, 3.05)).length() < 1e-4);
    assert!(
        frame
            .colliders
            .iter()
            .all(|collider| !matches!(collider, Collider::ExactMesh))
    );
    // One sees through the open door from room to room, and not through the wall beside it.
    let rays = dwell_scene::rays::RayScene::new(std::sync::Arc::new(house));
    let away = |x: f32| {
        let ray = dwell_scene::bvh::Ray::new(Vec3::new(x, 1.2, 2.0), Vec3::Z);
        rays.closest(&ray, dwell_scene::bvh::RayMask::EYE)
            .unwrap()
            .distance_m
    };
    assert!(
        (away(3.5) - 1.0).abs() < 1e-4 && away(2.0) > 2.5,
        "{} {}",
        away(3.5),
        away(2.0)
    );
}

#[test]
fn storeys_are_joined_by_stairs() {
    let rooms =
        |height: f32| json!({"height_m": height, "rooms": [rect("a", [0.0, 0.0, 5.0, 6.0])]});
    let (mut ground, mut first) = (rooms(2.5), rooms(2.4));
    ground["stairs"] = json!({"rect": [3.0, 2.0, 5.0, 6.0], "climb": "south"});
    first["rooms"][0]["name"] = "b".into();
    first["rooms"][0]["height_m"] = json!(2.2);
    let house = built(json!({"building": {"storeys": [ground, first]}}));
    assert_eq!(house.levels.len(), 2);
    let above = &house.rooms.as_slice()[1];
    assert!((above.floor_y - 2.8).abs() < 1e-5 && (above.ceiling_y - 5.0).abs() < 1e-5);
    // The floor of the upper room leaves the well of the stairs open.
    assert!((above.area_m2() - (30.0 - 8.0)).abs() < 1e-3);
    assert!(house.structure.iter().any(|piece| piece.name == "slab_b"));
    // One gets up on foot.
    let state = dwell_scene::State::new(&house);
    let config = dwell_scene::navigation::NavConfig::default();
    let grid = dwell_scene::navigation::NavGrid::build(&house, &state, &config).unwrap();
    let way = grid.geodesic_m(Vec3::new(1.0, 0.0, 1.0), Vec3::new(1.0, 2.8, 1.0));
    assert!(way.is_some_and(|way| way > 6.0), "{way:?}");
}

#[test]
fn plans_that_cannot_be_are_refused_by_name() {
    let one = |change: &dyn Fn(&mut Value)| {
        let mut storey =
            json!({"rooms": [rect("a", [0.0, 0.0, 4.0, 3.0]), rect("b", [4.1, 0.0, 6.0, 3.0])]});
        change(&mut storey);
        json!({"storeys": [storey]})
    };
    for (building, said) in [
        (json!({}), "building.storeys: found 0 storeys with 0 rooms"),
        (
            one(&|s| s["doors"] = json!([{"rooms": ["a", "c"]}])),
            "storeys[0].doors[0].rooms[1]: found \"c\"",
        ),
        (
            one(&|s| s["doors"] = json!([{"rooms": ["a", "b"], "width_m": 3.5}])),
            "width_m: found 3.5; possible: at most 2.900 m in the wall between \"a\" and \"b\"",
        ),
        (
            one(&|s| s["doors"] = json!([{"rooms": ["a", "b"], "at_m": 2.9}])),
            "at_m: found 2.9; possible: a place for 0.98 m in the wall between \"a\" and \"b\": 0.000 to 3.000 m",
        ),
        (
            one(&|s| s["doors"] = json!([{"rooms": ["a", "b"]}, {"rooms": ["b", "a"]}])),
            "an opening that meets another one",
        ),
        (
            one(&|s| s["doors"] = json!([{"rooms": ["a", "a"]}])),
            "\"a\" twice",
        ),
        (
            one(&|s| s["doors"] = json!([{"rooms": ["a", "b"], "open": 2.0}])),
            "open: found 2; possible: 0 to 1",
        ),
        (
            one(&|s| s["windows"] = json!([{"room": "b", "side": "west"}])),
            "no wall between \"b\" and its west outside",
        ),
        (
            one(&|s| s["windows"] = json!([{"room": "b", "height_m": 3.0}])),
            "height_m: found 3",
        ),
        (
            one(&|s| s["height_m"] = json!(0.5)),
            "height_m: found 0.5; possible: 1.8 to 20 m",
        ),
        (
            one(&|s| s["rooms"][0]["floor"] = json!({"substance": "lava"})),
            "rooms[0].floor.substance: found \"lava\"",
        ),
        (
            one(&|s| s["rooms"][1]["name"] = "a".into()),
            "storeys[0].rooms[1].name: found \"a\"",
        ),
        (
            one(&|s| s["stairs"] = json!({"rect": [0, 0, 2, 3], "climb": "north"})),
            "stairs on the highest storey",
        ),
        (
            json!({"style": "gothic", "storeys": [{"rooms": [rect("a", [0.0, 0.0, 4.0, 3.0])]}]}),
            "style: found \"gothic\"",
        ),
        (
            json!({"outer_wall_m": 9.0, "storeys": [{"rooms": [rect("a", [0.0, 0.0, 4.0, 3.0])]}]}),
            "outer_wall_m: found 9",
        ),
    ] {
        let told = refused(building);
        assert!(told.contains(said), "{told}\n  should say: {said}");
    }
    let neither = build(&HousePlan::default(), &FileAccess::Anywhere)
        .unwrap_err()
        .to_string();
    assert!(
        neither.contains("house, building: found neither"),
        "{neither}"
    );
}
