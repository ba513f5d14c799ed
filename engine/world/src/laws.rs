//! The laws of all engines, and their installation.

use crate::error::WorldError;
use dwell_scene::law::ParamInfo;
use dwell_scene::{Address, House, LawInfo, LawSpec, Parameter, SceneError, State};

/// All laws of all engines.
pub fn all() -> impl Iterator<Item = &'static LawInfo> {
    dwell_physics::laws::all()
        .iter()
        .chain(dwell_acoustics::laws::all())
        .chain(dwell_render::laws::all())
}

/// The usual parameters of a law that is installed by its name alone: numbers that need no choice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DefaultAction {
    /// The law's id.
    pub id: &'static str,
    /// Values by parameter name; the others have their defaults.
    pub params: &'static [(&'static str, f64)],
    /// The meaning of the values, and their source.
    pub about: &'static str,
}

/// The laws that have usual numbers. The others need some: a wind has no usual direction.
pub const USUAL: &[DefaultAction] = &[
    DefaultAction {
        id: "drag",
        params: &[("c_d", 0.47)],
        about: "that of a sphere at Reynolds numbers of 1e4 to 1e5: S. F. Hoerner, Fluid-Dynamic Drag (1965), chapter 3",
    },
    DefaultAction {
        id: "buoyancy",
        params: &[("fluid_density_kg_m3", 1.204)],
        about: "dry air at 20 degrees Celsius and 101325 Pa",
    },
    DefaultAction {
        id: "no_air_absorption",
        params: &[("missing", 1.0)],
        about: "all of it is missing",
    },
    DefaultAction {
        id: "vignetting",
        params: &[("strength", 1.0)],
        about: "the law of the fourth power",
    },
    DefaultAction {
        id: "redwood_depth",
        params: &[("strength", 1.0)],
        about: "the published noise",
    },
    DefaultAction {
        id: "kinect_depth",
        params: &[("axial", 1.0), ("lateral", 1.0)],
        about: "the published noise",
    },
];

/// Checks laws and leaves out those at their default: such a law changes nothing, bit for bit. Their targets are kept in one
/// spelling ([`LawSpec::canonical_target`]).
///
/// # Errors
/// [`WorldError::Unknown`] lists the laws there are; [`WorldError::Scene`] names a parameter out of bounds, or a target that
/// is there in two spellings.
pub fn install(house: &House, specs: &[LawSpec]) -> Result<Vec<LawSpec>, WorldError> {
    LawSpec::check_targets(house, &all().collect::<Vec<_>>(), specs)?;
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
            let target = spec.target.as_deref();
            spec.target = target.map(|target| LawSpec::canonical_target(house, info, target));
            // One spelling for each law: defaults are not written, as when it is set by its address.
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

/// The initial state of a house under laws and parameters (values by address), for engines that work without a world. Nobody is in it.
///
/// # Errors
/// As [`install`], and [`WorldError::Scene`] for an address that names nothing or a value out of range.
pub fn start<'a>(
    house: &House,
    specs: &[LawSpec],
    parameters: impl IntoIterator<Item = (&'a String, &'a f64)>,
) -> Result<State, WorldError> {
    let mut state = State::new(house);
    state.laws = install(house, specs)?;
    let values: Vec<(Address, f64)> = parameters
        .into_iter()
        .map(|(text, value)| Ok((text.parse()?, *value)))
        .collect::<Result<_, WorldError>>()?;
    set_parameters(&mut state, house, &values)?;
    Ok(state)
}

/// Returns the parameter at any address: a law's, or one of the scene.
///
/// # Errors
/// [`SceneError::Address`] says which word is wrong and what is allowed there.
pub(crate) fn parameter(
    state: &State,
    house: &House,
    address: &Address,
) -> Result<Parameter, SceneError> {
    if address.is_law() {
        state.law_parameter(house, &all().collect::<Vec<_>>(), address)
    } else {
        state.parameter(house, address)
    }
}

/// Sets parameters at any addresses: all of them, or none.
///
/// # Errors
/// As [`parameter`], for a value out of range beside the others, and for a parameter that is there twice.
pub(crate) fn set_parameters(
    state: &mut State,
    house: &House,
    values: &[(Address, f64)],
) -> Result<(), SceneError> {
    let before = (state.overrides.clone(), state.agents.clone());
    let (laws, scene): (Vec<_>, Vec<_>) = values
        .iter()
        .cloned()
        .partition(|(address, _)| address.is_law());
    state.set_parameters(house, &scene)?;
    let set = state.set_law_parameters(house, &all().collect::<Vec<_>>(), &laws);
    if set.is_err() {
        (state.overrides, state.agents) = before;
    }
    set
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_numbers_are_plausible_and_do_something() {
        for usual in USUAL {
            let info = all().find(|info| info.id == usual.id).unwrap();
            for (name, value) in usual.params {
                let param = info
                    .params
                    .iter()
                    .find(|param| param.name == *name)
                    .unwrap();
                let [low, high] = param.plausible;
                assert!((low..=high).contains(value), "{} {name}", usual.id);
            }
            let params = usual.params.iter();
            let spec = LawSpec {
                id: usual.id.to_owned(),
                version: info.version,
                target: None,
                params: params
                    .map(|(name, value)| ((*name).to_owned(), *value))
                    .collect(),
            };
            spec.check(info).unwrap();
            assert!(!spec.is_default(info), "{}", usual.id);
        }
    }
}
