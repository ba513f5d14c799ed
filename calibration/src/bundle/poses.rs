//! Pose trajectories: the content of `poses.csv` and `starts.csv`, and its plausibility.

use super::check::{self, NameIndex};
use super::file::{AngularFrame, MeasurementDescription, PoseRow, StartVelocityRow};
use super::read::{episode_index, for_each_row};
use super::{MeasuredEpisode, PoseSample, PoseVelocity, unit_checks};
use crate::error::CalibrationError;
use glam::{DQuat, DVec3};
use std::collections::BTreeMap;
use std::path::Path;

/// Largest deviation of a quaternion's length from one.
const UNIT_TOLERANCE: f64 = 1e-3;
/// Share of the turning speed, or of the speed, that a test of the velocities must leave unexplained to refute them.
const WRONG_SHARE: f64 = 0.5;
/// Speed below which a sample says nothing about frames or units, m/s or rad/s.
const TELLING_SPEED: f64 = 0.5;
/// Smallest number of such samples for a test.
const FEWEST_TELLING: usize = 50;

type PoseCheck = Result<(), CalibrationError>;

/// Reads both tables into the episodes.
pub(super) fn read(
    folder: &Path,
    names: &NameIndex,
    by_name: &BTreeMap<String, usize>,
    manifest: &MeasurementDescription,
    episodes: &mut [MeasuredEpisode],
) -> PoseCheck {
    // `check::manifest` has required the form.
    let frame = manifest
        .poses
        .as_ref()
        .map_or(AngularFrame::World, |form| form.angular_velocity);
    for_each_row(folder, "poses.csv", |row: PoseRow, at| {
        let sample = PoseSample {
            t_s: row.t_s,
            entity: names.entity(at, "entity", &row.entity)?,
            position: DVec3::new(row.x, row.y, row.z),
            rotation: checked_unit_quaternion(
                at,
                DQuat::from_xyzw(row.qx, row.qy, row.qz, row.qw),
            )?,
            rates: None,
        };
        check::check_time(at, row.t_s)?;
        for (field, value) in [("x", row.x), ("y", row.y), ("z", row.z)] {
            check::check_position(at, field, value)?;
        }
        let rates = parse_rates(at, &row, sample.rotation, frame)?;
        episodes[episode_index(at, by_name, &row.episode)?]
            .poses
            .push(PoseSample { rates, ..sample });
        Ok(())
    })?;
    for episode in episodes.iter_mut() {
        episode.poses.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
    }
    if folder.join("starts.csv").exists() {
        starts(folder, by_name, frame, episodes)?;
    }
    Ok(())
}

fn starts(
    folder: &Path,
    by_name: &BTreeMap<String, usize>,
    frame: AngularFrame,
    episodes: &mut [MeasuredEpisode],
) -> PoseCheck {
    for_each_row(folder, "starts.csv", |row: StartVelocityRow, at| {
        let index = episode_index(at, by_name, &row.episode)?;
        let episode = &mut episodes[index];
        if episode.known_start.is_some() {
            let found = format!("{:?} again", row.episode);
            return Err(CalibrationError::field(at, "episode", found, "each once"));
        }
        let sample = row.sample as usize;
        let Some(pose) = episode.poses.get(sample) else {
            let allowed = format!("below {}, the episode's samples", episode.poses.len());
            return Err(CalibrationError::field(at, "sample", row.sample, allowed));
        };
        for (field, value) in [
            ("vx", row.vx),
            ("vy", row.vy),
            ("vz", row.vz),
            ("wx", row.wx),
            ("wy", row.wy),
            ("wz", row.wz),
        ] {
            check::check_finite(at, field, value, 1e4)?;
        }
        let rates = PoseVelocity {
            linear: DVec3::new(row.vx, row.vy, row.vz),
            angular: in_world(frame, pose.rotation, DVec3::new(row.wx, row.wy, row.wz)),
        };
        episode.known_start = Some((sample, rates));
        Ok(())
    })
}

fn checked_unit_quaternion(at: &str, rotation: DQuat) -> Result<DQuat, CalibrationError> {
    let length = rotation.length();
    if (length - 1.0).abs() <= UNIT_TOLERANCE {
        return Ok(rotation.normalize());
    }
    let hint = if length == 0.0 {
        "; the tracker lost the body? Leave the row out, or end the episode before it"
    } else {
        "; are they the quaternion's columns?"
    };
    let allowed = format!("1 within {UNIT_TOLERANCE}: x, y, z and w of a unit quaternion{hint}");
    Err(CalibrationError::field(
        at,
        "the length of qx, qy, qz, qw",
        length,
        allowed,
    ))
}

