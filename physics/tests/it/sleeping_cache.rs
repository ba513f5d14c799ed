//! The sleeping-island cache is invisible: a body falls when its support is taken away, an impact meets a free body, and
//! contacts are reported as before.

use crate::common::{Build, Piece, Run, forward};
use dwell_physics::{BodyState, PhysicsConfig};
use dwell_scene::{Contact, ObjectId, Pose, Velocity};
use glam::Vec3;

const HALF_M: f32 = 0.1;

/// Boxes of 20 cm with their middles at some places.
fn boxes(places: &[Vec3]) -> (Build, Vec<ObjectId>) {
    let mut build = Build::room([8.0, 3.0, 8.0]);
    let add = |(k, at): (usize, &Vec3)| {
        let piece = Piece::cuboid(Vec3::splat(HALF_M), *at);
        build.movable(&format!("box_{k}"), piece)
    };
    let objects = places.iter().enumerate().map(add).collect();
    (build, objects)
}

fn tower(count: u8) -> (Build, Vec<ObjectId>) {
    let at = |k: u8| Vec3::new(2.0, HALF_M + 2.0 * HALF_M * f32::from(k), 2.0);
    boxes(&(0..count).map(at).collect::<Vec<_>>())
}

/// Runs until all is asleep and cached.
fn rest(run: &mut Run) {
    for _ in 0..40 {
        run.steps(8);
        if run.world.awake_count() == 0 && run.world.pair_counts().near == 0 {
            return;
        }
    }
    panic!("{} are awake", run.world.awake_count());
}

fn put(run: &mut Run, object: ObjectId, at: Vec3) {
    let body = BodyState {
        part: run.root(object),
        pose: Pose::from_position(at),
        velocity: Velocity::default(),
    };
    run.world.set_bodies(&mut run.state, &[body]).unwrap();
}

/// The pairs of supporting and supported body, from the bottom up.
#[test]
fn contacts_are_told_of_what_is_laid_aside() {
    let (build, objects) = tower(3);
    let mut run = build.run();
    run.steps(10);
    let awake: Vec<Contact> = run.state.contacts.clone();
    assert!(
        run.world.awake_count() == 3 && awake.len() == 3,
        "{awake:?}"
    );
    rest(&mut run);
    assert_eq!(run.state.contacts, awake);
    // Contacts of a removed body go with it, and come again.
    put(&mut run, objects[2], Vec3::new(4.0, HALF_M, 4.0));
    run.steps(5);
    let part = run.root(objects[2]);
    let own = |contact: &&Contact| contact.a == part || contact.b == Some(part);
    let told: Vec<_> = run.state.contacts.iter().filter(own).collect();
    assert_eq!((told.len(), run.state.contacts.len()), (1, 3), "{told:?}");
    assert_eq!(told[0].b, None);
}

#[test]
fn what_loses_its_support_falls() {
    for gone in 0..3 {
        let (build, objects) = tower(4);
        let mut run = build.run();
        rest(&mut run);
        put(&mut run, objects[gone], Vec3::new(5.0, HALF_M, 5.0));
        run.steps(60);
        for (k, object) in objects.iter().enumerate() {
            let level = if k > gone { k - 1 } else { k };
            let level = if k == gone { 0 } else { level };
            let height = HALF_M + 2.0 * HALF_M * level as f32;
            let found = run.position(*object).y;
            assert!(
                (found - height).abs() < 5e-3,
                "{gone}, {k}: {found} for {height}"
            );
        }
    }
}

/// However fast an impact is, it transfers what it would to a body that never sleeps.
#[test]
fn what_is_hit_moves_as_if_it_had_been_awake() {
    for speed in [0.3, 2.0, 8.0, 20.0] {
        let ends = [true, false].map(|sleeping| {
            let (mut build, objects) = boxes(&[Vec3::new(4.0, HALF_M, 4.0)]);
            let ball = Piece::ball(HALF_M, Vec3::new(2.5, HALF_M, 4.0));
            let ball = build.movable("ball", ball);
            let mut run = build.run_with(PhysicsConfig {
                sleeping,
                ..PhysicsConfig::default()
            });
            if sleeping {
                rest(&mut run);
            }
            let from = Vec3::new(4.0 - 3.0 * HALF_M - 0.05, HALF_M + 1e-3, 4.0);
            put(&mut run, ball, from);
            run.throw(ball, Vec3::X * speed);
            let mut fastest = 0.0_f32;
            for _ in 0..30 {
                run.steps(1);
                fastest = fastest.max(run.velocity(objects[0]).x);
            }
            (fastest, run.position(objects[0]).x)
        });
        let [(laid, far), (awake, far_awake)] = ends;
        println!("  {speed} m/s: {laid} and {awake} m/s, to {far} and {far_awake} m");
        assert!(awake > 0.2 * speed, "{speed}: {awake}");
        // Friction takes 0.04 m/s in a physics step, and the impact may come a step earlier or later.
        assert!(
            (laid - awake).abs() < 0.02 * awake + 0.05,
            "{speed}: {laid} for {awake}"
        );
        let way = far_awake - 4.0;
        assert!(
            (far - far_awake).abs() < 0.05 * way + 1e-3,
            "{speed}: {far} for {far_awake}"
        );
    }
}

/// A row of boxes that touch: the push goes through all of them.
#[test]
fn a_row_is_pushed_as_one() {
    let places: Vec<Vec3> = (0..6_u8)
        .map(|k| Vec3::new(3.0 + 2.0 * HALF_M * f32::from(k), HALF_M, 4.0))
        .collect();
    let (build, objects) = boxes(&places);
    let mut run = build.run();
    rest(&mut run);
    run.throw(objects[0], Vec3::X * 3.0);
    run.steps(2);
    let last = run.velocity(objects[5]).x;
    assert!(last > 0.05, "{last}");
    rest(&mut run);
}

/// An agent that walks into a cached body pushes it on.
#[test]
fn a_walker_pushes_what_is_laid_aside() {
    let (build, objects) = boxes(&[Vec3::new(4.0, HALF_M, 3.0)]);
    let mut run = build.run();
    run.agent(Vec3::new(4.0, 0.0, 5.0), 0.0);
    rest(&mut run);
    run.walk(60, &[forward(1.0)]);
    let found = run.position(objects[0]);
    assert!(found.z < 2.9, "{found}");
}

/// A snapshot of a world with many cached bodies goes on alike when something is thrown into it.
#[test]
fn a_restored_world_wakes_the_same_things() {
    let (build, objects) = tower(5);
    let mut run = build.run();
    rest(&mut run);
    let saved = (run.state.clone(), run.world.snapshot());
    let mut other = run.clone();
    other.throw(objects[4], Vec3::new(1.0, 4.0, 0.0));
    other.steps(20);
    other.state = saved.0;
    other.world.restore(&mut other.state, &saved.1).unwrap();
    assert_eq!(run.hash(), other.hash());
    for world in [&mut run, &mut other] {
        world.throw(objects[1], Vec3::new(2.0, 0.0, 0.5));
    }
    for step in 0..120 {
        run.steps(1);
        other.steps(1);
        assert!(run.hash() == other.hash(), "step {step}");
    }
}
