//! The programs that run on the adapter, and the buffers that they see.

/// What all kernels see: a house, and a batch of views.
#[derive(Debug)]
pub(super) struct Layouts {
    pub(super) house: wgpu::BindGroupLayout,
    pub(super) batch: wgpu::BindGroupLayout,
    pipeline: wgpu::PipelineLayout,
}

impl Layouts {
    /// Buffers that a kernel sees.
    pub(super) const BUFFERS: u32 = 8;

    pub(super) fn new(device: &wgpu::Device) -> Self {
        let group = |label: &str, writable: [bool; 4]| {
            let entry = |binding: usize| wgpu::BindGroupLayoutEntry {
                binding: binding as u32,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Storage {
                        read_only: !writable[binding],
                    },
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            };
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(label),
                entries: &[0, 1, 2, 3].map(entry),
            })
        };
        let house = group("house", [false; 4]);
        let batch = group("batch", [false, false, true, true]);
        let pipeline = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&house), Some(&batch)],
            immediate_size: 0,
        });
        Self {
            house,
            batch,
            pipeline,
        }
    }
}

/// The kernels.
#[derive(Debug)]
pub(super) struct Kernels {
    /// What each pixel sees first, by rays.
    pub(super) trace: wgpu::ComputePipeline,
    /// All images but colour.
    pub(super) describe: wgpu::ComputePipeline,
    /// Colour.
    pub(super) paint: wgpu::ComputePipeline,
}

impl Kernels {
    /// Compiles them, for trees in which at most `stack` links wait.
    pub(super) fn new(device: &wgpu::Device, layouts: &Layouts, stack: usize) -> Self {
        let kernel = |entry: &str, parts: &[&str]| {
            let shared = [
                include_str!("shaders/common.wgsl"),
                include_str!("shaders/camera.wgsl"),
                include_str!("shaders/walk.wgsl"),
            ];
            let stack = format!("const STACK: u32 = {stack}u;\n");
            let source: String = [stack.as_str()]
                .into_iter()
                .chain(shared)
                .chain(parts.iter().copied())
                .collect();
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(entry),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            });
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(&layouts.pipeline),
                module: &module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        };
        let skin = include_str!("shaders/skin.wgsl");
        Self {
            trace: kernel("trace", &[include_str!("shaders/trace.wgsl")]),
            describe: kernel("describe", &[skin, include_str!("shaders/describe.wgsl")]),
            paint: kernel("paint", &[skin, include_str!("shaders/paint.wgsl")]),
        }
    }
}
