//! Moving obstacles: parts of objects, and the columns that each of them occupies.

use super::config::{DoorPolicy, NavConfig};
use super::heightfield::{GridFrame, HeightSpan, merge_spans};
use super::static_grid::{StaticNavGrid, leaf_transform};
use crate::house::House;
use crate::ids::PartId;
use crate::interrupt::CancelPoller;
use crate::state::State;
use glam::{Affine3A, Vec3};
use std::collections::BTreeMap;

/// Openness from which a door counts as open.
const MIN_OPENNESS: f32 = 0.8;

/// Triangles between checks for cancellation.
const TRIANGLES_PER_CHECK: usize = 64;

/// A part that moves.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Obstacle {
    pub(super) part: PartId,
    /// Its transform; `None` while an agent holds it.
    world_from_part: Option<Affine3A>,
    /// The columns that it occupies, in order.
    columns: Vec<(u32, HeightSpan)>,
}

/// All parts that move, and the columns that they occupy.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Obstacles {
    parts: Vec<Obstacle>,
    /// For each column with a moving part, the spans by position in `parts`.
    filled: BTreeMap<u32, Vec<(u32, HeightSpan)>>,
}

/// The changes found by [`Obstacles::update_poses`].
pub(super) struct ObstacleChanges {
    /// Number of parts that moved.
    pub(super) parts: usize,
    /// The columns that they left or entered, in order, each once.
    pub(super) columns: Vec<u32>,
}

impl Obstacles {
    /// All parts that move, not placed yet.
    pub(super) fn new(house: &House) -> Self {
        let nowhere = |part: &PartId| Obstacle {
            part: *part,
            world_from_part: None,
            columns: Vec::new(),
        };
        Self {
            parts: house.geometry().movable.iter().map(nowhere).collect(),
            filled: BTreeMap::new(),
        }
    }

    /// Returns the number of parts.
    pub(super) fn len(&self) -> usize {
        self.parts.len()
    }

    /// Moves every part to its pose in `state`.
    pub(super) fn update_poses(
        &mut self,
        house: &House,
        state: &State,
        ground: &StaticNavGrid,
        config: &NavConfig,
    ) -> ObstacleChanges {
        let mut moved = ObstacleChanges {
            parts: 0,
            columns: Vec::new(),
        };
        for (k, obstacle) in self.parts.iter_mut().enumerate() {
            let place = unheld_part_transform(house, state, ground, config, obstacle.part);
            if place == obstacle.world_from_part {
                continue;
            }
            let columns = place.map_or_else(Vec::new, |world_from_part| {
                rasterize_part(house, &ground.frame, obstacle.part, &world_from_part)
            });
            moved.parts += 1;
            for (column, _) in &obstacle.columns {
                if let Some(spans) = self.filled.get_mut(column) {
                    spans.retain(|(part, _)| *part as usize != k);
                    if spans.is_empty() {
                        self.filled.remove(column);
                    }
                }
            }
            for (column, span) in &columns {
                let spans = self.filled.entry(*column).or_default();
                let place = spans.partition_point(|(part, _)| *part as usize <= k);
                spans.insert(place, (k as u32, *span));
            }
            let touched = obstacle.columns.iter().chain(&columns);
            moved.columns.extend(touched.map(|(column, _)| *column));
            obstacle.world_from_part = place;
            obstacle.columns = columns;
        }
        moved.columns.sort_unstable();
        moved.columns.dedup();
        moved
    }

    /// Returns the spans of the parts in a column.
    pub(super) fn at(&self, column: u32) -> impl Iterator<Item = HeightSpan> + '_ {
        let spans = self.filled.get(&column).map_or(&[][..], Vec::as_slice);
        spans.iter().map(|(_, span)| *span)
    }
}

/// Returns the openness of a passage's door in `state`, 0 to 1.
pub(super) fn passage_openness(
    house: &House,
    state: &State,
    ground: &StaticNavGrid,
    passage: usize,
) -> f32 {
    let id = ground.doors[passage].joint;
    house.joints[id].openness(state.joint_position[id])
}

/// Returns whether a door of this openness lets an agent pass.
pub(super) fn is_passable(openness: f32) -> bool {
    openness >= MIN_OPENNESS
}

/// Returns the pose of a part for navigation; `None` while it is held.
fn unheld_part_transform(
    house: &House,
    state: &State,
    ground: &StaticNavGrid,
    config: &NavConfig,
    part: PartId,
) -> Option<Affine3A> {
    if state.held_by[house.parts[part].object].is_some() {
        return None;
    }
    if let Some(passage) = ground.door_of_part[part] {
        let open = is_passable(passage_openness(house, state, ground, passage as usize));
        let opened = match config.doors {
            DoorPolicy::AsTheyStand => false,
            DoorPolicy::Open => true,
            DoorPolicy::Priced => !open,
        };
        if opened {
            let joint = &house.joints[ground.doors[passage as usize].joint];
            return Some(leaf_transform(state, joint, joint.open));
        }
    }
    Some(state.part_pose[part].to_affine())
}

/// Returns the columns that a part crosses at a pose, in order, with disjoint spans.
pub(super) fn rasterize_part(
    house: &House,
    frame: &GridFrame,
    part: PartId,
    world_from_part: &Affine3A,
) -> Vec<(u32, HeightSpan)> {
    let part = &house.parts[part];
    let world_from_mesh = *world_from_part * part.part_from_mesh;
    let mesh = &house.meshes[part.mesh];
    let points: Vec<Vec3> = mesh
        .positions
        .iter()
        .map(|p| world_from_mesh.transform_point3(*p))
        .collect();
    let mut crossed: Vec<(u32, HeightSpan)> = Vec::new();
    let mut pace = CancelPoller::new(TRIANGLES_PER_CHECK);
    for triangle in &mesh.triangles {
        pace.count_one();
        frame.rasterize_triangle(triangle.map(|v| points[v as usize]), |column, span| {
            crossed.push((column as u32, span));
        });
    }
    crossed.sort_by_key(|(column, _)| *column);
    let mut columns = Vec::new();
    for spans in crossed.chunk_by(|a, b| a.0 == b.0) {
        let mut joined: Vec<HeightSpan> = spans.iter().map(|(_, span)| *span).collect();
        merge_spans(&mut joined);
        columns.extend(joined.into_iter().map(|span| (spans[0].0, span)));
    }
    columns
}
