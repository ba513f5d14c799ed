//! What agreement is, and how it is measured.

use dwell_render::{
    Before, Camera, Channels, CpuRenderer, Frame, Gpu, GpuRenderer, Job, Path, View, adapters,
};
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{House, State};
use std::sync::{Arc, OnceLock};

/// The first adapter, of software too; printed where there is none.
pub(crate) fn gpu() -> Option<Arc<Gpu>> {
    static GPU: OnceLock<Option<Arc<Gpu>>> = OnceLock::new();
    let open = || {
        let Some(first) = adapters().into_iter().next() else {
            println!("skipped: no graphics adapter, not even of software");
            return None;
        };
        println!("adapter: {first}, {}", first.driver);
        Some(Gpu::open(Some(&first.name)).unwrap())
    };
    GPU.get_or_init(open).clone()
}

/// A house, one world in it, and both back ends.
pub(crate) struct Pair {
    pub(crate) house: Arc<House>,
    pub(crate) state: State,
    pub(crate) scene: RayScene,
    pub(crate) cpu: Arc<CpuRenderer>,
    pub(crate) gpu: GpuRenderer,
}

impl Pair {
    pub(crate) fn new(house: Arc<House>, path: Path) -> Option<Self> {
        let gpu = gpu()?;
        let cpu = Arc::new(CpuRenderer::new(&house));
        Some(Self {
            state: State::new(&house),
            scene: RayScene::new(house.clone()),
            gpu: GpuRenderer::new(gpu, cpu.clone(), path).unwrap(),
            cpu,
            house,
        })
    }

    /// The same views by both, one batch each.
    pub(crate) fn shoot(&self, views: &[View]) -> Vec<(Frame, Frame)> {
        self.shoot_after(views, None)
    }

    /// As [`Self::shoot`], with flow since `before`.
    pub(crate) fn shoot_after(
        &self,
        views: &[View],
        before: Option<Before<'_>>,
    ) -> Vec<(Frame, Frame)> {
        let by_cpu = self.by(views, before, &|jobs| {
            self.cpu.render_batch(jobs, Threads::default()).unwrap();
        });
        let by_gpu = self.by(views, before, &|jobs| {
            self.gpu.render_batch(jobs, Threads::default()).unwrap();
        });
        by_cpu.into_iter().zip(by_gpu).collect()
    }

