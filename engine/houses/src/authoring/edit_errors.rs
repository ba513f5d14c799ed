//! Errors of edits and plans in one form: the field, what was found, what is possible.

use std::fmt::Display;

use dwell_scene::material::{Substance, library};

use crate::error::HousesError;
use dwell_scene::name_suggestions::nearest_names;

/// Largest number of names that are offered in place of an unknown one.
pub(super) const MAX_SUGGESTIONS: usize = 6;

/// The error of an impossible field.
pub(super) fn invalid_field(
    field: impl Display,
    found: impl Display,
    possible: impl Into<String>,
) -> HousesError {
    HousesError::Spec {
        field: field.to_string(),
        found: found.to_string(),
        possible: possible.into(),
    }
}

/// Prefixes the error's field with `place`.
pub(super) fn prefix_field(place: impl Display) -> impl FnOnce(HousesError) -> HousesError {
    move |error| match error {
        HousesError::Spec {
            field,
            found,
            possible,
        } => invalid_field(format_args!("{place}.{field}"), found, possible),
        other => other,
    }
}

/// The error of an unknown name; offers the nearest of those that exist.
pub(super) fn unknown_name<'a>(
    field: impl Display,
    name: &str,
    of: &str,
    known: impl Iterator<Item = &'a str>,
) -> HousesError {
    let known: Vec<&str> = known.collect();
    let near = nearest_names(name, known.iter().copied(), MAX_SUGGESTIONS + 1);
    let possible = match near.len() {
        0 => format!("nothing: there are no {of}"),
        few if few <= MAX_SUGGESTIONS => format!("one of the {of}: {}", near.join(", ")),
        _ => format!(
            "one of {} {of}; the nearest are {}",
            known.len(),
            near[..MAX_SUGGESTIONS].join(", ")
        ),
    };
    invalid_field(field, format_args!("{name:?}"), possible)
}

/// Checks a number within `[low, high]`.
pub(super) fn check_range(
    field: &str,
    value: f32,
    [low, high]: [f32; 2],
    unit: &str,
) -> Result<f32, HousesError> {
    if (low..=high).contains(&value) {
        return Ok(value);
    }
    Err(invalid_field(
        field,
        value,
        format!("{low} to {high} {unit}").trim(),
    ))
}

/// Checks a position in the scene, m.
pub(super) fn checked_point(field: &str, value: [f32; 3]) -> Result<glam::Vec3, HousesError> {
    let near = |x: &f32| x.abs() <= 32_768.0;
    if value.iter().all(near) {
        return Ok(value.into());
    }
    let found = format!("{value:?}");
    Err(invalid_field(
        field,
        found,
        "coordinates within 32768 m of the origin",
    ))
}

/// Looks up a row of the materials table.
pub(super) fn find_substance(field: &str, name: &str) -> Result<&'static Substance, HousesError> {
    let known = || library().iter().map(|substance| substance.name.as_str());
    library()
        .get(name)
        .ok_or_else(|| unknown_name(field, name, "substances", known()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_name_is_answered_with_the_nearest() {
        let known = [
            "chair_1",
            "chair_2",
            "sofa_1",
            "lamp",
            "table",
            "bed_1",
            "wardrobe_1",
        ];
        let told = unknown_name("object", "chiar_1", "objects", known.into_iter()).to_string();
        assert!(
            told.starts_with("object: found \"chiar_1\"; possible: one of 7 objects"),
            "{told}"
        );
        assert!(told.contains("nearest are chair_1, chair_2"), "{told}");
        let few = unknown_name("on", "tabel", "objects", ["table", "cup"].into_iter()).to_string();
        assert_eq!(
            few,
            "on: found \"tabel\"; possible: one of the objects: table, cup"
        );
    }
}
