//! Rules for a furnished house when its physics begins.

use super::RuleViolation;
use dwell_physics::{PhysicsConfig, PhysicsWorld};
use dwell_scene::{House, Id, ObjectId, State};
use glam::Vec3;
use std::sync::Arc;

/// Simulated time, s.
const DURATION_S: f32 = 2.0;
/// No pickable thing may have moved farther, m.
const FARTHEST_M: f32 = 0.02;

/// Lets physics run with nobody in the house: what overlapped at the start, and pickable things that moved.
pub(super) fn faults(house: &Arc<House>) -> Vec<RuleViolation> {
    let fault = |rule, what| RuleViolation { rule, what };
    let mut state = State::new(house);
    let place = |state: &State, id: ObjectId| -> Vec3 {
        state.part_pose[house.objects[id].first_part].position
    };
    let before: Vec<Vec3> = house.objects.ids().map(|id| place(&state, id)).collect();
    let config = PhysicsConfig::default();
    let steps = (DURATION_S * config.control_rate_hz).round() as usize;
    let (mut world, report) = match PhysicsWorld::new(house.clone(), config, &mut state) {
        Ok(made) => made,
        Err(error) => return vec![fault("physics", error.to_string())],
    };
    let mut faults = Vec::new();
    for moved in &report.moved {
        faults.push(fault("start", format!("{moved:?}")));
    }
    for frozen in &report.frozen {
        faults.push(fault("start", format!("{frozen:?}")));
    }
    let mut events = Vec::new();
    for _ in 0..steps {
        if let Err(error) = world.step(&mut state, &[], &mut events) {
            faults.push(fault("physics", error.to_string()));
            return faults;
        }
        events.clear();
    }
    for (id, object) in house.objects.iter_ids() {
        let far_m = (place(&state, id) - before[id.index()]).length();
        let stayed = far_m <= FARTHEST_M;
        if object.pickable && !stayed {
            let name = &object.name;
            faults.push(fault("settle", format!("{name} moved {far_m:.3} m")));
        }
    }
    faults
}
