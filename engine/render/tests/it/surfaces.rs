//! Normals, reflectance, movement and lists of things, against formulas and brute force.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;

use common::{Builder, World, look, meets, quad};
use dwell_render::{Camera, Frame, ImageChannels, PreviousPoses, RenderJob, View, visible_objects};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::space::rotation_from_yaw_pitch;
use dwell_scene::{
    Aabb, AgentBody, AgentState, EntityId, House, Id, Mesh, ObjectId, PartId, Pose,
    ShoeboxMaterials, space,
};
use glam::{Quat, Vec2, Vec3};

fn middle(camera: &Camera, pixel: usize) -> Vec2 {
    let width = camera.width() as usize;
    Vec2::new((pixel % width) as f32 + 0.5, (pixel / width) as f32 + 0.5)
}

fn cuboid(half: Vec3) -> Mesh {
    Mesh::cuboid(-half, half)
}

/// The flow of a view whose camera and things were elsewhere before.
fn flow(world: &World, view: &View, before: PreviousPoses<'_>) -> Vec<Vec2> {
    let channels = ImageChannels {
        flow: true,
        ..ImageChannels::NONE
    };
    let mut frame = Frame::new(&view.camera, channels);
    let mut job = [RenderJob {
        before: Some(before),
        ..RenderJob::new(&world.scene, &world.state, *view, frame.as_mut())
    }];
    world.renderer.render_batch(&mut job, Threads::ONE).unwrap();
    frame.flow.chunks_exact(2).map(Vec2::from_slice).collect()
}

/// A wall 2 m away. Sideways by t: f t / z everywhere. Ahead by t: outwards by r t / (z + t) at the radius r now.
#[test]
fn translation_before_a_plane_flows_as_worked_out() {
    let mut builder = Builder::empty();
    let wall = quad(Vec2::splat(-50.0), Vec2::splat(50.0), -2.0);
    builder.add(
        "wall",
        wall,
        Builder::plaster("grey"),
        false,
        Pose::IDENTITY,
    );
    let world = builder.build();
    let camera = Camera::from_fov(64, 48, 90.0).unwrap();
    let view = View::new(camera, Pose::IDENTITY);
    let from = |x: f32, y: f32, z: f32| PreviousPoses {
        world_from_camera: Pose::from_position(Vec3::new(x, y, z)),
        moved_parts: &[],
        agents: &[],
        persons: &[],
    };
    // The camera went right by 0.1 m and down by 0.05 m: things go left and up.
    for flow in flow(&world, &view, from(-0.1, 0.05, 0.0)) {
        let expected = Vec2::new(-32.0 * 0.1 / 2.0, -32.0 * 0.05 / 2.0);
        assert!((flow - expected).length() < 1e-3, "{flow}");
    }
    // It went ahead by 0.2 m.
    for (pixel, flow) in flow(&world, &view, from(0.0, 0.0, 0.2))
        .into_iter()
        .enumerate()
    {
        let radius = middle(&camera, pixel) - Vec2::new(32.0, 24.0);
        assert!((flow - radius * 0.2 / 2.2).length() < 1e-3, "{flow}");
    }
    // It turned to the left by 0.1 rad: a pixel at the angle a from the axis was at a - 0.1 (to the right is positive).
    let turned = PreviousPoses {
        world_from_camera: Pose::new(Vec3::ZERO, rotation_from_yaw_pitch(-0.1, 0.0)),
        ..from(0.0, 0.0, 0.0)
    };
    let flows = flow(&world, &view, turned);
    for column in 0..64 {
        // The row just below the axis, nearly on it.
        let found = flows[24 * 64 + column].x;
        let x = column as f32 + 0.5 - 32.0;
        let was = 32.0 * ((x / 32.0).atan() - 0.1).tan();
        assert!((found - (x - was)).abs() < 2e-2, "{column} {found}");
    }
    // At rest nothing flows.
    assert!(
        flow(&world, &view, from(0.0, 0.0, 0.0))
            .iter()
            .all(|flow| flow.length() < 1e-4)
    );
}

