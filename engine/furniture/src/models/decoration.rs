//! Pictures and ornaments, magazines, boxes, toys, shoes, bags.

use crate::finishes::{Finish, black, leather, oak, paper, pine, plastic, upholstery};
use crate::model::{Model, PartBuilder};
use crate::shapes::{
    ball, block, cone, cylinder, frame, loft, oval, panel, ring, rod, rounded_block,
    surface_of_revolution, tube,
};
use crate::textures::Srgb;
use std::f32::consts::FRAC_PI_2;

/// A framed picture on the wall with a passe-partout; y = 0 is its middle.
pub fn picture(width_m: f32, height_m: f32, wood: &Finish, image: &Finish) -> Model {
    const BAR_M: f32 = 0.022;
    let margin = 0.16 * width_m.min(height_m);
    let (w, h) = (width_m - 2.0 * BAR_M, height_m - 2.0 * BAR_M);
    let (iw, ih) = (w - margin, h - margin);
    let body = PartBuilder::new("body")
        .with(wood, frame(width_m, height_m, BAR_M, 0.024))
        .with(
            &paper("mount", [240, 236, 226]),
            block([-0.5 * w, -0.5 * h, 0.004], [0.5 * w, 0.5 * h, 0.012]),
        )
        .with(
            image,
            panel(iw, ih, 0.002).at(0.0, -0.5 * ih, 0.012).visual_only(),
        );
    Model::fixed("picture", "picture_frame").part(body)
}

/// A poster without a frame.
pub fn poster(width_m: f32, height_m: f32, image: &Finish) -> Model {
    Model::fixed("poster", "picture_frame").part(PartBuilder::new("body").with(
        image,
        panel(width_m, height_m, 0.004).at(0.0, -0.5 * height_m, 0.0),
    ))
}

/// A stack of magazines.
pub fn magazines(covers: [&Finish; 3]) -> Model {
    let mut body = PartBuilder::new("body");
    for (k, cover) in covers.into_iter().enumerate() {
        let y = 0.008 * k as f32;
        let sheet = panel(0.21, 0.28, 0.008)
            .about_x(-FRAC_PI_2)
            .at(0.0, 0.0, 0.14);
        body = body.with(cover, sheet.about_y(0.12 * k as f32 - 0.1).at(0.0, y, 0.0));
    }
    Model::pickable("magazines", "magazines").part(body)
}

/// A sculpture of two rings on a foot.
pub fn sculpture(stone: &Finish) -> Model {
    let body = PartBuilder::new("body")
        .with(&oak(), block([-0.06, 0.0, -0.04], [0.06, 0.03, 0.04]))
        .with(
            stone,
            ring(0.07, 0.014, 26)
                .about_x(FRAC_PI_2)
                .at(-0.015, 0.11, 0.0),
        )
        .with(
            stone,
            ring(0.045, 0.011, 22)
                .about_x(FRAC_PI_2)
                .about_y(0.9)
                .at(0.04, 0.083, 0.01)
                .visual_only(),
        );
    Model::pickable("sculpture", "decoration").part(body)
}

/// A box of card or wood without a lid.
pub fn open_box(size_m: [f32; 3], material: &Finish) -> Model {
    let [w, h, d] = size_m;
    let (x, z, t) = (0.5 * w, 0.5 * d, 0.01);
    let walls = [
        block([-x, 0.0, -z], [x, t, z]),
        block([-x, t, -z], [-x + t, h, z]),
        block([x - t, t, -z], [x, h, z]),
        block([-x + t, t, -z], [x - t, h, -z + t]),
        block([-x + t, t, z - t], [x - t, h, z]),
    ];
    Model::pickable("storage_box", "box")
        .part(PartBuilder::new("body").with_all(material, walls))
        .inside("inside", [-x + t, t, -z + t], [x - t, h, z - t])
}

/// A building block of wood.
pub fn toy_block(edge_m: f32, name: &'static str, srgb: Srgb) -> Model {
    let h = 0.5 * edge_m;
    let lacquered = Finish::plain(name, "wood", srgb);
    Model::pickable("toy_block", "toy").part(PartBuilder::new("body").with(
        &lacquered,
        rounded_block([-h, 0.0, -h], [h, edge_m, h], 0.004, 1),
    ))
}

/// A bear of plush, sitting.
pub fn teddy_bear(plush: &Finish) -> Model {
    let cream = upholstery("cream_plush", [226, 206, 170]);
    let limb = |from: [f32; 3], to: [f32; 3], r: f32| {
        rod(from, to, r).and(ball(r * 1.12, 12).at(to[0], to[1], to[2]).visual_only())
    };
    let body = PartBuilder::new("body")
        .with(
            plush,
            surface_of_revolution(
                &[
                    (0.0, 0.0),
                    (0.055, 0.0),
                    (0.085, 0.05),
                    (0.075, 0.11),
                    (0.045, 0.155),
                    (0.0, 0.16),
                ],
                16,
            ),
        )
        .with(plush, ball(0.062, 16).at(0.0, 0.2, 0.0))
        .with(plush, ball(0.024, 10).at(-0.045, 0.25, 0.0).visual_only())
        .with(plush, ball(0.024, 10).at(0.045, 0.25, 0.0).visual_only())
        .with(&cream, ball(0.03, 12).at(0.0, 0.185, 0.05).visual_only())
        .with_all(
            plush,
            [-1.0_f32, 1.0].map(|s| limb([s * 0.05, 0.13, 0.02], [s * 0.1, 0.075, 0.07], 0.024)),
        )
        .with_all(
            plush,
            [-1.0_f32, 1.0].map(|s| limb([s * 0.045, 0.04, 0.04], [s * 0.075, 0.04, 0.13], 0.028)),
        )
        .with_all(
            &black(),
            [-0.022, 0.022].map(|x| ball(0.006, 8).at(x, 0.215, 0.058).visual_only()),
        )
        .with(&black(), ball(0.008, 8).at(0.0, 0.192, 0.078).visual_only());
    Model::pickable("teddy_bear", "toy").part(body)
}

