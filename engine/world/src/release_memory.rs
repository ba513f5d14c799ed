//! Return of a house's memory to the system when the house is dropped.

/// Gives memory back when it is dropped: the last field of what holds much.
///
/// A house is hundreds of thousands of small blocks and some large ones. glibc keeps what is freed between blocks that are still in use,
/// so that a process that opens house after house holds ever more: with environments over 50 houses some 250 MiB after 350 resets, a
/// quarter of all. Other allocators give it back by themselves.
#[derive(Debug)]
pub(crate) struct ReleaseOnDrop;

impl Drop for ReleaseOnDrop {
    fn drop(&mut self) {
        trim();
    }
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[expect(unsafe_code, reason = "glibc alone can tell its allocator")]
fn trim() {
    unsafe extern "C" {
        fn malloc_trim(pad: usize) -> std::ffi::c_int;
    }
    // SAFETY: glibc allows it at any time, in any thread; it touches free memory only.
    let _freed = unsafe { malloc_trim(0) };
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn trim() {}
