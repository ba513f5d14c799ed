//! Recorded drives: where a tracker saw the robot, and how far its wheels turned.

use crate::bundle::file::{BundleKind, DriveRow};
use crate::bundle::{Bundle, MeasuredEpisode};
use crate::error::CalibrationError;
use std::f64::consts::{PI, TAU};

/// The base as it is believed to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NominalWheelGeometry {
    /// Radius of both wheels, m.
    pub(super) wheel_radius_m: f64,
    /// Distance between the points where they touch the floor, m.
    pub(super) wheel_base_m: f64,
}

/// Drives of one robot.
pub(super) struct DriveRecordings {
    pub(super) base: NominalWheelGeometry,
    /// Samples per second, Hz.
    pub(super) rate_hz: f64,
    /// The episodes, in the order of the file.
    pub(super) episodes: Vec<DriveRecording>,
}

/// One drive.
pub(super) struct DriveRecording {
    pub(super) name: String,
    /// Drives of one session are held out together.
    pub(super) group: String,
    /// The tracked path: x, y in m and the heading in rad, not wrapped. Shape (sample,).
    pub(super) planar_poses: Vec<[f64; 3]>,
    /// Rotations of the left and the right wheel since the sample before, rad. Shape (sample,).
    pub(super) wheel_rotation_rad: Vec<[f64; 2]>,
}

impl DriveRecordings {
    /// The drives of a bundle.
    pub(super) fn of(bundle: &Bundle) -> Result<Self, CalibrationError> {
        let (Some(base), BundleKind::Drive) = (&bundle.manifest.scene.base, bundle.kind()) else {
            let found = format!("{:?}", bundle.kind());
            return Err(CalibrationError::field(
                &bundle.name,
                "kind",
                found,
                "drive",
            ));
        };
        let drive = |episode: &MeasuredEpisode| {
            let turned = episode.drive.iter();
            DriveRecording {
                name: episode.name.clone(),
                group: episode.group.clone(),
                planar_poses: planar(&episode.drive),
                wheel_rotation_rad: turned.map(|row| [row.left_rad, row.right_rad]).collect(),
            }
        };
        Ok(Self {
            base: NominalWheelGeometry {
                wheel_radius_m: base.wheel_radius_m,
                wheel_base_m: base.wheel_base_m,
            },
            rate_hz: base.rate_hz,
            episodes: bundle.episodes.iter().map(drive).collect(),
        })
    }
}

/// Headings that jump by a turn are made whole.
fn planar(rows: &[DriveRow]) -> Vec<[f64; 3]> {
    let mut last = rows.first().map_or(0.0, |row| row.heading);
    rows.iter()
        .map(|row| {
            last += wrap_angle(row.heading - last);
            [row.x, row.y, last]
        })
        .collect()
}

/// The same angle within half a turn of zero, rad.
pub(super) fn wrap_angle(angle_rad: f64) -> f64 {
    angle_rad - TAU * ((angle_rad + PI) / TAU).floor()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_do_not_jump() {
        let row = |heading| DriveRow {
            episode: String::new(),
            t_s: 0.0,
            x: 0.0,
            y: 0.0,
            heading,
            left_rad: 0.0,
            right_rad: 0.0,
        };
        let rows: Vec<DriveRow> = [3.0, 3.1, -3.1, -3.0].map(row).into();
        let headings: Vec<f64> = planar(&rows).iter().map(|pose| pose[2]).collect();
        for (found, expected) in headings.iter().zip([3.0, 3.1, TAU - 3.1, TAU - 3.0]) {
            assert!((found - expected).abs() < 1e-12, "{headings:?}");
        }
    }
}
