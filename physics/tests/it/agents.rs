//! Agents: walls, steps, falls, pushes.

use crate::common::{Build, Piece, forward, gravity};
use dwell_physics::AgentControl;
use dwell_scene::AgentBody;
use glam::{Quat, Vec3};
use proptest::prelude::*;
use std::f32::consts::{FRAC_PI_2, PI};

#[test]
fn an_agent_walks_and_turns_as_told() {
    let mut run = Build::room([10.0, 3.0, 10.0]).run();
    let id = run.agent(Vec3::new(5.0, 0.0, 5.0), 0.0);
    run.walk(
        20,
        &[AgentControl {
            forward_m_s: 1.0,
            right_m_s: 0.5,
            ..AgentControl::default()
        }],
    );
    let agent = run.state.agents[id];
    assert!(
        (agent.position - Vec3::new(5.5, 0.0, 4.0)).length() < 1e-3,
        "{}",
        agent.position
    );
    assert!(agent.grounded && !agent.collided);
    assert!((agent.velocity - Vec3::new(0.5, 0.0, -1.0)).length() < 1e-3);
    run.walk(
        10,
        &[AgentControl {
            yaw_rate_rad_s: PI,
            pitch_rate_rad_s: -0.5,
            ..AgentControl::default()
        }],
    );
    let agent = run.state.agents[id];
    assert!((agent.yaw_rad - FRAC_PI_2).abs() < 1e-4 && (agent.pitch_rad + 0.25).abs() < 1e-4);
    run.walk(10, &[forward(1.0)]);
    assert!((run.state.agents[id].position - Vec3::new(5.0, 0.0, 4.0)).length() < 1e-3);
}

#[test]
fn it_climbs_a_step_of_20_cm_and_not_one_of_30() {
    for (height, climbs) in [(0.05, true), (0.1, true), (0.2, true), (0.3, false)] {
        for speed in [0.5, 1.0, 4.0] {
            let mut build = Build::room([4.0, 3.0, 8.0]);
            build.fixed(
                "step",
                Piece::cuboid(
                    Vec3::new(2.0, height * 0.5, 1.5),
                    Vec3::new(2.0, height * 0.5, 2.5),
                ),
            );
            let mut run = build.run();
            let id = run.agent(Vec3::new(2.0, 0.0, 6.0), 0.0);
            run.walk((3.5 / speed * 20.0) as usize, &[forward(speed)]);
            let at = run.state.agents[id].position;
            let up = (at.y - height).abs() < 0.01;
            assert_eq!(up, climbs, "step {height} m at {speed} m/s: at {at}");
            if !climbs {
                assert!(at.z > 4.0 && at.y < 0.01, "{at}");
                assert!(run.state.agents[id].collided);
            }
        }
    }
}

#[test]
fn it_climbs_stairs_and_comes_down_again() {
    let mut build = Build::room([4.0, 4.0, 12.0]);
    for k in 0..5 {
        let height = 0.18 * (k + 1) as f32;
        let far = 7.0 - 0.28 * k as f32;
        let near = 3.0 + 0.28 * k as f32;
        build.fixed(
            &format!("stair_{k}"),
            Piece::cuboid(
                Vec3::new(1.0, height * 0.5, (far - near) * 0.5),
                Vec3::new(2.0, height * 0.5, (far + near) * 0.5),
            ),
        );
    }
    let mut run = build.run();
    let id = run.agent(Vec3::new(2.0, 0.0, 9.0), 0.0);
    run.walk(80, &[forward(1.0)]);
    let top = run.state.agents[id].position;
    assert!((top.y - 0.9).abs() < 0.02, "{top}");
    run.walk(60, &[forward(1.0)]);
    let end = run.state.agents[id].position;
    assert!(end.z < 2.9 && end.y < 0.01, "{end}");
}

#[test]
fn it_slides_along_a_wall() {
    let mut run = Build::room([10.0, 3.0, 10.0]).run();
    let id = run.agent(Vec3::new(1.0, 0.0, 5.0), PI / 4.0);
    run.walk(60, &[forward(1.0)]);
    let agent = run.state.agents[id];
    // Three seconds at 1 m/s: along the wall x = 0 it makes the cosine of the way.
    assert!((agent.position.x - 0.2).abs() < 0.02, "{}", agent.position);
    assert!(
        (agent.position.z - (5.0 - 3.0 * (PI / 4.0).cos())).abs() < 0.1,
        "{}",
        agent.position
    );
    assert!(agent.collided);
}

