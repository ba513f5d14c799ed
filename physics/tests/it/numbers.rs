//! Every number of bodies, joints and agents, set while a world runs: together where they bound each other, and with their
//! mechanical consequences.

use crate::arms::{STRONG, awake};
use crate::common::{Build, Piece, Run, forward};
use crate::linkages::linked;
use dwell_physics::{AgentPlacement, BodyState, JointState};
use dwell_scene::{
    Address, AgentBody, AgentId, DifferentialDrive, Inertial, JointId, JointKind, Locomotion,
    Mobility, ObjectId, Pose, State, Velocity,
};
use glam::Vec3;

fn values(pairs: &[(&str, f64)]) -> Vec<(Address, f64)> {
    let row = |(address, value): &(&str, f64)| (address.parse().unwrap(), *value);
    pairs.iter().map(row).collect()
}

/// Sets all or nothing, as a world does.
fn set(run: &mut Run, pairs: &[(&str, f64)]) -> Result<(), String> {
    let house = run.house.clone();
    let before = run.state.clone();
    let told = |error: &dyn ToString| error.to_string();
    let set = run.state.set_parameters(&house, &values(pairs));
    set.map_err(|error| told(&error))?;
    let applied = run.world.apply_parameters(&mut run.state);
    applied.map_err(|error| {
        run.state = before;
        told(&error)
    })
}

fn get(run: &Run, address: &str) -> f64 {
    let there = run.state.parameter(&run.house, &address.parse().unwrap());
    there.unwrap().value
}

/// Regression: each of the limits, and each of the moments, was refused as long as the others were the old ones.
#[test]
fn limits_and_moments_are_set_together() {
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let bar = Piece::cuboid(Vec3::new(0.3, 0.02, 0.02), Vec3::new(2.0, 1.5, 2.0));
    let bar = build.object("bar", Mobility::Articulated, &[bar]);
    build.joint(
        bar,
        JointKind::Hinge,
        Vec3::Y,
        Vec3::new(1.7, 1.5, 2.0),
        [-1.0, 1.0],
    );
    let part = build.data.objects[bar].first_part;
    build.data.parts[part].mass_kg = Some(2.0);
    build.data.parts[part].inertial = Some(Inertial {
        part_from_principal: Pose::IDENTITY,
        moments: Vec3::new(0.06, 0.05, 0.07),
    });
    let mut run = build.run();
    let ten_times = [
        ("part/bar/part_0/moment_1_kg_m2", 0.6),
        ("part/bar/part_0/moment_2_kg_m2", 0.5),
        ("part/bar/part_0/moment_3_kg_m2", 0.7),
    ];
    let limits = [
        ("joint/bar/hinge/lower", 1.2),
        ("joint/bar/hinge/upper", 1.8),
    ];
    let before = run.hash();
    for alone in ten_times.iter().chain(&limits[..1]) {
        assert!(set(&mut run, &[*alone]).is_err(), "{alone:?}");
    }
    let crossed = [("joint/bar/hinge/lower", 1.9), ("joint/0/upper", 1.8)];
    let message = set(&mut run, &crossed).unwrap_err();
    assert!(
        message.contains("joint/bar/hinge/lower") && message.contains("to 1.8"),
        "{message}"
    );
    let twice = [("joint/bar/hinge/lower", 0.0), ("joint/0/lower", 0.1)];
    assert!(set(&mut run, &twice).unwrap_err().contains("twice"));
    let flat = [("joint/0/axis_y", 0.0), ("joint/0/friction", 1.0)];
    assert!(set(&mut run, &flat).unwrap_err().contains("no direction"));
    assert!(run.hash() == before);
    let all: Vec<_> = ten_times.into_iter().chain(limits).collect();
    set(&mut run, &all).unwrap();
    for (address, value) in &all {
        assert_eq!(get(&run, address) as f32, *value as f32, "{address}");
    }
    assert_eq!(run.state.joint_position[JointId(0)], 1.2);
}

