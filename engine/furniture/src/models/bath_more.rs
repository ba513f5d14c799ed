//! More of the bathroom: shower cabin, basin on the wall, plunger, brush, soap dish, toilet roll, robe.

use crate::finishes::{Finish, black, chrome, glass, plastic, sanitary};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{
    ball, block, cylinder, loft, oval, rod, rounded_block, surface_of_revolution, tube, vessel,
};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;

/// A shower in a corner: a tray, two panes of glass and a door of glass; walls behind it (-Z) and to its left (-X).
pub fn shower_cabin(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("shower_cabin", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let metal = if d.chance("metal", 0.4) {
        style.metal.clone()
    } else {
        chrome()
    };
    let (t, step) = (0.008, 0.05);
    let half = 0.012;
    let face = z - 0.02;
    let head = h - 0.08;
    let split = -x + 0.42 * w;
    let post = |a: f32, b: f32| block([a - half, step, b - half], [a + half, h, b + half]);
    let pipe = tube(
        &[
            [-0.2 * w, 1.0, -z + 0.04],
            [-0.2 * w, head - 0.05, -z + 0.04],
            [-0.2 * w, head, -z + 0.09],
            [-0.2 * w, head, -z + 0.3],
        ],
        0.011,
        8,
    );
    let body = PartBuilder::new("body")
        .with_filled(
            &sanitary(),
            rounded_block([-x, 0.0, -z], [x, step, z], 0.012, 1),
            0.3,
        )
        .with(
            &chrome(),
            cylinder(0.045, 0.002, 16).at(0.0, step, 0.0).visual_only(),
        )
        .with(
            &glass(),
            block(
                [x - 0.02 - 0.5 * t, step, -z + 0.01],
                [x - 0.02 + 0.5 * t, h - 0.01, face - half],
            ),
        )
        .with(
            &glass(),
            block(
                [-x + 0.01, step, face - 0.5 * t],
                [split, h - 0.01, face + 0.5 * t],
            ),
        )
        .with_filled(&metal, post(x - 0.02, face), 0.3)
        .with_filled(
            &metal,
            block(
                [-x, h - 0.01, face - half],
                [x - 0.02 - half, h, face + half],
            ),
            0.3,
        )
        .with_filled(
            &metal,
            block(
                [x - 0.02 - half, h - 0.01, -z],
                [x - 0.02 + half, h, face - half],
            ),
            0.3,
        )
        .with(&chrome(), pipe)
        .with(
            &chrome(),
            rod([-0.2 * w, 1.05, -z], [-0.2 * w, 1.05, -z + 0.05], 0.03),
        )
        .with(
            &chrome(),
            cylinder(0.11, 0.012, 24).at(-0.2 * w, head - 0.024, -z + 0.3),
        );
    let (a, b) = (split + 0.006, x - 0.02 - half - 0.004);
    let door = PartBuilder::new("door")
        .with(
            &glass(),
            block(
                [a, step + 0.01, face - 0.5 * t],
                [b, h - 0.015, face + 0.5 * t],
            ),
        )
        .with(
            &chrome(),
            rod(
                [a + 0.04, 0.95, face + 0.03],
                [a + 0.04, 1.2, face + 0.03],
                0.008,
            ),
        )
        .with(
            &chrome(),
            rod([a + 0.04, 1.0, face], [a + 0.04, 1.0, face + 0.03], 0.006).visual_only(),
        )
        .with(
            &chrome(),
            rod([a + 0.04, 1.15, face], [a + 0.04, 1.15, face + 0.03], 0.006).visual_only(),
        );
    Model::articulated("shower_cabin", "shower")
        .switched(false)
        .part(body)
        .with_sound([-0.2 * w, head - 0.03, -z + 0.3], "tap", 66.0)
        .inside(
            "floor",
            [-x + 0.05, step + 0.004, -z + 0.12],
            [x - 0.05, 0.9, face - 0.03],
        )
        .part(door)
        .hinged("door", [b, 0.0, face + 0.5 * t], Vec3::Y, 1.5)
}

/// A washbasin on the wall or on a column, without a cupboard; the wall is at -Z.
pub fn basin(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("basin", key);
    let (w, h, depth) = (d.m("width"), d.m("rim"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let white = sanitary();
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
        .with_filled(
            &white,
            shell.into_iter().fold(
                crate::shapes::SolidMesh::default(),
                crate::shapes::SolidMesh::and,
            ),
            0.45,
        )
        .with(
            &chrome(),
            tube(&spout, 0.012, 10).and(cylinder(0.022, 0.02, 16).at(0.0, h, ledge - 0.05)),
        )
        .with(
            &chrome(),
            cylinder(0.02, 0.003, 16).at(0.0, floor, 0.03).visual_only(),
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
    body = body.with_filled(&white, column.at(0.0, 0.0, -z + 0.12), 0.25);
    Model::fixed("basin", "sink")
        .switched(false)
        .part(body)
        .with_sound([0.0, h, ledge + 0.06], "tap", 58.0)
        .inside(
            "basin",
            [-x + wall, floor + 0.004, ledge],
            [x - wall, h, z - wall],
        )
        .top("ledge", [0.05, h, -z + 0.01], [x - 0.02, h + 0.25, ledge])
}

/// A plunger.
pub fn plunger(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("plunger", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let r = 0.5 * w;
    let rubber = Finish::plain(
        "plunger_rubber",
        "rubber",
        d.of("tone", [[150, 52, 40], [34, 34, 36], [60, 90, 140]]),
    );
    let body = PartBuilder::new("body")
        .with_filled(
            &rubber,
            surface_of_revolution(
                &[
                    (0.0, 0.0),
                    (r, 0.0),
                    (0.95 * r, 0.3 * r),
                    (0.6 * r, 0.9 * r),
                    (0.25 * r, 1.2 * r),
                    (0.0, 1.2 * r),
                ],
                20,
            ),
            0.35,
        )
        .with(&style.wood, rod([0.0, 1.2 * r, 0.0], [0.0, h, 0.0], 0.011));
    Model::movable("plunger", "toilet_plunger").part(body)
}

/// A dish with a piece of soap.
pub fn soap_dish(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("soap_dish", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let soap = Finish::plain(
        "soap",
        "wax",
        d.of(
            "soap",
            [
                [238, 230, 206],
                [222, 170, 180],
                [180, 206, 170],
                [230, 200, 130],
            ],
        ),
    );
    let glaze = style.glaze(&mut d.stream("glaze"));
    let dish = loft(&[
        oval(0.38 * w, 0.36 * depth, 0.0, 0.0, 20),
        oval(0.5 * w, 0.5 * depth, 0.5 * h, 0.0, 20),
    ]);
    let piece = rounded_block(
        [-0.3 * w, 0.5 * h, -0.27 * depth],
        [0.3 * w, h, 0.27 * depth],
        0.009,
        2,
    );
    let body = PartBuilder::new("body")
        .with_filled(glaze, dish, 0.6)
        .with(&soap, piece);
    Model::pickable("soap_dish", "soap_dish").part(body)
}

/// A spare roll of toilet paper, standing.
pub fn toilet_roll(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toilet_roll", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let tissue = Finish::plain(
        "tissue",
        "paper",
        d.of("tone", [[244, 243, 238], [232, 222, 206], [236, 214, 214]]),
    );
    let core = Finish::plain("roll_core", "paper", [176, 146, 108]);
    let roll = cylinder(0.5 * w, h, 24);
    let body = PartBuilder::new("body")
        .with_filled(&tissue, roll, 0.22)
        .with(
            &core,
            cylinder(0.021, 0.0006, 16).at(0.0, h, 0.0).visual_only(),
        );
    Model::pickable("toilet_roll", "toilet_paper").part(body)
}

/// A toilet brush in its holder.
pub fn toilet_brush(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toilet_brush", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let holder = if d.chance("metal", 0.5) {
        style.metal.clone()
    } else {
        plastic("white_plastic", [240, 240, 236])
    };
    let r = 0.5 * w;
    let cup = vessel(&[(0.0, 0.0), (0.9 * r, 0.0), (r, 0.4 * h)], 0.004, 18);
    let body = PartBuilder::new("body")
        .with_filled(&holder, cup, 0.3)
        .with(
            &plastic("bristles", [226, 226, 222]),
            cylinder(0.62 * r, 0.2 * h, 16)
                .at(0.0, 0.02, 0.0)
                .visual_only(),
        )
        .with(&holder, rod([0.0, 0.02, 0.0], [0.0, h - 0.02, 0.0], 0.007))
        .with(&black(), ball(0.012, 10).at(0.0, h - 0.012, 0.0));
    Model::movable("toilet_brush", "toiletries").part(body)
}

/// Shampoo and shower gel: two or three bottles of plastic together.
pub fn shampoo(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("shampoo", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let tones = [
        [60, 140, 170],
        [226, 110, 130],
        [240, 236, 226],
        [110, 160, 90],
        [230, 170, 60],
        [90, 70, 130],
    ];
    let mut body = PartBuilder::new("body");
    let first = d.below("first", tones.len());
    for (k, (at, tall)) in [(-0.27, 1.0_f32), (0.27, 0.82)].into_iter().enumerate() {
        let tone = plastic("shampoo_bottle", tones[(first + 2 * k) % tones.len()]);
        let shell = loft(&[
            oval(0.2 * w, 0.42 * depth, 0.0, 0.0, 16),
            oval(0.22 * w, 0.5 * depth, 0.06 * h, 0.0, 16),
            oval(0.22 * w, 0.5 * depth, 0.62 * h * tall, 0.0, 16),
            oval(0.1 * w, 0.25 * depth, 0.82 * h * tall, 0.0, 16),
        ]);
        body = body
            .with_filled(&tone, shell.at(at * w, 0.0, 0.0), 0.75)
            .with(
                &plastic("bottle_cap", [236, 236, 232]),
                cylinder(0.09 * w, 0.18 * h * tall, 12).at(at * w, 0.82 * h * tall, 0.0),
            );
    }
    Model::movable("shampoo", "toiletries").part(body)
}
