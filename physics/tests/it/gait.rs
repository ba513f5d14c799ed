//! Legs: speed limits, crouching, slopes too steep to stand on.

use crate::common::{Build, Piece, forward, gravity};
use dwell_physics::{AgentControl, OutcomeCode};
use dwell_scene::{AgentBody, LeggedLocomotion, Locomotion};
use glam::{Quat, Vec3};

fn body(gait: LeggedLocomotion) -> AgentBody {
    AgentBody {
        locomotion: Locomotion::Walking(gait),
        ..AgentBody::default()
    }
}

fn crouched(speed: f32) -> AgentControl {
    AgentControl {
        crouch: true,
        ..forward(speed)
    }
}

#[test]
fn nobody_runs_faster_than_its_limit_and_a_slower_limit_holds_at_once() {
    let mut run = Build::room([4.0, 3.0, 30.0]).run();
    let gait = LeggedLocomotion {
        max_speed_m_s: 3.0,
        ..LeggedLocomotion::default()
    };
    let id = run.agent_with(body(gait), Vec3::new(2.0, 0.0, 28.0), 0.0);
    let fast_and_aside = AgentControl {
        forward_m_s: 8.0,
        right_m_s: 6.0,
        ..AgentControl::default()
    };
    run.walk(4, &[fast_and_aside]);
    let agent = run.state.agents[id];
    // The direction is kept: 0.8 and 0.6 of 3 m/s.
    assert!(
        (agent.velocity - Vec3::new(1.8, 0.0, -2.4)).length() < 1e-3,
        "{}",
        agent.velocity
    );
    assert!(!agent.collided);
    let address = "agent/0/base/max_speed_m_s".parse().unwrap();
    run.state.set_parameter(&run.house, &address, 1.5).unwrap();
    run.walk(1, &[forward(8.0)]);
    assert!((run.state.agents[id].velocity.z + 1.5).abs() < 1e-3);
}

/// A beam from 1.0 m above the floor: a crouched agent of 0.9 m passes under it, an upright one does not, and one that
/// stops below it cannot stand up.
#[test]
fn a_crouched_agent_passes_under_a_beam_and_stands_up_only_behind_it() {
    let mut build = Build::room([4.0, 3.0, 8.0]);
    build.fixed(
        "beam",
        Piece::cuboid(Vec3::new(2.0, 0.5, 0.5), Vec3::new(2.0, 1.5, 4.0)),
    );
    let mut run = build.run();
    let id = run.agent(Vec3::new(2.0, 0.0, 6.5), 0.0);
    run.walk(60, &[forward(1.0)]);
    let stopped = run.state.agents[id];
    assert!(
        stopped.collided && stopped.position.z > 4.7,
        "{}",
        stopped.position
    );
    let eye = stopped.eye_position().y;
    // Forward 0.7 m and more at the crouched limit of 1 m/s: under the middle of the beam.
    run.walk(15, &[crouched(3.0)]);
    let under = run.state.agents[id];
    assert!((under.height_m() - 0.9).abs() < 1e-6);
    assert!((under.velocity.z + 1.0).abs() < 1e-3, "{}", under.velocity);
    assert!((eye - under.eye_position().y - 0.6).abs() < 1e-3);
    run.walk(2, &[AgentControl::default()]);
    let still = run.state.agents[id];
    assert!(still.height_m() < 1.0, "it stood up through the beam");
    let notice = &run.world.delayed_outcomes()[0].outcome;
    assert_eq!(notice.code, OutcomeCode::Blocked);
    assert!(notice.sentence.contains("overhead"), "{}", notice.sentence);
    run.walk(40, &[forward(1.0)]);
    let behind = run.state.agents[id];
    assert!(behind.position.z < 3.4, "{}", behind.position);
    assert!((behind.height_m() - 1.5).abs() < 1e-6 && run.world.delayed_outcomes().is_empty());
    // Standing again, it does not come back.
    run.walk(80, &[forward(-1.0)]);
    assert!(run.state.agents[id].position.z < 3.4);
}

/// The capsule that others collide with is as low as the agent.
#[test]
fn what_hangs_above_a_crouched_agent_is_hit_when_it_stands_in_the_way() {
    for (crouch, hit) in [(true, false), (false, true)] {
        let mut build = Build::room([4.0, 3.0, 8.0]);
        let ball = build.movable("ball", Piece::ball(0.1, Vec3::new(2.0, 1.2, 5.0)));
        let mut run = build.run();
        run.agent(Vec3::new(2.0, 0.0, 4.0), 0.0);
        let control = AgentControl {
            crouch,
            ..AgentControl::default()
        };
        run.walk(2, &[control]);
        let mut crossed = false;
        run.throw(ball, Vec3::new(0.0, 1.0, -6.0));
        for _ in 0..8 {
            run.walk(1, &[control]);
            crossed |= run.position(ball).z < 3.5;
        }
        assert_eq!(crossed, !hit, "crouched: {crouch}");
    }
}

