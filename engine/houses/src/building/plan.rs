//! Rooms of a plan with their slabs.

use super::assembly::Assembly;
use crate::furniture::finish::Finish;
use crate::furniture::shapes::extrude;
use dwell_scene::{Aabb, LevelId, Room, RoomId, StructureKind};
use glam::{Vec2, Vec3};

/// Height of rooms, m.
pub(crate) const CEILING_M: f32 = 2.6;
/// Thickness of slabs, m.
const SLAB_M: f32 = 0.2;

/// A rectangle of the plan: x from, z from, x to, z to, m.
pub(crate) type Rect = [f32; 4];

/// A room of the plan.
#[derive(Clone, Debug)]
pub(crate) struct RoomPlan {
    pub(crate) name: &'static str,
    /// What people call it, most fitting first.
    pub(crate) kinds: Vec<&'static str>,
    /// The free floor, in rectangles that do not overlap; halves of doorways too.
    pub(crate) floor: Vec<Rect>,
    /// The corners of its slabs, (x, z) in m, clockwise seen from above; slabs reach to the middle of walls.
    pub(crate) slab: Vec<[f32; 2]>,
    pub(crate) floor_finish: Finish,
    pub(crate) ceiling_finish: Finish,
}

impl RoomPlan {
    /// Adds the room and its floor and ceiling pieces.
    pub(crate) fn build(&self, assembly: &mut Assembly) -> RoomId {
        let corner = |x: f32, z: f32| Vec2::new(x, z);
        let triangles = |[x0, z0, x1, z1]: Rect| {
            [
                [corner(x0, z0), corner(x1, z0), corner(x1, z1)],
                [corner(x0, z0), corner(x1, z1), corner(x0, z1)],
            ]
        };
        let mut bounds = Aabb::EMPTY;
        for [x0, z0, x1, z1] in &self.floor {
            bounds.add_point(Vec3::new(*x0, 0.0, *z0));
            bounds.add_point(Vec3::new(*x1, CEILING_M, *z1));
        }
        let id = assembly.data.rooms.push(Room {
            name: self.name.to_owned(),
            level: LevelId(0),
            kinds: self.kinds.iter().map(|kind| (*kind).to_owned()).collect(),
            footprint: self.floor.iter().copied().flat_map(triangles).collect(),
            floor_y: 0.0,
            ceiling_y: CEILING_M,
            bounds,
        });
        let slab = |top: f32, finish: &Finish| {
            // The prism's (x, y) plane becomes the world's (x, z), its depth runs down.
            let mut mesh = extrude(&self.slab, SLAB_M)
                .about_x(std::f32::consts::FRAC_PI_2)
                .at(0.0, top, 0.0)
                .mesh;
            if finish.tile_m > 0.0 {
                for uv in &mut mesh.uvs {
                    *uv /= finish.tile_m;
                }
            }
            mesh
        };
        let floor = slab(0.0, &self.floor_finish);
        let ceiling = slab(CEILING_M + SLAB_M, &self.ceiling_finish);
        let room = Some(id);
        assembly.structure(
            &format!("floor_{}", self.name),
            StructureKind::Floor,
            room,
            floor,
            std::slice::from_ref(&self.floor_finish),
        );
        assembly.structure(
            &format!("ceiling_{}", self.name),
            StructureKind::Ceiling,
            room,
            ceiling,
            std::slice::from_ref(&self.ceiling_finish),
        );
        id
    }
}