#[test]
fn it_walks_up_a_gentle_slope_and_not_a_steep_one() {
    for (angle, climbs) in [(0.4_f32, true), (1.0, false)] {
        let mut build = Build::room([4.0, 4.0, 10.0]);
        let turn = Quat::from_rotation_x(angle);
        let half = Vec3::new(2.0, 0.1, 2.0);
        let at = Vec3::new(2.0, 2.0 * angle.sin() - 0.1 * angle.cos(), 4.0);
        build.fixed("ramp", Piece::cuboid(half, at).turned(turn));
        let mut run = build.run();
        let id = run.agent(Vec3::new(2.0, 0.0, 7.0), 0.0);
        run.walk(70, &[forward(1.0)]);
        let y = run.state.agents[id].position.y;
        assert_eq!(
            y > 0.5,
            climbs,
            "{angle} rad: {}",
            run.state.agents[id].position
        );
    }
}

/// Off a table of 1 m it falls sqrt(2 h / g) seconds.
#[test]
fn it_falls_from_a_table() {
    let mut build = Build::room([6.0, 4.0, 6.0]);
    build.fixed(
        "table",
        Piece::cuboid(Vec3::new(1.0, 0.5, 1.0), Vec3::new(3.0, 0.5, 4.0)),
    );
    let mut run = build.run();
    let id = run.agent(Vec3::new(3.0, 1.0, 4.0), 0.0);
    run.steps(10);
    assert!(
        (run.state.agents[id].position.y - 1.0).abs() < 1e-3,
        "it stands on the table"
    );
    let mut left = None;
    let mut landed = None;
    for step in 0..80 {
        run.walk(1, &[forward(1.0)]);
        let agent = run.state.agents[id];
        if !agent.grounded && left.is_none() {
            left = Some(step);
        }
        if left.is_some() && agent.grounded && landed.is_none() {
            landed = Some(step);
        }
    }
    let seconds = (landed.unwrap() - left.unwrap()) as f32 / 20.0;
    let expected = (2.0 / gravity()).sqrt();
    assert!(
        (seconds - expected).abs() < 0.08,
        "{seconds} s, expected {expected} s"
    );
    assert!(run.state.agents[id].position.y.abs() < 1e-3);
}

/// Whatever the speed and the highest step, an agent does not stay hanging on an edge.
#[test]
fn it_comes_off_a_table_at_any_speed() {
    for (speed, step_height_m) in [(0.1, 0.2), (0.1, 0.02), (1.0, 0.02), (1.0, 0.0), (0.3, 0.1)] {
        let mut build = Build::room([6.0, 4.0, 6.0]);
        build.fixed(
            "table",
            Piece::cuboid(Vec3::new(1.0, 0.5, 1.0), Vec3::new(3.0, 0.5, 4.0)),
        );
        let mut run = build.run();
        let body = AgentBody {
            step_height_m,
            ..AgentBody::default()
        };
        let id = run.agent_with(body, Vec3::new(3.0, 1.0, 3.1), 0.0);
        run.walk((0.6 / speed * 20.0) as usize, &[forward(speed)]);
        run.steps(20);
        let at = run.state.agents[id].position;
        assert!(
            at.y < 0.01 && at.z < 2.81,
            "{speed} m/s, step {step_height_m} m: {at}"
        );
    }
}

#[test]
fn it_pushes_a_light_box_and_not_a_heavy_one() {
    for (density, moves) in [(100.0, true), (20_000.0, false)] {
        let mut build = Build::room([4.0, 3.0, 10.0]);
        let at = Vec3::new(2.0, 0.2, 5.0);
        let thing = build.movable("box", Piece::cuboid(Vec3::splat(0.2), at).density(density));
        let mut run = build.run();
        let id = run.agent(Vec3::new(2.0, 0.0, 6.5), 0.0);
        run.walk(60, &[forward(1.0)]);
        let moved = at.z - run.position(thing).z;
        let agent = run.state.agents[id].position;
        assert_eq!(moved > 0.5, moves, "{density} kg/m3 moved by {moved} m");
        // Never through it.
        assert!(
            agent.z > run.position(thing).z + 0.3,
            "{agent} {}",
            run.position(thing)
        );
    }
}

