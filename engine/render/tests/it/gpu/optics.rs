//! Glass, a mirror, a lamp and the sun by every camera, preset and path.

use super::agreement::Pair;
use super::cameras::cameras;
use super::compare::Count;
use crate::common::{Builder, look, quad};
use dwell_render::{Camera, Preset, PreviousPoses, View, VisibilityPath};
use dwell_scene::{
    House, Light, LightShape, Material, Mesh, ObjectId, PartId, Pose, ShoeboxMaterials, Sky,
    SkyConditions,
};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// A room under the open sky of noon with a red wall, a lamp, a ball of boxes, a tinted pane before it, and a mirror behind.
pub(super) fn room() -> Arc<House> {
    let grey = Builder::plaster("grey").with_srgb([188, 170, 150]);
    let shell = House::shoebox([6.0, 3.0, 6.0], &ShoeboxMaterials::uniform(&grey)).unwrap();
    let mut room = Builder::from(&shell);
    let red = room
        .data
        .materials
        .push(Builder::plaster("red").with_srgb([220, 20, 20]));
    let south = room
        .data
        .structure
        .iter_mut()
        .find(|piece| piece.name == "south");
    south.unwrap().materials = vec![red];
    let mirror = Material {
        metallic: 1.0,
        roughness: 0.02,
        ..Builder::plaster("mirror").with_srgb([240, 240, 240])
    };
    let pane = quad(Vec2::splat(-1.0), Vec2::splat(1.0), 0.0);
    let at = |x: f32, y: f32, z: f32| Pose::from_position(Vec3::new(x, y, z));
    room.add("mirror", pane.clone(), mirror, false, at(2.0, 1.5, 0.02));
    for (k, opacity) in [0.2, 0.4].into_iter().enumerate() {
        let glass = Material {
            opacity,
            ..Builder::plaster(&format!("glass {k}")).with_srgb([120, 200, 160])
        };
        room.add(
            &format!("pane {k}"),
            pane.clone(),
            glass,
            false,
            at(4.0, 1.4, 2.0 + k as f32),
        );
    }
    for k in 0..5 {
        let turn = glam::Quat::from_rotation_y(0.4 * k as f32);
        let place = Pose::new(Vec3::new(4.0 - 0.4 * k as f32, 0.3 * k as f32, 1.0), turn);
        let mesh = Mesh::cuboid(Vec3::splat(-0.2), Vec3::splat(0.2));
        let paint = Builder::plaster(&format!("paint {k}")).with_srgb([40 * k as u8, 90, 200]);
        room.add(&format!("box {k}"), mesh, paint, true, place);
    }
    let bulb = Mesh::cuboid(Vec3::splat(-0.02), Vec3::splat(0.02));
    let lamp = room.add(
        "lamp",
        bulb,
        Builder::plaster("bulb"),
        true,
        at(3.0, 2.2, 3.0),
    );
    room.data.objects[lamp].switch = Some(true);
    room.data.lights.push(Light {
        object: lamp,
        part: PartId(room.data.parts.len() as u32 - 1),
        position: Vec3::ZERO,
        shape: LightShape::Point,
        color: [1.0, 0.9, 0.7],
        power_w: 20.0,
        attenuation: [0.0, 0.0, 1.0],
    });
    let moment = SkyConditions {
        hour_h: 12.0,
        day: 80,
        latitude_deg: 45.0,
        ..SkyConditions::default()
    };
    room.data.sky = Some(Sky::at(&moment).unwrap());
    room.build().house
}

/// Through the panes, into the mirror, at the lamp from below, and over the wall into the sky.
pub(super) fn views(camera: Camera, preset: Preset) -> Vec<View> {
    let places = [
        ([4.2, 1.5, 4.5], [4.0, 1.2, 1.0]),
        ([2.5, 1.5, 3.0], [1.5, 1.4, 0.0]),
        ([3.5, 1.0, 5.0], [3.0, 2.2, 3.0]),
        ([3.0, 4.5, 8.0], [3.0, 1.0, 2.0]),
    ];
    let views = places.map(|(eye, target)| View {
        preset,
        ..look(camera, Vec3::from_array(eye), Vec3::from_array(target))
    });
    views.into()
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn glass_mirrors_and_light_look_the_same_by_every_camera() {
    for path in VisibilityPath::ALL {
        let Some(pair) = Pair::new(room(), path) else {
            return;
        };
        for (name, camera) in cameras() {
            let mut pictures = Vec::new();
            for preset in [Preset::Flat, Preset::Lit] {
                let name = format!("{name}, {}", preset.name());
                let mut compared = Count::default();
                let found = pair.shoot(&views(camera, preset));
                for (k, frames) in found.iter().enumerate() {
                    compared.compare(&format!("{name}, view {k}"), &camera, frames);
                }
                compared.finish(&name, path, 0.1);
                pictures.push(found);
            }
            // The light is seen.
            for (flat, lit) in pictures[0].iter().zip(&pictures[1]) {
                assert!(
                    flat.1.rgb != lit.1.rgb && flat.1.depth == lit.1.depth,
                    "{name}"
                );
            }
        }
    }
}

/// `full` is rendered by `cpu` whoever is asked, between pictures that are not.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn full_pictures_are_those_of_cpu() {
    let Some(pair) = Pair::new(room(), VisibilityPath::Raster) else {
        return;
    };
    let camera = Camera::from_fov(16, 12, 90.0).unwrap();
    let [flat, full, lit] =
        [Preset::Flat, Preset::Full, Preset::Lit].map(|preset| views(camera, preset));
    let mixed = [flat[0], full[0], full[1], lit[1], full[2]];
    let found = pair.shoot(&mixed);
    for (view, (cpu, gpu)) in mixed.iter().zip(&found) {
        assert!(cpu.rgb.iter().any(|byte| *byte > 40));
        assert!(view.preset != Preset::Full || cpu == gpu);
    }
    assert!(found[1].0.rgb != found[0].0.rgb);
}

/// A surface that was further away than numbers go has no flow; it used to be infinite.
#[test]
fn what_was_endlessly_far_beside_the_picture_has_no_flow() {
    let Some(pair) = Pair::new(room(), VisibilityPath::Compute) else {
        return;
    };
    let far = |part: &PartId| (*part, Pose::from_position(Vec3::new(2e38, 1.0, 1.0)));
    let moved: Vec<_> = pair.house.geometry().movable.iter().map(far).collect();
    let place = Pose::from_position(Vec3::new(3.0, 1.2, 3.6));
    let before = PreviousPoses {
        world_from_camera: place,
        moved_parts: &moved,
        agents: &[],
        persons: &[],
    };
    for (name, camera) in cameras() {
        let view = View::new(camera, place);
        let mut compared = Count::default();
        let frames = &pair.shoot_after(&[view], Some(before))[0];
        compared.compare(name, &camera, frames);
        compared.finish(name, VisibilityPath::Compute, 0.02);
        let (cpu, gpu) = frames;
        assert!(
            cpu.flow
                .iter()
                .chain(&gpu.flow)
                .all(|part| part.is_finite())
        );
        let first = pair.house.entity_of_object(ObjectId(3)).0;
        let boxes = first..first + 5;
        assert!(cpu.instance.iter().any(|id| boxes.contains(id)), "{name}");
    }
}
