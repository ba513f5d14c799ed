//! Ray queries on static geometry and moving instances.

use super::instances::InstanceSet;
use super::kernels::closest_hit::{ClosestHit, HitTriangle, TieBreak, coincidence_min_distance};
use super::kernels::dispatch::{ClosestPacketQuery, OccludedPacketQuery};
use super::kernels::scene_ray::{AllHitsVisitor, AnyHitVisitor, ClosestHitVisitor, SceneRayQuery};
use super::kernels::tree_ray::HitVisitor;
use super::kernels::triangle::{EdgePlanes, barycentric_weights, dot, plane_distance};
use super::kernels::{HitFilter, tree_packet};
use super::packet::{PacketHits, RayPacket};
use super::ray::{Hit, Ray, RayMask};
use super::triangles::TriangleBvh;
use crate::simd_dispatch::SimdLevel;

/// The geometry of a world for ray queries; a pair of references, cheap to make and copy.
///
/// Results depend on the set of surfaces alone, bit for bit: not on the order in which they are stored, nor on the kernel.
/// Of surfaces that coincide (see [`Hit::id`]) the lowest id counts, then static geometry, then the lower instance, then
/// the lower triangle.
#[derive(Clone, Copy, Debug)]
pub struct SceneBvh<'a> {
    /// The static triangles.
    pub fixed: &'a TriangleBvh,
    /// The moving instances.
    pub moving: &'a InstanceSet,
}

/// A ray in the space of one mesh.
struct LocalRay<'a> {
    bvh: &'a TriangleBvh,
    origin: [f32; 3],
    direction: [f32; 3],
    /// The instance's id.
    id: Option<i32>,
}