/// Two cubes far apart, one of which is made twice as dense. By hand: masses m and 2 m, `center = 2/3 d`, and about that
/// `I = 3 m a2 / 6 + 2/3 m d2` across the bar, `3 m a2 / 6` along it.
#[test]
fn a_dumbbell_with_one_heavy_end_has_its_mass_there() {
    let (edge, apart, density) = (0.1_f32, 0.6_f32, 500.0_f32);
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let end = |x: f32, of| {
        let half = Vec3::splat(0.5 * edge);
        Piece::cuboid(half, Vec3::new(1.5 + x, 1.5, 2.0))
            .of(of)
            .density(density)
    };
    let ends = [end(0.0, "oak"), end(apart, "steel")];
    let bell = build.object("bell", Mobility::Movable, &ends);
    let steel = build.material("steel");
    let nominal = build.data.materials[steel].density_kg_m3;
    let mut run = build.run_with(awake());
    set(&mut run, &[("world/gravity_m_s2", 0.0)]).unwrap();
    let root = run.root(bell);
    let start = run.state.part_pose[root];
    let put = |run: &mut Run, linear: Vec3, angular: Vec3| {
        let pose = Pose::from_position(start.position);
        let velocity = Velocity { linear, angular };
        let body = BodyState {
            part: root,
            pose,
            velocity,
        };
        run.world.set_bodies(&mut run.state, &[body]).unwrap();
    };
    let mass = density * edge.powi(3);
    for (factor, share) in [(1.0, 0.5), (2.0, 2.0 / 3.0)] {
        let address = "material/of_steel/density_kg_m3";
        set(&mut run, &[(address, f64::from(factor * nominal))]).unwrap();
        let (total, center) = (mass * (1.0 + factor), Vec3::X * (share * apart));
        // A velocity alone: the mass.
        put(&mut run, Vec3::X, Vec3::ZERO);
        let found = 2.0 * run.world.kinetic_energy_j();
        assert!(
            (found / f64::from(total) - 1.0).abs() < 1e-4,
            "{found} {total}"
        );
        // A spin about the centre of mass, where it should be: the inertia. Were it elsewhere the energy would be larger.
        let reduced = mass * factor / (1.0 + factor);
        let own = total * edge * edge / 6.0;
        let across = own + reduced * apart * apart;
        for (axis, expected) in [(Vec3::X, own), (Vec3::Y, across), (Vec3::Z, across)] {
            put(&mut run, -axis.cross(center), axis);
            let found = 2.0 * run.world.kinetic_energy_j();
            let error = (found / f64::from(expected) - 1.0).abs();
            assert!(error < 1e-4, "{factor} {axis}: {found} {expected}");
        }
        // And the centre stays where it is for a whole turn.
        put(&mut run, -Vec3::Y.cross(center) * 3.0, Vec3::Y * 3.0);
        let at = |run: &Run| run.state.part_pose[root].transform_point(center);
        let before = at(&run);
        for _ in 0..40 {
            run.steps(1);
            assert!((at(&run) - before).length() < 2e-3, "{}", at(&run) - before);
        }
    }
    // In motion: a spinning body goes on as before when its mass distribution changes.
    put(&mut run, Vec3::new(0.3, 0.0, 0.0), Vec3::Y);
    let before = run.state.part_velocity[root];
    set(
        &mut run,
        &[("material/of_steel/density_kg_m3", f64::from(nominal))],
    )
    .unwrap();
    run.world.adopt_state(&mut run.state).unwrap();
    let now = run.world.body_state(root).unwrap().velocity;
    assert!(
        (now.linear - before.linear).length() < 1e-5,
        "{now:?} {before:?}"
    );
    assert!((now.angular - before.angular).length() < 1e-5);
}

/// The object's own mass precedes its parts', in their shares.
#[test]
fn an_objects_mass_is_shared_as_its_parts_weigh() {
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let end = |x: f32, of| Piece::cuboid(Vec3::splat(0.05), Vec3::new(1.5 + x, 1.5, 2.0)).of(of);
    let bell = build.object(
        "bell",
        Mobility::Movable,
        &[end(0.0, "oak"), end(0.6, "steel")],
    );
    let steel = build.material("steel");
    let nominal = f64::from(build.data.materials[steel].density_kg_m3);
    let mut run = build.run_with(awake());
    let object = format!("object/{}/mass_kg", run.house.entity_of_object(bell).0);
    let density = ("material/of_steel/density_kg_m3", 3.0 * nominal);
    set(
        &mut run,
        &[("world/gravity_m_s2", 0.0), density, (&object, 4.0)],
    )
    .unwrap();
    let root = run.root(bell);
    let mut put = |linear: Vec3, angular: Vec3| {
        let mut body = BodyState {
            part: root,
            pose: run.state.part_pose[root],
            velocity: Velocity { linear, angular },
        };
        body.pose.position = Vec3::new(1.5, 1.5, 2.0);
        run.world.set_bodies(&mut run.state, &[body]).unwrap();
        2.0 * run.world.kinetic_energy_j()
    };
    assert!((put(Vec3::X, Vec3::ZERO) / 4.0 - 1.0).abs() < 1e-4);
    // 1 kg and 3 kg, 0.6 m apart: 4 a2 / 6 + 3/4 d2.
    let center = Vec3::X * 0.45;
    let found = put(-Vec3::Y.cross(center), Vec3::Y);
    let expected = 4.0 * 0.01 / 6.0 + 0.75 * 0.36;
    assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
}

