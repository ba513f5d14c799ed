//! A servo: each episode is a run of commands through the engine's own joint. Long runs are cut where the joint rests.

use super::experiment_world::{ExperimentObject, ExperimentWorld, hermite_interpolation};
use super::tables::{channels, episode_data};
use super::windows::{LONG_S, spread_evenly, windows_between_rests};
use super::{
    Cause, ChannelInfo, EpisodeData, EpisodeParameters, Experiment, FitParameter, MeasurementFault,
    ModelChanges, ResidualStructure,
};
use crate::bundle::Bundle;
use crate::error::CalibrationError;
use crate::options::CalibrationOptions;
use dwell_physics::PhysicsConfig;
use dwell_scene::{JointCommand, JointId, Servo};

/// Edge of the box around the servo, m.
const ROOM_M: f32 = 4.0;
/// The clock that stamps commands where the manifest does not say.
const CONTROLLER_CLOCK: &str = "controller";
/// Largest offset between the two clocks, s.
const MOST_OFFSET_S: f64 = 0.2;
/// Longest time that is simulated of all runs together, s.
const MOST_SIMULATED_S: f64 = 60.0;

/// A joint that is driven by a position servo.
pub(crate) struct ServoExperiment {
    episodes: Vec<EpisodeData>,
    channels: Vec<ChannelInfo>,
    causes: Vec<Cause>,
    shared: Vec<FitParameter>,
    own: Vec<FitParameter>,
    /// (time from the episode's first sample, target) of each episode, by time; the first is the one that was in force.
    commands: Vec<Vec<(f64, f64)>>,
    /// Windows of which `episodes` are an even choice.
    windows: usize,
    stage: ExperimentWorld,
    rate_hz: f64,
}

impl ServoExperiment {
    /// Prepares the joint of a bundle.
    pub(crate) fn new(
        bundle: &Bundle,
        options: &CalibrationOptions,
    ) -> Result<Self, CalibrationError> {
        let joint = &bundle.manifest.scene.joints[0];
        let servo = Servo {
            stiffness: joint.stiffness_n_m_rad as f32,
            damping: joint.damping_n_m_s_rad as f32,
            max_effort: joint.max_torque_n_m as f32,
            ..Servo::default()
        };
        let hinge = (servo, joint.friction_n_m as f32);
        let arm = ExperimentObject::arm(&joint.name, joint.inertia_kg_m2, hinge);
        let config = PhysicsConfig {
            control_rate_hz: options.physics_rate_hz as f32,
            physics_rate_hz: options.physics_rate_hz as f32,
            sleeping: false,
            ..PhysicsConfig::default()
        };
        let runs: Vec<(EpisodeData, Vec<(f64, f64)>)> = bundle
            .episodes
            .iter()
            .flat_map(|run| windows(bundle, run))
            .collect();
        let durations: Vec<f64> = runs.iter().map(|(run, _)| duration_s(run)).collect();
        let count = runs.len();
        let kept = spread_evenly(&durations, MOST_SIMULATED_S);
        let (episodes, commands) = runs
            .into_iter()
            .enumerate()
            .filter(|(k, _)| kept.binary_search(k).is_ok())
            .map(|(_, run)| run)
            .unzip();
        let one_clock = bundle.manifest.channels.iter().all(|channel| {
            let commands = bundle.manifest.command_clock.as_deref();
            commands.unwrap_or(CONTROLLER_CLOCK) == channel.clock
        });
        Ok(Self {
            episodes,
            windows: count,
            channels: channels(bundle),
            causes: causes(&joint.name),
            shared: if one_clock {
                Vec::new()
            } else {
                let name = "time offset of commands against positions";
                vec![FitParameter::nuisance(name, "s", 2e-3).within(-MOST_OFFSET_S, MOST_OFFSET_S)]
            },
            own: vec![FitParameter::nuisance("start position", "rad", 2e-3).within(-3.0, 3.0)],
            stage: ExperimentWorld::new(ROOM_M, &arm, config)?,
            rate_hz: options.physics_rate_hz,
            commands,
        })
    }
}

/// The time from an episode's first sample to its last, s.
fn duration_s(episode: &EpisodeData) -> f64 {
    episode.t_s.iter().copied().fold(0.0, f64::max)
}

