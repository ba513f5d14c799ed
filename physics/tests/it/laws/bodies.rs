//! Laws of air, mass and inertia.

use super::{spec, tower};
use crate::common::{Build, Piece, Run, gravity};
use dwell_physics::{PhysicsConfig, PhysicsWorld};
use dwell_scene::{LawSpec, ObjectId, State};
use glam::{Quat, Vec3};
use std::f32::consts::PI;

/// `v(t) = v_inf tanh(g t / v_inf), v_inf = sqrt(2 m g / (rho c_d A))`; a ball's mean cross-section is pi r^2.
#[test]
fn drag_slows_a_fall_as_the_hyperbolic_tangent() {
    let house = tower().house();
    let mut state = State::new(&house);
    state.laws = vec![spec("drag", Some("ball"), &[("c_d", 0.8)])];
    let mut run = Run::from_state(house, PhysicsConfig::default(), state);
    let ball = run.house.object_named("ball").unwrap();
    let other = run.house.object_named("other").unwrap();
    let mass = 30.0 * 4.0 / 3.0 * PI * 0.001;
    let terminal = (2.0 * mass * gravity() / (1.204 * 0.8 * PI * 0.01)).sqrt();
    for step in 1..=80 {
        run.steps(1);
        let t = step as f32 / 20.0;
        let expected = terminal * (gravity() * t / terminal).tanh();
        let found = -run.velocity(ball).y;
        assert!(
            (found / expected - 1.0).abs() < 3e-3,
            "{t} s: {found} m/s, expected {expected} m/s"
        );
    }
    // The other ball, which the law does not name, falls freely.
    assert!((run.velocity(other).y + gravity() * 4.0).abs() < 0.05);
}

/// A room with a cube of 1 kg that floats in it, without weight.
fn weightless_cube(laws: Vec<LawSpec>) -> Run {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let cube = Piece::cuboid(Vec3::splat(0.1), Vec3::new(2.0, 2.0, 2.0)).density(125.0);
    build.movable("cube", cube);
    let house = build.house();
    let mut state = State::new(&house);
    let gravity = "world/gravity_m_s2".parse().unwrap();
    state.set_parameter(&house, &gravity, 0.0).unwrap();
    state.laws = laws;
    Run::from_state(house, PhysicsConfig::default(), state)
}

/// A cube with one moment enlarged is a symmetric top: in its own frame the spin turns about the axis at
/// `(I_3 - I_1) / I_1 w_3` (Landau, Lifshitz, Mechanics, section 36).
#[test]
fn an_inertia_error_makes_a_cube_precess_as_a_symmetric_top() {
    for excess in [0.5_f32, -0.3] {
        let law = spec("inertia_error", Some("cube"), &[("z", f64::from(excess))]);
        let mut run = weightless_cube(vec![law]);
        let cube = run.house.object_named("cube").unwrap();
        let root = run.root(cube);
        run.state.part_velocity[root].angular = Vec3::new(0.3, 0.0, 6.0);
        run.world.adopt_state(&mut run.state).unwrap();
        let mut turned = 0.0;
        let mut before = 0.0_f32;
        for _ in 0..40 {
            run.steps(1);
            let rotation = run.state.part_pose[root].rotation;
            let spin = rotation.inverse() * run.state.part_velocity[root].angular;
            let angle = spin.y.atan2(spin.x);
            turned += dwell_scene::math::wrap_angle(angle - before);
            before = angle;
            assert!((spin.z - 6.0).abs() < 0.02, "{spin}");
        }
        let expected = excess * 6.0 * 2.0;
        assert!(
            (turned - expected).abs() < 0.03 * expected.abs(),
            "{turned} rad, expected {expected} rad"
        );
    }
    // The engine leaves a cube without the law alone.
    let mut run = weightless_cube(Vec::new());
    let cube = run.house.object_named("cube").unwrap();
    let root = run.root(cube);
    run.state.part_velocity[root].angular = Vec3::new(0.3, 0.0, 6.0);
    run.world.adopt_state(&mut run.state).unwrap();
    run.steps(40);
    let spin = run.state.part_velocity[root].angular;
    assert!((spin - Vec3::new(0.3, 0.0, 6.0)).length() < 1e-3, "{spin}");
}

