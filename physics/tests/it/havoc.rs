//! Everything at random, wrong ids and numbers included: nothing panics, and invariants hold.

use crate::common::{Build, Piece, Run};
use dwell_physics::{AgentControl, Grasp, HandAction, Target, actions};
use dwell_scene::random::{RandomKey, RandomStream};
use dwell_scene::{AgentId, AgentState, EntityId, ObjectId, PartId};
use glam::Vec3;

fn house() -> Run {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    build.wall_with_door(3.0, 6.0);
    build.chest(Vec3::new(1.0, 0.5, 4.0));
    build.fixed(
        "table",
        Piece::cuboid(Vec3::new(0.5, 0.35, 0.4), Vec3::new(4.0, 0.35, 4.6)),
    );
    let lamp = build.fixed(
        "lamp",
        Piece::cuboid(Vec3::splat(0.05), Vec3::new(4.4, 0.75, 4.8)),
    );
    build.data.objects[lamp].switch = Some(true);
    for k in 0..8_u8 {
        let half = Vec3::new(0.03 + 0.01 * f32::from(k), 0.04, 0.03);
        let z = if k < 4 { 4.6 } else { 1.5 };
        let at = Vec3::new(1.2 + 0.5 * f32::from(k), 0.8, z);
        build.movable(&format!("thing_{k}"), Piece::cuboid(half, at));
    }
    build.movable(
        "card",
        Piece::cuboid(Vec3::new(0.1, 0.001, 0.08), Vec3::new(3.0, 0.5, 5.0)),
    );
    let mut run = build.run();
    run.agent(Vec3::new(2.5, 0.0, 4.2), 0.0);
    run.agent(Vec3::new(2.2, 0.0, 1.8), std::f32::consts::PI);
    run.steps(20);
    run
}

/// A number that is usually valid.
fn number(stream: &mut RandomStream, size: f32) -> f32 {
    match stream.below(24) {
        0 => f32::NAN,
        1 => f32::INFINITY,
        2 => -1e30,
        3 => 0.0,
        _ => (2.0 * stream.uniform_f32() - 1.0) * size,
    }
}

fn vector(stream: &mut RandomStream, size: f32) -> Vec3 {
    Vec3::new(
        number(stream, size),
        number(stream, size),
        number(stream, size),
    )
}

fn target(run: &Run, stream: &mut RandomStream, agent: AgentId) -> Target {
    let objects = run.house.objects.len();
    match stream.below(8) {
        0..=2 => Target::Object(ObjectId(stream.below(objects + 2) as u32)),
        3 => Target::Part(PartId(stream.below(run.house.parts.len() + 3) as u32)),
        4 => Target::Entity(EntityId(stream.below(40) as i32 - 3)),
        5 => Target::Gaze,
        6 => {
            let object = ObjectId(stream.below(objects) as u32);
            let eye = run
                .state
                .agents
                .get(agent)
                .map_or(Vec3::ONE, AgentState::eye_position);
            Target::Ray {
                origin: eye,
                direction: run.position(object) - eye,
            }
        }
        _ => Target::Ray {
            origin: vector(stream, 6.0),
            direction: vector(stream, 1.0),
        },
    }
}

fn action(run: &Run, stream: &mut RandomStream, agent: AgentId) -> Box<dyn HandAction> {
    let target = target(run, stream, agent);
    let force_n = (stream.below(2) == 0).then(|| number(stream, 200.0).abs());
    match stream.below(16) {
        0..=3 => Box::new(actions::Pick {
            target,
            grasp: if stream.below(3) > 0 {
                Grasp::Kinematic
            } else {
                Grasp::Spring {
                    frequency_hz: 10.0 * stream.uniform_f32(),
                    damping_ratio: number(stream, 2.0),
                }
            },
        }),
        4 => Box::new(actions::Drop {}),
        5 => Box::new(actions::Place {
            target: (stream.below(2) == 0).then_some(target),
        }),
        6 => Box::new(actions::PlaceAt {
            point: vector(stream, 6.0),
        }),
        7 => Box::new(actions::PutIn { target }),
        8 => Box::new(actions::Throw {
            direction: Some(vector(stream, 1.0)),
            speed_m_s: number(stream, 20.0).abs(),
        }),
        9 => Box::new(actions::Push { target, force_n }),
        10 => Box::new(actions::Pull { target, force_n }),
        11 | 12 => Box::new(actions::Open {
            target,
            fraction: if stream.below(8) == 0 {
                number(stream, 2.0)
            } else {
                stream.uniform_f32()
            },
        }),
        13 => Box::new(actions::Close { target }),
        14 => Box::new(actions::Toggle { target }),
        _ => Box::new(actions::Point { target }),
    }
}

