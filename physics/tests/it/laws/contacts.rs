//! Laws of contacts.

use super::spec;
use crate::common::{Build, Piece, Run, forward, gravity, pair};
use dwell_physics::PhysicsConfig;
use dwell_scene::{LawSpec, ObjectId, State};
use glam::{Quat, Vec3};
use std::f32::consts::{PI, TAU};

fn run_with(build: Build, laws: Vec<LawSpec>, config: PhysicsConfig) -> Run {
    let house = build.house();
    let mut state = State::new(&house);
    state.laws = laws;
    Run::from_state(house, config, state)
}

fn compliance(frequency_hz: f32, damping_ratio: f32) -> Vec<LawSpec> {
    let params = [
        ("natural_frequency_hz", f64::from(frequency_hz)),
        ("damping_ratio", f64::from(damping_ratio)),
    ];
    vec![spec("contact_compliance", None, &params)]
}

/// A ball above the floor.
fn drop_from(height_m: f32, laws: Vec<LawSpec>, config: PhysicsConfig) -> (Run, ObjectId) {
    let mut build = Build::room_of([4.0, 8.0, 4.0], "rubber");
    let at = Vec3::new(2.0, 0.1 + height_m, 2.0);
    let ball = build.movable("ball", Piece::ball(0.1, at).of("rubber"));
    (run_with(build, laws, config), ball)
}

/// Speed on leaving the floor over the speed on reaching it.
fn rebound(run: &mut Run, ball: ObjectId, height_m: f32) -> f32 {
    let fast = |run: &Run| {
        let above = (run.position(ball).y - 0.1).max(0.0);
        let energy = 0.5 * run.velocity(ball).length_squared() + gravity() * above;
        (2.0 * energy).sqrt()
    };
    let arrives = (2.0 * gravity() * height_m).sqrt();
    while run.velocity(ball).y <= 0.0 {
        run.steps(1);
        assert!(run.world.time_s() < 5.0, "it never leaves the floor");
    }
    // Until it is clear of the floor.
    while run.position(ball).y < 0.1 {
        run.steps(1);
    }
    fast(run) / arrives
}

/// A spring with a damper that only pushes leaves `e = exp(-(b / w_d) (pi - atan(2 b w_d / (w_d^2 - b^2))))` of the speed,
/// with `b = zeta w`, `w_d = w sqrt(1 - zeta^2)` (T. Schwager, T. Poeschel, Granular Matter 9, 465 (2007), equation 21), and
/// depth lasts about `pi / w_d`. Gravity adds `g / (w v)`, here below 3 %.
#[test]
fn a_compliant_contact_rebounds_as_a_spring_with_a_damper() {
    for (frequency_hz, zeta) in [(30.0_f32, 0.05_f32), (30.0, 0.3), (60.0, 0.6)] {
        let height = 0.5;
        let (mut run, ball) = drop_from(
            height,
            compliance(frequency_hz, zeta),
            PhysicsConfig::default(),
        );
        let omega = TAU * frequency_hz;
        let (beta, damped) = (zeta * omega, omega * (1.0 - zeta * zeta).sqrt());
        let turn = PI - (2.0 * beta * damped / (damped * damped - beta * beta)).atan();
        let expected = (-beta / damped * turn).exp();
        let found = rebound(&mut run, ball, height);
        assert!(
            (found - expected).abs() < 0.04,
            "{frequency_hz} Hz, {zeta}: {found}, expected {expected}"
        );
    }
}

#[test]
fn a_compliant_impact_lasts_half_a_period() {
    let config = PhysicsConfig {
        control_rate_hz: 1000.0,
        physics_rate_hz: 1000.0,
        ..PhysicsConfig::default()
    };
    let (mut run, ball) = drop_from(0.5, compliance(20.0, 0.1), config);
    let mut below = 0;
    while run.world.time_s() < 0.5 {
        run.steps(1);
        below += usize::from(run.position(ball).y < 0.1);
    }
    let expected = 1000.0 * PI / (TAU * 20.0 * 0.99_f32.sqrt());
    assert!(
        (below as f32 - expected).abs() < 2.0,
        "{below} ms, expected {expected} ms"
    );
}

