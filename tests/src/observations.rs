//! All that can be observed, as bits.

use dwell::Batch;
use dwell::sensors::{self, Dtype, ObservationBuffer};
use dwell::tasks::TaskKind;

/// The sensor that agents on legs do not have.
pub const OF_WHEELS: &str = "wheel_odometry";

/// The names of the sensors that go with every task and every body.
pub fn all_sensors() -> Vec<&'static str> {
    let kinds = sensors::all().iter();
    let kinds = kinds.filter(|kind| kind.goal_part.is_none() && kind.name != OF_WHEELS);
    kinds.map(|kind| kind.name).collect()
}

/// The names of the sensors that observe the goals of a task.
pub fn goal_sensors(task: &TaskKind) -> Vec<&'static str> {
    let kinds = sensors::all().iter();
    let kinds = kinds.filter(|kind| {
        kind.goal_part
            .is_some_and(|part| task.goal_parts.contains(&part))
    });
    kinds.map(|kind| kind.name).collect()
}

/// The observations of every sensor of a batch, as bits: all environments of the first sensor, of the second, and so on.
///
/// # Panics
/// When the batch cannot observe, or a sensor leaves its range.
pub fn observe(batch: &mut Batch) -> Vec<Vec<u8>> {
    let specs = batch.sensor_specs();
    let count = batch.envs().len();
    let mut bytes: Vec<Vec<u8>> = specs
        .iter()
        .map(|spec| vec![0; spec.len() * count])
        .collect();
    let mut floats: Vec<Vec<f32>> = specs
        .iter()
        .map(|spec| vec![f32::NAN; spec.len() * count])
        .collect();
    let mut ints: Vec<Vec<i32>> = specs
        .iter()
        .map(|spec| vec![-1; spec.len() * count])
        .collect();
    let mut texts = vec![String::new(); specs.len()];
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
    batch
        .observe(&vec![true; count], &mut outs)
        .expect("buffers of the specified lengths");
    specs
        .iter()
        .enumerate()
        .map(|(k, spec)| {
            let name = &spec.name;
            match spec.dtype {
                Dtype::Uint8 => bytes[k].clone(),
                Dtype::Float32 => {
                    let range = spec.low as f32..=spec.high as f32;
                    assert!(
                        floats[k].iter().all(|x| range.contains(x)),
                        "{name} leaves its range"
                    );
                    floats[k].iter().flat_map(|x| x.to_le_bytes()).collect()
                }
                Dtype::Int32 => {
                    let fits =
                        |x: &i32| f64::from(*x) >= spec.low && f64::from(*x) < spec.high.max(1.0);
                    assert!(ints[k].iter().all(fits), "{name} leaves its range");
                    ints[k].iter().flat_map(|x| x.to_le_bytes()).collect()
                }
                Dtype::Text => batch.text_observations(k).concat().into_bytes(),
            }
        })
        .collect()
}
