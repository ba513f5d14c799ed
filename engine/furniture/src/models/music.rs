//! Musical instruments.

use crate::finishes::{Finish, black, brass, chrome, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{
    SolidMesh, ball, block, cylinder, extrude, rod, rounded_block, surface_of_revolution,
};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

/// Keys of a piano from -`half` to `half`: one white board with gaps painted by black keys; front at `z`.
fn keys(half: f32, y: f32, z: f32, depth: f32) -> [(Finish, SolidMesh); 2] {
    let ivory = plastic("ivory_keys", [244, 242, 234]);
    let count = ((2.0 * half) / 0.0235) as usize;
    let wide = 2.0 * half / count as f32;
    let mut white = SolidMesh::default();
    let mut dark = SolidMesh::default();
    for k in 0..count {
        let from = -half + wide * k as f32;
        white = white.and(
            block(
                [from + 0.0006, y, z - depth],
                [from + wide - 0.0006, y + 0.012, z],
            )
            .visual_only(),
        );
        // Two and three black keys in turn, as on every keyboard.
        if ![2, 6].contains(&(k % 7)) && k + 1 < count {
            let at = from + wide;
            dark = dark.and(
                block(
                    [at - 0.006, y + 0.012, z - depth],
                    [at + 0.006, y + 0.022, z - 0.36 * depth],
                )
                .visual_only(),
            );
        }
    }
    white.colliders = block([-half, y, z - depth], [half, y + 0.012, z]).colliders;
    [(ivory, white), (black(), dark)]
}

/// An upright piano; the lid over its keys turns up.
pub fn piano(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("piano", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let lacquer = match d.below("finish", 3) {
        0 => Finish::plain("piano_black", "wood", [24, 24, 26]),
        1 => Finish::plain("piano_white", "wood", [240, 238, 232]),
        _ => style.wood.clone(),
    };
    let front = -z + 0.36;
    let (bed, board) = (0.6, 0.68);
    let half = x - 0.12;
    let key_front = z - 0.05;
    let [white, dark] = keys(half, 0.655, key_front, 0.15);
    let cheek = |side: f32| {
        let (a, b) = (side * half, side * (x - 0.03));
        block([a.min(b), bed, front], [a.max(b), board + 0.04, z])
    };
    let pedal = |a: f32| block([a - 0.012, 0.05, front], [a + 0.012, 0.06, front + 0.09]);
    let side = |s: f32| {
        let (a, b) = (s * (x - 0.03), s * x);
        block([a.min(b), 0.0, -z], [a.max(b), h - 0.03, front])
    };
    let toe = |s: f32| {
        let (a, b) = (s * (x - 0.1), s * (x - 0.04));
        block([a.min(b), 0.0, front], [a.max(b), 0.06, z])
            .and(block([a.min(b), 0.06, z - 0.08], [a.max(b), bed, z - 0.02]))
    };
    let body = PartBuilder::new("body")
        .with_filled(
            &lacquer,
            block([-x + 0.03, 0.06, -z], [x - 0.03, h - 0.03, front]),
            0.7,
        )
        .with_all(
            &lacquer,
            [
                side(-1.0),
                side(1.0),
                toe(-1.0),
                toe(1.0),
                cheek(-1.0),
                cheek(1.0),
            ],
        )
        .with(
            &lacquer,
            rounded_block(
                [-x - 0.01, h - 0.03, -z],
                [x + 0.01, h, front + 0.02],
                0.006,
                1,
            ),
        )
        .with(
            &lacquer,
            block([-x + 0.03, bed, front], [x - 0.03, 0.65, z]),
        )
        .with(
            &lacquer,
            block(
                [-0.4, board + 0.3, front],
                [0.4, board + 0.32, front + 0.05],
            ),
        )
        .with(&white.0, white.1)
        .with(&dark.0, dark.1)
        .with_all(&brass(), [-0.12, 0.0, 0.12].map(pedal));
    let hinge = front + 0.03;
    let lid = PartBuilder::new("lid").with(
        &lacquer,
        block(
            [-half + 0.003, board + 0.005, hinge],
            [half - 0.003, board + 0.02, z - 0.02],
        ),
    );
    Model::articulated("piano", "piano")
        .part(body)
        .top("top", [-x + 0.02, h, -z + 0.02], [x - 0.02, h + 0.4, front])
        .part(lid)
        .hinged("lid", [0.0, board + 0.02, hinge], Vec3::NEG_X, 1.5)
}

/// An electric piano on a crossed stand.
pub fn keyboard(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("keyboard", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let case = plastic(
        "keyboard_case",
        d.of("tone", [[34, 34, 37], [222, 222, 220], [120, 40, 44]]),
    );
    let under = h - 0.09;
    let [white, dark] = keys(x - 0.03, h - 0.012, z - 0.012, 0.14);
    let stand = 0.36 * w;
    let bar = |s: f32, b: f32| rod([-s * stand, 0.02, b], [s * stand, under - 0.02, b], 0.014);
    let foot = |s: f32| rod([s * stand, 0.015, -z], [s * stand, 0.015, z], 0.015);
    let top = |s: f32| {
        rod(
            [s * stand, under - 0.015, -z + 0.02],
            [s * stand, under - 0.015, z - 0.02],
            0.015,
        )
    };
    let body = PartBuilder::new("body")
        .with_filled(
            &case,
            rounded_block([-x, under, -z], [x, h - 0.012, z], 0.012, 1),
            0.35,
        )
        .with_filled(&case, block([-x, h - 0.012, -z], [x, h, z - 0.16]), 0.5)
        .with(&white.0, white.1)
        .with(&dark.0, dark.1)
        .with_filled(&black(), bar(1.0, -0.03).and(bar(-1.0, 0.03)), 0.8)
        .with_all(&black(), [foot(-1.0), foot(1.0), top(-1.0), top(1.0)]);
    Model::movable("keyboard", "keyboard")
        .switched(false)
        .part(body)
}

/// A guitar on its stand, strings towards +Z.
pub fn guitar(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("guitar", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let top = Finish::tiled(
        "spruce",
        "wood",
        "wood",
        [
            d.of(
                "top",
                [[222, 176, 108], [196, 120, 60], [120, 60, 40], [60, 40, 34]],
            ),
            [170, 116, 66],
            [0; 3],
        ],
        0.5,
    );
    let side = Finish::plain("rosewood", "wood", [92, 52, 38]);
    let ebony = Finish::plain("ebony", "wood", [38, 30, 28]);
    // An outline in the plane of the strings, from the lower bout up; the waist is at 0.6 of the body's height.
    let tall = 0.48 * h;
    let outline = [
        [0.0, 0.0],
        [0.62, 0.03],
        [0.95, 0.16],
        [1.0, 0.3],
        [0.88, 0.46],
        [0.68, 0.6],
        [0.7, 0.76],
        [0.74, 0.86],
        [0.56, 0.97],
        [0.16, 1.0],
    ];
    let right = outline.iter().map(|[a, b]| [a * x, b * tall]);
    let left = outline
        .iter()
        .rev()
        .filter(|p| p[0] > 0.0)
        .map(|[a, b]| [-a * x, b * tall]);
    let shape: Vec<[f32; 2]> = right.chain(left).collect();
    let (low, back) = (0.1, -0.045);
    let deep = 0.09;
    let mut box_of = extrude(&shape, deep).at(0.0, low, back);
    // The waist is hollow: two convex halves stand for the body.
    box_of.colliders = [(0.02, 0.55, 0.93), (0.55, 0.98, 0.72)]
        .into_iter()
        .flat_map(|(a, b, s): (f32, f32, f32)| {
            block(
                [-s * x, low + a * tall, back],
                [s * x, low + b * tall, back + deep],
            )
            .colliders
        })
        .collect();
    let neck = low + tall;
    let face = back + deep;
    let body = PartBuilder::new("body")
        .with_filled(&side, box_of, 0.09)
        .with(
            &top,
            extrude(
                &shape
                    .iter()
                    .map(|[a, b]| [0.985 * a, 0.985 * b + 0.0075 * tall])
                    .collect::<Vec<_>>(),
                0.003,
            )
            .at(0.0, low, face)
            .visual_only(),
        )
        .with(
            &ebony,
            cylinder(0.05, 0.0015, 24)
                .about_x(FRAC_PI_2)
                .at(0.0, low + 0.66 * tall, face + 0.003)
                .visual_only(),
        )
        .with(
            &ebony,
            block(
                [-0.08, low + 0.26 * tall, face + 0.003],
                [0.08, low + 0.29 * tall, face + 0.012],
            )
            .visual_only(),
        )
        .with(
            &side,
            block(
                [-0.026, neck - 0.1, face - 0.02],
                [0.026, h - 0.17, face + 0.006],
            ),
        )
        .with(
            &ebony,
            block(
                [-0.026, neck - 0.12, face + 0.006],
                [0.026, h - 0.17, face + 0.011],
            ),
        )
        .with(
            &side,
            block([-0.034, h - 0.17, face - 0.016], [0.034, h, face + 0.004]),
        )
        .with(
            &chrome(),
            block(
                [-0.05, h - 0.14, face - 0.008],
                [0.05, h - 0.13, face - 0.002],
            )
            .and(block(
                [-0.05, h - 0.06, face - 0.008],
                [0.05, h - 0.05, face - 0.002],
            ))
            .visual_only(),
        )
        .with(&black(), ball(0.012, 8).at(-0.8 * x, 0.012, z - 0.012))
        .with(&black(), ball(0.012, 8).at(0.8 * x, 0.012, z - 0.012))
        .with(&black(), ball(0.012, 8).at(0.0, 0.012, -z + 0.012))
        // The stand: two feet to the front and one behind, a yoke below, a prop at the back.
        .with(
            &black(),
            rod(
                [-0.8 * x, 0.012, z - 0.012],
                [0.0, 0.11, back - 0.03],
                0.011,
            ),
        )
        .with(
            &black(),
            rod([0.8 * x, 0.012, z - 0.012], [0.0, 0.11, back - 0.03], 0.011),
        )
        .with(
            &black(),
            rod(
                [0.0, 0.012, -z + 0.012],
                [0.0, 0.6 * neck, back - 0.012],
                0.011,
            ),
        )
        .with(
            &black(),
            block([-0.1, low - 0.015, back - 0.03], [0.1, low, face + 0.01]),
        );
    Model::movable("guitar", "guitar").part(body)
}

/// A drum kit: bass drum, two toms, a floor tom, a snare, two cymbals, a stool behind.
pub fn drum_kit(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("drum_kit", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let shell = Finish::plain(
        "drum_shell",
        "wood",
        d.of(
            "shell",
            [
                [170, 36, 40],
                [36, 60, 120],
                [30, 30, 33],
                [190, 150, 60],
                [226, 224, 218],
            ],
        ),
    );
    let skin = plastic("drum_skin", [236, 234, 226]);
    let bass = 0.28;
    let front = z - 0.45;
    let mut body = PartBuilder::new("kit")
        .with_filled(
            &shell,
            cylinder(bass, 0.4, 28)
                .about_x(FRAC_PI_2)
                .at(0.0, bass, front),
            0.07,
        )
        .with(
            &skin,
            cylinder(bass - 0.015, 0.003, 28)
                .about_x(FRAC_PI_2)
                .at(0.0, bass, front + 0.4)
                .visual_only(),
        );
    let drum = |body: PartBuilder, r: f32, tall: f32, at: [f32; 3], legs: bool| {
        let [a, y, b] = at;
        let mut body = body
            .with_filled(&shell, cylinder(r, tall, 24).at(a, y, b), 0.07)
            .with(
                &skin,
                cylinder(r - 0.008, 0.003, 24)
                    .at(a, y + tall, b)
                    .visual_only(),
            );
        if legs {
            for k in 0..3 {
                let (sin, cos) = dwell_scene::math::sin_cos(2.1 * k as f32 + 0.5);
                body = body.with_filled(
                    &chrome(),
                    rod(
                        [a + 0.95 * r * sin, 0.008, b + 0.95 * r * cos],
                        [a + 0.8 * r * sin, y + 0.1, b + 0.8 * r * cos],
                        0.009,
                    ),
                    0.4,
                );
            }
        } else {
            body = body.with_filled(
                &chrome(),
                rod([0.4 * a, 2.0 * bass - 0.02, b], [a, y + 0.05, b], 0.012).visual_only(),
                0.4,
            );
        }
        body
    };
    body = drum(body, 0.15, 0.2, [-0.17, 0.62, front + 0.12], false);
    body = drum(body, 0.16, 0.22, [0.18, 0.62, front + 0.12], false);
    body = drum(body, 0.2, 0.4, [0.62 * x, 0.2, front - 0.3], true);
    body = drum(body, 0.18, 0.14, [-0.5 * x, 0.48, front - 0.28], true);
    let cymbal = |r: f32, a: f32, y: f32, b: f32| {
        let plate = surface_of_revolution(
            &[
                (0.0, 0.0),
                (r, -0.015),
                (r, -0.012),
                (0.05, 0.012),
                (0.0, 0.028),
            ],
            24,
        );
        (
            plate.at(a, y, b),
            rod([a, 0.03, b], [a, y, b], 0.011),
            cylinder(0.16, 0.03, 3).at(a, 0.0, b),
        )
    };
    for (plate, post, foot) in [
        cymbal(0.2, -x + 0.2, h - 0.04, front + 0.05),
        cymbal(0.23, x - 0.24, h - 0.08, front + 0.15),
    ] {
        body = body
            .with(&brass(), plate)
            .with_filled(&chrome(), post, 0.4)
            .with_filled(&black(), foot, 0.15);
    }
    let body = body
        .with(&black(), cylinder(0.17, 0.07, 24).at(0.0, 0.45, -z + 0.18))
        .with_filled(
            &chrome(),
            rod([0.0, 0.02, -z + 0.18], [0.0, 0.45, -z + 0.18], 0.015),
            0.5,
        )
        .with_filled(
            &black(),
            cylinder(0.18, 0.03, 3).at(0.0, 0.0, -z + 0.18),
            0.2,
        );
    Model::fixed("drum_kit", "drumset").part(body)
}
