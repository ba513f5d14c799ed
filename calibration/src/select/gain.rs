//! Gain of a cause on episodes that no fit has seen.

use dwell_scene::random::RandomKey;
use serde::Serialize;

/// Gain on held-out episodes, each with its 95 % interval over episodes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HeldOutGain {
    /// Relative decrease of the held-out squared error.
    pub share: f64,
    /// Its interval.
    pub share_interval: [f64; 2],
    /// Mean gain of log predictive density per episode, nat.
    pub log_density: f64,
    /// Its interval.
    pub log_density_interval: [f64; 2],
}

/// Compares the losses of two models episode by episode. `scale`: mean squared residual of the better model where it was
/// fitted; `worth`: independent residuals per residual.
///
/// # Source
/// B. Efron, Ann. Stat. 7, 1 (1979): percentiles of the bootstrap.
pub(super) fn gain(
    before: &[f64],
    after: &[f64],
    scale: f64,
    worth: f64,
    draws: usize,
    key: RandomKey,
) -> HeldOutGain {
    let count = before.len();
    let mut stream = key.child("bootstrap").stream();
    let statistic = |pick: &mut dyn FnMut(usize) -> usize| {
        let (mut b, mut a) = (0.0, 0.0);
        for k in 0..count {
            let episode = pick(k);
            b += before[episode];
            a += after[episode];
        }
        let share = if b > 0.0 { 1.0 - a / b } else { 0.0 };
        let density = if scale > 0.0 {
            worth * (b - a) / (2.0 * scale * count.max(1) as f64)
        } else {
            0.0
        };
        (share, density)
    };
    let (share, log_density) = statistic(&mut |k| k);
    let (mut shares, mut densities) = (Vec::with_capacity(draws), Vec::with_capacity(draws));
    for _ in 0..draws {
        let (s, d) = statistic(&mut |_| stream.below(count));
        shares.push(s);
        densities.push(d);
    }
    HeldOutGain {
        share,
        share_interval: interval(&mut shares),
        log_density,
        log_density_interval: interval(&mut densities),
    }
}

fn interval(values: &mut [f64]) -> [f64; 2] {
    values.sort_by(f64::total_cmp);
    let at = |share: f64| {
        values[((share * (values.len() - 1) as f64).round() as usize).min(values.len() - 1)]
    };
    [at(0.025), at(0.975)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gain_in_every_episode_is_certain_and_one_outlier_is_not() {
        let key = RandomKey::root(5);
        let certain = gain(
            &[10.0, 12.0, 11.0, 9.0],
            &[1.0, 1.5, 0.8, 1.1],
            1.0,
            1.0,
            1000,
            key,
        );
        assert!(
            certain.share > 0.85
                && certain.share_interval[0] > 0.8
                && certain.log_density_interval[0] > 3.0
        );
        let lucky = gain(
            &[10.0, 1.0, 1.0, 1.0],
            &[1.0, 1.1, 1.1, 1.1],
            1.0,
            1.0,
            1000,
            key,
        );
        assert!(lucky.share > 0.5 && lucky.log_density_interval[0] < 0.0);
    }
}
