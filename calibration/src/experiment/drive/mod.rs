//! Drives of a robot on two wheels: the measured turns of its wheels drive the engine's own base.
//!
//! Long drives are cut into windows with a start of their own: what a wheel did not grip once must not be carried along to
//! the end of the drive.

mod recording;
mod rig;

use super::windows::spread_evenly;
use super::{
    Cause, ChannelInfo, EpisodeData, EpisodeParameters, Experiment, FitParameter, MeasurementFault,
    ModelChanges, ParameterIndex, ResidualStructure,
};
use crate::bundle::Bundle;
use crate::error::CalibrationError;
use dwell_scene::law::LawRegime;
use recording::{DriveRecordings, NominalWheelGeometry};
use rig::DriveRig;

/// Duration of a window, s.
const WINDOW_S: f64 = 10.0;
/// Longest time that is simulated of all drives together, s.
const MOST_SIMULATED_S: f64 = 1200.0;
/// Samples below which the rest of a drive is no window of its own.
const FEWEST: usize = 40;
/// What the tracker sees: places in m, the heading in rad.
const CHANNELS: [(&str, &str); 3] = [("x", "m"), ("y", "m"), ("heading", "rad")];

/// A base on two wheels, windows of whose drives are the episodes.
pub(crate) struct DriveExperiment {
    episodes: Vec<EpisodeData>,
    channels: Vec<ChannelInfo>,
    causes: Vec<Cause>,
    own: Vec<FitParameter>,
    base: NominalWheelGeometry,
    rate_hz: f64,
    /// Rotations of the wheels from sample to sample of each window, rad. Shape (window, sample - 1).
    turned_rad: Vec<Vec<[f64; 2]>>,
    /// Windows of which `episodes` are an even choice.
    windows: usize,
}

impl DriveExperiment {
    /// Prepares the drives of a bundle.
    pub(crate) fn new(bundle: &Bundle) -> Result<Self, CalibrationError> {
        let drives = DriveRecordings::of(bundle)?;
        let samples = ((WINDOW_S * drives.rate_hz).round() as usize).max(FEWEST);
        let (mut episodes, mut turned_rad) =
            (Vec::<EpisodeData>::new(), Vec::<Vec<[f64; 2]>>::new());
        for drive in &drives.episodes {
            let count = drive.planar_poses.len();
            for first in (0..count).step_by(samples) {
                let end = (first + samples).min(count);
                if end - first < FEWEST {
                    continue;
                }
                let mut window = EpisodeData {
                    name: format!("{} from {:.1} s", drive.name, first as f64 / drives.rate_hz),
                    group: drive.group.clone(),
                    ..EpisodeData::default()
                };
                for channel in 0..CHANNELS.len() {
                    for (k, pose) in drive.planar_poses[first..end].iter().enumerate() {
                        window.measured.push(pose[channel]);
                        window.channel.push(channel);
                        window.t_s.push(k as f64 / drives.rate_hz);
                        window.sd.push(1.0);
                    }
                }
                episodes.push(window);
                turned_rad.push(drive.wheel_rotation_rad[first + 1..end].to_vec());
            }
        }
        let durations: Vec<f64> = turned_rad
            .iter()
            .map(|turned| turned.len() as f64 / drives.rate_hz)
            .collect();
        let windows = episodes.len();
        let kept = spread_evenly(&durations, MOST_SIMULATED_S);
        let episodes = kept
            .iter()
            .map(|k| std::mem::take(&mut episodes[*k]))
            .collect();
        let turned_rad = kept
            .iter()
            .map(|k| std::mem::take(&mut turned_rad[*k]))
            .collect();
        let laws = dwell_physics::laws::all()
            .filter(|law| law.acts_on == "agent" && law.regimes.contains(&LawRegime::Driven))
            .map(|law| Cause::of_law(law, &[], &[]));
        let faults = [
            MeasurementFault::LengthScale,
            MeasurementFault::HeadingOffset,
            MeasurementFault::TrackerDelay,
        ];
        Ok(Self {
            channels: CHANNELS
                .iter()
                .map(|(name, unit)| ChannelInfo {
                    name: (*name).into(),
                    unit: (*unit).into(),
                    noise_known: false,
                })
                .collect(),
            causes: laws.chain(faults.map(MeasurementFault::cause)).collect(),
            own: vec![
                FitParameter::nuisance("start x", "m", 1e-3),
                FitParameter::nuisance("start y", "m", 1e-3),
                FitParameter::nuisance("start heading", "rad", 1e-3),
            ],
            base: drives.base,
            rate_hz: drives.rate_hz,
            episodes,
            turned_rad,
            windows,
        })
    }
}

impl Experiment for DriveExperiment {
    fn episodes(&self) -> &[EpisodeData] {
        &self.episodes
    }

    fn episodes_mut(&mut self) -> &mut [EpisodeData] {
        &mut self.episodes
    }

    fn channels(&self) -> &[ChannelInfo] {
        &self.channels
    }

    fn residual_structure(&self) -> ResidualStructure {
        ResidualStructure::OverTime
    }

