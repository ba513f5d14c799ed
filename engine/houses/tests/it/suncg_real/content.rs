//! Facts 1 to 3 and 15 to 24: nodes, materials, textures, voxels, tables.

use std::collections::{BTreeMap, BTreeSet};

use dwell_houses::LoadReport;
use dwell_houses::suncg::metadata::{CategoryTable, LightTable, ModelTable, VoteTable, base_model};
use dwell_houses::suncg::read_binvox;
use glam::DVec3;

use super::common::{Real, real};
use super::{model_of, nodes, objects};

fn table<T>(real: &Real, name: &str, read: fn(&[u8], &str, &mut LoadReport) -> T) -> T {
    let mut report = LoadReport::new();
    let table = read(
        &std::fs::read(real.root.join("metadata").join(name)).unwrap(),
        name,
        &mut report,
    );
    assert!(report.is_empty(), "{report}");
    table
}

#[test]
fn fact_1_counts_and_kinds_of_nodes() {
    let Some(real) = real() else { return };
    let files = &real.files;
    assert_eq!(files.house.version.as_deref(), Some("suncg@1.0.0"));
    assert_eq!(files.house.levels.len(), 1);
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
            .count(|d| matches!(d, dwell_houses::WarningKind::MissingTexture { .. })),
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
    assert!(white.rgba().iter().all(|value| *value == 255));
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
