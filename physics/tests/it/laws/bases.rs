//! Laws of wheels and gyros against their closed forms.

use super::spec;
use crate::common::{Build, Run};
use dwell_physics::AgentControl;
use dwell_scene::{AgentBody, AgentId, AgentState, DifferentialDrive, LawSpec, Locomotion, State};
use glam::Vec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const AGENT: AgentId = AgentId(0);

/// A differential drive in the middle of a hall, whose wheels take `acceleration` rad/s2.
fn robot(laws: Vec<LawSpec>, acceleration: f32) -> Run {
    let house = Build::room([20.0, 3.0, 20.0]).house();
    let body = AgentBody {
        radius_m: 0.18,
        height_m: 0.5,
        eye_height_m: 0.4,
        step_height_m: 0.02,
        locomotion: Locomotion::DifferentialDrive(DifferentialDrive {
            max_wheel_acceleration_rad_s2: acceleration,
            ..DifferentialDrive::default()
        }),
        ..AgentBody::default()
    };
    let mut state = State::new(&house);
    state.laws = laws;
    for x in [10.0, 15.0] {
        let at = Vec3::new(x, 0.0, 10.0);
        state.agents.push(AgentState::new(body, at, 0.0));
    }
    Run::from_state(house, dwell_physics::PhysicsConfig::default(), state)
}

/// Both agents drive alike.
fn drive(run: &mut Run, steps: usize, left: f32, right: f32) {
    let control = AgentControl {
        wheel_rad_s: Some([left, right]),
        ..AgentControl::default()
    };
    run.walk(steps, &[control, control]);
}

/// The true heading so far, counted in turns by the gyro's sign; rad.
fn heading_error(run: &Run, agent: AgentId) -> f64 {
    let agent = &run.state.agents[agent];
    let error = f64::from(agent.yaw_rad) - agent.base.odometry[2];
    error - TAU * (error / TAU).round()
}

/// A square of four metres, of straight lines and turns on the spot, by the robot's odometry. Wheels that differ by `e_d`
/// bend the path by `2 (e_d - 1) / (e_d + 1) r / b` on each radian of both wheels, the same in both directions (type B); a
/// base longer by `e_b` turns less by its inverse (type A).
#[test]
fn a_square_shows_unequal_wheels_and_a_wrong_base_as_borenstein_and_feng_have_it() {
    let square = |laws: Vec<LawSpec>, direction: f32| {
        let mut run = robot(laws, 1e6);
        for _ in 0..4 {
            drive(&mut run, 80, 20.0, 20.0);
            // A quarter turn on the spot: 4.71 rad of each wheel in 30 steps.
            let rate = (FRAC_PI_2 * 0.15 / 0.05 / 1.5) as f32 * direction;
            drive(&mut run, 30, -rate, rate);
        }
        drive(&mut run, 1, 0.0, 0.0);
        run
    };
    let ratio = 1.004;
    for direction in [1.0, -1.0] {
        let unequal = vec![spec(
            "unequal_wheels",
            Some("0"),
            &[("radius_ratio", ratio)],
        )];
        let run = square(unequal, direction);
        let expected = 2.0 * (ratio - 1.0) / (ratio + 1.0) * 0.05 / 0.3 * 320.0;
        // The ramps of 1e6 rad/s2 cost 2e-4 rad of a wheel at each corner, 3e-5 rad of heading; roundings 1e-5.
        let error = heading_error(&run, AGENT);
        assert!((error - expected).abs() < 1e-4, "{error} {expected}");
        // The other robot has equal wheels and comes back to where it was.
        assert!(heading_error(&run, AgentId(1)).abs() < 1e-4);
        let back = run.state.agents[AgentId(1)].position - Vec3::new(15.0, 0.0, 10.0);
        assert!(back.length() < 2e-3, "{back}");
        let wide = vec![spec("unequal_wheels", Some("0"), &[("base_ratio", 1.01)])];
        let error = heading_error(&square(wide, direction), AGENT);
        let expected = f64::from(direction) * 2.0 * PI * (1.0 / 1.01 - 1.0);
        assert!((error - expected).abs() < 1e-4, "{error} {expected}");
    }
    let larger = vec![spec("unequal_wheels", None, &[("radius_scale", 1.02)])];
    let mut run = robot(larger, 1e6);
    drive(&mut run, 20, 10.0, 10.0);
    let way = 10.0 - run.state.agents[AGENT].position.z;
    assert!((way - 0.51).abs() < 1e-5, "{way}");
}