/// A box that slides and turns before a wall at rest: every pixel of it against its own point, worked out from the two poses.
#[test]
fn what_moves_flows_and_what_rests_does_not() {
    let mut builder = Builder::empty();
    let wall = quad(Vec2::splat(-50.0), Vec2::splat(50.0), -4.0);
    builder.add(
        "wall",
        wall,
        Builder::plaster("grey"),
        false,
        Pose::IDENTITY,
    );
    let now = Pose::new(Vec3::new(0.2, 0.1, -2.0), rotation_from_yaw_pitch(0.5, 0.2));
    let was = Pose::new(
        Vec3::new(0.0, 0.15, -2.1),
        rotation_from_yaw_pitch(0.3, 0.2),
    );
    let thing = builder.add(
        "box",
        cuboid(Vec3::splat(0.4)),
        Builder::plaster("red"),
        true,
        now,
    );
    let world = builder.build();
    let part = world.house.objects[thing].first_part;
    let camera = Camera::from_fov(64, 48, 90.0).unwrap();
    let view = View::new(camera, Pose::IDENTITY);
    let before = PreviousPoses {
        world_from_camera: Pose::IDENTITY,
        moved_parts: &[(part, was)],
        agents: &[],
        persons: &[],
    };
    let (frame, flows) = (world.shot(&view), flow(&world, &view, before));
    let id = world.house.entity_of_object(thing).0;
    let mut seen = 0;
    for (pixel, found) in flows.iter().enumerate() {
        if frame.instance[pixel] != id {
            assert!(found.length() < 1e-4);
            continue;
        }
        seen += 1;
        let image = middle(&camera, pixel);
        let (_, direction) = camera.ray_in_camera(image);
        let point = direction * frame.depth[pixel];
        let earlier = was.transform_point(now.inverse().transform_point(point));
        let expected = image - camera.project(earlier).unwrap().0;
        assert!((*found - expected).length() < 1e-2, "{found} {expected}");
    }
    assert!(seen > 100);
}

/// Spheres of stars: what is infinitely far away flows by turning alone, in pinholes and all around.
#[test]
fn nothing_flows_as_if_it_were_far_away() {
    let world = Builder::empty().build();
    let camera = Camera::equirectangular(64).unwrap();
    let view = View::new(camera, Pose::IDENTITY);
    let before = PreviousPoses {
        world_from_camera: Pose::new(Vec3::new(1.0, 2.0, 3.0), rotation_from_yaw_pitch(0.3, 0.0)),
        moved_parts: &[],
        agents: &[],
        persons: &[],
    };
    // Turned to the right by 0.3 rad: everything goes left by 64 · 0.3 / 2 pi columns.
    for flow in flow(&world, &view, before) {
        let expected = Vec2::new(-64.0 * 0.3 / std::f32::consts::TAU, 0.0);
        assert!((flow - expected).length() < 1e-2, "{flow}");
    }
}

/// In a room whose walls have colours of their own.
#[test]
fn normals_and_reflectance_are_those_of_the_walls() {
    let house = House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
    let mut builder = Builder::from(&house);
    for (k, material) in builder.data.materials.iter_mut().enumerate() {
        material.base_color = [0.1 * k as f32, 0.5, 0.9 - 0.1 * k as f32];
        material.texture = None;
    }
    let world = builder.build();
    let camera = Camera::from_fov(40, 30, 100.0).unwrap();
    let view = look(camera, Vec3::new(1.0, 2.0, 4.0), Vec3::new(4.0, 0.5, 1.0));
    let frame = world.shot(&view);
    for pixel in 0..camera.pixels() {
        let structure =
            &world.house.structure[dwell_scene::StructureId((frame.instance[pixel] - 1) as u32)];
        let color = world.house.materials[structure.materials[0]].base_color;
        assert_eq!(frame.albedo[3 * pixel..3 * pixel + 3], color);
        let normal = Vec3::from_slice(&frame.normals[3 * pixel..3 * pixel + 3]);
        let in_world = view.world_from_camera.rotation * normal;
        assert!((in_world.abs().max_element() - 1.0).abs() < 1e-5);
        let (_, ray) = camera.ray_in_camera(middle(&camera, pixel));
        assert!(normal.dot(ray) < 0.0, "it faces the camera");
        // The plane through the point with this normal is a wall: its distance from the middle is half the room.
        let point = view
            .world_from_camera
            .transform_point(ray * frame.depth[pixel]);
        let away = (point - Vec3::new(3.0, 1.5, 2.5)).dot(-in_world);
        let half = in_world.abs().dot(Vec3::new(3.0, 1.5, 2.5));
        assert!((away - half).abs() < 1e-3, "{away} {half}");
    }
}

