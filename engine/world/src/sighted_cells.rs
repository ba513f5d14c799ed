//! The cells of a navigation grid that an agent has seen, with what it saw there.

use dwell_scene::bvh::{PacketHits, RayMask, RayPacket};
use dwell_scene::navigation::{ColumnFrame, NavGrid};
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentState, EntityId, Id, LevelId, interrupt, math};
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A cell where the agent can stand.
pub(crate) const FREE: u8 = 1;
/// Any other cell.
pub(crate) const OBSTACLE: u8 = 2;

/// Lines of sight that are traced together.
const PACKET: usize = 16;
/// Distance between neighbouring lines of sight at the end of their range, in cells: none is missed between them.
const SPACING_CELLS: f32 = 0.7;
/// Depth of a surface's cell behind where a line of sight meets it, m.
const SURFACE_M: f32 = 1e-3;

/// The view by which cells are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SightSettings {
    /// m.
    pub(crate) range_m: f32,
    /// Around straight ahead, rad.
    pub(crate) fov_rad: f32,
    /// Height above the feet, m; `None`: that of the eyes.
    pub(crate) height_m: Option<f32>,
}

/// What was seen of the columns of each storey when they were last seen; 0 where nothing was.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SightedCells(BTreeMap<LevelId, Vec<u8>>);

/// The same in a snapshot: lengths of runs of equal values.
#[derive(Serialize, Deserialize)]
struct SightedCellRuns<'a> {
    settings: &'a str,
    storeys: Vec<(LevelId, Vec<(u8, u32)>)>,
}

impl SightedCells {
    /// Returns what was last seen of a column on a storey; 0 for nothing.
    pub(crate) fn value(&self, level: LevelId, column: usize) -> u8 {
        let storey = self.0.get(&level);
        storey
            .and_then(|cells| cells.get(column))
            .copied()
            .unwrap_or(0)
    }

    /// Takes in what an agent sees of its storey: all cells along level lines of sight, up to the first surface.
    ///
    /// `viewer`: the agent, the surfaces as they are, and the entity of its own body.
    pub(crate) fn mark_visible(
        &mut self,
        grid: &NavGrid,
        level: LevelId,
        sight: &SightSettings,
        (agent, rays, own): (&AgentState, &RayScene, EntityId),
    ) {
        let columns = grid.column_frame();
        let storey = self.0.entry(level);
        let cells = storey.or_insert_with(|| vec![0; columns.count()]);
        let mut see = |column: usize, is_surface: bool| {
            let free = grid.is_free(column, level);
            // The cell behind a thin wall begins where the wall is.
            if !(is_surface && free) {
                cells[column] = if free { FREE } else { OBSTACLE };
            }
        };
        let height_m = sight.height_m.unwrap_or(agent.eye_height_m());
        let eye = agent.position + Vec3::Y * height_m;
        let spacing_rad = SPACING_CELLS * columns.cell_m / sight.range_m;
        let count = (sight.fov_rad / spacing_rad).ceil().max(1.0) as usize;
        let mask = RayMask::EYE.union(RayMask::BODY);
        let lines: Vec<usize> = (0..count).collect();
        for lines in lines.chunks(PACKET) {
            interrupt::unwind_if_cancelled();
            let mut packet = RayPacket::<PACKET>::new(eye);
            for (k, line) in lines.iter().enumerate() {
                let share = (*line as f32 + 0.5) / count as f32 - 0.5;
                let (sine, cosine) = math::sin_cos(agent.yaw_rad + share * sight.fov_rad);
                packet.set(k, Vec3::new(-sine, 0.0, -cosine), 0.0, sight.range_m);
            }
            let mut hits = PacketHits::new();
            rays.closest_packet(&packet, mask, own, &mut hits);
            for k in 0..lines.len() {
                let ray = packet.ray(k);
                let hit_m = hits.distance_m[k];
                let free_m = (hit_m - SURFACE_M).min(sight.range_m);
                for_each_column(&columns, eye, ray.direction, free_m, |column| {
                    see(column, false);
                });
                if hit_m <= sight.range_m {
                    let surface = ray.point_at(hit_m + SURFACE_M);
                    if let Some(column) = columns.column_at([surface.x, surface.z]) {
                        see(column, true);
                    }
                }
            }
        }
    }

    /// Returns all of it as bytes, which fit only the same settings.
    pub(crate) fn to_bytes(&self, settings: &str) -> Vec<u8> {
        let runs = |cells: &Vec<u8>| {
            let runs = cells.chunk_by(|a, b| a == b);
            runs.map(|run| (run[0], run.len() as u32)).collect()
        };
        let storeys = self.0.iter();
        let memory = SightedCellRuns {
            settings,
            storeys: storeys
                .map(|(level, cells)| (*level, runs(cells)))
                .collect(),
        };
        postcard::to_stdvec(&memory).expect("plain data can always be written to memory")
    }

