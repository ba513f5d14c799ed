//! The colour of a pixel.

use super::CpuRenderer;
use super::band::Band;
use super::rays::Rays;
use super::rays::{COLUMNS, LANES, Packet, SEEN, Sight};
use crate::color::Srgb;
use crate::light::{beside_surface, display, sky};
use crate::look::Look;
use crate::surfaces::SLOW;
use dwell_scene::bvh::Ray;
use dwell_scene::{Entity, EntityId, Pose, State};
use glam::Vec3;

/// Most surfaces that a ray passes; the last one counts as opaque.
const LAYERS: usize = 8;
/// What passes so little light shows only itself.
const OPAQUE: f32 = 1.0 - 1.0 / 512.0;
/// A ray that goes on starts so far behind the surface that it passed: a length and a part of the depth.
const GAP: (f32, f32) = (2e-4, 2e-6);
/// Most mirrors that light meets; one more shows its colour.
const MIRRORS: u32 = 2;
/// How far off a surface its shadow ray or reflection starts, m.
const OFF_SURFACE_M: f32 = 1e-3;
/// The least cosine at which a pixel's footprint still grows.
const GRAZING: f32 = 0.05;

/// A pixel whose ray passed a surface.
#[derive(Clone, Copy)]
struct Open {
    lane: usize,
    /// Light so far.
    light: Vec3,
    /// How much of what lies behind is seen.
    rest: f32,
    /// Where to go on, m of depth.
    from: f32,
}

/// What a surface is like at a point, before light.
pub(super) struct Skin<'a> {
    look: &'a Look,
    /// Reflectance, linear.
    pub(super) color: Vec3,
    opacity: f32,
    /// By the winding, world space.
    pub(super) normal: Vec3,
    /// Of the part that it moves with.
    pose: Option<&'a Pose>,
}

/// The pixels of a packet whose rays passed a surface.
struct OpenLanes {
    count: usize,
    lanes: [Open; LANES],
}

impl OpenLanes {
    const NONE: Self = Self {
        count: 0,
        lanes: [Open {
            lane: 0,
            light: Vec3::ZERO,
            rest: 0.0,
            from: 0.0,
        }; LANES],
    };

    fn push(&mut self, open: Open) {
        self.lanes[self.count] = open;
        self.count += 1;
    }

    fn all(&self) -> &[Open] {
        &self.lanes[..self.count]
    }
}

/// Memory for many packets.
pub(super) struct Palette {
    pub(super) bytes: [[u8; 3]; LANES],
    open: OpenLanes,
    next: OpenLanes,
}

impl Palette {
    pub(super) fn new() -> Self {
        Self {
            bytes: [[0; 3]; LANES],
            open: OpenLanes::NONE,
            next: OpenLanes::NONE,
        }
    }
}

impl CpuRenderer {
    /// What is seen of a surface without light.
    pub(super) fn skin<'a>(&'a self, rays: &Rays, state: &'a State, sight: &Sight) -> Skin<'a> {
        let position = self.surfaces.position(sight.instance, sight.triangle);
        self.skin_at(rays, state, sight, position)
    }

    #[inline]
    fn skin_at<'a>(
        &'a self,
        rays: &Rays,
        state: &'a State,
        sight: &Sight,
        position: usize,
    ) -> Skin<'a> {
        let triangle = self.surfaces.triangle(position);
        let look = &self.looks[triangle.material as usize];
        let mut color = Vec3::from_array(look.base);
        let mut opacity = look.opacity;
        let &Sight {
            point,
            direction,
            depth,
            ..
        } = sight;
        let pose = self.surfaces.pose(sight.instance, state);
        let normal = pose.map_or(triangle.normal, |pose| pose.rotation * triangle.normal);
        if let Some(texture) = look.texture() {
            let in_part =
                |p: Vec3| pose.map_or(p, |pose| pose.rotation.inverse() * (p - pose.position));
            let (fixed, growing) = rays.pixel_area;
            let slope = normal.dot(direction).abs().max(GRAZING);
            let area = (fixed + growing * depth * depth) * sight.per_length / slope;
            let texels = area * triangle.density * look.texels;
            let uv = triangle.uv(in_part(point));
            let sample = self.textures.sample(Srgb::tables(), texture, uv, texels);
            color *= sample.truncate();
            opacity *= sample.w;
        }
        Skin {
            look,
            color,
            opacity,
            normal,
            pose,
        }
    }
}

