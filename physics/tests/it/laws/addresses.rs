//! Laws by their addresses: setting them at run time equals installing them.

use super::{lively, spec, spec_of};
use crate::common::Run;
use dwell_physics::laws;
use dwell_scene::{LawInfo, LawSpec};

fn known() -> Vec<&'static LawInfo> {
    laws::all().collect()
}

fn set(run: &mut Run, info: &LawInfo, name: &str, value: f64) {
    let (house, address) = (
        run.house.clone(),
        format!("law/{}/{name}", info.id).parse().unwrap(),
    );
    let state = &mut run.state;
    state
        .set_law_parameter(&house, &known(), &address, value)
        .unwrap();
    let there = state.law_parameter(&house, &known(), &address).unwrap();
    assert_eq!(there.value, value);
    run.world.apply_parameters(state).unwrap();
}

fn put(run: &mut Run, laws: Vec<LawSpec>) {
    run.state.laws = laws;
    run.world.apply_parameters(&mut run.state).unwrap();
}

/// Laws of masses: setting one computes all contacts anew, which rounds otherwise.
fn weighs(info: &LawInfo) -> bool {
    ["buoyancy", "center_of_mass_offset", "inertia_error"].contains(&info.id)
}

/// Half way from its default to the end of what is plausible.
fn between(acting: &LawSpec, param: &dwell_scene::law::ParamInfo) -> f64 {
    0.5 * (param.default + acting.params[param.name])
}

/// For every law in the list: all its numbers set by address before the first step are the law installed from the start, bit for bit (laws of
/// masses: to 1e-5 m).
#[test]
fn a_law_set_by_its_addresses_is_the_law_installed() {
    for info in laws::all() {
        let acting = spec_of(info, true);
        let mut installed = lively(vec![acting.clone()]);
        let mut told = lively(Vec::new());
        for param in info.params {
            set(&mut told, info, param.name, acting.params[param.name]);
        }
        installed.steps(20);
        told.steps(20);
        let same = told.state.part_pose == installed.state.part_pose;
        assert!(same || weighs(info), "{}", info.id);
        for (id, pose) in told.state.part_pose.iter_ids() {
            let off = pose.position - installed.state.part_pose[id].position;
            assert!(off.length() < 1e-5, "{} {id:?}: {off}", info.id);
        }
        assert!(
            told.state.joint_position == installed.state.joint_position,
            "{}",
            info.id
        );
    }
}

/// For every number of every law in the list: changed by its address while the world runs, the world goes on bit for bit as
/// one in which the law is installed with that number at that time, its state included; and set back before the next step,
/// as if nothing had been (bit for bit, but for laws of masses: to 1e-5 m).
#[test]
fn a_number_changed_by_its_address_is_the_law_with_that_number() {
    for info in laws::all() {
        let acting = spec_of(info, true);
        let mut run = lively(vec![acting.clone()]);
        run.steps(8);
        let mut went_on = run.clone();
        went_on.steps(12);
        for param in info.params {
            let (before, value) = (acting.params[param.name], between(&acting, param));
            let (mut told, mut installed) = (run.clone(), run.clone());
            set(&mut told, info, param.name, value);
            let mut other = acting.clone();
            other.params.insert(param.name.to_owned(), value);
            put(&mut installed, vec![other]);
            told.steps(12);
            installed.steps(12);
            assert!(
                told.world.unpacked_snapshot() == installed.world.unpacked_snapshot()
                    && told.state.part_pose == installed.state.part_pose,
                "{} {}",
                info.id,
                param.name
            );
            let mut back = run.clone();
            set(&mut back, info, param.name, value);
            set(&mut back, info, param.name, before);
            back.steps(12);
            let same = back.state.part_pose == went_on.state.part_pose;
            assert!(same || weighs(info), "{} {}", info.id, param.name);
            for (id, pose) in back.state.part_pose.iter_ids() {
                let off = pose.position - went_on.state.part_pose[id].position;
                assert!(off.length() < 1e-5, "{} {}: {off}", info.id, param.name);
            }
        }
    }
}

/// A change of the play's width or of a delay keeps the commands in progress: the joint goes on from where it is.
#[test]
fn what_a_law_remembers_outlives_a_change_of_its_numbers() {
    for (id, name, values) in [
        ("latency", "delay_s", [0.1, 0.2]),
        ("first_order_lag", "tau_s", [0.2, 0.3]),
        ("rate_limit", "max_rate", [2.0, 1.0]),
        ("backlash", "half_width", [0.1, 0.05]),
    ] {
        let info = LawInfo::find(laws::all(), id).unwrap();
        let joint = dwell_scene::JointId(0);
        let mut run = lively(vec![spec(id, None, &[(name, values[0])])]);
        run.steps(60);
        let before = run.state.joint_position[joint];
        assert!(before > 0.5, "{id}: {before}");
        set(&mut run, info, name, values[1]);
        let mut lowest = before;
        for _ in 0..40 {
            run.steps(1);
            lowest = lowest.min(run.state.joint_position[joint]);
        }
        // A law without its state would release the joint or lead it from its start again.
        assert!(lowest > before - 2e-3, "{id}: from {before} to {lowest}");
    }
}
