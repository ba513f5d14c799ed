//! Free flight: each episode is a ball that flies through the engine's own physics.

use super::air::{air_density_kg_m3, gravity_m_s2};
use super::test_world::{ExperimentObject, ExperimentWorld, hermite_interpolation};
use super::{
    Cause, CauseBinding, ChannelInfo, EpisodeData, EpisodeParameters, FitParameter, ParameterIndex,
    ResidualStructure, Twin,
};
use crate::bundle::{Bundle, MeasuredSample};
use crate::error::CalibrationError;
use crate::options::Options;
use dwell_physics::PhysicsConfig;
use dwell_scene::{LawInfo, LawSpec};
use glam::Vec3;

/// Number of samples from which an episode's start is estimated.
const START_SAMPLES: usize = 8;

/// Free flight of bodies.
pub(crate) struct FlightTwin {
    episodes: Vec<EpisodeData>,
    /// The axis (0 x, 1 y, 2 z) of each channel.
    axes: Vec<usize>,
    channels: Vec<ChannelInfo>,
    causes: Vec<Cause>,
    own: Vec<FitParameter>,
    /// The axis and whether it is the speed, of each own nuisance.
    own_axes: Vec<(usize, bool)>,
    stages: Vec<ExperimentWorld>,
    /// The stage of each episode's body.
    stage_of: Vec<usize>,
    rate_hz: f64,
    gravity_m_s2: f64,
    air_density_kg_m3: f64,
    drag: &'static LawInfo,
}

impl FlightTwin {
    /// Prepares the bodies of a bundle.
    pub(crate) fn new(bundle: &Bundle, options: &Options) -> Result<Self, CalibrationError> {
        let manifest = &bundle.manifest;
        let axes: Vec<usize> = manifest
            .channels
            .iter()
            .map(|channel| match channel.name.as_str() {
                "x" => 0,
                "y" => 1,
                _ => 2,
            })
            .collect();
        let mut own = Vec::new();
        let mut own_axes = Vec::new();
        for (axis, letter) in ["x", "y", "z"].iter().enumerate() {
            if axes.contains(&axis) {
                own.push(FitParameter::nuisance(
                    &format!("start {letter}"),
                    "m",
                    1e-3,
                ));
                own.push(FitParameter::nuisance(
                    &format!("start speed {letter}"),
                    "m/s",
                    2e-2,
                ));
                own_axes.extend([(axis, false), (axis, true)]);
            }
        }
        let reach = bundle
            .episodes
            .iter()
            .flat_map(|episode| &episode.samples)
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
            stages.push(ExperimentWorld::new(size_m, &ball, config)?);
        }
        let air_density_kg_m3 = air_density_kg_m3(manifest);
        let gravity_m_s2 = gravity_m_s2(manifest);
        let drag = LawInfo::find(dwell_physics::laws::all(), "drag")
            .map_err(|error| CalibrationError::simulation(&bundle.name, error))?;
        Ok(Self {
            episodes: bundle
                .episodes
                .iter()
                .map(|episode| episode_data(bundle, episode))
                .collect(),
            channels: channels(bundle),
            causes: causes(drag, gravity_m_s2, air_density_kg_m3),
            stage_of: bundle
                .episodes
                .iter()
                .map(|episode| episode.samples[0].entity)
                .collect(),
            rate_hz: options.physics_rate_hz,
            air_density_kg_m3,
            axes,
            own,
            own_axes,
            stages,
            gravity_m_s2,
            drag,
        })
    }

    fn laws(&self, causes: &[f64]) -> Vec<LawSpec> {
        if causes[0] > 0.0 {
            let density = ("air_density_kg_m3", self.air_density_kg_m3);
            vec![self.drag.spec(&[("c_d", causes[0]), density])]
        } else {
            Vec::new()
        }
    }
}

/// The channels as fitting sees them.
pub(super) fn channels(bundle: &Bundle) -> Vec<ChannelInfo> {
    let channels = bundle.manifest.channels.iter();
    channels
        .map(|channel| ChannelInfo {
            name: channel.name.clone(),
            unit: if channel.unit == "m" { "m" } else { "rad" },
            noise_known: channel.noise_sd.is_some(),
        })
        .collect()
}

