//! Chains of joints with motors: an arm of six joints and a gripper's payload.

use crate::common::{Build, Piece, Run, gravity};
use dwell_physics::PhysicsConfig;
use dwell_scene::random::RandomKey;
use dwell_scene::{
    Collider, Joint, JointCommand, JointId, JointKind, Mobility, ObjectId, PartId, Pose, Servo,
    State,
};
use glam::{DQuat, DVec3, Vec3};

/// Length of the links, m, their half widths, m, and the axes they turn about.
const LINKS: [(f32, f32, Vec3); 6] = [
    (0.15, 0.05, Vec3::Y),
    (0.35, 0.04, Vec3::Z),
    (0.30, 0.035, Vec3::Z),
    (0.12, 0.03, Vec3::X),
    (0.10, 0.025, Vec3::Z),
    (0.08, 0.025, Vec3::X),
];
const SHOULDER: Vec3 = Vec3::new(2.0, 1.5, 2.0);
const DENSITY: f32 = 2000.0;

/// An arm that stretches along +X from `SHOULDER`, with `payload_kg` in a box at its end.
pub(crate) fn arm(payload_kg: f32, servo: Option<Servo>) -> Build {
    arm_on(None, payload_kg, servo)
}

/// The same on a free base, 0.2 m over its middle.
pub(crate) fn arm_on(base: Option<Piece>, payload_kg: f32, servo: Option<Servo>) -> Build {
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let mut at = match &base {
        Some(base) => base.place.position + Vec3::Y * 0.2,
        None => SHOULDER,
    };
    let mobility = match base {
        Some(_) => Mobility::Movable,
        None => Mobility::Articulated,
    };
    let mut pieces: Vec<Piece> = base.into_iter().collect();
    let links = pieces.len();
    for (length, half, _) in LINKS {
        let (from, to) = (Vec3::new(0.0, -half, -half), Vec3::new(length, half, half));
        pieces.push(Piece {
            collider: Collider::cuboid(from, to),
            ..Piece::cuboid(Vec3::ONE, at).density(DENSITY)
        });
        at.x += length;
    }
    let object = build.object("arm", mobility, &pieces);
    let all: Vec<PartId> = build.data.objects[object].parts().collect();
    let (base, parts) = all.split_at(links);
    if payload_kg > 0.0 {
        let last = &mut build.data.parts[parts[5]];
        let half = Vec3::splat(0.03);
        let center = Vec3::new(LINKS[5].0 + 0.03, 0.0, 0.0);
        last.colliders
            .push(Collider::cuboid(center - half, center + half));
        last.mass_kg = Some(payload_kg);
    }
    let mut reach = 0.0;
    for (k, (length, _, axis)) in LINKS.iter().enumerate() {
        let (parent, at) = match k.checked_sub(1) {
            None if links == 1 => (Some(base[0]), Vec3::Y * 0.2),
            None => (None, SHOULDER),
            Some(before) => (Some(parts[before]), Vec3::X * reach),
        };
        build.data.joints.push(Joint {
            parent,
            parent_from_joint: Pose::from_position(at),
            limits: Some([-3.0, 3.0]),
            servo,
            ..Joint::new(&format!("j{k}"), object, parts[k], JointKind::Hinge, *axis)
        });
        reach = *length;
    }
    build
}

pub(crate) fn awake() -> PhysicsConfig {
    PhysicsConfig {
        sleeping: false,
        ..PhysicsConfig::default()
    }
}

/// Independent forward kinematics in f64: where each link's origin is, and how it is turned.
fn forward(angles: &[f64; 6]) -> [(DVec3, DQuat); 6] {
    let (mut at, mut turn) = (SHOULDER.as_dvec3(), DQuat::IDENTITY);
    let mut out = [(at, turn); 6];
    for (k, (length, _, axis)) in LINKS.iter().enumerate() {
        turn *= DQuat::from_axis_angle(axis.as_dvec3(), angles[k]);
        out[k] = (at, turn);
        at += turn * DVec3::X * f64::from(*length);
    }
    out
}