/// `g / w^2` for a ball, and for a cube, each of whose four corners carries a quarter with a quarter of the mass. A run of
/// rapier adds gravity before the contact answers: up to zeta / 10 of the depth is missing.
#[test]
fn a_compliant_contact_sinks_by_g_over_w_squared() {
    for piece in [
        Piece::ball(0.1, Vec3::new(2.0, 0.1, 2.0)),
        Piece::cuboid(Vec3::splat(0.1), Vec3::new(2.0, 0.1, 2.0)),
        Piece::cuboid(Vec3::splat(0.1), Vec3::new(2.0, 0.1, 2.0)).density(5000.0),
    ] {
        let mut build = Build::room([4.0, 3.0, 4.0]);
        let thing = build.movable("thing", piece);
        let mut run = run_with(build, compliance(8.0, 0.2), PhysicsConfig::default());
        run.steps(80);
        let expected = gravity() / (TAU * 8.0).powi(2);
        let found = 0.1 - run.position(thing).y;
        assert!(
            (found / expected - 1.0).abs() < 0.02,
            "{found} m, expected {expected} m"
        );
    }
}

/// `e(v) = e - k (v - v_0)` at each of three speeds.
#[test]
fn restitution_falls_with_speed_as_the_law_says() {
    let (_, e) = pair("rubber", "rubber");
    for height in [0.2, 0.8, 3.0] {
        let law = spec(
            "velocity_restitution",
            Some("rubber~ball"),
            &[("slope_s_m", 0.05), ("reference_m_s", 2.0)],
        );
        // rapier takes the speed of the step before: up to g dt too little.
        let config = PhysicsConfig {
            physics_rate_hz: 480.0,
            ..PhysicsConfig::default()
        };
        let (mut run, ball) = drop_from(height, vec![law], config);
        let speed = (2.0 * gravity() * height).sqrt();
        let expected = e - 0.05 * (speed - 2.0);
        let found = rebound(&mut run, ball, height);
        assert!(
            (found - expected).abs() < 0.02,
            "{speed} m/s: {found}, expected {expected}"
        );
    }
}

/// A sled on the floor, at rest.
fn sled(laws: Vec<LawSpec>) -> (Run, ObjectId) {
    let mut build = Build::room([12.0, 3.0, 12.0]);
    let at = Vec3::new(6.0, 0.1, 6.0);
    let sled = build.movable("sled", Piece::cuboid(Vec3::new(0.3, 0.1, 0.3), at));
    let mut run = run_with(build, laws, PhysicsConfig::default());
    run.steps(10);
    (run, sled)
}

/// `v^2 / (2 mu(phi) g)` along the grain, against the pile and across.
#[test]
fn anisotropic_friction_stops_a_sled_by_its_direction() {
    let params = [("grain", 0.2), ("pile", 0.1), ("axis_rad", 0.5)];
    for target in ["parquet~wood", "sled", "wood"] {
        // The axis belongs to what is named first: the floor, or the sled, which does not turn here.
        for angle in [0.5_f32, 0.5 + 0.5 * PI, 0.5 + PI] {
            let (mut run, sled) = sled(vec![spec("anisotropic_friction", Some(target), &params)]);
            let from = run.position(sled);
            let direction = Vec3::new(angle.cos(), 0.0, -angle.sin());
            run.throw(sled, direction * 2.5);
            run.steps(60);
            let (mu, _) = pair("parquet", "wood");
            // Seen from the sled the floor slides the other way.
            let sign = if target == "parquet~wood" { 1.0 } else { -1.0 };
            let phi = angle - 0.5;
            let mu = mu * (1.0 + sign * 0.1 * phi.cos() + 0.2 * (2.0 * phi).cos());
            let expected = 6.25 / (2.0 * mu * gravity());
            let found = (run.position(sled) - from).length();
            assert!(
                (found / expected - 1.0).abs() < 0.03,
                "{target} {angle} rad: {found} m, expected {expected} m"
            );
        }
    }
}

