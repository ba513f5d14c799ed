//! A point that falls through air, by the classical Runge-Kutta method in double precision.

/// Acceleration of free fall, m/s².
const GRAVITY: f64 = 9.806_65;
/// Steps between two samples.
const SUBSTEPS: usize = 16;

/// Positions (m) at equal steps of time, the start first.
pub(super) fn trajectory(
    start: [f64; 3],
    velocity: [f64; 3],
    drag_per_m: f64,
    step_s: f64,
    samples: usize,
) -> Vec<[f64; 3]> {
    let mut now = [start, velocity].concat();
    let mut found = Vec::with_capacity(samples);
    for _ in 0..samples {
        found.push([now[0], now[1], now[2]]);
        for _ in 0..SUBSTEPS {
            now = runge_kutta(&now, drag_per_m, step_s / SUBSTEPS as f64);
        }
    }
    found
}

/// Rates of position and velocity.
fn rates(now: &[f64], drag_per_m: f64) -> Vec<f64> {
    let v = &now[3..];
    let speed = v.iter().map(|v| v * v).sum::<f64>().sqrt();
    let pull = |axis: usize| -drag_per_m * speed * v[axis] - if axis == 1 { GRAVITY } else { 0.0 };
    vec![v[0], v[1], v[2], pull(0), pull(1), pull(2)]
}

/// One step.
///
/// # Source
/// W. Kutta, Z. Math. Phys. 46, 435 (1901), the classical method of fourth order.
fn runge_kutta(now: &[f64], drag_per_m: f64, h: f64) -> Vec<f64> {
    let moved = |rates: &[f64], h: f64| {
        now.iter()
            .zip(rates)
            .map(|(x, r)| x + h * r)
            .collect::<Vec<f64>>()
    };
    let a = rates(now, drag_per_m);
    let b = rates(&moved(&a, 0.5 * h), drag_per_m);
    let c = rates(&moved(&b, 0.5 * h), drag_per_m);
    let d = rates(&moved(&c, h), drag_per_m);
    (0..6)
        .map(|k| now[k] + h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Closed form of a fall from rest: y = -(1/k) ln cosh(t sqrt(g k)).
    #[test]
    fn a_fall_through_air_meets_its_closed_form() {
        let k = 0.11;
        let path = trajectory([0.0; 3], [0.0; 3], k, 0.01, 101);
        let exact = -(GRAVITY * k).sqrt().cosh().ln() / k;
        assert!(
            (path[100][1] - exact).abs() < 1e-9,
            "{} {exact}",
            path[100][1]
        );
    }
}
