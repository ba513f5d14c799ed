//! Facts 1 to 18 and 21 to 24 of the format's reference page, on the real sample house. Skips, with a line, where the
//! data is absent.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::float_cmp,
    reason = "tests stop at the first surprise, say why they skip, and compare exact numbers"
)]

mod common;

use std::collections::{BTreeMap, BTreeSet};

use common::real;
use dwell_houses::suncg::file::{HouseFile, NodeFile};
use dwell_houses::suncg::metadata::{CategoryTable, LightTable, ModelTable, VoteTable, base_model};
use dwell_houses::suncg::{SuncgFiles, read_binvox};
use dwell_houses::{Report, obj};
use dwell_scene::{Aabb, EntityId, Mobility, StructureKind};
use glam::{DMat4, DVec3};

fn house(files: &SuncgFiles) -> &HouseFile {
    &files.house
}

fn nodes(files: &SuncgFiles) -> &[NodeFile] {
    &files.house.levels[0].nodes
}

fn model_of(node: &NodeFile) -> &str {
    node.model_id.as_deref().unwrap()
}

fn objects(files: &SuncgFiles) -> impl Iterator<Item = (usize, &NodeFile)> {
    nodes(files)
        .iter()
        .enumerate()
        .filter(|(_, node)| node.kind.as_deref() == Some("Object"))
}

fn matrix(node: &NodeFile) -> DMat4 {
    DMat4::from_cols_array(node.transform.as_deref().unwrap().try_into().unwrap())
}

fn object_mesh<'a>(files: &'a SuncgFiles, model: &str) -> &'a obj::file::ObjFile {
    &files.meshes[&format!("object/{model}/{model}.obj")].obj
}

fn room_mesh(files: &SuncgFiles, room: usize, part: char) -> &obj::file::ObjFile {
    &files.meshes[&format!("room/{}/fr_0rm_{room}{part}.obj", files.scene_id)].obj
}

fn bounds(points: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
        (low.min(p), high.max(p))
    })
}

fn positions(mesh: &obj::file::ObjFile) -> impl Iterator<Item = DVec3> + '_ {
    mesh.positions.iter().map(|p| DVec3::from(p.map(f64::from)))
}

fn stated(node: &NodeFile) -> (DVec3, DVec3) {
    let corner = |c: &Option<Vec<f64>>| DVec3::from_slice(c.as_deref().unwrap());
    let bbox = node.bbox.as_ref().unwrap();
    (corner(&bbox.min), corner(&bbox.max))
}

fn difference(a: (DVec3, DVec3), b: (DVec3, DVec3)) -> f64 {
    (a.0 - b.0).abs().max((a.1 - b.1).abs()).max_element()
}

#[test]
fn fact_1_counts_and_kinds_of_nodes() {
    let Some(real) = real() else { return };
    let files = &real.files;
    assert_eq!(house(files).version.as_deref(), Some("suncg@1.0.0"));
    assert_eq!(house(files).levels.len(), 1);
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    for node in nodes(files) {
        assert!(node.is_valid());
        assert!(
            node.state.is_none()
                && node.hide_ceiling.is_none()
                && node.hide_floor.is_none()
                && node.hide_walls.is_none()
        );
        *kinds.entry(node.kind.as_deref().unwrap()).or_default() += 1;
    }
    assert_eq!(kinds, BTreeMap::from([("Object", 43), ("Room", 4)]));
    assert_eq!(
        (
            real.house.rooms.len(),
            real.house.objects.len(),
            real.house.levels.len()
        ),
        (4, 43, 1)
    );
    assert_eq!(real.house.source, "suncg@1.0.0");
}

