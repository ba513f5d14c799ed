//! Heap memory of a batch: after the first ones of a kind no more than its lists, and nothing that grows.

use dwell_render::{
    BatchLimits, Camera, CpuRenderer, Frame, Gpu, GpuRenderer, ImageChannels, Preset, RenderJob,
    View, VisibilityPath, adapters,
};
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{Pose, State, space};
use glam::Vec3;
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;
use std::sync::Arc;

#[global_allocator]
static HEAP: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Views of a batch, each of a world of its own, and their edge in pixels.
const VIEWS: usize = 48;
const EDGE: u32 = 24;

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn later_batches_take_little_from_the_heap() {
    let Some(first) = adapters().into_iter().next() else {
        println!("skipped: no graphics adapter, not even of software");
        return;
    };
    let house = Arc::new(dwell_houses::open("seed:4").unwrap().0);
    let cpu = Arc::new(CpuRenderer::new(&house));
    let worlds: Vec<(RayScene, State)> = (0..VIEWS)
        .map(|_| (RayScene::new(house.clone()), State::new(&house)))
        .collect();
    let camera = Camera::from_fov(EDGE, EDGE, 90.0).unwrap();
    let mut frames: Vec<Frame> = (0..VIEWS)
        .map(|_| Frame::new(&camera, ImageChannels::default()))
        .collect();
    let rooms: Vec<Vec3> = house
        .rooms
        .iter()
        .map(|room| room.bounds.center())
        .collect();
    for path in VisibilityPath::ALL {
        let gpu = Gpu::open_adapter(&first, BatchLimits::NONE).unwrap();
        let renderer = GpuRenderer::new(gpu, cpu.clone(), path).unwrap();
        let mut taken = Vec::new();
        for _ in 0..8 {
            let region = Region::new(HEAP);
            let mut jobs: Vec<RenderJob<'_>> = frames
                .iter_mut()
                .enumerate()
                .map(|(k, frame)| {
                    let turn = space::rotation_from_yaw_pitch(k as f32 * 2.4, -0.1);
                    let view = View {
                        preset: [Preset::Flat, Preset::Lit][k % 2],
                        ..View::new(camera, Pose::new(rooms[k % rooms.len()], turn))
                    };
                    RenderJob::new(&worlds[k].0, &worlds[k].1, view, frame.as_mut())
                })
                .collect();
            renderer.render_batch(&mut jobs, Threads::ONE).unwrap();
            drop(jobs);
            let change = region.change();
            taken.push(change.bytes_allocated + change.bytes_reallocated.max(0) as usize);
        }
        let made = renderer.gpu().buffer_count();
        println!(
            "{}: {taken:?} bytes of the heap, {made} buffers",
            path.name()
        );
        // The images of a batch alone are 48 * 24 * 24 * 12 bytes, its worlds ten times as much.
        let images = VIEWS * (EDGE * EDGE) as usize * 12;
        let (least, most) = (taken[4..].iter().min(), taken[4..].iter().max());
        assert!(*most.unwrap() < images, "{taken:?}");
        assert!(
            *most.unwrap() <= least.unwrap() + least.unwrap() / 10,
            "{taken:?}"
        );
        assert!(
            taken[0] > 10 * most.unwrap(),
            "the first one makes all memory: {taken:?}"
        );
    }
}
