//! Reading of files into a checked [`Bundle`].

use super::check::{self, NameIndex};
use super::file::{
    BundleKind, CommandRow, EpisodeRow, ImpulseResponseRow, MeasurementDescription, TrajectoryRow,
};
use super::limits;
use super::sufficiency;
use super::{
    Bundle, MeasuredEpisode, MeasuredResponse, MeasuredSample, arrivals, odometry, poses, row,
    spins, wav,
};
use crate::error::CalibrationError;
use dwell_scene::file::{self, ReadError};
use serde::Deserialize as _;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::{BufReader, Read as _};
use std::path::{Component, Path, PathBuf};

/// Reads and checks a bundle.
pub(crate) fn read(folder: &Path) -> Result<Bundle, CalibrationError> {
    let name = folder.display().to_string();
    if folder.exists() && !folder.join("manifest.json").exists() {
        return Err(CalibrationError::Missing {
            at: name,
            what: "manifest.json".to_owned(),
            needed:
                "a bundle is a folder NAME.measured, which `dwell measure import` makes of tables"
                    .to_owned(),
        });
    }
    let manifest = manifest(folder)?;
    check::check_manifest(&format!("{name}/manifest.json"), &manifest)?;
    let mut bundle = Bundle {
        episodes: episodes(folder)?,
        name,
        manifest,
    };
    let by_name: BTreeMap<String, usize> = bundle
        .episodes
        .iter()
        .enumerate()
        .map(|(k, episode)| (episode.name.clone(), k))
        .collect();
    let names = NameIndex::new(&bundle.manifest);
    match bundle.kind() {
        BundleKind::Trajectory => trajectory(folder, &names, &by_name, &mut bundle.episodes)?,
        BundleKind::Servo => {
            trajectory(folder, &names, &by_name, &mut bundle.episodes)?;
            commands(folder, &names, &by_name, &mut bundle.episodes)?;
        }
        BundleKind::ImpulseResponse => {
            if folder.join("arrivals.csv").exists() {
                arrivals::read(folder, &by_name, &bundle.manifest, &mut bundle.episodes)?;
            } else {
                responses(folder, &bundle.manifest, &by_name, &mut bundle.episodes)?;
            }
            arrivals::check_room(&bundle.name, &bundle.manifest)?;
        }
        BundleKind::PoseTrajectory => {
            poses::read(
                folder,
                &names,
                &by_name,
                &bundle.manifest,
                &mut bundle.episodes,
            )?;
        }
        BundleKind::Drive => odometry::read(folder, &by_name, &mut bundle.episodes)?,
    }
    sufficiency::check_sufficient_data(&bundle)?;
    spins::check_spins(&bundle.name, &bundle.manifest, &bundle.episodes)?;
    Ok(bundle)
}

/// Opens a file of the bundle that lies inside its folder and is not too large.
fn open(folder: &Path, relative: &str, limit: u64) -> Result<(fs::File, String), CalibrationError> {
    let at = folder.join(relative).display().to_string();
    let inside = Path::new(relative)
        .components()
        .all(|part| matches!(part, Component::Normal(_)));
    if !inside || relative.is_empty() || relative.len() > 1024 {
        let allowed = "a path inside the bundle, without ..";
        return Err(CalibrationError::field(
            folder.display().to_string(),
            "file",
            format!("{relative:?}"),
            allowed,
        ));
    }
    let fault = |path: PathBuf| move |source| CalibrationError::Read { path, source };
    let path = folder.join(relative);
    // A link could lead out of the folder.
    let root = fs::canonicalize(folder).map_err(fault(folder.to_owned()))?;
    let real = fs::canonicalize(&path).map_err(fault(path.clone()))?;
    if !real.starts_with(&root) {
        return Err(CalibrationError::field(
            at,
            "file",
            "a link out of the bundle",
            "a file inside the bundle",
        ));
    }
    let file = file::open(&real, limit).map_err(read_error(&path))?;
    Ok((file, at))
}

