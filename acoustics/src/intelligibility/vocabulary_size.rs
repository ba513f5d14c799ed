//! The choice among many words: how recognition depends on their number.

use std::f64::consts::{PI, SQRT_2};

/// Steps of the integral over the evidence for the right word, in standard deviations: 10 around the mean.
const STEP: f64 = 0.1;
const STEPS: i32 = 60;
/// Largest separation that is looked for, in standard deviations.
const LARGEST: f64 = 14.0;
/// Halvings that find it to 1e-8.
const HALVINGS: usize = 30;

/// Returns the probability that the evidence for the right word exceeds that for all others: the integral of
/// phi(x - separation) Phi(x)^(alternatives - 1) dx.
fn right_choice(separation: f64, alternatives: f64) -> f64 {
    let term = |k: i32| {
        let z = STEP * f64::from(k);
        let density = libm::exp(-0.5 * z * z) / (2.0 * PI).sqrt();
        let below = 0.5 * libm::erfc(-(z + separation) / SQRT_2);
        density * libm::pow(below, alternatives - 1.0) * STEP
    };
    (-STEPS..=STEPS).map(term).sum::<f64>().clamp(0.0, 1.0)
}

/// Returns the same less lucky guesses: 0 where there is no evidence, 1 where there is no error.
fn recognized(separation: f64, alternatives: f64) -> f64 {
    let guess = 1.0 / alternatives;
    ((right_choice(separation, alternatives) - guess) / (1.0 - guess)).clamp(0.0, 1.0)
}

/// Returns the score among `alternatives` words, 2 or more, of who has the score `score` among `reference` words, both less lucky guesses.
///
/// Every word that is said gives evidence for itself, and less for each of the others, which differs at random; the largest is chosen. The
/// separation of the two in standard deviations does not depend on the number of words.
///
/// # Source
/// D. M. Green, T. G. Birdsall, "The effect of vocabulary size on articulation score", Univ. Michigan, Technical Report 81 (1958), after G. A. Miller,
/// G. A. Heise, W. Lichten, J. Exp. Psychol. 41, 329 (1951).
pub(super) fn score_for_set_size(alternatives: f64, score: f64, reference: f64) -> f64 {
    if score <= 0.0 || score >= 1.0 {
        return score.clamp(0.0, 1.0);
    }
    let (mut low, mut high) = (0.0, LARGEST);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if recognized(middle, reference) < score {
            low = middle;
        } else {
            high = middle;
        }
    }
    recognized(0.5 * (low + high), alternatives)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;

    /// Two alternatives: Phi(d / sqrt(2)). Many: the frequency of 40,000 trials, within 5 standard errors.
    #[test]
    fn the_right_one_is_chosen_as_often_as_in_trials() {
        for separation in [0.0, 0.5, 1.0, 2.0, 4.0] {
            let known = 0.5 * libm::erfc(-0.5 * separation);
            assert!((right_choice(separation, 2.0) - known).abs() < 1e-6);
        }
        let mut stream = RandomKey::root(8).stream();
        for (separation, alternatives) in [(1.0, 8), (2.0, 32)] {
            let trials = 40_000;
            let right = (0..trials).filter(|_| {
                let best = (1..alternatives).fold(f64::MIN, |best, _| best.max(stream.normal()));
                stream.normal() + separation > best
            });
            let frequency = right.count() as f64 / f64::from(trials);
            let known = right_choice(separation, f64::from(alternatives));
            let error = (known * (1.0 - known) / f64::from(trials)).sqrt();
            assert!(
                (frequency - known).abs() < 5.0 * error,
                "{frequency} {known}"
            );
        }
    }

    #[test]
    fn fewer_words_are_easier() {
        for score in [0.001, 0.1, 0.5, 0.9, 0.999] {
            assert!((score_for_set_size(1000.0, score, 1000.0) - score).abs() < 1e-4);
            let scores = [2.0, 4.0, 32.0, 256.0, 1000.0, 10_000.0]
                .map(|alternatives| score_for_set_size(alternatives, score, 1000.0));
            assert!(scores.is_sorted_by(|a, b| a > b), "{scores:?}");
        }
        assert_eq!(score_for_set_size(2.0, 0.0, 1000.0), 0.0);
        assert_eq!(score_for_set_size(5.0, 1.0, 1000.0), 1.0);
    }
}
