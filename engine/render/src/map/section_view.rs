//! Pictures of the part below a level cut: each ray begins where it passes the cut.

use super::{StoreyMap, walls};
use crate::camera::Camera;
use crate::color::SrgbTables;
use crate::cpu::{CpuRenderer, RenderJob};
use crate::error::RenderError;
use crate::frame::{Frame, FrameMut, ImageChannels, View};
use dwell_scene::interrupt;
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{Entity, EntityId, State, StructureKind};
use glam::{Vec2, Vec3};

/// Pixels between checks for cancellation.
const PIXELS_PER_CHECK: usize = 1 << 14;
/// Pixels of a strip of rows that is drawn at a time: the buffers for a large picture would fill the memory, and to give
/// them back takes its time.
const PIXELS_PER_STRIP: usize = 1 << 20;
/// Background colour, sRGB.
const PAPER: [u8; 3] = [250, 249, 246];
/// Direction to the light in the camera's frame: from above, the left, and the viewer.
const LIGHT: Vec3 = Vec3::new(-0.35, 0.72, 0.6);
/// Ambient light, as a share of that on a surface that faces the light.
const AMBIENT: f32 = 0.5;

/// The channels from which colours are made.
const BESIDE: ImageChannels = ImageChannels {
    depth: true,
    instance: true,
    normals: true,
    ..ImageChannels::NONE
};

/// A level cut through a storey.
#[derive(Clone, Copy, Debug)]
pub(super) struct CutawayView<'a> {
    /// The view from above, without roll: then a row of the image meets the cut at one depth.
    pub(super) view: View,
    /// Height of the cut, m.
    pub(super) level_y: f32,
    /// Height below which geometry belongs to another storey and is left out, m.
    pub(super) floor_y: f32,
    /// The map on which walls at the cut are looked up.
    pub(super) plan: &'a StoreyMap,
}