/// The moment of the weight of everything beyond each joint, by hand.
fn weights(run: &Run, angles: &[f64; 6], payload_kg: f32) -> [f64; 6] {
    let links = forward(angles);
    let mut torques = [0.0; 6];
    for (k, torque) in torques.iter_mut().enumerate() {
        let (origin, turn) = links[k];
        let axis = turn * LINKS[k].2.as_dvec3();
        for (j, (length, half, _)) in LINKS.iter().enumerate().skip(k) {
            let (at, turn) = links[j];
            let volume = f64::from(length * 4.0 * half * half);
            let mut lumps = vec![(volume * f64::from(DENSITY), 0.5 * f64::from(*length))];
            if j == 5 && payload_kg > 0.0 {
                // The part's mass is spread over both pieces by volume.
                let box_m3 = 0.06_f64.powi(3);
                let density = f64::from(payload_kg) / (volume + box_m3);
                lumps = vec![
                    (volume * density, 0.5 * f64::from(*length)),
                    (box_m3 * density, f64::from(*length) + 0.03),
                ];
            }
            for (mass, along) in lumps {
                let arm = at + turn * DVec3::X * along - origin;
                let weight = DVec3::NEG_Y * mass * f64::from(gravity());
                *torque += axis.dot(arm.cross(weight));
            }
        }
    }
    assert_eq!(run.house.joints.len(), 6);
    torques
}

pub(crate) fn angles(state: &State) -> [f64; 6] {
    std::array::from_fn(|k| f64::from(state.joint_position[JointId(k as u32)]))
}

fn pose(run: &mut Run, key: RandomKey, reach: f32) -> [f32; 6] {
    let q =
        std::array::from_fn(|k| reach * (2.0 * key.child(k as u64).stream().uniform_f32() - 1.0));
    for (k, q) in q.iter().enumerate() {
        run.state.joint_position[JointId(k as u32)] = *q;
        run.state.joint_velocity[JointId(k as u32)] = 0.0;
    }
    run.world.adopt_state(&mut run.state).unwrap();
    q
}

pub(crate) const STRONG: Servo = Servo {
    stiffness: 400.0,
    damping: 40.0,
    max_effort: 200.0,
    velocity_gain: 40.0,
    max_velocity: None,
    gear: 1.0,
    feed_forward: true,
};

/// Issue 3: an arm set at rest with position motors that hold its pose keeps it within 1e-3 rad for 10 s; 2 kg in hand.
#[test]
fn an_arm_told_to_hold_its_pose_holds_it() {
    let mut run = arm(2.0, Some(STRONG)).run_with(awake());
    for seed in 0..5 {
        let reach = if seed == 0 { 0.0 } else { 1.5 };
        let start = pose(&mut run, RandomKey::root(seed), reach);
        for (k, q) in start.iter().enumerate() {
            run.state.joint_command[JointId(k as u32)] = JointCommand::Position(*q);
        }
        let mut worst: f32 = 0.0;
        for _ in 0..200 {
            run.steps(1);
            for (k, q) in start.iter().enumerate() {
                worst = worst.max((run.state.joint_position[JointId(k as u32)] - q).abs());
            }
        }
        println!("seed {seed}: worst {worst:.2e} rad");
        assert!(worst < 1e-3, "pose {seed}: {worst} rad");
    }
}

/// Torque balance: without feed-forward each joint deflects by its load over its stiffness.
#[test]
fn a_plain_position_motor_gives_way_by_load_over_stiffness() {
    let servo = Servo {
        stiffness: 2000.0,
        damping: 100.0,
        max_effort: 500.0,
        feed_forward: false,
        ..STRONG
    };
    let mut run = arm(2.0, Some(servo)).run_with(awake());
    let start = pose(&mut run, RandomKey::root(3), 1.0);
    for (k, q) in start.iter().enumerate() {
        run.state.joint_command[JointId(k as u32)] = JointCommand::Position(*q);
    }
    run.steps(100);
    let now = angles(&run.state);
    let loads = weights(&run, &now, 2.0);
    for k in 0..6 {
        let expected = loads[k] / 2000.0;
        let found = now[k] - f64::from(start[k]);
        // 1e-4 rad are 0.2 N m.
        assert!(
            (found - expected).abs() < 1e-4,
            "joint {k}: {found} {expected}"
        );
    }
}

