//! Each piece of an object has its own material.
//!
//! Regression: all pieces of a part had the part's first material.

use crate::common::{Build, Piece, Run, gravity, pair};
use dwell_physics::{ContactEntity, ContactKind, PhysicsConfig};
use dwell_scene::{Collider, Mesh, Mobility, ObjectId, Pose};
use glam::{Quat, Vec3};
use std::f32::consts::PI;
use std::sync::Arc;

const HALF: Vec3 = Vec3::new(0.15, 0.04, 0.15);

/// A slab of steel under one of rubber, as two parts or as one part of two materials and two pieces.
fn sandwich(build: &mut Build, place: Pose, parts: usize) -> ObjectId {
    let slab = |up: f32, substance| {
        let mut piece = Piece::cuboid(HALF, Vec3::ZERO).of(substance);
        piece.place = place * Pose::from_position(Vec3::Y * up * HALF.y);
        piece
    };
    let slabs = [slab(-1.0, "steel"), slab(1.0, "rubber")];
    if parts == 2 {
        return build.object("sandwich", Mobility::Movable, &slabs);
    }
    let mut whole = Piece::cuboid(Vec3::new(HALF.x, 2.0 * HALF.y, HALF.z), Vec3::ZERO);
    whole.place = place;
    let object = build.movable("sandwich", whole);
    let rubber = build.material("rubber");
    let steel = build.material("steel");
    // The faces of rubber come first in the mesh, and so does the material; the pieces have another order.
    let (low, high) = (
        [-HALF.with_y(2.0 * HALF.y), HALF.with_y(0.0)],
        [-HALF.with_y(0.0), HALF.with_y(2.0 * HALF.y)],
    );
    let mut mesh = Mesh::cuboid(high[0], high[1]);
    let count = mesh.triangles.len();
    let other = Mesh::cuboid(low[0], low[1]);
    let first = mesh.positions.len() as u32;
    mesh.positions.extend(&other.positions);
    mesh.normals.extend(&other.normals);
    mesh.uvs.extend(&other.uvs);
    let triangles = other.triangles.iter();
    let moved = triangles.map(|corners| corners.map(|corner| corner + first));
    mesh.triangles.extend(moved);
    mesh.slots = vec![0; count];
    mesh.slots.extend(vec![1; other.triangles.len()]);
    let part = build.data.objects[object].first_part;
    let mesh = build.data.meshes.push(Arc::new(mesh));
    let part = &mut build.data.parts[part];
    part.mesh = mesh;
    part.materials = vec![rubber, steel];
    part.colliders = [low, high]
        .map(|[min, max]| Collider::cuboid(min, max))
        .into();
    object
}

/// On a slope of oak that steel slides down and rubber does not, lying on its steel or turned over onto its rubber.
fn on_a_slope(angle_rad: f32, on_rubber: bool, parts: usize) -> (Run, ObjectId) {
    let mut build = Build::room([24.0, 20.0, 4.0]);
    let turned = Quat::from_rotation_z(-angle_rad);
    let middle = Vec3::new(12.0, 10.0, 2.0);
    let slope = Piece::cuboid(Vec3::new(11.0, 0.1, 1.0), middle).of("oak");
    build.fixed("slope", slope.turned(turned));
    let over = Quat::from_rotation_x(if on_rubber { PI } else { 0.0 });
    let up = 0.1 + 2.0 * HALF.y;
    let place = Pose::new(middle + turned * Vec3::new(-9.0, up, 0.0), turned * over);
    let object = sandwich(&mut build, place, parts);
    let config = PhysicsConfig {
        sleeping: false,
        ..PhysicsConfig::default()
    };
    (build.run_with(config), object)
}

/// Down a slope between the two angles of friction the object slides with `g (sin t - mu cos t)` on its steel, within 1 %,
/// and stays on its rubber; events name the substance in contact.
#[test]
fn a_thing_of_steel_and_rubber_slides_or_stays_by_which_touches() {
    let (steel, rubber) = (pair("oak", "steel").0, pair("oak", "rubber").0);
    assert!(rubber > steel + 0.1, "{steel} {rubber}");
    let angle = dwell_scene::math::atan2(0.5 * (steel + rubber), 1.0);
    let (sin, cos) = dwell_scene::math::sin_cos(angle);
    for parts in [1, 2] {
        for on_rubber in [false, true] {
            let (mut run, object) = on_a_slope(angle, on_rubber, parts);
            let from = run.position(object);
            run.steps(20);
            let found = (run.position(object) - from).length();
            if on_rubber {
                assert!(found < 2e-3, "{parts} parts: {found} m on rubber");
                continue;
            }
            let expected = 0.5 * gravity() * (sin - steel * cos);
            assert!(
                (found / expected - 1.0).abs() < 0.01,
                "{parts} parts: {found} m, expected {expected} m"
            );
            let scrapes = run.events.iter();
            let mut scrapes = scrapes.filter(|event| event.kind == ContactKind::Scrape);
            let told = scrapes.next().expect("it scrapes");
            let named = [(told.a, told.substance_a), (told.b, told.substance_b)];
            let root = run.root(object);
            let own = named.iter().find(|(toucher, _)| match toucher {
                ContactEntity::Part(part) => run.house.parts[*part].object == object,
                _ => false,
            });
            assert_eq!(
                own.map(|(_, substance)| *substance),
                Some("steel"),
                "{root:?}"
            );
            assert!((told.friction - steel).abs() < 1e-6, "{}", told.friction);
        }
    }
}
