//! The rays of a view, a packet of pixels at a time.

use super::path_tracer::SAMPLES_PER_PIXEL;
use crate::camera::{Camera, Projection};
use crate::frame::{Preset, View};
use dwell_scene::EntityId;
use dwell_scene::bvh::{Hit, PacketHits, Ray, RayMask, RayPacket, SceneBvh};
use glam::{Vec2, Vec3};

/// Pixels across a packet.
pub(super) const PACKET_COLUMNS: usize = 8;
/// Pixels down a packet.
pub(super) const PACKET_ROWS: usize = 4;
/// The surfaces that cameras see.
pub(crate) const VISIBLE_MASK: RayMask = RayMask::EYE.union(RayMask::BODY);
/// Rays of a packet.
pub(super) const LANES: usize = PACKET_COLUMNS * PACKET_ROWS;

/// A view, prepared.
#[derive(Clone, Copy, Debug)]
pub(super) struct CameraRayGenerator {
    view: View,
    right: Vec3,
    up: Vec3,
    back: Vec3,
    hidden: EntityId,
    /// See [`crate::camera::Camera::pixel_area`]; of one ray where a pixel has several.
    pub(super) pixel_area: (f32, f32),
}

/// The rays of some pixels with their hits. Lane k is column k % 8 and row k / 8.
pub(super) struct CameraRayPacket {
    rays: RayPacket<LANES>,
    /// Depth per length along the ray.
    per_length: [f32; LANES],
    hits: PacketHits<LANES>,
    /// In place of the hits where rays do not start at one point.
    beam: Option<Box<OrthographicRays>>,
}

/// Rays from one point with their hits.
#[derive(Clone, Copy)]
pub(super) struct RayPacketHits<'a> {
    pub(super) rays: &'a RayPacket<LANES>,
    pub(super) hits: &'a PacketHits<LANES>,
    /// Depth per length along the ray.
    pub(super) depth_per_length: &'a [f32; LANES],
}

/// Rays side by side.
struct OrthographicRays {
    start: [Vec3; LANES],
    hits: [Option<Hit>; LANES],
}

/// The closest hit of one pixel's ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrimaryHit {
    pub(super) point: Vec3,
    /// Direction of the ray; unit length.
    pub(super) direction: Vec3,
    pub(super) depth: f32,
    /// Depth per length along the ray.
    pub(super) depth_per_length: f32,
    pub(super) id: i32,
    pub(super) instance: Option<u32>,
    pub(super) triangle: u32,
}

impl CameraRayPacket {
    /// No rays; memory for many packets of one picture.
    pub(super) fn new() -> Self {
        Self {
            rays: RayPacket::new(Vec3::ZERO),
            per_length: [1.0; LANES],
            hits: PacketHits::new(),
            beam: None,
        }
    }

    /// The direction of a ray; unit length.
    #[inline]
    pub(super) fn direction(&self, lane: usize) -> Vec3 {
        let [x, y, z] = &self.rays.direction;
        Vec3::new(x[lane], y[lane], z[lane])
    }

    /// Returns a pixel's closest hit.
    #[inline]
    pub(super) fn closest_hit(&self, lane: usize) -> Option<PrimaryHit> {
        let direction = self.direction(lane);
        let (start, distance, id, instance, triangle) = match &self.beam {
            None => {
                if !self.hits.is_hit(lane) {
                    return None;
                }
                let hits = &self.hits;
                let found = (
                    hits.distance_m[lane],
                    hits.id[lane],
                    hits.instance(lane),
                    hits.triangle[lane],
                );
                (self.rays.origin, found.0, found.1, found.2, found.3)
            }
            Some(beam) => {
                let hit = beam.hits[lane]?;
                (
                    beam.start[lane],
                    hit.distance_m,
                    hit.id,
                    hit.instance,
                    hit.triangle,
                )
            }
        };
        let per_length = self.per_length[lane];
        Some(PrimaryHit {
            point: start + direction * distance,
            direction,
            depth: distance * per_length,
            depth_per_length: per_length,
            id,
            instance,
            triangle,
        })
    }

