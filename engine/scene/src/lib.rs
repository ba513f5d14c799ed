//! The nouns of dwell: [`House`], [`State`], ids, spaces, units, materials, laws, random streams, meshes, BVH,
//! navigation.
//!
//! A [`House`] is checked once and never changes; a [`State`] is plain data, one per running world. Engines read both and
//! do not depend on each other.

mod articulation;
mod bounds;
pub mod bvh;
mod collider;
pub mod columnar;
mod error;
pub mod file;
mod fixtures;
mod house;
mod ids;
pub mod interrupt;
pub mod law;
pub mod material;
pub mod math;
mod mesh;
pub mod name_suggestions;
pub mod navigation;
pub mod packing;
pub mod parallel;
pub mod person;
pub mod random;
pub mod rays;
pub mod simd_dispatch;
mod sky;
pub mod space;
mod state;
mod texture;
pub mod units;

pub use articulation::{Joint, JointCommand, JointKind, Mimic, Servo};
pub use bounds::Aabb;
pub use collider::Collider;
pub use error::SceneError;
pub use fixtures::{Light, LightShape, Receptacle, ReceptacleKind, SoundEmitter, SoundFile};
pub use house::{
    AgentStart, Category, Geometry, House, HouseData, Inertial, Level, Mobility, Object, Part,
    PlacedMesh, Room, ShoeboxMaterials, StaticTriangleSource, Structure, StructureKind, SurfaceHit,
    SurfaceOwner,
};
pub use ids::{
    AgentId, Entity, EntityId, Id, IdVec, JointId, LevelId, MaterialId, MeshId, ObjectId, PartId,
    RoomId, SoundFileId, StructureId, TextureId,
};
pub use law::{LawInfo, LawSpec, LawValues};
pub use material::{Bands, Material};
pub use mesh::Mesh;
pub use sky::{Sky, SkyConditions, SkyDome, Weather};
pub use space::Pose;
pub use state::{
    Address, AgentBody, AgentState, BaseState, Contact, DifferentialDrive, Gesture, HolonomicBase,
    JointParameters, LeggedLocomotion, Locomotion, Parameter, PersonBody, PersonColors, PersonGait,
    PersonState, PointingGesture, ReachGesture, ResolvedPersonColors, Side, State,
    SupportDirection, Velocity,
};
pub use texture::Texture;
