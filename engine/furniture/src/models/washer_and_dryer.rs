//! A washing machine and a tumble dryer.

use super::casings::casing_finish;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, chrome, enamel, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{SolidMesh, block, cylinder, torus};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("washer", "washer", 58, sample_washer),
    CatalogueEntry::new("dryer", "dryer", 59, dryer),
];

/// The case of a machine with a drum behind a round door: a body about the axis, `half_m` wide to either side, between two
/// corners in (y, z), hollow around (0, `middle_m`), with a hole in its front. The last block closes the drum behind.
fn drum_case(half_m: f32, low: [f32; 2], high: [f32; 2], middle_m: f32) -> [SolidMesh; 9] {
    let (x, [base, back], [top, front]) = (half_m, low, high);
    let (a, b, c, d) = (-DRUM_M, DRUM_M, middle_m - DRUM_M, middle_m + DRUM_M);
    let (plate, deep) = (front - 0.05, front - 0.05 - DRUM_DEPTH_M);
    let (left, right) = (-HOLE_M, HOLE_M);
    let (under, over) = (middle_m - HOLE_M, middle_m + HOLE_M);
    [
        block([-x, base, back], [a, top, front]),
        block([b, base, back], [x, top, front]),
        block([a, base, back], [b, c, front]),
        block([a, d, back], [b, top, front]),
        block([a, c, plate], [left, d, front]),
        block([right, c, plate], [b, d, front]),
        block([left, c, plate], [right, under, front]),
        block([left, over, plate], [right, d, front]),
        block([a, c, back], [b, d, deep]),
    ]
}

/// Half the width of a drum's free space, m.
const DRUM_M: f32 = 0.22;
/// Depth of a drum, m.
const DRUM_DEPTH_M: f32 = 0.36;
/// Half the width of the hole before a drum: a square within its round rim, m.
const HOLE_M: f32 = 0.105;

/// The free space of a drum behind a front at z = `front_m`.
fn drum_space(middle_m: f32, front_m: f32) -> ([f32; 3], [f32; 3]) {
    let r = DRUM_M - 0.006;
    (
        [-r, middle_m - DRUM_M, front_m - 0.045 - DRUM_DEPTH_M],
        [r, middle_m + r, front_m - 0.055],
    )
}

/// A washing machine with a round door.
fn washer() -> Model {
    let white = enamel("washer_white", [238, 239, 240]);
    let (x, h, z) = (0.298, 0.85, 0.29);
    let dark = Finish::plain("washer_window", "glass", [62, 70, 78]).transparent(1.0);
    let (case_low, case_high) = ([0.012, -z], [h, z]);
    let body = PartBuilder::new("body")
        .with_all(&white, drum_case(x, case_low, case_high, 0.42))
        .with(
            &chrome(),
            torus(0.15, 0.006, 28)
                .rotated_x(FRAC_PI_2)
                .translated(0.0, 0.42, z)
                .visual_only(),
        )
        .with(
            &black_plastic(),
            block([-x + 0.03, 0.0, -z + 0.03], [x - 0.03, 0.012, z - 0.03]),
        )
        .with(
            &plastic("panel_grey", [196, 198, 202]),
            block([-x + 0.01, h - 0.13, z], [x - 0.01, h - 0.02, z + 0.004]),
        )
        .with(
            &chrome(),
            cylinder(0.032, 0.02, 18)
                .rotated_x(FRAC_PI_2)
                .translated(0.05, h - 0.075, z + 0.004),
        )
        .with(
            &dark,
            block([0.13, h - 0.1, z + 0.004], [0.25, h - 0.05, z + 0.006]).visual_only(),
        );
    let door = PartBuilder::new("door")
        .with(
            &dark,
            cylinder(0.145, 0.03, 28)
                .rotated_x(FRAC_PI_2)
                .translated(0.0, 0.42, z + 0.002),
        )
        .with(
            &chrome(),
            torus(0.155, 0.016, 28)
                .rotated_x(FRAC_PI_2)
                .translated(0.0, 0.42, z + 0.018),
        );
    let (low, high) = drum_space(0.42, z);
    Model::articulated("washing_machine", "washer")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.42, z], "washing_machine", 62.0)
        .with_support_surface("top", [-x, h, -z], [x, h + 0.5, z])
        .with_container_space("drum", low, high)
        .part(door)
        .hinged("door", [-0.17, 0.0, z + 0.034], Vec3::NEG_Y, 1.8)
}

fn sample_washer(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("washer", key);
    washer().with_finish_replaced("washer_white", &casing_finish(style, &d, "washer_casing"))
}

/// A tumble dryer: as wide as a washing machine, its door larger and darker, a drawer for water above.
fn dryer(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("dryer", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth - 0.045);
    let dark = Finish::plain("dryer_window", "glass", [40, 44, 50]).transparent(1.0);
    let middle = 0.46 * h;
    let (case_low, case_high) = ([0.012, -0.5 * depth], [h, z]);
    let case = drum_case(x, case_low, case_high, middle);
    let body = case
        .into_iter()
        .fold(PartBuilder::new("body"), |part, wall| {
            part.with_fill_fraction(&style.appliance, wall, 0.9)
        })
        .with(
            &black_plastic(),
            block(
                [-x + 0.03, 0.0, -0.5 * depth + 0.03],
                [x - 0.03, 0.012, z - 0.03],
            ),
        )
        .with(
            &plastic("panel_grey", [196, 198, 202]),
            block([-x + 0.2, h - 0.13, z], [x - 0.01, h - 0.02, z + 0.004]),
        )
        .with(
            &style.appliance,
            block([-x + 0.01, h - 0.13, z], [-x + 0.18, h - 0.02, z + 0.012]),
        )
        .with(
            &chrome(),
            cylinder(0.03, 0.02, 18)
                .rotated_x(FRAC_PI_2)
                .translated(0.02, h - 0.075, z + 0.004),
        );
    let (low, high) = drum_space(middle, z);
    let door = PartBuilder::new("door")
        .with_fill_fraction(
            &chrome(),
            cylinder(0.2, 0.028, 32)
                .rotated_x(FRAC_PI_2)
                .translated(0.0, middle, z + 0.002),
            0.1,
        )
        .with_fill_fraction(
            &dark,
            cylinder(0.16, 0.014, 28)
                .rotated_x(FRAC_PI_2)
                .translated(0.0, middle, z + 0.03),
            0.4,
        );
    Model::articulated("tumble_dryer", "dryer")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, middle, z], "washing_machine", 60.0)
        .with_support_surface(
            "top",
            [-x + 0.02, h, -0.5 * depth + 0.02],
            [x - 0.02, h + 0.5, z - 0.02],
        )
        .with_container_space("drum", low, high)
        .part(door)
        .hinged("door", [0.2, 0.0, z + 0.03], Vec3::Y, 1.6)
}
