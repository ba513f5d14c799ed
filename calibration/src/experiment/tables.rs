//! The rows of a bundle's tables as fitting sees them.

use super::{ChannelInfo, EpisodeData};
use crate::bundle::{Bundle, MeasuredEpisode, MeasuredSample};

/// The channels of the manifest.
pub(super) fn channels(bundle: &Bundle) -> Vec<ChannelInfo> {
    let channels = bundle.manifest.channels.iter();
    channels
        .map(|channel| ChannelInfo {
            name: channel.name.clone(),
            unit: channel.unit.clone(),
            noise_known: channel.noise_sd.is_some(),
        })
        .collect()
}

/// An episode's numbers, with times from its first sample on.
pub(super) fn episode_data(bundle: &Bundle, episode: &MeasuredEpisode) -> EpisodeData {
    let first = episode
        .samples
        .iter()
        .map(|s| s.t_s)
        .fold(f64::INFINITY, f64::min);
    let column =
        |f: &dyn Fn(&MeasuredSample) -> f64| episode.samples.iter().map(f).collect::<Vec<f64>>();
    EpisodeData {
        name: episode.name.clone(),
        group: episode.group.clone(),
        measured: column(&|s| s.value),
        channel: episode.samples.iter().map(|s| s.channel).collect(),
        t_s: column(&|s| s.t_s - first),
        sd: column(&|s| bundle.manifest.channels[s.channel].noise_sd.unwrap_or(1.0)),
    }
}
