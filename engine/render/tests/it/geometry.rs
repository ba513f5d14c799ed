//! Depth and ids against closed forms and brute force.

#![allow(
    clippy::unwrap_used,
    reason = "tests may stop at the first surprise, and compare bits"
)]

use crate::common;

use common::{Builder, World, look, meets, point, quad};
use dwell_render::{Camera, Projection, semantic_classes};
use dwell_scene::random::RandomKey;
use dwell_scene::{EntityId, House, Mesh, Pose, ShoeboxMaterials, StructureId, space};
use glam::{Vec2, Vec3};

#[test]
fn every_pixel_of_a_room_has_the_depth_and_id_of_the_closed_form() {
    let size = Vec3::new(6.0, 3.0, 5.0);
    let world = World::new(House::shoebox(size.to_array(), &ShoeboxMaterials::default()).unwrap());
    let projection = Projection::Pinhole {
        fx: 40.0,
        fy: 47.0,
        cx: 33.5,
        cy: 28.0,
    };
    let camera = Camera::new(67, 59, projection).unwrap();
    let names = semantic_classes(&world.house);
    let mut stream = RandomKey::root(1).stream();
    for _ in 0..12 {
        let eye = Vec3::new(
            stream.range(0.2, 5.8),
            stream.range(0.2, 2.8),
            stream.range(0.2, 4.8),
        );
        let rotation =
            space::rotation_from_yaw_pitch(stream.range(-3.0, 3.0), stream.range(-1.4, 1.4));
        let view = dwell_render::View::new(camera, Pose::new(eye, rotation));
        let frame = world.shot(&view);
        for y in 0..59 {
            for x in 0..67 {
                let (px, py) = (x as f32 + 0.5, y as f32 + 0.5);
                let direction = rotation * Vec3::new((px - 33.5) / 40.0, (28.0 - py) / 47.0, -1.0);
                // The way to the wall that each axis leads to.
                let walls = [
                    if direction.x > 0.0 {
                        (3, (size.x - eye.x) / direction.x)
                    } else {
                        (2, -eye.x / direction.x)
                    },
                    if direction.y > 0.0 {
                        (1, (size.y - eye.y) / direction.y)
                    } else {
                        (0, -eye.y / direction.y)
                    },
                    if direction.z > 0.0 {
                        (5, (size.z - eye.z) / direction.z)
                    } else {
                        (4, -eye.z / direction.z)
                    },
                ];
                let (side, depth) = walls
                    .into_iter()
                    .min_by(|a, b| a.1.total_cmp(&b.1))
                    .unwrap();
                let k = y * 67 + x;
                assert!(
                    (frame.depth[k] - depth).abs() < 1e-4,
                    "{x} {y}: {} {depth}",
                    frame.depth[k]
                );
                // At an edge between two walls either may be seen.
                let clear = walls.iter().filter(|wall| wall.1 - depth < 1e-3).count() == 1;
                let piece = StructureId(side);
                if clear {
                    assert_eq!(frame.instance[k], world.house.entity_of_structure(piece).0);
                    let class = ["floor", "ceiling", "wall", "wall", "wall", "wall"][side as usize];
                    assert_eq!(names[frame.semantic[k] as usize], class);
                }
            }
        }
    }
}

/// A ball of triangles whose corners lie on the sphere.
fn ball(radius: f32, rings: u32, sectors: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for ring in 0..=rings {
        let (sin, cos) = (std::f32::consts::PI * ring as f32 / rings as f32).sin_cos();
        for sector in 0..=sectors {
            let (s, c) = (std::f32::consts::TAU * sector as f32 / sectors as f32).sin_cos();
            mesh.positions
                .push(Vec3::new(sin * c, cos, sin * s) * radius);
        }
    }
    for ring in 0..rings {
        for sector in 0..sectors {
            let k = ring * (sectors + 1) + sector;
            mesh.triangles.extend([
                [k, k + 1, k + sectors + 1],
                [k + 1, k + sectors + 2, k + sectors + 1],
            ]);
        }
    }
    mesh
}

