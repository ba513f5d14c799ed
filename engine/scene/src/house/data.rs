//! The tables of a house.

use crate::articulation::Joint;
use crate::bounds::Aabb;
use crate::collider::Collider;
use crate::fixtures::{Light, Receptacle, SoundEmitter, SoundFile};
use crate::ids::{
    IdVec, JointId, LevelId, MaterialId, MeshId, ObjectId, PartId, RoomId, SoundFileId,
    StructureId, TextureId,
};
use crate::material::Material;
use crate::mesh::Mesh;
use crate::sky::Sky;
use crate::space::Pose;
use crate::texture::Texture;
use glam::{Affine3A, Vec2, Vec3};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// All tables of a house, in file order. Plain data: [`House::new`](crate::House::new) checks it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HouseData {
    /// The name: the source's id or the file's name.
    pub name: String,
    /// Its source: format and version, such as `"suncg@1.0.0"`.
    pub source: String,
    /// Storeys, from the lowest.
    pub levels: IdVec<LevelId, Level>,
    /// Rooms.
    pub rooms: IdVec<RoomId, Room>,
    /// Walls, floors and ceilings. Their meshes are in world space.
    pub structure: IdVec<StructureId, Structure>,
    /// Objects.
    pub objects: IdVec<ObjectId, Object>,
    /// Rigid parts of all objects; an object's parts stand together, in the order of the objects.
    pub parts: IdVec<PartId, Part>,
    /// Joints.
    pub joints: IdVec<JointId, Joint>,
    /// Meshes, shared between instances of a model.
    pub meshes: IdVec<MeshId, Arc<Mesh>>,
    /// Materials; names are unique.
    pub materials: IdVec<MaterialId, Material>,
    /// Texture images.
    pub textures: IdVec<TextureId, Arc<Texture>>,
    /// Lamps' lights.
    pub lights: Vec<Light>,
    /// Sound emitters.
    pub emitters: Vec<SoundEmitter>,
    /// Receptacles.
    pub receptacles: Vec<Receptacle>,
    /// Sun and sky; `None`: unknown.
    #[serde(default)]
    pub sky: Option<Sky>,
    /// Sound files that emitters name, shared between them.
    #[serde(default, skip_serializing_if = "IdVec::is_empty")]
    pub sound_files: IdVec<SoundFileId, Arc<SoundFile>>,
    /// Start poses of agents, the first agent first; agents beyond them start in the first room.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub agent_starts: Vec<AgentStart>,
}

/// The start pose of an agent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AgentStart {
    /// Position of its feet, m.
    pub position: Vec3,
    /// Heading, rad to the left of -Z.
    pub yaw_rad: f32,
}

impl AgentStart {
    /// The largest number in a house: as many as a world has agents.
    pub const MAX_PER_HOUSE: usize = 64;
}

/// A storey.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Level {
    /// The source's name for it.
    pub name: String,
    /// The box around everything on it, m.
    pub bounds: Aabb,
}

/// A room.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Room {
    /// The name, unique in the house: the source's id.
    pub name: String,
    /// The storey.
    pub level: LevelId,
    /// Kinds of room, in plain lower-case words (`"living room"`), most fitting first; may be empty.
    pub kinds: Vec<String>,
    /// The floor seen from above as triangles of (x, z) with an area, m; they may overlap those of other rooms, but not each
    /// other.
    pub footprint: Vec<[Vec2; 3]>,
    /// Height of the walkable floor, m.
    pub floor_y: f32,
    /// Height of the ceiling's lower face, m; at least `floor_y`.
    pub ceiling_y: f32,
    /// The box of the source file (it may stick out through doors), m.
    pub bounds: Aabb,
}

impl Room {
    /// The largest number in a house, since a point is looked up in every room. Houses of SUNCG and ProcTHOR have some dozens.
    pub const MAX_PER_HOUSE: usize = 500;

    /// Puts right what importers cannot rule out: leaves triangles without area out of the footprint, and lifts a ceiling below
    /// the floor to the floor. Returns the height of such a ceiling, m.
    pub fn repair_footprint_and_ceiling(&mut self) -> Option<f32> {
        self.footprint.retain(super::check_rooms::has_area);
        let below = (self.ceiling_y < self.floor_y).then_some(self.ceiling_y);
        self.ceiling_y = self.ceiling_y.max(self.floor_y);
        below
    }
}