/// A lid whose hinge axis is turned opens the other way: independent kinematics by hand.
#[test]
fn an_axis_that_turns_takes_what_hangs_on_it_along() {
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let bar = Piece::cuboid(Vec3::new(0.3, 0.02, 0.02), Vec3::new(2.0, 1.5, 2.0));
    let bar = build.object("bar", Mobility::Articulated, &[bar]);
    let joint = build.joint(
        bar,
        JointKind::Hinge,
        Vec3::Y,
        Vec3::new(1.7, 1.5, 2.0),
        [-1.0, 1.0],
    );
    build.data.joints[joint].open = build.data.joints[joint].closed;
    let mut run = build.run_with(awake());
    set(&mut run, &[("world/gravity_m_s2", 0.0)]).unwrap();
    let state = JointState {
        joint,
        position: 0.5,
        velocity: 0.0,
    };
    run.world.set_joints(&mut run.state, &[state]).unwrap();
    let middle = |run: &Run| run.position(bar) - Vec3::new(1.7, 1.5, 2.0);
    let (s, c) = 0.5_f32.sin_cos();
    assert!((middle(&run) - Vec3::new(c, 0.0, -s) * 0.3).length() < 1e-5);
    let (state, physics) = (run.state.clone(), run.world.snapshot());
    set(
        &mut run,
        &[("joint/0/axis_y", 0.0), ("joint/0/axis_z", 2.0)],
    )
    .unwrap();
    let turned = Vec3::new(c, s, 0.0) * 0.3;
    assert!((middle(&run) - turned).length() < 1e-5, "{}", middle(&run));
    run.steps(40);
    assert!((middle(&run) - turned).length() < 1e-4, "{}", middle(&run));
    assert!((run.state.joint_position[joint] - 0.5).abs() < 1e-4);
    // It swings about the new axis.
    let state_of = JointState {
        joint,
        position: 0.0,
        velocity: 0.5,
    };
    run.world.set_joints(&mut run.state, &[state_of]).unwrap();
    run.steps(10);
    let now = middle(&run);
    assert!(now.z.abs() < 1e-4 && now.y > 0.05, "{now}");
    run.state = state;
    run.world.restore(&mut run.state, &physics).unwrap();
    run.steps(20);
    assert!((middle(&run) - Vec3::new(c, 0.0, -s) * 0.3).length() < 1e-4);
}

/// A mimic joint moves to its new multiple, and a motor that no longer compensates the weight deflects by load over
/// stiffness.
#[test]
fn linkages_and_carried_weights_change_at_run_time() {
    let mut run = linked(0.6);
    let follows = |run: &Run, multiplier: f32, offset: f32| {
        let q = |k| run.state.joint_position[JointId(k)];
        (q(2) - multiplier * q(1) - offset).abs()
    };
    run.steps(80);
    assert!(follows(&run, -0.5, 0.1) < 2e-3);
    set(
        &mut run,
        &[
            ("joint/2/mimic_multiplier", 0.25),
            ("joint/2/mimic_offset", -0.1),
        ],
    )
    .unwrap();
    run.steps(80);
    assert!(
        follows(&run, 0.25, -0.1) < 2e-3,
        "{}",
        follows(&run, 0.25, -0.1)
    );
    let held = run.state.joint_position[JointId(1)];
    // It carries the mimic joint's share, which no controller knows of.
    assert!((held - 0.6).abs() < 0.02, "{held}");
    set(&mut run, &[("joint/1/feed_forward", 0.5)]).unwrap();
    run.steps(80);
    let half = run.state.joint_position[JointId(1)] - held;
    set(&mut run, &[("joint/1/feed_forward", 0.0)]).unwrap();
    run.steps(80);
    let none = run.state.joint_position[JointId(1)] - held;
    // Its moment changes a little with the pose: a tenth.
    assert!(
        none.abs() > 5e-3 && (none / half - 2.0).abs() < 0.2,
        "{half} {none}"
    );
}