/// While it accelerates to `W`, slip costs `k r^2 W^2 / 2` of the distance, however fast it accelerates; at a steady speed
/// nothing; and braking gives it back.
#[test]
fn slip_costs_the_square_of_the_speed_that_is_gathered() {
    let k = 0.05;
    for acceleration in [10.0, 40.0] {
        let laws = vec![spec("wheel_slip", Some("0"), &[("slip_per_m_s2", k)])];
        let mut run = robot(laws, acceleration);
        let lost = |run: &Run| {
            let agent = &run.state.agents[AGENT];
            agent.base.odometry[0] - f64::from(10.0 - agent.position.z)
        };
        drive(&mut run, 20, 10.0, 10.0);
        let expected = 0.5 * k * (0.05_f64 * 10.0).powi(2);
        assert!(
            (lost(&run) - expected).abs() < 1e-5,
            "{} {expected}",
            lost(&run)
        );
        drive(&mut run, 40, 10.0, 10.0);
        assert!((lost(&run) - expected).abs() < 1e-5, "at a steady speed");
        drive(&mut run, 40, 0.0, 0.0);
        assert!(lost(&run).abs() < 1e-5, "{}", lost(&run));
        let other = &run.state.agents[AgentId(1)];
        assert!((other.base.odometry[0] - f64::from(10.0 - other.position.z)).abs() < 1e-5);
    }
}

/// The integral of the reading is `scale * angle + bias * time`.
#[test]
fn a_gyro_drifts_with_time_and_errs_with_the_angle() {
    let (bias, scale) = (0.004, 1.02);
    let laws = vec![spec(
        "gyro_bias_scale",
        Some("0"),
        &[("bias_rad_s", bias), ("scale", scale)],
    )];
    let mut run = robot(laws, 1e6);
    let mut read = 0.0;
    for (steps, rate) in [(100, 0.0), (60, 6.0), (40, -3.0)] {
        for _ in 0..steps {
            drive(&mut run, 1, -rate, rate);
            read += f64::from(run.state.agents[AGENT].gyro_rad_s) * 0.05;
        }
    }
    let angle = run.state.agents[AGENT].base.odometry[2];
    let expected = scale * angle + bias * 10.0;
    assert!((read - expected).abs() < 1e-4, "{read} {expected}");
    assert!(
        heading_error(&run, AGENT).abs() < 1e-4,
        "the way itself is not changed"
    );
    // The other gyro reads what it does: both wheels at 3 rad/s against each other.
    let other = f64::from(run.state.agents[AgentId(1)].gyro_rad_s);
    assert!((other + 2.0 * 3.0 * 0.05 / 0.3).abs() < 1e-5, "{other}");
}

#[test]
fn laws_of_bases_name_agents_that_exist() {
    for id in ["unequal_wheels", "wheel_slip", "gyro_bias_scale"] {
        let mut run = robot(Vec::new(), 40.0);
        let name = match id {
            "unequal_wheels" => "radius_ratio",
            "wheel_slip" => "slip_per_m_s2",
            _ => "bias_rad_s",
        };
        for target in ["2", "robot", "-1"] {
            run.state.laws = vec![spec(id, Some(target), &[(name, 0.9)])];
            let message = run
                .world
                .apply_parameters(&mut run.state)
                .unwrap_err()
                .to_string();
            assert!(
                message.contains(target) && message.contains(r#""0", "1""#),
                "{message}"
            );
        }
    }
}

/// Legs have neither wheels nor a gyro: a law that needs them is refused, and one without a target applies to the agents
/// that have them.
#[test]
fn laws_of_bases_are_refused_by_who_walks() {
    let house = Build::room([20.0, 3.0, 20.0]).house();
    for (id, name) in [
        ("unequal_wheels", "radius_ratio"),
        ("wheel_slip", "slip_per_m_s2"),
        ("gyro_bias_scale", "bias_rad_s"),
    ] {
        for target in [None, Some("0")] {
            let mut state = State::new(&house);
            let walker = AgentState::new(AgentBody::default(), Vec3::new(10.0, 0.0, 10.0), 0.0);
            state.agents.push(walker);
            state.laws = vec![spec(id, target, &[(name, 0.9)])];
            let config = dwell_physics::PhysicsConfig::default();
            let refused = dwell_physics::PhysicsWorld::new(house.clone(), config, &mut state);
            let message = refused.unwrap_err().to_string();
            assert!(
                message.contains("walking") && message.contains(id),
                "{message}"
            );
        }
        let mut both = robot(Vec::new(), 40.0);
        both.agent(Vec3::new(5.0, 0.0, 10.0), 0.0);
        both.state.laws = vec![spec(id, None, &[(name, 0.9)])];
        both.world.apply_parameters(&mut both.state).unwrap();
        both.steps(1);
        assert_eq!(both.state.agents[AgentId(2)].gyro_rad_s, 0.0, "{id}");
    }
}
