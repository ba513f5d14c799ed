//! Looks of houses for training.

use super::{LegStyle, Style, StyleSplit, boards, parquet, timber};
use crate::finishes::{
    Finish, beech, brass, chrome, cloth, enamel, granite, lacquer, marble, oak, painted_steel,
    pine, porcelain, rattan, steel, terry, upholstery, walnut, white_lacquer,
};

/// Light oak, white, sage.
pub(super) const NORDIC: Style = Style {
    name: "nordic",
    split: StyleSplit::Train,
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
    appliance: enamel("nordic_enamel", [240, 241, 240]),
    leg: LegStyle::Tapered,
    knobs: false,
    panelled: false,
};

/// Anthracite, chrome, charcoal and red.
pub(super) const MODERN: Style = Style {
    name: "modern",
    split: StyleSplit::Train,
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
    appliance: enamel("modern_enamel", [172, 174, 178]),
    leg: LegStyle::Metal,
    knobs: false,
    panelled: false,
};

/// Walnut, brass, burgundy, turned legs.
pub(super) const CLASSIC: Style = Style {
    name: "classic",
    split: StyleSplit::Train,
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
    appliance: enamel("classic_enamel", [238, 232, 216]),
    leg: LegStyle::Turned,
    knobs: true,
    panelled: true,
};

/// Pine, black iron, moss and rust.
pub(super) const RUSTIC: Style = Style {
    name: "rustic",
    split: StyleSplit::Train,
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
    appliance: enamel("rustic_enamel", [236, 228, 206]),
    leg: LegStyle::Square,
    knobs: true,
    panelled: true,
};

/// Teak, brass, teal and orange.
pub(super) const MID_CENTURY: Style = Style {
    name: "mid_century",
    split: StyleSplit::Train,
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
    appliance: enamel("mid_century_enamel", [206, 226, 220]),
    leg: LegStyle::Tapered,
    knobs: false,
    panelled: false,
};

/// Beech, white, bright cotton.
pub(super) const CHEERFUL: Style = Style {
    name: "cheerful",
    split: StyleSplit::Train,
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
    appliance: enamel("cheerful_enamel", [240, 236, 230]),
    leg: LegStyle::Square,
    knobs: true,
    panelled: false,
};

/// Cream paint over pine tops, checked blue, oil-rubbed bronze.
pub(super) const FARMHOUSE: Style = Style {
    name: "farmhouse",
    split: StyleSplit::Train,
    wood: lacquer("cream_paint", [232, 222, 196]),
    second_wood: timber("waxed_pine", "pine", [206, 160, 104], [172, 124, 74]),
    front: lacquer("cream_paint", [232, 222, 196]),
    kitchen_front: lacquer("duck_egg_lacquer", [176, 200, 194]),
    worktop: timber("butcher_block", "wood", [198, 152, 102], [168, 120, 76]),
    metal: painted_steel("bronze_steel", [84, 66, 50]),
    upholstery: [
        upholstery("stone_upholstery", [190, 180, 164]),
        upholstery("denim_upholstery", [88, 108, 140]),
    ],
    cloths: [
        cloth("natural_linen", [224, 212, 190]),
        cloth("denim_cloth", [84, 106, 140]),
        cloth("rose_cloth", [202, 146, 140]),
        cloth("duck_egg_cloth", [168, 194, 188]),
    ],
    terries: [
        terry("oat_terry", [220, 208, 184]),
        terry("denim_terry", [96, 116, 146]),
    ],
    glazes: [
        porcelain("cream_glaze", [236, 226, 202]),
        porcelain("denim_glaze", [84, 104, 140]),
        porcelain("stone_glaze", [170, 162, 150]),
    ],
    walls: [
        [244, 238, 222],
        [204, 216, 208],
        [222, 206, 190],
        [196, 206, 216],
    ],
    floor: boards("waxed_boards", [204, 158, 104], [164, 118, 72]),
    appliance: enamel("farmhouse_enamel", [238, 230, 212]),
    leg: LegStyle::Turned,
    knobs: true,
    panelled: true,
};