/// Every listed number of a robot, an agent on legs and two on wheels: each set to another value in its range, read back,
/// kept by a snapshot, and gone with the one before.
#[test]
fn every_listed_number_is_set_read_back_and_restored() {
    let base = Piece::cuboid(Vec3::new(0.3, 0.2, 0.3), Vec3::new(2.0, 0.2, 2.0)).density(3000.0);
    let mut build = crate::arms::arm_on(Some(base), 1.0, Some(STRONG));
    let follower = &mut build.data.joints[JointId(4)];
    follower.servo = None;
    follower.mimic = Some(dwell_scene::Mimic {
        leader: JointId(3),
        multiplier: 1.0,
        offset: 0.0,
    });
    let mut run = build.run_with(awake());
    for (k, locomotion) in [
        Locomotion::default(),
        Locomotion::DifferentialDrive(DifferentialDrive::default()),
        Locomotion::Holonomic(dwell_scene::HolonomicBase::default()),
    ]
    .into_iter()
    .enumerate()
    {
        let body = AgentBody {
            locomotion,
            ..AgentBody::default()
        };
        run.agent_with(body, Vec3::new(0.6 + k as f32, 0.0, 0.6), 0.0);
    }
    let start = (run.state.clone(), run.world.unpacked_snapshot(), run.hash());
    let addresses = run.state.addresses(&run.house);
    for wanted in [
        "joint/0/axis_x",
        "joint/4/mimic_offset",
        "agent/2/body/reach_m",
    ] {
        assert!(addresses.iter().any(|a| a.as_str() == wanted), "{wanted}");
    }
    for address in &addresses {
        let there = run.state.parameter(&run.house, address).unwrap();
        // A hundredth of the way to the nearer bound, so that nothing stands in a wall.
        let [low, high] = [there.low, there.high].map(|bound| bound.clamp(-1e3, 1e3));
        let aim = if high - there.value > there.value - low {
            high
        } else {
            low
        };
        let value = f64::from((there.value + 0.01 * (aim - there.value)) as f32);
        let house = run.house.clone();
        run.state.set_parameter(&house, address, value).unwrap();
        run.world.apply_parameters(&mut run.state).unwrap();
        let now = run.state.parameter(&house, address).unwrap().value;
        assert!(
            (now - value).abs() <= 1e-6 * value.abs(),
            "{address}: {now} {value}"
        );
        if value != there.value {
            assert_ne!(run.state.hash(), start.2.0, "{address}");
        }
        let bytes = run.state.to_bytes(&house);
        let moment = run.world.unpacked_snapshot();
        let mut again = State::from_bytes(&house, &bytes).unwrap();
        assert_eq!(again, run.state, "{address}");
        let mut world = run.world.clone();
        world.restore(&mut again, &moment).unwrap();
        assert!(world.unpacked_snapshot() == moment, "{address}");
        run.state = start.0.clone();
        run.world.restore(&mut run.state, &start.1).unwrap();
        assert!(run.hash() == start.2, "{address}");
        // Regression: an override equal to the house's value stayed, and with it another hash. Bands of materials stay set.
        if matches!(address.words()[..], ["material", _, _, _]) {
            continue;
        }
        run.state.set_parameter(&house, address, value).unwrap();
        let back = run.state.set_parameter(&house, address, there.value);
        back.unwrap();
        assert_eq!(run.state.hash(), start.2.0, "{address} set back");
    }
    let fov = run.state.overridden_fov_deg(AgentId(0));
    assert_eq!(fov, None);
}

