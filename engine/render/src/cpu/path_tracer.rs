//! Pictures with all light: paths of many rays a pixel.
//!
//! Each pixel is the mean of [`SAMPLES_PER_PIXEL`] rays through different places in it. Where one meets a surface, every source of light is
//! sampled by a ray to another point of it, so that shadows are soft; light from all around is gathered by rays to the surfaces
//! that reflect it, which have light of their own and the room's mean for the rest. Metals and polished surfaces reflect; how facets of
//! rough surfaces hide one another is left out.
//!
//! # Source
//! J. T. Kajiya, *The rendering equation*, SIGGRAPH 1986, cut off after the second surface by what `lit` says of it.
//! Reflection: C. Schlick, *An inexpensive BRDF model*, 1994, equation 15, with micro-facets of B. Walter et al., EGSR
//! 2007, equations 35 and 36 (GGX).

use super::CpuRenderer;
use super::camera_rays::{PrimaryHit, VISIBLE_MASK};
use super::sampler::PixelSampler;
use super::shade::{
    CONTINUATION_OFFSET, MAX_MIRROR_BOUNCES, MAX_TRANSPARENT_LAYERS, OPAQUE_THRESHOLD,
    SHADOW_RAY_OFFSET_M,
};
use super::tile::ImageBand;
use crate::light::{
    Exposure, IncidentLight, LightSource, Lighting, ShadingPoint, exposed_background_luminance,
    room_lookup_point, tone_map,
};
use crate::material::ShadingMaterial;
use dwell_scene::EntityId;
use dwell_scene::bvh::Ray;
use glam::{Vec2, Vec3};

/// Sample positions in a pixel, along each edge.
pub(super) const SAMPLES_PER_EDGE: usize = 4;
/// Rays a pixel.
pub(super) const SAMPLES_PER_PIXEL: usize = SAMPLES_PER_EDGE * SAMPLES_PER_EDGE;
/// Rays of each that gather light from all around.
const GATHERED: usize = 2;
/// Largest radiance of a gathered ray, in units of display white: few that meet a patch of sun would show as single bright pixels.
const MOST_GATHERED: f32 = 3.0;
/// Reflectance of smooth glass, varnish or ceramic at normal incidence.
const STRAIGHT: f32 = 0.04;
/// Roughness above which a non-metal shows no reflection. This, and that polish falls evenly up to there, is ours.
const DULL: f32 = 0.7;
/// Distance of the sample points of a window into the room, m: before its frame.
const BEFORE_FRAME_M: f32 = 0.05;
/// A room is looked up half of the way back from a surface at most: steps back a metre of way.
const NEAR: f32 = 2.5;
/// Tangent of half the angle under which the sun is seen: 0.533 degrees in the mean.
const SUN_RADIUS: f32 = 0.004_65;

/// The remaining budget of bounces of one kind of ray.
#[derive(Clone, Copy)]
struct BounceBudget {
    /// Surfaces that may still reflect diffusely.
    bounces: u32,
    mirrors: u32,
    /// Depth of the camera's footprint, as for [`PrimaryHit`].
    depth: f32,
    per_length: f32,
    hidden: i32,
}

/// One band with its light.
struct PathTracer<'a> {
    renderer: &'a CpuRenderer,
    band: &'a ImageBand<'a>,
    lighting: &'a Lighting,
    exposure: Exposure,
}

impl ImageBand<'_> {
    /// sRGB of a pixel with all light.
    pub(super) fn path_traced_color(
        &self,
        renderer: &CpuRenderer,
        (lighting, exposure): (&Lighting, Exposure),
        (column, row): (usize, usize),
    ) -> [u8; 3] {
        let tracer = PathTracer {
            renderer,
            band: self,
            lighting,
            exposure,
        };
        let mut sum = Vec3::ZERO;
        for sample in 0..SAMPLES_PER_PIXEL {
            let mut sampler = PixelSampler::new((column, row), sample);
            let (x, y) = sampler.uniform_pair();
            let place = |cell: usize, within: f32| (cell as f32 + within) / SAMPLES_PER_EDGE as f32;
            let image = Vec2::new(
                column as f32 + place(sample % SAMPLES_PER_EDGE, x),
                row as f32 + place(sample / SAMPLES_PER_EDGE, y),
            );
            if let Some((ray, per_length)) = self.rays.ray(image) {
                let path = BounceBudget {
                    bounces: 1,
                    mirrors: MAX_MIRROR_BOUNCES,
                    depth: 0.0,
                    per_length,
                    hidden: self.rays.hidden_entity(),
                };
                sum += tone_map(tracer.light_along(ray, path, &mut sampler));
            }
        }
        crate::color::SrgbTables::tables().encode3((sum / SAMPLES_PER_PIXEL as f32).to_array())
    }
}

