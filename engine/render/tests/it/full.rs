//! The full preset: soft shadows, light thrown back by what stands near, the same bits each time.

#![allow(
    clippy::unwrap_used,
    reason = "tests may stop at the first surprise, and compare bits"
)]

use crate::common;

use common::{Builder, World, look};
use dwell_render::{Camera, Frame, ImageChannels, Preset, RenderJob, View};
use dwell_scene::parallel::Threads;
use dwell_scene::units::linear_from_srgb;
use dwell_scene::{House, Light, LightShape, Mesh, Pose, ShoeboxMaterials, Sky, SkyConditions};
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
        let mut frame = Frame::new(&view.camera, ImageChannels::default());
        let threads = Threads::new(threads);
        let frames = &mut [frame.as_mut()];
        world
            .renderer
            .render(&world.scene, &world.state, &[view], frames, threads)
            .unwrap();
        frame
    };
    let (one, three) = (shot(1), shot(3));
    assert_eq!(one.rgb, three.rgb);
    // Some rows alone are those of the whole.
    let (first, end) = (3_usize, 7_usize);
    let mut rgb = vec![0; (end - first) * 64 * 3];
    let frame = dwell_render::FrameMut {
        rgb: Some(&mut rgb),
        ..dwell_render::FrameMut::default()
    };
    let job = RenderJob {
        scene: &world.scene,
        state: &world.state,
        view,
        before: None,
        rows: Some((first as u32, end as u32)),
        frame,
    };
    world
        .renderer
        .render_batch(&mut [job], Threads::ONE)
        .unwrap();
    assert_eq!(rgb, one.rgb[first * 64 * 3..end * 64 * 3]);
    // What is no colour is that of the other presets.
    let lit = world.shot(&View {
        preset: Preset::Lit,
        ..view
    });
    assert_eq!(one.depth, lit.depth);
    assert_eq!(one.instance, lit.instance);
}

/// A glowing line just below the ceiling of a dark room, where its own light counts most: none of it is lost above.
#[test]
fn a_line_below_the_ceiling_lights_the_floor_as_in_lit() {
    let world = {
        let grey = Builder::plaster("grey").with_srgb([60, 60, 60]);
        let house = House::shoebox([5.0, 2.6, 5.0], &ShoeboxMaterials::uniform(&grey)).unwrap();
        let mut builder = Builder::from(&house);
        let tube = Mesh::cuboid(Vec3::new(-0.6, -0.01, -0.01), Vec3::new(0.6, 0.01, 0.01));
        let at = Pose::from_position(Vec3::new(2.5, 2.57, 2.5));
        let object = builder.add("tube", tube, Builder::plaster("tube"), false, at);
        builder.data.lights.push(Light {
            object,
            part: dwell_scene::PartId(0),
            position: Vec3::X * -0.6,
            shape: LightShape::Line { end: Vec3::X * 0.6 },
            color: [1.0; 3],
            // Against which the few lx that `lit` gives every room do not count.
            power_w: 600.0,
            attenuation: [0.0, 0.0, 1.0],
        });
        builder.build()
    };
    let camera = Camera::from_fov(32, 32, 30.0).unwrap();
    let floor = |preset: Preset| {
        let view = View {
            preset,
            ..look(camera, Vec3::new(2.5, 1.6, 4.0), Vec3::new(2.5, 0.0, 2.5))
        };
        mean(&world.shot(&view))
    };
    let (lit, full) = (floor(Preset::Lit), floor(Preset::Full));
    assert!((full / lit - 1.0).abs() < 0.1, "{full} of {lit}");
}

/// Over ground, a wall in the open is lit by the sky and by what the ground throws back.
#[test]
fn a_wall_over_ground_is_as_bright_as_lit() {
    let mut builder = Builder::empty();
    let grey = || Builder::plaster("grey").with_srgb([160, 160, 160]);
    let slab = Mesh::cuboid(Vec3::new(-50.0, -0.2, -50.0), Vec3::new(50.0, 0.0, 50.0));
    builder.add("ground", slab, grey(), false, Pose::IDENTITY);
    let wall = Mesh::cuboid(Vec3::new(-3.0, 0.0, -0.1), Vec3::new(3.0, 3.0, 0.1));
    let mut paint = grey();
    paint.name = "paint".into();
    builder.add("wall", wall, paint, false, Pose::IDENTITY);
    let world = builder.build();
    let camera = Camera::from_fov(32, 32, 30.0).unwrap();
    let shown = |preset: Preset| {
        let view = View {
            preset,
            ..look(camera, Vec3::new(0.0, 1.5, 4.0), Vec3::new(0.0, 1.5, 0.0))
        };
        mean(&world.shot(&view))
    };
    let (lit, full) = (shown(Preset::Lit), shown(Preset::Full));
    assert!((full / lit - 1.0).abs() < 0.05, "{full} of {lit}");
}

/// Ten metres above the ground, an edge across the sun's way throws a border as wide as the sun's disc is seen: 10 m times its
/// 0.0093 rad, over the sine of its height and along the ground.
#[test]
fn the_suns_shadows_have_a_border_as_wide_as_the_sun() {
    let mut builder = Builder::empty();
    let grey = || Builder::plaster("grey").with_srgb([160, 160, 160]);
    let slab = Mesh::cuboid(Vec3::new(-50.0, -0.2, -50.0), Vec3::new(50.0, 0.0, 50.0));
    builder.add("ground", slab, grey(), false, Pose::IDENTITY);
    let roof = Mesh::cuboid(Vec3::new(0.0, 10.0, -30.0), Vec3::new(30.0, 10.1, 30.0));
    let mut paint = grey();
    paint.name = "paint".into();
    builder.add("roof", roof, paint, false, Pose::IDENTITY);
    let moment = SkyConditions {
        hour_h: 12.0,
        day: 172,
        latitude_deg: 23.44,
        ..SkyConditions::default()
    };
    // The sun stands overhead: the lower edge of the roof is above x = 0.
    let sky = Sky::at(&moment).unwrap();
    assert!(sky.to_sun.y > 0.999, "{}", sky.to_sun);
    let edge_x = -10.0 * sky.to_sun.x / sky.to_sun.y;
    builder.data.sky = Some(sky);
    let world = builder.build();
    // 64 pixels over 0.32 m: 5 mm each.
    let height = 1.0;
    let camera = Camera::from_fov(64, 64, 2.0 * 0.16_f32.atan().to_degrees()).unwrap();
    let eye = Vec3::new(edge_x, height, 0.0);
    let border_m = |preset: Preset| {
        let view = View {
            preset,
            ..look(camera, eye, Vec3::new(edge_x, 0.0, -1e-3))
        };
        let frame = world.shot(&view);
        let light: Vec<f32> = (0..64)
            .map(|x| {
                let column = (0..64)
                    .map(|y| linear_from_srgb(f32::from(frame.rgb[(y * 64 + x) * 3]) / 255.0));
                column.sum::<f32>() / 64.0
            })
            .collect();
        let (low, high) = (light[0].min(light[63]), light[0].max(light[63]));
        assert!(high > 1.5 * low, "{light:?}");
        let between = light
            .iter()
            .filter(|x| (low + 0.04 * (high - low)..high - 0.04 * (high - low)).contains(*x));
        between.count() as f32 * 0.005
    };
    // Of a disc's profile the outer 4 % of light take a tenth of the width each.
    let (lit, full) = (border_m(Preset::Lit), border_m(Preset::Full));
    assert!(lit < 0.011, "{lit}");
    assert!((0.06..0.10).contains(&full), "{full}");
}