#[test]
fn fact_2_rooms_types_and_children() {
    let Some(real) = real() else { return };
    let rooms: Vec<_> = nodes(&real.files)
        .iter()
        .filter(|node| node.kind.as_deref() == Some("Room"))
        .map(|node| {
            let types = node.room_types.clone().unwrap_or_default().join(",");
            (
                model_of(node),
                types,
                node.node_indices.as_ref().map_or(0, Vec::len),
            )
        })
        .collect();
    let expected = [
        ("fr_0rm_0", "Storage", 8),
        ("fr_0rm_1", "", 18),
        ("fr_0rm_2", "Bedroom", 11),
        ("fr_0rm_3", "Room", 3),
    ];
    assert_eq!(
        rooms,
        expected.map(|(id, types, children)| (id, types.to_owned(), children))
    );
    let kinds: Vec<&[String]> = real
        .house
        .rooms
        .iter()
        .map(|room| room.kinds.as_slice())
        .collect();
    assert_eq!(
        kinds,
        [
            &["storage".to_owned()][..],
            &[],
            &["bedroom".to_owned()],
            &["room".to_owned()]
        ]
    );

    let listed: Vec<usize> = nodes(&real.files)
        .iter()
        .flat_map(|node| node.node_indices.iter().flatten())
        .map(|i| *i as usize)
        .collect();
    assert_eq!(
        listed.len(),
        listed.iter().collect::<BTreeSet<_>>().len(),
        "none is in two rooms"
    );
    let unlisted: Vec<usize> = objects(&real.files)
        .map(|(i, _)| i)
        .filter(|i| !listed.contains(i))
        .collect();
    assert_eq!(unlisted, [13, 14, 35]);
    // The house keeps the file's membership.
    for (index, node) in nodes(&real.files).iter().enumerate() {
        for &child in node.node_indices.iter().flatten() {
            let id = format!("0_{}", child as usize);
            let object = real
                .house
                .objects
                .iter()
                .find(|object| object.source_id == id)
                .unwrap();
            let room = &real.house.rooms[object.room.unwrap()];
            assert_eq!(room.name, format!("0_{index}"));
        }
    }
}