/// An episode's numbers, with times from its first sample on.
pub(super) fn episode_data(
    bundle: &Bundle,
    episode: &crate::bundle::MeasuredEpisode,
) -> EpisodeData {
    let first = episode
        .samples
        .iter()
        .map(|s| s.t_s)
        .fold(f64::INFINITY, f64::min);
    let column =
        |f: &dyn Fn(&MeasuredSample) -> f64| episode.samples.iter().map(f).collect::<Vec<f64>>();
    EpisodeData {
        name: episode.name.clone(),
        group: episode.group.clone(),
        measured: column(&|s| s.value),
        channel: episode.samples.iter().map(|s| s.channel).collect(),
        t_s: column(&|s| s.t_s - first),
        sd: column(&|s| bundle.manifest.channels[s.channel].noise_sd.unwrap_or(1.0)),
    }
}

fn causes(drag: &LawInfo, gravity_m_s2: f64, air_density_kg_m3: f64) -> Vec<Cause> {
    let number =
        |name: &str, unit: &str, default: f64, bounds: [f64; 2], plausible: [f64; 2], step: f64| {
            FitParameter {
                name: name.to_owned(),
                unit: unit.to_owned(),
                default,
                low: bounds[0],
                high: bounds[1],
                plausible,
                step,
            }
        };
    vec![
        Cause {
            id: drag.id.to_owned(),
            name: drag.name.to_owned(),
            equation: drag.equation.to_owned(),
            parameters: FitParameter::from_law(drag, "c_d", 0.05).into_iter().collect(),
            separating_experiment: drag.separating_experiment.to_owned(),
            installs_as: CauseBinding::Law {
                version: drag.version,
                target: None,
            },
            fixed: vec![("air_density_kg_m3".into(), air_density_kg_m3)],
            starts: vec![0.1, 0.5],
        },
        Cause {
            id: "viscous_damping".into(),
            name: "drag in proportion to speed".into(),
            equation: "dv/dt = -c v, with c in 1/s".into(),
            // Air's viscosity alone gives 0.001 to 0.1 1/s to balls of 1 to 10 cm; more is dust, not indoor air.
            parameters: vec![number("rate_per_s", "1/s", 0.0, [0.0, 20.0], [1e-4, 2.0], 0.01)],
            separating_experiment: "throw at speeds that differ by a factor of three or more: the deceleration grows with \
                                    the speed here, with its square in quadratic drag"
                .into(),
            installs_as: CauseBinding::Unsupported,
            fixed: Vec::new(),
            starts: vec![0.05, 0.3],
        },
        Cause {
            id: "gravity".into(),
            name: "another acceleration of free fall (or scale of lengths, or of the clock)".into(),
            equation: "dv/dt = -g, with g in m/s2; a wrong length scale s and clock scale tau look like g s/tau^2".into(),
            // Between equator and pole, and a percent of length or clock error.
            parameters: vec![number("gravity_m_s2", "m/s2", gravity_m_s2, [0.0, 30.0], [9.7, 9.9], 0.2)],
            separating_experiment: "throw flat and steep, slow and fast: gravity changes the vertical motion alone, by the \
                                    same amount at every speed; time a pendulum of known length"
                .into(),
            installs_as: CauseBinding::Addresses(vec!["world/gravity_m_s2".into()]),
            fixed: Vec::new(),
            starts: vec![],
        },
    ]
}

