//! One law on one target, however it is named, and on agents that are added later.

use super::{spec, tower};
use crate::common::{Build, Run};
use dwell_physics::{AgentControl, PhysicsConfig, laws};
use dwell_scene::{AgentBody, AgentId, AgentState, DifferentialDrive, LawInfo, Locomotion, State};
use glam::Vec3;

fn known() -> Vec<&'static LawInfo> {
    laws::all().collect()
}

/// Regression: a joint named by number and by name got the law twice, and twice its delay.
#[test]
fn a_joint_in_three_spellings_has_a_law_once() {
    let house = tower().house();
    let spellings = ["elbow", "0", "arm/elbow", "+0"];
    let mut state = State::new(&house);
    for (k, target) in spellings.iter().enumerate() {
        let address = format!("law/latency@{target}/delay_s").parse().unwrap();
        let delay = 0.1 + 0.01 * k as f64;
        state
            .set_law_parameter(&house, &known(), &address, delay)
            .unwrap();
        assert_eq!(state.laws.len(), 1, "{target}");
        for other in spellings {
            let other = format!("law/latency@{other}/delay_s").parse().unwrap();
            let there = state.law_parameter(&house, &known(), &other).unwrap();
            assert_eq!(there.value, delay);
        }
    }
    assert_eq!(state.laws[0].target.as_deref(), Some("arm/elbow"));
    let listed = state.law_addresses(&known());
    assert_eq!(listed[0].as_str(), "law/latency@arm/elbow/delay_s");
    let both = ["law/latency@0/delay_s", "law/latency@elbow/delay_s"];
    let both = both.map(|address| (address.parse().unwrap(), 0.2));
    let before = state.clone();
    let message = state
        .set_law_parameters(&house, &known(), &both)
        .unwrap_err();
    assert!(message.to_string().contains("two spellings"), "{message}");
    assert_eq!(state, before);
}

/// Laws in a list on one target under two names are refused. (Under one name they are two laws one after the other.)
#[test]
fn a_law_on_one_thing_under_two_names_is_refused() {
    let house = tower().house();
    for (id, param, one, other) in [
        ("latency", "delay_s", "elbow", "0"),
        ("latency", "delay_s", "arm/elbow", "elbow"),
        ("drag", "c_d", "ball", "ball/part_0"),
        (
            "rolling_resistance",
            "coefficient_m",
            "glass~parquet",
            "parquet~glass",
        ),
    ] {
        let info = LawInfo::find(laws::all(), id).unwrap();
        let param = info.param(param).unwrap_or(&info.params[0]).name;
        let mut state = State::new(&house);
        state.laws = [one, other]
            .map(|target| info.spec(&[(param, 0.01)]).with_target(target))
            .into();
        let config = PhysicsConfig::default();
        let refused = dwell_physics::PhysicsWorld::new(house.clone(), config, &mut state);
        let message = refused.unwrap_err().to_string();
        for part in [id, one, other, "one spelling"] {
            assert!(message.contains(part), "{message}");
        }
    }
}

/// Regression: a name that several joints have, beside another name of one of them, was two laws on that joint.
#[test]
fn a_name_of_several_joints_is_refused_beside_one_of_them() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    build.wall_with_door(3.0, 6.0);
    build.chest(Vec3::new(1.0, 0.0, 1.0));
    let house = build.house();
    let refused = |targets: [&str; 2]| {
        let mut state = State::new(&house);
        let law = |target| spec("joint_friction", Some(target), &[("coulomb", 0.2)]);
        state.laws = targets.map(law).into();
        let config = PhysicsConfig::default();
        let made = dwell_physics::PhysicsWorld::new(house.clone(), config, &mut state);
        made.err().map(|error| error.to_string())
    };
    for one in ["door_1/hinge", "0", "chest_of_drawers/hinge"] {
        for targets in [["hinge", one], [one, "hinge"]] {
            let message = refused(targets).expect("they share a joint");
            for part in ["hinge", one, "one spelling"] {
                assert!(message.contains(part), "{message}");
            }
        }
    }
    assert_eq!(refused(["door_1/hinge", "chest_of_drawers/hinge"]), None);
    // The same by addresses: nothing has changed then.
    let mut state = State::new(&house);
    let mut set = |target: &str| {
        let address = format!("law/joint_friction@{target}/coulomb")
            .parse()
            .unwrap();
        let set = state.set_law_parameter(&house, &known(), &address, 0.2);
        (set.is_ok(), state.laws.len())
    };
    assert_eq!(set("hinge"), (true, 1));
    assert_eq!(set("door_1/hinge"), (false, 1));
}

fn body() -> AgentBody {
    AgentBody {
        locomotion: Locomotion::DifferentialDrive(DifferentialDrive::default()),
        ..AgentBody::default()
    }
}

/// A law for all bases applies to those added later; one for a single base does not.
#[test]
fn a_law_for_all_bases_reaches_those_that_come_later() {
    let house = Build::room([20.0, 3.0, 20.0]).house();
    for (target, reaches) in [(None, true), (Some("0"), false)] {
        for first in [true, false] {
            if !first && target.is_some() {
                continue;
            }
            let mut state = State::new(&house);
            if first {
                let at = Vec3::new(10.0, 0.0, 10.0);
                state.agents.push(AgentState::new(body(), at, 0.0));
            }
            state.laws = vec![
                spec("gyro_bias_scale", target, &[("bias_rad_s", 0.02)]),
                spec("unequal_wheels", target, &[("radius_ratio", 1.1)]),
            ];
            let mut run = Run::from_state(house.clone(), PhysicsConfig::default(), state);
            let later = run.agent_with(body(), Vec3::new(5.0, 0.0, 10.0), 0.0);
            run.agent(Vec3::new(15.0, 0.0, 10.0), 0.0);
            let told = AgentControl {
                wheel_rad_s: Some([10.0; 2]),
                ..AgentControl::default()
            };
            let controls: Vec<AgentControl> = run
                .state
                .agents
                .iter()
                .map(|agent| match agent.body.locomotion {
                    Locomotion::Walking(_) => AgentControl::default(),
                    _ => told,
                })
                .collect();
            run.walk(20, &controls);
            let agents = &run.state.agents;
            let bent = agents[later].yaw_rad.abs() > 0.05;
            assert_eq!(bent, reaches, "{target:?} {}", agents[later].yaw_rad);
            run.steps(10);
            let agents = &run.state.agents;
            let reads = agents[later].gyro_rad_s;
            assert_eq!((reads - 0.02).abs() < 1e-6, reaches, "{target:?} {reads}");
            if first {
                assert!((agents[AgentId(0)].gyro_rad_s - 0.02).abs() < 1e-6);
            }
            let walker = agents.iter().last().unwrap();
            assert_eq!(walker.gyro_rad_s, 0.0);
        }
    }
}
