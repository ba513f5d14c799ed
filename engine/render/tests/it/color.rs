//! Colours: exact where they can be.

#![allow(
    clippy::unwrap_used,
    reason = "tests may stop at the first surprise, and compare bits"
)]

use crate::common;

use common::{Builder, look, pixel, quad};
use dwell_render::{Camera, Frame};
use dwell_scene::units::{linear_from_srgb, srgb_from_linear};
use dwell_scene::{Material, Pose, Texture};
use glam::{Vec2, Vec3};
use std::sync::Arc;

fn texture(
    builder: &mut Builder,
    width: u32,
    height: u32,
    rgba: Vec<u8>,
) -> dwell_scene::TextureId {
    let texture = Texture::new("t".into(), width, height, rgba);
    builder.data.textures.push(Arc::new(texture))
}

fn wall(builder: &mut Builder, name: &str, material: Material, z: f32) {
    builder.add(
        name,
        quad(Vec2::splat(-1.0), Vec2::splat(1.0), z),
        material,
        false,
        Pose::IDENTITY,
    );
}

/// The wall of 2 m from 1 m away fills the picture exactly.
fn full_picture(builder: Builder, pixels: u32) -> (Frame, Camera) {
    let camera = Camera::from_fov(pixels, pixels, 90.0).unwrap();
    let world = builder.build();
    (world.shot(&look(camera, Vec3::ZERO, Vec3::NEG_Z)), camera)
}

#[test]
fn plain_colours_and_even_textures_come_out_as_they_went_in() {
    for color in [[0, 0, 0], [255, 255, 255], [1, 2, 3], [200, 17, 90]] {
        let mut plain = Builder::empty();
        wall(
            &mut plain,
            "w",
            Builder::plaster("w").with_srgb(color),
            -1.0,
        );
        let mut even = Builder::empty();
        let image = texture(
            &mut even,
            4,
            4,
            [color[0], color[1], color[2], 255].repeat(16),
        );
        wall(
            &mut even,
            "w",
            Builder::plaster("w").with_texture(image),
            -1.0,
        );
        // One strange texel keeps the image from being a plain colour; the picture's corner does not show it.
        let mut nearly = Builder::empty();
        let mut rgba = [color[0], color[1], color[2], 255].repeat(64 * 64);
        rgba[0] ^= 128;
        let image = texture(&mut nearly, 64, 64, rgba);
        wall(
            &mut nearly,
            "w",
            Builder::plaster("w").with_texture(image),
            -1.0,
        );
        for builder in [plain, even, nearly] {
            let (frame, camera) = full_picture(builder, 64);
            assert_eq!(pixel(&frame, &camera, 50, 40), color);
            assert_eq!(pixel(&frame, &camera, 31, 60), color);
        }
    }
}

#[test]
fn each_texel_lands_on_its_pixel_upright() {
    let mut builder = Builder::empty();
    let rgba: Vec<u8> = (0..32 * 32_u32)
        .flat_map(|k| [(k % 32 * 8) as u8, (k / 32 * 8) as u8, 77, 255])
        .collect();
    let image = texture(&mut builder, 32, 32, rgba.clone());
    wall(
        &mut builder,
        "w",
        Builder::plaster("w").with_texture(image),
        -1.0,
    );
    let (frame, camera) = full_picture(builder, 32);
    for y in 0..32 {
        for x in 0..32 {
            let expected = [(x * 8) as u8, (y * 8) as u8, 77];
            let found = pixel(&frame, &camera, x, y);
            let near = (0..3).all(|k| found[k].abs_diff(expected[k]) <= 1);
            assert!(near, "{x} {y}: {found:?} {expected:?}");
        }
    }
}

