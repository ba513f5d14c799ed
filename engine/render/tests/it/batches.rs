//! Equal bits for any number of threads and any company; faults that are named.

#![allow(
    clippy::unwrap_used,
    reason = "tests may stop at the first surprise, and compare bits"
)]

use crate::common;

use common::{Builder, World, look, point, quad};
use dwell_render::{Camera, Frame, FrameMut, ImageChannels, Preset, RenderError, RenderJob, View};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{
    House, Light, LightShape, Mesh, ObjectId, PartId, Pose, ShoeboxMaterials, Texture,
};
use glam::{Vec2, Vec3};
use std::sync::Arc;

fn furnished() -> World {
    let mut builder =
        Builder::from(&House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap());
    let mut stream = RandomKey::root(3).stream();
    let rgba: Vec<u8> = (0..40 * 30)
        .flat_map(|_| (stream.bits() as u32 | 0xff00_0000).to_le_bytes())
        .collect();
    let noise = Texture::new("noise".into(), 40, 30, rgba);
    let image = builder.data.textures.push(Arc::new(noise));
    for k in 0..12 {
        let size = Vec3::new(
            stream.range(0.1, 0.8),
            stream.range(0.1, 0.8),
            stream.range(0.1, 0.8),
        );
        let place = Pose::from_position_yaw(
            point(&mut stream, 2.0) + Vec3::new(3.0, 1.2, 2.5),
            stream.range(-3.0, 3.0),
        );
        let mut material =
            Builder::plaster(&format!("m{k}")).with_srgb([stream.below(256) as u8, 90, 200]);
        if k % 3 == 0 {
            material = material.with_texture(image);
        }
        if k % 4 == 0 {
            material.opacity = 0.4;
        }
        builder.add(
            &format!("o{k}"),
            Mesh::cuboid(-size * 0.5, size * 0.5),
            material,
            k % 2 == 0,
            place,
        );
    }
    builder.data.lights.push(Light {
        object: ObjectId(1),
        part: PartId(1),
        position: Vec3::ZERO,
        shape: LightShape::Line { end: Vec3::X },
        color: [1.0, 0.9, 0.7],
        power_w: 15.0,
        attenuation: [0.0, 0.0, 1.0],
    });
    builder.build()
}

fn views() -> Vec<View> {
    let mut stream = RandomKey::root(9).stream();
    let mut views = Vec::new();
    for k in 0..10_u32 {
        // Sizes that no packet and no band fits.
        let camera = if k == 4 {
            Camera::orthographic(33, 17, 5.0, 2.5).unwrap()
        } else {
            Camera::from_fov(20 + 7 * k, 31 + k, 75.0).unwrap()
        };
        let mut view = look(
            camera,
            Vec3::new(3.0, 1.4, 2.4) + point(&mut stream, 0.9),
            Vec3::new(3.0, 1.0, 2.5),
        );
        view.preset = if k % 2 == 0 {
            Preset::Flat
        } else {
            Preset::Lit
        };
        views.push(view);
    }
    views
}

#[test]
fn bits_are_equal_for_any_number_of_threads_and_any_company() {
    let world = furnished();
    let views = views();
    let alone: Vec<Frame> = views.iter().map(|view| world.shot(view)).collect();
    for threads in [1, 2, 7] {
        let mut frames: Vec<Frame> = views
            .iter()
            .map(|view| Frame::new(&view.camera, ImageChannels::ALL))
            .collect();
        let mut targets: Vec<FrameMut<'_>> = frames.iter_mut().map(Frame::as_mut).collect();
        let threads = Threads::new(threads);
        world
            .renderer
            .render(&world.scene, &world.state, &views, &mut targets, threads)
            .unwrap();
        for (a, b) in alone.iter().zip(&frames) {
            assert!(a.rgb == b.rgb && a.instance == b.instance && a.semantic == b.semantic);
            assert!(a.normals == b.normals && a.albedo == b.albedo && a.flow == b.flow);
            assert!(
                a.depth
                    .iter()
                    .zip(&b.depth)
                    .all(|(a, b)| a.to_bits() == b.to_bits())
            );
        }
    }
}

