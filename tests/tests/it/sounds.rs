//! Sounds played in a world, and what its agents hear of them.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use dwell::{Engines, PlayRequest, SoundName, SoundPlace, World, WorldConfig};
use dwell_physics::BodyState;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, House, ObjectId, Pose, ShoeboxMaterials, Velocity};
use glam::Vec3;
use std::sync::Arc;

const AGENT: AgentId = AgentId(0);
const BLOCK: usize = 800;

/// A bare room with one agent in its middle, who faces -Z.
fn bare(config: &WorldConfig) -> World {
    let house = House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
    let mut world = World::new(Engines::new(Arc::new(house)), config).unwrap();
    world.reset(RandomKey::root(3)).unwrap();
    world
        .place_agent(AGENT, Vec3::new(3.0, 0.0, 2.5), 0.0)
        .unwrap();
    world.enable_listeners(&[(AGENT, BLOCK)]).unwrap();
    world
}

fn request(sound: &str, place: SoundPlace, level_db: f32, loops: bool) -> PlayRequest {
    let sound = if sound.contains(".wav") {
        SoundName::File(sound.to_owned())
    } else {
        SoundName::Signal(sound.to_owned())
    };
    PlayRequest {
        sound,
        place,
        level_db,
        loops,
    }
}

fn at(x: f32, y: f32, z: f32) -> SoundPlace {
    SoundPlace::Point(Vec3::new(x, y, z))
}

/// Makes steps; what both ears heard. Shape (step, 2 * `BLOCK`).
fn hear(world: &mut World, steps: usize) -> Vec<Vec<f32>> {
    let step = |_| {
        world.step(&[]).unwrap();
        let mut heard = vec![0.0; 2 * BLOCK];
        for (channel, out) in heard.chunks_exact_mut(BLOCK).enumerate() {
            world.newest_samples(AGENT, channel, out);
        }
        heard
    };
    (0..steps).map(step).collect()
}

fn rms(blocks: &[Vec<f32>]) -> f64 {
    let samples = || blocks.iter().flatten();
    let power: f64 = samples().map(|x| f64::from(*x).powi(2)).sum();
    (power / samples().count() as f64).sqrt()
}

/// A tone of 16-bit samples as a WAV file.
fn wav(rate_hz: u32, frequency_hz: f64, samples: u32) -> Vec<u8> {
    let mut file = b"RIFF".to_vec();
    file.extend((36 + 2 * samples).to_le_bytes());
    file.extend(b"WAVEfmt ");
    file.extend(16_u32.to_le_bytes());
    for field in [1_u16, 1] {
        file.extend(field.to_le_bytes());
    }
    for field in [rate_hz, 2 * rate_hz] {
        file.extend(field.to_le_bytes());
    }
    for field in [2_u16, 16] {
        file.extend(field.to_le_bytes());
    }
    file.extend(b"data");
    file.extend((2 * samples).to_le_bytes());
    for k in 0..samples {
        let phase = std::f64::consts::TAU * frequency_hz * f64::from(k) / f64::from(rate_hz);
        file.extend(((3_000.0 * phase.sin()) as i16).to_le_bytes());
    }
    file
}

/// A second of a hundred tones from 100 Hz to 5 kHz, spread evenly over the octaves: a room's resonances average out.
fn chord() -> Vec<u8> {
    const RATE_HZ: u32 = 44_100;
    let mut file = wav(RATE_HZ, 0.0, RATE_HZ);
    let start = file.len() - 2 * RATE_HZ as usize;
    let frequencies_hz: Vec<f64> = (0..100)
        .map(|k| (100.0 * 50.0_f64.powf(f64::from(k) / 100.0)).round())
        .collect();
    for (k, sample) in file[start..].chunks_exact_mut(2).enumerate() {
        let turns = k as f64 / f64::from(RATE_HZ);
        let sum: f64 = (0_i32..)
            .zip(&frequencies_hz)
            .map(|(n, f)| (std::f64::consts::TAU * (f * turns + 0.618 * f64::from(n * n))).sin())
            .sum();
        sample.copy_from_slice(&((1_000.0 * sum) as i16).to_le_bytes());
    }
    file
}

