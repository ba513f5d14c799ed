//! The physics model of a house, built once: collision pieces and rigid bodies. All worlds over a house share it.

mod decompose;
mod plan;
mod rolling_cylinder;
pub(crate) mod shapes;
mod substance;

pub(crate) use plan::{BodyDefinition, CollisionPiece, MaterialAssignment, PieceOwner};
pub(crate) use rolling_cylinder::RollableCylinder;

use dwell_scene::{Aabb, House, IdVec, ObjectId, PartId};
use std::fmt;
use std::sync::Arc;

/// Moving pieces from which on static pieces are inserted behind them. rapier looks through all pairs of the piece that was
/// inserted first for each that it adds: as many pieces on one floor would otherwise take a time that grows with their square.
const MANY_MOVING_PIECES: usize = 10_000;

/// The collision pieces and rigid bodies of a house. Construction reads every mesh; a world over it reads none.
pub struct PhysicsModel {
    pub(crate) house: Arc<House>,
    /// Pieces that never move, in world space: structure in order, then fixed parts in order.
    pub(crate) static_pieces: Vec<CollisionPiece>,
    /// Rigid bodies, in the order of their first parts.
    pub(crate) bodies: Vec<BodyDefinition>,
    /// The body of each part that moves.
    pub(crate) body_of_part: IdVec<PartId, Option<u32>>,
    /// Moving objects without collision pieces of their own, which have convex pieces of their visible mesh.
    pub(crate) fallback_collider_objects: Vec<ObjectId>,
    /// The cylinders of bodies.
    pub(crate) rolling_cylinders: Vec<RollableCylinder>,
    /// The box around all static pieces and bodies at the start, m.
    pub(crate) bounds: Aabb,
}

impl PhysicsModel {
    /// Reads the house's meshes and colliders.
    pub fn new(house: Arc<House>) -> Self {
        plan::plan(house)
    }

    /// The house.
    pub fn house(&self) -> &Arc<House> {
        &self.house
    }

    /// Returns the number of rigid bodies that can move.
    pub fn body_count(&self) -> usize {
        self.bodies.len()
    }

    /// Returns whether static pieces are inserted behind those that move. It depends on the house alone, so that all its worlds
    /// number their pieces alike.
    pub(crate) fn inserts_statics_last(&self) -> bool {
        let moving = self.bodies.iter().map(|plan| plan.pieces.len());
        moving.sum::<usize>() >= MANY_MOVING_PIECES
    }

    /// Returns the number of static pieces.
    pub fn static_piece_count(&self) -> usize {
        self.static_pieces.len()
    }
}