#[test]
fn worlds_over_one_house_share_a_batch() {
    let mut world = furnished();
    let view = views()[1];
    let (first_state, first_scene) = (world.state.clone(), world.scene.clone());
    let expected_first = world.shot(&view);
    for pose in &mut world.state.part_pose {
        pose.position.y += 0.3;
    }
    world.scene.update(&world.state);
    let expected_second = world.shot(&view);
    assert_ne!(expected_first.depth, expected_second.depth);
    let mut frames = vec![Frame::new(&view.camera, ImageChannels::ALL); 3];
    let mut jobs: Vec<RenderJob<'_>> = frames
        .iter_mut()
        .enumerate()
        .map(|(k, frame)| {
            let (scene, state) = if k == 1 {
                (&world.scene, &world.state)
            } else {
                (&first_scene, &first_state)
            };
            RenderJob::new(scene, state, view, frame.as_mut())
        })
        .collect();
    world
        .renderer
        .render_batch(&mut jobs, Threads::new(2))
        .unwrap();
    assert!(
        frames[0] == expected_first && frames[1] == expected_second && frames[2] == expected_first
    );
}

#[test]
fn wanted_images_do_not_depend_on_one_another() {
    let world = furnished();
    let view = views()[3];
    let all = world.shot(&view);
    let only = |channels: ImageChannels| {
        let mut frame = Frame::new(&view.camera, channels);
        world
            .renderer
            .render(
                &world.scene,
                &world.state,
                &[view],
                &mut [frame.as_mut()],
                Threads::ONE,
            )
            .unwrap();
        frame
    };
    let none = ImageChannels::NONE;
    assert_eq!(only(ImageChannels { rgb: true, ..none }).rgb, all.rgb);
    assert_eq!(
        only(ImageChannels {
            depth: true,
            ..none
        })
        .depth,
        all.depth
    );
    assert_eq!(
        only(ImageChannels {
            instance: true,
            ..none
        })
        .instance,
        all.instance
    );
    assert_eq!(
        only(ImageChannels {
            semantic: true,
            ..none
        })
        .semantic,
        all.semantic
    );
    let surfaces = only(ImageChannels {
        normals: true,
        albedo: true,
        ..none
    });
    assert!(surfaces.normals == all.normals && surfaces.albedo == all.albedo);
    assert!(only(none).rgb.is_empty());
}

#[test]
fn every_depth_is_a_number_between_near_and_far() {
    let world = furnished();
    for view in views() {
        let frame = world.shot(&view);
        let range = view.camera.near_m()..=view.camera.far_m();
        assert!(frame.depth.iter().all(|depth| range.contains(depth)));
    }
}

#[test]
fn what_does_not_fit_is_refused_by_name() {
    let world = furnished();
    let view = views()[0];
    let mut frame = Frame::new(&view.camera, ImageChannels::ALL);
    let render = |view: &View, frame: FrameMut<'_>| {
        world.renderer.render(
            &world.scene,
            &world.state,
            &[*view],
            &mut [frame],
            Threads::ONE,
        )
    };
    frame.depth.pop();
    let message = render(&view, frame.as_mut()).unwrap_err().to_string();
    assert_eq!(
        message,
        "frame 0: depth has 619 elements; 620 are needed (height x width x channels)"
    );
    let mut lost = view;
    lost.world_from_camera.position.x = f32::NAN;
    frame.depth.push(0.0);
    let error = render(&lost, frame.as_mut()).unwrap_err();
    assert!(
        matches!(error, RenderError::Pose { view: 0, .. }),
        "{error}"
    );
    let error = world
        .renderer
        .render(&world.scene, &world.state, &[view], &mut [], Threads::ONE)
        .unwrap_err();
    assert_eq!(
        error,
        RenderError::Count {
            views: 1,
            frames: 0
        }
    );
    let other = furnished();
    let error = world
        .renderer
        .render(
            &other.scene,
            &other.state,
            &[view],
            &mut [frame.as_mut()],
            Threads::ONE,
        )
        .unwrap_err();
    assert_eq!(error, RenderError::OtherHouse { view: 0 });
}

#[test]
fn a_camera_in_a_wall_or_in_nothing_still_renders() {
    let mut builder = Builder::empty();
    builder.add(
        "wall",
        quad(Vec2::splat(-1.0), Vec2::splat(1.0), 0.0),
        Builder::plaster("w"),
        true,
        Pose::IDENTITY,
    );
    let world = builder.build();
    for eye in [
        Vec3::ZERO,
        Vec3::new(1e7, 0.0, 0.0),
        Vec3::new(0.0, 0.0, 1e-7),
    ] {
        for preset in [Preset::Flat, Preset::Lit] {
            let mut view = View::new(
                Camera::from_fov(16, 16, 90.0).unwrap(),
                Pose::from_position(eye),
            );
            view.preset = preset;
            let frame = world.shot(&view);
            assert!(frame.depth.iter().all(|depth| depth.is_finite()));
        }
    }
    let nothing = Builder::empty().build();
    let frame = nothing.shot(&views()[0]);
    assert!(
        frame.depth.iter().all(|depth| *depth == 50.0) && frame.instance.iter().all(|id| *id == 0)
    );
}
