//! The second release, whose walls stand in `arch.json`.

use dwell_houses::{WarningKind, open};
use dwell_scene::{RoomId, StructureKind};
use glam::Vec2;

use super::files::compose_second_release;
use super::srgb;

#[test]
fn walls_floors_and_ceilings_come_from_arch_json() {
    let root = tempfile::tempdir().unwrap();
    compose_second_release(root.path());
    let (house, report) = open(&root.path().to_string_lossy()).unwrap();
    let pieces: Vec<_> = house
        .structure
        .iter()
        .map(|p| (p.name.as_str(), p.kind, p.room))
        .collect();
    let (first, second) = (Some(RoomId(0)), Some(RoomId(1)));
    let expected = [
        ("0_0_w0", StructureKind::Wall, first),
        ("0_0_w1", StructureKind::Wall, first),
        ("0_0_f", StructureKind::Floor, first),
        ("0_0_c", StructureKind::Ceiling, first),
        ("0_1_f", StructureKind::Floor, second),
        ("lost", StructureKind::Wall, None),
    ];
    assert_eq!(
        pieces, expected,
        "a shared wall stands once, a hidden ceiling not at all"
    );
    let mesh = |name: &str| {
        let piece = house
            .structure
            .iter()
            .find(|piece| piece.name == name)
            .unwrap();
        &house.meshes[piece.mesh]
    };
    // 4 m of wall, 2.7 m and 0.035 m more high, less a door and a window.
    let volume = 0.1 * (4.0 * 2.735 - 0.9 * 2.08 - 1.4 * 1.36);
    assert!((mesh("0_0_w0").enclosed_volume_m3() - volume).abs() < 1e-4);
    let [bedroom, other] = house.rooms.as_slice() else {
        panic!("two rooms")
    };
    assert!((bedroom.area_m2() - 12.0).abs() < 1e-4 && (bedroom.floor_y - 0.05).abs() < 1e-6);
    assert!((bedroom.ceiling_y - 2.69).abs() < 1e-5);
    assert!(
        (other.area_m2() - 4.0).abs() < 1e-4 && !other.contains_xz(Vec2::new(44.5, 42.0)),
        "an L"
    );
    let wall = &house.structure.as_slice()[0];
    let [inside, outside] = [0, 1].map(|slot| &house.materials[wall.materials[slot]]);
    assert_eq!(
        (srgb(inside), inside.substance.as_str()),
        ([255, 128, 0], "wallpaper")
    );
    assert_eq!(
        (outside.texture.is_some(), outside.substance.as_str()),
        (true, "brick")
    );
    assert_eq!(report.count(|d| matches!(d, WarningKind::BadRow { .. })), 1);
    assert_eq!(
        report.count(|d| matches!(d, WarningKind::MissingMesh { .. })),
        0
    );
}
