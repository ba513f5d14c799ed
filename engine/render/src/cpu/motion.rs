//! Optical flow: previous positions of the points of an image.

use super::CpuRenderer;
use super::camera_rays::PrimaryHit;
use crate::camera::{Camera, Projection};
use crate::frame::PreviousPoses;
use dwell_scene::rays::RayScene;
use dwell_scene::{Id, State};
use glam::{Vec2, Vec3};

/// Returns the motion in the image of a point that is seen at `image`, pixels; it was at `was` in the world.
pub(super) fn point_flow(
    camera: &Camera,
    before: &PreviousPoses<'_>,
    image: (f32, f32),
    was: Vec3,
) -> [f32; 2] {
    let eye = &before.world_from_camera;
    image_flow(camera, image, eye.rotation.inverse() * (was - eye.position))
}

/// As [`point_flow`] for a direction that is infinitely far away.
pub(super) fn direction_flow(
    camera: &Camera,
    before: &PreviousPoses<'_>,
    image: (f32, f32),
    direction: Vec3,
) -> [f32; 2] {
    if matches!(camera.projection(), Projection::Orthographic { .. }) {
        return [0.0; 2];
    }
    let rotation = before.world_from_camera.rotation;
    image_flow(camera, image, rotation.inverse() * direction)
}

fn image_flow(camera: &Camera, (x, y): (f32, f32), was_in_camera: Vec3) -> [f32; 2] {
    let Some((was, _)) = camera.project(was_in_camera) else {
        return [0.0; 2];
    };
    let mut flow = Vec2::new(x, y) - was;
    let (width, face) = (camera.width() as f32, camera.width() as f32);
    match camera.projection() {
        // The image closes behind the camera.
        Projection::Equirectangular {} => flow.x -= (flow.x / width).round() * width,
        // Faces are pictures of their own.
        Projection::Cubemap {} if (y / face).floor() != (was.y / face).floor() => {
            return [0.0; 2];
        }
        _ => {}
    }
    if flow.is_finite() {
        flow.to_array()
    } else {
        [0.0; 2]
    }
}

impl CpuRenderer {
    /// Returns the previous position in the world of the point that is seen.
    pub(super) fn previous_position(
        &self,
        sight: &PrimaryHit,
        (scene, state): (&RayScene, &State),
        before: &PreviousPoses<'_>,
    ) -> Vec3 {
        let Some(instance) = sight.instance else {
            return sight.point;
        };
        if let Some((agent, piece)) = self.triangle_table.agent_of(instance) {
            if let Some(now) = scene.person_piece(instance) {
                let in_piece = now.pose.inverse().transform_point(sight.point);
                let was = before.person_piece(agent, piece).unwrap_or(now.pose);
                return was.transform_point(in_piece);
            }
            let was = before.agents.get(agent);
            let now = state
                .agents
                .as_slice()
                .get(agent)
                .map(|agent| agent.position);
            return match (was, now) {
                (Some(was), Some(now)) => sight.point - now + *was,
                _ => sight.point,
            };
        }
        let Some(part) = self.triangle_table.part_of(instance) else {
            return sight.point;
        };
        let Ok(place) = before
            .moved_parts
            .binary_search_by_key(&part.index(), |(part, _)| part.index())
        else {
            return sight.point;
        };
        let now = &state.part_pose[part];
        let in_part = now.rotation.inverse() * (sight.point - now.position);
        before.moved_parts[place].1.transform_point(in_part)
    }
}
