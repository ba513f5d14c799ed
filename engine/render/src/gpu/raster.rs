//! The raster path: the pictures of a batch side by side in one texture, drawn in one pass.

use super::cull::{Culler, CullingView, OccluderScratch, VisibilityQuery};
use super::device::Gpu;
use super::kernels::BindGroupLayouts;
use crate::camera::Projection;
use crate::cpu::{RenderJob, VISIBLE_MASK};
use crate::error::RenderError;
use dwell_scene::bvh::flat::PackedRow;
use dwell_scene::parallel::Threads;
use dwell_scene::rays::BODY_PIECES;
use glam::{Affine3A, DAffine3, DVec3, DVec4, Vec3};
use std::ops::Range;

/// Format in which pixels store the nearest triangle: see `shaders/raster.wgsl`.
const NOTED: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Vertices of a block of four triangles.
const BLOCK_VERTICES: u32 = 12;
/// Most blocks of a piece: what a picture shows is cut into pieces of one length, so that one call draws them all.
const PIECE_BLOCKS: u32 = 8;
/// Rows of a record.
const RECORD_ROWS: usize = 5;

/// The data of a house that the raster path needs beside the buffers.
#[derive(Debug)]
pub(super) struct RasterScene {
    pub(super) culler: Culler,
    /// The blocks of each part that moves, then of each piece of an agent's body. Shape (mesh,).
    pub(super) mesh_blocks: Vec<Range<u32>>,
    /// True to leave out what cannot be seen; tests compare.
    pub(super) is_culling: bool,
}

/// A picture's place in the texture, its size, and its drawing.
#[derive(Clone, Debug)]
pub(super) struct AtlasTile {
    pub(super) x: u32,
    pub(super) y: u32,
    width: u32,
    height: u32,
    /// Range among the pieces of the drawing.
    pieces: Range<u32>,
}

/// The drawing of a batch. Its memory is used again.
#[derive(Debug, Default)]
pub(super) struct DrawBatch {
    pub(super) atlas_tiles: Vec<AtlasTile>,
    /// Five rows each: from a mesh to the picture's clip space, then source, id and the id that is not seen.
    pub(super) instance_rows: Vec<PackedRow>,
    /// First block, number of blocks, and the record.
    pub(super) draw_rows: Vec<PackedRow>,
    /// Size of the texture.
    pub(super) size: (u32, u32),
    /// The list of each sheet.
    lists: Vec<DrawList>,
}

/// The drawing of one picture: as in [`DrawBatch`], records counted from its own first.
#[derive(Debug, Default)]
struct DrawList {
    records: Vec<PackedRow>,
    pieces: Vec<PackedRow>,
    /// Blocks of static geometry that may be seen.
    ranges: Vec<Range<u32>>,
    shadows: OccluderScratch,
}

/// A picture that is drawn.
struct DrawView<'a, 'b> {
    job: &'a RenderJob<'b>,
    eye: CullingView,
    clip: [DVec4; 4],
}

/// The work of one thread: a picture, and its list.
struct DrawListJob<'a, 'b, 'c> {
    shot: Option<DrawView<'a, 'b>>,
    list: &'c mut DrawList,
}

impl DrawBatch {
    /// Returns whether the raster path supports a view: straight lines must stay straight, and pixels need neighbours above and below.
    fn supports_view(job: &RenderJob<'_>) -> bool {
        let camera = &job.view.camera;
        let is_whole = job.row_range() == (0, camera.height() as usize);
        matches!(camera.projection(), Projection::Pinhole { .. })
            && camera.near_m() > 0.0
            && is_whole
    }

