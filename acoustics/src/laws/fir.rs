//! FIR filters with state between blocks.

use super::microphone_stage::{MicrophoneStage, SampleBlock, StageState, fade_in};

/// A filter: a delay in samples, then taps.
#[derive(Clone, Debug)]
pub(super) struct FirFilter {
    delay: usize,
    taps: Vec<f32>,
    /// The last samples heard, newest at the end. Shape (channel, delay + taps - 1).
    history: Vec<Vec<f32>>,
}

impl FirFilter {
    pub(super) fn new(delay: usize, taps: Vec<f32>) -> Self {
        Self {
            delay,
            taps,
            history: Vec::new(),
        }
    }

    fn history_samples(&self) -> usize {
        self.delay + self.taps.len().max(1) - 1
    }
}

impl MicrophoneStage for FirFilter {
    fn process(&mut self, block: &mut SampleBlock<'_>) {
        let (reach, length) = (self.history_samples(), block.len());
        self.history.resize(block.channels, vec![0.0; reach]);
        let mut heard = Vec::with_capacity(reach + length);
        for (history, channel) in self.history.iter_mut().zip(block.channels_mut()) {
            heard.clear();
            heard.extend_from_slice(history);
            heard.extend_from_slice(channel);
            channel.fill(0.0);
            for (k, tap) in self.taps.iter().enumerate() {
                // Newest first: tap k is k samples further back.
                let start = self.taps.len() - 1 - k;
                for (y, x) in channel.iter_mut().zip(&heard[start..]) {
                    *y += tap * x;
                }
            }
            history.copy_from_slice(&heard[length..]);
        }
    }

    fn restore(&mut self, memory: &StageState) {
        let reach = self.history_samples();
        self.history = memory
            .samples
            .iter()
            .map(|old| {
                let mut history = vec![0.0; reach];
                let used = old.len().min(reach);
                history[reach - used..].copy_from_slice(&old[old.len() - used..]);
                if used < reach {
                    // Older samples are unknown.
                    fade_in(&mut history[reach - used..]);
                }
                history
            })
            .collect();
    }

    fn state(&self) -> StageState {
        StageState {
            numbers: Vec::new(),
            samples: self.history.clone(),
        }
    }

    fn tail_samples(&self, _length: usize) -> usize {
        self.history_samples()
    }

    fn needs_fade_in(&self) -> bool {
        self.delay > 0
    }
}