#[test]
fn a_colour_multiplies_the_texture_in_linear_light() {
    let mut builder = Builder::empty();
    let image = texture(&mut builder, 2, 2, [180, 90, 255, 255].repeat(4));
    let mut material = Builder::plaster("w").with_srgb([128, 200, 64]);
    material.texture = Some(image);
    wall(&mut builder, "w", material, -1.0);
    let (frame, camera) = full_picture(builder, 16);
    let found = pixel(&frame, &camera, 8, 8);
    for (k, (a, b)) in [(180, 128), (90, 200), (255, 64)].into_iter().enumerate() {
        let product = linear_from_srgb(a as f32 / 255.0) * linear_from_srgb(b as f32 / 255.0);
        let expected = srgb_from_linear(product) * 255.0;
        assert!(
            (f32::from(found[k]) - expected).abs() < 1.0,
            "{k}: {} {expected}",
            found[k]
        );
    }
}

#[test]
fn fine_patterns_far_away_become_their_mean() {
    let mut builder = Builder::empty();
    // A chessboard of single texels, seen at 8 texels a pixel.
    let rgba: Vec<u8> = (0..256 * 256_u32)
        .flat_map(|k| {
            [if (k + k / 256) % 2 == 0 { 255 } else { 0 }; 3]
                .into_iter()
                .chain([255])
        })
        .collect();
    let image = texture(&mut builder, 256, 256, rgba);
    wall(
        &mut builder,
        "w",
        Builder::plaster("w").with_texture(image),
        -1.0,
    );
    let (frame, _) = full_picture(builder, 32);
    // Half the light.
    let expected = (srgb_from_linear(0.5) * 255.0).round() as u8;
    assert!(frame.rgb.iter().all(|byte| byte.abs_diff(expected) <= 1));
}

#[test]
fn glass_tints_what_is_behind_and_is_what_depth_and_ids_tell_of() {
    for layers in [1, 2, 3] {
        let mut builder = Builder::empty();
        let glass_color = [0.4, 0.56, 0.64];
        for k in 0..layers {
            let mut glass = Builder::plaster(&format!("glass{k}"));
            glass.base_color = glass_color;
            glass.opacity = 0.25;
            wall(
                &mut builder,
                &format!("pane{k}"),
                glass,
                -1.0 - 0.1 * k as f32,
            );
        }
        let back = Builder::plaster("back").with_srgb([230, 40, 10]);
        let back_color = back.base_color;
        builder.add(
            "back",
            quad(Vec2::splat(-9.0), Vec2::splat(9.0), -3.0),
            back,
            true,
            Pose::IDENTITY,
        );
        let (frame, camera) = full_picture(builder, 16);
        let found = pixel(&frame, &camera, 5, 9);
        for k in 0..3 {
            let mut light = back_color[k];
            for _ in 0..layers {
                light = 0.25 * glass_color[k] + 0.75 * light;
            }
            let expected = srgb_from_linear(light) * 255.0;
            assert!(
                (f32::from(found[k]) - expected).abs() < 1.0,
                "{k}: {} {expected}",
                found[k]
            );
        }
        assert!(frame.instance.iter().all(|id| *id == 1));
        assert!(frame.depth.iter().all(|depth| (depth - 1.0).abs() < 1e-6));
    }
}

#[test]
fn holes_of_a_texture_let_light_through() {
    let mut builder = Builder::empty();
    // Left half a hole, right half red.
    let rgba: Vec<u8> = (0..64_u32)
        .flat_map(|k| {
            if k % 8 < 4 {
                [9, 9, 9, 0]
            } else {
                [255, 0, 0, 255]
            }
        })
        .collect();
    let image = texture(&mut builder, 8, 8, rgba);
    wall(
        &mut builder,
        "leaf",
        Builder::plaster("leaf").with_texture(image),
        -1.0,
    );
    let back = Builder::plaster("back").with_srgb([0, 0, 222]);
    builder.add(
        "back",
        quad(Vec2::splat(-9.0), Vec2::splat(9.0), -3.0),
        back,
        false,
        Pose::IDENTITY,
    );
    let (frame, camera) = full_picture(builder, 16);
    assert_eq!(pixel(&frame, &camera, 4, 8), [0, 0, 222]);
    assert_eq!(pixel(&frame, &camera, 11, 8), [255, 0, 0]);
    assert!(frame.instance.iter().all(|id| *id == 1));
}