#[test]
fn fact_3_models_and_coarse_categories() {
    let Some(real) = real() else { return };
    let models: BTreeSet<&str> = objects(&real.files)
        .map(|(_, node)| model_of(node))
        .collect();
    assert_eq!(models.len(), 28);
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for object in &real.house.objects {
        *counts.entry(object.category.coarse.as_str()).or_default() += 1;
    }
    let mut expected = BTreeMap::from([
        ("window", 6),
        ("chair", 6),
        ("door", 5),
        ("table", 5),
        ("column", 2),
        ("curtain", 2),
        ("shelving", 2),
        ("toilet", 2),
        ("trash_can", 2),
    ]);
    for single in [
        "partition",
        "ottoman",
        "wardrobe_cabinet",
        "dressing_table",
        "shower",
        "bathtub",
        "sink",
        "bathroom_stuff",
        "mirror",
        "bed",
        "sofa",
    ] {
        expected.insert(single, 1);
    }
    assert_eq!(counts, expected);
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
            .runs
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

/// The heights at which a wall piece has vertices, to the centimetre.
fn heights_cm(real: &common::Real, name: &str) -> BTreeSet<i32> {
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

#[test]
fn fact_15_slots_count_by_position() {
    let Some(real) = real() else { return };
    let mtl = |model: &str| {
        &real.files.meshes[&format!("object/{model}/{model}.obj")]
            .mtl
            .materials
    };
    assert_eq!(mtl("135").len(), 7);
    let node = objects(&real.files)
        .find(|(_, node)| model_of(node) == "135")
        .unwrap()
        .1;
    assert_eq!(node.materials.as_ref().map(Vec::len), Some(3));
    let glass = &mtl("210")[0];
    assert_eq!(
        (glass.diffuse, glass.opacity),
        (Some([0.4136, 0.5648, 0.64]), Some(0.5))
    );
    assert_eq!(mtl("209")[1].opacity, Some(0.5));
    // The sample's models in use hold six such materials.
    let models: BTreeSet<&str> = objects(&real.files)
        .map(|(_, node)| model_of(node))
        .collect();
    let clear = models
        .iter()
        .flat_map(|model| mtl(model))
        .filter(|m| m.opacity == Some(0.5))
        .count();
    assert_eq!(clear, 6);
}

#[test]
fn fact_16_overrides_change_colors() {
    let Some(real) = real() else { return };
    let hex = |color: [f32; 3]| {
        color.map(|c| (dwell_scene::units::srgb_from_linear(c) * 255.0).round() as u8)
    };
    let mut changed = BTreeSet::new();
    for (index, node) in objects(&real.files) {
        let model = model_of(node);
        let slots = &real.files.meshes[&format!("object/{model}/{model}.obj")]
            .mtl
            .materials;
        let object = real
            .house
            .objects
            .iter()
            .find(|object| object.source_id == format!("0_{index}"))
            .unwrap();
        let shown = &real.house.parts[object.first_part].materials;
        for (slot, change) in node.materials.iter().flatten().enumerate() {
            let Some(diffuse) = &change.diffuse else {
                continue;
            };
            let wanted = u32::from_str_radix(&diffuse[1..], 16).unwrap();
            let wanted = [16, 8, 0].map(|shift| (wanted >> shift) as u8);
            let material = &real.house.materials[shown[slot]];
            assert_eq!(
                (hex(material.base_color), material.texture),
                (wanted, None),
                "{model} slot {slot}"
            );
            let own = slots[slot]
                .diffuse
                .unwrap()
                .map(|c| (c * 255.0).round() as i32);
            if own
                .iter()
                .zip(wanted)
                .any(|(a, b)| (a - i32::from(b)).abs() > 2)
            {
                changed.insert(model);
            }
        }
    }
    assert_eq!(
        changed,
        BTreeSet::from(["174", "83", "150", "135", "81", "87", "144"])
    );
    assert_eq!(
        real.report
            .count(|d| matches!(d, dwell_houses::Damage::MissingTexture { .. })),
        0
    );
    let toilet = real
        .house
        .objects
        .iter()
        .find(|object| object.model == "83")
        .unwrap();
    let shown = &real.house.parts[toilet.first_part].materials;
    let colors: Vec<_> = shown
        .iter()
        .map(|id| hex(real.house.materials[*id].base_color))
        .collect();
    assert_eq!(colors, [[0x47; 3], [0x8e; 3], [0x8e; 3]]);
}

#[test]
fn fact_17_textures() {
    let Some(real) = real() else { return };
    assert_eq!(
        std::fs::read_dir(real.root.join("texture"))
            .unwrap()
            .count(),
        27
    );
    let mean = |name: &str| real.files.textures[&format!("texture/{name}.jpg")].mean_srgb();
    for (name, expected) in [
        ("wood_8", [51.30, 41.35, 42.34]),
        ("wood_5", [251.25, 220.22, 176.21]),
        ("textile_2_3", [54.81, 92.06, 153.38]),
        ("bricks_1", [157.41, 77.67, 58.47]),
    ] {
        let found = mean(name);
        // JPEG decoders differ in rounding: half a grey level.
        assert!(
            found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.5),
            "{name}: {found:?}"
        );
    }
    let white = &real.files.textures["texture/wallp_0.jpg"];
    assert_eq!((white.width, white.height), (16, 16));
    assert!(white.rgba.iter().all(|value| *value == 255));
}

#[test]
fn fact_18_voxels_and_volumes() {
    let Some(real) = real() else { return };
    let read = |model: &str| {
        let path = format!("object_vox/object_vox_data/{model}/{model}.binvox");
        read_binvox(&std::fs::read(real.root.join(&path)).unwrap(), &path).unwrap()
    };
    let toilet = read("83");
    assert_eq!((toilet.count(), toilet.dims), (233_522, [128; 3]));
    assert!((toilet.scale - 0.863_783).abs() < 1e-9);
    assert_eq!(toilet.translate, [-0.176_343, -0.356_254, 0.000_702]);
    for (model, count, scale, volume) in [
        ("83", Some(233_522), Some(0.863_783), 0.071_765),
        ("77", Some(497_460), Some(2.203_32), 2.537_237),
        ("109", Some(97_266), Some(1.08), 0.058_425),
        ("261", None, None, 0.652_061),
        ("441", None, None, 0.018_967),
        ("317", None, None, 0.062_771),
    ] {
        let voxels = read(model);
        assert!(count.is_none_or(|count| count == voxels.count()), "{model}");
        assert!(
            scale.is_none_or(|scale: f64| (scale - voxels.scale).abs() < 1e-9),
            "{model}"
        );
        assert!(
            (voxels.volume_m3() - volume).abs() < 1e-6,
            "{model}: {}",
            voxels.volume_m3()
        );
    }
}

fn table<T>(real: &common::Real, name: &str, read: fn(&[u8], &str, &mut Report) -> T) -> T {
    let mut report = Report::new();
    let table = read(
        &std::fs::read(real.root.join("metadata").join(name)).unwrap(),
        name,
        &mut report,
    );
    assert!(report.is_empty(), "{report}");
    table
}

#[test]
fn fact_21_categories_of_models() {
    let Some(real) = real() else { return };
    let table = table(real, "ModelCategoryMapping.csv", CategoryTable::read);
    let coarse = |model: &str| table.get(model).unwrap().coarse.clone();
    let toilet = table.get("83").unwrap();
    assert_eq!(
        (
            toilet.fine.as_str(),
            toilet.coarse.as_str(),
            toilet.structure
        ),
        ("toilet", "toilet", 2)
    );
    assert_eq!(toilet.wordnet, "n04446276");
    assert_eq!(coarse("87"), "sink");
    let column = table.get("365").unwrap();
    assert_eq!(
        (
            column.fine.as_str(),
            column.coarse.as_str(),
            column.structure,
            column.nyu40.as_str()
        ),
        ("column", "column", 1, "wall")
    );
    let partition = table.get("502").unwrap();
    assert_eq!(
        (
            partition.coarse.as_str(),
            partition.structure,
            partition.nyu40.as_str()
        ),
        ("partition", 1, "otherstructure")
    );
    let nyu40 = |model: &str| table.get(model).unwrap().nyu40.clone();
    assert_eq!(
        (coarse("456"), nyu40("456")),
        ("shelving".into(), "shelves".into())
    );
    assert_eq!(
        (coarse("478"), nyu40("478")),
        ("ottoman".into(), "otherprop".into())
    );
    assert_eq!(
        (coarse("203"), nyu40("203")),
        ("dressing_table".into(), "desk".into())
    );
    assert_eq!(
        (coarse("135"), nyu40("135")),
        ("shower".into(), "shower_curtain".into())
    );
    assert_eq!(
        table.get("122_0"),
        table.get("122"),
        "variants are looked up as their model"
    );
    assert_eq!(
        (
            base_model("s__1296"),
            base_model("122_0"),
            base_model("s__1762_0")
        ),
        ("s__1296", "122", "s__1762")
    );
}

#[test]
fn fact_22_full_tables() {
    let Some(real) = real() else { return };
    let categories = table(real, "ModelCategoryMapping.csv", CategoryTable::read);
    assert_eq!(categories.len(), 2553);
    let fine: BTreeSet<&str> = categories
        .iter()
        .map(|(_, row)| row.fine.as_str())
        .collect();
    let coarse: BTreeSet<&str> = categories
        .iter()
        .map(|(_, row)| row.coarse.as_str())
        .collect();
    assert_eq!((fine.len(), coarse.len()), (187, 90));
    let models = table(real, "models.csv", ModelTable::read);
    assert_eq!(models.len(), 2592);
    assert_eq!(
        models
            .iter()
            .filter(|(id, _)| base_model(id) != *id)
            .count(),
        44
    );
    let lights = table(real, "suncgModelLights.json", LightTable::read);
    assert_eq!(
        (
            lights.len(),
            lights.iter().map(|(_, lights)| lights.len()).sum::<usize>()
        ),
        (185, 382)
    );
    let kinds = |model: &str| {
        lights
            .get(model)
            .iter()
            .map(|light| light.kind.as_str())
            .collect::<Vec<_>>()
    };
    assert_eq!(kinds("s__1296"), ["SpotLight"; 2]);
    let spots = lights.get("s__1296");
    assert_eq!(
        (spots[0].position, spots[0].direction),
        ([0.0, 1.8, 0.0], Some([0.0, -1.0, 0.0]))
    );
    assert_eq!(spots[1].direction, Some([0.0, 1.0, 0.0]));
    assert_eq!(
        (kinds("377"), lights.get("377")[0].position),
        (vec!["PointLight"], [0.0, 1.59, 0.0])
    );
    assert_eq!((kinds("178"), kinds("83")), (vec!["LineLight"], vec![]));
    assert!(real.house.lights.is_empty(), "no lamp in this house");
    let model = models.get("274").unwrap();
    assert!(DVec3::from(model.min_m).abs_diff_eq(DVec3::new(-0.45, 2.38e-7, -0.185), 1e-9));
    assert_eq!(model.materials, 3);
    assert_eq!(model.aligned_dims_cm, [90.0, 73.999_98, 36.935_402]);
}

#[test]
fn fact_23_votes() {
    let Some(real) = real() else { return };
    let votes = table(real, "houseAnnoMturk.csv", VoteTable::read)
        .get(&real.files.scene_id, 0)
        .unwrap();
    assert_eq!(
        (votes.positive, votes.negative, votes.is_realistic()),
        (3, 0, true)
    );
}

#[test]
fn fact_24_z_up_positions_turn_upright() {
    let Some(real) = real() else { return };
    // HoME's start (42, -39, 1) is (42, 1, 39) here: a free place over the floor of the largest room's overlap.
    let home = DVec3::new(42.0, -39.0, 1.0);
    let here = DVec3::new(home.x, home.z, -home.y);
    assert_eq!(here, DVec3::new(42.0, 1.0, 39.0));
    assert!(real.house.room_at(here.as_vec3()).is_some());
    assert_eq!(real.house.room_at(home.as_vec3()), None);
}
