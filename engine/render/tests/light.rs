//! The lit preset against formulas.

#![allow(
    clippy::unwrap_used,
    reason = "tests may stop at the first surprise, and compare bits"
)]

mod common;

use common::{Builder, World, look, pixel, quad};
use dwell_render::{Camera, Preset, View};
use dwell_scene::units::linear_from_srgb;
use dwell_scene::{Category, House, Light, LightShape, Mesh, ObjectId, Pose, ShoeboxMaterials};
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

/// Light before tone mapping: the inverse of Reinhard's equation 4 with white 8.
fn before_tone_mapping(byte: u8) -> f32 {
    inverse(f32::from(byte))
}

fn inverse(byte: f32) -> f32 {
    let shown = linear_from_srgb(byte / 255.0);
    // x (1 + x/64) = shown (1 + x)
    let half = 32.0 * (1.0 - shown);
    -half + (half * half + 64.0 * shown).sqrt()
}

fn grey_room() -> House {
    let grey = Builder::plaster("grey").with_srgb([188, 188, 188]);
    House::shoebox([6.0, 3.0, 6.0], &ShoeboxMaterials::uniform(&grey)).unwrap()
}

fn with_lamp(shape: LightShape, power_w: f32, at: Vec3, on: bool) -> World {
    let mut builder = Builder::from(&grey_room());
    // The bulb itself is far too small to be seen.
    let bulb = Mesh::cuboid(Vec3::splat(-1e-4), Vec3::splat(1e-4));
    let object = builder.add(
        "lamp",
        bulb,
        Builder::plaster("bulb"),
        true,
        Pose::from_position(at),
    );
    builder.data.objects[object].switch = Some(on);
    builder.data.lights.push(Light {
        object,
        part: dwell_scene::PartId(0),
        position: Vec3::ZERO,
        shape,
        color: [1.0; 3],
        power_w,
        attenuation: [0.0, 0.0, 1.0],
    });
    builder.build()
}

/// Looks straight down at the floor from (3, `y`, 3).
fn downwards(y: f32) -> View {
    let camera = Camera::from_fov(200, 200, 90.0).unwrap();
    let mut view = look(camera, Vec3::new(3.0, y, 3.0), Vec3::new(3.0, 0.0, 3.0));
    view.world_from_camera.rotation = dwell_scene::space::rotation_from_yaw_pitch(0.0, -PI / 2.0);
    view.preset = Preset::Lit;
    view
}

/// Differences between the lamp's light at floor points `x` metres to the right of its foot, found and expected, each
/// relative to the difference between the first and the last point.
fn compare(world: &World, expected: impl Fn(f32) -> f32, places: &[f32]) {
    let view = downwards(2.0);
    let frame = world.shot(&view);
    let bytes: Vec<u8> = places
        .iter()
        .map(|x| pixel(&frame, &view.camera, (100.0 + x * 50.0) as usize, 100)[1])
        .collect();
    let found: Vec<f32> = bytes
        .iter()
        .map(|byte| before_tone_mapping(*byte))
        .collect();
    // Half a step of a byte either way, at the brightest place.
    let step = inverse(f32::from(bytes[0]) + 0.5) - inverse(f32::from(bytes[0]) - 0.5);
    let slack = 2.5 * step / (found[0] - found[places.len() - 1]);
    assert!(slack < 0.12, "{slack}");
    let at = |x: f32| expected(((100.0 + x * 50.0).floor() + 0.5 - 100.0) / 50.0);
    let last = places.len() - 1;
    let span = at(places[0]) - at(places[last]);
    for (k, x) in places.iter().enumerate() {
        let part = (found[k] - found[last]) / (found[0] - found[last]);
        let right = (at(*x) - at(places[last])) / span;
        assert!(
            (part - right).abs() < slack,
            "{x}: {part} {right} of {found:?}"
        );
    }
}

#[test]
fn a_point_lamp_falls_off_with_the_inverse_square_and_the_cosine() {
    let world = with_lamp(LightShape::Point, 20.0, Vec3::new(3.0, 1.5, 3.0), true);
    // E = I cos / d² = I h / (h² + x²)^1.5
    compare(
        &world,
        |x| 1.5 / (2.25 + x * x).powf(1.5),
        &[0.0, 0.4, 0.8, 1.2, 1.6, 1.9],
    );
}

#[test]
fn a_spot_lights_its_cone_only() {
    let shape = LightShape::Spot {
        direction: Vec3::NEG_Y,
        cutoff_rad: 0.6,
        dropoff_rate: 4.0,
    };
    let world = with_lamp(shape, 0.3, Vec3::new(3.0, 1.5, 3.0), true);
    // E = I cos^4 cos / d² inside, nothing beyond h tan(cutoff) = 1.03 m.
    let inside = |x: f32| {
        if x < 1.5 * 0.6_f32.tan() {
            1.5_f32.powi(5) / (2.25 + x * x).powf(3.5)
        } else {
            0.0
        }
    };
    compare(&world, inside, &[0.0, 0.3, 0.6, 0.9, 1.2, 1.8]);
}

