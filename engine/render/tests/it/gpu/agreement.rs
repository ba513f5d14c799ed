//! The same views by both back ends.

use dwell_render::{
    BatchLimits, CpuRenderer, Frame, Gpu, GpuRenderer, ImageChannels, PreviousPoses, RenderJob,
    View, VisibilityPath, adapters,
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
        Some(Gpu::open_adapter(&first, BatchLimits::NONE).unwrap())
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
    pub(crate) fn new(house: Arc<House>, path: VisibilityPath) -> Option<Self> {
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
        before: Option<PreviousPoses<'_>>,
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
        before: Option<PreviousPoses<'_>>,
        render: &dyn Fn(&mut [RenderJob<'_>]),
    ) -> Vec<Frame> {
        let mut frames: Vec<Frame> = views
            .iter()
            .map(|view| Frame::new(&view.camera, ImageChannels::ALL))
            .collect();
        let mut jobs: Vec<RenderJob<'_>> = views
            .iter()
            .zip(&mut frames)
            .map(|(view, frame)| RenderJob {
                before,
                ..RenderJob::new(&self.scene, &self.state, *view, frame.as_mut())
            })
            .collect();
        render(&mut jobs);
        drop(jobs);
        frames
    }
}
