//! The laws of all engines, and their installation.

use crate::error::WorldError;
use dwell_scene::{LawInfo, LawSpec};

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
            installed.push(spec.clone());
        }
    }
    Ok(installed)
}
