//! Memory for one batch under way; kept for later ones, and only grown.

use super::batch::PackedBatch;
use super::device::Gpu;
use super::raster::RenderAtlas;
use crate::error::RenderError;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A buffer that grows.
#[derive(Debug)]
struct GrowableBuffer {
    what: &'static str,
    usage: wgpu::BufferUsages,
    buffer: Option<wgpu::Buffer>,
}

impl GrowableBuffer {
    fn new(what: &'static str, usage: wgpu::BufferUsages) -> Self {
        Self {
            what,
            usage,
            buffer: None,
        }
    }

    /// Reserves space; returns whether the buffer is another one now.
    fn reserve(&mut self, gpu: &Gpu, bytes: u64) -> Result<bool, RenderError> {
        if self
            .buffer
            .as_ref()
            .is_some_and(|held| held.size() >= bytes)
        {
            return Ok(false);
        }
        // A little more than is needed: worlds gain agents and views.
        let roomy = bytes + bytes / 8;
        let what = format!("a batch of views: its {}", self.what);
        let made = gpu
            .buffer(&what, roomy, self.usage)
            .or_else(|_| gpu.buffer(&what, bytes, self.usage))?;
        self.buffer = Some(made);
        Ok(true)
    }

    fn held(&self, gpu: &Gpu) -> Result<&wgpu::Buffer, RenderError> {
        let missing = || gpu.driver_error("to find a buffer", format!("no {} yet", self.what));
        self.buffer.as_ref().ok_or_else(missing)
    }
}

/// Memory that the processor writes and the adapter copies from. It is written by one batch at a time.
#[derive(Debug)]
struct StagingBuffer {
    buffer: Option<wgpu::Buffer>,
    /// True if it can be written: not while an adapter may read it.
    is_mapped: Arc<AtomicBool>,
}

impl StagingBuffer {
    fn new() -> Self {
        Self {
            buffer: None,
            is_mapped: Arc::default(),
        }
    }

    /// Writes bytes, and has them copied before later commands of the encoder.
    fn send(
        &mut self,
        gpu: &Gpu,
        bytes: &[u8],
        to: &wgpu::Buffer,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), RenderError> {
        let length = bytes.len() as u64;
        let held = self.buffer.as_ref();
        let fits = held.is_some_and(|held| held.size() >= length);
        if !fits || !self.is_mapped.load(Ordering::Acquire) {
            let what = "a batch of views: its worlds";
            let roomy = gpu.upload_buffer(what, length + length / 8);
            self.buffer = Some(roomy.or_else(|_| gpu.upload_buffer(what, length))?);
        }
        let missing = || gpu.driver_error("to find a buffer", "no memory to write to".into());
        let buffer = self.buffer.as_ref().ok_or_else(missing)?;
        let view = buffer.get_mapped_range_mut(0..length);
        let mut view = view.map_err(|error| gpu.driver_error("to write", error.to_string()))?;
        view.copy_from_slice(bytes);
        drop(view);
        buffer.unmap();
        self.is_mapped = Arc::default();
        encoder.copy_buffer_to_buffer(buffer, 0, to, 0, length);
        Ok(())
    }

    /// Maps the memory again when the submitted batch is done.
    fn remap(&self) {
        if let Some(buffer) = &self.buffer {
            let is_mapped = self.is_mapped.clone();
            buffer.map_async(wgpu::MapMode::Write, .., move |result| {
                is_mapped.store(result.is_ok(), Ordering::Release);
            });
        }
    }
}

/// The buffers of one batch.
#[derive(Debug)]
pub(super) struct BatchBuffers {
    pub(super) batch: PackedBatch,
    upload: StagingBuffer,
    rows: GrowableBuffer,
    lenses: GrowableBuffer,
    seen: GrowableBuffer,
    images: GrowableBuffer,
    back: GrowableBuffer,
    group: Option<wgpu::BindGroup>,
    /// The rows alone, for drawing.
    pub(super) rows_group: Option<wgpu::BindGroup>,
    pub(super) atlas: Option<RenderAtlas>,
}