/// Efforts that equal the weights' moments, computed by hand, leave the arm where it is (an unstable balance: short).
#[test]
fn efforts_that_balance_the_weight_hold_the_arm() {
    let mut run = arm(1.0, Some(STRONG)).run_with(awake());
    pose(&mut run, RandomKey::root(9), 1.0);
    let start = angles(&run.state);
    for _ in 0..20 {
        let loads = weights(&run, &angles(&run.state), 1.0);
        for (k, load) in loads.iter().enumerate() {
            run.state.joint_command[JointId(k as u32)] = JointCommand::Effort(-*load as f32);
        }
        run.steps(1);
    }
    for (k, (now, start)) in angles(&run.state).iter().zip(start).enumerate() {
        assert!((now - start).abs() < 2e-3, "joint {k}: {}", now - start);
    }
}

/// Issue 3: 10,000 random poses and velocities are read back. The state keeps the exact values; the bodies in physics
/// agree, each read by itself.
#[test]
fn any_pose_and_velocity_reads_back() {
    let mut run = arm(2.0, Some(STRONG)).run_with(awake());
    let object = ObjectId(0);
    let (mut worst_q, mut worst_v, mut worst_link) = (0.0_f32, 0.0_f32, 0.0_f64);
    for round in 0..10_000 {
        let key = RandomKey::root(77).child(round);
        let q: [f32; 6] =
            std::array::from_fn(|k| 2.9 * (2.0 * key.child(k as u64).stream().uniform_f32() - 1.0));
        let v: [f32; 6] = std::array::from_fn(|k| {
            5.0 * (2.0 * key.child(10 + k as u64).stream().uniform_f32() - 1.0)
        });
        for k in 0..6 {
            run.state.joint_position[JointId(k as u32)] = q[k];
            run.state.joint_velocity[JointId(k as u32)] = v[k];
        }
        run.world.adopt_state(&mut run.state).unwrap();
        // The values of physics itself, not those written.
        for k in 0..6 {
            let id = JointId(k as u32);
            let (there, speed) = run.world.joint_kinematics(&run.state, id).unwrap();
            worst_q = worst_q.max((there - q[k]).abs());
            worst_v = worst_v.max((speed - v[k]).abs());
            let kept = (run.state.joint_position[id], run.state.joint_velocity[id]);
            assert_eq!(kept, (q[k], v[k]));
        }
        let links = forward(&q.map(f64::from));
        for (k, part) in run.house.objects[object].parts().enumerate() {
            let pose = run.state.part_pose[part];
            let off = (pose.position.as_dvec3() - links[k].0).length();
            let turn = pose.rotation.as_dquat().dot(links[k].1).abs();
            worst_link = worst_link.max(off).max(1.0 - turn);
        }
    }
    println!("position {worst_q:.2e} velocity {worst_v:.2e} link {worst_link:.2e}");
    assert!(worst_q <= 1e-6, "{worst_q} rad");
    assert!(worst_v <= 1e-6, "{worst_v} rad/s");
    // Six turned links, each coordinate rounded at 2 m: 2.4e-7 m.
    assert!(worst_link < 3e-6, "{worst_link} m");
}

/// A double pendulum of two bars of 0.5 m that hangs from (2, 3, 2), turned by these angles, with these speeds.
pub(crate) fn double_pendulum(servo: Option<Servo>, angles: [f32; 2], speeds: [f32; 2]) -> Run {
    let mut build = Build::room([4.0, 6.0, 4.0]);
    let at = Vec3::new(2.0, 3.0, 2.0);
    let bar = |at: Vec3| Piece {
        collider: Collider::cuboid(Vec3::new(-0.02, -0.5, -0.02), Vec3::new(0.02, 0.0, 0.02)),
        ..Piece::cuboid(Vec3::ONE, at)
    };
    let object = build.object(
        "double",
        Mobility::Articulated,
        &[bar(at), bar(at - Vec3::Y * 0.5)],
    );
    let parts: Vec<PartId> = build.data.objects[object].parts().collect();
    for k in 0..2 {
        let parent = (k == 1).then_some(parts[0]);
        let place = if k == 0 { at } else { Vec3::NEG_Y * 0.5 };
        build.data.joints.push(Joint {
            parent,
            parent_from_joint: Pose::from_position(place),
            servo,
            ..Joint::new(
                &format!("j{k}"),
                object,
                parts[k],
                JointKind::Hinge,
                Vec3::Z,
            )
        });
    }
    let mut run = build.run_with(awake());
    for k in 0..2 {
        run.state.joint_position[JointId(k)] = angles[k as usize];
        run.state.joint_velocity[JointId(k)] = speeds[k as usize];
    }
    run.world.adopt_state(&mut run.state).unwrap();
    run
}

