//! From a force to pressure: modes that ring and radiate, walls under a force, and compact bodies that are accelerated.

use super::mode_bank::{self, SampledMode};
use super::modes::BendingPanel;
use super::{ContactPartner, PartnerKind, elastic};
use dwell_scene::random::RandomKey;
use std::f64::consts::{LN_10, PI, TAU};

/// Density of air, kg/m³, and speed of sound, m/s, at 20 degrees: radiation hardly depends on the weather.
const AIR_KG_M3: f64 = 1.2;
const SOUND_M_S: f64 = 343.0;
/// Longest ringing that is rendered, s.
pub(super) const MAX_RINGING_S: f64 = 2.0;
/// Longest time constant of the amplitude, s: a body in use is held, leans or lies.
const LONGEST_DECAY_S: f64 = 0.4;

/// A decaying mode: velocity after a unit impulse is e^(-δt) cos ωt.
#[derive(Clone, Copy, Debug, PartialEq)]
struct DecayingMode {
    omega: f64,
    decay_per_s: f64,
    /// Pressure at 1 m for an impulse of 1 N·s, Pa.
    gain: f64,
    /// Its energy after an impulse of 1 N·s, J.
    energy_j: f64,
}

/// The radiation of two bodies under one force.
#[derive(Clone, Debug)]
pub(super) struct Radiator {
    modes: Vec<DecayingMode>,
    /// Pressure at 1 m for a force of 1 N on walls, Pa.
    push: f64,
    /// Pressure at 1 m for a force that grows by 1 N/s on compact bodies, Pa.
    jerk: f64,
}

impl Radiator {
    /// `key`: random key of the position of the force on the bodies, and of their irregularities.
    pub(super) fn new(partners: &[ContactPartner], key: RandomKey) -> Self {
        let mut all = Self {
            modes: Vec::new(),
            push: 0.0,
            jerk: 0.0,
        };
        for (k, partner) in partners.iter().enumerate() {
            match partner.kind {
                PartnerKind::Panel(surface_density_kg_m2) => {
                    // An infinite limp leaf radiates the force itself: p = ρ F / 2π m'' r below its critical frequency
                    // (Cremer, Heckl, Petersson, section 7.4).
                    let leaf = f64::from(surface_density_kg_m2).max(1.0);
                    all.push += AIR_KG_M3 / (TAU * leaf);
                }
                PartnerKind::Body(_) => all.add_body(partner, key.child(k as u64)),
            }
        }
        all
    }

    fn add_body(&mut self, partner: &ContactPartner, key: RandomKey) {
        let PartnerKind::Body(body) = partner.kind else {
            return;
        };
        let of = elastic(&partner.substance);
        let panel = BendingPanel::equivalent_to(&body, &of);
        let mut stream = key.child("struck at").stream();
        let at = [stream.uniform(), stream.uniform()];
        let half_m = 0.5 * panel.sides_m[0];
        for mode in panel.modes(&of) {
            // No two bodies are exactly alike.
            let uneven = 0.985 + 0.03 * stream.uniform();
            let omega = TAU * mode.frequency_hz * uneven;
            // Mode shapes of free bodies far from the edges are cosines; the mean square of each is 1.
            let shape: f64 = (0..2)
                .map(|axis| {
                    let lines = f64::from(mode.nodal_lines[axis]);
                    if lines > 0.0 {
                        2.0_f64.sqrt() * libm::cos(PI * lines * at[axis])
                    } else {
                        1.0
                    }
                })
                .product();
            // Radiation is full above coincidence, where bending waves are longer than those of the air; less by the square
            // of their ratio below it. A bending body displaces no net air: where it is smaller than a wavelength it is a
            // dipole at most. An interpolation between the limits of Cremer, Heckl, Petersson, section 7.
            let wave = omega / SOUND_M_S;
            let [x, y] =
                [0, 1].map(|axis| f64::from(mode.nodal_lines[axis]) * PI / panel.sides_m[axis]);
            let coincidence = wave * wave / (x * x + y * y);
            let compact = libm::pow(wave * half_m, 4.0);
            let efficiency = coincidence / (1.0 + coincidence) * compact / (1.0 + compact);
            // W = ρ c S σ <v²>, and p² at 1 m = W ρ c / 4π.
            let radiated = AIR_KG_M3 * SOUND_M_S * (panel.area_m2 * efficiency / (4.0 * PI)).sqrt();
            self.modes.push(DecayingMode {
                omega,
                decay_per_s: (0.5 * omega * of.loss).max(1.0 / LONGEST_DECAY_S),
                gain: shape * radiated / panel.mass_kg,
                energy_j: 0.5 * shape * shape / panel.mass_kg,
            });
        }
        // An accelerated rigid body is a dipole with 1.5 times its volume (that of a sphere; R. Koss, R. Alfredson, J.
        // Sound Vib. 27, 59, 1973): p = 1.5 ρ V ȧ cos θ / 4π c r, here the mean over directions.
        let volume_m3 = f64::from(body.mass_kg) / of.density_kg_m3;
        self.jerk += 1.5 * AIR_KG_M3 * volume_m3
            / (4.0 * PI * SOUND_M_S * 3.0_f64.sqrt() * f64::from(body.mass_kg).max(1e-4));
    }