impl Twin for FlightTwin {
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
        self.own_axes
            .iter()
            .map(|(axis, speed)| {
                let fall = if *axis == 1 {
                    0.5 * self.gravity_m_s2
                } else {
                    0.0
                };
                let first: Vec<(f64, f64)> = (0..measured.measured.len())
                    .filter(|k| self.axes[measured.channel[*k]] == *axis)
                    .take(START_SAMPLES)
                    .map(|k| {
                        (
                            measured.t_s[k],
                            measured.measured[k] + fall * measured.t_s[k].powi(2),
                        )
                    })
                    .collect();
                let (position, rate) = line(&first);
                if *speed { rate } else { position }
            })
            .collect()
    }

    fn predict(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
    ) -> Result<Vec<f64>, CalibrationError> {
        let measured = &self.episodes[episode];
        let mut laws = self.laws(at.causes);
        let overrides = [("world/gravity_m_s2", at.causes[2])];
        let mut stage = self.stages[self.stage_of[episode]]
            .with_laws_and_overrides(std::mem::take(&mut laws), &overrides)?;
        let (mut position, mut velocity) = ([0.0; 3], Vec3::ZERO);
        for ((axis, speed), value) in self.own_axes.iter().zip(at.episode_nuisances) {
            if *speed {
                velocity[*axis] = *value as f32;
            } else {
                position[*axis] = *value;
            }
        }
        let step_s = 1.0 / self.rate_hz;
        let duration = measured.t_s.iter().copied().fold(0.0, f64::max);
        let steps = (duration * self.rate_hz).ceil() as usize + 1;
        let part = dwell_scene::PartId(0);
        let start = stage.state.part_pose[part].position;
        // Viscous damping is no law of the engine: it acts between the steps, half of it before the first.
        let keep = (-at.causes[1] * step_s).exp() as f32;
        stage.state.part_velocity[part].linear = velocity * keep.sqrt();
        stage.adopt_state()?;
        let mut tracks: [Vec<(f64, f64)>; 3] =
            std::array::from_fn(|_| Vec::with_capacity(steps + 1));
        for axis in 0..3 {
            tracks[axis].push((position[axis], f64::from(velocity[axis])));
        }
        for _ in 0..steps {
            stage.step()?;
            let there = stage.state.part_pose[part].position - start;
            let speed = stage.state.part_velocity[part].linear;
            for axis in 0..3 {
                tracks[axis].push((
                    position[axis] + f64::from(there[axis]),
                    f64::from(speed[axis]),
                ));
            }
            if keep < 1.0 {
                stage.state.part_velocity[part].linear = speed * keep;
                stage.adopt_state()?;
            }
        }
        let times = measured.t_s.iter().zip(&measured.channel);
        Ok(times
            .map(|(t, channel)| hermite_interpolation(&tracks[self.axes[*channel]], step_s, *t))
            .collect())
    }

    /// The start of a flight shifts all of it.
    fn derivative(
        &self,
        episode: usize,
        _at: &EpisodeParameters<'_>,
        _base: &[f64],
        slot: ParameterIndex,
    ) -> Option<Vec<f64>> {
        let ParameterIndex::Own(k) = slot else {
            return None;
        };
        let (axis, speed) = self.own_axes[k];
        let channels = self.episodes[episode].channel.iter();
        (!speed).then(|| {
            channels
                .map(|c| f64::from(u8::from(self.axes[*c] == axis)))
                .collect()
        })
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

    fn twin() -> FlightTwin {
        let folder = tempfile::tempdir().unwrap();
        crate::example::write(folder.path(), 1).unwrap();
        let bundle = crate::bundle::read(folder.path()).unwrap();
        FlightTwin::new(&bundle, &Options::default()).unwrap()
    }

    /// Flights of the engine match closed forms: a parabola under any gravity, and Stokes' fall.
    #[test]
    fn flights_meet_their_closed_forms() {
        let twin = twin();
        let own = [1.0, 3.0, 1.5, 2.0, -1.0, 0.5];
        let (start, speed) = ([1.0, 1.5, -1.0], [3.0, 2.0, 0.5]);
        for (gravity, rate) in [(9.806_65, 0.0), (9.78, 0.0), (5.0, 0.0), (9.806_65, 0.7)] {
            let values = EpisodeParameters {
                causes: &[0.0, rate, gravity],
                shared: &[],
                episode_nuisances: &own,
            };
            let found = twin.predict(0, &values).unwrap();
            let measured = &twin.episodes[0];
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
