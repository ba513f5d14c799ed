//! The laws of all engines, and their installation.

use crate::error::WorldError;
use dwell_scene::law::ParamInfo;
use dwell_scene::{Address, LawInfo, LawSpec, Parameter, SceneError, State};

/// All laws that some engine knows.
pub fn all() -> impl Iterator<Item = &'static LawInfo> {
    dwell_physics::laws::all()
        .iter()
        .chain(dwell_acoustics::laws::all())
}

/// Checks laws and leaves out those at their default: such a law changes nothing, bit for bit.
///
/// # Errors
/// [`WorldError::Unknown`] lists the laws there are; [`WorldError::Scene`] names a parameter out of bounds.
pub fn install(specs: &[LawSpec]) -> Result<Vec<LawSpec>, WorldError> {
    let mut installed = Vec::new();
    for spec in specs {
        let Some(info) = all().find(|info| info.id == spec.id) else {
            let known = all().map(|info| info.id.to_owned()).collect();
            return Err(WorldError::Unknown {
                kind: "law",
                name: spec.id.clone(),
                known,
            });
        };
        spec.check(info)?;
        if !spec.is_default(info) {
            let mut spec = spec.clone();
            // One spelling for each law: what is default is not written, as when it is set by its address.
            spec.params.retain(|name, value| {
                let of = |param: &&ParamInfo| param.name == name;
                let param = info.params.iter().find(of);
                param.is_none_or(|param| *value != param.default)
            });
            installed.push(spec);
        }
    }
    Ok(installed)
}

/// What stands at any address: a law's, or one of the scene.
///
/// # Errors
/// [`SceneError::Address`] says which word is wrong and what is allowed there.
pub(crate) fn parameter(
    state: &State,
    house: &dwell_scene::House,
    address: &Address,
) -> Result<Parameter, SceneError> {
    if address.is_law() {
        state.law_parameter(&all().collect::<Vec<_>>(), address)
    } else {
        state.parameter(house, address)
    }
}

/// Sets what stands at any address.
///
/// # Errors
/// As [`parameter`], and for a value out of range.
pub(crate) fn set_parameter(
    state: &mut State,
    house: &dwell_scene::House,
    address: &Address,
    value: f64,
) -> Result<(), SceneError> {
    if address.is_law() {
        state.set_law_parameter(&all().collect::<Vec<_>>(), address, value)
    } else {
        state.set_parameter(house, address, value)
    }
}
