//! Throughput of every stage, for `dwell bench`. Times are of this process and machine; compare ratios within one run.

use crate::action::DiscreteAction;
use crate::batch::Batch;
use crate::config::WorldConfig;
use crate::engines::Engines;
use crate::env::{Env, EnvConfig};
use crate::error::WorldError;
use crate::info::viewpoints;
use crate::sensors::{Dtype, Out};
use crate::world::World;
use dwell_acoustics::{Receiver, Source};
use dwell_render::{Camera, Frame, Job, Preset, View};
use dwell_scene::parallel::Threads;
use dwell_scene::random::Key;
use dwell_scene::rays::RayScene;
use dwell_scene::space::{rotation_from_forward, rotation_from_yaw_pitch};
use dwell_scene::{Pose, State};
use glam::Vec3;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::sync::Arc;
use std::time::Instant;

/// What `dwell bench` can be told.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BenchOptions {
    /// Views to render, in order; `None`: eight around from the middle of every room.
    pub views: Option<Vec<BenchView>>,
    /// Pixels across and down; default 128.
    pub resolution: u32,
    /// `"flat"` (default) or `"lit"`.
    pub preset: Preset,
    /// Threads; `None`: what the machine allows.
    pub threads: Option<usize>,
    /// Repetitions of which the median counts; 1 to 1,000, default 5.
    pub repeats: usize,
    /// Environments stepped together by `env`; default 4.
    pub envs: usize,
    /// Steps of a run of `physics` and `env`; default 200.
    pub steps: usize,
    /// Presets of `acoustics`; default both, `rl` and `full`.
    pub presets: Vec<String>,
}

/// A view of a views file.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BenchView {
    /// m.
    pub position: [f32; 3],
    /// Any length.
    pub forward: [f32; 3],
}

impl Default for BenchOptions {
    fn default() -> Self {
        Self {
            views: None,
            resolution: 128,
            preset: Preset::Flat,
            threads: None,
            repeats: 5,
            envs: 4,
            steps: 200,
            presets: vec!["rl".to_owned(), "full".to_owned()],
        }
    }
}

impl BenchOptions {
    fn check(&self) -> Result<(), WorldError> {
        for (field, value, high) in [
            ("repeats", self.repeats, 1000),
            ("envs", self.envs, 4096),
            ("steps", self.steps, 1_000_000),
        ] {
            if !(1..=high).contains(&value) {
                return Err(WorldError::Config {
                    field,
                    found: value.to_string(),
                    allowed: format!("1 to {high}"),
                });
            }
        }
        Ok(())
    }
}

/// Seconds of each of `repeats` runs, sorted.
fn timed(
    repeats: usize,
    mut run: impl FnMut() -> Result<(), WorldError>,
) -> Result<Vec<f64>, WorldError> {
    let mut seconds = Vec::with_capacity(repeats);
    for _ in 0..repeats {
        let start = Instant::now();
        run()?;
        seconds.push(start.elapsed().as_secs_f64());
    }
    seconds.sort_by(f64::total_cmp);
    Ok(seconds)
}

fn median(sorted: &[f64]) -> f64 {
    sorted[sorted.len() / 2]
}

/// Measures one stage over a house: `load`, `render`, `physics`, `acoustics` or `env`.
///
/// # Errors
/// [`WorldError`] for an unknown stage, a wrong option or a house that cannot be opened.
pub fn run(what: &str, house: &str, options: &BenchOptions) -> Result<Value, WorldError> {
    options.check()?;
    match what {
        "load" => load(house, options),
        "render" => render(house, options),
        "physics" => physics(house, options),
        "acoustics" => acoustics(house, options),
        "env" => env(house, options),
        _ => {
            let known = ["load", "render", "physics", "acoustics", "env"]
                .map(str::to_owned)
                .to_vec();
            Err(WorldError::Unknown {
                kind: "bench",
                name: what.to_owned(),
                known,
            })
        }
    }
}

fn open(house: &str) -> Result<Arc<Engines>, WorldError> {
    Ok(Engines::new(Arc::new(dwell_houses::open(house)?.0)))
}