impl Band<'_> {
    /// sRGB of the first `columns` by `rows` pixels of a packet, which afterwards no longer knows what they see first.
    pub(super) fn colors(
        &self,
        renderer: &CpuRenderer,
        packet: &mut Packet,
        (columns, rows): (usize, usize),
        palette: &mut Palette,
    ) {
        palette.open.count = 0;
        for row in 0..rows {
            for lane in row * COLUMNS..row * COLUMNS + columns {
                palette.bytes[lane] = self.color(renderer, packet, lane, &mut palette.open);
            }
        }
        if palette.open.count > 0 {
            self.behind(renderer, packet, palette);
        }
    }

    /// sRGB of a pixel that sees nothing or an opaque surface; others are noted in `open`.
    #[inline]
    fn color(
        &self,
        renderer: &CpuRenderer,
        packet: &Packet,
        lane: usize,
        open: &mut OpenLanes,
    ) -> [u8; 3] {
        let Some(sight) = packet.sight(lane) else {
            let direction = packet.direction(lane);
            if direction == Vec3::ZERO {
                return [0; 3];
            }
            return self.encode(self.sky(renderer, direction));
        };
        let position = renderer.surfaces.position(sight.instance, sight.triangle);
        let [r, g, b, kind] = renderer.surfaces.quick(position);
        if kind != SLOW && self.light.is_none() {
            return [r, g, b];
        }
        let (light, opacity) = self.surface(renderer, &sight, position, MIRRORS, || {
            packet.weights(self.scene, lane)
        });
        if opacity < OPAQUE {
            open.push(Open {
                lane,
                light: light * opacity,
                rest: 1.0 - opacity,
                from: sight.depth * (1.0 + GAP.1) + GAP.0,
            });
        }
        self.encode(light)
    }

    /// All that is seen through surfaces, front to back.
    #[cold]
    fn behind(&self, renderer: &CpuRenderer, packet: &mut Packet, palette: &mut Palette) {
        let bytes = &mut palette.bytes;
        let (mut open, mut next) = (&mut palette.open, &mut palette.next);
        for layer in 1..=LAYERS {
            let ways = open.all().iter().map(|open| (open.lane, open.from));
            packet.go_on(&self.rays, self.scene, ways);
            next.count = 0;
            for &Open {
                lane, light, rest, ..
            } in open.all()
            {
                let Some(sight) = packet.sight(lane) else {
                    bytes[lane] =
                        self.encode(light + self.sky(renderer, packet.direction(lane)) * rest);
                    continue;
                };
                let position = renderer.surfaces.position(sight.instance, sight.triangle);
                let (more, opacity) = self.surface(renderer, &sight, position, MIRRORS, || {
                    packet.weights(self.scene, lane)
                });
                if opacity >= OPAQUE || layer == LAYERS {
                    bytes[lane] = self.encode(light + more * rest);
                    continue;
                }
                next.push(Open {
                    lane,
                    light: light + more * (opacity * rest),
                    rest: rest * (1.0 - opacity),
                    from: sight.depth * (1.0 + GAP.1) + GAP.0,
                });
            }
            if next.count == 0 {
                return;
            }
            std::mem::swap(&mut open, &mut next);
        }
    }

    /// Light of nothing.
    fn sky(&self, renderer: &CpuRenderer, direction: Vec3) -> Vec3 {
        let light = self
            .light
            .map(|(_, exposure)| (renderer.house_light(), exposure));
        sky(direction, light)
    }

    #[inline]
    fn encode(&self, light: Vec3) -> [u8; 3] {
        let shown = if self.light.is_some() {
            display(light)
        } else {
            light
        };
        Srgb::tables().encode3(shown.to_array())
    }

    /// Light that a surface sends to the camera, and how much of what lies behind it hides.
    ///
    /// `mirrors`: how many more of them light meets. `weights`: of the second and third corner.
    #[inline]
    fn surface(
        &self,
        renderer: &CpuRenderer,
        sight: &Sight,
        position: usize,
        mirrors: u32,
        weights: impl FnOnce() -> (f32, f32),
    ) -> (Vec3, f32) {
        let Skin {
            look,
            color,
            opacity,
            normal,
            pose,
        } = renderer.skin_at(&self.rays, self.state, sight, position);
        let &Sight {
            point, direction, ..
        } = sight;
        let Some((lighting, exposure)) = &self.light else {
            return (color, opacity);
        };
        let facing = if normal.dot(direction) > 0.0 {
            -normal
        } else {
            normal
        };
        if look.mirror && mirrors > 0 {
            let light = self.reflected(renderer, sight, facing, mirrors - 1);
            return (color * light, opacity);
        }
        let (u, v) = weights();
        let smooth = renderer.surfaces.smooth_normal(position, u, v);
        let smooth = pose
            .map_or(smooth, |pose| pose.rotation * smooth)
            .normalize_or(facing);
        let smooth = if smooth.dot(facing) < 0.0 {
            -smooth
        } else {
            smooth
        };
        let brightness = lighting.brightness(
            renderer.house_light(),
            *exposure,
            point,
            smooth,
            beside_surface(point, facing, direction),
            sight.id,
            || renderer.sun_reaches(self.scene, point + facing * OFF_SURFACE_M),
        );
        (
            color * brightness + self.glow(renderer, look.emission, sight.id),
            opacity,
        )
    }

    /// What a mirror shows: the light that comes from where the ray goes on.
    #[cold]
    fn reflected(
        &self,
        renderer: &CpuRenderer,
        mirror: &Sight,
        facing: Vec3,
        mirrors: u32,
    ) -> Vec3 {
        let direction = mirror.direction.reflect(facing).normalize_or(facing);
        let mut ray = Ray {
            origin: mirror.point + facing * OFF_SURFACE_M,
            direction,
            near_m: 0.0,
            far_m: f32::INFINITY,
        };
        let (mut light, mut rest) = (Vec3::ZERO, 1.0);
        for layer in 1..=LAYERS {
            let Some(hit) = self.scene.closest(&ray, SEEN) else {
                break;
            };
            let distance = hit.distance_m;
            let sight = Sight {
                point: ray.origin + direction * distance,
                direction,
                // Patterns in a mirror are as fine as if they stood behind it.
                depth: mirror.depth + distance * mirror.per_length,
                per_length: mirror.per_length,
                id: hit.id,
                instance: hit.instance,
                triangle: hit.triangle,
            };
            let position = renderer.surfaces.position(hit.instance, hit.triangle);
            let (more, opacity) =
                self.surface(renderer, &sight, position, mirrors, || (hit.u, hit.v));
            if opacity >= OPAQUE || layer == LAYERS {
                return light + more * rest;
            }
            light += more * (opacity * rest);
            rest *= 1.0 - opacity;
            ray.near_m = distance * (1.0 + GAP.1) + GAP.0;
        }
        light + self.sky(renderer, direction) * rest
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