/// Between the two angles of friction a block that rests stays and one that slides goes on.
#[test]
fn static_friction_holds_what_kinetic_friction_lets_slide() {
    let (mu, _) = pair("wood", "oak");
    let law = || {
        let params = [("static_ratio", 1.4), ("stribeck_m_s", 0.02)];
        vec![spec("stribeck_friction", Some("oak~wood"), &params)]
    };
    let block_on = |angle: f32, speed: f32| {
        let mut build = Build::room([8.0, 5.0, 4.0]);
        let turn = Quat::from_rotation_z(angle);
        let at = Vec3::new(4.0, 2.2, 2.0);
        let ramp = Piece::cuboid(Vec3::new(3.0, 0.1, 1.0), at);
        build.fixed("ramp", ramp.of("oak").turned(turn));
        let on = at + turn * Vec3::new(1.5, 0.15, 0.0);
        let half = Vec3::new(0.2, 0.05, 0.2);
        let block = build.movable("block", Piece::cuboid(half, on).turned(turn));
        let mut run = run_with(build, law(), PhysicsConfig::default());
        run.steps(10);
        run.throw(block, turn * Vec3::X * -speed);
        run.steps(20);
        (run.position(block) - on).length()
    };
    let between = (1.2 * mu).atan();
    assert!(block_on(between, 0.0) < 0.01);
    assert!(block_on(between, 0.3) > 0.3);
    assert!(block_on((1.5 * mu).atan(), 0.0) > 0.3);
    assert!(block_on((0.9 * mu).atan(), 0.3) < 0.3);
}

/// The distance of `v' = -g mu(v)`, integrated finely here.
#[test]
fn stribeck_friction_brakes_a_sled_by_its_speed() {
    let params = [("static_ratio", 1.5), ("stribeck_m_s", 0.8), ("shape", 1.0)];
    let (mut run, sled) = sled(vec![spec("stribeck_friction", None, &params)]);
    let from = run.position(sled);
    run.throw(sled, Vec3::new(2.0, 0.0, 0.0));
    run.steps(60);
    let (mu, _) = pair("parquet", "wood");
    let (mut v, mut expected) = (2.0_f64, 0.0);
    while v > 0.0 {
        expected += v * 1e-5;
        v -= f64::from(gravity() * mu) * (1.0 + 0.5 * (-v / 0.8).exp()) * 1e-5;
    }
    let found = f64::from((run.position(sled) - from).length());
    assert!(
        (found / expected - 1.0).abs() < 0.03,
        "{found} m, expected {expected} m"
    );
}

/// A ball that rolls along the floor with `v`, or down a slope.
fn rolling(c_rr: f64, slope_rad: f32, speed_m_s: f32) -> (Run, ObjectId) {
    let mut build = Build::room_of([20.0, 6.0, 4.0], "rubber");
    let turn = Quat::from_rotation_z(slope_rad);
    let at = Vec3::new(10.0, 2.0, 2.0);
    let lane = Piece::cuboid(Vec3::new(9.0, 0.1, 1.0), at);
    build.fixed("lane", lane.of("rubber").turned(turn));
    let on = at + turn * Vec3::new(2.0, 0.2, 0.0);
    let ball = build.movable("ball", Piece::ball(0.1, on).of("rubber").density(200.0));
    let law = spec("rolling_resistance", Some("rubber~ball"), &[("c_rr", c_rr)]);
    let config = PhysicsConfig {
        sleeping: false,
        ..PhysicsConfig::default()
    };
    let mut run = run_with(build, vec![law], config);
    let root = run.root(ball);
    run.state.part_velocity[root].angular = Vec3::new(0.0, 0.0, speed_m_s / 0.1);
    run.throw(ball, turn * Vec3::X * -speed_m_s);
    (run, ball)
}

