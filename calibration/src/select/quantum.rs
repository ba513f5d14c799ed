//! The step of measured numbers that are counts: their noise is never below what rounding to counts makes.

use crate::experiment::Experiment;
use std::collections::BTreeMap;

/// Share of the numbers of a channel that may differ from all others where they are counts.
const MOST_DISTINCT_SHARE: f64 = 0.5;
/// Numbers from which on equal ones say something.
const FEWEST: usize = 50;
/// Differences below this share of the largest number are rounding of single precision.
const SAME_SHARE: f64 = 1e-6;

/// The standard deviation of rounding in each channel whose numbers are counts.
///
/// # Source
/// Errors of rounding to steps q are uniform, with standard deviation q / sqrt(12): B. Widrow, I. Kollar, Quantization Noise
/// (2008), chapter 1.
pub(super) fn rounding_sd(experiment: &dyn Experiment) -> BTreeMap<usize, f64> {
    let mut values: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for episode in experiment.episodes() {
        for (value, channel) in episode.measured.iter().zip(&episode.channel) {
            values.entry(*channel).or_default().push(*value);
        }
    }
    let steps = values
        .into_iter()
        .filter_map(|(channel, mut values)| Some((channel, step(&mut values)? / 12.0_f64.sqrt())));
    steps.collect()
}

/// The step of counts; `None` where most numbers differ from all others.
fn step(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let most = values.first()?.abs().max(values.last()?.abs());
    let gaps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let gaps: Vec<f64> = gaps.filter(|gap| *gap > SAME_SHARE * most).collect();
    let is_counted =
        values.len() >= FEWEST && (gaps.len() as f64) < MOST_DISTINCT_SHARE * values.len() as f64;
    let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    (is_counted && least.is_finite()).then_some(least)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;

    #[test]
    fn counts_have_a_step_and_other_numbers_none() {
        let mut stream = RandomKey::root(2).stream();
        let mut smooth: Vec<f64> = (0..400).map(|_| stream.normal()).collect();
        let mut counted: Vec<f64> = smooth
            .iter()
            .map(|value| (value * 20.0).round() * 0.0015 + 0.7)
            .collect();
        assert!((step(&mut counted).unwrap() / 0.0015 - 1.0).abs() < 1e-6);
        assert_eq!(step(&mut smooth), None);
        assert_eq!(step(&mut [1.0; 400]), None);
    }
}
