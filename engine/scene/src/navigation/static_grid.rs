//! The static part of the grid: the columns of walls, floors and fixed objects, and the doors that agents pass.

use super::config::{NavConfig, range_error};
use super::heightfield::{GridFrame, HeightSpan, Heightfield};
use super::obstacles::rasterize_part;
use crate::articulation::Joint;
use crate::bounds::Aabb;
use crate::error::SceneError;
use crate::house::{House, StructureKind, SurfaceOwner};
use crate::ids::{IdVec, JointId, LevelId, PartId};
use crate::interrupt;
use crate::space::Pose;
use crate::state::State;
use glam::{Affine3A, Vec3};

/// The parts of a grid that no state changes; grids of one house and one agent share them.
#[derive(Debug)]
pub(super) struct StaticNavGrid {
    pub(super) frame: GridFrame,
    /// All triangles that never move.
    pub(super) fixed: Heightfield,
    /// The house's own floors and the ground outside, without furniture.
    pub(super) floors: Heightfield,
    /// The height at which each storey ends, m, from the lowest; infinite for the last. Empty storeys are left out.
    tops: Vec<(LevelId, f32)>,
    /// The doors in the way of walking agents, by joint.
    pub(super) doors: Vec<DoorObstacle>,
    /// For each part, the position in `passages` of the door that moves it.
    pub(super) door_of_part: IdVec<PartId, Option<u32>>,
}

/// A door in the way of walking agents.
#[derive(Debug)]
pub(super) struct DoorObstacle {
    pub(super) joint: JointId,
    /// The columns that its leaf crosses when closed, in order.
    pub(super) closed_spans: Vec<(u32, HeightSpan)>,
}

/// The largest number of cells: 32 million would be 100 by 100 m in 1.8 cm cells, or a town in 10 cm cells.
pub(super) const MAX_CELLS: usize = 1 << 25;

impl StaticNavGrid {
    pub(super) fn new(house: &House, config: &NavConfig) -> Result<Self, SceneError> {
        let levels: Vec<(LevelId, Aabb)> = house
            .levels
            .iter_ids()
            .map(|(id, level)| (id, level.bounds))
            .filter(|(_, bounds)| !bounds.is_empty())
            .collect();
        let bounds = levels
            .iter()
            .fold(Aabb::EMPTY, |all, (_, bounds)| all.union(bounds));
        let size = bounds.size() / config.cell_m;
        if (size.x + 3.0) * (size.z + 3.0) >= MAX_CELLS as f32 {
            let allowed = "a cell size that gives fewer than 2^25 cells; a house this large may be in centimetres or millimetres where metres \
                 are meant";
            return Err(range_error("cell_m", config.cell_m, allowed));
        }
        let lowest = levels.iter().map(|(_, b)| b.min.y);
        let lowest = lowest.fold(f32::INFINITY, f32::min);
        let frame = GridFrame::new(&bounds, [lowest - 0.5, f32::INFINITY], config);
        let top = |k: usize| {
            let next = levels.get(k + 1).map(|(_, next)| next.min.y);
            next.map_or(f32::INFINITY, |next| next.max(levels[k].1.min.y + 1.0))
        };
        let tops = (0..levels.len()).map(|k| (levels[k].0, top(k))).collect();
        let (fixed, floors) = static_heightfields(house, &frame);
        let mut ground = Self {
            frame,
            fixed,
            floors,
            tops,
            doors: Vec::new(),
            door_of_part: IdVec::filled(None, house.parts.len()),
        };
        ground.find_passages(house, config);
        Ok(ground)
    }

    /// The storey that a height belongs to.
    pub(super) fn level(&self, y: f32) -> Option<LevelId> {
        let storey = self.tops.iter().find(|(_, top)| y < *top);
        storey.map(|(level, _)| *level)
    }

    /// Returns whether the storey exists.
    pub(super) fn has_level(&self, level: LevelId) -> bool {
        self.tops.iter().any(|(id, _)| *id == level)
    }

    /// Finds doors: joints of fixed-base objects whose closed leaf covers ground that is walkable without it.
    fn find_passages(&mut self, house: &House, config: &NavConfig) {
        for (id, joint) in house.joints.iter_ids() {
            interrupt::unwind_if_cancelled();
            let stands = joint.parent.is_none_or(|parent| house.parts[parent].fixed);
            if !stands || house.parts[joint.child].fixed {
                continue;
            }
            let world_from_child =
                joint.world_from_child(&start_of_parent(house, joint), joint.closed);
            let shut = rasterize_part(
                house,
                &self.frame,
                joint.child,
                &world_from_child.to_affine(),
            );
            let is_passage = shut.iter().any(|(column, leaf)| {
                let spans = self.fixed.at(*column as usize);
                standing_heights(spans, config).any(|y| {
                    let in_the_way =
                        leaf.high > y + config.step_m && leaf.low < y + config.height_m;
                    in_the_way && self.has_clearance(*column as usize, y, config)
                })
            });
            if is_passage {
                self.door_of_part[joint.child] = Some(self.doors.len() as u32);
                self.doors.push(DoorObstacle {
                    joint: id,
                    closed_spans: shut,
                });
            }
        }
    }

