//! Structure pieces of the second release, which states walls instead of meshes.

use std::sync::Arc;

use dwell_scene::{LevelId, RoomId, Structure, StructureKind};

use super::super::arch::{ArchElement, ElementKind, slab, wall};
use super::super::file::SuncgNode;
use super::Converter;
use crate::report::FileLocation;
use crate::warning_kind::WarningKind;

impl<'a> Converter<'a> {
    /// Returns whether the walls are in `arch.json`.
    pub(super) fn has_arch(&self) -> bool {
        self.files.arch.is_some()
    }

    /// The elements of a room's or a ground's node; one that two rooms share goes to the first.
    pub(super) fn arch_of_node(
        &mut self,
        node: &SuncgNode,
        level: LevelId,
        room: Option<RoomId>,
        hidden: &[StructureKind],
    ) {
        let ids = [node.id.as_deref(), node.model_id.as_deref()];
        let belongs = |element: &ArchElement| {
            element
                .rooms
                .iter()
                .any(|room| ids.contains(&Some(room.as_str())))
        };
        self.add_arch_elements(belongs, level, room, hidden);
    }

    /// Adds the elements that no node claimed.
    pub(super) fn add_unclaimed_arch_elements(&mut self) {
        if !self.data.levels.is_empty() {
            self.add_arch_elements(|_| true, LevelId(0), None, &[]);
        }
    }

    fn add_arch_elements(
        &mut self,
        wanted: impl Fn(&ArchElement) -> bool,
        level: LevelId,
        room: Option<RoomId>,
        hidden: &[StructureKind],
    ) {
        let Some((path, arch)) = &self.files.arch else {
            return;
        };
        self.arch_used.resize(arch.elements.len(), false);
        for (k, element) in arch.elements.iter().enumerate() {
            if self.arch_used[k] || !wanted(element) {
                continue;
            }
            self.arch_used[k] = true;
            let at = FileLocation::file(path).field(format_args!("elements[{k}]"));
            let kind = match element.kind {
                ElementKind::Wall => StructureKind::Wall,
                ElementKind::Floor => StructureKind::Floor,
                ElementKind::Ceiling => StructureKind::Ceiling,
                ElementKind::Ground => StructureKind::Ground,
            };
            if !hidden.contains(&kind) {
                self.arch_piece(element, kind, level, room, &at);
            }
        }
    }

    fn arch_piece(
        &mut self,
        element: &'a ArchElement,
        kind: StructureKind,
        level: LevelId,
        room: Option<RoomId>,
        at: &FileLocation,
    ) {
        let mesh = if kind == StructureKind::Wall {
            wall(element)
        } else {
            slab(element)
        };
        if mesh.triangles.is_empty() {
            return self.report.warn(
                at.clone(),
                WarningKind::EmptyMesh {
                    path: element.id.clone(),
                },
            );
        }
        // Two sides and a rim; a single material covers both sides.
        let sides = [
            element.materials.first(),
            element.materials.get(1).or(element.materials.first()),
            None,
        ];
        let materials = sides
            .map(|side| self.plain_structure_material(side, kind, at))
            .to_vec();
        let base = if element.id.is_empty() {
            format!("{kind:?}")
        } else {
            element.id.clone()
        };
        let name = self.structure_names.unique(&base);
        let mesh = self.in_world(mesh);
        let bounds = mesh.bounds();
        self.data.levels[level].bounds = self.data.levels[level].bounds.union(&bounds);
        let mesh = self.data.meshes.push(Arc::new(mesh));
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
