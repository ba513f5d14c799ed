//! glTF and GLB files as houses, written by hand and by our own writer.
#![allow(
    clippy::unwrap_used,
    reason = "tests stop at the first surprise and compare exact numbers"
)]

use crate::common;

use common::base64;

use dwell_houses::{HousesError, WarningKind, gltf, open};
use dwell_scene::{House, LightShape, Mobility, ObjectId, ShoeboxMaterials, State};
use glam::{Vec2, Vec3};

/// A tetrahedron as text: positions and byte indices in one base64 buffer made by hand (48 bytes of floats, 12 of indices).
fn tetrahedron() -> String {
    let mut bytes: Vec<u8> = Vec::new();
    for x in [
        0.0_f32, 0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.4,
    ] {
        bytes.extend(x.to_le_bytes());
    }
    bytes.extend([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]);
    base64(&bytes)
}

fn text(nodes: &str, extra: &str) -> String {
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}], "nodes": {nodes},
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1, "material": 0}}]}}],
        "materials": [{{"name": "red plastic", "alphaMode": "BLEND", "pbrMetallicRoughness":
            {{"baseColorFactor": [0.5, 0.25, 0.125, 0.75], "metallicFactor": 0, "roughnessFactor": 0.25}}}}],
        "accessors": [
            {{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [0.4, 0.4, 0.4]}},
            {{"bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 12}}],
        "buffers": [{{"byteLength": 60, "uri": "data:application/octet-stream;base64,{}"}}]{extra}}}"#,
        tetrahedron()
    )
}

fn open_text(text: &str) -> Result<(House, dwell_houses::LoadReport), HousesError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gltf");
    std::fs::write(&path, text).unwrap();
    open(&path.to_string_lossy())
}

#[test]
fn node_transforms_materials_and_names_are_kept() {
    let nodes = r#"[{"name": "group", "translation": [1, 0, 0], "children": [1, 2]},
        {"name": "Mug", "mesh": 0, "scale": [2, 2, 2]},
        {"name": "Mug", "mesh": 0, "matrix": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1]}]"#;
    let (house, report) = open_text(&text(nodes, "")).unwrap();
    assert!(report.is_empty(), "{report}");
    let names: Vec<&str> = house
        .objects
        .iter()
        .map(|object| object.name.as_str())
        .collect();
    assert_eq!(names, ["Mug", "Mug_2"]);
    let state = State::new(&house);
    let bounds = |k: u32| house.object_bounds(&state, dwell_scene::ObjectId(k));
    assert!(bounds(0).max.abs_diff_eq(Vec3::new(1.8, 0.8, 0.8), 1e-6));
    assert!(bounds(1).min.abs_diff_eq(Vec3::new(5.6, 0.0, 0.0), 1e-6) && bounds(1).max.x == 6.0);
    assert_eq!(house.meshes.len(), 1, "instances share a mesh");
    let material = &house.materials[house.parts.as_slice()[0].materials[0]];
    assert_eq!(
        (
            material.opacity,
            material.roughness,
            material.substance.as_str()
        ),
        (0.75, 0.25, "plastic")
    );
    assert!(
        material
            .base_color
            .iter()
            .zip([0.5, 0.25, 0.125])
            .all(|(a, b)| (a - b).abs() < 1e-5)
    );
}

