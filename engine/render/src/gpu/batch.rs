//! A batch as the kernels read it: views, worlds, and offsets of images.

use super::batch_buffers::HIT_BYTES;
use super::house_buffers::point;
use super::raster::{DrawBatch, RasterScene};
use super::world_rows::{WorldRows, runs_of_same_world};
use crate::camera::{Camera, Projection};
use crate::cpu::{CpuRenderer, RenderJob};
use crate::error::RenderError;
use crate::frame::{FrameMut, Preset, PreviousPoses, each_image};
use crate::light::Lighting;
use dwell_scene::bvh::flat::{PackedRow, flat_pose};
use dwell_scene::parallel::Threads;
use dwell_scene::rays::BODY_PIECES;
use dwell_scene::{Id, Pose, State};
use glam::{Quat, Vec2, Vec3, Vec4};

/// Rows of a view, as in `shaders/common.wgsl`.
const VIEW_ROWS: usize = 16;
/// No image.
const NOT_WANTED: u32 = u32::MAX;
/// Edge of a tile, pixels.
const TILE: u32 = 8;

/// Offsets of one view's images among the words that are read back.
#[derive(Clone, Copy, Debug)]
pub(super) struct ImageOffsets {
    /// Pixels of each image.
    pub(super) pixels: usize,
    pub(super) rgb: Option<usize>,
    pub(super) depth: Option<usize>,
    pub(super) instance: Option<usize>,
    pub(super) semantic: Option<usize>,
    pub(super) normals: Option<usize>,
    pub(super) albedo: Option<usize>,
    pub(super) flow: Option<usize>,
}

impl ImageOffsets {
    /// Checks that a frame wants the images that were announced.
    pub(super) fn check(&self, view: usize, frame: &FrameMut<'_>) -> Result<(), RenderError> {
        macro_rules! check {
            ($image:ident, $parts:expr) => {
                let was_wanted = self.$image.is_some();
                if frame.$image.is_some() != was_wanted {
                    return Err(RenderError::OtherImages {
                        view,
                        channel: stringify!($image),
                        was_wanted,
                    });
                }
            };
        }
        each_image!(check);
        Ok(())
    }
}

/// Groups of a kernel for a view of so many pixels.
pub(super) fn workgroup_count(width: u32, rows: u32) -> usize {
    width.div_ceil(TILE) as usize * rows.div_ceil(TILE) as usize
}

/// Words of all wanted images for each pixel.
pub(super) fn words_per_pixel(frame: &FrameMut<'_>) -> usize {
    usize::from(frame.rgb.is_some())
        + usize::from(frame.depth.is_some())
        + usize::from(frame.instance.is_some())
        + usize::from(frame.semantic.is_some())
        + 3 * usize::from(frame.normals.is_some())
        + 3 * usize::from(frame.albedo.is_some())
        + 2 * usize::from(frame.flow.is_some())
}

/// The rays of cameras that bend straight lines.
#[derive(Debug, Default)]
pub(super) struct LensRayTable {
    cameras: Vec<(Camera, u32)>,
    /// Directions per metre of depth in the camera's frame. Shape (ray,).
    pub(super) rays: Vec<[f32; 4]>,
    /// True if there are new ones.
    pub(super) changed: bool,
}

/// Rays kept for cameras that may come again.
const MOST_LENS_RAYS: usize = 1 << 22;

impl LensRayTable {
    /// Forgets old cameras when there are too many; before a batch.
    fn evict_old(&mut self) {
        if self.rays.len() > MOST_LENS_RAYS {
            self.invalidate();
        }
    }

    /// Forgets all cameras.
    pub(super) fn invalidate(&mut self) {
        self.cameras.clear();
        self.rays.clear();
    }

