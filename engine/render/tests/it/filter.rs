//! Texture filtering at grazing angles, against the mean of many rays a pixel.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use dwell_render::{Camera, CpuRenderer, Frame, ImageChannels, Preset, View};
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::space::rotation_from_forward;
use dwell_scene::{House, Pose, ShoeboxMaterials, State, Texture, TextureId};
use glam::Vec3;
use std::sync::Arc;

/// Edge of the hall, m; metres of the camera above its floor; squares of the checker a metre.
const EDGE_M: f32 = 120.0;
const HEIGHT_M: f32 = 1.5;
const SQUARES: f32 = 4.0;
/// Of the picture, pixels.
const SIZE: (u32, u32) = (96, 48);
/// Rays a pixel along each edge, of the reference.
const RAYS: usize = 16;

/// A hall with a checkered floor.
fn hall() -> Arc<House> {
    let plain = House::shoebox([EDGE_M, 40.0, EDGE_M], &ShoeboxMaterials::default()).unwrap();
    let mut data = plain.data().clone();
    // A metre is one repetition.
    let texels = (0..64 * 64).flat_map(|k| {
        let (x, y) = (k % 64, k / 64);
        let square = 64 / SQUARES as usize;
        let byte = if (x / square + y / square).is_multiple_of(2) {
            255
        } else {
            0
        };
        [byte, byte, byte, 255]
    });
    let texture = Texture::new("checker".into(), 64, 64, texels.collect());
    data.textures.push(Arc::new(texture));
    for material in &mut data.materials {
        if material.name == "floor" {
            material.texture = Some(TextureId(0));
            material.base_color = [1.0; 3];
        }
    }
    Arc::new(House::new(data).unwrap())
}

/// A camera that sees the floor 3 to 10 degrees below the horizon, turned by a little and moved ahead.
fn view(preset: Preset, yaw: f32, ahead_m: f32) -> View {
    let camera = Camera::from_fov(SIZE.0, SIZE.1, 14.0).unwrap();
    let (camera, down) = (
        camera.with_range(0.05, 200.0).unwrap(),
        6.5_f32.to_radians(),
    );
    let forward = Vec3::new(yaw.sin() * down.cos(), -down.sin(), -yaw.cos() * down.cos());
    let eye = Vec3::new(0.5 * EDGE_M + 0.13, HEIGHT_M, 0.75 * EDGE_M - ahead_m);
    let rotation = rotation_from_forward(forward).unwrap();
    View {
        preset,
        ..View::new(camera, Pose::new(eye, rotation))
    }
}

/// Reflectance of what a camera sees, as it is filtered for a preset. Shape (pixel,).
fn filtered(renderer: &CpuRenderer, view: &View) -> Vec<f32> {
    let house = renderer.house();
    let (scene, state) = (RayScene::new(house.clone()), State::new(house));
    let channels = ImageChannels {
        albedo: true,
        ..ImageChannels::NONE
    };
    let mut frame = Frame::new(&view.camera, channels);
    let frames = &mut [frame.as_mut()];
    renderer
        .render(&scene, &state, &[*view], frames, Threads::ONE)
        .unwrap();
    frame.albedo.chunks_exact(3).map(|pixel| pixel[0]).collect()
}

/// The same from many rays a pixel, each of which sees black or white. Shape (pixel,).
fn exact(view: &View) -> Vec<f32> {
    let (width, height) = (SIZE.0 as usize, SIZE.1 as usize);
    let focal = 0.5 * width as f32 / 7_f32.to_radians().tan();
    let Pose { position, rotation } = view.world_from_camera;
    let is_white = |x: f32, y: f32| {
        let seen = Vec3::new(x - 0.5 * width as f32, 0.5 * height as f32 - y, -focal);
        let ray = rotation * seen;
        assert!(ray.y < 0.0);
        let floor = position - ray * (position.y / ray.y);
        // Texture coordinates run along x and against z, rows of a texture downwards.
        let square = |metres: f32| (metres.rem_euclid(1.0) * SQUARES) as u32;
        (square(floor.x) + square(floor.z - EDGE_M)).is_multiple_of(2)
    };
    let middle = |k: usize, ray: usize| k as f32 + (ray as f32 + 0.5) / RAYS as f32;
    let mean = |pixel: usize| {
        let rays = (0..RAYS * RAYS).filter(|ray| {
            is_white(
                middle(pixel % width, ray % RAYS),
                middle(pixel / width, ray / RAYS),
            )
        });
        rays.count() as f32 / (RAYS * RAYS) as f32
    };
    (0..width * height).map(mean).collect()
}

/// Root of the mean square of differences.
fn off(a: &[f32], b: &[f32]) -> f32 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
    (squares.sum::<f32>() / a.len() as f32).sqrt()
}

#[test]
fn floors_at_grazing_angles_show_their_pattern() {
    let renderer = CpuRenderer::new(&hall());
    let [mut flat, mut lit] = [0.0_f32; 2];
    for (yaw, ahead_m) in [(0.0, 0.0), (0.4, 1.7), (0.785, 3.1)] {
        let known = exact(&view(Preset::Flat, yaw, ahead_m));
        let of = |preset: Preset| off(&filtered(&renderer, &view(preset, yaw, ahead_m)), &known);
        let (was, is) = (of(Preset::Flat), of(Preset::Lit));
        println!("turned {yaw}: off by {was} isotropic, {is} anisotropic");
        (flat, lit) = (flat + was, lit + is);
    }
    assert!(lit < 0.25 * flat, "{lit} {flat}");
}

#[test]
fn floors_do_not_shimmer_under_a_moving_camera() {
    let renderer = CpuRenderer::new(&hall());
    // A third of a pixel and a few centimetres a frame.
    let frames = (0..16_u8).map(|k| {
        let k = f32::from(k);
        let view = view(Preset::Lit, 0.3 + 0.0009 * k, 0.04 * k);
        (filtered(&renderer, &view), exact(&view))
    });
    let frames: Vec<_> = frames.collect();
    let (mut found, mut known) = (0.0, 0.0);
    for pair in frames.windows(2) {
        found += off(&pair[0].0, &pair[1].0);
        known += off(&pair[0].1, &pair[1].1);
    }
    println!("changes from frame to frame: {found}, of the reference {known}");
    assert!(found < 1.1 * known, "{found} {known}");
}
