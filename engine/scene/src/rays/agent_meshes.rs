//! Meshes of agents' bodies for cameras: capsules of three pieces, each a mesh of unit size that is stretched to the agent, and
//! the pieces of persons. Every agent has places for both; those of the other kind are hidden.

use crate::bvh::{RayMask, TriangleAttributes, TriangleBvh};
use crate::house::House;
use crate::ids::AgentId;
use crate::mesh::Mesh;
use crate::person::{PERSON_PIECES, person_meshes, person_pieces, skeleton_of};
use crate::space::Pose;
use crate::state::{AgentState, State};
use glam::{Affine3A, Quat, Vec3};
use std::f32::consts::{PI, TAU};
use std::sync::{Arc, LazyLock};

/// Pieces of a capsule: the lower end, the middle, the upper end.
pub const CAPSULE_PIECES: usize = 3;

/// Pieces of a body: those of a capsule, then those of a person.
pub const BODY_PIECES: usize = CAPSULE_PIECES + PERSON_PIECES;

/// Corners around a piece.
const AROUND: u16 = 24;
/// Rows of triangles from pole to pole of an end.
const ROWS: u16 = 12;

struct AgentMeshes {
    meshes: Vec<Mesh>,
    trees: Vec<Arc<TriangleBvh>>,
}

static SHAPES: LazyLock<AgentMeshes> = LazyLock::new(|| {
    let ball: Vec<(f32, f32)> = (0..=ROWS)
        .map(|k| {
            let (sine, cosine) = crate::math::sin_cos(PI * f32::from(k) / f32::from(ROWS));
            // The sine of pi as an f32 is below 0.
            (if k == ROWS { 0.0 } else { sine }, -cosine)
        })
        .collect();
    let ball = turned(&ball, &ball);
    let tube = turned(&[(1.0, 0.0), (1.0, 1.0)], &[(1.0, 0.0), (1.0, 0.0)]);
    let mut meshes = vec![ball.clone(), tube, ball];
    let tree = |mesh: &Mesh| {
        let tag = |_| TriangleAttributes {
            id: 0,
            mask: RayMask::BODY,
        };
        Arc::new(TriangleBvh::build_tagged(
            &mesh.positions,
            &mesh.triangles,
            tag,
        ))
    };
    let mut trees: Vec<_> = meshes.iter().map(tree).collect();
    for piece in person_meshes() {
        meshes.push(piece.mesh.clone());
        trees.push(piece.tree.clone());
    }
    AgentMeshes { meshes, trees }
});

/// A surface of revolution about Y, facing outwards. `profile`: radius and height from below; `normals`: likewise.
fn turned(profile: &[(f32, f32)], normals: &[(f32, f32)]) -> Mesh {
    let mut mesh = Mesh::default();
    for (place, normal) in profile.iter().zip(normals) {
        for step in 0..AROUND {
            let (sine, cosine) = crate::math::sin_cos(TAU * f32::from(step) / f32::from(AROUND));
            let at =
                |(radius, height): (f32, f32)| Vec3::new(radius * cosine, height, -radius * sine);
            mesh.positions.push(at(*place));
            mesh.normals.push(at(*normal));
        }
    }
    let around = u32::from(AROUND);
    for row in 1..profile.len() as u32 {
        for step in 0..around {
            let next = (step + 1) % around;
            let corner = |row: u32, step: u32| row * around + step;
            let (a, b) = (corner(row - 1, step), corner(row - 1, next));
            let (c, d) = (corner(row, step), corner(row, next));
            // At a pole a row is one point: one of its triangles has no area.
            if profile[row as usize - 1].0 > 0.0 {
                mesh.triangles.push([a, b, d]);
            }
            if profile[row as usize].0 > 0.0 {
                mesh.triangles.push([a, d, c]);
            }
        }
    }
    mesh
}

/// The meshes of a body's pieces. Those of a capsule are of unit radius; the middle reaches from 0 to 1 along Y, the ends are
/// centred. Those of a person are of unit height.
pub fn body_meshes() -> &'static [Mesh] {
    &SHAPES.meshes
}

/// The trees of [`body_meshes`].
pub fn body_trees() -> &'static [Arc<TriangleBvh>] {
    &SHAPES.trees
}

