//! The taste of one house: what its things are made of and coloured in, so that what stands together goes together.

use super::finish::{
    Finish, beech, brass, chrome, cloth, granite, lacquer, leather, marble, oak, painted_steel,
    pine, porcelain, steel, terry, upholstery, walnut, white_lacquer,
};
use super::textures::Srgb;
use dwell_scene::random::Stream;

/// Which houses may use a style: looks of `Val` and `Test` never occur in houses for training.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Split {
    /// For training.
    Train,
    /// For choosing between trained agents.
    Val,
    /// For the final test.
    Test,
}

/// The taste of one house. Models take finishes from here by role and vary them by their key.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Style {
    /// `"nordic"`.
    pub(crate) name: &'static str,
    pub(crate) split: Split,
    /// Tables, beds, shelves.
    pub(crate) wood: Finish,
    /// The wood of smaller pieces.
    pub(crate) second_wood: Finish,
    /// Doors and drawers of cupboards.
    pub(crate) front: Finish,
    /// Doors and drawers of the kitchen.
    pub(crate) kitchen_front: Finish,
    /// The kitchen's worktop.
    pub(crate) worktop: Finish,
    /// Handles, lamps, frames.
    pub(crate) metal: Finish,
    /// Sofas and armchairs.
    pub(crate) upholstery: [Finish; 2],
    /// Cushions, curtains, blankets.
    pub(crate) cloths: [Finish; 4],
    /// Towels and rugs.
    pub(crate) terries: [Finish; 2],
    /// Vases, mugs, lamp bases.
    pub(crate) glazes: [Finish; 3],
    /// Paint on the walls, sRGB: the calm tone, then those that a room may have.
    pub(crate) walls: [Srgb; 4],
    /// Boards of the floors.
    pub(crate) floor: Finish,
}

impl Style {
    /// One of the cloths.
    pub(crate) fn cloth(&self, stream: &mut Stream) -> &Finish {
        &self.cloths[stream.below(self.cloths.len())]
    }

    /// One of the coverings of seats.
    pub(crate) fn cover(&self, stream: &mut Stream) -> &Finish {
        &self.upholstery[stream.below(self.upholstery.len())]
    }

    /// One of the terries.
    pub(crate) fn terry(&self, stream: &mut Stream) -> &Finish {
        &self.terries[stream.below(self.terries.len())]
    }

    /// One of the glazes.
    pub(crate) fn glaze(&self, stream: &mut Stream) -> &Finish {
        &self.glazes[stream.below(self.glazes.len())]
    }

