//! Structure pieces as the meshes of rooms and grounds.

use dwell_scene::{LevelId, MaterialId, Room, RoomId, Structure, StructureKind};
use glam::Affine3A;

use super::super::file::{BinaryFlag, SuncgNode};
use super::{SuncgWriter, bounds};
use crate::error::HousesError;
use crate::obj::ObjWriter;

/// Returns whether a piece of `level` needs a room of its own: it is in none and is no ground.
pub(super) fn needs_own_room(piece: &Structure, level: LevelId) -> bool {
    piece.level == level && piece.room.is_none() && piece.kind != StructureKind::Ground
}

/// The file that a piece belongs to.
fn mesh_file_letter(kind: StructureKind) -> char {
    match kind {
        StructureKind::Ceiling => 'c',
        StructureKind::Floor | StructureKind::Ground => 'f',
        StructureKind::Wall | StructureKind::Other => 'w',
    }
}

/// The group name of a piece: its own where that means its kind, else with the kind before it.
fn group_name(piece: &Structure) -> String {
    let kind = match piece.kind {
        StructureKind::Ceiling => "Ceiling",
        StructureKind::Floor => "Floor",
        StructureKind::Ground => "Ground",
        StructureKind::Wall | StructureKind::Other => "Wall",
    };
    let starts = piece.name.split('#').next().unwrap_or("");
    let says_so = starts == kind || (kind == "Wall" && starts.starts_with("Wall"));
    if says_so {
        piece.name.clone()
    } else {
        format!("{kind}#{}", piece.name)
    }
}

impl SuncgWriter<'_> {
    /// The node of a room, or of the pieces of a storey without a room.
    pub(super) fn room_node(
        &self,
        level: LevelId,
        index: usize,
        room: Option<(RoomId, &Room)>,
    ) -> Result<SuncgNode, HousesError> {
        let model = format!("fr_{}rm_{index}", level.0);
        let id = room.map(|(id, _)| id);
        let belongs = |piece: &Structure| match id {
            Some(id) => piece.room == Some(id),
            None => needs_own_room(piece, level),
        };
        let mut node = SuncgNode {
            id: Some(format!("{}_{index}", level.0)),
            kind: Some("Room".to_owned()),
            valid: Some(BinaryFlag(true)),
            model_id: Some(model.clone()),
            room_types: Some(room.map_or_else(Vec::new, |(_, room)| {
                room.kinds.iter().map(|kind| room_type(kind)).collect()
            })),
            bbox: room.and_then(|(_, room)| bounds(&room.bounds)),
            ..SuncgNode::default()
        };
        for part in ['c', 'f', 'w'] {
            let pieces: Vec<&Structure> = self
                .house
                .structure
                .iter()
                .filter(|piece| belongs(piece) && mesh_file_letter(piece.kind) == part)
                .collect();
            if pieces.is_empty() {
                let hidden = match part {
                    'c' => &mut node.hide_ceiling,
                    'f' => &mut node.hide_floor,
                    _ => &mut node.hide_walls,
                };
                *hidden = Some(BinaryFlag(true));
            } else {
                self.pieces(&format!("{model}{part}"), &pieces)?;
            }
        }
        Ok(node)
    }

    /// A node for each piece of ground.
    pub(super) fn ground_nodes(
        &self,
        level: LevelId,
        first: usize,
    ) -> Result<Vec<SuncgNode>, HousesError> {
        let pieces =
            self.house.structure.iter().filter(|p| {
                p.level == level && p.room.is_none() && p.kind == StructureKind::Ground
            });
        let mut nodes = Vec::new();
        for (k, piece) in pieces.enumerate() {
            let model = format!("fr_{}gd_{k}", level.0);
            self.pieces(&format!("{model}f"), &[piece])?;
            nodes.push(SuncgNode {
                id: Some(format!("{}_{}", level.0, first + k)),
                kind: Some("Ground".to_owned()),
                valid: Some(BinaryFlag(true)),
                model_id: Some(model),
                bbox: bounds(&self.house.meshes[piece.mesh].bounds()),
                ..SuncgNode::default()
            });
        }
        Ok(nodes)
    }

    /// An OBJ file with a group for each piece, and its MTL file.
    fn pieces(&self, file: &str, pieces: &[&Structure]) -> Result<(), HousesError> {
        let mut materials: Vec<MaterialId> = Vec::new();
        for id in pieces.iter().flat_map(|piece| &piece.materials) {
            if !materials.contains(id) {
                materials.push(*id);
            }
        }
        let mut obj = ObjWriter::default();
        let position =
            |id: MaterialId| materials.iter().position(|known| *known == id).unwrap_or(0);
        let name = |k: usize, id: MaterialId| format!("{}_{k}", self.house.materials[id].substance);
        for piece in pieces {
            let mesh = &self.house.meshes[piece.mesh];
            obj.mesh(
                Some(&group_name(piece)),
                mesh,
                &Affine3A::IDENTITY,
                |slot| {
                    let id = piece.materials[usize::from(slot)];
                    name(position(id), id)
                },
            );
        }
        let folder = format!("room/{}", self.scene_id);
        let text = obj.into_text(&format!("{file}.mtl"));
        self.file(&format!("{folder}/{file}.obj"), text.as_bytes())?;
        let mtl = self.mtl(&materials, |k, _| name(k, materials[k]));
        self.file(&format!("{folder}/{file}.mtl"), mtl.as_bytes())
    }
}

/// A room type as the format spells it: `Living_Room` of `"living room"`.
fn room_type(kind: &str) -> String {
    let capital = |word: &str| {
        let mut letters = word.chars();
        letters
            .next()
            .map(|first| first.to_uppercase().chain(letters).collect::<String>())
            .unwrap_or_default()
    };
    kind.split(' ').map(capital).collect::<Vec<_>>().join("_")
}
