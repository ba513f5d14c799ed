//! A refrigerator with a freezer below.

use super::cabinet_parts::vertical_handle;
use super::casings::casing_finish;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{enamel, glass, steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{SolidMesh, block, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "refrigerator",
    "refrigerator",
    50,
    sample_refrigerator,
)];

/// Wall of the insulated case, m.
const WALL_M: f32 = 0.045;

/// A fridge of the given outer size with two doors on the left.
fn refrigerator(width_m: f32, height_m: f32, depth_m: f32) -> Model {
    let white = enamel("fridge_white", [236, 238, 238]);
    let (x, z) = (0.5 * width_m, 0.5 * depth_m);
    let (back, front) = (-z, z - 0.06);
    let split = height_m * 0.36;
    let w = WALL_M;
    let case: [SolidMesh; 6] = [
        block([-x, 0.03, back], [-x + w, height_m, front]),
        block([x - w, 0.03, back], [x, height_m, front]),
        block([-x + w, 0.03, back], [x - w, 0.03 + w, front]),
        block([-x + w, height_m - w, back], [x - w, height_m, front]),
        block(
            [-x + w, split - 0.5 * w, back],
            [x - w, split + 0.5 * w, front],
        ),
        block([-x + w, 0.03 + w, back], [x - w, height_m - w, back + w]),
    ];
    let feet = block(
        [-x + 0.03, 0.0, back + 0.03],
        [x - 0.03, 0.03, front - 0.03],
    );
    let shelf = |share: f32| {
        let y = split + share * (height_m - split);
        block([-x + w, y, back + w], [x - w, y + 0.006, front - 0.06])
    };
    let body = PartBuilder::new("body")
        .with_all(&white, case)
        .with(&crate::finishes::black_plastic(), feet)
        .with_all(&glass(), [shelf(0.3), shelf(0.55), shelf(0.78)]);
    let space = |low: f32, high: f32| ([-x + w, low, back + w], [x - w, high, front - 0.06]);
    let level = |share: f32| split + share * (height_m - split);
    let (a0, a1) = space(split + 0.5 * w, level(0.3));
    let (b0, b1) = space(level(0.3) + 0.006, level(0.55));
    let (c0, c1) = space(level(0.55) + 0.006, level(0.78));
    let (d0, d1) = space(0.03 + w, split - 0.5 * w);
    let door = |name: &'static str, low: f32, high: f32, handle: [f32; 2]| {
        PartBuilder::new(name)
            .with(
                &white,
                rounded_block([-x, low, front + 0.002], [x, high, z], 0.012, 1),
            )
            .with(&steel(), vertical_handle(x - 0.05, handle[0], handle[1], z))
    };
    Model::articulated("refrigerator", "refrigerator")
        .with_switch_state(true)
        .part(body)
        .with_sound([0.0, 0.2, back + 0.05], "fridge", 38.0)
        .with_container_space("lower_shelf", a0, a1)
        .with_container_space("middle_shelf", b0, b1)
        .with_container_space("upper_shelf", c0, c1)
        .with_container_space("freezer", d0, d1)
        .part(door(
            "door",
            split + 0.004,
            height_m,
            [split + 0.12, split + 0.5],
        ))
        .hinged("door", [-x, 0.0, z], Vec3::NEG_Y, 1.62)
        .part(door(
            "freezer_door",
            0.035,
            split - 0.004,
            [split - 0.35, split - 0.1],
        ))
        .hinged("freezer_door", [-x, 0.0, z], Vec3::NEG_Y, 1.62)
}

fn sample_refrigerator(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("refrigerator", key);
    let case = casing_finish(style, &d, "fridge_casing");
    refrigerator(
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    )
    .with_finish_replaced("fridge_white", &case)
}