    /// Lists the drawing of some jobs; returns the sheet of each that is drawn.
    pub(super) fn fill(
        &mut self,
        house: &RasterScene,
        jobs: &[RenderJob<'_>],
        most_edge: u32,
        threads: Threads,
    ) -> Vec<Option<usize>> {
        self.atlas_tiles.clear();
        self.instance_rows.clear();
        self.draw_rows.clear();
        let places = self.lay_out(jobs, most_edge);
        if self.lists.len() < self.atlas_tiles.len() {
            self.lists
                .resize_with(self.atlas_tiles.len(), DrawList::default);
        }
        let drawn = jobs
            .iter()
            .zip(&places)
            .filter(|(_, sheet)| sheet.is_some());
        let mut listings: Vec<DrawListJob<'_, '_, '_>> = drawn
            .zip(&mut self.lists)
            .map(|((job, _), list)| DrawListJob {
                shot: DrawView::new(job),
                list,
            })
            .collect();
        threads.for_each(&mut listings, |_, DrawListJob { shot, list }| {
            list.clear();
            if let Some(shot) = shot {
                list.fill(house, shot);
            }
        });
        for (sheet, list) in self.atlas_tiles.iter_mut().zip(&self.lists) {
            let first_record = (self.instance_rows.len() / RECORD_ROWS) as u32;
            let first_piece = self.draw_rows.len() as u32;
            self.instance_rows.extend_from_slice(&list.records);
            let pieces = list.pieces.iter();
            self.draw_rows.extend(
                pieces
                    .map(|[block, blocks, record, _]| [*block, *blocks, record + first_record, 0]),
            );
            sheet.pieces = first_piece..self.draw_rows.len() as u32;
        }
        places
    }

    /// Allocates space for pictures, in rows from left to right; those without space are not drawn.
    fn lay_out(&mut self, jobs: &[RenderJob<'_>], most_edge: u32) -> Vec<Option<usize>> {
        let pixels: usize = jobs.iter().map(|job| job.view.camera.pixels()).sum();
        let widest = jobs.iter().map(|job| job.view.camera.width()).max();
        let square = (pixels as f64).sqrt().ceil() as u32;
        let width = square
            .next_power_of_two()
            .max(widest.unwrap_or(1))
            .min(most_edge);
        let (mut x, mut y, mut tallest) = (0, 0, 0);
        let mut place = |job: &RenderJob<'_>| {
            let (across, down) = (job.view.camera.width(), job.view.camera.height());
            if !Self::supports_view(job) || across > width {
                return None;
            }
            if x + across > width {
                (x, y, tallest) = (0, y + tallest, 0);
            }
            if y + down > most_edge {
                return None;
            }
            self.atlas_tiles.push(AtlasTile {
                x,
                y,
                width: across,
                height: down,
                pieces: 0..0,
            });
            x += across;
            tallest = tallest.max(down);
            Some(self.atlas_tiles.len() - 1)
        };
        let places = jobs.iter().map(&mut place).collect();
        self.size = (width, y + tallest);
        places
    }

    /// Returns the number of draw calls of [`Self::draw`].
    pub(super) fn draw_call_count(&self) -> usize {
        let sheets = self.atlas_tiles.iter();
        sheets.filter(|sheet| !sheet.pieces.is_empty()).count()
    }

    /// Draws everything: one call for each picture.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        for sheet in self
            .atlas_tiles
            .iter()
            .filter(|sheet| !sheet.pieces.is_empty())
        {
            let [x, y, width, height] = [sheet.x, sheet.y, sheet.width, sheet.height];
            let [left, top, across, down] = [x, y, width, height].map(|edge| edge as f32);
            pass.set_viewport(left, top, across, down, 0.0, 1.0);
            pass.set_scissor_rect(x, y, width, height);
            pass.draw(0..PIECE_BLOCKS * BLOCK_VERTICES, sheet.pieces.clone());
        }
    }
}

impl DrawList {
    fn clear(&mut self) {
        self.records.clear();
        self.pieces.clear();
    }

