//! Rays through everything: static geometry and what moves.

use super::instances::InstanceSet;
use super::kernels::level::{ClosestPacket, OccludedPacket};
use super::kernels::nearest::{Claim, Nearest, Place, reach};
use super::kernels::one::{Any, Every, Offer, OneRay};
use super::kernels::single::Hits;
use super::kernels::triangle::{EdgePlanes, dot, height_of, weights};
use super::kernels::{Filter, packet};
use super::packet::{PacketHits, RayPacket};
use super::ray::{Hit, Ray, RayMask};
use super::triangles::TriangleBvh;
use crate::instructions::Level;

/// A world as rays see it; a pair of references, free to make and copy.
///
/// Answers depend on the set of surfaces alone, bit for bit: not on the order in which they are stored, nor on the kernel.
/// Of surfaces that coincide (see [`Hit::id`]) the lowest id counts, then static geometry, then the lower instance, then the
/// lower triangle.
#[derive(Clone, Copy, Debug)]
pub struct SceneBvh<'a> {
    /// What never moves.
    pub fixed: &'a TriangleBvh,
    /// What does.
    pub moving: &'a InstanceSet,
}

/// A ray in the space of one mesh.
struct Local<'a> {
    bvh: &'a TriangleBvh,
    origin: [f32; 3],
    direction: [f32; 3],
    /// The instance's id.
    id: Option<i32>,
}

