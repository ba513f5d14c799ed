//! Laws against their closed forms, and unchanged bits without them.

mod actuators;
mod bodies;
mod contacts;

use crate::common::{Build, Piece, Run};
use dwell_physics::{PhysicsConfig, laws};
use dwell_scene::{JointCommand, JointKind, LawInfo, LawSpec, Mobility, Servo, State};
use glam::Vec3;

fn spec(id: &str, target: Option<&str>, params: &[(&str, f64)]) -> LawSpec {
    LawSpec {
        id: id.into(),
        version: 1,
        target: target.map(str::to_owned),
        params: params
            .iter()
            .map(|(name, value)| ((*name).to_owned(), *value))
            .collect(),
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

#[test]
fn a_law_at_its_default_changes_no_bit() {
    let plain = |laws: Vec<LawSpec>| {
        let house = tower().house();
        let mut state = State::new(&house);
        state.laws = laws;
        let mut run = Run::from_state(house, PhysicsConfig::default(), state);
        let joint = run.house.joints.ids().next().unwrap();
        run.state.joint_command[joint] = JointCommand::Position(0.7);
        run.steps(40);
        run.state.laws.clear();
        run.hash()
    };
    let without = plain(Vec::new());
    for info in laws::all() {
        let params: Vec<(&str, f64)> = info
            .params
            .iter()
            .map(|param| (param.name, param.default))
            .collect();
        assert!(
            plain(vec![spec(info.id, None, &params)]) == without,
            "{}",
            info.id
        );
        assert!(
            plain(vec![spec(info.id, None, &[])]) == without,
            "{}",
            info.id
        );
    }
    let drag = plain(vec![spec("drag", None, &[("c_d", 0.5)])]);
    assert!(drag != without);
}

#[test]
fn every_law_says_all_there_is_to_say() {
    for LawInfo {
        id,
        version,
        name,
        equation,
        source,
        acts_on,
        params,
        rivals,
        separating_experiment,
        ..
    } in laws::all()
    {
        assert!(*version > 0, "{id}");
        for text in [name, equation, source, acts_on, separating_experiment] {
            assert!(text.len() > 4, "{id}: {text:?}");
        }
        assert!(!params.is_empty() && !rivals.is_empty(), "{id}");
        for param in *params {
            assert!(
                (param.low..=param.high).contains(&param.default),
                "{id} {}",
                param.name
            );
            assert!(
                param.plausible[0] <= param.plausible[1] && !param.unit.is_empty(),
                "{id} {}",
                param.name
            );
        }
    }
}

#[test]
fn a_law_without_its_target_is_refused_with_the_names_there_are() {
    let house = tower().house();
    let mut state = State::new(&house);
    for (id, param, names) in [("drag", "c_d", "ball"), ("backlash", "half_width", "elbow")] {
        state.laws = vec![spec(id, Some("nothing"), &[(param, 0.1)])];
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
