//! State that is set from outside: any pose and velocity, or a refusal with its reason.

use crate::arms::{STRONG, arm, arm_on};
use crate::common::{Build, Piece, Run};
use dwell_physics::{AgentControl, BodyState, Grasp, JointState, PhysicsConfig, Target, actions};
use dwell_scene::random::RandomKey;
use dwell_scene::{Collider, JointId, Mobility, ObjectId, PartId, Pose, Velocity};
use glam::{Quat, Vec3};

const RESETS: u64 = 10_000;

fn unit(key: RandomKey) -> f32 {
    2.0 * key.stream().uniform_f32() - 1.0
}

fn vector(key: RandomKey, size: f32) -> Vec3 {
    Vec3::from_array([0, 1, 2].map(|k| size * unit(key.child(k))))
}

/// Any place in a room of 4 by 3 by 4 m, any rotation, up to 10 m/s and 20 rad/s along each axis.
fn any(part: PartId, key: RandomKey) -> BodyState {
    let [x, y, z, w] = [0, 1, 2, 3].map(|k| unit(key.child("turn").child(k)));
    BodyState {
        part,
        pose: Pose::new(
            Vec3::new(2.0, 1.5, 2.0) + vector(key.child("at"), 1.4),
            Quat::from_xyzw(x, y, z, w + 0.01).normalize(),
        ),
        velocity: Velocity {
            linear: vector(key.child("linear"), 10.0),
            angular: vector(key.child("angular"), 20.0),
        },
    }
}

fn apart(a: &BodyState, b: &BodyState) -> [f32; 4] {
    let turn = a.pose.rotation - b.pose.rotation;
    [
        (a.pose.position - b.pose.position).abs().max_element(),
        turn.length(),
        (a.velocity.linear - b.velocity.linear).abs().max_element(),
        (a.velocity.angular - b.velocity.angular)
            .abs()
            .max_element(),
    ]
}

fn worst(of: &mut [f32; 4], found: [f32; 4]) {
    for (worst, found) in of.iter_mut().zip(found) {
        *worst = worst.max(found);
    }
}

fn told(run: &Run, part: PartId) -> BodyState {
    BodyState {
        part,
        pose: run.state.part_pose[part],
        velocity: run.state.part_velocity[part],
    }
}

/// The origin of the object is 0.4 m from its centre of mass, so that its velocity is not that of rapier's body. The state
/// has the values that were set, bit for bit; those of rapier differ by the rounding of some 10 m/s.
#[test]
fn any_pose_and_velocity_of_a_free_body_reads_back() {
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let stick = Piece {
        collider: Collider::cuboid(Vec3::new(0.38, -0.02, -0.03), Vec3::new(0.42, 0.02, 0.03)),
        ..Piece::cuboid(Vec3::ONE, Vec3::new(2.0, 1.0, 2.0))
    };
    let object = build.movable("stick", stick);
    let mut run = build.run();
    let part = run.root(object);
    let (mut by_state, mut by_engine) = ([0.0_f32; 4], [0.0_f32; 4]);
    for round in 0..RESETS {
        let set = any(part, RandomKey::root(5).child(round));
        run.world.set_bodies(&mut run.state, &[set]).unwrap();
        worst(&mut by_state, apart(&told(&run, part), &set));
        worst(
            &mut by_engine,
            apart(&run.world.body_state(part).unwrap(), &set),
        );
    }
    println!("state {by_state:?}, engine {by_engine:?}");
    assert_eq!(by_state, [0.0; 4]);
    assert!(
        by_engine.iter().all(|worst| *worst <= 1e-6),
        "{by_engine:?}"
    );
}

