//! Synthesis of pressure from energies.

mod fractional_delay;
mod noise_gains;
mod smooth;
mod tail_noise;
mod upper_air;

use crate::bands::{BAND_COUNT, BandValues, FilterBank};
use crate::config::AcousticConfig;
use crate::echogram::{Echogram, MIN_DISTANCE_M, PropagationPath};
use crate::fft::RealFft;
use crate::head::HeadSet;
use crate::minimum_phase::{self, HRIR_PRE_RINGING_S, MinimumPhaseDesigner};
use crate::receiver::Receiver;
use crate::receiver_channel::ReceiverChannel;
use dwell_scene::random::RandomKey;
use fractional_delay::FractionalDelay;
pub(crate) use noise_gains::CachedGains;
use serde::{Deserialize, Serialize};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, Weak};
pub(crate) use upper_air::UpperAirAbsorption;
use upper_air::UpperBands;

/// Most paths with filters, the strongest first; fainter ones beyond these are left out.
const MOST_PATHS: usize = 200;
/// Remaining energy at which an impulse response may end: -70 dB.
const END: f64 = 1e-7;
/// Crossover width of the tail's bands, octaves: the least that rings no longer than a window of their energy.
const OVERLAP: f64 = 0.5;
/// Length of the filters of moving paths, s.
const SHORT_S: f64 = 0.004;

/// Returns the taps of the filters of moving paths.
fn short_filter_taps(rate_hz: f64) -> usize {
    (SHORT_S * rate_hz) as usize
}

/// Returns the samples of the longest response.
fn longest(config: &AcousticConfig) -> usize {
    ((config.max_duration_s + 0.05) * f64::from(config.rate_hz)) as usize
}

/// Tables for one sample rate, shared by all worlds.
#[derive(Debug)]
pub(crate) struct Synthesizer {
    rate_hz: f64,
    arrivals_per_s: f64,
    filters: MinimumPhaseDesigner,
    /// Fade-out of the filters of moving paths.
    fade: Vec<f32>,
    longest: usize,
    /// Filter banks for a quarter, half and all of the longest response, made when first needed.
    banks: [OnceLock<FilterBankSet>; 3],
}

/// Filters for one length of responses.
#[derive(Debug)]
struct FilterBankSet {
    bands: FilterBank,
    upper: UpperBands,
}

/// The receiver, its head filters and the air.
pub(crate) struct ReceiverContext<'a> {
    pub(crate) receiver: &'a Receiver,
    pub(crate) heads: &'a HeadSet,
    /// Its absorption above the highest band, where that can be heard.
    pub(crate) upper_air: Option<&'a UpperAirAbsorption>,
}

/// Synthesizers in use: scenes with one rate share them.
static IN_USE: Mutex<Vec<Weak<Synthesizer>>> = Mutex::new(Vec::new());

impl Synthesizer {
    /// Returns the synthesizer for these settings, made where none is in use.
    pub(crate) fn shared(config: &AcousticConfig) -> Arc<Self> {
        let in_use = || IN_USE.lock().unwrap_or_else(PoisonError::into_inner);
        let known = |all: &[Weak<Self>]| {
            let mut known = all.iter().filter_map(Weak::upgrade);
            known.find(|one| one.is_for(config))
        };
        if let Some(known) = known(&in_use()) {
            return known;
        }
        // Made while nothing is locked: a process that forks meanwhile finds the list free.
        let new = Arc::new(Self::new(config));
        let mut in_use = in_use();
        if let Some(known) = known(&in_use) {
            return known;
        }
        in_use.retain(|one| one.strong_count() > 0);
        in_use.push(Arc::downgrade(&new));
        new
    }

    fn is_for(&self, config: &AcousticConfig) -> bool {
        (self.rate_hz, self.longest, self.arrivals_per_s)
            == (
                f64::from(config.rate_hz),
                longest(config),
                config.arrivals_per_s,
            )
    }

    fn new(config: &AcousticConfig) -> Self {
        let rate_hz = f64::from(config.rate_hz);
        let filters = MinimumPhaseDesigner::new(rate_hz);
        Self {
            longest: longest(config),
            banks: [const { OnceLock::new() }; 3],
            filters,
            fade: minimum_phase::fade_out_weights(short_filter_taps(rate_hz) / 4),
            rate_hz,
            arrivals_per_s: config.arrivals_per_s,
        }
    }

    /// Returns the absorption above the highest band by `config`'s air, with this `share` of it.
    pub(crate) fn upper_air_absorption(
        &self,
        config: &AcousticConfig,
        share: f64,
    ) -> Option<UpperAirAbsorption> {
        UpperAirAbsorption::new(config, share, &self.filters)
    }

    fn bank(&self, length: usize) -> &FilterBankSet {
        let quarters = (4 * length).div_ceil(self.longest.max(1));
        let (place, span) = match quarters {
            0 | 1 => (0, self.longest.div_ceil(4)),
            2 => (1, self.longest.div_ceil(2)),
            _ => (2, self.longest),
        };
        self.banks[place].get_or_init(|| FilterBankSet {
            bands: FilterBank::new(self.rate_hz, span, OVERLAP),
            upper: UpperBands::new(self.rate_hz, span),
        })
    }

