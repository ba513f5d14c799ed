//! Some rows of one picture.

use super::rays::{COLUMNS, Packet, ROWS, Rays};
use super::shade::Palette;
use super::{BAND_ROWS, CpuRenderer, Job};
use crate::frame::FrameMut;
use crate::light::{Exposure, Lighting};
use dwell_scene::State;
use dwell_scene::rays::RayScene;

/// Rows of a picture, with the memory they go to.
pub(super) struct Band<'a> {
    pub(super) scene: &'a RayScene,
    pub(super) state: &'a State,
    pub(super) rays: Rays,
    /// Nothing for flat views.
    pub(super) light: Option<(&'a Lighting, Exposure)>,
    /// Of the picture.
    size: (usize, usize),
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
                size: (width, height),
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
        let (mut packet, mut palette) = (Packet::new(), Palette::new());
        for top in (0..self.rows).step_by(ROWS) {
            for left in (0..self.size.0).step_by(COLUMNS) {
                let corner = (left, self.first_row + top);
                self.rays.cast(self.scene, corner, self.size, &mut packet);
                self.write(renderer, &mut packet, &mut palette, (left, top));
            }
        }
    }

    fn write(
        &mut self,
        renderer: &CpuRenderer,
        packet: &mut Packet,
        palette: &mut Palette,
        (left, top): (usize, usize),
    ) {
        let width = self.size.0;
        let (columns, rows) = (COLUMNS.min(width - left), ROWS.min(self.rows - top));
        // Pixels and lanes of each row.
        let spans = |row: usize| {
            let first = (top + row) * width + left;
            (
                first..first + columns,
                row * COLUMNS..row * COLUMNS + columns,
            )
        };
        if let Some(buffer) = &mut self.frame.depth {
            let (near_m, far_m) = self.rays.range();
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
        if self.frame.rgb.is_some() {
            self.colors(renderer, packet, (columns, rows), palette);
            if let Some(buffer) = &mut self.frame.rgb {
                for (pixels, lanes) in (0..rows).map(spans) {
                    let bytes = palette.bytes[lanes].as_flattened();
                    buffer[pixels.start * 3..pixels.end * 3].copy_from_slice(bytes);
                }
            }
        }
    }
}

/// The first `count` elements of what is left of a buffer.
fn cut<'a, T>(rest: &mut Option<&'a mut [T]>, count: usize) -> Option<&'a mut [T]> {
    let (first, others) = rest.take()?.split_at_mut_checked(count)?;
    *rest = Some(others);
    Some(first)
}
