//! Mean, median and spread over episodes.

use super::score::MeanDeviation;
use crate::median::median;
use serde::Serialize;

/// Statistics over episodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct EpisodeStatistics {
    /// Mean.
    pub mean: f64,
    /// Median.
    pub median: f64,
    /// Standard deviation (over n - 1).
    pub sd: f64,
}

impl EpisodeStatistics {
    /// The statistics of some values.
    pub fn of(values: &[f64]) -> Self {
        let count = values.len().max(1) as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        Self {
            mean,
            median: median(&mut values.to_vec()),
            sd: (squares / (count - 1.0).max(1.0)).sqrt(),
        }
    }
}

/// The `e_q` below which a toss counts as predicted.
const PREDICTED_E_Q: f64 = 0.05;

/// Scores of many episodes in one row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ScoreSummary {
    /// Number of episodes.
    pub count: usize,
    /// Distance, as a share of the body's width.
    pub position_widths: EpisodeStatistics,
    /// Angle, degrees.
    pub rotation_deg: EpisodeStatistics,
    /// The published loss.
    pub e_q: EpisodeStatistics,
    /// The share of episodes with an `e_q` below 0.05.
    pub predicted_share: f64,
}

impl ScoreSummary {
    /// The summary of some scores.
    pub fn of(scores: &[MeanDeviation]) -> Self {
        let column = |f: fn(&MeanDeviation) -> f64| scores.iter().map(f).collect::<Vec<f64>>();
        let predicted = scores.iter().filter(|score| score.e_q < PREDICTED_E_Q);
        Self {
            count: scores.len(),
            position_widths: EpisodeStatistics::of(&column(|s| s.position_widths)),
            rotation_deg: EpisodeStatistics::of(&column(|s| s.rotation_deg)),
            e_q: EpisodeStatistics::of(&column(|s| s.e_q)),
            predicted_share: predicted.count() as f64 / scores.len().max(1) as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spread_is_that_of_the_books() {
        let spread = EpisodeStatistics::of(&[2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]);
        assert_eq!(spread.mean, 5.0);
        assert!((spread.sd - (32.0_f64 / 7.0).sqrt()).abs() < 1e-15);
    }
}
