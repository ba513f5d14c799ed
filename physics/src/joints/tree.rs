//! Which joints act on each other: a tree of bodies over one root.

use super::Joint;
use crate::engine::Engine;
use crate::model::PhysicsModel;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle};

/// Joints whose efforts are found together.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    /// The body that the first joint hangs on.
    pub(super) root: RigidBodyHandle,
    /// The number of that body's plan in the model; `None`: it never moves.
    pub(super) root_body: Option<u32>,
    /// Places in the world's joints, parents first.
    pub(crate) joints: Vec<usize>,
    /// For each, the place in this tree of the joint that moves its parent. Shape (joint,).
    pub(super) parents: Vec<Option<usize>>,
    /// For each, the place in this tree of the joint that it follows. Shape (joint,).
    pub(super) follows: Vec<Option<usize>>,
}

impl Tree {
    /// The body that the first joint hangs on.
    pub(crate) fn root(&self) -> RigidBodyHandle {
        self.root
    }

    /// The number in the model of a root that is free to answer what its joints do; they push back on it.
    pub(crate) fn answering_root(&self, engine: &Engine, joints: &[Joint]) -> Option<u32> {
        let dynamic = |handle| engine.bodies.get(handle).is_some_and(RigidBody::is_dynamic);
        let moves = |k: &usize| dynamic(joints[*k].child_handle);
        let answers = dynamic(self.root) && self.joints.iter().any(moves);
        self.root_body.filter(|_| answers)
    }
}

/// Sorts a world's joints into trees. Joints hang together where one's child is another's parent, where they hang on one
/// body that may move, and where one follows the other.
pub(crate) fn trees(joints: &[Joint], model: &PhysicsModel, anchor: RigidBodyHandle) -> Vec<Tree> {
    let house = &model.house;
    let mut group: Vec<usize> = (0..joints.len()).collect();
    let merge = |group: &mut Vec<usize>, a: usize, b: usize| {
        let (from, to) = (group[a].max(group[b]), group[a].min(group[b]));
        for g in group.iter_mut().filter(|g| **g == from) {
            *g = to;
        }
    };
    for (a, joint) in joints.iter().enumerate() {
        let leader = house.joints[joint.id].mimic.map(|mimic| mimic.leader);
        for (b, other) in joints.iter().enumerate() {
            let hangs = joint.parent_handle == other.child_handle;
            let shares =
                joint.parent_handle != anchor && joint.parent_handle == other.parent_handle;
            if hangs || shares || leader == Some(other.id) {
                merge(&mut group, a, b);
            }
        }
    }
    let mut trees = Vec::new();
    for first in 0..joints.len() {
        if group[first] != first {
            continue;
        }
        let mut left: Vec<usize> = (0..joints.len()).filter(|k| group[*k] == first).collect();
        let mut order: Vec<usize> = Vec::with_capacity(left.len());
        while !left.is_empty() {
            // Parents stand before children in the house, so every round finds at least one.
            let moved: Vec<RigidBodyHandle> =
                left.iter().map(|k| joints[*k].child_handle).collect();
            let ready = |k: &usize| !moved.contains(&joints[*k].parent_handle);
            let next: Vec<usize> = left.iter().copied().filter(ready).collect();
            if next.is_empty() {
                break;
            }
            left.retain(|k| !next.contains(k));
            order.extend(next);
        }
        let place =
            |wanted: &dyn Fn(&Joint) -> bool| order.iter().position(|k| wanted(&joints[*k]));
        let parents = order
            .iter()
            .map(|k| place(&|other| other.child_handle == joints[*k].parent_handle))
            .collect();
        let follows = order
            .iter()
            .map(|k| {
                let mimic = house.joints[joints[*k].id].mimic?;
                place(&|other| other.id == mimic.leader)
            })
            .collect();
        let first = &joints[order[0]];
        let root_part = house.joints[first.id].parent;
        trees.push(Tree {
            root: first.parent_handle,
            root_body: root_part.and_then(|part| model.body_of_part[part]),
            joints: order,
            parents,
            follows,
        });
    }
    trees
}
