//! The colours of many pixels of a flat picture side by side: those that see one triangle together.

#![expect(
    clippy::inline_always,
    reason = "what is not inline does not use the wider instructions of the function around it"
)]
#![expect(
    clippy::needless_range_loop,
    reason = "plain loops over lanes without branches are what becomes vector instructions"
)]

use super::CpuRenderer;
use super::camera_rays::{CameraRayPacket, LANES, RayPacketHits};
use super::tile::ImageBand;
use crate::color::SrgbTables;
use crate::texture::{BilinearTaps, MipImage, mip_level};
use crate::texture_filter::MIN_FOOTPRINT_COSINE;
use crate::triangle_table::{NEEDS_SHADING, PosedTriangleShading, coordinate};
use dwell_scene::simd_dispatch::{SimdKernel, SimdLevel};
use glam::Vec3;

/// Number of pixels below which they are quicker one by one.
const FEW: u32 = 4;

/// The positions of the bits that are set, the lowest first.
#[inline]
pub(super) fn set_bit_positions(mut set: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = set.trailing_zeros() as usize;
        set &= set.wrapping_sub(1);
        (lane < 64).then_some(lane)
    })
}

/// The texels and weights from which the pixels of a packet take their colour. Shapes (lane,) and (corner, lane).
#[repr(C, align(64))]
#[derive(Debug, PartialEq)]
struct TexelLookups {
    level: [u32; LANES],
    texels: [[u32; LANES]; 4],
    weights: [[f32; LANES]; 2],
}

/// Locates the texels of pixels that see one triangle.
struct TexelLocator<'a> {
    seen: RayPacketHits<'a>,
    standing: &'a PosedTriangleShading,
    image: &'a MipImage,
    /// Texels of the largest level for each m² of the triangle.
    density: f32,
    /// See [`crate::camera::Camera::pixel_area`].
    pixel_area: (f32, f32),
}

impl SimdKernel for TexelLocator<'_> {
    type Output = TexelLookups;

    #[inline(always)]
    fn run(self) -> TexelLookups {
        let RayPacketHits {
            rays,
            hits,
            depth_per_length: per_length,
        } = self.seen;
        let [x, y, z] = &rays.direction;
        let PosedTriangleShading { uv, normal } = self.standing;
        let (start, (fixed, growing)) = (rays.origin, self.pixel_area);
        let mut places = TexelLookups {
            level: [0; LANES],
            texels: [[0; LANES]; 4],
            weights: [[0.0; LANES]; 2],
        };
        // As `skin_at` does for one pixel, in the same order.
        for k in 0..LANES {
            let distance = hits.distance_m[k];
            let slope = (normal.x * x[k] + normal.y * y[k]) + normal.z * z[k];
            let slope = slope.abs();
            let slope = if slope > MIN_FOOTPRINT_COSINE {
                slope
            } else {
                MIN_FOOTPRINT_COSINE
            };
            let depth = distance * per_length[k];
            let area = (fixed + growing * depth * depth) * per_length[k] / slope;
            let level = mip_level(area * self.density).min(self.image.last_level);
            let (px, py, pz) = (
                start.x + x[k] * distance,
                start.y + y[k] * distance,
                start.z + z[k] * distance,
            );
            let (u, v) = (
                coordinate(&uv[0], px, py, pz),
                coordinate(&uv[1], px, py, pz),
            );
            let BilinearTaps { texels, weights } = self.image.bilinear_taps(level, u, v);
            places.level[k] = level;
            for corner in 0..4 {
                places.texels[corner][k] = texels[corner];
            }
            for axis in 0..2 {
                places.weights[axis][k] = weights[axis];
            }
        }
        places
    }
}

