//! Time: worlds, agents, sensors, tasks and batches over a shared house; joins the engines.
//!
//! A [`World`] is stepped at the control rate. An [`Env`] adds tasks and sensors of the agents that act in it; a [`Batch`] steps
//! several and renders all their views in one submission.

pub mod actions;
mod air_position;
mod batch;
mod batch_pictures;
pub mod bench;
mod camera_capture;
mod config;
mod current_objects;
mod engines;
mod env;
mod env_agent;
mod env_config;
mod env_observation;
mod env_snapshot;
mod env_step;
mod episode;
mod episode_spec;
mod error;
mod expert;
mod external_task;
mod eye_camera;
mod first_use;
mod fixtures;
mod floor_plan;
mod free_memory;
mod info;
mod initial_state;
pub mod laws;
mod listener;
mod map_pictures;
pub mod memory_estimate;
pub mod metrics;
mod motion_history;
mod named_values;
mod parse_settings;
mod persons;
mod plain_json_error;
mod recordings;
mod release_memory;
mod room_surfaces;
pub mod schema;
mod sensor_requests;
pub mod sensors;
mod sighted_cells;
mod sound;
pub mod tasks;
mod texture_memory;
mod world;
mod world_snapshot;
mod world_sounds;

pub use actions::{
    ActionMode, ActionTarget, AgentAction, DiscreteAction, HandActionRequest, HandTarget,
    ObjectRef, PixelCamera, StepAction, StepSizes, StepUtterance,
};
pub use batch::Batch;
pub use camera_capture::{CameraMount, ImageRequest};
pub use config::WorldConfig;
pub use current_objects::{ObjectState, effective_agents, object_state, object_states};
pub use dwell_acoustics::utterance::{MAX_TOKENS, VocalEffort};
pub use engines::Engines;
pub use env::Env;
pub use env_config::{AgentConfig, EnvConfig, SensorConfig};
pub use episode::{
    Answer, AnswerField, Episode, EpisodeGoal, GoalField, MAX_ANSWER_FIELDS, MAX_QUESTION_TOKENS,
    QuestionTokens, StepInfo, StepResult, TaskMeasure,
};
pub use episode_spec::{EpisodeSpec, StatedGoal, StatedStart};
pub use error::WorldError;
pub use expert::{ShortestPathFollower, action_towards_object};
pub use fixtures::{
    JointOverlay, LampFixture, ObjectBox, SceneOverlay, SoundSource, scene_overlay,
};
pub use floor_plan::{FloorPlanLabels, PlanDoor, PlanRoom, floor_plan};
pub use info::{RoomViewpoint, best_room_viewpoints, house_info};
pub use listener::{Listener, MountedReceiver};
pub use map_pictures::{dollhouse_picture, map_picture};
pub use motion_history::LastStepMotion;
pub use parse_settings::parse_config;
pub use plain_json_error::plain_json_error;
pub use room_surfaces::{RoomMaterialMesh, room_surfaces};
pub use sensor_requests::{RenderedImages, RenderedView, SensorRequests, ViewRequest};
pub use sound::{
    HeardToken, PlayRequest, SoundName, SoundPlace, SoundState, Utterance, default_level_db,
};
pub use world::World;

/// Returns the pose of a camera relative to the eyes that carry it: position in m, then yaw, pitch and roll in degrees.
pub fn camera_mount(position_m: [f32; 3], angles_deg: [f32; 3]) -> dwell_scene::Pose {
    sensors::mount(position_m, angles_deg)
}
