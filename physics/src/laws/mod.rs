//! Physical effects that the basic model lacks. One file each, one line in the list.
//!
//! A law at its default is not installed, so that nothing changes bit for bit. A law has one effect or more, each a trait
//! of the stage of the step at which it acts: mass and inertia (`MassLaw`), bodies between steps (`BodyLaw`), forces on
//! kinematic trees (`LinkLaw`), the values of contacts (`ContactLaw`) and their compliance, motors (`MotorLaw`), joint
//! resistance (`ResistanceLaw`), wheeled bases (`BaseLaw`). Laws of air and of contact act on moving bodies and leave
//! sleeping ones asleep, apart from wind, which wakes bodies that it is strong enough to move.

mod actuators;
mod bases;
mod bodies;
mod body_law;
mod contacts;
mod law_set;
mod target;

pub(crate) use body_law::{BodyLaw, LawContext};
use law_set::LawEffect;
pub(crate) use law_set::LawSet;

use crate::error::PhysicsError;
use crate::model::PhysicsModel;
use dwell_scene::{LawInfo, LawSpec, State};
use std::sync::LazyLock;

/// A law of this engine: its description, and its installation.
struct PhysicsLaw {
    info: LawInfo,
    install: InstallFn,
}

/// Installs a law on its spec's target.
type InstallFn =
    fn(&LawSpec, &LawInfo, &PhysicsModel, &State) -> Result<Vec<LawEffect>, PhysicsError>;

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

/// Returns the descriptions of all laws of this engine.
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

/// Installs the state's laws that belong to this engine and differ from their default. A law that was installed before, on
/// the same target, keeps its state.
pub(crate) fn install(
    model: &PhysicsModel,
    state: &State,
    before: &LawSet,
) -> Result<LawSet, PhysicsError> {
    LawSpec::check_targets(&model.house, &all().iter().collect::<Vec<_>>(), &state.laws)?;
    let mut installed = LawSet::default();
    let mut remembered = before.memory();
    for spec in &state.laws {
        let Some(law) = LAWS.iter().find(|law| law.info.id == spec.id) else {
            continue;
        };
        spec.check(&law.info)?;
        if spec.is_default(&law.info) {
            continue;
        }
        let effects = (law.install)(spec, &law.info, model, state)?;
        // Two laws of one kind on one target are distinguished by their order.
        let same = |old: &LawSpec| old.id == spec.id && old.target == spec.target;
        let number = installed.specs().len();
        let earlier = installed.specs().iter().filter(|old| same(old)).count();
        installed.add(spec.clone(), effects);
        let old = before.specs().iter().enumerate();
        if let Some((old, _)) = old.filter(|(_, old)| same(old)).nth(earlier) {
            installed.restore_memory(number, &std::mem::take(&mut remembered[old]));
        }
    }
    Ok(installed)
}

/// Returns the value of a law's parameter.
fn value(spec: &LawSpec, info: &LawInfo, name: &str) -> f32 {
    spec.value(info, name).unwrap_or(0.0) as f32
}
