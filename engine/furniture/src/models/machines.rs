//! Larger machines: dishwasher, dryer, water cooler, air conditioner, fans, vacuum cleaner, treadmill.

use super::appliances::{drum_case, drum_space};
use super::cabinet_parts::level_handle;
use crate::finishes::{Finish, black, chrome, enamel, plastic, steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{
    SolidMesh, ball, block, cylinder, ring, rod, rounded_block, surface_of_revolution, tube,
};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::{FRAC_PI_2, TAU};

/// An oval fan blade from the axis (+Y) outwards along +X, twisted.
fn blade(from_m: f32, to_m: f32, width_m: f32) -> SolidMesh {
    rounded_block(
        [from_m, -0.004, -0.5 * width_m],
        [to_m, 0.004, 0.5 * width_m],
        0.0035,
        1,
    )
    .about_x(0.2)
}

/// A dishwasher under a worktop; its door folds down.
pub fn dishwasher(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("dishwasher", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z, t) = (0.5 * w, 0.5 * depth, 0.03);
    let face = z - 0.045;
    let tub = steel();
    let (low, top) = (0.12, h - 0.03);
    let body = PartBuilder::new("body")
        .with(
            &black(),
            block([-x + 0.02, 0.0, -z + 0.03], [x - 0.02, 0.1, face - 0.05]),
        )
        .with_filled(
            &style.appliance,
            block([-x, 0.1, -z], [-x + t, h, face]),
            0.5,
        )
        .with_filled(&style.appliance, block([x - t, 0.1, -z], [x, h, face]), 0.5)
        .with_filled(
            &style.appliance,
            block([-x + t, top, -z], [x - t, h, face]),
            0.5,
        )
        .with_filled(
            &style.appliance,
            block([-x + t, 0.1, -z], [x - t, top, -z + t]),
            0.5,
        )
        .with_filled(
            &style.appliance,
            block([-x + t, 0.1, -z + t], [x - t, low + 0.1, face]),
            0.6,
        )
        .with_filled(
            &tub,
            block(
                [-x + t, 0.5 * h, -z + t],
                [x - t, 0.5 * h + 0.012, face - 0.03],
            ),
            0.1,
        );
    let door = PartBuilder::new("door")
        .with_filled(
            &style.appliance,
            block([-x + 0.002, 0.105, face + 0.001], [x - 0.002, h - 0.002, z]),
            0.5,
        )
        .with(
            &black(),
            block([-x + 0.03, h - 0.07, z], [x - 0.03, h - 0.02, z + 0.002]).visual_only(),
        )
        .with(&steel(), level_handle(0.0, h - 0.11, z, 0.36 * w));
    Model::articulated("dishwasher", "dishwasher")
        .switched(false)
        .part(body)
        .with_sound([0.0, 0.4, z], "washing_machine", 48.0)
        .inside(
            "lower_rack",
            [-x + t, low + 0.1, -z + t],
            [x - t, 0.5 * h - 0.01, face - 0.01],
        )
        .inside(
            "upper_rack",
            [-x + t, 0.5 * h + 0.012, -z + t],
            [x - t, top, face - 0.03],
        )
        .part(door)
        .hinged("door", [0.0, 0.105, z], Vec3::X, 1.5)
}

/// A tumble dryer: as wide as a washing machine, its door larger and darker, a drawer for water above.
pub fn dryer(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("dryer", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth - 0.045);
    let dark = Finish::plain("dryer_window", "glass", [40, 44, 50]).clear(1.0);
    let middle = 0.46 * h;
    let (case_low, case_high) = ([0.012, -0.5 * depth], [h, z]);
    let case = drum_case(x, case_low, case_high, middle);
    let body = case
        .into_iter()
        .fold(PartBuilder::new("body"), |part, wall| {
            part.with_filled(&style.appliance, wall, 0.9)
        })
        .with(
            &black(),
            block(
                [-x + 0.03, 0.0, -0.5 * depth + 0.03],
                [x - 0.03, 0.012, z - 0.03],
            ),
        )
        .with(
            &plastic("panel_grey", [196, 198, 202]),
            block([-x + 0.2, h - 0.13, z], [x - 0.01, h - 0.02, z + 0.004]),
        )
        .with(
            &style.appliance,
            block([-x + 0.01, h - 0.13, z], [-x + 0.18, h - 0.02, z + 0.012]),
        )
        .with(
            &chrome(),
            cylinder(0.03, 0.02, 18)
                .about_x(FRAC_PI_2)
                .at(0.02, h - 0.075, z + 0.004),
        );
    let (low, high) = drum_space(middle, z);
    let door = PartBuilder::new("door")
        .with_filled(
            &chrome(),
            cylinder(0.2, 0.028, 32)
                .about_x(FRAC_PI_2)
                .at(0.0, middle, z + 0.002),
            0.1,
        )
        .with_filled(
            &dark,
            cylinder(0.16, 0.014, 28)
                .about_x(FRAC_PI_2)
                .at(0.0, middle, z + 0.03),
            0.4,
        );
    Model::articulated("tumble_dryer", "dryer")
        .switched(false)
        .part(body)
        .with_sound([0.0, middle, z], "washing_machine", 60.0)
        .top(
            "top",
            [-x + 0.02, h, -0.5 * depth + 0.02],
            [x - 0.02, h + 0.5, z - 0.02],
        )
        .inside("drum", low, high)
        .part(door)
        .hinged("door", [0.2, 0.0, z + 0.03], Vec3::Y, 1.6)
}

/// A stand with a bottle of water upside down.
pub fn water_dispenser(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("water_dispenser", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let case = h - 0.38;
    let water = Finish::plain("bottled_water", "water", [140, 186, 214]).clear(0.45);
    let r = 0.42 * w;
    let bottle = surface_of_revolution(
        &[
            (0.0, case),
            (0.2 * r, case),
            (0.25 * r, case + 0.04),
            (r, case + 0.1),
            (r, h - 0.02),
            (0.9 * r, h),
            (0.0, h),
        ],
        24,
    );
    let tap = |a: f32, tone: [u8; 3]| (a, plastic("tap_lever", tone));
    let mut body = PartBuilder::new("body")
        .with_filled(
            &style.appliance,
            rounded_block([-x, 0.0, -z], [x, 0.62 * case, z], 0.015, 1),
            0.18,
        )
        .with_filled(
            &style.appliance,
            rounded_block([-x, 0.62 * case, -z], [x, case, z - 0.09], 0.012, 1),
            0.18,
        )
        .with_filled(
            &style.appliance,
            rounded_block([-x, 0.9 * case, z - 0.1], [x, case, z], 0.012, 1),
            0.18,
        )
        .with(
            &black(),
            block(
                [-x + 0.04, 0.62 * case, z - 0.08],
                [x - 0.04, 0.62 * case + 0.012, z - 0.01],
            ),
        )
        .with_filled(&water, bottle, 0.6);
    for (a, lever) in [tap(-0.05, [60, 110, 190]), tap(0.05, [196, 60, 50])] {
        body = body.with(
            &lever,
            block(
                [a - 0.014, 0.8 * case, z - 0.09],
                [a + 0.014, 0.8 * case + 0.03, z - 0.04],
            ),
        );
    }
    Model::fixed("water_dispenser", "water_dispenser")
        .switched(true)
        .part(body)
        .with_sound([0.0, 0.2, -z], "hum", 36.0)
        .top(
            "drip_tray",
            [-x + 0.05, 0.62 * case + 0.012, z - 0.075],
            [x - 0.05, 0.79 * case, z - 0.015],
        )
}

/// The indoor unit of an air conditioner, on the wall; y = 0 is its lower edge.
pub fn air_conditioner(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("air_conditioner", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let x = 0.5 * w;
    let white = enamel(
        "white_case",
        d.of("tone", [[240, 241, 240], [232, 230, 224], [70, 74, 78]]),
    );
    let body = PartBuilder::new("body")
        .with_filled(
            &white,
            rounded_block([-x, 0.0, 0.0], [x, h, depth], 0.025, 2),
            0.45,
        )
        .with(
            &black(),
            block([-x + 0.06, 0.02, depth], [x - 0.06, 0.045, depth + 0.001]).visual_only(),
        )
        .with(
            &white,
            block(
                [-x + 0.05, -0.002, depth - 0.09],
                [x - 0.05, 0.004, depth - 0.02],
            )
            .visual_only(),
        )
        .with(
            &Finish::plain("indicator", "plastic", [90, 200, 120]).glowing([0.05, 0.3, 0.1]),
            block([x - 0.1, 0.12, depth], [x - 0.08, 0.126, depth + 0.001]).visual_only(),
        );
    Model::fixed("air_conditioner", "air_conditioner")
        .switched(false)
        .part(body)
        .with_sound([0.0, 0.02, depth], "fan", 40.0)
}

/// A fan on a stand: a cage with blades on a post.
pub fn pedestal_fan(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("pedestal_fan", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let (r, y) = (0.5 * w, h - 0.5 * w);
    let dark = d.chance("dark", 0.5);
    let case = if dark {
        black()
    } else {
        plastic("white_plastic", [240, 240, 236])
    };
    let hub = |from: f32, deep: f32, radius: f32| {
        cylinder(radius, deep, 16)
            .about_x(FRAC_PI_2)
            .at(0.0, y, from)
    };
    let mut body = PartBuilder::new("body")
        .with(
            &case,
            surface_of_revolution(
                &[
                    (0.0, 0.0),
                    (0.85 * r, 0.0),
                    (0.85 * r, 0.012),
                    (0.12, 0.04),
                    (0.0, 0.04),
                ],
                24,
            ),
        )
        .with(
            &style.metal,
            rod([0.0, 0.04, -0.1], [0.0, y - 0.05, -0.1], 0.013),
        )
        .with_filled(&case, hub(-0.15, 0.12, 0.055), 0.8)
        .with(
            &case,
            block([-0.02, y - 0.09, -0.12], [0.02, y - 0.04, -0.08]),
        );
    for k in 0..4 {
        let spin = TAU * k as f32 / 4.0;
        body = body.with(
            &case,
            blade(0.02, 0.86 * r, 0.35 * r)
                .about_x(FRAC_PI_2)
                .about_z(spin)
                .at(0.0, y, 0.0)
                .visual_only(),
        );
    }
    for z in [-0.045_f32, 0.045] {
        for (k, size) in [1.0_f32, 0.55].into_iter().enumerate() {
            let wire = ring(size * (r - 0.006), 0.003, 18).about_x(FRAC_PI_2).at(
                0.0,
                y,
                z * (1.0 + 0.25 * k as f32) * if k == 0 { 0.4 } else { 1.0 },
            );
            body = body.with(&style.metal, wire.visual_only());
        }
        for k in 0..8 {
            let (sin, cos) = dwell_scene::math::sin_cos(TAU * k as f32 / 8.0);
            let wire = rod(
                [0.0, y, z * 1.5],
                [0.99 * r * sin, y + 0.99 * r * cos, 0.4 * z],
                0.002,
            );
            body = body.with(&style.metal, wire.visual_only());
        }
    }
    // The cage is felt as a disc.
    let cage = hub(-0.05, 0.1, r - 0.004).collision_only();
    let body = body.with(&style.metal, cage);
    Model::movable("pedestal_fan", "fan")
        .switched(false)
        .part(body)
        .with_sound([0.0, y, 0.05], "fan", 50.0)
}

/// A fan under the ceiling with a lamp in its middle.
pub fn ceiling_fan(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("ceiling_fan", key);
    let (w, h) = (d.m("span"), d.m("height"));
    let (r, low) = (0.5 * w, -h);
    let count = d.of("blades", [3, 4, 5]);
    let mut body = PartBuilder::new("body")
        .with_filled(
            &style.metal,
            cylinder(0.07, 0.05, 20).at(0.0, -0.05, 0.0),
            0.3,
        )
        .with_filled(
            &style.metal,
            rod([0.0, low + 0.2, 0.0], [0.0, -0.05, 0.0], 0.014),
            0.5,
        )
        .with_filled(
            &style.metal,
            cylinder(0.1, 0.1, 24).at(0.0, low + 0.1, 0.0),
            0.3,
        )
        .with_filled(
            &crate::finishes::milk_glass(),
            surface_of_revolution(
                &[
                    (0.0, low),
                    (0.06, low + 0.01),
                    (0.095, low + 0.05),
                    (0.1, low + 0.1),
                    (0.0, low + 0.1),
                ],
                24,
            ),
            0.2,
        );
    for k in 0..count {
        let one = blade(0.09, r, 0.13).about_y(TAU * k as f32 / count as f32);
        body = body.with(&style.wood, one.at(0.0, low + 0.14, 0.0));
    }
    Model::fixed("ceiling_fan", "fan")
        .switched(true)
        .part(body)
        .with_light([0.0, low - 0.03, 0.0], 12.0)
        .with_sound([0.0, low + 0.14, 0.0], "fan", 38.0)
}

/// A vacuum cleaner on wheels with its hose and nozzle put away upright.
pub fn vacuum_cleaner(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("vacuum_cleaner", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let shell = plastic(
        "vacuum_shell",
        d.of(
            "tone",
            [
                [176, 40, 44],
                [40, 84, 150],
                [60, 62, 66],
                [64, 120, 90],
                [222, 170, 50],
            ],
        ),
    );
    let tank = (0.3 * h).min(0.26);
    let wheel = |sx: f32| {
        cylinder(0.07, 0.03, 18)
            .about_z(FRAC_PI_2)
            .at(sx * (x - 0.015) + 0.015, 0.07, -z + 0.09)
    };
    let body = PartBuilder::new("body")
        .with_filled(
            &shell,
            rounded_block([-x + 0.035, 0.02, -z], [x - 0.035, tank, z - 0.09], 0.06, 3),
            0.3,
        )
        .with_all(&black(), [wheel(-1.0), wheel(1.0)])
        .with(&black(), ball(0.03, 10).at(0.0, 0.03, z - 0.13))
        .with(
            &black(),
            rounded_block([-x, 0.0, z - 0.085], [x, 0.035, z], 0.012, 1),
        )
        .with_filled(
            &chrome(),
            rod([0.0, 0.03, z - 0.05], [0.0, h - 0.06, z - 0.12], 0.016),
            0.2,
        )
        .with(
            &black(),
            tube(
                &[
                    [0.0, h - 0.06, z - 0.12],
                    [0.0, h - 0.017, z - 0.15],
                    [0.0, h - 0.017, z - 0.24],
                ],
                0.017,
                8,
            ),
        )
        .with_filled(
            &black(),
            tube(
                &[
                    [0.0, h - 0.017, z - 0.24],
                    [0.05, 0.62 * h, z - 0.34],
                    [0.06, 0.42 * h, -0.02],
                    [0.0, tank - 0.02, 0.02],
                ],
                0.019,
                8,
            )
            .visual_only(),
            0.3,
        );
    Model::movable("vacuum_cleaner", "vacuum_cleaner")
        .switched(false)
        .part(body)
        .with_sound([0.0, 0.1, -z + 0.05], "noise", 72.0)
}

/// A treadmill: a belt between rails, a console on two posts. One runs towards -Z.
pub fn treadmill(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("treadmill", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let frame = Finish::plain(
        "treadmill_frame",
        "steel",
        d.of("tone", [[60, 62, 66], [190, 192, 196], [40, 42, 46]]),
    );
    let belt = Finish::plain("treadmill_belt", "rubber", [30, 30, 32]);
    let screen = Finish::picture(
        "console",
        "electronics",
        "desktop",
        [[30, 60, 80], [200, 220, 220], [60, 160, 120]],
        2,
    )
    .glowing([0.04, 0.08, 0.08]);
    let mut body = PartBuilder::new("body")
        .with_filled(
            &frame,
            block([-x, 0.0, -z + 0.2], [-x + 0.08, 0.16, z]),
            0.12,
        )
        .with_filled(&frame, block([x - 0.08, 0.0, -z + 0.2], [x, 0.16, z]), 0.12)
        .with_filled(
            &belt,
            block([-x + 0.08, 0.05, -z + 0.2], [x - 0.08, 0.14, z - 0.02]),
            0.1,
        )
        .with_filled(
            &black(),
            rounded_block([-x, 0.0, -z], [x, 0.24, -z + 0.3], 0.04, 2),
            0.25,
        );
    for side in [-1.0_f32, 1.0] {
        let a = side * (x - 0.045);
        body = body
            .with_filled(
                &frame,
                rod([a, 0.1, -z + 0.32], [a, h - 0.22, -z + 0.12], 0.03),
                0.12,
            )
            .with_filled(
                &black(),
                rod([a, h - 0.28, -z + 0.13], [a, h - 0.3, -z + 0.62], 0.02),
                0.5,
            );
    }
    let console = rounded_block([-x, 0.0, -0.05], [x, 0.25, 0.05], 0.03, 2).about_x(-0.45);
    let shown = crate::shapes::panel(0.34, 0.16, 0.004)
        .at(0.0, 0.05, 0.05)
        .about_x(-0.45);
    let (cy, cz) = (h - 0.25, -z + 0.13);
    let body = body
        .with_filled(&black(), console.at(0.0, cy, cz), 0.3)
        .with(&screen, shown.at(0.0, cy, cz).visual_only());
    Model::fixed("treadmill", "gym_equipment")
        .switched(false)
        .part(body)
        .with_sound([0.0, 0.15, -z + 0.15], "hum", 62.0)
}