/// `a = g sin(t) / (1 + I / (m r^2))` down a slope, with `I = 2/5 (1 + s) m r^2`.
#[test]
fn the_scale_of_the_inertia_is_seen_in_how_a_ball_rolls() {
    for scale in [0.0, 0.5] {
        let mut build = Build::room_of([8.0, 4.0, 4.0], "rubber");
        let turn = Quat::from_rotation_z(0.1);
        let at = Vec3::new(4.0, 1.0, 2.0);
        let slope = Piece::cuboid(Vec3::new(3.0, 0.1, 1.0), at);
        build.fixed("slope", slope.of("rubber").turned(turn));
        let on = at + turn * Vec3::new(2.5, 0.2, 0.0);
        build.movable("ball", Piece::ball(0.1, on).of("rubber"));
        let house = build.house();
        let mut state = State::new(&house);
        state.laws = vec![spec("inertia_error", None, &[("scale", scale)])];
        let mut run = Run::from_state(house, PhysicsConfig::default(), state);
        let ball = run.house.object_named("ball").unwrap();
        run.steps(20);
        let (from, t) = (run.velocity(ball).length(), 1.0);
        run.steps(20);
        let found = (run.velocity(ball).length() - from) / t;
        let expected = gravity() * 0.1_f32.sin() / (1.4 + 0.4 * scale as f32);
        assert!(
            (found / expected - 1.0).abs() < 0.02,
            "{scale}: {found} m/s2, expected {expected} m/s2"
        );
    }
}

/// Products within their bounds are those of some body where the object has none of its own; a stick along a diagonal has.
#[test]
fn an_inertia_that_no_body_has_is_refused() {
    let law = |xy: f64, yz: f64, zx: f64| {
        let products = [("xy", xy), ("yz", yz), ("zx", zx)];
        vec![spec("inertia_error", Some("cube"), &products)]
    };
    let _fine = weightless_cube(law(-0.3, -0.3, -0.3));
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let turn = Quat::from_rotation_z(0.785);
    let stick = [0.0_f32, 0.3, 0.6].map(|x| {
        Piece::cuboid(
            Vec3::splat(0.02),
            Vec3::new(2.0, 2.0, 2.0) + turn * Vec3::X * x,
        )
    });
    build.object("stick", dwell_scene::Mobility::Movable, &stick);
    let house = build.house();
    let mut state = State::new(&house);
    state.laws = vec![spec("inertia_error", Some("stick"), &[("xy", -0.3)])];
    let refused =
        dwell_physics::PhysicsWorld::new(house, PhysicsConfig::default(), &mut state).unwrap_err();
    assert!(
        refused.to_string().contains("positive definite"),
        "{refused}"
    );
}

/// In flight the centre of mass moves evenly while the body turns about it.
#[test]
fn a_body_turns_about_its_shifted_centre_of_mass() {
    let offset = Vec3::new(0.03, 0.0, -0.01);
    let params = [("x_m", 0.03), ("z_m", -0.01)];
    let law = spec("center_of_mass_offset", Some("cube"), &params);
    let mut run = weightless_cube(vec![law]);
    let cube = run.house.object_named("cube").unwrap();
    let root = run.root(cube);
    run.state.part_velocity[root].angular = Vec3::new(0.0, 5.0, 0.0);
    run.state.part_velocity[root].linear = Vec3::new(0.2, 0.0, 0.1);
    run.world.adopt_state(&mut run.state).unwrap();
    let center = |run: &Run| {
        let pose = run.state.part_pose[root];
        pose.position + pose.rotation * offset
    };
    let start = center(&run);
    let velocity = Vec3::new(0.2, 0.0, 0.1) + Vec3::new(0.0, 5.0, 0.0).cross(offset);
    let mut farthest = 0.0_f32;
    for step in 1..=40 {
        run.steps(1);
        let expected = start + velocity * (step as f32 / 20.0);
        let error = (center(&run) - expected).length();
        assert!(error < 1e-3, "{step}: {error} m");
        let origin = run.position(cube) - start - velocity * (step as f32 / 20.0);
        farthest = farthest.max((origin + offset).length());
    }
    // The origin swings from one side to the other.
    assert!(
        (farthest / (2.0 * offset.length()) - 1.0).abs() < 0.05,
        "{farthest}"
    );
}