    /// Bounds the energy of the modes to `energy_j` after a half sine of `impulse_n_s` that lasts `lasts_s`: the same
    /// impulse cannot go whole into every mode.
    pub(super) fn limit_mode_energy(&mut self, impulse_n_s: f64, lasts_s: f64, energy_j: f64) {
        let taken = |mode: &DecayingMode| {
            // The spectrum of a half sine re its impulse.
            let x = mode.omega * lasts_s / PI;
            let reached = if (x - 1.0).abs() < 1e-6 {
                0.25 * PI
            } else {
                libm::cos(0.5 * PI * x) / (1.0 - x * x)
            };
            mode.energy_j * impulse_n_s * impulse_n_s * reached * reached
        };
        let all: f64 = self.modes.iter().map(taken).sum();
        if all > energy_j {
            let scale = (energy_j / all).sqrt();
            for mode in &mut self.modes {
                mode.gain *= scale;
            }
        }
    }

    /// Returns the time that it rings after the force has ended, until it has decayed by 60 dB, s.
    pub(super) fn ringing_s(&self) -> f64 {
        let longest = self
            .modes
            .iter()
            .map(|mode| 3.0 * LN_10 / mode.decay_per_s)
            .fold(0.0, f64::max);
        longest.min(MAX_RINGING_S)
    }

    /// Adds the pressure radiated under `force` to `out`. `force`: shape (sample,), N, the mean over each sample; `out`: Pa
    /// at 1 m, at least as long. The last 10 ms of `out` fade.
    pub(super) fn add_response(&self, force: &[f64], rate_hz: u32, out: &mut [f64]) {
        let rate = f64::from(rate_hz);
        let step_s = 1.0 / rate;
        let mut before = 0.0;
        for (now, y) in force.iter().chain([&0.0]).zip(out.iter_mut()) {
            *y += self.push * now + self.jerk * (now - before) * rate;
            before = *now;
        }
        let audible = self
            .modes
            .iter()
            .filter(|mode| mode.omega < 0.45 * TAU * rate);
        let sampled = audible.map(|mode| {
            let size = libm::exp(-mode.decay_per_s * step_s);
            let angle = mode.omega * step_s;
            SampledMode {
                step: [size * libm::cos(angle), size * libm::sin(angle)],
                gain: mode.gain * step_s,
                // After the force the mode is rendered down by 80 dB.
                ringing: (4.0 * LN_10 / mode.decay_per_s * rate) as usize,
            }
        });
        let sampled: Vec<SampledMode> = sampled.collect();
        mode_bank::add_modes(&sampled, force, out);
        let edge = (0.01 * rate) as usize;
        let length = out.len();
        for (k, sample) in out.iter_mut().rev().take(edge.min(length)).enumerate() {
            *sample *= k as f64 / edge as f64;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rung(partners: &[ContactPartner], rate_hz: u32, samples: usize) -> Vec<f64> {
        let radiator = Radiator::new(partners, RandomKey::root(5));
        let mut out = vec![0.0; samples];
        radiator.add_response(&[f64::from(rate_hz)], rate_hz, &mut out);
        out
    }

    /// T60 = 2.2 / f η: a steel rod whose lowest mode alone is below half the rate.
    #[test]
    fn a_mode_decays_as_its_loss_factor_says() {
        let of = elastic("steel");
        let rod = ContactPartner::body("steel", 0.2 * 1e-4 * 7850.0, [0.01, 0.2, 0.01]);
        let mode = Radiator::new(std::slice::from_ref(&rod), RandomKey::root(5)).modes[0];
        let hz = mode.omega / TAU;
        assert!((hz / super::super::modes::bar_mode_hz(1, 0.2, 0.01, &of) - 1.0).abs() < 0.016);
        let rate_hz = 4_000;
        let heard = rung(&[rod], rate_hz, 3_000);
        let power = |range: std::ops::Range<usize>| heard[range].iter().map(|x| x * x).sum::<f64>();
        let fall_db = 10.0 * (power(100..500) / power(1_100..1_500)).log10();
        let t60_s = 60.0 / fall_db * 1_000.0 / f64::from(rate_hz);
        assert!(
            (t60_s / (2.2 / (hz * of.loss)) - 1.0).abs() < 0.02,
            "{t60_s} s at {hz} Hz"
        );
    }

    /// Power radiated as W = ρ c S σ <v²> arrives as p² = W ρ c / 4π, and the mode takes J φ / M.
    #[test]
    fn a_wall_gives_the_force_and_a_body_its_mean_square_velocity() {
        let radiator = Radiator::new(
            &[ContactPartner::panel("concrete", 100.0)],
            RandomKey::root(1),
        );
        let mut out = [0.0; 400];
        radiator.add_response(&[500.0], 16_000, &mut out);
        assert!((out[0] - 1.2 * 500.0 / (TAU * 100.0)).abs() < 1e-12 && out[1] == 0.0);
        assert_eq!(radiator.ringing_s(), 0.0);
        // Half the mass at the same size: thinner, hollow or not, it vibrates more.
        let loud = |mass_kg| {
            let tray = ContactPartner::body("steel", mass_kg, [0.4, 0.3, 0.004]);
            let out = rung(&[tray], 16_000, 8_000);
            out.iter().map(|x| x * x).sum::<f64>()
        };
        assert!(loud(1.9) > 1.5 * loud(3.8));
    }
}