#[test]
fn a_ball_has_the_silhouette_and_depth_of_a_sphere() {
    let mut builder = Builder::empty();
    let center = Vec3::new(0.3, 0.1, -3.0);
    builder.add(
        "ball",
        ball(0.8, 90, 180),
        Builder::plaster("white"),
        true,
        Pose::from_position(center),
    );
    let world = builder.build();
    let camera = Camera::from_fov(101, 83, 60.0).unwrap();
    let view = look(
        camera,
        Vec3::new(-0.4, 0.6, 0.5),
        center + Vec3::new(0.2, 0.0, 0.0),
    );
    let frame = world.shot(&view);
    let mut seen = 0;
    for k in 0..camera.pixels() {
        let image = Vec2::new((k % 101) as f32 + 0.5, (k / 101) as f32 + 0.5);
        let direction = view.world_from_camera.rotation * camera.ray_in_camera(image).1;
        let to_center = center - view.world_from_camera.position;
        let along = to_center.dot(direction) / direction.length();
        let off_squared = to_center.length_squared() - along * along;
        // A chord of the ball lies within r (1 - cos(1 degree)) of the sphere.
        let (inner, outer) = (0.8_f32 - 0.0006, 0.8_f32 + 1e-4);
        if off_squared < inner * inner {
            let depth = (along - (0.64 - off_squared).max(0.0).sqrt()) / direction.length();
            let slack = 0.0006 / (1.0 - off_squared / 0.64).max(1e-4).sqrt() + 1e-4;
            assert!(
                (frame.depth[k] - depth).abs() < slack,
                "{k}: {} {depth}",
                frame.depth[k]
            );
            assert_eq!(frame.instance[k], 1);
            seen += 1;
        } else if off_squared > outer * outer {
            assert_eq!(
                (frame.instance[k], frame.depth[k], frame.semantic[k]),
                (0, 50.0, 0)
            );
        }
    }
    assert!(seen > 500);
}

#[test]
fn random_triangles_are_seen_as_brute_force_sees_them() {
    let mut stream = RandomKey::root(5).stream();
    let mut builder = Builder::empty();
    let mut all: Vec<([Vec3; 3], i32)> = Vec::new();
    for object in 0..10 {
        let place = Pose::new(
            point(&mut stream, 2.0),
            space::rotation_from_yaw_pitch(stream.range(-3.0, 3.0), 0.4),
        );
        let mut mesh = Mesh::default();
        for k in 0..40_u32 {
            let middle = point(&mut stream, 2.0);
            for _ in 0..3 {
                mesh.positions.push(middle + point(&mut stream, 0.6));
            }
            mesh.triangles.push([3 * k, 3 * k + 1, 3 * k + 2]);
        }
        for k in 0..40 {
            all.push((
                mesh.corners(k).map(|p| place.transform_point(p)),
                object + 1,
            ));
        }
        builder.add(
            &format!("soup{object}"),
            mesh,
            Builder::plaster(&format!("m{object}")),
            object % 2 == 0,
            place,
        );
    }
    let world = builder.build();
    let camera = Camera::from_fov(30, 26, 80.0).unwrap();
    let (mut hits, mut wrong) = (0, 0);
    for _ in 0..6 {
        let view = look(camera, point(&mut stream, 3.0), point(&mut stream, 1.0));
        let frame = world.shot(&view);
        for k in 0..camera.pixels() {
            let image = Vec2::new((k % 30) as f32 + 0.5, (k / 30) as f32 + 0.5);
            let direction = view.world_from_camera.rotation * camera.ray_in_camera(image).1;
            let eye = view.world_from_camera.position;
            let mut found: Vec<(f64, i32)> = all
                .iter()
                .filter_map(|(corners, id)| Some((meets(eye, direction, *corners)?, *id)))
                .filter(|(depth, _)| (0.05..=50.0).contains(depth))
                .collect();
            found.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (depth, id) = found.first().copied().unwrap_or((50.0, 0));
            hits += usize::from(id != 0);
            // A ray that all but touches an edge may go either way in single precision.
            let same = (f64::from(frame.depth[k]) - depth).abs() < 1e-4 * (1.0 + depth)
                && frame.instance[k] == id;
            wrong += usize::from(!same);
        }
    }
    assert!(hits > 2000, "{hits}");
    assert!(wrong <= 2, "{wrong} of {}", 6 * camera.pixels());
}

#[test]
fn of_surfaces_that_coincide_the_lower_id_is_seen() {
    for movable in [[false, false], [true, true], [false, true], [true, false]] {
        let mut builder = Builder::empty();
        let mesh = quad(Vec2::splat(-1.0), Vec2::splat(1.0), -2.0);
        builder.add(
            "first",
            mesh.clone(),
            Builder::plaster("red").with_srgb([200, 0, 0]),
            movable[0],
            Pose::IDENTITY,
        );
        builder.add(
            "second",
            mesh,
            Builder::plaster("blue").with_srgb([0, 0, 200]),
            movable[1],
            Pose::IDENTITY,
        );
        let world = builder.build();
        let camera = Camera::from_fov(20, 20, 30.0).unwrap();
        for eye in [Vec3::ZERO, Vec3::new(0.3, 0.2, -4.0)] {
            let frame = world.shot(&look(camera, eye, Vec3::new(0.0, 0.0, -2.0)));
            assert!(frame.instance.iter().all(|id| *id == 1), "{movable:?}");
            assert!(
                frame
                    .rgb
                    .as_chunks::<3>()
                    .0
                    .iter()
                    .all(|rgb| *rgb == [200, 0, 0]),
                "{movable:?}"
            );
        }
    }
}

