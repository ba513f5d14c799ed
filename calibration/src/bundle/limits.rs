//! Limits of what is read: bundles come from strangers.

/// Bytes of `manifest.json`.
pub(super) const MAX_MANIFEST_BYTES: u64 = 1 << 20;
/// Bytes of a table.
pub(super) const MAX_TABLE_BYTES: u64 = 256 << 20;
/// Rows of a table.
pub(super) const MAX_TABLE_ROWS: u64 = 4_000_000;
/// Bytes of an impulse response.
pub(super) const MAX_WAV_BYTES: u64 = 64 << 20;
/// Samples of an impulse response.
pub(super) const MAX_WAV_SAMPLES: u64 = 8 << 20;
/// Episodes.
pub(super) const MAX_EPISODES: u64 = 20_000;
/// Impulse responses.
pub(super) const MAX_RESPONSES: u64 = 2_000;
/// Bodies, joints or channels of a manifest.
pub(super) const MAX_MANIFEST_ENTRIES: u64 = 256;
/// Characters of a name.
pub(super) const MAX_NAME_CHARS: usize = 128;