#[test]
fn cycles_and_missing_buffers_do_no_harm() {
    let (house, _) = open_text(&text(r#"[{"mesh": 0, "children": [0, 0]}]"#, "")).unwrap();
    assert_eq!(
        (house.objects.len(), house.objects.as_slice()[0].mobility),
        (1, Mobility::Movable)
    );
    let stolen = text(r#"[{"mesh": 0}]"#, "").replace(
        &format!("data:application/octet-stream;base64,{}", tetrahedron()),
        "../../../etc/passwd",
    );
    let error = open_text(&stolen).unwrap_err();
    assert!(matches!(error, HousesError::Empty { .. }), "{error}");
}

#[test]
fn huge_counts_are_refused_before_memory_is_taken() {
    let message = |text: &str| {
        open_text(text).map_or_else(|error| error.to_string(), |(_, report)| report.to_string())
    };
    let base = text(r#"[{"mesh": 0}]"#, "");
    assert_eq!(
        message(&base.replace("\"byteLength\": 60", "\"byteLength\": 99999999999")),
        "a.gltf: buffers: buffer bytes 99999999999 is more than the 2147483648 that are read"
    );
    let beyond = base.replace("\"count\": 4,", "\"count\": 4000000000,");
    // The first warnings say why.
    let empty = "a.gltf: the house is empty, not one triangle could be read; 2 warnings, the first: a.gltf: meshes[0]";
    let told = message(&beyond);
    assert!(
        told.starts_with(empty) && told.contains("67108864 are read"),
        "{told}"
    );
    let offset = base.replace("\"byteOffset\": 48", "\"byteOffset\": 18446744073709551615");
    let told = message(&offset);
    assert!(told.starts_with(empty), "{told}");
}

#[test]
fn what_is_not_read_is_reported() {
    let cameras =
        r#", "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]"#;
    let (_, report) = open_text(&text(r#"[{"mesh": 0, "camera": 0}]"#, cameras)).unwrap();
    assert_eq!(
        report.count(
            |d| matches!(d, WarningKind::Simplified { what } if what == "1 cameras are not read")
        ),
        1
    );
}

#[test]
fn a_written_house_looks_the_same_when_read() {
    let folder = tempfile::tempdir().unwrap();
    let house = House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap();
    let path = folder.path().join("room.glb");
    let losses = gltf::write(&house, &path).unwrap();
    assert!(
        losses
            .iter()
            .any(|loss| loss.description.starts_with("rooms;"))
    );
    let (again, report) = open(&path.to_string_lossy()).unwrap();
    assert!(report.is_empty(), "{report}");
    assert_eq!(again.triangle_count(), house.triangle_count());
}

#[test]
fn the_apartment_keeps_its_places_and_textures_as_glb() {
    let folder = tempfile::tempdir().unwrap();
    let (house, _) = open("builtin:apartment").unwrap();
    let path = folder.path().join("apartment.glb");
    gltf::write(&house, &path).unwrap();
    let (again, report) = open(&path.to_string_lossy()).unwrap();
    assert_eq!(
        report.count(|d| !matches!(d, WarningKind::DegenerateTriangles)),
        0,
        "{report}"
    );
    assert_eq!(again.triangle_count(), house.triangle_count());
    let (a, b) = (
        house.levels.as_slice()[0].bounds,
        again.levels.as_slice()[0].bounds,
    );
    assert!(
        a.min.abs_diff_eq(b.min, 0.3) && a.max.abs_diff_eq(b.max, 0.3),
        "{a:?} became {b:?}"
    );
    // Texture coordinates under textures come through two turns of v.
    let range = |house: &House| {
        let parts = house.parts.iter().map(|part| (part.mesh, &part.materials));
        let pieces = house
            .structure
            .iter()
            .map(|piece| (piece.mesh, &piece.materials));
        let (mut low, mut high) = (Vec2::MAX, Vec2::MIN);
        for (mesh, materials) in parts.chain(pieces) {
            let mesh = &house.meshes[mesh];
            let textured = |k: &usize| {
                house.materials[materials[usize::from(mesh.slot(*k))]]
                    .texture
                    .is_some()
            };
            for vertex in (0..mesh.triangles.len())
                .filter(textured)
                .flat_map(|k| mesh.triangles[k])
            {
                if let Some(uv) = mesh.uvs.get(vertex as usize) {
                    (low, high) = (low.min(*uv), high.max(*uv));
                }
            }
        }
        (low, high)
    };
    let ((low, high), (low_again, high_again)) = (range(&house), range(&again));
    assert!(
        low.abs_diff_eq(low_again, 1e-3) && high.abs_diff_eq(high_again, 1e-3),
        "{low} {high} became {low_again} {high_again}"
    );
}

#[test]
fn every_real_texture_and_triangle_survives_as_glb() {
    let Some(real) = common::real() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("real.glb");
    gltf::write(&real.house, &path).unwrap();
    let (again, _) = open(&path.to_string_lossy()).unwrap();
    assert_eq!(again.triangle_count(), real.house.triangle_count());
    assert_eq!(again.textures.len(), real.house.textures.len());
}

/// As in HSSD: the texture has no image of its own, only one that Basis Universal compressed.
#[test]
fn images_of_basis_universal_are_reported_and_the_rest_is_read() {
    let extra = r#", "extensionsUsed": ["KHR_texture_basisu"], "extensionsRequired": ["KHR_texture_basisu"],
        "images": [{"mimeType": "image/ktx2", "uri": "data:image/ktx2;base64,q0tUWCAyMLsNChoK"}],
        "textures": [{"extensions": {"KHR_texture_basisu": {"source": 0}}}]"#;
    let text = text(r#"[{"mesh": 0, "name": "chair"}]"#, extra).replace(
        r#""baseColorFactor""#,
        r#""baseColorTexture": {"index": 0}, "baseColorFactor""#,
    );
    let (house, report) = open_text(&text).unwrap();
    assert_eq!(house.objects.len(), 1);
    let unreadable = |damage: &WarningKind| matches!(damage, WarningKind::UnreadableTexture { .. });
    assert_eq!(report.count(unreadable), 1, "{report:?}");
}

/// Returns what a foreign reader sees: the `gltf` crate's own document.
fn foreign(house: &House) -> ::gltf::Gltf {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.glb");
    gltf::write(house, &path).unwrap();
    ::gltf::Gltf::from_slice(&std::fs::read(&path).unwrap()).unwrap()
}

#[test]
fn nodes_stand_in_their_rooms_and_say_what_they_are() {
    let (house, _) = open("builtin:apartment").unwrap();
    let file = foreign(&house);
    let known = |node: &::gltf::Node<'_>| -> serde_json::Value {
        let text = node.extras().as_ref().unwrap().get();
        serde_json::from_str::<serde_json::Value>(text).unwrap()["dwell"].clone()
    };
    let level = file.default_scene().unwrap().nodes().next().unwrap();
    let mut seen = 0;
    for room in level.children().filter(|node| known_room(node, &house)) {
        assert_eq!(known(&room)["room"], room.name().unwrap());
        for node in room.children() {
            let extras = known(&node);
            let Some(name) = extras["object"].as_str() else {
                assert!(extras["structure"].is_string());
                continue;
            };
            let object = house.objects.iter().find(|o| o.name == name).unwrap();
            let home = &house.rooms[object.room.unwrap()];
            assert_eq!(home.name, room.name().unwrap());
            assert_eq!(extras["category"]["fine"], object.category.fine);
            let parts = node.children().filter(|child| child.light().is_none());
            assert_eq!(parts.count(), object.part_count as usize);
            seen += 1;
        }
    }
    let housed = house.objects.iter().filter(|o| o.room.is_some()).count();
    assert_eq!(seen, housed);
    let fridge = file
        .nodes()
        .find(|node| {
            node.name()
                .is_some_and(|name| name.starts_with("refrigerator"))
        })
        .unwrap();
    let joints = known(&fridge)["joints"].as_array().unwrap().clone();
    assert!(joints.iter().all(|joint| joint["kind"] == "hinge") && !joints.is_empty());
}

fn known_room(node: &::gltf::Node<'_>, house: &House) -> bool {
    house
        .rooms
        .iter()
        .any(|room| Some(room.name.as_str()) == node.name())
}

#[test]
fn the_sun_is_a_directional_light_of_its_illuminance() {
    for (hour, shines) in [("12.5", true), ("23", false)] {
        let house = open(&format!("seed:3?home=studio&time_of_day={hour}"))
            .unwrap()
            .0;
        let sky = house.sky.unwrap();
        let file = foreign(&house);
        let mut scene = file.default_scene().unwrap().nodes();
        let node = scene.find(|node| node.name() == Some("sun")).unwrap();
        let light = node.light().unwrap();
        let kind = light.kind();
        assert!(matches!(
            kind,
            ::gltf::khr_lights_punctual::Kind::Directional
        ));
        let told = Vec3::from(light.color()) * light.intensity();
        assert!(told.abs_diff_eq(Vec3::from(sky.sun_lx), 1e-2), "{told}");
        assert_eq!(told.max_element() > 0.0, shines);
        let turn = glam::Quat::from_array(node.transform().decomposed().1);
        let along = turn * Vec3::NEG_Z;
        assert!(along.abs_diff_eq(-sky.to_sun, 1e-4), "{along}");
    }
}

/// 1 W counts as 100 lm; a point light spreads them over 4 pi sr, a spot over the solid angle of its cone.
#[test]
fn lamps_shine_as_bright_and_where_they_stand() {
    let (house, _) = open("builtin:apartment").unwrap();
    let file = foreign(&house);
    let state = State::new(&house);
    let is_lamp = |node: &::gltf::Node<'_>| {
        let kind = node.light().map(|light| light.kind());
        kind.is_some_and(|kind| !matches!(kind, ::gltf::khr_lights_punctual::Kind::Directional))
    };
    let lights: Vec<_> = file.nodes().filter(is_lamp).collect();
    assert_eq!(lights.len(), house.lights.len());
    for node in &lights {
        let light = node.light().unwrap();
        let lamp = house
            .lights
            .iter()
            .find(|lamp| {
                let pose = state.part_pose[lamp.part];
                let [x, y, z] = node.transform().decomposed().0;
                // A line shines from its middle.
                let at = match lamp.shape {
                    LightShape::Line { end } => (lamp.position + end) / 2.0,
                    _ => lamp.position,
                };
                pose.transform_point(at)
                    .abs_diff_eq(Vec3::new(x, y, z), 1e-4)
                    && house.objects[lamp.object].name == light.name().unwrap()
            })
            .unwrap();
        let lumens = 100.0 * lamp.power_w;
        let shines = house.objects[lamp.object].switch != Some(false);
        let solid_angle = match light.kind() {
            ::gltf::khr_lights_punctual::Kind::Spot {
                outer_cone_angle, ..
            } => std::f32::consts::TAU * (1.0 - outer_cone_angle.cos()),
            _ => 2.0 * std::f32::consts::TAU,
        };
        let told = light.intensity() * solid_angle;
        let asked = if shines { lumens } else { 0.0 };
        assert!((told - asked).abs() <= 1e-3 * lumens, "{told} of {asked}");
    }
    assert!(
        lights
            .iter()
            .any(|node| node.light().unwrap().intensity() > 0.0)
    );
}

/// Lamps come back where they stood, as bright, on or off, and on the same object.
#[test]
fn lamps_come_back_from_our_own_glb() {
    let (house, _) = open("builtin:apartment").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("house.glb");
    gltf::write(&house, &path).unwrap();
    let (again, report) = open(&path.to_string_lossy()).unwrap();
    assert_eq!(again.lights.len(), house.lights.len(), "{report}");
    let in_world = |house: &House, light: &dwell_scene::Light| {
        let pose = house.parts[light.part].world_from_part;
        let (at, along) = match light.shape {
            LightShape::Point => (light.position, None),
            LightShape::Line { end } => ((light.position + end) / 2.0, None),
            LightShape::Spot {
                direction,
                cutoff_rad,
                ..
            } => (
                light.position,
                Some((pose.transform_vector(direction).normalize(), cutoff_rad)),
            ),
        };
        (pose.transform_point(at), along)
    };
    for light in &house.lights {
        let (at, along) = in_world(&house, light);
        let found = again.lights.iter().find(|twin| {
            let (there, turned) = in_world(&again, twin);
            let same_way = match (along, turned) {
                (Some(a), Some(b)) => a.0.abs_diff_eq(b.0, 1e-4) && (a.1 - b.1).abs() < 1e-4,
                (None, None) => true,
                _ => false,
            };
            there.abs_diff_eq(at, 1e-4) && same_way && twin.color == light.color
        });
        let name = &house.objects[light.object].name;
        let twin = found.unwrap_or_else(|| panic!("no light of {name} at {at}: {light:?}"));
        assert_eq!(twin.power_w, light.power_w, "{name}");
        let carrier = &again.objects[twin.object];
        assert!(
            carrier.source_id.starts_with(name.as_str()),
            "{name}: {}",
            carrier.source_id
        );
        let shines = house.objects[light.object].switch != Some(false);
        assert_eq!(carrier.switch, Some(shines), "{name}");
    }
}

/// Khronos Group, glTF 2.0, section 3.5.3: what a node may not say of its place is told.
#[test]
fn transforms_that_the_format_does_not_allow_are_reported() {
    let matrix = "\"matrix\": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]";
    let skewed = matrix.replacen("[1, 0, 0, 0,", "[1, 0, 0, 0.5,", 1);
    for (place, told) in [
        (matrix.to_owned(), None),
        (
            format!("{matrix}, \"translation\": [5, 5, 5]"),
            Some("its matrix counts"),
        ),
        (
            skewed,
            Some("the last row of its matrix is [0.5, 0.0, 0.0, 1.0]"),
        ),
        (
            "\"rotation\": [0, 0, 0, 1e30]".to_owned(),
            Some("its rotation has the length 1.0000e30"),
        ),
    ] {
        let nodes = format!(r#"[{{"mesh": 0, "name": "chair", {place}}}]"#);
        let (house, report) = open_text(&text(&nodes, "")).unwrap();
        let plain = r#"[{"mesh": 0, "name": "chair"}]"#;
        let (expected, _) = open_text(&text(plain, "")).unwrap();
        let found = house.object_bounds(&State::new(&house), ObjectId(0));
        let wanted = expected.object_bounds(&State::new(&expected), ObjectId(0));
        assert_eq!(found, wanted, "{place}");
        let said = report.to_string();
        assert_eq!(
            told.is_some(),
            said.contains(told.unwrap_or("counts as")),
            "{place}: {said}"
        );
    }
}

/// 50 cd in all directions are 2 pi W at 100 lm each; a spot of 60 degrees half angle spreads its 50 cd over pi sr.
#[test]
fn lights_of_a_foreign_file_are_lamps() {
    let nodes = r#"[{"name": "all", "children": [1, 2, 3, 4]}, {"mesh": 0, "name": "chair"},
        {"translation": [3, 2, 1], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"rotation": [-0.70710678, 0, 0, 0.70710678], "extensions": {"KHR_lights_punctual": {"light": 1}}},
        {"extensions": {"KHR_lights_punctual": {"light": 2}}}]"#;
    let lights = r#", "extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": [
        {"type": "point", "intensity": 50, "color": [1, 0.5, 0.25]},
        {"type": "spot", "intensity": 50, "spot": {"outerConeAngle": 1.0471976}},
        {"type": "directional"}]}}"#;
    let (house, report) = open_text(&text(nodes, lights)).unwrap();
    let [point, spot] = &house.lights[..] else {
        panic!("{} lights: {report}", house.lights.len());
    };
    assert!((point.power_w - std::f32::consts::TAU).abs() < 1e-4);
    assert_eq!(point.color, [1.0, 0.5, 0.25]);
    let pose = house.parts[point.part].world_from_part;
    let at = pose.transform_point(point.position);
    assert!(at.abs_diff_eq(Vec3::new(3.0, 2.0, 1.0), 1e-5));
    let LightShape::Spot { direction, .. } = spot.shape else {
        panic!("{spot:?}");
    };
    assert!(
        pose.transform_vector(direction)
            .abs_diff_eq(Vec3::NEG_Y, 1e-5)
    );
    assert!((spot.power_w - 0.5 * std::f32::consts::PI).abs() < 1e-4);
    assert_eq!(house.objects[point.object].switch, Some(true));
    assert!(report.to_string().contains("directional light"), "{report}");
}

