//! Names of nodes, and which room lists which node.

use std::collections::{BTreeMap, BTreeSet};

use dwell_scene::RoomId;

use super::super::file::SuncgHouse;
use super::{Converter, NodeKey};
use crate::import::UniqueNames;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// A name for every node: its id, or `<level>_<index>`; ids used twice get a number.
pub(super) fn names(
    house: &SuncgHouse,
    at: &FileLocation,
    report: &mut LoadReport,
) -> Vec<Vec<String>> {
    let mut names = UniqueNames::default();
    let mut all = Vec::new();
    for (k, level) in house.levels.iter().enumerate() {
        let mut of_level = Vec::new();
        for (i, node) in level.nodes.iter().enumerate() {
            let at = at.field(format_args!("levels[{k}].nodes[{i}].id"));
            let given = node.id.as_deref().filter(|id| !id.is_empty());
            let name = names.unique(&given.map_or_else(|| format!("{k}_{i}"), str::to_owned));
            match given {
                Some(id) if id != name => {
                    report.warn(
                        at,
                        WarningKind::DuplicateId {
                            id: id.to_owned(),
                            renamed: name.clone(),
                        },
                    );
                }
                None if node.is_valid() => report.warn(
                    at,
                    WarningKind::MissingId {
                        given: name.clone(),
                    },
                ),
                _ => {}
            }
            of_level.push(name);
        }
        all.push(of_level);
    }
    all
}

impl Converter<'_> {
    /// The room that lists each node. A room may come after its nodes; the first room to list a node keeps it.
    pub(super) fn node_rooms(&mut self) -> BTreeMap<NodeKey, RoomId> {
        let mut rooms = BTreeMap::new();
        for (id, key) in self.room_nodes() {
            let (level, index) = key;
            let nodes = &self.files.house.levels[level].nodes;
            let at = self.node_at(key).field("nodeIndices");
            let mut own = BTreeSet::new();
            for &number in nodes[index].node_indices.iter().flatten() {
                let child = number as usize;
                let reason =
                    if number.fract() != 0.0 || !(0.0..nodes.len() as f64).contains(&number) {
                        Some(format!(
                            "whole numbers from 0 to {} are",
                            nodes.len().saturating_sub(1)
                        ))
                    } else if child == index {
                        Some("it is the room itself".to_owned())
                    } else if nodes[child].kind.as_deref() == Some("Room") {
                        Some("it is a room".to_owned())
                    } else {
                        None
                    };
                if let Some(reason) = reason {
                    self.report.warn(
                        at.clone(),
                        WarningKind::BadIndex {
                            found: number.to_string(),
                            reason,
                        },
                    );
                    continue;
                }
                // Repeats within a room and nodes that are not valid are common and harmless.
                if !own.insert(child) || !nodes[child].is_valid() {
                    continue;
                }
                if let Some(first) = rooms.insert((level, child), id) {
                    rooms.insert((level, child), first);
                    let name = |room: RoomId| self.data.rooms[room].name.clone();
                    let node = self.node_names[level][child].clone();
                    self.report.warn(
                        at.clone(),
                        WarningKind::InTwoRooms {
                            node,
                            first: name(first),
                            second: name(id),
                        },
                    );
                }
            }
        }
        rooms
    }

    /// The node of each room, in order.
    fn room_nodes(&self) -> Vec<(RoomId, NodeKey)> {
        let nodes = self.files.house.valid_nodes();
        let rooms = nodes.filter(|(_, node)| node.kind.as_deref() == Some("Room"));
        let keys = rooms.map(|(key, _)| key);
        self.data.rooms.ids().zip(keys).collect()
    }
}
