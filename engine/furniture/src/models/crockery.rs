//! Cups, plates, bowls, glasses, bottles, pots and pans.

use crate::finishes::{Finish, black, glass, painted_steel, porcelain, steel};
use crate::model::{Model, PartBuilder};
use crate::shapes::{cylinder, rod, surface_of_revolution, tube, vessel};

/// A mug with a handle.
pub fn mug(glaze: &Finish) -> Model {
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
        .inside("inside", [-0.025, 0.005, -0.025], [0.025, 0.095, 0.025])
}

/// A flat plate.
pub fn plate(radius_m: f32, glaze: &Finish) -> Model {
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
        .part(PartBuilder::new("body").with(glaze, plate_pieces(&profile, r)))
        .top(
            "top",
            [-0.45 * r, 0.0055, -0.45 * r],
            [0.45 * r, 0.12, 0.45 * r],
        )
}

/// A plate collides as a flat disc with a thin rim of wedges, so that things can lie in it.
fn plate_pieces(profile: &[(f32, f32)], radius_m: f32) -> crate::shapes::SolidMesh {
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

/// A bowl.
pub fn bowl(radius_m: f32, glaze: &Finish) -> Model {
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
        .inside(
            "inside",
            [-0.3 * r, 0.005, -0.3 * r],
            [0.3 * r, 0.62 * r, 0.3 * r],
        )
}

/// A tumbler.
pub fn tumbler() -> Model {
    let shell = vessel(&[(0.0, 0.0), (0.03, 0.0), (0.037, 0.12)], 0.003, 20);
    Model::pickable("tumbler", "drinking_glass")
        .part(PartBuilder::new("body").with(&glass(), shell))
        .inside("inside", [-0.018, 0.004, -0.018], [0.018, 0.12, 0.018])
}

/// A bottle; `cap` closes it.
pub fn bottle(height_m: f32, body: &Finish, label: &Finish, cap: &Finish) -> Model {
    let (h, r) = (height_m, 0.13 * height_m);
    let shape = surface_of_revolution(
        &[
            (0.0, 0.0),
            (r, 0.0),
            (1.02 * r, 0.02 * h),
            (r, 0.58 * h),
            (0.75 * r, 0.68 * h),
            (0.36 * r, 0.78 * h),
            (0.34 * r, 0.95 * h),
            (0.0, 0.95 * h),
        ],
        20,
    );
    let band = surface_of_revolution(
        &[
            (1.03 * r, 0.2 * h),
            (1.05 * r, 0.2 * h),
            (1.05 * r, 0.5 * h),
            (1.03 * r, 0.5 * h),
            (1.03 * r, 0.2 * h),
        ],
        20,
    );
    let part = PartBuilder::new("body")
        .with_filled(body, shape, 0.55)
        .with(label, band.visual_only())
        .with(cap, cylinder(0.38 * r, 0.05 * h, 14).at(0.0, 0.95 * h, 0.0));
    Model::pickable("bottle", "bottle").part(part)
}

/// A cooking pot with two grips and a lid.
pub fn pot(radius_m: f32, color: &Finish) -> Model {
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
        .with_filled(
            color,
            surface_of_revolution(
                &[(0.0, 0.0), (0.94 * r, 0.0), (r, 0.1 * h), (r, h), (0.0, h)],
                26,
            ),
            0.06,
        )
        .with_filled(color, lid, 0.25)
        .with_all(&black(), [grip(-1.0), grip(1.0)])
        .with(&black(), cylinder(0.018, 0.022, 12).at(0.0, h + 0.026, 0.0));
    Model::pickable("pot", "pot").part(body)
}

/// A cooking pot with two grips, open.
pub fn open_pot(radius_m: f32, color: &Finish) -> Model {
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
        .with_filled(color, shell, 0.4)
        .with_all(&black(), [grip(-1.0), grip(1.0)]);
    let half = 0.62 * r;
    Model::pickable("open_pot", "pot").part(body).inside(
        "inside",
        [-half, 0.006, -half],
        [half, h, half],
    )
}

/// A frying pan, its handle towards +X.
pub fn pan(radius_m: f32) -> Model {
    let r = radius_m;
    let iron = painted_steel("black_steel", [40, 40, 42]);
    let shell = vessel(&[(0.0, 0.0), (0.82 * r, 0.0), (r, 0.045)], 0.004, 26);
    let body = PartBuilder::new("body").with(&iron, shell).with(
        &black(),
        rod([r - 0.012, 0.04, 0.0], [r + 0.17, 0.06, 0.0], 0.009),
    );
    Model::pickable("pan", "pan").part(body)
}

/// A round tin or storage jar with a lid.
pub fn jar(height_m: f32, body: &Finish, lid: &Finish) -> Model {
    let r = 0.32 * height_m;
    let part = PartBuilder::new("body")
        .with_filled(body, cylinder(r, 0.86 * height_m, 20), 0.2)
        .with_filled(
            lid,
            cylinder(r * 1.04, 0.14 * height_m, 20).at(0.0, 0.86 * height_m, 0.0),
            0.15,
        );
    Model::pickable("jar", "containers").part(part)
}

/// White glaze.
pub const fn white_glaze() -> Finish {
    porcelain("white_glaze", [240, 238, 230])
}

/// A steel beaker with wooden spoons.
pub fn utensils() -> Model {
    let wood = crate::finishes::beech();
    let spoon = |x: f32, z: f32, tilt: f32| {
        let head = crate::shapes::ball(0.022, 10)
            .at(0.0, 0.29, 0.0)
            .visual_only();
        rod([0.0, 0.012, 0.0], [0.0, 0.28, 0.0], 0.005)
            .visual_only()
            .and(head)
            .about_z(tilt)
            .at(x, 0.0, z)
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
