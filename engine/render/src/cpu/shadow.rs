//! Shadow rays: occlusion of lights.

use super::CpuRenderer;
use super::camera_rays::{LANES, VISIBLE_MASK};
use super::shade::UnshadowedPixel;
use crate::light::{LampCluster, LightSource, Lighting};
use dwell_scene::EntityId;
use dwell_scene::bvh::{PacketHits, Ray, RayPacket, SceneBvh};
use glam::Vec3;

/// Largest distance at which something casts a shadow of the sky or the sun, m.
const SKY_RAY_M: f32 = 500.0;
/// Largest number of glass surfaces that light passes; behind more it counts as shadow.
const PANES: usize = 8;
/// Transmittance above which a material counts as glass.
const GLASS: f32 = 0.5;

impl CpuRenderer {
    /// Returns whether nothing but glass blocks a ray, apart from one thing.
    pub(super) fn is_unoccluded(&self, scene: SceneBvh<'_>, ray: &Ray, hidden: i32) -> bool {
        let mut ray = *ray;
        for _ in 0..PANES {
            let Some(hit) = scene.closest_excluding(&ray, VISIBLE_MASK, hidden) else {
                return true;
            };
            if !self.is_glass(hit.instance, hit.triangle) {
                return false;
            }
            ray.near_m = hit.distance_m * (1.0 + 1e-5) + 1e-3;
        }
        false
    }

    fn is_glass(&self, instance: Option<u32>, triangle: u32) -> bool {
        let position = self.triangle_table.table_index(instance, triangle);
        let material = self.triangle_table.triangle(position).material;
        self.shading_materials[material as usize].opacity <= GLASS
    }

    /// Returns whether the middle of the sun shines on a point.
    pub(super) fn is_sun_visible(&self, scene: SceneBvh<'_>, point: Vec3) -> bool {
        self.is_sky_visible(scene, point, self.static_lighting().sun.0)
    }

    /// Returns whether light comes to a point from far away. `direction`: unit length, towards it.
    pub(super) fn is_sky_visible(&self, scene: SceneBvh<'_>, point: Vec3, direction: Vec3) -> bool {
        let ray = Ray {
            origin: point,
            direction,
            near_m: 0.0,
            far_m: SKY_RAY_M,
        };
        self.is_unoccluded(scene, &ray, EntityId::VOID.0)
    }

    /// Returns whether light of a source arrives at a point off a surface, whose flat normal is `facing`.
    pub(super) fn is_source_unoccluded(
        &self,
        scene: SceneBvh<'_>,
        lighting: &Lighting,
        source: LightSource,
        (point, facing): (Vec3, Vec3),
    ) -> bool {
        match source {
            LightSource::None
            | LightSource::RoomWalls
            | LightSource::Sky
            | LightSource::Window(_) => true,
            LightSource::Sun => self.is_sun_visible(scene, point),
            LightSource::LampCluster(position) => {
                let caster = lighting.lamp_cluster(position);
                lamp_shadow_ray(caster, point, facing)
                    .is_none_or(|ray| self.is_unoccluded(scene, &ray, caster.entity))
            }
        }
    }

    /// Adds to each pixel the light that arrives there. A source's shadow rays are traced together: they start at one point.
    pub(super) fn add_unoccluded_light(
        &self,
        scene: SceneBvh<'_>,
        lighting: &Lighting,
        pending: &mut [UnshadowedPixel],
    ) {
        let mut hits = PacketHits::<LANES>::new();
        for first in 0..pending.len() {
            for k in 0..pending[first].incoming.rays.len() {
                let source = pending[first].incoming.rays[k].source;
                if source == LightSource::None {
                    continue;
                }
                let mut stopped = 0_u64;
                let rest = &mut pending[first..];
                if let LightSource::LampCluster(position) = source {
                    let caster = lighting.lamp_cluster(position);
                    let mut rays = RayPacket::<LANES>::new(caster.center);
                    let mut used = 0_u64;
                    for (lane, one) in rest.iter().enumerate() {
                        let asked = one.incoming.rays.iter().any(|ray| ray.source == source);
                        if asked
                            && let Some(ray) = lamp_shadow_ray(caster, one.ray_end, one.flat_normal)
                        {
                            rays.set(lane, ray.direction, ray.near_m, ray.far_m);
                            used |= 1 << lane;
                        }
                    }
                    if used != 0 {
                        scene.closest_packet(&rays, VISIBLE_MASK, Some(caster.entity), &mut hits);
                    }
                    for lane in (0..rest.len()).filter(|lane| used >> lane & 1 == 1) {
                        let through = || {
                            self.is_glass(hits.instance(lane), hits.triangle[lane])
                                && self.is_unoccluded(scene, &rays.ray(lane), caster.entity)
                        };
                        if hits.is_hit(lane) && !through() {
                            stopped |= 1 << lane;
                        }
                    }
                }
                for (lane, one) in rest.iter_mut().enumerate() {
                    let mine = one
                        .incoming
                        .rays
                        .iter_mut()
                        .find(|ray| ray.source == source);
                    let Some(ray) = mine else {
                        continue;
                    };
                    ray.source = LightSource::None;
                    let arrives = match source {
                        LightSource::Sun => self.is_sun_visible(scene, one.ray_end),
                        _ => stopped >> lane & 1 == 0,
                    };
                    if arrives {
                        one.incoming.light += ray.light;
                    }
                }
            }
        }
    }
}

/// The shadow ray of a caster to a point; `None` for a flat surface that faces away, which light meets only by its rounded normal.
fn lamp_shadow_ray(caster: &LampCluster, point: Vec3, facing: Vec3) -> Option<Ray> {
    let way = point - caster.center;
    let distance = way.length();
    (distance > 1e-3 && facing.dot(way) < 0.0).then(|| Ray {
        origin: caster.center,
        direction: way / distance,
        near_m: 0.0,
        far_m: distance,
    })
}
