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
use crate::median::median;
use crate::options::CalibrationOptions;
use dwell_physics::PhysicsConfig;
use dwell_scene::{JointCommand, JointId, Servo};

/// Edge of the box around the servo, m.
const ROOM_M: f32 = 4.0;
/// The clock that stamps commands where the manifest does not say.
const CONTROLLER_CLOCK: &str = "controller";
/// Largest offset between the two clocks, s.
const MOST_OFFSET_S: f64 = 0.2;
/// Largest square of a joint's turn in a step, and least part of its speed that a step keeps, for which gains are matched to steps.
const COARSEST: f64 = 2.0;
const LEAST_KEPT: f64 = 0.2;
/// Part of an interval by which even commands may be off.
const EVEN: f64 = 0.01;
/// Most steps in place of one, so that commands last whole numbers of them.
const MOST_MORE_STEPS: f64 = 1.5;
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
        let runs: Vec<(EpisodeData, Vec<(f64, f64)>)> = bundle
            .episodes
            .iter()
            .flat_map(|run| windows(bundle, run))
            .collect();
        let durations: Vec<f64> = runs.iter().map(|(run, _)| duration_s(run)).collect();
        let count = runs.len();
        let kept = spread_evenly(&durations, MOST_SIMULATED_S);
        let (episodes, commands): (_, Vec<Vec<(f64, f64)>>) = runs
            .into_iter()
            .enumerate()
            .filter(|(k, _)| kept.binary_search(k).is_ok())
            .map(|(_, run)| run)
            .unzip();
        let rate_hz = rate_for_commands(&commands, options.physics_rate_hz);
        let [stiffness, damping] = gains_of_steps(
            joint.inertia_kg_m2,
            [joint.stiffness_n_m_rad, joint.damping_n_m_s_rad],
            1.0 / rate_hz,
        );
        let servo = Servo {
            stiffness: stiffness as f32,
            damping: damping as f32,
            max_effort: joint.max_torque_n_m as f32,
            ..Servo::default()
        };
        let hinge = (servo, joint.friction_n_m as f32);
        let arm = ExperimentObject::arm(&joint.name, joint.inertia_kg_m2, hinge);
        let config = PhysicsConfig {
            control_rate_hz: rate_hz as f32,
            physics_rate_hz: rate_hz as f32,
            sleeping: false,
            ..PhysicsConfig::default()
        };
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
            rate_hz,
            commands,
        })
    }
}

/// The stiffness and damping with which a joint of the engine swings and settles, step by step, as one with `told` gains does
/// in continuous time. The engine takes a servo's effort as it is at the end of a step, which damps.
///
/// # Source
/// A step of h with v' = v + h a, q' = q + h (v + v') / 2 and I a = k (u - q - h v') - d v' has trace 2 - h B - h^2 A / 2 and
/// determinant 1 - h B + h^2 A / 2, with A = k / D, B = (d + k h) / D, D = I + h (d + k h). They are those of the motion, the sum and
/// the product of exp(h l) over its modes l (L. D. Landau, E. M. Lifshitz, Mechanics (1976), section 25), for one A and B.
fn gains_of_steps(inertia: f64, told: [f64; 2], step_s: f64) -> [f64; 2] {
    let [stiffness, damping] = told;
    let decay = 0.5 * damping / inertia * step_s;
    let turn = stiffness / inertia * step_s * step_s - decay * decay;
    let shape = if turn > 0.0 {
        libm::cos(turn.sqrt())
    } else {
        libm::cosh((-turn).sqrt())
    };
    let trace = 2.0 * libm::exp(-decay) * shape;
    let determinant = libm::exp(-2.0 * decay);
    let kept = 0.5 * (trace + determinant - 1.0);
    if turn > COARSEST || kept < LEAST_KEPT {
        // Such steps know nothing of how it settles.
        return told;
    }
    let resisted = inertia / kept;
    let matched = (1.0 + determinant - trace) / (step_s * step_s) * resisted;
    let resistance = (1.0 - kept) / step_s * resisted;
    // A joint with less damping than steps take away anyway gets none.
    [matched, (resistance - matched * step_s).max(0.0)]
}