fn load(house: &str, options: &BenchOptions) -> Result<Value, WorldError> {
    let mut triangles = 0;
    let seconds = timed(options.repeats, || {
        let (house, _) = dwell_houses::open(house)?;
        house.geometry();
        triangles = house.triangle_count();
        Ok(())
    })?;
    let engines = open(house)?;
    let mut world = World::new(engines, &WorldConfig::default())?;
    let reset = timed(options.repeats, || world.reset(Key::root(0)))?;
    Ok(
        json!({"load_ms": median(&seconds) * 1e3, "reset_ms": median(&reset) * 1e3, "triangles": triangles}),
    )
}

fn views(engines: &Engines, options: &BenchOptions) -> Result<Vec<Pose>, WorldError> {
    if let Some(views) = &options.views {
        return views
            .iter()
            .map(|view| {
                let rotation = rotation_from_forward(Vec3::from_array(view.forward));
                rotation
                    .map(|rotation| Pose::new(Vec3::from_array(view.position), rotation))
                    .ok_or_else(|| {
                        let allowed = "a direction that is not zero".to_owned();
                        WorldError::Config {
                            field: "forward",
                            found: format!("{:?}", view.forward),
                            allowed,
                        }
                    })
            })
            .collect();
    }
    let mut around = Vec::new();
    for room in viewpoints(engines)? {
        for k in 0..8_u8 {
            let eye = Vec3::new(room.stand[0], room.eye[1], room.stand[2]);
            around.push(Pose::new(
                eye,
                rotation_from_yaw_pitch(f32::from(k) * std::f32::consts::FRAC_PI_4, -0.1),
            ));
        }
    }
    Ok(around)
}

fn render(house: &str, options: &BenchOptions) -> Result<Value, WorldError> {
    let engines = open(house)?;
    let (state, scene) = (
        State::new(engines.house()),
        RayScene::new(engines.house().clone()),
    );
    let threads = Threads::resolve(options.threads);
    let camera =
        Camera::from_fov(options.resolution, options.resolution, 90.0)?.with_range(0.05, 50.0)?;
    let poses = views(&engines, options)?;
    let mut frames: Vec<Frame> = poses
        .iter()
        .map(|_| Frame::new(&camera, dwell_render::Channels::default()))
        .collect();
    let renderer = engines.renderer();
    let seconds = timed(options.repeats + 1, || {
        let mut jobs: Vec<Job<'_>> = poses
            .iter()
            .zip(&mut frames)
            .map(|(pose, frame)| Job {
                scene: &scene,
                state: &state,
                view: View {
                    preset: options.preset,
                    ..View::new(camera, *pose)
                },
                frame: frame.as_mut(),
            })
            .collect();
        renderer.render_batch(&mut jobs, threads)?;
        Ok(())
    })?;
    Ok(json!({
        "views_per_s": poses.len() as f64 / median(&seconds),
        "views": poses.len(),
        "resolution": options.resolution,
        "preset": options.preset,
        "threads": threads.count(),
        "triangles": engines.house().triangle_count(),
    }))
}

fn physics(house: &str, options: &BenchOptions) -> Result<Value, WorldError> {
    let engines = open(house)?;
    let mut world = World::new(
        engines,
        &WorldConfig {
            agents: Vec::new(),
            ..WorldConfig::default()
        },
    )?;
    let substeps = world.config().physics_rate_hz / world.config().control_rate_hz;
    let mut rates = Vec::new();
    for _ in 0..options.repeats {
        world.reset(Key::root(0))?;
        let start = Instant::now();
        for _ in 0..options.steps {
            world.step(&[])?;
        }
        rates.push(options.steps as f64 * substeps / start.elapsed().as_secs_f64());
    }
    rates.sort_by(f64::total_cmp);
    let movable = movable_count(&world);
    Ok(
        json!({"physics_steps_per_s": median(&rates), "control_steps": options.steps, "movable_objects": movable}),
    )
}

fn movable_count(world: &World) -> usize {
    world
        .house()
        .objects
        .iter()
        .filter(|object| object.mobility == dwell_scene::Mobility::Movable)
        .count()
}

