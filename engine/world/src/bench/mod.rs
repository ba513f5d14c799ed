//! Throughput of every stage, for `dwell bench`. Times are of this process and machine; compare ratios within one run.

mod acoustics;
mod env;
mod load;
mod physics;
mod progress;
mod render;
mod table;
mod unwinding;

pub use physics::{BenchBoxes, BoxBody};
pub use progress::BenchCallback;

use crate::engines::Engines;
use crate::error::WorldError;
use dwell_render::{BackEnd, Preset};
use dwell_scene::interrupt;
use progress::BenchProgress;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::sync::Arc;
use std::time::Instant;

/// A stage: its name, and what measures it.
type BenchStage = (
    &'static str,
    fn(&str, &BenchOptions, &mut BenchProgress<'_>) -> Result<Value, WorldError>,
);

/// All stages. A new one is one file and one line here.
const STAGES: [BenchStage; 5] = [
    ("load", load::run),
    ("render", render::run),
    ("physics", physics::run),
    ("acoustics", acoustics::run),
    ("env", env::run),
];

/// Options of `dwell bench`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BenchOptions {
    /// Views to render, in order; `None`: eight around from the middle of every room.
    pub views: Option<Vec<BenchView>>,
    /// Pixels across and down; default 128.
    pub resolution: u32,
    /// Views in a batch, each of a world of its own, 1 to 4,096: `render` answers a row for each of them and each of
    /// `resolutions`, by both paths of an adapter unless one is named. Default none: one figure over all views.
    pub batch: Vec<usize>,
    /// Sizes of pictures for `batch`; default `resolution`.
    pub resolutions: Vec<u32>,
    /// `"flat"` (default), `"lit"` or `"full"`.
    pub preset: Preset,
    /// The rendering back end: `"cpu"` (default), `"gpu"` or `"gpu:NAME"`.
    pub backend: BackEnd,
    /// Number of times that all views are rendered in one batch, as if for so many worlds; 1 to 4,096, default 1.
    pub batches: usize,
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
    /// Walks of 10 s in which `acoustics` measures streams, over up to four rooms in turns; default 16. What one says of a decay is
    /// chance by a third.
    pub walks: usize,
    /// Boxes that `physics` steps instead of the house's own objects; `None`: those.
    pub boxes: Option<BenchBoxes>,
    /// Worlds that `physics` steps together, to be compared with one; default 64.
    pub worlds: usize,
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
            batch: Vec::new(),
            resolutions: Vec::new(),
            preset: Preset::Flat,
            backend: BackEnd::Cpu,
            batches: 1,
            threads: None,
            repeats: 5,
            envs: 4,
            steps: 200,
            presets: vec!["rl".to_owned(), "full".to_owned()],
            walks: 16,
            boxes: None,
            worlds: 64,
        }
    }
}

impl BenchOptions {
    fn check(&self) -> Result<(), WorldError> {
        let batch = self.batch.iter().map(|batch| ("batch", *batch, 4096));
        for (field, value, high) in batch.chain([
            ("repeats", self.repeats, 1000),
            ("envs", self.envs, 4096),
            ("steps", self.steps, 1_000_000),
            ("worlds", self.worlds, 4096),
            ("walks", self.walks, 1000),
            ("batches", self.batches, 4096),
        ]) {
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

    /// The sizes of pictures for `batch`.
    fn resolutions(&self) -> Vec<u32> {
        if self.resolutions.is_empty() {
            vec![self.resolution]
        } else {
            self.resolutions.clone()
        }
    }
}

/// Seconds of each of `repeats` runs, sorted.
fn sorted_run_times_s(
    repeats: usize,
    mut run: impl FnMut() -> Result<(), WorldError>,
) -> Result<Vec<f64>, WorldError> {
    let mut seconds = Vec::with_capacity(repeats);
    for _ in 0..repeats {
        interrupt::unwind_if_cancelled();
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

/// Measures one stage over a house: `load`, `render`, `physics`, `acoustics` or `env`. `listener` receives the progress.
///
/// # Errors
/// [`WorldError`] for an unknown stage, a wrong option or a house that cannot be opened; [`WorldError::Cancelled`] where the listener does
/// not want to go on.
pub fn run(
    what: &str,
    house: &str,
    options: &BenchOptions,
    listener: BenchCallback<'_>,
) -> Result<Value, WorldError> {
    options.check()?;
    let stage = STAGES.iter().find(|(name, _)| *name == what);
    let Some((_, run)) = stage else {
        return Err(WorldError::Unknown {
            kind: "bench",
            name: what.to_owned(),
            known: STAGES.iter().map(|(name, _)| (*name).to_owned()).collect(),
        });
    };
    let mut progress = BenchProgress::new(listener);
    let figures = run(house, options, &mut progress)?;
    progress.end()?;
    Ok(figures)
}

fn open(house: &str) -> Result<Arc<Engines>, WorldError> {
    Ok(Engines::new(Arc::new(dwell_houses::open(house)?.0)))
}