fn parse_rates(
    at: &str,
    row: &PoseRow,
    rotation: DQuat,
    frame: AngularFrame,
) -> Result<Option<PoseVelocity>, CalibrationError> {
    let all = [row.vx, row.vy, row.vz, row.wx, row.wy, row.wz];
    let given: Vec<f64> = all.iter().flatten().copied().collect();
    let [vx, vy, vz, wx, wy, wz] = given[..] else {
        if given.is_empty() {
            return Ok(None);
        }
        let found = format!("{} of 6", given.len());
        return Err(CalibrationError::field(
            at,
            "vx to wz",
            found,
            "all six, or none",
        ));
    };
    for (field, value) in ["vx", "vy", "vz", "wx", "wy", "wz"].iter().zip(&given) {
        check::check_finite(at, field, *value, 1e4)?;
    }
    Ok(Some(PoseVelocity {
        linear: DVec3::new(vx, vy, vz),
        angular: in_world(frame, rotation, DVec3::new(wx, wy, wz)),
    }))
}

fn in_world(frame: AngularFrame, world_from_body: DQuat, angular: DVec3) -> DVec3 {
    match frame {
        AngularFrame::Body => world_from_body * angular,
        AngularFrame::World => angular,
    }
}

/// Checks that the poses of all episodes are what the manifest says: evenly spaced, long enough, and with velocities that
/// agree with the poses in unit, sign, frame and clock.
pub(super) fn check_poses(
    name: &str,
    manifest: &MeasurementDescription,
    episodes: &[MeasuredEpisode],
) -> PoseCheck {
    let Some(form) = &manifest.poses else {
        return Ok(());
    };
    let step_s = 1.0 / form.rate_hz;
    for episode in episodes {
        let at = format!("{name}, episode {}", episode.name);
        let times: Vec<f64> = episode.poses.iter().map(|sample| sample.t_s).collect();
        unit_checks::check_even_sampling(&at, &times, form.rate_hz)?;
        for sample in &episode.poses {
            if sample.entity != episode.poses[0].entity {
                return Err(CalibrationError::field(
                    at,
                    "entity",
                    "more than one",
                    "one body an episode",
                ));
            }
        }
    }
    check_velocities(name, form.angular_velocity, step_s, episodes)
}

/// Sums of squares over samples that move fast enough.
#[derive(Default)]
struct VelocityMismatch {
    total: f64,
    left: f64,
    other_left: f64,
    /// Products of the stated velocities with those that the poses show, and squares of the latter.
    along: f64,
    shown: f64,
    count: usize,
}

impl VelocityMismatch {
    fn add(&mut self, from_poses: DVec3, stated: DVec3, other: DVec3) {
        if from_poses.length() < TELLING_SPEED || !from_poses.is_finite() {
            return;
        }
        self.count += 1;
        self.total += from_poses.length_squared();
        self.left += (stated - from_poses).length_squared();
        self.along += stated.dot(from_poses);
        self.shown += from_poses.length_squared();
        self.other_left += (other - from_poses).length_squared();
    }

    /// Returns the ratio of the stated velocities to those that the poses show.
    fn factor(&self) -> f64 {
        self.along / self.shown
    }

    /// The share of the motion that the stated velocities miss; `None` where too little moves.
    fn unexplained_share(&self) -> Option<f64> {
        (self.count >= FEWEST_TELLING).then(|| (self.left / self.total).sqrt())
    }
}

/// Velocities against differences of the poses: body against world, units, sign, and the clock's scale.
fn check_velocities(
    name: &str,
    frame: AngularFrame,
    step_s: f64,
    episodes: &[MeasuredEpisode],
) -> PoseCheck {
    let (mut linear, mut angular) = (VelocityMismatch::default(), VelocityMismatch::default());
    for episode in episodes {
        for pair in episode.poses.windows(3) {
            let Some(rates) = pair[1].rates else { continue };
            let moved = (pair[2].position - pair[0].position) / (2.0 * step_s);
            linear.add(moved, rates.linear, rates.linear);
            let turned =
                rotation_vector_between(pair[0].rotation, pair[2].rotation) / (2.0 * step_s);
            // The stated velocities, read in the other frame.
            let other = match frame {
                AngularFrame::Body => pair[1].rotation.inverse() * rates.angular,
                AngularFrame::World => pair[1].rotation * rates.angular,
            };
            angular.add(turned, rates.angular, other);
        }
    }
    if let Some(share) = linear
        .unexplained_share()
        .filter(|share| *share > WRONG_SHARE)
    {
        return Err(CalibrationError::field(
            format!("{name}/poses.csv"),
            "vx, vy, vz against differences of x, y, z: the share that disagrees",
            format!("{share:.2}"),
            format!(
                "at most {WRONG_SHARE}; they are {:.4} times what the positions show: bring both to one unit, and check axes and \
                 rate_hz",
                linear.factor()
            ),
        ));
    }
    if let Some(share) = angular
        .unexplained_share()
        .filter(|share| *share > WRONG_SHARE)
    {
        let hint = if angular.other_left < 0.25 * angular.left {
            "; they agree in the other frame: angular_velocity is wrong".to_owned()
        } else if let Some(hint) = unit_checks::degrees_hint("angular velocities", angular.factor())
        {
            format!("; {hint}")
        } else {
            "; check units, the quaternion's order (x, y, z, w) and rate_hz".to_owned()
        };
        return Err(CalibrationError::field(
            format!("{name}/poses.csv"),
            "wx, wy, wz against differences of the quaternions: the share that disagrees",
            format!("{share:.2}"),
            format!("at most {WRONG_SHARE}{hint}"),
        ));
    }
    Ok(())
}

