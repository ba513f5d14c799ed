//! Packets on several instruction levels; see [`crate::simd_dispatch`].

use super::super::packet::RayPacket;
use super::super::scene::SceneBvh;
use super::HitFilter;
use super::scene_packet::{closest, occluded};
use super::tree_packet::PacketClosestHits;
use crate::simd_dispatch::SimdKernel;

/// Offers all hits that may matter to the results.
pub(in super::super) struct ClosestPacketQuery<'a, 'b, const N: usize> {
    pub(in super::super) scene: &'a SceneBvh<'b>,
    pub(in super::super) rays: &'a RayPacket<N>,
    pub(in super::super) filter: &'a HitFilter,
    pub(in super::super) hits: &'a mut PacketClosestHits<N>,
}

impl<const N: usize> SimdKernel for ClosestPacketQuery<'_, '_, N> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        closest(self.scene, self.rays, self.filter, self.hits);
    }
}

/// The rays that hit anything, as bits.
pub(in super::super) struct OccludedPacketQuery<'a, 'b, const N: usize> {
    pub(in super::super) scene: &'a SceneBvh<'b>,
    pub(in super::super) rays: &'a RayPacket<N>,
    pub(in super::super) filter: &'a HitFilter,
}

impl<const N: usize> SimdKernel for OccludedPacketQuery<'_, '_, N> {
    type Output = u64;

    #[inline(always)]
    fn run(self) -> u64 {
        occluded(self.scene, self.rays, self.filter)
    }
}

#[cfg(test)]
mod tests {
    use super::super::closest_hit::{ClosestHit, HitTriangle};
    use super::super::scene_ray::{AnyHitVisitor, ClosestHitVisitor, SceneRayQuery};
    use super::*;
    use crate::bvh::{Instance, InstanceSet, PacketHits, RayMask, TriangleAttributes, TriangleBvh};
    use crate::random::{RandomKey, RandomStream};
    use crate::simd_dispatch::SimdLevel;
    use glam::{Affine3A, Quat, Vec3};
    use std::sync::Arc;

    fn scraps(stream: &mut RandomStream, count: usize, size_m: f32) -> TriangleBvh {
        let mut corner = || stream.direction() * stream.uniform_f32();
        let middles: Vec<Vec3> = (0..count).map(|_| corner()).collect();
        let positions: Vec<Vec3> = middles
            .iter()
            .flat_map(|middle| [*middle; 3])
            .map(|middle| middle + corner() * size_m)
            .collect();
        let triangles: Vec<[u32; 3]> = (0..count as u32)
            .map(|k| [3 * k, 3 * k + 1, 3 * k + 2])
            .collect();
        TriangleBvh::build_tagged(&positions, &triangles, |k| {
            TriangleAttributes::new(1 + k as i32 % 9)
        })
    }

    fn same_on_all_levels<const N: usize>(scene: &SceneBvh<'_>, key: RandomKey) -> usize {
        let mut stream = key.stream();
        let mut met = 0;
        for round in 0..200 {
            let mut rays = RayPacket::<N>::new(stream.direction() * 2.0);
            let ahead = stream.direction() * 0.5 - rays.origin;
            let spread = [0.01, 0.1, 1.0, 5.0][round % 4];
            for k in 0..N {
                let direction = (ahead + stream.direction() * spread).normalize_or_zero();
                rays.set(k, direction, 0.0, stream.range(0.5, 9.0));
            }
            let filter = HitFilter::new(RayMask::ALL, Some(3));
            let answer = |level: SimdLevel| {
                let mut hits = PacketHits::<N>::new();
                scene.closest_packet_with_simd(level, &rays, &filter, &mut hits);
                let blocked = level.run(OccludedPacketQuery {
                    scene,
                    rays: &rays,
                    filter: &filter,
                });
                // Each ray alone gives the same.
                for k in 0..N {
                    let ray = &rays.ray(k);
                    let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
                    let claim = |place| scene.tie_break(origin, direction, place);
                    let mut nearest = ClosestHit::new(ray.far_m);
                    let filter = &filter;
                    let hits_of_one = &mut ClosestHitVisitor {
                        nearest: &mut nearest,
                        tie_break: claim,
                    };
                    level.run(SceneRayQuery {
                        scene,
                        ray,
                        filter,
                        hits: hits_of_one,
                    });
                    let met = level.run(SceneRayQuery {
                        scene,
                        ray,
                        filter,
                        hits: &mut AnyHitVisitor,
                    });
                    assert_eq!(met, blocked >> k & 1 == 1);
                    assert_eq!(nearest.closest != HitTriangle::NONE, hits.is_hit(k));
                    if hits.is_hit(k) && !nearest.is_ambiguous() {
                        let found = (nearest.closest.source, nearest.closest.slot);
                        assert_eq!(found, (hits.source[k], hits.slot[k]));
                        assert_eq!(nearest.distance.to_bits(), hits.distance_m[k].to_bits());
                    }
                }
                (hits, blocked)
            };
            let (hits, blocked) = answer(SimdLevel::Portable);
            met += blocked.count_ones() as usize;
            for level in SimdLevel::available() {
                let other = answer(level);
                assert_eq!(
                    hits.distance_m.map(f32::to_bits),
                    other.0.distance_m.map(f32::to_bits)
                );
                assert_eq!(
                    (hits.id, hits.triangle, hits.source, blocked),
                    (other.0.id, other.0.triangle, other.0.source, other.1)
                );
            }
        }
        met
    }

    #[test]
    fn all_instruction_levels_give_the_same_bits() {
        let key = RandomKey::root(5);
        let mut stream = key.stream();
        let fixed = scraps(&mut stream, 2000, 0.1);
        let instances = (0..6).map(|k| Instance {
            mesh: Arc::new(scraps(&mut stream, 300, 0.2)),
            world_from_mesh: Affine3A::from_scale_rotation_translation(
                Vec3::splat(0.5),
                Quat::from_rotation_y(k as f32),
                Vec3::new(0.3, 0.1 * k as f32, 0.0),
            ),
            id: 20 + k,
            mask: RayMask::ALL,
        });
        let moving = InstanceSet::new(instances);
        let scene = SceneBvh {
            fixed: &fixed,
            moving: &moving,
        };
        assert!(same_on_all_levels::<8>(&scene, key.child("8")) > 300);
        assert!(same_on_all_levels::<16>(&scene, key.child("16")) > 600);
        assert!(same_on_all_levels::<32>(&scene, key.child("32")) > 1200);
        for level in SimdLevel::available() {
            println!("tested on {level:?}");
        }
    }
}
