//! Houses that people make, as eyes, hands and ears find them.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(
    clippy::needless_pass_by_value,
    reason = "what json! makes is given as it stands"
)]

use dwell::{Engines, World, WorldConfig};
use dwell_acoustics::{AcousticConfig, AcousticScene};
use dwell_houses::authoring::{FileAccess, HousePlan, build};
use dwell_physics::actions;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, House, State};
use glam::Vec3;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::fs;
use std::sync::Arc;

const AGENT: AgentId = AgentId(0);
const BLOCK: usize = 800;

fn built(plan: Value) -> House {
    let plan: HousePlan = serde_json::from_value(plan).unwrap();
    build(&plan, &FileAccess::Anywhere).unwrap().0
}

/// A room of 4 by 2.5 by 3 m with a floor of carpet and walls of brick, and a second one behind a door.
fn rooms(edits: Value) -> Value {
    let covering = |name: &str| json!({"substance": name});
    json!({"edits": edits, "building": {"storeys": [{"height_m": 2.5,
        "rooms": [
            {"name": "study", "outline": [[0, 0], [4, 0], [4, 3], [0, 3]], "floor": covering("carpet"),
             "walls": covering("brick"), "ceiling": covering("acoustic_panel")},
            {"name": "hall", "outline": [[4.1, 0], [6, 0], [6, 3], [4.1, 3]], "floor": covering("concrete")},
        ],
        "doors": [{"rooms": ["study", "hall"], "name": "way"}],
    }]}})
}

fn world(house: House) -> World {
    let mut world = World::new(Engines::new(Arc::new(house)), &WorldConfig::default()).unwrap();
    world.reset(RandomKey::root(5)).unwrap();
    world
}

/// Returns what both ears heard in some steps.
fn heard_rms(world: &mut World, steps: usize) -> f64 {
    let mut power = 0.0;
    for _ in 0..steps {
        world.step(&[]).unwrap();
        for channel in 0..2 {
            let mut heard = [0.0; BLOCK];
            world.newest_samples(AGENT, channel, &mut heard);
            power += heard.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>();
        }
    }
    (power / (2 * steps * BLOCK) as f64).sqrt()
}

#[test]
fn sound_meets_the_areas_of_what_the_rooms_are_covered_with() {
    let house = Arc::new(built(rooms(json!([]))));
    let scene = AcousticScene::new(house, AcousticConfig::rl()).unwrap();
    let told = scene.material_report();
    let area = |substance: &str| -> f64 {
        let rows = told
            .materials
            .iter()
            .filter(|row| row.substance == substance);
        rows.map(|row| row.area_m2).sum()
    };
    // The slab of the floor: its upper face reaches under the walls, and has a lower face and edges of 0.2 m.
    let floor = area("carpet");
    assert!(
        (2.0 * 12.0..2.0 * 4.4 * 3.4 + 0.2 * 2.0 * (4.4 + 3.4) + 0.1).contains(&floor),
        "{floor}"
    );
    // The inner faces of its four walls, less the door to the hall.
    let brick = area("brick");
    assert!(
        (brick - (2.0 * (4.0 + 3.0) * 2.5 - 0.98 * 2.06)).abs() < 0.01,
        "{brick}"
    );
    let row = told
        .materials
        .iter()
        .find(|row| row.substance == "carpet")
        .unwrap();
    let library = dwell_scene::material::library().get("carpet").unwrap();
    assert!((row.absorption[4] - library.absorption.at(1000.0)).abs() < 1e-6);
}

#[test]
fn a_hand_opens_the_door() {
    let mut world = world(built(rooms(json!([]))));
    let door = world.house().object_named("way").unwrap();
    world
        .place_agent(
            AGENT,
            Vec3::new(2.6, 0.0, 1.5),
            -std::f32::consts::FRAC_PI_2,
        )
        .unwrap();
    let openness = |world: &World| {
        let house = world.house().clone();
        let (id, joint) = house
            .joints
            .iter_ids()
            .find(|(_, joint)| joint.object == door)
            .unwrap();
        joint.openness(world.state().joint_position[id])
    };
    assert!(openness(&world) < 0.01);
    let outcome = world.act(
        AGENT,
        &actions::Open {
            target: door.into(),
            fraction: 1.0,
        },
    );
    assert!(outcome.success, "{}", outcome.sentence);
    for _ in 0..80 {
        world.step(&[]).unwrap();
    }
    assert!(openness(&world) > 0.8, "{}", openness(&world));
}

