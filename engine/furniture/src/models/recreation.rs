//! A pool table, an aquarium on its cupboard.

use super::cabinet_parts::{BOARD_M, Carcass, GAP_M, door};
use crate::finishes::{Finish, glass};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{ball, block, cylinder, rounded_block, trough};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;

/// A pool table with cushions, pockets and balls racked up.
pub fn pool_table(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("pool_table", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let felt = Finish::plain(
        "billiard_cloth",
        "felt",
        d.of("cloth", [[34, 110, 70], [40, 84, 130], [130, 36, 44]]),
    );
    let rail = 0.11;
    let bed = h - 0.045;
    let wood = &style.wood;
    let slate = Finish::plain("slate", "stone", [80, 84, 88]);
    let mut body = PartBuilder::new("body")
        .with_filled(
            wood,
            block(
                [-x + 0.05, bed - 0.24, -z + 0.05],
                [x - 0.05, bed - 0.03, z - 0.05],
            ),
            0.12,
        )
        .with(
            &slate,
            block(
                [-x + 0.06, bed - 0.03, -z + 0.06],
                [x - 0.06, bed - 0.004, z - 0.06],
            ),
        )
        .with(
            &felt,
            block(
                [-x + rail, bed - 0.004, -z + rail],
                [x - rail, bed, z - rail],
            ),
        )
        .with(wood, block([-x, bed - 0.06, -z], [x, h, -z + rail - 0.03]))
        .with(wood, block([-x, bed - 0.06, z - rail + 0.03], [x, h, z]))
        .with(
            wood,
            block(
                [-x, bed - 0.06, -z + rail - 0.03],
                [-x + rail - 0.03, h, z - rail + 0.03],
            ),
        )
        .with(
            wood,
            block(
                [x - rail + 0.03, bed - 0.06, -z + rail - 0.03],
                [x, h, z - rail + 0.03],
            ),
        )
        .with(
            &felt,
            block(
                [-x + rail - 0.03, bed, -z + rail - 0.03],
                [x - rail + 0.03, h - 0.006, -z + rail],
            ),
        )
        .with(
            &felt,
            block(
                [-x + rail - 0.03, bed, z - rail],
                [x - rail + 0.03, h - 0.006, z - rail + 0.03],
            ),
        )
        .with(
            &felt,
            block(
                [-x + rail - 0.03, bed, -z + rail],
                [-x + rail, h - 0.006, z - rail],
            ),
        )
        .with(
            &felt,
            block(
                [x - rail, bed, -z + rail],
                [x - rail + 0.03, h - 0.006, z - rail],
            ),
        );
    body = body.with_bars(
        style.leg_finish(),
        style.legs([x - 0.2, z - 0.2], bed - 0.24, 0.13),
    );
    let pocket = Finish::plain("pocket", "leather", [20, 20, 22]);
    for sx in [-1.0_f32, 0.0, 1.0] {
        for sz in [-1.0_f32, 1.0] {
            let hole = cylinder(0.055, 0.003, 16).at(
                sx * (x - rail + 0.015),
                h - 0.0005,
                sz * (z - rail + 0.015),
            );
            body = body.with(&pocket, hole.visual_only());
        }
    }
    let tones = [
        [226, 180, 40],
        [30, 60, 140],
        [180, 36, 34],
        [84, 40, 110],
        [220, 110, 34],
        [30, 100, 60],
    ];
    for row in 0..4 {
        for k in 0..=row {
            let (a, b) = (
                0.25 * w + 0.0505 * row as f32,
                0.0585 * (k as f32 - 0.5 * row as f32),
            );
            let color = Finish::plain(
                "billiard_ball",
                "plastic",
                tones[(row * 2 + k) % tones.len()],
            );
            body = body.with(
                &color,
                ball(0.0285, 10).at(a, bed + 0.0285, b).visual_only(),
            );
        }
    }
    let white = Finish::plain("cue_ball", "plastic", [244, 242, 232]);
    body = body.with(
        &white,
        ball(0.0285, 12)
            .at(-0.25 * w, bed + 0.0285, 0.0)
            .visual_only(),
    );
    Model::fixed("pool_table", "game_table").part(body).top(
        "bed",
        [-0.2 * w, bed, -z + rail + 0.02],
        [0.2 * w, bed + 0.4, z - rail - 0.02],
    )
}

/// A table with a glass tank of water and fish.
pub fn aquarium(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("aquarium", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let tank = (0.42 * h).min(0.5);
    let low = h - tank - 0.03;
    let carcass = Carcass {
        min: [-x, 0.05, -z],
        max: [x, low, z - BOARD_M],
    };
    let wood = style.any_wood(&mut d.stream("wood"));
    let water = Finish::plain("aquarium_water", "water", [120, 180, 190]).clear(0.35);
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
            trough(
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
            long.and(tail)
                .about_y(
                    0.3 * side
                        + if side < 0.0 {
                            std::f32::consts::PI
                        } else {
                            0.0
                        },
                )
                .at(a, y, b)
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
    let front = style.doors();
    let mut model = Model::articulated("aquarium", "fish_tank")
        .switched(true)
        .part(body)
        .with_sound([0.0, h - 0.05, -z + 0.05], "hum", 34.0)
        .light([0.0, h + 0.02, 0.0], dwell_scene::LightShape::Point, 3.0);
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