/// `v^2 / (2 a)` with `a = 5/7 c_rr g`, rolling all the way; and it stays where it stops.
#[test]
fn rolling_resistance_stops_a_ball() {
    for (c_rr, speed) in [(0.02, 1.0_f32), (0.05, 1.5)] {
        let (mut run, ball) = rolling(c_rr, 0.0, speed);
        let from = run.position(ball);
        run.steps(20);
        let (v, w) = (
            run.velocity(ball),
            run.state.part_velocity[run.root(ball)].angular,
        );
        assert!(
            (v.length() / (0.1 * w.length()) - 1.0).abs() < 0.01,
            "{v} {w}"
        );
        run.steps(300);
        let expected = speed * speed * 1.4 / (2.0 * c_rr as f32 * gravity());
        let found = (run.position(ball) - from).length();
        assert!(
            (found / expected - 1.0).abs() < 0.02,
            "{found} m, expected {expected} m"
        );
        assert!(run.velocity(ball).length() < 1e-4);
    }
}

/// It holds a ball on a slope up to `tan(t) = c_rr`, and beyond lets it roll with `5/7 g (sin(t) - c_rr cos(t))`. Held means
/// that it creeps by less than 1 mm/s: the torque comes once a step, gravity all the time.
#[test]
fn rolling_resistance_holds_a_ball_on_a_gentle_slope() {
    let (mut run, ball) = rolling(0.05, 0.045, 0.0);
    run.steps(20);
    let from = run.position(ball);
    run.steps(100);
    let crept = (run.position(ball) - from).length();
    assert!(crept < 5e-3, "{crept} m in 5 s");
    let (mut run, ball) = rolling(0.05, 0.1, 0.0);
    run.steps(20);
    let before = run.velocity(ball).length();
    run.steps(20);
    let found = run.velocity(ball).length() - before;
    let expected = gravity() / 1.4 * (0.1_f32.sin() - 0.05 * 0.1_f32.cos());
    assert!(
        (found / expected - 1.0).abs() < 0.03,
        "{found} m/s2, expected {expected} m/s2"
    );
}

/// `dw/dt = -mu m g r / I` about the vertical, and nothing once it stands or in flight.
#[test]
fn torsional_friction_slows_a_spinning_ball_evenly() {
    let (mu, _) = pair("rubber", "rubber");
    let law = spec("torsional_friction", Some("ball"), &[("radius_m", 0.002)]);
    let (mut run, ball) = drop_from(0.0, vec![law], PhysicsConfig::default());
    run.steps(10);
    let root = run.root(ball);
    run.state.part_velocity[root].angular = Vec3::new(0.0, 10.0, 0.0);
    run.world.adopt_state(&mut run.state).unwrap();
    let slowing = mu * gravity() * 0.002 / (0.4 * 0.01);
    for step in 1..=60 {
        run.steps(1);
        let expected = (10.0 - slowing * step as f32 / 20.0).max(0.0);
        let found = run.state.part_velocity[root].angular.y;
        assert!(
            (found - expected).abs() < 0.1,
            "{step}: {found} rad/s, expected {expected} rad/s"
        );
    }
    let law = spec("torsional_friction", Some("ball"), &[("radius_m", 0.002)]);
    let (mut run, ball) = drop_from(5.0, vec![law], PhysicsConfig::default());
    let root = run.root(ball);
    run.state.part_velocity[root].angular = Vec3::new(0.0, 10.0, 0.0);
    run.world.adopt_state(&mut run.state).unwrap();
    run.steps(10);
    let kept = run.state.part_velocity[root].angular.y;
    assert!((kept - 10.0).abs() < 1e-3, "{kept} rad/s");
}

