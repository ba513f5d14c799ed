//! Vases, empty or with flowers.

use super::plants::fresh_foliage;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::Finish;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{
    SolidMesh, axis_rotation, ball, cylinder, leaf, rod, surface_of_revolution, vessel,
};
use crate::style::Style;
use dwell_scene::Pose;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::TAU;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("flowers", "flowers", 181, flowers),
    CatalogueEntry::new("vase", "vase", 182, sample_vase),
];

/// An empty vase.
fn vase(height_m: f32, glaze: &Finish) -> Model {
    let (h, r) = (height_m, 0.3 * height_m);
    let shell = vessel(
        &[
            (0.0, 0.0),
            (0.6 * r, 0.0),
            (r, 0.35 * h),
            (0.85 * r, 0.6 * h),
            (0.42 * r, 0.88 * h),
            (0.5 * r, h),
        ],
        0.005,
        24,
    );
    let body = PartBuilder::new("body").with(glaze, shell);
    let neck = 0.24 * r;
    Model::pickable("vase", "vase")
        .part(body)
        .with_container_space("inside", [-neck, 0.008, -neck], [neck, h, neck])
}

fn sample_vase(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("vase", key);
    vase(
        d.sample_m("height"),
        style.random_glaze(&mut d.stream("glaze")),
    )
}

/// A bunch of flowers in a vase.
fn flowers(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("flowers", key);
    let (w, h) = (d.sample_m("span"), d.sample_m("height"));
    let petals = [
        [226, 60, 70],
        [244, 206, 70],
        [238, 236, 226],
        [206, 110, 170],
        [240, 150, 60],
        [150, 120, 200],
    ];
    let bloom = Finish::plain("petals", "leaves", d.choose("petals", petals));
    let heart = Finish::plain("flower_heart", "leaves", [222, 176, 50]);
    let stem = fresh_foliage();
    let r = 0.26 * w;
    let pot = 0.45 * h;
    let glaze = style.random_glaze(&mut d.stream("glaze"));
    let shell = vessel(
        &[
            (0.0, 0.0),
            (0.7 * r, 0.0),
            (r, 0.4 * pot),
            (0.55 * r, 0.85 * pot),
            (0.7 * r, pot),
        ],
        0.005,
        20,
    );
    let mut random = d.stream("stems");
    let mut body = PartBuilder::new("body").with(glaze, shell);
    let mut crown = SolidMesh::default();
    for k in 0..9 {
        let (sin, cos) = dwell_scene::math::sin_cos(TAU * 0.381_966 * k as f32);
        let out = (0.5 * w - 0.03) * ((k as f32 + 0.5) / 9.0).sqrt();
        let top = Vec3::new(
            out * sin,
            h - 0.03 - 0.35 * out - random.range(0.0, 0.04),
            out * cos,
        );
        let foot = Vec3::new(0.2 * r * sin, 0.7 * pot, 0.2 * r * cos);
        body = body.with(
            &stem,
            rod(foot.to_array(), top.to_array(), 0.002).visual_only(),
        );
        crown = crown.merged(
            surface_of_revolution(
                &[
                    (0.0, -0.012),
                    (0.018, -0.006),
                    (0.028, 0.008),
                    (0.02, 0.014),
                    (0.0, 0.01),
                ],
                8,
            )
            .translated(top.x, top.y, top.z)
            .visual_only(),
        );
        body = body.with(
            &heart,
            ball(0.007, 6)
                .translated(top.x, top.y + 0.012, top.z)
                .visual_only(),
        );
        if k % 2 == 0 {
            let pose = Pose::new(
                foot + Vec3::Y * 0.35 * pot,
                axis_rotation(Vec3::Y, TAU * 0.381_966 * k as f32) * axis_rotation(Vec3::X, -0.7),
            );
            body = body.with(&stem, leaf(0.11, 0.03, 0.5).transformed(&pose));
        }
    }
    // What is felt of the bunch: a slim post.
    crown.colliders = cylinder(0.3 * w, 0.3 * h, 8)
        .translated(0.0, 0.6 * h, 0.0)
        .colliders;
    Model::pickable("flowers", "flowers").part(body.with_fill_fraction(&bloom, crown, 0.3))
}
