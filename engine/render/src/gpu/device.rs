//! An adapter in use.

use super::adapter::{AdapterChoice, AdapterInfo, block_on, find, forked_process_error};
use super::kernels::{BindGroupLayouts, Kernels};
use super::raster;
use super::visibility_path::VisibilityPathSpeeds;
use crate::cpu::CpuRenderer;
use crate::error::RenderError;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// An adapter in use, shared by the renderers of all houses.
#[derive(Debug)]
pub struct Gpu {
    adapter: AdapterInfo,
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) layouts: BindGroupLayouts,
    /// Kernels by the links that their stacks hold.
    kernels: Mutex<BTreeMap<usize, Arc<Kernels>>>,
    raster: OnceLock<wgpu::RenderPipeline>,
    /// The measured speeds of both paths here; see [`VisibilityPathSpeeds::measure`].
    speeds: OnceLock<VisibilityPathSpeeds>,
    /// The process that opened it.
    process: u32,
    buffers_made: AtomicUsize,
    /// The first message of the driver that was not reported yet.
    fault: Arc<Mutex<Option<String>>>,
}

/// Locks a mutex, even a poisoned one.
pub(super) fn lock_ignoring_poison<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Limits of what batches take of an adapter at once: larger ones are cut into several submissions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BatchLimits {
    /// Size of each buffer, a house's included, bytes.
    pub buffer_bytes: u64,
    /// Groups of 64 pixels along either axis of a call.
    pub groups: u32,
}

impl BatchLimits {
    /// No limits but those of the adapters.
    pub const NONE: Self = Self {
        buffer_bytes: u64::MAX,
        groups: u32::MAX,
    };
}

/// Kernels count the words of images in 32 bits.
const MOST_BYTES: u64 = 4 * u32::MAX as u64;

static OPEN: Mutex<DeviceRegistry> = Mutex::new(DeviceRegistry::NONE);

/// Adapters in use by this process.
struct DeviceRegistry {
    /// The adapter that each requested name stands for.
    names: BTreeMap<Option<String>, AdapterInfo>,
    gpus: BTreeMap<AdapterInfo, Arc<Gpu>>,
}

impl DeviceRegistry {
    const NONE: Self = Self {
        names: BTreeMap::new(),
        gpus: BTreeMap::new(),
    };

    fn known(&mut self, adapter: &AdapterInfo) -> Option<Arc<Gpu>> {
        let gpu = self.gpus.get(adapter)?;
        if gpu.check_not_forked().is_ok() {
            return Some(gpu.clone());
        }
        // Closing another process's adapter would call its driver, which is not there.
        std::mem::forget(self.gpus.remove(adapter));
        None
    }
}

/// The size of the buffer that is made for so many bytes.
pub(super) fn buffer_size(bytes: u64) -> u64 {
    bytes.max(64).next_multiple_of(16)
}

impl Gpu {
    /// Opens an adapter: the first whose name or place on the bus holds `name`, in upper or lower case; without a name the likely
    /// quickest that is not software. Behind `vulkan/`, `metal/`, `dx12/` or `gl/` only adapters of that interface are meant.
    ///
    /// # Errors
    /// [`RenderError::NoAdapter`] says what was found instead, [`RenderError::TooLarge`] what the adapter is too small for,
    /// [`RenderError::Driver`] what its driver said.
    pub fn open(name: Option<&str>) -> Result<Arc<Self>, RenderError> {
        let (adapter, handle) = find(name.map_or(AdapterChoice::Hardware, AdapterChoice::Named))?;
        Self::open_found(adapter, &handle, BatchLimits::NONE)
    }

    /// Opens one of [`adapters`](crate::adapters), and takes no more of it than `most`.
    ///
    /// # Errors
    /// As [`Self::open`]; where houses do not fit, making renderers fails.
    pub fn open_adapter(
        adapter: &AdapterInfo,
        most: BatchLimits,
    ) -> Result<Arc<Self>, RenderError> {
        let (adapter, handle) = find(AdapterChoice::Exact(adapter))?;
        Self::open_found(adapter, &handle, most)
    }

