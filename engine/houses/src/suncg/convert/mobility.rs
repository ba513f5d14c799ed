//! Mobility: by kind of thing, and by whether it stands on something.

use dwell_scene::{Aabb, Room};
use glam::{Vec2, Vec3};

use super::super::metadata::CategoryEntry;
use crate::import::CategoryRow;

/// Largest gap between an object and its support, m; SUNCG's objects rarely touch exactly.
const GAP_M: f32 = 0.06;
/// Largest side of a thing that one hand takes, m.
const HAND_SIDE_M: f32 = 0.6;
/// Largest box of a thing that one hand takes, m³.
const HAND_VOLUME_M3: f32 = 0.05;

/// Returns whether this kind of thing is movable.
///
/// Things of unknown kind are fixed: a house without tables must not fall apart.
pub(super) fn is_movable_kind(row: Option<&CategoryRow>, entry: Option<&CategoryEntry>) -> bool {
    row.is_some_and(|row| row.is_movable() && !row.is_mounted())
        && entry.is_none_or(|entry| entry.structure != 1)
}

/// Returns whether something with `bounds` stands on a floor or on another thing, so that it would stay where it is.
pub(super) fn is_supported(
    bounds: &Aabb,
    rooms: &[Room],
    stands: impl IntoIterator<Item = Aabb>,
) -> bool {
    let center = Vec3::new(bounds.center().x, bounds.min.y, bounds.center().z);
    let on_floor = |room: &Room| {
        (center.y - room.floor_y).abs() < GAP_M && room.contains_xz(Vec2::new(center.x, center.z))
    };
    let on_thing = |other: Aabb| {
        let under = Vec3::new(center.x, other.center().y, center.z);
        // Things also stand on shelves, below the top of the shelf's box.
        other.contains(under) && other.min.y < center.y - 0.01 && center.y < other.max.y + GAP_M
    };
    rooms.iter().any(on_floor) || stands.into_iter().any(on_thing)
}

/// Returns whether a hand can take a thing of this size.
pub(super) fn is_hand_sized(bounds: &Aabb) -> bool {
    bounds.size().max_element() <= HAND_SIDE_M && bounds.volume() <= HAND_VOLUME_M3
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::LevelId;

    #[test]
    fn hanging_things_are_not_supported() {
        let floor = [
            Vec2::new(0.0, 0.0),
            Vec2::new(4.0, 0.0),
            Vec2::new(0.0, 4.0),
        ];
        let room = Room {
            name: "a".into(),
            level: LevelId(0),
            kinds: vec![],
            footprint: vec![floor],
            floor_y: 0.05,
            ceiling_y: 2.7,
            bounds: Aabb::EMPTY,
        };
        let at = |y: f32| Aabb::new(Vec3::new(1.0, y, 1.0), Vec3::new(1.2, y + 0.3, 1.2));
        let table = Aabb::new(Vec3::new(0.5, 0.05, 0.5), Vec3::new(1.5, 0.8, 1.5));
        assert!(is_supported(&at(0.07), std::slice::from_ref(&room), None));
        assert!(!is_supported(
            &at(1.5),
            std::slice::from_ref(&room),
            Some(table)
        ));
        assert!(is_supported(&at(0.81), &[room], Some(table)));
    }
}
