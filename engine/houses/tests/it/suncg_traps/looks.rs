//! Materials, overrides, textures and boxes.

use dwell_houses::WarningKind;
use glam::{Vec2, Vec3};

use super::{count, materials, reported_at, root_part, srgb, texture_name, traps};

#[test]
fn textures_of_both_path_styles_are_found() {
    let house = &traps().0;
    let floor = house
        .structure
        .iter()
        .find(|piece| piece.name == "Floor#0_0")
        .unwrap();
    let top = &house.materials[floor.materials[0]];
    assert_eq!(
        (texture_name(top.texture), top.substance.as_str()),
        (Some("laminate_1_2"), "laminate")
    );
    let wall = house
        .structure
        .iter()
        .find(|piece| piece.name == "WallInside#0_0_0")
        .unwrap();
    let paint = &house.materials[wall.materials[0]];
    assert_eq!(
        (texture_name(paint.texture), srgb(paint)),
        (Some("wallp_0"), [230, 28, 82])
    );
}

#[test]
fn overrides_count_positions_in_the_material_file() {
    let [first, second, third] = materials("0_0")[..] else {
        panic!("three slots")
    };
    // Diffuse alone.
    assert_eq!((srgb(first), first.texture), ([0x8e; 3], None));
    // Texture alone: the PNG, tinted by the slot's own colour as its own texture was.
    assert_eq!(
        (texture_name(second.texture), srgb(second)),
        (Some("wood_3"), [163; 3])
    );
    assert_eq!(
        &traps().0.textures[second.texture.unwrap()].rgba()[..3],
        [10, 20, 30]
    );
    // Neither: the model's own, half transparent.
    assert_eq!(
        (srgb(third), third.opacity, third.substance.as_str()),
        ([64, 128, 191], 0.5, "chrome")
    );
    assert!(reported_at("levels[0].nodes[0].materials", |d| matches!(
        d,
        WarningKind::ExtraOverrides {
            found: 4,
            allowed: 3
        }
    )));
    // The slots of the triangles follow the MTL file although `usemtl` comes in another order.
    let mesh = &traps().0.meshes[root_part("0_0").mesh];
    assert_eq!(mesh.slots, [2, 2, 0, 0, 1]);
}

#[test]
fn overrides_with_faults_keep_what_can_be_kept() {
    let [both, bad, gone] = materials("0_4_2")[..] else {
        panic!("three slots")
    };
    assert_eq!(
        (srgb(both), texture_name(both.texture)),
        ([0x80; 3], Some("0123456789abcdef0"))
    );
    assert_eq!((srgb(bad), bad.texture), ([64; 3], None));
    assert_eq!((srgb(gone), gone.texture), ([32; 3], None));
    assert!(reported_at(
        "levels[0].nodes[5].materials[1].diffuse",
        |d| matches!(d, WarningKind::BadColor { .. })
    ));
    assert_eq!(
        count(
            |d| matches!(d, WarningKind::MissingTexture { path } if path == "texture/no_such_texture")
        ),
        1
    );
}

#[test]
fn overrides_may_be_indices_into_the_house() {
    let [red, kept, unknown] = materials("0_6")[..] else {
        panic!("three slots")
    };
    assert_eq!(
        (srgb(red), srgb(kept), srgb(unknown)),
        ([255, 0, 0], [64; 3], [32; 3])
    );
    assert!(reported_at(
        "levels[0].nodes[6].materialIndices",
        |d| matches!(d, WarningKind::BadIndex { found, .. } if found == "99")
    ));
}

#[test]
fn a_texture_on_a_mesh_without_coordinates_gets_some() {
    let mesh = &traps().0.meshes[root_part("0_4_2").mesh];
    assert_eq!(mesh.uvs.len(), mesh.positions.len());
    assert!(mesh.uvs.iter().any(|uv| *uv != Vec2::ZERO));
}

#[test]
fn boxes_have_their_slots_in_the_order_of_the_format() {
    let house = &traps().0;
    let part = root_part("0_10");
    let mesh = &house.meshes[part.mesh];
    assert_eq!(mesh.bounds().size(), Vec3::new(1.0, 0.5, 0.3));
    let blue_of = |normal: Vec3| {
        let k = (0..12)
            .find(|k| {
                let [a, b, c] = mesh.corners(*k);
                (b - a).cross(c - a).normalize().abs_diff_eq(normal, 1e-6)
            })
            .unwrap();
        let material = &house.materials[part.materials[usize::from(mesh.slot(k))]];
        (material.texture.is_some(), srgb(material)[2])
    };
    assert_eq!(blue_of(Vec3::Y), (true, 255));
    let sides = [Vec3::NEG_Y, Vec3::NEG_X, Vec3::X, Vec3::Z, Vec3::NEG_Z].map(blue_of);
    assert_eq!(
        sides,
        [(false, 1), (false, 2), (false, 3), (false, 4), (false, 5)]
    );
    assert_eq!(
        mesh.uvs.iter().copied().reduce(Vec2::max),
        Some(Vec2::new(1.0, 1.0)),
        "metres"
    );
}
