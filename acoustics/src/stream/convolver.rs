//! Block convolution: uniformly partitioned overlap-save.

use crate::fft::RealFft;
use realfft::num_complex::Complex;

type Spectrum = Vec<Complex<f32>>;

/// An impulse response as spectra of its partitions.
#[derive(Clone, Debug, Default)]
pub(super) struct PartitionedFilter {
    /// Shape (channel, partition, bin).
    channels: Vec<Vec<Spectrum>>,
}

impl PartitionedFilter {
    /// `samples`: shape (channel, sample), flat, cut to `partitions` blocks.
    pub(super) fn new(
        fft: &mut RealFft,
        samples: &[f32],
        channels: usize,
        partitions: usize,
    ) -> Self {
        let (block, length) = (fft.len() / 2, samples.len() / channels.max(1));
        let of_channel = |channel: &[f32]| {
            let pieces = channel.chunks(block).take(partitions);
            pieces.map(|piece| fft.forward(piece)).collect()
        };
        Self {
            channels: if length == 0 {
                vec![Vec::new(); channels]
            } else {
                samples.chunks_exact(length).map(of_channel).collect()
            },
        }
    }
}

/// The input of one source as spectra, newest first.
#[derive(Clone, Debug)]
pub(super) struct ConvolverInput {
    /// Samples of the last blocks, oldest first: one more block than a filter has partitions.
    history: Vec<f32>,
    /// Spectrum of each block with the one before it, a ring; `None` for silence.
    spectra: Vec<Option<Spectrum>>,
    newest: usize,
}

impl ConvolverInput {
    pub(super) fn new(block: usize, partitions: usize) -> Self {
        Self {
            history: vec![0.0; block * (partitions + 1)],
            spectra: vec![None; partitions],
            newest: 0,
        }
    }

    /// An input with the given `history`.
    pub(super) fn restore(fft: &mut RealFft, history: &[f32], partitions: usize) -> Self {
        let block = fft.len() / 2;
        let mut input = Self::new(block, partitions);
        let used = history.len().min(input.history.len());
        let start = input.history.len() - used;
        input.history[start..].copy_from_slice(&history[history.len() - used..]);
        for k in 0..partitions {
            // Position 0 of the ring becomes the newest.
            let end = input.history.len() - k * block;
            input.spectra[k] = transform(fft, &input.history[end - 2 * block..end]);
        }
        input
    }

    pub(super) fn history(&self) -> &[f32] {
        &self.history
    }

    /// Returns whether all samples that a filter can still reach are zero.
    pub(super) fn is_silent(&self) -> bool {
        self.spectra.iter().all(Option::is_none)
    }

    /// Adds the next block.
    pub(super) fn push(&mut self, fft: &mut RealFft, block: &[f32]) {
        let size = block.len();
        self.history.copy_within(size.., 0);
        let end = self.history.len();
        self.history[end - size..].copy_from_slice(block);
        self.newest = (self.newest + self.spectra.len() - 1) % self.spectra.len();
        self.spectra[self.newest] = transform(fft, &self.history[end - 2 * size..]);
    }

    /// Writes the newest block of the convolution with `filter`. `out`: shape (channel, sample), flat; overwritten.
    pub(super) fn convolve(&self, fft: &mut RealFft, filter: &PartitionedFilter, out: &mut [f32]) {
        let block = fft.len() / 2;
        let mut sum = vec![Complex::default(); fft.bins()];
        for (partitions, channel) in filter.channels.iter().zip(out.chunks_exact_mut(block)) {
            sum.fill(Complex::default());
            let mut any = false;
            for (k, partition) in partitions.iter().enumerate().take(self.spectra.len()) {
                let place = (self.newest + k) % self.spectra.len();
                if let Some(spectrum) = &self.spectra[place] {
                    any = true;
                    for ((total, x), h) in sum.iter_mut().zip(spectrum).zip(partition) {
                        *total += x * h;
                    }
                }
            }
            if any {
                // The first half is wrapped around; the second is the convolution.
                channel.copy_from_slice(&fft.inverse_ref(&mut sum)[block..]);
            } else {
                channel.fill(0.0);
            }
        }
    }
}

fn transform(fft: &mut RealFft, two_blocks: &[f32]) -> Option<Spectrum> {
    let heard = two_blocks.iter().any(|x| *x != 0.0);
    heard.then(|| fft.forward(two_blocks))
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;

    #[test]
    fn blocks_give_the_whole_convolution_for_odd_sizes() {
        for (block, taps) in [(10, 7), (64, 300), (125, 1000), (800, 801)] {
            let mut stream = RandomKey::root(block as u64).stream();
            let mut noise = |n: usize| (0..n).map(|_| stream.normal() as f32).collect::<Vec<_>>();
            let (ir, signal) = (noise(2 * taps), noise(block * 8));
            let partitions = taps.div_ceil(block);
            let mut fft = RealFft::new(2 * block);
            let filter = PartitionedFilter::new(&mut fft, &ir, 2, partitions);
            let mut input = ConvolverInput::new(block, partitions);
            let mut found = [Vec::new(), Vec::new()];
            for piece in signal.chunks(block) {
                input.push(&mut fft, piece);
                let again = ConvolverInput::restore(&mut fft, input.history(), partitions);
                let (mut out, mut other) = (vec![0.0; 2 * block], vec![0.0; 2 * block]);
                input.convolve(&mut fft, &filter, &mut out);
                again.convolve(&mut fft, &filter, &mut other);
                assert_eq!(out, other);
                found[0].extend_from_slice(&out[..block]);
                found[1].extend_from_slice(&out[block..]);
            }
            for (channel, found) in found.iter().enumerate() {
                let h = &ir[channel * taps..(channel + 1) * taps];
                for (n, y) in found.iter().enumerate() {
                    let taps = h.iter().enumerate().take(n + 1);
                    let wanted: f32 = taps.map(|(k, h)| h * signal[n - k]).sum();
                    assert!(
                        (y - wanted).abs() < 1e-3 * (taps_root(h)),
                        "{block} {n}: {y} {wanted}"
                    );
                }
            }
        }
    }

    fn taps_root(h: &[f32]) -> f32 {
        h.iter().map(|x| x * x).sum::<f32>().sqrt()
    }
}