/// A robot's base on the move with all its joints: base by the body, joints by their numbers.
#[test]
fn any_pose_and_velocity_of_a_robot_that_stands_free_reads_back() {
    let base = Piece::cuboid(Vec3::new(0.3, 0.2, 0.3), Vec3::new(2.0, 0.2, 2.0)).density(3000.0);
    let mut run = arm_on(Some(base), 1.0, Some(STRONG)).run();
    let root = run.root(ObjectId(0));
    let (mut by_state, mut joints_off) = ([0.0_f32; 4], [0.0_f32; 2]);
    for round in 0..RESETS {
        let key = RandomKey::root(6).child(round);
        let mut set = any(root, key);
        set.velocity.angular *= 0.25;
        let joints: Vec<JointState> = (0..6)
            .map(|k| JointState {
                joint: JointId(k),
                position: 2.9 * unit(key.child("q").child(u64::from(k))),
                velocity: 5.0 * unit(key.child("v").child(u64::from(k))),
            })
            .collect();
        run.world.set_joints(&mut run.state, &joints).unwrap();
        run.world.set_bodies(&mut run.state, &[set]).unwrap();
        worst(&mut by_state, apart(&told(&run, root), &set));
        for joint in &joints {
            let (q, v) = run.world.joint_kinematics(&run.state, joint.joint).unwrap();
            joints_off[0] = joints_off[0].max((q - joint.position).abs());
            joints_off[1] = joints_off[1].max((v - joint.velocity).abs());
            let kept = (
                run.state.joint_position[joint.joint],
                run.state.joint_velocity[joint.joint],
            );
            assert_eq!(kept, (joint.position, joint.velocity), "{round}");
        }
    }
    println!("base {by_state:?}, joints as the engine has them {joints_off:?}");
    assert_eq!(by_state, [0.0; 4]);
    assert!(joints_off[0] <= 1e-6, "{joints_off:?}");
    // The engine holds sums of up to 15 m/s and 35 rad/s along the chain, in f32.
    assert!(joints_off[1] <= 1e-6, "{joints_off:?}");
}

/// A robot at rest without motors that hold it, asleep; its joints are set where its weight then swings it.
#[test]
fn a_robot_that_sleeps_wakes_when_its_joints_are_set() {
    let mut run = arm(0.0, None).run();
    for joint in 0..6 {
        let address = format!("joint/{joint}/friction").parse().unwrap();
        let house = run.house.clone();
        run.state.set_parameter(&house, &address, 40.0).unwrap();
    }
    run.world.apply_parameters(&mut run.state).unwrap();
    run.steps(100);
    assert_eq!(run.world.awake_count(), 0);
    let set = JointState {
        joint: JointId(3),
        position: 0.5,
        velocity: 0.0,
    };
    run.world.set_joints(&mut run.state, &[set]).unwrap();
    assert!(run.world.awake_count() > 0);
    // Set to where it stands, it wakes as well.
    run.steps(100);
    assert_eq!(run.world.awake_count(), 0);
    run.world.set_joints(&mut run.state, &[set]).unwrap();
    assert!(run.world.awake_count() > 0);
}

/// A base that is moved without a turn takes its links along.
#[test]
fn links_go_where_their_base_goes() {
    let base = Piece::cuboid(Vec3::new(0.3, 0.2, 0.3), Vec3::new(1.2, 0.2, 2.0)).density(3000.0);
    let mut run = arm_on(Some(base), 0.0, Some(STRONG)).run();
    let parts: Vec<PartId> = run.house.objects[ObjectId(0)].parts().collect();
    let before: Vec<Vec3> = parts
        .iter()
        .map(|p| run.state.part_pose[*p].position)
        .collect();
    let shift = Vec3::new(0.3, 0.5, -0.4);
    let mut set = told(&run, parts[0]);
    set.pose.position += shift;
    set.velocity.linear = Vec3::X * 2.0;
    run.world.set_bodies(&mut run.state, &[set]).unwrap();
    for (part, before) in parts.iter().zip(before) {
        let now = told(&run, *part);
        assert!(
            (now.pose.position - before - shift).length() < 1e-5,
            "{part:?}"
        );
        assert!(
            (now.velocity.linear - Vec3::X * 2.0).length() < 1e-5,
            "{part:?}"
        );
    }
}

