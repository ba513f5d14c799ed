//! The colour of a pixel.

use super::CpuRenderer;
use super::camera_rays::CameraRayGenerator;
use super::camera_rays::{CameraRayPacket, LANES, PACKET_COLUMNS, PrimaryHit, VISIBLE_MASK};
use super::flat_shading::set_bit_positions;
use super::tile::ImageBand;
use crate::color::SrgbTables;
use crate::light::{
    IncidentLight, ShadingPoint, exposed_background_luminance, room_lookup_point, tone_map,
};
use crate::material::ShadingMaterial;
use crate::texture_filter::{MIN_FOOTPRINT_COSINE, TextureFootprint};
use dwell_scene::bvh::Ray;
use dwell_scene::rays::RayScene;
use dwell_scene::{Entity, EntityId, Pose, State};
use glam::Vec3;

/// Largest number of surfaces that a ray passes; the last one counts as opaque.
pub(super) const MAX_TRANSPARENT_LAYERS: usize = 8;
/// Opacity from which on a surface shows only itself.
pub(super) const OPAQUE_THRESHOLD: f32 = 1.0 - 1.0 / 512.0;
/// Offset of a continued ray behind the surface that it passed: a length and a part of the depth.
pub(super) const CONTINUATION_OFFSET: (f32, f32) = (2e-4, 2e-6);
/// Largest number of mirrors that light meets; one more shows its colour.
pub(super) const MAX_MIRROR_BOUNCES: u32 = 2;
/// Offset from a surface at which its shadow ray or reflection starts, m.
pub(super) const SHADOW_RAY_OFFSET_M: f32 = 1e-3;
/// A pixel whose ray passed a surface.
#[derive(Clone, Copy)]
struct TransmittedPixel {
    lane: usize,
    /// Light so far.
    light: Vec3,
    /// Transmittance so far: the share of what lies behind that is seen.
    rest: f32,
    /// Depth from which the ray goes on, m.
    from: f32,
}

/// A surface's properties at a point, before light.
pub(super) struct ShadedSurface<'a> {
    pub(super) material: &'a ShadingMaterial,
    /// Reflectance, linear.
    pub(super) color: Vec3,
    pub(super) opacity: f32,
    /// Normal by the winding, world space.
    pub(super) normal: Vec3,
    /// Pose of the part that it moves with.
    pose: Option<&'a Pose>,
}

impl ShadedSurface<'_> {
    /// The normal on the side that is seen along `direction`.
    pub(super) fn normal_facing(&self, direction: Vec3) -> Vec3 {
        if self.normal.dot(direction) > 0.0 {
            -self.normal
        } else {
            self.normal
        }
    }
}

/// The pixels of a packet whose rays passed a surface.
struct TransmittedLanes {
    count: usize,
    lanes: [TransmittedPixel; LANES],
}

impl TransmittedLanes {
    const NONE: Self = Self {
        count: 0,
        lanes: [TransmittedPixel {
            lane: 0,
            light: Vec3::ZERO,
            rest: 0.0,
            from: 0.0,
        }; LANES],
    };

    fn push(&mut self, open: TransmittedPixel) {
        self.lanes[self.count] = open;
        self.count += 1;
    }

    fn all(&self) -> &[TransmittedPixel] {
        &self.lanes[..self.count]
    }
}

/// Number of light sources of each pixel that get a shadow ray.
const SHADOW_RAYS: usize = 2;

/// A surface that a pixel sees, whose shadows are not yet known.
#[derive(Clone, Copy)]
pub(super) struct UnshadowedPixel {
    lane: usize,
    /// Opacity: the share of what lies behind it that it hides.
    opacity: f32,
    /// The light that it sends to the camera.
    pub(super) incoming: IncidentLight<SHADOW_RAYS>,
    /// The end of its shadow rays.
    pub(super) ray_end: Vec3,
    /// Normal of the flat triangle towards the viewer.
    pub(super) flat_normal: Vec3,
    /// Depth behind it from which a ray goes on, m.
    from: f32,
}

impl UnshadowedPixel {
    const NONE: Self = Self {
        lane: 0,
        opacity: 1.0,
        incoming: IncidentLight::NONE,
        ray_end: Vec3::ZERO,
        flat_normal: Vec3::ZERO,
        from: 0.0,
    };
}

/// The light that a surface sends to the camera.
struct OutgoingLight {
    incoming: IncidentLight<SHADOW_RAYS>,
    /// Opacity: the share of what lies behind it that it hides.
    opacity: f32,
    off: Vec3,
    facing: Vec3,
}

