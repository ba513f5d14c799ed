//! Utterances: tokens of a vocabulary as speech-like sound, with a voice and a vocal effort.
//!
//! A token is the number of a word. Each has two or three syllables of its own, of a consonant and a vowel: always the same,
//! whoever speaks; pitch and formants are the speaker's. Nobody can read words out of that sound that a person would
//! understand, but different tokens sound different, it has the spectrum, the level and the rhythm of speech, it is heard, located
//! and masked like any sound, and a network can learn to tell its tokens apart.
//!
//! **Level.** Pressures are in Pa at 1 m ahead of the mouth. Over a long time, pauses between tokens included, a voice has the level of its
//! [`VocalEffort`], and the mean of an average man and an average woman has its octaves from 250 Hz to 8 kHz (ANSI
//! S3.5-1997). One drawn voice deviates in an octave by up to some 4 dB, since its pitch and its vocal tract are its own, and one token by more.
//!
//! **Synthesis.** Vowels and sonorants are harmonics of the pitch below the formants of the tract, which glide from the consonant's
//! locus to the vowel; turbulence and whispers are noise that passes the same formants (source and filter: G. Fant, *Acoustic Theory of
//! Speech Production*, 1960). A fixed equalizer of each effort stands for the spectrum of larynx, turbulence and lips.

mod render;
mod speaker_voice;
mod spectrum;
mod syllables;
mod vocal_effort;

pub use speaker_voice::SpeakerVoice;
pub use syllables::MAX_VOCABULARY;
pub use vocal_effort::{SPEECH_BAND_COUNT, SPEECH_CENTRES_HZ, VocalEffort};

use crate::error::{AcousticsError, check_range};
use dwell_scene::random::RandomKey;

/// Most tokens of an utterance.
pub const MAX_TOKENS: usize = 8;

/// Refuses what is no utterance in a vocabulary of `vocabulary_size` words.
pub(crate) fn check_tokens(tokens: &[u32], vocabulary_size: u32) -> Result<(), AcousticsError> {
    const AT: &str = "utterance";
    let (size, count) = (f64::from(vocabulary_size), tokens.len() as f64);
    let sizes = (1.0, f64::from(MAX_VOCABULARY));
    check_range(AT, "vocabulary_size", size, sizes, "1 to 127,500")?;
    check_range(
        AT,
        "number of tokens",
        count,
        (1.0, MAX_TOKENS as f64),
        "1 to 8",
    )?;
    for token in tokens {
        let (token, last) = (f64::from(*token), size - 1.0);
        check_range(
            AT,
            "token",
            token,
            (0.0, last),
            "below the vocabulary's size",
        )?;
    }
    Ok(())
}

/// Returns the duration of an utterance, s: 0.43 s or 0.50 s for each token, with 0.05 s of silence at its end.
///
/// # Errors
/// [`AcousticsError::Range`]: 1 to [`MAX_TOKENS`] tokens below [`MAX_VOCABULARY`].
pub fn duration_s(tokens: &[u32]) -> Result<f64, AcousticsError> {
    check_tokens(tokens, MAX_VOCABULARY)?;
    Ok(tokens.iter().map(|t| syllables::token_duration_s(*t)).sum())
}

/// Returns the sound of an utterance: pressure at 1 m ahead of the mouth, Pa. Shape ([`duration_s`] * `rate_hz`, rounded up,).
///
/// `key` gives the noise of turbulence and the small variations of pitch: no two utterances of a speaker are equal to the last bit. The
/// sound of the first tokens does not depend on those that follow. What lies above 0.45 of the rate is left out.
///
/// # Errors
/// [`AcousticsError::Range`]: 1 to [`MAX_TOKENS`] tokens below [`MAX_VOCABULARY`]; a voice in the ranges of [`SpeakerVoice`];
/// `rate_hz` 1,000 to 192,000.
///
/// # Determinism
/// Equal arguments give equal bits, on any number of threads.
pub fn utterance(
    tokens: &[u32],
    voice: &SpeakerVoice,
    effort: VocalEffort,
    rate_hz: u32,
    key: RandomKey,
) -> Result<Vec<f32>, AcousticsError> {
    check_tokens(tokens, MAX_VOCABULARY)?;
    voice.check()?;
    crate::signals::check_rate(rate_hz)?;
    Ok(render::render(tokens, voice, effort, rate_hz, key))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_utterance_is_refused_with_what_is_allowed() {
        let man = SpeakerVoice::AVERAGE[0];
        let say = |tokens: &[u32], rate_hz| {
            utterance(
                tokens,
                &man,
                VocalEffort::Normal,
                rate_hz,
                RandomKey::root(0),
            )
        };
        for (tokens, told) in [
            (&[][..], "number of tokens is 0; allowed are 1 to 8"),
            (&[0; 9], "number of tokens is 9; allowed are 1 to 8"),
            (&[0, MAX_VOCABULARY], "token is 127500; allowed are below"),
        ] {
            let message = say(tokens, 16_000).unwrap_err().to_string();
            assert!(message.contains(told), "{message}");
            assert!(duration_s(tokens).is_err());
        }
        assert!(say(&[0], 10).is_err() && say(&[0], u32::MAX).is_err());
        let nobody = SpeakerVoice {
            pitch_hz: f64::NAN,
            ..man
        };
        let key = RandomKey::root(0);
        assert!(utterance(&[0], &nobody, VocalEffort::Loud, 16_000, key).is_err());
        assert_eq!(MAX_VOCABULARY, 127_500);
    }

    #[test]
    fn any_rate_gives_finite_sound_of_the_told_length() {
        let tokens = [MAX_VOCABULARY - 1, 0, 1242];
        let voice = SpeakerVoice::draw(RandomKey::root(4));
        for rate_hz in [1_000, 8_000, 44_100, 192_000] {
            for effort in [VocalEffort::Whisper, VocalEffort::Shout] {
                let sound =
                    utterance(&tokens, &voice, effort, rate_hz, RandomKey::root(1)).unwrap();
                let length = duration_s(&tokens).unwrap() * f64::from(rate_hz);
                assert_eq!(sound.len(), length.ceil() as usize);
                assert!(sound.iter().all(|x| x.is_finite() && x.abs() < 10.0));
                assert!(sound.iter().any(|x| x.abs() > 1e-6));
            }
        }
    }
}
