//! Every shape is closed, looks outwards and is covered by its collision pieces.

use super::*;
use crate::testing::meshes::{assert_closed, collider_bounds};
use dwell_scene::random::RandomKey;

fn all() -> Vec<(&'static str, SolidMesh)> {
    let mug = [(0.0, 0.0), (0.03, 0.0), (0.04, 0.02), (0.04, 0.09)];
    let arch = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.5, 0.2], [0.0, 0.5]];
    vec![
        ("block", block([-0.1, 0.2, 0.0], [0.3, 0.9, 2.0])),
        (
            "rounded_block",
            rounded_block([-0.1, 0.2, 0.0], [0.3, 0.9, 2.0], 0.05, 2),
        ),
        ("cushion", cushion([-0.3, 0.0, -0.4], [0.3, 0.2, 0.4])),
        ("pillow", pillow([0.5, 0.16, 0.4])),
        ("cylinder", cylinder(0.2, 0.5, 16)),
        ("cone", cone(0.2, 0.1, 0.5, 16)),
        ("ball", ball(0.1, 16)),
        (
            "lathe",
            surface_of_revolution(
                &[(0.0, 0.0), (0.1, 0.0), (0.2, 0.3), (0.05, 0.5), (0.0, 0.5)],
                16,
            ),
        ),
        ("vessel", vessel(&mug, 0.004, 16)),
        ("extrude", extrude(&arch, 0.2)),
        ("frame", frame(0.6, 0.4, 0.03, 0.02)),
        (
            "tapered_leg",
            tapered_leg([0.1, 0.0, 0.1], [0.0, 0.7, 0.0], 0.02, 0.05),
        ),
        ("panel", panel(0.6, 0.4, 0.01)),
        ("rod", rod([0.0, 0.0, 0.0], [0.3, 0.4, 0.1], 0.01)),
        (
            "tube",
            tube(
                &[
                    [0.0, 0.0, 0.0],
                    [0.0, 0.2, 0.0],
                    [0.1, 0.3, 0.0],
                    [0.1, 0.2, 0.05],
                ],
                0.01,
                8,
            ),
        ),
        ("ring", torus(0.1, 0.01, 16)),
        ("curtain", curtain(0.9, 2.2, 0.1, 6)),
        ("blanket", blanket(1.6, 1.4, 0.3, 0.04)),
        ("leaf", leaf(0.3, 0.1, 0.5)),
        (
            "loft",
            loft(&[
                oval(0.1, 0.2, 0.0, 0.0, 16),
                oval(0.2, 0.2, 0.3, 0.05, 16),
                oval(0.1, 0.1, 0.5, 0.0, 16),
            ]),
        ),
        ("foliage", foliage(12, 0.3, 0.1, 0.4, RandomKey::root(1))),
    ]
}

#[test]
fn every_shape_is_closed_and_looks_outwards() {
    for (name, solid) in all() {
        solid.mesh.check(name).unwrap();
        assert_closed(name, &solid.mesh);
        let volume = solid.mesh.enclosed_volume_m3();
        assert!(volume > 0.0, "{name}: {volume} m3");
    }
}

#[test]
fn normals_agree_with_the_faces() {
    for (name, solid) in all() {
        for (k, triangle) in solid.mesh.triangles.iter().enumerate() {
            let [a, b, c] = solid.mesh.corners(k);
            let face = (b - a).cross(c - a).normalize_or_zero();
            let worst = triangle
                .map(|v| solid.mesh.normals[v as usize].dot(face))
                .into_iter()
                .fold(1.0, f32::min);
            // The rim of a pillow turns round within one vertex, and folds are coarse.
            let allowed = if name == "pillow" { -0.8 } else { -0.05 };
            assert!(
                worst > allowed,
                "{name}: triangle {k} has a normal at {worst} to its face"
            );
        }
        for normal in &solid.mesh.normals {
            assert!(
                (normal.length() - 1.0).abs() < 1e-3,
                "{name}: normal {normal}"
            );
        }
    }
}

#[test]
fn collision_pieces_stay_within_a_tenth_of_the_size_of_their_shape() {
    for (name, solid) in all() {
        let Some(pieces) = collider_bounds(&solid.colliders) else {
            continue;
        };
        let shape = solid.mesh.bounds();
        let slack = shape.size().max_element() * 0.1;
        assert!(
            shape.grown(slack).contains(pieces.min) && shape.grown(slack).contains(pieces.max),
            "{name}: {pieces:?} around {shape:?}"
        );
    }
}

#[test]
fn known_volumes_come_out() {
    let near = |name: &str, solid: &SolidMesh, expected: f64| {
        let found = solid.mesh.enclosed_volume_m3();
        assert!(
            (found / expected - 1.0).abs() < 0.03,
            "{name}: {found} m3, expected {expected}"
        );
    };
    let pi = std::f64::consts::PI;
    near("block", &block([0.0; 3], [1.0, 2.0, 3.0]), 6.0);
    near("ball", &ball(0.5, 48), pi / 6.0);
    near("cylinder", &cylinder(0.5, 2.0, 48), pi * 0.5);
    near("cone", &cone(0.5, 0.0, 3.0, 48), pi * 0.25);
    near(
        "ring",
        &torus(0.5, 0.1, 48),
        2.0 * pi * pi * 0.5 * 0.01 * 0.9,
    );
    near(
        "extrude",
        &extrude(
            &[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 0.2], [0.0, 1.0]],
            0.5,
        ),
        0.6,
    );
    let cup = [(0.0, 0.0), (0.05, 0.0), (0.05, 0.1)];
    near(
        "vessel",
        &vessel(&cup, 0.005, 48),
        pi * (0.0025 * 0.1 - 0.045 * 0.045 * 0.095),
    );
}