    /// Returns the closest hits of pixels and their rays, where those start at one point.
    #[inline]
    pub(super) fn ray_packet_hits(&self) -> Option<RayPacketHits<'_>> {
        let seen = RayPacketHits {
            rays: &self.rays,
            hits: &self.hits,
            depth_per_length: &self.per_length,
        };
        self.beam.is_none().then_some(seen)
    }

    /// Returns whether a pixel sees anything.
    pub(super) fn has_hit(&self, lane: usize) -> bool {
        match &self.beam {
            None => self.hits.is_hit(lane),
            Some(beam) => beam.hits[lane].is_some(),
        }
    }

    /// Depths of the pixels' hits, m; `far_m` for those without one.
    #[inline]
    pub(super) fn depths(&self, near_m: f32, far_m: f32) -> [f32; LANES] {
        match &self.beam {
            // Distances of nothing are infinite.
            None => std::array::from_fn(|k| {
                (self.hits.distance_m[k] * self.per_length[k]).clamp(near_m, far_m)
            }),
            Some(beam) => beam
                .hits
                .map(|hit| hit.map_or(far_m, |hit| hit.distance_m.clamp(near_m, far_m))),
        }
    }

    /// Ids of the pixels' hits; 0 for those without one.
    #[inline]
    pub(super) fn ids(&self) -> [i32; LANES] {
        match &self.beam {
            None => self.hits.id,
            Some(beam) => beam.hits.map(|hit| hit.map_or(0, |hit| hit.id)),
        }
    }

    /// Weights of the second and third corner of the triangle that a pixel hits.
    pub(super) fn barycentric_weights(&self, scene: SceneBvh<'_>, lane: usize) -> (f32, f32) {
        let hit = match &self.beam {
            None => scene.packet_hit(&self.rays, &self.hits, lane),
            Some(beam) => beam.hits[lane],
        };
        hit.map_or((0.0, 0.0), |hit| (hit.u, hit.v))
    }

    /// Continues behind the given depths; lanes that are not named hit nothing from now on.
    pub(super) fn continue_behind(
        &mut self,
        rays: &CameraRayGenerator,
        scene: SceneBvh<'_>,
        behind: impl Iterator<Item = (usize, f32)>,
    ) {
        let mut far_m = [-1.0; LANES];
        for (lane, depth) in behind {
            self.rays.near_m[lane] = depth / self.per_length[lane];
            far_m[lane] = self.rays.far_m[lane];
        }
        self.rays.far_m = far_m;
        self.trace(rays, scene);
    }

    fn trace(&mut self, rays: &CameraRayGenerator, scene: SceneBvh<'_>) {
        let Some(beam) = &mut self.beam else {
            scene.closest_packet(
                &self.rays,
                VISIBLE_MASK,
                Some(rays.hidden.0),
                &mut self.hits,
            );
            return;
        };
        for k in 0..LANES {
            let ray = Ray {
                origin: beam.start[k],
                ..self.rays.ray(k)
            };
            beam.hits[k] = scene.closest_excluding(&ray, VISIBLE_MASK, rays.hidden.0);
        }
    }
}

impl CameraRayGenerator {
    pub(super) fn new(view: &View) -> Self {
        let rotation = view.world_from_camera.rotation.normalize();
        let (fixed, growing) = view.camera.pixel_area();
        let share = match view.preset {
            Preset::Full => 1.0 / SAMPLES_PER_PIXEL as f32,
            Preset::Flat | Preset::Lit => 1.0,
        };
        Self {
            view: *view,
            right: rotation * Vec3::X,
            up: rotation * Vec3::Y,
            back: rotation * Vec3::Z,
            // What nothing has as its id hides nothing.
            hidden: view.hidden_entity.unwrap_or(EntityId::VOID),
            pixel_area: (fixed * share, growing * share),
        }
    }

    /// The range of depth in which things are seen, m.
    pub(super) fn depth_range(&self) -> (f32, f32) {
        (self.view.camera.near_m(), self.view.camera.far_m())
    }

    /// Returns the closest hits of the pixels from (`left`, `top`) on; those beyond `width` and `height` hit nothing.
    #[inline]
    pub(super) fn cast(
        &self,
        scene: SceneBvh<'_>,
        (left, top): (usize, usize),
        (width, height): (usize, usize),
        packet: &mut CameraRayPacket,
    ) {
        let (near, far) = self.depth_range();
        packet.rays.origin = self.view.world_from_camera.position;
        packet.rays.near_m = [near; LANES];
        packet.rays.far_m = [far; LANES];
        if left + PACKET_COLUMNS > width || top + PACKET_ROWS > height {
            for k in 0..LANES {
                if left + k % PACKET_COLUMNS >= width || top + k / PACKET_COLUMNS >= height {
                    packet.rays.far_m[k] = -1.0;
                }
            }
        }
        match self.view.camera.projection() {
            Projection::Pinhole { fx, fy, cx, cy } => {
                self.pinhole_rays(packet, (left as f32, top as f32), (fx, fy, cx, cy));
            }
            Projection::Orthographic { .. } => self.orthographic_rays(packet, (left, top)),
            _ => self.distorted_rays(packet, (left, top)),
        }
        packet.trace(self, scene);
    }

