//! The graphics adapters of this machine.

use crate::error::RenderError;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

/// What an adapter is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum AdapterKind {
    /// A graphics card of its own.
    Discrete,
    /// A part of the processor's chip.
    Integrated,
    /// A card that a host shares.
    Virtual,
    /// Something that its driver does not name.
    Other,
    /// The processor: slower than `cpu`, taken by name only.
    Software,
}

impl AdapterKind {
    /// In one word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Discrete => "discrete",
            Self::Integrated => "integrated",
            Self::Virtual => "virtual",
            Self::Other => "other",
            Self::Software => "software",
        }
    }
}

/// One adapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adapter {
    /// As its driver calls it.
    pub name: String,
    /// What it is made of.
    pub kind: AdapterKind,
    /// `vulkan`, `metal`, `dx12` or `gl`.
    pub interface: String,
    /// The driver and its version.
    pub driver: String,
}

impl Adapter {
    fn of(adapter: &wgpu::Adapter) -> Self {
        let info = adapter.get_info();
        let kind = match info.device_type {
            wgpu::DeviceType::DiscreteGpu => AdapterKind::Discrete,
            wgpu::DeviceType::IntegratedGpu => AdapterKind::Integrated,
            wgpu::DeviceType::VirtualGpu => AdapterKind::Virtual,
            wgpu::DeviceType::Cpu => AdapterKind::Software,
            wgpu::DeviceType::Other => AdapterKind::Other,
        };
        let name = info.name.to_lowercase();
        // Behind GL some software adapters do not say what they are.
        let software = ["llvmpipe", "swiftshader", "softpipe"];
        let kind = if software.iter().any(|word| name.contains(word)) {
            AdapterKind::Software
        } else {
            kind
        };
        Self {
            name: info.name,
            kind,
            interface: info.backend.to_str().to_owned(),
            driver: format!("{} {}", info.driver, info.driver_info)
                .trim()
                .to_owned(),
        }
    }
}

impl std::fmt::Display for Adapter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            name, interface, ..
        } = self;
        write!(f, "{name:?} ({}, {interface})", self.kind.word())
    }
}

/// The result of a future of wgpu, which on this side of browsers needs no waker.
pub(super) fn ready<T>(future: impl Future<Output = T>) -> T {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        if let Poll::Ready(value) = future.as_mut().poll(&mut context) {
            return value;
        }
        std::thread::yield_now();
    }
}

/// All adapters, the likely quickest first. GL is asked only where nothing else answers.
fn list() -> Vec<(Adapter, wgpu::Adapter)> {
    let found = |backends: wgpu::Backends| {
        let mut description = wgpu::InstanceDescriptor::new_without_display_handle();
        description.backends = backends;
        description.flags = wgpu::InstanceFlags::empty();
        let instance = wgpu::Instance::new(description);
        ready(instance.enumerate_adapters(backends))
    };
    let mut all = found(wgpu::Backends::PRIMARY);
    if all.is_empty() {
        all = found(wgpu::Backends::GL);
    }
    let mut all: Vec<(Adapter, wgpu::Adapter)> = all
        .into_iter()
        .map(|adapter| (Adapter::of(&adapter), adapter))
        .collect();
    all.sort_by_key(|(adapter, _)| adapter.kind);
    all
}

/// The adapters of this machine, the likely quickest first; none where there is no driver.
pub fn adapters() -> Vec<Adapter> {
    list().into_iter().map(|(adapter, _)| adapter).collect()
}

/// The first adapter whose name holds `name` in upper or lower case; without a name the first that is not software.
///
/// # Errors
/// [`RenderError::NoAdapter`].
pub(super) fn find(name: Option<&str>) -> Result<(Adapter, wgpu::Adapter), RenderError> {
    let all = list();
    let names: Vec<String> = all.iter().map(|(adapter, _)| adapter.to_string()).collect();
    let fits = |adapter: &Adapter| match name {
        Some(name) => adapter.name.to_lowercase().contains(&name.to_lowercase()),
        None => adapter.kind != AdapterKind::Software,
    };
    let found = all.into_iter().find(|(adapter, _)| fits(adapter));
    found.ok_or_else(|| RenderError::NoAdapter {
        wanted: name.map_or_else(
            || "of hardware".to_owned(),
            |name| format!("with {name:?} in its name"),
        ),
        found: if names.is_empty() {
            "none (no Vulkan, Metal, DX12 or GL driver)".to_owned()
        } else {
            names.join(", ")
        },
    })
}
