//! From the index to words: which tokens a listener recognizes.

use super::vocabulary_size::score_for_set_size;
use crate::error::{AcousticsError, check_range};
use crate::utterance::{MAX_VOCABULARY, check_tokens};
use dwell_scene::random::RandomKey;

/// Speech transmission index at and below which nothing is recognized: speech is not even detected as such.
const THRESHOLD_STI: f64 = 0.1;
/// Scale and power of the score above it.
const SCALE_STI: f64 = 0.41;
const POWER: f64 = 1.36;
/// The number of words of the tests that the score is fitted to (J. P. Egan, Laryngoscope 58, 955, 1948: 20 lists of 50).
const TEST_WORDS: f64 = 1000.0;

/// Returns the share of meaningful single words, out of about a thousand, that is understood at a speech transmission index: 0 at 0.1 and
/// below, 0.97 at 0.75; 0 for NaN.
///
/// (1 - 10^(-(STI - 0.1) / 0.41))^1.36, a curve of H. Fletcher and R. H. Galt's form (JASA 22, 89, 1950) whose three constants were fitted by us.
///
/// # Source
/// ISO 9921:2003, table F.1, as H. J. M. Steeneken's lecture on the standard has it: phonetically balanced words have 60, 80, 93 and 98 % at 0.30, 0.45,
/// 0.60 and 0.75; the curve has 0.59, 0.81, 0.92 and 0.96 there. That nothing is recognized below 0.1 is our choice: tables end at 0.3.
pub fn word_score(sti: f64) -> f64 {
    if sti.is_nan() || sti <= THRESHOLD_STI {
        return 0.0;
    }
    let above = sti.min(1.0) - THRESHOLD_STI;
    libm::pow(1.0 - libm::pow(10.0, -above / SCALE_STI), POWER)
}

/// Returns the probability that a listener recognizes a token of a vocabulary of `vocabulary_size` words that are all expected alike.
///
/// It is [`word_score`] for a thousand words; fewer are easier and more are harder, by the model of choice among
/// signals of equal evidence in normal noise (Green and Birdsall 1958). Lucky guesses do not count: it is 0 at an STI of 0.1 and below, for any number.
///
/// # Errors
/// [`AcousticsError::Range`]: `sti` 0 to 1; `vocabulary_size` 1 to [`MAX_VOCABULARY`]. A vocabulary of one counts as one of two.
pub fn token_recognition_probability(
    sti: f64,
    vocabulary_size: u32,
) -> Result<f64, AcousticsError> {
    const AT: &str = "recognition";
    check_range(AT, "sti", sti, (0.0, 1.0), "0 to 1")?;
    let (size, most) = (f64::from(vocabulary_size), f64::from(MAX_VOCABULARY));
    check_range(AT, "vocabulary_size", size, (1.0, most), "1 to 127,500")?;
    Ok(score_for_set_size(
        size.max(2.0),
        word_score(sti),
        TEST_WORDS,
    ))
}

