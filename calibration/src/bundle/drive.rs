//! Drives of a robot: what stands in `drive.csv`, and whether it can be what it says.

use super::Episode;
use super::check;
use super::file::{DriveRow, Manifest};
use super::read::{episode, table};
use crate::error::CalibrationError;
use std::collections::BTreeMap;
use std::path::Path;

/// How far a sample's time may be from its place in an even row, as a share of the spacing.
const SPACING_TOLERANCE: f64 = 0.05;
/// Samples below which nothing can be predicted.
const FEWEST_SAMPLES: usize = 42;
/// Way by the wheels above which it is compared with the tracker's, m.
const TELLING_WAY_M: f64 = 1.0;
/// Way by the wheels over that by the tracker beyond which something is wrong with units or signs.
const WAYS: [f64; 2] = [0.5, 2.0];

type Checked = Result<(), CalibrationError>;

/// Reads the table into the episodes.
pub(super) fn read(
    folder: &Path,
    by_name: &BTreeMap<String, usize>,
    episodes: &mut [Episode],
) -> Checked {
    table(folder, "drive.csv", |row: DriveRow, at| {
        check::time(at, row.t_s)?;
        for (field, value, most) in [
            ("x", row.x, 1e3),
            ("y", row.y, 1e3),
            ("heading", row.heading, 1e4),
            ("left_rad", row.left_rad, 1e3),
            ("right_rad", row.right_rad, 1e3),
        ] {
            check::finite(at, field, value, most)?;
        }
        let index = episode(at, by_name, &row.episode)?;
        episodes[index].drive.push(row);
        Ok(())
    })?;
    for episode in episodes {
        episode.drive.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
    }
    Ok(())
}

/// Whether the drives are what the manifest says: long enough, evenly spaced, and with wheels that go as far as the robot.
pub(super) fn complete(name: &str, manifest: &Manifest, episodes: &[Episode]) -> Checked {
    let Some(base) = &manifest.scene.base else {
        return Err(CalibrationError::Missing {
            at: format!("{name}/manifest.json"),
            what: "scene.base".to_owned(),
            needed: "wheel_radius_m, wheel_base_m and rate_hz must be said".to_owned(),
        });
    };
    let (mut wheels_m, mut tracker_m) = (0.0, 0.0);
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
        for (k, row) in rows.iter().enumerate() {
            let place = rows[0].t_s + k as f64 / base.rate_hz;
            if (row.t_s - place).abs() * base.rate_hz > SPACING_TOLERANCE {
                let allowed = format!(
                    "{place:.6}, sample {k} of an even row at {} Hz",
                    base.rate_hz
                );
                return Err(CalibrationError::field(at, "t_s", row.t_s, allowed));
            }
        }
        for pair in rows.windows(2) {
            let (dx, dy) = (pair[1].x - pair[0].x, pair[1].y - pair[0].y);
            let heading = pair[1].heading;
            // Along the heading, so that a tracker's noise does not add up.
            tracker_m += dx * libm::cos(heading) + dy * libm::sin(heading);
            wheels_m += 0.5 * base.wheel_radius_m * (pair[1].left_rad + pair[1].right_rad);
        }
    }
    let ratio = wheels_m / tracker_m;
    if wheels_m.abs() > TELLING_WAY_M && !(WAYS[0]..=WAYS[1]).contains(&ratio) {
        return Err(CalibrationError::field(
            format!("{name}/drive.csv"),
            "the way by the wheels over the tracker's",
            format!("{ratio:.2}"),
            format!(
                "{} to {}; check units, signs and wheel_radius_m",
                WAYS[0], WAYS[1]
            ),
        ));
    }
    Ok(())
}
