//! Drives of a robot: the content of `drive.csv`, and its plausibility.

use super::check;
use super::file::{DriveRow, MeasurementDescription, WheeledBaseManifest};
use super::headings::HeadingEvidence;
use super::read::{episode_index, for_each_row};
use super::{MeasuredEpisode, unit_checks};
use crate::error::CalibrationError;
use std::collections::BTreeMap;
use std::path::Path;

/// Samples below which nothing can be predicted.
const FEWEST_SAMPLES: usize = 42;
/// Path length by the wheels or the tracker above which the two are compared, m.
const TELLING_WAY_M: f64 = 1.0;
/// Ratios of the path length by the wheels to that by the tracker beyond which units or signs are wrong.
/// A diameter in place of a radius is beyond them.
const WAYS: [f64; 2] = [0.55, 1.8];
/// Such ratios, of a diameter for a radius and of a radius for a diameter, within a tenth.
const DIAMETER_WAYS: [f64; 2] = [2.0, 0.5];

type OdometryCheck = Result<(), CalibrationError>;

/// Reads the table into the episodes.
pub(super) fn read(
    folder: &Path,
    by_name: &BTreeMap<String, usize>,
    episodes: &mut [MeasuredEpisode],
) -> OdometryCheck {
    for_each_row(folder, "drive.csv", |row: DriveRow, at| {
        check::check_time(at, row.t_s)?;
        for (field, value) in [("x", row.x), ("y", row.y)] {
            check::check_position(at, field, value)?;
        }
        for (field, value, most) in [
            ("heading", row.heading, 1e4),
            ("left_rad", row.left_rad, 1e3),
            ("right_rad", row.right_rad, 1e3),
        ] {
            check::check_finite(at, field, value, most)?;
        }
        let index = episode_index(at, by_name, &row.episode)?;
        episodes[index].drive.push(row);
        Ok(())
    })?;
    for episode in episodes {
        episode.drive.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
    }
    Ok(())
}

/// Checks that the drives are what the manifest says: long enough, evenly spaced, and with wheels that go as far as the robot.
pub(super) fn check_drives(
    name: &str,
    manifest: &MeasurementDescription,
    episodes: &[MeasuredEpisode],
) -> OdometryCheck {
    let Some(base) = &manifest.scene.base else {
        return Err(CalibrationError::Missing {
            at: format!("{name}/manifest.json"),
            what: "scene.base".to_owned(),
            needed: "wheel_radius_m, wheel_base_m and rate_hz must be said".to_owned(),
        });
    };
    let mut ways = WheelAndTrackerPaths::default();
    let mut headings = HeadingEvidence::default();
    for episode in episodes {
        let at = format!("{name}, episode {}", episode.name);
        let rows = &episode.drive;
        if rows.len() < FEWEST_SAMPLES {
            return Err(CalibrationError::TooFew {
                at,
                what: "rows of drive.csv",
                found: rows.len(),
                needed: FEWEST_SAMPLES,
            });
        }
        let times: Vec<f64> = rows.iter().map(|row| row.t_s).collect();
        unit_checks::check_even_sampling(&at, &times, base.rate_hz)?;
        rows.windows(2).for_each(|pair| ways.add(pair, base));
        ways.add_end_difference(rows, base);
        headings.add(rows, base);
    }
    let at = format!("{name}/drive.csv");
    headings.check(&at)?;
    ways.check_agreement(&at, headings.is_along_headings())
}

/// Lengths of robots' paths, by the wheels and by the tracker, m.
#[derive(Default)]
#[expect(clippy::struct_field_names, reason = "the unit")]
struct WheelAndTrackerPaths {
    wheels_m: f64,
    /// Along the heading, so that a tracker's noise does not add up.
    tracker_m: f64,
    /// By the wheels, if the turns were counted since the start.
    since_start_m: f64,
}

impl WheelAndTrackerPaths {
    fn add(&mut self, pair: &[DriveRow], base: &WheeledBaseManifest) {
        let (before, now) = (&pair[0], &pair[1]);
        self.tracker_m += (now.x - before.x) * libm::cos(now.heading)
            + (now.y - before.y) * libm::sin(now.heading);
        self.wheels_m += 0.5 * base.wheel_radius_m * (now.left_rad + now.right_rad);
    }

    fn add_end_difference(&mut self, rows: &[DriveRow], base: &WheeledBaseManifest) {
        let ends =
            [rows.first(), rows.last()].map(|row| row.map_or(0.0, |r| r.left_rad + r.right_rad));
        self.since_start_m += 0.5 * base.wheel_radius_m * (ends[1] - ends[0]);
    }

    /// `is_along`: whether ways along the headings are the tracker's.
    fn check_agreement(&self, at: &str, is_along: bool) -> OdometryCheck {
        let is_right = |ratio: f64| (WAYS[0]..=WAYS[1]).contains(&ratio);
        let ratio = self.wheels_m / self.tracker_m;
        let longest_m = self.wheels_m.abs().max(self.tracker_m.abs());
        if longest_m <= TELLING_WAY_M || is_right(ratio) {
            return Ok(());
        }
        let hint = if !is_along {
            None
        } else if is_right(self.since_start_m / self.tracker_m) {
            Some("are turns of the wheels counted since the start? They are meant since the sample before".into())
        } else if DIAMETER_WAYS
            .iter()
            .any(|way| (ratio / way - 1.0).abs() <= 0.1)
        {
            Some("is wheel_radius_m the diameter, or half the radius?".into())
        } else {
            unit_checks::length_unit_hint("positions", 1.0 / ratio.abs())
        };
        let hint = hint.unwrap_or_else(|| "check units, signs, headings and wheel_radius_m".into());
        Err(CalibrationError::field(
            at,
            "the way by the wheels over the tracker's",
            format!("{ratio:.3}"),
            format!("{} to {}; {hint}", WAYS[0], WAYS[1]),
        ))
    }
}
