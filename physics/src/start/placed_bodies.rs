//! Spatial index of the bodies that are placed while others are resolved.

use crate::model::PhysicsModel;
use dwell_scene::Aabb;
use rapier3d::math::Pose as RapierPose;
use rapier3d::parry::partitioning::Bvh;
use std::collections::BTreeMap;

/// A body that is placed while others are resolved.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlacedBody {
    pub(super) body: u32,
    pub(super) bounds: Aabb,
    pub(super) pose: RapierPose,
    /// Order of placement.
    rank: u32,
}

/// All placed bodies.
#[derive(Default)]
pub(super) struct PlacedBodyIndex {
    tree: Bvh,
    by_body: BTreeMap<u32, PlacedBody>,
    next_rank: u32,
}

impl PlacedBodyIndex {
    /// Places a body; one that is placed already moves there and keeps its rank.
    pub(super) fn insert(&mut self, model: &PhysicsModel, body: usize, place: RapierPose) {
        let number = body as u32;
        let rank = self
            .by_body
            .get(&number)
            .map_or(self.next_rank, |before| before.rank);
        self.next_rank = self.next_rank.max(rank + 1);
        self.reinsert(PlacedBody {
            body: number,
            bounds: model.bodies[body].bounds(&place),
            pose: place,
            rank,
        });
    }

    /// Puts a removed body back.
    pub(super) fn reinsert(&mut self, placed: PlacedBody) {
        self.remove(placed.body as usize);
        self.tree.insert(to_parry(&placed.bounds), placed.body);
        self.by_body.insert(placed.body, placed);
    }

    /// Removes a body.
    pub(super) fn remove(&mut self, body: usize) {
        let number = body as u32;
        if self.by_body.remove(&number).is_some() {
            self.tree.remove(number);
        }
    }

    /// Returns the bodies whose boxes intersect a box, in order of placement.
    pub(super) fn intersecting(&self, bounds: &Aabb) -> Vec<PlacedBody> {
        let around = to_parry(bounds);
        let found = self.tree.intersect_aabb(&around);
        let mut near: Vec<PlacedBody> = found
            .filter_map(|body| self.by_body.get(&body).copied())
            .filter(|placed| placed.bounds.intersects(bounds))
            .collect();
        near.sort_unstable_by_key(|placed| placed.rank);
        near
    }
}

fn to_parry(bounds: &Aabb) -> rapier3d::geometry::Aabb {
    rapier3d::geometry::Aabb::new(bounds.min, bounds.max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;
    use glam::Vec3;

    /// Against a linear list: the bodies near a box, in order, while bodies come, go and move.
    #[test]
    fn those_near_a_box_are_those_of_a_list() {
        let mut stream = RandomKey::root(4).stream();
        let mut standing = PlacedBodyIndex::default();
        let mut list: Vec<PlacedBody> = Vec::new();
        let mut draw = |grow: f32| {
            let at = Vec3::from_array(std::array::from_fn(|_| stream.range(0.0, 4.0)));
            Aabb::new(at, at + Vec3::splat(grow * stream.range(0.1, 1.0)))
        };
        for turn in 0..600_u32 {
            let body = turn * 7 % 150;
            let stood = list.iter().position(|placed| placed.body == body);
            match (stood, turn % 5) {
                (Some(place), 0) => {
                    list.remove(place);
                    standing.remove(body as usize);
                }
                (Some(place), _) => {
                    list[place].bounds = draw(1.0);
                    standing.reinsert(list[place]);
                }
                (None, _) => {
                    let placed = PlacedBody {
                        body,
                        bounds: draw(1.0),
                        pose: RapierPose::IDENTITY,
                        rank: turn,
                    };
                    list.push(placed);
                    standing.reinsert(placed);
                }
            }
            let asked = draw(2.0);
            let bodies = |all: &[PlacedBody]| all.iter().map(|one| one.body).collect::<Vec<_>>();
            let by_hand: Vec<PlacedBody> = list
                .iter()
                .filter(|placed| placed.bounds.intersects(&asked))
                .copied()
                .collect();
            assert_eq!(
                bodies(&standing.intersecting(&asked)),
                bodies(&by_hand),
                "turn {turn}"
            );
        }
    }
}
