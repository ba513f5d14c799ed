//! Laws of servos and joints.

use super::{spec, tower};
use crate::common::Run;
use dwell_physics::PhysicsConfig;
use dwell_scene::{JointCommand, State};

/// The joint follows the target b behind on the way up and b ahead on the way down, and rests at the turns.
#[test]
fn backlash_draws_its_hysteresis_loop() {
    let b = 0.1;
    let house = tower().house();
    let mut state = State::new(&house);
    state.laws = vec![spec("backlash", Some("elbow"), &[("half_width", b)])];
    let mut run = Run::from_state(
        house,
        PhysicsConfig {
            sleeping: false,
            ..PhysicsConfig::default()
        },
        state,
    );
    let joint = run.house.joints.ids().next().unwrap();
    let mut follow = |target: f32| {
        run.state.joint_command[joint] = JointCommand::Position(target);
        run.steps(30);
        run.state.joint_position[joint]
    };
    for (target, expected) in [
        (0.05, 0.0),
        (0.5, 0.4),
        (1.0, 0.9),
        (0.9, 0.9),
        (0.8, 0.9),
        (0.5, 0.6),
        (0.0, 0.1),
        (0.15, 0.1),
        (0.4, 0.3),
    ] {
        let found = follow(target);
        assert!(
            (found - expected).abs() < 2e-3,
            "target {target}: {found}, expected {expected}"
        );
    }
}
