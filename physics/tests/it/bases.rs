//! Wheeled bases: circles, odometry, limits, walls, run-time parameters.

use crate::common::{Build, Piece, Run, forward};
use dwell_physics::AgentControl;
use dwell_physics::bases::{PlanarPose, PlanarTwist, WheelGeometry};
use dwell_scene::{AgentBody, AgentId, DifferentialDrive, HolonomicBase, Locomotion};
use glam::Vec3;
use std::f64::consts::TAU;

/// Wheels that reach their speed almost at once: during the ramp to 10 rad/s they lose `w^2 / (2 a)` = 5e-5 rad.
pub(crate) fn quick() -> DifferentialDrive {
    DifferentialDrive {
        max_wheel_acceleration_rad_s2: 1e6,
        ..DifferentialDrive::default()
    }
}

pub(crate) fn robot(locomotion: Locomotion) -> AgentBody {
    AgentBody {
        radius_m: 0.18,
        height_m: 0.5,
        eye_height_m: 0.4,
        step_height_m: 0.02,
        locomotion,
        ..AgentBody::default()
    }
}

fn differential(drive: DifferentialDrive, at: Vec3, yaw: f32) -> (Run, AgentId) {
    let mut run = Build::room([20.0, 3.0, 20.0]).run();
    let id = run.agent_with(robot(Locomotion::DifferentialDrive(drive)), at, yaw);
    (run, id)
}

fn wheels(left: f32, right: f32) -> AgentControl {
    AgentControl {
        wheel_rad_s: Some([left, right]),
        ..AgentControl::default()
    }
}

/// Returns the world position of a planar pose for an agent that started at `at` with `yaw`.
fn in_world(pose: &PlanarPose, at: Vec3, yaw: f32) -> Vec3 {
    let turn = glam::Quat::from_rotation_y(yaw);
    at + turn * Vec3::new(-pose.y_m as f32, 0.0, -pose.x_m as f32)
}

/// Constant wheel speeds draw a circle of radius `b/2 (r + l)/(r - l)`; ten turns later the robot is where it was.
#[test]
fn constant_wheel_speeds_draw_the_circle_of_their_closed_form() {
    let (at, yaw) = (Vec3::new(10.0, 0.0, 10.0), 0.6);
    let (mut run, id) = differential(quick(), at, yaw);
    let (l, r) = (5.0, 7.0);
    let twist = WheelGeometry::from(&quick()).twist([5.0, 7.0]);
    for step in 1..=1200 {
        run.walk(1, &[wheels(l, r)]);
        let t = f64::from(step) * 0.05;
        let pose = PlanarPose::default().integrated(&twist, t);
        let agent = &run.state.agents[id];
        let expected = in_world(&pose, at, yaw);
        // Sixty seconds of 7200 roundings in f32; without the kept remainders they would be a millimetre.
        assert!(
            (agent.position - expected).length() < 1e-4,
            "{t} s: {} {expected}",
            agent.position
        );
        let heading = f64::from(agent.yaw_rad - yaw) - pose.heading_rad;
        assert!(
            (heading - TAU * (heading / TAU).round()).abs() < 5e-5,
            "{t} s: {heading}"
        );
        // The first step is short of the ramp.
        let gyro = f64::from(agent.gyro_rad_s) - twist.yaw_rate_rad_s;
        assert!(
            gyro.abs() < if step == 1 { 1e-3 } else { 1e-5 },
            "{t} s: {gyro}"
        );
        let [x, y, heading] = agent.base.odometry;
        assert!((x - pose.x_m).abs() < 1e-5 && (y - pose.y_m).abs() < 1e-5);
        assert!((heading - pose.heading_rad).abs() < 1e-5);
        let [left, right] = agent.base.wheel_rotation_rad;
        assert!((left - 5.0 * t).abs() < 1e-4 && (right - 7.0 * t).abs() < 1e-4);
    }
}

#[test]
fn wheels_gather_speed_as_fast_as_they_may_and_no_faster_than_their_limit() {
    let drive = DifferentialDrive {
        max_wheel_speed_rad_s: 8.0,
        max_wheel_acceleration_rad_s2: 10.0,
        ..DifferentialDrive::default()
    };
    let (mut run, id) = differential(drive, Vec3::new(10.0, 0.0, 15.0), 0.0);
    for step in 1..=40 {
        run.walk(1, &[wheels(100.0, 100.0)]);
        let t = step as f32 * 0.05;
        let way = if t < 0.8 {
            5.0 * t * t
        } else {
            3.2 + 8.0 * (t - 0.8)
        };
        let agent = &run.state.agents[id];
        assert!(
            (agent.base.wheel_rad_s[0] - (10.0 * t).min(8.0)).abs() < 1e-4,
            "{t}"
        );
        assert!(
            (15.0 - agent.position.z - 0.05 * way).abs() < 1e-4,
            "{t}: {}",
            agent.position
        );
    }
    // Let go, it rolls on for v^2 / (2 a).
    let before = run.state.agents[id].position;
    run.walk(20, &[]);
    let agent = run.state.agents[id];
    assert_eq!(agent.base.wheel_rad_s, [0.0; 2]);
    assert!(
        (before.z - agent.position.z - 0.05 * 3.2).abs() < 1e-4,
        "{}",
        agent.position
    );
}

