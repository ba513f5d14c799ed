//! Folds: the episodes that choose parameters, and those that judge them.

use dwell_scene::random::RandomKey;
use std::collections::BTreeSet;

/// The fold of every episode, 0 to `count` - 1, by the group of each; episodes of one group share a fold. Shape (episode,).
pub(in crate::rollout) fn folds(group_of: &[&str], count: usize, seed: u64) -> Vec<usize> {
    let groups: BTreeSet<&str> = group_of.iter().copied().collect();
    let mut groups: Vec<&str> = groups.into_iter().collect();
    RandomKey::root(seed)
        .child("folds")
        .stream()
        .shuffle(&mut groups);
    let place = |group: &str| groups.iter().position(|other| *other == group);
    let episodes = group_of.iter();
    episodes
        .map(|group| place(group).unwrap_or(0) % count)
        .collect()
}
