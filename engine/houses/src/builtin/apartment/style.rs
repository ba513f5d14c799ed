//! The colours of the apartment.

use crate::building::wall::Bands;
use dwell_furniture::finish::Finish;

/// Height of skirting boards, m.
const SKIRTING_M: f32 = 0.08;
/// Height to which the bathroom is tiled, m.
const TILES_M: f32 = 2.0;
/// Everything below the ceiling.
const TOP_M: f32 = 10.0;

/// White paint of ceilings.
pub(super) const fn ceiling() -> Finish {
    Finish::tiled(
        "ceiling_white",
        "painted_plaster",
        "plaster",
        [[244, 243, 238], [0; 3], [0; 3]],
        0.8,
    )
}

/// Paint on plaster.
const fn paint(name: &'static str, srgb: [u8; 3]) -> Finish {
    Finish::tiled(
        name,
        "painted_plaster",
        "plaster",
        [srgb, [0; 3], [0; 3]],
        0.8,
    )
}

/// What the insides of openings show.
pub(super) const fn reveal() -> Finish {
    paint("reveal_white", [240, 238, 232])
}

/// The outside of the building.
pub(super) fn facade() -> Bands {
    vec![(
        TOP_M,
        Finish::tiled(
            "facade_brick",
            "brick",
            "brick",
            [[168, 92, 66], [196, 188, 176], [120, 62, 48]],
            0.5,
        ),
    )]
}

fn with_skirting(upper: Finish) -> Bands {
    vec![
        (
            SKIRTING_M,
            Finish::plain("skirting", "wood", [238, 236, 230]),
        ),
        (TOP_M, upper),
    ]
}

/// Warm white.
pub(super) fn living_walls() -> Bands {
    with_skirting(paint("warm_white_paint", [236, 228, 212]))
}

/// A deep blue-green behind the television.
pub(super) fn living_accent() -> Bands {
    with_skirting(paint("petrol_paint", [66, 102, 108]))
}

/// Pale yellow above a row of tiles.
pub(super) fn kitchen_walls() -> Bands {
    with_skirting(paint("pale_yellow_paint", [240, 228, 188]))
}

/// Metro tiles over the worktop, paint elsewhere.
pub(super) fn kitchen_splashback() -> Bands {
    let tiles = Finish::tiled(
        "metro_tiles",
        "ceramic_tile",
        "metro",
        [[240, 238, 230], [206, 202, 194], [222, 219, 210]],
        0.4,
    );
    vec![
        (0.9, paint("pale_yellow_paint", [240, 228, 188])),
        (1.45, tiles),
        (TOP_M, paint("pale_yellow_paint", [240, 228, 188])),
    ]
}

/// Wallpaper with sprigs.
pub(super) fn bedroom_accent() -> Bands {
    with_skirting(Finish::tiled(
        "leaf_wallpaper",
        "wallpaper",
        "leaves",
        [[214, 214, 202], [138, 158, 140], [150, 140, 116]],
        0.7,
    ))
}

/// Dusty rose.
pub(super) fn bedroom_walls() -> Bands {
    with_skirting(paint("dusty_rose_paint", [222, 202, 192]))
}

/// Sky blue.
pub(super) fn child_walls() -> Bands {
    with_skirting(paint("sky_blue_paint", [176, 206, 224]))
}

/// Wallpaper with stars.
pub(super) fn child_accent() -> Bands {
    with_skirting(Finish::tiled(
        "star_wallpaper",
        "wallpaper",
        "stars",
        [[92, 130, 176], [250, 226, 130], [240, 240, 236]],
        0.8,
    ))
}

/// Tiles up to two metres.
pub(super) fn bath_walls() -> Bands {
    let tiles = Finish::tiled(
        "sea_tiles",
        "ceramic_tile",
        "tile",
        [[172, 204, 206], [236, 238, 236], [148, 186, 192]],
        0.4,
    );
    vec![
        (TILES_M, tiles),
        (TOP_M, paint("bath_white_paint", [238, 240, 238])),
    ]
}

/// Stone grey wallpaper with fine stripes.
pub(super) fn hall_walls() -> Bands {
    with_skirting(Finish::tiled(
        "striped_wallpaper",
        "wallpaper",
        "pinstripe",
        [[226, 220, 206], [214, 206, 190], [196, 184, 160]],
        0.4,
    ))
}

/// Oak herringbone.
pub(super) const fn living_floor() -> Finish {
    Finish::tiled(
        "oak_herringbone",
        "parquet",
        "herringbone",
        [[190, 148, 98], [146, 104, 62], [0; 3]],
        1.6,
    )
}

/// Terracotta tiles.
pub(super) const fn kitchen_floor() -> Finish {
    Finish::tiled(
        "terracotta_tiles",
        "ceramic_tile",
        "tile",
        [[190, 124, 88], [206, 190, 166], [168, 102, 70]],
        0.66,
    )
}

/// Soft carpet.
pub(super) const fn bedroom_floor() -> Finish {
    Finish::tiled(
        "oatmeal_carpet",
        "carpet",
        "carpet",
        [[206, 194, 172], [180, 166, 142], [0; 3]],
        0.6,
    )
}

/// Light boards.
pub(super) const fn child_floor() -> Finish {
    Finish::tiled(
        "maple_laminate",
        "laminate",
        "planks",
        [[226, 196, 152], [200, 164, 116], [0; 3]],
        1.6,
    )
}

/// Small dark tiles.
pub(super) const fn bath_floor() -> Finish {
    Finish::tiled(
        "slate_tiles",
        "ceramic_tile",
        "tile",
        [[96, 110, 116], [168, 174, 174], [80, 92, 100]],
        0.5,
    )
}

/// Dark boards.
pub(super) const fn hall_floor() -> Finish {
    Finish::tiled(
        "smoked_oak_boards",
        "parquet",
        "planks",
        [[142, 102, 68], [96, 66, 42], [0; 3]],
        1.4,
    )
}