/// The error of a file that was not read.
pub(crate) fn read_error(path: &Path) -> impl FnOnce(ReadError) -> CalibrationError {
    move |error| match error {
        ReadError::Io(source) => {
            let path = path.to_owned();
            CalibrationError::Read { path, source }
        }
        ReadError::TooLarge { found, allowed } => CalibrationError::TooLarge {
            at: path.display().to_string(),
            what: "bytes",
            found,
            limit: allowed,
        },
    }
}

fn manifest(folder: &Path) -> Result<MeasurementDescription, CalibrationError> {
    let (file, at) = open(folder, "manifest.json", limits::MAX_MANIFEST_BYTES)?;
    let mut text = String::new();
    file.take(limits::MAX_MANIFEST_BYTES)
        .read_to_string(&mut text)
        .map_err(|source| CalibrationError::Read {
            path: folder.join("manifest.json"),
            source,
        })?;
    // Some editors begin with a byte order mark.
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    // serde would take a list for the fields in their order.
    if text.trim_start().starts_with('[') {
        return Err(CalibrationError::Syntax {
            at,
            what: "found a list; expected values by name".to_owned(),
        });
    }
    // Of an enumeration that is no text the reader says only that a value was expected.
    if let Ok(Value::Object(fields)) = serde_json::from_str(text)
        && let Some(kind) = fields.get("kind")
        && BundleKind::deserialize(kind).is_err()
    {
        let allowed = BundleKind::deserialize(&Value::from(""))
            .map_or_else(|error| error.to_string(), |_| String::new());
        let allowed = allowed.rsplit("expected ").next().unwrap_or_default();
        return Err(CalibrationError::field(at, "kind", kind, allowed));
    }
    serde_json::from_str(text).map_err(|error| CalibrationError::Syntax {
        at: format!("{at} line {}", error.line()),
        what: error.to_string(),
    })
}

/// Calls `row` with every row of a table and its place.
pub(super) fn for_each_row<T: DeserializeOwned>(
    folder: &Path,
    name: &str,
    mut each: impl FnMut(T, &str) -> Result<(), CalibrationError>,
) -> Result<(), CalibrationError> {
    let (file, at) = open(folder, name, limits::MAX_TABLE_BYTES)?;
    let limited = BufReader::new(file).take(limits::MAX_TABLE_BYTES);
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_reader(limited);
    let head = reader.headers().cloned();
    let head = head.map_err(|error| {
        let none = csv::StringRecord::new();
        row::row_error(&format!("{at} line 1"), &error, &none, &none)
    })?;
    for (count, record) in reader.records().enumerate() {
        // Line 1 is the head.
        let here = format!("{at} line {}", count + 2);
        if count as u64 >= limits::MAX_TABLE_ROWS {
            let (found, limit) = (count as u64 + 1, limits::MAX_TABLE_ROWS);
            return Err(CalibrationError::TooLarge {
                at,
                what: "rows",
                found,
                limit,
            });
        }
        let none = csv::StringRecord::new();
        let cells = record.map_err(|error| row::row_error(&here, &error, &head, &none))?;
        let record = cells.deserialize(Some(&head));
        let record = record.map_err(|error| row::row_error(&here, &error, &head, &cells))?;
        each(record, &here)?;
    }
    Ok(())
}

fn episodes(folder: &Path) -> Result<Vec<MeasuredEpisode>, CalibrationError> {
    let mut found: Vec<MeasuredEpisode> = Vec::new();
    let mut names = BTreeSet::new();
    for_each_row(folder, "episodes.csv", |row: EpisodeRow, at| {
        check::check_name(at, "episode", &row.episode)?;
        check::check_name(at, "split_group", &row.split_group)?;
        if !names.insert(row.episode.clone()) {
            return Err(CalibrationError::field(
                at,
                "episode",
                format!("{:?} again", row.episode),
                "each name once",
            ));
        }
        if found.len() as u64 >= limits::MAX_EPISODES {
            let limit = limits::MAX_EPISODES;
            return Err(CalibrationError::TooLarge {
                at: at.to_owned(),
                what: "episodes",
                found: limit + 1,
                limit,
            });
        }
        found.push(MeasuredEpisode {
            name: row.episode,
            group: row.split_group,
            ..MeasuredEpisode::default()
        });
        Ok(())
    })?;
    Ok(found)
}