/// The kind of a structure piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StructureKind {
    /// A wall, or one shell of a wall.
    Wall,
    /// A floor.
    Floor,
    /// A ceiling.
    Ceiling,
    /// The ground outside.
    Ground,
    /// A box that belongs to the building.
    Other,
}

/// A wall, floor or ceiling piece; never moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Structure {
    /// The name, unique in the house, such as `"WallInside#0_0_0"`.
    pub name: String,
    /// Its kind.
    pub kind: StructureKind,
    /// The room it borders, if one is known.
    pub room: Option<RoomId>,
    /// The storey.
    pub level: LevelId,
    /// Its triangles in world space.
    pub mesh: MeshId,
    /// The material of each slot of the mesh.
    pub materials: Vec<MaterialId>,
}

/// The category of an object, in several vocabularies; empty where unknown.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Category {
    /// The finest name: `"coffee_table"`.
    pub fine: String,
    /// The coarse name, a row of `assets/categories.csv` where possible: `"table"`.
    pub coarse: String,
    /// The NYU-40 name.
    pub nyu40: String,
}

/// The mobility of an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mobility {
    /// It never moves.
    Fixed,
    /// Its base is fixed, but its joints move: doors, cabinets.
    Articulated,
    /// It is a free body.
    Movable,
}

/// An object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Object {
    /// The name, unique in the house, such as `"chair_2"`.
    pub name: String,
    /// The source's id of the node.
    pub source_id: String,
    /// The model it is an instance of.
    pub model: String,
    /// Its category.
    pub category: Category,
    /// The storey it starts on.
    pub level: LevelId,
    /// The room it starts in.
    pub room: Option<RoomId>,
    /// Its mobility.
    pub mobility: Mobility,
    /// True if a hand can take it by its shape and use; physics judges weight and size.
    pub pickable: bool,
    /// True if it starts switched on; `None` when it has no switch.
    pub switch: Option<bool>,
    /// Its first part. The parts of an object are consecutive; the first is its root.
    pub first_part: PartId,
    /// The number of its parts, at least one.
    pub part_count: u32,
}

impl Object {
    /// The ids of its parts, the root first.
    pub fn parts(&self) -> impl DoubleEndedIterator<Item = PartId> + ExactSizeIterator + use<> {
        (self.first_part.0..self.first_part.0 + self.part_count).map(PartId)
    }
}

/// A rigid part of an object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// The object it belongs to.
    pub object: ObjectId,
    /// The name, unique in its object: `"leaf"`, `"seat"`.
    pub name: String,
    /// True for a part that never moves; such parts are baked into the static geometry.
    pub fixed: bool,
    /// Its pose at the start.
    pub world_from_part: Pose,
    /// Its mesh.
    pub mesh: MeshId,
    /// Scale, mirror and offset of the mesh on the part.
    pub part_from_mesh: Affine3A,
    /// The material of each slot of the mesh.
    pub materials: Vec<MaterialId>,
    /// Convex pieces (or [`Collider::ExactMesh`] for a fixed part) in part space; empty: it collides with nothing.
    pub colliders: Vec<Collider>,
    /// Mass, kg; `None`: volume of the colliders times `density_kg_m3`.
    pub mass_kg: Option<f32>,
    /// Mean density of the colliders' volume, kg/m³ (a cupboard is mostly air).
    pub density_kg_m3: f32,
    /// Centre of mass and inertia as measured or given, for a part with a `mass_kg`; `None`: those of the colliders at
    /// uniform density.
    #[serde(default)]
    pub inertial: Option<Inertial>,
}

/// The mass, centre of mass and inertia of a part.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Inertial {
    /// The centre of mass with the principal axes, on the part.
    pub part_from_principal: Pose,
    /// The principal moments of inertia about the centre of mass, kg·m².
    pub moments: Vec3,
}

impl Inertial {
    /// Returns whether it is physically possible: finite, moments above 0, none above the sum of the other two (by more
    /// than 1 in 1000, which rounded files exceed).
    pub fn is_valid(&self) -> bool {
        let m = self.moments;
        self.part_from_principal.is_valid()
            && m.is_finite()
            && m.min_element() > 0.0
            && m.max_element() <= (m.element_sum() - m.max_element()) * 1.001
    }
}
