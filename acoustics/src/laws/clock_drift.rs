//! Recorders whose clock is fast or slow.

use super::microphone_stage::{MicrophoneStage, SampleBlock, StageState, fade_in, fade_in_weights};
use super::{AcousticLaw, SignalStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};
use std::sync::LazyLock;

pub(super) const LAW: AcousticLaw = AcousticLaw {
    info: LawInfo {
        id: "clock_drift",
        version: 1,
        name: "drift and offset of the recorder's clock",
        equation: "p_out(t) = p((t - offset_s) / (1 + 1e-6 drift_ppm)): all times come out (1 + 1e-6 drift_ppm) times as long, after \
                   offset_s (s); by a windowed sinc of 64 taps. In a stream, what was not yet made cannot be recorded: where the \
                   recording would be less than some 33 samples behind the world, it falls back by 10 ms, and where it is more than 1 s \
                   beyond the offset behind it, it catches up by 0.5 s, both crossfaded over 5 ms, as sound cards skip",
        source: "H. Gamper, Clock drift estimation and compensation for asynchronous impulse response measurements, HSCMA (2017)",
        engine: EngineKind::Acoustics,
        acts_on: "sensor",
        params: &[
            ParamInfo {
                name: "drift_ppm",
                unit: "1e-6",
                default: 0.0,
                low: -20_000.0,
                high: 20_000.0,
                plausible: [-200.0, 200.0],
            },
            ParamInfo {
                name: "offset_s",
                unit: "s",
                default: 0.0,
                low: 0.0,
                high: 1.0,
                plausible: [0.0, 0.1],
            },
        ],
        regimes: &[
            LawRegime::DirectSound,
            LawRegime::EarlySound,
            LawRegime::LateSound,
        ],
        probes: &[&[("drift_ppm", 100.0)]],
        rivals: &["temperature_error", "recording_delay", "room_scale"],
        separating_experiment: "measure the length or pitch of the excitation itself in the recording: a clock changes it as much as \
                                the arrivals, warmth leaves it; by size: one kelvin is 1700 ppm, clocks are off by 10 to 100 ppm",
    },
    effect: SignalStage::Microphones(install),
};

/// Taps on either side of a point between samples.
const HALF: usize = 32;
/// Tabulated points between two samples.
const PHASES: usize = 256;
/// Lag after a skip back where the recording would overtake the world, s.
const RESET_LAG_S: f64 = 0.01;
/// Largest lag beyond the offset, s.
const MAX_LAG_S: f64 = 1.0;
/// Part of that lag that one skip ahead removes, s.
const SKIP_S: f64 = 0.5;
/// Crossfade of a skip, s.
const FADE_S: f64 = 0.005;

/// Weights of the 64 samples around points between two samples. Shape (phase, tap).
static SINC: LazyLock<Vec<[f32; 2 * HALF]>> = LazyLock::new(|| {
    use std::f64::consts::{FRAC_PI_2, PI};
    let row = |phase: usize| {
        let fraction = phase as f64 / PHASES as f64;
        let weight = |k: usize| {
            let x = k as f64 + 1.0 - HALF as f64 - fraction;
            let window = libm::cos(FRAC_PI_2 * x / (HALF as f64 + 0.5));
            let sinc = if x.abs() < 1e-9 {
                1.0
            } else {
                libm::sin(PI * x) / (PI * x)
            };
            sinc * window * window
        };
        let weights: [f64; 2 * HALF] = std::array::from_fn(weight);
        let sum: f64 = weights.iter().sum();
        weights.map(|weight| (weight / sum) as f32)
    };
    (0..=PHASES).map(row).collect()
});

#[derive(Debug)]
struct DriftingClock {
    /// Growth of the lag in one sample.
    growth: f64,
    /// All below in samples.
    offset: f64,
    back: f64,
    most: f64,
    ahead: f64,
    fade: usize,
    /// Lag of the recording behind the world.
    lag: f64,
    /// Lag before it skipped.
    old_lag: f64,
    /// Remaining samples of its crossfade.
    fading: usize,
    /// The last samples heard, newest at the end. Shape (channel, any).
    history: Vec<Vec<f32>>,
}

fn install(values: LawValues<'_>, rate_hz: f64) -> Box<dyn MicrophoneStage> {
    let drift = 1e-6 * values.get("drift_ppm");
    let offset = values.get("offset_s") * rate_hz / (1.0 + drift);
    Box::new(DriftingClock {
        growth: drift / (1.0 + drift),
        offset,
        back: (RESET_LAG_S * rate_hz).max(3.0 * HALF as f64),
        most: offset + MAX_LAG_S * rate_hz,
        ahead: SKIP_S * rate_hz,
        fade: (FADE_S * rate_hz) as usize,
        lag: offset,
        old_lag: offset,
        fading: 0,
        history: Vec::new(),
    })
}

