//! Pictures of worlds: the views that sensors and callers request, taken as the laws of the cameras say.

mod shutter;

pub(crate) use shutter::OngoingExposure;

use crate::error::WorldError;
use crate::world::World;
use dwell_render::{Camera, CameraLaws, Frame, ImageChannels, Preset, PreviousPoses, View};
use dwell_scene::parallel::Threads;
use dwell_scene::{AgentId, AgentState, EntityId, Pose};

/// A requested picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageRequest {
    /// The ideal camera; laws of the agent's cameras turn it into the real one.
    pub camera: Camera,
    /// The camera's mount.
    pub mount: CameraMount,
    /// The amount of light transport.
    pub preset: Preset,
}

/// The mount of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CameraMount {
    /// On an agent, relative to its eyes: it moves along, does not see the body that carries it, and obeys the laws of its cameras.
    Agent(AgentId, Pose),
    /// Anywhere in the world, at rest and without laws.
    World(Pose),
    /// As [`Self::World`], without the body of an agent in the picture.
    WorldWithout(AgentId, Pose),
}

/// A view with its camera's previous pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ViewMotion {
    pub(crate) view: View,
    /// The camera's pose a control step ago.
    pub(crate) previous_pose: Pose,
}

impl World {
    /// The laws of a mount's cameras.
    pub(crate) fn optics(&self, place: &CameraMount) -> CameraLaws<'_> {
        match place {
            CameraMount::Agent(agent, _) => CameraLaws::of(&self.state().laws, *agent),
            CameraMount::World(_) | CameraMount::WorldWithout(..) => CameraLaws::ideal(),
        }
    }

    pub(crate) fn moving_view(&self, request: &ImageRequest) -> ViewMotion {
        let state = self.state();
        let camera = self.optics(&request.mount).apply_to_camera(request.camera);
        let (is, was, hide): (Pose, Pose, Option<EntityId>) = match request.mount {
            CameraMount::World(pose) => (pose, pose, None),
            CameraMount::WorldWithout(agent, pose) => {
                (pose, pose, Some(self.house().entity_of_agent(agent)))
            }
            CameraMount::Agent(agent, eye_from_camera) => {
                let is = state.agents.get(agent).map(AgentState::world_from_eye);
                let is = is.unwrap_or_default();
                let was = self
                    .motion_history()
                    .previous_eye_pose(agent, state)
                    .unwrap_or(is);
                let hide = self.house().entity_of_agent(agent);
                (is * eye_from_camera, was * eye_from_camera, Some(hide))
            }
        };
        let view = View {
            preset: request.preset,
            hidden_entity: hide,
            ..View::new(camera, is)
        };
        ViewMotion {
            view,
            previous_pose: was,
        }
    }

    /// One picture, without the noise that laws add to it, and the camera that took it, as laws make it.
    ///
    /// # Errors
    /// [`WorldError::Render`] for a pose that is not finite.
    pub fn render_image(
        &self,
        request: &ImageRequest,
        mut channels: ImageChannels,
        threads: Threads,
    ) -> Result<(Camera, Frame), WorldError> {
        channels.normals |= channels.depth && self.optics(&request.mount).needs_normals();
        let mut take = OngoingExposure::new(self, request, channels.rgb);
        let mut frame = Frame::new(&take.camera(), channels);
        let mut jobs = Vec::new();
        take.jobs(self, frame.as_mut(), &mut jobs);
        let renderer = self.engines().image_renderer(&self.config().renderer)?;
        renderer.render_batch(&mut jobs, threads)?;
        drop(jobs);
        take.average_exposures(&mut frame);
        Ok((take.camera(), frame))
    }

    /// Returns the previous frame; `None` in the first step.
    pub(crate) fn previous_frame(&self, world_from_camera: Pose) -> Option<PreviousPoses<'_>> {
        let past = self.motion_history();
        past.has_step.then_some(PreviousPoses {
            world_from_camera,
            moved_parts: &past.previous_part_poses,
            agents: &past.previous_feet,
            persons: &past.previous_persons,
        })
    }
}
