//! The graphics adapters of this machine, and the choice among them.

use crate::error::RenderError;
use std::pin::pin;
use std::sync::atomic::{AtomicU32, Ordering};
use std::task::{Context, Poll, Waker};

/// The type of an adapter.
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
    pub fn name(self) -> &'static str {
        match self {
            Self::Discrete => "discrete",
            Self::Integrated => "integrated",
            Self::Virtual => "virtual",
            Self::Other => "other",
            Self::Software => "software",
        }
    }
}

/// An adapter. Two of them are the same when all fields are equal: names alone are shared by equal cards, and by one card behind two
/// interfaces.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct AdapterInfo {
    /// Its type.
    pub kind: AdapterKind,
    /// `vulkan`, `metal`, `dx12` or `gl`.
    pub interface: String,
    /// Its driver's name for it.
    pub name: String,
    /// The numbers of its maker and model, as the interface has them (those of PCI as a rule); 0 where it has none.
    pub ids: [u32; 2],
    /// Its address on the bus, such as `0000:01:00.0`; empty where the interface does not say.
    pub bus: String,
    /// The driver and its version.
    pub driver: String,
    /// The number of adapters equal in all else that the interface lists before it.
    pub duplicate_index: usize,
}

impl AdapterInfo {
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
        let software = ["llvmpipe", "swiftshader", "softpipe", "basic render"];
        let kind = if software.iter().any(|word| name.contains(word)) {
            AdapterKind::Software
        } else {
            kind
        };
        Self {
            name: info.name,
            kind,
            interface: info.backend.to_str().to_owned(),
            ids: [info.vendor, info.device],
            bus: info.device_pci_bus_id,
            duplicate_index: 0,
            driver: format!("{} {}", info.driver, info.driver_info)
                .trim()
                .to_owned(),
        }
    }
}

impl std::fmt::Display for AdapterInfo {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            name, interface, ..
        } = self;
        write!(f, "{name:?} ({}, {interface})", self.kind.name())
    }
}

/// The result of a future of wgpu, which outside of browsers needs no waker.
pub(super) fn block_on<T>(future: impl Future<Output = T>) -> T {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        if let Poll::Ready(value) = future.as_mut().poll(&mut context) {
            return value;
        }
        std::thread::yield_now();
    }
}

/// The choice of an adapter.
#[derive(Clone, Copy, Debug)]
pub(super) enum AdapterChoice<'a> {
    /// The likely quickest that is not software.
    Hardware,
    /// The first whose name or place on the bus holds this, in upper or lower case; behind `vulkan/`, `metal/`, `dx12/` or `gl/`
    /// only those of that interface.
    Named(&'a str),
    /// This one.
    Exact(&'a AdapterInfo),
}

const INTERFACES: [&str; 4] = ["vulkan", "metal", "dx12", "gl"];

impl AdapterChoice<'_> {
    fn is(&self, adapter: &AdapterInfo) -> bool {
        let is_hardware = adapter.kind != AdapterKind::Software;
        match self {
            Self::Hardware => is_hardware,
            Self::Exact(wanted) => adapter == *wanted,
            Self::Named(text) => {
                let text = text.to_lowercase();
                let split = text.split_once('/');
                let behind = split.filter(|(interface, _)| INTERFACES.contains(interface));
                let (interface, name) = behind.map_or((None, &*text), |(i, name)| (Some(i), name));
                interface.is_none_or(|interface| interface == adapter.interface)
                    && (is_hardware || !name.is_empty())
                    && [&adapter.name, &adapter.bus]
                        .iter()
                        .any(|held| held.to_lowercase().contains(name))
            }
        }
    }
}

impl std::fmt::Display for AdapterChoice<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Hardware => f.write_str("of hardware"),
            Self::Named(text) => write!(f, "with {text:?} in its name"),
            Self::Exact(adapter) => write!(f, "that is {adapter}"),
        }
    }
}

