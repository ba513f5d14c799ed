//! The syllables of a token: which consonants and vowels, and when.

use crate::signals::VOWELS_HZ;

/// Duration of one syllable of tokens with two and with three of them, s. People say four to seven a second.
const SYLLABLE_S: [f64; 2] = [0.19, 0.15];
/// Silence behind each token, s.
pub(super) const PAUSE_S: f64 = 0.05;
/// Duration of the rise and of the fall of consonants and vowels, s.
pub(super) const CONSONANT_EDGE_S: f64 = 0.008;
pub(super) const VOWEL_EDGE_S: f64 = 0.02;
/// The consonant's share of a syllable.
const CONSONANT_SHARE: f64 = 0.4;
/// Share of a plosive in which the mouth is closed.
const CLOSURE_SHARE: f64 = 0.5;

/// The number of different syllables.
const SYLLABLES: u32 = (CONSONANTS.len() * VOWELS_HZ.len()) as u32;
/// The number of sequences of two syllables.
const PAIRS: u32 = SYLLABLES * SYLLABLES;
/// The number of tokens with sounds of their own: all sequences of two and of three syllables.
pub const MAX_VOCABULARY: u32 = PAIRS + SYLLABLES * PAIRS;
/// Factor by which tokens are spread over the sequences, coprime to their number: neighbours have no syllable in common.
const SPREAD: u32 = 1109;

/// The sound of a consonant before the vowel begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ConsonantSound {
    /// Turbulence at a constriction.
    Turbulence {
        /// Centre and width of its resonance, Hz.
        resonance_hz: (f64, f64),
        /// Root mean square over an amplitude of 1 of the vowel's strongest harmonic.
        level: f64,
        /// True after a closure of the mouth: a burst.
        is_plosive: bool,
    },
    /// Voice through the nose or a narrowed tract with these formants, Hz, and this amplitude over the vowel's.
    Sonorant([f64; 3], f64),
}

/// A consonant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Consonant {
    pub(super) sound: ConsonantSound,
    /// Formants at which the vowel after it begins, Hz.
    pub(super) locus_hz: [f64; 3],
}

const fn turbulent(resonance_hz: (f64, f64), level: f64, locus_hz: [f64; 3]) -> Consonant {
    let sound = ConsonantSound::Turbulence {
        resonance_hz,
        level,
        is_plosive: false,
    };
    Consonant { sound, locus_hz }
}

const fn plosive(resonance_hz: (f64, f64), level: f64, locus_hz: [f64; 3]) -> Consonant {
    let sound = ConsonantSound::Turbulence {
        resonance_hz,
        level,
        is_plosive: true,
    };
    Consonant { sound, locus_hz }
}

const fn sonorant(formants_hz: [f64; 3], level: f64, locus_hz: [f64; 3]) -> Consonant {
    let sound = ConsonantSound::Sonorant(formants_hz, level);
    Consonant { sound, locus_hz }
}

/// Ten consonants of a man, near p, t, k, f, s, sh, m, n, l, r.
///
/// # Source
/// Rounded by us after K. N. Stevens, *Acoustic Phonetics* (1998), chapters 7 to 9; second formants of loci: P. C. Delattre, A. M. Liberman,
/// F. S. Cooper, JASA 27, 769 (1955). They sound like speech, not like a person.
pub(super) const CONSONANTS: [Consonant; 10] = [
    plosive((800.0, 1000.0), 0.20, [300.0, 720.0, 2200.0]),
    plosive((4200.0, 2500.0), 0.25, [300.0, 1800.0, 2700.0]),
    plosive((1900.0, 800.0), 0.25, [300.0, 2300.0, 2700.0]),
    turbulent((3500.0, 9000.0), 0.05, [300.0, 900.0, 2300.0]),
    turbulent((6500.0, 2500.0), 0.15, [300.0, 1700.0, 2600.0]),
    turbulent((3000.0, 1500.0), 0.20, [300.0, 2000.0, 2500.0]),
    sonorant([250.0, 1000.0, 2200.0], 0.4, [300.0, 800.0, 2200.0]),
    sonorant([250.0, 1500.0, 2600.0], 0.4, [300.0, 1800.0, 2600.0]),
    sonorant([360.0, 1150.0, 2700.0], 0.6, [360.0, 1150.0, 2700.0]),
    sonorant([330.0, 1150.0, 1500.0], 0.6, [330.0, 1150.0, 1500.0]),
];