#[test]
fn what_sleeps_wakes_and_what_stood_on_it_falls() {
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let half = Vec3::splat(0.2);
    let low = build.movable("low", Piece::cuboid(half, Vec3::new(2.0, 0.2, 2.0)));
    let high = build.movable("high", Piece::cuboid(half, Vec3::new(2.0, 0.6, 2.0)));
    let mut run = build.run();
    run.steps(100);
    assert_eq!(run.world.awake_count(), 0);
    let mut set = told(&run, run.root(low));
    set.pose.position = Vec3::new(1.0, 1.0, 1.0);
    set.velocity = Velocity::default();
    run.world.set_bodies(&mut run.state, &[set]).unwrap();
    run.steps(40);
    assert!(
        (run.position(low).y - 0.2).abs() < 0.01,
        "{}",
        run.position(low)
    );
    assert!(
        (run.position(high).y - 0.2).abs() < 0.01,
        "{}",
        run.position(high)
    );
}

#[test]
fn what_cannot_be_set_is_refused_with_its_reason_and_changes_nothing() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let cube = |at: Vec3| Piece::cuboid(Vec3::splat(0.05), at);
    let free = build.movable("cube", cube(Vec3::new(2.0, 0.05, 1.4)));
    let held = build.movable("held", cube(Vec3::new(2.0, 0.05, 2.4)));
    let shelf = build.fixed("shelf", cube(Vec3::new(3.0, 0.05, 4.0)));
    // Two that share one place: neither can be freed without a way out of the wall around them.
    let block = |half: f32| Piece::cuboid(Vec3::splat(half), Vec3::new(5.0, 0.5, 5.0));
    let stuck = build.movable("stuck", block(0.3));
    build.fixed("wall", block(0.5));
    let (door, _) = build.wall_with_door(4.5, 6.0);
    let mut run = build.run();
    let agent = run.agent(Vec3::new(2.0, 0.0, 3.0), 0.0);
    let grasp = Grasp::default();
    let picked = run.act(
        agent,
        actions::Pick {
            target: Target::Object(held),
            grasp,
        },
    );
    assert!(picked.success, "{}", picked.sentence);
    let before = run.hash();
    let at = |run: &Run, object| told(run, run.house.objects[object].parts().next_back().unwrap());
    let nan = |mut body: BodyState| {
        body.velocity.angular.y = f32::NAN;
        body
    };
    let fast = |mut body: BodyState, speed: f32| {
        body.velocity.linear.x = speed;
        body
    };
    let far = |mut body: BodyState| {
        body.pose.position.x = 1e5;
        body
    };
    let bent = |mut body: BodyState| {
        body.pose.rotation = Quat::from_xyzw(0.0, 0.0, 0.0, 2.0);
        body
    };
    let cube = at(&run, free);
    for (body, part) in [
        (nan(cube), "finite"),
        (fast(cube, 1e12), "1000 m/s"),
        (fast(cube, f32::INFINITY), "finite"),
        (far(cube), "32768 m"),
        (bent(cube), "unit quaternion"),
        (at(&run, held), "agent 0 holds it"),
        (at(&run, shelf), "fixed"),
        (at(&run, stuck), "stands for good"),
        (at(&run, door), "the joint \"hinge\" moves it"),
        (
            BodyState {
                part: PartId(999),
                ..cube
            },
            "counted from 0",
        ),
    ] {
        // One bad row among good ones: none is taken.
        let mut moved = cube;
        moved.pose.position.y += 1.0;
        let refused = run
            .world
            .set_bodies(&mut run.state, &[moved, body])
            .unwrap_err();
        assert!(refused.to_string().contains(part), "{refused}");
        assert!(run.hash() == before, "{part}");
    }
    let joint = |position, velocity| JointState {
        joint: JointId(0),
        position,
        velocity,
    };
    for (set, part) in [
        (joint(f32::NAN, 0.0), "finite"),
        (joint(0.1, f32::NAN), "finite"),
        (joint(2.0, 0.0), "limits 0 to 1.6"),
        (joint(-0.1, 0.0), "limits 0 to 1.6"),
        (joint(0.1, 1e12), "1000 rad/s"),
        (
            JointState {
                joint: JointId(9),
                ..joint(0.0, 0.0)
            },
            "counted from 0",
        ),
    ] {
        let refused = run
            .world
            .set_joints(&mut run.state, &[joint(0.5, 0.0), set])
            .unwrap_err();
        assert!(refused.to_string().contains(part), "{refused}");
        assert!(run.hash() == before, "{part}");
    }
}

