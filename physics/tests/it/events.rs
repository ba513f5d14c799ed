//! Impacts: how hard, how fast, of what, where.

use crate::common::{Build, Piece, gravity, pair};
use dwell_physics::Toucher;
use dwell_scene::StructureId;
use glam::Vec3;

/// J = m (1 + e) v with v = sqrt(2 g h), within 5 %: the solver stops a body a step early or late.
#[test]
fn a_dropped_thing_reports_its_momentum() {
    for (floor, thing, radius) in [
        ("marble", "glass", 0.03),
        ("parquet", "rubber", 0.1),
        ("carpet", "steel", 0.05),
    ] {
        let mut build = Build::room_of([4.0, 4.0, 4.0], floor);
        let height = 1.0;
        let ball = build.movable(
            "ball",
            Piece::ball(radius, Vec3::new(1.3, radius + height, 2.4))
                .of(thing)
                .density(2000.0),
        );
        let mut run = build.run();
        while run.events.is_empty() && run.world.time_s() < 1.0 {
            run.steps(1);
        }
        let event = run.events[0];
        let (_, e) = pair(floor, thing);
        let speed = (2.0 * gravity() * height).sqrt();
        let mass = 2000.0 * 4.0 / 3.0 * std::f32::consts::PI * radius.powi(3);
        let expected = mass * (1.0 + e) * speed;
        assert!(
            (event.impulse_n_s / expected - 1.0).abs() < 0.05,
            "{floor}: {} expected {expected}",
            event.impulse_n_s
        );
        assert!(
            (event.relative_normal_speed_m_s / speed - 1.0).abs() < 0.05,
            "{}",
            event.relative_normal_speed_m_s
        );
        assert_eq!(event.a, Toucher::Structure(StructureId(0)));
        assert_eq!(event.b, Toucher::Part(run.root(ball)));
        assert_eq!((event.substance_a, event.substance_b), (floor, thing));
        assert!(
            (event.position - Vec3::new(1.3, 0.0, 2.4)).length() < 0.03,
            "{}",
            event.position
        );
        let when = f64::from((2.0 * height / gravity()).sqrt());
        assert!(
            (event.time_s - when).abs() < 0.03,
            "{} expected {when}",
            event.time_s
        );
    }
}

#[test]
fn things_at_rest_make_no_events() {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    for k in 0..6 {
        build.movable(
            &format!("box_{k}"),
            Piece::cuboid(Vec3::splat(0.1), Vec3::new(2.0, 0.1 + 0.2 * k as f32, 2.0)),
        );
    }
    let mut run = build.run();
    run.steps(60);
    assert!(run.events.is_empty(), "{:?}", run.events);
}

#[test]
fn events_come_in_the_order_of_time_and_pair() {
    let mut build = Build::room([6.0, 6.0, 6.0]);
    for k in 0..20 {
        let at = Vec3::new(
            1.0 + 0.2 * (k % 5) as f32,
            1.0 + 0.23 * k as f32,
            1.0 + 0.17 * (k % 3) as f32,
        );
        build.movable(&format!("cube_{k}"), Piece::cuboid(Vec3::splat(0.08), at));
    }
    let mut run = build.run();
    let mut last = 0.0;
    for _ in 0..80 {
        run.events.clear();
        run.steps(1);
        for event in &run.events {
            assert!(event.a < event.b && event.impulse_n_s > 0.0 && event.position.is_finite());
            // An impact that lasts longer is told later: by at most three steps.
            assert!(
                event.time_s >= last - 3.5 / 120.0,
                "{} after {last}",
                event.time_s
            );
            last = event.time_s;
        }
    }
    assert!(last > 0.3);
}