/// The double pendulum's energy by hand, from angles and speeds, J; 0 at rest at the lowest point.
fn pendulum_energy(state: &State) -> f64 {
    let (mass, half, g) = (500.0 * 0.5 * 0.04 * 0.04, 0.25, f64::from(gravity()));
    let own = mass * (0.5 * 0.5 + 0.04 * 0.04) / 12.0;
    let at = |k: u32| f64::from(state.joint_position[JointId(k)]);
    let speed = |k: u32| f64::from(state.joint_velocity[JointId(k)]);
    // Angles from hanging straight down; speeds of the centres of mass.
    let (one, two) = (at(0), at(0) + at(1));
    let (p, q) = (speed(0), speed(0) + speed(1));
    let first = half * p;
    let x = 0.5 * one.cos() * p + half * two.cos() * q;
    let y = 0.5 * one.sin() * p + half * two.sin() * q;
    let kinetic = 0.5 * mass * (first * first + x * x + y * y) + 0.5 * own * (p * p + q * q);
    let height = -half * one.cos() - 0.5 * one.cos() - half * two.cos();
    kinetic + mass * g * (height + 1.0)
}

/// Issue 3: without friction the energy of a double pendulum is kept within 5 % over 10 s, swinging freely, tumbling over,
/// and with motors under zero effort commands.
#[test]
fn a_double_pendulum_keeps_its_energy() {
    let limp = Servo {
        feed_forward: false,
        ..STRONG
    };
    for (servo, angles, speeds) in [
        (None, [1.2, 0.7], [0.0, 0.0]),
        (None, [2.8, 0.5], [0.0, 0.0]),
        (None, [1.0, 0.0], [9.0, -6.0]),
        (Some(limp), [1.2, 0.7], [0.0, 0.0]),
        (Some(limp), [0.0, 1.0], [12.0, 5.0]),
    ] {
        let mut run = double_pendulum(servo, angles, speeds);
        for k in 0..2 {
            if servo.is_some() {
                run.state.joint_command[JointId(k)] = JointCommand::Effort(0.0);
            }
        }
        let start = pendulum_energy(&run.state);
        let mut worst: f64 = 0.0;
        for _ in 0..200 {
            run.steps(1);
            worst = worst.max((pendulum_energy(&run.state) - start).abs());
        }
        println!(
            "{angles:?} {speeds:?}: {:.4} of {start:.3} J",
            worst / start
        );
        assert!(worst < 0.05 * start, "{worst} of {start}");
    }
}

/// A hinge in the horizontal plane: no weight acts along it.
fn turntable(friction: f32, damping: f32, armature: f32) -> (Run, JointId, f32) {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let half = Vec3::new(0.2, 0.02, 0.1);
    let bar = Piece::cuboid(half, Vec3::new(2.0, 2.0, 2.0));
    let mass = 500.0 * 8.0 * half.element_product();
    let inertia = mass / 3.0 * (half.x * half.x + half.z * half.z);
    let object = build.object("table", Mobility::Articulated, &[bar]);
    let at = Vec3::new(2.0, 2.0, 2.0);
    let joint = build.joint(object, JointKind::Hinge, Vec3::Y, at, [-1.0, 1.0]);
    let data = &mut build.data.joints[joint];
    data.limits = None;
    data.friction = friction;
    data.damping = damping;
    data.armature = armature;
    data.servo = Some(STRONG);
    (build.run_with(awake()), joint, inertia + armature)
}

