//! Two methods for what each pixel sees first.

use super::device::Gpu;
use super::renderer::GpuRenderer;
use crate::camera::Camera;
use crate::cpu::{CpuRenderer, RenderJob};
use crate::error::RenderError;
use crate::frame::{Frame, ImageChannels, View};
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{Pose, State, space};
use glam::Vec3;
use std::sync::Arc;
use std::time::Instant;

/// The method by which an adapter finds what each pixel sees first. All images are made from that in one way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum VisibilityPath {
    /// A kernel walks the trees of `cpu`, ray by ray.
    Compute,
    /// Triangles are drawn, those that cannot be seen left out; rays decide at edges. Cameras other than pinholes use
    /// [`Self::Compute`]. Of coincident surfaces either may be seen.
    Raster,
}

impl VisibilityPath {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Compute, Self::Raster];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Compute => "compute",
            Self::Raster => "raster",
        }
    }
}

/// Views a second of each path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibilityPathSpeeds {
    /// Of [`VisibilityPath::Compute`].
    pub compute_views_per_s: f64,
    /// Of [`VisibilityPath::Raster`].
    pub raster_views_per_s: f64,
}

impl VisibilityPathSpeeds {
    /// The quicker one.
    pub fn best(&self) -> VisibilityPath {
        if self.raster_views_per_s > self.compute_views_per_s {
            VisibilityPath::Raster
        } else {
            VisibilityPath::Compute
        }
    }
}

/// Views of the measurement, their edge in pixels, and how often it is repeated.
const VIEWS: usize = 16;
const EDGE: u32 = 64;
const ROUNDS: usize = 3;

impl VisibilityPathSpeeds {
    /// Measures both paths over views in the rooms of a house, as it stands at the start: the best of three rounds each, after one
    /// that compiles.
    ///
    /// # Errors
    /// As [`GpuRenderer::render_batch`].
    pub fn measure(gpu: &Arc<Gpu>, tables: &Arc<CpuRenderer>) -> Result<Self, RenderError> {
        let house = tables.house();
        let (scene, state) = (RayScene::new(house.clone()), State::new(house));
        let camera = Camera::from_fov(EDGE, EDGE, 90.0)?;
        let rooms: Vec<Vec3> = house
            .rooms
            .iter()
            .filter_map(|room| {
                let [a, b, c] = *room.footprint.first()?;
                let middle = (a + b + c) / 3.0;
                Some(Vec3::new(middle.x, room.floor_y + 1.4, middle.y))
            })
            .collect();
        let eye = |k: usize| {
            let center = house.geometry().static_bvh.bounds().center();
            rooms.get(k % rooms.len().max(1)).copied().unwrap_or(center)
        };
        let wanted = ImageChannels {
            depth: true,
            ..ImageChannels::NONE
        };
        let mut frames: Vec<Frame> = (0..VIEWS).map(|_| Frame::new(&camera, wanted)).collect();
        let mut speed = |path: VisibilityPath| {
            let renderer = GpuRenderer::new(gpu.clone(), tables.clone(), path)?;
            let mut best = f64::INFINITY;
            for round in 0..=ROUNDS {
                let mut jobs: Vec<RenderJob<'_>> = frames
                    .iter_mut()
                    .enumerate()
                    .map(|(k, frame)| {
                        let turn = space::rotation_from_yaw_pitch(k as f32 * 2.4, -0.1);
                        let view = View::new(camera, Pose::new(eye(k), turn));
                        RenderJob::new(&scene, &state, view, frame.as_mut())
                    })
                    .collect();
                let start = Instant::now();
                renderer.render_batch(&mut jobs, Threads::default())?;
                if round > 0 {
                    best = best.min(start.elapsed().as_secs_f64());
                }
            }
            Ok::<f64, RenderError>(VIEWS as f64 / best)
        };
        Ok(Self {
            compute_views_per_s: speed(VisibilityPath::Compute)?,
            raster_views_per_s: speed(VisibilityPath::Raster)?,
        })
    }
}
