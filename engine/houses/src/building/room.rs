//! Rooms of a plan with their slabs.

use super::assembly::HouseAssembly;
use dwell_furniture::finishes::Finish;
use dwell_furniture::shapes::extrude;
use dwell_scene::{Aabb, Room, RoomId, StructureKind};
use glam::{Vec2, Vec3};

/// Height of rooms, m.
pub(crate) const CEILING_M: f32 = 2.6;
/// Width below which strips of floor come of rounding, m.
const THIN_M: f32 = 1e-3;

/// A rectangle of the plan: x from, z from, x to, z to, m.
pub(crate) type PlanRect = [f32; 4];

/// A room of the plan.
#[derive(Clone, Debug)]
pub(crate) struct ShellRoom {
    pub(crate) name: String,
    /// Everyday names of its kind, the most fitting first.
    pub(crate) kinds: Vec<String>,
    /// The free floor, in rectangles that do not overlap; halves of doorways too.
    pub(crate) floor: Vec<PlanRect>,
    /// Height of the floor, m.
    pub(crate) floor_m: f32,
    /// Height of the ceiling's lower face above the floor, m.
    pub(crate) ceiling_m: f32,
    /// Height of the slab's lower face above the floor, m: that of the storey's walls.
    pub(crate) storey_m: f32,
    /// Its floor and the slab above it; they reach to the middle of walls.
    pub(crate) slabs: [HorizontalSlab; 2],
    /// The outlines of a ceiling that hangs below that slab.
    pub(crate) suspended_ceiling: Vec<PolygonXz>,
    pub(crate) floor_finish: Finish,
    pub(crate) ceiling_finish: Finish,
}

/// Corners, (x, z) in m, clockwise seen from above.
pub(crate) type PolygonXz = Vec<[f32; 2]>;

/// A floor or a ceiling.
#[derive(Clone, Debug)]
pub(crate) struct HorizontalSlab {
    pub(crate) outlines: Vec<PolygonXz>,
    pub(crate) thick_m: f32,
}

impl ShellRoom {
    /// Adds the room and its floor and ceiling pieces.
    pub(crate) fn build(&self, assembly: &mut HouseAssembly) -> RoomId {
        let corner = |x: f32, z: f32| Vec2::new(x, z);
        let triangles = |[x0, z0, x1, z1]: PlanRect| {
            [
                [corner(x0, z0), corner(x1, z0), corner(x1, z1)],
                [corner(x0, z0), corner(x1, z1), corner(x0, z1)],
            ]
        };
        let mut bounds = Aabb::EMPTY;
        for [x0, z0, x1, z1] in &self.floor {
            bounds.add_point(Vec3::new(*x0, self.floor_m, *z0));
            bounds.add_point(Vec3::new(*x1, self.floor_m + self.ceiling_m, *z1));
        }
        let wide = |[x0, z0, x1, z1]: &PlanRect| x1 - x0 > THIN_M && z1 - z0 > THIN_M;
        let floor = self.floor.iter().copied().filter(wide);
        let id = assembly.data.rooms.push(Room {
            name: self.name.clone(),
            level: assembly.level,
            kinds: self.kinds.clone(),
            footprint: floor.flat_map(triangles).collect(),
            floor_y: self.floor_m,
            ceiling_y: self.floor_m + self.ceiling_m,
            bounds,
        });
        let piece = |outline: &PolygonXz, thick_m: f32, top: f32, finish: &Finish| {
            // The prism's (x, y) plane becomes the world's (x, z), its depth runs down.
            let mut mesh = extrude(outline, thick_m)
                .rotated_x(std::f32::consts::FRAC_PI_2)
                .translated(0.0, top, 0.0)
                .mesh;
            if finish.tile_m > 0.0 {
                for uv in &mut mesh.uvs {
                    *uv /= finish.tile_m;
                }
            }
            mesh
        };
        let [below, above] = &self.slabs;
        let top = self.floor_m + self.storey_m + above.thick_m;
        let hung_m = self.storey_m - self.ceiling_m;
        // A part above a hung ceiling is hidden.
        let (kind, word) = if self.suspended_ceiling.is_empty() {
            (StructureKind::Ceiling, "ceiling")
        } else {
            (StructureKind::Other, "slab")
        };
        let (floor, ceiling) = (&self.floor_finish, &self.ceiling_finish);
        let pieces = [
            (
                StructureKind::Floor,
                "floor",
                &below.outlines,
                below.thick_m,
                self.floor_m,
                floor,
            ),
            (kind, word, &above.outlines, above.thick_m, top, ceiling),
            (
                StructureKind::Ceiling,
                "ceiling",
                &self.suspended_ceiling,
                hung_m,
                self.floor_m + self.storey_m,
                ceiling,
            ),
        ];
        for (kind, word, outlines, thick_m, top, finish) in pieces {
            let outlines = outlines.iter().filter(|outline| !outline.is_empty());
            for (k, outline) in outlines.enumerate() {
                let name = match k {
                    0 => format!("{word}_{}", self.name),
                    _ => format!("{word}_{}_{}", self.name, k + 1),
                };
                let mesh = piece(outline, thick_m, top, finish);
                assembly.add_structure(&name, kind, Some(id), mesh, std::slice::from_ref(finish));
            }
        }
        id
    }
}