/// A forward speed and a yaw rate become wheel speeds; one that is too fast keeps its curvature.
#[test]
fn velocities_are_driven_with_the_curvature_that_was_asked_for() {
    let (mut run, id) = differential(quick(), Vec3::new(10.0, 0.0, 10.0), 0.0);
    let control = AgentControl {
        forward_m_s: 0.5,
        yaw_rate_rad_s: 0.8,
        ..AgentControl::default()
    };
    run.walk(1, &[control]);
    let [forward_m_s, left, yaw] = run.state.agents[id].base.twist;
    assert!((forward_m_s - 0.5).abs() < 1e-6 && left == 0.0 && (yaw - 0.8).abs() < 1e-6);
    let tenfold = AgentControl {
        forward_m_s: 5.0,
        yaw_rate_rad_s: 8.0,
        ..AgentControl::default()
    };
    run.walk(1, &[tenfold]);
    let agent = &run.state.agents[id];
    assert!((agent.base.wheel_rad_s[1] - 20.0).abs() < 1e-4);
    let [forward_m_s, _, yaw] = agent.base.twist;
    assert!((yaw / forward_m_s - 1.6).abs() < 1e-5);
}

/// Against a wall the body stops, and the wheels keep turning: odometry counts a distance that was not travelled.
#[test]
fn against_a_wall_wheels_slip_and_odometry_is_deceived() {
    let (mut run, id) = differential(quick(), Vec3::new(10.0, 0.0, 1.0), 0.0);
    run.walk(60, &[wheels(10.0, 10.0)]);
    let agent = &run.state.agents[id];
    assert!(
        (agent.position.z - 0.18).abs() < 0.02 && agent.collided,
        "{}",
        agent.position
    );
    assert!((agent.base.odometry[0] - 1.5).abs() < 1e-5);
    assert!((agent.base.wheel_rotation_rad[0] - 30.0).abs() < 1e-4);
}

#[test]
fn a_base_pushes_a_light_box_and_not_a_heavy_one() {
    for (density, moves) in [(50.0, true), (20_000.0, false)] {
        let mut build = Build::room([4.0, 3.0, 10.0]);
        let at = Vec3::new(2.0, 0.2, 5.0);
        let thing = build.movable("box", Piece::cuboid(Vec3::splat(0.2), at).density(density));
        let mut run = build.run();
        let body = robot(Locomotion::DifferentialDrive(quick()));
        run.agent_with(body, Vec3::new(2.0, 0.0, 6.0), 0.0);
        run.walk(80, &[wheels(10.0, 10.0)]);
        assert_eq!(at.z - run.position(thing).z > 0.5, moves, "{density}");
    }
}

/// Off a table it keeps its speed and its heading until it lands, whatever its wheels do.
#[test]
fn in_the_air_a_base_is_thrown_and_does_not_steer() {
    let mut build = Build::room([6.0, 4.0, 10.0]);
    build.fixed(
        "table",
        Piece::cuboid(Vec3::new(1.0, 0.5, 1.0), Vec3::new(3.0, 0.5, 7.0)),
    );
    let mut run = build.run();
    let body = robot(Locomotion::DifferentialDrive(quick()));
    let id = run.agent_with(body, Vec3::new(3.0, 1.0, 7.0), 0.0);
    let mut steps = 0;
    while run.state.agents[id].grounded && steps < 60 {
        run.walk(1, &[wheels(20.0, 20.0)]);
        steps += 1;
    }
    let left = run.state.agents[id];
    run.walk(4, &[wheels(-20.0, 20.0)]);
    let air = run.state.agents[id];
    assert!(!air.grounded);
    assert_eq!(air.yaw_rad, left.yaw_rad);
    assert!(
        (left.position.z - air.position.z - 0.2).abs() < 1e-3,
        "{}",
        air.position
    );
    assert!(air.base.odometry[2] > 1.0);
    run.walk(20, &[wheels(0.0, 0.0)]);
    assert!(run.state.agents[id].grounded);
}

#[test]
fn a_holonomic_base_goes_sideways_and_turns_on_the_way() {
    let mut run = Build::room([20.0, 3.0, 20.0]).run();
    let quick = HolonomicBase {
        max_acceleration_m_s2: 1e4,
        max_yaw_acceleration_rad_s2: 1e4,
        ..HolonomicBase::default()
    };
    let at = Vec3::new(10.0, 0.0, 10.0);
    let id = run.agent_with(robot(Locomotion::Holonomic(quick)), at, -0.4);
    let control = AgentControl {
        forward_m_s: 0.3,
        right_m_s: 0.6,
        yaw_rate_rad_s: 0.7,
        ..AgentControl::default()
    };
    let twist = PlanarTwist {
        forward_m_s: 0.3,
        left_m_s: -0.6,
        yaw_rate_rad_s: 0.7,
    };
    for step in 1..=400 {
        run.walk(1, &[control]);
        let pose = PlanarPose::default().integrated(&twist, f64::from(step) * 0.05);
        let agent = &run.state.agents[id];
        let expected = in_world(&pose, at, -0.4);
        // The first physics step ramps up: 0.67 m/s and 0.7 rad/s within 70 us.
        assert!(
            (agent.position - expected).length() < 2e-4,
            "{} {expected}",
            agent.position
        );
        assert!((agent.base.odometry[1] - pose.y_m).abs() < 2e-4);
    }
}

