//! A cooker with an oven, and the hood above it.

use super::cabinet_parts::horizontal_handle;
use super::casings::casing_finish;
use super::kitchen_units::{UNIT_DEPTH_M, WORKTOP_M};
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, enamel, painted_steel, steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{SolidMesh, block, cylinder};
use crate::style::Style;
use dwell_scene::LightShape;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("cooker", "cooker", 48, sample_cooker),
    CatalogueEntry::new("range_hood", "range_hood", 49, sample_range_hood),
];

/// A cooker 0.6 m wide: glass hob, knobs, an oven whose door folds down.
fn cooker() -> Model {
    let case = enamel("cooker_steel", [172, 174, 178]);
    let dark = Finish::plain("black_glass", "glass", [22, 22, 24]).transparent(1.0);
    let (x, z) = (0.298, 0.5 * UNIT_DEPTH_M - 0.02);
    let face = z - 0.03;
    let top = WORKTOP_M - 0.006;
    let w = 0.04;
    let shell: [SolidMesh; 6] = [
        block([-x, 0.06, -z], [-x + w, 0.78, face]),
        block([x - w, 0.06, -z], [x, 0.78, face]),
        block([-x + w, 0.06, -z], [x - w, 0.3, face]),
        block([-x + w, 0.3, -z], [x - w, 0.78, -z + w]),
        block([-x, 0.78, -z], [x, top, face]),
        block([-x, 0.79, face], [x, top, z]),
    ];
    let knob = |k: usize| {
        cylinder(0.018, 0.022, 14)
            .rotated_x(FRAC_PI_2)
            .translated(-0.2 + 0.1 * k as f32, 0.845, z)
    };
    let plate = |px: f32, pz: f32, r: f32| {
        cylinder(r, 0.0012, 24)
            .translated(px, WORKTOP_M, pz)
            .visual_only()
    };
    let rings = Finish::plain("hob_ring", "glass", [58, 56, 58]).transparent(1.0);
    let body = PartBuilder::new("body")
        .with_all(&case, shell)
        .with(
            &black_plastic(),
            block([-x + 0.02, 0.0, -z + 0.03], [x - 0.02, 0.06, face - 0.04]),
        )
        .with(&dark, block([-x, top, -z], [x, WORKTOP_M, z]))
        .with_all(
            &rings,
            [
                plate(-0.14, -0.13, 0.08),
                plate(0.14, -0.13, 0.1),
                plate(-0.14, 0.13, 0.1),
                plate(0.14, 0.13, 0.08),
            ],
        )
        .with_all(&black_plastic(), (0..5).map(knob))
        .with(&case, block([-x, 0.07, face], [x, 0.29, z]));
    let grid = steel();
    let body = body.with(
        &grid,
        block([-x + w, 0.5, -z + w], [x - w, 0.508, face - 0.01]),
    );
    let door = PartBuilder::new("oven_door")
        .with(&case, block([-x, 0.3, face + 0.002], [x, 0.36, z]))
        .with(&case, block([-x, 0.7, face + 0.002], [x, 0.78, z]))
        .with(&dark, block([-x, 0.36, face + 0.002], [x, 0.7, z]))
        .with(&steel(), horizontal_handle(0.0, 0.74, z, 0.2));
    Model::articulated("cooker", "cooker")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.54, face], "fan", 46.0)
        .with_support_surface("hob", [-x, WORKTOP_M, -z], [x, WORKTOP_M + 0.4, z])
        .with_container_space("oven", [-x + w, 0.508, -z + w], [x - w, 0.78, face - 0.01])
        .part(door)
        .hinged("oven_door", [0.0, 0.3, z], Vec3::X, 1.5)
}

fn sample_cooker(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("cooker", key);
    cooker().with_finish_replaced("cooker_steel", &casing_finish(style, &d, "cooker_casing"))
}

/// A hood on the wall over a cooker; y = 0 is its lower edge.
fn range_hood(width_m: f32) -> Model {
    let x = 0.5 * width_m;
    let shine = steel();
    let skirt = [
        [-x, 0.0],
        [x, 0.0],
        [x, 0.06],
        [0.12, 0.22],
        [-0.12, 0.22],
        [-x, 0.06],
    ];
    let body = PartBuilder::new("body")
        .with_fill_fraction(&shine, crate::shapes::extrude(&skirt, 0.46), 0.06)
        .with_fill_fraction(&shine, block([-0.12, 0.22, 0.0], [0.12, 0.75, 0.26]), 0.06);
    let down = LightShape::Spot {
        direction: Vec3::NEG_Y,
        cutoff_rad: 1.0,
        dropoff_rate: 1.0,
    };
    Model::fixed("range_hood", "range_hood")
        .with_switch_state(false)
        .part(body)
        .with_light_shape([0.0, -0.01, 0.23], down, 5.0)
        .with_sound([0.0, 0.1, 0.23], "fan", 58.0)
}

fn sample_range_hood(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("range_hood", key);
    let shine = if d.chance("dark", 0.3) {
        painted_steel("hood_black", [44, 44, 47])
    } else {
        Finish {
            name: "hood_steel",
            ..steel()
        }
    };
    range_hood(d.sample_m("width")).with_finish_replaced("steel", &shine)
}
