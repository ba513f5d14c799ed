//! Moving instances: rigid copies of meshes, and a small tree over their boxes.

use std::sync::Arc;

use glam::{Affine3A, DMat3, Vec3, Vec4};

use super::binary::{self, BinaryBvh};
use super::node::{NodeLink, WIDTH};
use super::ray::RayMask;
use super::triangles::TriangleBvh;
use super::wide::WideBvh;
use crate::bounds::Aabb;

/// A mesh at a pose in the world.
#[derive(Clone, Debug)]
pub struct Instance {
    /// Shared by all copies.
    pub mesh: Arc<TriangleBvh>,
    /// Its transform; may scale and mirror. One that is not finite or flattens hides the instance.
    pub world_from_mesh: Affine3A,
    /// Reported by hits, and the tie-break among coincident surfaces: the lower id wins.
    pub id: i32,
    /// The rays that see it.
    pub mask: RayMask,
}

/// An instance, prepared for rays.
#[derive(Clone, Debug)]
pub(super) struct PreparedInstance {
    pub(super) mesh: Arc<TriangleBvh>,
    pub(super) id: i32,
    pub(super) mask: RayMask,
    pub(super) mesh_from_world: MeshFromWorld,
    /// In world space; empty while hidden.
    pub(super) bounds: Aabb,
    /// Its parent node, and its place among the node's children.
    home: (u32, u32),
}

/// The inverse of a transform, arranged to keep precision far from the origin: the difference of positions comes first.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MeshFromWorld {
    rows: [[f32; 3]; 3],
    origin: [f32; 3],
    /// Bound on each component of a transformed unit vector.
    pub(super) max_component: f32,
}

impl MeshFromWorld {
    fn new(world_from_mesh: &Affine3A) -> Option<Self> {
        let columns = world_from_mesh.matrix3;
        let forward = DMat3::from_cols(
            Vec3::from(columns.x_axis).as_dvec3(),
            Vec3::from(columns.y_axis).as_dvec3(),
            Vec3::from(columns.z_axis).as_dvec3(),
        );
        let inverse = forward.inverse();
        let origin = Vec3::from(world_from_mesh.translation);
        let usable = forward.determinant() != 0.0 && inverse.is_finite() && origin.is_finite();
        let rows = [0, 1, 2].map(|k| inverse.row(k).as_vec3());
        let longest = rows.map(glam::Vec3::length).into_iter().fold(0.0, f32::max);
        usable.then_some(Self {
            rows: rows.map(|row| row.to_array()),
            origin: origin.to_array(),
            max_component: longest,
        })
    }

    /// Returns its rows, each followed by a coordinate of the origin.
    pub(super) fn rows(&self) -> [Vec4; 3] {
        [0, 1, 2].map(|k| Vec3::from_array(self.rows[k]).extend(self.origin[k]))
    }

    #[inline(always)]
    pub(super) fn transform_point(&self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        self.transform_vector(x - self.origin[0], y - self.origin[1], z - self.origin[2])
    }

    #[inline(always)]
    pub(super) fn transform_vector(&self, x: f32, y: f32, z: f32) -> [f32; 3] {
        let [a, b, c] = &self.rows;
        [
            (a[0] * x + a[1] * y) + a[2] * z,
            (b[0] * x + b[1] * y) + b[2] * z,
            (c[0] * x + c[1] * y) + c[2] * z,
        ]
    }
}

/// All moving instances of one world.
///
/// Once filled, changing poses allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct InstanceSet {
    pub(super) placed: Vec<PreparedInstance>,
    pub(super) tree: WideBvh,
    /// For each node, its parent node and its place among that node's children.
    parents: Vec<(u32, u32)>,
    boxes: Vec<Aabb>,
    binary: BinaryBvh,
}

/// The parent of a node without one.
const NO_PARENT: (u32, u32) = (u32::MAX, 0);

