//! Light as rows of four numbers, as `gpu/shaders/light.wgsl` reads it.

use super::indirect::StaticLighting;
use super::openings::WindowLight;
use super::outdoor::OutdoorLight;
use super::{Exposure, Lighting, PointLamp};
use dwell_scene::bvh::flat::PackedRow;
use glam::Vec3;

fn row(vector: Vec3, last: f32) -> PackedRow {
    vector.extend(last).to_array().map(f32::to_bits)
}

/// Words one behind the other, the last row filled up with zeros.
fn words(words: impl IntoIterator<Item = u32>) -> Vec<PackedRow> {
    let words: Vec<u32> = words.into_iter().collect();
    let rows = words.chunks(4);
    rows.map(|chunk| std::array::from_fn(|k| chunk.get(k).copied().unwrap_or(0)))
        .collect()
}

/// A direction and its length.
fn direction_and_length(vector: Vec3) -> (Vec3, f32) {
    let length = vector.length().max(1e-6);
    (vector / length, length)
}

fn window_rows(window: &WindowLight) -> [PackedRow; 6] {
    let [(across, width), (along, height)] = window.half_edges.map(direction_and_length);
    let [up, down] = window.luminance_cd_m2;
    [
        row(window.center, window.area_m2()),
        row(window.normal, 0.0),
        row(across, width),
        row(along, height),
        row(up, 0.0),
        row(down, 0.0),
    ]
}

fn air_rows(air: &OutdoorLight) -> Vec<PackedRow> {
    let mut rows = vec![
        row(air.to_sun, air.white_per_lx),
        row(air.sun_lx, 0.0),
        row(air.ground_lx, 0.0),
    ];
    rows.extend(air.harmonics.map(|part| row(part, 0.0)));
    rows.extend(air.dome.coefficients().map(|part| part.map(f32::to_bits)));
    rows
}

impl StaticLighting {
    /// The constant light, when its first row is `first`: four rows of heads, storeys, windows, first windows of each room,
    /// the open air, and cells of storeys.
    pub(crate) fn to_rows(&self, first: usize) -> Vec<PackedRow> {
        let grid = &self.grid;
        let storeys = first + 4;
        let windows = storeys + grid.storeys.len();
        let starts = windows + self.windows.len() * 6;
        let start_rows = words(self.window_starts.iter().map(|start| *start as u32));
        let air = starts + start_rows.len();
        let air_rows = self.outdoor.as_ref().map_or_else(Vec::new, air_rows);
        let mut cells = air + air_rows.len();
        let mut rows = vec![
            [
                grid.corner.x.to_bits(),
                grid.corner.y.to_bits(),
                grid.cells_per_m.to_bits(),
                grid.storeys.len() as u32,
            ],
            [
                grid.width as u32,
                grid.depth as u32,
                windows as u32,
                starts as u32,
            ],
            row(self.sun.0, f32::from(u8::from(self.outdoor.is_some()))),
            row(self.sun.1, 0.0),
        ];
        rows[3][3] = air as u32;
        let mut cell_rows = Vec::new();
        for storey in &grid.storeys {
            let (low, high) = (storey.low_y.to_bits(), storey.high_y.to_bits());
            rows.push([low, high, cells as u32, 0]);
            let pair = |pair: &[u16]| {
                u32::from(pair[0]) | u32::from(pair.get(1).copied().unwrap_or(0)) << 16
            };
            let mine = words(storey.cells.chunks(2).map(pair));
            cells += mine.len();
            cell_rows.extend(mine);
        }
        rows.extend(self.windows.iter().flat_map(window_rows));
        rows.extend(start_rows);
        rows.extend(air_rows);
        rows.extend(cell_rows);
        rows
    }
}

/// A place, and a number as it is.
fn tagged(place: Vec3, tag: u32) -> PackedRow {
    let [x, y, z] = place.to_array().map(f32::to_bits);
    [x, y, z, tag]
}

fn lamp_rows(lamp: &PointLamp) -> [PackedRow; 4] {
    let (axis, cutoff, exponent) = lamp.cone.unwrap_or((Vec3::ZERO, -2.0, 0.0));
    [
        tagged(lamp.position, lamp.entity as u32),
        row(lamp.intensity, cutoff),
        row(axis, exponent),
        tagged(Vec3::from_array(lamp.attenuation), lamp.cluster),
    ]
}

impl Lighting {
    /// Appends the light of one state: two rows of heads (first rows of lamps, of the first lamps of each room, of rooms, and
    /// behind all; of shadow casters), then these.
    pub(crate) fn append_rows(&self, rows: &mut Vec<PackedRow>) {
        let lamps = rows.len() + 2;
        let starts = lamps + self.lamps.len() * 4;
        let start_rows = words(self.lamp_starts.iter().map(|start| *start as u32));
        let rooms = starts + start_rows.len();
        let casters = rooms + self.rooms.len();
        let end = casters + self.casters.len();
        rows.push([lamps as u32, starts as u32, rooms as u32, end as u32]);
        rows.push([casters as u32, 0, 0, 0]);
        rows.extend(self.lamps.iter().flat_map(lamp_rows));
        rows.extend(start_rows);
        let room_rows = self.rooms.iter();
        rows.extend(room_rows.map(|room| row(room.indirect, room.mean)));
        let casters = self.casters.iter();
        rows.extend(casters.map(|caster| tagged(caster.center, caster.entity as u32)));
    }
}

impl Exposure {
    /// Display white per lx.
    pub(crate) fn white_per_lx(self) -> f32 {
        self.per_lx
    }
}
