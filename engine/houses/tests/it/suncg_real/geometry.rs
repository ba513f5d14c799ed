//! Facts 4 to 14: places, meshes, floors, doors.

use std::collections::BTreeSet;

use dwell_scene::{Aabb, EntityId, Mobility, StructureKind};
use glam::DVec3;

use super::common::{Real, real};
use super::{
    bounds, difference, matrix, model_of, nodes, object_mesh, objects, positions, room_mesh, stated,
};

/// The heights at which a wall piece has vertices, to the centimetre.
fn heights_cm(real: &Real, name: &str) -> BTreeSet<i32> {
    let piece = real
        .house
        .structure
        .iter()
        .find(|piece| piece.name == name)
        .unwrap();
    real.house.meshes[piece.mesh]
        .positions
        .iter()
        .map(|p| (p.y * 1000.0).round() as i32)
        .collect()
}

#[test]
fn fact_4_box_of_the_house() {
    let Some(real) = real() else { return };
    let bbox = real.files.house.levels[0].bbox.as_ref().unwrap();
    let min = DVec3::from_slice(bbox.min.as_deref().unwrap());
    let max = DVec3::from_slice(bbox.max.as_deref().unwrap());
    assert!(min.abs_diff_eq(DVec3::new(33.689_993, -8.9e-18, 37.388_609), 5e-7));
    assert!(max.abs_diff_eq(DVec3::new(48.614_735, 2.75, 46.24), 5e-7));
    let level = &real.house.levels[dwell_scene::LevelId(0)];
    assert!(
        level.bounds.min.as_dvec3().abs_diff_eq(min, 1e-4),
        "{:?}",
        level.bounds
    );
    assert!(
        level.bounds.max.as_dvec3().abs_diff_eq(max, 1e-4),
        "{:?}",
        level.bounds
    );
}

#[test]
fn fact_5_transforms_are_column_major() {
    let Some(real) = real() else { return };
    let (mut worst_column, mut worst_row): (f64, f64) = (0.0, 0.0);
    for (_, node) in objects(&real.files) {
        let mesh = object_mesh(&real.files, model_of(node));
        let column = bounds(positions(mesh).map(|p| matrix(node).transform_point3(p)));
        let row = bounds(positions(mesh).map(|p| matrix(node).transpose().transform_point3(p)));
        worst_column = worst_column.max(difference(column, stated(node)));
        worst_row = worst_row.max(difference(row, stated(node)));
    }
    assert!(worst_column < 1.9e-6, "{worst_column}");
    assert!((48.0..49.0).contains(&worst_row), "{worst_row}");
    // The house's own poses, in 32 bits and 40 m from the origin, stay within 20 micrometres.
    let state = dwell_scene::State::new(&real.house);
    for (id, object) in real.house.objects.iter_ids() {
        let index: usize = object.source_id[2..].parse().unwrap();
        let bounds = real.house.object_bounds(&state, id);
        let of_house = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let off = difference(of_house, stated(&nodes(&real.files)[index]));
        assert!(off < 2e-5, "{}: {off}", object.name);
    }
}

#[test]
fn fact_6_one_mirrored_node() {
    let Some(real) = real() else { return };
    for (index, node) in objects(&real.files) {
        let mirrored = node.is_mirrored.is_some_and(|flag| flag.0);
        assert_eq!(mirrored, index == 17);
        let det = matrix(node).determinant();
        assert!(
            (det - if mirrored { -1.0 } else { 1.0 }).abs() < 1e-6,
            "{index}: {det}"
        );
    }
    let first = |model: &str| positions(object_mesh(&real.files, model)).next().unwrap();
    assert!(first("122").abs_diff_eq(DVec3::new(0.057_505_3, 0.944_399, -0.360_203), 1e-7));
    for (index, model, expected) in [
        (10, "122", DVec3::new(38.032_687, 0.964_399, 38.873_818)),
        (17, "122", DVec3::new(43.065_541, 0.964_399, 41.538_548)),
        (44, "77", DVec3::new(45.083_154, 0.720_954, 37.943_207)),
    ] {
        let world = matrix(&nodes(&real.files)[index]).transform_point3(first(model));
        assert!(world.abs_diff_eq(expected, 1e-6), "{index}: {world}");
        // Some vertex of the house stands there too.
        let object = real
            .house
            .objects
            .iter()
            .find(|object| object.source_id == format!("0_{index}"))
            .unwrap();
        let nearest = object
            .parts()
            .flat_map(|part| {
                let part = &real.house.parts[part];
                let map = part.world_from_part.to_affine() * part.part_from_mesh;
                real.house.meshes[part.mesh]
                    .positions
                    .iter()
                    .map(move |p| map.transform_point3(*p).as_dvec3().distance(expected))
            })
            .fold(f64::INFINITY, f64::min);
        assert!(nearest < 2e-5, "{index}: {nearest}");
    }
    let mirrored = real
        .house
        .objects
        .iter()
        .find(|object| object.source_id == "0_17")
        .unwrap();
    assert!(
        mirrored
            .parts()
            .all(|part| real.house.parts[part].part_from_mesh.matrix3.determinant() < 0.0)
    );
}

