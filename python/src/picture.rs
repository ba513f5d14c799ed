//! One picture of a world, as Python asks for it.

use crate::errors::Fault;
use dwell::World;
use dwell_render::{Camera, Channels, Frame, Preset, View};
use dwell_scene::parallel::Threads;
use dwell_scene::space::{rotation_from_forward, rotation_from_yaw_pitch};
use dwell_scene::{AgentId, EntityId, Pose};
use glam::Vec3;
use serde::Deserialize;

/// A picture that is asked for.
#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct ViewSettings {
    width: u32,
    height: u32,
    fov_deg: Option<f32>,
    near_m: f32,
    far_m: f32,
    preset: Preset,
    agent: Option<u32>,
    position: [f32; 3],
    yaw_deg: f32,
    pitch_deg: f32,
    forward: Option<[f32; 3]>,
}

impl Default for ViewSettings {
    fn default() -> Self {
        Self {
            width: 128,
            height: 128,
            fov_deg: None,
            near_m: 0.05,
            far_m: 50.0,
            preset: Preset::Lit,
            agent: None,
            position: [0.0; 3],
            yaw_deg: 0.0,
            pitch_deg: 0.0,
            forward: None,
        }
    }
}

/// The images of a picture; those that nobody asked for are empty.
pub(crate) struct Picture {
    pub(crate) height: usize,
    pub(crate) width: usize,
    pub(crate) frame: Frame,
}

/// Renders the view that `view_json` describes.
pub(crate) fn render(
    world: &World,
    view_json: &str,
    channels: &[String],
) -> Result<Picture, Fault> {
    let known = ["rgb", "depth", "instance", "semantic"];
    if let Some(other) = channels
        .iter()
        .find(|channel| !known.contains(&channel.as_str()))
    {
        return Err(Fault::Config(format!(
            "no image {other:?}; there are {known:?}"
        )));
    }
    let wanted = |channel: &str| channels.iter().any(|other| other == channel);
    let settings: ViewSettings = serde_json::from_str(view_json)?;
    let (world_from_camera, hide) = eye(world, &settings)?;
    let own = settings
        .agent
        .map(|agent| world.state().camera_fov_deg(AgentId(agent)));
    // Away from an agent's eyes a camera has the right angle that they have where nothing else is said.
    let fov_deg = settings.fov_deg.or(own).unwrap_or(90.0);
    let camera = Camera::from_fov(settings.width, settings.height, fov_deg)?;
    let camera = camera.with_range(settings.near_m, settings.far_m)?;
    let view = View {
        preset: settings.preset,
        hide,
        ..View::new(camera, world_from_camera)
    };
    let channels = Channels {
        rgb: wanted("rgb"),
        depth: wanted("depth"),
        instance: wanted("instance"),
        semantic: wanted("semantic"),
    };
    let mut frame = Frame::new(&camera, channels);
    let renderer = world.engines().renderer();
    renderer.render(
        world.rays(),
        world.state(),
        &[view],
        &mut [frame.as_mut()],
        Threads::requested(None)?,
    )?;
    Ok(Picture {
        height: settings.height as usize,
        width: settings.width as usize,
        frame,
    })
}

/// Where the camera stands, and whose body it does not see.
fn eye(world: &World, settings: &ViewSettings) -> Result<(Pose, Option<EntityId>), Fault> {
    if let Some(number) = settings.agent {
        let agents = &world.state().agents;
        let Some(agent) = agents.get(AgentId(number)) else {
            return Err(Fault::Usage(format!(
                "no agent {number}; there are {}",
                agents.len()
            )));
        };
        return Ok((
            agent.world_from_eye(),
            Some(world.house().entity_of_agent(AgentId(number))),
        ));
    }
    let rotation = match settings.forward {
        Some(forward) => rotation_from_forward(Vec3::from_array(forward)).ok_or_else(|| {
            Fault::Config(format!(
                "forward is {forward:?}; allowed is a direction that is not zero"
            ))
        })?,
        None => rotation_from_yaw_pitch(
            settings.yaw_deg.to_radians(),
            settings.pitch_deg.to_radians(),
        ),
    };
    let pose = Pose::new(Vec3::from_array(settings.position), rotation);
    if pose.is_valid() {
        Ok((pose, None))
    } else {
        Err(Fault::Config(
            "position and angles must be finite".to_owned(),
        ))
    }
}