/// A walker told any speed up to 1e6 m/s walks at its own; beyond that it is refused, not ignored.
#[test]
fn speeds_beyond_number_are_refused_and_not_ignored() {
    for speed in [10.0, 1e6, 1.1e6, 1e25, f32::MAX] {
        let mut run = Build::room([20.0, 3.0, 4.0]).run();
        let start = Vec3::new(2.0, 0.0, 2.0);
        run.agent(start, -std::f32::consts::FRAC_PI_2);
        let control = AgentControl {
            forward_m_s: speed,
            ..AgentControl::default()
        };
        let stepped = run.world.step(&mut run.state, &[control], &mut run.events);
        let way = (run.state.agents[dwell_scene::AgentId(0)].position - start).length();
        assert_eq!(stepped.is_ok(), speed <= 1e6, "{speed}");
        assert_eq!(way > 0.05, speed <= 1e6, "{speed}: {way} m");
    }
}

/// Limits are parameters: stops move at run time, what stands beyond a new one stands at it, and they go with the snapshot.
#[test]
fn limits_of_a_joint_change_at_run_time() {
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let bar = Piece::cuboid(Vec3::new(0.3, 0.02, 0.02), Vec3::new(2.0, 1.5, 2.0));
    let bar = build.object("bar", Mobility::Articulated, &[bar]);
    let hinge = dwell_scene::JointKind::Hinge;
    let joint = build.joint(bar, hinge, Vec3::Y, Vec3::new(1.7, 1.5, 2.0), [-1.0, 1.0]);
    build.data.joints[joint].open = build.data.joints[joint].closed;
    let config = PhysicsConfig {
        sleeping: false,
        ..PhysicsConfig::default()
    };
    let mut run = build.run_with(config);
    let set = |run: &mut Run, field: &str, value: f64| {
        let address = format!("joint/bar/hinge/{field}").parse().unwrap();
        let house = run.house.clone();
        let set = run.state.set_parameter(&house, &address, value);
        run.world.apply_parameters(&mut run.state).unwrap();
        set.map_err(|error| error.to_string())
    };
    let swing = |run: &mut Run| {
        let state = JointState {
            joint,
            position: 0.0,
            velocity: 2.0,
        };
        run.world.set_joints(&mut run.state, &[state]).unwrap();
        let mut furthest = f32::MIN;
        for _ in 0..30 {
            run.steps(1);
            furthest = furthest.max(run.state.joint_position[joint]);
        }
        furthest
    };
    // It is seen once in a control step, in which it goes up to 0.1 rad at 2 rad/s, and is stopped within a physics step.
    let stops_at = |found: f32, stop: f32| (stop - 0.1..stop + 1e-3).contains(&found);
    assert!(stops_at(swing(&mut run), 1.0));
    set(&mut run, "upper", 2.0).unwrap();
    assert!(stops_at(swing(&mut run), 2.0));
    let (state, physics) = (run.state.clone(), run.world.snapshot());
    let beyond = JointState {
        joint,
        position: 1.5,
        velocity: 1.0,
    };
    run.world.set_joints(&mut run.state, &[beyond]).unwrap();
    set(&mut run, "upper", 0.5).unwrap();
    let there = (
        run.state.joint_position[joint],
        run.state.joint_velocity[joint],
    );
    assert_eq!(there, (0.5, 0.0));
    let (measured, _) = run.world.joint_kinematics(&run.state, joint).unwrap();
    assert!((measured - 0.5).abs() < 1e-6);
    assert!(stops_at(swing(&mut run), 0.5));
    assert!(set(&mut run, "lower", 0.6).unwrap_err().contains("to 0.5"));
    assert!(set(&mut run, "upper", -1.5).unwrap_err().contains("-1 to"));
    run.state = state;
    run.world.restore(&mut run.state, &physics).unwrap();
    assert!(
        (swing(&mut run) - 2.0).abs() < 5e-3,
        "the stop of the snapshot"
    );
}

