//! Installing laws.

use super::{LawInfo, LawSpec};
use crate::error::SceneError;
use crate::house::House;

/// Checks laws and leaves out those at their default: such a law changes nothing, bit for bit. Their targets are kept in one
/// spelling ([`LawSpec::canonical_target`]), and of their numbers those that are not default. `known`: the laws of all engines.
///
/// # Errors
/// [`SceneError::UnknownLaw`] lists the laws there are; [`SceneError::Range`] and [`SceneError::Unknown`] name a parameter out
/// of bounds or one that there is not, a version other than this build's, or a target that is there in two spellings.
pub fn check_and_canonicalize(
    house: &House,
    known: &[&LawInfo],
    specs: &[LawSpec],
) -> Result<Vec<LawSpec>, SceneError> {
    LawSpec::check_targets(house, known, specs)?;
    let mut installed = Vec::new();
    for spec in specs {
        let info = LawInfo::find(known.iter().copied(), &spec.id)?;
        spec.check(info)?;
        if !spec.is_default(info) {
            let target = spec.target.as_deref();
            let mut spec = LawSpec {
                target: target.map(|target| LawSpec::canonical_target(house, info, target)),
                ..spec.clone()
            };
            // One spelling for each law: what is default is not written, as when it is set by its address.
            spec.params.retain(|name, value| {
                let param = info.param(name);
                param.is_none_or(|param| *value != param.default)
            });
            installed.push(spec);
        }
    }
    Ok(installed)
}
