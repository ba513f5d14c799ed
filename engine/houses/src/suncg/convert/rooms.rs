//! Conversion of rooms and grounds: structure pieces, floors, kinds.

use std::sync::Arc;

use dwell_scene::{Aabb, LevelId, Mesh, Room, RoomId, Structure, StructureKind};
use glam::{Vec2, Vec3};

use super::super::file::{BinaryFlag, SuncgNode};
use super::super::read::paths;
use super::{Converter, NodeKey, place};
use crate::import::room_kind;
use crate::limits::MAX_CORNERS_SHOWN;
use crate::obj::ParsedObj;
use crate::obj::file::FaceGroup;
use crate::obj::{MaterialSlots, ObjGroupSelection, build_mesh};
use crate::report::FileLocation;
use crate::warning_kind::{UnmappedKind, WarningKind};

/// Cosine from which on upward faces belong to the floor that one walks on.
const UPWARD: f32 = 0.7;
/// Depth below a floor's top from which on its pieces are not walked on, m.
const FLOOR_STEP_M: f32 = 0.02;

/// The meshes of a room: file letter, kind, whether the node hides it.
const PARTS: [(char, StructureKind); 3] = [
    ('c', StructureKind::Ceiling),
    ('f', StructureKind::Floor),
    ('w', StructureKind::Wall),
];

impl<'a> Converter<'a> {
    pub(super) fn room(&mut self, key: NodeKey, node: &'a SuncgNode) {
        let at = self.node_at(key);
        let name = self.node_names[key.0][key.1].clone();
        let kinds = self.room_kinds(node, &at);
        let room_id = RoomId(self.data.rooms.len() as u32);
        let level = Self::level_id(key.0);
        let first_piece = self.data.structure.len();
        let hidden = PARTS.map(|(_, kind)| {
            let flag = match kind {
                StructureKind::Ceiling => node.hide_ceiling,
                StructureKind::Floor => node.hide_floor,
                _ => node.hide_walls,
            };
            (flag == Some(BinaryFlag(true))).then_some(kind)
        });
        if self.has_arch() {
            let hidden: Vec<StructureKind> = hidden.into_iter().flatten().collect();
            self.arch_of_node(node, level, Some(room_id), &hidden);
        } else if let Some(model) = self.room_model(node, &at) {
            for (letter, kind) in PARTS
                .into_iter()
                .filter(|(_, kind)| !hidden.contains(&Some(*kind)))
            {
                let path = paths::room_mesh_path(&self.files.scene_id, model, letter);
                self.pieces_of(&path, kind, &name, level, Some(room_id), &at);
            }
        }
        let pieces = first_piece..self.data.structure.len();
        let room = self.room_from_pieces(pieces, name, level, kinds, node, &at);
        self.data.levels[level].bounds = self.data.levels[level].bounds.union(&room.bounds);
        self.data.rooms.push(room);
    }

    pub(super) fn ground(&mut self, key: NodeKey, node: &'a SuncgNode) {
        let at = self.node_at(key);
        let name = self.node_names[key.0][key.1].clone();
        if node.hide_floor == Some(BinaryFlag(true)) {
            return;
        }
        if self.has_arch() {
            return self.arch_of_node(node, Self::level_id(key.0), None, &[]);
        }
        if let Some(model) = self.room_model(node, &at) {
            let path = paths::room_mesh_path(&self.files.scene_id, model, 'f');
            self.pieces_of(
                &path,
                StructureKind::Ground,
                &name,
                Self::level_id(key.0),
                None,
                &at,
            );
        }
    }