#[test]
fn rooms_storeys_and_sky_come_back_from_our_own_glb() {
    let (house, _) = open("seed:2?home=house&storeys=2&clutter=0").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("house.glb");
    gltf::write(&house, &path).unwrap();
    let (again, report) = open(&path.to_string_lossy()).unwrap();
    assert_eq!(again.sky, house.sky);
    let names = |house: &House| -> Vec<String> {
        house
            .levels
            .iter()
            .map(|level| level.name.clone())
            .collect()
    };
    assert_eq!(names(&again), names(&house));
    let about = |house: &House| -> Vec<_> {
        let rooms = house.rooms.iter().map(|room| {
            let heights = (room.floor_y, room.ceiling_y);
            let place = (room.level, heights, room.footprint.clone());
            (room.name.clone(), room.kinds.clone(), place)
        });
        rooms.collect()
    };
    assert_eq!(about(&again), about(&house), "{report}");
    // Walls, floors and ceilings are what they were, each in its room and storey.
    let pieces = |house: &House| -> Vec<_> {
        let pieces = house.structure.iter();
        let mut pieces: Vec<_> = pieces
            .map(|piece| (piece.name.clone(), piece.kind, piece.room, piece.level))
            .collect();
        pieces.sort_by(|a, b| a.0.cmp(&b.0));
        pieces
    };
    assert_eq!(pieces(&again), pieces(&house));
    // So is furniture of one part.
    for object in house.objects.iter().filter(|object| object.part_count == 1) {
        let twin = again.objects.iter().find(|twin| twin.name == object.name);
        let twin = twin.unwrap_or_else(|| panic!("no {}", object.name));
        assert_eq!(
            (twin.room, twin.level),
            (object.room, object.level),
            "{}",
            object.name
        );
    }
}

