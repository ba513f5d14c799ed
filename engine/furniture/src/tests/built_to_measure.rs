//! Tests of models that are built to the measure of a house and not listed in the catalogue: doors, windows, stairs, railings.

use crate::finishes::{oak, painted_steel, steel, white_lacquer};
use crate::model::Model;
use crate::models::curtains_and_blinds::Curtains;
use crate::models::doors::Door;
use crate::models::heating_and_cooling::radiator;
use crate::models::stairs::{Stairs, railing};
use crate::models::windows::{Window, clear_pane, frosted_pane};
use crate::tables::category;
use crate::testing::meshes::{collider_bounds, open_edges};
use dwell_scene::Mobility;

fn models() -> Vec<Model> {
    let door = |width_m, glazed, hinge_right| Door {
        width_m,
        glazed,
        hinge_right,
        ..Door::default()
    };
    let window = |width_m, lights, pane| Window {
        width_m,
        height_m: 1.3,
        wall_m: 0.15,
        casements: lights,
        pane,
        sill_m: 0.1,
    };
    let stairs = |goes_on, mirrored| Stairs {
        width_m: 2.0,
        depth_m: 3.4,
        rise_m: 2.8,
        continues_up: goes_on,
        mirrored,
        wood: oak(),
        paint: white_lacquer(),
    };
    let curtains = Curtains {
        width_m: 2.0,
        height_m: 2.2,
        drawn: 0.2,
        cloth: painted_steel("cloth", [120, 130, 140]),
    };
    vec![
        door(0.8, false, false).build(),
        door(0.98, true, true).build(),
        window(0.6, 1, frosted_pane()).build(),
        window(1.2, 2, clear_pane()).build(),
        stairs(false, false).build(),
        stairs(true, true).build(),
        railing(2.0, &steel()),
        curtains.build(),
        radiator(1.0, 0.5),
    ]
}

#[test]
fn meshes_are_closed_and_every_part_is_felt() {
    for model in models() {
        let row = category([model.category]).unwrap();
        assert_eq!(row.name, model.category, "{}", model.name);
        assert!(!model.parts.is_empty(), "{}", model.name);
        for part in &model.parts {
            let at = format!("{} {}", model.name, part.name);
            part.mesh.check(&at).unwrap();
            assert_eq!(open_edges(&part.mesh), 0, "{at}");
            assert_eq!(part.mesh.slot_count(), part.finishes.len(), "{at}");
            assert!(!part.colliders.is_empty(), "{at}: nothing touches it");
        }
    }
}

#[test]
fn what_is_seen_is_as_large_as_what_is_felt() {
    for model in models() {
        for part in &model.parts {
            let seen = part.mesh.bounds();
            let felt = collider_bounds(&part.colliders).unwrap();
            let largest = seen.size().max_element();
            let (near, cover) = (
                seen.grown(0.004 + 0.02 * largest),
                felt.grown(0.02 + 0.12 * largest),
            );
            let fits = near.contains(felt.min)
                && near.contains(felt.max)
                && cover.contains(seen.min)
                && cover.contains(seen.max);
            let at = format!("{} {}", model.name, part.name);
            assert!(fits, "{at}: felt {felt:?}, seen {seen:?}");
        }
    }
}

#[test]
fn joints_move_parts_that_exist_and_open_from_zero() {
    for model in models() {
        for joint in &model.joints {
            assert!(joint.parent < joint.child, "{}", model.name);
            assert!(joint.child < model.parts.len(), "{}", model.name);
            assert!(joint.open > 0.0, "{}", model.name);
            let length = joint.axis.length();
            assert!((length - 1.0).abs() < 1e-6, "{}", model.name);
        }
        let opens = model.mobility == Mobility::Articulated;
        assert_eq!(opens, !model.joints.is_empty(), "{}", model.name);
    }
}