    /// All images of some views, by whatever renders.
    pub(crate) fn by(
        &self,
        views: &[View],
        before: Option<Before<'_>>,
        render: &dyn Fn(&mut [Job<'_>]),
    ) -> Vec<Frame> {
        let mut frames: Vec<Frame> = views
            .iter()
            .map(|view| Frame::new(&view.camera, Channels::ALL))
            .collect();
        let mut jobs: Vec<Job<'_>> = views
            .iter()
            .zip(&mut frames)
            .map(|(view, frame)| Job {
                before,
                ..Job::new(&self.scene, &self.state, *view, frame.as_mut())
            })
            .collect();
        render(&mut jobs);
        drop(jobs);
        frames
    }
}

/// What was compared.
#[derive(Debug, Default)]
pub(crate) struct Count {
    pub(crate) pixels: usize,
    /// Pixels whose neighbourhood holds one id and no jump of depth.
    pub(crate) inner: usize,
    /// Other pixels with another id, coincident things apart.
    pub(crate) edge_ids: usize,
    /// Pixels that show another of two coincident things.
    pub(crate) coincident: usize,
    /// Inner pixels whose colour differs by more than [`LEVELS`].
    pub(crate) colors: usize,
    /// Sum of the differences of colour, levels.
    pub(crate) levels: f64,
}

/// Levels by which colours may differ.
const LEVELS: u8 = 2;

impl Count {
    /// Compares a view: what DESIGN 4.2 asks for, or a panic that names the pixel.
    pub(crate) fn compare(&mut self, name: &str, camera: &Camera, (cpu, gpu): &(Frame, Frame)) {
        let (width, height) = (camera.width() as usize, camera.height() as usize);
        for pixel in 0..width * height {
            let (x, y) = (pixel % width, pixel / width);
            let around: Vec<usize> = (y.saturating_sub(1)..(y + 2).min(height))
                .flat_map(|y| (x.saturating_sub(1)..(x + 2).min(width)).map(move |x| (x, y)))
                .map(|(x, y)| y * width + x)
                .collect();
            let depths = around.iter().map(|k| cpu.depth[*k]);
            let (near, far) = depths.fold((f32::INFINITY, 0.0_f32), |(near, far), depth| {
                (near.min(depth), far.max(depth))
            });
            let one_id = around
                .iter()
                .all(|k| cpu.instance[*k] == cpu.instance[pixel]);
            self.pixels += 1;
            let place = || format!("{name}: pixel ({x}, {y})");
            if !one_id || far - near > 0.02 * near {
                if cpu.instance[pixel] != gpu.instance[pixel] {
                    let off = (cpu.depth[pixel] - gpu.depth[pixel]).abs();
                    self.edge_ids += usize::from(off >= 1e-4);
                    self.coincident += usize::from(off < 1e-4);
                }
                continue;
            }
            self.inner += 1;
            let off = (cpu.depth[pixel] - gpu.depth[pixel]).abs();
            let (ids, other) = (cpu.instance[pixel], gpu.instance[pixel]);
            if ids != other {
                assert!(
                    off < 1e-4,
                    "{}: id {ids}, {other} by gpu, depth off by {off} m",
                    place()
                );
                self.coincident += 1;
                continue;
            }
            assert!(
                off < 1e-3,
                "{}: id {ids}, depth {} off by {off} m",
                place(),
                cpu.depth[pixel]
            );
            assert_eq!(cpu.semantic[pixel], gpu.semantic[pixel], "{}", place());
            // A pixel on an edge between triangles may show the one or the other.
            let near_one = |image: &dyn Fn(usize) -> Vec<f32>, found: &[f32], most: f32| {
                around.iter().any(|k| {
                    let known = image(*k);
                    known.iter().zip(found).all(|(a, b)| (a - b).abs() <= most)
                })
            };
            let of3 = |image: &[f32], k: usize| image[k * 3..k * 3 + 3].to_vec();
            let normal = of3(&gpu.normals, pixel);
            assert!(
                near_one(&|k| of3(&cpu.normals, k), &normal, 1e-3),
                "{}: normal {normal:?}, not {:?}",
                place(),
                of3(&cpu.normals, pixel)
            );
            let of2 = |image: &[f32], k: usize| image[k * 2..k * 2 + 2].to_vec();
            let flow = of2(&gpu.flow, pixel);
            assert!(
                near_one(&|k| of2(&cpu.flow, k), &flow, 0.02),
                "{}: flow {flow:?}, not {:?}",
                place(),
                of2(&cpu.flow, pixel)
            );
            let off = of3(&cpu.albedo, pixel)
                .iter()
                .zip(of3(&gpu.albedo, pixel))
                .fold(0.0_f32, |most, (a, b)| most.max((a - b).abs()));
            let off_color = (0..3)
                .map(|k| cpu.rgb[pixel * 3 + k].abs_diff(gpu.rgb[pixel * 3 + k]))
                .max()
                .unwrap_or(0);
            self.colors += usize::from(off_color > LEVELS || off > 0.01);
            self.levels += f64::from(off_color);
        }
    }

    /// Prints the figures and checks those that are shares: coincident pixels and colours.
    /// `least`: the share of inner pixels.
    pub(crate) fn finish(&self, name: &str, least: f64) {
        let share = |part: usize| part as f64 / self.inner.max(1) as f64;
        println!(
            "{name}: {} pixels, {} inner, {} ids differ at edges, {} coincident, {} colours off by more than {LEVELS}, \
             mean {:.4} levels",
            self.pixels,
            self.inner,
            self.edge_ids,
            self.coincident,
            self.colors,
            self.levels / self.inner.max(1) as f64
        );
        assert!(self.inner as f64 > least * self.pixels as f64, "{self:?}");
        // Pixels on edges between triangles of one thing, of other materials or levels of a texture.
        assert!(share(self.colors) < 2e-3, "{self:?}");
        assert!(self.levels / (self.inner.max(1) as f64) < 0.05, "{self:?}");
        assert!(
            (self.edge_ids as f64) < 0.01 * self.pixels as f64,
            "{self:?}"
        );
    }
}
