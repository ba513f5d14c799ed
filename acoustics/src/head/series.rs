//! Sound on the surface of a rigid sphere: the exact series.

use realfft::num_complex::Complex;

/// Returns the pressure on a rigid sphere over the pressure at its centre without the sphere, for a plane wave.
///
/// `ka`: wave number times radius, at least 0. `cos_incidence`: cosine of the angles between the point's and the wave's
/// direction of origin. Returns one value for each angle, for signals that go as exp(+i omega t). Shape (angle,).
///
/// # Source
/// R. O. Duda, W. L. Martens, JASA 104, 3048 (1998), the limit of equation (3) for a distant source.
pub(crate) fn sphere_response(ka: f64, cos_incidence: &[f64]) -> Vec<Complex<f64>> {
    let mut sum = vec![Complex::new(0.0, 0.0); cos_incidence.len()];
    if ka < 1e-6 {
        return vec![Complex::new(1.0, 0.0); cos_incidence.len()];
    }
    let i = Complex::new(0.0, 1.0);
    let turn = Complex::new(libm::cos(ka), libm::sin(ka));
    // Spherical Hankel functions of the first kind, orders m and m + 1.
    let (mut h, mut h_next) = (-i * turn / ka, -turn * (1.0 / ka + i / (ka * ka)));
    let (mut legendre_before, mut legendre) = (vec![0.0; sum.len()], vec![1.0; sum.len()]);
    // (-i)^(m - 1)
    let mut phase = i;
    let highest = (1.5 * ka).ceil() as usize + 20;
    for m in 0..highest {
        let order = m as f64;
        // h'_m = (m / x) h_m - h_(m + 1)
        let slope = h * (order / ka) - h_next;
        let factor = phase * (2.0 * order + 1.0) / slope;
        if !factor.is_finite() {
            break;
        }
        for (total, p) in sum.iter_mut().zip(&legendre) {
            *total += factor * *p;
        }
        for ((before, p), x) in legendre_before
            .iter_mut()
            .zip(&mut legendre)
            .zip(cos_incidence)
        {
            let next = ((2.0 * order + 1.0) * x * *p - order * *before) / (order + 1.0);
            *before = std::mem::replace(p, next);
        }
        let after = h_next * ((2.0 * order + 3.0) / ka) - h;
        h = std::mem::replace(&mut h_next, after);
        phase *= -i;
    }
    // The series is written for exp(-i omega t).
    sum.iter().map(|value| (value / (ka * ka)).conj()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_waves_do_not_feel_the_sphere() {
        for value in sphere_response(1e-3, &[-1.0, 0.0, 1.0]) {
            assert!((value - Complex::new(1.0, 0.0)).norm() < 2e-3);
        }
    }

    /// The low-frequency delay is 1.5 a/c cos(theta) (Kuhn, JASA 62, 157, 1977): half as much again as the free path.
    #[test]
    fn long_waves_arrive_half_as_much_again_early() {
        let ka = 0.01;
        for (cos, value) in [1.0, 0.5, -0.7]
            .into_iter()
            .zip(sphere_response(ka, &[1.0, 0.5, -0.7]))
        {
            assert!(
                (value.arg() / ka - 1.5 * cos).abs() < 1e-3,
                "{cos}: {}",
                value.arg() / ka
            );
        }
    }

    /// A hard wall doubles the pressure, and so does the near side of a large sphere. In the shadow the first creeping wave
    /// fades as exp(-1.0188 sin(60 deg) (ka/2)^(1/3) angle) (J. B. Keller, J. Opt. Soc. Am. 52, 116, 1962), and on the far
    /// side all creeping waves meet in a bright spot.
    #[test]
    fn short_waves_double_on_the_near_side_and_creep_into_the_shadow() {
        let ka = 400.0;
        let cosines = [0.0_f64, 30.0, 50.0, 90.0].map(|deg| (90.0 + deg).to_radians().cos());
        let found = sphere_response(ka, &[1.0, cosines[1], cosines[2], cosines[3]]);
        assert!((found[0].norm() - 2.0).abs() < 0.01, "{}", found[0].norm());
        let per_rad = 1.0188 * 60.0_f64.to_radians().sin() * (0.5 * ka).cbrt();
        // On the way to the far side the wave is focused by the sphere: energy per width, 1 / sin of the polar angle.
        let focused = (120.0_f64.to_radians().sin() / 140.0_f64.to_radians().sin()).sqrt();
        let wanted = focused * (-per_rad * 20.0_f64.to_radians()).exp();
        let fading = found[2].norm() / found[1].norm();
        assert!((fading / wanted - 1.0).abs() < 0.05, "{fading} {wanted}");
        assert!(found[3].norm() > found[2].norm());
    }

    /// Independent of any series: without a sphere's scattering, the mean over the surface is that of the plane wave; with
    /// it, only order 0 survives the mean, 1 / (ka)^2 over the modulus of h0'(ka), that is 1 / sqrt(1 + (ka)^2).
    #[test]
    fn the_mean_over_the_surface_is_that_of_order_zero() {
        let n = 2000;
        let cosines: Vec<f64> = (0..n)
            .map(|k| -1.0 + (2.0 * f64::from(k) + 1.0) / f64::from(n))
            .collect();
        for ka in [0.3, 2.0, 9.0] {
            let mean: Complex<f64> =
                sphere_response(ka, &cosines).iter().sum::<Complex<f64>>() / f64::from(n);
            assert!(
                (mean.norm() * (1.0 + ka * ka).sqrt() - 1.0).abs() < 1e-3,
                "{ka}: {}",
                mean.norm()
            );
        }
    }
}
