//! Impacts, sliding and rolling: time, impulse, speed, substances, position.

use crate::common::Run;
use crate::common::{Build, Piece, gravity, pair};
use dwell_physics::{ContactEntity, ContactEvent, ContactKind, ContactPhase, PhysicsConfig};
use dwell_scene::{ObjectId, StructureId};
use glam::{Quat, Vec3};

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
        assert_eq!(
            (event.kind, event.phase),
            (ContactKind::Impact, ContactPhase::Once)
        );
        let (friction, e) = pair(floor, thing);
        assert_eq!((event.friction, event.restitution), (friction, e));
        let values = run.world.contact_coefficients(event.a, event.b).unwrap();
        assert_eq!((values.friction, values.restitution), (friction, e));
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
        assert_eq!(event.a, ContactEntity::Structure(StructureId(0)));
        assert_eq!(event.b, ContactEntity::Part(run.root(ball)));
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
            assert!(event.a < event.b && event.position.is_finite());
            assert!(event.impulse_n_s > 0.0 || event.phase == ContactPhase::End);
            if event.kind != ContactKind::Impact {
                continue;
            }
            // An impact that lasts longer is reported later: by at most three steps.
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

/// t = sqrt(2 h / g) and v = sqrt(2 g h): a body in free flight follows its parabola, and the time of an impact within the
/// physics step comes from gap and approach before it.
#[test]
fn a_dropped_ball_meets_the_floor_at_its_time_and_speed() {
    let step_s = 1.0 / 120.0;
    for (substeps, bound) in [(16, 0.01), (4, 0.01), (1, 0.01)] {
        let mut worst = 0.0_f64;
        for k in 0..25 {
            let height = 0.1 + 0.061 * k as f32;
            let mut build = Build::room_of([4.0, 4.0, 4.0], "marble");
            let place = Vec3::new(1.3, 0.05 + height, 2.4);
            build.movable("ball", Piece::ball(0.05, place).of("steel"));
            let mut run = build.run_with(PhysicsConfig {
                solver_substeps: substeps,
                ..PhysicsConfig::default()
            });
            while run.events.is_empty() && run.world.time_s() < 1.0 {
                run.steps(1);
            }
            let event = run.events[0];
            let expected = f64::from((2.0 * height / gravity()).sqrt());
            let error = (event.time_s - expected) / step_s;
            worst = worst.max(error.abs());
            let speed = (2.0 * gravity() * height).sqrt();
            let share = event.relative_normal_speed_m_s / speed;
            assert!(
                (share - 1.0).abs() < 2e-3,
                "{height} m: {share} of {speed} m/s"
            );
            assert!(event.relative_tangential_speed_m_s < 1e-3, "{event:?}");
        }
        println!("{substeps} substeps: {worst:.3} of a step");
        assert!(worst < bound, "{substeps} substeps: {worst} of a step");
    }
}

/// A slope of `angle` with a thing on it, `up` its half height.
fn on_a_slope(
    angle: f32,
    slope: &'static str,
    thing: impl Fn(Vec3) -> Piece,
    up: f32,
) -> (Run, ObjectId) {
    let mut build = Build::room([12.0, 8.0, 4.0]);
    let turned = Quat::from_rotation_z(-angle);
    let middle = Vec3::new(6.0, 4.0, 2.0);
    let half = Vec3::new(5.0, 0.1, 1.0);
    build.fixed(
        "slope",
        Piece::cuboid(half, middle).of(slope).turned(turned),
    );
    let at = middle + turned * Vec3::new(-4.0, 0.1 + up, 0.0);
    let thing = build.movable("thing", thing(at).turned(turned));
    (build.run(), thing)
}

/// Returns the events of one kind between the slope and the object, with the time of their middle after the start.
fn told(run: &Run, kind: ContactKind) -> Vec<(f32, ContactEvent)> {
    let same = |event: &&ContactEvent| event.kind == kind && event.phase != ContactPhase::End;
    let middle = |event: &ContactEvent| (event.time_s as f32 + 0.5 * event.duration_s, *event);
    run.events.iter().filter(same).map(middle).collect()
}

/// Down a slope steeper than its friction holds: N = m g cos, F = mu N, slip = g (sin - mu cos) t.
#[test]
fn a_sliding_box_scrapes_with_friction_times_its_normal_force() {
    let (friction, _) = pair("oak", "steel");
    let angle = dwell_scene::math::atan2(friction, 1.0) + 0.25;
    let (sin, cos) = dwell_scene::math::sin_cos(angle);
    let half = Vec3::new(0.15, 0.1, 0.15);
    let piece = |at| Piece::cuboid(half, at).of("steel").density(1000.0);
    let (mut run, _) = on_a_slope(angle, "oak", piece, 0.1);
    run.steps(20);
    let mass = 1000.0 * 8.0 * half.element_product();
    let normal = mass * gravity() * cos;
    let scrapes = told(&run, ContactKind::Scrape);
    assert!(scrapes.len() > 15, "{}", scrapes.len());
    assert!(told(&run, ContactKind::Roll).is_empty());
    for (time_s, event) in &scrapes[3..] {
        let slip = gravity() * (sin - friction * cos) * time_s;
        let found = event.relative_tangential_speed_m_s;
        assert!((found - slip).abs() < 0.05 * slip, "{found} {slip}");
        let force = event.normal_force_n();
        assert!((force / normal - 1.0).abs() < 0.05, "{force} {normal}");
        let ratio = event.friction_force_n() / force;
        assert!((ratio / friction - 1.0).abs() < 0.05, "{ratio} {friction}");
    }
}

