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
use dwell_scene::law::{Law, LawRegistry};
use dwell_scene::{LawInfo, LawSpec, LawValues, State};

/// A law of this engine.
type PhysicsLaw = Law<InstallFn>;

/// Puts a law to work on what its target names.
type InstallFn = fn(LawValues<'_>, &PhysicsModel, &State) -> Result<Vec<LawEffect>, PhysicsError>;

/// The laws of this engine.
static LAWS: LawRegistry<InstallFn> = LawRegistry::new(&[
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
]);

/// Returns the descriptions of all laws of this engine.
///
/// ```
/// let drag = dwell_scene::LawInfo::find(dwell_physics::laws::all(), "drag").unwrap();
/// assert_eq!(drag.params[0].name, "c_d");
/// ```
pub fn all() -> impl Iterator<Item = &'static LawInfo> + Clone {
    LAWS.infos()
}

/// Installs the state's laws that belong to this engine and differ from their default. A law that was installed before, on
/// the same target, keeps its state.
pub(crate) fn install(
    model: &PhysicsModel,
    state: &State,
    before: &LawSet,
) -> Result<LawSet, PhysicsError> {
    LAWS.check(&model.house, &state.laws)?;
    let mut installed = LawSet::default();
    for law in LAWS.active(&state.laws) {
        let effects = (law.effect)(law.values, model, state)?;
        installed.add(law.values.spec.clone(), effects);
    }
    let remembered = before.law_states();
    let predecessors = LawSpec::predecessor_indices(before.specs(), installed.specs());
    for (law, old) in predecessors.into_iter().enumerate() {
        if let Some(old) = old {
            installed.restore_law_state(law, &remembered[old]);
        }
    }
    Ok(installed)
}