    /// Returns whether no fixed thing stands within the radius between a step and the agent's height above `y`.
    fn has_clearance(&self, column: usize, y: f32, config: &NavConfig) -> bool {
        columns_around(&self.frame, column, config.radius_m)
            .all(|(beside, _)| !is_standing_blocked(self.fixed.at(beside), y, config))
    }
}

/// Returns whether something stands between a step and the agent's height above `y`.
pub(super) fn is_standing_blocked(spans: &[HeightSpan], y: f32, config: &NavConfig) -> bool {
    let (low, high) = (y + config.step_m, y + config.height_m);
    spans.iter().any(|span| span.high > low && span.low < high)
}

/// Returns the heights in a column on which the agent can stand upright, from below.
pub(super) fn standing_heights(
    spans: &[HeightSpan],
    config: &NavConfig,
) -> impl Iterator<Item = f32> {
    spans.iter().enumerate().filter_map(|(k, span)| {
        let above = spans.get(k + 1).map_or(f32::INFINITY, |next| next.low);
        // Something steep on a flat surface is a step too, if it is no higher than one.
        let fits = above - span.high >= config.height_m
            && span.walkable_height >= span.high - config.step_m;
        fits.then_some(span.high)
    })
}

/// Returns the columns some point of which lies nearer than `radius_m` to the middle of `column`, with their offsets.
pub(super) fn columns_around(
    frame: &GridFrame,
    column: usize,
    radius_m: f32,
) -> impl Iterator<Item = (usize, [isize; 2])> {
    let (width, depth, cell_m) = (frame.width, frame.depth, frame.cell_m);
    let (x, z) = (column % width, column / width);
    let reach = (radius_m / cell_m).ceil() as isize;
    let least = radius_m.max(1e-6);
    let gap = move |d: isize| (d.unsigned_abs() as f32 - 0.5).max(0.0) * cell_m;
    (-reach..=reach).flat_map(move |dz| {
        (-reach..=reach).filter_map(move |dx| {
            let near = gap(dx) * gap(dx) + gap(dz) * gap(dz) < least * least;
            let (i, j) = (x.checked_add_signed(dx)?, z.checked_add_signed(dz)?);
            (near && i < width && j < depth).then_some((j * width + i, [dx, dz]))
        })
    })
}

/// Returns the initial pose of a joint's parent.
fn start_of_parent(house: &House, joint: &Joint) -> Pose {
    joint
        .parent
        .map_or(Pose::IDENTITY, |parent| house.parts[parent].world_from_part)
}

/// Returns the transform of a door's leaf at a position of its joint.
pub(super) fn leaf_transform(state: &State, joint: &Joint, position: f32) -> Affine3A {
    let parent = joint
        .parent
        .map_or(Pose::IDENTITY, |parent| state.part_pose[parent]);
    joint.world_from_child(&parent, position).to_affine()
}

/// Returns the columns of all static geometry, and of floors alone.
fn static_heightfields(house: &House, frame: &GridFrame) -> (Heightfield, Heightfield) {
    let (mut fixed, mut floors) = (Vec::new(), Vec::new());
    for placed in &house.geometry().placed {
        if matches!(placed.owner, SurfaceOwner::Part(part) if !house.parts[part].fixed) {
            continue;
        }
        let is_floor = matches!(placed.owner, SurfaceOwner::Structure(id)
            if matches!(house.structure[id].kind, StructureKind::Floor | StructureKind::Ground));
        let mesh = &house.meshes[placed.mesh];
        let points: Vec<Vec3> = mesh
            .positions
            .iter()
            .map(|p| placed.world_from_mesh.transform_point3(*p))
            .collect();
        for triangle in &mesh.triangles {
            interrupt::unwind_if_cancelled();
            frame.rasterize_triangle(triangle.map(|v| points[v as usize]), |column, span| {
                fixed.push((column as u32, span));
                if is_floor {
                    floors.push((column as u32, span));
                }
            });
        }
    }
    let columns = |raw: Vec<(u32, HeightSpan)>| Heightfield::new(frame.count(), &raw);
    (columns(fixed), columns(floors))
}