/// Stick test: below the friction's torque nothing moves, above it the remaining torque accelerates it, and it coasts to a
/// stop after I w / F.
#[test]
fn friction_of_a_joint_takes_its_own_torque_and_no_more() {
    let friction = 0.05;
    for armature in [0.0, 0.02] {
        for (torque, moves) in [(0.0498, false), (0.0502, true), (0.08, true)] {
            let (mut run, joint, inertia) = turntable(friction, 0.0, armature);
            run.state.joint_command[joint] = JointCommand::Effort(torque);
            run.steps(20);
            let expected = if moves {
                (torque - friction) / inertia
            } else {
                0.0
            };
            let found = run.state.joint_velocity[joint];
            // 1 s, so that the speed is the acceleration; a thousandth of the friction's own share.
            let bound = 1e-3 * friction / inertia;
            assert!(
                (found - expected).abs() < bound,
                "{torque}: {found} {expected}"
            );
        }
        let (mut run, joint, inertia) = turntable(friction, 0.0, armature);
        run.state.joint_velocity[joint] = 3.0;
        run.world.adopt_state(&mut run.state).unwrap();
        let stops_s = inertia * 3.0 / friction;
        let steps = (0.8 * stops_s * 20.0) as usize;
        run.steps(steps);
        let expected = 3.0 - friction / inertia * steps as f32 / 20.0;
        let found = run.state.joint_velocity[joint];
        assert!((found - expected).abs() < 3e-3, "{found} {expected}");
        run.steps((0.3 * stops_s * 20.0) as usize);
        assert!(run.state.joint_velocity[joint].abs() < 1e-5);
    }
}

/// Under a velocity command, the joint keeps it less the effect of damping: w = g w* / (g + d).
#[test]
fn a_velocity_motor_keeps_its_speed() {
    let (mut run, joint, _) = turntable(0.0, 2.0, 0.0);
    run.state.joint_command[joint] = JointCommand::Velocity(1.5);
    run.steps(100);
    let expected = 40.0 * 1.5 / 42.0;
    let found = run.state.joint_velocity[joint];
    assert!((found - expected).abs() < 1e-3, "{found} {expected}");
    // A joint without limits counts its turns.
    assert!(run.state.joint_position[joint] > 1.0_f32.to_radians() * 360.0);
}

fn set(run: &mut Run, address: &str, value: f64) {
    let house = run.house.clone();
    let address = address.parse().unwrap();
    run.state.set_parameter(&house, &address, value).unwrap();
    run.world.apply_parameters(&mut run.state).unwrap();
}

/// Link length, gear, mass and friction change while the world runs: the body on a longer link moves out at once, a weaker
/// gear lets the arm sink, and all of it is in snapshot and hash.
#[test]
fn parameters_of_a_robot_change_at_run_time() {
    let mut run = arm(1.0, Some(STRONG)).run_with(awake());
    for k in 0..6 {
        run.state.joint_command[JointId(k)] = JointCommand::Position(0.0);
    }
    run.steps(5);
    let hand: Vec<PartId> = run.house.objects[ObjectId(0)].parts().collect();
    let before = run.state.part_pose[hand[5]].position;
    let hash = run.state.hash();
    set(&mut run, "joint/arm/j2/length_m", 0.5);
    assert_ne!(run.state.hash(), hash);
    let after = run.state.part_pose[hand[5]].position;
    assert!(
        (after - before - Vec3::X * 0.15).length() < 1e-4,
        "{before} {after}"
    );
    run.steps(40);
    let q = angles(&run.state);
    assert!(q.iter().all(|q| q.abs() < 1e-3), "{q:?}");
    // A fork from the snapshot gives the same bits, changed parameters included.
    let (state, physics) = (run.state.to_bytes(&run.house), run.world.snapshot());
    set(&mut run, "part/arm/part_5/mass_kg", 3.0);
    set(&mut run, "joint/1/gear", 0.1);
    set(&mut run, "joint/1/friction", 0.5);
    let joint = run.state.joint_parameters(&run.house, JointId(1));
    assert!((joint.servo.unwrap().max_joint_effort() - 20.0).abs() < 1e-4 && joint.friction == 0.5);
    run.steps(20);
    let sunk = angles(&run.state);
    assert!(sunk[1] < -0.3, "{sunk:?}");
    let end = run.hash();
    run.state = State::from_bytes(&run.house, &state).unwrap();
    run.world.restore(&mut run.state, &physics).unwrap();
    assert!((angles(&run.state)[1]).abs() < 1e-3);
    set(&mut run, "part/arm/part_5/mass_kg", 3.0);
    set(&mut run, "joint/1/gear", 0.1);
    set(&mut run, "joint/1/friction", 0.5);
    run.steps(20);
    assert!(run.hash() == end);
}

