//! What a viewer sees of each thing: shares of the picture, what is hidden, where it falls and how far it is.

use crate::clear_glass::is_transparent;
use crate::scene::{SemanticScene, Viewer};
use dwell_scene::bvh::{Hit, Ray, RayMask};
use dwell_scene::interrupt::CancelPoller;
use dwell_scene::{
    Entity, EntityId, House, MaterialId, ObjectId, PartId, RoomId, StructureId, StructureKind,
    SurfaceOwner,
};
use glam::Vec3;
use std::collections::BTreeMap;

/// Rays along each edge of the picture. A mug 3 m away meets two or three.
const RAYS: usize = 64;
/// Tangent of half the field of view: 90 degrees, that of the default camera.
const HALF_WIDTH: f32 = 1.0;
/// Rays between checks for cancellation.
const RAYS_PER_CHECK: usize = 256;

/// What is seen of one thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    /// Its share of the picture, 0 to 1.
    pub share: f32,
    /// The share of the rays towards it within the picture that nothing nearer stops, 0 to 1.
    pub unhidden: f32,
    /// The tangents of the leftmost and the rightmost ray that meets it: -1 at the left edge of the picture, 1 at the right.
    pub span: [f32; 2],
    /// The tangent of the lowest ray that meets it: -1 at the lower edge of the picture.
    pub bottom: f32,
    /// The distance from the eye to the nearest point that is seen, m.
    pub distance_m: f32,
    /// That point, in the house.
    pub nearest: Vec3,
}

/// What a viewer sees: a picture of 90 degrees in both directions, by 64 times 64 rays.
#[derive(Clone, Debug, Default)]
pub struct ViewSurvey {
    /// The things that at least one ray meets first, or through clear glass.
    pub objects: BTreeMap<ObjectId, Sighting>,
    /// The share of the picture that is each piece of the building.
    pub structure: BTreeMap<StructureId, f32>,
    /// The numbers of rays that meet each part of a thing first, by material.
    parts: BTreeMap<(PartId, MaterialId), u32>,
    /// The same of pieces of the building.
    pieces: BTreeMap<(StructureId, MaterialId), u32>,
}

/// Rays that meet a thing.
#[derive(Clone, Copy)]
struct RayCounts {
    first: u32,
    any: u32,
    span: [f32; 2],
    bottom: f32,
    nearest_m: f32,
    nearest: Vec3,
}

impl RayCounts {
    const NONE: Self = Self {
        first: 0,
        any: 0,
        span: [f32::INFINITY, f32::NEG_INFINITY],
        bottom: f32::INFINITY,
        nearest_m: f32::INFINITY,
        nearest: Vec3::ZERO,
    };

    fn sighting(self) -> Option<Sighting> {
        (self.first > 0).then(|| Sighting {
            share: self.first as f32 / (RAYS * RAYS) as f32,
            unhidden: self.first as f32 / self.any as f32,
            span: self.span,
            bottom: self.bottom,
            distance_m: self.nearest_m,
            nearest: self.nearest,
        })
    }
}

