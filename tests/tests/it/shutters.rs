//! Shutters that are open or roll, in batches and alone, by every back end.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use dwell::sensors::{ImageObservationOptions, ObservationData};
use dwell::{
    Batch, CameraMount, DiscreteAction, Env, EnvConfig, ImageRequest, SensorConfig, WorldConfig,
};
use dwell_physics::BodyState;
use dwell_render::{BackEnd, Camera, Preset};
use dwell_scene::parallel::Threads;
use dwell_scene::{AgentId, LawSpec, Pose, Velocity};
use dwell_tests::law;
use dwell_tests::pixel_counts::{adapter_paths, observe};
use glam::Vec3;
use serde_json::json;

const WIDTH: usize = 24;
const HEIGHT: usize = 8;
const PIXELS: usize = WIDTH * HEIGHT;

fn rolls() -> LawSpec {
    law("rolling_shutter", &[("line_s", 2e-3)])
}

fn blurs() -> LawSpec {
    law("motion_blur", &[("exposure_s", 0.02)])
}

/// Flat and lit pictures, so that a world has two cameras.
const SENSORS: [(&str, &str); 6] = [
    ("rgb", "flat"),
    ("depth", "flat"),
    ("instance", "flat"),
    ("normals", "flat"),
    ("flow", "flat"),
    ("rgb", "lit"),
];

fn env(renderer: &BackEnd, laws: &[LawSpec]) -> Env {
    let sensor = |(kind, preset): &(&str, &str)| SensorConfig {
        kind: (*kind).to_owned(),
        settings: json!({
            "name": format!("{kind} {preset}"), "preset": preset, "width": WIDTH, "height": HEIGHT
        }),
    };
    let config = EnvConfig {
        sensors: Some(SENSORS.iter().map(sensor).collect()),
        world: WorldConfig {
            renderer: renderer.clone(),
            laws: laws.to_vec(),
            ..WorldConfig::default()
        },
        ..EnvConfig::default()
    };
    Env::new(dwell_tests::apartment(), &config).unwrap()
}

/// Worlds in which the agent has turned and something falls before its eyes.
fn batch(seeds: std::ops::Range<u64>, renderer: &BackEnd, laws: &[LawSpec]) -> Batch {
    let envs = seeds.clone().map(|_| env(renderer, laws)).collect();
    let mut batch = Batch::new(envs, Threads::new(2)).unwrap();
    let seeds: Vec<Option<u64>> = seeds.map(Some).collect();
    batch.reset(&seeds).unwrap();
    batch
        .step(&vec![Some(DiscreteAction::TurnLeft); seeds.len()])
        .unwrap();
    for k in 0..seeds.len() {
        let world = batch.env_mut(k).unwrap().world_mut();
        let eye = world.state().agents[AgentId(0)].world_from_eye();
        let house = world.house().clone();
        let thing = house.objects.iter().find(|object| object.pickable).unwrap();
        let body = BodyState {
            part: thing.first_part,
            pose: Pose::from_position(eye.transform_point(Vec3::new(0.0, 0.1, -0.6))),
            velocity: Velocity {
                linear: Vec3::new(1.5, 0.0, 0.0),
                ..Velocity::default()
            },
        };
        world.set_bodies(&[body]).unwrap();
    }
    batch
        .step(&vec![Some(DiscreteAction::TurnLeft); seeds.len()])
        .unwrap();
    for env in batch.envs() {
        assert!(
            !env.world().motion_history().previous_part_poses.is_empty(),
            "something falls"
        );
    }
    batch
}

/// The part of one environment, of all that a batch of some has seen.
fn part(seen: &[Vec<u8>], k: usize, count: usize) -> Vec<Vec<u8>> {
    let own = |all: &Vec<u8>| {
        let length = all.len() / count;
        all[k * length..(k + 1) * length].to_vec()
    };
    seen.iter().map(own).collect()
}

