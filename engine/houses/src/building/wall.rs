//! Straight walls with openings.

use super::assembly::HouseAssembly;
use super::room::PlanRect;
use dwell_furniture::finishes::Finish;
use dwell_scene::{Mesh, RoomId, StructureKind};
use glam::{Vec2, Vec3};

/// The face of a wall from the floor up: each finish with the height where it ends, m.
pub(crate) type FinishBands = Vec<(f32, Finish)>;

/// The direction in which a wall runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WallAxis {
    /// West to east; its front looks south (+Z).
    X,
    /// North to south; its front looks east (+X).
    Z,
}

/// A hole in a wall.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallOpening {
    /// Ends along the wall: world x or z, m.
    pub(crate) along: [f32; 2],
    /// Lower and upper edge above the floor, m.
    pub(crate) up: [f32; 2],
}

/// A straight piece of wall between two rooms, or between a room and the outside.
#[derive(Clone, Debug)]
pub(crate) struct ShellWall {
    pub(crate) name: String,
    pub(crate) room: RoomId,
    /// Height of the floor on which it stands, m.
    pub(crate) floor_m: f32,
    pub(crate) height_m: f32,
    pub(crate) rect: PlanRect,
    pub(crate) along: WallAxis,
    pub(crate) front: FinishBands,
    pub(crate) back: FinishBands,
    /// The finish of ends, top and the insides of openings.
    pub(crate) reveal_finish: Finish,
    pub(crate) openings: Vec<WallOpening>,
}

/// A slot of the wall's mesh, and the edge of its texture's tile, m.
type SlotAndTile = (u16, f32);

impl ShellWall {
    /// The wall's lines along its length and up its height: every edge of an opening or a band.
    fn lines(&self) -> [Vec<f32>; 2] {
        let [x0, z0, x1, z1] = self.rect;
        let ends = if self.along == WallAxis::X {
            [x0, x1]
        } else {
            [z0, z1]
        };
        let mut along = ends.to_vec();
        let mut up = vec![0.0, self.height_m];
        for opening in &self.openings {
            along.extend(opening.along);
            up.extend(opening.up);
        }
        let bands = self.front.iter().chain(&self.back).map(|(top, _)| *top);
        up.extend(bands.filter(|top| *top < self.height_m));
        for lines in [&mut along, &mut up] {
            lines.sort_by(f32::total_cmp);
            lines.dedup();
        }
        [along, up]
    }

    fn is_solid(&self, along: f32, up: f32) -> bool {
        let within = |x: f32, [low, high]: [f32; 2]| low < x && x < high;
        !self
            .openings
            .iter()
            .any(|hole| within(along, hole.along) && within(up, hole.up))
    }

    /// Returns the positions of back and front across the wall.
    fn depth(&self) -> [f32; 2] {
        let [x0, z0, x1, z1] = self.rect;
        if self.along == WallAxis::X {
            [z0, z1]
        } else {
            [x0, x1]
        }
    }

    fn point(&self, [along, up, across]: [f32; 3]) -> Vec3 {
        let up = self.floor_m + up;
        match self.along {
            WallAxis::X => Vec3::new(along, up, across),
            WallAxis::Z => Vec3::new(across, up, along),
        }
    }

    /// Adds the wall, one closed piece.
    pub(crate) fn build(&self, assembly: &mut HouseAssembly) {
        let mut finishes: Vec<Finish> = vec![self.reveal_finish.clone()];
        let mut look = |finish: &Finish| -> SlotAndTile {
            let known = finishes.iter().position(|known| known == finish);
            let slot = known.unwrap_or_else(|| {
                finishes.push(finish.clone());
                finishes.len() - 1
            });
            (slot as u16, finish.tile_m)
        };
        let mut bands = |bands: &FinishBands| -> Vec<(f32, SlotAndTile)> {
            bands
                .iter()
                .map(|(top, finish)| (*top, look(finish)))
                .collect()
        };
        let (back, front) = (bands(&self.back), bands(&self.front));
        let mesh = self.mesh(&back, &front, (0, self.reveal_finish.tile_m));
        let name = format!("wall_{}", self.name);
        assembly.add_structure(&name, StructureKind::Wall, Some(self.room), mesh, &finishes);
    }

