//! Free flight: each episode is a ball that flies through the engine's own physics.

use super::air::{air_density_kg_m3, gravity_m_s2};
use super::experiment_world::{ExperimentObject, ExperimentWorld, hermite_interpolation};
use super::tables::{channels, episode_data};
use super::{
    Cause, CauseBinding, ChannelInfo, EpisodeData, EpisodeParameters, Experiment, FitParameter,
    MeasurementFault, ModelChanges, ParameterIndex, ResidualStructure,
};
use crate::bundle::Bundle;
use crate::error::CalibrationError;
use crate::options::CalibrationOptions;
use dwell_physics::PhysicsConfig;
use dwell_scene::PartId;
use dwell_scene::law::LawRegime;
use glam::Vec3;

/// Number of samples from which an episode's start is estimated.
const START_SAMPLES: usize = 8;
/// The quantities that can be measured: positions, then spins.
const QUANTITIES: [&str; 6] = ["x", "y", "z", "wx", "wy", "wz"];
/// The first of the spins.
const FIRST_SPIN: usize = 3;
/// Acceleration of free fall between equator and pole at heights of up to 3 km, m/s².
const EARTH_GRAVITY_M_S2: [f64; 2] = [9.77, 9.84];
/// The precision of a local gravity that was measured, m/s².
const MEASURED_GRAVITY_M_S2: f64 = 2e-3;
/// The largest acceleration of free fall that is tried, m/s2; of a larger one that was told, twice that.
const STRONGEST_GRAVITY_M_S2: f64 = 30.0;
/// The address of gravity.
const GRAVITY: &str = "world/gravity_m_s2";
/// The ball in its tiny house.
const BALL: PartId = PartId(0);

/// Free flight of bodies.
pub(crate) struct FlightExperiment {
    episodes: Vec<EpisodeData>,
    /// The position in [`QUANTITIES`] of each channel.
    quantities: Vec<usize>,
    channels: Vec<ChannelInfo>,
    causes: Vec<Cause>,
    own: Vec<FitParameter>,
    own_starts: Vec<Start>,
    stages: Vec<ExperimentWorld>,
    /// The stage of each episode's body.
    stage_of: Vec<usize>,
    rate_hz: f64,
    gravity_m_s2: f64,
}

/// What a nuisance of an episode is the start of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Start {
    /// The position along an axis.
    Position(usize),
    /// The speed along an axis.
    Speed(usize),
    /// The spin about an axis.
    Spin(usize),
}

/// The simulated motion: value and rate of change of each quantity at equal steps. Shape (quantity, step).
type Tracks = [Vec<(f64, f64)>; 6];

impl FlightExperiment {
    /// Prepares the bodies of a bundle.
    pub(crate) fn new(
        bundle: &Bundle,
        options: &CalibrationOptions,
    ) -> Result<Self, CalibrationError> {
        let manifest = &bundle.manifest;
        let quantities: Vec<usize> = manifest
            .channels
            .iter()
            .filter_map(|channel| QUANTITIES.iter().position(|name| *name == channel.name))
            .collect();
        let (mut own, mut own_starts) = (Vec::new(), Vec::new());
        let mut add = |start: Start, name: String, unit: &str, step: f64| {
            own.push(FitParameter::nuisance(&name, unit, step));
            own_starts.push(start);
        };
        for (quantity, name) in QUANTITIES.iter().enumerate() {
            if !quantities.contains(&quantity) {
                continue;
            }
            if quantity < FIRST_SPIN {
                add(
                    Start::Position(quantity),
                    format!("start {name}"),
                    "m",
                    1e-3,
                );
                add(
                    Start::Speed(quantity),
                    format!("start speed {name}"),
                    "m/s",
                    2e-2,
                );
            } else {
                let axis = quantity - FIRST_SPIN;
                add(
                    Start::Spin(axis),
                    format!("start spin {name}"),
                    "rad/s",
                    0.1,
                );
            }
        }
        let reach = bundle
            .episodes
            .iter()
            .flat_map(|episode| &episode.samples)
            .filter(|sample| quantities[sample.channel] < FIRST_SPIN)
            .fold(0.0_f64, |reach, sample| reach.max(sample.value.abs()));
        let size_m = (4.0 * reach + 40.0).min(1000.0) as f32;
        let mut stages = Vec::new();
        for body in &manifest.scene.bodies {
            // `bundle::read` has required the radius.
            let ball =
                ExperimentObject::ball(&body.name, body.mass_kg, body.radius_m.unwrap_or(0.0));
            let config = PhysicsConfig {
                control_rate_hz: options.physics_rate_hz as f32,
                physics_rate_hz: options.physics_rate_hz as f32,
                sleeping: false,
                // Nothing touches and nothing holds: finer steps would only round more often.
                solver_substeps: 1,
                ..PhysicsConfig::default()
            };
            // Causes change what differs from the gravity that was told: the stage has it from the start.
            let gravity = [(GRAVITY, gravity_m_s2(manifest))];
            let stage = ExperimentWorld::new(size_m, &ball, config)?;
            stages.push(stage.with_laws_and_overrides(Vec::new(), &gravity)?);
        }
        Ok(Self {
            episodes: bundle
                .episodes
                .iter()
                .map(|episode| episode_data(bundle, episode))
                .collect(),
            channels: channels(bundle),
            causes: causes(bundle),
            stage_of: bundle
                .episodes
                .iter()
                .map(|episode| episode.samples[0].entity)
                .collect(),
            rate_hz: options.physics_rate_hz,
            quantities,
            own,
            own_starts,
            stages,
            gravity_m_s2: gravity_m_s2(manifest),
        })
    }

