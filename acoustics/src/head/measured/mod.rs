//! Measured heads: from responses to tables.
//!
//! - `measurement`: the input, checked; `onset`: onsets of responses; `spectra`: responses at any frequencies.
//! - `fit`: the sphere fitted to a head, which gives level, time and unmeasured directions.
//! - `hull`: triangles between directions; `tables`: filters for any direction.

mod fit;
mod hull;
mod measurement;
mod onset;
mod spectra;
mod tables;

pub use measurement::HrirMeasurement;
pub(crate) use tables::MeasuredHead;

use crate::error::AcousticsError;
use fit::{SphereFit, WeightedDirections};
use glam::DVec3;
use hull::Triangulation;
use measurement::SAME_DIRECTION_CHORD;
use onset::OnsetDetector;
use serde::Serialize;
use std::sync::Arc;

/// Length of a head's response after its onset, s; later sound is the room's.
const RINGING_S: f64 = 0.011;
/// The end of the ringing over which it fades, s.
const FADE_S: f64 = 0.001;
/// Distance from every measured direction beyond which a sphere takes over: the cosine of 25 degrees.
const GAP_COSINE: f64 = 0.906_307_787;
/// Directions that are tested for gaps.
const FILLERS: usize = 240;

/// A summary of a head's measurement.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HeadSummary {
    /// Different directions.
    pub directions: usize,
    /// Directions that were filled in because nothing was measured within 25 degrees.
    pub filled: usize,
    /// Radius of the sphere whose delays fit those of the ears, m.
    pub radius_m: f64,
    /// Gain applied to all responses, dB.
    pub gain_db: f64,
    /// Delay removed from all responses, s: the distance from the measurement's loudspeaker, and its own delay.
    pub removed_delay_s: f64,
}

/// A measurement that can be tabulated at any rate.
pub(crate) struct HeadResponses {
    about: HeadSummary,
    rate_hz: f64,
    samples: usize,
    /// Unit vectors in head space, first measured ones, then those filled in.
    directions: Vec<DVec3>,
    mesh: Arc<Triangulation>,
    /// Responses, cut and scaled. Shape (measured direction, ear).
    pressure: Vec<[Vec<f32>; 2]>,
    /// Onset of each response after its first sample, s. Shape (measured direction, ear).
    begin_s: Vec<[f64; 2]>,
    /// Delays of waves re the head's centre, s. Shape (direction, ear).
    delay_s: Vec<[f64; 2]>,
}

impl HeadResponses {
    pub(super) fn new(measurement: &HrirMeasurement) -> Result<Self, AcousticsError> {
        let rows = measurement.measured_directions()?;
        let rate_hz = measurement.rate_hz;
        let mut onsets = OnsetDetector::new(rate_hz);
        let mut responses = Vec::with_capacity(rows.len());
        let (mut begins_s, mut delay_s) = (Vec::new(), Vec::new());
        for row in &rows {
            let begin_s = row.responses.map(|response| onsets.onset_s(response));
            responses.push(
                [0, 1].map(|ear| truncate_and_fade(row.responses[ear], begin_s[ear], rate_hz)),
            );
            delay_s.push([0, 1].map(|ear| row.delay_s[ear] + begin_s[ear]));
            begins_s.push(begin_s);
        }
        let mut directions: Vec<DVec3> = rows.iter().map(|row| row.direction).collect();
        let fit = SphereFit::new(&directions, &delay_s);
        for late_s in delay_s.iter_mut().flatten() {
            *late_s -= fit.common_delay_s;
        }
        let samples = responses.iter().flatten().map(Vec::len).max().unwrap_or(0);
        let gain = fit.level_matching_gain(&directions, &responses, rate_hz, samples);
        for x in responses.iter_mut().flatten().flatten() {
            *x *= gain as f32;
        }
        let measured = directions.len();
        for k in 0..FILLERS {
            let direction = crate::sphere_sequences::fibonacci_direction(k, FILLERS).as_dvec3();
            let direction = direction / direction.length();
            let nearest = directions[..measured].iter().map(|d| d.dot(direction));
            if nearest.fold(-1.0, f64::max) < GAP_COSINE {
                let near = WeightedDirections::near(&directions[..measured], direction);
                delay_s.push(fit.extrapolated_delay_s(&directions, &delay_s, &near, direction));
                directions.push(direction);
            }
        }
        let Some(mesh) = Triangulation::new(&directions) else {
            // Unreachable: filling leaves no gap, and no two directions are as near as this.
            return Err(AcousticsError::Head(format!(
                "directions {SAME_DIRECTION_CHORD} apart cannot be joined to triangles"
            )));
        };
        tracing::debug!(measured, triangles = mesh.len(), "measured head read");
        Ok(Self {
            about: HeadSummary {
                directions: measured,
                filled: directions.len() - measured,
                radius_m: fit.radius_m,
                gain_db: 20.0 * libm::log10(gain),
                removed_delay_s: fit.common_delay_s,
            },
            rate_hz,
            samples,
            directions,
            mesh: Arc::new(mesh),
            pressure: responses,
            begin_s: begins_s,
            delay_s,
        })
    }

    pub(super) fn summary(&self) -> &HeadSummary {
        &self.about
    }
}

/// Returns a response up to the end of its ringing.
fn truncate_and_fade(response: &[f32], begin_s: f64, rate_hz: f64) -> Vec<f32> {
    let samples = |time_s: f64| (time_s.max(0.0) * rate_hz) as usize;
    let end = samples(begin_s + RINGING_S).clamp(1, response.len());
    let mut kept = response[..end].to_vec();
    if end < response.len() {
        let fade = samples(FADE_S).min(end);
        for (k, x) in kept[end - fade..].iter_mut().enumerate() {
            let turn = std::f64::consts::PI * (k + 1) as f64 / (fade + 1) as f64;
            *x *= (0.5 + 0.5 * libm::cos(turn)) as f32;
        }
    }
    kept
}
