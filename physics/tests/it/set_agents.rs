//! Setting agents and robots of URDF to any pose and velocity.

use crate::arms::awake;
use crate::common::{Build, Piece, Run, gravity};
use dwell_houses::{open_robot, with_robot};
use dwell_physics::{AgentControl, AgentPlacement, BodyState, JointState, PhysicsConfig};
use dwell_scene::random::RandomKey;
use dwell_scene::{
    AgentBody, AgentId, DifferentialDrive, HolonomicBase, Id, JointId, JointKind, Locomotion,
    Mobility, ObjectId, PartId, Pose, Velocity,
};
use glam::{DVec3, Quat, Vec3};
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Arc;

const RESETS: u64 = 10_000;

fn unit(key: RandomKey) -> f32 {
    2.0 * key.stream().uniform_f32() - 1.0
}

fn vector(key: RandomKey, size: f32) -> Vec3 {
    Vec3::from_array([0, 1, 2].map(|k| size * unit(key.child(k))))
}

fn agent_of(run: &mut Run, locomotion: Locomotion, x: f32) -> AgentId {
    let body = AgentBody {
        locomotion,
        ..AgentBody::default()
    };
    run.agent_with(body, Vec3::new(x, 0.0, 4.0), 0.0)
}

fn wheels() -> Locomotion {
    Locomotion::DifferentialDrive(DifferentialDrive::default())
}

/// A room with an agent on legs, one on two wheels and one on a holonomic base.
fn one_of_each() -> (Run, [AgentId; 3]) {
    let mut run = Build::room([8.0, 3.0, 8.0]).run();
    let legs = agent_of(&mut run, Locomotion::default(), 2.0);
    let drive = agent_of(&mut run, wheels(), 4.0);
    let base = agent_of(
        &mut run,
        Locomotion::Holonomic(HolonomicBase::default()),
        6.0,
    );
    (run, [legs, drive, base])
}

/// Issue 3 for agents: 10,000 poses and velocities of legs, of two wheels and of a holonomic base, each with all values of
/// its body, are read back; and once in a while followed by a normal step.
#[test]
fn any_pose_and_velocity_of_an_agent_reads_back() {
    let (mut run, [legs, drive, base]) = one_of_each();
    let mut worst = 0.0_f32;
    for round in 0..RESETS {
        let key = RandomKey::root(41).child(round);
        let place = |agent: AgentId| {
            let key = key.child(u64::from(agent.0) + 100);
            AgentPlacement {
                pitch_rad: 1.5 * unit(key.child("pitch")),
                yaw_rate_rad_s: 2.0 * unit(key.child("rate")),
                ..AgentPlacement::at_rest(
                    agent,
                    Vec3::new(4.0, 1.4, 4.0) + vector(key.child("at"), 1.3),
                    3.1 * unit(key.child("yaw")),
                )
            }
        };
        let walking = AgentPlacement {
            velocity: vector(key.child("v"), 20.0),
            crouched_by_m: 0.55 * (1.0 + unit(key.child("low"))),
            ..place(legs)
        };
        let rates = [0, 1].map(|side| 20.0 * unit(key.child("w").child(side)));
        let rolling = AgentPlacement {
            wheel_rad_s: Some(rates),
            yaw_rate_rad_s: 0.0,
            ..place(drive)
        };
        let gliding = AgentPlacement {
            velocity: vector(key.child("g"), 0.7).with_y(0.0),
            ..place(base)
        };
        let all = [walking, rolling, gliding];
        run.world.set_agents(&mut run.state, &all).unwrap();
        for set in &all {
            let now = &run.state.agents[set.agent];
            let mut off = vec![
                (now.position - set.position).abs().max_element(),
                (now.yaw_rad - set.yaw_rad).abs(),
                (now.pitch_rad - set.pitch_rad).abs(),
                (now.crouched_by_m - set.crouched_by_m).abs(),
            ];
            if set.wheel_rad_s.is_none() {
                off.push((now.velocity - set.velocity).abs().max_element());
                off.push((now.gyro_rad_s - set.yaw_rate_rad_s).abs());
            }
            worst = off.into_iter().fold(worst, f32::max);
        }
        let wheel = run.state.agents[drive].base.wheel_rad_s;
        assert_eq!(wheel, rates, "{round}");
        // Two wheels by hand: (r_l w_l + r_r w_r) / 2 ahead, their difference over the base to the left.
        let ahead = 0.05 * 0.5 * (rates[0] + rates[1]);
        let forward = dwell_scene::space::forward_from_yaw(rolling.yaw_rad);
        let now = &run.state.agents[drive];
        assert!((now.velocity - forward * ahead).length() < 1e-5, "{round}");
        let turn = 0.05 * (rates[1] - rates[0]) / 0.3;
        assert!((now.gyro_rad_s - turn).abs() < 1e-5, "{round}");
        let twist = run.state.agents[base].base.twist;
        let level = (twist[0].powi(2) + twist[1].powi(2)).sqrt();
        assert!((level - gliding.velocity.length()).abs() < 1e-5);
        assert_eq!(twist[2], gliding.yaw_rate_rad_s);
        if round % 500 == 0 {
            run.walk(3, &[]);
            let finite = run
                .state
                .agents
                .iter()
                .all(|agent| agent.position.is_finite());
            assert!(finite, "{round}");
        }
    }
    println!("agents: worst {worst:.1e}");
    assert!(worst <= 1e-6, "{worst}");
}

