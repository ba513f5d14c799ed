//! The chain of microphone laws of one receiver, applied to the pressure that reaches it.

use crate::error::AcousticsError;
use crate::laws::{
    self,
    microphone_stage::{
        MicrophoneStage, SampleBlock, StageContext, StageState, fade_in, fade_in_weights,
    },
};
use dwell_scene::{LawInfo, LawSpec};
use serde::{Deserialize, Serialize};
use std::borrow::Borrow;

/// The installed microphone laws, one after the other.
///
/// When laws are added, removed or changed, the outputs of the old and the new chain are crossfaded over one block; a law
/// of the same id and target keeps its state.
#[derive(Debug)]
pub(crate) struct MicrophoneChain {
    rate_hz: f64,
    /// Channels of the last block; 0 before the first.
    channels: usize,
    chain: Vec<ChainStage>,
}

/// One law of the chain.
#[derive(Debug)]
struct ChainStage {
    /// Its index in the state's list.
    place: u64,
    spec: LawSpec,
    stage: Box<dyn MicrophoneStage>,
}

impl Borrow<LawSpec> for ChainStage {
    fn borrow(&self) -> &LawSpec {
        &self.spec
    }
}

/// The state of a microphone chain in a snapshot, from which signals continue bit for bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct MicrophoneChainState {
    channels: u64,
    chain: Vec<(u64, LawSpec, StageState)>,
}

impl ChainStage {
    /// Returns `None` for a law of something else, and for one without effect.
    fn new(place: u64, spec: &LawSpec, rate_hz: f64) -> Option<Self> {
        Some(Self {
            place,
            stage: laws::microphone_stage(spec, rate_hz)?,
            spec: spec.clone(),
        })
    }

    fn process(&mut self, listener: &StageContext<'_>, whole: bool, samples: &mut [f32]) {
        self.stage.process(&mut SampleBlock {
            context: listener,
            samples,
            channels: listener.receiver.channels(),
            key: listener.microphone_key.child(self.place),
            is_entire_signal: whole,
        });
    }
}

impl MicrophoneChain {
    pub(crate) fn new(rate_hz: f64) -> Self {
        Self {
            rate_hz,
            channels: 0,
            chain: Vec::new(),
        }
    }

    /// Resets the state.
    pub(crate) fn reset(&mut self) {
        self.channels = 0;
        self.chain.clear();
    }

    /// Replaces the next block of pressure by the microphones' output. `samples`: shape (channel, sample), flat.
    pub(crate) fn process_block(
        &mut self,
        installed: &[LawSpec],
        listener: &StageContext<'_>,
        samples: &mut [f32],
    ) {
        let channels = listener.receiver.channels();
        if channels != self.channels {
            // Another receiver has other microphones.
            self.reset();
        }
        let amid = self.channels > 0;
        self.channels = channels;
        let acting = || laws::pressure_laws(installed);
        let there = self.chain.iter().map(|link| (link.place, &link.spec));
        let same = there.eq(acting());
        if same {
            for link in &mut self.chain {
                link.process(listener, false, samples);
            }
            return;
        }
        let link = |(place, spec)| ChainStage::new(place, spec, self.rate_hz);
        let chain = acting().filter_map(link).collect();
        let mut before = std::mem::replace(&mut self.chain, chain);
        if !amid {
            for link in &mut self.chain {
                link.process(listener, false, samples);
            }
            return;
        }
        let size = samples.len() / channels.max(1);
        let mut old = samples.to_vec();
        let mut memories: Vec<StageState> = Vec::with_capacity(before.len());
        for link in &mut before {
            memories.push(link.stage.state());
            link.process(listener, false, &mut old);
        }
        let predecessors = LawSpec::predecessor_indices(&before, &self.chain);
        for (link, predecessor) in self.chain.iter_mut().zip(predecessors) {
            if let Some(predecessor) = predecessor {
                link.stage.restore(&memories[predecessor]);
            } else if link.stage.needs_fade_in() {
                samples.chunks_exact_mut(size.max(1)).for_each(fade_in);
            }
            link.process(listener, false, samples);
        }
        for (old, new) in old.chunks_exact(size).zip(samples.chunks_exact_mut(size)) {
            for ((old, new), weight) in old.iter().zip(new).zip(fade_in_weights(size)) {
                *new = old + (*new - old) * weight;
            }
        }
    }

    /// Returns the output of microphones in their initial state for `samples` and the silence after it, until they are
    /// silent themselves. Shape (channel, sample), flat.
    pub(crate) fn record_until_silent(
        installed: &[LawSpec],
        rate_hz: f64,
        listener: &StageContext<'_>,
        mut samples: Vec<f32>,
    ) -> Vec<f32> {
        let channels = listener.receiver.channels().max(1);
        for (place, spec) in laws::pressure_laws(installed) {
            let Some(mut link) = ChainStage::new(place, spec, rate_hz) else {
                continue;
            };
            let length = samples.len() / channels;
            if length == 0 {
                return samples;
            }
            let longer = length + link.stage.tail_samples(length);
            let mut out = vec![0.0; channels * longer];
            for (out, channel) in out
                .chunks_exact_mut(longer)
                .zip(samples.chunks_exact(length))
            {
                out[..length].copy_from_slice(channel);
            }
            link.process(listener, true, &mut out);
            samples = out;
        }
        samples
    }

    pub(crate) fn state(&self) -> MicrophoneChainState {
        let links = self.chain.iter();
        MicrophoneChainState {
            channels: self.channels as u64,
            chain: links
                .map(|link| (link.place, link.spec.clone(), link.stage.state()))
                .collect(),
        }
    }

    /// Restores a chain from [`Self::state`].
    ///
    /// # Errors
    /// [`AcousticsError::Snapshot`] for a law that this build does not know or with numbers out of range.
    pub(crate) fn restore(
        rate_hz: f64,
        memory: MicrophoneChainState,
    ) -> Result<Self, AcousticsError> {
        let mut chain = Vec::with_capacity(memory.chain.len());
        for (place, spec, stage) in memory.chain {
            let info = LawInfo::find(laws::all(), &spec.id);
            let sound = info.is_ok_and(|info| spec.check(info).is_ok());
            let link = sound
                .then(|| ChainStage::new(place, &spec, rate_hz))
                .flatten();
            let Some(mut link) = link else {
                let why = format!("law {:?} is not one of this build's microphones", spec.id);
                return Err(AcousticsError::Snapshot(why));
            };
            link.stage.restore(&stage);
            chain.push(link);
        }
        let channels = memory.channels as usize;
        Ok(Self {
            rate_hz,
            channels,
            chain,
        })
    }
}
