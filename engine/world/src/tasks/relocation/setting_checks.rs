//! Checks of the settings that tasks with moved things share.

use crate::error::WorldError;
use dwell_semantics::category::categories;
use std::fmt::Display;

/// The most things of an episode.
pub(in crate::tasks) const MOST_THINGS: u32 = 20;

/// Refuses a setting.
pub(in crate::tasks) fn setting_error(
    field: &'static str,
    found: impl Display,
    allowed: impl Into<String>,
) -> WorldError {
    WorldError::Config {
        field,
        found: found.to_string(),
        allowed: allowed.into(),
    }
}

/// Refuses numbers of things that no episode can have.
pub(in crate::tasks) fn check_counts(least: u32, most: u32) -> Result<(), WorldError> {
    if !(1..=MOST_THINGS).contains(&most) {
        return Err(setting_error(
            "max_things",
            most,
            format!("1 to {MOST_THINGS}"),
        ));
    }
    if !(1..=most).contains(&least) {
        let allowed = format!("1 to max_things, which is {most}");
        return Err(setting_error("min_things", least, allowed));
    }
    Ok(())
}

/// Refuses distances that nothing can be moved by.
pub(in crate::tasks) fn check_moves(least_m: f32, most_m: f32) -> Result<(), WorldError> {
    if !(0.1..=1000.0).contains(&most_m) {
        return Err(setting_error("max_move_m", most_m, "0.1 to 1000"));
    }
    if !(0.1..=most_m).contains(&least_m) {
        let allowed = format!("0.1 to max_move_m, which is {most_m}");
        return Err(setting_error("min_move_m", least_m, allowed));
    }
    Ok(())
}

/// Refuses classes that no thing can have.
pub(in crate::tasks) fn check_classes(classes: &[String]) -> Result<(), WorldError> {
    let rows = categories().rows();
    let known = |name: &String| rows.iter().any(|row| row.name == name);
    match classes.iter().find(|name| !known(name)) {
        None => Ok(()),
        Some(name) => Err(WorldError::Unknown {
            kind: "class",
            name: name.clone(),
            known: rows.iter().map(|row| row.name.to_owned()).collect(),
        }),
    }
}

/// Refuses what nobody can be paid.
pub(in crate::tasks) fn check_rewards(rewards: &[(&'static str, f64)]) -> Result<(), WorldError> {
    let wrong = rewards
        .iter()
        .find(|(_, value)| value.is_nan() || value.abs() > 1e6);
    match wrong {
        None => Ok(()),
        Some((field, value)) => Err(setting_error(field, value, "-1,000,000 to 1,000,000")),
    }
}