/// Draws what a listener hears of an utterance: each token independently right, another one (a confusion), or `None` (lost). Shape (token,).
///
/// With `probability` p of recognition, a token is right with p, confused with p (1 - p) and lost with (1 - p)²: who recognizes
/// little also notices little. So all are lost at 0, and most errors are confusions near 1. The split is an assumption of ours:
/// listeners in open tests answer the less often the less they hear, and no table of that was found. A confusion is one of the other words,
/// all alike.
///
/// # Errors
/// [`AcousticsError::Range`]: `probability` 0 to 1; 1 to 8 tokens below `vocabulary_size`, which is 1 to [`MAX_VOCABULARY`].
///
/// # Determinism
/// The answer depends on the arguments alone; what is heard of a token, on its place and not on the other tokens.
pub fn hear_tokens(
    tokens: &[u32],
    probability: f64,
    vocabulary_size: u32,
    key: RandomKey,
) -> Result<Vec<Option<u32>>, AcousticsError> {
    check_range(
        "recognition",
        "probability",
        probability,
        (0.0, 1.0),
        "0 to 1",
    )?;
    check_tokens(tokens, vocabulary_size)?;
    let heard = tokens.iter().enumerate().map(|(place, token)| {
        let mut stream = key.child("token").child(place as u64).stream();
        if stream.uniform() < probability {
            return Some(*token);
        }
        let is_noticed = stream.uniform() < probability;
        let other = stream.below(vocabulary_size as usize - 1) as u32;
        // Numbers from the token on stand for the next ones.
        let confused = if other >= *token { other + 1 } else { other };
        (is_noticed && vocabulary_size > 1).then_some(confused)
    });
    Ok(heard.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The limits of classes of ISO 9921, table F.1.
    #[test]
    fn words_are_understood_as_tests_say() {
        for (sti, share) in [(0.30, 0.60), (0.45, 0.80), (0.60, 0.93), (0.75, 0.98)] {
            let found = word_score(sti);
            assert!((found - share).abs() < 0.02, "{sti}: {found}");
            let among = token_recognition_probability(sti, 1243).unwrap();
            // Some more words than in the test: up to 0.02 less.
            assert!(among < found && among > found - 0.03, "{sti}: {among}");
        }
        for sti in [0.0, 0.05, 0.1] {
            assert_eq!(token_recognition_probability(sti, 1243).unwrap(), 0.0);
            assert_eq!(token_recognition_probability(sti, 2).unwrap(), 0.0);
        }
        assert!(token_recognition_probability(1.0, 1243).unwrap() > 0.98);
        assert_eq!(word_score(f64::NAN), 0.0);
    }

    #[test]
    fn recognition_grows_with_the_index_and_falls_with_the_vocabulary() {
        for size in [1, 2, 50, 1243, MAX_VOCABULARY] {
            let of = |k: u32| token_recognition_probability(f64::from(k) / 100.0, size).unwrap();
            let all: Vec<f64> = (0..=100).map(of).collect();
            assert!(all.is_sorted() && all[12] > 0.0, "{size} {all:?}");
            // A hundred times as many words as in the test are harder even in quiet.
            let least = if size == MAX_VOCABULARY { 0.85 } else { 0.98 };
            assert!(all[100] > least, "{size} {}", all[100]);
            // Among many words there is no step; of a few, one is recognized soon above the threshold.
            let steepest = all.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
            assert!(size < 1000 || steepest < 0.06, "{size}: {steepest}");
        }
        let at = |size| token_recognition_probability(0.3, size).unwrap();
        assert!(at(10) > at(100) && at(100) > at(1243) && at(1243) > at(100_000));
    }

    /// 16,000 tokens: the shares are those told within 5 standard errors (two-sided p below 1e-6 each).
    #[test]
    fn tokens_are_right_confused_and_lost_as_often_as_told() {
        let (size, tokens) = (50, [0, 7, 49, 7, 12, 30, 31, 48]);
        for p in [0.0, 0.2, 0.6, 0.95, 1.0] {
            let [mut right, mut confused, mut lost] = [0_u32; 3];
            let mut others = [0_u32; 50];
            for k in 0..2000 {
                let key = RandomKey::root(1).child(k);
                let heard = hear_tokens(&tokens, p, size, key).unwrap();
                assert_eq!(heard.len(), tokens.len());
                for (said, heard) in tokens.iter().zip(heard) {
                    match heard {
                        None => lost += 1,
                        Some(heard) if heard == *said => right += 1,
                        Some(heard) => {
                            confused += 1;
                            others[heard as usize] += 1;
                        }
                    }
                }
            }
            for (count, share) in [
                (right, p),
                (confused, p * (1.0 - p)),
                (lost, (1.0 - p) * (1.0 - p)),
            ] {
                let error = (share * (1.0 - share) * 16_000.0).sqrt();
                let off = (f64::from(count) - 16_000.0 * share).abs();
                assert!(off <= 5.0 * error, "{p}: {count} {share}");
            }
            // Every word comes up in 3,000 confusions.
            assert!(!(0.1..0.9).contains(&p) || others.iter().all(|count| *count > 20));
        }
    }

    #[test]
    fn what_is_heard_depends_on_the_place_alone() {
        let key = RandomKey::root(3);
        let hear = |tokens: &[u32]| hear_tokens(tokens, 0.5, 100, key).unwrap();
        let all = hear(&[5, 5, 5, 5, 5, 5, 5, 5]);
        assert_eq!(all, hear(&[5; 8]));
        assert_eq!(all[..3], hear(&[5; 3]));
        // The same draws: a larger probability never loses what was right.
        let better = hear_tokens(&[5; 8], 0.8, 100, key).unwrap();
        for (a, b) in all.iter().zip(better) {
            assert!(*a != Some(5) || b == Some(5));
        }
        // The only word cannot be taken for another.
        let only = hear_tokens(&[0; 8], 0.5, 1, key).unwrap();
        assert!(
            only.iter()
                .all(|heard| heard.is_none_or(|token| token == 0))
        );
    }

    #[test]
    fn what_is_no_utterance_is_refused() {
        let key = RandomKey::root(0);
        for (tokens, p, size) in [
            (&[][..], 0.5, 10),
            (&[0; 9], 0.5, 10),
            (&[10], 0.5, 10),
            (&[0], f64::NAN, 10),
            (&[0], 1.1, 10),
            (&[0], 0.5, 0),
            (&[0], 0.5, u32::MAX),
        ] {
            assert!(hear_tokens(tokens, p, size, key).is_err());
        }
        assert!(token_recognition_probability(f64::NAN, 10).is_err());
        assert!(token_recognition_probability(0.5, 0).is_err());
        assert!(token_recognition_probability(-0.1, 10).is_err());
    }
}
