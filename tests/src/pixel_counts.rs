//! Pixel counts of batches, for any renderer.

use dwell::sensors::{Dtype, ObservationBuffer};
use dwell::{Batch, WorldError};
use dwell_render::BackEnd;

/// Both paths of the first graphics adapter, of software too; printed and empty where there is none.
///
/// # Panics
/// Never: what is written is read.
#[expect(clippy::print_stdout, reason = "a skip is printed")]
pub fn adapter_paths() -> Vec<BackEnd> {
    let Some(first) = dwell_render::adapters().into_iter().next() else {
        println!("skipped: no graphics adapter, not even of software");
        return Vec::new();
    };
    let by = |path: &str| {
        let text = format!("gpu+{path}:{}/{}", first.interface, first.name);
        text.parse().expect("an adapter has a name")
    };
    ["compute", "raster"].map(by).to_vec()
}

/// The observations of a batch, as the bytes of its numbers. Shape (sensor,) of (environment, number).
///
/// # Errors
/// As [`Batch::observe`].
pub fn try_observe(batch: &mut Batch, which: &[bool]) -> Result<Vec<Vec<u8>>, WorldError> {
    let specs = batch.sensor_specs();
    let count = batch.envs().len();
    let buffers = |dtype: Dtype| -> Vec<usize> {
        let lengths = specs.iter();
        lengths
            .map(|spec| {
                if spec.dtype == dtype {
                    spec.len() * count
                } else {
                    0
                }
            })
            .collect()
    };
    let mut bytes: Vec<Vec<u8>> = buffers(Dtype::Uint8).iter().map(|n| vec![0; *n]).collect();
    let mut floats: Vec<Vec<f32>> = buffers(Dtype::Float32)
        .iter()
        .map(|n| vec![0.0; *n])
        .collect();
    let mut ints: Vec<Vec<i32>> = buffers(Dtype::Int32).iter().map(|n| vec![0; *n]).collect();
    let mut texts = vec![String::new(); specs.len()];
    let numbers = bytes.iter_mut().zip(&mut floats).zip(&mut ints);
    let mut outs: Vec<ObservationBuffer<'_>> = specs
        .iter()
        .zip(numbers.zip(&mut texts))
        .map(|(spec, (((bytes, floats), ints), text))| match spec.dtype {
            Dtype::Uint8 => ObservationBuffer::Uint8(bytes),
            Dtype::Float32 => ObservationBuffer::Float32(floats),
            Dtype::Int32 => ObservationBuffer::Int32(ints),
            Dtype::Text => ObservationBuffer::Text(text),
        })
        .collect();
    batch.observe(which, &mut outs)?;
    let all = bytes.into_iter().zip(floats).zip(ints);
    Ok(all
        .map(|((bytes, floats), ints)| {
            let floats = floats.into_iter().flat_map(f32::to_le_bytes);
            let ints = ints.into_iter().flat_map(i32::to_le_bytes);
            bytes.into_iter().chain(floats).chain(ints).collect()
        })
        .collect())
}

/// As [`try_observe`], of all environments.
///
/// # Panics
/// When the batch cannot be observed.
pub fn observe(batch: &mut Batch) -> Vec<Vec<u8>> {
    let which = vec![true; batch.envs().len()];
    try_observe(batch, &which).expect("the batch can be observed")
}
