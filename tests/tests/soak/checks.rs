//! Invariants after every step.

use dwell::World;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::{Aabb, StructureKind, SurfaceOwner};
use glam::Vec3;

/// Largest distance of a thing from the box around the house: that of one that leans out of a window, m.
const MARGIN_M: f32 = 1.0;

/// The most that a snapshot may hold, bytes.
pub(crate) fn largest_snapshot(world: &World) -> usize {
    (256 + 2 * world.start_report().bodies) * 1024
}

/// Returns whether the way from one place to the next leads through a wall, floor or ceiling.
fn passes_structure(world: &World, from: Vec3, to: Vec3) -> bool {
    let way = to - from;
    let ray = Ray {
        far_m: way.length(),
        ..Ray::new(from, way)
    };
    if way.length() < 1e-5 {
        return false;
    }
    let rays = world.rays();
    rays.closest(&ray, RayMask::AGENT).is_some_and(|hit| {
        let walled = |id| world.house().structure[id].kind != StructureKind::Other;
        matches!(rays.surface(&hit).owner, SurfaceOwner::Structure(id) if walled(id))
    })
}

/// Returns where every agent is.
pub(crate) fn places(world: &World) -> Vec<Vec3> {
    let agents = world.state().agents.iter();
    agents.map(|agent| agent.position).collect()
}

/// Everything is somewhere in the house, at finite speed; no agent passed a wall since it was `before`; who holds what is
/// held by it.
pub(crate) fn check(world: &World, before: &[Vec3], at: usize) {
    let (state, house) = (world.state(), world.house());
    let levels = house.levels.iter();
    let bounds = levels
        .fold(Aabb::EMPTY, |all, level| all.union(&level.bounds))
        .grown(MARGIN_M);
    for (part, pose) in state.part_pose.iter_ids() {
        let name = &house.objects[house.parts[part].object].name;
        assert!(pose.is_valid(), "step {at}: {name} is nowhere: {pose:?}");
        assert!(
            bounds.contains(pose.position),
            "step {at}: {name} left the house: {:?}",
            pose.position
        );
        let velocity = state.part_velocity[part];
        assert!(velocity.linear.is_finite() && velocity.angular.is_finite());
    }
    let joints = state.joint_position.iter().zip(&state.joint_velocity);
    for (k, (position, velocity)) in joints.enumerate() {
        let finite = position.is_finite() && velocity.is_finite();
        assert!(finite, "step {at}: joint {k}: {position} {velocity}");
    }
    for ((id, agent), before) in state.agents.iter_ids().zip(before) {
        assert!(
            bounds.contains(agent.position),
            "step {at}: agent {} left the house: {:?}",
            id.0,
            agent.position
        );
        let middle = Vec3::Y * (0.5 * agent.height_m());
        assert!(
            !passes_structure(world, *before + middle, agent.position + middle),
            "step {at}: agent {} passed a wall from {before:?} to {:?}",
            id.0,
            agent.position
        );
        if let Some(object) = agent.holding {
            assert_eq!(state.held_by[object], Some(id), "step {at}");
        }
    }
    let held = state.held_by.iter().flatten().count();
    let holding = state.agents.iter().filter(|a| a.holding.is_some()).count();
    assert_eq!(held, holding, "step {at}: who holds what");
}
