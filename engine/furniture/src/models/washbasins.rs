//! Washbasins on a cabinet and on the wall.

use super::cabinet_parts::{BOARD_M, Carcass, GAP_M, door};
use super::taps::with_mixer_tap;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, chrome, sanitary_ware};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{SolidMesh, block, cylinder, surface_of_revolution, tube};
use crate::style::{FrontStyle, Style};
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("washbasin", "sink", 74, sample_washbasin),
    CatalogueEntry::new("hand_basin", "sink", 75, hand_basin),
    CatalogueEntry::new("basin", "sink", 76, basin),
];

/// Sanitary ware is white, sometimes of a pale colour.
pub(super) fn sanitary_finish(d: &SizeSampler) -> Finish {
    let tones = [[236, 230, 214], [226, 232, 230], [230, 214, 206]];
    if d.chance("white", 0.75) {
        sanitary_ware()
    } else {
        Finish {
            name: "pale_porcelain",
            srgb: d.choose("tone", tones),
            ..sanitary_ware()
        }
    }
}

/// Height of a washbasin's rim, m.
const BASIN_RIM_M: f32 = 0.86;

/// A washbasin on a cabinet with two doors; its tap stands at the middle of the back.
fn washbasin(width_m: f32, look: &FrontStyle) -> Model {
    let (x, z) = (0.5 * width_m, 0.23);
    let white = sanitary_ware();
    let (rim, low, t) = (BASIN_RIM_M, 0.74, 0.03);
    let (bx, back, front_z) = (x - 0.06, -0.11, z - 0.04);
    let carcass = Carcass {
        min: [-x + 0.01, 0.24, -z],
        max: [x - 0.01, low - 0.002, z - 0.02 - BOARD_M],
    };
    let basin = [
        block([-x, low, -z], [x, low + t, z]),
        block([-x, low + t, -z], [-bx, rim, z]),
        block([bx, low + t, -z], [x, rim, z]),
        block([-bx, low + t, -z], [bx, rim, back]),
        block([-bx, low + t, front_z], [bx, rim, z]),
    ];
    let body = PartBuilder::new("body")
        .with_all(&look.board, carcass.boards(&[], &[]))
        .with_fill_fraction(
            &white,
            basin
                .into_iter()
                .fold(SolidMesh::default(), SolidMesh::merged),
            0.5,
        )
        .with(
            &chrome(),
            cylinder(0.022, 0.004, 16)
                .translated(0.0, low + t, 0.02)
                .visual_only(),
        )
        .with(
            &chrome(),
            block([-0.008, 0.0, -z + 0.1], [0.008, 0.24, -z + 0.116]),
        );
    let face = carcass.max[2];
    let (a, b) = (carcass.min[0], carcass.max[0]);
    let (low_in, high_in) = carcass.space_between_shelves(0.0, 1.0);
    Model::articulated("washbasin", "sink")
        .part(body)
        .with_container_space("basin", [-bx, low + t, back], [bx, rim, front_z])
        .with_container_space("cabinet", low_in, high_in)
        .with_support_surface("left_rim", [-x, rim, -z], [-bx, rim + 0.3, z])
        .with_support_surface("right_rim", [bx, rim, -z], [x, rim + 0.3, z])
        .with_support_surface("back_left", [-bx, rim, -z], [-0.06, rim + 0.3, back])
        .with_support_surface("back_right", [0.06, rim, -z], [bx, rim + 0.3, back])
        .part(door(
            "left_door",
            [a, carcass.min[1]],
            [-0.5 * GAP_M, carcass.max[1]],
            face,
            true,
            look,
        ))
        .hinged("left_door", [a, 0.0, face + BOARD_M], Vec3::NEG_Y, 1.7)
        .part(door(
            "right_door",
            [0.5 * GAP_M, carcass.min[1]],
            [b, carcass.max[1]],
            face,
            false,
            look,
        ))
        .hinged("right_door", [b, 0.0, face + BOARD_M], Vec3::Y, 1.7)
}

fn vanity(style: &Style, d: &SizeSampler) -> Model {
    let basin = washbasin(d.sample_m("width"), &style.front_style());
    let basin = basin.with_finish_replaced("white_porcelain", &sanitary_finish(d));
    let sizes = [d.range("tap", 0.13, 0.2), 0.13];
    with_mixer_tap(basin, style, d, sizes, [0.0, BASIN_RIM_M, -0.17], 0.0)
}

fn sample_washbasin(style: &Style, key: RandomKey) -> Model {
    vanity(style, &SizeSampler::new("washbasin", key))
}

fn hand_basin(style: &Style, key: RandomKey) -> Model {
    vanity(style, &SizeSampler::new("hand_basin", key))
}

/// A washbasin on the wall or on a column, without a cupboard; the wall is at -Z.
fn basin(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("basin", key);
    let (w, h, depth) = (d.sample_m("width"), d.sample_m("rim"), d.sample_m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let white = sanitary_ware();
    let (low, floor, wall) = (h - 0.17, h - 0.13, 0.035);
    let ledge = -z + 0.12;
    let shell = [
        block([-x, low, -z], [x, floor, z]),
        block([-x, floor, -z], [-x + wall, h, z]),
        block([x - wall, floor, -z], [x, h, z]),
        block([-x + wall, floor, -z], [x - wall, h, ledge]),
        block([-x + wall, floor, z - wall], [x - wall, h, z]),
    ];
    let spout = [
        [0.0, h, ledge - 0.05],
        [0.0, h + 0.08, ledge - 0.05],
        [0.0, h + 0.11, ledge - 0.02],
        [0.0, h + 0.09, ledge + 0.08],
    ];
    let mut body = PartBuilder::new("body")
        .with_fill_fraction(
            &white,
            shell.into_iter().fold(
                crate::shapes::SolidMesh::default(),
                crate::shapes::SolidMesh::merged,
            ),
            0.45,
        )
        .with(
            &chrome(),
            tube(&spout, 0.012, 10).merged(cylinder(0.022, 0.02, 16).translated(
                0.0,
                h,
                ledge - 0.05,
            )),
        )
        .with(
            &chrome(),
            cylinder(0.02, 0.003, 16)
                .translated(0.0, floor, 0.03)
                .visual_only(),
        );
    let column = surface_of_revolution(
        &[
            (0.0, 0.0),
            (0.11, 0.0),
            (0.08, 0.1),
            (0.075, 0.5 * low),
            (0.1, low),
            (0.0, low),
        ],
        20,
    );
    body = body.with_fill_fraction(&white, column.translated(0.0, 0.0, -z + 0.12), 0.25);
    Model::fixed("basin", "sink")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, h, ledge + 0.06], "tap", 58.0)
        .with_container_space(
            "basin",
            [-x + wall, floor + 0.004, ledge],
            [x - wall, h, z - wall],
        )
        .with_support_surface("ledge", [0.05, h, -z + 0.01], [x - 0.02, h + 0.25, ledge])
}
