//! The samples of a block, source by source.

use super::ActiveSource;
use super::block_plan::PlannedSource;
use super::config::StreamConfig;
use super::early::{DelayInterpolation, TrackedPath};
use super::source_state::{ResponseInputs, SourceState};
use super::update_queue::PartialTraceOutcome;
use super::{add, crossfade, response_without_tracked_paths};
use crate::fft::RealFft;
use crate::receiver::Receiver;
use crate::response::ImpulseResponse;
use crate::scene::AcousticScene;

/// What the sources of a block have in common.
pub(super) struct BlockRendering<'a> {
    pub(super) scene: &'a AcousticScene,
    pub(super) config: &'a StreamConfig,
    pub(super) fft: &'a RealFft,
    /// Weights of the new over the block. Shape (sample,).
    pub(super) fade: &'a [f32],
    pub(super) partitions: usize,
    pub(super) sources: &'a [ActiveSource<'a>],
    pub(super) receiver: &'a Receiver,
}

/// A source in a block.
pub(super) struct SourceBlock<'a> {
    pub(super) voice: &'a mut SourceState,
    /// Taken when it is rendered.
    pub(super) planned: Option<PlannedSource>,
    /// What is heard of it, Pa. Shape (channel, sample), flat; zeros before.
    pub(super) out: Vec<f32>,
}

impl BlockRendering<'_> {
    /// Renders a source's block and updates its state.
    pub(super) fn render(&self, block: &mut SourceBlock<'_>) {
        let Some(planned) = block.planned.take() else {
            return;
        };
        let PlannedSource {
            id,
            is_playing,
            positions,
            new_response,
            tracked_paths: followed,
            waiting_since_block,
            partial_trace,
        } = planned;
        let (voice, out) = (&mut *block.voice, &mut block.out[..]);
        let mut fft = self.fft.clone();
        let (mut old, mut new) = (vec![0.0; out.len()], vec![0.0; out.len()]);
        let mut signal = vec![0.0; self.config.block_samples];
        // A source that was left out or is no longer named rings out without further input.
        let fed = self
            .sources
            .iter()
            .filter(|source| is_playing && source.id == id);
        for source in fed {
            add(&mut signal, source.signal);
        }
        let fresh = voice.input.is_silent() || voice.current_response.is_none();
        voice.input.push(&mut fft, &signal);
        let channels = |heard: &Option<(ResponseInputs, ImpulseResponse)>| {
            heard.as_ref().map(|(_, response)| response.channels)
        };
        let channels_before = channels(&voice.current_response);
        let before = voice.tracked.paths.take();
        // Changes of air or microphone do not glide.
        let effects = |heard: &Option<(ResponseInputs, ImpulseResponse)>| {
            heard.as_ref().map(|(situation, _)| situation.effects)
        };
        let effects_before = effects(&voice.current_response);
        let other = new_response.is_some() || before.is_some() != followed.is_some();
        if let Some(new_response) = new_response {
            voice.current_response = Some(new_response);
        }
        let same_channels = channels(&voice.current_response) == channels_before;
        let jumps = effects(&voice.current_response) != effects_before;
        if other && let Some((situation, response)) = &voice.current_response {
            if !fresh && same_channels {
                voice.input.convolve(&mut fft, &voice.filter, &mut old);
            }
            let most = followed.as_ref().map(|_| self.config.tracked_reflections);
            let samples = response_without_tracked_paths(self.scene, situation, response, most);
            let channels = response.channels;
            voice.set_filter(&mut fft, &samples, channels, self.partitions);
            voice.input.convolve(&mut fft, &voice.filter, &mut new);
            if fresh {
                add(out, &new);
            } else {
                crossfade(out, &old, &new, self.fade);
            }
        } else {
            voice.input.convolve(&mut fft, &voice.filter, &mut new);
            add(out, &new);
        }
        if let Some(paths) = followed {
            let speed_m_s = self.scene.config().air.speed_of_sound_m_s();
            let wavelets = self.scene.path_filters(speed_m_s, &paths, self.receiver);
            let pairs = paths.into_iter().zip(wavelets);
            let now: Vec<TrackedPath> = pairs
                .map(|(path, wavelets)| TrackedPath { path, wavelets })
                .collect();
            let before = before.filter(|_| same_channels).unwrap_or_default();
            let glide = self.delay_interpolation(voice);
            if fresh {
                glide.add(&now, &now, out);
            } else if jumps {
                glide.add(&before, &[], out);
                glide.add(&[], &now, out);
            } else {
                glide.add(&before, &now, out);
            }
            voice.tracked.paths = Some(now);
        } else if let Some(before) = before.filter(|_| same_channels && !fresh) {
            self.delay_interpolation(voice).add(&before, &[], out);
        }
        voice.tracked.last_positions = Some(positions);
        voice.pending_update.due_block = waiting_since_block;
        match partial_trace {
            PartialTraceOutcome::Unchanged => {}
            PartialTraceOutcome::None => voice.pending_update.job = None,
            PartialTraceOutcome::Advanced(job) => voice.pending_update.job = Some(job),
        }
    }

    /// Returns the glide of a source's early paths through its block.
    fn delay_interpolation<'a>(&'a self, voice: &'a SourceState) -> DelayInterpolation<'a> {
        DelayInterpolation {
            history: voice.input.history(),
            rate_hz: f64::from(self.scene.config().rate_hz),
            fade: self.fade,
        }
    }
}