fn back_ends() -> Vec<BackEnd> {
    let mut all = vec![BackEnd::Cpu];
    all.extend(adapter_paths());
    all
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn shutters_in_a_batch_give_the_bits_of_worlds_alone() {
    for renderer in back_ends() {
        let still = observe(&mut batch(0..2, &renderer, &[]));
        let laws = [vec![rolls()], vec![blurs()], vec![rolls(), blurs()]];
        // Each alone is a part of both; software adapters are slow.
        let is_slow = renderer != BackEnd::Cpu && !dwell_tests::runs_all();
        let first = if is_slow { 2 } else { 0 };
        for laws in laws.into_iter().skip(first) {
            let seen = observe(&mut batch(0..2, &renderer, &laws));
            let rolling = laws.contains(&rolls());
            for (k, (preset, image)) in SENSORS.iter().zip(&seen).enumerate() {
                let changes = rolling || preset.0 == "rgb";
                assert_eq!(
                    changes,
                    *image != still[k],
                    "{preset:?}, {laws:?} by {renderer}"
                );
            }
            for k in 0..2 {
                let mut alone = batch(k..k + 1, &renderer, &laws);
                assert!(
                    observe(&mut alone) == part(&seen, k as usize, 2),
                    "world {k} of a batch, {laws:?} by {renderer}"
                );
                // And what a caller who asks for a picture gets.
                let world = alone.env(0).unwrap().world();
                let request = ImageRequest {
                    camera: Camera::from_fov(WIDTH as u32, HEIGHT as u32, 90.0)
                        .and_then(|camera| camera.with_range(0.05, 50.0))
                        .unwrap(),
                    mount: CameraMount::Agent(AgentId(0), Pose::IDENTITY),
                    preset: Preset::Lit,
                };
                let picture = world.image_observations(
                    &request,
                    &["rgb".to_owned()],
                    ImageObservationOptions::default(),
                    Threads::ONE,
                );
                let ObservationData::Uint8(rgb) = &picture.unwrap()[0].data else {
                    panic!("colours are bytes")
                };
                assert!(*rgb == part(&seen, k as usize, 2)[5]);
            }
        }
    }
}

/// More worlds than are exposed at once.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn many_worlds_with_open_shutters_are_those_of_few() {
    let laws = [blurs()];
    let all = observe(&mut batch(0..40, &BackEnd::Cpu, &laws));
    let last = observe(&mut batch(38..40, &BackEnd::Cpu, &laws));
    assert!(part(&all, 38, 40) == part(&last, 0, 2) && part(&all, 39, 40) == part(&last, 1, 2));
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn adapters_roll_and_blur_as_the_processor_does() {
    let laws = [rolls(), blurs()];
    let by_cpu = observe(&mut batch(0..4, &BackEnd::Cpu, &laws));
    for renderer in adapter_paths() {
        let by_gpu = observe(&mut batch(0..4, &renderer, &laws));
        for (k, (kind, preset)) in SENSORS
            .iter()
            .enumerate()
            .filter(|(_, (kind, _))| *kind == "rgb")
        {
            let off = by_cpu[k].iter().zip(&by_gpu[k]);
            let levels = off.map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>();
            let mean = levels / by_cpu[k].len() as f64;
            println!("{kind} {preset} by {renderer}: {mean:.4} levels off");
            assert!(mean < 0.2, "{kind} {preset} by {renderer}: {mean}");
        }
        let depth = |bytes: &[u8]| -> Vec<f32> {
            let words = bytes.as_chunks::<4>().0.iter();
            words.map(|word| f32::from_le_bytes(*word)).collect()
        };
        let (z, other) = (depth(&by_cpu[1]), depth(&by_gpu[1]));
        assert_eq!(z.len(), 4 * PIXELS);
        let off = z.iter().zip(&other).filter(|(a, b)| (*a - *b).abs() > 1e-3);
        let share = off.count() as f64 / z.len() as f64;
        println!("depth by {renderer}: {share:.4} off by more than 1 mm");
        assert!(share < 0.01, "{share}");
    }
}
