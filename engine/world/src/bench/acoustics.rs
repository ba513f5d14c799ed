//! Impulse responses a second.

use super::{BenchOptions, median, open, timed};
use crate::error::WorldError;
use crate::info::viewpoints;
use dwell_acoustics::{Receiver, Source};
use dwell_scene::Pose;
use dwell_scene::parallel::Threads;
use dwell_scene::random::Key;
use dwell_scene::rays::RayScene;
use glam::Vec3;
use serde_json::{Value, json};

pub(super) fn run(house: &str, options: &BenchOptions) -> Result<Value, WorldError> {
    let engines = open(house)?;
    let rays = RayScene::new(engines.house().clone());
    let spots: Vec<Vec3> = viewpoints(&engines)?
        .iter()
        .map(|room| Vec3::new(room.stand[0], room.eye[1], room.stand[2]))
        .collect();
    let threads = Threads::requested(options.threads)?;
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
