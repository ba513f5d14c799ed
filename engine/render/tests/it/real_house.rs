//! The real SUNCG house, where the data lies beside the repository (or at `$DWELL_SHARED_DATA`).
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "tests may stop at the first surprise; a skip is printed"
)]

use crate::common;

use common::World;
use dwell_render::{Camera, Preset, View, semantic_classes};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::units::{linear_from_srgb, srgb_from_linear};
use dwell_scene::{Pose, space};
use glam::{Vec2, Vec3};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

fn house() -> Option<&'static World> {
    static HOUSE: OnceLock<Option<World>> = OnceLock::new();
    let open = || {
        let data = std::env::var_os("DWELL_SHARED_DATA").map_or_else(
            || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"),
            PathBuf::from,
        );
        let root = data.join("suncg");
        if !root.is_dir() {
            println!("skipped: no SUNCG data at {}", root.display());
            return None;
        }
        Some(World::new(dwell_houses::open(root.to_str()?).unwrap().0))
    };
    HOUSE.get_or_init(open).as_ref()
}

/// Two views in every room.
fn views(world: &World, camera: Camera) -> Vec<View> {
    let mut views = Vec::new();
    for room in &world.house.rooms {
        // The middle of the largest triangle of the floor lies well inside the room.
        let area = |t: &&[Vec2; 3]| (t[1] - t[0]).perp_dot(t[2] - t[0]).abs();
        let largest = room
            .footprint
            .iter()
            .max_by(|s, t| area(s).total_cmp(&area(t)));
        let [a, b, c] = largest.unwrap();
        let middle = (*a + *b + *c) / 3.0;
        for yaw in [0.4, 2.9] {
            let eye = Vec3::new(middle.x, room.floor_y + 1.4, middle.y);
            views.push(View::new(
                camera,
                Pose::new(eye, space::rotation_from_yaw_pitch(yaw, -0.2)),
            ));
        }
    }
    views
}

#[test]
fn pictures_agree_with_single_rays() {
    let Some(world) = house() else { return };
    let camera = Camera::from_fov(61, 47, 85.0).unwrap();
    for view in views(world, camera) {
        let frame = world.shot(&view);
        for k in 0..camera.pixels() {
            let image = Vec2::new((k % 61) as f32 + 0.5, (k / 61) as f32 + 0.5);
            let way = view.world_from_camera.rotation * camera.ray_in_camera(image).1;
            let near_m = camera.near_m() * way.length();
            let ray =
                Ray::new(view.world_from_camera.position, way).with_range(near_m, f32::INFINITY);
            let hit = world.scene.closest(&ray, RayMask::EYE);
            let depth = hit.map_or(50.0, |hit| hit.distance_m / way.length());
            // Directions differ in their last bits; a ray past an edge may meet what lies behind.
            let same = (frame.depth[k] - depth).abs() < 1e-4 * (1.0 + depth);
            let id = hit.map_or(0, |hit| hit.id);
            assert!(
                !same || frame.instance[k] == id,
                "{k}: {} {id}",
                frame.instance[k]
            );
            assert!(
                same || edge(world, &view, k),
                "{k}: {} {depth}",
                frame.depth[k]
            );
        }
    }
}

/// Returns whether rays a thousandth of a pixel apart see different things.
fn edge(world: &World, view: &View, k: usize) -> bool {
    let width = view.camera.width() as usize;
    let image = Vec2::new((k % width) as f32 + 0.5, (k / width) as f32 + 0.5);
    let depths: Vec<f32> = [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y]
        .into_iter()
        .map(|off| {
            let way =
                view.world_from_camera.rotation * view.camera.ray_in_camera(image + off * 1e-3).1;
            let hit = world.scene.closest(
                &Ray::new(view.world_from_camera.position, way),
                RayMask::EYE,
            );
            hit.map_or(50.0, |hit| hit.distance_m / way.length())
        })
        .collect();
    depths
        .iter()
        .any(|depth| (depth - depths[0]).abs() > 1e-3 * depths[0])
}