/// All adapters, the likely quickest first and software last. `ask`: those behind some interfaces. GL is queried where nothing else
/// answers but software: a card may have no other driver. Its software is listed only where there is no other.
fn sorted_adapters<T>(
    mut ask: impl FnMut(wgpu::Backends) -> Vec<(AdapterInfo, T)>,
) -> Vec<(AdapterInfo, T)> {
    let is_hardware = |(adapter, _): &(AdapterInfo, T)| adapter.kind != AdapterKind::Software;
    let mut all = ask(wgpu::Backends::PRIMARY);
    if !all.iter().any(is_hardware) {
        let is_first = all.is_empty();
        let more = ask(wgpu::Backends::GL).into_iter();
        all.extend(more.filter(|found| is_first || is_hardware(found)));
    }
    all.sort_by_key(|(adapter, _)| {
        let interface = INTERFACES
            .iter()
            .position(|known| *known == adapter.interface);
        (adapter.kind, interface)
    });
    for k in 0..all.len() {
        let (before, rest) = all.split_at_mut(k);
        let own = &mut rest[0].0;
        let same = |(other, _): &&(AdapterInfo, T)| {
            let twin = own.duplicate_index;
            AdapterInfo {
                duplicate_index: twin,
                ..other.clone()
            } == *own
        };
        own.duplicate_index = before.iter().filter(same).count();
    }
    all
}

/// The process that found adapters behind GL first; 0 as long as none has. Forked ones inherit it.
static GL_USED_BY: AtomicU32 = AtomicU32::new(0);

/// Returns whether a process may query GL. Its drivers keep one display for a whole process, whose threads do not exist in a forked one:
/// drawing there would wait for them for ever.
fn may_ask_gl(used_by: &AtomicU32, process: u32) -> bool {
    [0, process].contains(&used_by.load(Ordering::Relaxed))
}

/// All adapters, and whether GL was left out because a process that this one was forked from has used it.
fn list() -> (Vec<(AdapterInfo, wgpu::Adapter)>, bool) {
    let process = std::process::id();
    let mut is_gl_lost = false;
    let all = sorted_adapters(|backends| {
        let is_gl = backends == wgpu::Backends::GL;
        if is_gl && !may_ask_gl(&GL_USED_BY, process) {
            is_gl_lost = true;
            return Vec::new();
        }
        let mut description = wgpu::InstanceDescriptor::new_without_display_handle();
        description.backends = backends;
        description.flags = wgpu::InstanceFlags::empty();
        let instance = wgpu::Instance::new(description);
        let found = block_on(instance.enumerate_adapters(backends));
        if is_gl && !found.is_empty() {
            GL_USED_BY.store(process, Ordering::Relaxed);
        }
        let found = found.into_iter();
        found
            .map(|adapter| (AdapterInfo::of(&adapter), adapter))
            .collect()
    });
    (all, is_gl_lost)
}

/// The adapters of this machine, the likely quickest first and software last; none where there is no driver. Those behind GL are left
/// out in a process that was forked from one that has found them.
pub fn adapters() -> Vec<AdapterInfo> {
    let (all, _) = list();
    all.into_iter().map(|(adapter, _)| adapter).collect()
}

/// The hint for GL that was used before a fork.
const NOT_GL: &str = "it cannot be opened again here: start workers with \"spawn\", or use `cpu`";

/// Returns the error for a process that was forked from one that has opened an adapter.
pub(super) fn forked_process_error(adapter: &AdapterInfo) -> RenderError {
    let instead = if adapter.interface == "gl" {
        NOT_GL
    } else {
        "make houses and worlds that use it in the forked process, or start workers with \"spawn\""
    };
    RenderError::Forked {
        what: adapter.to_string(),
        instead,
    }
}

