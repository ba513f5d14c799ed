//! An aquarium on its cupboard.

use super::cabinet_parts::{BOARD_M, Carcass, GAP_M, door};
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, glass};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, open_top_box, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] =
    &[CatalogueEntry::new("aquarium", "fish_tank", 135, aquarium)];

/// A table with a glass tank of water and fish.
fn aquarium(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("aquarium", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let tank = (0.42 * h).min(0.5);
    let low = h - tank - 0.03;
    let carcass = Carcass {
        min: [-x, 0.05, -z],
        max: [x, low, z - BOARD_M],
    };
    let wood = style.random_wood(&mut d.stream("wood"));
    let water = Finish::plain("aquarium_water", "water", [120, 180, 190]).transparent(0.35);
    let sand = Finish::tiled(
        "aquarium_sand",
        "soil",
        "speckle",
        [[200, 180, 140], [150, 130, 100], [226, 210, 180]],
        0.2,
    );
    let weed = crate::finishes::foliage("water_weed", [52, 120, 60], [110, 160, 80]);
    let mut body = PartBuilder::new("body")
        .with_all(wood, carcass.boards(&[], &[0.5]))
        .with(
            wood,
            block([-x + 0.03, 0.0, -z + 0.02], [x - 0.03, 0.05, z - 0.06]),
        )
        .with(wood, block([-x, low, -z], [x, low + 0.02, z]))
        .with(
            &glass(),
            open_top_box(
                [-x + 0.01, low + 0.02, -z + 0.01],
                [x - 0.01, h - 0.01, z - 0.01],
                0.008,
            ),
        )
        .with(
            &sand,
            block(
                [-x + 0.018, low + 0.028, -z + 0.018],
                [x - 0.018, low + 0.06, z - 0.018],
            ),
        )
        .with(
            &water,
            block(
                [-x + 0.018, low + 0.06, -z + 0.018],
                [x - 0.018, h - 0.06, z - 0.018],
            ),
        )
        .with(
            &Finish::plain("aquarium_lid", "plastic", [34, 36, 38]),
            block([-x + 0.01, h - 0.01, -z + 0.01], [x - 0.01, h, z - 0.01]),
        );
    let mut random = d.stream("inside");
    let fish = [[236, 120, 36], [60, 110, 200], [230, 200, 60]];
    for k in 0..7 {
        let (a, y, b) = (
            random.range(-0.8, 0.8) * (x - 0.06),
            low + 0.1 + random.range(0.0, 1.0) * (tank - 0.22),
            random.range(-0.7, 0.7) * (z - 0.05),
        );
        let tone = Finish::plain("fish", "animal", fish[k % 3]);
        let side = if k % 2 == 0 { 1.0 } else { -1.0 };
        let long = rounded_block([-0.025, -0.012, -0.004], [0.02, 0.012, 0.004], 0.0035, 1);
        let tail = block([-0.042, -0.012, -0.0015], [-0.025, 0.012, 0.0015]);
        body = body.with(
            &tone,
            long.merged(tail)
                .rotated_y(
                    0.3 * side
                        + if side < 0.0 {
                            std::f32::consts::PI
                        } else {
                            0.0
                        },
                )
                .translated(a, y, b)
                .visual_only(),
        );
    }
    for _ in 0..6 {
        let (a, b, tall) = (
            random.range(-0.85, 0.85) * (x - 0.05),
            random.range(-0.8, 0.2) * (z - 0.05),
            random.range(0.4, 0.8) * (tank - 0.1),
        );
        body = body.with(
            &weed,
            block(
                [a - 0.008, low + 0.05, b - 0.003],
                [a + 0.008, low + 0.05 + tall, b + 0.003],
            )
            .visual_only(),
        );
    }
    let front = style.front_style();
    let mut model = Model::articulated("aquarium", "fish_tank")
        .with_switch_state(true)
        .part(body)
        .with_sound([0.0, h - 0.05, -z + 0.05], "hum", 34.0)
        .with_light_shape([0.0, h + 0.02, 0.0], dwell_scene::LightShape::Point, 3.0);
    for (name, a, b, left) in [
        ("left_door", -x + 0.002, -0.5 * GAP_M, true),
        ("right_door", 0.5 * GAP_M, x - 0.002, false),
    ] {
        let (hinge, axis) = if left {
            (-x, Vec3::NEG_Y)
        } else {
            (x, Vec3::Y)
        };
        model = model
            .part(door(
                name,
                [a, 0.055],
                [b, low - 0.002],
                carcass.max[2],
                left,
                &front,
            ))
            .hinged(name, [hinge, 0.0, carcass.max[2] + BOARD_M], axis, 1.57);
    }
    model
}
