//! The taste of one house: what its things are made of and coloured in, so that what stands together goes together.

mod front_style;
mod held_out;
mod train;

pub use front_style::FrontStyle;

use super::finishes::Finish;
use super::shapes::{SolidMesh, rod, surface_of_revolution, tapered_leg};
use super::textures::Srgb;
use dwell_scene::random::RandomStream;

/// Which houses may use a style: looks of `Val` and `Test` never occur in houses for training.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum StyleSplit {
    /// For training.
    Train,
    /// For choosing between trained agents.
    Val,
    /// For the final test.
    Test,
}

/// The shape of legs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LegStyle {
    /// Square, thinner towards the foot.
    Tapered,
    /// Square, as thick below as above.
    Square,
    /// Turned on a lathe, with beads.
    Turned,
    /// Thin round bars of metal.
    Metal,
}

/// The taste of one house. Models take finishes from here by role and vary them by their key.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// `"nordic"`.
    pub name: &'static str,
    /// The split of houses that may have it: train, val or test.
    pub split: StyleSplit,
    /// Tables, beds, shelves.
    pub wood: Finish,
    /// The wood of smaller pieces.
    pub second_wood: Finish,
    /// Doors and drawers of cupboards.
    pub front: Finish,
    /// Doors and drawers of the kitchen.
    pub kitchen_front: Finish,
    /// The kitchen's worktop.
    pub worktop: Finish,
    /// Handles, lamps, frames.
    pub metal: Finish,
    /// Sofas and armchairs.
    pub upholstery: [Finish; 2],
    /// Cushions, curtains, blankets.
    pub cloths: [Finish; 4],
    /// Towels and rugs.
    pub terries: [Finish; 2],
    /// Vases, mugs, lamp bases.
    pub glazes: [Finish; 3],
    /// Paint on the walls, sRGB: the calm tone, then those that a room may have.
    pub walls: [Srgb; 4],
    /// Boards of the floors.
    pub floor: Finish,
    /// Casings of household appliances.
    pub appliance: Finish,
    /// Legs of tables, seats and beds.
    pub leg: LegStyle,
    /// True if doors and drawers have knobs instead of bars.
    pub knobs: bool,
    /// True if doors and drawers are framed panels instead of plain boards.
    pub panelled: bool,
}

impl Style {
    /// One of the cloths.
    pub fn random_cloth(&self, stream: &mut RandomStream) -> &Finish {
        &self.cloths[stream.below(self.cloths.len())]
    }

    /// One of the coverings of seats.
    pub fn random_upholstery(&self, stream: &mut RandomStream) -> &Finish {
        &self.upholstery[stream.below(self.upholstery.len())]
    }

    /// One of the terries.
    pub fn random_terry(&self, stream: &mut RandomStream) -> &Finish {
        &self.terries[stream.below(self.terries.len())]
    }

    /// One of the glazes.
    pub fn random_glaze(&self, stream: &mut RandomStream) -> &Finish {
        &self.glazes[stream.below(self.glazes.len())]
    }

    /// One of the two woods, more often the first.
    pub fn random_wood(&self, stream: &mut RandomStream) -> &Finish {
        if stream.below(3) == 0 {
            &self.second_wood
        } else {
            &self.wood
        }
    }

    /// Returns what legs are made of.
    pub fn leg_finish(&self) -> &Finish {
        match self.leg {
            LegStyle::Metal => &self.metal,
            _ => &self.wood,
        }
    }

    /// Four upright legs with their middles at (±`out[0]`, ±`out[1]`), `height_m` tall, about `width_m` wide.
    pub fn legs(&self, out: [f32; 2], height_m: f32, width_m: f32) -> [SolidMesh; 4] {
        let [x, z] = out;
        [[-x, -z], [x, -z], [x, z], [-x, z]].map(|at| self.one_leg(at, height_m, width_m))
    }

