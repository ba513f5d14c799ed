//! Environments stepped together, with everything they sense.

use super::{BenchOptions, BenchProgress, open};
use crate::actions::DiscreteAction;
use crate::batch::Batch;
use crate::env::Env;
use crate::env_config::EnvConfig;
use crate::error::WorldError;
use crate::sensors::{Dtype, ObservationBuffer, SensorSpec};
use dwell_scene::parallel::Threads;
use serde_json::{Value, json};
use std::time::Instant;

pub(super) fn run(
    house: &str,
    options: &BenchOptions,
    progress: &mut BenchProgress<'_>,
) -> Result<Value, WorldError> {
    progress.begin_part("steps of environments")?;
    let engines = open(house)?;
    let config = EnvConfig::default();
    let envs = (0..options.envs)
        .map(|_| Env::new(engines.clone(), &config))
        .collect::<Result<Vec<_>, _>>()?;
    let mut batch = Batch::new(envs, Threads::try_resolve(options.threads)?)?;
    let seeds: Vec<Option<u64>> = (0..options.envs as u64).map(Some).collect();
    let start = Instant::now();
    batch.reset(&seeds)?;
    let reset_s = start.elapsed().as_secs_f64();
    let specs = batch.sensor_specs();
    let (n, which) = (options.envs, vec![true; options.envs]);
    let length = |spec: &SensorSpec, dtype| {
        if spec.dtype == dtype {
            n * spec.len()
        } else {
            0
        }
    };
    let mut bytes: Vec<Vec<u8>> = specs
        .iter()
        .map(|spec| vec![0; length(spec, Dtype::Uint8)])
        .collect();
    let mut floats: Vec<Vec<f32>> = specs
        .iter()
        .map(|spec| vec![0.0; length(spec, Dtype::Float32)])
        .collect();
    let mut ints: Vec<Vec<i32>> = specs
        .iter()
        .map(|spec| vec![0; length(spec, Dtype::Int32)])
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
        let mut outs: Vec<ObservationBuffer<'_>> = specs
            .iter()
            .zip(buffers)
            .map(|(spec, (((bytes, floats), ints), text))| match spec.dtype {
                Dtype::Uint8 => ObservationBuffer::Uint8(bytes),
                Dtype::Float32 => ObservationBuffer::Float32(floats),
                Dtype::Int32 => ObservationBuffer::Int32(ints),
                Dtype::Text => ObservationBuffer::Text(text),
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
