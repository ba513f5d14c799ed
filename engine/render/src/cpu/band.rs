//! Some rows of one picture.

use super::rays::{EDGE, Packet, Rays};
use super::{BAND_ROWS, CpuRenderer, Job};
use crate::frame::FrameMut;
use crate::light::{Exposure, Lighting};
use crate::semantic::VOID;
use crate::surfaces::SLOW;
use dwell_scene::State;
use dwell_scene::rays::RayScene;

/// Rows of a picture, with the memory they go to.
pub(super) struct Band<'a> {
    pub(super) scene: &'a RayScene,
    pub(super) state: &'a State,
    pub(super) rays: Rays,
    /// Nothing for flat views.
    pub(super) light: Option<(&'a Lighting, Exposure)>,
    width: usize,
    far_m: f32,
    /// Its first row in the picture.
    first_row: usize,
    rows: usize,
    frame: FrameMut<'a>,
}

impl<'a> Band<'a> {
    /// Cuts the picture of a job into bands.
    pub(super) fn split(
        job: &'a mut Job<'_>,
        light: Option<(&'a Lighting, Exposure)>,
        bands: &mut Vec<Self>,
    ) {
        let camera = job.view.camera;
        let (width, height) = (camera.width() as usize, camera.height() as usize);
        let rays = Rays::new(&job.view);
        let mut rest = job.frame.reborrow();
        for first_row in (0..height).step_by(BAND_ROWS) {
            let rows = BAND_ROWS.min(height - first_row);
            let pixels = rows * width;
            bands.push(Self {
                scene: job.scene,
                state: job.state,
                rays,
                light,
                width,
                far_m: camera.far_m(),
                first_row,
                rows,
                frame: FrameMut {
                    rgb: cut(&mut rest.rgb, pixels * 3),
                    depth: cut(&mut rest.depth, pixels),
                    instance: cut(&mut rest.instance, pixels),
                    semantic: cut(&mut rest.semantic, pixels),
                },
            });
        }
    }

    /// Writes the pixels.
    pub(super) fn render(&mut self, renderer: &CpuRenderer) {
        for top in (0..self.rows).step_by(EDGE) {
            for left in (0..self.width).step_by(EDGE) {
                let packet = self.rays.packet(self.scene, left, self.first_row + top);
                self.write(renderer, &packet, left, top);
            }
        }
    }

    fn write(&mut self, renderer: &CpuRenderer, packet: &Packet, left: usize, top: usize) {
        let columns = EDGE.min(self.width - left);
        for row in 0..EDGE.min(self.rows - top) {
            let first = (top + row) * self.width + left;
            let hits = &packet.hits[row * EDGE..row * EDGE + columns];
            if let Some(depth) = &mut self.frame.depth {
                for (pixel, hit) in depth[first..first + columns].iter_mut().zip(hits) {
                    *pixel = hit.map_or(self.far_m, |hit| hit.distance_m);
                }
            }
            if let Some(instance) = &mut self.frame.instance {
                for (pixel, hit) in instance[first..first + columns].iter_mut().zip(hits) {
                    *pixel = hit.map_or(0, |hit| hit.id);
                }
            }
            if let Some(semantic) = &mut self.frame.semantic {
                for (pixel, hit) in semantic[first..first + columns].iter_mut().zip(hits) {
                    *pixel = hit.map_or(VOID, |hit| renderer.class(hit.id));
                }
            }
            if self.frame.rgb.is_some() {
                let mut colors = [[0; 3]; EDGE];
                for (lane, color) in (row * EDGE..).zip(&mut colors[..columns]) {
                    *color = self.pixel(renderer, packet, lane);
                }
                if let Some(rgb) = &mut self.frame.rgb {
                    rgb[first * 3..(first + columns) * 3]
                        .copy_from_slice(&colors.as_flattened()[..columns * 3]);
                }
            }
        }
    }

    #[inline]
    fn pixel(&self, renderer: &CpuRenderer, packet: &Packet, lane: usize) -> [u8; 3] {
        let Some(hit) = packet.hits[lane] else {
            return self.void(packet.ray(lane));
        };
        let position = renderer.surfaces.position(hit.instance, hit.triangle);
        let [r, g, b, kind] = renderer.surfaces.quick(position);
        if kind != SLOW && self.light.is_none() {
            return [r, g, b];
        }
        self.color(renderer, packet.ray(lane), hit, position)
    }
}

/// The first `count` elements of what is left of a buffer.
fn cut<'a, T>(rest: &mut Option<&'a mut [T]>, count: usize) -> Option<&'a mut [T]> {
    let (first, others) = rest.take()?.split_at_mut_checked(count)?;
    *rest = Some(others);
    Some(first)
}
