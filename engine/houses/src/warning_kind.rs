//! Kinds of survived damage.

use std::fmt;

use serde::{Deserialize, Serialize};

/// The kind of a warning: what was wrong, and what was done about it.
#[derive(
    Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, thiserror::Error,
)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum WarningKind {
    /// Something that a generated house should have had but does not.
    #[error("given up: {what}")]
    Omitted {
        /// The omitted thing.
        what: String,
    },
    /// A thing outside of every room; it stays there.
    #[error("stands outside of every room")]
    OutsideRooms,
    /// A thing inside of another one; it stays there, and physics pushes them apart.
    #[error("stands in {other:?}")]
    Overlap {
        /// The other thing.
        other: String,
    },
    /// A thing in a wall, or through it; it stays there.
    #[error("reaches into a wall")]
    InWall,
    /// A mesh file that does not exist; the thing has no shape from it.
    #[error("mesh {path:?} does not exist; left out")]
    MissingMesh {
        /// Relative to the data root.
        path: String,
    },
    /// A mesh file that could not be read.
    #[error("mesh {path:?} could not be read ({reason}); left out")]
    UnreadableMesh {
        /// Relative to the data root.
        path: String,
        /// The reason.
        reason: String,
    },
    /// A mesh file without a triangle.
    #[error("mesh {path:?} has no triangle; left out")]
    EmptyMesh {
        /// Relative to the data root.
        path: String,
    },
    /// A texture that does not exist; the plain colour is used.
    #[error("texture {path:?} does not exist; the plain colour is used")]
    MissingTexture {
        /// Relative to the data root, or the name in an override.
        path: String,
    },
    /// A texture that could not be decoded; the plain colour is used.
    #[error("texture {path:?} could not be read ({reason}); the plain colour is used")]
    UnreadableTexture {
        /// Relative to the data root.
        path: String,
        /// The reason.
        reason: String,
    },
    /// An image that ends too early; the missing part is grey.
    #[error("texture {path:?} ends too early; what is missing of it is grey")]
    TruncatedTexture {
        /// Relative to the data root.
        path: String,
    },
    /// A material file that does not exist; grey is used.
    #[error("material file {path:?} does not exist; its materials are grey")]
    MissingMaterialFile {
        /// Relative to the data root.
        path: String,
    },
    /// A material file that could not be read; grey is used.
    #[error("material file {path:?} could not be read ({reason}); its materials are grey")]
    UnreadableMaterialFile {
        /// Relative to the data root.
        path: String,
        /// The reason.
        reason: String,
    },
    /// A material that no material file defines; grey is used.
    #[error("material {name:?} is not defined; grey is used")]
    MissingMaterial {
        /// Its name.
        name: String,
    },
    /// A material defined twice in one file; the first definition counts.
    #[error("material {name:?} is defined again; the first definition counts")]
    DuplicateMaterial {
        /// Its name.
        name: String,
    },
    /// Vertices with a coordinate that is no finite number; the coordinate became 0.
    #[error("vertex coordinates that are not finite numbers; set to 0")]
    NanVertices,
    /// Texture coordinates or normals that are no finite numbers.
    #[error("texture coordinates or normals that are not finite numbers; replaced")]
    NanAttributes,
    /// Triangles without area; kept, no ray hits them.
    #[error("triangles without area; kept, nothing can hit them")]
    DegenerateTriangles,
    /// Faces that cross themselves, or concave ones of more than 4096 corners; each a fan of triangles, which may cover more than it.
    #[error(
        "faces that cross themselves, or concave ones of more than 4096 corners; they may cover more than they should"
    )]
    UnfilledFaces,
    /// A face that cannot be a polygon; left out.
    #[error("a face is left out: {reason}")]
    BadFace {
        /// The reason.
        reason: String,
    },
    /// A primitive of a mesh that cannot be read; left out with all of its faces.
    #[error("a primitive is left out with all of its faces: {reason}")]
    BadPrimitive {
        /// The reason.
        reason: String,
    },
    /// A statement of the file that is not understood; ignored.
    #[error("{found:?} is not understood; ignored")]
    BadStatement {
        /// The statement, shortened.
        found: String,
    },
    /// A field with a value of the wrong kind; treated as absent.
    #[error("found {found}, expected {expected}; treated as absent")]
    BadField {
        /// The value, shortened.
        found: String,
        /// The value that the reader expects.
        expected: String,
    },
    /// A field that is missing although needed.
    #[error("missing; {consequence}")]
    MissingField {
        /// The consequence.
        consequence: String,
    },
    /// A matrix without a valid pose.
    #[error("no usable transform ({reason}); the node is left out")]
    BadTransform {
        /// The reason.
        reason: String,
    },
    /// A matrix that shears: held by the mesh instead of the pose.
    #[error("the transform shears; it is baked into a mesh of its own")]
    Shear,
    /// An id used twice; the later one was renamed.
    #[error("id {id:?} is used again; renamed to {renamed:?}")]
    DuplicateId {
        /// The id in the file.
        id: String,
        /// The id given instead.
        renamed: String,
    },
    /// An id that is missing; one was given.
    #[error("has no id; {given:?} was given")]
    MissingId {
        /// The id given.
        given: String,
    },
    /// An index that points nowhere; ignored.
    #[error("index {found} points at nothing usable ({reason}); ignored")]
    BadIndex {
        /// The value in the file.
        found: String,
        /// The reason why it is not usable.
        reason: String,
    },
    /// A node claimed by two rooms; the first keeps it.
    #[error("node {node:?} is listed by room {second:?} too; room {first:?} keeps it")]
    InTwoRooms {
        /// The node.
        node: String,
        /// The room that keeps it.
        first: String,
        /// The room that lists it too.
        second: String,
    },
    /// A node type this format does not have; left out.
    #[error("node type {found:?} is unknown; the node is left out")]
    UnknownNodeType {
        /// The type in the file.
        found: String,
    },
    /// A model whose second state has no file of its own; the first is used.
    #[error("state {state} asks for {path:?}, which does not exist; the base mesh is used")]
    MissingVariant {
        /// The state in the file.
        state: i64,
        /// Relative to the data root.
        path: String,
    },
    /// A colour that is not `#rrggbb`; ignored.
    #[error("colour {found:?} is not #rrggbb; ignored")]
    BadColor {
        /// The text in the file.
        found: String,
    },
    /// More material overrides than the model has materials; the rest is ignored.
    #[error("{found} overrides for {allowed} materials; the rest is ignored")]
    ExtraOverrides {
        /// Overrides in the file.
        found: usize,
        /// Materials of the model.
        allowed: usize,
    },
    /// A path that would leave the data root; not opened.
    #[error("path {path:?} leaves the house's folder; not opened")]
    PathRefused {
        /// The path as written.
        path: String,
    },
    /// A missing metadata table.
    #[error("table {path:?} does not exist; {consequence}")]
    MissingTable {
        /// Relative to the data root.
        path: String,
        /// The consequence.
        consequence: String,
    },
    /// A metadata table that is there and cannot be read: nothing of it is known.
    #[error("table {path:?} could not be read ({reason}); {consequence}")]
    UnreadableTable {
        /// Relative to the data root.
        path: String,
        /// Why.
        reason: String,
        /// The consequence of it.
        consequence: String,
    },
    /// A metadata row that could not be read.
    #[error("a row could not be read ({reason}); left out")]
    BadRow {
        /// The reason.
        reason: String,
    },
    /// A group of a room's mesh that names no wall, floor or ceiling.
    #[error("group {found:?} names no wall, floor or ceiling; taken for {taken_for}")]
    UnknownPiece {
        /// The group's name.
        found: String,
        /// The interpretation.
        taken_for: String,
    },
    /// A name our tables do not know; the thing exists, its meaning is open.
    #[error("{what} {name:?} is unknown to our tables")]
    Unmapped {
        /// The kind of name.
        what: UnmappedKind,
        /// The name.
        name: String,
    },
    /// Something that the source cannot state exactly, or that we hold in a simpler form.
    #[error("{what}")]
    Simplified {
        /// The simplified feature, and its replacement.
        what: String,
    },
}

/// The kind of an unmapped name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum UnmappedKind {
    /// A model id without a row in the category table, or with a class that is none of `assets/categories.csv`.
    Category,
    /// A texture or material name without a substance.
    Substance,
    /// A room type nobody listed.
    RoomType,
}

impl fmt::Display for UnmappedKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Category => "the category of model",
            Self::Substance => "the substance of",
            Self::RoomType => "room type",
        })
    }
}