/// Gravity as usually written, 9.80665, is the house's, though its nearest f32 is another f64.
#[test]
fn a_number_that_stands_there_anyway_is_not_kept() {
    let mut run = Build::room([4.0, 3.0, 4.0]).run();
    let agent = run.agent(Vec3::new(2.0, 0.0, 2.0), 0.0);
    let before = run.hash();
    for (address, other, own) in [
        ("world/gravity_m_s2", 1.62, 9.80665),
        ("agent/0/camera/fov_deg", 60.0, 90.0),
        ("agent/0/base/max_speed_m_s", 0.3, f64::NAN),
    ] {
        let own = if own.is_nan() {
            get(&run, address)
        } else {
            own
        };
        set(&mut run, &[(address, other)]).unwrap();
        assert!(run.hash() != before, "{address}");
        set(&mut run, &[(address, own)]).unwrap();
        assert!(run.hash() == before, "{address}");
        assert!(run.state.overrides.is_empty(), "{address}");
    }
    assert_eq!(run.state.overridden_fov_deg(agent), None);
}

/// Regression: a hand that had become too weak, and one whose object had become too heavy, went on holding.
#[test]
fn what_is_too_heavy_now_falls_from_the_hand() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    // 4 kg of 500 kg/m3.
    let cube = Piece::cuboid(Vec3::splat(0.1), Vec3::new(3.0, 0.1, 2.0));
    let cube = build.movable("cube", cube);
    let mut run = build.run();
    let agent = run.agent(Vec3::new(3.0, 0.0, 3.0), 0.0);
    run.steps(2);
    assert!(
        run.act(agent, dwell_physics::actions::Pick::new(cube))
            .success
    );
    run.steps(20);
    let id = run.house.entity_of_object(cube).0;
    let heavier = format!("object/{id}/mass_kg");
    for (address, number) in [("agent/0/body/lift_kg", 3.9), (heavier.as_str(), 10.1)] {
        let mut run = run.clone();
        let held_at = run.position(cube).y;
        assert!(held_at > 0.5 && run.state.agents[agent].holding == Some(cube));
        set(&mut run, &[(address, number)]).unwrap();
        run.walk(1, &[]);
        let told = run
            .world
            .delayed_outcomes()
            .first()
            .expect("it is told")
            .clone();
        assert_eq!(told.agent, Some(agent));
        assert_eq!(told.outcome.code, dwell_physics::OutcomeCode::TooHeavy);
        assert!(told.outcome.sentence.contains("fell from your hand"));
        assert_eq!(run.state.agents[agent].holding, None);
        assert_eq!(run.state.held_by[cube], None);
        run.steps(40);
        assert!(run.position(cube).y < held_at - 0.3, "{address}");
    }
    // As heavy as it lifts it holds on.
    set(&mut run, &[("agent/0/body/lift_kg", 4.001)]).unwrap();
    run.steps(20);
    assert_eq!(run.state.agents[agent].holding, Some(cube));
}

/// A door with 0.5 N m of friction and as much damping is opened by 40 N m and not by 0.3: an agent's hand has its own
/// number, and commands that come from no agent have one of the world.
#[test]
fn a_hand_that_is_too_weak_opens_no_door() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let (door, joint) = build.wall_with_door(3.0, 6.0);
    let mut run = build.run();
    let agent = run.agent(Vec3::new(2.7, 0.0, 4.2), 0.0);
    run.steps(2);
    let opened = |run: &Run, address: &str, effort: f64, by_agent: bool| {
        let mut run = run.clone();
        set(&mut run, &[(address, effort)]).unwrap();
        if by_agent {
            let told = run.act(agent, dwell_physics::actions::Open::new(door));
            assert!(told.success, "{}", told.sentence);
        } else {
            run.state.joint_command[joint] = dwell_scene::JointCommand::Position(0.8);
        }
        run.steps(60);
        run.state.joint_position[joint]
    };
    let (own, world) = ("agent/0/body/hand_effort", "world/hand_effort");
    assert!(opened(&run, own, 40.0, true) > 0.7);
    assert!(opened(&run, own, 0.3, true) < 0.05);
    assert!(opened(&run, world, 0.3, true) > 0.7);
    assert!(opened(&run, world, 40.0, false) > 0.7);
    assert!(opened(&run, world, 0.3, false) < 0.05);
    assert!(opened(&run, own, 0.3, false) > 0.7);
}