    /// The position of a camera's first ray.
    fn first_ray(&mut self, camera: &Camera) -> u32 {
        if let Some((_, first)) = self.cameras.iter().find(|(known, _)| known == camera) {
            return *first;
        }
        let first = self.rays.len() as u32;
        for row in 0..camera.height() {
            for column in 0..camera.width() {
                let image = Vec2::new(column as f32 + 0.5, row as f32 + 0.5);
                let direction = camera.ray_in_camera(image).1;
                self.rays.push(direction.extend(0.0).to_array());
            }
        }
        self.cameras.push((*camera, first));
        self.changed = true;
        first
    }
}

/// The rows of a batch, and the offsets of its images. Its memory is reused.
#[derive(Debug, Default)]
pub(super) struct PackedBatch {
    pub(super) rows: Vec<PackedRow>,
    pub(super) image_offsets: Vec<ImageOffsets>,
    pub(super) lens_rays: LensRayTable,
    /// The draw calls of the raster path.
    pub(super) draw_batch: DrawBatch,
    worlds: WorldRows,
    pub(super) pixels: usize,
    pub(super) words: usize,
    pub(super) tiles: usize,
    /// Most instances of a world.
    pub(super) instances: usize,
    pub(super) has_flat_color: bool,
    pub(super) has_lit_color: bool,
    pub(super) has_geometry_images: bool,
}

/// Returns whether a view needs light: colours alone show it.
fn is_lit(job: &RenderJob<'_>) -> bool {
    job.view.preset == Preset::Lit && job.frame.rgb.is_some()
}

fn quaternion(rotation: Quat) -> PackedRow {
    Vec4::from(rotation).to_array().map(f32::to_bits)
}

