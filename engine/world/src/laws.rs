//! The laws of all engines, and their installation.

use crate::error::WorldError;
use dwell_scene::{Address, House, LawInfo, LawSpec, Parameter, SceneError, State};
use std::sync::LazyLock;

/// All laws that some engine knows.
pub fn all() -> impl Iterator<Item = &'static LawInfo> + Clone {
    dwell_physics::laws::all()
        .chain(dwell_acoustics::laws::all())
        .chain(dwell_render::laws::all())
}

/// As [`all`], as a slice.
pub(crate) fn all_slice() -> &'static [&'static LawInfo] {
    static KNOWN: LazyLock<Vec<&LawInfo>> = LazyLock::new(|| all().collect());
    &KNOWN
}

/// The numbers of a law that is given by its name alone, where these need no choice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawDefaultValues {
    /// The law's id.
    pub id: &'static str,
    /// Values by parameter name; the others have their defaults.
    pub params: &'static [(&'static str, f64)],
    /// The meaning of the values, and their source.
    pub about: &'static str,
}

/// The laws that have usual numbers. The others need some: a wind has no usual direction.
pub const DEFAULT_VALUES: &[LawDefaultValues] = &[
    LawDefaultValues {
        id: "drag",
        params: &[("c_d", 0.47)],
        about: "that of a sphere at Reynolds numbers of 1e4 to 1e5: S. F. Hoerner, Fluid-Dynamic Drag (1965), chapter 3",
    },
    LawDefaultValues {
        id: "buoyancy",
        params: &[("fluid_density_kg_m3", 1.204)],
        about: "dry air at 20 degrees Celsius and 101325 Pa",
    },
    LawDefaultValues {
        id: "no_air_absorption",
        params: &[("missing", 1.0)],
        about: "all of it is missing",
    },
    LawDefaultValues {
        id: "vignetting",
        params: &[("strength", 1.0)],
        about: "the law of the fourth power",
    },
    LawDefaultValues {
        id: "redwood_depth",
        params: &[("strength", 1.0)],
        about: "the published noise",
    },
    LawDefaultValues {
        id: "kinect_depth",
        params: &[("axial", 1.0), ("lateral", 1.0)],
        about: "the published noise",
    },
];

/// Checks laws of all engines and leaves out those at their default, as [`dwell_scene::law::check_and_canonicalize`] says.
///
/// # Errors
/// [`WorldError::Unknown`] lists the laws there are; [`WorldError::Scene`] names a parameter out of bounds, or a target that
/// is there in two spellings.
pub fn normalize_laws(house: &House, specs: &[LawSpec]) -> Result<Vec<LawSpec>, WorldError> {
    let installed = dwell_scene::law::check_and_canonicalize(house, all_slice(), specs);
    installed.map_err(|error| match error {
        SceneError::UnknownLaw { id, known } => WorldError::Unknown {
            kind: "law",
            name: id,
            known: known.into_iter().map(str::to_owned).collect(),
        },
        other => other.into(),
    })
}

/// The initial state of a house under laws and parameters (values by address), for engines that work without a world. Nobody is in it.
///
/// # Errors
/// As [`normalize_laws`], and [`WorldError::Scene`] for an address that names nothing or a value out of range.
pub fn state_with_laws<'a>(
    house: &House,
    specs: &[LawSpec],
    parameters: impl IntoIterator<Item = (&'a String, &'a f64)>,
) -> Result<State, WorldError> {
    let mut state = State::new(house);
    state.laws = normalize_laws(house, specs)?;
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
        state.law_parameter(house, all_slice(), address)
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
    let set = state.set_law_parameters(house, all_slice(), &laws);
    if set.is_err() {
        (state.overrides, state.agents) = before;
    }
    set
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Causes that look like a law and are none: numbers of the scene, of clocks, trackers, sensors and controllers.
    const NUISANCES: &[&str] = &[
        "absorption",
        "camera_pitch",
        "camera_roll",
        "camera_yaw",
        "collision_shape",
        "defocus",
        "depth_color_offset",
        "distance",
        "frame_tilt",
        "friction",
        "gravity",
        "length_scale",
        "light_power",
        "marker_offset",
        "mass",
        "mount_offset",
        "object_size",
        "restitution",
        "room_scale",
        "samples_per_pixel",
        "second_slope",
        "time_offset",
        "timestamp_offset",
    ];

    #[test]
    fn every_law_says_all_there_is_to_say() {
        for info in all() {
            let id = info.id;
            assert!(info.version > 0 && !info.params.is_empty(), "{id}");
            for text in [
                info.name,
                info.equation,
                info.source,
                info.acts_on,
                info.separating_experiment,
            ] {
                assert!(text.len() > 4 && !text.ends_with('.'), "{id}: {text:?}");
            }
            assert!(!info.rivals.is_empty(), "{id}");
            for rival in info.rivals {
                let other = *rival != id && LawInfo::find(all(), rival).is_ok();
                assert!(
                    other || NUISANCES.contains(rival),
                    "{id}: {rival} is neither another law nor a nuisance"
                );
            }
            for param in info.params {
                let [low, high] = param.plausible;
                let bounds = param.low..=param.high;
                let values = [param.default, low, high];
                assert!(
                    values.iter().all(|value| bounds.contains(value)),
                    "{id} {}",
                    param.name
                );
                assert!(low <= high && !param.unit.is_empty(), "{id} {}", param.name);
            }
        }
    }

    #[test]
    fn usual_numbers_are_plausible_and_do_something() {
        for usual in DEFAULT_VALUES {
            let info = LawInfo::find(all(), usual.id).unwrap();
            for (name, value) in usual.params {
                let [low, high] = info.param(name).unwrap().plausible;
                assert!((low..=high).contains(value), "{} {name}", usual.id);
            }
            let spec = info.spec(usual.params);
            spec.check(info).unwrap();
            assert!(!spec.is_default(info), "{}", usual.id);
        }
    }
}
