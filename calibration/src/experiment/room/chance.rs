//! The echoes that chance makes: scattered sound arrives at random times, and its peaks are picked like echoes.

use super::arrivals::{self, PickedArrivals};
use super::simulation::{RoomSimulator, SimulatedResponse};
use dwell_scene::random::RandomKey;

/// Draws of each recording.
const DRAWS: usize = 4;
/// Standard deviations above the mean up to which a mean square is one of chance.
const CHANCE_SDS: f64 = 3.0;
/// How far the mean may be off: when scattered sound arrives is known to the width of a histogram's bins. Between bins of 1 and
/// of 4 ms its mean square differs by up to a third.
const MEAN_FACTOR: f64 = 4.0 / 3.0;

/// Squared mismatches of a recording's echoes, in standard deviations, and their number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct EchoMismatch {
    pub(super) sum: f64,
    pub(super) count: f64,
}

impl EchoMismatch {
    /// The mismatch of picked echoes. `shift`: what is added to a picked time, s.
    pub(super) fn of(
        picked: &PickedArrivals,
        predicted_s: &[f64],
        sd_s: f64,
        mut shift_s: impl FnMut() -> f64,
    ) -> Self {
        let mut found = Self::default();
        for echo in &picked.echoes {
            let off_s = arrivals::mismatch_s(echo.t_s + shift_s(), predicted_s);
            found.sum += (off_s / sd_s).powi(2);
            found.count += 1.0;
        }
        found
    }
}

/// The mean square of mismatches up to which echoes are those of the simulation and of its scattered sound, in recordings of
/// `simulated` by a perfect microphone whose places are known so well.
///
/// Pressures are drawn anew of each recording's energies and picked as recordings are. The deviation of the mean square is that of a
/// ratio of sums over independent recordings.
///
/// # Source
/// W. G. Cochran, Sampling Techniques, 3rd ed. (1977), section 6.4, for the variance of a ratio.
pub(super) fn chance_threshold(
    simulator: &RoomSimulator,
    simulated: &[&SimulatedResponse],
    (time_sd_s, place_sd_s): (f64, f64),
    key: RandomKey,
) -> f64 {
    let draws: Vec<[EchoMismatch; DRAWS]> = simulated
        .iter()
        .enumerate()
        .map(|(recording, one)| {
            std::array::from_fn(|draw| {
                let key = key.child(recording as u64).child(draw as u64);
                let picked = arrivals::pick(&simulator.pressure(one, key), &one.times_s);
                let mut stream = key.child("places").stream();
                let zero_s = one.direct_s - picked.direct_s;
                EchoMismatch::of(&picked, &one.times_s, time_sd_s, || {
                    zero_s + place_sd_s * stream.normal()
                })
            })
        })
        .collect();
    let total = |of: fn(&EchoMismatch) -> f64| draws.iter().flatten().map(of).sum::<f64>();
    let count = total(|one| one.count);
    if count == 0.0 {
        return 0.0;
    }
    let mean = total(|one| one.sum) / count;
    let variance: f64 = draws
        .iter()
        .map(|draws| {
            let off = draws.map(|one| one.sum - mean * one.count);
            let middle = off.iter().sum::<f64>() / DRAWS as f64;
            let squares = off.iter().map(|one| (one - middle).powi(2));
            squares.sum::<f64>() / (DRAWS - 1) as f64
        })
        .sum();
    MEAN_FACTOR * mean + CHANCE_SDS * variance.sqrt() * DRAWS as f64 / count
}

#[cfg(test)]
mod tests {
    use super::super::RoomExperiment;
    use super::super::setup::RoomSetup;
    use crate::bundle::file::MeasurementDescription;
    use crate::bundle::{Bundle, MeasuredEpisode, MeasuredResponse};
    use crate::experiment::{Experiment as _, ParameterVector, StructureTest};
    use crate::options::CalibrationOptions;
    use dwell_acoustics::{AcousticConfig, Receiver, SoundSourcePose};
    use dwell_scene::parallel::Threads;
    use dwell_scene::random::RandomKey;
    use glam::Vec3;