/// Compliant contacts return at most the energy that they took: a cube that lands on its corners, edges and faces never
/// rises above its initial height, and comes to rest and to sleep.
#[test]
fn a_tumbling_soft_cube_gains_no_energy_and_comes_to_rest() {
    for (k, (frequency_hz, zeta)) in [(25.0, 0.05), (60.0, 0.2), (150.0, 0.5)]
        .into_iter()
        .enumerate()
    {
        let mut build = Build::room([8.0, 4.0, 8.0]);
        let turn = Quat::from_euler(glam::EulerRot::XYZ, 0.4 + k as f32, 0.9, 0.2);
        let at = Vec3::new(4.1, 0.6, 3.8);
        let cube = build.movable("cube", Piece::cuboid(Vec3::splat(0.05), at).turned(turn));
        let mut run = run_with(
            build,
            compliance(frequency_hz, zeta),
            PhysicsConfig::default(),
        );
        let root = run.root(cube);
        run.state.part_velocity[root].angular = Vec3::new(3.0, -2.0, 4.0);
        run.throw(cube, Vec3::new(0.8, 0.0, -0.4));
        let mass = 500.0 * 1e-3;
        let energy = |run: &Run| {
            let (v, w) = (run.velocity(cube), run.state.part_velocity[root].angular);
            let spin = mass * 0.01 / 6.0 * w.length_squared();
            0.5 * (mass * v.length_squared() + spin) + mass * gravity() * run.position(cube).y
        };
        let start = energy(&run);
        let mut most = 0.0_f32;
        for _ in 0..300 {
            run.steps(1);
            most = most.max(energy(&run));
        }
        assert!(
            most < 1.02 * start,
            "{frequency_hz} Hz, {zeta}: {most} J of {start} J"
        );
        let depth = 0.05 - run.position(cube).y;
        let expected = gravity() / (TAU * frequency_hz).powi(2);
        assert!(
            (depth - expected).abs() < 0.1 * expected + 2e-5,
            "{depth} m, expected {expected} m"
        );
        assert_eq!(run.world.awake_count(), 0);
    }
}

/// Three boxes on each other stand for 20 s, each on springs that carry what is above it.
#[test]
fn a_soft_stack_stands() {
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let boxes: Vec<ObjectId> = (0..3)
        .map(|k| {
            let at = Vec3::new(2.1, 0.1 + 0.2 * k as f32, 1.9);
            build.movable(&format!("box_{k}"), Piece::cuboid(Vec3::splat(0.1), at))
        })
        .collect();
    let mut run = run_with(build, compliance(40.0, 0.4), PhysicsConfig::default());
    run.steps(400);
    for (k, id) in boxes.iter().enumerate() {
        let at = run.position(*id);
        let aside = (at - Vec3::new(2.1, at.y, 1.9)).length();
        let sunk = 0.1 + 0.2 * k as f32 - at.y;
        assert!(
            aside < 2e-3 && sunk < 3e-3,
            "box {k}: {aside} m aside, {sunk} m down"
        );
    }
}

/// A kinematic body such as an agent's goes the same way in the same time when contacts take several runs a step.
#[test]
fn a_soft_world_leads_agents_at_their_own_speed() {
    let pushed = |laws: Vec<LawSpec>| {
        let mut build = Build::room([8.0, 3.0, 4.0]);
        let at = Vec3::new(3.0, 0.3, 2.0);
        let crate_ = build.movable("crate", Piece::cuboid(Vec3::splat(0.3), at).density(20.0));
        let mut run = run_with(build, laws, PhysicsConfig::default());
        run.agent(Vec3::new(2.0, 0.0, 2.0), -0.5 * PI);
        let mut fastest = 0.0_f32;
        for _ in 0..40 {
            run.walk(1, &[forward(1.0)]);
            fastest = fastest.max(run.velocity(crate_).length());
        }
        let agent = run.state.agents.iter().next().unwrap().position.x;
        (agent, run.position(crate_).x, fastest)
    };
    let (hard, soft) = (pushed(Vec::new()), pushed(compliance(40.0, 0.5)));
    assert!(
        (hard.0 - soft.0).abs() < 0.05 && (hard.1 - soft.1).abs() < 0.1,
        "{hard:?} {soft:?}"
    );
    assert!(soft.2 < 1.5, "{soft:?}");
}
