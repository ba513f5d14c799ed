//! Renders a house into a folder: two views of every room (colour by each preset, depth, ids), maps of its storeys, and
//! how fast that goes.
//!
//! `cargo run -p dwell-render --example look -- HOUSE OUT [VIEWS.json] [SIZE]`
//!
//! VIEWS.json is a list of `{"position": [x, y, z], "forward": [x, y, z]}`; with it the pictures are of its first views
//! and the rate is measured over all of them.
#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "a program for developers"
)]

use dwell_render::{
    Camera, CpuRenderer, Frame, FrameMut, ImageChannels, Preset, StoreyMap, View, semantic_classes,
};
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{House, Pose, State, space};
use glam::{Vec2, Vec3};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

struct World {
    scene: RayScene,
    state: State,
    renderer: CpuRenderer,
}

impl World {
    fn shot(&self, view: &View) -> Frame {
        let mut frame = Frame::new(&view.camera, ImageChannels::ALL);
        let threads = Threads::default();
        self.renderer
            .render(
                &self.scene,
                &self.state,
                &[*view],
                &mut [frame.as_mut()],
                threads,
            )
            .unwrap();
        frame
    }

    /// Whole passes over the views until two seconds are over; views a second of the fastest pass.
    fn rate(&self, views: &[View], channels: ImageChannels, threads: usize) -> f64 {
        let mut frames: Vec<Frame> = views
            .iter()
            .map(|view| Frame::new(&view.camera, channels))
            .collect();
        let (start, mut best) = (Instant::now(), f64::INFINITY);
        while start.elapsed().as_secs_f64() < 2.0 {
            let mut targets: Vec<FrameMut<'_>> = frames.iter_mut().map(Frame::as_mut).collect();
            let begin = Instant::now();
            self.renderer
                .render(
                    &self.scene,
                    &self.state,
                    views,
                    &mut targets,
                    Threads::new(threads),
                )
                .unwrap();
            best = best.min(begin.elapsed().as_secs_f64());
        }
        views.len() as f64 / best
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let out = Path::new(&arguments[1]);
    std::fs::create_dir_all(out).unwrap();
    let start = Instant::now();
    let (house, _) = dwell_houses::open(&arguments[0]).unwrap();
    let house = Arc::new(house);
    println!("opened in {:.0} ms", start.elapsed().as_secs_f64() * 1e3);
    let start = Instant::now();
    let scene = RayScene::new(house.clone());
    println!("rays in {:.0} ms", start.elapsed().as_secs_f64() * 1e3);
    let start = Instant::now();
    let renderer = CpuRenderer::new(&house);
    println!("renderer in {:.0} ms", start.elapsed().as_secs_f64() * 1e3);
    let world = World {
        scene,
        state: State::new(&house),
        renderer,
    };

    let camera = Camera::from_fov(128, 128, 90.0).unwrap();
    let listed = arguments
        .get(2)
        .filter(|path| {
            Path::new(path)
                .extension()
                .is_some_and(|ending| ending == "json")
        })
        .map(|path| listed_views(Path::new(path), camera));
    let views = listed
        .clone()
        .unwrap_or_else(|| room_views(&house, &world, camera));
    let size = arguments
        .last()
        .and_then(|word| word.parse().ok())
        .unwrap_or(384);
    if size > 0 {
        pictures(&house, &world, &views, size, out);
    }
    let rgb_depth_ids = ImageChannels::default();
    let only_depth = ImageChannels {
        rgb: false,
        instance: false,
        ..rgb_depth_ids
    };
    let lit: Vec<View> = views
        .iter()
        .map(|view| View {
            preset: Preset::Lit,
            ..*view
        })
        .collect();
    for threads in [1, 2] {
        println!(
            "{threads} threads, {} views: flat rgb+depth+instance {:.0}/s, depth {:.0}/s, lit {:.0}/s",
            views.len(),
            world.rate(&views, rgb_depth_ids, threads),
            world.rate(&views, only_depth, threads),
            world.rate(&lit, rgb_depth_ids, threads),
        );
    }
}

fn listed_views(path: &Path, camera: Camera) -> Vec<View> {
    #[derive(serde::Deserialize)]
    struct Listed {
        position: [f32; 3],
        forward: [f32; 3],
    }
    let listed: Vec<Listed> = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    let view = |entry: &Listed| {
        let rotation = space::rotation_from_forward(Vec3::from_array(entry.forward)).unwrap();
        View::new(
            camera,
            Pose::new(Vec3::from_array(entry.position), rotation),
        )
    };
    listed.iter().map(view).collect()
}

/// From the place in each room with the widest view, towards where it is widest, and back.
fn room_views(house: &House, world: &World, camera: Camera) -> Vec<View> {
    let mut views = Vec::new();
    for (id, room) in house.rooms.iter_ids() {
        let (low, high) = room
            .footprint
            .iter()
            .flatten()
            .fold((Vec2::MAX, Vec2::MIN), |(low, high), p| {
                (low.min(*p), high.max(*p))
            });
        let mut best: Option<(f32, View)> = None;
        for k in 0..100 {
            let place =
                low + (high - low) * Vec2::new((k % 10) as f32 + 0.5, (k / 10) as f32 + 0.5) / 10.0;
            let eye = Vec3::new(place.x, room.floor_y + 1.5, place.y);
            if house.room_at(eye) != Some(id) {
                continue;
            }
            for turn in 0..8 {
                let yaw = turn as f32 * std::f32::consts::FRAC_PI_4 + 0.2;
                let pose = Pose::new(eye, space::rotation_from_yaw_pitch(yaw, -0.15));
                let small = View::new(Camera::from_fov(12, 12, 90.0).unwrap(), pose);
                let frame = world.shot(&small);
                let nearest = frame.depth.iter().copied().fold(f32::INFINITY, f32::min);
                // Much to see: many different things, none too near.
                let mut ids = frame.instance.clone();
                ids.sort_unstable();
                ids.dedup();
                let worth = nearest.min(0.7) * ids.len() as f32;
                if best.is_none_or(|(most, _)| worth > most) {
                    best = Some((worth, View::new(camera, pose)));
                }
            }
        }
        views.extend(best.map(|(_, view)| view));
    }
    views
}

fn pictures(house: &House, world: &World, views: &[View], size: u32, out: &Path) {
    let camera = Camera::from_fov(size, size, 90.0).unwrap();
    println!("{} classes", semantic_classes(house).len());
    for (k, view) in views.iter().take(12).enumerate() {
        let view = View { camera, ..*view };
        let [flat, lit, full] = Preset::ALL.map(|preset| world.shot(&View { preset, ..view }));
        let strip = [
            &flat.rgb,
            &lit.rgb,
            &full.rgb,
            &depth_picture(&flat.depth),
            &id_picture(&flat.instance),
        ];
        save(&out.join(format!("view{k:02}.png")), size, size, &strip);
    }
    for level in house.levels.ids() {
        if let Ok(mut map) = StoreyMap::new(house, level, 800) {
            let (width, height) = (map.view.camera.width(), map.view.camera.height());
            for (name, preset) in [("flat", Preset::Flat), ("lit", Preset::Lit)] {
                map.view.preset = preset;
                let mut frame = world.shot(&map.view);
                map.draw_walls(house, &mut frame.rgb);
                save(
                    &out.join(format!("map{}_{name}.png", level.0)),
                    width,
                    height,
                    &[&frame.rgb],
                );
            }
        }
    }
}

/// Near is bright.
fn depth_picture(depth: &[f32]) -> Vec<u8> {
    depth
        .iter()
        .flat_map(|depth| [(255.0 / (1.0 + depth * 0.6)) as u8; 3])
        .collect()
}

/// A colour by id.
fn id_picture(ids: &[i32]) -> Vec<u8> {
    let color = |id: i32| {
        (id as u32)
            .wrapping_mul(2_654_435_761)
            .rotate_left(9)
            .to_le_bytes()
    };
    ids.iter()
        .flat_map(|id| {
            if *id == 0 {
                [0; 3]
            } else {
                [color(*id)[0], color(*id)[1], color(*id)[3]]
            }
        })
        .collect()
}

/// Pictures side by side.
fn save(path: &Path, width: u32, height: u32, images: &[&Vec<u8>]) {
    let mut strip = image::RgbImage::new(width * images.len() as u32, height);
    for (k, rgb) in images.iter().enumerate() {
        let picture = image::RgbImage::from_raw(width, height, (*rgb).clone()).unwrap();
        image::imageops::replace(&mut strip, &picture, i64::from(width) * k as i64, 0);
    }
    strip.save(path).unwrap();
}
