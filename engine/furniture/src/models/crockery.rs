//! Mugs, plates, bowls, jugs and teapots.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, glass};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{ball, cylinder, surface_of_revolution, tube, vessel};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("mug", "cup", 153, sample_mug),
    CatalogueEntry::new("plate", "plate", 154, sample_plate),
    CatalogueEntry::new("bowl", "bowl", 155, sample_bowl),
    CatalogueEntry::new("jug", "jug", 160, jug),
    CatalogueEntry::new("teapot", "teapot", 161, teapot),
];

/// A mug with a handle.
fn mug(glaze: &Finish) -> Model {
    let cup = vessel(
        &[(0.0, 0.0), (0.034, 0.0), (0.041, 0.012), (0.041, 0.095)],
        0.004,
        20,
    );
    let grip = tube(
        &[
            [0.038, 0.075, 0.0],
            [0.062, 0.072, 0.0],
            [0.07, 0.05, 0.0],
            [0.06, 0.028, 0.0],
            [0.038, 0.024, 0.0],
        ],
        0.005,
        8,
    );
    Model::pickable("mug", "cup")
        .part(PartBuilder::new("body").with(glaze, cup).with(glaze, grip))
        .with_container_space("inside", [-0.025, 0.005, -0.025], [0.025, 0.095, 0.025])
}

fn sample_mug(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("mug", key);
    mug(style.random_glaze(&mut d.stream("glaze"))).resized(d.sample_m("height") / 0.095)
}

/// A flat plate.
fn plate(radius_m: f32, glaze: &Finish) -> Model {
    let r = radius_m;
    let profile = [
        (0.0, 0.0),
        (0.58 * r, 0.0),
        (r, 0.018),
        (r, 0.022),
        (0.6 * r, 0.0055),
        (0.0, 0.0055),
    ];
    Model::pickable("plate", "plate")
        .part(PartBuilder::new("body").with(glaze, plate_solid(&profile, r)))
        .with_support_surface(
            "top",
            [-0.45 * r, 0.0055, -0.45 * r],
            [0.45 * r, 0.12, 0.45 * r],
        )
}

/// A plate collides as a flat disc with a thin rim of wedges, so that things can lie in it.
fn plate_solid(profile: &[(f32, f32)], radius_m: f32) -> crate::shapes::SolidMesh {
    let mut solid = surface_of_revolution(profile, 28);
    let disc = cylinder(0.58 * radius_m, 0.0055, 8);
    let rim = vessel(
        &[(0.0, 0.0), (0.58 * radius_m, 0.0), (radius_m, 0.021)],
        0.005,
        8,
    );
    solid.colliders = disc.colliders;
    solid.colliders.extend(rim.colliders.into_iter().skip(1));
    solid
}

fn sample_plate(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("plate", key);
    plate(
        0.5 * d.sample_m("width"),
        style.random_glaze(&mut d.stream("glaze")),
    )
}

/// A bowl.
fn bowl(radius_m: f32, glaze: &Finish) -> Model {
    let r = radius_m;
    let shell = vessel(
        &[
            (0.0, 0.0),
            (0.55 * r, 0.0),
            (0.85 * r, 0.22 * r),
            (r, 0.62 * r),
        ],
        0.005,
        26,
    );
    Model::pickable("bowl", "bowl")
        .part(PartBuilder::new("body").with(glaze, shell))
        .with_container_space(
            "inside",
            [-0.3 * r, 0.005, -0.3 * r],
            [0.3 * r, 0.62 * r, 0.3 * r],
        )
}

fn sample_bowl(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bowl", key);
    bowl(
        0.5 * d.sample_m("width"),
        style.random_glaze(&mut d.stream("glaze")),
    )
}

/// A jug for water or milk.
fn jug(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("jug", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let clear = d.chance("glass", 0.5);
    let stuff = if clear {
        glass()
    } else {
        style.random_glaze(&mut d.stream("glaze")).clone()
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
        .with(&stuff, grip.translated(-0.03 * w, 0.0, 0.0));
    if clear {
        let water = Finish::plain("drinking_water", "water", [170, 206, 222]).transparent(0.35);
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
        body = body.with_fill_fraction(&water, fill.visual_only(), 0.3);
    }
    Model::pickable("jug", "jug").part(body)
}

/// A teapot with spout, handle and lid.
fn teapot(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("teapot", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let glaze = style.random_glaze(&mut d.stream("glaze"));
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
        .with_fill_fraction(glaze, pot, 0.25)
        .with(glaze, spout)
        .with(glaze, grip)
        .with_fill_fraction(
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
        .with(glaze, ball(0.05 * h, 10).translated(0.0, 0.945 * h, 0.0));
    Model::pickable("teapot", "teapot").part(body)
}
