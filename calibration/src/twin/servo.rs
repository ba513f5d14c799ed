//! A servo: each episode is a run of commands through the engine's own joint.

use super::flight::{channels, episode_data};
use super::test_world::{ExperimentObject, ExperimentWorld, hermite_interpolation};
use super::{
    Cause, CauseBinding, ChannelInfo, EpisodeData, EpisodeParameters, FitParameter,
    ResidualStructure, Twin,
};
use crate::bundle::Bundle;
use crate::error::CalibrationError;
use crate::options::Options;
use dwell_physics::PhysicsConfig;
use dwell_scene::{JointCommand, JointId, LawInfo, Servo};

/// Edge of the box around the servo, m.
const ROOM_M: f32 = 4.0;
/// Largest offset between the two clocks, s.
const MOST_OFFSET_S: f64 = 0.2;

/// A joint that is driven by a position servo.
pub(crate) struct ServoTwin {
    episodes: Vec<EpisodeData>,
    channels: Vec<ChannelInfo>,
    causes: Vec<Cause>,
    shared: Vec<FitParameter>,
    own: Vec<FitParameter>,
    /// (time from the episode's first sample, target) of each episode, by time.
    commands: Vec<Vec<(f64, f64)>>,
    stage: ExperimentWorld,
    rate_hz: f64,
    backlash: &'static LawInfo,
    friction_n_m: f64,
}

impl ServoTwin {
    /// Prepares the joint of a bundle.
    pub(crate) fn new(bundle: &Bundle, options: &Options) -> Result<Self, CalibrationError> {
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
        let backlash = LawInfo::find(dwell_physics::laws::all(), "backlash")
            .map_err(|error| CalibrationError::simulation(&bundle.name, error))?;
        let commands = bundle
            .episodes
            .iter()
            .map(|episode| {
                let first = episode
                    .samples
                    .iter()
                    .map(|s| s.t_s)
                    .fold(f64::INFINITY, f64::min);
                episode
                    .commands
                    .iter()
                    .map(|command| (command.t_s - first, command.value))
                    .collect()
            })
            .collect();
        Ok(Self {
            episodes: bundle
                .episodes
                .iter()
                .map(|episode| episode_data(bundle, episode))
                .collect(),
            channels: channels(bundle),
            causes: causes(
                backlash,
                &joint.name,
                joint.friction_n_m,
                joint.stiffness_n_m_rad,
            ),
            shared: vec![
                FitParameter::nuisance("time offset of commands against positions", "s", 2e-3)
                    .within(-MOST_OFFSET_S, MOST_OFFSET_S),
            ],
            own: vec![FitParameter::nuisance("start position", "rad", 2e-3).within(-3.0, 3.0)],
            stage: ExperimentWorld::new(ROOM_M, &arm, config)?,
            rate_hz: options.physics_rate_hz,
            friction_n_m: joint.friction_n_m,
            commands,
            backlash,
        })
    }
}