/// A cube of an edge of 1 as an OBJ file with two materials.
const CUBE: &str = "o cube\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\nv 1 1 0\nv 1 1 1\nv 0 1 1\n\
    usemtl a\nf 1 2 3 4\nf 5 8 7 6\nusemtl b\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";

#[test]
fn an_own_mesh_falls_rests_weighs_and_rings_as_it_was_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cube.obj");
    fs::write(&path, CUBE).unwrap();
    let drop = |substance: &str| {
        let cube = json!({"add": {"what": {"file": {"path": path, "scale": 0.12}}, "name": "mine",
            "place": {"at": [5, 0.6, 1.5], "yaw_deg": 20}, "traits": {"mass_kg": 0.75}, "look": {"substance": substance, "keep_look": true}}});
        let mut world = world(built(rooms(json!([cube]))));
        world
            .place_agent(AGENT, Vec3::new(4.6, 0.0, 0.6), 0.0)
            .unwrap();
        world.enable_listeners(&[(AGENT, BLOCK)]).unwrap();
        let mine = world.house().object_named("mine").unwrap();
        let mass = world
            .parameter(&"part/mine/body/mass_kg".parse().unwrap())
            .unwrap();
        assert!((mass.value - 0.75).abs() < 1e-6);
        let part = world.house().objects[mine].first_part;
        let (mut touched, mut high) = (Vec::new(), 0.0);
        for _ in 0..60 {
            world.step(&[]).unwrap();
            let mut heard = [0.0; BLOCK];
            world.newest_samples(AGENT, 0, &mut heard);
            let steps = heard
                .windows(2)
                .map(|pair| f64::from(pair[1] - pair[0]).powi(2));
            high += steps.sum::<f64>();
            touched.extend(
                world
                    .events()
                    .iter()
                    .flat_map(|event| [event.substance_a, event.substance_b]),
            );
        }
        let state = world.state();
        let speed = state.part_velocity[part].linear.length();
        // The mesh's own origin is its corner: it lies flat on the floor, whose height is 0.
        let height = state.part_pose[part].position.y;
        assert!(speed < 1e-3 && height.abs() < 0.005, "{speed} {height}");
        assert!(touched.contains(&substance), "{touched:?}");
        high
    };
    // Struck steel rings high, foam does not; how low the blow itself is depends on its weight, which is the same.
    let (steel, foam) = (drop("steel"), drop("foam"));
    assert!(steel > 100.0 * foam && foam > 0.0, "{steel} {foam}");
}

#[test]
fn an_emitter_is_heard_from_the_start_at_its_level() {
    let at = [1.0, 1.2, 1.5];
    let quiet = built(rooms(json!([])));
    let emitter = |level_db: f32| json!([{"add_emitter": {"at": at, "name": "voice", "sound": {"signal": "noise", "level_db": level_db}}}]);
    let listen = |house: House| {
        let mut world = world(house);
        world
            .place_agent(AGENT, Vec3::new(3.0, 0.0, 1.5), std::f32::consts::FRAC_PI_2)
            .unwrap();
        world.enable_listeners(&[(AGENT, BLOCK)]).unwrap();
        heard_rms(&mut world, 2);
        heard_rms(&mut world, 20)
    };
    let loud = built(rooms(emitter(70.0)));
    let voice = loud.object_named("voice").unwrap();
    // The source is where it was put, above its disc, in the free.
    let state = State::new(&loud);
    let source = loud.emitters.last().unwrap();
    assert_eq!(source.object, voice);
    assert!(
        (state.part_pose[source.part].transform_point(source.position) - Vec3::from(at)).length()
            < 1e-5
    );
    let (loud, soft, silence) = (
        listen(loud),
        listen(built(rooms(emitter(50.0)))),
        listen(quiet),
    );
    assert!(silence < 0.02 * soft, "{silence} {soft}");
    let apart_db = 20.0 * (loud / soft).log10();
    assert!((apart_db - 20.0).abs() < 0.5, "{apart_db}");
    // 70 dB SPL at 1 m is a power of 81 dB: more than the free field's 64 dB at 2 m, and less than what a room would give that
    // absorbs as 4 m2 of open window (81 dB); the ceiling alone absorbs more.
    let level_db = 20.0 * (loud / 20e-6).log10();
    assert!((64.0..81.0).contains(&level_db), "{level_db}");
}

