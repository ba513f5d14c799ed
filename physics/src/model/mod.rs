//! What physics makes of a house, once: collision pieces and rigid bodies. All worlds over a house share it.

mod plan;
pub(crate) mod shapes;

pub(crate) use plan::{BodyPlan, Cover, Owner, Piece};

use dwell_scene::{Aabb, House, IdVec, ObjectId, PartId};
use std::fmt;
use std::sync::Arc;

/// The collision pieces and rigid bodies of a house. Making one reads every mesh; a world over it reads none.
pub struct PhysicsModel {
    pub(crate) house: Arc<House>,
    /// Pieces that never move, in world space: structure in order, then fixed parts in order.
    pub(crate) statics: Vec<Piece>,
    /// Rigid bodies, in the order of their first parts.
    pub(crate) bodies: Vec<BodyPlan>,
    /// The body of each part that moves.
    pub(crate) body_of_part: IdVec<PartId, Option<u32>>,
    /// Objects that move and came without collision pieces: they have the hull of what is seen.
    pub(crate) stand_ins: Vec<ObjectId>,
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

    /// How many rigid bodies can move.
    pub fn body_count(&self) -> usize {
        self.bodies.len()
    }

    /// How many pieces never move.
    pub fn static_piece_count(&self) -> usize {
        self.statics.len()
    }
}

impl fmt::Debug for PhysicsModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PhysicsModel")
            .field("house", &self.house.name)
            .field("bodies", &self.bodies.len())
            .field("static_pieces", &self.statics.len())
            .finish_non_exhaustive()
    }
}
