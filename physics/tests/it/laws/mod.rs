//! Laws against their closed forms, and unchanged bits without them.

mod actuators;
mod addresses;
mod bases;
mod bodies;
mod contacts;
mod floating;
mod friction;
mod links;
mod loads;
mod targets;

use crate::common::{Build, Piece, Run};
use dwell_physics::{PhysicsConfig, laws};
use dwell_scene::{JointCommand, JointKind, LawInfo, LawSpec, Mobility, Servo, State};
use glam::Vec3;

pub(crate) fn spec(id: &str, target: Option<&str>, params: &[(&str, f64)]) -> LawSpec {
    let law = LawInfo::find(laws::all(), id).unwrap();
    LawSpec {
        target: target.map(str::to_owned),
        ..law.spec(params)
    }
}

fn tower() -> Build {
    let mut build = Build::room([4.0, 100.0, 4.0]);
    build.movable(
        "ball",
        Piece::ball(0.1, Vec3::new(2.0, 99.0, 2.0)).density(30.0),
    );
    build.movable(
        "other",
        Piece::ball(0.1, Vec3::new(1.0, 99.0, 2.0)).density(30.0),
    );
    // A sliding and a rolling, spinning body on the floor.
    let half = Vec3::new(0.2, 0.1, 0.15);
    build.movable("sled", Piece::cuboid(half, Vec3::new(1.0, 0.1, 1.0)));
    let marble = Piece::ball(0.05, Vec3::new(1.0, 0.25, 3.0)).of("glass");
    build.movable("marble", marble);
    let arm = Piece::cuboid(Vec3::new(0.2, 0.02, 0.02), Vec3::new(2.2, 2.0, 1.0));
    let arm = build.object("arm", Mobility::Articulated, &[arm]);
    let joint = build.joint(
        arm,
        JointKind::Hinge,
        Vec3::Y,
        Vec3::new(2.0, 2.0, 1.0),
        [-2.0, 2.0],
    );
    build.data.joints[joint].name = "elbow".into();
    build.data.joints[joint].servo = Some(Servo {
        stiffness: 50.0,
        damping: 2.0,
        max_effort: 100.0,
        ..Servo::default()
    });
    build
}

/// The tower with the servo told to move, the sled pushed and the marble thrown and spinning.
fn lively(laws: Vec<LawSpec>) -> Run {
    let house = tower().house();
    let mut state = State::new(&house);
    state.laws = laws;
    let mut run = Run::from_state(house, PhysicsConfig::default(), state);
    let joint = run.house.joints.ids().next().unwrap();
    run.state.joint_command[joint] = JointCommand::Position(0.7);
    for (name, linear, angular) in [
        ("sled", Vec3::new(0.8, 0.0, 0.5), Vec3::new(0.0, 2.0, 0.0)),
        ("marble", Vec3::new(0.9, 0.0, 0.0), Vec3::new(3.0, 9.0, 0.0)),
        ("ball", Vec3::new(0.5, 0.0, 0.1), Vec3::new(1.0, 5.0, 0.0)),
    ] {
        let root = run.root(run.house.object_named(name).unwrap());
        run.state.part_velocity[root].linear = linear;
        run.state.part_velocity[root].angular = angular;
    }
    run.world.adopt_state(&mut run.state).unwrap();
    run
}

/// A law with every parameter at its default, or at the end of its plausible range that is not.
fn spec_of(info: &LawInfo, acts: bool) -> LawSpec {
    let value = |param: &dwell_scene::law::ParamInfo| match param.plausible {
        [low, high] if acts && high == param.default => low,
        [_, high] if acts => high,
        _ => param.default,
    };
    let params: Vec<(&str, f64)> = info.params.iter().map(|p| (p.name, value(p))).collect();
    info.spec(&params)
}

#[test]
fn a_law_at_its_default_changes_no_bit() {
    let plain = |laws: Vec<LawSpec>| {
        let mut run = lively(laws);
        run.steps(40);
        run.state.laws.clear();
        run.hash()
    };
    let without = plain(Vec::new());
    for info in laws::all() {
        for law in [spec_of(info, false), info.spec(&[])] {
            assert!(plain(vec![law]) == without, "{}", info.id);
        }
    }
}

/// Every law that acts on bodies changes their motion, and every law goes on with the same bits in a restored world,
/// whatever its state.
#[test]
fn a_law_acts_and_goes_on_bit_for_bit_after_a_restore() {
    let mut without = lively(Vec::new());
    without.steps(20);
    for info in laws::all() {
        let mut run = lively(vec![spec_of(info, true)]);
        run.steps(20);
        if ["object", "contact", "world"].contains(&info.acts_on) {
            let moved = run.state.part_pose != without.state.part_pose;
            assert!(moved, "{} does nothing", info.id);
        }
        let (state, bytes) = (run.state.clone(), run.world.snapshot());
        run.steps(20);
        let mut again = lively(Vec::new());
        again.steps(3);
        again.state = state;
        again.world.restore(&mut again.state, &bytes).unwrap();
        again.steps(20);
        assert!(run.hash() == again.hash(), "{}", info.id);
    }
}

/// Laws that are installed and removed while a world runs leave masses, inertia and contacts as they were.
#[test]
fn laws_that_go_leave_nothing_behind() {
    let mut without = lively(Vec::new());
    let mut run = lively(Vec::new());
    run.state.laws = laws::all().map(|info| spec_of(info, true)).collect();
    run.world.apply_parameters(&mut run.state).unwrap();
    run.state.laws.clear();
    run.world.apply_parameters(&mut run.state).unwrap();
    without.steps(20);
    run.steps(20);
    for (id, pose) in without.state.part_pose.iter_ids() {
        let apart = (run.state.part_pose[id].position - pose.position).length();
        assert!(apart < 1e-5, "{id:?}: {apart} m");
    }
}

#[test]
fn a_law_without_its_target_is_refused_with_the_names_there_are() {
    let house = tower().house();
    let mut state = State::new(&house);
    for (id, target, param, names) in [
        ("drag", "nothing", "c_d", "ball"),
        ("backlash", "nothing", "half_width", "elbow"),
        ("rolling_resistance", "nothing", "c_rr", "marble"),
        ("rolling_resistance", "parquet~nothing", "c_rr", "marble"),
        (
            "contact_compliance",
            "nothing",
            "natural_frequency_hz",
            "all contacts",
        ),
    ] {
        state.laws = vec![spec(id, Some(target), &[(param, 0.1)])];
        let message =
            dwell_physics::PhysicsWorld::new(house.clone(), PhysicsConfig::default(), &mut state)
                .unwrap_err()
                .to_string();
        assert!(
            message.contains("nothing") && message.contains(names),
            "{message}"
        );
    }
    state.laws = vec![spec("drag", None, &[("c_d", 1e6)])];
    assert!(dwell_physics::PhysicsWorld::new(house, PhysicsConfig::default(), &mut state).is_err());
}