#[test]
fn rooms_that_cannot_be_are_reported_and_passed_over() {
    let room = |footprint: &str, ceiling: &str, place: &str| {
        let nodes = format!(
            r#"[{{"name": "level_0", "children": [1]}},
            {{"name": "den", "children": [2] {place}, "extras": {{"dwell": {{"room": "den", "kinds": ["den"],
              "floor_y": 0.0, "ceiling_y": {ceiling}, "footprint": {footprint}}}}}}},
            {{"mesh": 0, "name": "chair"}}]"#
        );
        open_text(&text(&nodes, "")).unwrap()
    };
    let floor = "[[[0, 0], [2, 0], [2, 2]]]";
    let (house, report) = room(floor, "2.5", "");
    assert_eq!(house.rooms.len(), 1, "{report}");
    assert_eq!(
        house.objects.as_slice()[0].room,
        Some(dwell_scene::RoomId(0))
    );
    for (footprint, ceiling, place) in [
        (floor, "-1.0", ""),
        (floor, "1e30", ""),
        ("[[[0, 0], [2, 0]]]", "2.5", ""),
        ("7", "2.5", ""),
        (floor, "2.5", r#", "translation": [1, 0, 0]"#),
    ] {
        let (house, report) = room(footprint, ceiling, place);
        assert!(house.rooms.is_empty(), "{footprint} {ceiling} {place}");
        assert_eq!(
            report.count(|d| matches!(d, WarningKind::Simplified { .. })),
            1
        );
    }
}
