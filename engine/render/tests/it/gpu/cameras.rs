//! Agreement for every camera, with things and agents that have moved.

use super::agreement::Pair;
use super::compare::Count;
use super::houses::views;
use dwell_render::{Camera, PreviousPoses, Projection, VisibilityPath};
use dwell_scene::person::{person_pieces, skeleton_of};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentBody, AgentId, AgentState, Id, PartId, PersonGait, PersonState, Pose};
use glam::{Quat, Vec3};
use std::sync::Arc;

pub(crate) fn cameras() -> Vec<(&'static str, Camera)> {
    let new = |projection| Camera::new(64, 48, projection).unwrap();
    let (fx, fy, cx, cy) = (30.0, 29.0, 31.0, 25.0);
    vec![
        ("pinhole", new(Projection::Pinhole { fx, fy, cx, cy })),
        (
            "lens",
            new(Projection::BrownConrady {
                fx,
                fy,
                cx,
                cy,
                k1: -0.12,
                k2: 0.02,
                k3: 0.001,
                p1: 0.002,
                p2: -0.001,
            }),
        ),
        (
            "fisheye",
            new(Projection::Fisheye {
                fx: 17.0,
                fy: 18.0,
                cx,
                cy,
                k1: 0.01,
                k2: 0.001,
                k3: 0.0,
                k4: 0.0,
                half_angle_deg: 100.0,
            }),
        ),
        ("all around", Camera::equirectangular(96).unwrap()),
        ("cube map", Camera::cubemap(48).unwrap()),
        ("map", Camera::orthographic(64, 48, 5.0, 4.0).unwrap()),
        (
            "near and far",
            new(Projection::Pinhole { fx, fy, cx, cy })
                .with_range(1.5, 3.0)
                .unwrap(),
        ),
    ]
}

/// The pair of renderers with the earlier poses of moved parts, the earlier positions of agents, and those of the pieces of persons.
type Moved = (
    Pair,
    Vec<(PartId, Pose)>,
    Vec<Vec3>,
    Vec<(AgentId, Vec<Pose>)>,
);

/// The poses of the pieces of an agent that is a person.
fn figure(pair: &Pair, agent: AgentId) -> Vec<Pose> {
    let joints = skeleton_of(&pair.house, &pair.state, agent).unwrap();
    let pieces = person_pieces(&joints);
    pieces.iter().map(|piece| piece.pose).collect()
}

/// A furnished house in which parts and two agents have moved, of which the second is a person.
fn moved(path: VisibilityPath) -> Option<Moved> {
    let house = Arc::new(dwell_houses::open("seed:5").unwrap().0);
    let mut pair = Pair::new(house, path)?;
    let start: Vec<_> = views(&pair.house, Camera::cubemap(4).unwrap(), 2)
        .iter()
        .map(|view| view.world_from_camera.position)
        .collect();
    let feet: Vec<Vec3> = start
        .iter()
        .map(|eye| Vec3::new(eye.x, 0.05, eye.z))
        .collect();
    for feet in &feet {
        let body = AgentState::new(AgentBody::default(), *feet + Vec3::new(0.1, 0.0, 0.05), 0.4);
        pair.state.agents.push(body);
    }
    let walker = AgentId::from_index(1);
    let body = AgentBody::person(1.6);
    pair.state.agents[walker].body = body;
    let mut person = PersonState::new(body.person.unwrap(), RandomKey::root(3));
    person.gait = PersonGait {
        phase: 0.15,
        stride_m: 1.1,
        direction: glam::Vec2::Y,
    };
    pair.state.persons.insert(walker, person);
    let persons = vec![(walker, figure(&pair, walker))];
    person.gait.phase = 0.25;
    person.gesture.right_hand = Some(feet[1] + Vec3::new(0.4, 1.2, -0.3));
    pair.state.persons.insert(walker, person);
    let mut before = Vec::new();
    for (k, part) in pair.house.geometry().movable.iter().enumerate() {
        if k % 3 == 0 {
            continue;
        }
        before.push((*part, pair.state.part_pose[*part]));
        let pose = &mut pair.state.part_pose[*part];
        pose.position += Vec3::new(0.03, 0.02, -0.04);
        pose.rotation = Quat::from_rotation_y(0.1) * pose.rotation;
    }
    before.sort_by_key(|(part, _)| part.index());
    pair.scene.update(&pair.state);
    Some((pair, before, feet, persons))
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn every_camera_sees_the_same_by_cpu_and_gpu_after_things_moved() {
    cameras_agree(VisibilityPath::Compute, &cameras());
}

#[test]
fn pinholes_see_the_same_by_raster_after_things_moved() {
    let pinholes: Vec<_> = cameras()
        .into_iter()
        .filter(|(_, camera)| matches!(camera.projection(), Projection::Pinhole { .. }))
        .collect();
    assert_eq!(pinholes.len(), 2);
    cameras_agree(VisibilityPath::Raster, &pinholes);
}

fn cameras_agree(path: VisibilityPath, cameras: &[(&'static str, Camera)]) {
    let Some((pair, parts, agents, persons)) = moved(path) else {
        return;
    };
    for (name, camera) in cameras.iter().copied() {
        let views = views(&pair.house, camera, 10);
        let mut compared = Count::default();
        for (k, view) in views.iter().enumerate() {
            let mut was = view.world_from_camera;
            was.position += Vec3::new(0.02, -0.01, 0.03);
            was.rotation *= Quat::from_rotation_y(0.02);
            let before = PreviousPoses {
                world_from_camera: was,
                moved_parts: &parts,
                agents: &agents,
                persons: &persons,
            };
            let mut view = *view;
            // Every other camera is the first agent's.
            view.hidden_entity =
                (k % 2 == 0).then(|| pair.house.entity_of_agent(AgentId::from_index(0)));
            for frames in pair.shoot_after(&[view], Some(before)) {
                compared.compare(&format!("{name}, view {k}"), &camera, &frames);
            }
        }
        compared.finish(name, path, 0.03);
    }
}