#[test]
fn a_lamp_that_is_off_or_in_another_room_gives_no_light() {
    let view = downwards(2.0);
    let shot = |world: &World| world.shot(&view).rgb;
    let on = shot(&with_lamp(
        LightShape::Point,
        20.0,
        Vec3::new(3.0, 1.5, 3.0),
        true,
    ));
    let off = shot(&with_lamp(
        LightShape::Point,
        20.0,
        Vec3::new(3.0, 1.5, 3.0),
        false,
    ));
    let outside = shot(&with_lamp(
        LightShape::Point,
        20.0,
        Vec3::new(9.0, 1.5, 3.0),
        true,
    ));
    let none = shot(&World::new(grey_room()));
    assert_ne!(on, off);
    assert!(off.iter().zip(&none).all(|(a, b)| a.abs_diff(*b) <= 1));
    assert!(outside.iter().zip(&none).all(|(a, b)| a.abs_diff(*b) <= 1));
    // A closed room without lamps is dark, but not black.
    let mean = |rgb: &[u8]| rgb.iter().map(|b| u64::from(*b)).sum::<u64>() / rgb.len() as u64;
    assert!(mean(&none) > 20 && mean(&none) < mean(&on));
}

#[test]
fn switching_a_lamp_changes_the_next_picture() {
    let mut world = with_lamp(LightShape::Point, 20.0, Vec3::new(3.0, 1.5, 3.0), false);
    let view = downwards(2.0);
    let before = world.shot(&view).rgb;
    world.state.switched_on[ObjectId(0)] = true;
    assert_ne!(world.shot(&view).rgb, before);
    world.state.switched_on[ObjectId(0)] = false;
    assert_eq!(world.shot(&view).rgb, before);
}

#[test]
fn daylight_is_strongest_under_the_window() {
    let mut builder = Builder::from(&grey_room());
    let pane = quad(Vec2::new(-0.7, -0.7), Vec2::new(0.7, 0.7), 0.0);
    let object = builder.add(
        "window",
        pane,
        Builder::plaster("glass"),
        false,
        Pose::from_position(Vec3::new(3.0, 1.5, 0.02)),
    );
    builder.data.objects[object].category = Category {
        coarse: "window".into(),
        ..Category::default()
    };
    let world = builder.build();
    let view = downwards(1.4);
    let frame = world.shot(&view);
    // Image up is -Z: the window's wall.
    let row = |y: usize| before_tone_mapping(pixel(&frame, &view.camera, 100, y)[1]);
    assert!(
        row(10) > 1.2 * row(150) && row(150) > 0.0,
        "{} {}",
        row(10),
        row(150)
    );
}

#[test]
fn either_side_of_a_surface_is_lit_as_it_faces() {
    // A sheet between lamp and camera whose normals all point up; it is seen from below and above.
    for (eye, brighter) in [
        (Vec3::new(3.0, 2.5, 3.0), true),
        (Vec3::new(3.0, 0.5, 3.0), false),
    ] {
        let mut builder = Builder::from(&grey_room());
        let sheet = Mesh {
            positions: vec![
                Vec3::new(-1., 0., 1.),
                Vec3::new(1., 0., 1.),
                Vec3::new(1., 0., -1.),
                Vec3::new(-1., 0., -1.),
            ],
            normals: vec![Vec3::Y; 4],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        };
        let bulb = Mesh::cuboid(Vec3::splat(-1e-4), Vec3::splat(1e-4));
        builder.add(
            "lamp",
            bulb,
            Builder::plaster("bulb"),
            true,
            Pose::from_position(Vec3::new(4.0, 2.4, 3.0)),
        );
        builder.add(
            "sheet",
            sheet,
            Builder::plaster("sheet"),
            true,
            Pose::from_position(Vec3::new(3.0, 1.5, 3.0)),
        );
        builder.data.lights.push(Light {
            object: ObjectId(0),
            part: dwell_scene::PartId(0),
            position: Vec3::ZERO,
            shape: LightShape::Point,
            color: [1.0; 3],
            power_w: 20.0,
            attenuation: [0.0, 0.0, 1.0],
        });
        let world = builder.build();
        let camera = Camera::from_fov(21, 21, 40.0).unwrap();
        let mut view = look(camera, eye, Vec3::new(3.001, 1.5, 3.0));
        view.preset = Preset::Lit;
        let lit = before_tone_mapping(pixel(&world.shot(&view), &camera, 10, 10)[0]);
        assert_eq!(lit > 0.6, brighter, "{lit}");
    }
}