fn acoustics(house: &str, options: &BenchOptions) -> Result<Value, WorldError> {
    let engines = open(house)?;
    let rays = RayScene::new(engines.house().clone());
    let spots: Vec<Vec3> = viewpoints(&engines)?
        .iter()
        .map(|room| Vec3::new(room.stand[0], room.eye[1], room.stand[2]))
        .collect();
    let threads = Threads::resolve(options.threads);
    let mut rates = serde_json::Map::new();
    for preset in &options.presets {
        let scene = engines.acoustics(preset, 16_000)?;
        let mut pairs = 0;
        let seconds = timed(options.repeats.min(3), || {
            pairs = 0;
            for (k, source) in spots.iter().enumerate() {
                let ear = spots[(k + 1) % spots.len()];
                let receiver = Receiver::binaural(Pose::from_position(ear));
                scene.impulse_response(
                    &rays,
                    &Source::at(*source),
                    &receiver,
                    Key::root(k as u64),
                    threads,
                )?;
                pairs += 1;
            }
            Ok(())
        })?;
        rates.insert(
            format!("impulse_responses_per_s_{preset}"),
            json!(f64::from(pairs) / median(&seconds)),
        );
    }
    rates.insert("threads".to_owned(), json!(threads.count()));
    Ok(Value::Object(rates))
}

fn env(house: &str, options: &BenchOptions) -> Result<Value, WorldError> {
    let engines = open(house)?;
    let config = EnvConfig::default();
    let envs = (0..options.envs)
        .map(|_| Env::new(engines.clone(), &config))
        .collect::<Result<Vec<_>, _>>()?;
    let mut batch = Batch::new(envs, Threads::resolve(options.threads))?;
    let seeds: Vec<Option<u64>> = (0..options.envs as u64).map(Some).collect();
    let start = Instant::now();
    batch.reset(&seeds)?;
    let reset_s = start.elapsed().as_secs_f64();
    let specs = batch.specs();
    let (n, which) = (options.envs, vec![true; options.envs]);
    let mut bytes: Vec<Vec<u8>> = specs
        .iter()
        .map(|s| {
            vec![
                0;
                if s.dtype == Dtype::Uint8 {
                    n * s.len()
                } else {
                    0
                }
            ]
        })
        .collect();
    let mut floats: Vec<Vec<f32>> = specs
        .iter()
        .map(|s| {
            vec![
                0.0;
                if s.dtype == Dtype::Float32 {
                    n * s.len()
                } else {
                    0
                }
            ]
        })
        .collect();
    let mut ints: Vec<Vec<i32>> = specs
        .iter()
        .map(|s| {
            vec![
                0;
                if s.dtype == Dtype::Int32 {
                    n * s.len()
                } else {
                    0
                }
            ]
        })
        .collect();
    let mut texts = vec![String::new(); specs.len()];
    let walk = [
        DiscreteAction::MoveForward,
        DiscreteAction::TurnLeft,
        DiscreteAction::MoveForward,
        DiscreteAction::TurnRight,
    ];
    let start = Instant::now();
    for step in 0..options.steps {
        let actions: Vec<_> = (0..n)
            .map(|k| Some(walk[(step / 3 + k) % walk.len()]))
            .collect();
        batch.step(&actions)?;
        let buffers = bytes
            .iter_mut()
            .zip(&mut floats)
            .zip(&mut ints)
            .zip(&mut texts);
        let mut outs: Vec<Out<'_>> = specs
            .iter()
            .zip(buffers)
            .map(|(spec, (((bytes, floats), ints), text))| match spec.dtype {
                Dtype::Uint8 => Out::Uint8(bytes),
                Dtype::Float32 => Out::Float32(floats),
                Dtype::Int32 => Out::Int32(ints),
                Dtype::Text => Out::Text(text),
            })
            .collect();
        batch.observe(&which, &mut outs)?;
    }
    let seconds = start.elapsed().as_secs_f64();
    let sensors: Vec<_> = specs.iter().map(|spec| &spec.name).collect();
    Ok(json!({
        "env_steps_per_s": (options.steps * n) as f64 / seconds,
        "envs": n,
        "sensors": sensors,
        "first_reset_ms": reset_s * 1e3,
    }))
}
