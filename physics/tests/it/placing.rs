//! Placing objects: a placed object stands, or the action is refused with the reason.

use crate::common::{Build, Piece, Run};
use dwell_physics::{OutcomeCode, PhysicsConfig, Target, actions};
use dwell_scene::{AgentId, Collider, Mobility, ObjectId, Pose, SupportDirection};
use glam::{Quat, Vec3};
use std::f32::consts::PI;
use std::sync::Arc;

/// Largest displacement, m, and rotation of an object in the two seconds after it was put down.
const MOVES_M: f32 = 0.01;
const TURNS_DEG: f32 = 5.0;

fn stays(run: &mut Run, object: ObjectId) -> (f32, f32) {
    let (from, turned) = (run.position(object), run.rotation(object));
    run.steps(40);
    let moved = (run.position(object) - from).length();
    let turn = 2.0 * turned.dot(run.rotation(object)).abs().min(1.0).acos();
    (moved, turn.to_degrees())
}

struct Setting {
    run: Run,
    agent: AgentId,
    table: ObjectId,
    thing: ObjectId,
}

fn table(piece: Piece, clutter: &[Vec3]) -> Setting {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let table = build.fixed(
        "table",
        Piece::cuboid(Vec3::new(0.6, 0.4, 0.4), Vec3::new(3.0, 0.4, 2.0)),
    );
    let mut piece = piece.density(100.0);
    piece.place.position = Vec3::new(3.5, 0.3, 3.0);
    let thing = build.movable("thing", piece);
    for (k, at) in clutter.iter().enumerate() {
        let half = Vec3::new(0.05, 0.1, 0.05);
        build.movable(
            &format!("bottle_{k}"),
            Piece::cuboid(half, *at + Vec3::Y * 0.901),
        );
    }
    let mut run = build.run();
    let agent = run.agent(Vec3::new(3.2, 0.0, 2.8), 0.0);
    run.steps(1);
    let thing_at = run.root(thing);
    run.state.part_pose[thing_at].position = Vec3::new(3.2, 1.0, 2.3);
    run.world.adopt_state(&mut run.state).unwrap();
    run.rays.update(&run.state);
    let told = run.act(agent, actions::Pick::new(thing));
    assert!(told.success, "{}", told.sentence);
    Setting {
        run,
        agent,
        table,
        thing,
    }
}

fn cylinder(radius: f32, half_height: f32) -> Piece {
    Piece {
        collider: Collider::Cylinder {
            part_from_cylinder: Pose::IDENTITY,
            half_height,
            radius,
        },
        ..Piece::cuboid(Vec3::ONE, Vec3::ZERO)
    }
}

fn pyramid(half: f32, height: f32) -> Piece {
    let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
    let mut points = vec![Vec3::Y * height];
    points.extend(corners.map(|(x, z)| Vec3::new(x, 0.0, z)));
    Piece {
        collider: Collider::Hull { points },
        ..Piece::cuboid(Vec3::ONE, Vec3::ZERO)
    }
}

#[test]
fn things_of_all_shapes_stand_where_they_are_put() {
    let turned = |axis: Vec3, angle: f32| Quat::from_axis_angle(axis.normalize(), angle);
    let shapes = [
        Piece::cuboid(Vec3::new(0.05, 0.1, 0.03), Vec3::ZERO),
        // Held askew, it is put down straight.
        Piece::cuboid(Vec3::new(0.05, 0.1, 0.03), Vec3::ZERO)
            .turned(turned(Vec3::new(1.0, 0.2, 0.5), 0.7)),
        Piece::cuboid(Vec3::new(0.15, 0.005, 0.1), Vec3::ZERO),
        Piece::cuboid(Vec3::new(0.01, 0.15, 0.01), Vec3::ZERO),
        cylinder(0.04, 0.06),
        cylinder(0.01, 0.1),
        pyramid(0.05, 0.15),
        Piece::ball(0.05, Vec3::ZERO),
    ];
    for (k, piece) in shapes.into_iter().enumerate() {
        let mut on = table(piece, &[]);
        let told = on.run.act(on.agent, actions::Place::on(on.table));
        assert_eq!(told.code, OutcomeCode::Done, "{k}: {}", told.sentence);
        assert_eq!(told.sentence, "You put the thing on the table.");
        let (moved, turn) = stays(&mut on.run, on.thing);
        assert!(
            moved < MOVES_M && turn < TURNS_DEG,
            "{k}: {moved} m, {turn} degrees"
        );
        let table = on.run.state.supports_of(&on.run.house, on.thing);
        assert_eq!(table, [Some(on.table)], "{k}");
    }
}