impl SceneBvh<'_> {
    /// Returns the nearest surface on a ray whose mask meets `mask`.
    pub fn closest(&self, ray: &Ray, mask: RayMask) -> Option<Hit> {
        self.closest_filtered(ray, &HitFilter::new(mask, None))
    }

    /// As [`Self::closest`], ignoring the id `hidden`.
    pub fn closest_excluding(&self, ray: &Ray, mask: RayMask, hidden: i32) -> Option<Hit> {
        self.closest_filtered(ray, &HitFilter::new(mask, Some(hidden)))
    }

    /// Returns whether a surface whose mask meets `mask` lies on the ray.
    pub fn occluded(&self, ray: &Ray, mask: RayMask) -> bool {
        self.occluded_filtered(ray, &HitFilter::new(mask, None))
    }

    /// As [`Self::occluded`], ignoring the id `hidden`.
    pub fn occluded_excluding(&self, ray: &Ray, mask: RayMask, hidden: i32) -> bool {
        self.occluded_filtered(ray, &HitFilter::new(mask, Some(hidden)))
    }

    /// Finds every surface on the ray whose mask meets `mask`, by distance, then id, instance and triangle. `hits` is cleared first.
    pub fn all_hits(&self, ray: &Ray, mask: RayMask, hits: &mut Vec<Hit>) {
        hits.clear();
        if !ray.is_usable() {
            return;
        }
        let mut every = AllHitsVisitor(|place, distance| hits.push(self.hit(ray, place, distance)));
        self.visit_hits(ray, &HitFilter::new(mask, None), &mut every);
        hits.sort_by(|a, b| {
            let rest = |hit: &Hit| (hit.id, hit.instance, hit.triangle);
            a.distance_m
                .total_cmp(&b.distance_m)
                .then(rest(a).cmp(&rest(b)))
        });
    }

    /// Finds the nearest surfaces on the rays of a packet; the same bits as [`Self::closest`] for each.
    ///
    /// `hidden`: an id to ignore.
    pub fn closest_packet<const N: usize>(
        &self,
        rays: &RayPacket<N>,
        mask: RayMask,
        hidden: Option<i32>,
        hits: &mut PacketHits<N>,
    ) {
        self.closest_packet_with_simd(
            SimdLevel::best_available(),
            rays,
            &HitFilter::new(mask, hidden),
            hits,
        );
    }

    /// Returns the rays of a packet that hit anything, as bits; the same as [`Self::occluded`] for each.
    pub fn occluded_packet<const N: usize>(
        &self,
        rays: &RayPacket<N>,
        mask: RayMask,
        hidden: Option<i32>,
    ) -> u64 {
        let filter = &HitFilter::new(mask, hidden);
        SimdLevel::best_available().run(OccludedPacketQuery {
            scene: self,
            rays,
            filter,
        })
    }

    /// Returns the full hit of one ray of a packet; the same as [`Self::closest`] gives.
    pub fn packet_hit<const N: usize>(
        &self,
        rays: &RayPacket<N>,
        hits: &PacketHits<N>,
        k: usize,
    ) -> Option<Hit> {
        let place = HitTriangle {
            source: hits.source[k],
            slot: hits.slot[k],
        };
        hits.is_hit(k)
            .then(|| self.hit(&rays.ray(k), place, hits.distance_m[k]))
    }

    pub(super) fn closest_packet_with_simd<const N: usize>(
        &self,
        level: SimdLevel,
        rays: &RayPacket<N>,
        filter: &HitFilter,
        hits: &mut PacketHits<N>,
    ) {
        let mut answers = tree_packet::PacketClosestHits::new();
        level.run(ClosestPacketQuery {
            scene: self,
            rays,
            filter,
            hits: &mut answers,
        });
        for k in 0..N {
            if answers.is_ambiguous(k) {
                let ray = rays.ray(k);
                let settled = self.resolve_ambiguous(&ray, filter, &answers.lane(k, ray.far_m));
                answers.set(k, settled.closest);
            }
        }
        (hits.distance_m, hits.source, hits.slot) =
            (answers.distance, answers.source, answers.slot);
        for k in 0..N {
            if hits.is_hit(k) {
                let (source, slot) = (hits.source[k], hits.slot[k]);
                (hits.id[k], hits.triangle[k]) =
                    self.triangle_identity(HitTriangle { source, slot });
            } else {
                (hits.id[k], hits.triangle[k]) = (0, 0);
            }
        }
    }

    fn closest_filtered(&self, ray: &Ray, filter: &HitFilter) -> Option<Hit> {
        if !ray.is_usable() {
            return None;
        }
        let mut nearest = ClosestHit::new(ray.far_m);
        self.offer_all(ray, filter, &mut nearest);
        if nearest.is_ambiguous() {
            nearest = self.resolve_ambiguous(ray, filter, &nearest);
        }
        (nearest.closest != HitTriangle::NONE)
            .then(|| self.hit(ray, nearest.closest, nearest.distance))
    }

    fn occluded_filtered(&self, ray: &Ray, filter: &HitFilter) -> bool {
        ray.is_usable() && self.visit_hits(ray, filter, &mut AnyHitVisitor)
    }

    /// The second pass of a ray whose first was ambiguous.
    #[cold]
    fn resolve_ambiguous(&self, ray: &Ray, filter: &HitFilter, first: &ClosestHit) -> ClosestHit {
        let mut nearest = first.second_pass(ray.far_m);
        self.offer_all(ray, filter, &mut nearest);
        nearest
    }

    /// Offers all hits that may matter.
    fn offer_all(&self, ray: &Ray, filter: &HitFilter, nearest: &mut ClosestHit) {
        let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
        let claim = |place: HitTriangle| self.tie_break(origin, direction, place);
        self.visit_hits(
            ray,
            filter,
            &mut ClosestHitVisitor {
                nearest,
                tie_break: claim,
            },
        );
    }

    /// Passes hits to `hits`; returns whether it needs no more.
    fn visit_hits(&self, ray: &Ray, filter: &HitFilter, hits: &mut impl HitVisitor) -> bool {
        SimdLevel::best_available().run(SceneRayQuery {
            scene: self,
            ray,
            filter,
            hits,
        })
    }

    #[inline(always)]
    fn local(&self, origin: [f32; 3], direction: [f32; 3], source: u32) -> LocalRay<'_> {
        let Some(instance) = source.checked_sub(1) else {
            return LocalRay {
                bvh: self.fixed,
                origin,
                direction,
                id: None,
            };
        };
        let placed = &self.moving.placed[instance as usize];
        let map = &placed.mesh_from_world;
        let [x, y, z] = direction;
        let id = Some(placed.id);
        LocalRay {
            bvh: &placed.mesh,
            origin: map.transform_point(origin),
            direction: map.transform_vector(x, y, z),
            id,
        }
    }

    /// Returns the tie-break of a hit among coincident ones.
    pub(super) fn tie_break(
        &self,
        origin: [f32; 3],
        direction: [f32; 3],
        place: HitTriangle,
    ) -> TieBreak {
        let LocalRay {
            bvh,
            origin,
            direction: [x, y, z],
            id,
        } = self.local(origin, direction, place.source);
        let slot = place.slot as usize;
        let surface = &bvh.surfaces[slot];
        let (block, lane) = (&bvh.blocks[slot / 4], slot % 4);
        let slope = dot(block.normal_of(lane), x, y, z);
        let distance = plane_distance(block, lane, origin) / slope;
        let cosine = slope.abs() / dot([x, y, z], x, y, z).sqrt();
        TieBreak {
            reach: coincidence_min_distance(distance, cosine),
            id: id.unwrap_or(surface.id),
            triangle: surface.index,
        }
    }

    /// The id and the triangle's position in its list.
    #[inline(always)]
    fn triangle_identity(&self, place: HitTriangle) -> (i32, u32) {
        if let Some(instance) = place.source.checked_sub(1) {
            let placed = &self.moving.placed[instance as usize];
            return (placed.id, placed.mesh.surfaces[place.slot as usize].index);
        }
        let surface = &self.fixed.surfaces[place.slot as usize];
        (surface.id, surface.index)
    }

    fn hit(&self, ray: &Ray, place: HitTriangle, distance_m: f32) -> Hit {
        let LocalRay {
            bvh,
            origin,
            direction,
            ..
        } = self.local(
            ray.origin.to_array(),
            ray.direction.to_array(),
            place.source,
        );
        let slot = place.slot as usize;
        let sides = EdgePlanes::new(&bvh.blocks[slot / 4], origin, 1.0)
            .edge_functions(direction)
            .map(|side| side[slot % 4]);
        let (u, v) = barycentric_weights(sides);
        let (id, triangle) = self.triangle_identity(place);
        Hit {
            distance_m,
            u,
            v,
            id,
            instance: place.source.checked_sub(1),
            triangle,
        }
    }
}

impl TriangleBvh {
    /// As [`SceneBvh::closest`] for this tree alone.
    pub fn closest(&self, ray: &Ray, mask: RayMask) -> Option<Hit> {
        SceneBvh {
            fixed: self,
            moving: &InstanceSet::default(),
        }
        .closest(ray, mask)
    }

    /// As [`SceneBvh::occluded`] for this tree alone.
    pub fn occluded(&self, ray: &Ray, mask: RayMask) -> bool {
        SceneBvh {
            fixed: self,
            moving: &InstanceSet::default(),
        }
        .occluded(ray, mask)
    }
}