impl ImageBand<'_> {
    /// Colours the pixels, of those in `lanes`, that see nothing or something opaque; returns the others.
    pub(super) fn color_opaque_pixels(
        &self,
        renderer: &CpuRenderer,
        packet: &CameraRayPacket,
        mut lanes: u64,
        bytes: &mut [[u8; 3]; LANES],
    ) -> u64 {
        let Some(seen) = packet.ray_packet_hits() else {
            return lanes;
        };
        let mut others = 0;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize;
            if !seen.hits.is_hit(lane) {
                others |= 1 << lane;
                lanes &= lanes - 1;
                continue;
            }
            let same = seen.hits.same_triangle_mask(lane) & lanes;
            lanes &= !same;
            let (instance, triangle) = (seen.hits.instance(lane), seen.hits.triangle[lane]);
            let position = renderer.triangle_table.table_index(instance, triangle);
            let [r, g, b, kind] = renderer.triangle_table.uniform_color(position);
            if kind != NEEDS_SHADING {
                for lane in set_bit_positions(same) {
                    bytes[lane] = [r, g, b];
                }
                continue;
            }
            let triangle = renderer.triangle_table.triangle(position);
            let look = &renderer.shading_materials[triangle.material as usize];
            let Some(texture) = look.texture().filter(|_| !look.transmits_light) else {
                others |= same;
                continue;
            };
            if same.count_ones() < FEW {
                others |= same;
                continue;
            }
            let pose = renderer
                .triangle_table
                .pose(instance, self.scene_and_state());
            let image = renderer.textures.image(texture);
            let places = SimdLevel::best_available().run(TexelLocator {
                seen,
                standing: &triangle.posed(pose),
                image,
                density: triangle.texture_density * look.texel_count,
                pixel_area: self.rays.pixel_area,
            });
            let base = Vec3::from_array(look.base).extend(1.0);
            let srgb = SrgbTables::tables();
            for lane in set_bit_positions(same) {
                let corners = BilinearTaps {
                    texels: std::array::from_fn(|corner| places.texels[corner][lane]),
                    weights: std::array::from_fn(|axis| places.weights[axis][lane]),
                };
                let color = renderer
                    .textures
                    .bilinear(image, places.level[lane], corners)
                    * base;
                bytes[lane] = srgb.encode_vec(color);
            }
        }
        others
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::Textures;
    use crate::triangle_table::coordinate;
    use dwell_scene::bvh::{InstanceSet, PacketHits, RayPacket, SceneBvh, TriangleBvh};
    use dwell_scene::random::RandomKey;
    use dwell_scene::{House, HouseData, Texture};
    use glam::Vec4;
    use std::sync::Arc;

    /// Images of these sizes, all grey.
    fn textures(sizes: &[(u32, u32)]) -> Textures {
        let mut data = HouseData::default();
        for (k, (width, height)) in sizes.iter().enumerate() {
            let bytes = (0..width * height * 4).map(|byte| (byte % 251) as u8);
            let name = format!("t{k}");
            let texture = Texture::new(name, *width, *height, bytes.collect());
            data.textures.push(Arc::new(texture));
        }
        Textures::new(&House::new(data).unwrap()).unwrap()
    }

    #[test]
    fn all_instruction_levels_find_the_texels_that_one_pixel_finds() {
        let all = textures(&[(64, 64), (7, 3), (1, 5), (300, 17)]);
        let mut stream = RandomKey::root(12).stream();
        let wall = [[-9.0, -9.0, 0.0], [30.0, -9.0, 0.0], [-9.0, 30.0, 0.0]].map(Vec3::from_array);
        let wall = TriangleBvh::build(&wall, &[[0, 1, 2]]);
        let scene = SceneBvh {
            fixed: &wall,
            moving: &InstanceSet::default(),
        };
        let mut levels = [0; 16];
        for round in 0..400 {
            let eye = Vec3::new(0.0, 0.0, stream.range(0.01, 5.0));
            let mut rays = RayPacket::<LANES>::new(eye);
            let mut per_length = [0.0; LANES];
            for k in 0..LANES {
                let towards = stream.direction() - Vec3::Z * 1.5;
                rays.set(k, towards.normalize_or_zero(), 0.0, 40.0);
                per_length[k] = stream.range(0.4, 1.0);
            }
            let mut hits = PacketHits::new();
            let seen = super::super::camera_rays::VISIBLE_MASK;
            scene.closest_packet(&rays, seen, None, &mut hits);
            let row = |stream: &mut dwell_scene::random::RandomStream| {
                (stream.direction() * stream.range(0.01, 9.0)).extend(stream.range(-2.0, 2.0))
            };
            let uv: [Vec4; 2] = [row(&mut stream), row(&mut stream)];
            let normal = stream.direction();
            let image = all.image(round % 4);
            let density = stream.range(0.0, 90_000.0);
            let (fixed, growing) = (0.0, 1.0 / 64.0_f32.powi(2));
            let places = |level: SimdLevel| {
                level.run(TexelLocator {
                    seen: RayPacketHits {
                        rays: &rays,
                        hits: &hits,
                        depth_per_length: &per_length,
                    },
                    standing: &PosedTriangleShading { uv, normal },
                    image,
                    density,
                    pixel_area: (fixed, growing),
                })
            };
            let found = places(SimdLevel::Portable);
            for level in SimdLevel::available() {
                assert_eq!(found, places(level), "{level:?}");
            }
            for k in (0..LANES).filter(|k| hits.is_hit(*k)) {
                let Vec3 { x, y, z } = eye + rays.ray(k).direction * hits.distance_m[k];
                let depth = hits.distance_m[k] * per_length[k];
                let slope = normal
                    .dot(rays.ray(k).direction)
                    .abs()
                    .max(MIN_FOOTPRINT_COSINE);
                let area = (fixed + growing * depth * depth) * per_length[k] / slope;
                let level = mip_level(area * density).min(image.last_level);
                let [u, v] = uv.map(|row| coordinate(&row, x, y, z));
                let BilinearTaps { texels, weights } = image.bilinear_taps(level, u, v);
                assert_eq!(found.level[k], level);
                assert_eq!(found.texels.map(|corner| corner[k]), texels);
                assert_eq!(found.weights.map(|axis| axis[k]), weights);
                levels[level as usize] += 1;
            }
        }
        // Images of several sizes have several levels, and all are seen.
        assert!(levels[..7].iter().all(|count| *count > 20), "{levels:?}");
    }
}
