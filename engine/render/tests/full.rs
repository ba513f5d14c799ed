//! The full preset: soft shadows, light thrown back by what stands near, the same bits each time.

#![allow(
    clippy::unwrap_used,
    reason = "tests may stop at the first surprise, and compare bits"
)]

mod common;

use common::{Builder, World, look};
use dwell_render::{Camera, Channels, Frame, Preset, View};
use dwell_scene::parallel::Threads;
use dwell_scene::units::linear_from_srgb;
use dwell_scene::{House, Light, LightShape, Mesh, Pose, ShoeboxMaterials};
use glam::Vec3;

/// A grey room with a lamp below the middle of its ceiling, and things in it.
fn room(things: &[(Vec3, Vec3)]) -> World {
    let grey = Builder::plaster("grey").with_srgb([160, 160, 160]);
    let house = House::shoebox([5.0, 2.6, 5.0], &ShoeboxMaterials::uniform(&grey)).unwrap();
    let mut builder = Builder::from(&house);
    let bulb = Mesh::cuboid(Vec3::splat(-0.02), Vec3::splat(0.02));
    let at = Pose::from_position(Vec3::new(2.5, 2.2, 2.5));
    let object = builder.add("lamp", bulb, Builder::plaster("bulb"), false, at);
    builder.data.lights.push(Light {
        object,
        part: dwell_scene::PartId(0),
        position: Vec3::ZERO,
        shape: LightShape::Point,
        color: [1.0; 3],
        power_w: 200.0,
        attenuation: [0.0, 0.0, 1.0],
    });
    for (k, (low, high)) in things.iter().enumerate() {
        let (middle, half) = ((*low + *high) * 0.5, (*high - *low) * 0.5);
        let mesh = Mesh::cuboid(-half, half);
        let name = format!("thing_{k}");
        builder.add(
            &name,
            mesh,
            grey.clone(),
            false,
            Pose::from_position(middle),
        );
    }
    builder.build()
}

fn view(preset: Preset) -> View {
    let camera = Camera::from_fov(64, 48, 90.0).unwrap();
    View {
        preset,
        ..look(camera, Vec3::new(4.6, 1.6, 4.6), Vec3::new(2.2, 0.4, 2.2))
    }
}

fn mean(frame: &Frame) -> f32 {
    let light = frame
        .rgb
        .iter()
        .map(|byte| linear_from_srgb(f32::from(*byte) / 255.0));
    light.sum::<f32>() / frame.rgb.len() as f32
}

/// In an empty room, what surfaces throw on one another is by and large what the room's mean says.
#[test]
fn an_empty_room_is_as_bright_as_lit() {
    let world = room(&[]);
    let [lit, full] = [Preset::Lit, Preset::Full].map(|preset| mean(&world.shot(&view(preset))));
    assert!((full / lit - 1.0).abs() < 0.15, "{full} of {lit}");
}

/// Brightness on the floor below the camera's axis, by distance from a low bench that hides the lamp's light from below it and most
/// of the room's.
#[test]
fn under_a_low_bench_it_is_darker_than_the_rooms_mean_says() {
    let bench = [(Vec3::new(1.5, 0.25, 1.5), Vec3::new(3.5, 0.3, 3.5))];
    let world = room(&bench);
    let camera = Camera::from_fov(48, 48, 40.0).unwrap();
    // From beside the bench at a height below it, at the floor below its middle.
    let eye = Vec3::new(2.5, 0.15, 4.2);
    let below = |preset: Preset| {
        let view = View {
            preset,
            ..look(camera, eye, Vec3::new(2.5, 0.0, 2.6))
        };
        let frame = world.shot(&view);
        let pixel = (26 * 48 + 24) * 3;
        linear_from_srgb(f32::from(frame.rgb[pixel]) / 255.0)
    };
    let (lit, full) = (below(Preset::Lit), below(Preset::Full));
    assert!(full < 0.5 * lit, "{full} of {lit}");
}

#[test]
fn full_pictures_have_the_same_bits_for_any_number_of_threads_and_rows() {
    let world = room(&[(Vec3::new(1.0, 0.0, 1.0), Vec3::new(2.0, 1.0, 2.0))]);
    let view = view(Preset::Full);
    let shot = |threads: usize| {
        let mut frame = Frame::new(&view.camera, Channels::default());
        let threads = Threads::exactly(threads);
        let frames = &mut [frame.as_mut()];
        world
            .renderer
            .render(&world.scene, &world.state, &[view], frames, threads)
            .unwrap();
        frame
    };
    let (one, three) = (shot(1), shot(3));
    assert_eq!(one.rgb, three.rgb);
    // What is no colour is that of the other presets.
    let lit = world.shot(&View {
        preset: Preset::Lit,
        ..view
    });
    assert_eq!(one.depth, lit.depth);
    assert_eq!(one.instance, lit.instance);
}
