//! Looks that never occur in houses for training.

use super::{LegStyle, Style, StyleSplit, boards, parquet, timber};
use crate::finishes::{
    Finish, brass, chrome, cloth, enamel, lacquer, leather, marble, painted_steel, porcelain,
    steel, terry, upholstery, white_lacquer,
};

/// Whitewashed wood, navy and sand.
pub(super) const COASTAL: Style = Style {
    name: "coastal",
    split: StyleSplit::Val,
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
    appliance: enamel("coastal_enamel", [238, 240, 240]),
    leg: LegStyle::Square,
    knobs: true,
    panelled: true,
};

/// Pale cedar, black lacquer, rice white and ink.
pub(super) const JAPANDI: Style = Style {
    name: "japandi",
    split: StyleSplit::Val,
    wood: timber("cedar", "wood", [216, 178, 138], [184, 142, 104]),
    second_wood: lacquer("ink_lacquer", [44, 44, 48]),
    front: timber("cedar", "wood", [216, 178, 138], [184, 142, 104]),
    kitchen_front: lacquer("ink_lacquer", [44, 44, 48]),
    worktop: timber("cedar", "wood", [216, 178, 138], [184, 142, 104]),
    metal: painted_steel("ink_steel", [40, 40, 42]),
    upholstery: [
        upholstery("rice_upholstery", [222, 214, 200]),
        upholstery("ink_upholstery", [70, 72, 78]),
    ],
    cloths: [
        cloth("rice_cloth", [232, 226, 212]),
        cloth("ink_cloth", [62, 64, 70]),
        cloth("matcha_cloth", [146, 158, 112]),
        cloth("persimmon_cloth", [204, 112, 70]),
    ],
    terries: [
        terry("rice_terry", [228, 220, 204]),
        terry("matcha_terry", [154, 164, 122]),
    ],
    glazes: [
        porcelain("ink_glaze", [48, 48, 52]),
        porcelain("rice_glaze", [232, 228, 216]),
        porcelain("matcha_glaze", [140, 152, 106]),
    ],
    walls: [
        [240, 235, 224],
        [222, 212, 194],
        [204, 206, 188],
        [196, 190, 180],
    ],
    floor: boards("cedar_boards", [218, 184, 144], [182, 144, 106]),
    appliance: enamel("japandi_enamel", [226, 222, 212]),
    leg: LegStyle::Square,
    knobs: false,
    panelled: false,
};

/// Smoked oak, black steel, leather.
pub(super) const INDUSTRIAL: Style = Style {
    name: "industrial",
    split: StyleSplit::Test,
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
    appliance: enamel("industrial_enamel", [60, 62, 66]),
    leg: LegStyle::Metal,
    knobs: false,
    panelled: false,
};

/// Rosewood, black, gold, emerald and blush.
pub(super) const ART_DECO: Style = Style {
    name: "art_deco",
    split: StyleSplit::Test,
    wood: timber("rosewood", "wood", [110, 56, 50], [62, 28, 28]),
    second_wood: lacquer("piano_lacquer", [26, 26, 28]),
    front: lacquer("piano_lacquer", [26, 26, 28]),
    kitchen_front: lacquer("emerald_lacquer", [30, 92, 76]),
    worktop: marble(),
    metal: brass(),
    upholstery: [
        upholstery("emerald_upholstery", [24, 98, 80]),
        upholstery("blush_upholstery", [218, 172, 164]),
    ],
    cloths: [
        cloth("ivory_satin", [240, 232, 216]),
        cloth("emerald_satin", [28, 104, 84]),
        cloth("blush_satin", [222, 176, 168]),
        cloth("gold_satin", [204, 166, 86]),
    ],
    terries: [
        terry("emerald_terry", [40, 112, 92]),
        terry("ivory_terry", [236, 228, 212]),
    ],
    glazes: [
        porcelain("emerald_glaze", [20, 96, 78]),
        porcelain("gold_glaze", [198, 158, 78]),
        porcelain("piano_black_glaze", [30, 30, 32]),
    ],
    walls: [
        [240, 232, 220],
        [198, 212, 204],
        [228, 202, 196],
        [70, 88, 92],
    ],
    floor: parquet("rosewood_parquet", [128, 72, 60], [84, 42, 38]),
    appliance: enamel("art_deco_enamel", [34, 36, 38]),
    leg: LegStyle::Metal,
    knobs: true,
    panelled: false,
};
