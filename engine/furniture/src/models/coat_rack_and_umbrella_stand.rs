//! A coat rack and an umbrella stand.

use super::clothes::CLOTHING_COLORS;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, oak};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{
    axis_rotation, ball, block, cylinder, loft, oval, rod, rounded_block, surface_of_revolution,
    tube, vessel,
};
use crate::style::Style;
use dwell_scene::Pose;
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("coat_rack", "hanger", 29, sample_coat_rack),
    CatalogueEntry::new("umbrella_stand", "umbrella", 196, umbrella_stand),
];

/// A clothes rack on the wall: hooks on a board with a coat and a scarf; y = 0 is the board's middle.
fn coat_rack(width_m: f32, coat: &Finish, scarf: &Finish) -> Model {
    let x = 0.5 * width_m;
    let hook = |k: usize| {
        let at = -x + 0.1 + (width_m - 0.2) * k as f32 / 4.0;
        rod([at, -0.01, 0.02], [at, 0.02, 0.075], 0.006)
            .merged(ball(0.011, 10).translated(at, 0.02, 0.075))
    };
    let at = -x + 0.1 + (width_m - 0.2) * 0.25;
    let ring = |half_x: f32, half_z: f32, y: f32| oval(half_x, half_z, y, 0.026 + half_z, 20);
    let garment = loft(&[
        ring(0.23, 0.055, -1.0),
        ring(0.19, 0.05, -0.55),
        ring(0.2, 0.05, -0.24),
        ring(0.17, 0.04, -0.1),
        ring(0.06, 0.03, -0.03),
        ring(0.05, 0.025, 0.015),
    ]);
    let sleeve = |side: f32| {
        tube(
            &[
                [side * 0.17, -0.13, 0.075],
                [side * 0.23, -0.35, 0.08],
                [side * 0.235, -0.68, 0.09],
            ],
            0.04,
            10,
        )
    };
    let garment = garment
        .merged(sleeve(-1.0).visual_only())
        .merged(sleeve(1.0).visual_only())
        .translated(at, 0.0, 0.0);
    let wrap = -x + 0.1 + (width_m - 0.2) * 0.75;
    let shawl = rounded_block(
        [wrap - 0.05, -0.75, 0.03],
        [wrap + 0.01, 0.02, 0.06],
        0.014,
        1,
    )
    .merged(rounded_block(
        [wrap - 0.005, -0.6, 0.06],
        [wrap + 0.055, 0.02, 0.085],
        0.012,
        1,
    ));
    let body = PartBuilder::new("body")
        .with(&oak(), block([-x, -0.05, 0.0], [x, 0.05, 0.02]))
        .with_all(&black_plastic(), (0..5).map(hook))
        .with_fill_fraction(coat, garment, 0.15)
        .with_fill_fraction(scarf, shawl, 0.3);
    Model::fixed("coat_rack", "hanger").part(body)
}

/// Black hooks.
const BLACK: &Finish = &black_plastic();

fn sample_coat_rack(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("coat_rack", key);
    let tones = [
        [60, 66, 90],
        [120, 84, 60],
        [70, 84, 70],
        [44, 44, 48],
        [150, 60, 60],
    ];
    let coat = crate::finishes::cloth("coat", d.choose("coat", tones));
    let scarf = style.random_cloth(&mut d.stream("scarf"));
    coat_rack(d.sample_m("width"), &coat, scarf)
        .with_finish_replaced("oak", style.random_wood(&mut d.stream("wood")))
        .with_finish_replaced(
            "black_plastic",
            if d.chance("metal", 0.5) {
                &style.metal
            } else {
                BLACK
            },
        )
}

/// A stand with umbrellas.
fn umbrella_stand(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("umbrella_stand", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let r = 0.5 * w;
    let rim = 0.55;
    let shell = vessel(&[(0.0, 0.0), (0.92 * r, 0.0), (r, rim)], 0.006, 22);
    let holder = if d.chance("metal", 0.5) {
        style.metal.clone()
    } else {
        style.random_glaze(&mut d.stream("glaze")).clone()
    };
    let thin = Finish {
        substance: "steel",
        ..holder
    };
    let mut body = PartBuilder::new("body").with_fill_fraction(&thin, shell, 0.2);
    let mut random = d.stream("umbrellas");
    for k in 0..2 {
        let tone = crate::finishes::cloth(
            "umbrella_cloth",
            CLOTHING_COLORS[random.below(CLOTHING_COLORS.len())],
        );
        let side = if k == 0 { -1.0 } else { 1.0 };
        let furled = surface_of_revolution(
            &[
                (0.0, 0.02),
                (0.012, 0.02),
                (0.035, 0.25),
                (0.03, 0.66 * h),
                (0.008, 0.78 * h),
                (0.0, 0.78 * h),
            ],
            12,
        );
        let grip = rod([0.0, 0.78 * h, 0.0], [0.0, h, 0.0], 0.01);
        let lean = axis_rotation(Vec3::Z, -side * 0.05);
        let pose = Pose::new(Vec3::new(side * 0.25 * r, 0.0, 0.1 * r * side), lean);
        body = body
            .with_fill_fraction(&tone, furled.transformed(&pose).visual_only(), 0.15)
            .with(&style.wood, grip.transformed(&pose).visual_only());
    }
    // The bundle is felt as one post.
    let bundle = cylinder(0.45 * r, h - 0.05, 12).collision_only();
    Model::movable("umbrella_stand", "umbrella").part(body.with(&thin, bundle))
}
