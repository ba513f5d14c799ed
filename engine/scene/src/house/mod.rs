//! The house: everything that never changes while worlds run.

mod check;
mod check_rooms;
mod data;
mod fingerprint;
mod footprint;
mod geometry;
mod queries;
mod shoebox;

pub use data::{
    AgentStart, Category, HouseData, Inertial, Level, Mobility, Object, Part, Room, Structure,
    StructureKind,
};
pub(crate) use geometry::normal_matrix;
pub use geometry::{Geometry, PlacedMesh, StaticTriangleSource, SurfaceHit, SurfaceOwner};
pub use shoebox::ShoeboxMaterials;

use crate::error::SceneError;
use crate::fixtures::Receptacle;
use crate::ids::{IdVec, ObjectId};
use crate::parallel::Threads;
use footprint::RoomIndex;
use std::ops::Deref;
use std::sync::OnceLock;

/// A checked, immutable house. Share it as `Arc<House>`: a thousand worlds over one house cost one set of meshes.
///
/// It dereferences to its [`HouseData`]. To change one, clone the data, edit, and make a new house: meshes and textures are
/// shared.
#[derive(Debug)]
pub struct House {
    data: HouseData,
    geometry: OnceLock<Geometry>,
    fingerprint: OnceLock<u64>,
    spaces: OnceLock<IdVec<ObjectId, Vec<u32>>>,
    room_index: OnceLock<RoomIndex>,
}

impl House {
    /// Checks every index, name and range once.
    ///
    /// # Errors
    /// [`SceneError`] with the path, the value found and the allowed ones.
    pub fn new(data: HouseData) -> Result<Self, SceneError> {
        check::check(&data)?;
        Ok(Self {
            data,
            geometry: OnceLock::new(),
            fingerprint: OnceLock::new(),
            spaces: OnceLock::new(),
            room_index: OnceLock::new(),
        })
    }

    /// The triangles of the house baked for rays; made at first use, by the caller's thread: whoever else asks at that moment
    /// waits for no other work.
    pub fn geometry(&self) -> &Geometry {
        self.geometry
            .get_or_init(|| Geometry::bake(&self.data, Threads::ONE))
    }

    /// Makes [`Self::geometry`] by several threads, unless it exists. Nobody waits for this call: who asks meanwhile makes
    /// the same.
    pub fn bake_geometry(&self, threads: Threads) {
        if self.geometry.get().is_none() {
            // The one that loses a race is dropped; they are equal.
            let _ = self.geometry.set(Geometry::bake(&self.data, threads));
        }
    }

    /// Returns a hash of this house: its tables (names, places, masses, collision pieces, joints) and the triangles of its
    /// meshes, not its images or its sky. Computed at first use.
    pub fn fingerprint(&self) -> u64 {
        *self.fingerprint.get_or_init(|| fingerprint::of(&self.data))
    }

    /// Returns the receptacles of an object, in order.
    pub fn receptacles_of(&self, object: ObjectId) -> impl Iterator<Item = &Receptacle> {
        let spaces = self.spaces.get_or_init(|| {
            let mut spaces = IdVec::filled(Vec::new(), self.data.objects.len());
            for (k, space) in self.data.receptacles.iter().enumerate() {
                spaces[space.object].push(k as u32);
            }
            spaces
        });
        let own = spaces[object].iter();
        own.map(|k| &self.data.receptacles[*k as usize])
    }

    fn room_index(&self) -> &RoomIndex {
        self.room_index
            .get_or_init(|| RoomIndex::new(&self.data.rooms))
    }

    /// Returns the plain data, for editing and writing.
    pub fn data(&self) -> &HouseData {
        &self.data
    }
}

impl Clone for House {
    fn clone(&self) -> Self {
        Self {
            data: self.data.clone(),
            geometry: OnceLock::new(),
            fingerprint: OnceLock::new(),
            spaces: OnceLock::new(),
            room_index: OnceLock::new(),
        }
    }
}

impl PartialEq for House {
    fn eq(&self, other: &Self) -> bool {
        self.data == other.data
    }
}

impl Deref for House {
    type Target = HouseData;
    fn deref(&self) -> &HouseData {
        &self.data
    }
}
