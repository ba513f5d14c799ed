//! Environments in which nothing is asked, and what single sensors of them observe.

use dwell::sensors::{Dtype, ObservationBuffer};
use dwell::{Batch, Engines, Env, EnvConfig, SensorConfig, World, WorldConfig};
use dwell_scene::parallel::Threads;
use dwell_scene::{AgentId, House, ShoeboxMaterials};
use glam::Vec3;
use serde_json::Value;
use std::sync::Arc;

/// The shared engines of a bare room.
///
/// # Panics
/// For a size that no room has.
pub fn bare_room(size_m: [f32; 3]) -> Arc<Engines> {
    let house = House::shoebox(size_m, &ShoeboxMaterials::default()).expect("a room of that size");
    Engines::new(Arc::new(house))
}

/// An environment with these sensors, whose episode has begun, as a batch of one. Things are taken as they stand at the start.
///
/// # Panics
/// When a sensor does not exist.
pub fn sensing(engines: &Arc<Engines>, world: WorldConfig, sensors: &[(&str, Value)]) -> Batch {
    let sensors = sensors.iter().map(|(kind, settings)| SensorConfig {
        kind: (*kind).to_owned(),
        settings: settings.clone(),
    });
    let config = EnvConfig {
        task: "Free".to_owned(),
        sensors: Some(sensors.collect()),
        world: WorldConfig {
            settle_s: Some(0.0),
            ..world
        },
        ..EnvConfig::default()
    };
    let env = Env::new(engines.clone(), &config).expect("the sensors exist");
    let mut batch = Batch::new(vec![env], Threads::ONE).expect("one environment");
    batch.reset(&[Some(1)]).expect("an episode begins");
    batch
}

/// The world of the environment, for changes.
///
/// # Panics
/// When the batch has no environment.
pub fn world(batch: &mut Batch) -> &mut World {
    batch.env_mut(0).expect("one environment").world_mut()
}

/// Places an agent, at rest.
///
/// # Panics
/// When there is no such agent.
pub fn place(batch: &mut Batch, agent: u32, position: Vec3, yaw_rad: f32) {
    world(batch)
        .place_agent(AgentId(agent), position, yaw_rad)
        .expect("the agent exists");
}

/// What a sensor of numbers observes, and its shape; bytes as numbers.
///
/// # Panics
/// When there is no such sensor, or it observes text.
pub fn observed(batch: &mut Batch, name: &str) -> (Vec<f32>, Vec<usize>) {
    let specs = batch.sensor_specs();
    let place = specs.iter().position(|spec| spec.name == name);
    let place = place.expect("a sensor of that name");
    let mut floats: Vec<Vec<f32>> = Vec::new();
    let mut bytes: Vec<Vec<u8>> = Vec::new();
    for spec in &specs {
        floats.push(vec![0.0; spec.len()]);
        bytes.push(vec![0; spec.len()]);
    }
    let buffers = floats.iter_mut().zip(&mut bytes);
    let mut outs: Vec<ObservationBuffer<'_>> = specs
        .iter()
        .zip(buffers)
        .map(|(spec, (floats, bytes))| match spec.dtype {
            Dtype::Uint8 => ObservationBuffer::Uint8(bytes),
            Dtype::Float32 => ObservationBuffer::Float32(floats),
            Dtype::Int32 | Dtype::Text => panic!("{} is of another type", spec.name),
        })
        .collect();
    batch
        .observe(&[true], &mut outs)
        .expect("buffers of the specified lengths");
    let values = match specs[place].dtype {
        Dtype::Uint8 => bytes[place].iter().map(|value| f32::from(*value)).collect(),
        _ => floats[place].clone(),
    };
    (values, specs[place].shape.clone())
}
