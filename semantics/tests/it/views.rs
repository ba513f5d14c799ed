//! Texts of views in houses whose doors are out of the way.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use crate::common::{Builder, Corners};
use dwell_scene::{House, ObjectId, Pose, RoomId, State};
use dwell_semantics::check::Addressee;
use dwell_semantics::describe::{TextOptions, describe_view};
use dwell_semantics::predicates;
use dwell_semantics::{Semantics, Term, Viewer};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// Distance of a window's middle from the floor of the room whose wall it is in, m: walls are thinner.
const IN_WALL_M: f32 = 0.5;

/// Distance of a point from a triangle, seen from above, m.
fn distance_m([a, b, c]: [Vec2; 3], point: Vec2) -> f32 {
    let edges = [(a, b), (b, c), (c, a)];
    let sides = edges.map(|(p, q)| (q - p).perp_dot(point - p));
    if sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0) {
        return 0.0;
    }
    let to_edge = |(p, q): (Vec2, Vec2)| {
        let share = (point - p).dot(q - p) / (q - p).length_squared().max(1e-9);
        point.distance(p.lerp(q, share.clamp(0.0, 1.0)))
    };
    edges.map(to_edge).into_iter().fold(f32::INFINITY, f32::min)
}

/// Returns whether a window, or what hangs before one, is in a wall of a room.
fn is_of_room(house: &House, state: &State, window: ObjectId, room: RoomId) -> bool {
    let middle = house.object_bounds(state, window).center();
    let floor = house.rooms[room].footprint.iter();
    let distances = floor.map(|triangle| distance_m(*triangle, Vec2::new(middle.x, middle.z)));
    distances.fold(f32::INFINITY, f32::min) <= IN_WALL_M
}

/// A window that is seen through a door is not told as one of the viewer's room.
#[test]
fn windows_of_other_rooms_are_told_as_such() {
    let (mut own, mut others) = (0, 0);
    for name in ["builtin:apartment", "builtin:studio", "seed:3", "seed:17"] {
        let house = Arc::new(dwell_houses::open(name).unwrap().0);
        let semantics = Semantics::new(&house);
        let mut state = State::new(&house);
        for joint in &house.joints {
            // Out of the way: nothing here moves what hangs on a joint.
            if house.objects[joint.object].category.coarse == "door" {
                state.part_pose[joint.child].position.y += 100.0;
            }
        }
        let scene = semantics.scene(&state);
        let is_window = |object: ObjectId| {
            let coarse = house.objects[object].category.coarse.as_str();
            ["window", "curtain", "blinds"].contains(&coarse)
        };
        for room in house.rooms.ids() {
            for (place, yaw_rad) in house
                .points_in_room(room, 5)
                .into_iter()
                .zip([0.3, 1.8, 3.2, 4.7, 5.5])
            {
                let eye = place.with_y(house.rooms[room].floor_y) + Vec3::Y * 1.5;
                let viewer = Viewer {
                    world_from_camera: Pose::from_position_yaw(eye, yaw_rad),
                };
                if house.room_at(eye) != Some(room) {
                    continue;
                }
                let listener = Addressee {
                    viewer: Some(viewer),
                    agent: None,
                };
                let text = describe_view(&scene, listener, TextOptions::default());
                for claim in &text.claims {
                    let is_elsewhere = format!("{:?}", claim.form).contains("in_room");
                    let things = claim.terms.iter().filter_map(|term| term.object());
                    for window in things.filter(|thing| is_window(*thing)) {
                        assert!(
                            is_elsewhere || is_of_room(&house, &state, window, room),
                            "{name}, room {}: {} in {}",
                            room.0,
                            house.objects[window].name,
                            text.text
                        );
                        own += usize::from(!is_elsewhere);
                    }
                }
                let is_seen = |window: &ObjectId| {
                    let terms = [Term::Object(*window)];
                    let visible = predicates::find("visible").unwrap();
                    visible.holds(&scene, &terms, Some(&viewer)).is_true()
                };
                let windows = house.objects.ids().filter(|thing| is_window(*thing));
                let seen = windows.filter(is_seen);
                others += seen
                    .filter(|window| !is_of_room(&house, &state, *window, room))
                    .count();
            }
        }
    }
    println!("{own} windows and curtains of the viewer's room told, {others} of others in sight");
    assert!(own >= 50 && others >= 20, "{own}, {others}");
}

/// What somebody in the middle of the near wall of a room of 6 by 6 m sees, looking along -z.
fn view_of(kind: &str, things: &[(&str, &str, Corners)]) -> String {
    let mut b = Builder::new("view");
    b.room(kind, [0.05, 0.05], [5.95, 5.95]);
    for (category, substance, corners) in things {
        let material = b.material(substance, [150, 111, 72]);
        b.thing(category, &[*corners], material);
    }
    let house = b.build();
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let listener = Addressee {
        viewer: Some(Viewer {
            world_from_camera: Pose::from_position_yaw(Vec3::new(3.0, 1.5, 5.5), 0.0),
        }),
        agent: None,
    };
    describe_view(&scene, listener, TextOptions::default()).text
}

/// Nobody sees how near the near end of a thing is that the lower border cuts.
#[test]
fn what_runs_out_of_the_picture_below_has_no_distance() {
    let bench = |from: f32| -> Corners { ([2.2, 0.0, from - 1.2], [3.8, 0.45, from]) };
    let far = view_of("living_room", &[("bench", "wood", bench(3.0))]);
    let near = view_of("living_room", &[("bench", "wood", bench(4.9))]);
    // 2.5 m ahead and 1.05 m below the eye: 2.7 m.
    assert!(far.contains("The bench is about 3 metres away."), "{far}");
    assert!(near.contains("bench") && !near.contains("away"), "{near}");
}

/// People say door of a partition with glass in it.
#[test]
fn a_glazed_partition_is_not_told() {
    let panel: Corners = ([1.5, 0.0, 2.0], [4.5, 2.2, 2.1]);
    let solid = view_of("living_room", &[("partition", "gypsum_board", panel)]);
    let glazed = view_of("living_room", &[("partition", "glass", panel)]);
    assert!(solid.contains("partition"), "{solid}");
    assert!(!glazed.contains("partition"), "{glazed}");
}

/// Dark boards look light in the sun.
#[test]
fn floors_in_the_open_have_no_colour() {
    let table: Corners = ([2.2, 0.0, 2.0], [3.8, 0.7, 3.0]);
    let things = [("table", "wood", table)];
    let indoors = view_of("living_room", &things);
    let outdoors = view_of("terrace", &things);
    assert!(indoors.contains("brown parquet floor"), "{indoors}");
    let floor = outdoors
        .split(". ")
        .find(|sentence| sentence.contains("floor"));
    assert!(
        floor.is_none_or(|floor| !floor.contains("brown")),
        "{outdoors}"
    );
    assert!(outdoors.contains("parquet floor"), "{outdoors}");
}
