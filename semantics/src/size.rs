//! Words for sizes.

use crate::category::SemanticCategory;
use dwell_scene::math;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Returns whether a box says nothing about the size of such things: doors swing, cloth is folded, and built-in things have the size
/// of its room.
fn has_no_usual_size(row: &SemanticCategory) -> bool {
    let classes = ["door", "curtain", "blinds", "towel", "clothes", "counter"];
    row.structure
        || classes.contains(&row.nyu40_name)
        || ["blanket", "umbrella"].contains(&row.name)
}

/// The size of a thing relative to a usual specimen of its category.
///
/// With A the product of the two longest edges of its box (in the axes of its own root part) and A0 that of the usual
/// specimen in `assets/categories.csv`, z = log2(A / A0): sizes of a kind of thing spread by ratios, and the face that a
/// thing shows says more than its thickness.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum SizeClass {
    /// z below -3: less than 0.35 times as long and wide.
    Tiny,
    /// z from -3 to -1.2.
    Small,
    /// z from -1.2 to 1.2: 0.66 to 1.5 times as long and wide; not worth a word.
    #[default]
    Normal,
    /// z from 1.2 to 3.
    Large,
    /// z above 3: more than 2.8 times as long and wide.
    Huge,
}

impl SizeClass {
    /// All sizes, the smallest first.
    pub const ALL: [Self; 5] = [
        Self::Tiny,
        Self::Small,
        Self::Normal,
        Self::Large,
        Self::Huge,
    ];

    /// The size of a box of `extents_m` beside the usual one of `row`; [`SizeClass::Normal`] for an unknown category
    /// and for what folds, swings or is built in.
    pub fn of(extents_m: Vec3, row: Option<&SemanticCategory>) -> Self {
        let Some(row) = row.filter(|row| !has_no_usual_size(row)) else {
            return Self::Normal;
        };
        let face = |m: Vec3| {
            let area = (m.x * m.y).max(m.y * m.z).max(m.z * m.x);
            area.max(1e-6)
        };
        let ratio = face(extents_m) / face(Vec3::from(row.size_m));
        match math::ln(ratio) / std::f32::consts::LN_2 {
            z if z < -3.0 => Self::Tiny,
            z if z < -1.2 => Self::Small,
            z if z <= 1.2 => Self::Normal,
            z if z <= 3.0 => Self::Large,
            _ => Self::Huge,
        }
    }

    /// The adjective; `None` for the usual size.
    pub fn word(self) -> Option<&'static str> {
        match self {
            Self::Tiny => Some("tiny"),
            Self::Small => Some("small"),
            Self::Normal => None,
            Self::Large => Some("large"),
            Self::Huge => Some("huge"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::category::categories;

    #[test]
    fn size_grows_with_the_thing_and_the_usual_one_is_normal() {
        for row in categories().rows() {
            let usual = Vec3::from(row.size_m);
            assert_eq!(
                SizeClass::of(usual, Some(row)),
                SizeClass::Normal,
                "{}",
                row.name
            );
            if has_no_usual_size(row) {
                assert_eq!(SizeClass::of(usual * 3.0, Some(row)), SizeClass::Normal);
                continue;
            }
            let mut last = SizeClass::Tiny;
            for k in 1..60 {
                let size = SizeClass::of(usual * (k as f32 * 0.05), Some(row));
                assert!(size >= last);
                last = size;
            }
            assert_eq!(last, SizeClass::Huge);
        }
        assert_eq!(SizeClass::of(Vec3::ONE, None), SizeClass::Normal);
    }
}
