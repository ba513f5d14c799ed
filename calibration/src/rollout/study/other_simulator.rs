//! Scores of another simulator on the same episodes, compared episode by episode.

use crate::bundle::read_error;
use crate::error::CalibrationError;
use crate::median::median;
use crate::rollout::{MeanDeviation, PoseTracks, ScoreSummary};
use dwell_scene::file;
use dwell_scene::random::RandomKey;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// Bytes of a table of scores that are read.
const MOST_BYTES: u64 = 16 << 20;

/// Another simulator's scores.
#[derive(Clone, Debug, PartialEq)]
pub struct PeerScores {
    /// Its name.
    pub name: String,
    /// By episode.
    pub scores: BTreeMap<String, MeanDeviation>,
}

/// The columns of a table of scores.
const COLUMNS: [&str; 4] = ["episode", "position_widths", "rotation_deg", "e_q"];

/// A row of a table of scores.
#[derive(Deserialize)]
struct PeerScoreRow {
    episode: String,
    position_widths: f64,
    rotation_deg: f64,
    e_q: f64,
}

impl PeerScores {
    /// Reads a CSV table with the columns `episode, position_widths, rotation_deg, e_q`; the file's name is the peer's.
    ///
    /// # Errors
    /// [`CalibrationError::Read`], [`CalibrationError::Syntax`], [`CalibrationError::TooLarge`] name file and line.
    pub fn read(path: &Path) -> Result<Self, CalibrationError> {
        let at = path.display().to_string();
        let text = file::read(path, MOST_BYTES).map_err(read_error(path))?;
        let mut scores = BTreeMap::new();
        for (k, row) in csv::Reader::from_reader(&text[..])
            .deserialize()
            .enumerate()
        {
            let row: PeerScoreRow = row.map_err(|error| CalibrationError::Syntax {
                at: format!("{at} line {}", k + 2),
                what: format!("{error}; columns are {}", COLUMNS.join(", ")),
            })?;
            let score = MeanDeviation {
                position_widths: row.position_widths,
                rotation_deg: row.rotation_deg,
                e_q: row.e_q,
                ..MeanDeviation::default()
            };
            scores.insert(row.episode, score);
        }
        let name = path
            .file_stem()
            .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        Ok(Self { name, scores })
    }
}

/// One quantity, episode by episode: ours minus theirs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SimulatorScoreDifference {
    /// The share of episodes in which ours is smaller.
    pub better_share: f64,
    /// The median difference; below 0: ours is smaller.
    pub median_difference: f64,
    /// Its 95 % interval over draws of episodes.
    pub interval: [f64; 2],
}

/// The comparison with a peer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SimulatorComparison {
    /// The peer.
    pub name: String,
    /// Its own figures on the shared episodes.
    pub summary: ScoreSummary,
    /// Distance, as a share of the body's width.
    pub position_widths: SimulatorScoreDifference,
    /// Angle, degrees.
    pub rotation_deg: SimulatorScoreDifference,
    /// The published loss.
    pub e_q: SimulatorScoreDifference,
}

/// Compares the scores of all episodes with a peer's.
///
/// # Errors
/// [`CalibrationError::Missing`] when the peer lacks an episode.
pub(super) fn compare(
    tracks: &PoseTracks,
    ours: &[MeanDeviation],
    peer: &PeerScores,
    draws: usize,
    key: RandomKey,
) -> Result<SimulatorComparison, CalibrationError> {
    let mut theirs = Vec::with_capacity(ours.len());
    for episode in &tracks.episodes {
        let Some(score) = peer.scores.get(&episode.name) else {
            return Err(CalibrationError::Missing {
                at: format!("scores of {}", peer.name),
                what: format!("episode {:?}", episode.name),
                needed: "every episode of the bundle must be scored".to_owned(),
            });
        };
        theirs.push(*score);
    }
    let paired = |f: fn(&MeanDeviation) -> f64, what: &str| {
        let pairs = ours.iter().zip(&theirs);
        let differences: Vec<f64> = pairs.map(|(a, b)| f(a) - f(b)).collect();
        let mut stream = key.child(what).stream();
        let mut medians: Vec<f64> = (0..draws.max(1))
            .map(|_| {
                let count = differences.len();
                let mut drawn: Vec<f64> = (0..count)
                    .map(|_| differences[stream.below(count)])
                    .collect();
                median(&mut drawn)
            })
            .collect();
        medians.sort_by(f64::total_cmp);
        let at = |share: f64| medians[(share * (medians.len() - 1) as f64).round() as usize];
        let better = differences.iter().filter(|d| **d < 0.0).count();
        SimulatorScoreDifference {
            better_share: better as f64 / differences.len() as f64,
            median_difference: median(&mut differences.clone()),
            interval: [at(0.025), at(0.975)],
        }
    };
    Ok(SimulatorComparison {
        name: peer.name.clone(),
        summary: ScoreSummary::of(&theirs),
        position_widths: paired(|s| s.position_widths, "position"),
        rotation_deg: paired(|s| s.rotation_deg, "rotation"),
        e_q: paired(|s| s.e_q, "e_q"),
    })
}