/// Counts, boxes and what is hidden of a heap of boxes, against every triangle for every pixel.
#[test]
fn lists_of_things_agree_with_brute_force() {
    for seed in 0..3 {
        let mut stream = RandomKey::root(seed).stream();
        let mut builder = Builder::empty();
        for k in 0..9 {
            let place = Pose::new(
                Vec3::new(
                    stream.range(-1.5, 1.5),
                    stream.range(-1.0, 1.0),
                    stream.range(-5.0, -2.0),
                ),
                rotation_from_yaw_pitch(stream.range(-3.0, 3.0), stream.range(-1.0, 1.0)),
            );
            let half = Vec3::new(
                stream.range(0.1, 0.6),
                stream.range(0.1, 0.6),
                stream.range(0.1, 0.6),
            );
            builder.add(
                &format!("box_{k}"),
                cuboid(half),
                Builder::plaster(&format!("grey_{k}")),
                k % 2 == 0,
                place,
            );
        }
        let world = builder.build();
        let pinhole = Camera::from_fov(40, 30, 80.0).unwrap();
        for camera in [pinhole, Camera::equirectangular(48).unwrap()] {
            let view = View::new(camera, Pose::IDENTITY);
            let frame = world.shot(&view);
            let things = visible_objects(&frame.instance, camera.width());
            for thing in &things {
                let shows = |pixel: &usize| frame.instance[*pixel] == thing.entity.0;
                let pixels: Vec<Vec2> = (0..camera.pixels())
                    .filter(shows)
                    .map(|pixel| middle(&camera, pixel))
                    .collect();
                assert_eq!(pixels.len(), thing.pixels as usize);
                let low = pixels.iter().copied().reduce(Vec2::min).unwrap() - 0.5;
                let high = pixels.iter().copied().reduce(Vec2::max).unwrap() + 0.5;
                assert_eq!(
                    (low, high),
                    (
                        Vec2::new(thing.first_pixel[0] as f32, thing.first_pixel[1] as f32),
                        Vec2::new(thing.end_pixel[0] as f32, thing.end_pixel[1] as f32),
                    )
                );
            }
            for object in 0..9 {
                let entity = world.house.entity_of_object(ObjectId(object));
                let part = &world.house.parts[PartId(object)];
                let mesh = &world.house.meshes[part.mesh];
                let meets_it = |pixel: usize| {
                    let (_, ray) = camera.ray_in_camera(middle(&camera, pixel));
                    (0..mesh.triangles.len()).any(|triangle| {
                        let corners = mesh
                            .corners(triangle)
                            .map(|p| part.world_from_part.transform_point(p));
                        meets(Vec3::ZERO, ray, corners).is_some()
                    })
                };
                let expected = (0..camera.pixels())
                    .filter(|pixel| meets_it(*pixel))
                    .count() as i64;
                let alone = world.renderer.unoccluded_pixel_count(
                    &world.scene,
                    &world.state,
                    &view,
                    entity,
                );
                // A ray through an edge may count either way.
                assert!(
                    (i64::from(alone) - expected).abs() <= 1,
                    "{alone} {expected}"
                );
                let seen = things.iter().find(|thing| thing.entity == entity);
                assert!(seen.map_or(0, |seen| seen.pixels) <= alone + 1);
            }
            assert_eq!(
                world.renderer.unoccluded_pixel_count(
                    &world.scene,
                    &world.state,
                    &view,
                    EntityId(0)
                ),
                0
            );
        }
    }
}

/// Half of a square behind another: half of its pixels.
#[test]
fn half_hidden_is_half_the_pixels() {
    let mut builder = Builder::empty();
    let far = quad(Vec2::splat(-1.0), Vec2::splat(1.0), -4.0);
    let near = quad(Vec2::new(0.0, -2.0), Vec2::new(3.0, 2.0), -3.0);
    let back = builder.add("back", far, Builder::plaster("red"), false, Pose::IDENTITY);
    builder.add(
        "front",
        near,
        Builder::plaster("blue"),
        true,
        Pose::IDENTITY,
    );
    let world = builder.build();
    let camera = Camera::from_fov(64, 64, 90.0).unwrap();
    let view = View::new(camera, Pose::IDENTITY);
    let things = visible_objects(&world.shot(&view).instance, 64);
    let entity = world.house.entity_of_object(back);
    let seen = things.iter().find(|thing| thing.entity == entity).unwrap();
    let alone = world
        .renderer
        .unoccluded_pixel_count(&world.scene, &world.state, &view, entity);
    // 2 m at 4 m: 16 by 16 pixels.
    assert_eq!((seen.pixels, alone), (128, 256));
    assert_eq!((seen.first_pixel, seen.end_pixel), ([24, 24], [32, 40]));
}