    /// The motion from a start on, for so long.
    fn fly(
        &self,
        episode: usize,
        intervention: ModelChanges,
        own: &[f64],
        duration_s: f64,
    ) -> Result<Tracks, CalibrationError> {
        let overrides: Vec<(&str, f64)> = intervention
            .overrides
            .iter()
            .map(|(address, value)| (address.as_str(), *value))
            .collect();
        let mut stage = self.stages[self.stage_of[episode]]
            .with_laws_and_overrides(intervention.laws, &overrides)?;
        let (mut position, mut velocity, mut spin) = ([0.0; 3], Vec3::ZERO, Vec3::ZERO);
        for (start, value) in self.own_starts.iter().zip(own) {
            match *start {
                Start::Position(axis) => position[axis] = *value,
                Start::Speed(axis) => velocity[axis] = *value as f32,
                Start::Spin(axis) => spin[axis] = *value as f32,
            }
        }
        let steps = (duration_s * self.rate_hz).ceil() as usize + 1;
        let start = stage.state.part_pose[BALL].position;
        stage.state.part_velocity[BALL].linear = velocity;
        stage.state.part_velocity[BALL].angular = spin;
        stage.adopt_state()?;
        let mut tracks: Tracks = std::array::from_fn(|_| Vec::with_capacity(steps + 1));
        for axis in 0..3 {
            tracks[axis].push((position[axis], f64::from(velocity[axis])));
            tracks[FIRST_SPIN + axis].push((f64::from(spin[axis]), 0.0));
        }
        for _ in 0..steps {
            stage.step()?;
            let there = stage.state.part_pose[BALL].position - start;
            let speed = stage.state.part_velocity[BALL];
            for axis in 0..3 {
                let place = position[axis] + f64::from(there[axis]);
                tracks[axis].push((place, f64::from(speed.linear[axis])));
                // What changes a spin in the air does so slowly: between two steps it is held.
                tracks[FIRST_SPIN + axis].push((f64::from(speed.angular[axis]), 0.0));
            }
        }
        Ok(tracks)
    }
}

/// What can act on a body in flight: laws of bodies, gravity, and the tracker's faults.
fn causes(bundle: &Bundle) -> Vec<Cause> {
    let manifest = &bundle.manifest;
    let density = ("air_density_kg_m3", air_density_kg_m3(manifest));
    let targets: Vec<String> = manifest
        .scene
        .bodies
        .iter()
        .map(|body| body.name.clone())
        .collect();
    let laws = dwell_physics::laws::all()
        .filter(|law| law.acts_on == "object" && law.regimes.contains(&LawRegime::Flight))
        .map(|law| Cause::of_law(law, &targets, &[density]));
    let faults = [
        MeasurementFault::LengthScale,
        MeasurementFault::ClockScale,
        MeasurementFault::FrameTilt,
    ]
    .map(MeasurementFault::cause);
    laws.chain([gravity(manifest)]).chain(faults).collect()
}

