//! For leisure and housework: chess, bicycle, ladder, tripod, ironing board, exercise bench, board to write on.

use crate::finishes::{Finish, black, chrome, painted_steel, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{
    SolidMesh, ball, block, cylinder, frame, ring, rod, rounded_block, surface_of_revolution, tube,
};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::{FRAC_PI_2, TAU};

/// A chess board with some pieces of a game on it.
pub fn chessboard(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("chessboard", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let thick = 0.016;
    let x = 0.5 * w;
    let square = (w - 0.04) / 8.0;
    let maple = Finish::plain("chess_maple", "wood", [226, 196, 150]);
    let dark = Finish::plain("chess_walnut", "wood", [104, 66, 44]);
    let mut squares = SolidMesh::default();
    for k in 0..64 {
        let (a, b) = (k % 8, k / 8);
        if (a + b) % 2 == 1 {
            let (from_x, from_z) = (-x + 0.02 + square * a as f32, -x + 0.02 + square * b as f32);
            squares = squares.and(
                block(
                    [from_x, thick, from_z],
                    [from_x + square, thick + 0.0006, from_z + square],
                )
                .visual_only(),
            );
        }
    }
    let tall = h - thick;
    let piece = |share: f32| {
        let (t, r) = (tall * share, 0.36 * square);
        surface_of_revolution(
            &[
                (0.0, 0.0),
                (r, 0.0),
                (0.9 * r, 0.12 * t),
                (0.4 * r, 0.3 * t),
                (0.35 * r, 0.62 * t),
                (0.62 * r, 0.8 * t),
                (0.4 * r, 0.95 * t),
                (0.0, t),
            ],
            8,
        )
    };
    let mut random = d.stream("game");
    let mut body = PartBuilder::new("body")
        .with(&dark, block([-x, 0.0, -x], [x, thick - 0.002, x]))
        .with(
            &maple,
            block(
                [-x + 0.02, thick - 0.002, -x + 0.02],
                [x - 0.02, thick, x - 0.02],
            ),
        )
        .with(&dark, squares);
    // Pawns on the second and seventh rank, some moved forward; kings and queens behind.
    for k in 0..8 {
        for (color, home, way) in [(&maple, 6, -1), (&dark, 1, 1)] {
            if random.below(5) == 0 {
                continue;
            }
            let rank = home + way * [0, 0, 1, 2][random.below(4)];
            let at = |n: i32| -x + 0.02 + square * (n as f32 + 0.5);
            body = body.with(color, piece(0.55).at(at(k), thick + 0.0006, at(rank)));
        }
    }
    for (color, rank) in [(&maple, 7), (&dark, 0)] {
        for (file, share) in [(0, 0.6), (3, 0.92), (4, 1.0), (5, 0.8), (7, 0.6)] {
            let at = |n: i32| -x + 0.02 + square * (n as f32 + 0.5);
            body = body.with(color, piece(share).at(at(file), thick + 0.0006, at(rank)));
        }
    }
    Model::movable("chessboard", "chessboard").part(body)
}

/// A bicycle on its stand, riding towards +X.
pub fn bicycle(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bicycle", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let paint = painted_steel(
        "bicycle_paint",
        d.of(
            "paint",
            [
                [176, 40, 44],
                [40, 90, 150],
                [40, 44, 46],
                [70, 130, 100],
                [222, 200, 160],
            ],
        ),
    );
    let rubber = Finish::plain("tyre", "rubber", [32, 32, 34]);
    let r = 0.195 * w;
    let (rear, ahead) = ([-0.5 * w + r, r, 0.0], [0.5 * w - r, r, 0.0]);
    let (saddle, crank, head) = (
        [-0.12 * w, h - 0.1, 0.0],
        [-0.06 * w, r - 0.06, 0.0],
        [0.22 * w, h - 0.16, 0.0],
    );
    let seat_tube = [-0.1 * w, 0.68 * h, 0.0];
    let head_low = [0.245 * w, 0.62 * h, 0.0];
    let bar = 0.015;
    let tubes = [
        rod(crank, saddle, bar),
        rod(seat_tube, head, bar),
        rod(crank, head_low, bar),
        rod(rear, crank, 0.01),
        rod(rear, seat_tube, 0.009),
        rod(ahead, head_low, 0.012),
        rod(head_low, head, 0.018),
    ];
    let wheel = |at: [f32; 3]| {
        ring(r - 0.018, 0.018, 32)
            .about_x(FRAC_PI_2)
            .at(at[0], at[1], at[2])
    };
    let mut body = PartBuilder::new("body")
        .with_filled(&rubber, wheel(rear).and(wheel(ahead)), 0.45)
        .with_filled(
            &paint,
            tubes.into_iter().fold(SolidMesh::default(), SolidMesh::and),
            0.16,
        )
        .with_filled(
            &black(),
            rounded_block(
                [saddle[0] - 0.14, h - 0.1, -0.07],
                [saddle[0] + 0.12, h - 0.04, 0.07],
                0.025,
                2,
            ),
            0.5,
        )
        .with_filled(
            &chrome(),
            tube(
                &[
                    [head[0] - 0.08, h - 0.02, -0.28],
                    [head[0] + 0.02, h - 0.02, -0.1],
                    [head[0] + 0.02, h - 0.02, 0.1],
                    [head[0] - 0.08, h - 0.02, 0.28],
                ],
                0.011,
                8,
            ),
            0.3,
        )
        .with_filled(
            &chrome(),
            rod(head, [head[0] + 0.02, h - 0.02, 0.0], 0.012),
            0.3,
        )
        .with_filled(
            &chrome(),
            cylinder(0.09, 0.008, 20)
                .about_x(FRAC_PI_2)
                .at(crank[0], crank[1], 0.03),
            0.3,
        )
        .with_filled(
            &chrome(),
            rod(
                [crank[0] - 0.1, crank[1] + 0.13, 0.06],
                [crank[0] + 0.1, crank[1] - 0.13, 0.06],
                0.008,
            ),
            0.5,
        )
        .with(
            &black(),
            block(
                [crank[0] - 0.15, crank[1] + 0.12, 0.05],
                [crank[0] - 0.06, crank[1] + 0.14, 0.13],
            ),
        )
        .with(
            &black(),
            block(
                [crank[0] + 0.06, crank[1] - 0.14, -0.13],
                [crank[0] + 0.15, crank[1] - 0.12, -0.05],
            ),
        )
        // A stand of two legs under the bottom bracket.
        .with(&black(), ball(0.01, 8).at(crank[0] - 0.08, 0.01, 0.16))
        .with(&black(), ball(0.01, 8).at(crank[0] - 0.08, 0.01, -0.16))
        .with(
            &black(),
            rod(
                [crank[0], crank[1], 0.0],
                [crank[0] - 0.08, 0.008, 0.16],
                0.01,
            ),
        )
        .with(
            &black(),
            rod(
                [crank[0], crank[1], 0.0],
                [crank[0] - 0.08, 0.008, -0.16],
                0.01,
            ),
        );
    for hub in [rear, ahead] {
        for k in 0..6 {
            let (sin, cos) = dwell_scene::math::sin_cos(TAU * k as f32 / 12.0);
            let (a, b) = ((r - 0.03) * cos, (r - 0.03) * sin);
            body = body.with(
                &chrome(),
                rod(
                    [hub[0] - a, hub[1] - b, 0.0],
                    [hub[0] + a, hub[1] + b, 0.0],
                    0.0016,
                )
                .visual_only(),
            );
        }
    }
    Model::movable("bicycle", "bicycle").part(body)
}

/// A stepladder, opened out.
pub fn ladder(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("ladder", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let alloy = Finish::plain(
        "ladder_alloy",
        "aluminium",
        d.of("tone", [[196, 198, 202], [214, 160, 60], [170, 60, 50]]),
    );
    let leg = |from: [f32; 3], to: [f32; 3]| crate::shapes::tapered_leg(from, to, 0.03, 0.03);
    let mut body = PartBuilder::new("body");
    for side in [-1.0_f32, 1.0] {
        let a = side * (x - 0.02);
        let b = side * (x - 0.045);
        body = body
            .with_filled(&alloy, leg([a, 0.0, z - 0.02], [b, h - 0.03, 0.05]), 0.25)
            .with_filled(&alloy, leg([a, 0.0, -z + 0.02], [b, h - 0.03, -0.1]), 0.25);
    }
    let steps = ((h / 0.24) as usize).max(2);
    for k in 1..steps {
        let share = k as f32 / steps as f32;
        let (y, at) = (share * h, (z - 0.02) * (1.0 - share) + 0.05 * share);
        let half = x - 0.04 - 0.025 * share;
        body = body.with_filled(
            &alloy,
            block([-half, y - 0.02, at - 0.045], [half, y, at + 0.045]),
            0.3,
        );
    }
    let body = body.with_filled(
        &alloy,
        block([-x + 0.03, h - 0.03, -0.13], [x - 0.03, h, 0.1]),
        0.4,
    );
    Model::movable("stepladder", "ladder").part(body)
}

/// A tripod with its legs spread.
pub fn tripod(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("tripod", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let leg = Finish::plain(
        "tripod_leg",
        "aluminium",
        d.of("tone", [[44, 44, 47], [176, 178, 182]]),
    );
    let r = w / 3.0_f32.sqrt() - 0.012;
    let crown = 0.72 * h;
    let mut body = PartBuilder::new("body")
        .with(
            &black(),
            cylinder(0.045, 0.06, 16).at(0.0, crown - 0.03, 0.0),
        )
        .with_filled(
            &leg,
            cylinder(0.013, h - crown - 0.03, 12).at(0.0, crown, 0.0),
            0.6,
        )
        .with(&black(), block([-0.04, h - 0.05, -0.03], [0.04, h, 0.03]))
        .with(
            &black(),
            rod([0.0, h - 0.03, -0.02], [0.1, h - 0.12, -0.14], 0.008),
        );
    for k in 0..3 {
        let (sin, cos) = dwell_scene::math::sin_cos(TAU * k as f32 / 3.0);
        let foot = ball(0.012, 8).at(r * sin, 0.012, r * cos);
        body = body.with(&black(), foot);
        body = body.with_filled(
            &leg,
            rod(
                [r * sin, 0.01, r * cos],
                [0.04 * sin, crown, 0.04 * cos],
                0.012,
            ),
            0.5,
        );
    }
    Model::movable("tripod", "tripod").part(body)
}

/// An ironing board on crossed legs.
pub fn ironing_board(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("ironing_board", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let cover = style.cloth(&mut d.stream("cover"));
    let outline = [
        [-x, -z],
        [0.55 * x, -z],
        [0.85 * x, -0.6 * z],
        [x, -0.2 * z],
        [x, 0.2 * z],
        [0.85 * x, 0.6 * z],
        [0.55 * x, z],
        [-x, z],
    ];
    let board = crate::shapes::extrude(&outline, 0.03).about_x(-FRAC_PI_2);
    let leg = |s: f32, b: f32| rod([-s * 0.6 * x, 0.014, b], [s * 0.6 * x, h - 0.035, b], 0.012);
    let foot = |s: f32, half: f32| {
        rod(
            [s * 0.6 * x, 0.014, -half],
            [s * 0.6 * x, 0.014, half],
            0.014,
        )
    };
    let body = PartBuilder::new("body")
        .with_filled(cover, board.at(0.0, h - 0.03, 0.0), 0.5)
        .with_filled(&style.metal, leg(1.0, -0.03).and(leg(-1.0, 0.03)), 0.35)
        .with_filled(&style.metal, foot(-1.0, z).and(foot(1.0, z)), 0.35);
    Model::movable("ironing_board", "ironing_board")
        .part(body)
        .top(
            "board",
            [-0.9 * x, h, -0.7 * z],
            [0.5 * x, h + 0.4, 0.7 * z],
        )
}

/// A bench to lift weights on, with a bar in its rack.
pub fn weight_bench(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("weight_bench", key);
    let (w, h, depth) = (d.m("width"), d.m("bar"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let steel = painted_steel(
        "bench_steel",
        d.of("tone", [[44, 46, 50], [150, 40, 42], [200, 202, 206]]),
    );
    let cover = Finish {
        substance: "leather",
        ..plastic("bench_cover", [40, 40, 43])
    };
    let iron = Finish::plain("weights", "cast_iron", [52, 54, 58]);
    let seat = 0.45;
    let mut body = PartBuilder::new("body")
        .with_filled(
            &cover,
            rounded_block([-0.14, seat - 0.06, -0.5 * z], [0.14, seat, z], 0.02, 2),
            0.35,
        )
        .with_filled(
            &steel,
            block(
                [-0.03, seat - 0.12, -z + 0.06],
                [0.03, seat - 0.06, z - 0.05],
            ),
            0.2,
        )
        .with_filled(
            &steel,
            block([-0.03, 0.05, z - 0.16], [0.03, seat - 0.12, z - 0.1]),
            0.2,
        )
        .with_filled(
            &steel,
            block([-0.25, 0.0, z - 0.16], [0.25, 0.05, z - 0.1]),
            0.2,
        );
    let post = 0.36 * x;
    for side in [-1.0_f32, 1.0] {
        let a = side * post;
        body = body
            .with_filled(
                &steel,
                block([a - 0.03, 0.0, -z], [a + 0.03, 0.05, -0.2 * z]),
                0.2,
            )
            .with_filled(
                &steel,
                block([a - 0.03, 0.05, -z + 0.08], [a + 0.03, h - 0.06, -z + 0.14]),
                0.2,
            )
            .with(
                &steel,
                block(
                    [a - 0.03, h - 0.07, -z + 0.14],
                    [a + 0.03, h - 0.05, -z + 0.2],
                ),
            );
        for (k, r) in [0.14_f32, 0.11].into_iter().enumerate() {
            let plate = cylinder(r, 0.024, 24).about_z(FRAC_PI_2);
            body = body.with_filled(
                &iron,
                plate.at(
                    side * (x - 0.12 + 0.03 * k as f32) + 0.012,
                    h - 0.035,
                    -z + 0.17,
                ),
                0.5,
            );
        }
    }
    let body = body
        .with_filled(
            &steel,
            block(
                [-post + 0.03, 0.2, -z + 0.09],
                [post - 0.03, 0.25, -z + 0.13],
            ),
            0.2,
        )
        .with(
            &chrome(),
            rod(
                [-x, h - 0.035, -z + 0.17],
                [x, h - 0.035, -z + 0.17],
                0.0145,
            ),
        );
    Model::fixed("weight_bench", "gym_equipment").part(body)
}

/// A white board in a frame on the wall; y = 0 is its middle.
pub fn whiteboard(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("whiteboard", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let (x, y) = (0.5 * w, 0.5 * h);
    let alloy = Finish::plain("board_frame", "aluminium", [190, 192, 196]);
    let face = Finish::plain("board_face", "steel", [246, 247, 247]);
    let mut body = PartBuilder::new("body")
        .with(&alloy, frame(w, h, 0.02, 0.022))
        .with_filled(
            &face,
            block([-x + 0.02, -y + 0.02, 0.002], [x - 0.02, y - 0.02, 0.016]),
            0.15,
        )
        .with(
            &alloy,
            block([-0.4 * w, -y, 0.022], [0.4 * w, -y + 0.012, 0.08]),
        );
    let pens = [[30, 60, 150], [190, 40, 40], [30, 120, 60]];
    for (k, tone) in pens.into_iter().enumerate() {
        let at = -0.1 + 0.15 * k as f32;
        let pen = rod([at, -y + 0.021, 0.05], [at + 0.12, -y + 0.021, 0.05], 0.008);
        body = body.with(&plastic("board_pen", tone), pen.visual_only());
    }
    Model::fixed("whiteboard", "whiteboard").part(body)
}
