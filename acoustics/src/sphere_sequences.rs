//! Sequences of directions that cover the sphere evenly.

use glam::Vec3;

/// Returns direction `k` of `count` that cover the sphere evenly.
///
/// # Source
/// R. Swinbank, R. J. Purser, Q. J. R. Meteorol. Soc. 132, 1769 (2006): the Fibonacci lattice.
pub(crate) fn fibonacci_direction(k: usize, count: usize) -> Vec3 {
    let y = 1.0 - (2 * k + 1) as f64 / count.max(1) as f64;
    on_sphere(y, k as f64 * 0.618_033_988_749_894_9)
}

/// Returns direction `k` of a sequence every prefix of which covers the sphere evenly.
///
/// # Source
/// M. Roberts, *The Unreasonable Effectiveness of Quasirandom Sequences* (2018): the additive recurrence of the plastic number,
/// mapped to the sphere by equal areas.
pub(crate) fn direction_in_sequence(k: usize, (u, v): (f64, f64)) -> Vec3 {
    let place = |start: f64, step: f64| {
        let x = start + k as f64 * step;
        x - x.floor()
    };
    let y = 1.0 - 2.0 * place(u, 0.754_877_666_246_692_7);
    on_sphere(y, place(v, 0.569_840_290_998_053_2))
}

/// Returns the unit vector at height `y` and an azimuth in turns.
fn on_sphere(y: f64, turns: f64) -> Vec3 {
    let angle = std::f64::consts::TAU * (turns - turns.floor());
    let r = (1.0 - y * y).max(0.0).sqrt();
    Vec3::new(
        (r * libm::cos(angle)) as f32,
        y as f32,
        (r * libm::sin(angle)) as f32,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_cover_the_sphere_evenly() {
        let n = 5000;
        let lattice: Vec<Vec3> = (0..n).map(|k| fibonacci_direction(k, n)).collect();
        let sequence: Vec<Vec3> = (0..n)
            .map(|k| direction_in_sequence(k, (0.3, 0.8)))
            .collect();
        for (directions, tolerance) in [
            (&lattice[..], 1e-3),
            (&sequence, 3e-3),
            (&sequence[..640], 1e-2),
        ] {
            let n = directions.len() as f32;
            let mean = directions.iter().sum::<Vec3>() / n;
            assert!(mean.length() < tolerance, "{mean}");
            for axis in [Vec3::X, Vec3::Y, Vec3::new(0.6, 0.0, 0.8)] {
                let second: f32 = directions.iter().map(|d| d.dot(axis).powi(2)).sum::<f32>() / n;
                assert!((second - 1.0 / 3.0).abs() < tolerance);
            }
        }
    }
}
