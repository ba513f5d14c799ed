//! For balcony and garden: parasol, grill, lamp, mower, letter box, table.

use super::table::Table;
use crate::finishes::{Finish, black, milk_glass, painted_steel, plastic, steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{
    SolidMesh, block, cylinder, loft, rod, rounded_block, surface_of_revolution, tube,
};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::{FRAC_PI_2, TAU};

/// A parasol on a heavy foot, open.
pub fn parasol(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("parasol", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let r = 0.5 * w;
    let cover = style.cloth(&mut d.stream("cover"));
    let stone = Finish::plain("parasol_foot", "concrete", [150, 148, 144]);
    // A ring of eight corners, a tip above, and the same again a hand below: thin cloth, closed.
    let ring = |radius: f32, y: f32| -> Vec<Vec3> {
        (0..8)
            .map(|k| {
                let (sin, cos) = dwell_scene::math::sin_cos(TAU * k as f32 / 8.0);
                Vec3::new(radius * sin, y, radius * cos)
            })
            .collect()
    };
    let roof = loft(&[ring(r, h - 0.42), ring(0.02, h - 0.05)]);
    let post = if d.chance("wood", 0.5) {
        style.wood.clone()
    } else {
        style.metal.clone()
    };
    let body = PartBuilder::new("body")
        .with_filled(
            &stone,
            surface_of_revolution(
                &[
                    (0.0, 0.0),
                    (0.24, 0.0),
                    (0.24, 0.05),
                    (0.06, 0.08),
                    (0.0, 0.08),
                ],
                24,
            ),
            0.5,
        )
        .with_filled(&post, rod([0.0, 0.08, 0.0], [0.0, h, 0.0], 0.02), 0.4)
        .with_filled(cover, roof, 0.008);
    Model::movable("parasol", "umbrella").part(body)
}

/// A grill: a kettle on three legs or a wagon with a hood that opens.
pub fn grill(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("grill", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let enamel = painted_steel(
        "grill_enamel",
        d.of(
            "tone",
            [[34, 34, 36], [130, 34, 38], [60, 80, 70], [168, 171, 175]],
        ),
    );
    let bowl = 0.42 * w.min(depth * 1.2);
    let rim = h - 0.26;
    let mut body = PartBuilder::new("body")
        .with_filled(
            &enamel,
            block([-bowl, rim - 0.16, -0.8 * z], [bowl, rim, 0.8 * z]),
            0.06,
        )
        .with_filled(
            &steel(),
            block(
                [-bowl + 0.02, rim, -0.8 * z + 0.02],
                [bowl - 0.02, rim + 0.006, 0.8 * z - 0.02],
            ),
            0.4,
        )
        .with(
            &style_wood(),
            block(
                [-x, rim - 0.04, -0.6 * z],
                [-bowl - 0.004, rim - 0.015, 0.6 * z],
            ),
        )
        .with(
            &style_wood(),
            block(
                [bowl + 0.004, rim - 0.04, -0.6 * z],
                [x, rim - 0.015, 0.6 * z],
            ),
        );
    for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let (a, b) = (sx * (bowl - 0.03), sz * (0.7 * z));
        body = body.with_filled(
            &black(),
            block(
                [a - 0.018, 0.0, b - 0.018],
                [a + 0.018, rim - 0.16, b + 0.018],
            ),
            0.5,
        );
    }
    let knob = |k: usize| {
        cylinder(0.022, 0.022, 14).about_x(FRAC_PI_2).at(
            -0.5 * bowl + 0.5 * bowl * k as f32,
            rim - 0.1,
            0.8 * z,
        )
    };
    let wheel = |s: f32| {
        cylinder(0.08, 0.03, 18)
            .about_z(FRAC_PI_2)
            .at(s * (bowl + 0.01) + 0.015, 0.08, -0.7 * z)
    };
    let body = body
        .with_filled(
            &black(),
            block(
                [-bowl + 0.015, 0.16, -0.7 * z + 0.018],
                [bowl - 0.015, 0.175, 0.7 * z - 0.018],
            ),
            0.5,
        )
        .with_all(&black(), (0..3).map(knob))
        .with_all(&black(), [wheel(-1.0), wheel(1.0)]);
    let side = [
        [-0.8 * z, 0.0],
        [0.8 * z, 0.0],
        [0.72 * z, 0.12],
        [0.35 * z, 0.24],
        [-0.35 * z, 0.24],
        [-0.72 * z, 0.12],
    ];
    // The profile in (z, y), drawn out along x.
    let hood = crate::shapes::extrude(
        &side
            .map(|[a, y]| [-a, y])
            .iter()
            .rev()
            .copied()
            .collect::<Vec<_>>(),
        2.0 * bowl,
    )
    .about_y(FRAC_PI_2)
    .at(-bowl, rim + 0.01, 0.0);
    let lid = PartBuilder::new("lid")
        .with_filled(&enamel, hood, 0.05)
        .with(
            &steel(),
            rod(
                [-0.6 * bowl, rim + 0.09, 0.8 * z + 0.03],
                [0.6 * bowl, rim + 0.09, 0.8 * z + 0.03],
                0.01,
            ),
        )
        .with(
            &steel(),
            rod(
                [-0.5 * bowl, rim + 0.09, 0.7 * z],
                [-0.5 * bowl, rim + 0.09, 0.8 * z + 0.03],
                0.007,
            )
            .visual_only(),
        )
        .with(
            &steel(),
            rod(
                [0.5 * bowl, rim + 0.09, 0.7 * z],
                [0.5 * bowl, rim + 0.09, 0.8 * z + 0.03],
                0.007,
            )
            .visual_only(),
        );
    Model::articulated("grill", "grill")
        .switched(false)
        .part(body)
        .top(
            "side_table",
            [bowl + 0.01, rim - 0.015, -0.55 * z],
            [x - 0.01, rim + 0.4, 0.55 * z],
        )
        .part(lid)
        .hinged("lid", [0.0, rim + 0.01, -0.8 * z], Vec3::NEG_X, 1.2)
}

/// Oiled slats beside a grill.
const fn style_wood() -> Finish {
    Finish::tiled(
        "grill_wood",
        "wood",
        "wood",
        [[150, 104, 66], [116, 76, 46], [0; 3]],
        0.6,
    )
}

/// A lamp on a post beside a path.
pub fn garden_lamp(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("garden_lamp", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let r = 0.5 * w;
    let iron = painted_steel(
        "lamp_iron",
        d.of("tone", [[36, 38, 38], [70, 80, 76], [150, 150, 152]]),
    );
    let head = h - 1.9 * r;
    let body = PartBuilder::new("body")
        .with_filled(
            &iron,
            surface_of_revolution(
                &[
                    (0.0, 0.0),
                    (0.9 * r, 0.0),
                    (0.7 * r, 0.06),
                    (0.25 * r, 0.12),
                    (0.2 * r, head),
                    (0.0, head),
                ],
                18,
            ),
            0.35,
        )
        .with_filled(&iron, cylinder(0.75 * r, 0.02, 18).at(0.0, head, 0.0), 0.8)
        .with_filled(
            &milk_glass(),
            cylinder(0.65 * r, 1.2 * r, 18).at(0.0, head + 0.02, 0.0),
            0.15,
        )
        .with_filled(
            &iron,
            surface_of_revolution(
                &[(0.0, 0.0), (r, 0.0), (0.35 * r, 0.45 * r), (0.0, 0.6 * r)],
                18,
            )
            .at(0.0, head + 0.02 + 1.2 * r, 0.0),
            0.3,
        );
    Model::fixed("garden_lamp", "outdoor_lamp")
        .switched(true)
        .part(body)
        .with_light([0.0, h + 0.05, 0.0], 8.0)
}

/// A lawn mower with its handle bar to the back (-Z).
pub fn lawn_mower(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("lawn_mower", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let deck = painted_steel(
        "mower_deck",
        d.of(
            "tone",
            [[190, 40, 36], [50, 120, 60], [226, 120, 30], [60, 90, 140]],
        ),
    );
    let wheel = |sx: f32, b: f32| {
        cylinder(0.09, 0.04, 18)
            .about_z(FRAC_PI_2)
            .at(sx * (x - 0.02) + 0.02, 0.09, b)
    };
    let (front, rear) = (z - 0.11, z - 0.62);
    let bag = Finish::plain("grass_bag", "textile", [60, 62, 64]);
    let body = PartBuilder::new("body")
        .with_filled(
            &deck,
            rounded_block(
                [-x + 0.045, 0.06, rear - 0.05],
                [x - 0.045, 0.22, z],
                0.04,
                2,
            ),
            0.1,
        )
        .with_filled(
            &black(),
            cylinder(0.13, 0.14, 20).at(0.0, 0.22, 0.5 * (front + rear) + 0.06),
            0.8,
        )
        .with_all(
            &black(),
            [
                wheel(-1.0, front),
                wheel(1.0, front),
                wheel(-1.0, rear),
                wheel(1.0, rear),
            ],
        )
        .with_filled(
            &bag,
            rounded_block(
                [-x + 0.08, 0.1, rear - 0.5],
                [x - 0.08, 0.4, rear - 0.05],
                0.06,
                2,
            ),
            0.04,
        )
        .with_filled(
            &black(),
            tube(
                &[
                    [-x + 0.06, 0.2, rear],
                    [-x + 0.06, h - 0.012, -z + 0.012],
                    [x - 0.06, h - 0.012, -z + 0.012],
                    [x - 0.06, 0.2, rear],
                ],
                0.012,
                8,
            ),
            0.6,
        );
    Model::movable("lawn_mower", "lawn_mower")
        .switched(false)
        .part(body)
        .with_sound([0.0, 0.3, front], "noise", 88.0)
}

/// A letter box on the wall; its flap turns up. y = 0 is its lower edge.
pub fn letter_box(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("letter_box", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let x = 0.5 * w;
    let paint = painted_steel(
        "letter_box_paint",
        d.of(
            "tone",
            [
                [40, 44, 48],
                [170, 36, 38],
                [226, 190, 60],
                [70, 96, 82],
                [230, 230, 226],
            ],
        ),
    );
    let t = 0.008;
    let face = depth - 0.012;
    let shell = [
        block([-x, 0.0, 0.0], [x, t, face]),
        block([-x, t, 0.0], [-x + t, h - 0.02, face]),
        block([x - t, t, 0.0], [x, h - 0.02, face]),
        block([-x + t, t, 0.0], [x - t, h - 0.02, t]),
        block([-x + t, t, face - t], [x - t, 0.72 * h, face]),
    ];
    let plate = Finish::plain("name_plate", "paper", [236, 234, 226]);
    let body = PartBuilder::new("body")
        .with_filled(
            &paint,
            shell.into_iter().fold(SolidMesh::default(), SolidMesh::and),
            0.15,
        )
        .with(
            &plate,
            block([-0.2 * w, 0.3 * h, face], [0.2 * w, 0.4 * h, face + 0.002]).visual_only(),
        );
    let flap = PartBuilder::new("flap").with_filled(
        &paint,
        block([-x, h - 0.018, 0.004], [x, h, depth]),
        0.3,
    );
    Model::articulated("letter_box", "mailbox")
        .part(body)
        .inside("inside", [-x + t, t, t], [x - t, 0.72 * h, face - t])
        .part(flap)
        .hinged("flap", [0.0, h - 0.018, 0.004], Vec3::NEG_X, 1.2)
}

/// A table for balcony or terrace.
pub fn garden_table(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("garden_table", key);
    let teak = Finish::tiled(
        "teak",
        "wood",
        "wood",
        [[178, 128, 82], [146, 98, 58], [0; 3]],
        0.8,
    );
    let plastic_top = plastic("garden_plastic", [236, 236, 230]);
    let top = if d.chance("plastic", 0.25) {
        plastic_top
    } else {
        teak
    };
    Table {
        name: "garden_table",
        category: "table",
        size_m: [d.m("width"), d.m("depth")],
        height_m: d.m("height"),
        legs: if d.chance("metal", 0.5) {
            style.metal.clone()
        } else {
            top.clone()
        },
        top,
        leg_m: 0.05,
        ..Table::default()
    }
    .build()
}