/// The rotation vector that leads from `a` to `b`, along the axes of the world, rad.
pub(crate) fn rotation_vector_between(a: DQuat, b: DQuat) -> DVec3 {
    let mut between = b * a.inverse();
    if between.w < 0.0 {
        between = -between;
    }
    let axis = DVec3::new(between.x, between.y, between.z);
    let sine = axis.length();
    if sine < 1e-12 {
        return 2.0 * axis;
    }
    axis * (2.0 * libm::atan2(sine, between.w) / sine)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bundle::file::{
        BundleKind, PoseTableFormat, ResponseTimeOrigin, SceneManifest, VERSION,
    };

    const RATE_HZ: f64 = 100.0;

    /// Two episodes of a body that flies and tumbles about a tilted axis, with velocities along the world's axes.
    fn episodes() -> Vec<MeasuredEpisode> {
        let spin = DVec3::new(2.0, 5.0, -1.0);
        let episode = |k: usize| MeasuredEpisode {
            name: format!("e{k}"),
            poses: (0..60)
                .map(|k| {
                    let t_s = f64::from(k) / RATE_HZ;
                    let turned = DQuat::from_scaled_axis(spin * t_s);
                    let linear = DVec3::new(1.0, 2.0 - 9.81 * t_s, 0.5);
                    let fall = DVec3::NEG_Y * (4.905 * t_s * t_s);
                    PoseSample {
                        t_s,
                        entity: 0,
                        position: DVec3::new(1.0, 2.0, 0.5) * t_s + fall,
                        rotation: turned * DQuat::from_rotation_x(1.2),
                        rates: Some(PoseVelocity {
                            linear,
                            angular: spin,
                        }),
                    }
                })
                .collect(),
            ..MeasuredEpisode::default()
        };
        vec![episode(0), episode(1)]
    }

    fn judged(frame: AngularFrame, change: impl Fn(&mut PoseSample)) -> Result<(), String> {
        let mut episodes = episodes();
        for sample in episodes.iter_mut().flat_map(|episode| &mut episode.poses) {
            change(sample);
        }
        let manifest = MeasurementDescription {
            version: VERSION,
            title: String::new(),
            licence: String::new(),
            kind: BundleKind::PoseTrajectory,
            scene: SceneManifest::default(),
            command_clock: None,
            response_times: ResponseTimeOrigin::default(),
            channels: Vec::new(),
            poses: Some(PoseTableFormat {
                rate_hz: RATE_HZ,
                angular_velocity: frame,
                filtering: String::new(),
            }),
            notes: String::new(),
        };
        check_poses("b", &manifest, &episodes).map_err(|error| error.to_string())
    }

    fn rates(sample: &mut PoseSample) -> &mut PoseVelocity {
        sample.rates.as_mut().unwrap()
    }

    #[test]
    fn velocities_that_are_not_those_of_the_poses_are_told_with_what_is_likely_wrong() {
        judged(AngularFrame::World, |_| ()).unwrap();
        // World velocities that the manifest calls the body's: reading has turned them once too often.
        let turned = |s: &mut PoseSample| rates(s).angular = s.rotation * rates(s).angular;
        let told = judged(AngularFrame::Body, turned).unwrap_err();
        assert!(told.contains("angular_velocity is wrong"), "{told}");
        let told = judged(AngularFrame::World, |s| rates(s).angular *= 57.3).unwrap_err();
        assert!(
            told.contains("wx, wy, wz") && told.contains("in degrees?"),
            "{told}"
        );
        let told = judged(AngularFrame::World, |s| rates(s).linear *= -1.0).unwrap_err();
        assert!(told.contains("vx, vy, vz"), "{told}");
        let told = judged(AngularFrame::World, |s| s.t_s *= 2.0).unwrap_err();
        assert!(told.contains("t_s"), "{told}");
        judged(AngularFrame::World, |s| s.rates = None).unwrap();
    }
}
