//! Pictures a second by size of batch and picture, each view of a world of its own: the workload of a graphics card.

use super::{BenchOptions, BenchProgress, median, open, render, sorted_run_times_s};
use crate::engines::Engines;
use crate::error::WorldError;
use dwell_render::{
    BackEnd, Camera, Frame, FrameMut, ImageChannels, RenderJob, Renderer, View, VisibilityPath,
};
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{Pose, State};
use serde_json::{Value, json};

/// Worlds in one house, and the viewpoint in each.
struct RenderBenchWorlds {
    poses: Vec<Pose>,
    worlds: Vec<(RayScene, State)>,
}

/// A size of batch and of picture.
#[derive(Clone, Copy)]
struct BenchSize {
    batch: usize,
    resolution: u32,
}

/// Both paths of an adapter unless one is named.
fn back_ends(asked: &BackEnd) -> Vec<BackEnd> {
    match asked {
        BackEnd::Gpu { name, path: None } => VisibilityPath::ALL
            .map(|path| BackEnd::Gpu {
                name: name.clone(),
                path: Some(path),
            })
            .to_vec(),
        one => vec![one.clone()],
    }
}

pub(super) fn run(
    house: &str,
    options: &BenchOptions,
    progress: &mut BenchProgress<'_>,
) -> Result<Value, WorldError> {
    let engines = open(house)?;
    let threads = Threads::try_resolve(options.threads)?;
    let most = options.batch.iter().copied().max().unwrap_or(1);
    let stage = RenderBenchWorlds {
        poses: render::views(&engines, options)?,
        worlds: (0..most).map(|_| world(&engines)).collect(),
    };
    let back_ends = back_ends(&options.backend);
    progress.set_part_count(back_ends.len() * options.resolutions().len() * options.batch.len());
    let mut rows = Vec::new();
    let mut read_back = None;
    for back_end in back_ends {
        let renderer = engines.image_renderer(&back_end)?;
        if let (Renderer::Gpu(gpu), None) = (&*renderer, read_back) {
            read_back = Some(gpu.gpu().read_back_bytes_per_s()?);
        }
        for resolution in &options.resolutions() {
            for batch in &options.batch {
                progress.begin_part(&format!("batches of {batch} at {resolution} pixels"))?;
                let size = BenchSize {
                    batch: *batch,
                    resolution: *resolution,
                };
                rows.push(measure_size(
                    &stage,
                    &renderer,
                    options,
                    size,
                    (threads, read_back),
                )?);
            }
        }
    }
    Ok(json!({
        "rows": rows,
        "read_back_bytes_per_s": read_back,
        "preset": options.preset,
        "threads": threads.count(),
        "house": engines.house().name,
        "triangles": engines.house().triangle_count(),
        "pieces_that_move": stage.worlds.first().map_or(0, |(scene, _)| scene.bvh().moving.len()),
    }))
}

fn world(engines: &Engines) -> (RayScene, State) {
    let state = State::new(engines.house());
    let mut scene = RayScene::new(engines.house().clone());
    scene.update(&state);
    (scene, state)
}

/// One size of batch and picture: colour, depth and ids.
fn measure_size(
    stage: &RenderBenchWorlds,
    renderer: &Renderer,
    options: &BenchOptions,
    size: BenchSize,
    (threads, read_back): (Threads, Option<f64>),
) -> Result<Value, WorldError> {
    let BenchSize { batch, resolution } = size;
    let camera = Camera::from_fov(resolution, resolution, 90.0)?.with_range(0.05, 50.0)?;
    let wanted = ImageChannels::default();
    let mut frames: Vec<Frame> = (0..batch).map(|_| Frame::new(&camera, wanted)).collect();
    let jobs = |frames: &mut [Frame]| -> Result<(), WorldError> {
        let mut jobs = render_jobs(stage, camera, options, frames);
        renderer.render_batch(&mut jobs, threads)?;
        Ok(())
    };
    jobs(&mut frames)?;
    let seconds = sorted_run_times_s(options.repeats, || jobs(&mut frames))?;
    let views_per_s = batch as f64 / median(&seconds);
    let mut row = json!({
        "backend": renderer.description(),
        "resolution": resolution,
        "batch": batch,
        "views_per_s": views_per_s,
        "pixels_per_s": views_per_s * camera.pixels() as f64,
    });
    if let Renderer::Gpu(gpu) = renderer {
        // Two batches under way, as where worlds step meanwhile.
        let mut submit = Vec::new();
        let mut next = || {
            let start = std::time::Instant::now();
            let mut frames: Vec<Frame> = (0..batch).map(|_| Frame::new(&camera, wanted)).collect();
            let jobs = render_jobs(stage, camera, options, &mut frames);
            let submitted = gpu.submit(&jobs, threads);
            submit.push(start.elapsed().as_secs_f64());
            submitted
        };
        let mut waiting = next()?;
        let seconds = sorted_run_times_s(options.repeats, || {
            let following = next()?;
            let waited = std::mem::replace(&mut waiting, following);
            let mut into: Vec<FrameMut<'_>> = frames.iter_mut().map(Frame::as_mut).collect();
            gpu.collect(waited, &mut into, threads)?;
            Ok(())
        })?;
        let mut into: Vec<FrameMut<'_>> = frames.iter_mut().map(Frame::as_mut).collect();
        gpu.collect(waiting, &mut into, threads)?;
        submit.sort_by(f64::total_cmp);
        // Four bytes each of colour, depth and id.
        let bytes = camera.pixels() as f64 * 12.0;
        row["overlapped_views_per_s"] = (batch as f64 / median(&seconds)).into();
        row["submit_s"] = median(&submit).into();
        row["bound_views_per_s"] = read_back.map(|rate| rate / bytes).into();
    }
    Ok(row)
}

fn render_jobs<'a>(
    stage: &'a RenderBenchWorlds,
    camera: Camera,
    options: &BenchOptions,
    frames: &'a mut [Frame],
) -> Vec<RenderJob<'a>> {
    let poses = stage.poses.iter().cycle();
    let worlds = stage.worlds.iter().zip(poses);
    let jobs = worlds.zip(frames).map(|(((scene, state), pose), frame)| {
        let view = View {
            preset: options.preset,
            ..View::new(camera, *pose)
        };
        RenderJob::new(scene, state, view, frame.as_mut())
    });
    jobs.collect()
}
