//! Physical effects that the basic model lacks. One file each, one line in the list.
//!
//! A law at its default is not installed, so that nothing changes bit for bit. What a law can reach is `LawHooks`: forces on
//! bodies, the values of contacts, mass and inertia, how stiff contacts are, where servos go. What wakes a body that
//! sleeps: laws of air and of contact act on what moves, and leave asleep what sleeps, apart from wind, which wakes what
//! it is strong enough to move.

mod actuators;
mod bases;
mod bodies;
mod contacts;
mod law_hooks;
mod link_wrench;
mod target;

pub(crate) use law_hooks::{
    ContactCompliance, ContactSide, ContactValues, JointLoad, JointResistance, LawContact,
    LawContext, LawHooks, MotorStep, SlipSpring,
};

pub(crate) use link_wrench::{ExternalWrench, LinkStep};

use crate::error::PhysicsError;
use crate::model::PhysicsModel;
use dwell_scene::{LawInfo, LawSpec, State};
use std::sync::LazyLock;

/// A law of this engine: what is known about it, and how it is put to work.
struct PhysicsLaw {
    info: LawInfo,
    install: InstallFn,
}

/// Puts a law to work on what its spec names.
type InstallFn =
    fn(&LawSpec, &LawInfo, &PhysicsModel, &State) -> Result<Box<dyn LawHooks>, PhysicsError>;

/// The laws of this engine.
static LAWS: &[PhysicsLaw] = &[
    bodies::drag::LAW,
    bodies::viscous_damping::LAW,
    bodies::magnus::LAW,
    bodies::buoyancy::LAW,
    bodies::wind::LAW,
    bodies::center_of_mass::LAW,
    bodies::inertia_error::LAW,
    contacts::compliance::LAW,
    contacts::rolling::LAW,
    contacts::torsional::LAW,
    contacts::stribeck::LAW,
    contacts::anisotropic_friction::LAW,
    contacts::velocity_restitution::LAW,
    actuators::backlash::LAW,
    actuators::latency::LAW,
    actuators::first_order_lag::LAW,
    actuators::rate_limit::LAW,
    actuators::deadband::LAW,
    actuators::saturation::LAW,
    actuators::joint_friction::LAW,
    actuators::motor_constants::LAW,
    actuators::compliance::LAW,
    actuators::hysteresis::LAW,
    bases::unequal_wheels::LAW,
    bases::wheel_slip::LAW,
    bases::gyro_bias_scale::LAW,
];

/// Returns what is known about each law of this engine.
///
/// ```
/// let drag = dwell_physics::laws::all().iter().find(|law| law.id == "drag").unwrap();
/// assert_eq!(drag.params[0].name, "c_d");
/// ```
pub fn all() -> &'static [LawInfo] {
    static INFOS: LazyLock<Vec<LawInfo>> =
        LazyLock::new(|| LAWS.iter().map(|law| law.info.clone()).collect());
    &INFOS
}

/// An installed law with the words it was installed by.
#[derive(Debug)]
pub(crate) struct InstalledLaw {
    pub(crate) spec: LawSpec,
    pub(crate) law: Box<dyn LawHooks>,
}

impl Clone for InstalledLaw {
    fn clone(&self) -> Self {
        Self {
            spec: self.spec.clone(),
            law: self.law.clone_box(),
        }
    }
}

/// Installs the state's laws that belong to this engine and differ from their default. A law that was there before, on
/// the same target, keeps its memory.
pub(crate) fn install(
    model: &PhysicsModel,
    state: &State,
    before: &[InstalledLaw],
) -> Result<Vec<InstalledLaw>, PhysicsError> {
    LawSpec::check_targets(&model.house, &all().iter().collect::<Vec<_>>(), &state.laws)?;
    let mut installed: Vec<InstalledLaw> = Vec::new();
    for spec in &state.laws {
        let Some(law) = LAWS.iter().find(|law| law.info.id == spec.id) else {
            continue;
        };
        spec.check(&law.info)?;
        if spec.is_default(&law.info) {
            continue;
        }
        let mut acts = (law.install)(spec, &law.info, model, state)?;
        // Two laws of one kind on one target are told apart by their order.
        let same = |old: &&InstalledLaw| old.spec.id == spec.id && old.spec.target == spec.target;
        let earlier = installed.iter().filter(same).count();
        if let Some(old) = before.iter().filter(same).nth(earlier) {
            acts.restore_memory(&old.law.memory());
        }
        installed.push(InstalledLaw {
            spec: spec.clone(),
            law: acts,
        });
    }
    Ok(installed)
}

/// Returns how contacts give under the laws; the last law that says so wins.
pub(crate) fn compliance(laws: &[InstalledLaw]) -> Option<ContactCompliance> {
    laws.iter()
        .rev()
        .find_map(|installed| installed.law.compliance())
}

/// The value of a law's parameter.
fn value(spec: &LawSpec, info: &LawInfo, name: &str) -> f32 {
    spec.value(info, name).unwrap_or(0.0) as f32
}
