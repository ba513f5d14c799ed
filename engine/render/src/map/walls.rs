//! Walls on maps: a camera that starts inside a wall sees nothing of it.

use super::StoreyMap;
use dwell_scene::interrupt::CancelPoller;
use dwell_scene::{House, Mesh, StructureKind};
use glam::Vec2;

/// Width of the lines around walls, m: the skins of a wall are about so thick.
const LINE_M: f32 = 0.06;
/// Pixels between checks for cancellation.
const PIXELS_PER_CHECK: usize = 1 << 16;
/// The colour of walls.
pub(super) const SRGB: [u8; 3] = [40, 40, 44];

impl StoreyMap {
    /// Fills the places where the cut meets walls in a picture of the map.
    ///
    /// `rgb`: shape (height, width, 3) of [`Self::view`]'s camera; what does not fit stays as it is.
    pub fn draw_walls(&self, house: &House, rgb: &mut [u8]) {
        for piece in house
            .structure
            .iter()
            .filter(|piece| piece.kind == StructureKind::Wall)
        {
            let lines = self.cut(&house.meshes[piece.mesh]);
            self.fill(&lines, rgb);
        }
    }

    /// Returns the lines where triangles cross the cut, as points from the map's corner, m. With the front of its triangle a line has the
    /// same side as all others.
    fn cut(&self, mesh: &Mesh) -> Vec<[Vec2; 2]> {
        let mut lines = Vec::new();
        for corners in (0..mesh.triangles.len()).map(|k| mesh.corners(k)) {
            let (mut up, mut down) = (None, None);
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                if (a.y > self.cut_y) != (b.y > self.cut_y) {
                    let p = a.lerp(b, (self.cut_y - a.y) / (b.y - a.y));
                    let end = if b.y > a.y { &mut up } else { &mut down };
                    *end = Some(Vec2::new(p.x, p.z) - self.corner);
                }
            }
            lines.extend(up.zip(down).map(|(a, b)| [a, b]));
        }
        lines
    }

    /// Paints lines, and the areas that they enclose.
    fn fill(&self, lines: &[[Vec2; 2]], rgb: &mut [u8]) {
        let half_m = (LINE_M * 0.5).max(0.75 / self.pixels_per_m);
        // Lines around a solid lead back to where they started.
        let rest: Vec2 = lines.iter().map(|[a, b]| *b - *a).sum();
        let closed = rest.length() < 1e-3;
        let (width, height) = (
            self.view.camera.width() as usize,
            self.view.camera.height() as usize,
        );
        let first = |m: f32| (m * self.pixels_per_m).max(0.0) as usize;
        let last = |m: f32, size: usize| {
            ((m * self.pixels_per_m).max(-1.0) + 1.0).min(size as f32) as usize
        };
        let middle = |k: usize| (k as f32 + 0.5) / self.pixels_per_m;
        let mut paint = |x: usize, y: usize| {
            let byte = (y * width + x) * 3;
            if let Some(pixel) = rgb.get_mut(byte..byte + 3) {
                pixel.copy_from_slice(&SRGB);
            }
        };
        let mut pace = CancelPoller::new(PIXELS_PER_CHECK);
        // Each line in its own box: walls of scanned houses have thousands.
        for [a, b] in lines {
            let (low, high) = (a.min(*b) - half_m, a.max(*b) + half_m);
            for y in first(low.y)..last(high.y, height) {
                let columns = first(low.x)..last(high.x, width);
                pace.count_many(columns.len());
                for x in columns {
                    if distance(Vec2::new(middle(x), middle(y)), *a, *b) <= half_m {
                        paint(x, y);
                    }
                }
            }
        }
        if !closed {
            return;
        }
        // Between every second pair of lines that a row of pixels meets.
        let mut meets: Vec<Vec<f32>> = vec![Vec::new(); height];
        for [a, b] in lines {
            let (low, high) = (a.y.min(b.y), a.y.max(b.y));
            let rows = meets.iter_mut().enumerate().take(last(high, height));
            for (y, meets) in rows.skip(first(low)) {
                let z = middle(y);
                if (a.y > z) != (b.y > z) {
                    meets.push(a.x + (b.x - a.x) * (z - a.y) / (b.y - a.y));
                }
            }
        }
        for (y, meets) in meets.iter_mut().enumerate() {
            meets.sort_by(f32::total_cmp);
            for pair in meets.chunks_exact(2) {
                let columns = first(pair[0])..last(pair[1], width);
                pace.count_many(columns.len());
                for x in columns {
                    if (pair[0]..pair[1]).contains(&middle(x)) {
                        paint(x, y);
                    }
                }
            }
        }
    }
}

/// The distance from a point to a line between two others.
fn distance(p: Vec2, a: Vec2, b: Vec2) -> f32 {
    let along = b - a;
    let part = (p - a).dot(along) / along.length_squared().max(1e-12);
    (p - a - along * part.clamp(0.0, 1.0)).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::{LevelId, ShoeboxMaterials};
    use glam::Vec3;
    use std::sync::Arc;

    #[test]
    fn walls_are_painted_where_they_stand_and_nowhere_else() {
        let room = House::shoebox([8.0, 3.0, 4.0], &ShoeboxMaterials::default()).unwrap();
        // The west wall becomes a block of half a metre; the others stay sheets.
        let mut data = room.data().clone();
        let west = data
            .structure
            .iter()
            .position(|piece| piece.name == "west")
            .unwrap();
        let block = Mesh::cuboid(Vec3::ZERO, Vec3::new(0.5, 3.0, 4.0));
        data.structure.as_mut_slice()[west].mesh = data.meshes.push(Arc::new(block));
        let house = House::new(data).unwrap();
        let map = StoreyMap::new(&house, LevelId(0), 450).unwrap();
        let mut rgb = vec![200; map.view.camera.pixels() * 3];
        map.draw_walls(&house, &mut rgb);
        let at = |x: f32, z: f32| {
            let p = map.image_from_world(Vec3::new(x, 0.0, z));
            rgb[(p.y as usize * 450 + p.x as usize) * 3]
        };
        for (x, z) in [
            (0.01, 2.0),
            (0.25, 0.1),
            (0.25, 2.0),
            (0.49, 3.9),
            (8.0, 2.0),
            (4.0, 0.0),
            (4.0, 4.0),
        ] {
            assert_eq!(at(x, z), 40, "{x} {z}");
        }
        for (x, z) in [(0.6, 2.0), (7.8, 0.2), (4.0, 2.0), (-0.2, 2.0), (0.25, 4.3)] {
            assert_eq!(at(x, z), 200, "{x} {z}");
        }
        map.draw_walls(&house, &mut rgb[..100]);
    }
}