    /// One of the two woods, more often the first.
    pub(crate) fn any_wood(&self, stream: &mut Stream) -> &Finish {
        if stream.below(3) == 0 {
            &self.second_wood
        } else {
            &self.wood
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

/// All styles. A new one is one entry here.
pub(crate) const STYLES: &[Style] = &[
    Style {
        name: "nordic",
        split: Split::Train,
        wood: oak(),
        second_wood: white_lacquer(),
        front: white_lacquer(),
        kitchen_front: lacquer("sage_lacquer", [150, 166, 146]),
        worktop: oak(),
        metal: painted_steel("black_steel", [40, 40, 42]),
        upholstery: [
            upholstery("grey_upholstery", [150, 152, 152]),
            upholstery("sage_upholstery", [124, 142, 126]),
        ],
        cloths: [
            cloth("white_linen", [238, 236, 230]),
            cloth("sage_cloth", [138, 154, 128]),
            cloth("dusty_blue_cloth", [128, 150, 168]),
            cloth("mustard_cloth", [206, 164, 72]),
        ],
        terries: [
            terry("ivory_terry", [228, 220, 204]),
            terry("grey_terry", [164, 166, 164]),
        ],
        glazes: [
            porcelain("white_glaze", [242, 241, 236]),
            porcelain("sage_glaze", [136, 156, 140]),
            porcelain("grey_glaze", [150, 152, 152]),
        ],
        walls: [
            [240, 238, 232],
            [214, 222, 212],
            [206, 214, 222],
            [228, 220, 206],
        ],
        floor: boards("pale_boards", [214, 184, 140], [176, 142, 98]),
    },
    Style {
        name: "modern",
        split: Split::Train,
        wood: lacquer("anthracite_lacquer", [62, 64, 68]),
        second_wood: oak(),
        front: white_lacquer(),
        kitchen_front: white_lacquer(),
        worktop: granite(),
        metal: chrome(),
        upholstery: [
            upholstery("charcoal_upholstery", [78, 80, 86]),
            upholstery("silver_upholstery", [178, 180, 182]),
        ],
        cloths: [
            cloth("white_cotton", [240, 240, 238]),
            cloth("charcoal_cloth", [76, 78, 84]),
            cloth("red_cloth", [186, 48, 48]),
            cloth("petrol_cloth", [44, 104, 116]),
        ],
        terries: [
            terry("white_terry", [238, 238, 236]),
            terry("slate_terry", [92, 100, 110]),
        ],
        glazes: [
            porcelain("white_glaze", [242, 241, 236]),
            porcelain("black_glaze", [44, 44, 48]),
            porcelain("red_glaze", [178, 52, 48]),
        ],
        walls: [
            [236, 236, 234],
            [200, 204, 208],
            [182, 198, 204],
            [222, 216, 210],
        ],
        floor: boards("grey_boards", [176, 166, 152], [136, 126, 114]),
    },
    Style {
        name: "classic",
        split: Split::Train,
        wood: walnut(),
        second_wood: walnut(),
        front: walnut(),
        kitchen_front: lacquer("cream_lacquer", [236, 226, 200]),
        worktop: marble(),
        metal: brass(),
        upholstery: [
            upholstery("burgundy_upholstery", [122, 44, 52]),
            upholstery("beige_upholstery", [204, 184, 150]),
        ],
        cloths: [
            cloth("cream_cloth", [236, 226, 202]),
            cloth("burgundy_cloth", [128, 46, 54]),
            cloth("gold_cloth", [196, 158, 84]),
            cloth("forest_cloth", [62, 92, 70]),
        ],
        terries: [
            terry("cream_terry", [234, 222, 196]),
            terry("burgundy_terry", [132, 56, 60]),
        ],
        glazes: [
            porcelain("ivory_glaze", [238, 230, 210]),
            porcelain("cobalt_glaze", [44, 70, 138]),
            porcelain("forest_glaze", [58, 92, 72]),
        ],
        walls: [
            [238, 228, 206],
            [206, 196, 162],
            [196, 206, 186],
            [218, 192, 176],
        ],
        floor: parquet("walnut_parquet", [150, 104, 66], [108, 70, 42]),
    },
    Style {
        name: "rustic",
        split: Split::Train,
        wood: pine(),
        second_wood: pine(),
        front: pine(),
        kitchen_front: lacquer("moss_lacquer", [112, 126, 92]),
        worktop: beech(),
        metal: painted_steel("black_iron", [46, 44, 42]),
        upholstery: [
            upholstery("oatmeal_upholstery", [206, 194, 168]),
            upholstery("rust_upholstery", [168, 92, 58]),
        ],
        cloths: [
            cloth("linen_cloth", [226, 214, 190]),
            cloth("rust_cloth", [174, 96, 60]),
            cloth("moss_cloth", [118, 130, 88]),
            cloth("brick_cloth", [158, 72, 58]),
        ],
        terries: [
            terry("oatmeal_terry", [214, 200, 174]),
            terry("moss_terry", [124, 134, 96]),
        ],
        glazes: [
            porcelain("clay_glaze", [186, 120, 84]),
            porcelain("cream_glaze", [234, 222, 196]),
            porcelain("moss_glaze", [112, 124, 84]),
        ],
        walls: [
            [242, 234, 216],
            [226, 204, 168],
            [208, 210, 184],
            [232, 214, 190],
        ],
        floor: boards("pine_boards", [216, 170, 112], [178, 130, 78]),
    },
    Style {
        name: "mid_century",
        split: Split::Train,
        wood: Finish::tiled(
            "teak",
            "wood",
            "wood",
            [[176, 112, 66], [128, 76, 42], [0; 3]],
            0.8,
        ),
        second_wood: walnut(),
        front: white_lacquer(),
        kitchen_front: lacquer("teal_lacquer", [70, 126, 128]),
        worktop: white_lacquer(),
        metal: brass(),
        upholstery: [
            upholstery("teal_upholstery", [58, 112, 116]),
            upholstery("ochre_upholstery", [204, 144, 58]),
        ],
        cloths: [
            cloth("ivory_cloth", [240, 232, 212]),
            cloth("teal_cloth", [70, 126, 128]),
            cloth("orange_cloth", [222, 122, 48]),
            cloth("olive_cloth", [128, 128, 66]),
        ],
        terries: [
            terry("ochre_terry", [214, 160, 80]),
            terry("aqua_terry", [126, 172, 178]),
        ],
        glazes: [
            porcelain("ochre_glaze", [206, 150, 62]),
            porcelain("teal_glaze", [62, 120, 124]),
            porcelain("white_glaze", [242, 241, 236]),
        ],
        walls: [
            [240, 234, 220],
            [190, 208, 204],
            [232, 206, 160],
            [214, 214, 188],
        ],
        floor: parquet("teak_parquet", [190, 134, 84], [148, 98, 56]),
    },
    Style {
        name: "cheerful",
        split: Split::Train,
        wood: beech(),
        second_wood: white_lacquer(),
        front: white_lacquer(),
        kitchen_front: lacquer("sunny_lacquer", [244, 206, 96]),
        worktop: beech(),
        metal: steel(),
        upholstery: [
            upholstery("blue_upholstery", [70, 110, 172]),
            upholstery("coral_upholstery", [222, 118, 100]),
        ],
        cloths: [
            cloth("yellow_cotton", [240, 208, 104]),
            cloth("blue_cotton", [84, 136, 196]),
            cloth("pink_cotton", [226, 144, 166]),
            cloth("green_cotton", [120, 178, 108]),
        ],
        terries: [
            terry("coral_terry", [222, 128, 108]),
            terry("sky_terry", [140, 186, 220]),
        ],
        glazes: [
            porcelain("yellow_glaze", [238, 198, 84]),
            porcelain("blue_glaze", [70, 120, 186]),
            porcelain("coral_glaze", [226, 124, 104]),
        ],
        walls: [
            [244, 240, 230],
            [190, 218, 232],
            [246, 226, 164],
            [206, 228, 192],
        ],
        floor: boards("beech_boards", [222, 178, 130], [188, 142, 98]),
    },
    Style {
        name: "coastal",
        split: Split::Val,
        wood: Finish::tiled(
            "whitewashed_wood",
            "wood",
            "wood",
            [[224, 216, 202], [190, 180, 164], [0; 3]],
            0.8,
        ),
        second_wood: white_lacquer(),
        front: lacquer("pale_blue_lacquer", [182, 206, 220]),
        kitchen_front: lacquer("navy_lacquer", [48, 66, 104]),
        worktop: marble(),
        metal: chrome(),
        upholstery: [
            upholstery("navy_upholstery", [52, 70, 110]),
            upholstery("sand_upholstery", [218, 204, 176]),
        ],
        cloths: [
            cloth("sand_cloth", [224, 210, 182]),
            cloth("navy_cloth", [50, 68, 108]),
            cloth("aqua_cloth", [130, 196, 200]),
            cloth("white_linen", [238, 236, 230]),
        ],
        terries: [
            terry("navy_terry", [56, 76, 116]),
            terry("white_terry", [238, 238, 236]),
        ],
        glazes: [
            porcelain("navy_glaze", [46, 66, 112]),
            porcelain("aqua_glaze", [124, 188, 194]),
            porcelain("white_glaze", [242, 241, 236]),
        ],
        walls: [
            [242, 242, 238],
            [198, 220, 228],
            [230, 222, 202],
            [180, 204, 206],
        ],
        floor: boards("driftwood_boards", [206, 196, 178], [166, 154, 136]),
    },
    Style {
        name: "industrial",
        split: Split::Test,
        wood: Finish::tiled(
            "smoked_oak",
            "oak",
            "wood",
            [[138, 108, 82], [92, 68, 50], [0; 3]],
            0.8,
        ),
        second_wood: lacquer("black_lacquer", [38, 38, 40]),
        front: lacquer("graphite_lacquer", [84, 86, 90]),
        kitchen_front: lacquer("black_lacquer", [38, 38, 40]),
        worktop: steel(),
        metal: painted_steel("black_steel", [40, 40, 42]),
        upholstery: [
            leather("cognac_leather", [150, 86, 46]),
            leather("black_leather", [46, 42, 40]),
        ],
        cloths: [
            cloth("grey_wool", [150, 150, 152]),
            cloth("black_cloth", [48, 48, 52]),
            cloth("cognac_cloth", [156, 92, 52]),
            cloth("denim_cloth", [70, 88, 118]),
        ],
        terries: [
            terry("charcoal_terry", [72, 74, 80]),
            terry("grey_terry", [164, 166, 164]),
        ],
        glazes: [
            porcelain("black_glaze", [44, 44, 48]),
            porcelain("concrete_glaze", [150, 148, 144]),
            porcelain("copper_glaze", [164, 96, 62]),
        ],
        walls: [
            [218, 216, 212],
            [168, 168, 168],
            [188, 164, 148],
            [132, 142, 146],
        ],
        floor: boards("smoked_boards", [150, 122, 94], [108, 84, 62]),
    },
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
        for split in [Split::Train, Split::Val, Split::Test] {
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
}
