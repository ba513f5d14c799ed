//! Pots, pans, utensils, cutting boards and knife blocks.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, beech, black_plastic, painted_steel, steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{cylinder, rod, rounded_block, surface_of_revolution, tube, vessel};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("pot", "pot", 164, sample_pot),
    CatalogueEntry::new("pan", "pan", 165, sample_pan),
    CatalogueEntry::new("utensils", "utensil_holder", 166, sample_utensils),
    CatalogueEntry::new("knife_block", "knife_rack", 167, sample_knife_block),
    CatalogueEntry::new("cutting_board", "cutting_board", 168, sample_cutting_board),
];

/// A cooking pot with two grips and a lid.
fn pot(radius_m: f32, color: &Finish) -> Model {
    let (r, h) = (radius_m, radius_m * 1.15);
    let lid = surface_of_revolution(
        &[
            (0.0, h),
            (r + 0.004, h),
            (r + 0.004, h + 0.006),
            (0.3 * r, h + 0.024),
            (0.0, h + 0.026),
        ],
        26,
    );
    let grip = |side: f32| {
        let x = side * r;
        tube(
            &[
                [x, h * 0.75, -0.04],
                [x + side * 0.035, h * 0.78, -0.03],
                [x + side * 0.035, h * 0.78, 0.03],
                [x, h * 0.75, 0.04],
            ],
            0.006,
            8,
        )
    };
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            color,
            surface_of_revolution(
                &[(0.0, 0.0), (0.94 * r, 0.0), (r, 0.1 * h), (r, h), (0.0, h)],
                26,
            ),
            0.06,
        )
        .with_fill_fraction(color, lid, 0.25)
        .with_all(&black_plastic(), [grip(-1.0), grip(1.0)])
        .with(
            &black_plastic(),
            cylinder(0.018, 0.022, 12).translated(0.0, h + 0.026, 0.0),
        );
    Model::pickable("pot", "pot").part(body)
}

/// A cooking pot with two grips, open.
fn open_pot(radius_m: f32, color: &Finish) -> Model {
    let (r, h) = (radius_m, radius_m * 1.15);
    let shell = vessel(
        &[(0.0, 0.0), (0.94 * r, 0.0), (r, 0.1 * h), (r, h)],
        0.004,
        26,
    );
    let grip = |side: f32| {
        let x = side * r;
        let path = [
            [x, h * 0.75, -0.04],
            [x + side * 0.035, h * 0.78, -0.03],
            [x + side * 0.035, h * 0.78, 0.03],
            [x, h * 0.75, 0.04],
        ];
        tube(&path, 0.006, 8)
    };
    let body = PartBuilder::new("body")
        .with_fill_fraction(color, shell, 0.4)
        .with_all(&black_plastic(), [grip(-1.0), grip(1.0)]);
    let half = 0.62 * r;
    Model::pickable("open_pot", "pot")
        .part(body)
        .with_container_space("inside", [-half, 0.006, -half], [half, h, half])
}

fn sample_pot(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("pot", key);
    let tone = style.random_cloth(&mut d.stream("tone")).srgb;
    let metal = if d.chance("enamel", 0.5) {
        painted_steel("pot_enamel", tone)
    } else {
        steel()
    };
    let radius = 0.5 * d.sample_m("depth");
    if d.chance("lid", 0.5) {
        pot(radius, &metal)
    } else {
        open_pot(radius, &metal)
    }
}

/// A frying pan, its handle towards +X.
fn pan(radius_m: f32) -> Model {
    let r = radius_m;
    let iron = painted_steel("black_steel", [40, 40, 42]);
    let shell = vessel(&[(0.0, 0.0), (0.82 * r, 0.0), (r, 0.045)], 0.004, 26);
    let body = PartBuilder::new("body").with(&iron, shell).with(
        &black_plastic(),
        rod([r - 0.012, 0.04, 0.0], [r + 0.17, 0.06, 0.0], 0.009),
    );
    Model::pickable("pan", "pan").part(body)
}

fn sample_pan(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("pan", key);
    let iron = painted_steel(
        "pan_metal",
        d.choose("metal", [[40, 40, 42], [168, 171, 175], [150, 60, 40]]),
    );
    pan(0.5 * d.sample_m("depth")).with_finish_replaced("black_steel", &iron)
}

/// A steel beaker with wooden spoons.
fn utensils() -> Model {
    let wood = crate::finishes::beech();
    let spoon = |x: f32, z: f32, tilt: f32| {
        let head = crate::shapes::ball(0.022, 10)
            .translated(0.0, 0.29, 0.0)
            .visual_only();
        rod([0.0, 0.012, 0.0], [0.0, 0.28, 0.0], 0.005)
            .visual_only()
            .merged(head)
            .rotated_z(tilt)
            .translated(x, 0.0, z)
    };
    let cup = vessel(&[(0.0, 0.0), (0.05, 0.0), (0.05, 0.14)], 0.003, 20);
    let body = PartBuilder::new("body").with(&steel(), cup).with_all(
        &wood,
        [
            spoon(0.0, 0.012, 0.1),
            spoon(0.005, -0.02, -0.09),
            spoon(-0.01, 0.0, 0.02),
        ],
    );
    Model::pickable("utensil_holder", "utensil_holder").part(body)
}

fn sample_utensils(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("utensils", key);
    let cup = Finish {
        name: "beaker",
        substance: "steel",
        ..style.random_glaze(&mut d.stream("cup")).clone()
    };
    utensils()
        .resized(d.sample_m("height") / 0.31)
        .with_finish_replaced("steel", &cup)
}

/// A board for cutting.
fn cutting_board() -> Model {
    let body = PartBuilder::new("body").with(
        &beech(),
        rounded_block([-0.19, 0.0, -0.13], [0.19, 0.02, 0.13], 0.008, 1),
    );
    Model::pickable("cutting_board", "cutting_board")
        .part(body)
        .with_support_surface("top", [-0.19, 0.02, -0.13], [0.19, 0.3, 0.13])
}

fn sample_cutting_board(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("cutting_board", key);
    let wood = &style.wood;
    let board = cutting_board().resized(d.sample_m("width") / 0.38);
    if wood.pattern.is_some() && wood.tile_m > 0.0 {
        board.with_finish_replaced("beech", wood)
    } else {
        board
    }
}

/// A block with five knives.
fn knife_block() -> Model {
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
            crate::shapes::extrude(&side, 0.1).translated(0.0, 0.0, -0.05),
        )
        .with_all(&black_plastic(), (0..5).map(grip));
    Model::pickable("knife_block", "knife_rack").part(body)
}

fn sample_knife_block(_style: &Style, key: RandomKey) -> Model {
    knife_block().resized(SizeSampler::new("knife_block", key).sample_m("height") / 0.31)
}