impl OutgoingLight {
    fn plain(light: Vec3, opacity: f32) -> Self {
        Self {
            incoming: IncidentLight::unshadowed(light),
            opacity,
            off: Vec3::ZERO,
            facing: Vec3::ZERO,
        }
    }
}

/// Memory for many packets.
pub(super) struct ShadeScratch {
    pub(super) bytes: [[u8; 3]; LANES],
    pending: [UnshadowedPixel; LANES],
    open: TransmittedLanes,
    next: TransmittedLanes,
}

impl ShadeScratch {
    pub(super) fn new() -> Self {
        Self {
            bytes: [[0; 3]; LANES],
            pending: [UnshadowedPixel::NONE; LANES],
            open: TransmittedLanes::NONE,
            next: TransmittedLanes::NONE,
        }
    }
}

impl CpuRenderer {
    /// Returns the surface at a hit, without light.
    pub(super) fn surface_at_hit<'a>(
        &'a self,
        rays: &CameraRayGenerator,
        posed: (&'a RayScene, &'a State),
        sight: &PrimaryHit,
    ) -> ShadedSurface<'a> {
        let position = self
            .triangle_table
            .table_index(sight.instance, sight.triangle);
        self.surface_at_point(rays, posed, sight, position)
    }

    #[inline]
    pub(super) fn surface_at_point<'a>(
        &'a self,
        rays: &CameraRayGenerator,
        posed: (&'a RayScene, &'a State),
        sight: &PrimaryHit,
        position: usize,
    ) -> ShadedSurface<'a> {
        let triangle = self.triangle_table.triangle(position);
        let look = &self.shading_materials[triangle.material as usize];
        let mut color = Vec3::from_array(look.base);
        let mut opacity = look.opacity;
        let &PrimaryHit {
            point,
            direction,
            depth,
            ..
        } = sight;
        let pose = self.triangle_table.pose(sight.instance, posed);
        if let Some(piece) = sight.instance.and_then(|piece| posed.0.person_piece(piece)) {
            color = SrgbTables::tables().decode3(piece.srgb);
        }
        let standing = triangle.posed(pose);
        let normal = standing.normal;
        if let Some(texture) = look.texture() {
            let (fixed, growing) = rays.pixel_area;
            let area = (fixed + growing * depth * depth) * sight.depth_per_length;
            let uv = standing.uv(point);
            let sample = if rays.is_flat_preset() {
                let slope = normal.dot(direction).abs().max(MIN_FOOTPRINT_COSINE);
                let texels = area / slope * (triangle.texture_density * look.texel_count);
                self.textures.sample(texture, uv, texels)
            } else {
                let size = self.textures.image(texture).size();
                let footprint = TextureFootprint::new(&standing, direction, area.sqrt(), size);
                footprint.sample(&self.textures, texture, uv)
            };
            color *= sample.truncate();
            opacity *= sample.w;
        }
        ShadedSurface {
            material: look,
            color,
            opacity,
            normal,
            pose,
        }
    }

    /// Of the flat triangle and, interpolated between its corners, of the surface that it stands for, both towards the viewer.
    #[inline]
    pub(super) fn geometric_and_shading_normals(
        &self,
        skin: &ShadedSurface<'_>,
        sight: &PrimaryHit,
        position: usize,
        (u, v): (f32, f32),
    ) -> (Vec3, Vec3) {
        let facing = skin.normal_facing(sight.direction);
        let smooth = self.triangle_table.smooth_normal(position, u, v);
        let smooth = skin
            .pose
            .map_or(smooth, |pose| pose.rotation * smooth)
            .normalize_or(facing);
        let smooth = if smooth.dot(facing) < 0.0 {
            -smooth
        } else {
            smooth
        };
        (facing, smooth)
    }
}