    fn causes(&self) -> &[Cause] {
        &self.causes
    }

    fn shared_nuisances(&self) -> &[FitParameter] {
        &[]
    }

    fn episode_nuisances(&self) -> &[FitParameter] {
        &self.own
    }

    fn initial_nuisances(&self, episode: usize) -> Vec<f64> {
        let measured = &self.episodes[episode].measured;
        let samples = measured.len() / CHANNELS.len();
        (0..CHANNELS.len()).map(|k| measured[k * samples]).collect()
    }

    fn notes(&self) -> Vec<String> {
        let (kept, all) = (self.episodes.len(), self.windows);
        let thinned = (kept < all).then(|| {
            format!(
                "{kept} of {all} windows of {WINDOW_S} s, spread evenly over the drives, were simulated: \
                 {MOST_SIMULATED_S} s."
            )
        });
        thinned.into_iter().collect()
    }

    fn predict(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
    ) -> Result<Vec<f64>, CalibrationError> {
        let intervention = ModelChanges::new(&self.causes, at.causes);
        let faults = intervention.faults;
        let rig = DriveRig::new(&self.base, self.rate_hz, intervention.laws)?;
        let path = rig.simulated_path(&self.turned_rad[episode], self.rate_hz)?;
        let [x, y, heading] = at.episode_nuisances else {
            return Err(CalibrationError::simulation(
                "a drive",
                "its start is three numbers",
            ));
        };
        let (sin, cos) = libm::sincos(*heading);
        let place = |axis: usize, k: usize| {
            let [forward, left, turned] = path[k];
            match axis {
                0 => x + cos * forward - sin * left,
                1 => y + sin * forward + cos * left,
                _ => heading + turned,
            }
        };
        let truth = |axis: usize, t_s: f64| {
            let at = (t_s * self.rate_hz).clamp(0.0, (path.len() - 1) as f64);
            let k = (at.floor() as usize).min(path.len().saturating_sub(2));
            let share = at - k as f64;
            place(axis, k) * (1.0 - share) + place(axis, (k + 1).min(path.len() - 1)) * share
        };
        let measured = &self.episodes[episode];
        let stamps = measured.t_s.iter().zip(&measured.channel);
        Ok(stamps
            .map(|(t_s, channel)| {
                let value = faults.sample(*t_s, |t| truth(*channel, t));
                if *channel < 2 {
                    value * faults.length_scale
                } else {
                    value + faults.heading_offset_rad
                }
            })
            .collect())
    }

    /// A start moves and turns the whole path.
    fn derivative(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
        base: &[f64],
        slot: ParameterIndex,
    ) -> Option<Vec<f64>> {
        let ParameterIndex::Own(k) = slot else {
            return None;
        };
        let channel = &self.episodes[episode].channel;
        let samples = base.len() / CHANNELS.len();
        let faults = ModelChanges::new(&self.causes, at.causes).faults;
        let scale = faults.length_scale;
        let [x, y, _] = at.episode_nuisances else {
            return None;
        };
        let of = |row: usize| match (k, channel[row]) {
            (0, 0) | (1, 1) => scale,
            // d(x, y) / d heading is the way turned by a right angle.
            (2, 0) => -(base[row + samples] - scale * y),
            (2, 1) => base[row - samples] - scale * x,
            (2, 2) => 1.0,
            _ => 0.0,
        };
        Some((0..base.len()).map(of).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::ParameterVector;

    /// The derivatives by a start are those of differences.
    #[test]
    fn starts_move_and_turn_the_path() {
        let episodes = vec![EpisodeData {
            measured: vec![0.0; 12],
            channel: [[0; 4], [1; 4], [2; 4]].concat(),
            t_s: [[0.0, 0.1, 0.2, 0.3]; 3].concat(),
            sd: vec![1.0; 12],
            ..EpisodeData::default()
        }];
        let experiment = DriveExperiment {
            episodes,
            channels: Vec::new(),
            causes: vec![MeasurementFault::LengthScale.cause()],
            own: vec![FitParameter::nuisance("start", "m", 1e-4); 3],
            base: NominalWheelGeometry {
                wheel_radius_m: 0.05,
                wheel_base_m: 0.2,
            },
            rate_hz: 10.0,
            turned_rad: vec![vec![[0.5, 0.6], [0.2, 0.9], [0.7, 0.1]]],
            windows: 1,
        };
        let mut point = ParameterVector::start(&experiment);
        point.causes[0] = 1.1;
        point.episode_nuisances[0] = vec![0.4, -0.3, 0.8];
        let at = point.values(0);
        let base = experiment.predict(0, &at).unwrap();
        for k in 0..3 {
            let slot = ParameterIndex::Own(k);
            let exact = experiment.derivative(0, &at, &base, slot).unwrap();
            let differences = experiment.finite_difference(0, &at, &base, slot).unwrap();
            for (a, b) in exact.iter().zip(&differences) {
                assert!((a - b).abs() < 1e-3, "{k}: {a} {b}");
            }
        }
    }
}