/// A box falls over its edge once its centre of mass is beyond it.
#[test]
fn a_box_tips_once_its_centre_of_mass_is_beyond_its_edge() {
    for (shift, tips) in [(0.09, false), (0.11, true)] {
        let mut build = Build::room([4.0, 3.0, 4.0]);
        let at = Vec3::new(2.0, 0.2, 2.0);
        build.movable("box", Piece::cuboid(Vec3::new(0.1, 0.2, 0.1), at));
        let house = build.house();
        let mut state = State::new(&house);
        state.laws = vec![spec("center_of_mass_offset", None, &[("x_m", shift)])];
        let mut run = Run::from_state(house, PhysicsConfig::default(), state);
        run.steps(60);
        let object = run.house.object_named("box").unwrap();
        let up = run.state.part_pose[run.root(object)].rotation * Vec3::Y;
        assert_eq!(up.y < 0.5, tips, "{shift} m: {up}");
    }
}

/// A knife whose centre of mass is a metre away is refused, with its name, the value and the allowed ones.
#[test]
fn a_centre_of_mass_far_outside_its_object_is_refused() {
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let at = Vec3::new(2.0, 0.02, 2.0);
    build.movable("knife", Piece::cuboid(Vec3::new(0.1, 0.01, 0.005), at));
    let house = build.house();
    for (axis, shift, may) in [
        ("x_m", 0.14, true),
        ("x_m", 0.16, false),
        ("z_m", 0.05, false),
    ] {
        let mut state = State::new(&house);
        state.laws = vec![spec(
            "center_of_mass_offset",
            Some("knife"),
            &[(axis, shift)],
        )];
        let made = PhysicsWorld::new(house.clone(), PhysicsConfig::default(), &mut state);
        assert_eq!(made.is_ok(), may, "{axis} {shift}");
        if let Err(error) = made {
            let said = error.to_string();
            assert!(
                said.contains("\"knife\"") && said.contains("three quarters"),
                "{said}"
            );
        }
    }
}

/// A ball of a tenth of a metre radius that floats in a room, without weight, and its mass.
fn weightless_ball(laws: Vec<LawSpec>) -> (Run, ObjectId, f32) {
    let mut build = Build::room([40.0, 40.0, 40.0]);
    let ball = build.movable("ball", Piece::ball(0.1, Vec3::splat(20.0)).density(30.0));
    let house = build.house();
    let mut state = State::new(&house);
    let gravity = "world/gravity_m_s2".parse().unwrap();
    state.set_parameter(&house, &gravity, 0.0).unwrap();
    state.laws = laws;
    let run = Run::from_state(house, PhysicsConfig::default(), state);
    (run, ball, 30.0 * 4.0 / 3.0 * PI * 1e-3)
}

/// `v = v_0 exp(-c t)` and `x = v_0 (1 - exp(-c t)) / c`, and the same for the spin.
#[test]
fn viscous_damping_takes_the_same_share_in_each_second() {
    let params = [("linear_per_s", 0.7), ("angular_per_s", 1.1)];
    let (mut run, ball, _) = weightless_ball(vec![spec("viscous_damping", Some("ball"), &params)]);
    let (root, from) = (run.root(ball), run.position(ball));
    run.state.part_velocity[root].angular = Vec3::new(0.0, 4.0, 0.0);
    run.throw(ball, Vec3::new(3.0, 0.0, 0.0));
    for step in 1..=40 {
        run.steps(1);
        let t = step as f32 / 20.0;
        let slowed = (-0.7 * t).exp();
        assert!((run.velocity(ball).x / (3.0 * slowed) - 1.0).abs() < 1e-4);
        let spin = run.state.part_velocity[root].angular.y;
        // rapier rounds the spin anew in each substep.
        let expected = 4.0 * (-1.1 * t).exp();
        assert!((spin / expected - 1.0).abs() < 1e-3, "{t} s: {spin} rad/s");
        let way = run.position(ball).x - from.x;
        assert!(
            (way / (3.0 * (1.0 - slowed) / 0.7) - 1.0).abs() < 1e-3,
            "{t} s: {way} m"
        );
    }
}