/// A ball rolls as long as mu > 2/7 tan, at 5/7 g sin t; on a steeper slope it slips at g (sin - 7/2 mu cos) t.
#[test]
fn rolling_is_told_apart_from_sliding_by_its_slip() {
    let (friction, _) = pair("oak", "steel");
    let ball = |at| Piece::ball(0.1, at).of("steel").density(1000.0);
    let limit = dwell_scene::math::atan2(3.5 * friction, 1.0);
    let gentle = 0.4 * limit;
    let (mut run, _) = on_a_slope(gentle, "oak", ball, 0.1);
    run.steps(20);
    let rolls = told(&run, ContactKind::Roll);
    assert!(rolls.len() > 15, "{}", rolls.len());
    for (time_s, event) in &rolls[3..] {
        let speed = 5.0 / 7.0 * gravity() * dwell_scene::math::sin(gentle) * time_s;
        let found = event.rolling_speed_m_s;
        assert!((found - speed).abs() < 0.05 * speed, "{found} {speed}");
        assert!(
            event.relative_tangential_speed_m_s < 0.03 * speed,
            "{event:?}"
        );
        assert!(event.friction_force_n() < friction * event.normal_force_n());
    }
    assert!(told(&run, ContactKind::Scrape).is_empty());
    let steep = limit + 0.2;
    let (sin, cos) = dwell_scene::math::sin_cos(steep);
    let (mut run, _) = on_a_slope(steep, "oak", ball, 0.1);
    run.steps(12);
    let scrapes = told(&run, ContactKind::Scrape);
    assert!(scrapes.len() > 7, "{}", scrapes.len());
    for (time_s, event) in &scrapes[3..] {
        let slip = gravity() * (sin - 3.5 * friction * cos) * time_s;
        let found = event.relative_tangential_speed_m_s;
        assert!((found - slip).abs() < 0.05 * slip, "{found} {slip}");
    }
}

#[test]
fn a_scrape_begins_goes_on_and_ends() {
    let mut build = Build::room([6.0, 3.0, 4.0]);
    let thing = build.movable(
        "box",
        Piece::cuboid(Vec3::splat(0.1), Vec3::new(1.0, 0.1, 2.0)),
    );
    let mut run = build.run();
    run.steps(4);
    assert!(run.events.is_empty(), "{:?}", run.events);
    run.throw(thing, Vec3::X * 2.0);
    run.steps(40);
    let scrapes: Vec<ContactEvent> = run
        .events
        .iter()
        .filter(|event| event.kind == ContactKind::Scrape)
        .copied()
        .collect();
    let phases: Vec<ContactPhase> = scrapes.iter().map(|event| event.phase).collect();
    let (first, rest) = phases.split_first().expect("it scrapes");
    let (last, middle) = rest.split_last().expect("it goes on");
    assert_eq!((*first, *last), (ContactPhase::Begin, ContactPhase::End));
    assert!(!middle.is_empty());
    assert!(middle.iter().all(|phase| *phase == ContactPhase::Continue));
    let slips = scrapes
        .iter()
        .map(|event| event.relative_tangential_speed_m_s);
    assert!(slips.collect::<Vec<_>>().is_sorted_by(|a, b| a >= b));
}

/// The limit holds in every step, the strongest events are reported, and the others are counted with their impulse: the
/// sums with and without a limit agree.
#[test]
fn five_hundred_falling_things_stay_bounded() {
    let run_with = |most: usize| {
        let mut build = Build::room([6.0, 8.0, 6.0]);
        for k in 0..500_u16 {
            let (x, y, z) = (k % 10, k / 100, k / 10 % 10);
            let at = Vec3::new(f32::from(x), f32::from(y), f32::from(z)) * 0.5;
            let piece = Piece::cuboid(Vec3::splat(0.08), at + Vec3::new(0.6, 0.5, 0.6));
            build.movable(&format!("cube_{k}"), piece);
        }
        let mut run = build.run_with(PhysicsConfig {
            max_events_per_step: most,
            ..PhysicsConfig::default()
        });
        let (mut told, mut merged, mut impulse) = (0, 0, 0.0_f64);
        for _ in 0..30 {
            run.events.clear();
            run.steps(1);
            let rest = run.world.events_beyond_limit();
            let sum: f32 = run.events.iter().map(|event| event.impulse_n_s).sum();
            told = told.max(run.events.len());
            merged += rest.count;
            impulse += f64::from(sum + rest.impulse_n_s);
            assert!(rest.count > 0 || rest.impulse_n_s == 0.0);
        }
        (told, merged, impulse, run.hash())
    };
    let bounded = run_with(64);
    assert_eq!(bounded.0, 64);
    assert!(bounded.1 > 300, "{}", bounded.1);
    let free = run_with(100_000);
    assert!(free.0 > 200 && free.1 == 0, "{} {}", free.0, free.1);
    assert!((bounded.2 / free.2 - 1.0).abs() < 1e-4);
    assert_eq!(bounded.3.0, free.3.0, "what is told changes nothing");
}