/// The position of an episode.
pub(super) fn episode_index(
    at: &str,
    by_name: &BTreeMap<String, usize>,
    name: &str,
) -> Result<usize, CalibrationError> {
    by_name.get(name).copied().ok_or_else(|| {
        CalibrationError::field(
            at,
            "episode",
            format!("{name:?}"),
            "a name that stands in episodes.csv",
        )
    })
}

fn trajectory(
    folder: &Path,
    names: &NameIndex,
    by_name: &BTreeMap<String, usize>,
    episodes: &mut [MeasuredEpisode],
) -> Result<(), CalibrationError> {
    for_each_row(folder, "trajectory.csv", |row: TrajectoryRow, at| {
        check::check_time(at, row.t_s)?;
        check::check_finite(at, "value", row.value, 1e6)?;
        let sample = MeasuredSample {
            entity: names.entity(at, "entity", &row.entity)?,
            channel: names.channel(at, &row.channel)?,
            t_s: row.t_s,
            value: row.value,
        };
        episodes[episode_index(at, by_name, &row.episode)?]
            .samples
            .push(sample);
        Ok(())
    })?;
    for episode in episodes {
        let order = |s: &MeasuredSample| (s.entity, s.channel);
        episode
            .samples
            .sort_by(|a, b| order(a).cmp(&order(b)).then(a.t_s.total_cmp(&b.t_s)));
    }
    Ok(())
}

fn commands(
    folder: &Path,
    names: &NameIndex,
    by_name: &BTreeMap<String, usize>,
    episodes: &mut [MeasuredEpisode],
) -> Result<(), CalibrationError> {
    for_each_row(folder, "command.csv", |row: CommandRow, at| {
        check::check_time(at, row.t_s)?;
        check::check_finite(at, "value", row.value, 1e3)?;
        names.entity(at, "actuator", &row.actuator)?;
        if row.kind != "position" {
            return Err(CalibrationError::field(
                at,
                "kind",
                format!("{:?}", row.kind),
                "position",
            ));
        }
        episodes[episode_index(at, by_name, &row.episode)?]
            .commands
            .push(row);
        Ok(())
    })?;
    for episode in episodes {
        episode.commands.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
    }
    Ok(())
}

fn responses(
    folder: &Path,
    manifest: &MeasurementDescription,
    by_name: &BTreeMap<String, usize>,
    episodes: &mut [MeasuredEpisode],
) -> Result<(), CalibrationError> {
    let mut count = 0;
    for_each_row(folder, "ir.csv", |row: ImpulseResponseRow, at| {
        count += 1;
        if count > limits::MAX_RESPONSES {
            let limit = limits::MAX_RESPONSES;
            return Err(CalibrationError::TooLarge {
                at: at.to_owned(),
                what: "responses",
                found: count,
                limit,
            });
        }
        let source_m = [row.source_x, row.source_y, row.source_z];
        let receiver_m = [row.receiver_x, row.receiver_y, row.receiver_z];
        check::check_point_in_room(at, "source", source_m, manifest)?;
        check::check_point_in_room(at, "receiver", receiver_m, manifest)?;
        let (file, wav_at) = open(folder, &row.file, limits::MAX_WAV_BYTES)?;
        let samples = wav::samples(file, &wav_at, row.rate_hz)?;
        episodes[episode_index(at, by_name, &row.episode)?]
            .responses
            .push(MeasuredResponse {
                source_m,
                receiver_m,
                rate_hz: row.rate_hz,
                samples,
            });
        Ok(())
    })
}