/// The steps a second in which commands that come evenly last whole numbers of steps, from `least_hz` on; of others `least_hz`.
fn rate_for_commands(commands: &[Vec<(f64, f64)>], least_hz: f64) -> f64 {
    let gaps = commands
        .iter()
        .flat_map(|run| run.windows(2).map(|pair| pair[1].0 - pair[0].0));
    let mut gaps: Vec<f64> = gaps.collect();
    let typical = median(&mut gaps);
    let even = gaps
        .iter()
        .filter(|gap| (*gap - typical).abs() < EVEN * typical);
    if typical <= 0.0 || 10 * even.count() < 9 * gaps.len() {
        return least_hz;
    }
    let rate_hz = (typical * least_hz - EVEN).ceil().max(1.0) / typical;
    if rate_hz <= MOST_MORE_STEPS * least_hz {
        rate_hz
    } else {
        least_hz
    }
}

/// The mean of what is told over each step: `commands` hold until the next, the first is `held`.
fn means_over_steps(commands: &[(f64, f64)], held: f64, step_s: f64, steps: usize) -> Vec<f64> {
    let (mut next, mut value) = (0, held);
    let mean = |k: usize| {
        let (mut now, end) = (k as f64 * step_s, (k + 1) as f64 * step_s);
        let mut sum = 0.0;
        while next < commands.len() && commands[next].0 < end {
            let change = commands[next].0.max(now);
            sum += value * (change - now);
            (now, value) = (change, commands[next].1);
            next += 1;
        }
        (sum + value * (end - now)) / step_s
    };
    (0..steps).map(mean).collect()
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
        let step_s = 1.0 / self.rate_hz;
        let most_offset = if self.shared.is_empty() {
            0.0
        } else {
            MOST_OFFSET_S
        };
        let duration = duration_s(measured) + most_offset;
        let steps = (duration * self.rate_hz).ceil() as usize + 1;
        // Until the first command the servo holds where it stands.
        let scale = faults.command_scale;
        let held = at.episode_nuisances[0] / scale;
        let targets = means_over_steps(&self.commands[episode], held, step_s, steps);
        let mut track = Vec::with_capacity(steps + 1);
        track.push((at.episode_nuisances[0], 0.0));
        for target in targets {
            stage.state.joint_command[joint] = JointCommand::Position((scale * target) as f32);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A joint of the engine at 240 steps a second meets the closed form of a damped oscillator's step.
    #[test]
    fn a_step_is_that_of_a_damped_oscillator() {
        let (inertia, stiffness): (f64, f64) = (0.002, 3.0);
        let (asked, step_s) = (0.3, 1.0 / 240.0);
        let frequency = (stiffness / inertia).sqrt();
        for ratio in [0.5_f64, 0.9] {
            let damping = 2.0 * ratio * (inertia * stiffness).sqrt();
            let [k, d] = gains_of_steps(inertia, [stiffness, damping], step_s);
            let servo = Servo {
                stiffness: k as f32,
                damping: d as f32,
                max_effort: 10.0,
                ..Servo::default()
            };
            let arm = ExperimentObject::arm("arm", inertia, (servo, 0.0));
            let config = PhysicsConfig {
                control_rate_hz: 240.0,
                physics_rate_hz: 240.0,
                sleeping: false,
                ..PhysicsConfig::default()
            };
            let mut stage = ExperimentWorld::new(ROOM_M, &arm, config).unwrap();
            let mut track = vec![(0.0, 0.0)];
            for _ in 0..120 {
                stage.state.joint_command[JointId(0)] = JointCommand::Position(asked as f32);
                stage.step().unwrap();
                let position = stage.state.joint_position[JointId(0)];
                let velocity = stage.state.joint_velocity[JointId(0)];
                track.push((f64::from(position), f64::from(velocity)));
            }
            let damped = frequency * (1.0 - ratio * ratio).sqrt();
            for k in 1..40 {
                let t = 0.01 * f64::from(k);
                let swing =
                    libm::cos(damped * t) + ratio * frequency / damped * libm::sin(damped * t);
                let exact = asked * (1.0 - libm::exp(-ratio * frequency * t) * swing);
                let found = hermite_interpolation(&track, step_s, t);
                assert!(
                    (found - exact).abs() < 0.003 * asked,
                    "{ratio} {t}: {found} {exact}"
                );
            }
        }
    }

    #[test]
    fn a_step_is_told_the_mean_of_its_commands() {
        let commands = [(0.0, 1.0), (1.25, 3.0), (1.75, 0.0), (2.0, 4.0)];
        let found = means_over_steps(&commands, 9.0, 1.0, 4);
        assert_eq!(found, [1.0, 0.25 + 1.5, 4.0, 4.0]);
        assert_eq!(means_over_steps(&[(0.5, 1.0)], 3.0, 1.0, 2), [2.0, 1.0]);
    }
}
