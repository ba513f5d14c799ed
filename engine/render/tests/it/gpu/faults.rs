//! The comparison itself: a fault in any image is found, at edges as well as away from them.

use super::compare::Count;
use super::optics::{room, views};
use crate::common::World;
use dwell_render::{Camera, Frame, Preset, VisibilityPath};
use std::panic::{AssertUnwindSafe, catch_unwind};

type Fault = (&'static str, fn(&mut Frame, usize));

/// Faults that each change one pixel: a little more than is allowed.
const FAULTS: [Fault; 7] = [
    ("depth", |frame, k| frame.depth[k] += 2.5),
    ("instance", |frame, k| frame.instance[k] += 40),
    ("semantic", |frame, k| frame.semantic[k] += 1),
    ("normals", |frame, k| {
        let normal = &mut frame.normals[3 * k..3 * k + 3];
        let turned = glam::Quat::from_rotation_x(0.01) * glam::Vec3::from_slice(normal);
        let turned = glam::Quat::from_rotation_y(0.01) * turned;
        normal.copy_from_slice(&turned.to_array());
    }),
    ("flow", |frame, k| frame.flow[2 * k] += 0.05),
    ("albedo", |frame, k| frame.albedo[3 * k + 1] += 1.0),
    ("rgb", |frame, k| frame.rgb[3 * k] ^= 0xff),
];

#[test]
fn a_fault_in_any_image_is_found_at_edges_and_elsewhere() {
    let world = World::over(room());
    let camera = Camera::from_fov(48, 36, 90.0).unwrap();
    let view = views(camera, Preset::Lit)[0];
    let right = world.shot(&view);
    let width = camera.width() as usize;
    let is_edge = |k: &usize| {
        let around = [k.wrapping_sub(1), k + 1, k.wrapping_sub(width), k + width];
        let ids = around.iter().filter_map(|k| right.instance.get(*k));
        ids.clone().any(|id| *id != right.instance[*k])
    };
    let is_found = |frame: &Frame| {
        let mut compared = Count::default();
        let pair = (right.clone(), frame.clone());
        let compare = || {
            compared.compare("fault", &camera, &pair);
            compared.finish("fault", VisibilityPath::Compute, 0.05);
        };
        catch_unwind(AssertUnwindSafe(compare)).is_err()
    };
    assert!(!is_found(&right), "the same is the same");
    for (name, fault) in FAULTS {
        for at_edges in [true, false] {
            let mut wrong = right.clone();
            let pixels = (0..camera.pixels()).filter(|k| is_edge(k) == at_edges);
            // Every other one: a fault of single pixels.
            pixels.step_by(2).for_each(|k| fault(&mut wrong, k));
            assert!(is_found(&wrong), "{name}, at edges: {at_edges}");
        }
    }
}
