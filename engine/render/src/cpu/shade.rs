//! The colour of a pixel.

use super::CpuRenderer;
use super::band::Band;
use crate::color::Srgb;
use crate::light::{beside_surface, display, sky};
use dwell_scene::bvh::Hit;
use dwell_scene::{Entity, EntityId};
use glam::Vec3;

/// Most surfaces that a ray passes; the last one counts as opaque.
const LAYERS: usize = 8;
/// What passes so little light shows only itself.
const OPAQUE: f32 = 1.0 - 1.0 / 512.0;
/// A ray that goes on starts so far behind the surface that it passed: a length and a part of the depth.
const GAP: (f32, f32) = (2e-4, 2e-6);
/// The least cosine at which a pixel's footprint still grows.
const GRAZING: f32 = 0.05;
/// What the sky shows on a lit picture, against a flat one: tone mapping darkens it again.
const LIT_SKY: f32 = 4.0;

/// One ray: the point at depth 0 and the way per metre of depth.
pub(super) type DepthRay = (Vec3, Vec3);

impl Band<'_> {
    /// sRGB of what a ray sees that first meets a surface that is not plain.
    pub(super) fn color(
        &self,
        renderer: &CpuRenderer,
        ray: DepthRay,
        hit: Hit,
        position: usize,
    ) -> [u8; 3] {
        let (mut light, opacity) = self.surface(renderer, ray, &hit, position);
        if opacity < OPAQUE {
            light = self.behind(renderer, ray, hit, (light, opacity));
        }
        self.encode(light)
    }

    /// sRGB of nothing.
    pub(super) fn void(&self, ray: DepthRay) -> [u8; 3] {
        self.encode(self.sky(ray))
    }

    fn sky(&self, ray: DepthRay) -> Vec3 {
        let strength = if self.light.is_some() { LIT_SKY } else { 1.0 };
        sky(ray.1.normalize_or_zero()) * strength
    }

    #[inline]
    fn encode(&self, light: Vec3) -> [u8; 3] {
        let light = light.to_array();
        Srgb::tables().encode3(if self.light.is_some() {
            light.map(display)
        } else {
            light
        })
    }

    /// All that a ray sees through a first surface of this light and opacity, front to back.
    #[cold]
    fn behind(
        &self,
        renderer: &CpuRenderer,
        ray: DepthRay,
        mut hit: Hit,
        first: (Vec3, f32),
    ) -> Vec3 {
        let mut sum = first.0 * first.1;
        let mut rest = 1.0 - first.1;
        for layer in 1..=LAYERS {
            let from = hit.distance_m * (1.0 + GAP.1) + GAP.0;
            let Some(next) = self.rays.closest(self.scene, ray, from) else {
                return sum + self.sky(ray) * rest;
            };
            let position = renderer.surfaces.position(next.instance, next.triangle);
            let (light, opacity) = self.surface(renderer, ray, &next, position);
            if opacity >= OPAQUE || layer == LAYERS {
                return sum + light * rest;
            }
            sum += light * (opacity * rest);
            rest *= 1.0 - opacity;
            hit = next;
        }
        sum
    }

    /// Light that a surface sends to the camera, and how much of what lies behind it hides.
    #[inline]
    fn surface(
        &self,
        renderer: &CpuRenderer,
        ray: DepthRay,
        hit: &Hit,
        position: usize,
    ) -> (Vec3, f32) {
        let triangle = renderer.surfaces.triangle(position);
        let look = &renderer.looks[triangle.material as usize];
        let mut color = Vec3::from_array(look.base);
        let mut opacity = look.opacity;
        let rotation = renderer.surfaces.rotation(hit.instance, self.state);
        let normal = rotation.map_or(triangle.normal, |turn| turn * triangle.normal);
        if let Some(texture) = look.texture() {
            let uv = triangle.uv(hit.u, hit.v);
            let slope = normal.dot(ray.1).abs().max(GRAZING);
            let (fixed, growing) = self.rays.pixel_area;
            let area = (fixed + growing * hit.distance_m * hit.distance_m) / slope;
            let texels = area * triangle.density * look.texels;
            let [r, g, b, alpha] = renderer
                .textures
                .sample(Srgb::tables(), texture, uv, texels);
            color *= Vec3::new(r, g, b);
            opacity *= alpha;
        }
        let Some((lighting, exposure)) = &self.light else {
            return (color, opacity);
        };
        let facing = if normal.dot(ray.1) > 0.0 {
            -normal
        } else {
            normal
        };
        let smooth = renderer.surfaces.smooth_normal(position, hit.u, hit.v);
        let smooth = rotation
            .map_or(smooth, |turn| turn * smooth)
            .normalize_or(facing);
        let smooth = if smooth.dot(facing) < 0.0 {
            -smooth
        } else {
            smooth
        };
        let point = ray.0 + ray.1 * hit.distance_m;
        let brightness = lighting.brightness(
            renderer.house_light(),
            *exposure,
            point,
            smooth,
            beside_surface(point, facing, ray.1),
            hit.id,
        );
        (
            color * brightness + self.glow(renderer, look.emission, hit.id),
            opacity,
        )
    }

    /// Light of its own, unless it is switched off.
    fn glow(&self, renderer: &CpuRenderer, emission: [f32; 3], entity: i32) -> Vec3 {
        let off = || match renderer.house.entity(EntityId(entity)) {
            Some(Entity::Object(object)) => !self.state.is_on(&renderer.house, object),
            _ => false,
        };
        if emission.iter().all(|part| *part <= 0.0) || off() {
            Vec3::ZERO
        } else {
            Vec3::from_array(emission)
        }
    }
}
