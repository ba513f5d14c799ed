//! Time: worlds, agents, sensors, tasks and batches over a shared house; joins the engines.
//!
//! A [`World`] is stepped at the control rate. An [`Env`] adds a task and sensors; a [`Batch`] steps several and renders
//! all their views in one submission.

mod action;
mod asking;
mod batch;
mod batch_pictures;
pub mod bench;
mod config;
mod engines;
mod env;
mod error;
mod expert;
mod exposure;
mod fixtures;
mod floor_plan;
mod heap;
mod info;
pub mod laws;
pub mod memory;
pub mod metrics;
mod moment;
mod now;
mod past;
mod pictures;
mod recordings;
mod request;
mod requests;
mod saving;
pub mod sensors;
mod settings;
mod sound;
mod start;
mod surfaces;
pub mod tasks;
mod world;

pub use action::{DiscreteAction, Stride};
pub use batch::Batch;
pub use config::WorldConfig;
pub use engines::Engines;
pub use env::{Env, EnvConfig, Episode, SensorConfig, StepInfo, Verdict};
pub use error::WorldError;
pub use expert::{Guide, face};
pub use fixtures::{Fixtures, JointNow, Lamp, ObjectBox, SoundSource, fixtures};
pub use floor_plan::{FloorPlan, PlanDoor, PlanRoom, floor_plan};
pub use info::{Viewpoint, info, viewpoints};
pub use now::{ObjectNow, agents_now, object_now, objects_now};
pub use past::Past;
pub use pictures::{PictureRequest, Place};
pub use request::{ActionRequest, Named, PixelCamera};
pub use requests::{Picture, Requests, Results, ViewRequest};
pub use settings::plain_json_error;
pub use sound::{PlayRequest, SoundName, SoundNow, SoundPlace, usual_level_db};
pub use surfaces::{RoomSurface, room_surfaces};
pub use world::World;

/// Where a camera is against the eyes that carry it: position in m, then yaw, pitch and roll in degrees.
pub fn camera_mount(position_m: [f32; 3], angles_deg: [f32; 3]) -> dwell_scene::Pose {
    sensors::mount(position_m, angles_deg)
}
