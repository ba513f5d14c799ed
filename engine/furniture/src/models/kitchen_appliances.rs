//! Small kitchen appliances: kettle, toaster, coffee machine, microwave, blender.

use super::casings::{CASING_COLORS, casing_finish};
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{
    Finish, black_plastic, chrome, enamel, glass, painted_steel, plastic, steel,
};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, rod, rounded_block, surface_of_revolution, tube, vessel};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("microwave", "microwave", 53, sample_microwave),
    CatalogueEntry::new("kettle", "kettle", 54, sample_kettle),
    CatalogueEntry::new("toaster", "toaster", 55, sample_toaster),
    CatalogueEntry::new(
        "coffee_machine",
        "coffee_machine",
        56,
        sample_coffee_machine,
    ),
    CatalogueEntry::new("blender", "food_processor", 57, blender),
];

/// A kettle on its base.
fn kettle() -> Model {
    let grip = tube(
        &[
            [-0.045, 0.2, 0.0],
            [-0.11, 0.2, 0.0],
            [-0.125, 0.15, 0.0],
            [-0.11, 0.07, 0.0],
            [-0.07, 0.055, 0.0],
        ],
        0.011,
        8,
    );
    let spout = rod([0.06, 0.15, 0.0], [0.1, 0.185, 0.0], 0.012);
    let pot = surface_of_revolution(
        &[
            (0.0, 0.02),
            (0.078, 0.02),
            (0.08, 0.05),
            (0.066, 0.17),
            (0.05, 0.2),
            (0.0, 0.205),
        ],
        24,
    );
    let body = PartBuilder::new("body")
        .with(&black_plastic(), cylinder(0.082, 0.02, 24))
        .with_fill_fraction(&steel(), pot, 0.03)
        .with(&black_plastic(), grip)
        .with_fill_fraction(&steel(), spout, 0.2)
        .with(
            &black_plastic(),
            cylinder(0.012, 0.015, 12).translated(0.0, 0.2035, 0.0),
        );
    Model::pickable("kettle", "kettle")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.1, 0.0], "kettle", 64.0)
}

fn sample_kettle(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("kettle", key);
    let tone = style.random_cloth(&mut d.stream("tone")).srgb;
    let body = match d.below("body", 3) {
        0 => painted_steel("kettle_enamel", tone),
        1 => painted_steel("kettle_white", [236, 236, 232]),
        _ => Finish {
            name: "kettle_steel",
            ..steel()
        },
    };
    kettle()
        .resized(d.sample_m("height") / 0.22)
        .with_finish_replaced("steel", &body)
}

/// A toaster for two slices.
fn toaster() -> Model {
    let cream = plastic("cream_plastic", [232, 218, 186]);
    let slot = |z: f32| block([-0.1, 0.1785, z - 0.013], [0.1, 0.1802, z + 0.013]).visual_only();
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &cream,
            rounded_block([-0.14, 0.008, -0.085], [0.14, 0.18, 0.085], 0.03, 2),
            0.2,
        )
        .with(
            &black_plastic(),
            block([-0.12, 0.0, -0.07], [0.12, 0.008, 0.07]),
        )
        .with_all(&black_plastic(), [slot(-0.03), slot(0.03)])
        .with(
            &black_plastic(),
            block([0.14, 0.11, -0.015], [0.16, 0.125, 0.015]),
        );
    Model::pickable("toaster", "toaster")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.1, 0.0], "hum", 36.0)
}

fn sample_toaster(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toaster", key);
    let tone = style.random_cloth(&mut d.stream("tone")).srgb;
    let case = plastic(
        "toaster_case",
        d.choose(
            "case",
            [tone, [232, 218, 186], [52, 54, 58], [190, 193, 197]],
        ),
    );
    toaster()
        .resized(d.sample_m("height") / 0.18)
        .with_finish_replaced("cream_plastic", &case)
}

/// A filter coffee machine with its jug.
fn coffee_machine() -> Model {
    let case = plastic("anthracite_plastic", [54, 56, 60]);
    let jug = surface_of_revolution(
        &[
            (0.0, 0.035),
            (0.055, 0.035),
            (0.065, 0.07),
            (0.05, 0.14),
            (0.0, 0.142),
        ],
        20,
    );
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &case,
            rounded_block([-0.1, 0.0, -0.13], [0.1, 0.034, 0.13], 0.01, 1),
            0.5,
        )
        .with_fill_fraction(
            &case,
            rounded_block([-0.1, 0.034, -0.13], [0.1, 0.22, -0.03], 0.01, 1),
            0.5,
        )
        .with_fill_fraction(
            &case,
            rounded_block([-0.1, 0.22, -0.13], [0.1, 0.33, 0.1], 0.012, 1),
            0.5,
        )
        .with_fill_fraction(&glass(), jug.translated(0.0, 0.0, 0.045), 0.25);
    Model::movable("coffee_machine", "coffee_machine")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.25, 0.0], "hum", 55.0)
}

