//! Contents of an instance image: things with their pixels, and the boxes around them.

use crate::cpu::CpuRenderer;
use dwell_scene::person::{person_meshes, person_pieces, skeleton_of};
use dwell_scene::{Aabb, Entity, EntityId, Id, PartId, Pose, State};
use glam::Vec3;
use std::collections::BTreeMap;

/// A thing in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VisibleObject {
    /// The visible entity.
    pub entity: EntityId,
    /// Pixels that show it.
    pub pixels: u32,
    /// First column and row that show it.
    pub first_pixel: [u32; 2],
    /// The column and row behind the last ones that show it.
    pub end_pixel: [u32; 2],
}

/// All things that an instance image shows, by id, without void.
///
/// `instance`: shape (height, `width`).
pub fn visible_objects(instance: &[i32], width: u32) -> Vec<VisibleObject> {
    let mut all: BTreeMap<i32, VisibleObject> = BTreeMap::new();
    for (row, ids) in (0_u32..).zip(instance.chunks(width.max(1) as usize)) {
        for (column, id) in (0_u32..).zip(ids).filter(|(_, id)| **id != 0) {
            let thing = all.entry(*id).or_insert(VisibleObject {
                entity: EntityId(*id),
                pixels: 0,
                first_pixel: [column, row],
                end_pixel: [column, row],
            });
            thing.pixels += 1;
            thing.first_pixel[0] = thing.first_pixel[0].min(column);
            thing.end_pixel = [thing.end_pixel[0].max(column + 1), row + 1];
        }
    }
    all.into_values().collect()
}

/// A box that is turned with the thing it encloses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientedBox {
    /// From the box's middle and axes to the world.
    pub world_from_box: Pose,
    /// Its edges along its own axes, m.
    pub size: Vec3,
}

impl CpuRenderer {
    /// The box around a thing as it stands, turned as its first part is: around the boxes of its parts, each in the part's own
    /// axes. Of an agent: around its body, or the figure of a person, turned as it faces. Nothing for structure, and for objects without a surface.
    pub fn oriented_box(&self, state: &State, entity: EntityId) -> Option<OrientedBox> {
        let house = self.house();
        let (world_from_frame, bounds) = match house.entity(entity)? {
            Entity::Object(object) => {
                let thing = &house.objects[object];
                let frame = *state.part_pose.get(thing.first_part)?;
                let first = thing.first_part.index();
                let parts = (first..first + thing.part_count as usize).map(PartId::from_index);
                let mut bounds = Aabb::EMPTY;
                for part in parts {
                    let own = &self.part_bounds()[part.index()];
                    let frame_from_part = frame.inverse() * *state.part_pose.get(part)?;
                    if !own.is_empty() {
                        bounds = bounds.union(&if part == thing.first_part {
                            *own
                        } else {
                            own.transformed(&frame_from_part.to_affine())
                        });
                    }
                }
                (frame, bounds)
            }
            Entity::Agent(id) => {
                let agent = state.agents.get(id)?;
                let frame = Pose::from_position_yaw(agent.position, agent.yaw_rad);
                if let Some(joints) = skeleton_of(house, state, id) {
                    let from_world = frame.inverse().to_affine();
                    let pieces = person_pieces(&joints);
                    let shown = pieces.iter().zip(person_meshes());
                    let boxes =
                        shown
                            .filter(|(piece, _)| piece.scale > 0.0)
                            .map(|(piece, mesh)| {
                                let map = from_world * piece.world_from_mesh();
                                let points = mesh.mesh.positions.iter();
                                Aabb::from_points(points.map(|point| map.transform_point3(*point)))
                            });
                    let bounds = boxes.fold(Aabb::EMPTY, |all, one| all.union(&one));
                    return Some(OrientedBox {
                        world_from_box: frame * Pose::from_position(bounds.center()),
                        size: bounds.size(),
                    });
                }
                let radius = agent.body.radius_m;
                let height = agent.height_m().max(2.0 * radius);
                let bounds = Aabb::new(
                    Vec3::new(-radius, 0.0, -radius),
                    Vec3::new(radius, height, radius),
                );
                (frame, bounds)
            }
            _ => return None,
        };
        if bounds.is_empty() {
            return None;
        }
        Some(OrientedBox {
            world_from_box: world_from_frame * Pose::from_position(bounds.center()),
            size: bounds.size(),
        })
    }
}