#[test]
fn textures_lie_where_the_scene_says() {
    let Some(world) = house() else { return };
    let camera = Camera::from_fov(64, 64, 1.0).unwrap();
    // So narrow a view magnifies: no smaller level is used, and texels are larger than pixels.
    let (mut compared, mut wrong) = (0, 0);
    for mut view in views(world, camera) {
        for pitch in [-1.2, -0.6, -0.1] {
            view.world_from_camera.rotation = space::rotation_from_yaw_pitch(0.7, pitch);
            let frame = world.shot(&view);
            for k in (0..camera.pixels()).step_by(37) {
                let image = Vec2::new((k % 64) as f32 + 0.5, (k / 64) as f32 + 0.5);
                let way = view.world_from_camera.rotation * camera.ray_in_camera(image).1;
                let ray = Ray::new(view.world_from_camera.position, way);
                let Some(hit) = world.scene.closest(&ray, RayMask::EYE) else {
                    continue;
                };
                let material = &world.house.materials[world.scene.surface(&hit).material];
                let Some(texture) = material.texture.filter(|_| material.opacity >= 1.0) else {
                    continue;
                };
                let texture = &world.house.textures[texture];
                let uv = world.scene.uv(&hit);
                // The texels around the place span what interpolation can give.
                let place = Vec2::new(uv.x, 1.0 - uv.y)
                    * Vec2::new(texture.width as f32, texture.height as f32);
                let (mut low, mut high) = ([255_u8; 3], [0_u8; 3]);
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let x =
                        ((place.x - 0.5).floor() as i64 + dx).rem_euclid(i64::from(texture.width));
                    let y =
                        ((place.y - 0.5).floor() as i64 + dy).rem_euclid(i64::from(texture.height));
                    let first = (y as usize * texture.width as usize + x as usize) * 4;
                    for c in 0..3 {
                        low[c] = low[c].min(texture.rgba()[first + c]);
                        high[c] = high[c].max(texture.rgba()[first + c]);
                    }
                }
                compared += 1;
                let tinted = |byte: u8, c: usize| {
                    srgb_from_linear(
                        linear_from_srgb(f32::from(byte) / 255.0) * material.base_color[c],
                    ) * 255.0
                };
                let within = (0..3).all(|c| {
                    let found = f32::from(frame.rgb[k * 3 + c]);
                    found > tinted(low[c], c) - 3.0 && found < tinted(high[c], c) + 3.0
                });
                wrong += usize::from(!within);
            }
        }
    }
    assert!(compared > 500, "{compared}");
    // Some surfaces are so fine or so oblique that a smaller level is right.
    assert!(wrong * 20 < compared, "{wrong} of {compared}");
}

#[test]
fn rooms_look_like_rooms() {
    let Some(world) = house() else { return };
    let camera = Camera::from_fov(64, 64, 90.0).unwrap();
    let names = semantic_classes(&world.house);
    let mut seen = BTreeSet::new();
    for mut view in views(world, camera) {
        let flat = world.shot(&view);
        seen.extend(
            flat.semantic
                .iter()
                .map(|class| names[*class as usize].clone()),
        );
        let void = flat.instance.iter().filter(|id| **id == 0).count();
        assert!(void * 5 < camera.pixels(), "{void} pixels of nothing");
        view.preset = Preset::Lit;
        let lit = world.shot(&view);
        assert!(lit.depth == flat.depth && lit.instance == flat.instance);
        // Neither dark nor burnt out.
        let mean = lit.rgb.iter().map(|byte| u64::from(*byte)).sum::<u64>() / lit.rgb.len() as u64;
        let white = lit
            .rgb
            .as_chunks::<3>()
            .0
            .iter()
            .filter(|rgb| **rgb == [255; 3])
            .count();
        assert!(
            (50..225).contains(&mean) && white * 8 < camera.pixels(),
            "{mean} {white}"
        );
    }
    for name in ["wall", "floor", "ceiling", "window", "door"] {
        assert!(seen.contains(name), "{name} of {seen:?}");
    }
}
