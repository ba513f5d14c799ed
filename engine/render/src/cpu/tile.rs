//! A tile: some rows of one picture.

use super::camera_rays::{CameraRayGenerator, CameraRayPacket, PACKET_COLUMNS, PACKET_ROWS};
use super::motion;
use super::shade::ShadeScratch;
use super::{BAND_ROWS, CpuRenderer, RenderJob};
use crate::frame::{FrameMut, PreviousPoses};
use crate::light::{Exposure, Lighting};
use dwell_scene::State;
use dwell_scene::bvh::SceneBvh;
use dwell_scene::interrupt::CancelPoller;
use dwell_scene::rays::RayScene;
use glam::Vec3;

/// Packets between checks for cancellation.
const PACKETS_PER_CHECK: usize = 32;

/// Rows of a picture, with their destination.
pub(super) struct ImageBand<'a> {
    pub(super) scene: SceneBvh<'a>,
    /// The scene whose trees these are.
    all: &'a RayScene,
    pub(super) state: &'a State,
    before: Option<PreviousPoses<'a>>,
    pub(super) rays: CameraRayGenerator,
    /// The light; `None` for flat views.
    pub(super) light: Option<(&'a Lighting, Exposure)>,
    /// Size of the picture, pixels.
    size: (usize, usize),
    /// Its first row in the picture.
    first_row: usize,
    rows: usize,
    frame: FrameMut<'a>,
}

impl<'a> ImageBand<'a> {
    /// Cuts the picture of a job into bands.
    pub(super) fn split(
        job: &'a mut RenderJob<'_>,
        light: Option<(&'a Lighting, Exposure)>,
        bands: &mut Vec<Self>,
    ) {
        let camera = job.view.camera;
        let (width, height) = (camera.width() as usize, camera.height() as usize);
        let rays = CameraRayGenerator::new(&job.view);
        let (first, last) = job.row_range();
        let mut rest = job.frame.reborrow();
        for first_row in (first..last).step_by(BAND_ROWS) {
            let rows = BAND_ROWS.min(last - first_row);
            bands.push(Self {
                scene: job.scene.bvh(),
                all: job.scene,
                state: job.state,
                before: job.before,
                rays,
                light,
                size: (width, height),
                first_row,
                rows,
                frame: rest.split_off_pixels(rows * width),
            });
        }
    }

    /// What says how things stand: scene and state.
    pub(super) fn scene_and_state(&self) -> (&'a RayScene, &'a State) {
        (self.all, self.state)
    }

    /// Writes the pixels.
    pub(super) fn render(&mut self, renderer: &CpuRenderer) {
        let (mut packet, mut palette) = (CameraRayPacket::new(), ShadeScratch::new());
        let end = (self.size.0, self.first_row + self.rows);
        // All light of a packet takes milliseconds.
        let mut pace = CancelPoller::new(if self.rays.is_path_traced() {
            1
        } else {
            PACKETS_PER_CHECK
        });
        for top in (0..self.rows).step_by(PACKET_ROWS) {
            for left in (0..self.size.0).step_by(PACKET_COLUMNS) {
                pace.count_one();
                let corner = (left, self.first_row + top);
                self.rays.cast(self.scene, corner, end, &mut packet);
                self.write(renderer, &mut packet, &mut palette, (left, top));
            }
        }
    }

    fn write(
        &mut self,
        renderer: &CpuRenderer,
        packet: &mut CameraRayPacket,
        palette: &mut ShadeScratch,
        (left, top): (usize, usize),
    ) {
        let width = self.size.0;
        let (columns, rows) = (
            PACKET_COLUMNS.min(width - left),
            PACKET_ROWS.min(self.rows - top),
        );
        // Pixels and lanes of each row.
        let spans = |row: usize| {
            let first = (top + row) * width + left;
            (
                first..first + columns,
                row * PACKET_COLUMNS..row * PACKET_COLUMNS + columns,
            )
        };
        if let Some(buffer) = &mut self.frame.depth {
            let (near_m, far_m) = self.rays.depth_range();
            let depths = packet.depths(near_m, far_m);
            for (pixels, lanes) in (0..rows).map(spans) {
                buffer[pixels].copy_from_slice(&depths[lanes]);
            }
        }
        if self.frame.instance.is_some() || self.frame.semantic.is_some() {
            let ids = packet.ids();
            for (pixels, lanes) in (0..rows).map(spans) {
                if let Some(buffer) = &mut self.frame.instance {
                    buffer[pixels.clone()].copy_from_slice(&ids[lanes.clone()]);
                }
                if let Some(buffer) = &mut self.frame.semantic {
                    for (pixel, id) in buffer[pixels].iter_mut().zip(&ids[lanes]) {
                        *pixel = renderer.class(*id);
                    }
                }
            }
        }
        let surfaces = self.frame.normals.is_some()
            || self.frame.albedo.is_some()
            || self.frame.flow.is_some();
        if surfaces {
            for (pixels, lanes) in (0..rows).map(spans) {
                for (pixel, lane) in pixels.zip(lanes) {
                    self.write_surface(renderer, packet, lane, pixel);
                }
            }
        }
        if self.frame.rgb.is_some() {
            match self.light {
                Some(light) if self.rays.is_path_traced() => {
                    for row in 0..rows {
                        for column in 0..columns {
                            let place = (left + column, self.first_row + top + row);
                            palette.bytes[row * PACKET_COLUMNS + column] =
                                self.path_traced_color(renderer, light, place);
                        }
                    }
                }
                _ => self.colors(renderer, packet, (columns, rows), palette),
            }
            if let Some(buffer) = &mut self.frame.rgb {
                for (pixels, lanes) in (0..rows).map(spans) {
                    let bytes = palette.bytes[lanes].as_flattened();
                    buffer[pixels.start * 3..pixels.end * 3].copy_from_slice(bytes);
                }
            }
        }
    }

    /// Writes normal, reflectance and flow of one pixel's surface.
    fn write_surface(
        &mut self,
        renderer: &CpuRenderer,
        packet: &CameraRayPacket,
        lane: usize,
        pixel: usize,
    ) {
        let sight = packet.closest_hit(lane);
        let skin = sight
            .as_ref()
            .map(|sight| renderer.surface_at_hit(&self.rays, self.scene_and_state(), sight));
        let put = |buffer: &mut Option<&mut [f32]>, value: Vec3| {
            if let Some(buffer) = buffer {
                buffer[pixel * 3..pixel * 3 + 3].copy_from_slice(&value.to_array());
            }
        };
        let (normal, albedo) = match (&sight, &skin) {
            (Some(sight), Some(skin)) => (
                self.rays.in_camera(skin.normal_facing(sight.direction)),
                skin.color.clamp(Vec3::ZERO, Vec3::ONE),
            ),
            _ => (Vec3::ZERO, Vec3::ZERO),
        };
        put(&mut self.frame.normals, normal);
        put(&mut self.frame.albedo, albedo);
        let posed = self.scene_and_state();
        let Some(buffer) = &mut self.frame.flow else {
            return;
        };
        let image = (
            (pixel % self.size.0) as f32 + 0.5,
            (self.first_row + pixel / self.size.0) as f32 + 0.5,
        );
        let flow = self.before.as_ref().map_or([0.0; 2], |before| {
            let camera = self.rays.camera();
            match &sight {
                Some(sight) => {
                    let was = renderer.previous_position(sight, posed, before);
                    motion::point_flow(camera, before, image, was)
                }
                None => motion::direction_flow(camera, before, image, packet.direction(lane)),
            }
        });
        buffer[pixel * 2..pixel * 2 + 2].copy_from_slice(&flow);
    }
}