/// The first adapter that fits the choice.
///
/// # Errors
/// [`RenderError::NoAdapter`]; [`RenderError::Forked`] where it may be behind GL, which cannot be asked here.
pub(super) fn find(wanted: AdapterChoice<'_>) -> Result<(AdapterInfo, wgpu::Adapter), RenderError> {
    let (all, is_gl_lost) = list();
    let names: Vec<String> = all.iter().map(|(adapter, _)| adapter.to_string()).collect();
    let found = all.into_iter().find(|(adapter, _)| wanted.is(adapter));
    found.ok_or_else(|| {
        let wanted = wanted.to_string();
        if is_gl_lost {
            let what = format!("GL, which may have an adapter {wanted},");
            return RenderError::Forked {
                what,
                instead: NOT_GL,
            };
        }
        let found = if names.is_empty() {
            "none (no Vulkan, Metal, DX12 or GL driver)".to_owned()
        } else {
            names.join(", ")
        };
        RenderError::NoAdapter { wanted, found }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn adapter(kind: AdapterKind, interface: &str, name: &str, bus: &str) -> AdapterInfo {
        AdapterInfo {
            kind,
            interface: interface.into(),
            name: name.into(),
            ids: [0x10de, 0x2335],
            bus: bus.into(),
            driver: String::new(),
            duplicate_index: 0,
        }
    }

    fn pipe(interface: &str) -> AdapterInfo {
        adapter(AdapterKind::Software, interface, "llvmpipe (LLVM 15)", "")
    }

    /// The adapters of a machine whose Vulkan and GL have these.
    fn machine(vulkan: &[AdapterInfo], gl: &[AdapterInfo]) -> Vec<AdapterInfo> {
        let listed = sorted_adapters(|backends| {
            let of = if backends == wgpu::Backends::GL {
                gl
            } else {
                vulkan
            };
            of.iter().map(|adapter| (adapter.clone(), ())).collect()
        });
        listed.into_iter().map(|(adapter, ())| adapter).collect()
    }

    fn chosen(all: &[AdapterInfo], wanted: AdapterChoice<'_>) -> Option<usize> {
        all.iter().position(|adapter| wanted.is(adapter))
    }

    #[test]
    fn a_card_with_a_driver_for_gl_alone_comes_before_software() {
        let card = adapter(AdapterKind::Integrated, "gl", "HD Graphics 4000", "");
        let all = machine(&[pipe("vulkan")], &[card.clone(), pipe("gl")]);
        assert_eq!(all, [card.clone(), pipe("vulkan")]);
        assert_eq!(chosen(&all, AdapterChoice::Hardware), Some(0));
        // A name that both hold means the card.
        assert_eq!(chosen(&all, AdapterChoice::Named("p")), Some(0));
        assert_eq!(
            machine(&[], &[pipe("gl"), card.clone()]),
            [card, pipe("gl")]
        );
    }

    #[test]
    fn software_is_taken_by_name_alone() {
        let all = machine(&[pipe("vulkan")], &[]);
        assert_eq!(chosen(&all, AdapterChoice::Hardware), None);
        assert_eq!(chosen(&all, AdapterChoice::Named("vulkan/")), None);
        for name in ["LLVMpipe", "vulkan/llvm"] {
            assert_eq!(chosen(&all, AdapterChoice::Named(name)), Some(0));
        }
        assert_eq!(chosen(&all, AdapterChoice::Named("gl/llvm")), None);
    }

    #[test]
    fn gl_is_for_the_process_that_used_it_first() {
        let used_by = AtomicU32::new(0);
        assert!(may_ask_gl(&used_by, 70) && may_ask_gl(&used_by, 71));
        used_by.store(70, Ordering::Relaxed);
        assert!(may_ask_gl(&used_by, 70));
        assert!(!may_ask_gl(&used_by, 71), "a forked process");
    }

    #[test]
    fn what_was_forked_is_told_what_to_do_instead() {
        let lost = |interface: &str| {
            let adapter = adapter(AdapterKind::Software, interface, "llvmpipe", "");
            forked_process_error(&adapter).to_string()
        };
        assert!(lost("vulkan").contains("in the forked process"));
        assert!(!lost("gl").contains("in the forked process"));
        assert!(lost("gl").contains("\"spawn\", or use `cpu`"));
    }

    #[test]
    fn equal_names_are_told_apart_by_interface_bus_and_order() {
        let card =
            |interface: &str, bus: &str| adapter(AdapterKind::Discrete, interface, "R5/R7 X", bus);
        let first = card("vulkan", "0000:01:00.0");
        let second = card("vulkan", "0000:65:00.0");
        let all = machine(
            &[card("dx12", ""), first.clone(), second, card("dx12", "")],
            &[],
        );
        for (k, adapter) in all.iter().enumerate() {
            assert_eq!(chosen(&all, AdapterChoice::Exact(adapter)), Some(k));
        }
        assert_eq!(all[0], first, "vulkan comes before dx12");
        assert_eq!(chosen(&all, AdapterChoice::Named("r5/r7")), Some(0));
        assert_eq!(chosen(&all, AdapterChoice::Named("0000:65")), Some(1));
        assert_eq!(chosen(&all, AdapterChoice::Named("dx12/r5")), Some(2));
        assert_eq!((all[2].duplicate_index, all[3].duplicate_index), (0, 1));
    }
}