impl SceneBvh<'_> {
    /// The nearest surface on a ray that `mask` meets.
    pub fn closest(&self, ray: &Ray, mask: RayMask) -> Option<Hit> {
        self.closest_filtered(ray, &Filter::new(mask, None))
    }

    /// As [`Self::closest`], as if nothing had the id `hidden`.
    pub fn closest_without(&self, ray: &Ray, mask: RayMask, hidden: i32) -> Option<Hit> {
        self.closest_filtered(ray, &Filter::new(mask, Some(hidden)))
    }

    /// Whether a surface that `mask` meets lies on the ray.
    pub fn occluded(&self, ray: &Ray, mask: RayMask) -> bool {
        self.occluded_filtered(ray, &Filter::new(mask, None))
    }

    /// As [`Self::occluded`], as if nothing had the id `hidden`.
    pub fn occluded_without(&self, ray: &Ray, mask: RayMask, hidden: i32) -> bool {
        self.occluded_filtered(ray, &Filter::new(mask, Some(hidden)))
    }

    /// Every surface on the ray that `mask` meets, by distance, then id, instance and triangle. `hits` is cleared first.
    pub fn every_hit(&self, ray: &Ray, mask: RayMask, hits: &mut Vec<Hit>) {
        hits.clear();
        if !ray.is_usable() {
            return;
        }
        let mut every = Every(|place, distance| hits.push(self.hit(ray, place, distance)));
        self.offer(ray, &Filter::new(mask, None), &mut every);
        hits.sort_by(|a, b| {
            let rest = |hit: &Hit| (hit.id, hit.instance, hit.triangle);
            a.distance_m
                .total_cmp(&b.distance_m)
                .then(rest(a).cmp(&rest(b)))
        });
    }

    /// The nearest surfaces on the rays of a packet; the same bits as [`Self::closest`] for each.
    ///
    /// `hidden`: as if nothing had that id.
    pub fn closest_packet<const N: usize>(
        &self,
        rays: &RayPacket<N>,
        mask: RayMask,
        hidden: Option<i32>,
        hits: &mut PacketHits<N>,
    ) {
        self.closest_packet_at(Level::best(), rays, &Filter::new(mask, hidden), hits);
    }

    /// Which rays of a packet meet anything, as bits; the same as [`Self::occluded`] for each.
    pub fn occluded_packet<const N: usize>(
        &self,
        rays: &RayPacket<N>,
        mask: RayMask,
        hidden: Option<i32>,
    ) -> u64 {
        let filter = &Filter::new(mask, hidden);
        Level::best().run(OccludedPacket {
            scene: self,
            rays,
            filter,
        })
    }

    /// Everything about one ray of a packet; the same as [`Self::closest`] gives.
    pub fn packet_hit<const N: usize>(
        &self,
        rays: &RayPacket<N>,
        hits: &PacketHits<N>,
        k: usize,
    ) -> Option<Hit> {
        let place = Place {
            source: hits.source[k],
            slot: hits.slot[k],
        };
        hits.is_hit(k)
            .then(|| self.hit(&rays.ray(k), place, hits.distance_m[k]))
    }

    pub(super) fn closest_packet_at<const N: usize>(
        &self,
        level: Level,
        rays: &RayPacket<N>,
        filter: &Filter,
        hits: &mut PacketHits<N>,
    ) {
        let mut answers = packet::Answers::new();
        level.run(ClosestPacket {
            scene: self,
            rays,
            filter,
            answers: &mut answers,
        });
        for k in 0..N {
            if answers.is_unsure(k) {
                let ray = rays.ray(k);
                let settled = self.settle(&ray, filter, &answers.lane(k, ray.far_m));
                answers.set(k, settled.best);
            }
        }
        (hits.distance_m, hits.source, hits.slot) =
            (answers.distance, answers.source, answers.slot);
        for k in 0..N {
            if hits.is_hit(k) {
                let (source, slot) = (hits.source[k], hits.slot[k]);
                (hits.id[k], hits.triangle[k]) = self.name(Place { source, slot });
            } else {
                (hits.id[k], hits.triangle[k]) = (0, 0);
            }
        }
    }

    fn closest_filtered(&self, ray: &Ray, filter: &Filter) -> Option<Hit> {
        if !ray.is_usable() {
            return None;
        }
        let mut nearest = Nearest::new(ray.far_m);
        self.offer_all(ray, filter, &mut nearest);
        if nearest.is_unsure() {
            nearest = self.settle(ray, filter, &nearest);
        }
        (nearest.best != Place::NONE).then(|| self.hit(ray, nearest.best, nearest.distance))
    }

    fn occluded_filtered(&self, ray: &Ray, filter: &Filter) -> bool {
        ray.is_usable() && self.offer(ray, filter, &mut Any)
    }

    /// The second run of a ray whose first was not sure.
    #[cold]
    fn settle(&self, ray: &Ray, filter: &Filter, first: &Nearest) -> Nearest {
        let mut nearest = first.again(ray.far_m);
        self.offer_all(ray, filter, &mut nearest);
        nearest
    }

    /// Offers all hits that may matter.
    fn offer_all(&self, ray: &Ray, filter: &Filter, nearest: &mut Nearest) {
        let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
        let claim = |place: Place| self.claim(origin, direction, place);
        self.offer(ray, filter, &mut Offer { nearest, claim });
    }

    /// Hands hits to `hits`; whether one was enough.
    fn offer(&self, ray: &Ray, filter: &Filter, hits: &mut impl Hits) -> bool {
        Level::best().run(OneRay {
            scene: self,
            ray,
            filter,
            hits,
        })
    }

    #[inline(always)]
    fn local(&self, origin: [f32; 3], direction: [f32; 3], source: u32) -> Local<'_> {
        let Some(instance) = source.checked_sub(1) else {
            return Local {
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
        Local {
            bvh: &placed.mesh,
            origin: map.point(origin),
            direction: map.vector(x, y, z),
            id,
        }
    }

    /// What decides for a hit among coincident ones.
    pub(super) fn claim(&self, origin: [f32; 3], direction: [f32; 3], place: Place) -> Claim {
        let Local {
            bvh,
            origin,
            direction: [x, y, z],
            id,
        } = self.local(origin, direction, place.source);
        let slot = place.slot as usize;
        let surface = &bvh.surfaces[slot];
        let (block, lane) = (&bvh.blocks[slot / 4], slot % 4);
        let slope = dot(block.normal_of(lane), x, y, z);
        let distance = height_of(block, lane, origin) / slope;
        let cosine = slope.abs() / dot([x, y, z], x, y, z).sqrt();
        Claim {
            reach: reach(distance, cosine),
            id: id.unwrap_or(surface.id),
            triangle: surface.index,
        }
    }

    /// The id and the triangle's position in its list.
    #[inline(always)]
    fn name(&self, place: Place) -> (i32, u32) {
        if let Some(instance) = place.source.checked_sub(1) {
            let placed = &self.moving.placed[instance as usize];
            return (placed.id, placed.mesh.surfaces[place.slot as usize].index);
        }
        let surface = &self.fixed.surfaces[place.slot as usize];
        (surface.id, surface.index)
    }

    fn hit(&self, ray: &Ray, place: Place, distance_m: f32) -> Hit {
        let Local {
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
            .sides(direction)
            .map(|side| side[slot % 4]);
        let (u, v) = weights(sides);
        let (id, triangle) = self.name(place);
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
