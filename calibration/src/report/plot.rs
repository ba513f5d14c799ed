//! Residuals over time, thinned out.

use super::data::ResidualPlot;
use crate::experiment::Experiment;

/// Points of a picture.
const MOST_POINTS: usize = 1200;

type ResidualSeries<'a> = (&'a [usize], &'a [Vec<f64>]);

/// A picture for each channel.
pub(super) fn plots(
    experiment: &dyn Experiment,
    before: (&Vec<usize>, &Vec<Vec<f64>>),
    after: Option<ResidualSeries<'_>>,
) -> Vec<ResidualPlot> {
    let channels = experiment.channels().iter().enumerate();
    channels
        .map(|(channel, info)| ResidualPlot {
            title: info.name.clone(),
            unit: info.unit.clone(),
            before: points(experiment, (before.0, before.1), channel),
            after: after.map_or_else(Vec::new, |after| points(experiment, after, channel)),
            noise_sd: noise_sd(experiment, channel),
        })
        .collect()
}

fn points(
    experiment: &dyn Experiment,
    (set, residuals): ResidualSeries<'_>,
    channel: usize,
) -> Vec<[f64; 2]> {
    let mut all = Vec::new();
    for (episode, residual) in set.iter().zip(residuals) {
        let measured = &experiment.episodes()[*episode];
        let here = (0..residual.len()).filter(|k| measured.channel[*k] == channel);
        all.extend(here.map(|k| [measured.t_s[k], residual[k] * measured.sd[k]]));
    }
    let stride = all.len().div_ceil(MOST_POINTS).max(1);
    all.into_iter().step_by(stride).collect()
}

fn noise_sd(experiment: &dyn Experiment, channel: usize) -> f64 {
    let (mut square, mut count) = (0.0, 0.0_f64);
    for measured in experiment.episodes() {
        for (sd, _) in measured
            .sd
            .iter()
            .zip(&measured.channel)
            .filter(|(_, c)| **c == channel)
        {
            square += sd * sd;
            count += 1.0;
        }
    }
    (square / count.max(1.0)).sqrt()
}