/// A light box against a wall stops the agent; neither passes.
#[test]
fn it_squeezes_nothing_through_a_wall() {
    let mut build = Build::room([4.0, 3.0, 6.0]);
    let thing = build.movable(
        "box",
        Piece::cuboid(Vec3::new(0.3, 0.3, 0.2), Vec3::new(2.0, 0.3, 1.0)).density(50.0),
    );
    let mut run = build.run();
    let id = run.agent(Vec3::new(2.0, 0.0, 3.0), 0.0);
    run.walk(120, &[forward(2.0)]);
    let (agent, thing) = (run.state.agents[id].position, run.position(thing));
    assert!(thing.z > 0.15 && thing.z < 0.4, "{thing}");
    assert!(agent.z > thing.z + 0.3, "{agent} {thing}");
}

#[test]
fn agents_do_not_pass_each_other() {
    let mut build = Build::room([10.0, 3.0, 4.0]);
    build.fixed(
        "side_a",
        Piece::cuboid(Vec3::new(5.0, 1.0, 0.8), Vec3::new(5.0, 1.0, 0.8)),
    );
    build.fixed(
        "side_b",
        Piece::cuboid(Vec3::new(5.0, 1.0, 0.9), Vec3::new(5.0, 1.0, 3.1)),
    );
    let mut run = build.run();
    let a = run.agent(Vec3::new(2.0, 0.0, 1.9), -FRAC_PI_2);
    let b = run.agent(Vec3::new(8.0, 0.0, 1.9), FRAC_PI_2);
    run.walk(100, &[forward(3.0), forward(3.0)]);
    let (a, b) = (run.state.agents[a], run.state.agents[b]);
    let gap = b.position.x - a.position.x;
    assert!(gap > 0.39 && gap < 0.5, "{} {}", a.position, b.position);
    assert!(a.collided && b.collided);
}

#[test]
fn wrong_controls_are_refused_and_nothing_happens() {
    let mut run = Build::room([4.0, 3.0, 4.0]).run();
    run.agent(Vec3::new(2.0, 0.0, 2.0), 0.0);
    let before = run.hash();
    let mut events = Vec::new();
    assert!(
        run.world
            .step(&mut run.state, &[forward(f32::NAN)], &mut events)
            .is_err()
    );
    assert!(
        run.world
            .step(&mut run.state, &[forward(1.0); 2], &mut events)
            .is_err()
    );
    assert!(before == run.hash());
}

/// Thin walls (single sheets and boxes) in a room: corridors, wedges, and a closed door.
fn maze() -> Build {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    build.wall_with_door(3.0, 6.0);
    let sheet = |x: f32, z: f32, half: f32, turn: f32| {
        Piece::cuboid(Vec3::new(half, 1.0, 0.002), Vec3::new(x, 1.0, z))
            .turned(Quat::from_rotation_y(turn))
    };
    build.fixed("wedge_a", sheet(4.5, 4.5, 0.8, 0.4));
    build.fixed("wedge_b", sheet(4.5, 5.2, 0.8, -0.3));
    build.fixed(
        "post",
        Piece::cuboid(Vec3::new(0.03, 1.0, 0.03), Vec3::new(1.5, 1.0, 4.5)),
    );
    build
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// From the southern half of the maze, whatever it does, an agent never gets to the northern half or outside: the wall
    /// at z = 3 has a closed door, and speeds go up to 60 m/s (0.5 m in a physics step).
    #[test]
    fn no_wall_is_ever_passed(
        x in 0.4_f32..5.6,
        z in 3.4_f32..4.0,
        moves in proptest::collection::vec((-PI..PI, prop_oneof![0.2_f32..3.0, 3.0_f32..60.0], 1_usize..12), 3..10),
    ) {
        let mut run = maze().run();
        let id = run.agent(Vec3::new(x, 0.0, z), 0.0);
        for (turn, speed, steps) in moves {
            run.walk(1, &[AgentControl { yaw_rate_rad_s: turn * 20.0, ..AgentControl::default() }]);
            for _ in 0..steps {
                run.walk(1, &[forward(speed)]);
                let at = run.state.agents[id].position;
                prop_assert!(at.z > 3.02 + 0.19 && at.z < 6.0 - 0.19, "{at}");
                prop_assert!(at.x > 0.19 && at.x < 6.0 - 0.19, "{at}");
                prop_assert!(at.y > -0.01 && at.y < 0.02, "{at}");
            }
        }
    }
}
