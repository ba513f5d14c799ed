//! Pictures whose shutter is open or rolls: the moments that they are made of, and how those become one picture.

use super::{ImageRequest, ViewMotion};
use crate::motion_history::interpolate_back;
use crate::world::World;
use dwell_render::laws::mean_color;
use dwell_render::{Camera, Frame, FrameMut, RenderJob};
use dwell_scene::State;
use dwell_scene::rays::RayScene;

/// Moments from which the light of an exposure is averaged.
const EXPOSED: u16 = 16;
/// Moments between which things stand still while a shutter rolls; the camera moves from row to row.
const MOMENTS: usize = 16;

/// The times at which a picture's rows are taken, in steps of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
struct RowTiming {
    /// Delay of each row after the one above.
    delay: f32,
    /// Exposure time of each row's colours.
    exposure: f32,
}

/// Rows that are taken at one moment.
struct SimultaneousRows<'a> {
    /// Time before the picture's, in steps of the world.
    share: f32,
    /// The first row and the one behind the last; `None`: all.
    rows: Option<(u32, u32)>,
    frame: FrameMut<'a>,
}

/// A picture that is being taken.
#[derive(Debug)]
pub(crate) struct OngoingExposure {
    shot: ViewMotion,
    timing: RowTiming,
    moments: PastStates,
    /// Colours at each moment of the exposure; empty without one.
    exposed: Vec<Vec<u8>>,
}

impl OngoingExposure {
    /// A picture of a world as it stands, as the laws of its camera have it. `has_color`: whether colours are wanted.
    pub(crate) fn new(world: &World, request: &ImageRequest, has_color: bool) -> Self {
        let shot = world.moving_view(request);
        let shutter = world.optics(&request.mount).shutter();
        let step_s = world.config().step_s() as f32;
        let timing = RowTiming {
            delay: shutter.line_s / step_s,
            exposure: shutter.exposure_s / step_s,
        };
        let camera = &shot.view.camera;
        // Shares of a step ago, at the most.
        let longest = timing.delay * (camera.height() - 1) as f32 + timing.exposure;
        let is_exposed = has_color && timing.exposure > 0.0;
        let exposures = if is_exposed { usize::from(EXPOSED) } else { 0 };
        Self {
            moments: PastStates::new(world, longest),
            exposed: vec![vec![0; camera.pixels() * 3]; exposures],
            shot,
            timing,
        }
    }

    /// The camera that takes it, as laws make it.
    pub(crate) fn camera(&self) -> Camera {
        self.shot.view.camera
    }

    /// Appends the work for a renderer. `world`: that of [`Self::new`], unchanged.
    pub(crate) fn jobs<'a>(
        &'a mut self,
        world: &'a World,
        frame: FrameMut<'a>,
        jobs: &mut Vec<RenderJob<'a>>,
    ) {
        let Self {
            shot,
            timing,
            moments,
            exposed,
        } = self;
        for part in exposure_rows(&shot.view.camera, *timing, exposed, frame) {
            let (state, scene) = moments.at(world, part.share);
            let mut view = shot.view;
            if part.rows.is_some() || part.share > 0.0 {
                view.world_from_camera =
                    interpolate_back(&view.world_from_camera, &shot.previous_pose, part.share);
            }
            jobs.push(RenderJob {
                before: world.previous_frame(shot.previous_pose),
                rows: part.rows,
                ..RenderJob::new(scene, state, view, part.frame)
            });
        }
    }

    /// Appends the destinations of the images of [`Self::jobs`], in their order.
    pub(crate) fn frames<'a>(&'a mut self, frame: FrameMut<'a>, frames: &mut Vec<FrameMut<'a>>) {
        let Self {
            shot,
            timing,
            exposed,
            ..
        } = self;
        let parts = exposure_rows(&shot.view.camera, *timing, exposed, frame);
        frames.extend(parts.into_iter().map(|part| part.frame));
    }

    /// Drops the data that only [`Self::jobs`] needs.
    pub(crate) fn drop_render_states(&mut self) {
        self.moments.copies = Vec::new();
    }

    /// Returns whether [`Self::average_exposures`] has something to do.
    pub(crate) fn has_multiple_exposures(&self) -> bool {
        !self.exposed.is_empty()
    }

    /// Makes the picture's colours from those of its moments.
    pub(crate) fn average_exposures(&self, frame: &mut Frame) {
        if self.has_multiple_exposures() {
            mean_color(self.exposed.iter().map(Vec::as_slice), &mut frame.rgb);
        }
    }
}

/// The parts of a picture: all images at the end of the exposure, then colours at each of its moments.
fn exposure_rows<'a>(
    camera: &Camera,
    timing: RowTiming,
    exposed: &'a mut [Vec<u8>],
    mut frame: FrameMut<'a>,
) -> Vec<SimultaneousRows<'a>> {
    let mut parts = Vec::new();
    if !exposed.is_empty() {
        frame.rgb = None;
    }
    rolling_rows(camera, timing.delay, 0.0, frame, &mut parts);
    for (k, rgb) in exposed.iter_mut().enumerate() {
        let share = (k as f32 + 0.5) / f32::from(EXPOSED);
        let frame = FrameMut {
            rgb: Some(rgb),
            ..FrameMut::default()
        };
        rolling_rows(
            camera,
            timing.delay,
            share * timing.exposure,
            frame,
            &mut parts,
        );
    }
    parts
}

/// All rows, `earlier` steps of the world before their time; those of one moment together.
fn rolling_rows<'a>(
    camera: &Camera,
    delay: f32,
    earlier: f32,
    mut frame: FrameMut<'a>,
    parts: &mut Vec<SimultaneousRows<'a>>,
) {
    if delay == 0.0 {
        parts.push(SimultaneousRows {
            share: earlier,
            rows: None,
            frame,
        });
        return;
    }
    let height = camera.height();
    parts.extend((0..height).map(|row| SimultaneousRows {
        share: earlier + delay * (height - 1 - row) as f32,
        rows: Some((row, row + 1)),
        frame: frame.split_off_pixels(camera.width() as usize),
    }));
}

/// The world at moments of the step that has been made.
#[derive(Debug)]
struct PastStates {
    /// Even steps back from now; only now where nothing moves.
    copies: Vec<(State, RayScene)>,
    /// Age of the last one, in steps of the world.
    longest: f32,
}

impl PastStates {
    fn new(world: &World, longest: f32) -> Self {
        let still = longest <= 0.0 || world.motion_history().is_scene_still(world.state());
        let copies = (1..MOMENTS).map(|k| {
            let share = longest * k as f32 / (MOMENTS - 1) as f32;
            let (mut state, mut scene) = (world.state().clone(), world.rays().clone());
            world.motion_history().rewind(&mut state, share);
            scene.update(&state);
            (state, scene)
        });
        Self {
            copies: if still { Vec::new() } else { copies.collect() },
            longest,
        }
    }

    /// The moment nearest to a share of a step ago.
    fn at<'a>(&'a self, world: &'a World, share: f32) -> (&'a State, &'a RayScene) {
        let place = (share / self.longest * (MOMENTS - 1) as f32).round();
        let copy = (place as usize).checked_sub(1);
        copy.and_then(|copy| self.copies.get(copy))
            .map_or((world.state(), world.rays()), |(state, scene)| {
                (state, scene)
            })
    }
}