/// A base's true parameters can differ from its nominal ones: the override moves the body, odometry keeps to nominal
/// numbers. A base wider by one percent turns one percent less.
#[test]
fn a_measured_wheel_base_changes_the_way_and_not_the_odometry() {
    let (mut run, id) = differential(quick(), Vec3::new(10.0, 0.0, 10.0), 0.0);
    let address = "agent/0/base/wheel_base_m".parse().unwrap();
    run.state
        .set_parameter(&run.house, &address, 0.303)
        .unwrap();
    run.world.apply_parameters(&mut run.state).unwrap();
    run.walk(40, &[wheels(-3.0, 3.0)]);
    let agent = &run.state.agents[id];
    let believed = agent.base.odometry[2];
    assert!((believed - 2.0).abs() < 1e-5, "{believed}");
    assert!(
        (f64::from(agent.yaw_rad) - 2.0 / 1.01).abs() < 1e-5,
        "{}",
        agent.yaw_rad
    );
    // Half of the radius on the left: at equal speeds it turns left.
    for (field, value) in [("left_wheel_radius_m", 0.025), ("wheel_base_m", 0.3)] {
        let address = format!("agent/0/base/{field}").parse().unwrap();
        run.state
            .set_parameter(&run.house, &address, value)
            .unwrap();
    }
    run.walk(20, &[wheels(4.0, 4.0)]);
    let agent = &run.state.agents[id];
    assert!(
        (f64::from(agent.gyro_rad_s) - 0.1 / 0.3).abs() < 1e-5,
        "{}",
        agent.gyro_rad_s
    );
}

#[test]
fn snapshots_hold_the_wheels_and_continue_bit_for_bit() {
    let (mut run, _) = differential(
        DifferentialDrive::default(),
        Vec3::new(10.0, 0.0, 10.0),
        0.3,
    );
    let drive = |step: usize| wheels(3.0 + (step % 7) as f32, 9.0 - (step % 11) as f32);
    for step in 0..33 {
        run.walk(1, &[drive(step)]);
    }
    let (state, bytes) = (run.state.clone(), run.world.snapshot());
    let mut other = run.clone();
    for step in 33..80 {
        run.walk(1, &[drive(step)]);
    }
    other.state =
        dwell_scene::State::from_bytes(&other.house, &state.to_bytes(&other.house)).unwrap();
    other.world.restore(&mut other.state, &bytes).unwrap();
    for step in 33..80 {
        other.walk(1, &[drive(step)]);
    }
    assert!(run.hash() == other.hash());
}

#[test]
fn commands_that_a_body_cannot_follow_are_refused_and_nothing_happens() {
    let mut run = Build::room([8.0, 3.0, 8.0]).run();
    let legs = AgentBody::default();
    let drive = robot(Locomotion::DifferentialDrive(quick()));
    let holonomic = robot(Locomotion::Holonomic(HolonomicBase::default()));
    for (k, body) in [legs, drive, holonomic].into_iter().enumerate() {
        run.agent_with(body, Vec3::new(2.0 * k as f32 + 1.0, 0.0, 4.0), 0.0);
    }
    let sideways = AgentControl {
        right_m_s: 0.1,
        ..AgentControl::default()
    };
    let crouch = AgentControl {
        crouch: true,
        ..AgentControl::default()
    };
    let both = AgentControl {
        forward_m_s: 1.0,
        ..wheels(1.0, 1.0)
    };
    let before = run.hash();
    for (agent, control, reason) in [
        (0, wheels(1.0, 1.0), "no such wheels"),
        (1, sideways, "sideways"),
        (1, crouch, "no legs"),
        (1, both, "not both"),
        (1, wheels(f32::NAN, 0.0), "finite"),
        (1, wheels(0.0, f32::INFINITY), "finite"),
        (2, wheels(1.0, 1.0), "no such wheels"),
        (2, crouch, "no legs"),
        (2, forward(f32::NAN), "finite"),
    ] {
        let mut controls = [AgentControl::default(); 3];
        controls[agent] = control;
        let mut events = Vec::new();
        let message = run
            .world
            .step(&mut run.state, &controls, &mut events)
            .unwrap_err()
            .to_string();
        assert!(message.contains(reason), "{message}");
        assert!(message.contains(&format!("agent {agent}")), "{message}");
        assert!(before == run.hash());
    }
}
