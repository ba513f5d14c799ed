//! Read-back rate of pictures: a bound on views a second for any renderer on the adapter.

use super::device::Gpu;
use crate::error::RenderError;
use std::sync::mpsc;
use std::time::Instant;

/// Bytes of the measurement, and how often it is repeated.
const BYTES: u64 = 64 << 20;
const ROUNDS: usize = 4;

impl Gpu {
    /// Measures the read-back rate from the adapter's memory into that of the caller, bytes a second: the best of four rounds over 64 MiB,
    /// or the largest possible buffer.
    ///
    /// # Errors
    /// [`RenderError::Driver`].
    pub fn read_back_bytes_per_s(&self) -> Result<f64, RenderError> {
        use wgpu::BufferUsages as Use;
        let bytes = BYTES.min(self.max_buffer_bytes());
        let images = self.buffer("a measurement", bytes, Use::STORAGE | Use::COPY_SRC)?;
        let back = self.buffer("a measurement", bytes, Use::MAP_READ | Use::COPY_DST)?;
        let mut into = vec![0_u8; bytes as usize];
        let mut best = f64::INFINITY;
        for _ in 0..ROUNDS {
            let start = Instant::now();
            let mut encoder = self
                .device
                .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            encoder.copy_buffer_to_buffer(&images, 0, &back, 0, bytes);
            let index = self.queue.submit([encoder.finish()]);
            let (sender, mapped) = mpsc::channel();
            back.map_async(wgpu::MapMode::Read, 0..bytes, move |result| {
                // Nobody waits any more when something else went wrong.
                let _ = sender.send(result);
            });
            self.wait(&index, &mapped)?;
            let held = back.get_mapped_range(0..bytes);
            let held = held.map_err(|error| self.driver_error("to read", error.to_string()))?;
            into.copy_from_slice(&held);
            drop(held);
            back.unmap();
            best = best.min(start.elapsed().as_secs_f64());
        }
        Ok(bytes as f64 / best)
    }

    /// Waits for a submission, and for memory that is to be read after it.
    pub(super) fn wait(
        &self,
        index: &wgpu::SubmissionIndex,
        mapped: &mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
    ) -> Result<(), RenderError> {
        let until = wgpu::PollType::Wait {
            submission_index: Some(index.clone()),
            timeout: None,
        };
        let polled = self.device.poll(until);
        polled.map_err(|error| self.driver_error("to render", error.to_string()))?;
        self.take_driver_error("to render")?;
        match mapped.recv() {
            Ok(Ok(())) => Ok(()),
            Ok(Err(error)) => Err(self.driver_error("to read", error.to_string())),
            Err(error) => Err(self.driver_error("to read", error.to_string())),
        }
    }
}
