//! The rays of a view, sixteen pixels at a time.

use crate::camera::Projection;
use crate::frame::View;
use dwell_scene::EntityId;
use dwell_scene::bvh::{Hit, Ray, RayMask};
use dwell_scene::rays::{FAN, RayScene};
use glam::{Vec2, Vec3};

/// Pixels along the edge of a packet.
pub(super) const EDGE: usize = 4;

/// A view, prepared. Rays run per metre of depth: the point at depth d is `start + d * direction`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rays {
    view: View,
    right: Vec3,
    up: Vec3,
    back: Vec3,
    hidden: EntityId,
    /// See [`crate::camera::Camera::pixel_area`].
    pub(super) pixel_area: (f32, f32),
}

/// The rays of 4 by 4 pixels, and what they met.
pub(super) struct Packet {
    start: [Vec3; FAN],
    direction: [Vec3; FAN],
    pub(super) hits: [Option<Hit>; FAN],
}

impl Packet {
    /// The point at depth 0 and the way per metre of depth.
    #[inline]
    pub(super) fn ray(&self, lane: usize) -> (Vec3, Vec3) {
        (self.start[lane], self.direction[lane])
    }
}

impl Rays {
    pub(super) fn new(view: &View) -> Self {
        let rotation = view.world_from_camera.rotation.normalize();
        Self {
            view: *view,
            right: rotation * Vec3::X,
            up: rotation * Vec3::Y,
            back: rotation * Vec3::Z,
            // What nothing has as its id hides nothing.
            hidden: view.hide.unwrap_or(EntityId::VOID),
            pixel_area: view.camera.pixel_area(),
        }
    }

    /// The ray through the middle of a pixel.
    #[inline]
    fn through(&self, x: usize, y: usize) -> (Vec3, Vec3) {
        let image = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
        let (start, direction) = self.view.camera.ray_in_camera(image);
        let eye = self.view.world_from_camera.position;
        let turned = |v: Vec3| self.right * v.x + self.up * v.y + self.back * v.z;
        match self.view.camera.projection() {
            Projection::Pinhole { .. } => (eye, turned(direction)),
            Projection::Orthographic { .. } => (eye + turned(start), -self.back),
        }
    }

    /// What the pixels from (`x`, `y`) on see. Distances of hits are depths.
    #[inline]
    pub(super) fn packet(&self, scene: &RayScene, x: usize, y: usize) -> Packet {
        let rays: [(Vec3, Vec3); FAN] =
            std::array::from_fn(|k| self.through(x + k % EDGE, y + k / EDGE));
        let near_m = self.view.camera.near_m();
        Packet {
            start: rays.map(|ray| ray.0),
            direction: rays.map(|ray| ray.1),
            hits: rays.map(|ray| self.closest(scene, ray, near_m)),
        }
    }

    /// The nearest surface from a depth on.
    pub(super) fn closest(
        &self,
        scene: &RayScene,
        (start, direction): (Vec3, Vec3),
        near_m: f32,
    ) -> Option<Hit> {
        // Lengths along a ray of unit direction, and back.
        let length = direction.length();
        let ray = Ray {
            origin: start,
            direction: direction / length,
            near_m: near_m * length,
            far_m: self.view.camera.far_m() * length,
        };
        let hit = scene.closest_without(&ray, RayMask::EYE, self.hidden)?;
        Some(Hit {
            distance_m: hit.distance_m / length,
            ..hit
        })
    }
}