/// Another acceleration of free fall. Where it was measured on Earth, only that value is plausible; one that is told and none
/// of the Earth's may be a mistake.
fn gravity(manifest: &crate::bundle::file::MeasurementDescription) -> Cause {
    let told = gravity_m_s2(manifest);
    let [least, most] = EARTH_GRAVITY_M_S2;
    let is_told = manifest.scene.environment.g_m_s2.is_some();
    let plausible = if is_told && (least..=most).contains(&told) {
        [told - MEASURED_GRAVITY_M_S2, told + MEASURED_GRAVITY_M_S2]
    } else {
        [least.min(told), most.max(told)]
    };
    Cause {
        id: "gravity".into(),
        name: if is_told {
            "another acceleration of free fall than g_m_s2 tells".into()
        } else {
            "another acceleration of free fall".into()
        },
        equation: "dv/dt = -g, with g in m/s2".into(),
        parameters: vec![FitParameter {
            name: "gravity_m_s2".into(),
            unit: "m/s2".into(),
            default: told,
            low: 0.0,
            high: STRONGEST_GRAVITY_M_S2.max(2.0 * told).min(100.0),
            plausible,
            step: 0.2,
        }],
        probes: Vec::new(),
        separating_experiment: "throw flat and steep, slow and fast: gravity changes the vertical motion alone, by the same \
                                amount at every speed; for scales of lengths and of the clock, measure a known length and \
                                time a pendulum"
            .into(),
        binding: CauseBinding::Addresses(vec![GRAVITY.into()]),
        fixed: Vec::new(),
    }
}

impl Experiment for FlightExperiment {
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

    /// A time offset is none here: a flight that starts earlier starts elsewhere.
    fn shared_nuisances(&self) -> &[FitParameter] {
        &[]
    }

    fn episode_nuisances(&self) -> &[FitParameter] {
        &self.own
    }

    fn initial_nuisances(&self, episode: usize) -> Vec<f64> {
        let measured = &self.episodes[episode];
        let first = |quantity: usize, fall: f64| -> Vec<(f64, f64)> {
            (0..measured.measured.len())
                .filter(|k| self.quantities[measured.channel[*k]] == quantity)
                .take(START_SAMPLES)
                .map(|k| {
                    let t = measured.t_s[k];
                    (t, measured.measured[k] + fall * t.powi(2))
                })
                .collect()
        };
        let along = |axis: usize| {
            let fall = if axis == 1 {
                0.5 * self.gravity_m_s2
            } else {
                0.0
            };
            line(&first(axis, fall))
        };
        let starts = self.own_starts.iter().map(|start| match *start {
            Start::Position(axis) => along(axis).0,
            Start::Speed(axis) => along(axis).1,
            Start::Spin(axis) => line(&first(FIRST_SPIN + axis, 0.0)).0,
        });
        starts.collect()
    }

    fn predict(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
    ) -> Result<Vec<f64>, CalibrationError> {
        let measured = &self.episodes[episode];
        let intervention = ModelChanges::new(&self.causes, at.causes);
        let faults = intervention.faults;
        let last = measured.t_s.iter().copied().fold(0.0, f64::max);
        let duration_s = last / faults.clock_scale;
        let tracks = self.fly(episode, intervention, at.episode_nuisances, duration_s)?;
        let step_s = 1.0 / self.rate_hz;
        let written = |quantity: usize, t: f64| {
            let value =
                |quantity: usize, t: f64| hermite_interpolation(&tracks[quantity], step_s, t);
            if quantity >= FIRST_SPIN {
                return faults.sample(t, |t| value(quantity, t));
            }
            let weights = faults.axis_weights(quantity);
            faults.sample(t, |t| {
                let parts = weights
                    .iter()
                    .enumerate()
                    .filter(|(_, weight)| **weight != 0.0);
                parts.map(|(axis, weight)| weight * value(axis, t)).sum()
            })
        };
        let times = measured.t_s.iter().zip(&measured.channel);
        Ok(times
            .map(|(t, channel)| written(self.quantities[*channel], *t))
            .collect())
    }

    /// The start of a flight shifts all of it.
    fn derivative(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
        _base: &[f64],
        slot: ParameterIndex,
    ) -> Option<Vec<f64>> {
        let ParameterIndex::Own(k) = slot else {
            return None;
        };
        let Start::Position(axis) = self.own_starts[k] else {
            return None;
        };
        let faults = ModelChanges::new(&self.causes, at.causes).faults;
        let weight = |quantity: usize| {
            if quantity < FIRST_SPIN {
                faults.axis_weights(quantity)[axis]
            } else {
                0.0
            }
        };
        let channels = self.episodes[episode].channel.iter();
        Some(channels.map(|c| weight(self.quantities[*c])).collect())
    }
}