/// Half a second of a tone of 1 kHz at 8,000 samples a second of 8 bits, as a WAV file.
fn tone() -> Vec<u8> {
    const RATE_HZ: u32 = 8_000;
    let samples: Vec<u8> = [128, 185, 208, 185, 128, 71, 48, 71].repeat(500);
    let count = samples.len() as u32;
    let mut file = b"RIFF".to_vec();
    file.extend((36 + count).to_le_bytes());
    file.extend(b"WAVEfmt \x10\0\0\0\x01\0\x01\0");
    file.extend([RATE_HZ, RATE_HZ].map(u32::to_le_bytes).concat());
    file.extend(b"\x01\0\x08\0data");
    file.extend(count.to_le_bytes());
    file.extend(samples);
    file
}

#[test]
fn a_sound_file_is_heard_when_it_is_told_to_and_at_its_level() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tone.wav");
    fs::write(&path, tone()).unwrap();
    let emitter = |more: Value| {
        let mut sound = json!({"file": path, "level_db": 60.0});
        for (key, value) in more.as_object().unwrap() {
            sound[key] = value.clone();
        }
        world(built(rooms(
            json!([{"add_emitter": {"at": [1.0, 1.2, 1.5], "sound": sound}}]),
        )))
    };
    // RMS of both ears in each tenth of a second.
    let heard = |mut world: World| -> Vec<f64> {
        world
            .place_agent(AGENT, Vec3::new(3.0, 0.0, 1.5), std::f32::consts::FRAC_PI_2)
            .unwrap();
        world.enable_listeners(&[(AGENT, BLOCK)]).unwrap();
        (0..20).map(|_| heard_rms(&mut world, 2)).collect()
    };
    let once = heard(emitter(json!({"loops": false, "start_s": 0.6})));
    let over = heard(emitter(json!({"level_db": 66.0})));
    let late = heard(emitter(json!({"start_s": 1.0})));
    let mean = |rms: &[f64]| (rms.iter().map(|x| x * x).sum::<f64>() / rms.len() as f64).sqrt();
    // Nothing is heard before it begins but the room's noise, then the tone, then its reverberation dies away.
    let (before, during, after) = (mean(&once[..6]), mean(&once[7..11]), mean(&once[16..]));
    assert!(before < 0.01 * during && after < 0.05 * during, "{once:?}");
    assert!(mean(&late[..10]) < 0.01 * mean(&late[12..]), "{late:?}");
    // Over and over: as loud at the end as before, 6 dB above the other.
    let (first, last) = (mean(&over[4..10]), mean(&over[14..]));
    assert!((20.0 * (first / last).log10()).abs() < 0.5, "{over:?}");
    let apart_db = 20.0 * (last / mean(&late[14..])).log10();
    assert!((apart_db - 6.0).abs() < 0.5, "{apart_db}");
    // As of a signal of that level: between the free field's and that of a room without carpet.
    let level_db = 20.0 * (last / 20e-6).log10();
    assert!((60.0..77.0).contains(&level_db), "{level_db}");
    let named = emitter(json!({})).sounds();
    let named = named.last().unwrap();
    assert_eq!(named.sound, dwell::SoundName::File("tone.wav".to_owned()));
}

