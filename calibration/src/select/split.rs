//! The split of episodes into those that are fitted and those held out from all fitting.

use crate::experiment::EpisodeData;
use dwell_scene::random::RandomKey;
use std::collections::BTreeSet;

/// Positions of the episodes for fitting, and of those held out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct EpisodeSplit {
    pub(crate) train: Vec<usize>,
    pub(crate) held_out: Vec<usize>,
    /// True if whole groups are held out; else there is one group only, or groups too unequal for that, and episodes are.
    pub(crate) by_group: bool,
}

impl EpisodeSplit {
    /// Draws groups until `share` of the episodes is held out, leaving at least two on both sides. Where whole groups do not
    /// allow that, single episodes are drawn.
    pub(crate) fn new(episodes: &[EpisodeData], share: f64, seed: u64) -> Self {
        let groups: BTreeSet<&str> = episodes
            .iter()
            .map(|episode| episode.group.as_str())
            .collect();
        if groups.len() > 1 {
            let split = Self::draw(episodes, share, seed, true);
            if split.held_out.len() >= 2 {
                return split;
            }
        }
        Self::draw(episodes, share, seed, false)
    }

    fn draw(episodes: &[EpisodeData], share: f64, seed: u64, by_group: bool) -> Self {
        let label = |k: usize| {
            if by_group {
                episodes[k].group.as_str()
            } else {
                episodes[k].name.as_str()
            }
        };
        let labels: BTreeSet<&str> = (0..episodes.len()).map(label).collect();
        let mut labels: Vec<&str> = labels.into_iter().collect();
        RandomKey::root(seed)
            .child("split")
            .stream()
            .shuffle(&mut labels);
        let members = |label_here: &str| {
            (0..episodes.len())
                .filter(|k| label(*k) == label_here)
                .count()
        };
        let wanted =
            ((share * episodes.len() as f64).round() as usize).clamp(2, episodes.len() - 2);
        let (mut held, mut count) = (BTreeSet::new(), 0);
        for label in &labels {
            let more = members(label);
            if count < wanted && count + more + 2 <= episodes.len() {
                held.insert(*label);
                count += more;
            }
        }
        let (held_out, train) = (0..episodes.len()).partition(|k| held.contains(label(*k)));
        Self {
            train,
            held_out,
            by_group,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn episodes(groups: &[&str]) -> Vec<EpisodeData> {
        let named = groups.iter().enumerate();
        named
            .map(|(k, group)| EpisodeData {
                name: format!("e{k}"),
                group: (*group).to_owned(),
                ..EpisodeData::default()
            })
            .collect()
    }

    #[test]
    fn two_episodes_judge_however_unequal_the_groups_are() {
        for groups in ["abbb", "abbbbb", "aaab", "aabb", "abcd"] {
            let names: Vec<&str> = groups.split("").filter(|name| !name.is_empty()).collect();
            for seed in 0..20 {
                let split = EpisodeSplit::new(&episodes(&names), 1.0 / 3.0, seed);
                assert!(
                    split.train.len() >= 2 && split.held_out.len() >= 2,
                    "{groups}: {split:?}"
                );
                assert_eq!(split.train.len() + split.held_out.len(), names.len());
            }
        }
    }

    #[test]
    fn groups_are_never_torn() {
        for seed in 0..20 {
            let all = episodes(&["a", "a", "b", "b", "c", "c", "d", "d", "e"]);
            let split = EpisodeSplit::new(&all, 1.0 / 3.0, seed);
            assert!(
                split.by_group && split.train.len() >= 2 && split.held_out.len() >= 2,
                "{split:?}"
            );
            for k in &split.held_out {
                assert!(split.train.iter().all(|t| all[*t].group != all[*k].group));
            }
        }
        assert_eq!(
            EpisodeSplit::new(&episodes(&["a"; 9]), 1.0 / 3.0, 3)
                .held_out
                .len(),
            3
        );
    }
}
