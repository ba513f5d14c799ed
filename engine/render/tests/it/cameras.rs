//! Cameras of every kind in rooms whose pictures can be worked out.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;

use common::World;
use dwell_render::{Camera, Projection, View};
use dwell_scene::parallel::Threads;
use dwell_scene::space::rotation_from_yaw_pitch;
use dwell_scene::{House, Pose, ShoeboxMaterials};
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, PI};

const SIZE: Vec3 = Vec3::new(6.0, 3.0, 5.0);
const EYE: Vec3 = Vec3::new(2.3, 1.3, 3.1);

fn room() -> World {
    World::new(House::shoebox(SIZE.to_array(), &ShoeboxMaterials::default()).unwrap())
}

/// Returns where a ray from [`EYE`] leaves the room: distance, and the wall's inward normal.
fn wall(direction: Vec3) -> (f32, Vec3) {
    let mut nearest = (f32::INFINITY, Vec3::ZERO);
    for axis in 0..3 {
        let (end, normal) = if direction[axis] > 0.0 {
            (SIZE[axis], -1.0)
        } else {
            (0.0, 1.0)
        };
        let distance = (end - EYE[axis]) / direction[axis];
        if distance < nearest.0 {
            let mut inward = Vec3::ZERO;
            inward[axis] = normal;
            nearest = (distance, inward);
        }
    }
    nearest
}

fn middle(camera: &Camera, pixel: usize) -> Vec2 {
    let width = camera.width() as usize;
    Vec2::new((pixel % width) as f32 + 0.5, (pixel / width) as f32 + 0.5)
}

/// Every pixel of an equirectangular picture of a room, in closed form.
#[test]
fn an_equirectangular_picture_of_a_room_is_as_worked_out() {
    let camera = Camera::equirectangular(128).unwrap();
    let yaw = 0.7;
    let pose = Pose::new(EYE, rotation_from_yaw_pitch(yaw, 0.0));
    let frame = room().shot(&View::new(camera, pose));
    for pixel in 0..camera.pixels() {
        let image = middle(&camera, pixel);
        let azimuth = yaw - (image.x / 128.0 - 0.5) * 2.0 * PI;
        let elevation = (0.5 - image.y / 64.0) * PI;
        let direction = Vec3::new(
            -azimuth.sin() * elevation.cos(),
            elevation.sin(),
            -azimuth.cos() * elevation.cos(),
        );
        let (range, normal) = wall(direction);
        assert!(
            (frame.depth[pixel] - range).abs() < 1e-4 * range,
            "{image}: {} instead of {range}",
            frame.depth[pixel]
        );
        let found = Vec3::from_slice(&frame.normals[3 * pixel..3 * pixel + 3]);
        let expected = pose.rotation.inverse() * normal;
        // Where walls meet either may be seen.
        let edge = (frame.depth[pixel] - range).abs() > 1e-5 * range;
        assert!(
            edge || (found - expected).length() < 1e-4,
            "{image} {found} {expected}"
        );
    }
}

/// Fisheyes and lenses: depth of every pixel is the distance of the wall along the ray that their formulas give.
#[test]
fn fisheyes_and_lenses_see_the_walls_where_their_rays_end() {
    let world = room();
    let fisheye = |k1: f32, half_angle_deg: f32| Projection::Fisheye {
        fx: 30.0,
        fy: 30.0,
        cx: 48.0,
        cy: 40.0,
        k1,
        k2: 0.0,
        k3: 0.0,
        k4: 0.0,
        half_angle_deg,
    };
    let lens = Projection::BrownConrady {
        fx: 60.0,
        fy: 60.0,
        cx: 48.0,
        cy: 40.0,
        k1: -0.1,
        k2: 0.0,
        k3: 0.0,
        p1: 0.001,
        p2: 0.002,
    };
    let pose = Pose::new(EYE, rotation_from_yaw_pitch(-0.4, 0.2));
    for (projection, is_range) in [
        (fisheye(0.0, 70.0), true),
        (fisheye(0.06, 80.0), true),
        (lens, false),
    ] {
        let camera = Camera::new(96, 80, projection).unwrap();
        let frame = world.shot(&View::new(camera, pose));
        let mut dark = 0;
        for pixel in 0..camera.pixels() {
            let (_, direction) = camera.ray_in_camera(middle(&camera, pixel));
            if direction == Vec3::ZERO {
                assert_eq!(
                    (frame.depth[pixel], frame.instance[pixel]),
                    (camera.far_m(), 0)
                );
                assert_eq!(frame.rgb[3 * pixel..3 * pixel + 3], [0; 3]);
                assert_eq!(frame.normals[3 * pixel..3 * pixel + 3], [0.0; 3]);
                dark += 1;
                continue;
            }
            let (range, _) = wall((pose.rotation * direction).normalize());
            let depth = if is_range {
                range
            } else {
                range / direction.length()
            };
            assert!(
                (frame.depth[pixel] - depth).abs() < 2e-4 * depth,
                "{projection:?} {pixel}"
            );
        }
        // The corners of the image lie beyond the half angle of the first two.
        assert_eq!(dark > 0, is_range, "{projection:?}");
    }
}