#[test]
fn nothing_is_seen_before_near_or_beyond_far() {
    let mut builder = Builder::empty();
    for (k, z) in [-1.0, -2.0, -3.0].into_iter().enumerate() {
        let mesh = quad(Vec2::splat(-9.0), Vec2::splat(9.0), z);
        builder.add(
            &format!("wall{k}"),
            mesh,
            Builder::plaster(&format!("m{k}")),
            false,
            Pose::IDENTITY,
        );
    }
    let world = builder.build();
    let camera = Camera::from_fov(33, 33, 90.0).unwrap();
    let shot = |near: f32, far: f32| {
        let camera = camera.with_range(near, far).unwrap();
        world.shot(&look(camera, Vec3::ZERO, Vec3::NEG_Z))
    };
    // Planes across the axis have one depth; near and far are depths, not distances.
    let all_are = |frame: &dwell_render::Frame, depth: f32, id: i32| {
        frame.depth.iter().all(|d| (d - depth).abs() < 1e-5)
            && frame.instance.iter().all(|i| *i == id)
    };
    assert!(all_are(&shot(0.99, 50.0), 1.0, 1));
    assert!(all_are(&shot(1.01, 50.0), 2.0, 2));
    assert!(all_are(&shot(2.01, 3.01), 3.0, 3));
    assert!(all_are(&shot(2.01, 2.99), 2.99, 0));
}

#[test]
fn a_thing_is_seen_where_its_state_has_it_and_not_at_all_when_hidden() {
    let mut builder = Builder::empty();
    let cube = Mesh::cuboid(Vec3::splat(-0.5), Vec3::splat(0.5));
    builder.add(
        "near",
        cube.clone(),
        Builder::plaster("a"),
        true,
        Pose::from_position(Vec3::new(0.0, 0.0, -2.0)),
    );
    builder.add(
        "far",
        cube,
        Builder::plaster("b"),
        false,
        Pose::from_position(Vec3::new(0.0, 0.0, -5.0)),
    );
    let mut world = builder.build();
    let camera = Camera::from_fov(9, 9, 20.0).unwrap();
    let mut view = look(camera, Vec3::ZERO, Vec3::NEG_Z);
    let middle = |world: &World, view: &dwell_render::View| {
        let frame = world.shot(view);
        (frame.instance[40], frame.depth[40])
    };
    assert_eq!(middle(&world, &view).0, 1);
    view.hidden_entity = Some(EntityId(1));
    let (id, depth) = middle(&world, &view);
    assert_eq!(id, 2);
    assert!((depth - 4.5).abs() < 1e-5);
    view.hidden_entity = None;
    world.state.part_pose[dwell_scene::PartId(0)].position.z = -8.0;
    world.scene.update(&world.state);
    assert_eq!(middle(&world, &view).0, 2);
}

#[test]
fn a_storey_from_above_shows_what_stands_on_its_floor() {
    let house = House::shoebox([4.0, 3.0, 2.0], &ShoeboxMaterials::default()).unwrap();
    let mut builder = Builder::from(&house);
    let table = Mesh::cuboid(Vec3::new(-0.5, 0.0, -0.25), Vec3::new(0.5, 0.7, 0.25));
    builder.add(
        "table",
        table,
        Builder::plaster("table"),
        true,
        Pose::from_position(Vec3::new(1.0, 0.0, 0.5)),
    );
    let world = builder.build();
    let map = dwell_render::StoreyMap::new(&world.house, dwell_scene::LevelId(0), 500).unwrap();
    let frame = world.shot(&map.view);
    let width = map.view.camera.width() as usize;
    let at = |x: f32, z: f32| {
        let p = map.image_from_world(Vec3::new(x, 0.0, z));
        let k = p.y as usize * width + p.x as usize;
        (frame.instance[k], frame.depth[k])
    };
    let table = world.house.entity_of_object(dwell_scene::ObjectId(0)).0;
    for (x, z, id, y) in [
        (1.0, 0.5, table, 0.7),
        (0.52, 0.27, table, 0.7),
        (1.52, 0.5, 1, 0.0),
        (3.9, 1.9, 1, 0.0),
    ] {
        let (found, depth) = at(x, z);
        assert_eq!(found, id, "{x} {z}");
        assert!((depth - (map.cut_y - y)).abs() < 1e-4);
    }
    assert_eq!(at(-0.3, 1.0).0, 0);
}
