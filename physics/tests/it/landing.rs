//! Landing of wheeled bases with a motion that their wheels do not have.

use crate::bases::{quick, robot};
use crate::bounces::each_step;
use crate::common::{Build, Run, gravity};
use dwell_physics::{AgentControl, AgentPlacement};
use dwell_scene::{AgentId, HolonomicBase, Locomotion};
use glam::Vec3;

/// The friction of feet and wheels: that of the steepest slope they hold on.
fn friction(run: &Run, agent: AgentId) -> f32 {
    run.state.agents[agent].body.max_slope_rad.tan()
}

/// A base thrown from half a metre, its wheels commanded to stop: it slides on as it flew, slower by `mu g t`, and comes to
/// rest after `v^2 / (2 mu g)`, forwards, sideways and obliquely.
#[test]
fn landing_brakes_what_wheels_cannot_roll_by_friction() {
    let omni = HolonomicBase {
        max_acceleration_m_s2: 1e4,
        ..HolonomicBase::default()
    };
    for locomotion in [
        Locomotion::DifferentialDrive(quick()),
        Locomotion::Holonomic(omni),
    ] {
        for way in [Vec3::X, Vec3::NEG_Z, Vec3::new(-0.6, 0.0, 0.8)] {
            let speed = 0.9_f32;
            let mut run = Build::room([12.0, 4.0, 12.0]).run_with(each_step());
            let start = Vec3::new(6.0, 0.5, 6.0);
            let agent = run.agent_with(robot(locomotion), start, 0.0);
            let thrown = AgentPlacement {
                velocity: way * speed - Vec3::Y * 0.1,
                ..AgentPlacement::at_rest(agent, start, 0.0)
            };
            run.world.set_agents(&mut run.state, &[thrown]).unwrap();
            let stand = [AgentControl::default()];
            while !run.state.agents[agent].grounded {
                run.walk(1, &stand);
                let level = run.state.agents[agent].velocity.with_y(0.0);
                assert!((level - way * speed).length() < 1e-3, "{level}");
            }
            let landed = run.state.agents[agent].position;
            let slows = friction(&run, agent) * gravity();
            for k in 1..=40 {
                run.walk(1, &stand);
                let now = run.state.agents[agent].velocity;
                // Each step goes with the speed at its beginning.
                let expected = (speed - slows * (k - 1) as f32 / 120.0).max(0.0);
                assert!(
                    (now - way * expected).length() < 1e-3,
                    "{k}: {now} {expected}"
                );
            }
            let slid = (run.state.agents[agent].position - landed).dot(way);
            let expected = speed * speed / (2.0 * slows);
            println!("{way}: slid {slid} m of {expected}");
            // Half a step's way more, as it goes with the speed at the beginning of each.
            let expected = expected + 0.5 * speed / 120.0;
            assert!(
                (slid - expected).abs() < 0.1 * speed / 120.0,
                "{slid} {expected}"
            );
        }
    }
}

/// Wheels that turn as fast as the base flies go on without slip.
#[test]
fn landing_on_wheels_that_roll_takes_no_speed() {
    let mut run = Build::room([12.0, 4.0, 12.0]).run_with(each_step());
    let start = Vec3::new(6.0, 0.3, 6.0);
    let body = robot(Locomotion::DifferentialDrive(quick()));
    let agent = run.agent_with(body, start, 0.0);
    let thrown = AgentPlacement {
        velocity: Vec3::new(0.0, -0.1, -0.5),
        ..AgentPlacement::at_rest(agent, start, 0.0)
    };
    run.world.set_agents(&mut run.state, &[thrown]).unwrap();
    let rolls = AgentControl {
        wheel_rad_s: Some([10.0; 2]),
        ..AgentControl::default()
    };
    for _ in 0..90 {
        run.walk(1, &[rolls]);
        let level = run.state.agents[agent].velocity.with_y(0.0);
        assert!((level - Vec3::NEG_Z * 0.5).length() < 1e-3, "{level}");
    }
    assert!(run.state.agents[agent].grounded);
}