/// The same for a robot of a URDF file that stands free: base and joints.
#[test]
fn any_pose_and_velocity_of_a_urdf_robot_reads_back() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it/robots/gripper.urdf");
    let (robot, _) = open_robot(&path).unwrap();
    let house = Build::room([4.0, 3.0, 8.0]).house();
    let stands = Pose::from_position(Vec3::new(2.0, 0.0, 7.0));
    let house = with_robot(&house, &robot, "gantry", stands, false).unwrap();
    let mut run = Run::over(Arc::new(house), awake());
    let root = run.root(ObjectId(0));
    let followed: Vec<bool> = run
        .house
        .joints
        .iter()
        .map(|joint| joint.mimic.is_some())
        .collect();
    let (mut by_engine, mut joints_off) = ([0.0_f32; 4], [0.0_f32; 2]);
    let mut by_poses = [0.0_f64; 2];
    for round in 0..RESETS {
        let key = RandomKey::root(42).child(round);
        let joints: Vec<JointState> = run
            .house
            .joints
            .iter_ids()
            .filter(|(id, _)| !followed[id.index()])
            .map(|(joint, articulation)| {
                let [low, high] = articulation.limits.unwrap();
                let share = 0.5 + 0.499 * unit(key.child("q").child(u64::from(joint.0)));
                JointState {
                    joint,
                    position: low + share * (high - low),
                    velocity: unit(key.child("v").child(u64::from(joint.0))),
                }
            })
            .collect();
        let [x, y, z, w] = [0, 1, 2, 3].map(|k| unit(key.child("turn").child(k)));
        let body = BodyState {
            part: root,
            pose: Pose::new(
                Vec3::new(2.0, 1.5, 4.0) + vector(key.child("at"), 0.8),
                Quat::from_xyzw(x, y, z, w + 0.01).normalize(),
            ),
            velocity: Velocity {
                linear: vector(key.child("linear"), 5.0),
                angular: vector(key.child("angular"), 5.0),
            },
        };
        run.world.set_joints(&mut run.state, &joints).unwrap();
        run.world.set_bodies(&mut run.state, &[body]).unwrap();
        assert_eq!(run.state.part_pose[root], body.pose, "{round}");
        assert_eq!(run.state.part_velocity[root], body.velocity, "{round}");
        let there = run.world.body_state(root).unwrap();
        for (worst, found) in by_engine.iter_mut().zip([
            (there.pose.position - body.pose.position)
                .abs()
                .max_element(),
            (there.pose.rotation - body.pose.rotation).length(),
            (there.velocity.linear - body.velocity.linear)
                .abs()
                .max_element(),
            (there.velocity.angular - body.velocity.angular)
                .abs()
                .max_element(),
        ]) {
            *worst = worst.max(found);
        }
        for set in &joints {
            let kept = (
                run.state.joint_position[set.joint],
                run.state.joint_velocity[set.joint],
            );
            assert_eq!(kept, (set.position, set.velocity), "{round}");
            let (q, v) = run.world.joint_kinematics(&run.state, set.joint).unwrap();
            joints_off[0] = joints_off[0].max((q - set.position).abs());
            joints_off[1] = joints_off[1].max((v - set.velocity).abs());
            let [q, v] = by_parts(&run, set.joint);
            by_poses[0] = by_poses[0].max((q - f64::from(set.position)).abs());
            by_poses[1] = by_poses[1].max((v - f64::from(set.velocity)).abs());
        }
    }
    println!("URDF base {by_engine:?}, joints {joints_off:?}");
    assert!(
        by_engine.iter().all(|worst| *worst <= 1e-6),
        "{by_engine:?}"
    );
    assert_eq!(joints_off, [0.0; 2]);
    // Slides of bodies are differences of places up to 5 m and of speeds up to 20 m/s, in f32: 5e-7 m and 2e-6 m/s each, some
    // times over.
    println!("as poses and velocities in the world have them {by_poses:?}");
    assert!(by_poses[0] <= 5e-6 && by_poses[1] <= 2e-5, "{by_poses:?}");
}