impl ViewSurvey {
    /// Traces the rays of a viewer's picture.
    pub fn of(scene: &SemanticScene<'_>, viewer: &Viewer) -> Self {
        let (house, rays) = (scene.house(), scene.rays());
        let eye = viewer.world_from_camera.position;
        let mut counts: BTreeMap<i32, RayCounts> = BTreeMap::new();
        let mut survey = Self::default();
        let mut hits: Vec<Hit> = Vec::new();
        let mut met: Vec<i32> = Vec::new();
        let mut poll = CancelPoller::new(RAYS_PER_CHECK);
        let tangent = |k: usize| ((k as f32 + 0.5) / RAYS as f32 * 2.0 - 1.0) * HALF_WIDTH;
        for k in 0..RAYS * RAYS {
            poll.count_one();
            let (x, y) = (tangent(k % RAYS), tangent(k / RAYS));
            let direction = viewer
                .world_from_camera
                .transform_vector(Vec3::new(x, y, -1.0));
            let ray = Ray::new(eye, direction);
            rays.bvh().all_hits(&ray, RayMask::EYE, &mut hits);
            met.clear();
            let mut is_seen = true;
            for hit in &hits {
                let was_seen = is_seen;
                is_seen = is_seen && is_transparent(rays, hit);
                if met.contains(&hit.id) {
                    continue;
                }
                met.push(hit.id);
                let own = counts.entry(hit.id).or_insert(RayCounts::NONE);
                own.any += 1;
                if was_seen {
                    survey.count_surface(rays.owner_and_material(hit));
                    own.first += 1;
                    own.span = [own.span[0].min(x), own.span[1].max(x)];
                    own.bottom = own.bottom.min(y);
                    if hit.distance_m < own.nearest_m {
                        own.nearest_m = hit.distance_m;
                        own.nearest = eye + ray.direction * hit.distance_m;
                    }
                }
            }
        }
        for (id, own) in counts {
            let Some(sighting) = own.sighting() else {
                continue;
            };
            match house.entity(EntityId(id)) {
                Some(Entity::Object(object)) => {
                    survey.objects.insert(object, sighting);
                }
                Some(Entity::Structure(piece)) => {
                    survey.structure.insert(piece, sighting.share);
                }
                _ => {}
            }
        }
        survey
    }

    fn count_surface(&mut self, (owner, material): (SurfaceOwner, MaterialId)) {
        let count = match owner {
            SurfaceOwner::Part(part) => self.parts.entry((part, material)).or_insert(0),
            SurfaceOwner::Structure(piece) => self.pieces.entry((piece, material)).or_insert(0),
        };
        *count += 1;
    }

    /// The materials of a thing with the numbers of rays that meet them first.
    pub(crate) fn materials_of(&self, house: &House, object: ObjectId) -> Vec<(MaterialId, f32)> {
        let parts = self.parts.iter();
        summed(
            parts
                .filter(|((part, _), _)| house.parts[*part].object == object)
                .map(|((_, material), rays)| (*material, *rays)),
        )
    }

    /// The same of the walls or floors that border a room; `None`: of all that are seen.
    pub(crate) fn materials_of_structure(
        &self,
        house: &House,
        room: Option<RoomId>,
        kind: StructureKind,
    ) -> Vec<(MaterialId, f32)> {
        let pieces = self.pieces.iter();
        summed(
            pieces
                .filter(|((piece, _), _)| borders(house, *piece, room, kind))
                .map(|((_, material), rays)| (*material, *rays)),
        )
    }

    /// Returns whether a ray meets a part of a thing first.
    pub(crate) fn is_part_seen(&self, part: PartId) -> bool {
        self.parts.keys().any(|(own, _)| *own == part)
    }

    /// The share of the picture that the walls or floors that border a room cover, 0 to 1.
    pub(crate) fn structure_share(&self, house: &House, room: RoomId, kind: StructureKind) -> f32 {
        let own = self.structure.iter();
        own.filter(|(piece, _)| borders(house, **piece, Some(room), kind))
            .map(|(_, share)| share)
            .sum()
    }
}

/// Returns whether a piece of the building is of a kind and borders a room; `None`: any.
fn borders(house: &House, piece: StructureId, room: Option<RoomId>, kind: StructureKind) -> bool {
    let own = &house.structure[piece];
    own.kind == kind && (room.is_none() || own.room.is_none() || own.room == room)
}

fn summed(rays: impl Iterator<Item = (MaterialId, u32)>) -> Vec<(MaterialId, f32)> {
    let mut sums: BTreeMap<MaterialId, f32> = BTreeMap::new();
    for (material, count) in rays {
        *sums.entry(material).or_insert(0.0) += count as f32;
    }
    sums.into_iter().collect()
}
