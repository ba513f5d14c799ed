//! Washbasin, bathtub, shower screen.

use super::cabinet_parts::{BOARD_M, Carcass, GAP_M, door};
use crate::finishes::{chrome, glass, lacquer, oak, sanitary};
use crate::model::{Model, PartBuilder};
use crate::shapes::{SolidMesh, block, cylinder, extrude, rod, tube};
use crate::style::FrontStyle;
use glam::Vec3;

/// Height of a washbasin's rim, m.
pub const BASIN_RIM_M: f32 = 0.86;
/// Height of a tub's rim, m.
pub const TUB_RIM_M: f32 = 0.57;

/// A washbasin on a cabinet with two doors; its tap stands at the middle of the back.
pub fn washbasin(width_m: f32) -> Model {
    let look = FrontStyle::plain(oak(), lacquer("black_lacquer", [38, 38, 40]));
    washbasin_with(width_m, &look)
}

/// The same with a cabinet of another look.
pub fn washbasin_with(width_m: f32, look: &FrontStyle) -> Model {
    let (x, z) = (0.5 * width_m, 0.23);
    let white = sanitary();
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
        .with_filled(
            &white,
            basin.into_iter().fold(SolidMesh::default(), SolidMesh::and),
            0.5,
        )
        .with(
            &chrome(),
            cylinder(0.022, 0.004, 16)
                .at(0.0, low + t, 0.02)
                .visual_only(),
        )
        .with(
            &chrome(),
            block([-0.008, 0.0, -z + 0.1], [0.008, 0.24, -z + 0.116]),
        );
    let face = carcass.max[2];
    let (a, b) = (carcass.min[0], carcass.max[0]);
    let (low_in, high_in) = carcass.space(0.0, 1.0);
    Model::articulated("washbasin", "sink")
        .part(body)
        .inside("basin", [-bx, low + t, back], [bx, rim, front_z])
        .inside("cabinet", low_in, high_in)
        .top("left_rim", [-x, rim, -z], [-bx, rim + 0.3, z])
        .top("right_rim", [bx, rim, -z], [x, rim + 0.3, z])
        .top("back_left", [-bx, rim, -z], [-0.06, rim + 0.3, back])
        .top("back_right", [0.06, rim, -z], [bx, rim + 0.3, back])
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

/// A tub along x, boxed in; its tap stands on the rim of the end where it is deep.
pub fn bathtub(length_m: f32, width_m: f32, tap_left: bool) -> Model {
    let (x, z, h) = (0.5 * length_m, 0.5 * width_m, TUB_RIM_M);
    let white = sanitary();
    let (ix, iz, floor) = (x - 0.09, z - 0.07, 0.14);
    let shell = [
        block([-x, 0.0, -z], [x, floor, z]),
        block([-x, floor, -z], [-ix, h, z]),
        block([ix, floor, -z], [x, h, z]),
        block([-ix, floor, -z], [ix, h, -iz]),
        block([-ix, floor, iz], [ix, h, z]),
    ];
    // Sloping ends, so that the inside reads as a tub.
    let slope = |side: f32| {
        let points = [[ix, floor], [ix, h - 0.02], [ix - 0.26, floor]];
        let mut wedge = extrude(&[points[2], points[0], points[1]], 2.0 * iz).at(0.0, 0.0, -iz);
        if side < 0.0 {
            wedge = wedge.about_y(std::f32::consts::PI);
        }
        wedge
    };
    let tap_side = if tap_left { -1.0 } else { 1.0 };
    let body = PartBuilder::new("body")
        .with_filled(
            &white,
            shell.into_iter().fold(SolidMesh::default(), SolidMesh::and),
            0.12,
        )
        .with_filled(&white, slope(-tap_side), 0.12)
        .with(
            &chrome(),
            cylinder(0.03, 0.003, 16)
                .at(tap_side * (ix - 0.2), floor, 0.0)
                .visual_only(),
        );
    Model::fixed("bathtub", "bathtub").part(body).inside(
        "tub",
        [-ix + 0.26, floor, -iz],
        [ix - 0.26, h, iz],
    )
}

/// A pane of glass on the rim of a tub, from the wall at z = 0 outwards; y = 0 is the rim.
pub fn shower_screen(width_m: f32, height_m: f32) -> Model {
    let body = PartBuilder::new("body")
        .with(
            &glass(),
            block([-0.004, 0.0, 0.02], [0.004, height_m, width_m]),
        )
        .with(
            &chrome(),
            block([-0.008, 0.0, 0.0], [0.008, height_m, 0.02]),
        )
        .with(
            &chrome(),
            block([-0.006, height_m, 0.0], [0.006, height_m + 0.012, width_m]),
        );
    Model::fixed("shower_screen", "shower").part(body)
}

/// A shower head on a rail on the wall; y = 0 is the rail's foot.
pub fn shower_head() -> Model {
    let rail = tube(
        &[
            [0.0, 0.0, 0.04],
            [0.0, 1.2, 0.04],
            [0.0, 1.33, 0.09],
            [0.0, 1.33, 0.2],
        ],
        0.011,
        8,
    );
    let hold = |y: f32| rod([0.0, y, 0.0], [0.0, y, 0.03], 0.012);
    let head = cylinder(0.1, 0.012, 24).at(0.0, 1.31, 0.2);
    let mixer = rod([-0.09, 0.08, 0.05], [0.09, 0.08, 0.05], 0.022);
    let body =
        PartBuilder::new("body").with_all(&chrome(), [rail, hold(0.08), hold(1.0), head, mixer]);
    Model::fixed("shower_head", "shower").part(body)
}