/// The windows of a run, each with its commands.
fn windows(
    bundle: &Bundle,
    run: &crate::bundle::MeasuredEpisode,
) -> Vec<(EpisodeData, Vec<(f64, f64)>)> {
    let whole = episode_data(bundle, run);
    let first = run
        .samples
        .iter()
        .map(|s| s.t_s)
        .fold(f64::INFINITY, f64::min);
    let commands: Vec<(f64, f64)> = run
        .commands
        .iter()
        .map(|command| (command.t_s - first, command.value))
        .collect();
    let times: Vec<f64> = commands.iter().map(|(t, _)| *t).collect();
    let found = windows_between_rests(&whole.t_s, &whole.measured, &times);
    if found.len() == 1 {
        return vec![(whole, commands)];
    }
    let window = |rows: std::ops::Range<usize>| {
        let (start, last) = (whole.t_s[rows.start], whole.t_s[rows.end - 1]);
        let data = EpisodeData {
            name: format!("{} from {start:.1} s", whole.name),
            group: whole.group.clone(),
            measured: whole.measured[rows.clone()].to_vec(),
            channel: whole.channel[rows.clone()].to_vec(),
            t_s: whole.t_s[rows.clone()].iter().map(|t| t - start).collect(),
            sd: whole.sd[rows].to_vec(),
        };
        // The command in force comes first.
        let from = times.partition_point(|t| *t <= start).saturating_sub(1);
        let own = commands[from..].iter();
        let own = own.take_while(|(t, _)| *t <= last + MOST_OFFSET_S);
        (data, own.map(|(t, value)| (t - start, *value)).collect())
    };
    found.into_iter().map(window).collect()
}

/// What can act on a driven joint: laws of joints, its friction and damping, and the scale of commands.
fn causes(joint: &str) -> Vec<Cause> {
    let laws = dwell_physics::laws::all()
        .filter(|law| law.acts_on == "joint")
        .map(|law| Cause::of_law(law, &[joint.to_owned()], &[]));
    laws.chain([
        MeasurementFault::CommandScale.cause(),
        MeasurementFault::Smoothing.cause(),
    ])
    .collect()
}

impl Experiment for ServoExperiment {
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
        &self.shared
    }

    fn episode_nuisances(&self) -> &[FitParameter] {
        &self.own
    }

    fn initial_nuisances(&self, episode: usize) -> Vec<f64> {
        vec![self.episodes[episode].measured[0]]
    }

    fn notes(&self) -> Vec<String> {
        let (kept, all) = (self.episodes.len(), self.windows);
        let thinned = (kept < all).then(|| {
            format!(
                "Runs longer than {LONG_S} s were cut where the joint rests; {kept} of {all} windows in which it moves, spread evenly over \
                 the runs, were simulated: {MOST_SIMULATED_S} s."
            )
        });
        thinned.into_iter().collect()
    }

    fn predict(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
    ) -> Result<Vec<f64>, CalibrationError> {
        let measured = &self.episodes[episode];
        let joint = JointId(0);
        let mut start = self.stage.clone();
        start.state.joint_position[joint] = at.episode_nuisances[0] as f32;
        start.adopt_state()?;
        let intervention = ModelChanges::new(&self.causes, at.causes);
        let faults = intervention.faults;
        // The law's memory begins where the joint stands, so it is installed after the joint was put there.
        let mut stage = start.with_laws_and_overrides(intervention.laws, &[])?;
        let commands = &self.commands[episode];
        let step_s = 1.0 / self.rate_hz;
        let duration = duration_s(measured) + MOST_OFFSET_S;
        let steps = (duration * self.rate_hz).ceil() as usize + 1;
        let mut track = Vec::with_capacity(steps + 1);
        track.push((at.episode_nuisances[0], 0.0));
        let mut next = 0;
        // Until the first command the servo holds where it stands.
        let mut target = at.episode_nuisances[0];
        for k in 0..steps {
            // A command counts from the step in whose middle it has come.
            let now = (k as f64 + 0.5) * step_s;
            while next < commands.len() && commands[next].0 <= now {
                target = faults.command_scale * commands[next].1;
                next += 1;
            }
            stage.state.joint_command[joint] = JointCommand::Position(target as f32);
            stage.step()?;
            let velocity = stage.state.joint_velocity[joint];
            track.push((
                f64::from(stage.state.joint_position[joint]),
                f64::from(velocity),
            ));
        }
        let offset = at.shared.first().copied().unwrap_or(0.0);
        let position = |t: f64| hermite_interpolation(&track, step_s, t + offset);
        Ok(measured
            .t_s
            .iter()
            .map(|t| faults.sample(*t, position))
            .collect())
    }
}