#[test]
fn a_spot_is_found_between_other_things_and_refused_when_there_is_none() {
    // Bottles every 0.25 m leave room for 0.1 m, not for 0.3 m.
    let mut clutter = Vec::new();
    for x in [2.5, 2.75, 3.0, 3.25, 3.5] {
        for z in [1.7, 1.95, 2.2] {
            clutter.push(Vec3::new(x, 0.0, z));
        }
    }
    let small = Piece::cuboid(Vec3::splat(0.05), Vec3::ZERO);
    let mut on = table(small, &clutter);
    let told = on.run.act(on.agent, actions::Place::on(on.table));
    assert_eq!(told.code, OutcomeCode::Done, "{}", told.sentence);
    let (moved, turn) = stays(&mut on.run, on.thing);
    assert!(moved < MOVES_M && turn < TURNS_DEG, "{moved} {turn}");
    let large = Piece::cuboid(Vec3::new(0.15, 0.15, 0.15), Vec3::ZERO);
    let mut on = table(large, &clutter);
    let told = on.run.act(on.agent, actions::Place::on(on.table));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::NoSpace,
            "There is no free space for the thing on the table within your reach and sight. Clear it or walk around it."
        )
    );
    assert_eq!(on.run.state.held_by[on.thing], Some(on.agent));
}

#[test]
fn a_thing_is_put_at_a_point_and_nowhere_else() {
    let mug = || Piece::cuboid(Vec3::new(0.04, 0.05, 0.04), Vec3::ZERO);
    let mut on = table(mug(), &[]);
    let point = Vec3::new(3.1, 0.8, 2.2);
    let told = on.run.act(on.agent, actions::PlaceAt { point });
    assert_eq!(told.code, OutcomeCode::Done, "{}", told.sentence);
    let (moved, turn) = stays(&mut on.run, on.thing);
    assert!(moved < MOVES_M && turn < TURNS_DEG);
    let at = on.run.position(on.thing);
    assert!((at - point - Vec3::Y * 0.05).length() < 0.01, "{at}");
    let mut on = table(mug(), &[Vec3::new(3.0, 0.0, 2.1)]);
    let cases = [
        (Vec3::NAN, OutcomeCode::BadNumber, "NaN"),
        (
            Vec3::new(3.0, 0.0, 5.5),
            OutcomeCode::TooFar,
            "That place is 2.98 m away; your reach is 1.50 m. Walk closer.",
        ),
        (
            Vec3::new(3.2, 1.2, 2.2),
            OutcomeCode::NoSupport,
            "Nothing carries the thing there. Choose a point on a level surface.",
        ),
        (
            Vec3::new(3.02, 0.8, 2.1),
            OutcomeCode::NoSpace,
            "The thing does not fit there: the bottle is in the way. Choose another point.",
        ),
        (
            // Half of it over the edge at z = 2.4.
            Vec3::new(3.3, 0.8, 2.399),
            OutcomeCode::NoSupport,
            "The thing would not stand there. Choose a level spot away from edges.",
        ),
        (
            // Inside the table.
            Vec3::new(3.2, 0.4, 2.2),
            OutcomeCode::NotVisible,
            "The table is between you and that place. Choose one in the open.",
        ),
    ];
    for (point, code, sentence) in cases {
        let told = on.run.act(on.agent, actions::PlaceAt { point });
        assert_eq!(told.code, code, "{point}: {}", told.sentence);
        assert!(
            told.sentence.contains(sentence),
            "{point}: {}",
            told.sentence
        );
        assert_eq!(on.run.state.held_by[on.thing], Some(on.agent));
    }
    // Inside the wall at z = 6, or beyond it.
    on.run
        .world
        .place_agent(&mut on.run.state, on.agent, Vec3::new(3.0, 0.0, 5.2), PI)
        .unwrap();
    on.run.rays.update(&on.run.state);
    for z in [6.0, 6.05, 6.3] {
        let point = Vec3::new(3.0, 0.5, z);
        let told = on.run.act(on.agent, actions::PlaceAt { point });
        assert!(!told.success, "{z}");
        assert!(
            [
                OutcomeCode::NotVisible,
                OutcomeCode::NoSupport,
                OutcomeCode::NoSpace
            ]
            .contains(&told.code),
            "{:?}",
            told.code
        );
    }
}