    /// Directions through the middles of pixels.
    #[inline]
    fn pinhole_rays(
        &self,
        packet: &mut CameraRayPacket,
        (left, top): (f32, f32),
        (fx, fy, cx, cy): (f32, f32, f32, f32),
    ) {
        let rays = &mut packet.rays;
        let across: [f32; PACKET_COLUMNS] =
            std::array::from_fn(|column| (left + column as f32 + 0.5 - cx) * (1.0 / fx));
        for row in 0..PACKET_ROWS {
            let y = (cy - (top + row as f32 + 0.5)) * (1.0 / fy);
            let fixed = self.up * y - self.back;
            for (column, x) in across.iter().enumerate() {
                let k = row * PACKET_COLUMNS + column;
                let length = (x * x + (y * y + 1.0)).sqrt();
                let scale = 1.0 / length;
                for axis in 0..3 {
                    rays.direction[axis][k] = (self.right[axis] * x + fixed[axis]) * scale;
                }
                packet.per_length[k] = scale;
                rays.near_m[k] *= length;
                rays.far_m[k] *= length;
            }
        }
    }

    /// Directions through the middles of pixels of cameras that bend straight lines.
    fn distorted_rays(&self, packet: &mut CameraRayPacket, (left, top): (usize, usize)) {
        let camera = &self.view.camera;
        let is_range = camera.projection().depth_is_range();
        for k in 0..LANES {
            let image = Vec2::new(
                (left + k % PACKET_COLUMNS) as f32 + 0.5,
                (top + k / PACKET_COLUMNS) as f32 + 0.5,
            );
            let seen = camera.ray_in_camera(image).1;
            let direction = self.right * seen.x + self.up * seen.y + self.back * seen.z;
            let rays = &mut packet.rays;
            let Some(unit) = direction.try_normalize() else {
                rays.set(k, Vec3::ZERO, 0.0, -1.0);
                packet.per_length[k] = 1.0;
                continue;
            };
            // A direction is as long as the ray is for a metre of depth.
            let length = if is_range { 1.0 } else { seen.length() };
            rays.set(k, unit, rays.near_m[k] * length, rays.far_m[k] * length);
            packet.per_length[k] = 1.0 / length;
        }
    }

    /// The ray through a point of the image, and depth per length along it; `None` where the camera sees nothing.
    pub(super) fn ray(&self, image: Vec2) -> Option<(Ray, f32)> {
        let camera = &self.view.camera;
        let (start, seen) = camera.ray_in_camera(image);
        let turned = |v: Vec3| self.right * v.x + self.up * v.y + self.back * v.z;
        let direction = turned(seen).try_normalize()?;
        let length = if camera.projection().depth_is_range() {
            1.0
        } else {
            seen.length()
        };
        let (near, far) = self.depth_range();
        let ray = Ray {
            origin: self.view.world_from_camera.position + turned(start),
            direction,
            near_m: near * length,
            far_m: far * length,
        };
        Some((ray, 1.0 / length))
    }

    /// Returns whether the picture shows no light.
    pub(super) fn is_flat_preset(&self) -> bool {
        self.view.preset == Preset::Flat
    }

    /// Returns whether the picture has all light.
    pub(super) fn is_path_traced(&self) -> bool {
        self.view.preset == Preset::Full
    }

    /// Returns the id that the camera does not see.
    pub(super) fn hidden_entity(&self) -> i32 {
        self.hidden.0
    }

    /// A direction of the world in the camera's frame.
    #[inline]
    pub(super) fn in_camera(&self, direction: Vec3) -> Vec3 {
        Vec3::new(
            self.right.dot(direction),
            self.up.dot(direction),
            self.back.dot(direction),
        )
    }

    /// The camera.
    pub(super) fn camera(&self) -> &Camera {
        &self.view.camera
    }

    /// Starts in the middles of pixels, all in one direction.
    fn orthographic_rays(&self, packet: &mut CameraRayPacket, (left, top): (usize, usize)) {
        let start = std::array::from_fn(|k| {
            let image = Vec2::new(
                (left + k % PACKET_COLUMNS) as f32 + 0.5,
                (top + k / PACKET_COLUMNS) as f32 + 0.5,
            );
            let start = self.view.camera.ray_in_camera(image).0;
            self.view.world_from_camera.position + self.right * start.x + self.up * start.y
        });
        for axis in 0..3 {
            packet.rays.direction[axis] = [-self.back[axis]; LANES];
        }
        packet.beam = Some(Box::new(OrthographicRays {
            start,
            hits: [None; LANES],
        }));
    }
}