#[test]
fn a_sound_is_heard_from_its_start_to_its_end_and_no_longer() {
    let mut world = bare(&WorldConfig::default());
    let silent = hear(&mut world, 2);
    assert!(silent.iter().flatten().all(|x| *x == 0.0));
    // The loop of the noise lasts 4 s: 80 steps.
    let place = at(4.5, 1.5, 2.5);
    let handle = world.play(request("noise", place, 70.0, false)).unwrap();
    assert_eq!(world.sounds().len(), 1);
    let during = hear(&mut world, 80);
    assert!(
        during
            .iter()
            .all(|block| rms(std::slice::from_ref(block)) > 0.01)
    );
    // Whoever begins to listen now still hears its last block.
    hear(&mut world, 1);
    assert!(world.sounds().is_empty());
    assert!(world.stop_sound(handle).is_err());
    // The room rings out, then nothing is left.
    hear(&mut world, 60);
    assert!(hear(&mut world, 3).iter().flatten().all(|x| *x == 0.0));
    // One that loops goes on.
    let handle = world.play(request("noise", place, 70.0, true)).unwrap();
    assert_ne!(world.sounds()[0].handle, 0);
    let looped = hear(&mut world, 100);
    assert!(rms(&looped[90..]) > 0.01);
    assert_eq!(world.sounds()[0].handle, handle);
}

/// Twenty decibels are ten times the pressure, sample for sample, and a level that is set acts from the next step on.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn levels_are_pressures() {
    let loud = |level_db: f32, later_db: Option<f32>| {
        let mut world = bare(&WorldConfig::default());
        let request = request("speech", at(4.5, 1.5, 2.0), level_db, true);
        let handle = world.play(request).unwrap();
        if let Some(level_db) = later_db {
            world.set_sound_level(handle, level_db).unwrap();
        }
        hear(&mut world, 30)
    };
    let (quiet, strong) = (loud(60.0, None), loud(80.0, None));
    assert!((rms(&strong) / rms(&quiet) - 10.0).abs() < 1e-3);
    for (a, b) in quiet.iter().flatten().zip(strong.iter().flatten()) {
        assert!((10.0 * a - b).abs() < 1e-4 * rms(&strong) as f32 + 1e-3 * b.abs());
    }
    // Beyond the first 5 ms of the direct sound and the reverberation of that moment.
    let set = loud(60.0, Some(80.0));
    assert!((rms(&set[20..]) / rms(&strong[20..]) - 1.0).abs() < 0.01);
}

#[test]
fn what_is_stopped_fades_and_is_forgotten() {
    let mut world = bare(&WorldConfig::default());
    let handle = world
        .play(request("hum", at(3.5, 1.5, 2.5), 80.0, true))
        .unwrap();
    let playing = hear(&mut world, 30);
    world.stop_sound(handle).unwrap();
    let after = hear(&mut world, 60);
    assert!(
        world
            .stop_sound(handle)
            .unwrap_err()
            .to_string()
            .contains("is over")
    );
    // Third differences make little of a hum and much of a click: one of a hundredth of the hum's height would stand out.
    let roughest = |blocks: &[Vec<f32>]| {
        let ear: Vec<f32> = blocks
            .iter()
            .flat_map(|block| block[..BLOCK].to_vec())
            .collect();
        let third = |w: &[f32]| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).abs();
        ear.windows(4).map(third).fold(0.0, f32::max)
    };
    let (hum, ring) = (roughest(&playing[10..]), roughest(&after));
    assert!(ring <= 1.05 * hum, "{ring} {hum}");
    assert!(after[50..].iter().flatten().all(|x| *x == 0.0));
}