/// A box has the size of its mesh and turns with it; its corners bound the pixels that show it.
#[test]
fn oriented_boxes_turn_with_their_things() {
    let mut builder = Builder::empty();
    let half = Vec3::new(0.5, 0.2, 0.3);
    let place = Pose::new(
        Vec3::new(0.3, -0.1, -3.0),
        rotation_from_yaw_pitch(0.6, 0.3),
    );
    let thing = builder.add("box", cuboid(half), Builder::plaster("red"), true, place);
    let mut world = builder.build();
    let entity = world.house.entity_of_object(thing);
    let moved = Pose::new(
        Vec3::new(-0.4, 0.2, -2.5),
        rotation_from_yaw_pitch(-1.0, 0.1),
    );
    for place in [place, moved] {
        world.state.part_pose[PartId(0)] = place;
        world.scene.update(&world.state);
        let found = world.renderer.oriented_box(&world.state, entity).unwrap();
        assert!((found.size - 2.0 * half).length() < 1e-5);
        assert!((found.world_from_box.position - place.position).length() < 1e-5);
        assert!(found.world_from_box.rotation.dot(place.rotation).abs() > 1.0 - 1e-6);
        let camera = Camera::from_fov(64, 48, 90.0).unwrap();
        let seen = visible_objects(&world.shot(&View::new(camera, Pose::IDENTITY)).instance, 64)[0];
        let corners = Aabb::new(-0.5 * found.size, 0.5 * found.size).corners();
        let images = corners.map(|corner| {
            camera
                .project(found.world_from_box.transform_point(corner))
                .unwrap()
                .0
        });
        let low = images.into_iter().reduce(Vec2::min).unwrap();
        let high = images.into_iter().reduce(Vec2::max).unwrap();
        for axis in 0..2 {
            // Pixels whose middles lie inside.
            assert!((seen.first_pixel[axis] as f32 - low[axis]).abs() < 1.5);
            assert!((seen.end_pixel[axis] as f32 - high[axis]).abs() < 1.5);
        }
    }
    assert!(
        world
            .renderer
            .oriented_box(&world.state, EntityId(0))
            .is_none()
    );
}

/// Agents are seen as capsules of their size, as persons, and not by the camera that they carry.
#[test]
fn cameras_see_agents_bodies() {
    let house = House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
    let mut world = World::new(house);
    let body = AgentBody::default();
    for x in [1.0, 4.0] {
        let feet = Vec3::new(x, 0.0, 2.5);
        world.state.agents.push(AgentState::new(body, feet, 0.0));
    }
    world.scene.update(&world.state);
    let [own, other] = [0, 1].map(|k| world.house.entity_of_agent(dwell_scene::AgentId(k)));
    let camera = Camera::from_fov(120, 90, 90.0).unwrap();
    let eye = Vec3::new(1.0, 1.0, 2.5);
    let pose = Pose::new(eye, space::rotation_from_forward(Vec3::X).unwrap());
    let view = View {
        hidden_entity: Some(own),
        ..View::new(camera, pose)
    };
    let frame = world.shot(&view);
    let things = visible_objects(&frame.instance, 120);
    let seen = things.iter().find(|thing| thing.entity == other).unwrap();
    assert!(things.iter().all(|thing| thing.entity != own));
    // Twice the angle whose sine is radius / distance, 60 pixels a unit of its tangent.
    let width = 2.0 * 60.0 * (body.radius_m / 3.0).asin().tan();
    let found = (seen.end_pixel[0] - seen.first_pixel[0]) as f32;
    assert!((found - width).abs() < 1.5, "{found} {width}");
    // From the feet 1 m below the eye to the crown, at about 3 m.
    let height = 60.0 * body.height_m / 3.0;
    let found = (seen.end_pixel[1] - seen.first_pixel[1]) as f32;
    assert!((found - height).abs() < 3.0, "{found} {height}");
    let names = dwell_render::semantic_classes(&world.house);
    let pixel = 45 * 120 + 60;
    assert_eq!(frame.instance[pixel], other.0);
    assert_eq!(names[frame.semantic[pixel] as usize], "person");
    assert!((frame.depth[pixel] - (3.0 - body.radius_m)).abs() < 0.01);
    let normal = Vec3::from_slice(&frame.normals[3 * pixel..3 * pixel + 3]);
    assert!((normal - Vec3::Z).length() < 0.2);
    let alone = world
        .renderer
        .unoccluded_pixel_count(&world.scene, &world.state, &view, other);
    assert_eq!(alone, seen.pixels);
    let bounds = world.renderer.oriented_box(&world.state, other).unwrap();
    assert!(
        (bounds.size - Vec3::new(2.0 * body.radius_m, body.height_m, 2.0 * body.radius_m)).length()
            < 1e-5
    );
    assert!(bounds.world_from_box.rotation.dot(Quat::IDENTITY).abs() > 1.0 - 1e-6);
    // The other one steps towards the eye: flow grows outwards from the middle.
    let before = PreviousPoses {
        world_from_camera: pose,
        moved_parts: &[],
        agents: &[Vec3::new(1.0, 0.0, 2.5), Vec3::new(4.2, 0.0, 2.5)],
        persons: &[],
    };
    let flows = flow(&world, &view, before);
    let z = frame.depth[pixel];
    let radius = middle(&camera, pixel) - Vec2::new(60.0, 45.0);
    assert!((flows[pixel] - radius * 0.2 / (z + 0.2)).length() < 1e-2);
    assert_eq!(
        other.0 as usize,
        1 + world.house.structure.len() + 1 + world.house.objects.len()
    );
    assert_eq!(world.state.agents.ids().next().map(Id::index), Some(0));
}
