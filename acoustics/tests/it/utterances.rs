//! Utterances as sound: levels, spectra, and whether tokens can be told apart.
//!
//! Levels are compared with those that ANSI S3.5-1997 states beside its tables, and with its table of third octaves; the
//! synthesizer has the table of octaves. Tokens are matched by spectrograms, which know nothing of syllables.

#![allow(clippy::unwrap_used, reason = "tests may stop at the first surprise")]

use dwell_acoustics::Spectrogram;
use dwell_acoustics::intelligibility::octave_levels_db;
use dwell_acoustics::utterance::{SpeakerVoice, VocalEffort, duration_s, utterance};
use dwell_scene::random::RandomKey;

/// Enough for the octave of 8 kHz, within 0.1 dB.
const RATE_HZ: u32 = 25_000;

/// Mean power in the octaves of 125 Hz to 8 kHz of utterances of random tokens of the vocabulary by one speaker, Pa² / (20 µPa)².
fn long_term_power(voice: &SpeakerVoice, effort: VocalEffort, utterances: u64) -> [f64; 7] {
    let mut sums = [0.0; 7];
    for k in 0..utterances {
        let key = RandomKey::root(7).child(k);
        let mut stream = key.child("tokens").stream();
        let tokens: Vec<u32> = (0..8).map(|_| stream.below(1243) as u32).collect();
        let sound = utterance(&tokens, voice, effort, RATE_HZ, key).unwrap();
        for (sum, db) in sums
            .iter_mut()
            .zip(octave_levels_db(&sound, RATE_HZ).unwrap())
        {
            *sum += 10_f64.powf(0.1 * db) / utterances as f64;
        }
    }
    sums
}

fn db(power: f64) -> f64 {
    10.0 * power.log10()
}

/// Levels of the octaves of 250 Hz to 4 kHz, sums of the standard's third octaves, and the overall level at 1 m, dB.
fn standard(effort: VocalEffort) -> ([f64; 5], f64) {
    // Spectrum levels from 200 Hz to 5 kHz.
    let (thirds, overall): ([f64; 15], f64) = match effort {
        VocalEffort::Normal => (
            [
                34.48, 34.75, 33.98, 34.59, 34.27, 32.06, 28.30, 25.01, 23.00, 20.15, 17.32, 13.18,
                11.55, 9.33, 5.31,
            ],
            62.35,
        ),
        VocalEffort::Raised => (
            [
                33.92, 38.98, 38.57, 39.11, 40.15, 38.78, 36.37, 33.86, 31.89, 28.58, 25.32, 22.35,
                20.15, 16.78, 11.47,
            ],
            68.34,
        ),
        VocalEffort::Loud => (
            [
                37.76, 41.55, 43.78, 43.40, 44.85, 45.55, 44.05, 42.16, 40.53, 37.70, 34.39, 30.98,
                28.21, 25.41, 18.35,
            ],
            74.85,
        ),
        _ => (
            [
                36.65, 42.50, 46.51, 47.40, 49.24, 51.21, 51.44, 51.31, 49.63, 47.65, 44.32, 40.80,
                38.13, 34.41, 28.24,
            ],
            82.30,
        ),
    };
    let mut octaves = [0.0; 5];
    for (k, level) in thirds.iter().enumerate() {
        let centre_hz = 1000.0 * 10_f64.powf(0.1 * (k as f64 - 7.0));
        let width_hz = centre_hz * (10_f64.powf(0.05) - 10_f64.powf(-0.05));
        octaves[k / 3] += 10_f64.powf(0.1 * level) * width_hz;
    }
    (octaves.map(db), overall)
}

/// The mean of an average man and an average woman has the standard's octaves within 2 dB, and each has its level within 1 dB.
#[test]
fn long_utterances_have_the_spectrum_of_the_standard() {
    let voices =
        [(132.0, 1.0), (223.0, 1.0 / 1.17)].map(|(pitch_hz, vocal_tract_scale)| SpeakerVoice {
            pitch_hz,
            vocal_tract_scale,
        });
    for effort in &VocalEffort::ALL[1..] {
        let powers = voices.map(|voice| long_term_power(&voice, *effort, 8));
        let (octaves_db, overall_db) = standard(*effort);
        for power in &powers {
            let level_db = db(power.iter().sum());
            assert!((level_db - overall_db).abs() < 1.0, "{effort:?} {level_db}");
        }
        let found = [0, 1, 2, 3, 4].map(|k| db(0.5 * (powers[0][k + 1] + powers[1][k + 1])));
        for (found, known) in found.iter().zip(octaves_db) {
            assert!((found - known).abs() < 2.0, "{effort:?} {found} {known}");
        }
    }
}

