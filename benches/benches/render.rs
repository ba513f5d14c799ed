//! Views a second of the `cpu` back end: 128 by 128 pixels, 90 degrees, colour, depth and instance.
//!
//! In `builtin:apartment`, and in the SUNCG house at `$DWELL_SHARED_DATA` (else `../shared/data` beside the repository)
//! where there is one. Views stand in every room, four directions each.
#![allow(clippy::unwrap_used, reason = "a bench may stop at the first surprise")]

use divan::Bencher;
use divan::counter::ItemsCount;
use dwell_render::{Camera, CpuRenderer, Frame, FrameMut, ImageChannels, Preset, View};
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{House, Pose, State};
use glam::Vec3;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

fn main() {
    divan::main();
}

struct World {
    scene: RayScene,
    state: State,
    renderer: CpuRenderer,
    views: Vec<View>,
}

impl World {
    fn new(house: House) -> Self {
        let house = Arc::new(house);
        let camera = Camera::from_fov(128, 128, 90.0).unwrap();
        let mut views = Vec::new();
        for room in &house.rooms {
            // The middle of the largest triangle of the floor lies well inside the room.
            let area = |t: &&[glam::Vec2; 3]| (t[1] - t[0]).perp_dot(t[2] - t[0]).abs();
            let Some([a, b, c]) = room
                .footprint
                .iter()
                .max_by(|s, t| area(s).total_cmp(&area(t)))
            else {
                continue;
            };
            let middle = (*a + *b + *c) / 3.0;
            let eye = Vec3::new(middle.x, room.floor_y + 1.2, middle.y);
            for turn in 0..4 {
                let yaw = 0.3 + turn as f32 * std::f32::consts::FRAC_PI_2;
                views.push(View::new(camera, Pose::from_position_yaw(eye, yaw)));
            }
        }
        Self {
            scene: RayScene::new(house.clone()),
            state: State::new(&house),
            renderer: CpuRenderer::new(&house),
            views,
        }
    }

    fn bench(&self, bencher: Bencher, preset: Preset, channels: ImageChannels, threads: usize) {
        let views: Vec<View> = self
            .views
            .iter()
            .map(|view| View { preset, ..*view })
            .collect();
        let mut frames: Vec<Frame> = views
            .iter()
            .map(|view| Frame::new(&view.camera, channels))
            .collect();
        bencher
            .counter(ItemsCount::new(views.len()))
            .bench_local(|| {
                let mut targets: Vec<FrameMut<'_>> = frames.iter_mut().map(Frame::as_mut).collect();
                let threads = Threads::new(threads);
                self.renderer
                    .render(&self.scene, &self.state, &views, &mut targets, threads)
                    .unwrap();
            });
    }
}

static APARTMENT: LazyLock<World> =
    LazyLock::new(|| World::new(dwell_houses::open("builtin:apartment").unwrap().0));

static SUNCG: LazyLock<Option<World>> = LazyLock::new(|| {
    let data = std::env::var_os("DWELL_SHARED_DATA").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data"),
        PathBuf::from,
    );
    let root = data.join("suncg");
    if !root.is_dir() {
        return None;
    }
    Some(World::new(dwell_houses::open(root.to_str()?).unwrap().0))
});

const DEPTH: ImageChannels = ImageChannels {
    depth: true,
    ..ImageChannels::NONE
};

#[divan::bench(args = [1, 2])]
fn apartment_flat(bencher: Bencher, threads: usize) {
    APARTMENT.bench(bencher, Preset::Flat, ImageChannels::default(), threads);
}

#[divan::bench(args = [1, 2])]
fn apartment_lit(bencher: Bencher, threads: usize) {
    APARTMENT.bench(bencher, Preset::Lit, ImageChannels::default(), threads);
}

#[divan::bench(args = [1, 2])]
fn apartment_depth(bencher: Bencher, threads: usize) {
    APARTMENT.bench(bencher, Preset::Flat, DEPTH, threads);
}

#[divan::bench(args = [1, 2], ignore = SUNCG.is_none())]
fn suncg_flat(bencher: Bencher, threads: usize) {
    if let Some(world) = &*SUNCG {
        world.bench(bencher, Preset::Flat, ImageChannels::default(), threads);
    }
}

#[divan::bench(args = [1, 2], ignore = SUNCG.is_none())]
fn suncg_depth(bencher: Bencher, threads: usize) {
    if let Some(world) = &*SUNCG {
        world.bench(bencher, Preset::Flat, DEPTH, threads);
    }
}