    fn one_leg(&self, [x, z]: [f32; 2], h: f32, w: f32) -> SolidMesh {
        let (foot, top) = ([x, 0.0, z], [x, h, z]);
        match self.leg {
            LegStyle::Tapered => tapered_leg(foot, top, 0.65 * w, w),
            LegStyle::Square => tapered_leg(foot, top, w, w),
            LegStyle::Metal => rod(foot, top, 0.3 * w),
            LegStyle::Turned => {
                let r = 0.5 * w;
                let beads = [
                    (0.0, 0.0),
                    (0.6, 0.0),
                    (0.5, 0.12),
                    (0.55, 0.4),
                    (0.95, 0.62),
                    (0.55, 0.72),
                    (1.0, 0.78),
                    (1.0, 1.0),
                    (0.0, 1.0),
                ];
                surface_of_revolution(&beads.map(|(out, up)| (out * r, up * h)), 10)
                    .translated(x, 0.0, z)
            }
        }
    }

    /// Returns how doors and drawers of furniture look.
    pub fn front_style(&self) -> FrontStyle {
        self.front_style_with(&self.front)
    }

    /// Returns how doors and drawers of the kitchen look.
    pub fn kitchen_front_style(&self) -> FrontStyle {
        self.front_style_with(&self.kitchen_front)
    }

    fn front_style_with(&self, board: &Finish) -> FrontStyle {
        FrontStyle {
            board: board.clone(),
            handle: self.metal.clone(),
            knobs: self.knobs,
            panelled: self.panelled,
        }
    }
}

/// Floor boards of two tones.
const fn boards(name: &'static str, light: Srgb, dark: Srgb) -> Finish {
    Finish::tiled(name, "parquet", "planks", [light, dark, [0; 3]], 1.6)
}

/// Herringbone parquet of two tones.
const fn parquet(name: &'static str, light: Srgb, dark: Srgb) -> Finish {
    Finish::tiled(name, "parquet", "herringbone", [light, dark, [0; 3]], 1.6)
}

/// Boards with grain of two tones.
const fn timber(name: &'static str, substance: &'static str, light: Srgb, dark: Srgb) -> Finish {
    Finish::tiled(name, substance, "wood", [light, dark, [0; 3]], 0.8)
}

/// All styles. A new one is one entry here.
pub const STYLES: &[Style] = &[
    train::NORDIC,
    train::MODERN,
    train::CLASSIC,
    train::RUSTIC,
    train::MID_CENTURY,
    train::CHEERFUL,
    train::FARMHOUSE,
    train::CONTEMPORARY,
    train::BOHO,
    train::COLONIAL,
    held_out::COASTAL,
    held_out::JAPANDI,
    held_out::INDUSTRIAL,
    held_out::ART_DECO,
];

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::material::library;
    use std::collections::BTreeSet;

    #[test]
    fn every_style_has_its_name_and_known_substances_and_every_split_has_a_style() {
        let names: BTreeSet<_> = STYLES.iter().map(|style| style.name).collect();
        assert_eq!(names.len(), STYLES.len());
        for split in [StyleSplit::Train, StyleSplit::Val, StyleSplit::Test] {
            assert!(STYLES.iter().any(|style| style.split == split), "{split:?}");
        }
        for style in STYLES {
            let singles = [
                &style.wood,
                &style.second_wood,
                &style.front,
                &style.kitchen_front,
                &style.worktop,
                &style.metal,
                &style.floor,
                &style.appliance,
            ];
            let many = style.upholstery.iter().chain(&style.cloths);
            let many = many.chain(&style.terries).chain(&style.glazes);
            for finish in singles.into_iter().chain(many) {
                assert!(
                    library().get(finish.substance).is_some(),
                    "{}: {finish:?}",
                    style.name
                );
            }
        }
    }

    /// A look that is held out has woods and covers that no training house has.
    #[test]
    fn held_out_styles_share_no_wood_and_no_cover_with_training() {
        let (train, held): (Vec<_>, Vec<_>) = STYLES
            .iter()
            .partition(|style| style.split == StyleSplit::Train);
        for style in held {
            for known in &train {
                assert_ne!(style.wood, known.wood, "{} {}", style.name, known.name);
                for cover in &style.upholstery {
                    let colors = known.upholstery.iter().map(|other| other.srgb);
                    let shared = colors.into_iter().any(|color| color == cover.srgb);
                    assert!(!shared, "{} {}: {}", style.name, known.name, cover.name);
                }
            }
        }
    }
}