    /// Returns the samples of an echogram: until 1e-7 of its energy is left, at most the configured duration.
    fn length(&self, echogram: &Echogram) -> usize {
        let sum = |energy: &[f64]| energy.iter().sum::<f64>();
        let total = sum(&echogram.total());
        if total <= 0.0 {
            return 0;
        }
        let mut left = 0.0;
        let mut bins = echogram.tail.bins.len();
        while bins > 0 {
            left += sum(&echogram.tail.bins[bins - 1]);
            if left > END * total {
                break;
            }
            bins -= 1;
        }
        let tail_s = bins as f64 * echogram.tail.bin_s;
        let early_s = echogram
            .paths
            .iter()
            .map(|path| echogram.delay_s(path))
            .fold(0.0, f64::max);
        // 20 ms for the filters of the last arrivals.
        let length = ((tail_s.max(early_s) + 0.02) * self.rate_hz).ceil() as usize;
        length.min(self.longest)
    }

    /// Returns the pressure at the receiver, Pa for an impulse of 1 Pa at 1 m. Shape (channel, sample), flat.
    ///
    /// Sample 0 is the time of the impulse; a free path of d metres arrives d/c later with the amplitude 1/d. `early`: the
    /// paths of each channel where they are not the centre's. `levels`: those of the same echogram and key for a receiver
    /// with another rotation, where they are known; afterwards they are.
    pub(crate) fn render(
        &self,
        echogram: &Echogram,
        hearing: &ReceiverContext<'_>,
        early: Option<&[Vec<PropagationPath>]>,
        levels: &mut CachedGains,
        key: RandomKey,
    ) -> Vec<f32> {
        let ReceiverContext {
            receiver,
            heads,
            upper_air: air,
        } = *hearing;
        let length = self.length(echogram);
        let mut out = vec![0.0; receiver.channels() * length];
        if out.is_empty() {
            return out;
        }
        let channels = ReceiverChannel::all_of_receiver(receiver, heads, echogram.speed_m_s);
        // The tail may not begin before the direct sound.
        let radius_m = receiver
            .radius_m()
            .max(HRIR_PRE_RINGING_S * echogram.speed_m_s);
        let quiet_s = (echogram.direct_length_m - radius_m) / echogram.speed_m_s;
        let quiet = ((quiet_s * self.rate_hz).max(0.0) as usize).min(length);
        let bank = self.bank(length);
        let noise = tail_noise::TailNoise {
            echogram,
            energy: smooth::smooth(&echogram.tail),
            rate_hz: self.rate_hz,
            arrivals_per_s: self.arrivals_per_s,
            length,
            silent_samples: quiet,
            bank: &bank.bands,
            upper_air_absorption: air.map(|air| (&bank.upper, air)),
        };
        let arrivals = noise.arrivals(key);
        if !arrivals.is_empty() {
            let levels = levels.get_or_compute(|| {
                let mut paths = vec![0.0; length];
                // Bands are known at their centres: levels are those before absorption above.
                let omni = PathRenderContext {
                    channels: &[ReceiverChannel::Omni],
                    at_channel: true,
                    air: None,
                };
                self.add_paths(echogram, &echogram.paths, &omni, &mut paths);
                noise.noise_gains(&arrivals, &paths, channels.len())
            });
            noise.add(&arrivals, levels, &channels, &mut out);
        }
        let listening = |channels, at_channel| PathRenderContext {
            channels,
            at_channel,
            air,
        };
        let Some(early) = early else {
            self.add_paths(
                echogram,
                &echogram.paths,
                &listening(&channels, false),
                &mut out,
            );
            return out;
        };
        let all = channels.chunks(1).zip(out.chunks_exact_mut(length));
        for ((channel, out), paths) in all.zip(early) {
            self.add_paths(echogram, paths, &listening(channel, true), out);
        }
        out
    }

    /// Adds early paths at each channel to `out`, shape (channel, sample).
    fn add_paths(
        &self,
        echogram: &Echogram,
        paths: &[PropagationPath],
        listening: &PathRenderContext<'_>,
        out: &mut [f32],
    ) {
        let length = out.len() / listening.channels.len();
        let mut fft = self.filters.fft();
        for path in strongest(paths) {
            let wavelets = self.channel_filters(&mut fft, echogram.speed_m_s, path, listening);
            for (wavelet, out) in wavelets.zip(out.chunks_exact_mut(length)) {
                let taps = FractionalDelay::new(wavelet.delay_s * self.rate_hz);
                taps.add(
                    out,
                    &wavelet.response,
                    wavelet.pre_ringing_samples,
                    wavelet.amplitude,
                );
            }
        }
    }

