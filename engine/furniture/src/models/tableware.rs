//! What stands on a laid table: teapot, jug, beer, wine glass, bowl of fruit, tray, cake, place setting.

use super::food::{green_skin, orange_skin, red_skin};
use crate::finishes::{Finish, glass, paper, plastic, steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{ball, block, cylinder, rod, surface_of_revolution, trough, tube, vessel};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::TAU;

/// A teapot with spout, handle and lid.
pub fn teapot(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("teapot", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let glaze = style.glaze(&mut d.stream("glaze"));
    let (r, top) = (0.31 * w, 0.82 * h);
    let pot = surface_of_revolution(
        &[
            (0.0, 0.0),
            (0.62 * r, 0.0),
            (0.66 * r, 0.05 * h),
            (r, 0.38 * h),
            (0.92 * r, 0.6 * h),
            (0.5 * r, top),
            (0.0, top),
        ],
        24,
    );
    let spout = tube(
        &[
            [0.8 * r, 0.25 * h, 0.0],
            [1.25 * r, 0.42 * h, 0.0],
            [0.5 * w - 0.006, 0.75 * h, 0.0],
        ],
        0.011,
        10,
    );
    let grip = tube(
        &[
            [-0.75 * r, 0.68 * h, 0.0],
            [-1.35 * r, 0.7 * h, 0.0],
            [-0.5 * w + 0.006, 0.5 * h, 0.0],
            [-1.3 * r, 0.25 * h, 0.0],
            [-0.85 * r, 0.22 * h, 0.0],
        ],
        0.006,
        8,
    );
    let body = PartBuilder::new("body")
        .with_filled(glaze, pot, 0.25)
        .with(glaze, spout)
        .with(glaze, grip)
        .with_filled(
            glaze,
            surface_of_revolution(
                &[
                    (0.0, top),
                    (0.52 * r, top),
                    (0.3 * r, 0.9 * h),
                    (0.0, 0.9 * h),
                ],
                20,
            ),
            0.4,
        )
        .with(glaze, ball(0.05 * h, 10).at(0.0, 0.945 * h, 0.0));
    Model::pickable("teapot", "teapot").part(body)
}

/// A jug for water or milk.
pub fn jug(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("jug", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let clear = d.chance("glass", 0.5);
    let stuff = if clear {
        glass()
    } else {
        style.glaze(&mut d.stream("glaze")).clone()
    };
    let r = 0.4 * w;
    let shell = vessel(
        &[
            (0.0, 0.0),
            (0.8 * r, 0.0),
            (r, 0.35 * h),
            (0.72 * r, 0.75 * h),
            (0.82 * r, h),
        ],
        0.004,
        24,
    );
    let grip = tube(
        &[
            [-0.66 * r, 0.82 * h, 0.0],
            [-0.6 * w + 0.1 * w, 0.8 * h, 0.0],
            [-0.5 * w + 0.005, 0.55 * h, 0.0],
            [-0.9 * r, 0.32 * h, 0.0],
        ],
        0.006,
        8,
    );
    let mut body = PartBuilder::new("body")
        .with(&stuff, shell)
        .with(&stuff, grip.at(-0.03 * w, 0.0, 0.0));
    if clear {
        let water = Finish::plain("drinking_water", "water", [170, 206, 222]).clear(0.35);
        let fill = surface_of_revolution(
            &[
                (0.0, 0.005),
                (0.76 * r, 0.005),
                (0.95 * r, 0.35 * h),
                (0.85 * r, 0.52 * h),
                (0.0, 0.52 * h),
            ],
            20,
        );
        body = body.with_filled(&water, fill.visual_only(), 0.3);
    }
    Model::pickable("jug", "jug").part(body)
}

/// A bottle of beer.
pub fn beer(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("beer", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let r = 0.5 * w;
    let brown = Finish {
        srgb: d.of("glass", [[104, 60, 26], [50, 96, 56], [196, 200, 190]]),
        ..glass()
    }
    .clear(0.75);
    let label = paper(
        "beer_label",
        d.of(
            "label",
            [
                [232, 220, 180],
                [190, 40, 40],
                [40, 80, 140],
                [236, 236, 230],
            ],
        ),
    );
    let shape = surface_of_revolution(
        &[
            (0.0, 0.0),
            (r, 0.0),
            (r, 0.55 * h),
            (0.8 * r, 0.65 * h),
            (0.42 * r, 0.76 * h),
            (0.38 * r, 0.96 * h),
            (0.0, 0.96 * h),
        ],
        18,
    );
    let band = surface_of_revolution(
        &[
            (1.005 * r, 0.15 * h),
            (1.02 * r, 0.15 * h),
            (1.02 * r, 0.42 * h),
            (1.005 * r, 0.42 * h),
            (1.005 * r, 0.15 * h),
        ],
        18,
    );
    let body = PartBuilder::new("body")
        .with_filled(&brown, shape, 0.55)
        .with(&label, band.visual_only())
        .with(
            &steel(),
            cylinder(0.45 * r, 0.04 * h, 12).at(0.0, 0.96 * h, 0.0),
        );
    Model::pickable("beer", "beer").part(body)
}

/// A wine glass on its stem.
pub fn wine_glass(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("wine_glass", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let r = 0.5 * w;
    let foot = surface_of_revolution(
        &[
            (0.0, 0.0),
            (0.86 * r, 0.0),
            (0.86 * r, 0.003),
            (0.12 * r, 0.01),
            (0.1 * r, 0.45 * h),
            (0.0, 0.45 * h),
        ],
        20,
    );
    let cup = vessel(
        &[
            (0.0, 0.0),
            (0.35 * r, 0.0),
            (0.9 * r, 0.15 * h),
            (r, 0.3 * h),
            (0.8 * r, 0.55 * h),
        ],
        0.002,
        20,
    );
    let body = PartBuilder::new("body")
        .with(&glass(), foot)
        .with(&glass(), cup.at(0.0, 0.45 * h, 0.0));
    let half = 0.3 * r;
    Model::pickable("wine_glass", "drinking_glass")
        .part(body)
        .inside("inside", [-half, 0.46 * h, -half], [half, h, half])
}

/// A jar for flour, tea or sweets; its lid turns up on a clip at the back.
pub fn clip_jar(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("clip_jar", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let (r, rim) = (0.5 * w, 0.86 * h);
    let stuff = if d.chance("glass", 0.5) {
        glass()
    } else {
        style.glaze(&mut d.stream("glaze")).clone()
    };
    let cover = if d.chance("wood", 0.5) {
        style.wood.clone()
    } else {
        stuff.clone()
    };
    let shell = vessel(
        &[
            (0.0, 0.0),
            (0.94 * r, 0.0),
            (r, 0.06 * h),
            (r, 0.97 * rim),
            (0.96 * r, rim),
        ],
        0.004,
        22,
    );
    let clip = block([-0.012, 0.9 * rim, -r - 0.006], [0.012, rim, -r]);
    let body = PartBuilder::new("body")
        .with(&stuff, shell)
        .with(&steel(), clip);
    let lid = PartBuilder::new("lid")
        .with(&cover, cylinder(r, 0.09 * h, 22).at(0.0, rim + 0.001, 0.0))
        .with(
            &cover,
            cylinder(0.25 * r, 0.045 * h, 14).at(0.0, 0.955 * h, 0.0),
        );
    let half = 0.6 * r;
    Model::pickable("clip_jar", "containers")
        .part(body)
        .inside("inside", [-half, 0.006, -half], [half, rim, half])
        .part(lid)
        .hinged("lid", [0.0, rim + 0.001, -r], Vec3::NEG_X, 1.5)
}

/// A bowl heaped with fruit.
pub fn fruit_bowl(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("fruit_bowl", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let r = 0.5 * w;
    let rim = 0.6 * h;
    let glaze = style.glaze(&mut d.stream("glaze"));
    let shell = vessel(
        &[(0.0, 0.0), (0.5 * r, 0.0), (0.86 * r, 0.4 * rim), (r, rim)],
        0.006,
        24,
    );
    let skins = [red_skin(), green_skin(), orange_skin()];
    let banana = plastic("banana_skin", [232, 200, 70]);
    let banana = Finish {
        substance: "food",
        ..banana
    };
    let size = 0.036;
    let mut random = d.stream("fruit");
    let mut body = PartBuilder::new("body").with(glaze, shell);
    for k in 0..6 {
        let (sin, cos) = dwell_scene::math::sin_cos(TAU * k as f32 / 6.0);
        let out = 0.52 * r;
        let skin = &skins[random.below(3)];
        body = body.with_filled(
            skin,
            ball(size, 12).at(out * sin, rim - 0.2 * size, out * cos),
            0.9,
        );
    }
    let top = ball(size, 12).at(0.0, h - size, 0.0);
    body = body.with_filled(&skins[random.below(3)], top, 0.9);
    if d.chance("bananas", 0.5) {
        for side in [-0.5_f32, 0.5] {
            let z = side * 0.036;
            let long = tube(
                &[
                    [-0.09, h - 0.02, z],
                    [-0.03, h - 0.045, z],
                    [0.04, h - 0.045, z],
                    [0.09, h - 0.02, z],
                ],
                0.015,
                8,
            );
            body = body.with_filled(&banana, long.visual_only(), 0.9);
        }
    }
    Model::movable("fruit_bowl", "fruit_bowl").part(body)
}

/// A tray with two grips.
pub fn tray(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("tray", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let stuff = match d.below("build", 3) {
        0 => style.wood.clone(),
        1 => plastic(
            "tray_plastic",
            d.of(
                "tone",
                [
                    [60, 62, 66],
                    [200, 70, 60],
                    [120, 160, 150],
                    [236, 230, 216],
                ],
            ),
        ),
        _ => Finish {
            substance: "wood",
            ..style.second_wood.clone()
        },
    };
    let grip = |s: f32| {
        rod(
            [s * (x - 0.014), h + 0.014, -0.06],
            [s * (x - 0.014), h + 0.014, 0.06],
            0.006,
        )
        .and([-0.055_f32, 0.055].into_iter().fold(
            crate::shapes::SolidMesh::default(),
            |all, b| {
                all.and(
                    rod(
                        [s * (x - 0.014), h - 0.01, b],
                        [s * (x - 0.014), h + 0.014, b],
                        0.005,
                    )
                    .visual_only(),
                )
            },
        ))
    };
    let body = PartBuilder::new("body")
        .with(&stuff, trough([-x, 0.0, -z], [x, h, z], 0.008))
        .with_all(&style.metal, [grip(-1.0), grip(1.0)]);
    Model::pickable("tray", "food_tray").part(body).top(
        "inside",
        [-x + 0.03, 0.008, -z + 0.012],
        [x - 0.03, 0.25, z - 0.012],
    )
}

/// A cake on a stand, a slice taken out.
pub fn cake(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("cake", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let (r, stand) = (0.5 * w, 0.35 * h);
    let (icing, crumb) = d.of(
        "kind",
        [
            ([92, 54, 38], [70, 40, 28]),
            ([244, 232, 222], [226, 186, 120]),
            ([238, 170, 186], [232, 200, 140]),
            ([240, 214, 110], [226, 186, 120]),
        ],
    );
    let (icing, crumb) = (
        Finish::plain("icing", "food", icing),
        Finish::plain("sponge_cake", "food", crumb),
    );
    let cherry = Finish::plain("cherry", "food", [176, 24, 40]);
    let cr = 0.82 * r;
    let low = stand + 0.008;
    // Seven eighths of a round cake, as wedges in the (x, y) plane laid flat.
    let wedge = |k: usize, radius: f32, tall: f32| {
        let at = |j: usize| {
            let (sin, cos) = dwell_scene::math::sin_cos(TAU * j as f32 / 24.0);
            [radius * cos, radius * sin]
        };
        let mut points = vec![[0.0, 0.0]];
        points.extend((3 * k..=3 * k + 3).map(at));
        crate::shapes::extrude(&points, tall).about_x(-std::f32::consts::FRAC_PI_2)
    };
    let (lower, upper) = (0.6 * (h - low - 0.02), 0.4 * (h - low - 0.02));
    let glaze = style.glaze(&mut d.stream("glaze"));
    let mut body = PartBuilder::new("body")
        .with_filled(
            glaze,
            surface_of_revolution(
                &[
                    (0.0, 0.0),
                    (0.5 * r, 0.0),
                    (0.12 * r, 0.3 * stand),
                    (0.14 * r, stand),
                    (0.0, stand),
                ],
                20,
            ),
            0.6,
        )
        .with(glaze, cylinder(r, 0.008, 28).at(0.0, stand, 0.0));
    for k in 0..7 {
        body = body
            .with(&crumb, wedge(k, 0.985 * cr, lower).at(0.0, low, 0.0))
            .with(&icing, wedge(k, cr, upper).at(0.0, low + lower, 0.0));
        let (sin, cos) = dwell_scene::math::sin_cos(TAU * (k as f32 + 0.5) / 8.0);
        body = body.with(
            &cherry,
            ball(0.011, 8)
                .at(0.75 * cr * cos, h - 0.012, -0.75 * cr * sin)
                .visual_only(),
        );
    }
    Model::movable("cake", "cake").part(body)
}

/// A place laid for one: mat, plate, knife, fork, folded napkin.
pub fn place_setting(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("place_setting", key);
    let (w, depth) = (d.m("width"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let mat = style.cloth(&mut d.stream("mat"));
    let napkin = &style.cloths[d.below("napkin", style.cloths.len())];
    let glaze = style.glaze(&mut d.stream("glaze"));
    let r = 0.3 * w;
    let dish = surface_of_revolution(
        &[
            (0.0, 0.003),
            (0.58 * r, 0.003),
            (r, 0.021),
            (r, 0.025),
            (0.6 * r, 0.0085),
            (0.0, 0.0085),
        ],
        24,
    );
    let tool = |a: f32, wide: f32| {
        block([a - 0.006, 0.003, -0.02], [a + 0.006, 0.0065, 0.1])
            .and(block([a - wide, 0.003, -0.1], [a + wide, 0.006, -0.02]))
    };
    let body = PartBuilder::new("body")
        .with(mat, block([-x, 0.0, -z], [x, 0.003, z]))
        .with(glaze, dish)
        .with(&steel(), tool(0.82 * x, 0.009))
        .with(&steel(), tool(-0.82 * x, 0.012))
        .with(
            napkin,
            block([-0.97 * x, 0.003, -0.6 * z], [-0.89 * x, 0.012, 0.6 * z]),
        );
    Model::movable("place_setting", "place_setting").part(body)
}
