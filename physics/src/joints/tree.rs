//! Kinematic trees: joints that act on each other, over one root body.

use super::PhysicsJoint;
use crate::engine::RapierWorld;
use crate::model::PhysicsModel;
use dwell_scene::JointId;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle};
use std::collections::BTreeMap;

/// A tree of joints whose efforts are computed together.
#[derive(Clone, Debug)]
pub(crate) struct KinematicTree {
    /// The parent body of the first joint.
    pub(super) root: RigidBodyHandle,
    /// Index of that body's plan in the model; `None`: it never moves.
    pub(super) root_body: Option<u32>,
    /// Indices among the world's joints, parents first.
    pub(crate) joints: Vec<usize>,
    /// For each joint, the index in this tree of the joint that moves its parent. Shape (joint,).
    pub(super) parents: Vec<Option<usize>>,
    /// For each joint, the index in this tree of its leader. Shape (joint,).
    pub(super) mimic_leaders: Vec<Option<usize>>,
}

impl KinematicTree {
    /// Returns the parent body of the first joint.
    pub(crate) fn root(&self) -> RigidBodyHandle {
        self.root
    }

    /// Returns the index of that body's plan in the model; `None`: it never moves.
    pub(crate) fn root_body(&self) -> Option<u32> {
        self.root_body
    }

    /// Returns the index in the model of a free root, on which the joints' efforts react.
    pub(crate) fn floating_root(
        &self,
        engine: &RapierWorld,
        joints: &[PhysicsJoint],
    ) -> Option<u32> {
        let dynamic = |handle| engine.bodies.get(handle).is_some_and(RigidBody::is_dynamic);
        let moves = |k: &usize| dynamic(joints[*k].child_handle);
        let answers = dynamic(self.root) && self.joints.iter().any(moves);
        self.root_body.filter(|_| answers)
    }
}

/// Sorts a world's joints into trees. Joints are connected where one's child is another's parent, where they share a parent
/// that may move, and where one follows the other.
pub(crate) fn trees(
    joints: &[PhysicsJoint],
    model: &PhysicsModel,
    anchor: RigidBodyHandle,
) -> Vec<KinematicTree> {
    let house = &model.house;
    let key = |handle: RigidBodyHandle| handle.into_raw_parts();
    let numbered = || joints.iter().enumerate();
    let by_child: BTreeMap<_, usize> = numbered()
        .map(|(k, joint)| (key(joint.child_handle), k))
        .collect();
    let by_id: BTreeMap<JointId, usize> = numbered().map(|(k, joint)| (joint.id, k)).collect();
    let above = |joint: &PhysicsJoint| by_child.get(&key(joint.parent_handle)).copied();
    let leader = |joint: &PhysicsJoint| {
        let mimic = house.joints[joint.id].mimic?;
        by_id.get(&mimic.leader).copied()
    };
    let mut groups = UnionFind::new(joints.len());
    let mut first_on: BTreeMap<_, usize> = BTreeMap::new();
    for (k, joint) in numbered() {
        let sharing = (joint.parent_handle != anchor)
            .then(|| *first_on.entry(key(joint.parent_handle)).or_insert(k));
        for other in [above(joint), leader(joint), sharing].into_iter().flatten() {
            groups.union(k, other);
        }
    }
    // Number of joints between each and the root; a part comes after its parent.
    let mut depths = vec![0_usize; joints.len()];
    let mut by_part: Vec<usize> = (0..joints.len()).collect();
    by_part.sort_by_key(|k| house.joints[joints[*k].id].child);
    for k in by_part {
        depths[k] = above(&joints[k]).map_or(0, |above| depths[above] + 1);
    }
    let mut orders: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for k in 0..joints.len() {
        orders.entry(groups.find(k)).or_default().push(k);
    }
    let mut places = vec![0_usize; joints.len()];
    let tree = |mut order: Vec<usize>| {
        // Those of equal depth in the order of the house.
        order.sort_by_key(|k| depths[*k]);
        for (place, k) in order.iter().enumerate() {
            places[*k] = place;
        }
        let place_of = |other: Option<usize>| other.map(|other| places[other]);
        let first = &joints[order[0]];
        let root_part = house.joints[first.id].parent;
        KinematicTree {
            root: first.parent_handle,
            root_body: root_part.and_then(|part| model.body_of_part[part]),
            parents: order.iter().map(|k| place_of(above(&joints[*k]))).collect(),
            mimic_leaders: order
                .iter()
                .map(|k| place_of(leader(&joints[*k])))
                .collect(),
            joints: order,
        }
    };
    orders.into_values().map(tree).collect()
}

/// A union-find structure; each group is represented by its first element.
struct UnionFind {
    /// For each, an element of its group that is not behind it.
    before: Vec<usize>,
}

impl UnionFind {
    /// Each element in a group of its own.
    fn new(count: usize) -> Self {
        Self {
            before: (0..count).collect(),
        }
    }

    fn find(&mut self, mut k: usize) -> usize {
        while self.before[k] != k {
            // Paths are compressed with each use.
            self.before[k] = self.before[self.before[k]];
            k = self.before[k];
        }
        k
    }

    fn union(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        self.before[a.max(b)] = a.min(b);
    }
}