    /// Returns the filters of a path at each channel. Shape (channel,).
    fn channel_filters<'a>(
        &'a self,
        fft: &'a mut RealFft,
        speed_m_s: f64,
        path: &'a PropagationPath,
        listening: &PathRenderContext<'a>,
    ) -> impl Iterator<Item = PathFilter> + 'a {
        let PathRenderContext {
            channels,
            at_channel,
            air,
        } = *listening;
        let air = air.map(|air| air.log_spectrum_at(path.length_m));
        // Most channels have the same energies.
        let (mut last, mut found) = ([f32::NAN; BAND_COUNT], (Vec::new(), 0.0));
        channels.iter().map(move |channel| {
            let gain = channel.path_gain(path.arrival);
            let energy: BandValues = std::array::from_fn(|b| path.energy[b] * gain[b] * gain[b]);
            if energy != last {
                (last, found) = (energy, self.filters.spectrum(&energy, air));
            }
            let (mut spectrum, mut amplitude) = found.clone();
            if path.inverted != (gain.iter().sum::<f32>() < 0.0) {
                amplitude = -amplitude;
            }
            let mut delay_s =
                channel.apply_undelayed_response(speed_m_s, path.arrival, &mut spectrum);
            if at_channel {
                delay_s = 0.0;
            }
            let early = channel.has_pre_ringing();
            if early {
                self.filters.delay_by_pre_ringing(&mut spectrum);
            }
            PathFilter {
                response: self.filters.impulse_response(fft, &mut spectrum),
                pre_ringing_samples: if early {
                    minimum_phase::pre_ringing_samples(self.rate_hz)
                } else {
                    0
                },
                amplitude,
                delay_s: delay_s + path.length_m.max(MIN_DISTANCE_M) / speed_m_s,
            }
        })
    }

    /// Returns the filters of paths at each channel of a receiver, of length [`SHORT_S`]. Shape (path, channel).
    pub(crate) fn path_filters(
        &self,
        speed_m_s: f64,
        paths: &[PropagationPath],
        hearing: &ReceiverContext<'_>,
    ) -> Vec<Vec<PathFilter>> {
        let channels = ReceiverChannel::all_of_receiver(hearing.receiver, hearing.heads, speed_m_s);
        let listening = PathRenderContext {
            channels: &channels,
            at_channel: false,
            air: hearing.upper_air,
        };
        let mut fft = self.filters.fft();
        let mut hear = |path: &PropagationPath| -> Vec<PathFilter> {
            let wavelets = self.channel_filters(&mut fft, speed_m_s, path, &listening);
            wavelets.map(|wavelet| self.shorten(wavelet)).collect()
        };
        paths.iter().map(&mut hear).collect()
    }

    /// Keeps the first [`SHORT_S`] after the lead, the last quarter of them faded out.
    fn shorten(&self, mut wavelet: PathFilter) -> PathFilter {
        let taps = short_filter_taps(self.rate_hz) + wavelet.pre_ringing_samples;
        if wavelet.response.len() > taps {
            wavelet.response.truncate(taps);
            minimum_phase::fade_out(&mut wavelet.response, &self.fade);
        }
        wavelet
    }

    /// Subtracts wavelets from a response. Shapes: (path, channel) and (channel, sample), flat.
    pub(crate) fn subtract_path_filters(&self, wavelets: &[Vec<PathFilter>], samples: &mut [f32]) {
        let Some(channels) = wavelets.first().map(Vec::len) else {
            return;
        };
        let length = samples.len() / channels.max(1);
        for path in wavelets {
            for (wavelet, out) in path.iter().zip(samples.chunks_exact_mut(length.max(1))) {
                let taps = FractionalDelay::new(wavelet.delay_s * self.rate_hz);
                taps.add(
                    out,
                    &wavelet.response,
                    wavelet.pre_ringing_samples,
                    -wavelet.amplitude,
                );
            }
        }
    }
}

/// The channels that receive paths, and the air.
struct PathRenderContext<'a> {
    channels: &'a [ReceiverChannel],
    /// True for paths that end at the channel itself rather than at the centre.
    at_channel: bool,
    air: Option<&'a UpperAirAbsorption>,
}

/// Returns the paths that are rendered one by one, the strongest first where there are too many.
pub(crate) fn strongest(paths: &[PropagationPath]) -> Vec<&PropagationPath> {
    let mut strongest: Vec<&PropagationPath> = paths.iter().collect();
    if strongest.len() > MOST_PATHS {
        let power = |path: &PropagationPath| path.energy.iter().sum::<f32>();
        strongest.sort_by(|a, b| power(b).total_cmp(&power(a)));
        strongest.truncate(MOST_PATHS);
    }
    strongest
}

/// The filter of one path at one channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct PathFilter {
    /// A short filter. Shape (tap,).
    pub(crate) response: Vec<f32>,
    /// Samples of it before the delay.
    pub(crate) pre_ringing_samples: usize,
    pub(crate) amplitude: f32,
    pub(crate) delay_s: f64,
}
