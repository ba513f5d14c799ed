//! Which episodes choose parameters, and which judge them.

use crate::rollout::Tracks;
use dwell_scene::random::Key;
use std::collections::BTreeSet;

/// The fold of every episode, 0 to `count` - 1; episodes of one group share a fold. Shape (episode,).
pub(super) fn folds(tracks: &Tracks, count: usize, seed: u64) -> Vec<usize> {
    let groups: BTreeSet<&str> = tracks.episodes.iter().map(|e| e.group.as_str()).collect();
    let mut groups: Vec<&str> = groups.into_iter().collect();
    Key::root(seed).child("folds").stream().shuffle(&mut groups);
    let place = |group: &str| groups.iter().position(|other| *other == group);
    let episodes = tracks.episodes.iter();
    episodes
        .map(|episode| place(&episode.group).unwrap_or(0) % count)
        .collect()
}
