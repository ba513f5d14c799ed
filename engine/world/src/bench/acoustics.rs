//! Impulse responses a second; streams against real time and against the reference.

use super::{BenchOptions, BenchProgress, median, open, sorted_run_times_s};
use crate::engines::Engines;
use crate::error::WorldError;
use crate::info::best_room_viewpoints;
use dwell_acoustics::metrics::{self, BandMetrics, Metrics};
use dwell_acoustics::{ActiveSource, Receiver, SoundSourcePose, Stream, StreamConfig, signals};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{Pose, State};
use glam::Vec3;
use serde_json::{Value, json};
use std::time::Instant;

pub(super) fn run(
    house: &str,
    options: &BenchOptions,
    progress: &mut BenchProgress<'_>,
) -> Result<Value, WorldError> {
    let engines = open(house)?;
    let rays = RayScene::new(engines.house().clone());
    let spots: Vec<Vec3> = best_room_viewpoints(&engines)?
        .iter()
        .map(|room| Vec3::new(room.stand[0], room.eye[1], room.stand[2]))
        .collect();
    let threads = Threads::try_resolve(options.threads)?;
    let rooms: Vec<WalkPaths> = spots
        .iter()
        .filter_map(|spot| WalkPaths::find_unobstructed(&rays, *spot))
        .take(ROOMS.min(options.walks))
        .collect();
    let walk_count = if rooms.is_empty() { 0 } else { options.walks };
    progress.set_part_count(options.presets.len() * (1 + walk_count) + rooms.len());
    let mut rates = serde_json::Map::new();
    for preset in &options.presets {
        progress.begin_part(&format!("impulse responses, {preset}"))?;
        let scene = engines.acoustic_scene(preset, 16_000)?;
        let mut pairs = 0;
        let seconds = sorted_run_times_s(options.repeats.min(3), || {
            pairs = 0;
            for (k, source) in spots.iter().enumerate() {
                let ear = spots[(k + 1) % spots.len()];
                let receiver = Receiver::binaural(Pose::from_position(ear));
                scene.impulse_response(
                    &rays,
                    &SoundSourcePose::omni(*source),
                    &receiver,
                    RandomKey::root(k as u64),
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
    let wanted: Vec<Metrics> = rooms
        .iter()
        .map(|figure| {
            progress.begin_part("the reference of a room")?;
            reference_metrics(&engines, &rays, *figure, threads)
        })
        .collect::<Result<_, _>>()?;
    for preset in &options.presets {
        // Walks in a room differ by their rays.
        let walks = rooms.iter().zip(&wanted).cycle();
        let walks: Vec<WalkBenchResult> = (0..options.walks)
            .zip(walks)
            .map(|(k, (figure, wanted))| {
                progress.begin_part(&format!("walk {} of {walk_count}, {preset}", k + 1))?;
                let seed = (k / rooms.len()) as u64;
                walk(&engines, &rays, preset, *figure, wanted, seed)
            })
            .collect::<Result<_, _>>()?;
        let middle = |of: fn(&WalkBenchResult) -> Option<f64>| {
            let mut values: Vec<f64> = walks.iter().filter_map(of).collect();
            values.sort_by(f64::total_cmp);
            // Nothing where no walk has a figure.
            (!values.is_empty()).then(|| median(&values))
        };
        let figures = [
            (
                "stream_times_real_time",
                middle(|walk| Some(walk.times_real_time)),
            ),
            (
                "stream_t30_off_percent",
                middle(|walk| walk.t30_off_percent),
            ),
            ("stream_c80_off_db", middle(|walk| walk.c80_off_db)),
        ];
        for (name, value) in figures {
            rates.insert(format!("{name}_{preset}"), json!(value));
        }
    }
    rates.insert("threads".to_owned(), json!(threads.count()));
    Ok(Value::Object(rates))
}

/// Largest number of rooms in which a stream is measured.
const ROOMS: usize = 4;
/// Samples of a block: 50 ms at 16 kHz.
const BLOCK: usize = 800;
/// Blocks of a walk: 10 s.
const BLOCKS: usize = 200;

/// A walk with a radio.
struct WalkBenchResult {
    times_real_time: f64,
    /// Mean deviation of its end's measures from the reference over the octaves from 250 Hz to 4 kHz; `None` where a band lacks one.
    t30_off_percent: Option<f64>,
    c80_off_db: Option<f64>,
}

/// The walks of a listener and a source in a room.
#[derive(Clone, Copy)]
struct WalkPaths {
    /// The middle of the listener's path, m.
    spot: Vec3,
    /// Directions of that path and to the right of it; unit length, level.
    ahead: Vec3,
    right: Vec3,
}

impl WalkPaths {
    /// Turns of a figure that are tried.
    const TURNS: usize = 12;
    /// Half of the length of the listener's path, m.
    const REACH_M: f32 = 0.6;
    /// Free distance that paths need beyond their ends, m.
    const ROOM_M: f32 = 0.15;

    /// The first rotation around `spot` for which both paths are free, and the line between the walkers.
    fn find_unobstructed(rays: &RayScene, spot: Vec3) -> Option<Self> {
        let mut turned = (0..Self::TURNS).map(|k| {
            let angle = std::f32::consts::TAU * k as f32 / Self::TURNS as f32;
            let (sin, cos) = dwell_scene::math::sin_cos(angle);
            let (ahead, right) = (Vec3::new(cos, 0.0, -sin), Vec3::new(sin, 0.0, cos));
            Self { spot, ahead, right }
        });
        turned.find(|figure| figure.is_free(rays))
    }

    fn is_free(&self, rays: &RayScene) -> bool {
        let clear = |a: Vec3, b: Vec3| {
            let beyond = Self::ROOM_M * (b - a).normalize_or_zero();
            let ways = [(a - beyond, b + beyond), (b + beyond, a - beyond)];
            let mut ways = ways.map(|(a, b)| Ray::segment(a, b, 0.0)).into_iter();
            ways.all(|way| !rays.occluded(&way, RayMask::EAR))
        };
        let ends = [-Self::REACH_M, Self::REACH_M].map(|off| self.source_and_listener_at(off));
        let between =
            [-Self::REACH_M, 0.0, Self::REACH_M].map(|off| self.source_and_listener_at(off));
        clear(ends[0].0, ends[1].0)
            && clear(ends[0].1, ends[1].1)
            && between.iter().all(|(radio, head)| clear(*radio, *head))
    }

    /// The radio and the head, when the listener is `off_m` from the middle.
    fn source_and_listener_at(&self, off_m: f32) -> (Vec3, Vec3) {
        let radio = (0.3 - 0.7 * off_m) * self.ahead + (0.8 + 0.5 * off_m) * self.right;
        (
            self.spot + radio - 0.4 * Vec3::Y,
            self.spot + off_m * self.ahead,
        )
    }

    /// Returns the poses at the end of block `k` of a listener that walks to and fro at 1 m/s and turns, and of a radio that moves as
    /// fast.
    fn poses_after_block(&self, k: usize) -> (Vec3, Pose) {
        let way_m = (0.05 * k as f32 + Self::REACH_M).rem_euclid(4.0 * Self::REACH_M);
        let off_m = Self::REACH_M - (way_m - 2.0 * Self::REACH_M).abs();
        let (radio, head) = self.source_and_listener_at(off_m);
        (radio, Pose::from_position_yaw(head, 0.031 * k as f32))
    }
}

/// Returns the reference's measures for the end of the walk.
fn reference_metrics(
    engines: &Engines,
    rays: &RayScene,
    figure: WalkPaths,
    threads: Threads,
) -> Result<Metrics, WorldError> {
    let (position, head) = figure.poses_after_block(BLOCKS - 1);
    let scene = engines.acoustic_scene("reference", 16_000)?;
    let source = SoundSourcePose::omni(position);
    let echogram = scene.echogram(rays, &source, head.position, RandomKey::root(1), threads)?;
    Ok(metrics::echogram_metrics(&echogram))
}

/// Walks on one thread.
fn walk(
    engines: &Engines,
    rays: &RayScene,
    preset: &str,
    figure: WalkPaths,
    wanted: &Metrics,
    seed: u64,
) -> Result<WalkBenchResult, WorldError> {
    let scene = engines.acoustic_scene(preset, 16_000)?;
    let config = StreamConfig::preset(preset).unwrap_or_default();
    let mut stream = Stream::new(scene, config, RandomKey::root(seed), Threads::ONE)?;
    let state = State::new(engines.house());
    let mut signal = vec![0.0; BLOCK];
    signals::synthesize("radio", 16_000, 0, &mut signal)?;
    let mut out = vec![0.0; 2 * BLOCK];
    let start = Instant::now();
    for k in 0..BLOCKS {
        let (position, head) = figure.poses_after_block(k);
        let source = ActiveSource {
            id: 0,
            position,
            signal: &signal,
        };
        stream.render_block(rays, &state, &[source], &Receiver::binaural(head), &mut out)?;
    }
    let seconds = start.elapsed().as_secs_f64();
    let mut heard = stream.echograms();
    let found = heard.next().map(|(_, e)| metrics::echogram_metrics(&e));
    let found = found.unwrap_or_default();
    let mean = |off: fn(&BandMetrics, &BandMetrics) -> Option<f64>| {
        let bands = found.iter().zip(wanted).skip(2).take(5);
        let off: Option<Vec<f64>> = bands.map(|(a, b)| off(a, b)).collect();
        off.map(|off| off.iter().sum::<f64>() / off.len() as f64)
    };
    Ok(WalkBenchResult {
        times_real_time: 0.05 * BLOCKS as f64 / seconds,
        t30_off_percent: mean(|a, b| Some(100.0 * (a.t30_s? / b.t30_s? - 1.0).abs())),
        c80_off_db: mean(|a, b| Some((a.c80_db? - b.c80_db?).abs())),
    })
}