/// Drawn voices deviate in an octave by up to 5 dB, and have the level within 1 dB.
#[test]
fn drawn_voices_have_about_that_spectrum() {
    for seed in 0..5 {
        let voice = SpeakerVoice::draw(RandomKey::root(seed));
        for effort in [
            VocalEffort::Whisper,
            VocalEffort::Normal,
            VocalEffort::Shout,
        ] {
            let power = long_term_power(&voice, effort, 4);
            let level_db = db(power.iter().sum());
            assert!(
                (level_db - effort.level_db()).abs() < 1.5,
                "{effort:?} {level_db}"
            );
            for (k, level) in effort.octave_levels_db().iter().enumerate().skip(1) {
                let off = db(power[k]) - level;
                assert!(off.abs() < 5.0, "{voice:?} {effort:?} {k}: {off}");
            }
            // Nobody speaks below the octave of men's pitch.
            assert!(db(power[0]) < effort.octave_levels_db()[1] + 3.0);
        }
    }
}

#[test]
fn the_same_is_said_with_the_same_bits_and_the_start_does_not_know_the_end() {
    let voice = SpeakerVoice::draw(RandomKey::root(1));
    let tokens = [3, 1242, 77, 2500, 0];
    for effort in [VocalEffort::Whisper, VocalEffort::Raised] {
        let say = |tokens: &[u32], seed| {
            utterance(tokens, &voice, effort, 16_000, RandomKey::root(seed)).unwrap()
        };
        let whole = say(&tokens, 1);
        assert_eq!(whole, say(&tokens, 1));
        assert_ne!(whole, say(&tokens, 2));
        let start = say(&tokens[..3], 1);
        let known = (duration_s(&tokens[..3]).unwrap() * 16_000.0) as usize;
        assert_eq!(start[..known], whole[..known]);
        // The pause at the end is silent.
        assert!(whole[whole.len() - 700..].iter().all(|x| *x == 0.0));
    }
}

/// Centre of the power spectrum by octaves, in octaves above 125 Hz.
#[test]
fn a_smaller_vocal_tract_sounds_brighter() {
    let centre = |scale: f64, effort| {
        let voice = SpeakerVoice {
            pitch_hz: 150.0,
            vocal_tract_scale: scale,
        };
        let tokens = [12, 345, 678, 901, 234, 567, 890, 123];
        let sound = utterance(&tokens, &voice, effort, RATE_HZ, RandomKey::root(2)).unwrap();
        let levels = octave_levels_db(&sound, RATE_HZ).unwrap();
        let power = levels.map(|level| 10_f64.powf(0.1 * level));
        let moment: f64 = power
            .iter()
            .zip([125.0, 250.0, 500.0, 1e3, 2e3, 4e3, 8e3])
            .map(|(p, f)| p * f)
            .sum();
        moment / power.iter().sum::<f64>()
    };
    for effort in VocalEffort::ALL {
        let centres = [1.2, 1.0, 0.85, 0.7].map(|scale| centre(scale, effort));
        assert!(
            centres.is_sorted() && centres[3] > 1.1 * centres[0],
            "{effort:?} {centres:?}"
        );
    }
}

/// A spectrogram without its mean: level does not count.
fn features(sound: &[f32], spectrogram: &Spectrogram) -> Vec<f64> {
    let [rows, columns] = spectrogram.shape();
    let mut out = vec![0.0; rows * columns];
    spectrogram.write(sound, &mut out, 1);
    let mean = out.iter().map(|x| f64::from(*x)).sum::<f64>() / out.len() as f64;
    out.iter().map(|x| f64::from(*x) - mean).collect()
}

/// Tokens of one speaker are found among those of another by the nearest spectrogram: far more often than by chance, which is 1 of 60.
#[test]
fn tokens_can_be_told_apart_across_speakers() {
    let tokens: Vec<u32> = (0..60).map(|k| 20 * k).collect();
    let spectrogram = Spectrogram::new(16_000 * 43 / 100, 1e-4).unwrap();
    let say = |seed: u64, effort, token: u32| {
        let key = RandomKey::root(seed);
        let voice = SpeakerVoice::draw(key);
        let sound = utterance(
            &[token],
            &voice,
            effort,
            16_000,
            key.child(u64::from(token)),
        );
        features(&sound.unwrap(), &spectrogram)
    };
    for (effort, least) in [(VocalEffort::Normal, 0.6), (VocalEffort::Whisper, 0.6)] {
        // Six speakers, each matched with the next.
        let spoken: Vec<Vec<Vec<f64>>> = (20..26)
            .map(|seed| {
                tokens
                    .iter()
                    .map(|token| say(seed, effort, *token))
                    .collect()
            })
            .collect();
        let mut right = 0;
        for pair in spoken.windows(2) {
            for (k, one) in pair[0].iter().enumerate() {
                let distance = |other: &Vec<f64>| -> f64 {
                    one.iter().zip(other).map(|(a, b)| (a - b).powi(2)).sum()
                };
                let nearest = pair[1]
                    .iter()
                    .enumerate()
                    .min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
                right += usize::from(nearest.unwrap().0 == k);
            }
        }
        let share = right as f64 / (5.0 * 60.0);
        assert!(share > least, "{effort:?}: {share}");
    }
}
