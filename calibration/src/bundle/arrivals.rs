//! Reading of arrivals that were picked from recordings of a room, and checks of its materials.

use super::check::{self, ROOM_SURFACES};
use super::file::{ArrivalRow, MeasurementDescription};
use super::read::{episode_index, for_each_row};
use super::{MeasuredArrival, MeasuredEpisode};
use crate::error::CalibrationError;
use std::collections::BTreeMap;
use std::path::Path;

/// The name of the direct sound in `arrivals.csv`.
const DIRECT: &str = "direct";
/// The latest arrival, s.
const LATEST_S: f64 = 10.0;

/// Reads `arrivals.csv`.
pub(super) fn read(
    folder: &Path,
    by_name: &BTreeMap<String, usize>,
    manifest: &MeasurementDescription,
    episodes: &mut [MeasuredEpisode],
) -> Result<(), CalibrationError> {
    for_each_row(folder, "arrivals.csv", |row: ArrivalRow, at| {
        let source_m = [row.source_x, row.source_y, row.source_z];
        let receiver_m = [row.receiver_x, row.receiver_y, row.receiver_z];
        check::check_point_in_room(at, "source", source_m, manifest)?;
        check::check_point_in_room(at, "receiver", receiver_m, manifest)?;
        let side = ROOM_SURFACES.iter().position(|side| *side == row.path);
        if side.is_none() && row.path != DIRECT {
            return Err(CalibrationError::field(
                at,
                "path",
                format!("{:?}", row.path),
                format!("{DIRECT:?} or one of {ROOM_SURFACES:?}"),
            ));
        }
        if !(-LATEST_S..=LATEST_S).contains(&row.t_s) {
            let allowed = format!("within {LATEST_S} s; is it in milliseconds?");
            return Err(CalibrationError::field(at, "t_s", row.t_s, allowed));
        }
        episodes[episode_index(at, by_name, &row.episode)?]
            .arrivals
            .push(MeasuredArrival {
                source_m,
                receiver_m,
                side,
                t_s: row.t_s,
            });
        Ok(())
    })
}

/// Checks how well places are known, and that sides of one material state the same values.
pub(super) fn check_room(
    name: &str,
    manifest: &MeasurementDescription,
) -> Result<(), CalibrationError> {
    let Some(room) = &manifest.scene.room else {
        return Ok(());
    };
    let at = format!("{name}/manifest.json");
    if let Some(sd) = room.position_sd_m
        && !(1e-4..=1.0).contains(&sd)
    {
        let field = "scene.room.position_sd_m";
        return Err(CalibrationError::field(at, field, sd, "0.0001 to 1 m"));
    }
    for (side, surface) in &room.surfaces {
        let Some(material) = &surface.material else {
            continue;
        };
        check::check_name(
            &at,
            &format!("scene.room.surfaces.{side}.material"),
            material,
        )?;
        let named = |other: &&String| {
            let told = room.surfaces[*other].material.as_ref();
            told.unwrap_or(*other) == material
        };
        let other = room.surfaces.keys().filter(named).find(|other| {
            let other = &room.surfaces[*other];
            (&other.absorption, other.scattering, &other.substance)
                != (&surface.absorption, surface.scattering, &surface.substance)
        });
        if let Some(other) = other {
            return Err(CalibrationError::field(
                at,
                format!("scene.room.surfaces.{side}.material"),
                format!("{material:?}, as of {other}, with other values"),
                "the same absorption, scattering and substance for all sides of one material",
            ));
        }
    }
    Ok(())
}