    fn mesh(
        &self,
        back: &[(f32, SlotAndTile)],
        front: &[(f32, SlotAndTile)],
        edge: SlotAndTile,
    ) -> Mesh {
        let [along, up] = self.lines();
        let [b, f] = self.depth();
        let middle = |lines: &[f32], k: usize| 0.5 * (lines[k] + lines[k + 1]);
        let solid = |i: Option<usize>, j: Option<usize>| match (i, j) {
            (Some(i), Some(j)) if i + 1 < along.len() && j + 1 < up.len() => {
                self.is_solid(middle(&along, i), middle(&up, j))
            }
            _ => false,
        };
        let mut mesh = Mesh::default();
        for i in 0..along.len() - 1 {
            for j in 0..up.len() - 1 {
                if !solid(Some(i), Some(j)) {
                    continue;
                }
                let ([l, r], [u, o]) = ([along[i], along[i + 1]], [up[j], up[j + 1]]);
                let band = |bands: &[(f32, SlotAndTile)]| {
                    let found = bands
                        .iter()
                        .find(|(top, _)| o <= *top + 1e-4)
                        .or(bands.last());
                    found.map_or(edge, |(_, look)| *look)
                };
                // Corners (along, up, across), counter-clockwise seen from outside; whether the face is open; its look.
                let faces = [
                    (
                        [[l, u, f], [r, u, f], [r, o, f], [l, o, f]],
                        true,
                        band(front),
                    ),
                    (
                        [[r, u, b], [l, u, b], [l, o, b], [r, o, b]],
                        true,
                        band(back),
                    ),
                    (
                        [[l, u, b], [l, u, f], [l, o, f], [l, o, b]],
                        !solid(i.checked_sub(1), Some(j)),
                        edge,
                    ),
                    (
                        [[r, u, f], [r, u, b], [r, o, b], [r, o, f]],
                        !solid(Some(i + 1), Some(j)),
                        edge,
                    ),
                    (
                        [[l, u, b], [r, u, b], [r, u, f], [l, u, f]],
                        !solid(Some(i), j.checked_sub(1)),
                        edge,
                    ),
                    (
                        [[l, o, f], [r, o, f], [r, o, b], [l, o, b]],
                        !solid(Some(i), Some(j + 1)),
                        edge,
                    ),
                ];
                for (corners, _, look) in faces.into_iter().filter(|(_, open, _)| *open) {
                    let mut quad = corners.map(|corner| self.point(corner));
                    // A wall along Z is the mirror image of one along X: its faces run the other way round.
                    if self.along == WallAxis::Z {
                        quad.reverse();
                    }
                    add_quad(&mut mesh, quad, look);
                }
            }
        }
        mesh
    }
}

/// Appends a rectangle; texture coordinates in metres over the tile, v up on upright faces.
fn add_quad(mesh: &mut Mesh, corners: [Vec3; 4], (slot, tile_m): SlotAndTile) {
    let normal = (corners[1] - corners[0])
        .cross(corners[3] - corners[0])
        .normalize_or_zero();
    let base = mesh.positions.len() as u32;
    let scale = if tile_m > 0.0 { 1.0 / tile_m } else { 1.0 };
    for corner in corners {
        let uv = if normal.y.abs() > 0.5 {
            Vec2::new(corner.x, -corner.z)
        } else {
            // To the right as one stands before the face.
            Vec2::new(corner.dot(Vec3::Y.cross(normal)), corner.y)
        };
        mesh.positions.push(corner);
        mesh.normals.push(normal);
        mesh.uvs.push(uv * scale);
    }
    for triangle in [[base, base + 1, base + 2], [base, base + 2, base + 3]] {
        mesh.triangles.push(triangle);
        mesh.slots.push(slot);
    }
}
