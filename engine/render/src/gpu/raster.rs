//! The raster path: the pictures of a batch side by side in one texture, drawn in one pass.

use super::cull::{Culler, Eye};
use super::device::Gpu;
use super::kernels::Layouts;
use crate::camera::Projection;
use crate::cpu::{Job, SEEN};
use crate::error::RenderError;
use dwell_scene::bvh::flat::Row;
use dwell_scene::parallel::Threads;
use dwell_scene::rays::BODY_PIECES;
use glam::{Affine3A, DAffine3, DVec3, DVec4, Vec3};
use std::ops::Range;

/// What pixels note of the nearest triangle: see `shaders/raster.wgsl`.
const NOTED: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Vertices of a block of four triangles.
const BLOCK_VERTICES: u32 = 12;

/// What the raster path needs of a house beside the buffers.
#[derive(Debug)]
pub(super) struct Drawable {
    pub(super) culler: Culler,
    /// The blocks of each part that moves, then of each piece of an agent's body. Shape (mesh,).
    pub(super) meshes: Vec<Range<u32>>,
    /// Whether to leave out what cannot be seen; tests compare.
    pub(super) culls: bool,
}

/// A picture's place in the texture, and its size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheet {
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) width: u32,
    pub(super) height: u32,
}

/// Some triangles of one picture.
#[derive(Clone, Debug)]
struct Draw {
    /// Position in the list of sheets.
    sheet: usize,
    record: u32,
    blocks: Range<u32>,
}

/// What is drawn for a batch.
#[derive(Debug, Default)]
pub(super) struct Drawing {
    pub(super) sheets: Vec<Sheet>,
    draws: Vec<Draw>,
    /// Five rows each: from a mesh to the picture's clip space, then source, id and the id that is not seen.
    pub(super) records: Vec<Row>,
    /// Of the texture.
    pub(super) size: (u32, u32),
}

/// A picture with its place among the jobs.
struct Shot<'a, 'b> {
    job: &'a Job<'b>,
    sheet: usize,
    eye: Eye,
    clip: [DVec4; 4],
}

/// What is seen of a shot: blocks of static geometry, and instances.
type Seen = (Vec<Range<u32>>, Vec<usize>);

impl Drawing {
    /// Whether the raster path takes a view: straight lines must stay straight.
    fn takes(job: &Job<'_>) -> bool {
        let camera = &job.view.camera;
        let (first, end) = job.row_range();
        matches!(camera.projection(), Projection::Pinhole { .. })
            && camera.near_m() > 0.0
            && end > first
    }

    /// Lists what is to be drawn for some jobs; returns the sheet of each that is drawn.
    pub(super) fn fill(
        &mut self,
        house: &Drawable,
        jobs: &[Job<'_>],
        most_edge: u32,
        threads: Threads,
    ) -> Vec<Option<usize>> {
        self.sheets.clear();
        self.draws.clear();
        self.records.clear();
        let places = self.lay_out(jobs, most_edge);
        let shots: Vec<Shot<'_, '_>> = jobs
            .iter()
            .zip(&places)
            .filter_map(|(job, sheet)| Shot::new(job, (*sheet)?))
            .collect();
        let seen = threads.map(shots.len(), |k| shots[k].seen(house));
        for (shot, seen) in shots.iter().zip(seen) {
            self.add(house, shot, seen);
        }
        places
    }

    /// Finds room for pictures, in rows from left to right; those without room are not drawn.
    fn lay_out(&mut self, jobs: &[Job<'_>], most_edge: u32) -> Vec<Option<usize>> {
        let pixels: usize = jobs.iter().map(|job| job.view.camera.pixels()).sum();
        let widest = jobs.iter().map(|job| job.view.camera.width()).max();
        let square = (pixels as f64).sqrt().ceil() as u32;
        let width = square
            .next_power_of_two()
            .max(widest.unwrap_or(1))
            .min(most_edge);
        let (mut x, mut y, mut tallest) = (0, 0, 0);
        let mut place = |job: &Job<'_>| {
            let (first, end) = job.row_range();
            let (across, down) = (job.view.camera.width(), (end - first) as u32);
            if !Self::takes(job) || across > width {
                return None;
            }
            if x + across > width {
                (x, y, tallest) = (0, y + tallest, 0);
            }
            if y + down > most_edge {
                return None;
            }
            self.sheets.push(Sheet {
                x,
                y,
                width: across,
                height: down,
            });
            x += across;
            tallest = tallest.max(down);
            Some(self.sheets.len() - 1)
        };
        let places = jobs.iter().map(&mut place).collect();
        self.size = (width, y + tallest);
        places
    }

    fn add(&mut self, house: &Drawable, shot: &Shot<'_, '_>, (fixed, moving): Seen) {
        let hidden = shot.eye.hidden as u32;
        let sheet = shot.sheet;
        let record = self.record(shot.clip, [0, 0, hidden, 0]);
        let draw = |blocks| Draw {
            sheet,
            record,
            blocks,
        };
        self.draws.extend(fixed.into_iter().map(draw));
        for instance in moving {
            let set = shot.job.scene.bvh().moving;
            let Some(rows) = set.flat_instance(instance, SEEN) else {
                continue;
            };
            let Some(world_from_mesh) = shot.job.scene.world_from_mesh(instance) else {
                continue;
            };
            let clip = shot.clip.map(|row| composed(row, world_from_mesh));
            let record = self.record(clip, [instance as u32 + 1, rows[4][3], hidden, 0]);
            let parts = house.meshes.len() - BODY_PIECES;
            let mesh = if instance < parts {
                instance
            } else {
                parts + (instance - parts) % BODY_PIECES
            };
            self.draws.push(Draw {
                sheet,
                record,
                blocks: house.meshes[mesh].clone(),
            });
        }
    }

    fn record(&mut self, clip: [DVec4; 4], facts: Row) -> u32 {
        let record = self.records.len() / 5;
        let rows = clip.map(|row| row.as_vec4().to_array().map(f32::to_bits));
        self.records.extend(rows);
        self.records.push(facts);
        record as u32
    }

    /// Draws everything.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        let mut last = usize::MAX;
        for Draw {
            sheet,
            record,
            blocks,
        } in &self.draws
        {
            if *sheet != last {
                last = *sheet;
                let Sheet {
                    x,
                    y,
                    width,
                    height,
                } = self.sheets[*sheet];
                let [left, top, across, down] = [x, y, width, height].map(|edge| edge as f32);
                pass.set_viewport(left, top, across, down, 0.0, 1.0);
                pass.set_scissor_rect(x, y, width, height);
            }
            let vertices = blocks.start * BLOCK_VERTICES..blocks.end * BLOCK_VERTICES;
            pass.draw(vertices, *record..*record + 1);
        }
    }
}

