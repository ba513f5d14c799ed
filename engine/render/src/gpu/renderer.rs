//! Batches of views by an adapter.

use super::batch::{ImageOffsets, words_per_pixel, workgroup_count};
use super::batch_buffers::{BatchBuffers, HIT_BYTES};
use super::device::{Gpu, buffer_size, lock_ignoring_poison};
use super::house_buffers::HouseBuffers;
use super::visibility_path::VisibilityPath;
use crate::cpu::{CpuRenderer, RenderJob};
use crate::error::RenderError;
use crate::frame::{FrameMut, Preset};
use dwell_scene::interrupt;
use dwell_scene::parallel::Threads;
use std::sync::{Arc, Mutex, mpsc};

/// Renders views of one house, in any of its worlds, by a graphics adapter.
///
/// Pictures agree with those of [`CpuRenderer`] within a bound: where a pixel and its eight neighbours show one thing
/// without a jump of depth, ids are equal and depths differ by less than a millimetre.
#[derive(Debug)]
pub struct GpuRenderer {
    gpu: Arc<Gpu>,
    cpu: Arc<CpuRenderer>,
    house: HouseBuffers,
    path: VisibilityPath,
    /// Memory of earlier batches.
    slots: Mutex<Vec<BatchBuffers>>,
    /// Shared with the batches that it submitted.
    own: Arc<()>,
}

/// Batches under way; see [`GpuRenderer::submit`].
#[derive(Debug)]
pub struct PendingBatch {
    parts: Vec<SubmittedPart>,
    /// The renderer that submitted it.
    owner: Arc<()>,
}

impl PendingBatch {
    /// Number of draw calls of the raster path: one for each view that shows something.
    pub fn draw_calls(&self) -> usize {
        let parts = self.parts.iter();
        parts
            .map(|part| part.slot.batch.draw_batch.draw_call_count())
            .sum()
    }

    /// Number of submissions into which the batch was cut.
    pub fn submission_count(&self) -> usize {
        self.parts.len()
    }
}

/// Views that were submitted together.
#[derive(Debug)]
struct SubmittedPart {
    slot: BatchBuffers,
    index: wgpu::SubmissionIndex,
    mapped: mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
}

/// One view's images in the read-back memory, and their destination.
struct ReadBack<'a, 'b> {
    places: ImageOffsets,
    frame: &'a mut FrameMut<'b>,
}

impl GpuRenderer {
    /// Uploads the tables that `cpu` has prepared for its house to an adapter, which takes the given path.
    ///
    /// # Errors
    /// [`RenderError::TooLarge`] when the house does not fit, [`RenderError::Driver`].
    pub fn new(
        gpu: Arc<Gpu>,
        cpu: Arc<CpuRenderer>,
        path: VisibilityPath,
    ) -> Result<Self, RenderError> {
        let house = HouseBuffers::new(&gpu, &cpu)?;
        Ok(Self {
            gpu,
            cpu,
            house,
            path,
            slots: Mutex::new(Vec::new()),
            own: Arc::default(),
        })
    }

    /// The adapter.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Returns the method by which it finds what pixels see first.
    pub fn visibility_path(&self) -> VisibilityPath {
        self.path
    }

    /// Draws everything, seen or not; pictures are the same. For comparisons.
    #[must_use]
    pub fn without_culling(mut self) -> Self {
        self.house.drawable.is_culling = false;
        self
    }

    /// Memory that the house takes on the adapter, bytes.
    pub fn house_bytes(&self) -> u64 {
        self.house.bytes
    }