    /// Lists the visible geometry of a shot: static geometry, then instances.
    fn fill(&mut self, house: &RasterScene, shot: &DrawView<'_, '_>) {
        let hidden = shot.eye.hidden_entity as u32;
        let mut shadows = std::mem::take(&mut self.shadows);
        let sightline = house
            .is_culling
            .then(|| house.culler.visibility_query(&shot.eye, &mut shadows));
        self.record(shot.clip, [0, 0, hidden, 0]);
        let mut ranges = std::mem::take(&mut self.ranges);
        match &sightline {
            Some(sightline) => house.culler.visible_blocks(sightline, &mut ranges),
            None => ranges = vec![house.culler.all_blocks()],
        }
        for range in &ranges {
            self.piece(range.clone());
        }
        self.ranges = ranges;
        let moving = shot.job.scene.bvh().moving;
        let parts = house.mesh_blocks.len() - BODY_PIECES;
        for instance in 0..moving.len() {
            let sees = |sightline: &VisibilityQuery<'_>| {
                sightline.is_visible(&moving.bounds_of(instance as u32))
            };
            if !sightline.as_ref().is_none_or(sees) {
                continue;
            }
            let Some(rows) = moving.flat_instance(instance, VISIBLE_MASK) else {
                continue;
            };
            let Some(world_from_mesh) = shot.job.scene.world_from_mesh(instance) else {
                continue;
            };
            // Hidden ones have no size.
            if f32::from_bits(rows[3][3]) <= 0.0 {
                continue;
            }
            let clip = shot.clip.map(|row| composed(row, world_from_mesh));
            self.record(clip, [instance as u32 + 1, rows[4][3], hidden, 0]);
            let mesh = if instance < parts {
                instance
            } else {
                parts + (instance - parts) % BODY_PIECES
            };
            self.piece(house.mesh_blocks[mesh].clone());
        }
        self.shadows = shadows;
    }

    fn record(&mut self, clip: [DVec4; 4], facts: PackedRow) {
        let rows = clip.map(|row| row.as_vec4().to_array().map(f32::to_bits));
        self.records.extend(rows);
        self.records.push(facts);
    }

    /// Adds blocks under the latest record.
    fn piece(&mut self, blocks: Range<u32>) {
        let record = (self.records.len() / RECORD_ROWS - 1) as u32;
        let pieces = blocks.clone().step_by(PIECE_BLOCKS as usize);
        let piece = |first: u32| [first, PIECE_BLOCKS.min(blocks.end - first), record, 0];
        self.pieces.extend(pieces.map(piece));
    }
}

/// A linear form on points of the world as one on points of a mesh.
fn composed(row: DVec4, world_from_mesh: &Affine3A) -> DVec4 {
    let map = DAffine3::from_mat4(glam::Mat4::from(*world_from_mesh).as_dmat4());
    let normal = row.truncate();
    let turned = map.matrix3.transpose() * normal;
    turned.extend(normal.dot(map.translation) + row.w)
}

impl<'a, 'b> DrawView<'a, 'b> {
    fn new(job: &'a RenderJob<'b>) -> Option<Self> {
        let (view, camera) = (&job.view, &job.view.camera);
        let Projection::Pinhole { fx, fy, cx, cy } = camera.projection() else {
            return None;
        };
        let rotation = view.world_from_camera.rotation.normalize();
        let [right, up, back] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| rotation * axis);
        let position = view.world_from_camera.position;
        let (near, far) = (camera.near_m(), camera.far_m());
        // Slopes of the edges of the picture.
        let (width, height) = (camera.width() as f32, camera.height() as f32);
        let (left, across) = (-cx / fx, (width - cx) / fx);
        let (top, bottom) = (cy / fy, (cy - height) / fy);
        let longest =
            (left.abs().max(across.abs()).powi(2) + top.abs().max(bottom.abs()).powi(2) + 1.0)
                .sqrt();
        let eye = CullingView {
            position,
            planes: [
                CullingView::plane_through(position, right + back * left),
                CullingView::plane_through(position, -back * across - right),
                CullingView::plane_through(position, -back * top - up),
                CullingView::plane_through(position, up + back * bottom),
                CullingView::plane_through(position - back * near, -back),
                CullingView::plane_through(position - back * far, back),
            ],
            near_m: near * longest,
            hidden_entity: view.hidden_entity.map_or(0, |entity| entity.0),
        };
        let from_eye = |axis: Vec3| {
            let axis: DVec3 = axis.as_dvec3();
            axis.extend(-axis.dot(position.as_dvec3()))
        };
        let (x, y, depth) = (from_eye(right), from_eye(up), from_eye(-back));
        let [fx, fy, cx, cy] = [fx, fy, cx, cy].map(f64::from);
        let (width, height) = (f64::from(width), f64::from(height));
        let (near, far) = (f64::from(near), f64::from(far));
        let steep = near / (far - near);
        let clip = [
            x * (2.0 * fx / width) + depth * (2.0 * cx / width - 1.0),
            y * (2.0 * fy / height) + depth * (1.0 - 2.0 * cy / height),
            DVec4::W * (steep * far) - depth * steep,
            depth,
        ];
        Some(Self { job, eye, clip })
    }
}

/// Render targets; they grow.
#[derive(Debug)]
pub(super) struct RenderAtlas {
    size: (u32, u32),
    noted: wgpu::TextureView,
    depth: wgpu::TextureView,
    pub(super) group: wgpu::BindGroup,
}

