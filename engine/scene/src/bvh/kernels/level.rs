//! Packets on several instruction levels: the same code, compiled for wider registers. No level has instructions that round
//! differently (nothing here is fused), so all give the same bits.

#![expect(
    unsafe_code,
    reason = "calling a function compiled for instructions that a check has found needs it"
)]

use super::super::packet::RayPacket;
use super::super::scene::SceneBvh;
use super::Filter;
use super::everything::{closest, occluded};
use super::packet::Answers;

/// An instruction level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Level {
    /// What every machine of the kind has; SSE2 on x86-64.
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2(Checked),
    #[cfg(target_arch = "x86_64")]
    Avx512(Checked),
}

/// Proof that the machine was found to have a level's instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) struct Checked(());

impl Level {
    /// Every level that this machine has, the best last.
    #[cfg(target_arch = "x86_64")]
    pub(in super::super) fn available() -> impl Iterator<Item = Self> {
        let avx2 = is_x86_feature_detected!("avx2");
        let avx512 = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512bw");
        let levels = [
            Some(Self::Portable),
            avx2.then_some(Self::Avx2(Checked(()))),
            avx512.then_some(Self::Avx512(Checked(()))),
        ];
        levels.into_iter().flatten()
    }

    /// Every level that this machine has, the best last.
    #[cfg(not(target_arch = "x86_64"))]
    pub(in super::super) fn available() -> impl Iterator<Item = Self> {
        std::iter::once(Self::Portable)
    }

    /// The best level that this machine has.
    #[inline]
    pub(in super::super) fn best() -> Self {
        static BEST: std::sync::OnceLock<Level> = std::sync::OnceLock::new();
        *BEST.get_or_init(|| Self::available().last().unwrap_or(Self::Portable))
    }

    /// Offers all hits that may matter to the answers.
    #[inline]
    pub(in super::super) fn closest<const N: usize>(
        self,
        scene: &SceneBvh<'_>,
        rays: &RayPacket<N>,
        filter: &Filter,
        answers: &mut Answers<N>,
    ) {
        match self {
            Self::Portable => closest(scene, rays, filter, answers),
            // SAFETY: `Checked` is made by `available` alone, after it found AVX2.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => unsafe { closest_avx2(scene, rays, filter, answers) },
            // SAFETY: `Checked` is made by `available` alone, after it found AVX-512 F, VL, DQ and BW.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => unsafe { closest_avx512(scene, rays, filter, answers) },
        }
    }

    /// Which rays meet anything, as bits.
    #[inline]
    pub(in super::super) fn occluded<const N: usize>(
        self,
        scene: &SceneBvh<'_>,
        rays: &RayPacket<N>,
        filter: &Filter,
    ) -> u64 {
        match self {
            Self::Portable => occluded(scene, rays, filter),
            // SAFETY: `Checked` is made by `available` alone, after it found AVX2.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => unsafe { occluded_avx2(scene, rays, filter) },
            // SAFETY: `Checked` is made by `available` alone, after it found AVX-512 F, VL, DQ and BW.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => unsafe { occluded_avx512(scene, rays, filter) },
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn closest_avx2<const N: usize>(
    s: &SceneBvh<'_>,
    rays: &RayPacket<N>,
    filter: &Filter,
    answers: &mut Answers<N>,
) {
    closest(s, rays, filter, answers);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
fn closest_avx512<const N: usize>(
    s: &SceneBvh<'_>,
    rays: &RayPacket<N>,
    filter: &Filter,
    answers: &mut Answers<N>,
) {
    closest(s, rays, filter, answers);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn occluded_avx2<const N: usize>(
    scene: &SceneBvh<'_>,
    rays: &RayPacket<N>,
    filter: &Filter,
) -> u64 {
    occluded(scene, rays, filter)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
fn occluded_avx512<const N: usize>(
    scene: &SceneBvh<'_>,
    rays: &RayPacket<N>,
    filter: &Filter,
) -> u64 {
    occluded(scene, rays, filter)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::{Instance, InstanceSet, PacketHits, RayMask, TriangleBvh, TriangleTag};
    use crate::random::{Key, Stream};
    use glam::{Affine3A, Quat, Vec3};
    use std::sync::Arc;

    fn scraps(stream: &mut Stream, count: usize, size_m: f32) -> TriangleBvh {
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
            TriangleTag::new(1 + k as i32 % 9)
        })
    }

    fn same_on_all_levels<const N: usize>(scene: &SceneBvh<'_>, key: Key) -> usize {
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
            let filter = Filter::new(RayMask::ALL, Some(3));
            let answer = |level: Level| {
                let mut hits = PacketHits::<N>::new();
                scene.closest_packet_at(level, &rays, &filter, &mut hits);
                let blocked = level.occluded(scene, &rays, &filter);
                (hits, blocked)
            };
            let (hits, blocked) = answer(Level::Portable);
            met += blocked.count_ones() as usize;
            for level in Level::available() {
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
        let key = Key::root(5);
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
        for level in Level::available() {
            println!("tested on {level:?}");
        }
    }
}
