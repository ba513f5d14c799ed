//! The simulation of a body above a board, ready to be started from any motion.

use super::motion::MotionState;
use super::pose_tracks::{PoseTracks, TrackedBody};
use crate::bundle::file::BoardManifest;
use crate::error::CalibrationError;
use crate::experiment::experiment_world::{ExperimentObject, ExperimentWorld};
use dwell_physics::{ContactFriction, PhysicsConfig};
use dwell_scene::{LawSpec, PartId};
use glam::{DQuat, DVec3, Quat, Vec3};

/// Physics steps between two samples, as the published evaluation of cube tosses has them.
pub const STEPS_PER_SAMPLE: u32 = 10;

/// Half the board's edge, m.
const BOARD_HALF_EDGE_M: f32 = 4.0;
/// The body's only part.
const BODY: PartId = PartId(0);

/// A tiny house, a body above a board, to be copied for every roll-out.
#[derive(Clone)]
pub struct BoardRig {
    stage: ExperimentWorld,
    /// The law that turns the inertia of a solid body into the measured one.
    inertia: LawSpec,
    board: BoardManifest,
}

/// The settings of a rig.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RigSettings {
    /// Coulomb friction of the pair.
    pub friction: f64,
    /// Restitution of the pair.
    pub restitution: f64,
    /// Laws that are installed.
    pub laws: Vec<LawSpec>,
}

impl BoardRig {
    /// Builds the house and its physics.
    ///
    /// # Errors
    /// [`CalibrationError::Simulation`] for a body that physics does not take.
    pub fn new(
        tracks: &PoseTracks,
        contact_friction: ContactFriction,
    ) -> Result<Self, CalibrationError> {
        Self::with_finer_steps(tracks, contact_friction, 1)
    }

    /// The same with `times` as many steps between two samples.
    ///
    /// # Errors
    /// As [`BoardRig::new`].
    pub fn with_finer_steps(
        tracks: &PoseTracks,
        contact_friction: ContactFriction,
        times: u32,
    ) -> Result<Self, CalibrationError> {
        let body = &tracks.body;
        let thing = ExperimentObject::cuboid(&body.name, body.mass_kg, body.half_extents_m)
            .above_board(BOARD_HALF_EDGE_M, &tracks.board);
        let rate_hz = tracks.rate_hz as f32;
        let config = PhysicsConfig {
            control_rate_hz: rate_hz,
            physics_rate_hz: rate_hz * (STEPS_PER_SAMPLE * times) as f32,
            solver_substeps: 1,
            contact_friction,
            sleeping: false,
            ..PhysicsConfig::default()
        };
        let stage = ExperimentWorld::new(20.0, &thing, config)?;
        let gravity = [("world/gravity_m_s2", tracks.gravity_m_s2)];
        let rig = Self {
            stage: stage.with_laws_and_overrides(Vec::new(), &gravity)?,
            inertia: inertia(&tracks.body),
            board: tracks.board.clone(),
        };
        rig.with_settings(&RigSettings {
            friction: tracks.board.friction,
            restitution: tracks.board.restitution,
            laws: Vec::new(),
        })
    }

    /// A copy with other contact values and laws.
    ///
    /// # Errors
    /// [`CalibrationError::Simulation`] for a value or law that physics does not take.
    pub fn with_settings(&self, settings: &RigSettings) -> Result<Self, CalibrationError> {
        let [friction, restitution] =
            ["friction", "restitution"].map(|value| self.board.pair_address(value));
        let values = [
            (friction.as_str(), settings.friction),
            (restitution.as_str(), settings.restitution),
        ];
        let laws = std::iter::once(&self.inertia).chain(&settings.laws);
        Ok(Self {
            stage: self
                .stage
                .with_laws_and_overrides(laws.cloned().collect(), &values)?,
            inertia: self.inertia.clone(),
            board: self.board.clone(),
        })
    }

    /// The motions at the `samples` samples that follow `start`.
    ///
    /// # Errors
    /// [`CalibrationError::Simulation`] for a start that is not finite.
    pub fn simulate(
        &self,
        start: &MotionState,
        samples: usize,
    ) -> Result<Vec<MotionState>, CalibrationError> {
        let mut stage = self.stage.clone();
        // Near the origin single precision is finest, and the board is the same everywhere.
        let origin = DVec3::new(start.position.x, 0.0, start.position.z);
        let pose = &mut stage.state.part_pose[BODY];
        pose.position = (start.position - origin).as_vec3();
        pose.rotation = start.rotation.as_quat().normalize();
        let velocity = &mut stage.state.part_velocity[BODY];
        velocity.linear = start.linear.as_vec3();
        velocity.angular = start.angular.as_vec3();
        stage.adopt_state()?;
        let mut motions = Vec::with_capacity(samples);
        for _ in 0..samples {
            stage.step()?;
            motions.push(motion_from_state(
                origin,
                stage.state.part_pose[BODY].position,
                stage.state.part_pose[BODY].rotation,
                &stage.state.part_velocity[BODY],
            ));
        }
        Ok(motions)
    }
}

fn motion_from_state(
    origin: DVec3,
    position: Vec3,
    rotation: Quat,
    velocity: &dwell_scene::Velocity,
) -> MotionState {
    let quat = DQuat::from_xyzw(
        f64::from(rotation.x),
        f64::from(rotation.y),
        f64::from(rotation.z),
        f64::from(rotation.w),
    );
    MotionState {
        position: origin + position.as_dvec3(),
        rotation: quat.normalize(),
        linear: velocity.linear.as_dvec3(),
        angular: velocity.angular.as_dvec3(),
    }
}

/// The law that gives a solid box other principal moments.
fn inertia(body: &TrackedBody) -> LawSpec {
    let moments = body.inertia_kg_m2.iter().zip(body.solid_inertia_kg_m2());
    let errors = moments.map(|(moment, solid)| moment / solid - 1.0);
    let params: Vec<(&str, f64)> = ["x", "y", "z"].into_iter().zip(errors).collect();
    LawSpec::new("inertia_error", 1, &params).with_target(&body.name)
}