impl DriftingClock {
    /// Returns the lag of each sample of a block, that before a skip, and the weight of the new one.
    fn lags(&mut self, length: usize, whole: bool) -> Vec<(f64, f64, f32)> {
        let weights: Vec<f32> = fade_in_weights(self.fade).collect();
        // Lag needed until the end of a crossfade.
        let least = HALF as f64 + 1.0 + self.growth.abs() * self.fade as f64;
        let mut lags = Vec::with_capacity(length);
        // A skip before anything was heard needs no crossfade.
        let mut silent = self.history.is_empty();
        for _ in 0..length {
            if self.fading == 0 && !whole {
                let skip = if self.lag < least {
                    self.back
                } else if self.lag > self.most {
                    -self.ahead
                } else {
                    0.0
                };
                if skip != 0.0 {
                    self.old_lag = self.lag;
                    self.lag += skip;
                    self.fading = if silent { 0 } else { self.fade };
                }
            }
            silent = false;
            let weight = if self.fading > 0 {
                self.fading -= 1;
                weights[self.fade - 1 - self.fading]
            } else {
                1.0
            };
            lags.push((self.lag, self.old_lag, weight));
            self.lag += self.growth;
            self.old_lag += self.growth;
            if self.fading == 0 {
                // Nothing of it is heard any more.
                self.old_lag = self.lag;
            }
        }
        lags
    }
}

/// Returns the signal `lag` samples before sample `now`; zero outside.
fn read(samples: &[f32], now: usize, lag: f64) -> f32 {
    // By the lag alone, so that blocks give the bits of the whole.
    let back = lag.ceil();
    let phase = (back - lag) * PHASES as f64;
    let row = (phase as usize).min(PHASES - 1);
    let way = (phase - row as f64) as f32;
    let first = now as i64 - back as i64 + 1 - HALF as i64;
    let (low, high) = (
        first.max(0),
        (first + 2 * HALF as i64).min(samples.len() as i64),
    );
    if low >= high {
        return 0.0;
    }
    let taps = (low - first) as usize..(high - first) as usize;
    let samples = &samples[low as usize..high as usize];
    let rows = SINC[row][taps.clone()].iter().zip(&SINC[row + 1][taps]);
    let weights = rows.map(|(a, b)| a + (b - a) * way);
    weights.zip(samples).map(|(weight, x)| weight * x).sum()
}

impl MicrophoneStage for DriftingClock {
    fn process(&mut self, block: &mut SampleBlock<'_>) {
        let length = block.len();
        let lags = self.lags(length, block.is_entire_signal);
        self.history.resize_with(block.channels, Vec::new);
        // The longest look-back of a skip.
        let reach = self.lag.max(self.old_lag) + self.back + 2.0 * HALF as f64;
        let mut heard = Vec::new();
        for (history, channel) in self.history.iter_mut().zip(block.channels_mut()) {
            heard.clear();
            heard.extend_from_slice(history);
            heard.extend_from_slice(channel);
            let now = history.len();
            for (n, (y, (lag, old, weight))) in channel.iter_mut().zip(&lags).enumerate() {
                let at = |lag: f64| read(&heard, now + n, lag);
                *y = at(*lag);
                if *weight < 1.0 {
                    let before = at(*old);
                    *y = before + (*y - before) * weight;
                }
            }
            let kept = heard.len().min(reach.ceil() as usize);
            history.clear();
            history.extend_from_slice(&heard[heard.len() - kept..]);
        }
    }

    fn restore(&mut self, memory: &StageState) {
        let [lag, old_lag, fading, offset] = memory.numbers[..] else {
            return;
        };
        let later = self.offset - offset;
        self.lag = (lag + later).clamp(0.0, self.most + self.back);
        self.old_lag = (old_lag + later).clamp(0.0, self.most + self.back);
        self.fading = (fading as usize).min(self.fade);
        self.history.clone_from(&memory.samples);
        if later > 0.0 {
            // Older samples are unknown.
            for history in &mut self.history {
                let ramp = history.len().min(self.fade);
                fade_in(&mut history[..ramp]);
            }
        }
    }

    fn state(&self) -> StageState {
        StageState {
            numbers: vec![self.lag, self.old_lag, self.fading as f64, self.offset],
            samples: self.history.clone(),
        }
    }