/// Each face shows what a pinhole of 90 degrees shows that is turned there.
#[test]
fn a_cube_map_agrees_with_six_pinholes() {
    let world = World::new(dwell_houses::open("builtin:studio").unwrap().0);
    let house = &world.house;
    let room = house.rooms.iter().next().unwrap();
    let bounds = dwell_scene::Aabb::from_points(
        room.footprint
            .iter()
            .flatten()
            .map(|p| Vec3::new(p.x, room.floor_y, p.y)),
    );
    let eye = Pose::new(
        bounds.center() + Vec3::Y * 1.3,
        rotation_from_yaw_pitch(0.3, 0.0),
    );
    let edge = 64;
    let cube = Camera::cubemap(edge).unwrap();
    let all = world.shot_with(&View::new(cube, eye), Threads::new(2));
    let pinhole = Camera::from_fov(edge, edge, 90.0).unwrap();
    let turns = [
        (0.0, 0.0),
        (FRAC_PI_2, 0.0),
        (PI, 0.0),
        (-FRAC_PI_2, 0.0),
        (0.0, FRAC_PI_2),
        (0.0, -FRAC_PI_2),
    ];
    let pixels = (edge * edge) as usize;
    let (mut same, mut rough) = (0, 0);
    for (face, (yaw, pitch)) in turns.into_iter().enumerate() {
        let pose = Pose::new(
            eye.position,
            eye.rotation * rotation_from_yaw_pitch(yaw, pitch),
        );
        let one = world.shot(&View::new(pinhole, pose));
        for pixel in 0..pixels {
            let whole = face * pixels + pixel;
            if all.instance[whole] != one.instance[pixel] {
                continue;
            }
            same += 1;
            let length = pinhole.ray_in_camera(middle(&pinhole, pixel)).1.length();
            let range = one.depth[pixel] * length;
            // At the edge of a thing the two may see different sides of it.
            rough += usize::from((all.depth[whole] - range).abs() > 1e-3 * range);
        }
    }
    // Rays differ in their last bits, so that a few pixels at edges see something else.
    assert!(same * 1000 > 6 * pixels * 998, "{same} of {}", 6 * pixels);
    assert!(rough * 1000 < 6 * pixels, "{rough} of {}", 6 * pixels);
}

/// A picture from above: the floor's pattern is where the plan says, and depth is the height below the camera.
#[test]
fn an_orthographic_camera_from_above_draws_the_plan() {
    let camera = Camera::orthographic(80, 60, 8.0, 6.0).unwrap();
    let pose = Pose::new(
        Vec3::new(3.0, 2.5, 2.5),
        rotation_from_yaw_pitch(0.0, -FRAC_PI_2),
    );
    let frame = room().shot(&View::new(camera, pose));
    for pixel in 0..camera.pixels() {
        let image = middle(&camera, pixel);
        let (x, z) = (image.x / 10.0 - 1.0, image.y / 10.0 - 0.5);
        let inside = x > 0.05 && x < SIZE.x - 0.05 && z > 0.05 && z < SIZE.z - 0.05;
        if inside {
            assert!((frame.depth[pixel] - 2.5).abs() < 1e-4, "{x} {z}");
        } else if !(-0.05..=SIZE.x + 0.05).contains(&x) {
            assert_eq!(frame.instance[pixel], 0);
        }
    }
}
