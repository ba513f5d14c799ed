//! Batches: several worlds and cameras at once, memory that is kept, work that overlaps, and errors.

use super::agreement::{Pair, gpu};
use super::houses::views;
use dwell_render::{Camera, Channels, Frame, Gpu, Job, RenderError, View};
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use glam::Vec3;
use std::sync::Arc;

fn pair() -> Option<Pair> {
    Pair::new(Arc::new(dwell_houses::open("seed:4").unwrap().0))
}

/// Cameras of all sizes, in turn.
fn mixed(pair: &Pair) -> Vec<View> {
    let cameras = [
        Camera::from_fov(33, 17, 80.0).unwrap(),
        Camera::equirectangular(40).unwrap(),
        Camera::from_fov(8, 8, 60.0).unwrap(),
    ];
    let places = views(&pair.house, cameras[0], 9);
    let cameras = cameras.iter().cycle();
    let pairs = places.iter().zip(cameras);
    pairs
        .map(|(view, camera)| View {
            camera: *camera,
            ..*view
        })
        .collect()
}

#[test]
fn a_batch_of_worlds_gives_each_what_it_gives_alone() {
    let Some(pair) = pair() else { return };
    let mut other = pair.state.clone();
    for part in &pair.house.geometry().movable {
        other.part_pose[*part].position += Vec3::new(0.0, 0.3, 0.1);
    }
    let mut other_scene = RayScene::new(pair.house.clone());
    other_scene.update(&other);
    let views = mixed(&pair);
    let worlds = [(&pair.scene, &pair.state), (&other_scene, &other)];
    let mut frames: Vec<Frame> = Vec::new();
    for k in 0..2 * views.len() {
        frames.push(Frame::new(&views[k / 2].camera, Channels::ALL));
    }
    let mut jobs: Vec<Job<'_>> = frames
        .iter_mut()
        .enumerate()
        .map(|(k, frame)| {
            let (scene, state) = worlds[k % 2];
            Job::new(scene, state, views[k / 2], frame.as_mut())
        })
        .collect();
    pair.gpu.render_batch(&mut jobs, Threads::ONE).unwrap();
    drop(jobs);
    let mut differ = 0;
    for (k, frame) in frames.iter().enumerate() {
        let (scene, state) = worlds[k % 2];
        let mut alone = Frame::new(&views[k / 2].camera, Channels::ALL);
        let job = Job::new(scene, state, views[k / 2], alone.as_mut());
        pair.gpu.render_batch(&mut [job], Threads::ONE).unwrap();
        assert!(alone == *frame, "view {k}");
        differ += usize::from(k % 2 == 1 && frames[k - 1] != *frame);
    }
    assert!(differ > views.len() / 2, "{differ} of {}", views.len());
}

#[test]
fn rows_are_those_of_the_whole_picture() {
    let Some(pair) = pair() else { return };
    for view in mixed(&pair) {
        let [(_, whole)] = &pair.shoot(&[view])[..] else {
            panic!("one view")
        };
        let width = view.camera.width() as usize;
        let (first, end) = (3_usize, 7_usize);
        let pixels = (end - first) * width;
        let mut part = Frame::default();
        part.depth.resize(pixels, 0.0);
        part.rgb.resize(pixels * 3, 0);
        let mut job = Job::new(&pair.scene, &pair.state, view, part.as_mut());
        job.rows = Some((first as u32, end as u32));
        pair.gpu.render_batch(&mut [job], Threads::ONE).unwrap();
        assert_eq!(part.depth[..], whole.depth[first * width..end * width]);
        assert_eq!(part.rgb[..], whole.rgb[first * width * 3..end * width * 3]);
    }
}

#[test]
fn later_batches_make_no_buffers() {
    let Some(pair) = pair() else { return };
    let views = mixed(&pair);
    // Tests run side by side on one adapter: count over several batches, and expect a batch without any.
    let mut fewest = usize::MAX;
    for _ in 0..20 {
        let before = pair.gpu.gpu().buffers_made();
        pair.shoot(&views);
        fewest = fewest.min(pair.gpu.gpu().buffers_made() - before);
    }
    assert_eq!(fewest, 0);
}

#[test]
fn a_batch_under_way_shows_the_world_as_it_was() {
    let Some(mut pair) = pair() else { return };
    let views = mixed(&pair);
    let expected: Vec<Frame> = pair.shoot(&views).into_iter().map(|(_, gpu)| gpu).collect();
    let mut frames: Vec<Frame> = views
        .iter()
        .map(|view| Frame::new(&view.camera, Channels::ALL))
        .collect();
    let jobs: Vec<Job<'_>> = views
        .iter()
        .zip(&mut frames)
        .map(|(view, frame)| Job::new(&pair.scene, &pair.state, *view, frame.as_mut()))
        .collect();
    let first = pair.gpu.submit(&jobs).unwrap();
    let second = pair.gpu.submit(&jobs).unwrap();
    drop(jobs);
    for pose in &mut pair.state.part_pose {
        pose.position.y += 0.5;
    }
    pair.scene.update(&pair.state);
    for submitted in [first, second] {
        let mut into: Vec<_> = frames.iter_mut().map(Frame::as_mut).collect();
        pair.gpu
            .collect(submitted, &mut into, Threads::ONE)
            .unwrap();
        drop(into);
        assert!(frames == expected);
    }
}

#[test]
fn other_frames_than_announced_are_refused() {
    let Some(pair) = pair() else { return };
    let views = mixed(&pair);
    let mut frame = Frame::new(&views[0].camera, Channels::default());
    let job = Job::new(&pair.scene, &pair.state, views[0], frame.as_mut());
    let submitted = pair.gpu.submit(&[job]).unwrap();
    let error = pair.gpu.collect(submitted, &mut [], Threads::ONE);
    assert_eq!(
        error,
        Err(RenderError::Count {
            views: 1,
            frames: 0
        })
    );
    let mut job = Job::new(&pair.scene, &pair.state, views[0], frame.as_mut());
    job.rows = Some((0, 2));
    let error = pair.gpu.render_batch(&mut [job], Threads::ONE);
    assert!(
        matches!(error, Err(RenderError::Length { view: 0, .. })),
        "{error:?}"
    );
}

#[test]
fn an_adapter_that_is_not_there_is_named_beside_those_that_are() {
    let error = Gpu::open(Some("no such card")).unwrap_err().to_string();
    assert!(error.contains("no such card"), "{error}");
    match gpu() {
        None => assert!(error.contains("found: none"), "{error}"),
        Some(gpu) => assert!(error.contains(&gpu.adapter().name), "{error}"),
    }
}