/// Returns whether a step goes through the wall at z = 3 beside the doorway.
fn crosses(a: Vec3, b: Vec3) -> bool {
    if (a.z - 3.0).signum() == (b.z - 3.0).signum() {
        return false;
    }
    let at = a.lerp(b, (3.0 - a.z) / (b.z - a.z));
    !(2.0..=3.0).contains(&at.x) || at.y > 2.1
}

fn check(run: &Run, before: &Run, told: &str) {
    let state = &run.state;
    for (id, agent) in state.agents.iter_ids() {
        let was = before.state.agents[id].position;
        assert!(
            agent.position.is_finite() && !crosses(was, agent.position),
            "{told}"
        );
        assert!(
            agent.position.min_element() > -0.01,
            "{told}: {}",
            agent.position
        );
        if let Some(held) = agent.holding {
            assert_eq!(state.held_by[held], Some(id), "{told}: one holder");
        }
    }
    for (object, _) in run.house.objects.iter_ids() {
        let holders = state
            .agents
            .iter()
            .filter(|a| a.holding == Some(object))
            .count();
        assert_eq!(
            holders,
            usize::from(state.held_by[object].is_some()),
            "{told}"
        );
        assert!(
            !state
                .supports_of(&run.house, object)
                .contains(&Some(object)),
            "{told}"
        );
        assert!(
            !state
                .containers_of(&run.house, object, &run.house.object_boxes(state))
                .contains(&object),
            "{told}"
        );
        let (at, was) = (run.position(object), before.position(object));
        assert!(at.is_finite(), "{told}: {object:?}");
        assert!(!crosses(was, at), "{told}: {object:?} {was} to {at}");
        let inside = at.min_element() > -0.05 && at.x < 6.05 && at.z < 6.05 && at.y < 3.05;
        assert!(inside, "{told}: {object:?} at {at}");
    }
}

fn run_for(run: &mut Run, steps: std::ops::Range<usize>, checked: bool) -> Vec<u64> {
    let mut hashes = Vec::new();
    for step in steps {
        let mut stream = RandomKey::root(11).child(step as u64).stream();
        let before = checked.then(|| run.clone());
        let agent = AgentId(if stream.below(50) == 0 {
            7
        } else {
            stream.below(2) as u32
        });
        let action = action(run, &mut stream, agent);
        let told = run.act(agent, &*action);
        assert!(
            !told.sentence.is_empty() && told.sentence.ends_with('.'),
            "{told:?}"
        );
        let controls: Vec<AgentControl> = (0..2)
            .map(|_| AgentControl {
                forward_m_s: 3.0 * stream.uniform_f32() - 0.8,
                yaw_rate_rad_s: 8.0 * stream.uniform_f32() - 4.0,
                pitch_rate_rad_s: 2.0 * stream.uniform_f32() - 1.0,
                ..AgentControl::default()
            })
            .collect();
        run.walk(1, &controls);
        if let Some(before) = &before {
            check(
                run,
                before,
                &format!("{step}: {action:?}: {}", told.sentence),
            );
        }
        hashes.push(run.state.hash());
    }
    hashes
}

#[test]
fn two_thousand_random_actions_break_nothing() {
    let mut run = house();
    run_for(&mut run, 0..2000, true);
}

#[test]
fn random_actions_have_the_same_hashes_twice_and_after_a_restore() {
    let mut first = house();
    let hashes = run_for(&mut first, 0..300, false);
    let mut second = house();
    assert_eq!(run_for(&mut second, 0..150, false), hashes[..150]);
    let (bytes, mut state) = (second.world.snapshot(), second.state.clone());
    let mut third = house();
    third.world.restore(&mut state, &bytes).unwrap();
    third.state = state;
    third.rays.update(&third.state);
    assert_eq!(run_for(&mut third, 150..300, false), hashes[150..]);
    assert_eq!(third.hash(), first.hash());
}