impl PackedBatch {
    /// Writes the rows of some jobs. `draws`: the house and the longest edge of a texture, for the raster path.
    pub(super) fn fill(
        &mut self,
        cpu: &CpuRenderer,
        jobs: &[RenderJob<'_>],
        draws: Option<(&RasterScene, u32)>,
        threads: Threads,
    ) {
        self.rows.clear();
        self.image_offsets.clear();
        (self.pixels, self.words, self.tiles, self.instances) = (0, 0, 0, 0);
        (
            self.has_flat_color,
            self.has_lit_color,
            self.has_geometry_images,
        ) = (false, false, false);
        self.lens_rays.evict_old();
        let sheets = if let Some((house, edge)) = draws {
            self.draw_batch.fill(house, jobs, edge, threads)
        } else {
            self.draw_batch.atlas_tiles.clear();
            vec![None; jobs.len()]
        };
        let runs = runs_of_same_world(jobs);
        self.worlds.fill(&runs, threads);
        let mut lights = threads.map(runs.len(), |run| {
            let lit = runs[run].iter().find(|job| is_lit(job))?;
            Some(cpu.cached_or_computed_lighting(lit.scene, lit.state))
        });
        self.rows.resize(1 + jobs.len() * VIEW_ROWS, [0; 4]);
        let mut k = 0;
        for (run, (views, light)) in runs.iter().zip(&mut lights).enumerate() {
            let world = self.worlds.append(run, &mut self.rows);
            self.instances = self.instances.max(views[0].scene.bvh().moving.len());
            let light = light.take().map(|light| {
                let first = self.add_light(cpu, &light, views[0].state);
                (light, first)
            });
            for job in *views {
                let shown = match &light {
                    Some((light, first)) if is_lit(job) => {
                        let eye = job.view.world_from_camera.position;
                        let exposure = light.exposure(cpu.static_lighting(), eye);
                        [1, *first, exposure.white_per_lx().to_bits(), 0]
                    }
                    _ => [0; 4],
                };
                self.add_view(k, job, world, shown);
                if let Some(sheet) = sheets[k].map(|sheet| &self.draw_batch.atlas_tiles[sheet]) {
                    self.rows[1 + k * VIEW_ROWS + 15] = [1, sheet.x, sheet.y, 0];
                }
                k += 1;
            }
            if let Some((light, _)) = light {
                cpu.return_to_lighting_cache(light);
            }
        }
        let records = self.rows.len();
        let mut pieces = records;
        if !self.draw_batch.atlas_tiles.is_empty() {
            self.rows.extend_from_slice(&self.draw_batch.instance_rows);
            pieces = self.rows.len();
            self.rows.extend_from_slice(&self.draw_batch.draw_rows);
        }
        self.rows[0] = [jobs.len(), self.tiles, records, pieces].map(|number| number as u32);
    }

    /// Bytes of all that grows with the batch: rows, rays of lenses, first hits and images.
    pub(super) fn buffer_sizes(&self) -> [u64; 4] {
        [
            size_of_val(&self.rows[..]) as u64,
            size_of_val(&self.lens_rays.rays[..]) as u64,
            self.pixels as u64 * HIT_BYTES,
            self.words as u64 * 4,
        ]
    }

    /// Adds the light of a world, and which things are switched off; returns the first row.
    fn add_light(&mut self, cpu: &CpuRenderer, lighting: &Lighting, state: &State) -> u32 {
        let first = self.rows.len() as u32;
        lighting.append_rows(&mut self.rows);
        let house = cpu.house();
        let bits = self.rows.len();
        let entities = 1 + house.structure.len() + house.objects.len();
        self.rows.resize(bits + entities.div_ceil(128), [0; 4]);
        for object in house.objects.ids() {
            if !state.is_on(house, object) {
                let id = house.entity_of_object(object).0 as usize;
                self.rows[bits + id / 128][id / 32 % 4] |= 1 << (id % 32);
            }
        }
        first
    }

    /// `shown`: the preset, the first row of its light, and the exposure.
    fn add_view(&mut self, k: usize, job: &RenderJob<'_>, world: u32, shown: PackedRow) {
        let (view, camera) = (&job.view, &job.view.camera);
        let rotation = view.world_from_camera.rotation.normalize();
        let (first_row, end) = job.row_range();
        let rows = (end - first_row) as u32;
        let pixels = rows as usize * camera.width() as usize;
        let places = self.allocate_images(&job.frame, pixels);
        let bits = |numbers: [f32; 4]| numbers.map(f32::to_bits);
        let (kind, lens, bend, more) = lens_of(camera);
        let lens_rays = if kind == PINHOLE || kind == ORTHOGRAPHIC {
            0
        } else {
            self.lens_rays.first_ray(camera)
        };
        let before = job.before.as_ref().filter(|_| places.flow.is_some());
        let before_rows = before.map_or(0, |before| self.add_previous_poses(job, before));
        let (fixed, growing) = camera.pixel_area();
        let eye_before = before.map_or(view.world_from_camera, |before| before.world_from_camera);
        let word = |place: Option<usize>| place.map_or(NOT_WANTED, |place| place as u32);
        let hidden = view.hidden_entity.map_or(0, |entity| entity.0) as u32;
        let written = [
            point(rotation * Vec3::X, camera.near_m().to_bits()),
            point(rotation * Vec3::Y, camera.far_m().to_bits()),
            point(rotation * Vec3::Z, hidden),
            point(view.world_from_camera.position, world),
            bits(lens),
            bits(bend),
            [more[0].to_bits(), more[1].to_bits(), kind, lens_rays],
            [camera.width(), camera.height(), first_row as u32, rows],
            [self.tiles as u32, self.pixels as u32, 0, 0],
            [places.rgb, places.depth, places.instance, places.semantic].map(word),
            [places.normals, places.albedo, places.flow, None].map(word),
            [
                fixed.to_bits(),
                growing.to_bits(),
                u32::from(before.is_some()),
                before_rows,
            ],
            quaternion(eye_before.rotation),
            point(eye_before.position, 0),
            shown,
        ];
        let first = 1 + k * VIEW_ROWS;
        self.rows[first..first + written.len()].copy_from_slice(&written);
        self.tiles += workgroup_count(camera.width(), rows);
        self.pixels += pixels;
        self.image_offsets.push(places);
        let frame = &job.frame;
        let is_lit = shown[0] == 1;
        self.has_flat_color |= frame.rgb.is_some() && !is_lit;
        self.has_lit_color |= frame.rgb.is_some() && is_lit;
        self.has_geometry_images |= words_per_pixel(frame) > usize::from(frame.rgb.is_some());
    }

    fn allocate_images(&mut self, frame: &FrameMut<'_>, pixels: usize) -> ImageOffsets {
        let mut next = |wanted: bool, parts: usize| {
            let first = self.words;
            self.words += if wanted { pixels * parts } else { 0 };
            wanted.then_some(first)
        };
        ImageOffsets {
            pixels,
            rgb: next(frame.rgb.is_some(), 1),
            depth: next(frame.depth.is_some(), 1),
            instance: next(frame.instance.is_some(), 1),
            semantic: next(frame.semantic.is_some(), 1),
            normals: next(frame.normals.is_some(), 3),
            albedo: next(frame.albedo.is_some(), 3),
            flow: next(frame.flow.is_some(), 2),
        }
    }

    /// Adds the previous pose of each instance; returns the first row.
    fn add_previous_poses(&mut self, job: &RenderJob<'_>, before: &PreviousPoses<'_>) -> u32 {
        let first = self.rows.len() as u32;
        for part in &job.scene.house().geometry().movable {
            let moved = &before.moved_parts;
            let was = moved.binary_search_by_key(&part.index(), |(part, _)| part.index());
            let pose = match was {
                Ok(place) => moved[place].1,
                Err(_) => job
                    .state
                    .part_pose
                    .get(*part)
                    .copied()
                    .unwrap_or(Pose::IDENTITY),
            };
            self.rows.extend(flat_pose(&pose));
        }
        let parts = job.scene.house().geometry().movable.len();
        for (agent, way) in previous_agent_offsets(job.state, before).enumerate() {
            for piece in 0..BODY_PIECES {
                let instance = (parts + agent * BODY_PIECES + piece) as u32;
                let pose = match job.scene.person_piece(instance) {
                    Some(now) => before.person_piece(agent, piece).unwrap_or(now.pose),
                    None => Pose::from_position(way),
                };
                self.rows.extend(flat_pose(&pose));
            }
        }
        first
    }
}

/// The displacement of each agent to its previous position, m.
fn previous_agent_offsets<'a>(
    state: &'a State,
    before: &'a PreviousPoses<'_>,
) -> impl Iterator<Item = Vec3> + 'a {
    let agents = state.agents.as_slice().iter().enumerate();
    agents.map(|(k, agent)| {
        before
            .agents
            .get(k)
            .map_or(Vec3::ZERO, |was| *was - agent.position)
    })
}