#[test]
fn fact_7_triangles_after_fanning() {
    let Some(real) = real() else { return };
    let rooms: usize = (0..4)
        .flat_map(|room| {
            ['c', 'f', 'w'].map(|part| room_mesh(&real.files, room, part).triangle_count())
        })
        .sum();
    assert_eq!(rooms, 1768);
    let models: BTreeSet<&str> = objects(&real.files)
        .map(|(_, node)| model_of(node))
        .collect();
    let of_models: usize = models
        .iter()
        .map(|model| object_mesh(&real.files, model).triangle_count())
        .sum();
    assert_eq!(of_models, 74_636);
    let instances: usize = objects(&real.files)
        .map(|(_, n)| object_mesh(&real.files, model_of(n)).triangle_count())
        .sum();
    assert_eq!(instances, 100_308);
    assert_eq!(real.house.triangle_count(), 102_076);
}

#[test]
fn fact_8_room_meshes_and_wall_pieces() {
    let Some(real) = real() else { return };
    let expected = [
        (60, 60, 256, 4),
        (92, 92, 344, 6),
        (60, 60, 216, 4),
        (92, 92, 344, 6),
    ];
    let (mut walls, mut groups) = (0, 0);
    for (room, expected) in expected.into_iter().enumerate() {
        let triangles =
            ['c', 'f', 'w'].map(|part| room_mesh(&real.files, room, part).triangle_count());
        let names: BTreeSet<&str> = room_mesh(&real.files, room, 'w')
            .face_groups
            .iter()
            .map(|run| run.object.as_str())
            .collect();
        let inside = names
            .iter()
            .filter(|name| name.starts_with(&format!("WallInside#0_{room}_")))
            .count();
        assert_eq!((triangles[0], triangles[1], triangles[2], inside), expected);
        walls += inside;
        groups += names.len();
    }
    assert_eq!((walls, groups), (20, 40));
    // HoME counts a wall once and floor and ceiling apart; here each group has its own id.
    assert_eq!(43 + 8 + walls, 71);
    let of_kind = |kind| {
        real.house
            .structure
            .iter()
            .filter(|piece| piece.kind == kind)
            .count()
    };
    assert_eq!(
        (
            of_kind(StructureKind::Wall),
            of_kind(StructureKind::Floor),
            of_kind(StructureKind::Ceiling)
        ),
        (40, 4, 4)
    );
    assert_eq!(
        real.house.entity_of_object(dwell_scene::ObjectId(0)),
        EntityId(49)
    );
    let names: Vec<&str> = real
        .house
        .structure
        .iter()
        .take(4)
        .map(|piece| piece.name.as_str())
        .collect();
    assert_eq!(
        names,
        [
            "Ceiling#0_0",
            "Floor#0_0",
            "WallInside#0_0_0",
            "WallOutside#0_0_0"
        ]
    );
}

#[test]
fn fact_9_floor_areas_and_heights() {
    let Some(real) = real() else { return };
    let expected_m2 = [26.2638, 19.3121, 16.0094, 20.3744];
    for (room, expected) in real.house.rooms.iter().zip(expected_m2) {
        assert!(
            (f64::from(room.area_m2()) - expected).abs() < 1e-3,
            "{}: {}",
            room.name,
            room.area_m2()
        );
        assert!((room.floor_y - 0.05).abs() < 1e-6 && (room.ceiling_y - 2.69).abs() < 1e-5);
    }
    let mut walls = Aabb::EMPTY;
    let mut ceilings = Aabb::EMPTY;
    for piece in &real.house.structure {
        let bounds = real.house.meshes[piece.mesh].bounds();
        match piece.kind {
            StructureKind::Wall => walls = walls.union(&bounds),
            StructureKind::Ceiling => ceilings = ceilings.union(&bounds),
            _ => {}
        }
    }
    assert!((ceilings.min.y - 2.69).abs() < 1e-5 && (ceilings.max.y - 2.74).abs() < 1e-5);
    assert!(walls.min.y.abs() < 1e-5 && (walls.max.y - 2.735).abs() < 1e-5);
}

