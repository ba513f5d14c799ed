//! A house in the adapter's memory: trees, triangles, textures and tables.

use super::cull::Culler;
use super::device::Gpu;
use super::occluders::occluders;
use super::raster::RasterScene;
use crate::color::SrgbTables;
use crate::cpu::{CpuRenderer, VISIBLE_MASK};
use crate::error::RenderError;
use crate::semantic::ClassSet;
use dwell_scene::bvh::TriangleBvh;
use dwell_scene::bvh::flat::{BLOCK_ROWS, FlatBvhRoot, NO_LINK, PackedRow};
use dwell_scene::rays::{BODY_PIECES, body_trees};
use dwell_scene::{IdVec, MeshId};
use glam::Vec3;
use std::ops::Range;

/// Rows before the tables; `shaders/common.wgsl` and `skin.wgsl` read them by number.
const HEADER_ROWS: usize = 8;

/// The buffers of a house's constant data, and their bind group.
#[derive(Debug)]
pub(super) struct HouseBuffers {
    pub(super) group: wgpu::BindGroup,
    /// Stack size for the tree of static geometry: the most links that wait while it is walked.
    pub(super) stack: usize,
    /// As `stack`, for the deepest mesh of an instance.
    pub(super) mesh_stack: usize,
    /// The data for the raster path.
    pub(super) drawable: RasterScene,
    /// Memory held, bytes.
    pub(super) bytes: u64,
}

/// A point as the first three numbers of a row.
pub(super) fn point(point: Vec3, last: u32) -> PackedRow {
    let [x, y, z] = point.to_array().map(f32::to_bits);
    [x, y, z, last]
}

/// Words as rows, the last one filled up with zeros.
fn rows_of_words(words: impl Iterator<Item = u32>) -> Vec<PackedRow> {
    let mut rows = Vec::new();
    for (k, word) in words.enumerate() {
        if k % 4 == 0 {
            rows.push([0; 4]);
        }
        if let Some(row) = rows.last_mut() {
            row[k % 4] = word;
        }
    }
    rows
}

/// Tables one behind the other, after the header.
struct PackedTables(Vec<PackedRow>);

impl PackedTables {
    /// Appends a table and returns its first row.
    fn add(&mut self, rows: impl IntoIterator<Item = PackedRow>) -> u32 {
        let first = self.0.len() as u32;
        self.0.extend(rows);
        first
    }
}

impl HouseBuffers {
    /// Writes a house as `cpu` has prepared it.
    ///
    /// # Errors
    /// [`RenderError::TooLarge`] names the house and what of it does not fit.
    pub(super) fn new(gpu: &Gpu, cpu: &CpuRenderer) -> Result<Self, RenderError> {
        let (house, geometry) = (cpu.house(), cpu.house().geometry());
        let (mut nodes, mut blocks) = (Vec::new(), Vec::new());
        let fixed = geometry
            .static_bvh
            .flatten(VISIBLE_MASK, &mut nodes, &mut blocks);
        let culler = Culler::new(&nodes, fixed.root, fixed.bounds, occluders(&blocks));
        // Each mesh once, however many parts show it.
        let mut flat: IdVec<MeshId, Option<(FlatBvhRoot, Range<u32>)>> =
            IdVec::filled(None, house.meshes.len());
        let mut trees: Vec<FlatBvhRoot> = Vec::new();
        let mut ranges: Vec<Range<u32>> = Vec::new();
        let mut add = |tree: &TriangleBvh| {
            let first = (blocks.len() / BLOCK_ROWS) as u32;
            let tree = tree.flatten(VISIBLE_MASK, &mut nodes, &mut blocks);
            (tree, first..(blocks.len() / BLOCK_ROWS) as u32)
        };
        for part in &geometry.movable {
            let mesh = geometry.placed_part(*part).mesh;
            let made = flat[mesh].get_or_insert_with(|| match &geometry.mesh_bvh[mesh] {
                Some(tree) => add(tree),
                None => (
                    FlatBvhRoot {
                        root: NO_LINK,
                        bounds: dwell_scene::Aabb::EMPTY,
                        stack_size: 0,
                    },
                    0..0,
                ),
            });
            trees.push(made.0);
            ranges.push(made.1.clone());
        }
        for tree in body_trees() {
            let (tree, range) = add(tree);
            trees.push(tree);
            ranges.push(range);
        }
        debug_assert_eq!(trees.len(), geometry.movable.len() + BODY_PIECES);
        let mut tables = PackedTables(vec![[0; 4]; HEADER_ROWS]);
        let (levels, images, texels) = cpu.textures.to_rows();
        let levels = tables.add(levels);
        let images = tables.add(images);
        let looks = tables.add(
            cpu.shading_materials
                .iter()
                .flat_map(crate::material::ShadingMaterial::packed_rows),
        );
        let classes = cpu.classes(ClassSet::Coarse).all();
        let class_rows = tables.add(rows_of_words(classes.iter().map(|class| *class as u32)));
        let (decode, encode) = SrgbTables::tables().entries();
        let decode = tables.add(rows_of_words(decode.iter().map(|light| light.to_bits())));
        let steps = encode.as_chunks::<4>().0.iter();
        let encode = tables.add(rows_of_words(steps.map(|bytes| u32::from_le_bytes(*bytes))));
        let meshes = trees.iter().zip(cpu.triangle_table.first_triangles());
        let meshes = tables.add(meshes.flat_map(|(tree, first)| {
            [
                point(tree.bounds.min, tree.root),
                point(tree.bounds.max, first),
            ]
        }));
        let texels = tables.add(rows_of_words(
            texels.iter().map(|texel| u32::from_le_bytes(*texel)),
        ));
        tables.0[0] = [levels, images, looks, class_rows];
        tables.0[1] = [decode, encode, meshes, texels];
        let parts = geometry.movable.len() as u32;
        tables.0[2] = [fixed.root, 0, parts, classes.len() as u32];
        tables.0[3] = point(fixed.bounds.min, 0);
        tables.0[4] = point(fixed.bounds.max, 0);
        let light = tables.0.len();
        tables.add(cpu.static_lighting().to_rows(light));
        tables.0[2][1] = light as u32;
        let triangles = cpu.triangle_table.to_rows();
        let name = &house.name;
        let mut bytes = 0;
        let mut upload = |what: &str, rows: &[PackedRow]| {
            let data: &[u8] = bytemuck::cast_slice(rows);
            bytes += data.len() as u64;
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
            let what = format!("house {name:?}: its {what}");
            let buffer = gpu.buffer(&what, data.len() as u64, usage)?;
            gpu.queue.write_buffer(&buffer, 0, data);
            Ok(buffer)
        };
        let buffers = [
            upload("tree", &nodes)?,
            upload("corners", &blocks)?,
            upload("triangles", &triangles)?,
            upload("textures", &tables.0)?,
        ];
        let entries = [0, 1, 2, 3].map(|k: usize| wgpu::BindGroupEntry {
            binding: k as u32,
            resource: buffers[k].as_entire_binding(),
        });
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("house"),
            layout: &gpu.layouts.house,
            entries: &entries,
        });
        gpu.take_driver_error("to take a house")?;
        tracing::debug!(bytes, "house in the adapter's memory");
        Ok(Self {
            group,
            stack: fixed.stack_size,
            mesh_stack: trees.iter().map(|tree| tree.stack_size).max().unwrap_or(0),
            drawable: RasterScene {
                culler,
                mesh_blocks: ranges,
                is_culling: true,
            },
            bytes,
        })
    }
}
