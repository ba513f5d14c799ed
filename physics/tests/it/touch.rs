//! What agents touch: walls, what presses on them, and what the things in their hands touch.

use crate::common::{Build, Piece};
use dwell_physics::{PhysicsConfig, actions::Pick};
use glam::Vec3;

/// The forces of a blow, summed over its physics steps, are what the ball's momentum changes by.
#[test]
fn a_thrown_ball_presses_with_its_momentum_from_where_it_comes() {
    let config = PhysicsConfig {
        control_rate_hz: 120.0,
        ..PhysicsConfig::default()
    };
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let ball = build.movable(
        "ball",
        Piece::ball(0.12, Vec3::new(4.2, 1.0, 3.0)).density(300.0),
    );
    let mut run = build.run_with(config);
    let id = run.agent(Vec3::new(3.0, 0.0, 3.0), 0.4);
    assert_eq!(run.world.touch(&run.state, id).body, []);
    run.throw(ball, Vec3::new(-4.0, 1.0, 0.0));
    let root = run.root(ball);
    let mass_kg = 300.0 * 4.0 / 3.0 * std::f32::consts::PI * 0.12_f32.powi(3);
    let (mut pressed, mut momentum) = (0.0, 0.0);
    for _ in 0..60 {
        let before = run.state.part_velocity[root].linear.x;
        run.steps(1);
        let after = run.state.part_velocity[root].linear.x;
        let touch = run.world.touch(&run.state, id);
        let pressing = touch.body.iter().filter(|touch| touch.force_n > 0.0);
        for touch in pressing.clone() {
            assert!((touch.direction - Vec3::X).length() < 0.05, "{touch:?}");
        }
        if pressing.clone().count() > 0 {
            pressed += pressing.map(|touch| touch.force_n).sum::<f32>() / 120.0;
            momentum += mass_kg * (after - before);
        }
    }
    assert!(momentum > 0.5 * mass_kg * 4.0, "{momentum}");
    // Rebounds are corrected after the step that tells forces, so that a blow's force lacks the restitution's part.
    assert!(
        pressed > 0.5 * momentum && pressed < 1.05 * momentum,
        "{pressed} N s, {momentum} N s"
    );
}

#[test]
fn a_held_thing_feels_the_wall_it_is_held_against() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let table = Piece::cuboid(Vec3::new(0.4, 0.4, 0.3), Vec3::new(3.0, 0.4, 1.6));
    build.fixed("table", table);
    let at = Vec3::new(3.0, 0.9, 1.7);
    let thing = build.movable("box", Piece::cuboid(Vec3::splat(0.09), at).density(200.0));
    let mut run = build.run();
    run.steps(20);
    let id = run.agent(Vec3::new(3.0, 0.0, 2.3), 0.0);
    assert_eq!(run.world.touch(&run.state, id).held_force_n, None);
    assert_eq!(run.world.held_mass_kg(id), 0.0);
    let outcome = run.act(id, Pick::new(thing));
    assert!(outcome.success, "{}", outcome.sentence);
    let (held_kg, expected_kg) = (run.world.held_mass_kg(id), 200.0 * 0.18_f32.powi(3));
    assert!(
        (held_kg - expected_kg).abs() < 0.01 * expected_kg,
        "{held_kg} kg"
    );
    run.steps(20);
    assert_eq!(run.world.touch(&run.state, id).held_force_n, None);
    // Towards the wall behind it, with the thing before it.
    run.world
        .place_agent(
            &mut run.state,
            id,
            Vec3::new(3.0, 0.0, 5.0),
            std::f32::consts::PI,
        )
        .unwrap();
    run.walk(60, &[crate::common::forward(1.0)]);
    assert!(run.world.touch(&run.state, id).held_force_n.is_some());
}