impl InstanceSet {
    /// A set of the instances in the order in which hits number them.
    pub fn new(instances: impl IntoIterator<Item = Instance>) -> Self {
        let mut set = Self::default();
        for Instance {
            mesh,
            world_from_mesh,
            id,
            mask,
        } in instances
        {
            let mesh_from_world = MeshFromWorld::default();
            set.placed.push(PreparedInstance {
                mesh,
                id,
                mask,
                mesh_from_world,
                bounds: Aabb::EMPTY,
                home: NO_PARENT,
            });
            let last = set.placed.len() - 1;
            set.placed[last].set_pose(&world_from_mesh);
        }
        set.rebuild();
        set
    }

    /// Returns the number of instances.
    pub fn len(&self) -> usize {
        self.placed.len()
    }

    /// Returns whether there are no instances.
    pub fn is_empty(&self) -> bool {
        self.placed.is_empty()
    }

    /// The smallest box around all, m.
    pub fn bounds(&self) -> Aabb {
        self.tree.bounds
    }

    /// The box around one, m; empty while it is hidden, and when there are not that many.
    pub fn bounds_of(&self, instance: u32) -> Aabb {
        self.placed
            .get(instance as usize)
            .map_or(Aabb::EMPTY, |placed| placed.bounds)
    }

    /// Sets the mask of an instance, if there are that many; [`RayMask::NONE`] hides it.
    pub fn set_mask(&mut self, instance: u32, mask: RayMask) {
        if let Some(placed) = self.placed.get_mut(instance as usize) {
            placed.mask = mask;
        }
    }

    /// Moves one instance, if there are that many. For a few: large displacements make later rays slower until
    /// [`Self::set_poses`].
    pub fn set_pose(&mut self, instance: u32, world_from_mesh: &Affine3A) {
        let Some(placed) = self.placed.get_mut(instance as usize) else {
            return;
        };
        placed.set_pose(world_from_mesh);
        let (mut place, mut bounds) = (placed.home, placed.bounds);
        while place != NO_PARENT {
            let node = &mut self.tree.nodes[place.0 as usize];
            node.set_bounds(place.1 as usize, &bounds);
            bounds = node.bounds();
            place = self.parents[place.0 as usize];
        }
        self.tree.bounds = bounds;
    }

    /// Moves all instances, in order, and rebuilds the tree; those beyond the end of `poses` stay.
    pub fn set_poses<'a>(&mut self, poses: impl IntoIterator<Item = &'a Affine3A>) {
        for (placed, pose) in self.placed.iter_mut().zip(poses) {
            placed.set_pose(pose);
        }
        self.rebuild();
    }

    fn rebuild(&mut self) {
        self.boxes.clear();
        self.boxes
            .extend(self.placed.iter().map(|placed| placed.bounds));
        binary::rebuild_median_tree(&self.boxes, 1, &mut self.binary);
        let order = &self.binary.primitive_order;
        // Halving makes no tree too deep.
        self.tree.fill(&self.binary, &mut |leaf| {
            NodeLink::leaf(order[leaf.start] as usize)
        });
        self.parents.clear();
        self.parents.resize(self.tree.nodes.len(), NO_PARENT);
        for (index, node) in self.tree.nodes.iter().enumerate() {
            for child in (0..WIDTH).filter(|child| node.present & (1 << child) != 0) {
                let home = (index as u32, child as u32);
                match node.links[child].unpack() {
                    (true, instance) => self.placed[instance].home = home,
                    (false, node) => self.parents[node] = home,
                }
            }
        }
    }
}

impl PreparedInstance {
    /// Returns whether no ray can hit it because of its pose or its mesh.
    #[inline(always)]
    pub(super) fn is_hidden(&self) -> bool {
        self.mesh_from_world.max_component == 0.0
    }

    /// Sets the pose.
    fn set_pose(&mut self, world_from_mesh: &Affine3A) {
        let bounds = self.mesh.bounds();
        let inverse = MeshFromWorld::new(world_from_mesh).filter(|_| !bounds.is_empty());
        self.mesh_from_world = inverse.unwrap_or_default();
        self.bounds = if inverse.is_some() {
            // Wider by more than the rounding of the transform.
            let bounds = bounds.transformed(world_from_mesh);
            let furthest = bounds.min.abs().max(bounds.max.abs()).max_element();
            bounds.grown(1e-5 + 1e-6 * furthest)
        } else {
            Aabb::EMPTY
        };
    }
}
