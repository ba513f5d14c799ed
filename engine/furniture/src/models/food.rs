//! Fruit, bread and cake.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{ball, cylinder, rod, rounded_block, surface_of_revolution, tube, vessel};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::TAU;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("fruit_bowl", "fruit_bowl", 174, fruit_bowl),
    CatalogueEntry::new("fruit", "food", 175, sample_fruit),
    CatalogueEntry::new("bread", "bread", 176, sample_bread),
    CatalogueEntry::new("cake", "cake", 177, cake),
];

/// An apple, a pear or an orange: a round fruit with a stalk; its colours are ground, blush, freckle.
fn fruit(radius_m: f32, skin: &Finish) -> Model {
    let r = radius_m;
    let shape = [
        (0.0, 0.06 * r),
        (0.3 * r, 0.0),
        (0.62 * r, 0.12 * r),
        (0.92 * r, 0.55 * r),
        (r, 1.0 * r),
        (0.9 * r, 1.45 * r),
        (0.55 * r, 1.76 * r),
        (0.25 * r, 1.78 * r),
        (0.0, 1.62 * r),
    ];
    let stalk = Finish::plain("stalk", "wood", [94, 66, 40]);
    let body = PartBuilder::new("body")
        .with(skin, surface_of_revolution(&shape, 16))
        .with(
            &stalk,
            rod([0.0, 1.6 * r, 0.0], [0.1 * r, 2.1 * r, 0.0], 0.0018).visual_only(),
        );
    Model::pickable("fruit", "food").part(body)
}

/// Skin of a red apple.
const fn red_skin() -> Finish {
    Finish::tiled(
        "red_apple",
        "food",
        "peel",
        [[186, 36, 38], [226, 172, 70], [236, 196, 120]],
        0.2,
    )
}

/// Skin of a green apple.
const fn green_skin() -> Finish {
    Finish::tiled(
        "green_apple",
        "food",
        "peel",
        [[138, 176, 58], [192, 204, 96], [226, 226, 150]],
        0.2,
    )
}

/// Skin of an orange.
const fn orange_skin() -> Finish {
    Finish::tiled(
        "orange_peel",
        "food",
        "peel",
        [[238, 140, 30], [244, 158, 52], [206, 108, 20]],
        0.2,
    )
}

fn sample_fruit(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("fruit", key);
    let skins = [red_skin(), green_skin(), orange_skin()];
    fruit(0.5 * d.sample_m("width"), &skins[d.below("skin", 3)])
}

/// A bowl heaped with fruit.
fn fruit_bowl(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("fruit_bowl", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let r = 0.5 * w;
    let rim = 0.6 * h;
    let glaze = style.random_glaze(&mut d.stream("glaze"));
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
        body = body.with_fill_fraction(
            skin,
            ball(size, 12).translated(out * sin, rim - 0.2 * size, out * cos),
            0.9,
        );
    }
    let top = ball(size, 12).translated(0.0, h - size, 0.0);
    body = body.with_fill_fraction(&skins[random.below(3)], top, 0.9);
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
            body = body.with_fill_fraction(&banana, long.visual_only(), 0.9);
        }
    }
    Model::movable("fruit_bowl", "fruit_bowl").part(body)
}

/// A loaf of bread.
fn bread() -> Model {
    let crust = Finish::tiled(
        "crust",
        "food",
        "peel",
        [[178, 118, 62], [150, 92, 46], [214, 168, 110]],
        0.15,
    );
    Model::pickable("bread", "bread").part(PartBuilder::new("body").with(
        &crust,
        rounded_block([-0.13, 0.0, -0.055], [0.13, 0.1, 0.055], 0.045, 3),
    ))
}

fn sample_bread(_style: &Style, key: RandomKey) -> Model {
    bread().resized(SizeSampler::new("bread", key).sample_m("width") / 0.26)
}

/// A cake on a stand, a slice taken out.
fn cake(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("cake", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let (r, stand) = (0.5 * w, 0.35 * h);
    let (icing, crumb) = d.choose(
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
        crate::shapes::extrude(&points, tall).rotated_x(-std::f32::consts::FRAC_PI_2)
    };
    let (lower, upper) = (0.6 * (h - low - 0.02), 0.4 * (h - low - 0.02));
    let glaze = style.random_glaze(&mut d.stream("glaze"));
    let mut body = PartBuilder::new("body")
        .with_fill_fraction(
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
        .with(glaze, cylinder(r, 0.008, 28).translated(0.0, stand, 0.0));
    for k in 0..7 {
        body = body
            .with(
                &crumb,
                wedge(k, 0.985 * cr, lower).translated(0.0, low, 0.0),
            )
            .with(
                &icing,
                wedge(k, cr, upper).translated(0.0, low + lower, 0.0),
            );
        let (sin, cos) = dwell_scene::math::sin_cos(TAU * (k as f32 + 0.5) / 8.0);
        body = body.with(
            &cherry,
            ball(0.011, 8)
                .translated(0.75 * cr * cos, h - 0.012, -0.75 * cr * sin)
                .visual_only(),
        );
    }
    Model::movable("cake", "cake").part(body)
}