    fn open_found(
        adapter: AdapterInfo,
        handle: &wgpu::Adapter,
        most: BatchLimits,
    ) -> Result<Arc<Self>, RenderError> {
        let mut limits = handle.limits();
        let bytes = &mut limits.max_storage_buffer_binding_size;
        *bytes = most.buffer_bytes.min(*bytes);
        limits.max_buffer_size = most.buffer_bytes.min(limits.max_buffer_size);
        let groups = &mut limits.max_compute_workgroups_per_dimension;
        *groups = most.groups.clamp(1, *groups);
        let needed = u64::from(BindGroupLayouts::BUFFERS);
        let allowed = u64::from(limits.max_storage_buffers_per_shader_stage);
        if allowed < needed {
            return Err(RenderError::TooLarge {
                what: "a kernel".into(),
                needed,
                unit: "buffers",
                allowed,
                adapter: adapter.to_string(),
            });
        }
        let description = wgpu::DeviceDescriptor {
            label: Some("dwell"),
            required_limits: limits,
            ..wgpu::DeviceDescriptor::default()
        };
        let opened = block_on(handle.request_device(&description));
        let (device, queue) = opened.map_err(|error| RenderError::Driver {
            adapter: adapter.to_string(),
            doing: "to open",
            message: error.to_string(),
        })?;
        let fault = Arc::new(Mutex::new(None));
        let note = fault.clone();
        // Without a handler wgpu would panic.
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            lock_ignoring_poison(&note).get_or_insert_with(|| error.to_string());
        }));
        let note = fault.clone();
        device.set_device_lost_callback(move |reason, message| {
            if reason != wgpu::DeviceLostReason::Destroyed {
                lock_ignoring_poison(&note)
                    .get_or_insert_with(|| format!("device lost: {message}"));
            }
        });
        let gpu = Self {
            layouts: BindGroupLayouts::new(&device),
            adapter,
            device,
            queue,
            kernels: Mutex::new(BTreeMap::new()),
            raster: OnceLock::new(),
            speeds: OnceLock::new(),
            process: std::process::id(),
            buffers_made: AtomicUsize::new(0),
            fault,
        };
        gpu.take_driver_error("to prepare")?;
        tracing::debug!(adapter = %gpu.adapter, "graphics adapter opened");
        Ok(Arc::new(gpu))
    }

    /// As [`Self::open`]; the same adapter is shared in one process.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn shared(name: Option<&str>) -> Result<Arc<Self>, RenderError> {
        let mut open = lock_ignoring_poison(&OPEN);
        let key = name.map(str::to_lowercase);
        if let Some(adapter) = open.names.get(&key).cloned()
            && let Some(gpu) = open.known(&adapter)
        {
            return Ok(gpu);
        }
        let (adapter, handle) = find(name.map_or(AdapterChoice::Hardware, AdapterChoice::Named))?;
        open.names.insert(key, adapter.clone());
        Self::share(&mut open, adapter, &handle)
    }

    /// As [`Self::shared`], for one of [`adapters`](crate::adapters).
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn shared_adapter(adapter: &AdapterInfo) -> Result<Arc<Self>, RenderError> {
        let mut open = lock_ignoring_poison(&OPEN);
        if let Some(gpu) = open.known(adapter) {
            return Ok(gpu);
        }
        let (adapter, handle) = find(AdapterChoice::Exact(adapter))?;
        Self::share(&mut open, adapter, &handle)
    }

    fn share(
        open: &mut DeviceRegistry,
        adapter: AdapterInfo,
        handle: &wgpu::Adapter,
    ) -> Result<Arc<Self>, RenderError> {
        if let Some(gpu) = open.known(&adapter) {
            return Ok(gpu);
        }
        let gpu = Self::open_found(adapter.clone(), handle, BatchLimits::NONE)?;
        open.gpus.insert(adapter, gpu.clone());
        Ok(gpu)
    }

    /// Returns whether this process opened the adapter.
    pub(super) fn check_not_forked(&self) -> Result<(), RenderError> {
        if self.process == std::process::id() {
            return Ok(());
        }
        Err(forked_process_error(&self.adapter))
    }

    /// The adapter.
    pub fn adapter(&self) -> &AdapterInfo {
        &self.adapter
    }

    /// Returns the speeds of both paths on this adapter; measured over the first house, then kept.
    ///
    /// # Errors
    /// As [`VisibilityPathSpeeds::measure`].
    pub fn visibility_path_speeds(
        self: &Arc<Self>,
        tables: &Arc<CpuRenderer>,
    ) -> Result<VisibilityPathSpeeds, RenderError> {
        if let Some(speeds) = self.speeds.get() {
            return Ok(*speeds);
        }
        let speeds = VisibilityPathSpeeds::measure(self, tables)?;
        tracing::debug!(adapter = %self.adapter, ?speeds, path = speeds.best().name(), "path chosen");
        Ok(*self.speeds.get_or_init(|| speeds))
    }

    /// The program that draws; made at first use.
    pub(super) fn raster_pipeline(&self) -> &wgpu::RenderPipeline {
        self.raster
            .get_or_init(|| raster::pipeline(&self.device, &self.layouts))
    }

    /// The longest edge of a texture, pixels.
    pub(super) fn max_texture_edge(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }

    pub(super) fn increment_buffer_count(&self) {
        self.buffers_made.fetch_add(1, Ordering::Relaxed);
    }

    /// Buffers and textures made so far: no more after the first batch of a kind.
    pub fn buffer_count(&self) -> usize {
        self.buffers_made.load(Ordering::Relaxed)
    }

    /// Returns the driver's message since the last call, as an error.
    pub(super) fn take_driver_error(&self, doing: &'static str) -> Result<(), RenderError> {
        match lock_ignoring_poison(&self.fault).take() {
            None => Ok(()),
            Some(message) => Err(self.driver_error(doing, message)),
        }
    }

    pub(super) fn driver_error(&self, doing: &'static str, message: String) -> RenderError {
        RenderError::Driver {
            adapter: self.adapter.to_string(),
            doing,
            message,
        }
    }

    /// The largest buffer that kernels can use, bytes.
    pub(super) fn max_buffer_bytes(&self) -> u64 {
        let limits = self.device.limits();
        limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size)
            .min(MOST_BYTES)
    }

    /// Most groups of a kernel along one axis.
    pub(super) fn max_workgroups(&self) -> usize {
        self.device.limits().max_compute_workgroups_per_dimension as usize
    }

    /// A buffer of at least 64 bytes.
    pub(super) fn buffer(
        &self,
        what: &str,
        bytes: u64,
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, RenderError> {
        self.make_buffer(what, bytes, usage, false)
    }

    /// A buffer that the processor can write at once, to be copied from.
    pub(super) fn upload_buffer(
        &self,
        what: &str,
        bytes: u64,
    ) -> Result<wgpu::Buffer, RenderError> {
        let usage = wgpu::BufferUsages::MAP_WRITE | wgpu::BufferUsages::COPY_SRC;
        self.make_buffer(what, bytes, usage, true)
    }

    fn make_buffer(
        &self,
        what: &str,
        bytes: u64,
        usage: wgpu::BufferUsages,
        mapped_at_creation: bool,
    ) -> Result<wgpu::Buffer, RenderError> {
        let allowed = self.max_buffer_bytes();
        let size = buffer_size(bytes);
        if size > allowed {
            return Err(RenderError::TooLarge {
                what: what.to_owned(),
                needed: bytes,
                unit: "bytes",
                allowed,
                adapter: self.adapter.to_string(),
            });
        }
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage,
            mapped_at_creation,
        });
        self.increment_buffer_count();
        self.take_driver_error("to make a buffer")?;
        Ok(buffer)
    }

    /// Kernels whose stacks hold at least so many links; made at first use.
    pub(super) fn kernels(&self, stack: usize) -> Result<Arc<Kernels>, RenderError> {
        let stack = stack.next_multiple_of(32);
        let mut made = lock_ignoring_poison(&self.kernels);
        if let Some(kernels) = made.get(&stack) {
            return Ok(kernels.clone());
        }
        let kernels = Arc::new(Kernels::new(&self.device, &self.layouts, stack));
        self.take_driver_error("to compile")?;
        made.insert(stack, kernels.clone());
        Ok(kernels)
    }
}
