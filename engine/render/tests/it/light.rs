//! The lit preset against formulas.

#![allow(
    clippy::unwrap_used,
    reason = "tests may stop at the first surprise, and compare bits"
)]

use crate::common;

use common::{Builder, World, look, pixel, quad};
use dwell_render::{Camera, Preset, View};
use dwell_scene::units::linear_from_srgb;
use dwell_scene::{
    Category, House, Light, LightShape, Mesh, ObjectId, Pose, ShoeboxMaterials, Sky, SkyConditions,
};
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

/// A tube of 2.4 m seen across and along: Lambert's law integrated over its length, every piece shining alike in all directions,
/// E(x) = I/L integral of h / (h² + (x - s)²)^1.5 ds (across: x² + s² instead).
#[test]
fn a_tube_lights_as_the_integral_over_its_length() {
    const HEIGHT_M: f32 = 1.0;
    const LENGTH_M: f32 = 2.4;
    let integral = |square: &dyn Fn(f32) -> f32| {
        let pieces = 400;
        let piece = |k: i32| {
            let s = ((k as f32 + 0.5) / pieces as f32 - 0.5) * LENGTH_M;
            HEIGHT_M / (HEIGHT_M * HEIGHT_M + square(s)).powf(1.5)
        };
        (0..pieces).map(piece).sum::<f32>() / pieces as f32
    };
    let places = [0.0, 0.4, 0.8, 1.2, 1.6, 1.9];
    let tube = |way: Vec3| {
        let shape = LightShape::Line {
            end: way * LENGTH_M,
        };
        let begin = Vec3::new(3.0, HEIGHT_M, 3.0) - way * (0.5 * LENGTH_M);
        with_lamp(shape, 20.0, begin, true)
    };
    compare(
        &tube(Vec3::X),
        |x| integral(&|s| (x - s) * (x - s)),
        &places,
    );
    compare(&tube(Vec3::Z), |x| integral(&|s| x * x + s * s), &places);
    // A single lamp in its middle is another light: the comparison tells them apart.
    let single = |x: f32| HEIGHT_M / (HEIGHT_M * HEIGHT_M + x * x).powf(1.5);
    let confused = std::panic::catch_unwind(|| compare(&tube(Vec3::X), single, &places));
    assert!(confused.is_err());
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

/// A plate of half a metre hangs 1.5 m below a lamp at 2.5 m: its shadow on the floor is 0.5 * 2.5 / 1.5 m wide.
#[test]
fn a_plate_under_a_lamp_throws_its_shadow_and_glass_none() {
    let at = Vec3::new(3.0, 2.5, 3.0);
    let shadow = |plate: Option<f32>| {
        let mut world = with_lamp(LightShape::Point, 60.0, at, true);
        if let Some(opacity) = plate {
            let mut builder = Builder::from(&world.house);
            let half = Vec3::new(0.25, 0.005, 0.25);
            let material = dwell_scene::Material {
                opacity,
                ..Builder::plaster("plate")
            };
            let place = Pose::from_position(Vec3::new(3.0, 1.0, 3.0));
            builder.add("plate", Mesh::cuboid(-half, half), material, false, place);
            world = builder.build();
        }
        // From below the plate, at the height of which 100 pixels are 0.9 m of floor each way.
        let view = downwards(0.9);
        let frame = world.shot(&view);
        let row = (0..200).map(|x| pixel(&frame, &view.camera, x, 100)[1]);
        row.map(before_tone_mapping).collect::<Vec<f32>>()
    };
    let (free, plate, glass) = (shadow(None), shadow(Some(1.0)), shadow(Some(0.2)));
    // The exposure is that of the room, and what it throws back is the same.
    let dark = |x: usize| plate[x] < 0.8 * free[x];
    let half_width = 0.5 * 0.5 * 2.5 / 1.5;
    for x in 0..200 {
        let floor_x = (x as f32 + 0.5 - 100.0) * 0.009;
        let from_edge = floor_x.abs() - half_width;
        if from_edge.abs() > 0.012 {
            assert_eq!(
                dark(x),
                from_edge < 0.0,
                "{x}: {floor_x} {} {}",
                plate[x],
                free[x]
            );
        }
        assert!((glass[x] - free[x]).abs() < 0.03 * free[x], "{x}");
    }
}

/// Between the ceiling and the floor above: such lamps stand in SUNCG's houses.
#[test]
fn a_lamp_that_is_walled_in_lights_its_room_all_the_same() {
    let view = downwards(2.0);
    let light = |y: f32| {
        let world = with_lamp(LightShape::Point, 60.0, Vec3::new(3.0, y, 3.0), true);
        let frame = world.shot(&view);
        before_tone_mapping(pixel(&frame, &view.camera, 100, 100)[1])
    };
    let (below, above) = (light(2.99), light(3.01));
    assert!((below - above).abs() < 0.03 * below, "{below} {above}");
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
        let sheet = Mesh::rectangle([
            Vec3::new(-1., 0., 1.),
            Vec3::new(1., 0., 1.),
            Vec3::new(1., 0., -1.),
            Vec3::new(-1., 0., -1.),
        ]);
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

/// A roofed room with a window of 1.4 m in its south wall, the sun shining in at 45 degrees.
fn sunny_room(hour_h: f32, awning: bool) -> World {
    let mut builder = Builder::from(&grey_room());
    let south = builder
        .data
        .structure
        .iter_ids()
        .find(|(_, piece)| piece.name == "south")
        .map(|(id, _)| id)
        .unwrap();
    // Only the part of the wall beside the window stays.
    let wall = quad(Vec2::new(0.0, 0.0), Vec2::new(2.3, 3.0), 6.0);
    builder.data.structure[south].mesh = builder.data.meshes.push(std::sync::Arc::new(wall));
    let mut glass = Builder::plaster("glass");
    glass.opacity = 0.1;
    let pane = quad(Vec2::new(-0.7, -0.7), Vec2::new(0.7, 0.7), 0.0);
    let place = Pose::from_position(Vec3::new(3.0, 1.5, 6.0));
    let object = builder.add("window", pane, glass, false, place);
    builder.data.objects[object].category.coarse = "window".into();
    if awning {
        let board = Mesh::cuboid(Vec3::new(1.0, 3.2, 6.1), Vec3::new(5.0, 3.3, 10.0));
        builder.add(
            "awning",
            board,
            Builder::plaster("cloth"),
            false,
            Pose::IDENTITY,
        );
    }
    // South is +Z. At the equinox the sun of noon stands 45 degrees high at this latitude.
    let moment = SkyConditions {
        hour_h,
        day: 80,
        latitude_deg: 45.0,
        ..SkyConditions::default()
    };
    builder.data.sky = Some(Sky::at(&moment).unwrap());
    builder.build()
}

#[test]
fn the_sun_draws_the_window_on_the_floor_unless_something_stands_before_it() {
    // The window spans heights 0.8 to 2.2 m at z = 6 and x = 2.3 to 3.7: its patch lies 0.8 to 2.2 m before the wall.
    let at = |world: &World, x: f32, z: f32| {
        let view = downwards(2.5);
        let frame = world.shot(&view);
        // 200 pixels for 5 m of floor, image up is -Z.
        let (column, row) = (100.0 + (x - 3.0) * 40.0, 100.0 + (z - 3.0) * 40.0);
        before_tone_mapping(pixel(&frame, &view.camera, column as usize, row as usize)[1])
    };
    let noon = sunny_room(12.0, false);
    let (lit, beside, deeper) = (
        at(&noon, 3.0, 4.5),
        at(&noon, 4.3, 4.5),
        at(&noon, 3.0, 3.2),
    );
    assert!(
        lit > 2.0 * beside && lit > 2.0 * deeper,
        "{lit} {beside} {deeper}"
    );
    // An awning takes the sun and leaves the sky.
    let shaded = sunny_room(12.0, true);
    let (under, next) = (at(&shaded, 3.0, 4.5), at(&shaded, 3.0, 3.2));
    assert!(
        lit / deeper > 2.0 * under / next && under > next && next > 0.0,
        "{lit} {deeper} without, {under} {next} with"
    );
    // In the morning the patch lies further west, at night there is none.
    let morning = sunny_room(10.0, false);
    assert!(at(&morning, 2.2, 4.6) > 2.0 * at(&morning, 3.6, 4.6));
    let night = sunny_room(23.0, false);
    let (a, b) = (at(&night, 3.0, 4.5), at(&night, 4.3, 4.5));
    assert!((a - b).abs() < 0.2 * b, "{a} {b}");
}

#[test]
fn the_open_air_is_blue_by_day_and_black_by_night() {
    let sky = |hour: f32| {
        let world = sunny_room(hour, false);
        let camera = Camera::from_fov(21, 21, 30.0).unwrap();
        let mut view = look(camera, Vec3::new(3.0, 1.5, 4.0), Vec3::new(3.0, 3.5, 9.0));
        view.preset = Preset::Lit;
        pixel(&world.shot(&view), &camera, 10, 10)
    };
    let (noon, night) = (sky(15.0), sky(1.0));
    assert!(noon[2] > 120 && noon[2] > noon[0], "{noon:?}");
    assert!(night.iter().all(|byte| *byte < 30), "{night:?}");
}

#[test]
fn a_mirror_shows_what_stands_behind_the_camera() {
    let red = Builder::plaster("red").with_srgb([220, 20, 20]);
    let mut room = Builder::from(&grey_room());
    let south = room
        .data
        .structure
        .iter()
        .find(|piece| piece.name == "south")
        .map(|piece| piece.materials[0])
        .unwrap();
    room.data.materials[south].base_color = red.base_color;
    let pane = quad(Vec2::new(-0.5, -0.5), Vec2::new(0.5, 0.5), 0.0);
    let place = Pose::from_position(Vec3::new(3.0, 1.5, 0.02));
    let glass = Builder::plaster("mirror_glass").with_srgb([240, 240, 240]);
    let mirror = dwell_scene::Material {
        metallic: 1.0,
        roughness: 0.02,
        ..glass
    };
    room.add("mirror", pane, mirror, false, place);
    let world = room.build();
    let camera = Camera::from_fov(21, 21, 30.0).unwrap();
    // From 2 m before the mirror the middle of the picture shows the wall 6 m behind it.
    let mut view = look(camera, Vec3::new(3.0, 1.5, 2.0), Vec3::new(3.0, 1.5, 0.0));
    view.preset = Preset::Lit;
    let frame = world.shot(&view);
    let [r, g, b] = pixel(&frame, &camera, 10, 10);
    assert!(r > 2 * g && r > 2 * b, "{r} {g} {b}");
    // A mirror beside the wall that it shows: as bright as the wall seen directly, less what the glass takes.
    let mut back = look(camera, Vec3::new(3.0, 1.5, 2.0), Vec3::new(3.0, 1.5, 6.0));
    back.preset = Preset::Lit;
    let direct = pixel(&world.shot(&back), &camera, 10, 10);
    assert!(
        r <= direct[0] && f32::from(r) > 0.85 * f32::from(direct[0]),
        "{r} {direct:?}"
    );
    // Depth and ids tell of the mirror itself.
    assert!((frame.depth[10 * 21 + 10] - 1.98).abs() < 1e-3);
}

/// The light of a world is kept between calls; what it shows is that of a renderer that has seen nothing before.
#[test]
fn kept_light_follows_lamps_and_wardrobes() {
    let mut builder = Builder::from(&grey_room());
    let bulb = Mesh::cuboid(Vec3::splat(-1e-4), Vec3::splat(1e-4));
    let at = |x: f32, y: f32, z: f32| Pose::from_position(Vec3::new(x, y, z));
    let lamp = builder.add(
        "lamp",
        bulb,
        Builder::plaster("bulb"),
        true,
        at(3.0, 2.4, 1.0),
    );
    builder.data.objects[lamp].switch = Some(true);
    builder.data.lights.push(Light {
        object: lamp,
        part: dwell_scene::PartId(0),
        position: Vec3::ZERO,
        shape: LightShape::Point,
        color: [1.0; 3],
        power_w: 20.0,
        attenuation: [0.0, 0.0, 1.0],
    });
    let wardrobe = Mesh::cuboid(Vec3::new(-0.6, 0.0, -0.3), Vec3::new(0.6, 2.0, 0.3));
    let wood = Builder::plaster("wood");
    builder.add("wardrobe", wardrobe, wood, true, at(1.0, 0.0, 3.0));
    let mut world = builder.build();
    let camera = Camera::from_fov(40, 30, 90.0).unwrap();
    let mut view = look(camera, Vec3::new(3.0, 1.5, 5.5), Vec3::new(3.0, 1.0, 0.0));
    view.preset = Preset::Lit;
    let mut seen = Vec::new();
    let wardrobe = dwell_scene::PartId(1);
    let changes: [&dyn Fn(&mut dwell_scene::State); 4] = [
        &|_| {},
        &|state| state.part_pose[wardrobe].position = Vec3::new(3.0, 0.0, 1.8),
        &|state| state.switched_on[lamp] = false,
        &|state| {
            state.switched_on[lamp] = true;
            state.part_pose[wardrobe].position = Vec3::new(1.0, 0.0, 3.0);
        },
    ];
    for change in changes {
        change(&mut world.state);
        world.scene.update(&world.state);
        let fresh = dwell_render::CpuRenderer::new(&world.house);
        let renderer = std::mem::replace(&mut world.renderer, fresh);
        let expected = world.shot(&view);
        world.renderer = renderer;
        for _ in 0..2 {
            assert!(world.shot(&view) == expected);
        }
        seen.push(expected);
    }
    assert!(seen[0] == seen[3]);
    for [a, b] in [[0, 1], [1, 2], [0, 2]] {
        assert!(seen[a].rgb != seen[b].rgb, "{a} and {b}");
    }
}
