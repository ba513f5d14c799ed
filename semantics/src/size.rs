//! Words for sizes.

use crate::category::CategoryRow;
use dwell_scene::math;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// How large a thing is beside a usual specimen of its category.
///
/// With V the volume of its box (in the axes of its own root part) and V0 that of the usual specimen in
/// `assets/categories.csv`, z = log2(V / V0): sizes of a kind of thing spread by ratios, so the scale is a ratio.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Size {
    /// z below -3: less than an eighth of the usual volume.
    Tiny,
    /// z from -3 to -1.25.
    Small,
    /// z from -1.25 to 1.25: 0.42 to 2.4 times the usual volume; not worth a word.
    #[default]
    Normal,
    /// z from 1.25 to 3.
    Large,
    /// z above 3: more than eight times the usual volume.
    Huge,
}

impl Size {
    /// The size of a box of `extents_m` beside the usual one of `row`; [`Size::Normal`] for an unknown category
    /// and for doors, whose box grows when they open.
    pub fn of(extents_m: Vec3, row: Option<&CategoryRow>) -> Self {
        let Some(row) = row.filter(|row| row.nyu40_name != "door") else {
            return Self::Normal;
        };
        // A centimetre is the least thickness, so that rugs and panes compare by area.
        let volume = |m: Vec3| m.max(Vec3::splat(0.01)).element_product();
        let ratio = volume(extents_m) / volume(Vec3::from(row.size_m));
        match math::ln(ratio) / std::f32::consts::LN_2 {
            z if z < -3.0 => Self::Tiny,
            z if z < -1.25 => Self::Small,
            z if z <= 1.25 => Self::Normal,
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
    fn size_grows_with_volume_and_the_usual_one_is_normal() {
        for row in categories().rows() {
            let usual = Vec3::from(row.size_m);
            assert_eq!(Size::of(usual, Some(row)), Size::Normal, "{}", row.name);
            if row.nyu40_name == "door" {
                assert_eq!(Size::of(usual * 3.0, Some(row)), Size::Normal);
                continue;
            }
            let mut last = Size::Tiny;
            for k in 1..60 {
                let size = Size::of(usual * (k as f32 * 0.05), Some(row));
                assert!(size >= last);
                last = size;
            }
            assert_eq!(last, Size::Huge);
        }
        assert_eq!(Size::of(Vec3::ONE, None), Size::Normal);
    }
}
