//! Opening a house with its ray tree, and starting a world over again.

use super::{BenchOptions, BenchProgress, median, open, sorted_run_times_s};
use crate::config::WorldConfig;
use crate::error::WorldError;
use crate::world::World;
use dwell_scene::random::RandomKey;
use serde_json::{Value, json};

pub(super) fn run(
    house: &str,
    options: &BenchOptions,
    progress: &mut BenchProgress<'_>,
) -> Result<Value, WorldError> {
    progress.set_part_count(2);
    progress.begin_part("opening the house")?;
    let mut triangles = 0;
    let seconds = sorted_run_times_s(options.repeats, || {
        let (house, _) = dwell_houses::open(house)?;
        house.geometry();
        triangles = house.triangle_count();
        Ok(())
    })?;
    progress.begin_part("starting over")?;
    let engines = open(house)?;
    let mut world = World::new(engines, &WorldConfig::default())?;
    let reset = sorted_run_times_s(options.repeats, || world.reset(RandomKey::root(0)))?;
    Ok(
        json!({"load_ms": median(&seconds) * 1e3, "reset_ms": median(&reset) * 1e3, "triangles": triangles}),
    )
}