/// A consonant and a vowel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Syllable {
    pub(super) consonant: &'static Consonant,
    /// Formants of the vowel, Hz.
    pub(super) vowel_hz: &'static [f64; 3],
    pub(super) duration_s: f64,
}

impl Syllable {
    /// The syllable of a number below [`SYLLABLES`].
    fn new(number: u32, duration_s: f64) -> Self {
        let number = number as usize;
        Self {
            consonant: &CONSONANTS[number / VOWELS_HZ.len()],
            vowel_hz: &VOWELS_HZ[number % VOWELS_HZ.len()],
            duration_s,
        }
    }

    /// Returns start and duration of the consonant's sound within the syllable, s.
    pub(super) fn consonant_span_s(&self) -> (f64, f64) {
        let all_s = CONSONANT_SHARE * self.duration_s;
        match self.consonant.sound {
            ConsonantSound::Turbulence {
                is_plosive: true, ..
            } => (CLOSURE_SHARE * all_s, (1.0 - CLOSURE_SHARE) * all_s),
            _ => (0.0, all_s),
        }
    }

    /// Returns start and duration of the vowel within the syllable, s: it begins while the consonant fades.
    pub(super) fn vowel_span_s(&self) -> (f64, f64) {
        let start_s = CONSONANT_SHARE * self.duration_s - 0.01;
        (start_s, self.duration_s - start_s)
    }
}

/// Returns the two or three syllables of a token below [`MAX_VOCABULARY`]: always the same, and no other token's.
pub(super) fn syllables(token: u32) -> Vec<Syllable> {
    let (mut code, count) = match token.checked_sub(PAIRS) {
        // No overflow: PAIRS * SPREAD is below 3 million, and the longer sequences need 64 bits.
        None => (token * SPREAD % PAIRS, 2),
        Some(token) => {
            let sequences = u64::from(SYLLABLES * PAIRS);
            let spread = u64::from(token) * u64::from(SPREAD) % sequences;
            (spread as u32, 3)
        }
    };
    let digits = (0..count).map(|_| {
        let digit = code % SYLLABLES;
        code /= SYLLABLES;
        Syllable::new(digit, SYLLABLE_S[count - 2])
    });
    digits.collect()
}

/// Returns the duration of a token with the pause behind it, s.
pub(super) fn token_duration_s(token: u32) -> f64 {
    let syllables = syllables(token);
    PAUSE_S + syllables.iter().map(|s| s.duration_s).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_token_has_syllables_of_its_own() {
        let name = |token: u32| -> Vec<String> {
            let of = |s: &Syllable| format!("{:?}{:?}", s.consonant.locus_hz, s.vowel_hz);
            syllables(token).iter().map(of).collect()
        };
        let tokens = (0..PAIRS + 20_000).chain(MAX_VOCABULARY - 100..MAX_VOCABULARY);
        let all: Vec<Vec<String>> = tokens.map(name).collect();
        assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len());
        assert!(all.iter().all(|token| token.len() == 2 || token.len() == 3));
        // Neighbours share no syllable at the same place.
        for pair in all[..2500].windows(2) {
            assert!(pair[0].iter().zip(&pair[1]).all(|(a, b)| a != b));
        }
    }

    #[test]
    fn a_token_lasts_for_three_to_five_tenths_of_a_second() {
        for token in [0, 1, 1242, PAIRS - 1, PAIRS, MAX_VOCABULARY - 1] {
            let duration_s = token_duration_s(token);
            assert!(
                (0.3..=0.5 + 1e-9).contains(&duration_s),
                "{token} {duration_s}"
            );
            for syllable in syllables(token) {
                let (start_s, long_s) = syllable.vowel_span_s();
                assert!((start_s + long_s - syllable.duration_s).abs() < 1e-12);
                let (start_s, long_s) = syllable.consonant_span_s();
                assert!(start_s + long_s < syllable.duration_s && long_s > 0.02);
            }
        }
    }
}
