//! Rooms of a plan with their slabs.

use super::assembly::Assembly;
use dwell_furniture::finish::Finish;
use dwell_furniture::shapes::extrude;
use dwell_scene::{Aabb, Room, RoomId, StructureKind};
use glam::{Vec2, Vec3};

/// Height of rooms, m.
pub(crate) const CEILING_M: f32 = 2.6;
/// Strips of floor that are narrower come of rounding, m.
const THIN_M: f32 = 1e-3;

/// A rectangle of the plan: x from, z from, x to, z to, m.
pub(crate) type Rect = [f32; 4];

/// A room of the plan.
#[derive(Clone, Debug)]
pub(crate) struct RoomPlan {
    pub(crate) name: String,
    /// What people call it, most fitting first.
    pub(crate) kinds: Vec<&'static str>,
    /// The free floor, in rectangles that do not overlap; halves of doorways too.
    pub(crate) floor: Vec<Rect>,
    /// Height of the floor, m.
    pub(crate) floor_m: f32,
    /// The corners of its floor and of its ceiling, (x, z) in m, clockwise seen from above; slabs reach to the middle of
    /// walls.
    pub(crate) slabs: [Vec<[f32; 2]>; 2],
    /// Thickness of floor and ceiling, m.
    pub(crate) slab_m: [f32; 2],
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
            bounds.add_point(Vec3::new(*x0, self.floor_m, *z0));
            bounds.add_point(Vec3::new(*x1, self.floor_m + CEILING_M, *z1));
        }
        let wide = |[x0, z0, x1, z1]: &Rect| x1 - x0 > THIN_M && z1 - z0 > THIN_M;
        let floor = self.floor.iter().copied().filter(wide);
        let id = assembly.data.rooms.push(Room {
            name: self.name.clone(),
            level: assembly.level,
            kinds: self.kinds.iter().map(|kind| (*kind).to_owned()).collect(),
            footprint: floor.flat_map(triangles).collect(),
            floor_y: self.floor_m,
            ceiling_y: self.floor_m + CEILING_M,
            bounds,
        });
        let slab = |k: usize, top: f32, finish: &Finish| {
            // The prism's (x, y) plane becomes the world's (x, z), its depth runs down.
            let mut mesh = extrude(&self.slabs[k], self.slab_m[k])
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
        let above = self.floor_m + CEILING_M + self.slab_m[1];
        let pieces = [
            (
                StructureKind::Floor,
                "floor",
                self.floor_m,
                &self.floor_finish,
            ),
            (
                StructureKind::Ceiling,
                "ceiling",
                above,
                &self.ceiling_finish,
            ),
        ];
        for (k, (kind, word, top, finish)) in pieces.into_iter().enumerate() {
            if !self.slabs[k].is_empty() {
                let name = format!("{word}_{}", self.name);
                let finishes = std::slice::from_ref(finish);
                assembly.structure(&name, kind, Some(id), slab(k, top, finish), finishes);
            }
        }
        id
    }
}
