//! The rules of `assets/furnishing.toml`.

use crate::generate::rooms::GeneratedRoomKind;
use serde::Deserialize;
use std::sync::OnceLock;

/// The kind of place of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum PlacementKind {
    /// With its back to a wall.
    Wall,
    /// With its back to a wall and a side to another.
    Corner,
    /// In the middle of the room.
    Centre,
    /// Beside its anchor, backs in line.
    Beside,
    /// Before its anchor, facing the same way.
    InFrontOf,
    /// Before its anchor and facing it.
    Facing,
    /// At the sides of its anchor, facing it.
    Around,
    /// Pushed under its anchor's front, facing it.
    At,
    /// On its anchor.
    On,
    /// On the wall above its anchor.
    Above,
    /// On a wall; with an anchor, as near to its front as can be, and not further than `gap_m`.
    Hung,
    /// On the ceiling.
    Ceiling,
    /// At every window, as wide as it.
    Window,
}

/// One rule.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FurnishingRule {
    pub(crate) rooms: Vec<GeneratedRoomKind>,
    /// Kinds of the catalogue: the first that fits is taken.
    pub(crate) kinds: Vec<String>,
    pub(crate) place: PlacementKind,
    /// Kinds of things that it goes with.
    #[serde(default)]
    pub(crate) of: Vec<String>,
    /// The smallest and the largest number.
    #[serde(default = "default_count_range")]
    pub(crate) count: [usize; 2],
    /// Probability that a home has it; `furniture_density` scales it.
    #[serde(default = "default_chance")]
    pub(crate) chance: f32,
    /// True if a room is none of its kind without it.
    #[serde(default)]
    pub(crate) required: bool,
    /// Free floor before it, m.
    #[serde(default)]
    pub(crate) front_m: f32,
    /// Distance from its anchor, m: the least, and the most when the distance is free.
    #[serde(default)]
    pub(crate) gap_m: [f32; 2],
    /// Height above the floor (or above its anchor's foot) at which it hangs, m.
    #[serde(default)]
    pub(crate) height_m: f32,
    /// Rooms that have one already do not get another.
    #[serde(default)]
    pub(crate) once: bool,
    /// True if no two in a room show the same picture.
    #[serde(default)]
    pub(crate) differ: bool,
    /// Rooms with less floor do not get it, m².
    #[serde(default)]
    pub(crate) from_m2: f32,
    /// The reason for the rule.
    pub(crate) reason: String,
}

/// A run of fitted units along one wall: the first row that fits is taken.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FittedRunRule {
    pub(crate) rooms: Vec<GeneratedRoomKind>,
    /// The rows of kinds; `"gap"` is no thing but leaves a gap.
    pub(crate) rows: Vec<Vec<String>>,
    /// Free floor before it, m.
    pub(crate) front_m: f32,
    pub(crate) reason: String,
}

/// Small things on or in larger ones.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SmallItemRule {
    pub(crate) kinds: Vec<String>,
    /// Kinds of things on which it stands.
    pub(crate) on: Vec<String>,
    /// Names of their spaces; empty: any.
    #[serde(default)]
    pub(crate) spaces: Vec<String>,
    /// Rooms; empty: any.
    #[serde(default)]
    pub(crate) rooms: Vec<GeneratedRoomKind>,
    /// True if it lies inside, else on top.
    #[serde(default)]
    pub(crate) inside: bool,
    /// The smallest and the largest number on each.
    pub(crate) count: [usize; 2],
    /// Largest turn either way, degrees.
    #[serde(default = "default_turn_deg")]
    pub(crate) turn_deg: f32,
    /// Its probability; `clutter` scales it.
    pub(crate) chance: f32,
    /// The reason for the rule.
    #[cfg_attr(not(test), expect(dead_code, reason = "for readers; tests ask for it"))]
    pub(crate) reason: String,
}

const fn default_count_range() -> [usize; 2] {
    [1, 1]
}

const fn default_turn_deg() -> f32 {
    180.0
}

const fn default_chance() -> f32 {
    1.0
}

/// All rules, in the order in which they are followed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FurnishingRules {
    pub(crate) run: Vec<FittedRunRule>,
    pub(crate) rule: Vec<FurnishingRule>,
    pub(crate) clutter: Vec<SmallItemRule>,
}

/// The rules of `assets/furnishing.toml`.
///
/// # Panics
/// Never: the file is part of the build, and this module's tests read it.
pub(crate) fn rules() -> &'static FurnishingRules {
    static RULES: OnceLock<FurnishingRules> = OnceLock::new();
    RULES.get_or_init(|| {
        let text = include_str!("../../../../../assets/furnishing.toml");
        toml::from_str(text).expect("assets/furnishing.toml is checked by this module's tests")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::furnish::fit_to_window::WINDOW_SIZED_KINDS;
    use dwell_furniture::catalogue::entries;

    #[test]
    fn every_rule_names_known_things_and_its_reason() {
        let known = |kind: &String| {
            entries().iter().any(|entry| entry.kind == kind)
                || WINDOW_SIZED_KINDS.contains(&kind.as_str())
        };
        let rules = rules();
        for rule in &rules.rule {
            for kind in rule.kinds.iter().chain(&rule.of) {
                assert!(known(kind), "{kind}");
            }
            assert!(rule.reason.len() > 8 && !rule.rooms.is_empty(), "{rule:?}");
            assert!(rule.count[0] <= rule.count[1], "{rule:?}");
        }
        for run in &rules.run {
            let kinds = run.rows.iter().flatten();
            assert!(kinds.filter(|k| *k != "gap").all(known), "{run:?}");
            assert!(run.reason.len() > 8, "{run:?}");
        }
        for clutter in &rules.clutter {
            for kind in clutter.kinds.iter().chain(&clutter.on) {
                assert!(known(kind), "{kind}");
            }
            assert!(clutter.reason.len() > 8, "{clutter:?}");
        }
    }
}