#[test]
fn fact_10_rooms_overlap_and_the_smallest_wins() {
    let Some(real) = real() else { return };
    let rooms = &real.house.rooms;
    // Areas by counting cells of a 2 cm grid.
    let (mut union, mut both) = (0.0, 0.0);
    let cell = 0.02_f32;
    let level = real.house.levels[dwell_scene::LevelId(0)].bounds;
    let size = level.size();
    for i in 0..(size.x / cell) as usize {
        for k in 0..(size.z / cell) as usize {
            let point = glam::Vec2::new(
                level.min.x + (i as f32 + 0.5) * cell,
                level.min.z + (k as f32 + 0.5) * cell,
            );
            let holds: Vec<bool> = rooms.iter().map(|room| room.contains_xz(point)).collect();
            let area = f64::from(cell * cell);
            union += if holds.contains(&true) { area } else { 0.0 };
            if holds[0] && holds[1] {
                both += area;
                let room = real.house.room_at(glam::Vec3::new(point.x, 1.0, point.y));
                let area_m2 = rooms[room.unwrap()].area_m2();
                assert!(
                    area_m2 <= rooms[dwell_scene::RoomId(1)].area_m2(),
                    "the smaller one"
                );
            }
        }
    }
    assert!((union - 62.1).abs() < 0.1, "{union}");
    assert!((both - 19.2).abs() < 0.1, "{both}");
    let sum: f32 = rooms.iter().map(dwell_scene::Room::area_m2).sum();
    assert!((sum - 81.96).abs() < 0.01, "{sum}");
}

#[test]
fn fact_11_room_boxes_hold_their_children() {
    let Some(real) = real() else { return };
    let mut off_alone = Vec::new();
    for (room, node) in nodes(&real.files).iter().enumerate().take(4) {
        let own = bounds(
            ['c', 'f', 'w']
                .into_iter()
                .flat_map(|part| positions(room_mesh(&real.files, room, part))),
        );
        let children = node
            .node_indices
            .iter()
            .flatten()
            .map(|i| stated(&nodes(&real.files)[*i as usize]));
        let all = children.fold(own, |a, b| (a.0.min(b.0), a.1.max(b.1)));
        assert!(
            difference(all, stated(node)) < 1.5e-6 + 2e-6,
            "{room}: {}",
            difference(all, stated(node))
        );
        off_alone.push(difference(own, stated(node)));
    }
    for (room, expected) in [(1, 0.51), (2, 0.52), (3, 0.54)] {
        assert!((off_alone[room] - expected).abs() < 0.006, "{off_alone:?}");
    }
}

#[test]
fn fact_12_openings() {
    let Some(real) = real() else { return };
    assert_eq!(
        heights_cm(real, "WallInside#0_0_0"),
        BTreeSet::from([0, 870, 2230, 2735])
    );
    assert_eq!(
        heights_cm(real, "WallInside#0_3_4"),
        BTreeSet::from([0, 40, 870, 2120, 2230, 2735])
    );
}

#[test]
fn fact_13_mesh_counts() {
    let Some(real) = real() else { return };
    let counts = |path: &str| {
        let mesh = &real.files.meshes[path].obj;
        (
            mesh.positions.len(),
            mesh.texcoords.len(),
            mesh.normals.len(),
            mesh.face_count(),
        )
    };
    assert_eq!(counts("object/83/83.obj"), (1437, 0, 1242, 1427));
    assert_eq!(counts("object/122/122.obj"), (1208, 847, 688, 866));
    assert_eq!(counts("object/122/122_0.obj"), (1196, 847, 684, 863));
    assert_eq!(counts("object/261/261.obj"), (8829, 8703, 3327, 8915));
    assert_eq!(counts("object/441/441.obj"), (2110, 2752, 1281, 2083));
    assert_eq!(object_mesh(&real.files, "83").triangle_count(), 2752);
    assert_eq!(object_mesh(&real.files, "261").triangle_count(), 16_124);
}

#[test]
fn fact_14_two_states_of_the_door() {
    let Some(real) = real() else { return };
    for (path, expected) in [
        ("object/122/122.obj", DVec3::new(0.8, 2.12, 0.65)),
        ("object/122/122_0.obj", DVec3::new(0.8, 2.12, 0.209_99)),
    ] {
        let files = &real.files.meshes[path];
        let (low, high) = bounds(positions(&files.obj));
        assert!(
            (high - low).abs_diff_eq(expected, 5e-4),
            "{path}: {}",
            high - low
        );
        assert_eq!(files.obj.material_libraries, ["122.mtl"]);
    }
    // From the two states follows the hinge: closing the joint gives the closed model's box.
    let door = real
        .house
        .objects
        .iter_ids()
        .find(|(_, object)| object.source_id == "0_11")
        .unwrap()
        .0;
    assert_eq!(real.house.objects[door].mobility, Mobility::Articulated);
    let joint_id = real.house.joints_of(door).next().unwrap();
    let joint = &real.house.joints[joint_id];
    let leaf = &real.house.parts[joint.child];
    let frame = &real.house.parts[joint.parent.unwrap()];
    let closed = joint.world_from_child(&frame.world_from_part, joint.closed);
    let map =
        frame.world_from_part.inverse().to_affine() * closed.to_affine() * leaf.part_from_mesh;
    let mut bounds = real.house.meshes[frame.mesh].bounds();
    for p in &real.house.meshes[leaf.mesh].positions {
        bounds.add_point(map.transform_point3(*p));
    }
    assert!((bounds.size().z - 0.21).abs() < 0.01, "{:?}", bounds.size());
    assert!((joint.open - joint.closed).abs() > 0.5, "{joint:?}");
}