impl CutawayView<'_> {
    /// The picture in flat colours, darker where a surface turns away, with dark walls at the cut. Shape (height, width, 3).
    pub(super) fn render(
        &self,
        renderer: &CpuRenderer,
        scene: &RayScene,
        state: &State,
        threads: Threads,
    ) -> Result<Vec<u8>, RenderError> {
        self.in_strips(PIXELS_PER_STRIP, renderer, (scene, state), threads)
    }

    fn in_strips(
        &self,
        pixels: usize,
        renderer: &CpuRenderer,
        world: (&RayScene, &State),
        threads: Threads,
    ) -> Result<Vec<u8>, RenderError> {
        let camera = &self.view.camera;
        let mut walls = vec![0; self.plan.view.camera.pixels() * 3];
        self.plan.draw_walls(renderer.house(), &mut walls);
        let mut rgb = vec![0; camera.pixels() * 3];
        let width = camera.width() as usize;
        let rows = (pixels / width).clamp(1, camera.height() as usize);
        for (strip, rgb) in rgb.chunks_mut(rows * width * 3).enumerate() {
            let first = (strip * rows) as u32;
            let end = camera.height().min(first + rows as u32);
            let mut beside = Frame::with_pixel_count(rgb.len() / 3, BESIDE);
            let images = FrameMut {
                rgb: Some(&mut *rgb),
                ..beside.as_mut()
            };
            self.draw((first, end), images, renderer, world, threads)?;
            self.shade(first, renderer, &beside, rgb);
            self.fill_walls(first, &walls, rgb);
        }
        Ok(rgb)
    }

    /// The depth at which a row meets the cut; `None` for one that looks level or up.
    fn near_m(&self, row: u32) -> Option<f32> {
        let pose = &self.view.world_from_camera;
        let (start, direction) = self
            .view
            .camera
            .ray_in_camera(Vec2::new(0.5, row as f32 + 0.5));
        let (start, direction) = (
            pose.transform_point(start),
            pose.transform_vector(direction),
        );
        (direction.y < -1e-3).then(|| ((self.level_y - start.y) / direction.y).max(0.0))
    }

    /// Draws rows, the first and the one behind the last, without light.
    fn draw(
        &self,
        rows: (u32, u32),
        mut rest: FrameMut<'_>,
        renderer: &CpuRenderer,
        (scene, state): (&RayScene, &State),
        threads: Threads,
    ) -> Result<(), RenderError> {
        let camera = self.view.camera;
        let mut jobs = Vec::new();
        let (mut first, last) = rows;
        while first < last {
            let near = self.near_m(first);
            let mut end = first + 1;
            while end < last && self.near_m(end) == near {
                end += 1;
            }
            let pixels = (end - first) as usize * camera.width() as usize;
            let part = rest.split_off_pixels(pixels);
            if let Some(near_m) = near.filter(|near_m| *near_m < camera.far_m()) {
                let view = View {
                    camera: camera.with_range(near_m, camera.far_m())?,
                    ..self.view
                };
                jobs.push(RenderJob {
                    rows: Some((first, end)),
                    ..RenderJob::new(scene, state, view, part)
                });
            }
            first = end;
        }
        renderer.render_batch(&mut jobs, threads)
    }

    /// Colours by how surfaces stand to the light; paper where nothing of the storey is.
    fn shade(&self, first_row: u32, renderer: &CpuRenderer, beside: &Frame, rgb: &mut [u8]) {
        let srgb = SrgbTables::tables();
        let house = renderer.house();
        let pose = &self.view.world_from_camera;
        let light = LIGHT.normalize_or_zero();
        let facing = |normal: Vec3| AMBIENT + (1.0 - AMBIENT) * normal.dot(light).max(0.0);
        // Floors keep their colour.
        let level = facing(pose.rotation.inverse() * Vec3::Y);
        let ground = |id: i32| match house.entity(EntityId(id)) {
            Some(Entity::Structure(piece)) => house.structure[piece].kind == StructureKind::Ground,
            found => found.is_none(),
        };
        let first = first_row as usize * self.view.camera.width() as usize;
        for (k, rgb) in rgb.chunks_exact_mut(3).enumerate() {
            if k % PIXELS_PER_CHECK == 0 {
                interrupt::unwind_if_cancelled();
            }
            let point = self.point_at_depth(first + k, beside.depth[k]);
            if beside.instance[k] == 0 || point.y < self.floor_y || ground(beside.instance[k]) {
                rgb.copy_from_slice(&PAPER);
                continue;
            }
            let normal = Vec3::from_slice(&beside.normals[k * 3..k * 3 + 3]);
            let share = facing(normal) / level;
            for byte in rgb {
                *byte = srgb.encode(srgb.decode(*byte) * share);
            }
        }
    }

    /// The point that a pixel shows at a depth.
    fn point_at_depth(&self, pixel: usize, depth_m: f32) -> Vec3 {
        let camera: &Camera = &self.view.camera;
        let width = camera.width() as usize;
        let image = Vec2::new((pixel % width) as f32 + 0.5, (pixel / width) as f32 + 0.5);
        let (start, direction) = camera.ray_in_camera(image);
        let in_camera = start + direction * depth_m;
        self.view.world_from_camera.transform_point(in_camera)
    }

    /// Paints the places where rays pass the cut inside walls: where `plan`, a picture of the map, is not black.
    fn fill_walls(&self, first_row: u32, plan: &[u8], rgb: &mut [u8]) {
        let (width, height) = (
            self.plan.view.camera.width(),
            self.plan.view.camera.height(),
        );
        let across = self.view.camera.width() as usize;
        for (row, rgb) in (first_row as usize..).zip(rgb.chunks_exact_mut(across * 3)) {
            interrupt::unwind_if_cancelled();
            let Some(near_m) = self.near_m(row as u32) else {
                continue;
            };
            for (column, rgb) in rgb.chunks_exact_mut(3).enumerate() {
                let place = self
                    .plan
                    .image_from_world(self.point_at_depth(row * across + column, near_m));
                let (x, y) = (place.x.floor(), place.y.floor());
                if x < 0.0 || y < 0.0 || x >= width as f32 || y >= height as f32 {
                    continue;
                }
                let byte = (y as usize * width as usize + x as usize) * 3;
                if plan[byte] != 0 {
                    rgb.copy_from_slice(&walls::SRGB);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::{House, LevelId, Pose, ShoeboxMaterials, space};
    use std::sync::Arc;

    /// Rows that meet the cut at one depth, and rows that all meet it at another.
    #[test]
    fn strips_of_any_size_make_the_same_picture() {
        let house = House::shoebox([8.0, 3.0, 4.0], &ShoeboxMaterials::default()).unwrap();
        let house = Arc::new(house);
        let (scene, state) = (RayScene::new(house.clone()), State::new(&house));
        let renderer = CpuRenderer::new(&house);
        let map = StoreyMap::new(&house, LevelId(0), 90).unwrap();
        let turned = space::rotation_from_yaw_pitch(0.4, -0.9);
        let eye = Vec3::new(4.0, 2.0, 2.0) - turned * Vec3::NEG_Z * 12.0;
        let beside = View::new(
            Camera::from_fov(80, 61, 50.0).unwrap(),
            Pose::new(eye, turned),
        );
        for view in [map.view, beside] {
            let cut = CutawayView {
                view,
                level_y: map.cut_y,
                floor_y: -0.5,
                plan: &map,
            };
            let drawn = |pixels: usize| {
                cut.in_strips(pixels, &renderer, (&scene, &state), Threads::ONE)
                    .unwrap()
            };
            let whole = drawn(usize::MAX);
            let papers = whole.chunks_exact(3).filter(|rgb| **rgb == PAPER).count();
            assert!(
                papers > 0 && papers * 10 < 9 * (whole.len() / 3),
                "{papers}"
            );
            for pixels in [1, 500, 1000] {
                assert!(drawn(pixels) == whole, "{pixels}");
            }
        }
    }
}
