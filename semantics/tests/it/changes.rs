//! Changes that were made at random are told, and nothing else.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use dwell_houses::open;
use dwell_scene::random::RandomKey;
use dwell_scene::{JointId, ObjectId, State};
use dwell_semantics::check::{Addressee, Checker};
use dwell_semantics::describe::{GroundedText, describe_changes};
use dwell_semantics::form::{Clause, Form, Quality};
use dwell_semantics::{Semantics, Term};
use glam::Vec3;
use std::sync::Arc;

/// The states that a text tells, and of what.
fn states(text: &GroundedText) -> Vec<(&str, &[Term])> {
    let told = text.claims.iter().filter_map(|claim| match &claim.form {
        Form::Claim(Clause::Now(inner)) => match &**inner {
            Clause::Is {
                quality: Quality::State(state),
                ..
            } => Some((state.as_str(), &claim.terms[..])),
            _ => None,
        },
        other => panic!("{other:?}"),
    });
    told.collect()
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn what_was_changed_is_told() {
    let mut counts = [0; 3];
    for name in ["builtin:apartment", "seed:3", "seed:8"] {
        let house = Arc::new(open(name).unwrap().0);
        let semantics = Semantics::new(&house);
        let before = State::new(&house);
        let same = describe_changes(
            &semantics.scene(&before),
            &semantics.scene(&before),
            Addressee::default(),
            None,
        );
        assert_eq!(same.text, "", "{name}");
        let mut stream = RandomKey::root(3).child(name).stream();
        for round in 0..30 {
            let mut after = before.clone();
            let object: ObjectId;
            match round % 3 {
                0 => {
                    let joints: Vec<JointId> = house.joints.ids().collect();
                    let joint = *stream.choose(&joints).unwrap();
                    let own = &house.joints[joint];
                    let share =
                        (before.joint_position[joint] - own.closed) / (own.open - own.closed);
                    after.joint_position[joint] = if share > 0.5 { own.closed } else { own.open };
                    object = own.object;
                }
                1 => {
                    let lamps = house
                        .objects
                        .iter_ids()
                        .filter(|(_, own)| own.switch.is_some());
                    let lamps: Vec<ObjectId> = lamps.map(|(id, _)| id).collect();
                    object = *stream.choose(&lamps).unwrap();
                    after.switched_on[object] = !before.switched_on[object];
                }
                _ => {
                    // Into the middle of another room's floor.
                    let movable = house.objects.ids().filter(|id| {
                        house.objects[*id].part_count == 1
                            && semantics.facts(*id).category.is_some_and(|row| row.movable)
                    });
                    let movable: Vec<ObjectId> = movable.collect();
                    object = *stream.choose(&movable).unwrap();
                    let rooms: Vec<_> = house.rooms.ids().collect();
                    let room = *stream.choose(&rooms).unwrap();
                    let Some(point) = house.points_in_room(room, 9).get(4).copied() else {
                        continue;
                    };
                    let part = house.objects[object].first_part;
                    let rise = before.part_pose[part].position.y;
                    after.part_pose[part].position = Vec3::new(
                        point.x,
                        house.rooms[room].floor_y + rise.fract().abs(),
                        point.z,
                    );
                }
            }
            let scenes = (semantics.scene(&before), semantics.scene(&after));
            let text = describe_changes(&scenes.0, &scenes.1, Addressee::default(), None);
            let checker = Checker::new(&scenes.1, Addressee::default());
            for claim in &text.claims {
                let said = &text.text[claim.start..claim.end];
                let Form::Claim(Clause::Now(inner)) = &claim.form else {
                    panic!("{said}");
                };
                assert!(checker.check(inner).truth.is_true(), "{name}: {said}");
                let earlier = Checker::new(&scenes.0, Addressee::default());
                assert!(
                    !earlier.check(inner).truth.is_true(),
                    "{name}: {said} was so before"
                );
                assert_eq!(
                    semantics.language().read(said).unwrap().forms[0],
                    claim.form,
                    "{said}"
                );
            }
            let of_object = |terms: &[Term]| terms.contains(&Term::Object(object));
            match round % 3 {
                0 | 1 => {
                    let told = states(&text);
                    assert!(
                        told.iter().all(|(_, terms)| of_object(terms)),
                        "{name}: {}",
                        text.text
                    );
                    counts[round % 3] += usize::from(!told.is_empty());
                }
                _ => {
                    let about = text.claims.iter().filter(|claim| of_object(&claim.terms));
                    counts[2] += about.count().min(1);
                }
            }
        }
    }
    println!(
        "told of 30 each: joints {}, switches {}, places {}",
        counts[0], counts[1], counts[2]
    );
    assert!(counts.iter().all(|told| *told >= 20), "{counts:?}");
}