    fn tail_samples(&self, length: usize) -> usize {
        // The lag at the end, less where the clock is slow.
        let at_the_end = self.offset + self.growth * length as f64 / (1.0 - self.growth);
        (at_the_end + HALF as f64).ceil().max(0.0) as usize
    }

    fn needs_fade_in(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{
        RATE_HZ, law, microphone_output, streamed_microphone_output, with_listener,
    };
    use crate::microphone_chain::MicrophoneChain;
    use crate::receiver::Receiver;
    use dwell_scene::random::RandomKey;

    fn clock(drift_ppm: f64, offset_s: f64) -> [dwell_scene::LawSpec; 1] {
        [law(
            "clock_drift",
            &[("drift_ppm", drift_ppm), ("offset_s", offset_s)],
        )]
    }

    fn tone(frequency_hz: f64, samples: usize) -> Vec<f32> {
        let omega = std::f64::consts::TAU * frequency_hz / RATE_HZ;
        (0..samples)
            .map(|k| (omega * k as f64).sin() as f32)
            .collect()
    }

    /// p((t - o) / (1 + e)) in closed form, within 2e-4 of the peak up to 0.8 of Nyquist's frequency.
    #[test]
    fn a_tone_is_read_at_its_times() {
        for (drift_ppm, offset_s) in [(0.0, 0.0101), (150.0, 0.0), (-150.0, 0.02), (4000.0, 0.3)] {
            for frequency_hz in [300.0, 2500.0, 6400.0] {
                let out =
                    microphone_output(&clock(drift_ppm, offset_s), 0, &tone(frequency_hz, 32_000));
                for n in (6000..31_000).step_by(101) {
                    let t = (n as f64 / RATE_HZ - offset_s) / (1.0 + 1e-6 * drift_ppm);
                    let wanted = (std::f64::consts::TAU * frequency_hz * t).sin();
                    assert!(
                        (f64::from(out[n]) - wanted).abs() < 2e-4,
                        "{drift_ppm} {frequency_hz} {n}"
                    );
                }
            }
        }
    }

    /// With a sufficient offset, the stream has the bits of the whole; without, it is 10 ms late where the future is unknown.
    #[test]
    fn streams_give_what_recordings_give() {
        let sound = tone(777.0, 40_000);
        for drift_ppm in [-300.0, 0.0, 300.0] {
            let whole = microphone_output(&clock(drift_ppm, 0.02), 0, &sound);
            for block in [33, 800] {
                let blocks = streamed_microphone_output(&clock(drift_ppm, 0.02), &sound, block);
                let differs = (0..39_000).find(|n| blocks[*n] != whole[*n]);
                assert_eq!(differs, None, "{drift_ppm} {block}");
            }
        }
        let late = streamed_microphone_output(&clock(300.0, 0.0), &sound, 800);
        let whole = microphone_output(&clock(300.0, 0.0), 0, &sound);
        for n in 1000..39_000 {
            assert!((late[n + 160] - whole[n]).abs() < 0.03);
        }
    }

    /// A snapshot holds what goes on, and nothing else: it comes back as it was, also after hours.
    #[test]
    fn what_it_remembers_comes_back_to_the_bit() {
        let sound = tone(300.0, 64 * 16_000);
        for drift_ppm in [-20_000.0, -1.0, 1.0, 20_000.0] {
            let mut microphones = MicrophoneChain::new(RATE_HZ);
            for (k, block) in sound.chunks(800).enumerate() {
                let (mut block, own) = (block.to_vec(), RandomKey::root(0).child(k as u64));
                with_listener(&Receiver::omni(glam::Vec3::ZERO), 0, own, |listener| {
                    microphones.process_block(&clock(drift_ppm, 0.0), listener, &mut block);
                });
                let memory = microphones.state();
                let again = MicrophoneChain::restore(RATE_HZ, memory.clone()).unwrap();
                assert!(again.state() == memory, "{drift_ppm}, block {k}");
            }
        }
    }

    /// A slow clock falls back, a fast one catches up, both without a step; memory stays bounded.
    #[test]
    fn skips_do_not_click() {
        let omega = std::f64::consts::TAU * 200.0 / RATE_HZ;
        for drift_ppm in [-20_000.0, 20_000.0] {
            let out =
                streamed_microphone_output(&clock(drift_ppm, 0.0), &tone(200.0, 64 * 16_000), 800);
            for (n, three) in out.windows(3).enumerate().skip(1000) {
                let [a, b, c] = [three[2], three[1], three[0]].map(f64::from);
                let residual = a - 2.0 * omega.cos() * b + c;
                assert!(residual.abs() < 5e-3, "{drift_ppm} {n}: {residual}");
            }
        }
    }
}