#[test]
fn a_thing_is_put_on_what_is_seen_and_on_the_floor_where_a_ray_meets_it() {
    let mug = || Piece::cuboid(Vec3::new(0.04, 0.05, 0.04), Vec3::ZERO);
    let mut on = table(mug(), &[]);
    on.run.state.agents[on.agent].pitch_rad = -0.6;
    let told = on.run.act(on.agent, actions::Place { target: None });
    assert_eq!(
        (told.code, told.sentence.as_str(), told.object),
        (
            OutcomeCode::Done,
            "You put the thing on the table.",
            Some(on.table)
        )
    );
    let (moved, turn) = stays(&mut on.run, on.thing);
    assert!(moved < MOVES_M && turn < TURNS_DEG);
    // Looking up, there is nothing to put it on.
    let mut on = table(mug(), &[]);
    on.run.state.agents[on.agent].pitch_rad = 1.2;
    let told = on.run.act(on.agent, actions::Place { target: None });
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::NoSpace,
            "You see no free surface for the thing within your reach. Turn towards one."
        )
    );
    let eye = on.run.state.agents[on.agent].eye_position();
    let spot = Vec3::new(3.9, 0.0, 2.7);
    let floor = Target::Ray {
        origin: eye,
        direction: spot - eye,
    };
    let told = on.run.act(on.agent, actions::Place::on(floor));
    assert_eq!(told.sentence, "You put the thing on the floor.");
    let at = on.run.position(on.thing);
    assert!((at - spot).with_y(0.0).length() < 0.02, "{at}");
    let (moved, turn) = stays(&mut on.run, on.thing);
    assert!(moved < MOVES_M && turn < TURNS_DEG);
    assert_eq!(on.run.state.supports_of(&on.run.house, on.thing), [None]);
}

#[test]
fn what_rests_on_what_follows_a_stack() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let block = |half: f32, y: f32| Piece::cuboid(Vec3::splat(half), Vec3::new(3.0, y, 3.0));
    let low = build.movable("low", block(0.2, 0.2));
    let high = build.movable("high", block(0.1, 0.501));
    // One that leans on nothing stands beside them, touching.
    let beside = build.movable("beside", {
        let mut piece = block(0.1, 0.1);
        piece.place.position.x = 3.3;
        piece
    });
    let mut run = build.run();
    run.steps(40);
    let rests = |run: &Run, object| run.state.supports_of(&run.house, object);
    assert_eq!(rests(&run, low), [None]);
    assert_eq!(rests(&run, high), [Some(low)]);
    assert_eq!(rests(&run, beside), [None]);
    for contact in &run.state.contacts {
        if contact.b.is_none() {
            assert_eq!(
                contact.support_relation,
                SupportDirection::AOnB,
                "everything stands on the floor"
            );
        }
    }
}

/// Every small thing of the apartment, put on its dining table one after the other.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn the_apartments_things_stand_on_its_table() {
    let house = Arc::new(dwell_houses::open("builtin:apartment").unwrap().0);
    let mut run = Run::over(Arc::clone(&house), PhysicsConfig::default());
    let tables = house.objects.iter_ids();
    let tables = tables.filter(|(_, object)| object.category.coarse == "dining_table");
    let size = |id: ObjectId| {
        let size = house.object_bounds(&run.state, id).size();
        size.x * size.z
    };
    let largest = tables.max_by(|a, b| size(a.0).total_cmp(&size(b.0)));
    let table = largest.expect("a dining table").0;
    let middle = house.object_bounds(&run.state, table).center();
    let stand = run.places_by(middle)[0];
    let ahead = (middle - stand).with_y(0.0).normalize();
    let agent = run.agent(stand, dwell_scene::space::yaw_from_forward(ahead));
    let pickable: Vec<ObjectId> = house
        .objects
        .iter_ids()
        .filter(|(_, o)| o.pickable && o.mobility == Mobility::Movable && o.part_count == 1)
        .map(|(id, _)| id)
        .collect();
    run.steps(20);
    let start = run.clone();
    let (mut put, mut restless) = (0, Vec::new());
    for object in &pickable {
        let mut run = start.clone();
        let (eye, root) = (run.state.agents[agent].eye_position(), run.root(*object));
        run.state.part_pose[root].position = eye + ahead * 0.5 - Vec3::Y * 0.1;
        run.world.adopt_state(&mut run.state).unwrap();
        run.rays.update(&run.state);
        let told = run.act(agent, actions::Pick::new(*object));
        if !told.success {
            println!("{}: {}", house.objects[*object].name, told.sentence);
            continue;
        }
        let told = run.act(agent, actions::Place::on(table));
        if !told.success {
            println!("{}: {}", house.objects[*object].name, told.sentence);
            continue;
        }
        put += 1;
        let (moved, turn) = stays(&mut run, *object);
        if moved > MOVES_M || turn > TURNS_DEG {
            let name = &house.objects[*object].model;
            restless.push(format!("{name}: {moved:.3} m, {turn:.1} degrees"));
        }
    }
    println!(
        "{put} of {} things put down; restless: {restless:?}",
        pickable.len()
    );
    assert!(
        put * 10 >= pickable.len() * 8,
        "{put} of {}",
        pickable.len()
    );
    assert!(restless.is_empty(), "{restless:?}");
}
