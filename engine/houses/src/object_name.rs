//! Names of things in houses.

use crate::error::HousesError;

/// Refuses a name of blanks alone, and one with control characters.
///
/// # Errors
/// [`HousesError::Spec`] with `field`.
pub(crate) fn check_is_name(field: &str, name: &str) -> Result<(), HousesError> {
    if name.trim().is_empty() || name.contains(char::is_control) {
        return Err(HousesError::Spec {
            field: field.to_owned(),
            found: format!("{name:?}"),
            possible: "a name, without control characters".to_owned(),
        });
    }
    Ok(())
}
