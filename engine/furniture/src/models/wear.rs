//! Clothes, bags, umbrellas, helmets, flowers, papers, small ornaments.

use crate::finishes::{Finish, black, paper, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{
    SolidMesh, ball, block, cylinder, leaf, panel, rod, rounded_block, surface_of_revolution, turn,
    vessel,
};
use crate::style::Style;
use dwell_scene::Pose;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::{FRAC_PI_2, TAU};

/// Colours of clothes and of other things that owners choose one by one.
const WORN: [[u8; 3]; 8] = [
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
pub fn folded_clothes(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("folded_clothes", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let count = ((h / 0.03).round() as usize).clamp(1, 4);
    let each = h / count as f32;
    let mut random = d.stream("tones");
    let mut body = PartBuilder::new("body");
    for k in 0..count {
        let tone = WORN[random.below(WORN.len())];
        let slack = random.range(0.0, 0.012);
        let y = each * k as f32;
        let fold = rounded_block(
            [-x + slack, y, -z],
            [x, y + each, z - slack],
            0.45 * each,
            2,
        );
        body = body.with_filled(&crate::finishes::cloth("garment", tone), fold, 0.35);
    }
    Model::pickable("folded_clothes", "cloth").part(body)
}

/// A helmet for a cyclist.
pub fn helmet(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("helmet", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let shell = plastic("helmet_shell", d.of("tone", WORN));
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
        .with_filled(&shell, dome, 0.05)
        .with_all(&black(), [vent(-0.13 * w), vent(0.13 * w)]);
    Model::pickable("helmet", "helmet").part(body)
}

/// A backpack standing on the floor.
pub fn backpack(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("backpack", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let cloth = crate::finishes::cloth("backpack_cloth", d.of("tone", WORN));
    let strap = Finish {
        srgb: cloth.srgb.map(|c| (f32::from(c) * 0.6) as u8),
        ..cloth.clone()
    };
    let belt = |s: f32| {
        rounded_block(
            [s * 0.45 * x - 0.025, 0.12, -z],
            [s * 0.45 * x + 0.025, 0.86 * h, -z + 0.02],
            0.008,
            1,
        )
    };
    let body = PartBuilder::new("body")
        .with_filled(
            &cloth,
            rounded_block([-x, 0.0, -z + 0.02], [x, h - 0.03, 0.35 * z], 0.07, 3),
            0.04,
        )
        .with_filled(
            &cloth,
            rounded_block([-0.8 * x, 0.02, 0.3 * z], [0.8 * x, 0.5 * h, z], 0.04, 2),
            0.04,
        )
        .with(
            &strap,
            block(
                [-0.6 * x, 0.4 * h, z - 0.004],
                [0.6 * x, 0.41 * h, z + 0.001],
            )
            .visual_only(),
        )
        .with_all(&strap, [belt(-1.0), belt(1.0)])
        .with(
            &strap,
            rounded_block([-0.03, h - 0.05, -z + 0.03], [0.03, h, -z + 0.05], 0.008, 1),
        );
    Model::pickable("backpack", "bag").part(body)
}

/// A stand with umbrellas.
pub fn umbrella_stand(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("umbrella_stand", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let r = 0.5 * w;
    let rim = 0.55;
    let shell = vessel(&[(0.0, 0.0), (0.92 * r, 0.0), (r, rim)], 0.006, 22);
    let holder = if d.chance("metal", 0.5) {
        style.metal.clone()
    } else {
        style.glaze(&mut d.stream("glaze")).clone()
    };
    let thin = Finish {
        substance: "steel",
        ..holder
    };
    let mut body = PartBuilder::new("body").with_filled(&thin, shell, 0.2);
    let mut random = d.stream("umbrellas");
    for k in 0..2 {
        let tone = crate::finishes::cloth("umbrella_cloth", WORN[random.below(WORN.len())]);
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
        let lean = turn(Vec3::Z, -side * 0.05);
        let pose = Pose::new(Vec3::new(side * 0.25 * r, 0.0, 0.1 * r * side), lean);
        body = body
            .with_filled(&tone, furled.placed(&pose).visual_only(), 0.15)
            .with(&style.wood, grip.placed(&pose).visual_only());
    }
    // The bundle is felt as one post.
    let bundle = cylinder(0.45 * r, h - 0.05, 12).collision_only();
    Model::movable("umbrella_stand", "umbrella").part(body.with(&thin, bundle))
}

/// A bunch of flowers in a vase, or lying in paper where `loose`.
pub fn flowers(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("flowers", key);
    let (w, h) = (d.m("span"), d.m("height"));
    let petals = [
        [226, 60, 70],
        [244, 206, 70],
        [238, 236, 226],
        [206, 110, 170],
        [240, 150, 60],
        [150, 120, 200],
    ];
    let bloom = Finish::plain("petals", "leaves", d.of("petals", petals));
    let heart = Finish::plain("flower_heart", "leaves", [222, 176, 50]);
    let stem = crate::models::plants::fresh_green();
    let r = 0.26 * w;
    let pot = 0.45 * h;
    let glaze = style.glaze(&mut d.stream("glaze"));
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
        crown = crown.and(
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
            .at(top.x, top.y, top.z)
            .visual_only(),
        );
        body = body.with(
            &heart,
            ball(0.007, 6).at(top.x, top.y + 0.012, top.z).visual_only(),
        );
        if k % 2 == 0 {
            let pose = Pose::new(
                foot + Vec3::Y * 0.35 * pot,
                turn(Vec3::Y, TAU * 0.381_966 * k as f32) * turn(Vec3::X, -0.7),
            );
            body = body.with(&stem, leaf(0.11, 0.03, 0.5).placed(&pose));
        }
    }
    // What is felt of the bunch: a slim post.
    crown.colliders = cylinder(0.3 * w, 0.3 * h, 8)
        .at(0.0, 0.6 * h, 0.0)
        .colliders;
    Model::pickable("flowers", "flowers").part(body.with_filled(&bloom, crown, 0.3))
}

/// A few sheets of paper.
pub fn papers(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("papers", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let white = paper("white_sheet", [246, 246, 242]);
    let ink = Finish::picture(
        "printed_sheet",
        "paper",
        "pages",
        [[244, 244, 240], [70, 70, 76], [0; 3]],
        3,
    );
    let body = PartBuilder::new("body")
        .with(&white, block([-x, 0.0, -z], [x, h, z]))
        .with(
            &ink,
            panel(0.8 * w, 0.82 * depth, 0.0002)
                .about_x(-FRAC_PI_2)
                .at(0.0, h, 0.41 * depth)
                .visual_only(),
        );
    Model::pickable("papers", "paper").part(body)
}

/// A small ornament: a bird, a snow globe, a pyramid of stone, or a box.
pub fn trinket(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("trinket", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let r = 0.5 * w;
    let glaze = style.glaze(&mut d.stream("glaze"));
    let body = PartBuilder::new("body");
    let body = match d.below("build", 4) {
        0 => {
            let tail = block([-r, 0.3 * h, -0.1 * w], [-0.5 * r, 0.4 * h, 0.1 * w]);
            let beak = crate::shapes::cone(0.06 * w, 0.006 * w, 0.2 * w, 8).about_z(-FRAC_PI_2);
            body.with_filled(
                glaze,
                surface_of_revolution(
                    &[
                        (0.0, 0.0),
                        (0.5 * r, 0.0),
                        (0.72 * r, 0.25 * h),
                        (0.5 * r, 0.55 * h),
                        (0.0, 0.6 * h),
                    ],
                    16,
                ),
                0.6,
            )
            .with(glaze, ball(0.2 * h, 14).at(0.28 * r, 0.8 * h, 0.0))
            .with(glaze, tail.visual_only())
            .with(
                &style.metal,
                beak.at(0.28 * r + 0.15 * h, 0.8 * h, 0.0).visual_only(),
            )
        }
        1 => body
            .with(&style.wood, cylinder(0.8 * r, 0.25 * h, 20))
            .with_filled(
                &crate::finishes::glass(),
                surface_of_revolution(
                    &[
                        (0.0, 0.25 * h),
                        (0.7 * r, 0.25 * h),
                        (r, 0.6 * h),
                        (0.7 * r, 0.9 * h),
                        (0.0, h),
                    ],
                    20,
                ),
                0.9,
            ),
        2 => body.with(
            glaze,
            crate::shapes::tapered_leg([0.0; 3], [0.0, h, 0.0], w, 0.05 * w),
        ),
        _ => body
            .with(
                &style.wood,
                rounded_block([-r, 0.0, -0.7 * r], [r, 0.75 * h, 0.7 * r], 0.006, 1),
            )
            .with(
                &style.wood,
                rounded_block([-r, 0.76 * h, -0.7 * r], [r, h, 0.7 * r], 0.006, 1),
            )
            .with(
                &style.metal,
                block([-0.1 * r, 0.6 * h, 0.7 * r], [0.1 * r, 0.8 * h, 0.72 * r]),
            ),
    };
    Model::pickable("trinket", "trinket").part(body)
}