#[test]
fn a_sound_that_goes_on_is_the_same_after_a_restore() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tone.wav");
    fs::write(&path, tone()).unwrap();
    let sound = json!({"file": path, "level_db": 60.0, "loops": false, "start_s": 0.3});
    let house = built(rooms(
        json!([{"add_emitter": {"at": [1.0, 1.2, 1.5], "sound": sound}}]),
    ));
    let mut world = world(house);
    world.enable_listeners(&[(AGENT, BLOCK)]).unwrap();
    heard_rms(&mut world, 8);
    let snapshot = world.snapshot();
    let first = heard_rms(&mut world, 10);
    world.restore(&snapshot).unwrap();
    assert_eq!(heard_rms(&mut world, 10).to_bits(), first.to_bits());
}

#[test]
fn agents_and_free_episodes_start_where_the_house_says() {
    let starts = json!([
        {"agent_start": {"room": "hall", "yaw_deg": 90.0}},
        {"agent_start": {"at": [1.0, 0.0, 1.0], "room": "study"}},
    ]);
    let house = Arc::new(built(rooms(starts)));
    let engines = Engines::new(house.clone());
    let body = dwell_scene::AgentBody::default();
    let config = WorldConfig {
        agents: vec![body; 3],
        ..WorldConfig::default()
    };
    let mut world = World::new(engines.clone(), &config).unwrap();
    world.reset(RandomKey::root(5)).unwrap();
    let agents = world.state().agents.as_slice();
    let room = |k: usize| {
        let room = house.room_at(agents[k].position + Vec3::Y * 0.1).unwrap();
        house.rooms[room].name.as_str()
    };
    // The third has no start of its own: the first room's floor.
    assert_eq!([0, 1, 2].map(room), ["hall", "study", "study"]);
    assert!((agents[0].yaw_rad - std::f32::consts::FRAC_PI_2).abs() < 1e-6);
    assert!((agents[1].position - Vec3::new(1.0, 0.0, 1.0)).length() < 1e-3);

    let begin = |settings: Value, seed: u64| {
        let config = dwell::EnvConfig {
            task: "Free".to_owned(),
            task_settings: settings,
            ..dwell::EnvConfig::default()
        };
        let mut env = dwell::Env::new(engines.clone(), &config).unwrap();
        env.reset(seed).unwrap();
        env.world().state().agents[AGENT].position
    };
    let own = house.agent_starts[0].position;
    for seed in 0..3 {
        assert!((begin(Value::Null, seed) - own).length() < 0.05);
    }
    let apart = |seed| (begin(json!({"start": "anywhere"}), seed) - own).length() > 0.3;
    assert!((0..4).filter(|seed| apart(*seed)).count() >= 2);
}

#[test]
fn a_hand_opens_a_door_that_a_map_has_hung() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = "o Floor\nv 0 0 0\nv 0 0 4\nv 4 0 4\nv 4 0 0\nf 1 2 3 4\no Leaf.1\n".to_owned();
    for y in [0.01, 2.01] {
        for (x, z) in [(1.5, 2.0), (2.4, 2.0), (2.4, 2.04), (1.5, 2.04)] {
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
    }
    text += "f 5 6 7 8\nf 9 12 11 10\nf 5 9 10 6\nf 6 10 11 7\nf 7 11 12 8\nf 8 12 9 5\n";
    fs::write(folder.path().join("a.obj"), text).unwrap();
    let map = "[nodes]\n\"leaf*\" = { name = \"door\", mass_kg = 20.0, hinge = { edge = \"-x\", open_deg = 100 } }\n";
    fs::write(folder.path().join("m.toml"), map).unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let house = format!("{}?map={}", at("a.obj"), at("m.toml"));
    let (house, _) = dwell_houses::open(&house).unwrap();
    let mut world = world(house);
    let door = world.house().object_named("door").unwrap();
    world
        .place_agent(AGENT, Vec3::new(1.9, 0.0, 2.9), 0.0)
        .unwrap();
    let open = actions::Open {
        target: door.into(),
        fraction: 1.0,
    };
    let outcome = world.act(AGENT, &open);
    assert!(outcome.success, "{}", outcome.sentence);
    for _ in 0..100 {
        world.step(&[]).unwrap();
    }
    let turned = world.state().joint_position.as_slice()[0];
    assert!(turned > 80_f32.to_radians(), "{turned}");
}