    /// Renders views of any worlds over the house. Those with a preset that only `cpu` has are rendered by it.
    ///
    /// # Errors
    /// As [`CpuRenderer::render_batch`]; [`RenderError::TooLarge`] and [`RenderError::Driver`]. Then some images may be
    /// written.
    pub fn render_batch(
        &self,
        jobs: &mut [RenderJob<'_>],
        threads: Threads,
    ) -> Result<(), RenderError> {
        if jobs.iter().all(|job| has_gpu_preset(job)) {
            let submitted = self.submit(jobs, threads)?;
            let frames = jobs.iter_mut().map(|job| &mut job.frame);
            // Work that an adapter has begun is waited for.
            return interrupt::uninterruptible(|| self.wait_and_copy(submitted, frames, threads));
        }
        for (k, job) in jobs.iter().enumerate() {
            self.cpu.check(k, job)?;
        }
        for run in jobs.chunk_by_mut(|a, b| has_gpu_preset(a) == has_gpu_preset(b)) {
            if has_gpu_preset(&run[0]) {
                self.render_batch(run, threads)?;
            } else {
                self.cpu.render_batch(run, threads)?;
            }
        }
        Ok(())
    }

    /// Starts a batch and does not wait: the worlds may go on meanwhile. Which images are wanted is read from the frames of
    /// the jobs; they are written by [`Self::collect`].
    ///
    /// # Errors
    /// As [`Self::render_batch`]; and [`RenderError::OnlyCpu`] for a preset that only `cpu` has.
    pub fn submit(
        &self,
        jobs: &[RenderJob<'_>],
        threads: Threads,
    ) -> Result<PendingBatch, RenderError> {
        self.gpu.check_not_forked()?;
        for (k, job) in jobs.iter().enumerate() {
            self.cpu.check(k, job)?;
            if !has_gpu_preset(job) {
                return Err(RenderError::OnlyCpu { view: k });
            }
        }
        let mut parts = Vec::new();
        let (mut rest, mut most) = (jobs, usize::MAX);
        while !rest.is_empty() {
            let some = self.fitting_job_count(rest).min(most);
            interrupt::unwind_if_cancelled();
            let part = interrupt::uninterruptible(|| self.submit_part(&rest[..some], threads))?;
            let taken = part.slot.batch.image_offsets.len();
            // What follows is as large as a rule.
            most = if taken < some { taken } else { most };
            parts.push(part);
            rest = &rest[taken..];
        }
        Ok(PendingBatch {
            parts,
            owner: self.own.clone(),
        })
    }

    /// Waits for a batch and writes its images. `frames`: as those of the jobs, in their order.
    ///
    /// # Errors
    /// [`RenderError::Count`], [`RenderError::Length`] or [`RenderError::OtherImages`] for other frames than were announced,
    /// [`RenderError::OtherRenderer`] for a batch that another renderer was given: then nothing is written.
    /// [`RenderError::Driver`].
    pub fn collect(
        &self,
        submitted: PendingBatch,
        frames: &mut [FrameMut<'_>],
        threads: Threads,
    ) -> Result<(), RenderError> {
        interrupt::uninterruptible(|| self.wait_and_copy(submitted, frames.iter_mut(), threads))
    }

    /// Returns the number of the first jobs whose images fit into one submission; at least one.
    fn fitting_job_count(&self, jobs: &[RenderJob<'_>]) -> usize {
        let (most, most_groups) = (self.gpu.max_buffer_bytes(), self.gpu.max_workgroups());
        let (mut seen, mut words, mut groups) = (0, 0, 0);
        let fits = |job: &&RenderJob<'_>| {
            let (first, end) = job.row_range();
            let pixels = ((end - first) * job.view.camera.width() as usize) as u64;
            seen += pixels * HIT_BYTES;
            words += pixels * words_per_pixel(&job.frame) as u64 * 4;
            groups += workgroup_count(job.view.camera.width(), (end - first) as u32);
            seen.max(words) <= most && groups.div_ceil(most_groups) <= most_groups
        };
        jobs.iter().take_while(fits).count().max(1)
    }

    /// Writes the rows of as many of the first jobs as fit into the buffers; at least of one.
    fn fill(&self, slot: &mut BatchBuffers, jobs: &[RenderJob<'_>], threads: Threads) {
        let most = self.gpu.max_buffer_bytes();
        let draws = (self.path == VisibilityPath::Raster)
            .then(|| (&self.house.drawable, self.gpu.max_texture_edge()));
        let (mut count, mut is_fresh) = (jobs.len(), false);
        loop {
            let batch = &mut slot.batch;
            batch.fill(&self.cpu, &jobs[..count], draws, threads);
            let fits = batch
                .buffer_sizes()
                .iter()
                .all(|bytes| buffer_size(*bytes) <= most);
            if fits || (count == 1 && is_fresh) {
                break;
            }
            // First without the lenses of earlier batches, then with half the views.
            count = if is_fresh { count.div_ceil(2) } else { count };
            batch.lens_rays.invalidate();
            is_fresh = true;
        }
    }

    fn submit_part(
        &self,
        jobs: &[RenderJob<'_>],
        threads: Threads,
    ) -> Result<SubmittedPart, RenderError> {
        let gpu = &*self.gpu;
        let mut slot = lock_ignoring_poison(&self.slots)
            .pop()
            .unwrap_or_else(BatchBuffers::new);
        self.fill(&mut slot, jobs, threads);
        let mut encoder = gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        slot.upload(gpu, &mut encoder)?;
        // Of the tree over n instances, halved again and again, three links wait at each of at most log2 n nodes.
        let levels = usize::BITS - slot.batch.instances.saturating_sub(1).leading_zeros();
        let moving = 3 * levels as usize + self.house.mesh_stack;
        let kernels = gpu.kernels(self.house.stack.max(moving) + 1)?;
        let is_drawn = !slot.batch.draw_batch.atlas_tiles.is_empty();
        let atlas = slot.atlas.as_ref().filter(|_| is_drawn);
        if let (Some(atlas), Some(rows)) = (atlas, &slot.rows_group) {
            let mut pass = atlas.pass(&mut encoder);
            pass.set_pipeline(gpu.raster_pipeline());
            pass.set_bind_group(0, &self.house.group, &[]);
            pass.set_bind_group(1, rows, &[]);
            slot.batch.draw_batch.draw(&mut pass);
        }
        let groups_x = slot.batch.tiles.clamp(1, gpu.max_workgroups());
        let groups_y = slot.batch.tiles.div_ceil(groups_x).max(1);
        if let Some(group) = slot.group() {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_bind_group(0, &self.house.group, &[]);
            pass.set_bind_group(1, group, &[]);
            if let Some(atlas) = atlas {
                pass.set_pipeline(kernels.raster_hit_kernel(&gpu.device, &gpu.layouts));
                pass.set_bind_group(2, &atlas.group, &[]);
                pass.dispatch_workgroups(groups_x as u32, groups_y as u32, 1);
            }
            let all_drawn =
                slot.batch.draw_batch.atlas_tiles.len() == slot.batch.image_offsets.len();
            let steps = [
                (!all_drawn, &kernels.trace),
                (slot.batch.has_geometry_images, &kernels.geometry_images),
                (slot.batch.has_flat_color, &kernels.flat_color),
            ];
            let lit = slot.batch.has_lit_color.then(|| {
                let kernel = kernels.lit_kernel(&gpu.device, &gpu.layouts);
                (true, kernel)
            });
            for (_, kernel) in steps.into_iter().chain(lit).filter(|(wanted, _)| *wanted) {
                pass.set_pipeline(kernel);
                pass.dispatch_workgroups(groups_x as u32, groups_y as u32, 1);
            }
        }
        let bytes = slot.image_bytes();
        let (images, back) = slot.image_buffers(gpu)?;
        if bytes > 0 {
            encoder.copy_buffer_to_buffer(images, 0, back, 0, bytes);
        }
        let index = gpu.queue.submit([encoder.finish()]);
        slot.remap_upload_memory();
        let (sender, mapped) = mpsc::channel();
        back.map_async(wgpu::MapMode::Read, 0..bytes.max(16), move |result| {
            // Nobody waits any more when the batch was dropped.
            let _ = sender.send(result);
        });
        gpu.take_driver_error("to render")?;
        Ok(SubmittedPart {
            slot,
            index,
            mapped,
        })
    }

    fn wait_and_copy<'a, 'b: 'a>(
        &self,
        submitted: PendingBatch,
        frames: impl ExactSizeIterator<Item = &'a mut FrameMut<'b>>,
        threads: Threads,
    ) -> Result<(), RenderError> {
        if !Arc::ptr_eq(&submitted.owner, &self.own) {
            return Err(RenderError::OtherRenderer);
        }
        let views = submitted
            .parts
            .iter()
            .map(|part| part.slot.batch.image_offsets.len());
        let views = views.sum();
        if frames.len() != views {
            return Err(RenderError::Count {
                views,
                frames: frames.len(),
            });
        }
        let places = submitted
            .parts
            .iter()
            .flat_map(|part| &part.slot.batch.image_offsets);
        let mut all = Vec::with_capacity(views);
        for (view, (places, frame)) in places.zip(frames).enumerate() {
            places.check(view, frame)?;
            frame.check(view, places.pixels)?;
            all.push(ReadBack {
                places: *places,
                frame,
            });
        }
        let mut rest = &mut all[..];
        for part in submitted.parts {
            let (deliveries, more) = rest.split_at_mut(part.slot.batch.image_offsets.len());
            rest = more;
            self.gpu.wait(&part.index, &part.mapped)?;
            let (_, back) = part.slot.image_buffers(&self.gpu)?;
            let range = 0..part.slot.image_bytes().max(16);
            let held = back.get_mapped_range(range);
            let held = held.map_err(|error| self.gpu.driver_error("to read", error.to_string()))?;
            let bytes: &[u8] = &held;
            threads.for_each(deliveries, |_, delivery| delivery.write(bytes));
            drop(held);
            back.unmap();
            lock_ignoring_poison(&self.slots).push(part.slot);
        }
        Ok(())
    }
}

/// Returns whether a view is one for the adapter.
fn has_gpu_preset(job: &RenderJob<'_>) -> bool {
    matches!(job.view.preset, Preset::Flat | Preset::Lit)
}

impl ReadBack<'_, '_> {
    /// Copies the images out of the bytes that came back.
    fn write(&mut self, bytes: &[u8]) {
        let ImageOffsets { pixels, .. } = self.places;
        let words = |first: usize, parts: usize| &bytes[first * 4..(first + pixels * parts) * 4];
        if let (Some(first), Some(rgb)) = (self.places.rgb, &mut self.frame.rgb) {
            let found = words(first, 1).as_chunks::<4>().0;
            for (pixel, [r, g, b, _]) in rgb.as_chunks_mut::<3>().0.iter_mut().zip(found) {
                *pixel = [*r, *g, *b];
            }
        }
        macro_rules! copy {
            ($image:ident, $parts:expr) => {
                if let (Some(first), Some(image)) = (self.places.$image, &mut self.frame.$image) {
                    bytemuck::cast_slice_mut::<_, u8>(image).copy_from_slice(words(first, $parts));
                }
            };
        }
        copy!(depth, 1);
        copy!(instance, 1);
        copy!(semantic, 1);
        copy!(normals, 3);
        copy!(albedo, 3);
        copy!(flow, 2);
    }
}