impl fmt::Debug for PhysicsModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PhysicsModel")
            .field("house", &self.house.name)
            .field("bodies", &self.bodies.len())
            .field("static_pieces", &self.static_pieces.len())
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inertia::BodyInertia;
    use dwell_scene::{
        Category, Collider, LevelId, Mesh, Mobility, Object, Part, Pose, ShoeboxMaterials, State,
    };
    use glam::{Affine3A, DMat3, DVec3, Mat3, Quat, Vec3};

    /// An object of one part, in a room.
    fn thing(mesh: Mesh, colliders: Vec<Collider>, density_kg_m3: f32) -> PhysicsModel {
        let room = House::shoebox([4.0, 3.0, 4.0], &ShoeboxMaterials::default()).unwrap();
        let mut data = room.data().clone();
        let mesh = data.meshes.push(Arc::new(mesh));
        data.parts.push(Part {
            object: ObjectId(0),
            name: "body".into(),
            fixed: false,
            world_from_part: Pose::from_position(Vec3::splat(1.0)),
            mesh,
            part_from_mesh: Affine3A::IDENTITY,
            materials: vec![dwell_scene::MaterialId(0)],
            colliders,
            mass_kg: None,
            density_kg_m3,
            inertial: None,
        });
        data.objects.push(Object {
            name: "thing".into(),
            source_id: String::new(),
            model: String::new(),
            category: Category::default(),
            level: LevelId(0),
            room: None,
            mobility: Mobility::Movable,
            pickable: true,
            switch: None,
            first_part: PartId(0),
            part_count: 1,
        });
        PhysicsModel::new(Arc::new(House::new(data).unwrap()))
    }

    /// Mass, centre and inertia of boxes by Steiner's theorem, in f64.
    fn by_hand(boxes: &[(DVec3, DVec3)], density: f64) -> (f64, DVec3, DMat3) {
        let mass = |half: DVec3| density * 8.0 * half.element_product();
        let total: f64 = boxes.iter().map(|(_, half)| mass(*half)).sum();
        let moment: DVec3 = boxes.iter().map(|(at, half)| *at * mass(*half)).sum();
        let center = moment / total;
        let mut inertia = DMat3::ZERO;
        for (at, half) in boxes {
            let (m, s, d) = (mass(*half), *half * *half, *at - center);
            let own = DVec3::new(s.y + s.z, s.x + s.z, s.x + s.y) * (m / 3.0);
            let apart = DMat3::from_diagonal(DVec3::splat(d.length_squared()))
                - DMat3::from_cols(d * d.x, d * d.y, d * d.z);
            inertia += DMat3::from_diagonal(own) + apart * m;
        }
        (total, center, inertia)
    }

    fn apart(a: Mat3, b: DMat3) -> f64 {
        let difference = a.as_dmat3() - b;
        difference
            .to_cols_array()
            .into_iter()
            .map(f64::abs)
            .fold(0.0, f64::max)
    }

    #[test]
    fn an_l_has_the_mass_centre_and_inertia_of_its_two_bars() {
        let bars = [
            (Vec3::new(0.0, 0.05, 0.0), Vec3::new(0.2, 0.05, 0.04)),
            (Vec3::new(-0.15, 0.25, 0.0), Vec3::new(0.05, 0.15, 0.04)),
        ];
        let pieces = bars.map(|(at, half)| Collider::Cuboid {
            part_from_box: Pose::from_position(at),
            half_extents: half,
        });
        let model = thing(Mesh::cuboid(Vec3::ZERO, Vec3::ONE), pieces.to_vec(), 640.0);
        let found = BodyInertia::of(
            &model.house,
            &model.bodies[0],
            &State::new(&model.house),
            &[1.0],
        );
        let boxes = bars.map(|(at, half)| (at.as_dvec3(), half.as_dvec3()));
        let (mass, center, inertia) = by_hand(&boxes, 640.0);
        assert!((f64::from(found.mass_kg) / mass - 1.0).abs() < 1e-5);
        assert!((found.center.as_dvec3() - center).length() < 1e-6);
        // Its off-diagonal entries are not zero: the bars lie on both sides of the centre.
        assert!(inertia.x_axis.y.abs() > 0.01);
        let error = apart(found.tensor, inertia);
        assert!(error < 1e-4 * inertia.x_axis.x, "{error} of {inertia}");
        assert!((f64::from(model.bodies[0].mass_kg(&[1.0])) / mass - 1.0).abs() < 1e-5);
    }

    #[test]
    fn a_turned_piece_turns_its_inertia() {
        let half = Vec3::new(0.3, 0.1, 0.05);
        let turn = Quat::from_rotation_z(0.6) * Quat::from_rotation_x(0.3);
        let piece = Collider::Cuboid {
            part_from_box: Pose::new(Vec3::ZERO, turn),
            half_extents: half,
        };
        let model = thing(Mesh::cuboid(Vec3::ZERO, Vec3::ONE), vec![piece], 500.0);
        let found = BodyInertia::of(
            &model.house,
            &model.bodies[0],
            &State::new(&model.house),
            &[1.0],
        );
        let (_, _, straight) = by_hand(&[(DVec3::ZERO, half.as_dvec3())], 500.0);
        let turn = DMat3::from_quat(turn.as_dquat());
        let expected = turn * straight * turn.transpose();
        assert!(apart(found.tensor, expected) < 1e-4 * expected.x_axis.x);
    }

    /// A mesh without collision pieces: the mass of its pieces is that of its volume, within their overlap.
    #[test]
    fn an_l_without_pieces_is_taken_apart() {
        let mut mesh = Mesh::cuboid(Vec3::ZERO, Vec3::new(0.4, 0.1, 0.08));
        mesh.append(
            &Mesh::cuboid(Vec3::new(0.0, 0.1, 0.0), Vec3::new(0.1, 0.4, 0.08)),
            0,
        );
        let model = thing(mesh, Vec::new(), 640.0);
        assert_eq!(model.fallback_collider_objects, [ObjectId(0)]);
        assert!(model.bodies[0].pieces.len() >= 2);
        let found = BodyInertia::of(
            &model.house,
            &model.bodies[0],
            &State::new(&model.house),
            &[1.0],
        );
        let boxes = [
            (DVec3::new(0.2, 0.05, 0.04), DVec3::new(0.2, 0.05, 0.04)),
            (DVec3::new(0.05, 0.25, 0.04), DVec3::new(0.05, 0.15, 0.04)),
        ];
        let (mass, center, _) = by_hand(&boxes, 640.0);
        // A voxel is 1/32 of the longest edge: 8 % of the thinnest one here.
        assert!(
            (f64::from(found.mass_kg) / mass - 1.0).abs() < 0.1,
            "{} {mass}",
            found.mass_kg
        );
        assert!((found.center.as_dvec3() - center).length() < 0.015);
    }
}
