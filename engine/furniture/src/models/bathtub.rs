//! A bathtub with its tap.

use super::taps::with_mixer_tap;
use super::washbasins::sanitary_finish;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{chrome, sanitary_ware};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{SolidMesh, block, cylinder, extrude};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "bathtub",
    "bathtub",
    70,
    sample_bathtub,
)];

/// Height of a tub's rim, m.
const TUB_RIM_M: f32 = 0.57;

/// A tub along x, boxed in; its tap stands on the rim of the end where it is deep.
fn bathtub(length_m: f32, width_m: f32, tap_left: bool) -> Model {
    let (x, z, h) = (0.5 * length_m, 0.5 * width_m, TUB_RIM_M);
    let white = sanitary_ware();
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
        let mut wedge =
            extrude(&[points[2], points[0], points[1]], 2.0 * iz).translated(0.0, 0.0, -iz);
        if side < 0.0 {
            wedge = wedge.rotated_y(std::f32::consts::PI);
        }
        wedge
    };
    let tap_side = if tap_left { -1.0 } else { 1.0 };
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &white,
            shell
                .into_iter()
                .fold(SolidMesh::default(), SolidMesh::merged),
            0.12,
        )
        .with_fill_fraction(&white, slope(-tap_side), 0.12)
        .with(
            &chrome(),
            cylinder(0.03, 0.003, 16)
                .translated(tap_side * (ix - 0.2), floor, 0.0)
                .visual_only(),
        );
    Model::fixed("bathtub", "bathtub")
        .part(body)
        .with_container_space("tub", [-ix + 0.26, floor, -iz], [ix - 0.26, h, iz])
}

fn sample_bathtub(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bathtub", key);
    let (length, left) = (d.sample_m("width"), d.chance("left", 0.5));
    let tub = bathtub(length, d.sample_m("depth"), left)
        .with_finish_replaced("white_porcelain", &sanitary_finish(&d));
    let side = if left { -1.0 } else { 1.0 };
    let at = [side * (0.5 * length - 0.045), TUB_RIM_M, 0.0];
    with_mixer_tap(tub, style, &d, [0.16, 0.14], at, -side * FRAC_PI_2)
}
