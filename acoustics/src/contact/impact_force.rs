//! The force of an impact.

use super::{ContactPartner, elastic};
use std::f64::consts::PI;

/// The shortest and the longest duration of an impact, s.
const LASTS_S: (f64, f64) = (2e-5, 0.1);
/// Radius of curvature at the contact, as a share of the smallest edge, and its bounds, m: estimate for rounded edges.
const CURVATURE: f64 = 0.1;
const CURVATURE_M: (f64, f64) = (2e-3, 5e-2);

/// Returns the duration of contact of two bodies that hit at `speed_m_s`, s.
///
/// # Source
/// H. Hertz; K. L. Johnson, *Contact Mechanics* (1985), equation 11.24: T = 2.87 (m² / R E*² v)^(1/5).
pub(super) fn hertz_contact_time_s(
    mass_kg: f64,
    radius_m: f64,
    modulus_pa: f64,
    speed_m_s: f64,
) -> f64 {
    let speed = speed_m_s.max(1e-2);
    let inside = mass_kg * mass_kg / (radius_m * modulus_pa * modulus_pa * speed);
    (2.87 * libm::pow(inside, 0.2)).clamp(LASTS_S.0, LASTS_S.1)
}

/// Returns the effective modulus of two surfaces in contact, Pa.
pub(super) fn effective_modulus_pa(a: &str, b: &str) -> f64 {
    let yields = [a, b].map(|name| {
        let of = elastic(name);
        (1.0 - of.poisson * of.poisson) / of.contact_pa
    });
    1.0 / (yields[0] + yields[1])
}

/// Returns the duration of an impact between two bodies, s.
pub(super) fn impact_duration_s(partners: &[ContactPartner; 2], speed_m_s: f64) -> f64 {
    let inverse: f64 = partners
        .iter()
        .filter_map(ContactPartner::mass_kg)
        .map(f64::recip)
        .sum();
    // Two walls do not collide.
    let mass_kg = if inverse > 0.0 { 1.0 / inverse } else { 1.0 };
    let smallest = partners
        .iter()
        .filter_map(|partner| match partner.kind {
            super::PartnerKind::Body(body) => {
                Some(body.size_m.into_iter().fold(f32::INFINITY, f32::min))
            }
            super::PartnerKind::Panel(_) => None,
        })
        .fold(f32::INFINITY, f32::min);
    let radius_m = (CURVATURE * f64::from(smallest)).clamp(CURVATURE_M.0, CURVATURE_M.1);
    let modulus = effective_modulus_pa(&partners[0].substance, &partners[1].substance);
    hertz_contact_time_s(mass_kg, radius_m, modulus, speed_m_s)
}

/// Adds a half sine of `impulse_n_s` that lasts `lasts_s` from `start_s` on to `force`, N, as the mean over each sample.
pub(super) fn add_half_sine(
    force: &mut [f64],
    rate_hz: u32,
    start_s: f64,
    impulse_n_s: f64,
    lasts_s: f64,
) {
    let rate = f64::from(rate_hz);
    let first = (start_s * rate).floor().max(0.0) as usize;
    let last = ((start_s + lasts_s) * rate).ceil() as usize;
    // The integral of the force from the start of the impact.
    let until = |t: f64| 0.5 * (1.0 - libm::cos(PI * ((t - start_s) / lasts_s).clamp(0.0, 1.0)));
    let end = last.min(force.len());
    for (k, sample) in force[first.min(end)..end].iter_mut().enumerate() {
        let from = (first + k) as f64 / rate;
        *sample += impulse_n_s * rate * (until(from + 1.0 / rate) - until(from));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// K. L. Johnson, Contact Mechanics, section 11.4: two steel spheres.
    #[test]
    fn steel_balls_touch_for_a_tenth_of_a_millisecond() {
        let modulus = effective_modulus_pa("steel", "steel");
        assert!((modulus / (200e9 / (2.0 * (1.0 - 0.29 * 0.29))) - 1.0).abs() < 1e-12);
        // 1 cm radius, 33 g each: R = 5 mm, m = 16.4 g. The equation of motion, step by step.
        let (mass, radius, speed) = (0.0164, 0.005_f64, 1.0);
        let stiffness = 4.0 / 3.0 * modulus * radius.sqrt();
        let (mut x, mut v, mut t, dt) = (0.0_f64, speed, 0.0, 1e-9);
        while x >= 0.0 {
            v -= stiffness * x.max(0.0).powf(1.5) / mass * dt;
            x += v * dt;
            t += dt;
        }
        let found = hertz_contact_time_s(mass, radius, modulus, speed);
        assert!((found / t - 1.0).abs() < 0.01, "{found} {t}");
        // Slower by 2^5 lasts twice as long; softer lasts longer.
        let long = hertz_contact_time_s(10.0, radius, 1e9, 1.0);
        assert!((hertz_contact_time_s(10.0, radius, 1e9, 1.0 / 32.0) / long - 2.0).abs() < 1e-9);
    }

    #[test]
    fn the_force_adds_up_to_the_impulse_however_short_it_is() {
        for (lasts_s, start_s) in [(5e-5, 0.0), (2e-3, 0.0103), (0.03, 0.00002)] {
            let mut force = vec![0.0; 1_000];
            add_half_sine(&mut force, 16_000, start_s, 0.7, lasts_s);
            let impulse: f64 = force.iter().sum::<f64>() / 16_000.0;
            assert!((impulse - 0.7).abs() < 1e-12);
            assert!(force.iter().all(|f| *f >= 0.0));
        }
    }
}
