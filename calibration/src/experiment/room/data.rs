//! What is compared of a recording: levels, and times of the direct sound and of echoes.

use super::arrivals::PickedArrivals;
use super::levels::{self, WINDOWS};
use crate::bundle::{Bundle, MeasuredEpisode};
use crate::error::CalibrationError;
use crate::experiment::{ChannelInfo, EpisodeData};
use dwell_acoustics::bands::NOMINAL_CENTRES_HZ;
use glam::Vec3;

/// Floor of the standard deviation from chance and the ray count, dB.
const LEAST_SD_DB: f64 = 0.4;
/// Times are compared in ms.
pub(super) const MS: f64 = 1e3;
/// The direct sound of a recording whose sound rings is so many times less sharp.
const RINGING_SDS: f64 = 4.0;

/// An arrival whose path is known.
#[derive(Clone, Copy, Debug)]
pub(super) struct KnownArrival {
    /// Position among the episode's pairs.
    pub(super) pair: usize,
    pub(super) side: Option<usize>,
    pub(super) t_s: f64,
}

/// What an episode's numbers are.
#[derive(Clone, Debug, Default)]
pub(super) struct EpisodeLayout {
    pub(super) picked: Vec<PickedArrivals>,
    pub(super) known: Vec<KnownArrival>,
}

/// Checks that all responses have one rate.
pub(super) fn check_rates(bundle: &Bundle, rate_hz: Option<u32>) -> Result<(), CalibrationError> {
    for episode in &bundle.episodes {
        let other = episode
            .responses
            .iter()
            .find(|response| Some(response.rate_hz) != rate_hz);
        if let (Some(other), Some(rate_hz)) = (other, rate_hz) {
            let at = format!("{}/ir.csv, episode {}", bundle.name, episode.name);
            let allowed = format!("{rate_hz}, as the first");
            return Err(CalibrationError::field(
                at,
                "rate_hz",
                other.rate_hz,
                allowed,
            ));
        }
    }
    Ok(())
}

/// The pairs of source and receiver of an episode, and its arrivals among them.
pub(super) fn layout(episode: &MeasuredEpisode) -> (Vec<(Vec3, Vec3)>, EpisodeLayout) {
    let place = |p: [f64; 3]| Vec3::from_array(p.map(|x| x as f32));
    let mut pairs: Vec<(Vec3, Vec3)> = episode
        .responses
        .iter()
        .map(|r| (place(r.source_m), place(r.receiver_m)))
        .collect();
    let mut known = Vec::new();
    for arrival in &episode.arrivals {
        let ends = (place(arrival.source_m), place(arrival.receiver_m));
        let pair = pairs.iter().position(|other| *other == ends);
        let pair = pair.unwrap_or_else(|| {
            pairs.push(ends);
            pairs.len() - 1
        });
        known.push(KnownArrival {
            pair,
            side: arrival.side,
            t_s: arrival.t_s,
        });
    }
    let layout = EpisodeLayout {
        picked: Vec::new(),
        known,
    };
    (pairs, layout)
}

pub(super) fn channels(bands: &std::ops::Range<usize>) -> Vec<ChannelInfo> {
    let channel = |name: String, unit: &str| ChannelInfo {
        name,
        unit: unit.into(),
        noise_known: true,
    };
    let levels = bands
        .clone()
        .map(|band| channel(format!("{} Hz", NOMINAL_CENTRES_HZ[band]), "dB"));
    levels
        .chain(["direct sound", "echoes"].map(|name| channel(name.into(), "ms")))
        .collect()
}

/// An episode's numbers: levels of a response by band and window, the time of its direct sound, and those of its echoes;
/// then arrivals whose paths are known.
pub(super) fn episode_data(
    episode: &MeasuredEpisode,
    layout: &EpisodeLayout,
    bands: &std::ops::Range<usize>,
    time_sd_s: f64,
) -> EpisodeData {
    let mut measured = EpisodeData {
        name: episode.name.clone(),
        group: episode.group.clone(),
        ..EpisodeData::default()
    };
    let (direct, echoes) = (bands.len(), bands.len() + 1);
    let time = |measured: &mut EpisodeData, channel: usize, t_s: f64, sd_s: f64| {
        measured.measured.push(MS * t_s);
        measured.channel.push(channel);
        measured.t_s.push(t_s);
        measured.sd.push(MS * sd_s);
    };
    for (response, picked) in episode.responses.iter().zip(&layout.picked) {
        measured.measured.extend(levels::measured_db(response));
        for band in bands.clone() {
            for window in 0..WINDOWS {
                let edges = &levels::EDGES_S[window..window + 2];
                measured.channel.push(band - bands.start);
                measured.t_s.push(0.5 * (edges[0] + edges[1]));
                let chance_db = levels::level_sd_db(band, window);
                measured.sd.push(chance_db.hypot(LEAST_SD_DB));
            }
        }
        let sd_s = if picked.rings {
            RINGING_SDS * time_sd_s
        } else {
            time_sd_s
        };
        time(&mut measured, direct, picked.direct_s, sd_s);
        for echo in &picked.echoes {
            time(&mut measured, echoes, echo.t_s, time_sd_s);
        }
    }
    for known in &layout.known {
        let channel = if known.side.is_none() { direct } else { echoes };
        time(&mut measured, channel, known.t_s, time_sd_s);
    }
    measured
}
