//! Search for the parameters of a contact model that predict some episodes best.

use super::StudyOptions;
use super::model::ContactModel;
use crate::error::CalibrationError;
use crate::fit::CmaEs;
use crate::progress::ProgressReporter;
use crate::rollout::{BoardRig, MeanDeviation, PoseTracks, scores};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;

/// Share of episodes, the best in each quantity, that the cost counts: one toss in eight lands on another face than
/// predicted, by chance rather than by parameters.
const TRIMMED_SHARE: f64 = 0.75;
/// Initial width of the search, as a share of the ranges, around the bundle's own values and the middles of the others.
const FIRST_SIGMA: f64 = 0.1;

/// ln of the mean squared distance plus ln of the mean squared angle, each over the best three quarters of the episodes:
/// the negative logarithm of the profile likelihood of two quantities whose sizes of error are unknown, so that neither
/// outweighs the other by its unit.
pub(super) fn cost(scores: &[MeanDeviation]) -> f64 {
    let trimmed = |f: fn(&MeanDeviation) -> f64| {
        let mut values: Vec<f64> = scores.iter().map(f).collect();
        values.sort_by(f64::total_cmp);
        let count = ((TRIMMED_SHARE * values.len() as f64).ceil() as usize).clamp(1, values.len());
        values[..count].iter().sum::<f64>() / count as f64
    };
    libm::log(trimmed(|s| s.position_square_m2).max(1e-18))
        + libm::log(trimmed(|s| s.rotation_square_rad2).max(1e-18))
}

/// Searches on the episodes `train`: first on a part of them, then on all. Chooses the better of the best among the last points and
/// their mean.
pub(super) fn search(
    model: &ContactModel,
    rig: &BoardRig,
    tracks: &PoseTracks,
    train: &[usize],
    options: &StudyOptions,
    key: RandomKey,
    progress: &dyn ProgressReporter,
) -> Result<Vec<f64>, CalibrationError> {
    let threads = Threads::resolve(options.threads);
    let starts = model.parameters.iter().map(|parameter| {
        let own = match parameter.name {
            "friction" => Some(tracks.board.friction),
            "restitution" => Some(tracks.board.restitution),
            _ => None,
        };
        own.map_or(0.5, |value| parameter.position_of(value))
    });
    let start: Vec<f64> = starts.collect();
    let mut cma = CmaEs::new(&start, FIRST_SIGMA, options.population, key.child("search"));
    let mut part = train.to_vec();
    key.child("part").stream().shuffle(&mut part);
    part.truncate(options.first_episodes.max(1));
    part.sort_unstable();
    let values = |place: &[f64]| -> Vec<f64> {
        let pairs = model.parameters.iter().zip(place);
        pairs
            .map(|(parameter, place)| parameter.value_at(*place))
            .collect()
    };
    let judge = |point: &[f64], which: &[usize]| {
        progress.check()?;
        let set = rig.with_settings(&model.settings(&values(point), &tracks.board))?;
        Ok::<f64, CalibrationError>(cost(&scores(&set, tracks, which, threads)?))
    };
    let [first, then] = options.generations;
    let last_on = if then > 0 { train } else { &part[..] };
    let mut best: Option<(f64, Vec<f64>)> = None;
    for generation in 0..first + then {
        let which = if generation < first { &part[..] } else { train };
        let points = cma.sample_population();
        let mut costs = Vec::with_capacity(points.len());
        for point in &points {
            let found = judge(point, which)?;
            let comparable = then == 0 || generation >= first;
            if comparable && best.as_ref().is_none_or(|(least, _)| found < *least) {
                best = Some((found, point.clone()));
            }
            costs.push(found);
        }
        cma.update(&points, &costs);
    }
    let mean = cma.mean();
    let of_mean = judge(&mean, last_on)?;
    Ok(match best {
        Some((least, point)) if least < of_mean => values(&point),
        _ => values(&mean),
    })
}