#[test]
fn a_file_sounds_at_the_level_it_is_told() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("bells")).unwrap();
    // Of another rate than the world's.
    std::fs::write(folder.path().join("bells/door.wav"), chord()).unwrap();
    let config = WorldConfig {
        sound_root: Some(folder.path().to_str().unwrap().to_owned()),
        ..WorldConfig::default()
    };
    let place = at(4.0, 1.5, 2.5);
    let mut level_db = Vec::new();
    for sound in ["bells/door.wav", "noise"] {
        let mut world = bare(&config);
        world.play(request(sound, place, 70.0, true)).unwrap();
        let heard = hear(&mut world, 40);
        level_db.push(20.0 * (rms(&heard[20..]) / 20e-6).log10());
    }
    // Direct sound at 1 m alone is 70 dB.
    assert!((level_db[0] - level_db[1]).abs() < 4.0, "{level_db:?}");
    assert!(level_db[1] > 67.0 && level_db[1] < 82.0, "{level_db:?}");
    let mut world = bare(&config);
    let refusal = |world: &mut World, name: &str| {
        let before = world.hash();
        let error = world.play(request(name, place, 70.0, false)).unwrap_err();
        assert_eq!(world.hash(), before);
        error.to_string()
    };
    assert!(refusal(&mut world, "../door.wav").contains("door.wav"));
    assert!(refusal(&mut world, "/etc/door.wav").contains("door.wav"));
    assert!(refusal(&mut world, "none.wav").contains("none.wav"));
    std::fs::write(folder.path().join("text.wav"), "no sound at all").unwrap();
    assert!(refusal(&mut world, "text.wav").contains("Ogg Vorbis"));
    let mut plain = bare(&WorldConfig::default());
    assert!(refusal(&mut plain, "bells/door.wav").contains("sound_root"));
}

#[test]
fn a_folder_of_sounds_that_is_none_is_refused_when_the_world_is_made() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("file"), "").unwrap();
    for name in ["nowhere", "file"] {
        let path = folder.path().join(name).to_str().unwrap().to_owned();
        let config = WorldConfig {
            sound_root: Some(path.clone()),
            ..WorldConfig::default()
        };
        let house = House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        let told = World::new(Engines::new(Arc::new(house)), &config).unwrap_err();
        let told = told.to_string();
        assert!(
            told.starts_with(&format!("sound_root is {path:?}: ")),
            "{told}"
        );
        assert!(told.contains("the folder below which sound files are"));
    }
}

#[test]
fn wrong_requests_are_answered_and_change_nothing() {
    let mut world = bare(&WorldConfig::default());
    let before = world.hash();
    let place = at(4.0, 1.5, 2.5);
    for (request, word) in [
        (request("gramophone", place, 60.0, true), "gramophone"),
        (request("noise", place, f32::NAN, true), "-100 to 200"),
        (
            request("noise", at(f32::NAN, 0.0, 0.0), 60.0, true),
            "coordinates",
        ),
        (
            request("noise", SoundPlace::Object(ObjectId(9)), 60.0, true),
            "no object 9",
        ),
        (
            request("noise", SoundPlace::Agent(AgentId(1)), 60.0, true),
            "no agent 1",
        ),
    ] {
        let message = world.play(request).unwrap_err().to_string();
        assert!(message.contains(word), "{message}");
    }
    assert!(
        world
            .set_sound_level(7, 60.0)
            .unwrap_err()
            .to_string()
            .contains("no sound 7")
    );
    assert_eq!(world.hash(), before);
}

