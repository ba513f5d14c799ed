//! Kernels of the adapter, and the buffers that they bind.

use std::sync::OnceLock;

/// The bind group layouts of all kernels: a house, and a batch of views.
#[derive(Debug)]
pub(super) struct BindGroupLayouts {
    pub(super) house: wgpu::BindGroupLayout,
    pub(super) batch: wgpu::BindGroupLayout,
    /// The rows of a batch alone, for drawing.
    pub(super) rows: wgpu::BindGroupLayout,
    /// The drawn triangle of each pixel.
    pub(super) atlas: wgpu::BindGroupLayout,
    pipeline: wgpu::PipelineLayout,
    settle: wgpu::PipelineLayout,
    pub(super) raster: wgpu::PipelineLayout,
}

impl BindGroupLayouts {
    /// Number of buffers that a kernel binds.
    pub(super) const BUFFERS: u32 = 8;

    pub(super) fn new(device: &wgpu::Device) -> Self {
        let drawn = wgpu::ShaderStages::VERTEX;
        let group = |label: &str, writable: &[bool], stages: wgpu::ShaderStages| {
            let entry = |binding: usize| wgpu::BindGroupLayoutEntry {
                binding: binding as u32,
                visibility: stages,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Storage {
                        read_only: !writable[binding],
                    },
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            };
            let entries: Vec<_> = (0..writable.len()).map(entry).collect();
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(label),
                entries: &entries,
            })
        };
        let computed = wgpu::ShaderStages::COMPUTE;
        let house = group("house", &[false; 4], computed | drawn);
        let batch = group("batch", &[false, false, true, true], computed);
        let rows = group("rows", &[false], drawn);
        let atlas = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("atlas"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: computed,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Uint,
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            }],
        });
        let pipeline = |groups: &[Option<&wgpu::BindGroupLayout>]| {
            device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: groups,
                immediate_size: 0,
            })
        };
        Self {
            pipeline: pipeline(&[Some(&house), Some(&batch)]),
            settle: pipeline(&[Some(&house), Some(&batch), Some(&atlas)]),
            raster: pipeline(&[Some(&house), Some(&rows)]),
            house,
            batch,
            rows,
            atlas,
        }
    }
}

/// The kernels, for trees whose traversal stacks hold at most so many links.
#[derive(Debug)]
pub(super) struct Kernels {
    stack: usize,
    /// The closest hit of each pixel, by rays.
    pub(super) trace: wgpu::ComputePipeline,
    /// All images but colour.
    pub(super) geometry_images: wgpu::ComputePipeline,
    /// Flat colour.
    pub(super) flat_color: wgpu::ComputePipeline,
    /// Made for the first lit view.
    lit: OnceLock<wgpu::ComputePipeline>,
    /// Made for the first view that is drawn.
    settle: OnceLock<wgpu::ComputePipeline>,
}

const SKIN: &str = include_str!("shaders/skin.wgsl");
const COLORS: &str = include_str!("shaders/colors.wgsl");

impl Kernels {
    /// Compiles all but that of lit pictures.
    pub(super) fn new(device: &wgpu::Device, layouts: &BindGroupLayouts, stack: usize) -> Self {
        let layout = &layouts.pipeline;
        let kernel = |entry: &str, parts: &[&str]| compile(device, layout, stack, entry, parts);
        Self {
            stack,
            trace: kernel("trace", &[include_str!("shaders/trace.wgsl")]),
            geometry_images: kernel("describe", &[SKIN, include_str!("shaders/describe.wgsl")]),
            flat_color: kernel("paint", &[SKIN, COLORS, include_str!("shaders/paint.wgsl")]),
            lit: OnceLock::new(),
            settle: OnceLock::new(),
        }
    }

    /// Lit colour.
    pub(super) fn lit_kernel(
        &self,
        device: &wgpu::Device,
        layouts: &BindGroupLayouts,
    ) -> &wgpu::ComputePipeline {
        self.lit.get_or_init(|| {
            let light = include_str!("shaders/light.wgsl");
            let paint = include_str!("shaders/paint_lit.wgsl");
            let parts = [SKIN, COLORS, light, paint];
            compile(device, &layouts.pipeline, self.stack, "paint_lit", &parts)
        })
    }

    /// Returns the kernel that finds the closest hit of each pixel of drawn pictures.
    pub(super) fn raster_hit_kernel(
        &self,
        device: &wgpu::Device,
        layouts: &BindGroupLayouts,
    ) -> &wgpu::ComputePipeline {
        self.settle.get_or_init(|| {
            let parts = [include_str!("shaders/settle.wgsl")];
            compile(device, &layouts.settle, self.stack, "settle", &parts)
        })
    }
}

/// One kernel: what all share, then its own parts.
fn compile(
    device: &wgpu::Device,
    layout: &wgpu::PipelineLayout,
    stack: usize,
    entry: &str,
    parts: &[&str],
) -> wgpu::ComputePipeline {
    let stack = format!("const STACK: u32 = {stack}u;\n");
    let shared = [
        stack.as_str(),
        include_str!("shaders/common.wgsl"),
        include_str!("shaders/camera.wgsl"),
        include_str!("shaders/walk.wgsl"),
    ];
    let source: String = shared.iter().chain(parts).copied().collect();
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(entry),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: Some(layout),
        module: &module,
        entry_point: Some(entry),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    })
}