/// Returns where a joint stands and how it moves by the poses and velocities of its two parts, rad or m and per second.
fn by_parts(run: &Run, joint: JointId) -> [f64; 2] {
    let joint = &run.house.joints[joint];
    let parent = joint.parent.unwrap();
    let frame = |part: PartId, place: &Pose| {
        let pose = run.state.part_pose[part];
        let turn = pose.rotation.as_dquat().normalize();
        let at = pose.position.as_dvec3() + turn * place.position.as_dvec3();
        (at, turn * place.rotation.as_dquat().normalize())
    };
    let moves = |part: PartId, at: DVec3| {
        let velocity = run.state.part_velocity[part];
        let arm = at - run.state.part_pose[part].position.as_dvec3();
        let spin = velocity.angular.as_dvec3();
        (velocity.linear.as_dvec3() + spin.cross(arm), spin)
    };
    let (from, from_turn) = frame(parent, &joint.parent_from_joint);
    let (to, to_turn) = frame(joint.child, &joint.child_from_joint);
    let own = joint.axis.as_dvec3().normalize();
    let axis = from_turn * own;
    let [before, after] = [parent, joint.child].map(|part| moves(part, from));
    match joint.kind {
        JointKind::Slide => [(to - from).dot(axis), (after.0 - before.0).dot(axis)],
        JointKind::Hinge => {
            let turn = from_turn.inverse() * to_turn;
            let angle = 2.0 * turn.xyz().dot(own).atan2(turn.w);
            let angle = angle - TAU * (angle / TAU).round();
            [angle, (after.1 - before.1).dot(axis)]
        }
    }
}

/// A drawer 40 m from the origin, where its pose in f32 is coarse to 4e-6 m, is set to any position and speed, and follows
/// them exactly a step later: it moves by its own coordinates.
#[test]
fn a_slide_goes_on_from_the_very_numbers_it_is_put_to() {
    let mut build = Build::room([44.0, 3.0, 44.0]);
    let drawer = Piece::cuboid(Vec3::splat(0.1), Vec3::new(41.0, 1.3, 40.7));
    let chest = build.object("chest", Mobility::Articulated, &[drawer]);
    let axis = Vec3::new(0.6, 0.0, 0.8);
    let at = Vec3::new(41.0, 1.3, 40.7);
    let joint = build.joint(chest, JointKind::Slide, axis, at, [-0.5, 0.5]);
    let data = &mut build.data.joints[joint];
    (data.friction, data.damping) = (0.0, 0.0);
    let mut run = build.run_with(PhysicsConfig {
        latches: false,
        ..awake()
    });
    let (mut worst, mut coarse) = ([0.0_f64; 2], 0.0_f64);
    for round in 0..1000 {
        let key = RandomKey::root(43).child(round);
        let set = JointState {
            joint,
            position: 0.4 * unit(key.child("q")),
            velocity: {
                // What goes less than 1e-5 m a step is left to bodies.
                let way = unit(key.child("v"));
                0.01 * way.signum() + 0.5 * way
            },
        };
        run.world.set_joints(&mut run.state, &[set]).unwrap();
        assert_eq!(
            run.world.joint_kinematics(&run.state, joint),
            Some((set.position, set.velocity))
        );
        let leaf = run.house.joints[joint].child;
        let pose = run.state.part_pose[leaf].position.as_dvec3() - at.as_dvec3();
        coarse = coarse.max((pose.dot(axis.as_dvec3()) - f64::from(set.position)).abs());
        run.steps(1);
        let expected = f64::from(set.position) + 0.05 * f64::from(set.velocity);
        let found = f64::from(run.state.joint_position[joint]);
        worst[0] = worst[0].max((found - expected).abs());
        let found = f64::from(run.state.joint_velocity[joint]);
        worst[1] = worst[1].max((found - f64::from(set.velocity)).abs());
    }
    println!("a step later {worst:?}, poses {coarse:.1e}");
    assert!(worst[0] < 1e-6 && worst[1] < 1e-6, "{worst:?}");
    assert!(coarse > 1e-6, "{coarse}");
}