impl ImageBand<'_> {
    /// sRGB of the first `columns` by `rows` pixels of a packet, which afterwards no longer knows what they see first.
    pub(super) fn colors(
        &self,
        renderer: &CpuRenderer,
        packet: &mut CameraRayPacket,
        (columns, rows): (usize, usize),
        palette: &mut ShadeScratch,
    ) {
        palette.open.count = 0;
        let mut lanes = 0_u64;
        for row in 0..rows {
            lanes |= ((1 << columns) - 1) << (row * PACKET_COLUMNS);
        }
        if self.light.is_none() {
            lanes = self.color_opaque_pixels(renderer, packet, lanes, &mut palette.bytes);
        }
        let mut count = 0;
        for lane in set_bit_positions(lanes) {
            match self.color(renderer, packet, lane) {
                Ok(bytes) => palette.bytes[lane] = bytes,
                Err(pending) => {
                    palette.pending[count] = pending;
                    count += 1;
                }
            }
        }
        let pending = &mut palette.pending[..count];
        if let Some((lighting, _)) = self.light {
            renderer.add_unoccluded_light(self.scene, lighting, pending);
        }
        for one in pending {
            let (lane, light, opacity) = (one.lane, one.incoming.light, one.opacity);
            palette.bytes[lane] = self.tone_mapped_srgb(light);
            if opacity < OPAQUE_THRESHOLD {
                palette.open.push(TransmittedPixel {
                    lane,
                    light: light * opacity,
                    rest: 1.0 - opacity,
                    from: one.from,
                });
            }
        }
        if palette.open.count > 0 {
            self.composite_transmitted(renderer, packet, palette);
        }
    }

    /// sRGB of a pixel that sees nothing or a plain colour; of others the surface.
    #[inline]
    fn color(
        &self,
        renderer: &CpuRenderer,
        packet: &CameraRayPacket,
        lane: usize,
    ) -> Result<[u8; 3], UnshadowedPixel> {
        let Some(sight) = packet.closest_hit(lane) else {
            let direction = packet.direction(lane);
            if direction == Vec3::ZERO {
                return Ok([0; 3]);
            }
            return Ok(self.tone_mapped_srgb(self.sky(renderer, direction)));
        };
        let position = renderer
            .triangle_table
            .table_index(sight.instance, sight.triangle);
        let sent = self.surface(renderer, &sight, position, MAX_MIRROR_BOUNCES, || {
            packet.barycentric_weights(self.scene, lane)
        });
        if self.light.is_none() && sent.opacity >= OPAQUE_THRESHOLD {
            return Ok(self.tone_mapped_srgb(sent.incoming.light));
        }
        Err(UnshadowedPixel {
            lane,
            opacity: sent.opacity,
            incoming: sent.incoming,
            ray_end: sent.off,
            flat_normal: sent.facing,
            from: sight.depth * (1.0 + CONTINUATION_OFFSET.1) + CONTINUATION_OFFSET.0,
        })
    }

    /// All that is seen through surfaces, front to back.
    #[cold]
    fn composite_transmitted(
        &self,
        renderer: &CpuRenderer,
        packet: &mut CameraRayPacket,
        palette: &mut ShadeScratch,
    ) {
        let bytes = &mut palette.bytes;
        let (mut open, mut next) = (&mut palette.open, &mut palette.next);
        for layer in 1..=MAX_TRANSPARENT_LAYERS {
            let ways = open.all().iter().map(|open| (open.lane, open.from));
            packet.continue_behind(&self.rays, self.scene, ways);
            next.count = 0;
            for &TransmittedPixel {
                lane, light, rest, ..
            } in open.all()
            {
                let Some(sight) = packet.closest_hit(lane) else {
                    bytes[lane] = self.tone_mapped_srgb(
                        light + self.sky(renderer, packet.direction(lane)) * rest,
                    );
                    continue;
                };
                let position = renderer
                    .triangle_table
                    .table_index(sight.instance, sight.triangle);
                let sent = self.surface(renderer, &sight, position, MAX_MIRROR_BOUNCES, || {
                    packet.barycentric_weights(self.scene, lane)
                });
                let (more, opacity) = self.shadowed_radiance(renderer, &sent);
                if opacity >= OPAQUE_THRESHOLD || layer == MAX_TRANSPARENT_LAYERS {
                    bytes[lane] = self.tone_mapped_srgb(light + more * rest);
                    continue;
                }
                next.push(TransmittedPixel {
                    lane,
                    light: light + more * (opacity * rest),
                    rest: rest * (1.0 - opacity),
                    from: sight.depth * (1.0 + CONTINUATION_OFFSET.1) + CONTINUATION_OFFSET.0,
                });
            }
            if next.count == 0 {
                return;
            }
            std::mem::swap(&mut open, &mut next);
        }
    }

    /// Radiance where nothing is hit.
    fn sky(&self, renderer: &CpuRenderer, direction: Vec3) -> Vec3 {
        let light = self
            .light
            .map(|(_, exposure)| (renderer.static_lighting(), exposure));
        exposed_background_luminance(direction, light)
    }

    #[inline]
    pub(super) fn tone_mapped_srgb(&self, light: Vec3) -> [u8; 3] {
        let shown = if self.light.is_some() {
            tone_map(light)
        } else {
            light
        };
        SrgbTables::tables().encode3(shown.to_array())
    }

    /// The light that a surface sends to the camera, and its opacity, once its shadows are known.
    fn shadowed_radiance(&self, renderer: &CpuRenderer, sent: &OutgoingLight) -> (Vec3, f32) {
        let light = self.light.map_or(sent.incoming.light, |(lighting, _)| {
            sent.incoming.total_arriving(|source| {
                renderer.is_source_unoccluded(self.scene, lighting, source, (sent.off, sent.facing))
            })
        });
        (light, sent.opacity)
    }

    /// Returns the light that a surface sends to the camera.
    ///
    /// `mirrors`: how many more of them the ray may meet. `weights`: of the second and third corner.
    #[inline]
    fn surface(
        &self,
        renderer: &CpuRenderer,
        sight: &PrimaryHit,
        position: usize,
        mirrors: u32,
        weights: impl FnOnce() -> (f32, f32),
    ) -> OutgoingLight {
        let skin = renderer.surface_at_point(&self.rays, self.scene_and_state(), sight, position);
        let &PrimaryHit {
            point, direction, ..
        } = sight;
        let Some((lighting, exposure)) = &self.light else {
            return OutgoingLight::plain(skin.color, skin.opacity);
        };
        if skin.material.mirror && mirrors > 0 {
            let facing = skin.normal_facing(direction);
            let light = self.reflected(renderer, sight, facing, mirrors - 1);
            return OutgoingLight::plain(skin.color * light, skin.opacity);
        }
        let (facing, smooth) =
            renderer.geometric_and_shading_normals(&skin, sight, position, weights());
        let site = ShadingPoint {
            point,
            normal: smooth,
            room_lookup_point: room_lookup_point(point, facing, direction),
            entity: sight.id,
        };
        let incoming = lighting.incident_light(renderer.static_lighting(), *exposure, &site);
        let mut incoming = incoming.reflected_by(skin.color);
        incoming.light += self.emitted_light(renderer, skin.material.emission, sight.id);
        OutgoingLight {
            incoming,
            opacity: skin.opacity,
            off: point + facing * SHADOW_RAY_OFFSET_M,
            facing,
        }
    }

    /// Returns the radiance that a mirror reflects: from where the ray goes on.
    #[cold]
    fn reflected(
        &self,
        renderer: &CpuRenderer,
        mirror: &PrimaryHit,
        facing: Vec3,
        mirrors: u32,
    ) -> Vec3 {
        let direction = mirror.direction.reflect(facing).normalize_or(facing);
        let mut ray = Ray {
            origin: mirror.point + facing * SHADOW_RAY_OFFSET_M,
            direction,
            near_m: 0.0,
            far_m: f32::INFINITY,
        };
        let (mut light, mut rest) = (Vec3::ZERO, 1.0);
        for layer in 1..=MAX_TRANSPARENT_LAYERS {
            let Some(hit) = self.scene.closest(&ray, VISIBLE_MASK) else {
                break;
            };
            let distance = hit.distance_m;
            let sight = PrimaryHit {
                point: ray.origin + direction * distance,
                direction,
                // Patterns in a mirror are as fine as if they stood behind it.
                depth: mirror.depth + distance * mirror.depth_per_length,
                depth_per_length: mirror.depth_per_length,
                id: hit.id,
                instance: hit.instance,
                triangle: hit.triangle,
            };
            let position = renderer
                .triangle_table
                .table_index(hit.instance, hit.triangle);
            let sent = self.surface(renderer, &sight, position, mirrors, || (hit.u, hit.v));
            let (more, opacity) = self.shadowed_radiance(renderer, &sent);
            if opacity >= OPAQUE_THRESHOLD || layer == MAX_TRANSPARENT_LAYERS {
                return light + more * rest;
            }
            light += more * (opacity * rest);
            rest *= 1.0 - opacity;
            ray.near_m = distance * (1.0 + CONTINUATION_OFFSET.1) + CONTINUATION_OFFSET.0;
        }
        light + self.sky(renderer, direction) * rest
    }

    /// Light of its own, unless it is switched off.
    pub(super) fn emitted_light(
        &self,
        renderer: &CpuRenderer,
        emission: [f32; 3],
        entity: i32,
    ) -> Vec3 {
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