/// A ball to play with.
pub fn toy_ball(radius_m: f32, rubber: &Finish) -> Model {
    Model::pickable("ball", "ball").part(PartBuilder::new("body").with_filled(
        rubber,
        ball(radius_m, 24).at(0.0, radius_m, 0.0),
        0.06,
    ))
}

/// A wooden engine on wheels.
pub fn toy_train() -> Model {
    let red = Finish::plain("red_wood", "wood", [196, 52, 44]);
    let blue = Finish::plain("blue_wood", "wood", [54, 96, 168]);
    let wheel = |x: f32, z: f32| {
        cylinder(0.022, 0.012, 14)
            .about_x(FRAC_PI_2)
            .at(x, 0.022, z)
    };
    let body = PartBuilder::new("body")
        .with(&red, block([-0.12, 0.024, -0.04], [0.12, 0.05, 0.04]))
        .with(
            &blue,
            cylinder(0.034, 0.13, 18)
                .about_z(FRAC_PI_2)
                .at(0.11, 0.084, 0.0),
        )
        .with(&red, block([-0.11, 0.05, -0.04], [-0.02, 0.14, 0.04]))
        .with(&blue, block([-0.12, 0.14, -0.046], [-0.01, 0.15, 0.046]))
        .with(&black(), cone(0.013, 0.018, 0.04, 12).at(0.085, 0.115, 0.0))
        .with_all(
            &pine(),
            [
                wheel(-0.08, 0.04),
                wheel(0.07, 0.04),
                wheel(-0.08, -0.052),
                wheel(0.07, -0.052),
            ],
        );
    Model::pickable("toy_train", "toy").part(body)
}

/// A pair of shoes side by side.
pub fn shoes(hide: &Finish) -> Model {
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
            .with_filled(hide, upper.at(x, 0.0, 0.0), 0.3)
            .with(&inside, opening.at(x, 0.0, 0.0).visual_only())
            .with_filled(&sole, foot.at(x, 0.0, 0.0), 0.6);
    }
    Model::pickable("shoes", "shoes").part(body)
}

/// A bag with two handles.
pub fn handbag() -> Model {
    let hide = leather("cognac_leather", [150, 88, 48]);
    let arc = |z: f32| {
        let path = [
            [-0.08, 0.24, z],
            [-0.07, 0.33, z],
            [0.0, 0.37, z],
            [0.07, 0.33, z],
            [0.08, 0.24, z],
        ];
        tube(&path, 0.006, 8).visual_only()
    };
    let body = PartBuilder::new("body")
        .with_filled(
            &hide,
            rounded_block([-0.17, 0.0, -0.06], [0.17, 0.25, 0.06], 0.02, 2),
            0.15,
        )
        .with_all(&hide, [arc(-0.05), arc(0.05)]);
    Model::pickable("handbag", "bag").part(body)
}

/// A globe of the earth on a stand.
pub fn globe() -> Model {
    let sea = Finish::tiled(
        "globe_map",
        "paper",
        "marble",
        [[70, 130, 180], [110, 150, 80], [150, 170, 100]],
        0.5,
    );
    let body = PartBuilder::new("body")
        .with(&oak(), cylinder(0.07, 0.02, 22))
        .with(&oak(), cylinder(0.01, 0.05, 12).at(0.0, 0.02, 0.0))
        .with_filled(&sea, ball(0.11, 24).at(0.0, 0.175, 0.0), 0.05);
    Model::pickable("globe", "decoration").part(body)
}

/// Pencils in a cup.
pub fn pencil_cup() -> Model {
    let cup = crate::shapes::vessel(&[(0.0, 0.0), (0.035, 0.0), (0.037, 0.1)], 0.003, 18);
    let pencil = |k: usize| {
        let tilt = 0.05 * k as f32 - 0.1;
        rod([0.0, 0.006, 0.0], [0.0, 0.16, 0.0], 0.0035)
            .visual_only()
            .about_z(tilt)
            .at(0.0, 0.0, 0.012 * (k % 3) as f32 - 0.012)
    };
    let body = PartBuilder::new("body")
        .with(&plastic("blue_plastic", [66, 120, 186]), cup)
        .with_all(
            &Finish::plain("pencil_wood", "wood", [224, 176, 62]),
            (0..5).map(pencil),
        );
    Model::pickable("pencil_cup", "utensil_holder").part(body)
}