    fn room_model(&mut self, node: &'a SuncgNode, at: &FileLocation) -> Option<&'a str> {
        let model = node.model_id.as_deref();
        match model {
            None => {
                let consequence = "it has no walls, floor or ceiling".to_owned();
                self.report.warn(
                    at.field("modelId"),
                    WarningKind::MissingField { consequence },
                );
            }
            Some(id) => {
                if let Some(damage) = paths::invalid_id_reason(id) {
                    self.report.warn(at.field("modelId"), damage);
                    return None;
                }
            }
        }
        model
    }

    fn room_kinds(&mut self, node: &SuncgNode, at: &FileLocation) -> Vec<String> {
        let mut kinds = Vec::new();
        for given in node.room_types.iter().flatten() {
            let kind = room_kind(given).unwrap_or_else(|plain| {
                let damage = WarningKind::Unmapped {
                    what: UnmappedKind::RoomType,
                    name: given.clone(),
                };
                self.report.warn(at.field("roomTypes"), damage);
                plain
            });
            if !kind.is_empty() && !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        // "Room" says nothing; it must not hide what does.
        if kinds.len() > 1 {
            kinds.retain(|kind| kind != "room");
        }
        kinds
    }

    /// One structure piece for each `o` group of a mesh, in file order.
    fn pieces_of(
        &mut self,
        path: &str,
        kind: StructureKind,
        node: &str,
        level: LevelId,
        room: Option<RoomId>,
        at: &FileLocation,
    ) {
        let Some((path, files)) = self.files.meshes.get_key_value(path) else {
            // One that could not be read was reported when it was.
            if !self.files.unreadable.contains(path) {
                let path = path.to_owned();
                self.report
                    .warn(at.clone(), WarningKind::MissingMesh { path });
            }
            return;
        };
        let mesh_at = FileLocation::file(path);
        if files.obj.face_count() == 0 {
            self.report
                .warn(mesh_at, WarningKind::EmptyMesh { path: path.clone() });
            return;
        }
        // Any number of nodes may show the same file.
        let all = self
            .corners_shown
            .saturating_add(files.obj.corners.len() as u64);
        if all > MAX_CORNERS_SHOWN {
            let reason = format!("with it rooms have {all} corners; {MAX_CORNERS_SHOWN} are read");
            let path = path.clone();
            self.report
                .warn(at.clone(), WarningKind::UnreadableMesh { path, reason });
            return;
        }
        self.corners_shown = all;
        let slots = MaterialSlots::from_obj_and_mtl(&files.obj, &files.mtl, &mesh_at, self.report);
        // A group may be interrupted by others: pieces are gathered by name, in the order of their first faces.
        let mut groups: Vec<(&str, Vec<&FaceGroup>)> = Vec::new();
        for run in &files.obj.face_groups {
            let name = if run.object.is_empty() {
                run.group.as_str()
            } else {
                run.object.as_str()
            };
            match groups.iter_mut().find(|(known, _)| *known == name) {
                Some((_, runs)) => runs.push(run),
                None => groups.push((name, vec![run])),
            }
        }
        for (group, runs) in groups {
            let kind = self.piece_kind(group, kind, &mesh_at);
            let base = if group.is_empty() {
                format!("{kind:?}#{node}")
            } else {
                group.to_owned()
            };
            let name = self.structure_names.unique(&base);
            let (mesh, used) = piece_mesh(files, &slots, runs, &mesh_at, self.report);
            let materials = used
                .iter()
                .map(|slot| self.structure_material(files, &slots, *slot, kind))
                .collect();
            let mesh = self.data.meshes.push(Arc::new(self.in_world(mesh)));
            self.data.structure.push(Structure {
                name,
                kind,
                room,
                level,
                mesh,
                materials,
            });
        }
    }

    /// Returns the kind of a piece, by the name of its group.
    fn piece_kind(
        &mut self,
        group: &str,
        of_file: StructureKind,
        at: &FileLocation,
    ) -> StructureKind {
        let kind = match group.split('#').next().unwrap_or("") {
            "Floor" if of_file == StructureKind::Ground => StructureKind::Ground,
            "Floor" => StructureKind::Floor,
            "Ceiling" => StructureKind::Ceiling,
            "Ground" => StructureKind::Ground,
            name if name.starts_with("Wall") => StructureKind::Wall,
            "" => of_file,
            _ => {
                let damage = WarningKind::UnknownPiece {
                    found: group.to_owned(),
                    taken_for: format!("{of_file:?}").to_lowercase(),
                };
                self.report.warn(at.clone(), damage);
                of_file
            }
        };
        // Outside of a building there are no rooms.
        if kind == StructureKind::Floor && of_file == StructureKind::Ground {
            of_file
        } else {
            kind
        }
    }

    pub(super) fn in_world(&self, mut mesh: Mesh) -> Mesh {
        if self.world_from_file != glam::Affine3A::IDENTITY {
            let map = self.world_from_file;
            mesh.positions
                .iter_mut()
                .for_each(|p| *p = map.transform_point3(*p));
            mesh.normals
                .iter_mut()
                .for_each(|n| *n = map.transform_vector3(*n).normalize_or(Vec3::Y));
        }
        mesh
    }

    fn room_from_pieces(
        &mut self,
        pieces: std::ops::Range<usize>,
        name: String,
        level: LevelId,
        kinds: Vec<String>,
        node: &SuncgNode,
        at: &FileLocation,
    ) -> Room {
        let pieces = &self.data.structure.as_slice()[pieces];
        let meshes = |kind| {
            pieces
                .iter()
                .filter(move |piece| piece.kind == kind)
                .map(|piece| &self.data.meshes[piece.mesh])
        };
        let all = pieces.iter().fold(Aabb::EMPTY, |bounds, piece| {
            bounds.union(&self.data.meshes[piece.mesh].bounds())
        });
        let stated = place::bounds(node.bbox.as_ref(), &self.world_from_file);
        let bounds = stated.unwrap_or(all);
        let ceiling_y = meshes(StructureKind::Ceiling)
            .map(|mesh| mesh.bounds().min.y)
            .reduce(f32::min);
        let floor_y = meshes(StructureKind::Floor)
            .map(|mesh| mesh.bounds().max.y)
            .reduce(f32::max);
        let (mut footprint, mut top) = (Vec::new(), floor_y.unwrap_or(bounds.min.y));
        for mesh in meshes(StructureKind::Floor) {
            footprint.extend(horizontal_faces(mesh, 1.0, top - FLOOR_STEP_M..=top));
        }
        if footprint.is_empty() {
            // Without a floor, the ceiling's outline; without that, the box of the walls.
            let under = ceiling_y.unwrap_or(bounds.max.y);
            for mesh in meshes(StructureKind::Ceiling) {
                footprint.extend(horizontal_faces(mesh, -1.0, under..=under + FLOOR_STEP_M));
            }
            if node.hide_floor != Some(BinaryFlag(true)) {
                let consequence =
                    "no floor; the outline is taken from the ceiling or the box".to_owned();
                self.report
                    .warn(at.clone(), WarningKind::MissingField { consequence });
            }
        }
        if footprint.is_empty() && !bounds.is_empty() {
            let corner = |x: f32, z: f32| Vec2::new(x, z);
            let (a, c) = (
                corner(bounds.min.x, bounds.min.z),
                corner(bounds.max.x, bounds.max.z),
            );
            let (b, d) = (
                corner(bounds.max.x, bounds.min.z),
                corner(bounds.min.x, bounds.max.z),
            );
            footprint.extend([[a, b, c], [a, c, d]]);
        }
        if bounds.is_empty() {
            top = 0.0;
        }
        let ceiling_y = ceiling_y.unwrap_or(if bounds.is_empty() { 0.0 } else { bounds.max.y });
        let mut room = Room {
            name,
            level,
            kinds,
            footprint,
            floor_y: top,
            ceiling_y,
            bounds,
        };
        if let Some(below) = room.repair_footprint_and_ceiling() {
            let what = format!(
                "the ceiling is at {below} m, below the floor at {top} m; taken for at the floor"
            );
            self.report
                .warn(at.clone(), WarningKind::Simplified { what });
        }
        room
    }
}

/// The mesh of a piece with its own few slots, and the file's slots that they are.
fn piece_mesh(
    files: &ParsedObj,
    slots: &MaterialSlots,
    runs: Vec<&FaceGroup>,
    at: &FileLocation,
    report: &mut crate::LoadReport,
) -> (Mesh, Vec<u16>) {
    let mut used: Vec<u16> = Vec::new();
    let mut own = Vec::new();
    for run in runs {
        let slot = slots.slot_of_group(run);
        let position = used
            .iter()
            .position(|known| *known == slot)
            .unwrap_or_else(|| {
                used.push(slot);
                used.len() - 1
            });
        own.push((position as u16, run));
    }
    let box_mapping = used.iter().any(|slot| {
        let in_file = slots.entries[usize::from(*slot)].1;
        in_file.is_some_and(|i| files.textures[i].is_some())
    });
    (
        build_mesh(
            &ObjGroupSelection {
                obj: &files.obj,
                face_groups: own,
                box_mapping,
            },
            at,
            report,
        ),
        used,
    )
}

/// Triangles of (x, z) whose faces look up (`sign` 1) or down (-1) at a height.
fn horizontal_faces(
    mesh: &Mesh,
    sign: f32,
    height: std::ops::RangeInclusive<f32>,
) -> Vec<[Vec2; 3]> {
    let mut found = Vec::new();
    for k in 0..mesh.triangles.len() {
        let corners = mesh.corners(k);
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        if normal.y * sign > UPWARD && corners.iter().all(|p| height.contains(&p.y)) {
            found.push(corners.map(|p| Vec2::new(p.x, p.z)));
        }
    }
    found
}
