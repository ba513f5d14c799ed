//! Agents' bodies at the start of a world: one too large for the house is refused, one in the way is moved aside.
//!
//! Regression: a body that was too large was refused only when it grew in a running world; one that began so stood in walls
//! and ceiling.

use crate::common::{Build, Piece, Run};
use dwell_physics::{PhysicsConfig, PhysicsWorld};
use dwell_scene::{AgentBody, AgentId, AgentState, House, State};
use glam::Vec3;
use std::sync::Arc;

/// A room of 4 m by 2 m, 2.5 m high, with a table of 0.8 m by 0.8 m at x = 1.
fn room() -> Arc<House> {
    let mut build = Build::room([4.0, 2.5, 2.0]);
    let table = Piece::cuboid(Vec3::new(0.4, 0.4, 0.4), Vec3::new(1.0, 0.4, 1.0));
    build.fixed("table", table);
    build.house()
}

fn state(house: &House, body: AgentBody, at: Vec3) -> State {
    let mut state = State::new(house);
    state.agents.push(AgentState::new(body, at, 0.0));
    state
}

fn refused(house: &Arc<House>, mut state: State) -> String {
    let made = PhysicsWorld::new(house.clone(), PhysicsConfig::default(), &mut state);
    made.unwrap_err().to_string()
}

#[test]
fn a_body_that_no_room_has_room_for_is_refused() {
    let house = room();
    let plain = AgentBody::default();
    let at = Vec3::new(3.0, 0.0, 1.0);
    for (field, body) in [
        (
            "radius 1 m",
            AgentBody {
                radius_m: 1.0,
                height_m: 2.2,
                ..plain
            },
        ),
        (
            "height 3 m",
            AgentBody {
                height_m: 3.0,
                ..plain
            },
        ),
    ] {
        let message = refused(&house, state(&house, body, at));
        for part in ["agent 0", field, "no room of the house"] {
            assert!(message.contains(part), "{message}");
        }
    }
    // The same by values set in the initial state.
    let mut tall = state(&house, plain, at);
    let height = "agent/0/body/height_m".parse().unwrap();
    tall.set_parameter(&house, &height, 2.9).unwrap();
    let message = refused(&house, tall);
    assert!(message.contains("height 2.9 m"), "{message}");
    // A body that just fits between the walls is not refused.
    let wide = AgentBody {
        radius_m: 0.95,
        height_m: 2.2,
        ..plain
    };
    let run = Run::from_state(
        house.clone(),
        PhysicsConfig::default(),
        state(&house, wide, at),
    );
    assert!((run.state.agents[AgentId(0)].position - at).length() < 0.1);
}

/// At the nearest place: beside a table 0.4 m wide to either side, a body of 0.2 m stands 0.6 m from its middle, up to a row.
#[test]
fn an_agent_that_begins_in_a_table_stands_beside_it() {
    let house = room();
    let middle = Vec3::new(1.0, 0.0, 1.0);
    let begun = |body: AgentBody, at: Vec3| {
        let config = PhysicsConfig::default();
        Run::from_state(house.clone(), config, state(&house, body, at))
    };
    let mut run = begun(AgentBody::default(), middle);
    let now = run.state.agents[AgentId(0)].position;
    let (dx, dz) = ((now.x - 1.0).abs(), (now.z - 1.0).abs());
    assert!((0.6..0.75).contains(&dx.max(dz)) && now.y == 0.0, "{now}");
    let report = &run.report.agents;
    assert_eq!((report.len(), report[0].agent), (1, AgentId(0)));
    assert!((report[0].distance_m - now.distance(middle)).abs() < 1e-6);
    run.steps(5);
    assert!(run.state.agents[AgentId(0)].position.distance(now) < 1e-3);
    // An agent with room stays, bit for bit.
    let free = Vec3::new(3.0, 0.0, 1.0);
    let run = begun(AgentBody::default(), free);
    assert_eq!(run.state.agents[AgentId(0)].position, free);
    assert!(run.report.agents.is_empty());
}

/// Agents with one start pose stand beside each other, the first at the pose; those for which there is no room share a position.
#[test]
fn agents_that_are_told_one_place_stand_beside_each_other() {
    let at = Vec3::new(3.0, 0.0, 1.0);
    let beside = |house: &Arc<House>, count: usize| {
        let mut state = State::new(house);
        for _ in 0..count {
            let agent = AgentState::new(AgentBody::default(), at, 0.0);
            state.agents.push(agent);
        }
        let made = PhysicsWorld::new(house.clone(), PhysicsConfig::default(), &mut state);
        let moved = made.unwrap().1.agents.len();
        let places: Vec<Vec3> = state.agents.iter().map(|agent| agent.position).collect();
        (places, moved)
    };
    let near_m = 2.0 * AgentBody::default().radius_m;
    let apart = |places: &[Vec3]| {
        let pairs = (0..places.len()).flat_map(|k| (0..k).map(move |j| (k, j)));
        let mut gaps = pairs.map(|(k, j)| places[k].distance(places[j]));
        gaps.all(|gap_m| gap_m > near_m)
    };
    let (places, moved) = beside(&room(), 5);
    assert_eq!(places[0], at);
    assert!(apart(&places), "{places:?}");
    assert_eq!(moved, 4);
    let (places, _) = beside(&room(), 64);
    assert!(!apart(&places));
}
