//! Every sensor, every kind of camera by every preset, plans and doll's houses, against the pictures of `tests/golden`.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use dwell::sensors::{Observation, ObservationData, SensorSpec};
use dwell::{CameraMount, Engines, ImageRequest, World};
use dwell_physics::AgentControl;
use dwell_render::{ClassSet, Dollhouse, DollhouseConfig, Preset, Projection, StoreyMap};
use dwell_scene::parallel::Threads;
use dwell_scene::{AgentId, House, HouseData, Pose, StructureKind};
use dwell_tests::golden::views::{self, ROOMS};
use dwell_tests::golden::{Golden, LOOKS, StoredObservation};
use serde_json::json;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

fn golden() -> Golden {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden");
    Golden::new(
        &folder,
        &Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden"),
    )
}

/// Names of the sensors that give pictures or lists of what pictures show.
fn sensors() -> Vec<&'static str> {
    let all = dwell::sensors::all().iter();
    all.filter(|kind| kind.is_image_sensor())
        .map(|kind| kind.name)
        .collect()
}

#[test]
fn pictures_are_the_golden_ones() {
    let mut golden = golden();
    for viewpoint in ROOMS {
        let (name, house, ..) = viewpoint;
        let world = views::world(house);
        let camera = views::plain_camera(96, 72).unwrap();
        for preset in Preset::ALL {
            for rgb in views::look(&world, viewpoint, camera, preset, &["rgb"]).unwrap() {
                golden.check(&format!("preset_{}_{name}", preset.name()), &rgb);
            }
        }
        if house != "builtin:apartment" {
            continue;
        }
        for (name, camera) in views::cameras().unwrap() {
            let seen = ["rgb", "depth", "instance"];
            for image in views::look(&world, viewpoint, camera, Preset::Lit, &seen).unwrap() {
                golden.check(&format!("camera_{name}_{}", image.spec.name), &image);
            }
            for preset in Preset::ALL {
                if preset == Preset::Lit {
                    continue;
                }
                for rgb in views::look(&world, viewpoint, camera, preset, &["rgb"]).unwrap() {
                    golden.check(&format!("camera_{name}_rgb_{}", preset.name()), &rgb);
                }
            }
        }
    }
    let world = turned(views::world_of_two_agents());
    for image in views::observe_request(&world, eyes(), &sensors(), ClassSet::Coarse).unwrap() {
        golden.check(&format!("sensor_{}", image.spec.name), &image);
    }
    for (name, classes) in [("fine", ClassSet::Fine), ("nyu40", ClassSet::Nyu40)] {
        for image in views::observe_request(&world, eyes(), &["semantic"], classes).unwrap() {
            golden.check(&format!("sensor_semantic_{name}"), &image);
        }
    }
    plans(&mut golden);
    let faults = golden.finish();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Both storeys of a house as plans and as a doll's house.
fn plans(golden: &mut Golden) {
    let world = views::world("builtin:house");
    let house = world.house();
    let (renderer, rays, state) = (
        world.engines().cpu_renderer().unwrap(),
        world.rays(),
        world.state(),
    );
    let config = DollhouseConfig {
        width: 128,
        ..DollhouseConfig::default()
    };
    for level in house.levels.ids() {
        let map = StoreyMap::new(house, level, 128).unwrap();
        let plan = map.render(renderer, rays, state, Threads::ONE).unwrap();
        golden.check_color(
            &format!("plan_map_{}", level.0),
            map.view.camera.width(),
            plan,
        );
        let doll = Dollhouse::new(house, level, &config).unwrap();
        let picture = doll.render(renderer, rays, state, Threads::new(3)).unwrap();
        golden.check_color(&format!("plan_dollhouse_{}", level.0), 128, picture);
    }
}

/// Returns what the first agent sees.
fn eyes() -> ImageRequest {
    ImageRequest {
        camera: views::plain_camera(80, 60).unwrap(),
        mount: CameraMount::Agent(AgentId(0), Pose::IDENTITY),
        preset: Preset::Lit,
    }
}

/// A pixel of what [`eyes`] see that shows nothing but a wall.
const WALL: usize = 20 * 80 + 20;

/// The first agent has turned to the left, and the second has walked to its right.
fn turned(mut world: World) -> World {
    let turn = AgentControl {
        yaw_rate_rad_s: 0.8,
        ..AgentControl::default()
    };
    let walk = AgentControl {
        right_m_s: 0.6,
        ..AgentControl::default()
    };
    world.step(&[turn, walk]).unwrap();
    world
}

/// The golden view in which defects hide.
fn lit(world: &World) -> Observation {
    let camera = views::plain_camera(96, 72).unwrap();
    let seen = views::look(world, ROOMS[0], camera, Preset::Lit, &["rgb"]);
    seen.unwrap().remove(0)
}

/// Mean difference and share of rough pixels from the golden picture, and whether that is allowed.
fn judge(observation: &Observation) -> (f64, f64, bool) {
    let kept = StoredObservation::of(observation).unwrap();
    let difference = golden()
        .difference("preset_lit_living_room", &kept)
        .unwrap();
    (
        difference.mean(),
        difference.rough_share(),
        difference.judge().is_ok(),
    )
}

fn edited(edit: impl FnOnce(&mut HouseData)) -> World {
    let mut data = dwell_tests::apartment().house().data().clone();
    edit(&mut data);
    views::world_over(Engines::new(Arc::new(House::new(data).unwrap())))
}

#[test]
fn hidden_defects_are_found() {
    let sound = lit(&views::world("builtin:apartment"));
    let (_, _, allowed) = judge(&sound);
    assert!(allowed, "the picture itself is allowed");

    // One lamp of the room is dark.
    let engines = dwell_tests::apartment();
    let rooms = engines.house().rooms.iter_ids();
    let mut rooms = rooms.filter(|(_, room)| room.name == "living_room");
    let room = rooms.next().map(|(id, _)| id);
    let dark = edited(|data| {
        let objects = &data.objects;
        let mut lights = data.lights.iter();
        let lamp = lights.position(|light| objects[light.object].room == room);
        data.lights
            .remove(lamp.expect("the living room has a lamp"));
    });
    let (mean, share, allowed) = judge(&lit(&dark));
    println!("one lamp off: mean {mean:.4}, rough {share:.4}");
    assert!(!allowed, "one lamp off: {mean} {share}");

    // The floor has the texture of something else.
    let swapped = edited(|data| {
        let pieces = data.structure.iter();
        let mut floors = pieces.filter(|one| one.kind == StructureKind::Floor && one.room == room);
        let floor = floors.next().expect("a floor").materials[0];
        let own = data.materials[floor].texture;
        let others = || data.materials.iter().map(|one| one.texture);
        let other = others().find(|texture| texture.is_some() && *texture != own);
        data.materials[floor].texture = other.expect("two textures");
    });
    let (mean, share, allowed) = judge(&lit(&swapped));
    println!("a texture swapped: mean {mean:.4}, rough {share:.4}");
    assert!(!allowed, "a texture swapped: {mean} {share}");

    // The whole picture is a hundredth brighter.
    let ObservationData::Uint8(rgb) = &sound.data else {
        panic!("colours are bytes")
    };
    let brighter = rgb
        .iter()
        .map(|byte| (f32::from(*byte) * 1.01).round().min(255.0) as u8);
    let brighter = Observation {
        spec: sound.spec.clone(),
        data: ObservationData::Uint8(brighter.collect()),
    };
    let (mean, share, allowed) = judge(&brighter);
    println!("a hundredth brighter: mean {mean:.4}, rough {share:.4}");
    assert!(!allowed, "a hundredth brighter: {mean} {share}");
    assert!(mean > 1.5 * LOOKS.mean, "not by chance: {mean}");
}

/// The names that a type reads, as serde lists them when it meets another.
fn known(error: &serde_json::Error) -> Vec<String> {
    let sentence = error.to_string();
    let words = sentence.split('`').skip(1).step_by(2);
    words
        .filter(|word| *word != "?")
        .map(str::to_owned)
        .collect()
}

/// A preset or kind of camera that comes later is not forgotten.
#[test]
fn every_preset_and_kind_of_camera_has_golden_pictures() {
    let shown = Preset::ALL.map(|preset| {
        assert_eq!(serde_json::to_value(preset).unwrap(), json!(preset.name()));
        preset.name().to_owned()
    });
    let strange = serde_json::from_value::<Preset>(json!("?")).unwrap_err();
    assert_eq!(known(&strange), shown);
    let cameras = views::cameras().unwrap().into_iter();
    let shown: BTreeSet<String> = cameras
        .map(|(_, camera)| serde_json::to_value(camera.projection()).unwrap())
        .map(|projection| projection["kind"].as_str().unwrap().to_owned())
        .collect();
    let strange = serde_json::from_value::<Projection>(json!({"kind": "?"})).unwrap_err();
    let kinds = known(&strange);
    assert!(kinds.len() >= 6, "{kinds:?}");
    assert_eq!(kinds.into_iter().collect::<BTreeSet<_>>(), shown);
}

/// A depth that is a millimetre off somewhere, an id that is another away from edges, and a list without its last row.
#[test]
fn small_errors_of_exact_sensors_are_found() {
    let world = turned(views::world_of_two_agents());
    for image in views::observe_request(
        &world,
        eyes(),
        &["depth", "instance", "boxes_2d"],
        ClassSet::Coarse,
    )
    .unwrap()
    {
        let name = format!("sensor_{}", image.spec.name);
        let judge = |data: ObservationData| {
            let spoilt = Observation {
                spec: image.spec.clone(),
                data,
            };
            golden()
                .difference(&name, &StoredObservation::of(&spoilt).unwrap())
                .and_then(|found| found.judge())
        };
        assert_eq!(judge(image.data.clone()), Ok(()), "{name}");
        let fault = match image.data.clone() {
            ObservationData::Float32(mut depth) => {
                depth[WALL] += 1e-3;
                judge(ObservationData::Float32(depth))
            }
            ObservationData::Int32(mut ids) if image.spec.shape.len() == 3 => {
                ids[WALL] += 1;
                judge(ObservationData::Int32(ids))
            }
            ObservationData::Int32(mut rows) => {
                let parts = image.spec.shape[1];
                let end = rows.chunks(parts).take_while(|row| row[0] != 0).count() * parts;
                rows[end - parts..end].fill(0);
                judge(ObservationData::Int32(rows))
            }
            ObservationData::Uint8(_) => Ok(()),
        };
        assert!(fault.is_err(), "{name}");
    }
}

#[test]
fn a_missing_golden_picture_fails_with_a_sentence() {
    let spec = SensorSpec {
        name: "rgb".to_owned(),
        shape: vec![1, 1, 3],
        ..lit(&views::world("builtin:apartment")).spec
    };
    let pixel = Observation {
        spec,
        data: ObservationData::Uint8(vec![0; 3]),
    };
    let sentence = golden()
        .difference("nowhere", &StoredObservation::of(&pixel).unwrap())
        .unwrap_err();
    assert!(
        sentence.contains("there is no") && sentence.contains("UPDATE_GOLDEN=1"),
        "{sentence}"
    );
}
