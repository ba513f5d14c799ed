//! Pictures a second.

use super::{BenchOptions, BenchProgress, median, open, sorted_run_times_s, table};
use crate::engines::Engines;
use crate::error::WorldError;
use crate::info::best_room_viewpoints;
use dwell_render::{Camera, Frame, RenderJob, View};
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::space::{rotation_from_forward, rotation_from_yaw_pitch};
use dwell_scene::{Pose, State};
use glam::Vec3;
use serde_json::{Value, json};

pub(super) fn views(engines: &Engines, options: &BenchOptions) -> Result<Vec<Pose>, WorldError> {
    if let Some(views) = &options.views {
        return views
            .iter()
            .map(|view| {
                let rotation = rotation_from_forward(Vec3::from_array(view.forward));
                rotation
                    .map(|rotation| Pose::new(Vec3::from_array(view.position), rotation))
                    .ok_or_else(|| {
                        let allowed = "a direction that is not zero".to_owned();
                        WorldError::Config {
                            field: "forward",
                            found: format!("{:?}", view.forward),
                            allowed,
                        }
                    })
            })
            .collect();
    }
    let mut around = Vec::new();
    for room in best_room_viewpoints(engines)? {
        for k in 0..8_u8 {
            let eye = Vec3::new(room.stand[0], room.eye[1], room.stand[2]);
            around.push(Pose::new(
                eye,
                rotation_from_yaw_pitch(f32::from(k) * std::f32::consts::FRAC_PI_4, -0.1),
            ));
        }
    }
    Ok(around)
}

pub(super) fn run(
    house: &str,
    options: &BenchOptions,
    progress: &mut BenchProgress<'_>,
) -> Result<Value, WorldError> {
    if !options.batch.is_empty() {
        return table::run(house, options, progress);
    }
    progress.begin_part("pictures")?;
    let engines = open(house)?;
    let (state, scene) = (
        State::new(engines.house()),
        RayScene::new(engines.house().clone()),
    );
    let threads = Threads::try_resolve(options.threads)?;
    let camera =
        Camera::from_fov(options.resolution, options.resolution, 90.0)?.with_range(0.05, 50.0)?;
    let views = views(&engines, options)?;
    let poses: Vec<Pose> = (0..options.batches)
        .flat_map(|_| views.iter().copied())
        .collect();
    let mut frames: Vec<Frame> = poses
        .iter()
        .map(|_| Frame::new(&camera, dwell_render::ImageChannels::default()))
        .collect();
    let renderer = engines.image_renderer(&options.backend)?;
    let seconds = sorted_run_times_s(options.repeats + 1, || {
        let mut jobs: Vec<RenderJob<'_>> = poses
            .iter()
            .zip(&mut frames)
            .map(|(pose, frame)| {
                let view = View {
                    preset: options.preset,
                    ..View::new(camera, *pose)
                };
                RenderJob::new(&scene, &state, view, frame.as_mut())
            })
            .collect();
        renderer.render_batch(&mut jobs, threads)?;
        Ok(())
    })?;
    Ok(json!({
        "views_per_s": poses.len() as f64 / median(&seconds),
        "views": poses.len(),
        "resolution": options.resolution,
        "preset": options.preset,
        "backend": renderer.description(),
        "threads": threads.count(),
        "triangles": engines.house().triangle_count(),
    }))
}