/// A part that states its inertia swings with it: T = 2 pi sqrt(I / (m g d)), whatever its collider is.
#[test]
fn a_stated_inertia_is_the_one_that_swings() {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let at = Vec3::new(2.0, 3.0, 2.0);
    let bob = Piece {
        collider: Collider::cuboid(Vec3::splat(-0.05), Vec3::splat(0.05)),
        ..Piece::cuboid(Vec3::ONE, at)
    };
    let object = build.object("bob", Mobility::Articulated, &[bob]);
    let part = build.data.objects[object].first_part;
    let (mass, down, own) = (2.0_f32, 0.3_f32, 0.09_f32);
    build.data.parts[part].mass_kg = Some(mass);
    build.data.parts[part].inertial = Some(dwell_scene::Inertial {
        part_from_principal: Pose::from_position(Vec3::NEG_Y * down),
        moments: Vec3::new(0.06, 0.05, own),
    });
    let hinge = JointKind::Hinge;
    build.data.joints.push(Joint {
        parent_from_joint: Pose::from_position(at),
        initial: 0.05,
        ..Joint::new("pivot", object, part, hinge, Vec3::Z)
    });
    let mut run = build.run_with(awake());
    let period =
        std::f32::consts::TAU * ((own + mass * down * down) / (mass * gravity() * down)).sqrt();
    let steps = 60;
    let mut worst: f32 = 0.0;
    for k in 1..=steps {
        run.steps(1);
        let expected = 0.05 * (std::f32::consts::TAU * k as f32 / 20.0 / period).cos();
        worst = worst.max((run.state.joint_position[JointId(0)] - expected).abs());
    }
    // Two periods; 3 % of the swing.
    assert!(worst < 1.5e-3, "{worst}");
}

/// Links that no joint connects stop at each other, as users of URDF expect: an arm commanded to fold onto itself comes to
/// rest on its own body, short of its target. Links connected by a joint do not collide.
#[test]
fn a_folded_arm_stops_at_its_own_body() {
    let mut run = arm(0.0, Some(STRONG)).run_with(awake());
    assert!(run.report.passing.is_empty(), "{:?}", run.report.passing);
    let parts: Vec<PartId> = run.house.objects[ObjectId(0)].parts().collect();
    let own = |state: &State| {
        let place = |part: PartId| parts.iter().position(|own| *own == part);
        let pairs = state.contacts.iter();
        pairs
            .filter_map(|contact| Some((place(contact.a)?, place(contact.b?)?)))
            .collect::<Vec<_>>()
    };
    // The second link up, the third turned round against it.
    let told = [0.0, 1.57, 3.1, 0.0, 0.0, 0.0];
    for (k, q) in told.iter().enumerate() {
        set(&mut run, &format!("joint/{k}/max_effort"), 30.0);
        run.state.joint_command[JointId(k as u32)] = JointCommand::Position(*q);
    }
    run.steps(200);
    let q = angles(&run.state);
    let touching = own(&run.state);
    println!("third joint at {:.3} of 3.1, touching {touching:?}", q[2]);
    assert!(q[2] < 3.0 && q[2] > 2.0, "{q:?}");
    assert!(!touching.is_empty());
    assert!(touching.iter().all(|(a, b)| a.abs_diff(*b) > 1));
    assert!(run.state.joint_velocity.iter().all(|v| v.abs() < 1e-2));
}
