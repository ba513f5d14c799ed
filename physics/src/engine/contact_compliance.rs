//! Contact stiffness: rapier's parameters for it.

use crate::config::{ContactFriction, ResolvedConfig};
use rapier3d::dynamics::{FrictionModel, IntegrationParameters, SpringCoefficients};
use std::f64::consts::TAU;

/// Contact compliance: a spring and damper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ContactCompliance {
    pub(crate) natural_frequency_hz: f32,
    pub(crate) damping_ratio: f32,
}

/// Natural frequency of contacts, as a share of the substep rate. A body sinks by g over its square: 0.04 mm at 4 substeps
/// and 120 Hz.
const CONTACT_FREQUENCY: f32 = 1.0 / 6.0;
/// The same against static pieces.
const STATIC_CONTACT_FREQUENCY: f32 = 0.25;
/// Damping ratio of contacts, as in rapier.
const CONTACT_DAMPING_RATIO: f32 = 10.0;
/// Longest run of rapier under compliant contacts, in radians of their oscillation: a contact is noticed up to a run late,
/// which changes the energy of a bounce by up to this share.
const LONGEST_RUN_RAD: f64 = 0.1;
/// Solver iterations over the contacts of a run, where rapier has two with 1 each.
const SOFT_SWEEPS: usize = 4;

fn friction(settings: &ResolvedConfig) -> FrictionModel {
    match settings.config.contact_friction {
        ContactFriction::Patch => FrictionModel::Simplified,
        ContactFriction::Point => FrictionModel::Coulomb,
    }
}

/// Returns the stiffest contacts that the rate allows.
pub(crate) fn rigid_contact_parameters(settings: &ResolvedConfig) -> IntegrationParameters {
    let substeps = settings.config.solver_substeps as f32;
    let substep_hz = substeps / settings.dt_s;
    let softness = |share: f32| SpringCoefficients {
        natural_frequency: share * substep_hz,
        damping_ratio: CONTACT_DAMPING_RATIO,
    };
    IntegrationParameters {
        dt: settings.dt_s,
        min_ccd_dt: settings.dt_s / 100.0,
        num_solver_iterations: settings.config.solver_substeps as usize,
        contact_softness: softness(CONTACT_FREQUENCY),
        static_contact_softness: softness(STATIC_CONTACT_FREQUENCY),
        friction_model: friction(settings),
        ..IntegrationParameters::default()
    }
}

/// Returns contacts that are springs with dampers, and the number of runs of rapier in a physics step, each shorter than a substep.
///
/// rapier's soft contacts are no springs by default: a second iteration after each substep removes all velocity along the
/// normal, points that are about to touch are stopped at the surface, and the push is bounded. Here there is no second
/// iteration, no point before it touches, and no bound.
///
/// # Source
/// A run of length h with factors e and c changes the depth d and its rate v by v' = (1 - c) v - c e d, d' = d + h v'. Its
/// matrix has the determinant 1 - c and the trace 2 - c - c e h; those of the exact solution of a damped oscillator over h
/// are exp(-2 z w h) and 2 exp(-z w h) cos(w h sqrt(1 - z^2)), so that impacts are exact. A constant force then sinks z w h
/// (relative) too little. rapier makes c and e from a frequency and a damping ratio (E. Catto, Soft Constraints, GDC 2011);
/// those that give the exact ones are returned.
pub(crate) fn compliant_contact_parameters(
    settings: &ResolvedConfig,
    compliance: ContactCompliance,
) -> (IntegrationParameters, u32) {
    let angular = f64::from(compliance.natural_frequency_hz) * TAU;
    let damping = f64::from(compliance.damping_ratio);
    let needed = (angular * f64::from(settings.dt_s) / LONGEST_RUN_RAD).ceil() as u32;
    let runs = needed.max(settings.config.solver_substeps);
    let dt_s = settings.dt_s / runs as f32;
    let run = angular * f64::from(dt_s);
    let decay = libm::exp(-damping * run);
    // cos(i x) = cosh(x) where the damping is more than critical.
    let turn = if damping < 1.0 {
        libm::cos(run * libm::sqrt(1.0 - damping * damping))
    } else {
        libm::cosh(run * libm::sqrt(damping * damping - 1.0))
    };
    // The determinant: 1 - c = exp(-2 z w h).
    let c = 1.0 - decay * decay;
    // The trace: c e h = 2 - c - 2 exp(-z w h) cos(w h sqrt(1 - z^2)).
    let stiffness = 2.0 - c - 2.0 * decay * turn;
    // rapier's own, of its frequency W and damping ratio Z, with a = W h: c / (1 - c) = a^2 + 2 Z a, c e h = a^2 (1 - c).
    let ratio = c / (1.0 - c);
    let run_of_rapier = libm::sqrt(stiffness / (1.0 - c));
    let softness = SpringCoefficients {
        natural_frequency: (run_of_rapier / (TAU * f64::from(dt_s))) as f32,
        damping_ratio: ((ratio / run_of_rapier - run_of_rapier) * 0.5) as f32,
    };
    let parameters = IntegrationParameters {
        dt: dt_s,
        min_ccd_dt: dt_s / 100.0,
        num_solver_iterations: 1,
        num_internal_pgs_iterations: SOFT_SWEEPS,
        num_internal_stabilization_iterations: 0,
        contact_softness: softness,
        static_contact_softness: softness,
        normalized_prediction_distance: 0.0,
        normalized_max_corrective_velocity: f32::MAX,
        friction_model: friction(settings),
        ..IntegrationParameters::default()
    };
    (parameters, runs)
}