/// Without weight the lift of a constant spin across the flight bends it to a circle of radius `m v / (1/2 rho A r c_l w)`
/// at constant speed, to the side that the sense of the spin says.
#[test]
fn magnus_lift_bends_a_flight_to_a_circle() {
    for sense in [1.0_f32, -1.0] {
        let params = [("c_l", 1.0), ("area_m2", 0.0)];
        let (mut run, ball, mass) = weightless_ball(vec![spec("magnus", None, &params)]);
        let (root, from) = (run.root(ball), run.position(ball));
        run.state.part_velocity[root].angular = Vec3::new(0.0, sense * 80.0, 0.0);
        run.throw(ball, Vec3::new(5.0, 0.0, 0.0));
        let gain = 0.5 * 1.204 * PI * 0.01 * 0.1;
        let rate = gain * 80.0 / mass;
        let radius = 5.0 / rate;
        // w x v of +Y and +X is -Z.
        let center = from + Vec3::new(0.0, 0.0, -sense * radius);
        for step in 1..=40 {
            run.steps(1);
            assert!((run.velocity(ball).length() / 5.0 - 1.0).abs() < 1e-4);
            let angle = rate * step as f32 / 20.0;
            let expected = center + Vec3::new(angle.sin(), 0.0, sense * angle.cos()) * radius;
            let error = (run.position(ball) - expected).length();
            assert!(
                error < 5e-3 * radius,
                "{angle} rad: {error} m of {radius} m"
            );
        }
    }
}

/// `a = -g (m - rho V) / (m + c rho V)`: a light ball falls slower than a heavy one, and one lighter than the fluid rises.
#[test]
fn buoyancy_and_added_mass_slow_a_fall() {
    for (density, fluid, added) in [
        (30.0, 1.204, 0.5),
        (3000.0, 1.204, 0.5),
        (0.5, 1.204, 0.5),
        (30.0, 5.0, 0.0),
    ] {
        let mut build = Build::room([4.0, 20.0, 4.0]);
        let at = Vec3::new(2.0, 10.0, 2.0);
        let ball = build.movable("ball", Piece::ball(0.1, at).density(density));
        let house = build.house();
        let mut state = State::new(&house);
        let params = [
            ("fluid_density_kg_m3", f64::from(fluid)),
            ("added_mass", f64::from(added)),
        ];
        state.laws = vec![spec("buoyancy", Some("ball"), &params)];
        let mut run = Run::from_state(house, PhysicsConfig::default(), state);
        run.steps(16);
        let expected = -gravity() * 0.8 * (density - fluid) / (density + added * fluid);
        let found = run.velocity(ball).y;
        assert!(
            (found / expected - 1.0).abs() < 1e-3,
            "{density} in {fluid} kg/m3: {found} m/s, expected {expected} m/s"
        );
    }
}

/// The velocity against the air falls as `u_0 / (1 + k u_0 t / m)`, so that a ball at rest is blown along by the rest.
#[test]
fn wind_carries_a_ball_along() {
    let params = [("x_m_s", 3.0), ("z_m_s", -4.0), ("c_d", 0.5)];
    let (mut run, ball, mass) = weightless_ball(vec![spec("wind", Some("ball"), &params)]);
    let gain = 0.5 * 1.204 * 0.5 * PI * 0.01 / mass;
    for step in 1..=60 {
        run.steps(1);
        let left = 5.0 / (1.0 + gain * 5.0 * (step as f32 / 20.0));
        let expected = Vec3::new(0.6, 0.0, -0.8) * (5.0 - left);
        assert!((run.velocity(ball) - expected).length() < 1e-3);
    }
}

/// In the calm both sleep; the gust wakes the light ball, which rolls away, and leaves the heavy box asleep.
#[test]
fn a_gust_wakes_what_it_can_move() {
    let mut build = Build::room([8.0, 3.0, 4.0]);
    let light = Piece::ball(0.1, Vec3::new(2.0, 0.1, 1.0)).density(2.0);
    let ball = build.movable("ball", light);
    let heavy = Piece::cuboid(Vec3::splat(0.2), Vec3::new(2.0, 0.2, 3.0)).density(2000.0);
    let block = build.movable("block", heavy);
    let house = build.house();
    let mut state = State::new(&house);
    let params = [("x_m_s", 1.0), ("period_s", 12.0), ("blowing_share", 0.5)];
    state.laws = vec![spec("wind", None, &params)];
    let mut run = Run::from_state(house, PhysicsConfig::default(), state);
    run.steps(119);
    assert_eq!(run.world.awake_count(), 0);
    let (ball_at, block_at) = (run.position(ball), run.position(block));
    run.steps(60);
    assert_eq!(run.world.awake_count(), 1);
    assert!(run.position(ball).x > ball_at.x + 0.2);
    assert_eq!(run.position(block), block_at);
}
