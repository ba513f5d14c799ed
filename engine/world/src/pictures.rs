//! Pictures of worlds: the views that sensors and callers ask for, taken as the laws of the cameras say.

use crate::error::WorldError;
use crate::past::between;
use crate::world::World;
use dwell_render::laws::mean_color;
use dwell_render::{Before, Camera, Channels, Frame, FrameMut, Job, Optics, Preset, View};
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentId, AgentState, EntityId, Pose, State};

/// Moments from which the light of an exposure is averaged.
const EXPOSED: u16 = 16;
/// Moments between which things stand still while a shutter rolls; the camera moves from row to row.
const MOMENTS: usize = 16;

/// A picture that is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureRequest {
    /// The camera as it should be; laws of the agent's cameras make it what it is.
    pub camera: Camera,
    /// From where.
    pub place: Place,
    /// How much light there is.
    pub preset: Preset,
}

/// Where a camera stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// On an agent, against its eyes: it moves along, does not see the body that carries it, and obeys the laws of its cameras.
    Agent(AgentId, Pose),
    /// Anywhere in the world, at rest and without laws.
    World(Pose),
}

/// A view with what its camera did before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shot {
    pub(crate) view: View,
    /// Where the camera was a control step ago.
    was: Pose,
}

impl World {
    /// The laws of the cameras of a place.
    pub(crate) fn optics(&self, place: &Place) -> Optics<'_> {
        match place {
            Place::Agent(agent, _) => Optics::of(&self.state().laws, *agent),
            Place::World(_) => Optics::ideal(),
        }
    }

    pub(crate) fn shot(&self, request: &PictureRequest) -> Shot {
        let state = self.state();
        let camera = self.optics(&request.place).camera(request.camera);
        let (is, was, hide): (Pose, Pose, Option<EntityId>) = match request.place {
            Place::World(pose) => (pose, pose, None),
            Place::Agent(agent, eye_from_camera) => {
                let is = state.agents.get(agent).map(AgentState::world_from_eye);
                let is = is.unwrap_or_default();
                let was = self.past().eye(agent, state).unwrap_or(is);
                let hide = self.house().entity_of_agent(agent);
                (is * eye_from_camera, was * eye_from_camera, Some(hide))
            }
        };
        let view = View {
            preset: request.preset,
            hide,
            ..View::new(camera, is)
        };
        Shot { view, was }
    }

    /// One picture, without the noise that laws add to it, and the camera that took it, as laws make it.
    ///
    /// # Errors
    /// [`WorldError::Render`] for a pose that is not finite.
    pub fn picture(
        &self,
        request: &PictureRequest,
        mut channels: Channels,
        threads: Threads,
    ) -> Result<(Camera, Frame), WorldError> {
        let optics = self.optics(&request.place);
        let shot = self.shot(request);
        channels.normals |= channels.depth && optics.needs_normals();
        let mut frame = Frame::new(&shot.view.camera, channels);
        if optics.shutter().is_still() {
            let mut job = [self.job(&shot, frame.as_mut())];
            let renderer = self.engines().pictures(&self.config().renderer)?;
            renderer.render_batch(&mut job, threads)?;
        } else {
            self.expose(&shot, &optics, &mut frame, threads)?;
        }
        Ok((shot.view.camera, frame))
    }

    /// The work of a picture without a shutter.
    pub(crate) fn job<'a>(&'a self, shot: &Shot, frame: FrameMut<'a>) -> Job<'a> {
        Job {
            before: self.before(shot.was),
            ..Job::new(self.rays(), self.state(), shot.view, frame)
        }
    }

    /// Nothing where nothing has been before.
    fn before(&self, world_from_camera: Pose) -> Option<Before<'_>> {
        let past = self.past();
        past.known.then_some(Before {
            world_from_camera,
            moved: &past.moved,
            agents: &past.feet,
        })
    }

    /// Takes a picture row by row, and its colours over the time of their exposure.
    pub(crate) fn expose(
        &self,
        shot: &Shot,
        optics: &Optics<'_>,
        frame: &mut Frame,
        threads: Threads,
    ) -> Result<(), WorldError> {
        let shutter = optics.shutter();
        let step_s = self.config().step_s() as f32;
        let rows = shot.view.camera.height();
        let delay = shutter.line_s / step_s;
        let exposure = shutter.exposure_s / step_s;
        // Shares of a step ago, at the most.
        let longest = delay * (rows - 1) as f32 + exposure;
        let moments = Moments::new(self, longest);
        let mut rgb = std::mem::take(&mut frame.rgb);
        let rolled = |frame: &mut Frame, earlier: f32| {
            moments.render(self, shot, frame, (delay, earlier), threads)
        };
        // The rest, and colours without exposure, at the end of it.
        if exposure == 0.0 {
            frame.rgb = rgb;
            return rolled(frame, 0.0);
        }
        rolled(frame, 0.0)?;
        if !rgb.is_empty() {
            let mut exposed = Vec::with_capacity(usize::from(EXPOSED));
            for k in 0..EXPOSED {
                let mut one = Frame {
                    rgb: vec![0; rgb.len()],
                    ..Frame::default()
                };
                let share = (f32::from(k) + 0.5) / f32::from(EXPOSED);
                rolled(&mut one, share * exposure)?;
                exposed.push(one.rgb);
            }
            mean_color(exposed.iter().map(Vec::as_slice), &mut rgb);
        }
        frame.rgb = rgb;
        Ok(())
    }
}

/// The world at moments of the step that has been made.
struct Moments {
    /// Even steps back from now; only now where nothing moves.
    copies: Vec<(State, RayScene)>,
    /// How far back the last one lies, in steps of the world.
    longest: f32,
}

impl Moments {
    fn new(world: &World, longest: f32) -> Self {
        let still = world.past().is_still(world.state()) || longest <= 0.0;
        let copies = (1..MOMENTS).map(|k| {
            let share = longest * k as f32 / (MOMENTS - 1) as f32;
            let (mut state, mut scene) = (world.state().clone(), world.rays().clone());
            world.past().rewind(&mut state, share);
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

    /// Takes all rows `earlier` shares of a step before their time.
    fn render(
        &self,
        world: &World,
        shot: &Shot,
        frame: &mut Frame,
        (delay, earlier): (f32, f32),
        threads: Threads,
    ) -> Result<(), WorldError> {
        let rows = shot.view.camera.height();
        let (is, was) = (shot.view.world_from_camera, shot.was);
        // Rows of one moment are taken together.
        let step = if delay == 0.0 { rows } else { 1 };
        let mut rest = frame.as_mut();
        let mut jobs = Vec::new();
        for first in (0..rows).step_by(step as usize) {
            let end = (first + step).min(rows);
            let share = earlier + delay * (rows - end) as f32;
            let (state, scene) = self.at(world, share);
            let view = View {
                world_from_camera: between(&is, &was, share),
                ..shot.view
            };
            let pixels = ((end - first) * shot.view.camera.width()) as usize;
            jobs.push(Job {
                before: world.before(was),
                rows: Some((first, end)),
                ..Job::new(scene, state, view, rest.take_pixels(pixels))
            });
        }
        let renderer = world.engines().pictures(&world.config().renderer)?;
        renderer.render_batch(&mut jobs, threads)?;
        Ok(())
    }
}