/// The line through points (t, y) by least squares: its value at 0 and its slope.
fn line(points: &[(f64, f64)]) -> (f64, f64) {
    let n = points.len().max(1) as f64;
    let mean_t = points.iter().map(|p| p.0).sum::<f64>() / n;
    let mean_y = points.iter().map(|p| p.1).sum::<f64>() / n;
    let spread: f64 = points.iter().map(|p| (p.0 - mean_t).powi(2)).sum();
    let slope = if spread > 0.0 {
        points
            .iter()
            .map(|p| (p.0 - mean_t) * (p.1 - mean_y))
            .sum::<f64>()
            / spread
    } else {
        0.0
    };
    (mean_y - slope * mean_t, slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::{ParameterVector, parameter_range};

    /// An experiment of the example's bodies and times, where gravity was told.
    fn experiment(told_m_s2: Option<f64>) -> FlightExperiment {
        let folder = tempfile::tempdir().unwrap();
        crate::example::write(folder.path(), 1).unwrap();
        let mut bundle = crate::bundle::read(folder.path()).unwrap();
        bundle.manifest.scene.environment.g_m_s2 = told_m_s2;
        FlightExperiment::new(&bundle, &CalibrationOptions::default()).unwrap()
    }

    /// No cause acts, or gravity alone: the fall is by the gravity that the manifest tells, or by the cause's.
    #[test]
    fn things_fall_by_the_gravity_that_was_told() {
        for (told, tried) in [
            (Some(1.62), None),
            (Some(1.62), Some(9.806_65)),
            (Some(0.0), None),
            (None, None),
        ] {
            let experiment = experiment(told);
            let mut causes = ParameterVector::start(&experiment).causes;
            let index = experiment
                .causes
                .iter()
                .position(|cause| cause.id == "gravity")
                .unwrap();
            let place = parameter_range(&experiment, index).start;
            assert_eq!(causes[place], told.unwrap_or(f64::from(9.806_65_f32)));
            causes[place] = tried.unwrap_or(causes[place]);
            let gravity = causes[place];
            let values = EpisodeParameters {
                causes: &causes,
                shared: &[],
                episode_nuisances: &[0.0, 0.0, 0.0, 2.0, 0.0, 0.0],
            };
            let found = experiment.predict(0, &values).unwrap();
            let measured = &experiment.episodes[0];
            for (k, found) in found
                .iter()
                .enumerate()
                .filter(|(k, _)| measured.channel[*k] == 1)
            {
                let t = measured.t_s[k];
                let exact = 2.0 * t - 0.5 * gravity * t * t;
                let drift = 0.5 * gravity * t / 240.0;
                assert!(
                    (found - exact).abs() < 2e-4 + drift,
                    "{told:?} {tried:?} {t}: {found} {exact}"
                );
            }
        }
    }

    /// Flights of the engine match closed forms: a parabola under any gravity, and Stokes' fall.
    #[test]
    fn flights_meet_their_closed_forms() {
        let experiment = experiment(None);
        let own = [1.0, 3.0, 1.5, 2.0, -1.0, 0.5];
        let (start, speed) = ([1.0, 1.5, -1.0], [3.0, 2.0, 0.5]);
        for (gravity, rate) in [(9.806_65, 0.0), (9.78, 0.0), (5.0, 0.0), (9.806_65, 0.7)] {
            let mut causes = ParameterVector::start(&experiment).causes;
            for (id, value) in [("viscous_damping", rate), ("gravity", gravity)] {
                let index = experiment.causes.iter().position(|cause| cause.id == id);
                causes[parameter_range(&experiment, index.unwrap()).start] = value;
            }
            let values = EpisodeParameters {
                causes: &causes,
                shared: &[],
                episode_nuisances: &own,
            };
            let found = experiment.predict(0, &values).unwrap();
            let measured = &experiment.episodes[0];
            for (k, found) in found.iter().enumerate() {
                let (t, axis) = (measured.t_s[k], measured.channel[k]);
                let pull = if axis == 1 { gravity } else { 0.0 };
                let exact = if rate > 0.0 {
                    let end = pull / rate;
                    start[axis] - end * t + (speed[axis] + end) * (1.0 - (-rate * t).exp()) / rate
                } else {
                    start[axis] + speed[axis] * t - 0.5 * pull * t * t
                };
                // The engine's first-order steps shift a fall by g t dt / 2, which the start takes up.
                let drift = 0.5 * pull * t / 240.0;
                assert!(
                    (found - exact).abs() < 2e-4 + drift,
                    "g {gravity}, c {rate}, axis {axis}, t {t}: {found} {exact}"
                );
            }
        }
    }
}
