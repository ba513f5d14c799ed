//! Stages of microphone laws, which process pressure block by block.

use crate::head::HeadSet;
use crate::receiver::Receiver;
use dwell_scene::random::RandomKey;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The receiver of a stage, and its surroundings.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StageContext<'a> {
    pub(crate) receiver: &'a Receiver,
    /// Head filters, if the receiver is a head.
    pub(crate) heads: &'a HeadSet,
    /// Speed of sound, m/s.
    pub(crate) speed_m_s: f64,
    /// Random key of the place, the same for all receivers in it.
    pub(crate) room_key: RandomKey,
    /// Random key of the microphones themselves.
    pub(crate) microphone_key: RandomKey,
}

/// A block of pressure and its context.
#[derive(Debug)]
pub(crate) struct SampleBlock<'a> {
    pub(crate) context: &'a StageContext<'a>,
    /// The pressure, Pa. Shape (channel, sample), one channel after the other.
    pub(crate) samples: &'a mut [f32],
    /// Number of channels, at least 1.
    pub(crate) channels: usize,
    /// Random key of this block for this law.
    pub(crate) key: RandomKey,
    /// True if the block is the whole signal, with only silence after it. Else later samples are not known yet.
    pub(crate) is_entire_signal: bool,
}

impl SampleBlock<'_> {
    /// Returns the samples of a channel.
    pub(crate) fn len(&self) -> usize {
        self.samples.len() / self.channels.max(1)
    }

    /// Returns the channels, one after the other.
    pub(crate) fn channels_mut(&mut self) -> std::slice::ChunksExactMut<'_, f32> {
        let length = self.len().max(1);
        self.samples.chunks_exact_mut(length)
    }
}

/// The state of a stage that a snapshot holds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct StageState {
    /// A few numbers, in the stage's own order.
    pub(crate) numbers: Vec<f64>,
    /// Samples of each channel, the newest last. Shape (channel, any).
    pub(crate) samples: Vec<Vec<f32>>,
}

/// Returns the weights of a fade-in over `length` samples: a raised cosine, so that neither level nor slope has a step.
pub(crate) fn fade_in_weights(length: usize) -> impl Iterator<Item = f32> {
    (1..=length).map(move |k| {
        let turn = std::f64::consts::PI * k as f64 / length as f64;
        (0.5 - 0.5 * libm::cos(turn)) as f32
    })
}

/// Fades all samples in.
pub(crate) fn fade_in(samples: &mut [f32]) {
    let weights = fade_in_weights(samples.len());
    for (x, weight) in samples.iter_mut().zip(weights) {
        *x *= weight;
    }
}

/// A stage of an installed microphone law.
pub(crate) trait MicrophoneStage: fmt::Debug + Send + Sync {
    /// Processes a block.
    fn process(&mut self, block: &mut SampleBlock<'_>);

    /// Takes over the state of another stage of the same law, possibly with other numbers.
    fn restore(&mut self, _memory: &StageState) {}

    /// Returns its state.
    fn state(&self) -> StageState {
        StageState::default()
    }

    /// Returns the number of samples by which its output is longer than its input of `length` samples.
    fn tail_samples(&self, _length: usize) -> usize {
        0
    }

    /// Returns whether its first block must fade in when it is installed during sound: a late output would begin with a step.
    fn needs_fade_in(&self) -> bool {
        false
    }
}

/// A stage without state.
pub(crate) struct StatelessStage<F>(pub(crate) F);

impl<F> fmt::Debug for StatelessStage<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Each")
    }
}

impl<F: Fn(&mut SampleBlock<'_>) + Send + Sync> MicrophoneStage for StatelessStage<F> {
    fn process(&mut self, block: &mut SampleBlock<'_>) {
        (self.0)(block);
    }
}