/// The moment of a snapshot may be one in which an agent crouches.
#[test]
fn a_crouched_agent_continues_bit_for_bit_from_a_snapshot() {
    let mut build = Build::room([4.0, 3.0, 8.0]);
    build.movable(
        "box",
        Piece::cuboid(Vec3::splat(0.1), Vec3::new(2.0, 0.1, 4.0)).density(100.0),
    );
    let mut run = build.run();
    run.agent(Vec3::new(2.0, 0.0, 5.0), 0.0);
    run.walk(11, &[crouched(0.8)]);
    let (state, bytes) = (run.state.clone(), run.world.snapshot());
    let mut other = run.clone();
    for step in 0..30 {
        run.walk(
            1,
            &[if step < 15 {
                crouched(0.8)
            } else {
                forward(0.5)
            }],
        );
    }
    other.state = state;
    other.world.restore(&mut other.state, &bytes).unwrap();
    for step in 0..30 {
        other.walk(
            1,
            &[if step < 15 {
                crouched(0.8)
            } else {
                forward(0.5)
            }],
        );
    }
    assert!(run.hash() == other.hash());
}

/// A plane tilted by `angle` whose surface passes through `through`.
fn ramp(angle: f32, through: Vec3) -> Piece {
    let turn = Quat::from_rotation_x(angle);
    let up = turn * Vec3::Y;
    Piece::cuboid(Vec3::new(2.0, 0.1, 6.0), through - up * 0.1).turned(turn)
}

/// Beyond the steepest slope that feet hold, an agent slides like a block with that friction:
/// `s = g (sin a - tan(a_max) cos a) t^2 / 2`.
#[test]
fn on_a_slope_too_steep_it_slides_as_a_block_and_on_a_gentler_one_it_stands() {
    for angle in [0.3_f32, 0.7, 0.9, 1.1] {
        let mut build = Build::room([4.0, 12.0, 14.0]);
        build.fixed("ramp", ramp(angle, Vec3::new(2.0, 6.0, 7.0)));
        let mut run = build.run();
        // The foot, a ball of half the body's radius, touches the slope beside its middle.
        let foot = 0.1 * (1.0 / angle.cos() - 1.0);
        let start = Vec3::new(2.0, 6.0 + foot, 7.0);
        let id = run.agent(start, 0.0);
        run.steps(20);
        let moved = run.state.agents[id].position - start;
        let limit = AgentBody::default().max_slope_rad;
        if angle < limit {
            assert!(moved.length() < 2e-3, "{angle}: {moved}");
        } else {
            let along = gravity() * (angle.sin() - limit.tan() * angle.cos());
            // One step of 1/120 s late: it is seen to be steep at the end of the first.
            let expected = 0.5 * along * (1.0_f32 - 1.0 / 120.0).powi(2);
            assert!(
                (moved.length() / expected - 1.0).abs() < 0.02,
                "{angle}: {moved}, {expected} m"
            );
            assert!(
                (moved.y / moved.length() + angle.sin()).abs() < 0.02,
                "{angle}: {moved}"
            );
        }
    }
}

/// At the foot of the slope the slide ends under the same friction: `v^2 / (2 g tan(a_max))` on the level.
#[test]
fn it_comes_to_rest_below_the_slope_and_can_walk_again() {
    let mut build = Build::room([4.0, 12.0, 30.0]);
    build.fixed("ramp", ramp(1.0, Vec3::new(2.0, 3.0, 8.0)));
    let mut run = build.run();
    let id = run.agent(Vec3::new(2.0, 3.1, 8.0), 0.0);
    run.steps(60);
    let rest = run.state.agents[id];
    assert!(
        rest.position.y < 0.01 && rest.velocity.length() < 1e-6,
        "{}",
        rest.position
    );
    run.steps(20);
    assert_eq!(run.state.agents[id].position, rest.position);
    run.walk(20, &[forward(-1.0)]);
    let walked = run.state.agents[id].position - rest.position;
    assert!((walked.length() - 1.0).abs() < 1e-2, "{walked}");
}
