//! Fruit and bread, and the boards they lie on.

use crate::finishes::{Finish, beech, black, steel};
use crate::model::{Model, PartBuilder};
use crate::shapes::{block, extrude, loft, oval, rod, rounded_block, surface_of_revolution};

/// An apple, a pear or an orange: a round fruit with a stalk; its colours are ground, blush, freckle.
pub fn fruit(radius_m: f32, skin: &Finish) -> Model {
    let r = radius_m;
    let shape = [
        (0.0, 0.06 * r),
        (0.3 * r, 0.0),
        (0.62 * r, 0.12 * r),
        (0.92 * r, 0.55 * r),
        (r, 1.0 * r),
        (0.9 * r, 1.45 * r),
        (0.55 * r, 1.76 * r),
        (0.25 * r, 1.78 * r),
        (0.0, 1.62 * r),
    ];
    let stalk = Finish::plain("stalk", "wood", [94, 66, 40]);
    let body = PartBuilder::new("body")
        .with(skin, surface_of_revolution(&shape, 16))
        .with(
            &stalk,
            rod([0.0, 1.6 * r, 0.0], [0.1 * r, 2.1 * r, 0.0], 0.0018).visual_only(),
        );
    Model::pickable("fruit", "food").part(body)
}

/// Skin of a red apple.
pub const fn red_skin() -> Finish {
    Finish::tiled(
        "red_apple",
        "food",
        "peel",
        [[186, 36, 38], [226, 172, 70], [236, 196, 120]],
        0.2,
    )
}

/// Skin of a green apple.
pub const fn green_skin() -> Finish {
    Finish::tiled(
        "green_apple",
        "food",
        "peel",
        [[138, 176, 58], [192, 204, 96], [226, 226, 150]],
        0.2,
    )
}

/// Skin of an orange.
pub const fn orange_skin() -> Finish {
    Finish::tiled(
        "orange_peel",
        "food",
        "peel",
        [[238, 140, 30], [244, 158, 52], [206, 108, 20]],
        0.2,
    )
}

/// A loaf of bread.
pub fn bread() -> Model {
    let crust = Finish::tiled(
        "crust",
        "food",
        "peel",
        [[178, 118, 62], [150, 92, 46], [214, 168, 110]],
        0.15,
    );
    Model::pickable("bread", "bread").part(PartBuilder::new("body").with(
        &crust,
        rounded_block([-0.13, 0.0, -0.055], [0.13, 0.1, 0.055], 0.045, 3),
    ))
}

/// A board for cutting.
pub fn cutting_board() -> Model {
    let body = PartBuilder::new("body").with(
        &beech(),
        rounded_block([-0.19, 0.0, -0.13], [0.19, 0.02, 0.13], 0.008, 1),
    );
    Model::pickable("cutting_board", "cutting_board")
        .part(body)
        .top("top", [-0.19, 0.02, -0.13], [0.19, 0.3, 0.13])
}

/// A block with five knives.
pub fn knife_block() -> Model {
    let side = [[-0.08, 0.0], [0.08, 0.0], [0.03, 0.2], [-0.06, 0.24]];
    let grip = |k: usize| {
        let (x, z) = (
            -0.045 + 0.036 * (k / 2) as f32,
            -0.024 + 0.048 * (k % 2) as f32,
        );
        rod([x, 0.2, z], [x - 0.012, 0.31, z], 0.009).visual_only()
    };
    let body = PartBuilder::new("body")
        .with(
            &beech(),
            crate::shapes::extrude(&side, 0.1).at(0.0, 0.0, -0.05),
        )
        .with_all(&black(), (0..5).map(grip));
    Model::pickable("knife_block", "knife_rack").part(body)
}

/// A knife, a fork or a spoon, seen as a bar with a head; it points towards -Z.
pub fn cutlery(name: &'static str) -> Model {
    let handle = block([-0.006, 0.0, 0.0], [0.006, 0.0035, 0.1]);
    let head = match name {
        "knife" => extrude(
            &[
                [-0.008, 0.0],
                [0.008, 0.0],
                [0.009, 0.06],
                [0.004, 0.1],
                [-0.005, 0.112],
                [-0.008, 0.108],
            ],
            0.0025,
        )
        .about_x(-std::f32::consts::FRAC_PI_2),
        "fork" => block([-0.004, 0.0, -0.05], [0.004, 0.003, 0.0])
            .and(block([-0.012, 0.0, -0.06], [0.012, 0.003, -0.05]))
            .and(block([-0.012, 0.0, -0.1], [-0.008, 0.003, -0.06]))
            .and(block([-0.002, 0.0, -0.1], [0.002, 0.003, -0.06]))
            .and(block([0.008, 0.0, -0.1], [0.012, 0.003, -0.06])),
        _ => block([-0.004, 0.0, -0.05], [0.004, 0.003, 0.0]).and(loft(&[
            oval(0.01, 0.018, 0.0, -0.077, 14),
            oval(0.02, 0.03, 0.007, -0.077, 14),
        ])),
    };
    Model::pickable(name, name).part(PartBuilder::new("body").with(&steel(), handle.and(head)))
}