fn causes(backlash: &LawInfo, joint: &str, friction_n_m: f64, stiffness: f64) -> Vec<Cause> {
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
    // The torque of a target that is off by so many radians.
    let torque = |rad: f64| rad * stiffness;
    vec![
        Cause {
            id: backlash.id.to_owned(),
            name: backlash.name.to_owned(),
            equation: backlash.equation.to_owned(),
            parameters: FitParameter::from_law(backlash, "half_width", 1e-3).into_iter().collect(),
            separating_experiment: backlash.separating_experiment.to_owned(),
            installs_as: CauseBinding::Law {
                version: backlash.version,
                target: Some(joint.to_owned()),
            },
            fixed: Vec::new(),
            starts: vec![0.005, 0.02, 0.06],
        },
        Cause {
            id: "joint_friction".into(),
            name: "more Coulomb friction in the joint".into(),
            equation: "torque = -F sign(velocity), with F in N m".into(),
            parameters: vec![number(
                "friction_n_m",
                "N m",
                friction_n_m,
                [0.0, friction_n_m + torque(1.0)],
                [friction_n_m + torque(1e-4), friction_n_m + torque(0.3)],
                torque(2e-3),
            )],
            separating_experiment: "stiffen the servo: what friction holds back shrinks with its stiffness, what backlash \
                                    holds back does not"
                .into(),
            installs_as: CauseBinding::Unsupported,
            fixed: Vec::new(),
            starts: [0.005, 0.02].map(|rad| friction_n_m + torque(rad)).to_vec(),
        },
        Cause {
            id: "joint_damping".into(),
            name: "more viscous damping in the joint".into(),
            equation: "torque = -d velocity, with d in N m s/rad".into(),
            parameters: vec![number(
                "damping_n_m_s_rad",
                "N m s/rad",
                0.0,
                [0.0, torque(1.0)],
                [torque(1e-4), torque(0.3)],
                torque(1e-3),
            )],
            separating_experiment: "move slowly and fast: what damping holds back grows with the speed".into(),
            installs_as: CauseBinding::Unsupported,
            fixed: Vec::new(),
            starts: vec![torque(0.005), torque(0.03)],
        },
        Cause {
            id: "deadband".into(),
            name: "a deadband of the controller".into(),
            equation: "the motor is told u only while |u - position| > d (rad), else to stay where it is".into(),
            parameters: vec![number("half_width_rad", "rad", 0.0, [0.0, 1.0], [5e-4, 0.1], 2e-3)],
            separating_experiment: "approach one target from both sides in small steps: a deadband has no memory, backlash \
                                    stays on the side it came from"
                .into(),
            installs_as: CauseBinding::Unsupported,
            fixed: Vec::new(),
            starts: vec![0.005, 0.02, 0.06],
        },
        Cause {
            id: "command_scale".into(),
            name: "another scale of commands or encoder".into(),
            equation: "target = s times command".into(),
            parameters: vec![number("scale", "1", 1.0, [0.2, 5.0], [0.9, 1.1], 2e-3)],
            separating_experiment: "hold still at several targets: a wrong scale is wrong in proportion to the target".into(),
            installs_as: CauseBinding::Unsupported,
            fixed: Vec::new(),
            starts: vec![],
        },
    ]
}

impl Twin for ServoTwin {
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

    fn predict(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
    ) -> Result<Vec<f64>, CalibrationError> {
        let measured = &self.episodes[episode];
        let [half_width, friction, damping, deadband, scale] = at.causes else {
            return Err(CalibrationError::simulation(
                &measured.name,
                "five causes were expected",
            ));
        };
        let joint = JointId(0);
        let mut start = self.stage.clone();
        start.state.joint_position[joint] = at.episode_nuisances[0] as f32;
        start.adopt_state()?;
        let mut laws = Vec::new();
        if *half_width > 0.0 {
            laws.push(self.backlash.spec(&[("half_width", *half_width)]));
        }
        let mut overrides = Vec::new();
        if (*friction - self.friction_n_m).abs() > 0.0 {
            overrides.push(("joint/0/friction", *friction));
        }
        if *damping > 0.0 {
            overrides.push(("joint/0/damping", *damping));
        }
        // The law's memory begins where the joint stands, so it is installed after the joint was put there.
        let mut stage = start.with_laws_and_overrides(laws, &overrides)?;
        let commands = &self.commands[episode];
        let step_s = 1.0 / self.rate_hz;
        let duration = measured.t_s.iter().copied().fold(0.0, f64::max) + MOST_OFFSET_S;
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
                target = scale * commands[next].1;
                next += 1;
            }
            let position = stage.state.joint_position[joint];
            let held = (target - f64::from(position)).abs() <= *deadband;
            let told = if held { position } else { target as f32 };
            stage.state.joint_command[joint] = JointCommand::Position(told);
            stage.step()?;
            let velocity = stage.state.joint_velocity[joint];
            track.push((
                f64::from(stage.state.joint_position[joint]),
                f64::from(velocity),
            ));
        }
        let offset = at.shared[0];
        Ok(measured
            .t_s
            .iter()
            .map(|t| hermite_interpolation(&track, step_s, t + offset))
            .collect())
    }
}