/// An agent thrown with a velocity follows its parabola until it lands, whatever its legs are commanded then.
#[test]
fn a_thrown_agent_flies() {
    let mut run = Build::room([20.0, 12.0, 6.0]).run();
    let agent = run.agent(Vec3::new(3.0, 0.0, 3.0), 0.0);
    let (up, along) = (6.0_f32, 2.0_f32);
    let start = Vec3::new(3.0, 1.0, 3.0);
    let thrown = AgentPlacement {
        velocity: Vec3::new(along, up, 0.0),
        ..AgentPlacement::at_rest(agent, start, 0.0)
    };
    run.world.set_agents(&mut run.state, &[thrown]).unwrap();
    for k in 1..=20 {
        run.steps(1);
        let t = k as f32 / 20.0;
        let y = start.y + up * t - 0.5 * gravity() * t * t;
        let now = run.state.agents[agent].position;
        // Falls are stepped with the speed at the end of each physics step: g t / 240 low at most.
        let late = gravity() * t / 240.0 + 2e-3;
        assert!((now.y - y).abs() < late, "{t}: {} {y}", now.y);
        assert!((now.x - start.x - along * t).abs() < 2e-3, "{t}: {}", now.x);
    }
    run.steps(60);
    let rests = run.state.agents[agent];
    assert!(rests.grounded && rests.velocity.length() < 1e-5 && rests.position.y.abs() < 1e-3);
    // A ceiling ends a rise.
    let thrown = AgentPlacement {
        velocity: Vec3::Y * 25.0,
        ..AgentPlacement::at_rest(agent, Vec3::new(3.0, 9.0, 3.0), 0.0)
    };
    run.world.set_agents(&mut run.state, &[thrown]).unwrap();
    let mut highest = 0.0_f32;
    for _ in 0..60 {
        run.steps(1);
        highest = highest.max(run.state.agents[agent].position.y);
    }
    assert!(
        highest < 12.0 - 1.5 && highest > 12.0 - 1.5 - 0.05,
        "{highest}"
    );
}

/// Feet brake a slide with the friction of the steepest slope they hold on: `v2 / (2 g tan a)`.
#[test]
fn a_slide_on_the_level_is_braked_by_feet() {
    let mut run = Build::room([20.0, 3.0, 6.0]).run();
    let agent = run.agent(Vec3::new(3.0, 0.0, 3.0), 0.0);
    let slid = AgentPlacement {
        velocity: Vec3::X * 4.0,
        ..AgentPlacement::at_rest(agent, Vec3::new(3.0, 0.0, 3.0), 0.0)
    };
    run.world.set_agents(&mut run.state, &[slid]).unwrap();
    run.steps(40);
    let way = run.state.agents[agent].position.x - 3.0;
    let expected = 16.0 / (2.0 * gravity() * 0.785_f32.tan());
    assert!((way / expected - 1.0).abs() < 0.05, "{way} {expected}");
}