/// A linear form on points of the world as one on points of a mesh.
fn composed(row: DVec4, world_from_mesh: &Affine3A) -> DVec4 {
    let map = DAffine3::from_mat4(glam::Mat4::from(*world_from_mesh).as_dmat4());
    let normal = row.truncate();
    let turned = map.matrix3.transpose() * normal;
    turned.extend(normal.dot(map.translation) + row.w)
}

impl<'a, 'b> Shot<'a, 'b> {
    fn new(job: &'a Job<'b>, sheet: usize) -> Option<Self> {
        let (view, camera) = (&job.view, &job.view.camera);
        let Projection::Pinhole { fx, fy, cx, cy } = camera.projection() else {
            return None;
        };
        let rotation = view.world_from_camera.rotation.normalize();
        let [right, up, back] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| rotation * axis);
        let position = view.world_from_camera.position;
        let (first, end) = job.row_range();
        let (near, far) = (camera.near_m(), camera.far_m());
        // Slopes of the edges of the picture.
        let width = camera.width() as f32;
        let (left, across) = (-cx / fx, (width - cx) / fx);
        let (top, bottom) = ((cy - first as f32) / fy, (cy - end as f32) / fy);
        let longest =
            (left.abs().max(across.abs()).powi(2) + top.abs().max(bottom.abs()).powi(2) + 1.0)
                .sqrt();
        let eye = Eye {
            position,
            planes: [
                Eye::through(position, right + back * left),
                Eye::through(position, -back * across - right),
                Eye::through(position, -back * top - up),
                Eye::through(position, up + back * bottom),
                Eye::through(position - back * near, -back),
                Eye::through(position - back * far, back),
            ],
            near_m: near * longest,
            hidden: view.hide.map_or(0, |entity| entity.0),
        };
        let from_eye = |axis: Vec3| {
            let axis: DVec3 = axis.as_dvec3();
            axis.extend(-axis.dot(position.as_dvec3()))
        };
        let (x, y, depth) = (from_eye(right), from_eye(up), from_eye(-back));
        let [fx, fy, cx, cy] = [fx, fy, cx, cy].map(f64::from);
        let (width, height) = (f64::from(width), (end - first) as f64);
        let cy = cy - first as f64;
        let (near, far) = (f64::from(near), f64::from(far));
        let steep = near / (far - near);
        let clip = [
            x * (2.0 * fx / width) + depth * (2.0 * cx / width - 1.0),
            y * (2.0 * fy / height) + depth * (1.0 - 2.0 * cy / height),
            DVec4::W * (steep * far) - depth * steep,
            depth,
        ];
        Some(Self {
            job,
            sheet,
            eye,
            clip,
        })
    }

    fn seen(&self, house: &Drawable) -> Seen {
        let moving = self.job.scene.bvh().moving;
        let there = |instance: &usize| {
            let rows = moving.flat_instance(*instance, SEEN);
            rows.is_some_and(|rows| f32::from_bits(rows[3][3]) > 0.0)
        };
        let instances = (0..moving.len()).filter(there);
        if !house.culls {
            return (vec![house.culler.everything()], instances.collect());
        }
        let sightline = house.culler.sightline(&self.eye);
        let mut ranges = Vec::new();
        house.culler.visible(&sightline, &mut ranges);
        let sees = |k: &usize| sightline.sees(&moving.bounds_of(*k as u32));
        (ranges, instances.filter(sees).collect())
    }
}

/// Textures that are drawn into; they grow.
#[derive(Debug)]
pub(super) struct Atlas {
    size: (u32, u32),
    noted: wgpu::TextureView,
    depth: wgpu::TextureView,
    pub(super) group: wgpu::BindGroup,
}

impl Atlas {
    /// Textures of at least this size; the same as before where they are large enough.
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
            gpu.count_buffer();
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
        gpu.check("to make a texture")?;
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

/// The program that draws.
pub(super) fn pipeline(device: &wgpu::Device, layouts: &Layouts) -> wgpu::RenderPipeline {
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
        use dwell_scene::random::Key;
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
        let mut job = Job::new(
            &scene,
            &state,
            View::new(camera, place),
            FrameMut::default(),
        );
        job.rows = Some((5, 40));
        let shot = Shot::new(&job, 0).unwrap();
        let mut stream = Key::root(3).stream();
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
                let at = [(x / w + 1.0) * 32.0, (1.0 - y / w) * 17.5 + 5.0];
                assert!((at[0] as f32 - image.x).abs() < 1e-3);
                assert!((at[1] as f32 - image.y).abs() < 1e-3);
                inside += 1;
            }
        }
        assert!(inside > 200, "{inside}");
    }
}