fn sample_coffee_machine(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("coffee_machine", key);
    let tone = style.random_cloth(&mut d.stream("tone")).srgb;
    let case = plastic(
        "coffee_machine_case",
        d.choose("case", [tone, [54, 56, 60], [196, 198, 202], [150, 36, 38]]),
    );
    coffee_machine()
        .resized(d.sample_m("height") / 0.33)
        .with_finish_replaced("anthracite_plastic", &case)
}

/// A microwave oven; its door turns on the left.
fn microwave() -> Model {
    let case = enamel("microwave_white", [232, 232, 230]);
    let dark = Finish::plain("black_glass", "glass", [22, 22, 24]).transparent(1.0);
    let (x, h, z) = (0.24, 0.28, 0.18);
    let (low, w, panel) = (0.01, 0.02, 0.145);
    let face = z - 0.025;
    // Left, right with the panel, bottom, top, back.
    let shell = [
        block([-x, low, -z], [-x + w, h, face]),
        block([panel, low, -z], [x, h, z]),
        block([-x + w, low, -z], [panel, low + w, face]),
        block([-x + w, h - w, -z], [panel, h, face]),
        block([-x + w, low + w, -z], [panel, h - w, -z + w]),
    ];
    let knob = |y: f32| {
        cylinder(0.02, 0.018, 14)
            .rotated_x(FRAC_PI_2)
            .translated(0.195, y, z)
    };
    let body = PartBuilder::new("body")
        .with_all(&case, shell)
        .with(
            &black_plastic(),
            block([-x + 0.02, 0.0, -z + 0.02], [x - 0.02, low, z - 0.02]),
        )
        .with_all(&case, [knob(0.1), knob(0.19)]);
    let (near, edge) = (face + 0.001, panel - 0.002);
    let door = PartBuilder::new("door")
        .with(&case, block([-x, low + 0.002, near], [edge, h, z - 0.006]))
        .with(
            &dark,
            block([-x + 0.03, 0.04, z - 0.006], [edge - 0.05, h - 0.03, z]),
        )
        .with(
            &chrome(),
            rod(
                [edge - 0.02, 0.06, z + 0.012],
                [edge - 0.02, h - 0.05, z + 0.012],
                0.006,
            ),
        )
        .with_all(
            &chrome(),
            [0.075, h - 0.065].map(|y| {
                rod(
                    [edge - 0.02, y, z - 0.006],
                    [edge - 0.02, y, z + 0.012],
                    0.004,
                )
            }),
        );
    Model::movable("microwave", "microwave")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.15, z], "hum", 56.0)
        .with_container_space(
            "inside",
            [-x + w, low + w, -z + w],
            [panel, h - w, face - 0.005],
        )
        .part(door)
        .hinged("door", [-x, 0.0, z - 0.006], Vec3::NEG_Y, 1.6)
}

fn sample_microwave(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("microwave", key);
    microwave()
        .resized(d.sample_m("width") / 0.48)
        .with_finish_replaced(
            "microwave_white",
            &casing_finish(style, &d, "microwave_casing"),
        )
}

/// A blender: a jug of glass on a motor.
fn blender(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("blender", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let (r, base) = (0.5 * w, 0.4 * h);
    let case = plastic("blender_case", d.choose("case", CASING_COLORS));
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
        .with_fill_fraction(
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
        .with(&glass(), jug.translated(0.0, base, 0.0))
        .with(&glass(), grip.visual_only())
        .with(
            &black_plastic(),
            cylinder(0.84 * r, 0.06 * h, 20).translated(0.0, 0.9 * h, 0.0),
        )
        .with(
            &black_plastic(),
            cylinder(0.4 * r, 0.04 * h, 14).translated(0.0, 0.96 * h, 0.0),
        )
        .with(
            &chrome(),
            cylinder(0.018, 0.02, 14)
                .rotated_x(FRAC_PI_2)
                .translated(0.0, 0.14 * h, 0.9 * r),
        );
    Model::movable("blender", "food_processor")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.2 * h, 0.0], "noise", 80.0)
}