#[test]
fn an_agent_grows_where_it_has_room_and_not_into_walls() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let table = Piece::cuboid(Vec3::new(0.5, 0.05, 0.5), Vec3::new(4.0, 1.75, 4.0));
    build.fixed("shelf", table);
    let mut run = build.run();
    let agent = run.agent(Vec3::new(0.5, 0.0, 3.0), 0.0);
    run.steps(2);
    let before = run.hash();
    let message = set(&mut run, &[("agent/0/body/radius_m", 0.6)]).unwrap_err();
    assert!(
        message.contains("agent 0") && message.contains("move the agent first"),
        "{message}"
    );
    assert!(run.hash() == before, "a refusal changes nothing");
    let tall = [
        ("agent/0/body/height_m", 1.9),
        ("agent/0/body/eye_height_m", 1.7),
    ];
    set(&mut run, &tall).unwrap();
    assert_eq!(run.state.agents[agent].eye_position().y, 1.7);
    set(&mut run, &[("agent/0/body/radius_m", 0.45)]).unwrap();
    // The wall keeps the new body's distance.
    run.walk(
        60,
        &[dwell_physics::AgentControl {
            right_m_s: -1.0,
            ..Default::default()
        }],
    );
    let x = run.state.agents[agent].position.x;
    assert!((0.45..0.47).contains(&x), "{x}");
    // Under a shelf at 1.7 m one of 1.9 m has no room; one of 1.5 m does, but cannot grow there.
    set(
        &mut run,
        &[
            ("agent/0/body/height_m", 1.5),
            ("agent/0/body/eye_height_m", 1.2),
        ],
    )
    .unwrap();
    run.world
        .place_agent(&mut run.state, agent, Vec3::new(4.0, 0.0, 4.0), 0.0)
        .unwrap();
    let message = set(&mut run, &tall).unwrap_err();
    assert!(message.contains("height 1.9"), "{message}");
    // Another agent blocks it too.
    run.agent(Vec3::new(4.0, 0.0, 5.0), 0.0);
    let message = set(&mut run, &[("agent/1/body/radius_m", 0.6)]).unwrap_err();
    assert!(message.contains("agent 1"), "{message}");
}

/// Arms, strength and legs with other numbers act accordingly, from the next action on.
#[test]
fn what_an_agent_can_do_follows_its_numbers() {
    let mut build = Build::room([8.0, 3.0, 8.0]);
    let half = Vec3::splat(0.1);
    let cube = build.movable("cube", Piece::cuboid(half, Vec3::new(4.0, 0.1, 3.0)));
    let step = Piece::cuboid(Vec3::new(0.5, 0.05, 0.5), Vec3::new(6.0, 0.05, 3.0));
    build.fixed("step", step);
    let mut run = build.run();
    let agent = run.agent(Vec3::new(4.0, 0.0, 4.0), 0.0);
    run.steps(2);
    let picks = |run: &mut Run| {
        run.clone()
            .act(agent, dwell_physics::actions::Pick::new(cube))
            .success
    };
    assert!(picks(&mut run));
    for (field, little) in [
        ("reach_m", 0.8),
        ("lift_kg", 1.0),
        ("max_carry_size_m", 0.19),
    ] {
        let address = format!("agent/0/body/{field}");
        let own = get(&run, &address);
        set(&mut run, &[(&address, little)]).unwrap();
        assert!(!picks(&mut run), "{field}");
        set(&mut run, &[(&address, own)]).unwrap();
        assert!(picks(&mut run), "{field}");
    }
    // It pushes the cube of 4 kg over the floor with 100 N and not with 5.
    let pushed = |run: &Run, force: f64| {
        let mut run = run.clone();
        set(&mut run, &[("agent/0/body/push_force_n", force)]).unwrap();
        let before = run.position(cube);
        run.walk(40, &[forward(1.0)]);
        (run.position(cube) - before).length()
    };
    assert!(pushed(&run, 100.0) > 0.5 && pushed(&run, 5.0) < 0.05);
    // A step of 0.1 m is climbed by legs that can, and stops those that cannot.
    let climbs = |run: &Run, step_m: f64| {
        let mut run = run.clone();
        set(&mut run, &[("agent/0/body/step_height_m", step_m)]).unwrap();
        let at = AgentPlacement::at_rest(agent, Vec3::new(6.0, 0.0, 4.0), 0.0);
        run.world.set_agents(&mut run.state, &[at]).unwrap();
        run.walk(20, &[forward(1.0)]);
        run.state.agents[AgentId(0)].position.y
    };
    assert!((climbs(&run, 0.2) - 0.1).abs() < 1e-3 && climbs(&run, 0.05).abs() < 1e-3);
    assert_eq!(ObjectId(0), cube);
}