/// Pale ash, warm grey, terracotta, matt black.
pub(super) const CONTEMPORARY: Style = Style {
    name: "contemporary",
    split: StyleSplit::Train,
    wood: timber("ash", "wood", [222, 204, 174], [196, 174, 140]),
    second_wood: lacquer("warm_grey_lacquer", [176, 170, 162]),
    front: lacquer("warm_grey_lacquer", [176, 170, 162]),
    kitchen_front: lacquer("terracotta_lacquer", [190, 112, 82]),
    worktop: granite(),
    metal: painted_steel("matt_black", [34, 34, 36]),
    upholstery: [
        upholstery("clay_upholstery", [190, 128, 100]),
        upholstery("stone_grey_upholstery", [164, 160, 154]),
    ],
    cloths: [
        cloth("chalk_cloth", [234, 230, 222]),
        cloth("terracotta_cloth", [192, 110, 80]),
        cloth("slate_cloth", [98, 108, 118]),
        cloth("sand_cloth", [214, 196, 164]),
    ],
    terries: [
        terry("clay_terry", [200, 146, 120]),
        terry("stone_terry", [178, 174, 166]),
    ],
    glazes: [
        porcelain("chalk_glaze", [236, 234, 228]),
        porcelain("terracotta_glaze", [186, 104, 76]),
        porcelain("slate_glaze", [92, 102, 112]),
    ],
    walls: [
        [242, 239, 234],
        [214, 202, 190],
        [220, 190, 172],
        [196, 202, 204],
    ],
    floor: boards("ash_boards", [222, 204, 174], [188, 166, 132]),
    appliance: enamel("contemporary_enamel", [70, 70, 72]),
    leg: LegStyle::Tapered,
    knobs: false,
    panelled: false,
};

/// Rattan and honey wood, plum, saffron, turquoise.
pub(super) const BOHO: Style = Style {
    name: "boho",
    split: StyleSplit::Train,
    wood: timber("honey_wood", "wood", [206, 146, 84], [160, 104, 56]),
    second_wood: rattan(),
    front: timber("honey_wood", "wood", [206, 146, 84], [160, 104, 56]),
    kitchen_front: lacquer("turquoise_lacquer", [72, 152, 152]),
    worktop: timber("mango_wood", "wood", [176, 118, 72], [120, 76, 46]),
    metal: brass(),
    upholstery: [
        upholstery("plum_upholstery", [116, 62, 96]),
        upholstery("saffron_upholstery", [220, 160, 60]),
    ],
    cloths: [
        cloth("saffron_cloth", [224, 160, 56]),
        cloth("plum_cloth", [122, 64, 100]),
        cloth("turquoise_cloth", [70, 158, 160]),
        cloth("brick_red_cloth", [176, 74, 56]),
    ],
    terries: [
        terry("saffron_terry", [226, 176, 88]),
        terry("turquoise_terry", [104, 176, 176]),
    ],
    glazes: [
        porcelain("turquoise_glaze", [58, 146, 150]),
        porcelain("saffron_glaze", [222, 164, 66]),
        porcelain("plum_glaze", [112, 62, 94]),
    ],
    walls: [
        [244, 234, 214],
        [232, 198, 150],
        [196, 214, 208],
        [224, 190, 180],
    ],
    floor: boards("honey_boards", [210, 156, 96], [166, 114, 64]),
    appliance: enamel("boho_enamel", [232, 222, 196]),
    leg: LegStyle::Tapered,
    knobs: true,
    panelled: false,
};

/// Dark mahogany, linen, palm green, cane.
pub(super) const COLONIAL: Style = Style {
    name: "colonial",
    split: StyleSplit::Train,
    wood: timber("mahogany", "wood", [122, 62, 42], [78, 36, 26]),
    second_wood: timber("mahogany", "wood", [122, 62, 42], [78, 36, 26]),
    front: timber("mahogany", "wood", [122, 62, 42], [78, 36, 26]),
    kitchen_front: lacquer("ivory_lacquer", [238, 230, 208]),
    worktop: marble(),
    metal: brass(),
    upholstery: [
        upholstery("palm_upholstery", [74, 104, 76]),
        upholstery("linen_upholstery", [222, 210, 184]),
    ],
    cloths: [
        cloth("linen_white_cloth", [236, 230, 214]),
        cloth("palm_cloth", [80, 112, 80]),
        cloth("indigo_cloth", [54, 62, 112]),
        cloth("curry_cloth", [198, 150, 66]),
    ],
    terries: [
        terry("linen_terry", [230, 220, 198]),
        terry("palm_terry", [98, 126, 92]),
    ],
    glazes: [
        porcelain("ivory_glaze", [238, 230, 210]),
        porcelain("indigo_glaze", [46, 54, 108]),
        porcelain("palm_glaze", [70, 102, 72]),
    ],
    walls: [
        [240, 232, 212],
        [208, 216, 190],
        [214, 200, 170],
        [200, 206, 210],
    ],
    floor: parquet("mahogany_parquet", [140, 82, 56], [98, 52, 36]),
    appliance: enamel("colonial_enamel", [236, 228, 206]),
    leg: LegStyle::Turned,
    knobs: true,
    panelled: true,
};