impl PathTracer<'_> {
    /// Returns the radiance along a ray, in units of display white.
    fn light_along(&self, mut ray: Ray, path: BounceBudget, sampler: &mut PixelSampler) -> Vec3 {
        let (mut light, mut rest) = (Vec3::ZERO, 1.0);
        for layer in 1..=MAX_TRANSPARENT_LAYERS {
            let Some(hit) = self
                .band
                .scene
                .closest_excluding(&ray, VISIBLE_MASK, path.hidden)
            else {
                break;
            };
            let distance = hit.distance_m;
            let sight = PrimaryHit {
                point: ray.origin + ray.direction * distance,
                direction: ray.direction,
                depth: path.depth + distance * path.per_length,
                depth_per_length: path.per_length,
                id: hit.id,
                instance: hit.instance,
                triangle: hit.triangle,
            };
            let (more, opacity) = self.surface((&sight, distance), (hit.u, hit.v), path, sampler);
            if opacity >= OPAQUE_THRESHOLD || layer == MAX_TRANSPARENT_LAYERS {
                return light + more * rest;
            }
            light += more * (opacity * rest);
            rest *= 1.0 - opacity;
            ray.near_m = distance * (1.0 + CONTINUATION_OFFSET.1) + CONTINUATION_OFFSET.0;
        }
        // The sky's light on rooms comes by their windows, each sampled by itself.
        if path.bounces == 0 {
            return light;
        }
        let fixed = self.renderer.static_lighting();
        light + exposed_background_luminance(ray.direction, Some((fixed, self.exposure))) * rest
    }

    /// Returns the radiance that a surface sends back along the ray that met it, and its opacity.
    fn surface(
        &self,
        (sight, distance_m): (&PrimaryHit, f32),
        weights: (f32, f32),
        path: BounceBudget,
        sampler: &mut PixelSampler,
    ) -> (Vec3, f32) {
        let renderer = self.renderer;
        let position = renderer
            .triangle_table
            .table_index(sight.instance, sight.triangle);
        let skin = renderer.surface_at_point(
            &self.band.rays,
            self.band.scene_and_state(),
            sight,
            position,
        );
        let (facing, smooth) =
            renderer.geometric_and_shading_normals(&skin, sight, position, weights);
        let off = sight.point + facing * SHADOW_RAY_OFFSET_M;
        if skin.material.mirror && path.mirrors > 0 {
            let seen = FacetAndGeometricNormals {
                facet: facing,
                facing,
            };
            let light = self.reflected(sight, off, seen, path, sampler);
            return (skin.color * light, skin.opacity);
        }
        let site = ShadingPoint {
            point: sight.point,
            normal: smooth,
            // Not behind where a short ray comes from.
            room_lookup_point: room_lookup_point(
                sight.point,
                facing,
                sight.direction * (distance_m * NEAR).min(1.0),
            ),
            entity: sight.id,
        };
        let fixed = renderer.static_lighting();
        if path.bounces == 0 {
            let incoming: IncidentLight<2> =
                self.lighting.incident_light(fixed, self.exposure, &site);
            let light = incoming.total_arriving(|source| {
                renderer.is_source_unoccluded(self.band.scene, self.lighting, source, (off, facing))
            });
            return (skin.color * light, skin.opacity);
        }
        let mut sum = Vec3::ZERO;
        self.lighting
            .for_each_source(fixed, self.exposure, &site, |source, light| {
                if light == Vec3::ZERO {
                    return;
                }
                sum += match source {
                    LightSource::RoomWalls => self.indirect_light(off, smooth, path, sampler),
                    _ if self.is_source_visible(source, (off, facing), smooth, sampler) => light,
                    _ => Vec3::ZERO,
                };
            });
        let mut shown = skin.color * sum;
        if path.mirrors > 0 && has_specular_reflection(skin.material) {
            let facet = sampler.sample_microfacet_normal(smooth, skin.material.roughness);
            let share = reflectance(skin.material, skin.color, -sight.direction.dot(facet));
            let seen = FacetAndGeometricNormals { facet, facing };
            let light = self.reflected(sight, off, seen, path, sampler);
            shown = shown * (Vec3::ONE - share) * (1.0 - skin.material.metallic) + light * share;
        }
        shown += self
            .band
            .emitted_light(renderer, skin.material.emission, sight.id);
        (shown, skin.opacity)
    }

    /// Returns the radiance from the direction into which a mirror reflects the ray.
    fn reflected(
        &self,
        sight: &PrimaryHit,
        off: Vec3,
        FacetAndGeometricNormals { facet, facing }: FacetAndGeometricNormals,
        path: BounceBudget,
        sampler: &mut PixelSampler,
    ) -> Vec3 {
        let direction = sight.direction.reflect(facet).normalize_or(facing);
        // A facet that reflects into its own surface would show that; the surface's mirror image stands for it.
        let direction = if direction.dot(facing) > 0.0 {
            direction
        } else {
            sight.direction.reflect(facing).normalize_or(facing)
        };
        let path = BounceBudget {
            mirrors: path.mirrors - 1,
            // Patterns in a mirror are as fine as if they stood behind it.
            depth: sight.depth,
            hidden: EntityId::VOID.0,
            ..path
        };
        self.light_along(Ray::new(off, direction), path, sampler)
    }

    /// Returns the light that other surfaces reflect on one of reflectance 1.
    fn indirect_light(
        &self,
        off: Vec3,
        normal: Vec3,
        path: BounceBudget,
        sampler: &mut PixelSampler,
    ) -> Vec3 {
        let path = BounceBudget {
            bounces: path.bounces - 1,
            mirrors: 0,
            hidden: EntityId::VOID.0,
            ..path
        };
        let one = |sampler: &mut PixelSampler| {
            let direction = sampler.cosine_hemisphere(normal);
            let light = self.light_along(Ray::new(off, direction), path, sampler);
            light.min(Vec3::splat(MOST_GATHERED))
        };
        let sum = (0..GATHERED).fold(Vec3::ZERO, |sum, _| sum + one(sampler));
        sum / GATHERED as f32
    }

    /// Returns whether light arrives from a point of its source.
    fn is_source_visible(
        &self,
        source: LightSource,
        (off, facing): (Vec3, Vec3),
        normal: Vec3,
        sampler: &mut PixelSampler,
    ) -> bool {
        let (renderer, scene) = (self.renderer, self.band.scene);
        let (target, hidden) = match source {
            LightSource::None | LightSource::RoomWalls => return true,
            LightSource::Sun => {
                let to_sun = sampler.uniform_cone(renderer.static_lighting().sun.0, SUN_RADIUS);
                return renderer.is_sky_visible(scene, off, to_sun);
            }
            LightSource::Sky => {
                let direction = sampler.cosine_hemisphere(normal);
                // What lies below throws back what the ground is taken to.
                return direction.y < 0.0 || renderer.is_sky_visible(scene, off, direction);
            }
            LightSource::Window(position) => {
                let window = &renderer.static_lighting().windows[position as usize];
                let (x, y) = sampler.uniform_pair();
                let [across, along] = window.half_edges;
                let on_pane = window.center + across * (2.0 * x - 1.0) + along * (2.0 * y - 1.0);
                (on_pane + window.normal * BEFORE_FRAME_M, EntityId::VOID.0)
            }
            LightSource::LampCluster(position) => {
                let caster = self.lighting.lamp_cluster(position);
                let (pick, within) = (sampler.uniform_pair(), sampler.uniform_ball());
                let place = self
                    .lighting
                    .sample_point_in_cluster(caster, off, pick, within);
                (place, caster.entity)
            }
        };
        let way = target - off;
        // A flat surface that faces away meets light only by its rounded normal.
        facing.dot(way) <= 0.0
            || renderer.is_unoccluded(scene, &Ray::segment(off, target, 0.0), hidden)
    }
}

/// The normal of a facet, and that of the flat triangle that it is on, towards the viewer.
#[derive(Clone, Copy)]
struct FacetAndGeometricNormals {
    facet: Vec3,
    facing: Vec3,
}

/// Returns whether a surface reflects more than rays can show.
fn has_specular_reflection(look: &ShadingMaterial) -> bool {
    look.metallic > 0.0 || look.roughness < DULL
}

/// Returns a surface's reflectance, by its colour and the cosine between the viewer and the facet: metals by their colour, others less the
/// rougher they are.
fn reflectance(look: &ShadingMaterial, color: Vec3, cosine: f32) -> Vec3 {
    let left = 1.0 - cosine.clamp(0.0, 1.0);
    let grazing = left * left * left * left * left;
    let schlick = |straight: Vec3| straight + (Vec3::ONE - straight) * grazing;
    let polish = (1.0 - look.roughness / DULL).max(0.0);
    let other = schlick(Vec3::splat(STRAIGHT)) * polish;
    other.lerp(schlick(color), look.metallic)
}
