//! Folded clothes, shoes and helmets.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, leather, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{loft, oval, rounded_block, surface_of_revolution};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("helmet", "helmet", 139, helmet),
    CatalogueEntry::new("shoes", "shoes", 192, sample_shoes),
    CatalogueEntry::new("folded_clothes", "cloth", 193, folded_clothes),
];

/// Colours of clothes and of other things that owners choose one by one.
pub(super) const CLOTHING_COLORS: [[u8; 3]; 8] = [
    [56, 66, 92],
    [150, 42, 46],
    [232, 230, 224],
    [90, 110, 84],
    [44, 44, 48],
    [196, 160, 92],
    [120, 150, 180],
    [176, 120, 140],
];

/// A folded shirt or pullover.
fn folded_clothes(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("folded_clothes", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let count = ((h / 0.03).round() as usize).clamp(1, 4);
    let each = h / count as f32;
    let mut random = d.stream("tones");
    let mut body = PartBuilder::new("body");
    for k in 0..count {
        let tone = CLOTHING_COLORS[random.below(CLOTHING_COLORS.len())];
        let slack = random.range(0.0, 0.012);
        let y = each * k as f32;
        let fold = rounded_block(
            [-x + slack, y, -z],
            [x, y + each, z - slack],
            0.45 * each,
            2,
        );
        body = body.with_fill_fraction(&crate::finishes::cloth("garment", tone), fold, 0.35);
    }
    Model::pickable("folded_clothes", "cloth").part(body)
}

/// A pair of shoes side by side.
fn shoes(hide: &Finish) -> Model {
    let sole = plastic("sole", [60, 52, 46]);
    let inside = plastic("shoe_lining", [30, 28, 28]);
    let mut body = PartBuilder::new("body");
    for x in [-0.06, 0.06] {
        let outline = |half_x: f32, half_z: f32, y: f32, z: f32| oval(half_x, half_z, y, z, 20);
        let foot = loft(&[
            outline(0.044, 0.14, 0.0, 0.0),
            outline(0.046, 0.143, 0.016, 0.0),
        ]);
        let upper = loft(&[
            outline(0.043, 0.138, 0.016, 0.0),
            outline(0.042, 0.13, 0.045, -0.006),
            outline(0.037, 0.096, 0.068, -0.038),
            outline(0.033, 0.062, 0.1, -0.07),
        ]);
        let opening = loft(&[
            outline(0.027, 0.054, 0.1, -0.07),
            outline(0.027, 0.054, 0.1006, -0.07),
        ]);
        body = body
            .with_fill_fraction(hide, upper.translated(x, 0.0, 0.0), 0.3)
            .with(&inside, opening.translated(x, 0.0, 0.0).visual_only())
            .with_fill_fraction(&sole, foot.translated(x, 0.0, 0.0), 0.6);
    }
    Model::pickable("shoes", "shoes").part(body)
}

fn sample_shoes(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("shoes", key);
    let hide = leather(
        "shoe_leather",
        d.choose(
            "hide",
            [
                [104, 62, 38],
                [36, 34, 34],
                [226, 224, 218],
                [60, 74, 104],
                [150, 50, 48],
            ],
        ),
    );
    shoes(&hide).resized(d.sample_m("depth") / 0.29)
}

/// A helmet for a cyclist.
fn helmet(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("helmet", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let shell = plastic("helmet_shell", d.choose("tone", CLOTHING_COLORS));
    let stretch = depth / w;
    let mut dome = surface_of_revolution(
        &[
            (0.0, 0.0),
            (0.5 * w, 0.0),
            (0.5 * w, 0.25 * h),
            (0.42 * w, 0.62 * h),
            (0.24 * w, 0.9 * h),
            (0.0, h),
        ],
        24,
    );
    for p in &mut dome.mesh.positions {
        p.z *= stretch;
    }
    for n in &mut dome.mesh.normals {
        *n = Vec3::new(n.x, n.y, n.z / stretch).normalize_or(Vec3::Y);
    }
    dome.colliders = vec![dwell_scene::Collider::Hull {
        points: dome.mesh.positions.iter().copied().step_by(3).collect(),
    }];
    let vent = |a: f32| {
        rounded_block(
            [a - 0.012, 0.84 * h, -0.2 * depth],
            [a + 0.012, 0.945 * h, 0.28 * depth],
            0.008,
            1,
        )
        .visual_only()
    };
    let body = PartBuilder::new("body")
        .with_fill_fraction(&shell, dome, 0.05)
        .with_all(&black_plastic(), [vent(-0.13 * w), vent(0.13 * w)]);
    Model::pickable("helmet", "helmet").part(body)
}
