//! Batches: several worlds and cameras at once, memory that is kept, work that overlaps, and errors.

use super::agreement::{Pair, gpu};
use super::houses::{tests_all, views};
use dwell_render::{
    BatchLimits, Camera, CpuRenderer, Frame, Gpu, GpuRenderer, ImageChannels, Preset, RenderError,
    RenderJob, View, VisibilityPath, VisibilityPathSpeeds,
};
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use glam::Vec3;
use std::sync::Arc;

fn pair_by(path: VisibilityPath) -> Option<Pair> {
    Pair::new(Arc::new(dwell_houses::open("seed:4").unwrap().0), path)
}

fn pair() -> Option<Pair> {
    pair_by(VisibilityPath::Compute)
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
    for path in VisibilityPath::ALL {
        worlds_are_apart(path);
    }
}

fn worlds_are_apart(path: VisibilityPath) {
    let Some(pair) = pair_by(path) else { return };
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
        frames.push(Frame::new(&views[k / 2].camera, ImageChannels::ALL));
    }
    let mut jobs: Vec<RenderJob<'_>> = frames
        .iter_mut()
        .enumerate()
        .map(|(k, frame)| {
            let (scene, state) = worlds[k % 2];
            RenderJob::new(scene, state, views[k / 2], frame.as_mut())
        })
        .collect();
    pair.gpu.render_batch(&mut jobs, Threads::ONE).unwrap();
    drop(jobs);
    let mut differ = 0;
    for (k, frame) in frames.iter().enumerate() {
        let (scene, state) = worlds[k % 2];
        let mut alone = Frame::new(&views[k / 2].camera, ImageChannels::ALL);
        let job = RenderJob::new(scene, state, views[k / 2], alone.as_mut());
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
        let mut job = RenderJob::new(&pair.scene, &pair.state, view, part.as_mut());
        job.rows = Some((first as u32, end as u32));
        pair.gpu.render_batch(&mut [job], Threads::ONE).unwrap();
        assert_eq!(part.depth[..], whole.depth[first * width..end * width]);
        assert_eq!(part.rgb[..], whole.rgb[first * width * 3..end * width * 3]);
    }
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn later_batches_make_no_buffers() {
    let Some(shared) = gpu() else { return };
    for path in VisibilityPath::ALL {
        let house = Arc::new(dwell_houses::open("seed:4").unwrap().0);
        let Some(mut pair) = Pair::new(house, path) else {
            return;
        };
        // Other tests run side by side on the shared adapter.
        let own = Gpu::open_adapter(shared.adapter(), BatchLimits::NONE).unwrap();
        pair.gpu = GpuRenderer::new(own, pair.cpu.clone(), path).unwrap();
        let mut views = mixed(&pair);
        for (k, view) in views.iter_mut().enumerate() {
            view.preset = [Preset::Flat, Preset::Lit][k % 2];
        }
        pair.shoot(&views);
        let before = pair.gpu.gpu().buffer_count();
        assert!(before > 8, "{before}");
        for _ in 0..3 {
            views.reverse();
            pair.shoot(&views);
        }
        assert_eq!(pair.gpu.gpu().buffer_count(), before);
    }
}

/// However many pieces a house has, and with all of them drawn: one call for a view.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn a_view_is_drawn_by_one_call() {
    let Some(pair) = pair_by(VisibilityPath::Raster) else {
        return;
    };
    let camera = Camera::from_fov(8, 8, 80.0).unwrap();
    let views = views(&pair.house, camera, 12);
    let pieces = pair.scene.bvh().moving.len();
    assert!(pieces > 100, "{pieces}");
    let all = GpuRenderer::new(gpu().unwrap(), pair.cpu.clone(), VisibilityPath::Raster)
        .unwrap()
        .without_culling();
    for renderer in [&pair.gpu, &all] {
        let mut frames: Vec<Frame> = views
            .iter()
            .map(|view| Frame::new(&view.camera, ImageChannels::default()))
            .collect();
        let pairs = views.iter().zip(&mut frames);
        let jobs: Vec<RenderJob<'_>> = pairs
            .map(|(view, frame)| RenderJob::new(&pair.scene, &pair.state, *view, frame.as_mut()))
            .collect();
        let submitted = renderer.submit(&jobs, Threads::ONE).unwrap();
        assert_eq!(submitted.draw_calls(), views.len());
        drop(jobs);
        let mut into: Vec<_> = frames.iter_mut().map(Frame::as_mut).collect();
        renderer
            .collect(submitted, &mut into, Threads::ONE)
            .unwrap();
    }
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn culling_changes_no_pixel() {
    let Some(pair) = pair_by(VisibilityPath::Raster) else {
        return;
    };
    let all = GpuRenderer::new(gpu().unwrap(), pair.cpu.clone(), VisibilityPath::Raster)
        .unwrap()
        .without_culling();
    let camera = Camera::from_fov(16, 12, 80.0).unwrap();
    // Software takes 17 ms a view.
    let count = if tests_all() { 2000 } else { 60 };
    let views = views(&pair.house, camera, count);
    for (k, views) in views.chunks(250).enumerate() {
        let by = |renderer: &GpuRenderer| {
            pair.by(views, None, &|jobs| {
                renderer.render_batch(jobs, Threads::default()).unwrap();
            })
        };
        let (culled, drawn) = (by(&pair.gpu), by(&all));
        for (j, (culled, drawn)) in culled.iter().zip(&drawn).enumerate() {
            assert!(culled == drawn, "view {}", 250 * k + j);
        }
    }
}

