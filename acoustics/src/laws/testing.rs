//! Shared helpers of the laws' tests.

use super::microphone_stage::StageContext;
use crate::head::HeadSet;
use crate::microphone_chain::MicrophoneChain;
use crate::receiver::Receiver;
use dwell_scene::LawSpec;
use dwell_scene::random::RandomKey;

pub(super) const RATE_HZ: f64 = 16_000.0;

pub(super) fn law(id: &str, values: &[(&str, f64)]) -> LawSpec {
    LawSpec::new(id, 1, values)
}

/// Calls a test with the context of `receiver` in the place `room`, in the block `own`.
pub(super) fn with_listener<T>(
    receiver: &Receiver,
    room: u64,
    own: RandomKey,
    then: impl FnOnce(&StageContext<'_>) -> T,
) -> T {
    static HEADS: std::sync::LazyLock<HeadSet> =
        std::sync::LazyLock::new(|| HeadSet::with_bins(0.0875, 343.2, RATE_HZ, 9));
    let (heads, room) = (&*HEADS, RandomKey::root(room));
    then(&StageContext {
        receiver,
        heads,
        speed_m_s: 343.2,
        room_key: room,
        microphone_key: own,
    })
}

/// Returns the output of one microphone, its ringing included.
pub(super) fn microphone_output(laws: &[LawSpec], seed: u64, pressure: &[f32]) -> Vec<f32> {
    let here = Receiver::omni(glam::Vec3::ZERO);
    with_listener(&here, seed, RandomKey::root(seed), |listener| {
        MicrophoneChain::record_until_silent(laws, RATE_HZ, listener, pressure.to_vec())
    })
}

/// Returns the same block by block.
pub(super) fn streamed_microphone_output(
    laws: &[LawSpec],
    pressure: &[f32],
    block: usize,
) -> Vec<f32> {
    let mut microphones = MicrophoneChain::new(RATE_HZ);
    let here = Receiver::omni(glam::Vec3::ZERO);
    let mut out = pressure.to_vec();
    for (k, samples) in out.chunks_mut(block).enumerate() {
        let own = RandomKey::root(0).child(k as u64);
        with_listener(&here, 0, own, |listener| {
            microphones.process_block(laws, listener, samples);
        });
    }
    out
}
