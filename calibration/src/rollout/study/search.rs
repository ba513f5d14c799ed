//! The parameters of a contact model that predict some episodes best.

use super::StudyOptions;
use super::model::ContactModel;
use crate::error::CalibrationError;
use crate::fit::CmaEs;
use crate::progress::Tell;
use crate::rollout::{Rig, Score, Tracks, scores};
use dwell_scene::parallel::Threads;
use dwell_scene::random::Key;

/// The share of episodes, the best in each quantity, that the cost looks at: one toss in eight lands on another face than
/// predicted, by chance rather than by parameters.
const TRIMMED_SHARE: f64 = 0.75;
/// Where the search starts is the middle of the ranges, and this wide.
const FIRST_SIGMA: f64 = 0.25;

/// ln of the mean squared distance plus ln of the mean squared angle, each over the best three quarters of the episodes:
/// the negative logarithm of the profile likelihood of two quantities whose sizes of error are unknown, so that neither
/// outweighs the other by its unit.
pub(super) fn cost(scores: &[Score]) -> f64 {
    let trimmed = |f: fn(&Score) -> f64| {
        let mut values: Vec<f64> = scores.iter().map(f).collect();
        values.sort_by(f64::total_cmp);
        let count = ((TRIMMED_SHARE * values.len() as f64).ceil() as usize).clamp(1, values.len());
        values[..count].iter().sum::<f64>() / count as f64
    };
    libm::log(trimmed(|s| s.position_square_m2).max(1e-18))
        + libm::log(trimmed(|s| s.rotation_square_rad2).max(1e-18))
}

/// Searches on the episodes `train`: first on a part of them, then on all.
pub(super) fn search(
    model: &ContactModel,
    rig: &Rig,
    tracks: &Tracks,
    train: &[usize],
    options: &StudyOptions,
    key: Key,
    progress: &dyn Tell,
) -> Result<Vec<f64>, CalibrationError> {
    let threads = Threads::resolve(options.threads);
    let start = vec![0.5; model.parameters.len()];
    let mut cma = CmaEs::new(&start, FIRST_SIGMA, options.population, key.child("search"));
    let mut part = train.to_vec();
    key.child("part").stream().shuffle(&mut part);
    part.truncate(options.first_episodes.max(1));
    part.sort_unstable();
    let values = |place: &[f64]| -> Vec<f64> {
        let pairs = model.parameters.iter().zip(place);
        pairs
            .map(|(parameter, place)| parameter.at(*place))
            .collect()
    };
    let [first, then] = options.generations;
    for generation in 0..first + then {
        let which = if generation < first { &part[..] } else { train };
        let points = cma.ask();
        let mut costs = Vec::with_capacity(points.len());
        for point in &points {
            progress.check()?;
            let set = rig.set(&model.settings(&values(point), tracks.nominal))?;
            costs.push(cost(&scores(&set, tracks, which, threads)?));
        }
        cma.tell(&points, &costs);
    }
    Ok(values(&cma.mean()))
}
