//! Small kitchen appliances and the washing machine.

use crate::finishes::{Finish, black, chrome, enamel, glass, plastic, steel};
use crate::model::{Model, PartBuilder};
use crate::shapes::{
    SolidMesh, block, cylinder, ring, rod, rounded_block, surface_of_revolution, tube,
};
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

/// A kettle on its base.
pub fn kettle() -> Model {
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
        .with(&black(), cylinder(0.082, 0.02, 24))
        .with_filled(&steel(), pot, 0.03)
        .with(&black(), grip)
        .with_filled(&steel(), spout, 0.2)
        .with(&black(), cylinder(0.012, 0.015, 12).at(0.0, 0.2035, 0.0));
    Model::pickable("kettle", "kettle")
        .switched(false)
        .part(body)
        .with_sound([0.0, 0.1, 0.0], "kettle", 64.0)
}

/// A toaster for two slices.
pub fn toaster() -> Model {
    let cream = plastic("cream_plastic", [232, 218, 186]);
    let slot = |z: f32| block([-0.1, 0.1785, z - 0.013], [0.1, 0.1802, z + 0.013]).visual_only();
    let body = PartBuilder::new("body")
        .with_filled(
            &cream,
            rounded_block([-0.14, 0.008, -0.085], [0.14, 0.18, 0.085], 0.03, 2),
            0.2,
        )
        .with(&black(), block([-0.12, 0.0, -0.07], [0.12, 0.008, 0.07]))
        .with_all(&black(), [slot(-0.03), slot(0.03)])
        .with(&black(), block([0.14, 0.11, -0.015], [0.16, 0.125, 0.015]));
    Model::pickable("toaster", "toaster")
        .switched(false)
        .part(body)
        .with_sound([0.0, 0.1, 0.0], "hum", 36.0)
}

/// A filter coffee machine with its jug.
pub fn coffee_machine() -> Model {
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
        .with_filled(
            &case,
            rounded_block([-0.1, 0.0, -0.13], [0.1, 0.034, 0.13], 0.01, 1),
            0.5,
        )
        .with_filled(
            &case,
            rounded_block([-0.1, 0.034, -0.13], [0.1, 0.22, -0.03], 0.01, 1),
            0.5,
        )
        .with_filled(
            &case,
            rounded_block([-0.1, 0.22, -0.13], [0.1, 0.33, 0.1], 0.012, 1),
            0.5,
        )
        .with_filled(&glass(), jug.at(0.0, 0.0, 0.045), 0.25);
    Model::movable("coffee_machine", "coffee_machine")
        .switched(false)
        .part(body)
        .with_sound([0.0, 0.25, 0.0], "hum", 55.0)
}

/// A microwave oven; its door turns on the left.
pub fn microwave() -> Model {
    let case = enamel("microwave_white", [232, 232, 230]);
    let dark = Finish::plain("black_glass", "glass", [22, 22, 24]).clear(1.0);
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
    let knob = |y: f32| cylinder(0.02, 0.018, 14).about_x(FRAC_PI_2).at(0.195, y, z);
    let body = PartBuilder::new("body")
        .with_all(&case, shell)
        .with(
            &black(),
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
        .switched(false)
        .part(body)
        .with_sound([0.0, 0.15, z], "hum", 56.0)
        .inside(
            "inside",
            [-x + w, low + w, -z + w],
            [panel, h - w, face - 0.005],
        )
        .part(door)
        .hinged("door", [-x, 0.0, z - 0.006], Vec3::NEG_Y, 1.6)
}

/// The case of a machine with a drum behind a round door: a body about the axis, `half_m` wide to either side, between two
/// corners in (y, z), hollow around (0, `middle_m`), with a hole in its front. The last block closes the drum behind.
pub fn drum_case(half_m: f32, low: [f32; 2], high: [f32; 2], middle_m: f32) -> [SolidMesh; 9] {
    let (x, [base, back], [top, front]) = (half_m, low, high);
    let (a, b, c, d) = (-DRUM_M, DRUM_M, middle_m - DRUM_M, middle_m + DRUM_M);
    let (plate, deep) = (front - 0.05, front - 0.05 - DRUM_DEPTH_M);
    let (left, right) = (-HOLE_M, HOLE_M);
    let (under, over) = (middle_m - HOLE_M, middle_m + HOLE_M);
    [
        block([-x, base, back], [a, top, front]),
        block([b, base, back], [x, top, front]),
        block([a, base, back], [b, c, front]),
        block([a, d, back], [b, top, front]),
        block([a, c, plate], [left, d, front]),
        block([right, c, plate], [b, d, front]),
        block([left, c, plate], [right, under, front]),
        block([left, over, plate], [right, d, front]),
        block([a, c, back], [b, d, deep]),
    ]
}

/// Half the width of a drum's free space, m.
const DRUM_M: f32 = 0.22;
/// Depth of a drum, m.
const DRUM_DEPTH_M: f32 = 0.36;
/// Half the width of the hole before a drum: a square within its round rim, m.
const HOLE_M: f32 = 0.105;

/// The free space of a drum behind a front at z = `front_m`.
pub fn drum_space(middle_m: f32, front_m: f32) -> ([f32; 3], [f32; 3]) {
    let r = DRUM_M - 0.006;
    (
        [-r, middle_m - DRUM_M, front_m - 0.045 - DRUM_DEPTH_M],
        [r, middle_m + r, front_m - 0.055],
    )
}

/// A washing machine with a round door.
pub fn washer() -> Model {
    let white = enamel("washer_white", [238, 239, 240]);
    let (x, h, z) = (0.298, 0.85, 0.29);
    let dark = Finish::plain("washer_window", "glass", [62, 70, 78]).clear(1.0);
    let (case_low, case_high) = ([0.012, -z], [h, z]);
    let body = PartBuilder::new("body")
        .with_all(&white, drum_case(x, case_low, case_high, 0.42))
        .with(
            &chrome(),
            ring(0.15, 0.006, 28)
                .about_x(FRAC_PI_2)
                .at(0.0, 0.42, z)
                .visual_only(),
        )
        .with(
            &black(),
            block([-x + 0.03, 0.0, -z + 0.03], [x - 0.03, 0.012, z - 0.03]),
        )
        .with(
            &plastic("panel_grey", [196, 198, 202]),
            block([-x + 0.01, h - 0.13, z], [x - 0.01, h - 0.02, z + 0.004]),
        )
        .with(
            &chrome(),
            cylinder(0.032, 0.02, 18)
                .about_x(FRAC_PI_2)
                .at(0.05, h - 0.075, z + 0.004),
        )
        .with(
            &dark,
            block([0.13, h - 0.1, z + 0.004], [0.25, h - 0.05, z + 0.006]).visual_only(),
        );
    let door = PartBuilder::new("door")
        .with(
            &dark,
            cylinder(0.145, 0.03, 28)
                .about_x(FRAC_PI_2)
                .at(0.0, 0.42, z + 0.002),
        )
        .with(
            &chrome(),
            ring(0.155, 0.016, 28)
                .about_x(FRAC_PI_2)
                .at(0.0, 0.42, z + 0.018),
        );
    let (low, high) = drum_space(0.42, z);
    Model::articulated("washing_machine", "washer")
        .switched(false)
        .part(body)
        .with_sound([0.0, 0.42, z], "washing_machine", 62.0)
        .top("top", [-x, h, -z], [x, h + 0.5, z])
        .inside("drum", low, high)
        .part(door)
        .hinged("door", [-0.17, 0.0, z + 0.034], Vec3::NEG_Y, 1.8)
}