/// Returns the transforms of an agent's pieces, and writes how those of a person are placed and coloured.
pub(super) fn place_body(
    (house, state): (&House, &State),
    (id, agent): (AgentId, &AgentState),
    placed: &mut [Option<PlacedPiece>],
) -> [Affine3A; BODY_PIECES] {
    let mut transforms = [Affine3A::ZERO; BODY_PIECES];
    let person = state.persons.get(&id).zip(skeleton_of(house, state, id));
    let Some((person, joints)) = person else {
        placed.fill(None);
        transforms[..CAPSULE_PIECES].copy_from_slice(&capsule_transforms(agent));
        return transforms;
    };
    placed[..CAPSULE_PIECES].fill(None);
    for (k, piece) in person_pieces(&joints).iter().enumerate() {
        transforms[CAPSULE_PIECES + k] = piece.world_from_mesh();
        placed[CAPSULE_PIECES + k] = Some(PlacedPiece {
            pose: piece.pose,
            srgb: person.look.color(k),
        });
    }
    transforms
}

/// A piece of a person in the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedPiece {
    /// `world_from_piece`.
    pub pose: Pose,
    /// Its colour, sRGB.
    pub srgb: [u8; 3],
}

/// Returns the transforms of a capsule of an agent's radius from its feet to its present height.
fn capsule_transforms(agent: &AgentState) -> [Affine3A; CAPSULE_PIECES] {
    let radius = agent.body.radius_m;
    let middle = (agent.height_m() - 2.0 * radius).max(0.0);
    let at = |height: f32, scale: Vec3| {
        let place = agent.position + Vec3::Y * height;
        Affine3A::from_scale_rotation_translation(scale, Quat::IDENTITY, place)
    };
    [
        at(radius, Vec3::splat(radius)),
        at(radius, Vec3::new(radius, middle, radius)),
        at(radius + middle, Vec3::splat(radius)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::Ray;
    use crate::rays::RayScene;
    use crate::state::AgentBody;
    use crate::{AgentState, House, ShoeboxMaterials, State};

    /// The body ends sideways at its radius, above at its height; only rays with the body mask hit it.
    #[test]
    fn a_body_is_a_capsule_for_rays_that_look_for_bodies() {
        let house =
            Arc::new(House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap());
        let mut state = State::new(&house);
        let mut scene = RayScene::new(house.clone());
        let (feet, eye) = (Vec3::new(3.0, 0.0, 2.0), Vec3::new(1.0, 1.0, 2.0));
        let ray = Ray::new(eye, Vec3::X);
        scene.update(&state);
        let wall = scene
            .closest(&ray, RayMask::EYE.union(RayMask::BODY))
            .unwrap();
        let agent = AgentState::new(AgentBody::default(), feet, 0.3);
        let id = state.agents.push(agent);
        scene.update(&state);
        let hit = scene
            .closest(&ray, RayMask::EYE.union(RayMask::BODY))
            .unwrap();
        assert_eq!(hit.id, house.entity_of_agent(id).0);
        let radius = agent.body.radius_m;
        assert!(
            (hit.distance_m - (2.0 - radius)).abs() < 0.01 * radius,
            "{}",
            hit.distance_m
        );
        for mask in [RayMask::EYE, RayMask::EAR, RayMask::AGENT, RayMask::ALL] {
            assert_eq!(scene.closest(&ray, mask).unwrap(), wall);
        }
        let down = Ray::new(Vec3::new(3.0, 2.9, 2.0), Vec3::NEG_Y);
        let hit = scene.closest(&down, RayMask::BODY).unwrap();
        assert!((hit.distance_m - (2.9 - agent.height_m())).abs() < 1e-3);
        state.agents[id].position.x = 4.0;
        scene.update(&state);
        let moved = scene.closest(&ray, RayMask::BODY).unwrap();
        assert!((moved.distance_m - (3.0 - radius)).abs() < 0.01 * radius);
        state.agents = crate::IdVec::new();
        scene.update(&state);
        assert_eq!(
            scene
                .closest(&ray, RayMask::EYE.union(RayMask::BODY))
                .unwrap(),
            wall
        );
    }

    #[test]
    fn pieces_face_outwards() {
        for mesh in &body_meshes()[..CAPSULE_PIECES] {
            for triangle in 0..mesh.triangles.len() {
                let [a, b, c] = mesh.corners(triangle);
                let normal = (b - a).cross(c - a);
                let mut middle = (a + b + c) / 3.0;
                if mesh.positions.len() == 2 * usize::from(AROUND) {
                    middle.y = 0.0;
                }
                assert!(normal.dot(middle) >= 0.0);
            }
        }
    }
}
