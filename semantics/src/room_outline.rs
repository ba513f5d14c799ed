//! The borders of a room seen from above: its corners and its middle.

use dwell_scene::Room;
use glam::Vec2;
use std::collections::BTreeMap;

/// The sharpest and bluntest angle of a corner, as cosine between its borders: 45 and 135 degrees.
const CORNER_COSINE: f32 = std::f32::consts::FRAC_1_SQRT_2 + 1e-5;

/// A room seen from above.
#[derive(Clone, Debug, Default)]
pub(crate) struct RoomOutline {
    /// The corners at which two borders meet at 45 to 135 degrees on the room's side, (x, z), m.
    pub(crate) corners: Vec<Vec2>,
    /// Along the longest border, unit length.
    along: Vec2,
    /// The middle and half the edges of the rectangle around the floor, along and across its longest border, m.
    middle: Vec2,
    half_m: Vec2,
}

impl RoomOutline {
    pub(crate) fn gather(room: &Room) -> Self {
        let edges = boundary_edges(room);
        let longest = edges
            .iter()
            .max_by(|[a, b], [c, d]| a.distance_squared(*b).total_cmp(&c.distance_squared(*d)));
        let Some(along) = longest.and_then(|[a, b]| (*b - *a).try_normalize()) else {
            return Self::default();
        };
        let points = room.footprint.iter().flatten();
        let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for point in points {
            let local = along_across(along, *point);
            (low, high) = (low.min(local), high.max(local));
        }
        Self {
            corners: corners(room, &edges),
            along,
            middle: (low + high) * 0.5,
            half_m: (high - low) * 0.5,
        }
    }

    /// Returns where a point lies along the longer edge of the rectangle around the floor, -1 to 1 from end to end.
    pub(crate) fn lengthwise_position(&self, point: Vec2) -> f32 {
        let share = self.normalized_position(point);
        if self.half_m.x >= self.half_m.y {
            share.x
        } else {
            share.y
        }
    }

    /// Returns the direction of the longest border, unit length; zero for a room without a floor.
    pub(crate) fn long_axis(&self) -> Vec2 {
        self.along
    }

    /// Returns where a point lies in the rectangle around the floor: -1 to 1 along and across the longest border.
    pub(crate) fn normalized_position(&self, point: Vec2) -> Vec2 {
        (along_across(self.along, point) - self.middle) / self.half_m.max(Vec2::splat(1e-6))
    }
}

fn along_across(along: Vec2, point: Vec2) -> Vec2 {
    Vec2::new(along.dot(point), along.perp().dot(point))
}

/// The edges of a room's footprint that only one of its triangles has.
pub(crate) fn boundary_edges(room: &Room) -> Vec<[Vec2; 2]> {
    let mut edges: BTreeMap<[[u32; 2]; 2], ([Vec2; 2], usize)> = BTreeMap::new();
    for [a, b, c] in &room.footprint {
        for [p, q] in [[*a, *b], [*b, *c], [*c, *a]] {
            let mut ends = [key(p), key(q)];
            ends.sort_unstable();
            edges.entry(ends).or_insert(([p, q], 0)).1 += 1;
        }
    }
    let once = edges.into_values().filter(|(_, count)| *count == 1);
    once.map(|(edge, _)| edge).collect()
}

fn key(p: Vec2) -> [u32; 2] {
    (p + Vec2::ZERO).to_array().map(f32::to_bits)
}

fn corners(room: &Room, edges: &[[Vec2; 2]]) -> Vec<Vec2> {
    let mut at: BTreeMap<[u32; 2], (Vec2, Vec<Vec2>)> = BTreeMap::new();
    for [a, b] in edges {
        for (from, to) in [(*a, *b), (*b, *a)] {
            let Some(out) = (to - from).try_normalize() else {
                continue;
            };
            let entry = at.entry(key(from)).or_insert((from, Vec::new()));
            entry.1.push(out);
        }
    }
    let is_corner = |(point, out): &(Vec2, Vec<Vec2>)| {
        let [p, q] = out[..] else {
            return false;
        };
        let within = (p + q).try_normalize();
        let inside = |way: Vec2| room.contains_xz(*point + way * 0.05);
        p.dot(q).abs() <= CORNER_COSINE && within.is_some_and(inside)
    };
    let found = at.into_values().filter(is_corner);
    found.map(|(point, _)| point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_room_in_the_form_of_an_l_has_five_corners() {
        let p = |x: f32, z: f32| Vec2::new(x, z);
        let (a, b, c, d) = (p(0.0, 0.0), p(4.0, 0.0), p(4.0, 2.0), p(2.0, 2.0));
        let (e, f, g) = (p(2.0, 5.0), p(0.0, 5.0), p(0.0, 2.0));
        let room = Room {
            name: "l".to_owned(),
            level: dwell_scene::LevelId(0),
            kinds: Vec::new(),
            footprint: vec![[a, b, c], [a, c, d], [a, d, g], [g, d, e], [g, e, f]],
            floor_y: 0.0,
            ceiling_y: 2.5,
            bounds: dwell_scene::Aabb::default(),
        };
        let outline = RoomOutline::gather(&room);
        assert_eq!(outline.corners.len(), 5, "{:?}", outline.corners);
        assert!(!outline.corners.contains(&d) && !outline.corners.contains(&g));
        let share = outline.normalized_position(p(2.0, 2.5));
        assert!(share.length() < 1e-6, "{share}");
        assert!((outline.normalized_position(f).abs() - Vec2::ONE).length() < 1e-6);
    }
}