/// Sounds of files and signals go on with the same bits in another world, and so do overrides of objects' sounds.
#[test]
fn a_restored_world_sounds_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bell.wav");
    std::fs::write(&file, wav(22_050, 700.0, 30_000)).unwrap();
    let config = WorldConfig {
        sound_root: Some(folder.path().to_str().unwrap().to_owned()),
        ..WorldConfig::default()
    };
    let mut world = bare(&config);
    let quiet = world.hash();
    let bell = world
        .play(request("bell.wav", at(4.5, 1.5, 2.0), 70.0, false))
        .unwrap();
    assert_ne!(world.hash(), quiet);
    let hum = world
        .play(request("hum", SoundPlace::Agent(AGENT), 50.0, true))
        .unwrap();
    hear(&mut world, 5);
    world.stop_sound(hum).unwrap();
    world.set_sound_level(bell, 64.0).unwrap();
    let saved = world.snapshot();
    let first = hear(&mut world, 12);
    assert!(rms(&first) > 1e-3);
    let hash = world.hash();
    world.restore(&saved).unwrap();
    assert_eq!(hear(&mut world, 12), first);
    // Engines of its own read the file again.
    let mut other = bare(&config);
    other.restore(&saved).unwrap();
    assert_eq!(hear(&mut other, 12), first);
    assert_eq!(other.hash(), hash);
    // A handle is never given twice.
    assert!(
        ![bell, hum].contains(
            &other
                .play(request("hum", at(1.0, 1.0, 1.0), 50.0, true))
                .unwrap()
        )
    );
    // Another sound under the old name is no silent change.
    std::fs::write(&file, wav(22_050, 800.0, 30_000)).unwrap();
    let message = bare(&config).restore(&saved).unwrap_err().to_string();
    assert!(message.contains("bell.wav"), "{message}");
    std::fs::remove_file(&file).unwrap();
    assert!(bare(&config).restore(&saved).is_err());
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn sounds_of_objects_are_silenced_and_move_with_what_they_sit_on() {
    let mut world = World::new(dwell_tests::apartment(), &WorldConfig::default()).unwrap();
    world.reset(RandomKey::root(1)).unwrap();
    let count = world.house().emitters.len();
    assert!(count > 0);
    let on = world.sounds().iter().position(|sound| sound.on);
    let on = on.expect("a fridge or a clock sounds in the apartment");
    let position = Vec3::from_array(world.sounds()[on].position);
    let house = world.house().clone();
    let room = house.rooms[house.room_at(position).unwrap()].bounds;
    let middle = Vec3::new(room.center().x, room.min.y, room.center().z);
    world.place_agent(AGENT, middle, 0.0).unwrap();
    world.enable_listeners(&[(AGENT, BLOCK)]).unwrap();
    for sound in world.sounds() {
        world.stop_sound(sound.handle).unwrap();
    }
    assert!(world.sounds().iter().all(|sound| !sound.on));
    hear(&mut world, 40);
    let silent = hear(&mut world, 2);
    assert!(silent.iter().flatten().all(|x| *x == 0.0));
    world.start_sound(on as u64).unwrap();
    world.set_sound_level(on as u64, 80.0).unwrap();
    assert!(rms(&hear(&mut world, 40)) > 1e-3);
    assert_eq!(world.sounds()[on].level_db, 80.0);
    // What is thrown takes its sound along.
    let thing = house.objects.iter_ids().find(|(_, object)| object.pickable);
    let (id, object) = thing.unwrap();
    let request = request("phone", SoundPlace::Object(id), 60.0, true);
    world.play(request).unwrap();
    let there = Vec3::new(position.x, 1.7, position.z);
    let body = BodyState {
        part: object.first_part,
        pose: Pose::from_position(there),
        velocity: Velocity::default(),
    };
    world.set_bodies(&[body]).unwrap();
    let before = Vec3::from_array(world.sounds()[count].position);
    assert!((before - there).length() < 1.0);
    hear(&mut world, 4);
    let after = Vec3::from_array(world.sounds()[count].position);
    let fallen = world.state().part_pose[object.first_part].position.y;
    assert!(fallen < there.y - 0.05 && after.y < before.y - 0.05);
}