const PINHOLE: u32 = 0;
const ORTHOGRAPHIC: u32 = 5;

/// The kind of a camera and its numbers, as `shaders/camera.wgsl` reads them.
fn lens_of(camera: &Camera) -> (u32, [f32; 4], [f32; 4], [f32; 2]) {
    let none = [0.0; 4];
    match camera.projection() {
        Projection::Pinhole { fx, fy, cx, cy } => (PINHOLE, [fx, fy, cx, cy], none, [0.0; 2]),
        Projection::BrownConrady {
            fx,
            fy,
            cx,
            cy,
            k1,
            k2,
            k3,
            p1,
            p2,
        } => (1, [fx, fy, cx, cy], [k1, k2, k3, p1], [p2, 0.0]),
        Projection::Fisheye {
            fx,
            fy,
            cx,
            cy,
            k1,
            k2,
            k3,
            k4,
            half_angle_deg,
        } => (
            2,
            [fx, fy, cx, cy],
            [k1, k2, k3, k4],
            [0.0, half_angle_deg.to_radians()],
        ),
        Projection::Equirectangular {} => (3, none, none, [0.0; 2]),
        Projection::Cubemap {} => (4, none, none, [0.0; 2]),
        Projection::Orthographic { width_m, height_m } => {
            (ORTHOGRAPHIC, [width_m, height_m, 0.0, 0.0], none, [0.0; 2])
        }
    }
}