/// The centre of mass and the inertia of a link are parameters: T = 2 pi sqrt((I + m d2) / (m g d)).
#[test]
fn a_stated_inertia_changes_at_run_time() {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let at = Vec3::new(2.0, 3.0, 2.0);
    let bob = Piece {
        collider: Collider::cuboid(Vec3::splat(-0.05), Vec3::splat(0.05)),
        ..Piece::cuboid(Vec3::ONE, at)
    };
    let object = build.object("bob", Mobility::Articulated, &[bob]);
    let part = build.data.objects[object].first_part;
    let mass = 2.0_f32;
    build.data.parts[part].mass_kg = Some(mass);
    build.data.parts[part].inertial = Some(dwell_scene::Inertial {
        part_from_principal: Pose::from_position(Vec3::NEG_Y * 0.1),
        moments: Vec3::new(0.06, 0.05, 0.07),
    });
    build.data.joints.push(dwell_scene::Joint {
        parent_from_joint: Pose::from_position(at),
        ..dwell_scene::Joint::new(
            "pivot",
            object,
            part,
            dwell_scene::JointKind::Hinge,
            Vec3::Z,
        )
    });
    let config = PhysicsConfig {
        sleeping: false,
        ..PhysicsConfig::default()
    };
    let mut run = build.run_with(config);
    let set = |run: &mut Run, field: &str, value: f64| {
        let address = format!("part/bob/part_0/{field}").parse().unwrap();
        let house = run.house.clone();
        run.state.set_parameter(&house, &address, value).unwrap();
        run.world.apply_parameters(&mut run.state).unwrap();
    };
    let tau = std::f32::consts::TAU;
    let (mut down, mut own) = (0.1_f32, 0.07_f32);
    for change in [
        None,
        Some(("center_y_m", -0.3)),
        Some(("moment_3_kg_m2", 0.1)),
    ] {
        match change {
            Some(("center_y_m", y)) => down = -y as f32,
            Some((_, moment)) => own = moment as f32,
            None => {}
        }
        if let Some((field, value)) = change {
            set(&mut run, field, value);
        }
        let start = JointState {
            joint: JointId(0),
            position: 0.05,
            velocity: 0.0,
        };
        run.world.set_joints(&mut run.state, &[start]).unwrap();
        let period =
            tau * ((own + mass * down * down) / (mass * crate::common::gravity() * down)).sqrt();
        let mut worst: f32 = 0.0;
        for k in 1..=40 {
            run.steps(1);
            let expected = 0.05 * (tau * k as f32 / 20.0 / period).cos();
            worst = worst.max((run.state.joint_position[JointId(0)] - expected).abs());
        }
        // The period of a small swing is good to (0.05)^2 / 16; what remains is 1 % of the swing.
        assert!(worst < 5e-4, "{change:?}: {worst}");
    }
}

/// An arm that is bolted down takes any pose its limits allow, and nothing beyond.
#[test]
fn a_bolted_arm_keeps_to_its_limits() {
    let mut run = arm(0.0, Some(STRONG)).run();
    for (position, fits) in [
        (2.999, true),
        (3.000_001, true),
        (3.1, false),
        (-3.5, false),
    ] {
        let set = JointState {
            joint: JointId(3),
            position,
            velocity: 0.0,
        };
        assert_eq!(
            run.world.set_joints(&mut run.state, &[set]).is_ok(),
            fits,
            "{position}"
        );
    }
}