/// Wheels that turn keep turning: a base that is put down on the move goes on without a jolt.
#[test]
fn wheels_go_on_from_the_speed_they_are_given() {
    let mut run = Build::room([20.0, 3.0, 20.0]).run();
    let agent = agent_of(&mut run, wheels(), 10.0);
    let at = AgentPlacement::at_rest(agent, Vec3::new(10.0, 0.0, 10.0), 0.0);
    let told = AgentControl {
        wheel_rad_s: Some([8.0, 12.0]),
        ..AgentControl::default()
    };
    let mut ways = Vec::new();
    for set in [
        AgentPlacement {
            wheel_rad_s: Some([8.0, 12.0]),
            ..at
        },
        AgentPlacement {
            velocity: Vec3::NEG_Z * 0.5,
            yaw_rate_rad_s: 0.2 / 0.3,
            ..at
        },
    ] {
        run.world.set_agents(&mut run.state, &[set]).unwrap();
        run.walk(20, &[told]);
        ways.push(run.state.agents[agent]);
    }
    assert!((ways[0].position - ways[1].position).length() < 1e-4);
    // A second on a circle of v / omega.
    let (radius, turn) = (0.5 * 0.3 / 0.2_f32, 0.2 / 0.3_f32);
    assert!((ways[0].yaw_rad - turn).abs() < 1e-4, "{}", ways[0].yaw_rad);
    let chord = 2.0 * radius * (0.5 * turn).sin();
    let found = (ways[0].position - at.position).length();
    assert!((found - chord).abs() < 1e-3, "{found} {chord}");
}

#[test]
fn what_a_body_cannot_have_is_refused_and_changes_nothing() {
    let (mut run, [legs, drive, base]) = one_of_each();
    let before = run.hash();
    let at = |agent| AgentPlacement::at_rest(agent, Vec3::new(3.0, 0.0, 3.0), 0.0);
    let fast = Vec3::X * 31.0;
    for (bad, part) in [
        (at(AgentId(9)), "no agent 9"),
        (
            AgentPlacement {
                position: Vec3::NAN,
                ..at(legs)
            },
            "position",
        ),
        (
            AgentPlacement {
                yaw_rad: f32::INFINITY,
                ..at(legs)
            },
            "yaw_rad",
        ),
        (
            AgentPlacement {
                pitch_rad: 1.6,
                ..at(legs)
            },
            "-1.5 to 1.5",
        ),
        (
            AgentPlacement {
                velocity: fast,
                ..at(legs)
            },
            "30 m/s",
        ),
        (
            AgentPlacement {
                yaw_rate_rad_s: 101.0,
                ..at(legs)
            },
            "100 rad/s",
        ),
        (
            AgentPlacement {
                crouched_by_m: 1.2,
                ..at(legs)
            },
            "twice the radius",
        ),
        (
            AgentPlacement {
                crouched_by_m: 0.2,
                ..at(drive)
            },
            "no legs",
        ),
        (
            AgentPlacement {
                wheel_rad_s: Some([1.0; 2]),
                ..at(legs)
            },
            "no such wheels",
        ),
        (
            AgentPlacement {
                wheel_rad_s: Some([21.0, 0.0]),
                ..at(drive)
            },
            "up to 20",
        ),
        (
            AgentPlacement {
                wheel_rad_s: Some([f32::NAN; 2]),
                ..at(drive)
            },
            "up to 20",
        ),
        (
            AgentPlacement {
                velocity: Vec3::NEG_Z * 1.1,
                ..at(drive)
            },
            "up to 20",
        ),
        (
            AgentPlacement {
                wheel_rad_s: Some([1.0; 2]),
                velocity: Vec3::X,
                ..at(drive)
            },
            "not both",
        ),
        (
            AgentPlacement {
                velocity: Vec3::NEG_Z * 1.1,
                ..at(base)
            },
            "limits allow",
        ),
    ] {
        // One bad row behind a good one: neither is taken.
        let refused = run.world.set_agents(&mut run.state, &[at(legs), bad]);
        let message = refused.unwrap_err().to_string();
        assert!(message.contains(part), "{part}: {message}");
        assert!(run.hash() == before, "{part}");
    }
}