    const SIZE_M: [f64; 3] = [5.0, 2.6, 4.0];

    /// What the engine's own recordings leave in a room that is described with this scattering, if each side stands so much further out.
    fn left(scattering: f64, further_m: [f64; 6], seed: u64) -> StructureTest {
        let side = format!(
            r#"{{"absorption": {{"centres_hz": [1000.0], "values": [0.25]}}, "scattering": {scattering}, "material": "wall"}}"#
        );
        let surfaces: Vec<String> = crate::bundle::ROOM_SURFACES
            .iter()
            .map(|name| format!(r#""{name}": {side}"#))
            .collect();
        let manifest: MeasurementDescription = serde_json::from_str(&format!(
            r#"{{"version": 1, "title": "t", "licence": "l", "kind": "impulse_response",
                "scene": {{"room": {{"size_m": {SIZE_M:?}, "surfaces": {{{}}}}}}}}}"#,
            surfaces.join(", ")
        ))
        .unwrap();
        let config = AcousticConfig {
            rate_hz: 24_000,
            rays: 2_000,
            max_duration_s: 0.2,
            ..AcousticConfig::full()
        };
        let room = manifest.scene.room.clone().unwrap();
        let stage = RoomSetup::of_box(&room, &further_m, config).unwrap();
        let mut stream = RandomKey::root(seed).stream();
        let episodes = (0..6)
            .map(|k| {
                let mut place = || SIZE_M.map(|edge| 0.5 + (edge - 1.0) * stream.uniform());
                let (source_m, receiver_m) = (place(), place());
                let there = |p: [f64; 3]| Vec3::from_array(p.map(|x| x as f32)) + stage.shift;
                let (source, receiver) = (
                    SoundSourcePose::omni(there(source_m)),
                    Receiver::omni(there(receiver_m)),
                );
                let key = RandomKey::root(100 * seed + k);
                let response = stage
                    .scene
                    .impulse_response(&stage.rays, &source, &receiver, key, Threads::ONE)
                    .unwrap();
                MeasuredEpisode {
                    name: k.to_string(),
                    group: k.to_string(),
                    responses: vec![MeasuredResponse {
                        source_m,
                        receiver_m,
                        rate_hz: config.rate_hz,
                        samples: response.samples,
                    }],
                    ..MeasuredEpisode::default()
                }
            })
            .collect();
        let bundle = Bundle {
            name: "r.measured".to_owned(),
            manifest,
            episodes,
        };
        let options = CalibrationOptions {
            rays: 800,
            ..CalibrationOptions::default()
        };
        let experiment = RoomExperiment::new(&bundle, &options).unwrap();
        let point = ParameterVector::start(&experiment);
        let found = experiment.structure(&[0, 1, 2, 3, 4, 5], &point).unwrap();
        found.unwrap()
    }

    /// Peaks of scattered sound are no echoes from elsewhere, however many there are.
    #[test]
    fn the_engine_s_own_recordings_leave_nothing() {
        for (scattering, seed) in [(0.0, 1), (0.05, 2), (0.2, 3), (0.2, 4), (0.5, 5)] {
            let found = left(scattering, [0.0; 6], seed);
            assert!(
                found.ratio <= found.threshold,
                "{scattering} {seed}: {found:?}"
            );
        }
    }

    /// Walls elsewhere are seen where sound is not much scattered, and the threshold is what it was where it is not at all.
    #[test]
    fn echoes_from_elsewhere_are_left_beside_scattered_sound() {
        for (scattering, seed) in [(0.0, 1), (0.05, 2)] {
            let found = left(scattering, [0.0, 0.0, 0.0, 0.5, 0.4, 0.0], seed);
            assert!(
                found.ratio > found.threshold,
                "{scattering} {seed}: {found:?}"
            );
            assert!(scattering > 0.0 || found.threshold < 1.601, "{found:?}");
        }
    }
}