/// Bytes of a pixel's first hit.
pub(super) const HIT_BYTES: u64 = 16;

impl BatchBuffers {
    pub(super) fn new() -> Self {
        use wgpu::BufferUsages as Use;
        let written = Use::STORAGE | Use::COPY_DST;
        Self {
            batch: PackedBatch::default(),
            upload: StagingBuffer::new(),
            rows: GrowableBuffer::new("worlds", written),
            lenses: GrowableBuffer::new("lenses", written),
            seen: GrowableBuffer::new("first hits", Use::STORAGE),
            images: GrowableBuffer::new("images", Use::STORAGE | Use::COPY_SRC),
            back: GrowableBuffer::new("images", Use::MAP_READ | Use::COPY_DST),
            group: None,
            rows_group: None,
            atlas: None,
        }
    }

    /// Uploads the rows of the batch, and reserves space for its images.
    pub(super) fn upload(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), RenderError> {
        let rows: &[u8] = bytemuck::cast_slice(&self.batch.rows);
        let rays: &[u8] = bytemuck::cast_slice(&self.batch.lens_rays.rays);
        let [row_bytes, lens_bytes, seen_bytes, image_bytes] =
            self.batch.buffer_sizes().map(|bytes| bytes.max(16));
        let mut changed = self.rows.reserve(gpu, row_bytes)?;
        let new_lenses = self.lenses.reserve(gpu, lens_bytes)?;
        changed |= new_lenses;
        changed |= self.seen.reserve(gpu, seen_bytes)?;
        changed |= self.images.reserve(gpu, image_bytes)?;
        self.back.reserve(gpu, image_bytes)?;
        self.upload.send(gpu, rows, self.rows.held(gpu)?, encoder)?;
        if (self.batch.lens_rays.changed || new_lenses) && !rays.is_empty() {
            gpu.queue.write_buffer(self.lenses.held(gpu)?, 0, rays);
            self.batch.lens_rays.changed = false;
        }
        if changed || self.group.is_none() {
            let buffers = [
                self.rows.held(gpu)?,
                self.lenses.held(gpu)?,
                self.seen.held(gpu)?,
                self.images.held(gpu)?,
            ];
            let entries = [0, 1, 2, 3].map(|k: usize| wgpu::BindGroupEntry {
                binding: k as u32,
                resource: buffers[k].as_entire_binding(),
            });
            let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("batch"),
                layout: &gpu.layouts.batch,
                entries: &entries,
            });
            self.group = Some(group);
            self.rows_group = Some(gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("rows"),
                layout: &gpu.layouts.rows,
                entries: &[wgpu::BindGroupEntry {
                    binding: 0,
                    resource: self.rows.held(gpu)?.as_entire_binding(),
                }],
            }));
        }
        if !self.batch.draw_batch.atlas_tiles.is_empty() {
            let atlas = RenderAtlas::reserve(self.atlas.take(), gpu, self.batch.draw_batch.size)?;
            self.atlas = Some(atlas);
        }
        Ok(())
    }

    /// To be called when the batch has been submitted.
    pub(super) fn remap_upload_memory(&self) {
        self.upload.remap();
    }

    pub(super) fn group(&self) -> Option<&wgpu::BindGroup> {
        self.group.as_ref()
    }

    /// Returns the buffers of images: that which kernels write, and that into which it is read back.
    pub(super) fn image_buffers(
        &self,
        gpu: &Gpu,
    ) -> Result<(&wgpu::Buffer, &wgpu::Buffer), RenderError> {
        Ok((self.images.held(gpu)?, self.back.held(gpu)?))
    }

    /// Bytes of all images.
    pub(super) fn image_bytes(&self) -> u64 {
        self.batch.words as u64 * 4
    }
}