/// With `DWELL_TEST_ALL=1`: it draws for as long as a measurement takes. `dwell doctor`, which has a test, shows its figures.
#[test]
fn a_measurement_chooses_the_quicker_path() {
    if !tests_all() {
        println!("skipped: slow; DWELL_TEST_ALL=1 runs it");
        return;
    }
    let Some(shared) = gpu() else { return };
    let house = Arc::new(dwell_houses::open("seed:4").unwrap().0);
    let speeds = shared
        .visibility_path_speeds(&Arc::new(CpuRenderer::new(&house)))
        .unwrap();
    println!("{speeds:?}: {}", speeds.best().name());
    assert!(speeds.compute_views_per_s > 1.0 && speeds.raster_views_per_s > 1.0);
    let quicker = |compute_views_per_s: f64, raster_views_per_s: f64| {
        let speeds = VisibilityPathSpeeds {
            compute_views_per_s,
            raster_views_per_s,
        };
        speeds.best()
    };
    assert_eq!([quicker(2.0, 1.0), quicker(1.0, 2.0)], VisibilityPath::ALL);
}

#[test]
fn a_batch_under_way_shows_the_world_as_it_was() {
    let Some(mut pair) = pair() else { return };
    let views = mixed(&pair);
    let expected: Vec<Frame> = pair.shoot(&views).into_iter().map(|(_, gpu)| gpu).collect();
    let mut frames: Vec<Frame> = views
        .iter()
        .map(|view| Frame::new(&view.camera, ImageChannels::ALL))
        .collect();
    let jobs: Vec<RenderJob<'_>> = views
        .iter()
        .zip(&mut frames)
        .map(|(view, frame)| RenderJob::new(&pair.scene, &pair.state, *view, frame.as_mut()))
        .collect();
    let first = pair.gpu.submit(&jobs, Threads::ONE).unwrap();
    let second = pair.gpu.submit(&jobs, Threads::ONE).unwrap();
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
    let mut frame = Frame::new(&views[0].camera, ImageChannels::default());
    let job = RenderJob::new(&pair.scene, &pair.state, views[0], frame.as_mut());
    let submitted = pair.gpu.submit(&[job], Threads::ONE).unwrap();
    let error = pair.gpu.collect(submitted, &mut [], Threads::ONE);
    assert_eq!(
        error,
        Err(RenderError::Count {
            views: 1,
            frames: 0
        })
    );
    let mut job = RenderJob::new(&pair.scene, &pair.state, views[0], frame.as_mut());
    job.rows = Some((0, 2));
    let error = pair.gpu.render_batch(&mut [job], Threads::ONE);
    assert!(
        matches!(error, Err(RenderError::Length { view: 0, .. })),
        "{error:?}"
    );
}

#[test]
fn frames_of_other_images_are_refused() {
    let Some(pair) = pair() else { return };
    let view = mixed(&pair)[0];
    let [all, some] = [ImageChannels::ALL, ImageChannels::default()];
    let submit = |frame: &mut Frame| {
        let job = RenderJob::new(&pair.scene, &pair.state, view, frame.as_mut());
        pair.gpu.submit(&[job], Threads::ONE).unwrap()
    };
    let depths = |was_wanted| RenderError::OtherImages {
        view: 0,
        channel: "depth",
        was_wanted,
    };
    let few = ImageChannels {
        depth: false,
        ..some
    };
    for (announced, found, error) in [
        (all, some, None),
        (some, all, None),
        (some, few, Some(depths(true))),
        (few, some, Some(depths(false))),
    ] {
        let submitted = submit(&mut Frame::new(&view.camera, announced));
        let mut into = Frame::new(&view.camera, found);
        let frames = &mut [into.as_mut()];
        let refused = pair.gpu.collect(submitted, frames, Threads::ONE);
        let refused = refused.unwrap_err();
        assert!(error.is_none_or(|error| error == refused), "{refused}");
        assert!(
            into == Frame::new(&view.camera, found),
            "something is written"
        );
    }
    assert_eq!(
        depths(true).to_string(),
        "frame 0: depth is not wanted now, unlike when the batch was submitted; batches are collected into frames of the same \
         images"
    );
    assert!(depths(false).to_string().contains("depth is wanted now"));
}

#[test]
fn a_batch_of_another_renderer_is_refused() {
    let (Some(pair), Some(other)) = (pair(), pair()) else {
        return;
    };
    let view = mixed(&pair)[0];
    let mut frame = Frame::new(&view.camera, ImageChannels::ALL);
    let submit = |frame: &mut Frame| {
        let job = RenderJob::new(&pair.scene, &pair.state, view, frame.as_mut());
        pair.gpu.submit(&[job], Threads::ONE).unwrap()
    };
    let submitted = submit(&mut frame);
    let error = other
        .gpu
        .collect(submitted, &mut [frame.as_mut()], Threads::ONE);
    assert_eq!(error, Err(RenderError::OtherRenderer));
    let submitted = submit(&mut frame);
    let cpu = dwell_render::Renderer::Cpu(pair.cpu.clone());
    let error = cpu.collect(submitted, &mut [frame.as_mut()], Threads::ONE);
    assert_eq!(error, Err(RenderError::OtherRenderer));
    assert!(frame == Frame::new(&view.camera, ImageChannels::ALL));
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