    /// Reads [`Self::to_bytes`], for a grid of so many storeys and columns; else says why they do not fit.
    pub(crate) fn from_bytes(
        settings: &str,
        levels: usize,
        columns: usize,
        bytes: &[u8],
    ) -> Result<Self, String> {
        let memory: SightedCellRuns<'_> =
            postcard::from_bytes(bytes).map_err(|error| error.to_string())?;
        if memory.settings != settings {
            return Err(format!(
                "its settings are {}, and those of the environment {settings}",
                memory.settings
            ));
        }
        let mut all = BTreeMap::new();
        for (level, runs) in memory.storeys {
            let total: u64 = runs.iter().map(|(_, length)| u64::from(*length)).sum();
            let values = runs.iter().all(|(value, _)| *value <= OBSTACLE);
            if level.index() >= levels || total != columns as u64 || !values {
                return Err(format!("a map of {total} cells of storey {}", level.0));
            }
            let runs = runs.iter();
            let cells =
                runs.flat_map(|(value, length)| std::iter::repeat_n(*value, *length as usize));
            all.insert(level, cells.collect());
        }
        Ok(Self(all))
    }
}

/// Visits the columns that a level line from `start` crosses, in order, up to `length_m`.
///
/// # Source
/// J. Amanatides, A. Woo, A Fast Voxel Traversal Algorithm for Ray Tracing, Eurographics 1987.
fn for_each_column(
    columns: &ColumnFrame,
    start: Vec3,
    direction: Vec3,
    length_m: f32,
    mut visit: impl FnMut(usize),
) {
    let from = columns.column_coordinates([start.x, start.z]);
    let way = [direction.x, direction.z];
    let length = length_m / columns.cell_m;
    let mut cell = from.map(|value| value.floor() as i64);
    // Where the line next crosses an edge along each axis, and how far apart such edges are, in columns.
    let mut next = [f32::INFINITY; 2];
    let mut apart = [f32::INFINITY; 2];
    for axis in 0..2 {
        if way[axis] != 0.0 {
            let inside = from[axis] - from[axis].floor();
            let left = if way[axis] > 0.0 {
                1.0 - inside
            } else {
                inside
            };
            (next[axis], apart[axis]) = (left / way[axis].abs(), 1.0 / way[axis].abs());
        }
    }
    loop {
        if let Some(column) = columns.column(cell) {
            visit(column);
        }
        let axis = usize::from(next[1] < next[0]);
        if next[axis].is_nan() || next[axis] >= length {
            return;
        }
        cell[axis] += if way[axis] > 0.0 { 1 } else { -1 };
        next[axis] += apart[axis];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLUMNS: ColumnFrame = ColumnFrame {
        width: 10,
        depth: 10,
        corner: [0.0, 0.0],
        cell_m: 0.5,
    };

    fn crossed(start: [f32; 2], way: [f32; 2], length_m: f32) -> Vec<usize> {
        let mut found = Vec::new();
        let way = Vec3::new(way[0], 0.0, way[1]).normalize_or_zero();
        let start = Vec3::new(start[0], 1.0, start[1]);
        for_each_column(&COLUMNS, start, way, length_m, |column| found.push(column));
        found
    }

    #[test]
    fn a_line_crosses_the_columns_on_its_way() {
        assert_eq!(crossed([0.25, 0.25], [1.0, 0.0], 1.0), [0, 1, 2]);
        assert_eq!(crossed([1.25, 0.25], [-1.0, 0.0], 1.5), [2, 1, 0]);
        assert_eq!(crossed([0.25, 0.3], [1.0, 1.0], 1.0), [0, 10, 11, 21]);
        assert_eq!(crossed([0.25, 0.25], [0.0, 1.0], 0.2), [0]);
        assert_eq!(crossed([-0.3, 0.25], [1.0, 0.0], 0.5), [0]);
        assert_eq!(crossed([f32::NAN, 0.25], [1.0, 0.0], 0.5).len(), 1);
    }

    /// Every column that a line of many small steps lies in is crossed, and no other.
    #[test]
    fn no_column_is_left_out_at_any_angle() {
        for k in 0..360 {
            let angle = (k as f32 + 0.37).to_radians();
            let (sine, cosine) = math::sin_cos(angle);
            let start = [2.51, 2.43];
            let found = crossed(start, [cosine, sine], 2.0);
            let mut stepped: Vec<usize> = (0..=20_000)
                .filter_map(|n| {
                    let s = n as f32 * 1e-4;
                    COLUMNS.column_at([start[0] + s * cosine, start[1] + s * sine])
                })
                .collect();
            stepped.dedup();
            stepped.retain(|column| !found.contains(column));
            assert!(stepped.is_empty(), "{k}: {stepped:?} of {found:?}");
            assert!(found.len() <= 10);
        }
    }

    #[test]
    fn what_was_seen_comes_back_from_bytes_and_nothing_else_is_taken() {
        let mut cells = vec![0; 100];
        cells[3..9].fill(FREE);
        cells[9] = OBSTACLE;
        let seen = SightedCells(BTreeMap::from([(LevelId(1), cells)]));
        let bytes = seen.to_bytes("settings");
        assert_eq!(
            SightedCells::from_bytes("settings", 2, 100, &bytes),
            Ok(seen)
        );
        for (settings, levels, columns) in [
            ("others", 2, 100),
            ("settings", 1, 100),
            ("settings", 2, 99),
        ] {
            assert!(SightedCells::from_bytes(settings, levels, columns, &bytes).is_err());
        }
        for cut in 0..bytes.len() {
            assert!(SightedCells::from_bytes("settings", 2, 100, &bytes[..cut]).is_err());
        }
    }
}
