//! The views that golden pictures show: of built-in houses alone.

use crate::apartment;
use dwell::sensors::{ImageObservationOptions, Observation};
use dwell::{CameraMount, Engines, ImageRequest, World, WorldConfig, WorldError};
use dwell_render::{Camera, ClassSet, Preset, Projection, RenderError};
use dwell_scene::parallel::Threads;
use dwell_scene::space::rotation_from_yaw_pitch;
use dwell_scene::{AgentBody, AgentId, Pose};
use glam::Vec3;
use std::sync::Arc;

/// Nothing in the views is further away, m; steps of depth in files are a fifth of a millimetre.
pub const FAR_M: f64 = 13.0;

/// A place to look from: its name, the house, the eye in m, yaw and pitch in degrees.
pub type GoldenView = (&'static str, &'static str, [f32; 3], [f32; 2]);

/// A room of each built-in house.
pub const ROOMS: [GoldenView; 4] = [
    (
        "living_room",
        "builtin:apartment",
        [7.52, 1.25, 4.42],
        [180.0, -8.0],
    ),
    (
        "studio",
        "builtin:studio",
        [2.22, 1.25, 0.92],
        [180.0, -8.0],
    ),
    ("house", "builtin:house", [3.12, 1.25, 0.52], [157.5, -8.0]),
    ("lobby", "builtin:office", [2.92, 1.26, 5.62], [22.5, -8.0]),
];

/// The camera of pictures that are not about cameras.
///
/// # Errors
/// Never: the numbers are in range.
pub fn plain_camera(width: u32, height: u32) -> Result<Camera, RenderError> {
    Camera::from_fov(width, height, 90.0)?.with_range(0.05, FAR_M as f32)
}

/// Every kind of camera, small; a new one is one entry.
///
/// # Errors
/// Never: the numbers are in range.
pub fn cameras() -> Result<Vec<(&'static str, Camera)>, RenderError> {
    let (fx, fy, cx, cy) = (58.0, 60.0, 44.0, 39.0);
    let lens = Projection::BrownConrady {
        fx,
        fy,
        cx,
        cy,
        k1: -0.22,
        k2: 0.05,
        k3: -0.004,
        p1: 0.004,
        p2: -0.003,
    };
    let fisheye = |[k1, k2, k3, k4]: [f32; 4], half_angle_deg| Projection::Fisheye {
        fx: 22.0,
        fy: 22.0,
        cx: 36.0,
        cy: 36.0,
        k1,
        k2,
        k3,
        k4,
        half_angle_deg,
    };
    let all = [
        (
            "pinhole",
            Camera::new(96, 72, Projection::Pinhole { fx, fy, cx, cy })?,
        ),
        ("brown_conrady", Camera::new(96, 72, lens)?),
        (
            "fisheye_equidistant",
            Camera::new(72, 72, fisheye([0.0; 4], 90.0))?,
        ),
        (
            "fisheye_kannala_brandt",
            Camera::new(72, 72, fisheye([0.03, -0.004, 0.0008, -0.0001], 80.0))?,
        ),
        ("equirectangular", Camera::equirectangular(112)?),
        ("cubemap", Camera::cubemap(32)?),
        ("orthographic", Camera::orthographic(96, 72, 4.0, 3.0)?),
    ];
    all.into_iter()
        .map(|(name, camera)| Ok((name, camera.with_range(0.05, FAR_M as f32)?)))
        .collect()
}

/// A world over a house, without agents.
///
/// # Panics
/// When the built-in house does not open.
pub fn world(house: &str) -> World {
    let engines = if house == "builtin:apartment" {
        apartment()
    } else {
        let (house, _) = dwell_houses::open(house).expect("the built-in house opens");
        Engines::new(Arc::new(house))
    };
    world_over(engines)
}

/// A world without agents over any house.
///
/// # Panics
/// When the house cannot be started.
pub fn world_over(engines: Arc<Engines>) -> World {
    let config = WorldConfig {
        agents: Vec::new(),
        ..WorldConfig::default()
    };
    World::new(engines, &config).expect("a house without agents starts")
}

/// The apartment's living room with two agents: the eyes of the first, and the second in front of them.
///
/// # Panics
/// When the agents do not fit.
pub fn world_of_two_agents() -> World {
    let config = WorldConfig {
        agents: vec![AgentBody::default(); 2],
        ..WorldConfig::default()
    };
    let mut world = World::new(apartment(), &config).expect("two agents fit");
    let yaw_rad = std::f32::consts::PI;
    for (agent, x, z) in [(0, 7.52, 4.42), (1, 8.1, 5.9)] {
        world
            .place_agent(AgentId(agent), Vec3::new(x, 0.0, z), yaw_rad)
            .expect("there are two agents");
    }
    world
}

/// Returns what a sensor gives at a viewpoint.
///
/// # Errors
/// [`WorldError`] for a sensor that there is not.
pub fn look(
    world: &World,
    (_, _, eye, [yaw_deg, pitch_deg]): GoldenView,
    camera: Camera,
    preset: Preset,
    sensors: &[&str],
) -> Result<Vec<Observation>, WorldError> {
    let rotation = rotation_from_yaw_pitch(yaw_deg.to_radians(), pitch_deg.to_radians());
    let place = CameraMount::World(Pose::new(Vec3::from_array(eye), rotation));
    observe_request(
        world,
        ImageRequest {
            camera,
            mount: place,
            preset,
        },
        sensors,
        ClassSet::Coarse,
    )
}

/// Returns what sensors give for a picture. `classes`: those of `semantic`.
///
/// # Errors
/// [`WorldError`] for a sensor that there is not.
pub fn observe_request(
    world: &World,
    request: ImageRequest,
    sensors: &[&str],
    classes: ClassSet,
) -> Result<Vec<Observation>, WorldError> {
    let names: Vec<String> = sensors.iter().map(|name| (*name).to_owned()).collect();
    let settings = ImageObservationOptions {
        max_objects: 16,
        classes,
    };
    world.image_observations(&request, &names, settings, Threads::ONE)
}
