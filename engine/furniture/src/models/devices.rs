//! Small machines and electronics: blender, iron, hair dryer, computer, camera, console, stereo, headphones.

use crate::finishes::{Finish, black, chrome, device, glass, plastic, steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{
    block, cone, cylinder, extrude, panel, rod, rounded_block, surface_of_revolution, tube, vessel,
};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::{FRAC_PI_2, PI};

/// Common colours of small machines' plastic.
const CASES: [[u8; 3]; 6] = [
    [236, 234, 228],
    [52, 54, 58],
    [176, 44, 46],
    [120, 170, 176],
    [226, 190, 90],
    [186, 190, 196],
];

/// A glowing picture of a screen.
fn screen(name: &'static str, d: &SizeSampler) -> Finish {
    let ground = d.of(
        "desktop",
        [[52, 96, 150], [38, 60, 70], [110, 70, 110], [60, 120, 100]],
    );
    Finish::picture(
        name,
        "glass",
        "desktop",
        [ground, [240, 240, 240], [90, 90, 96]],
        1 + d.below("icons", 4) as u64,
    )
    .clear(1.0)
    .glowing([0.08, 0.1, 0.13])
}

/// A blender: a jug of glass on a motor.
pub fn blender(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("blender", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let (r, base) = (0.5 * w, 0.4 * h);
    let case = plastic("blender_case", d.of("case", CASES));
    let jug = vessel(
        &[(0.0, 0.0), (0.62 * r, 0.0), (0.82 * r, 0.5 * h)],
        0.004,
        20,
    );
    let grip = tube(
        &[
            [0.7 * r, base + 0.1 * h, 0.0],
            [1.15 * r, base + 0.14 * h, 0.0],
            [1.15 * r, base + 0.38 * h, 0.0],
            [0.76 * r, base + 0.42 * h, 0.0],
        ],
        0.009,
        8,
    );
    let body = PartBuilder::new("body")
        .with_filled(
            &case,
            surface_of_revolution(
                &[
                    (0.0, 0.0),
                    (r, 0.0),
                    (0.95 * r, 0.2 * h),
                    (0.66 * r, base),
                    (0.0, base),
                ],
                24,
            ),
            0.85,
        )
        .with(&glass(), jug.at(0.0, base, 0.0))
        .with(&glass(), grip.visual_only())
        .with(
            &black(),
            cylinder(0.84 * r, 0.06 * h, 20).at(0.0, 0.9 * h, 0.0),
        )
        .with(
            &black(),
            cylinder(0.4 * r, 0.04 * h, 14).at(0.0, 0.96 * h, 0.0),
        )
        .with(
            &chrome(),
            cylinder(0.018, 0.02, 14)
                .about_x(FRAC_PI_2)
                .at(0.0, 0.14 * h, 0.9 * r),
        );
    Model::movable("blender", "food_processor")
        .switched(false)
        .part(body)
        .with_sound([0.0, 0.2 * h, 0.0], "noise", 80.0)
}

/// An iron standing on its heel; the tip points up, the plate to -Z.
pub fn iron(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("iron", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let shell = plastic(
        "iron_shell",
        d.of(
            "tone",
            [[60, 110, 170], [150, 60, 120], [70, 74, 78], [60, 140, 130]],
        ),
    );
    let outline = |s: f32| {
        [
            [-s * x, 0.0],
            [s * x, 0.0],
            [s * x, 0.45 * h],
            [0.55 * s * x, 0.8 * h],
            [0.0, h],
            [-0.55 * s * x, 0.8 * h],
            [-s * x, 0.45 * h],
        ]
    };
    let body = PartBuilder::new("body")
        .with(&steel(), extrude(&outline(1.0), 0.012).at(0.0, 0.0, -z))
        .with_filled(
            &shell,
            extrude(&outline(0.92).map(|[a, b]| [a, b * 0.94]), 0.05).at(0.0, 0.0, -z + 0.012),
            0.7,
        )
        .with_filled(
            &shell,
            block([-0.5 * x, 0.0, -z + 0.062], [0.5 * x, 0.035, z]),
            0.6,
        )
        .with(
            &shell,
            block(
                [-0.4 * x, 0.62 * h, -z + 0.062],
                [0.4 * x, 0.7 * h, z - 0.01],
            ),
        )
        .with(
            &black(),
            rod([0.0, 0.02, z - 0.02], [0.0, 0.68 * h, z - 0.025], 0.015),
        );
    Model::pickable("iron", "iron")
        .switched(false)
        .part(body)
        .with_sound([0.0, 0.5 * h, -z], "noise", 56.0)
}

/// A hair dryer lying on its side, the nozzle towards +X.
pub fn hair_dryer(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("hair_dryer", key);
    let (w, depth) = (d.m("width"), d.m("depth"));
    let shell = plastic("dryer_shell", d.of("case", CASES));
    let r = 0.038;
    let barrel = cylinder(r, 0.75 * w, 20).about_z(-FRAC_PI_2);
    let nozzle = cone(0.8 * r, 0.62 * r, 0.25 * w, 16).about_z(-FRAC_PI_2);
    let handle = rounded_block(
        [-0.018, -0.016, 0.0],
        [0.018, 0.016, depth - 1.4 * r],
        0.012,
        2,
    );
    let body = PartBuilder::new("body")
        .with_filled(&shell, barrel.at(-0.5 * w, r, -0.5 * depth + r), 0.3)
        .with_filled(&black(), nozzle.at(0.25 * w, r, -0.5 * depth + r), 0.3)
        .with_filled(&shell, handle.at(-0.2 * w, r, -0.5 * depth + 1.4 * r), 0.5)
        .with(
            &black(),
            cylinder(0.03, 0.004, 16)
                .about_z(FRAC_PI_2)
                .at(-0.5 * w, r, -0.5 * depth + r)
                .visual_only(),
        )
        // The handle is lower at its end, so that the dryer lies on barrel and grip.
        .with(
            &black(),
            block(
                [-0.2 * w - 0.012, 0.0, 0.5 * depth - 0.03],
                [-0.2 * w + 0.012, r - 0.014, 0.5 * depth - 0.01],
            ),
        );
    Model::pickable("hair_dryer", "hair_dryer")
        .switched(false)
        .part(body)
        .with_sound([0.5 * w, r, -0.5 * depth + r], "noise", 76.0)
}

/// A monitor with keyboard and mouse before it.
pub fn computer(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("computer", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let z = 0.5 * depth;
    let case = if d.chance("light", 0.3) {
        device("light_case", [206, 208, 212])
    } else {
        device("black_case", [28, 28, 31])
    };
    let low = h - 0.59 * w;
    let at = -z + 0.1;
    let keys = Finish::picture(
        "keyboard",
        "electronics",
        "keyboard",
        [[70, 72, 76], [30, 30, 33], [60, 62, 66]],
        1,
    );
    let (kw, kd, kz) = (0.43_f32.min(w), 0.13, z - 0.14);
    let body = PartBuilder::new("body")
        .with_filled(
            &case,
            block([-0.16 * w, 0.0, -z], [0.16 * w, 0.012, -z + 0.2]),
            0.6,
        )
        .with_filled(
            &case,
            block([-0.03, 0.012, at - 0.05], [0.03, low + 0.1, at - 0.025]),
            0.6,
        )
        .with_filled(
            &case,
            rounded_block(
                [-0.5 * w, low, at - 0.025],
                [0.5 * w, h, at + 0.015],
                0.006,
                1,
            ),
            0.35,
        )
        .with(
            &screen("desktop", &d),
            panel(w - 0.02, h - low - 0.035, 0.002)
                .at(0.0, low + 0.022, at + 0.015)
                .visual_only(),
        )
        .with_filled(
            &case,
            block(
                [-0.5 * kw - 0.04, 0.0, kz],
                [0.5 * kw - 0.04, 0.018, kz + kd],
            ),
            0.5,
        )
        .with(
            &keys,
            panel(kw - 0.01, kd - 0.01, 0.004)
                .about_x(-FRAC_PI_2)
                .at(-0.04, 0.018, kz + kd - 0.005)
                .visual_only(),
        )
        .with_filled(
            &case,
            rounded_block(
                [0.5 * kw, 0.0, kz + 0.02],
                [0.5 * kw + 0.06, 0.032, kz + 0.12],
                0.014,
                2,
            ),
            0.5,
        );
    Model::movable("computer", "computer")
        .switched(true)
        .part(body)
}

/// The tower of a computer.
pub fn computer_tower(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("computer_tower", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let case = device(
        "tower_case",
        d.of("tone", [[34, 34, 37], [206, 208, 210], [60, 62, 66]]),
    );
    let light = Finish::plain("power_light", "plastic", [90, 160, 240]).glowing([0.05, 0.15, 0.4]);
    let body = PartBuilder::new("body")
        .with_filled(&case, block([-x, 0.012, -z], [x, h, z - 0.01]), 0.35)
        .with(
            &black(),
            block(
                [-x + 0.012, 0.05, z - 0.01],
                [x - 0.012, h - 0.03, z - 0.004],
            ),
        )
        .with(
            &black(),
            block([-x + 0.02, 0.0, -z + 0.02], [x - 0.02, 0.012, z - 0.04]),
        )
        .with(
            &light,
            cylinder(0.012, 0.003, 14)
                .about_x(FRAC_PI_2)
                .at(0.0, h - 0.07, z - 0.004)
                .visual_only(),
        );
    Model::movable("computer_tower", "computer")
        .switched(true)
        .part(body)
        .with_sound([0.0, 0.5 * h, -z], "fan", 34.0)
}

/// A flat tablet computer, face up.
pub fn tablet(_style: &Style, key: RandomKey) -> Model {
    slab("tablet", "tablet", key)
}

/// A mobile phone, face up.
pub fn cellphone(_style: &Style, key: RandomKey) -> Model {
    slab("cellphone", "cellphone", key)
}

fn slab(name: &'static str, category: &'static str, key: RandomKey) -> Model {
    let d = SizeSampler::new(name, key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let case = device(
        "slab_case",
        d.of(
            "tone",
            [
                [30, 30, 33],
                [206, 208, 212],
                [60, 80, 110],
                [180, 140, 130],
            ],
        ),
    );
    let rim = 0.05 * w;
    let face = panel(w - 2.0 * rim, depth - 2.0 * rim, 0.0008)
        .about_x(-FRAC_PI_2)
        .at(0.0, h, z - rim);
    let body = PartBuilder::new("body")
        .with(&case, rounded_block([-x, 0.0, -z], [x, h, z], 0.45 * h, 1))
        .with(&screen("slab_screen", &d), face.visual_only());
    Model::pickable(name, category).switched(true).part(body)
}

/// A camera, its lens towards +Z.
pub fn camera(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("camera", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let skin = device(
        "camera_body",
        d.of("skin", [[34, 34, 36], [170, 172, 176], [90, 60, 40]]),
    );
    let lens = |r: f32, from: f32, deep: f32| {
        cylinder(r, deep, 24)
            .about_x(FRAC_PI_2)
            .at(0.1 * x, 0.36 * h, from)
    };
    let body = PartBuilder::new("body")
        .with(
            &skin,
            rounded_block([-x, 0.0, -z], [x, 0.8 * h, -z + 0.045], 0.01, 1),
        )
        .with(
            &skin,
            block([-0.25 * x, 0.8 * h, -z + 0.004], [0.45 * x, h, -z + 0.04]),
        )
        .with_filled(&black(), lens(0.36 * h, -z + 0.045, depth - 0.05), 0.7)
        .with(
            &Finish::plain("lens", "glass", [40, 46, 70]).clear(1.0),
            lens(0.28 * h, z - 0.005, 0.004),
        )
        .with(
            &chrome(),
            cylinder(0.01, 0.008, 12).at(-0.7 * x, 0.8 * h, -z + 0.022),
        );
    Model::pickable("camera", "camera")
        .switched(false)
        .part(body)
}

/// A games console with a pad lying on it.
pub fn game_console(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("game_console", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let (tone, other) = d.of(
        "tone",
        [
            ([30, 30, 33], [236, 236, 234]),
            ([236, 236, 234], [36, 36, 40]),
            ([60, 62, 66], [170, 40, 44]),
        ],
    );
    let (case, pad) = (device("console_case", tone), plastic("pad", other));
    let top = h - 0.035;
    let grip = |side: f32| {
        rounded_block(
            [side * 0.055 - 0.018, top, 0.0],
            [side * 0.055 + 0.018, h, 0.075],
            0.014,
            2,
        )
    };
    let stick = |a: f32| {
        cylinder(0.009, 0.012, 12)
            .at(a, h - 0.004, 0.02)
            .visual_only()
    };
    let body = PartBuilder::new("body")
        .with_filled(&case, block([-x, 0.006, -z], [x, 0.46 * top, z]), 0.6)
        .with_filled(&case, block([-x, 0.54 * top, -z], [x, top, z - 0.01]), 0.6)
        .with_filled(
            &black(),
            block(
                [-x + 0.012, 0.46 * top, -z + 0.01],
                [x - 0.012, 0.54 * top, z - 0.02],
            ),
            0.6,
        )
        .with(
            &black(),
            block([-x + 0.02, 0.0, -z + 0.02], [x - 0.02, 0.006, z - 0.02]),
        )
        .with_filled(
            &pad,
            rounded_block([-0.07, top, -0.03], [0.07, h, 0.03], 0.014, 2),
            0.5,
        )
        .with_all(&pad, [grip(-1.0), grip(1.0)])
        .with_all(&black(), [stick(-0.03), stick(0.03)]);
    Model::movable("game_console", "game_console")
        .switched(false)
        .part(body)
        .with_sound([0.0, 0.3 * h, -z], "fan", 36.0)
}

/// Headphones hung over a stand.
pub fn headphones(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("headphones", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let shell = plastic("headphones_shell", d.of("case", CASES));
    let r = 0.5 * w - 0.016;
    let y = h - r - 0.012;
    let arc: Vec<[f32; 3]> = (0..=8)
        .map(|k| {
            let (sin, cos) = dwell_scene::math::sin_cos(PI * (k as f32 / 8.0 - 0.5));
            [r * sin, y + r * cos, 0.0]
        })
        .collect();
    let ear = |side: f32| {
        cylinder(0.038, 0.03, 18)
            .about_z(FRAC_PI_2)
            .at(side * r + 0.015, y - 0.02, 0.0)
    };
    let body = PartBuilder::new("body")
        .with(&style.wood, cylinder(0.36 * w, 0.016, 24))
        .with(
            &style.metal,
            rod([0.0, 0.016, 0.0], [0.0, h - 0.024, 0.0], 0.008),
        )
        .with(&shell, tube(&arc, 0.01, 8))
        .with_filled(&shell, ear(-1.0).and(ear(1.0)), 0.5);
    Model::pickable("headphones", "headphones")
        .switched(false)
        .part(body)
        .with_sound([r, y - 0.02, 0.0], "radio", 48.0)
}

/// A stereo: an amplifier with a record player on top.
pub fn stereo(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("stereo", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let amp = 0.5 * h;
    let silver = device(
        "amplifier_face",
        d.of("face", [[186, 188, 190], [36, 36, 39], [206, 190, 150]]),
    );
    let vinyl = plastic("vinyl", [20, 20, 22]);
    let label = plastic(
        "record_label",
        d.of("label", [[196, 60, 50], [60, 110, 170], [226, 180, 70]]),
    );
    let knob = |a: f32, r: f32| {
        cylinder(r, 0.018, 18)
            .about_x(FRAC_PI_2)
            .at(a, 0.5 * amp, z - 0.02)
    };
    let body = PartBuilder::new("body")
        .with_filled(
            &style.wood,
            rounded_block([-x, 0.012, -z], [x, amp, z - 0.025], 0.006, 1),
            0.4,
        )
        .with(
            &black(),
            block([-x + 0.03, 0.0, -z + 0.03], [x - 0.03, 0.012, z - 0.05]),
        )
        .with(
            &silver,
            block(
                [-x + 0.008, 0.02, z - 0.025],
                [x - 0.008, amp - 0.008, z - 0.02],
            ),
        )
        .with_all(
            &chrome(),
            [
                knob(0.6 * x, 0.024),
                knob(-0.75 * x, 0.012),
                knob(-0.55 * x, 0.012),
                knob(-0.35 * x, 0.012),
            ],
        )
        .with_filled(
            &style.wood,
            rounded_block(
                [-x + 0.005, amp, -z + 0.005],
                [x - 0.005, h - 0.03, z - 0.03],
                0.006,
                1,
            ),
            0.5,
        )
        .with(
            &vinyl,
            cylinder(0.15_f32.min(0.42 * depth), 0.006, 32).at(-0.06, h - 0.03, -0.012),
        )
        .with(
            &label,
            cylinder(0.05, 0.0015, 20)
                .at(-0.06, h - 0.024, -0.012)
                .visual_only(),
        )
        .with(
            &chrome(),
            cylinder(0.018, 0.026, 14).at(x - 0.06, h - 0.03, -z + 0.07),
        )
        .with(
            &chrome(),
            rod(
                [x - 0.06, h - 0.008, -z + 0.07],
                [0.06, h - 0.016, 0.07],
                0.004,
            )
            .visual_only(),
        );
    Model::movable("stereo", "stereo_set")
        .switched(false)
        .part(body)
        .with_sound([0.0, 0.5 * h, z], "radio", 66.0)
}