impl RenderAtlas {
    /// Returns targets of at least this size; the same as before where they are large enough.
    pub(super) fn reserve(
        held: Option<Self>,
        gpu: &Gpu,
        size: (u32, u32),
    ) -> Result<Self, RenderError> {
        let before = held.as_ref().map_or((1, 1), |held| held.size);
        let size = (size.0.max(before.0), size.1.max(before.1));
        if let Some(held) = held.filter(|held| held.size == size) {
            return Ok(held);
        }
        let texture = |format, usage| {
            gpu.increment_buffer_count();
            let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("atlas"),
                size: wgpu::Extent3d {
                    width: size.0,
                    height: size.1,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let noted = texture(NOTED, wgpu::TextureUsages::TEXTURE_BINDING);
        let depth = texture(DEPTH, wgpu::TextureUsages::empty());
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("atlas"),
            layout: &gpu.layouts.atlas,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&noted),
            }],
        });
        gpu.take_driver_error("to make a texture")?;
        Ok(Self {
            size,
            noted,
            depth,
            group,
        })
    }

    /// Starts a pass that clears both.
    pub(super) fn pass<'a>(&self, encoder: &'a mut wgpu::CommandEncoder) -> wgpu::RenderPass<'a> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("raster"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.noted,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations {
                    // Near is 1: what is far away has most of the digits.
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        })
    }
}

/// The render pipeline.
pub(super) fn pipeline(device: &wgpu::Device, layouts: &BindGroupLayouts) -> wgpu::RenderPipeline {
    let source = [
        include_str!("shaders/common.wgsl"),
        include_str!("shaders/raster.wgsl"),
    ];
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("raster"),
        source: wgpu::ShaderSource::Wgsl(source.concat().into()),
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("raster"),
        layout: Some(&layouts.raster),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("corner"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("surface"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(NOTED.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec4;

    /// Clip coordinates and planes agree about what a picture shows.
    #[test]
    fn what_lies_in_the_clip_volume_lies_within_the_planes() {
        use crate::camera::Camera;
        use crate::frame::{FrameMut, View};
        use dwell_scene::random::RandomKey;
        use dwell_scene::rays::RayScene;
        use dwell_scene::{House, Pose, ShoeboxMaterials, State, space};
        use std::sync::Arc;
        let house =
            Arc::new(House::shoebox([4.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap());
        let (scene, state) = (RayScene::new(house.clone()), State::new(&house));
        let projection = Projection::Pinhole {
            fx: 40.0,
            fy: 35.0,
            cx: 30.0,
            cy: 20.0,
        };
        let camera = Camera::new(64, 48, projection).unwrap();
        let camera = camera.with_range(0.5, 6.0).unwrap();
        let place = Pose::new(
            Vec3::new(1.0, 1.5, 2.0),
            space::rotation_from_yaw_pitch(0.7, -0.3),
        );
        let view = View::new(camera, place);
        let job = RenderJob::new(&scene, &state, view, FrameMut::default());
        let shot = DrawView::new(&job).unwrap();
        let mut stream = RandomKey::root(3).stream();
        let mut inside = 0;
        for _ in 0..20_000 {
            let point = Vec3::new(
                stream.range(-6.0, 6.0),
                stream.range(-4.0, 6.0),
                stream.range(-6.0, 6.0),
            );
            let clip = shot.clip.map(|row| row.dot(point.as_dvec3().extend(1.0)));
            let [x, y, z, w] = clip;
            let clipped = w > 0.0 && x.abs() <= w && y.abs() <= w && z >= 0.0 && z <= w;
            let planes = shot.eye.planes.iter();
            let within = planes.fold(f32::INFINITY, |least, plane: &Vec4| {
                least.min(plane.dot(point.extend(1.0)))
            });
            if within.abs() > 1e-4 {
                assert_eq!(clipped, within > 0.0, "{point}");
            }
            // And with where the camera puts points.
            let in_camera = place.inverse().transform_point(point);
            if let (true, Some((image, _))) = (clipped, camera.project(in_camera)) {
                let at = [(x / w + 1.0) * 32.0, (1.0 - y / w) * 24.0];
                assert!((at[0] as f32 - image.x).abs() < 1e-3);
                assert!((at[1] as f32 - image.y).abs() < 1e-3);
                inside += 1;
            }
        }
        assert!(inside > 200, "{inside}");
    }
}
