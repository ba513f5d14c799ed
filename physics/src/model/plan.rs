//! Plans of rigid bodies: parts that move together, their masses, and collision pieces.

use super::PhysicsModel;
use super::decompose;
use super::rolling_cylinder;
use super::shapes::{self, PlacedShape};
use super::substance;
use crate::convert::to_rapier;
use dwell_scene::interrupt;
use dwell_scene::{
    Aabb, Collider, House, Id, IdVec, Inertial, JointId, MaterialId, MeshId, Mobility, ObjectId,
    Part, PartId, Pose, State, StructureId,
};
use glam::Affine3A;
use rapier3d::dynamics::MassProperties;
use rapier3d::geometry::SharedShape;
use rapier3d::math::Pose as RapierPose;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The owner of a collision piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum PieceOwner {
    /// A wall, floor or ceiling.
    Structure(StructureId),
    /// A part of an object.
    Part(PartId),
    /// The fallback box around the house.
    BoundingBox,
}

/// The materials of a piece.
#[derive(Clone, Debug)]
pub(crate) enum MaterialAssignment {
    /// One material for all; `None` when the part names none.
    Uniform(Option<MaterialId>),
    /// A material for each triangle of the shape.
    PerTriangle(Arc<[MaterialId]>),
}

/// A collision piece.
#[derive(Clone)]
pub(crate) struct CollisionPiece {
    pub(crate) owner: PieceOwner,
    pub(crate) shape: SharedShape,
    /// Pose of the shape on its body, or in the world for a static piece.
    pub(crate) pose: RapierPose,
    /// kg/m³; 0 for a static piece.
    pub(crate) density_kg_m3: f32,
    pub(crate) materials: MaterialAssignment,
}

/// A rigid body: one or more parts that move together.
#[derive(Clone)]
pub(crate) struct BodyDefinition {
    pub(crate) object: ObjectId,
    /// The parts with their poses on the body; the body's own frame is that of the first.
    pub(crate) parts: Vec<(PartId, Pose)>,
    pub(crate) pieces: Vec<CollisionPiece>,
    /// The joint that moves it, if it is not free.
    pub(crate) joint: Option<JointId>,
    /// Mass of each part without overrides, kg. Shape (part,).
    pub(crate) part_mass_kg: Vec<f32>,
    /// Set if some of its parts state mass, centre of mass and inertia; their pieces then have no density.
    pub(crate) has_explicit_inertia: bool,
}

/// A mesh's shape, and the mesh's triangle for each of the shape's.
type ExactShape = (SharedShape, Arc<[u32]>);

/// Shapes of exact meshes, shared between instances of a model.
#[derive(Default)]
struct ShapeCache {
    made: BTreeMap<MeshKey, Option<ExactShape>>,
    /// Convex pieces of meshes without collision pieces.
    convex: BTreeMap<MeshKey, Vec<(SharedShape, RapierPose)>>,
}

/// A mesh and its transform on the part, bit for bit.
type MeshKey = (MeshId, [u32; 12]);

impl ShapeCache {
    fn exact(
        &mut self,
        house: &House,
        mesh: MeshId,
        part_from_mesh: &Affine3A,
    ) -> Option<ExactShape> {
        self.made
            .entry(mesh_key(mesh, part_from_mesh))
            .or_insert_with(|| {
                shapes::triangle_mesh(&house.meshes[mesh], part_from_mesh)
                    .map(|shaped| (shaped.shape, shaped.triangles.into()))
            })
            .clone()
    }

    /// Returns convex pieces of a part's visible mesh, in part space.
    fn convex(&mut self, house: &House, part: PartId) -> Vec<(SharedShape, RapierPose)> {
        let part = &house.parts[part];
        let made = || {
            let pieces = decompose::convex_pieces(&house.meshes[part.mesh], &part.part_from_mesh);
            let pieces = pieces.into_iter();
            pieces
                .map(|piece| (piece.shape, piece.part_from_shape))
                .collect()
        };
        self.convex
            .entry(mesh_key(part.mesh, &part.part_from_mesh))
            .or_insert_with(made)
            .clone()
    }
}

fn mesh_key(mesh: MeshId, part_from_mesh: &Affine3A) -> MeshKey {
    (mesh, part_from_mesh.to_cols_array().map(f32::to_bits))
}

/// Returns one material, or one for each triangle where substances differ.
fn assign_materials(
    house: &House,
    mesh: MeshId,
    materials: &[MaterialId],
    triangles: &[u32],
) -> MaterialAssignment {
    let mesh = &house.meshes[mesh];
    let material_of = |triangle: u32| {
        materials
            .get(usize::from(mesh.slot(triangle as usize)))
            .copied()
    };
    let first = triangles
        .first()
        .and_then(|triangle| material_of(*triangle));
    let substance = |material: Option<MaterialId>| {
        material.map(|material| house.materials[material].substance.as_str())
    };
    let alike = triangles
        .iter()
        .all(|triangle| substance(material_of(*triangle)) == substance(first));
    let all: Option<Vec<MaterialId>> = triangles.iter().map(|t| material_of(*t)).collect();
    match all {
        Some(all) if !alike => MaterialAssignment::PerTriangle(all.into()),
        _ => MaterialAssignment::Uniform(first),
    }
}

/// Returns the pieces of a part in part space.
fn part_pieces(
    house: &House,
    meshes: &mut ShapeCache,
    id: PartId,
    density: f32,
) -> Vec<CollisionPiece> {
    let part = &house.parts[id];
    let owner = PieceOwner::Part(id);
    let mut pieces = Vec::with_capacity(part.colliders.len());
    for collider in &part.colliders {
        if matches!(collider, Collider::ExactMesh) {
            if let Some((shape, triangles)) = meshes.exact(house, part.mesh, &part.part_from_mesh) {
                pieces.push(CollisionPiece {
                    owner,
                    shape,
                    pose: RapierPose::IDENTITY,
                    density_kg_m3: 0.0,
                    materials: assign_materials(house, part.mesh, &part.materials, &triangles),
                });
            }
        } else if let Some(shaped) = shapes::convex_shape(collider) {
            pieces.push(part_collision_piece(house, id, shaped, density));
        }
    }
    substance::assign_face_materials(house, id, &mut pieces);
    pieces
}

fn part_collision_piece(
    house: &House,
    id: PartId,
    shaped: PlacedShape,
    density: f32,
) -> CollisionPiece {
    CollisionPiece {
        owner: PieceOwner::Part(id),
        shape: shaped.shape,
        pose: shaped.part_from_shape,
        density_kg_m3: density,
        materials: MaterialAssignment::Uniform(house.parts[id].materials.first().copied()),
    }
}

fn moved(mut piece: CollisionPiece, by: &RapierPose) -> CollisionPiece {
    piece.pose = *by * piece.pose;
    piece
}

fn volume_m3(pieces: &[CollisionPiece]) -> f32 {
    pieces
        .iter()
        .map(|piece| piece.shape.mass_properties(1.0).mass())
        .sum()
}

/// Returns the pieces of one moving part with densities that give its mass.
fn moving_pieces(house: &House, meshes: &mut ShapeCache, id: PartId) -> Vec<CollisionPiece> {
    let part = &house.parts[id];
    let mut pieces = part_pieces(house, meshes, id, part.density_kg_m3);
    pieces.retain(|piece| piece.shape.as_trimesh().is_none());
    set_part_density(&mut pieces, part);
    pieces
}

/// Gives the pieces of a part densities that give its mass; none where the part states its inertia itself.
fn set_part_density(pieces: &mut [CollisionPiece], part: &Part) {
    if part.inertial.is_some() {
        for piece in pieces {
            piece.density_kg_m3 = 0.0;
        }
    } else {
        set_uniform_density(pieces, part.mass_kg, part.density_kg_m3);
    }
}

/// Returns the stated mass properties of a part, in the body's frame: its mass and moments times `factor`. `inertial`: its
/// centre of mass and moments.
fn stated_mass_properties(
    house: &House,
    (id, body_from_part): &(PartId, Pose),
    inertial: Option<Inertial>,
    factor: f32,
) -> Option<MassProperties> {
    let (inertial, mass_kg) = (inertial?, house.parts[*id].mass_kg?);
    let frame = *body_from_part * inertial.part_from_principal;
    Some(MassProperties::with_principal_inertia_frame(
        frame.position,
        mass_kg * factor,
        inertial.moments * factor,
        frame.rotation,
    ))
}

fn set_uniform_density(pieces: &mut [CollisionPiece], mass_kg: Option<f32>, density_kg_m3: f32) {
    let volume = volume_m3(pieces);
    let density = match mass_kg {
        Some(mass) if volume > 0.0 => mass / volume,
        _ => density_kg_m3,
    };
    for piece in pieces {
        piece.density_kg_m3 = density;
    }
}

pub(super) fn plan(house: Arc<House>) -> PhysicsModel {
    let mut meshes = ShapeCache::default();
    let mut statics = structure_pieces(&house, &mut meshes);
    let mut joint_of_part = IdVec::filled(None, house.parts.len());
    for (id, joint) in house.joints.iter_ids() {
        joint_of_part[joint.child] = Some(id);
    }
    let mut bodies = Vec::new();
    let mut body_of_part = IdVec::filled(None, house.parts.len());
    let mut stand_ins = Vec::new();
    for (object_id, object) in house.objects.iter_ids() {
        let mut root: Option<usize> = None;
        let first_body = bodies.len();
        for id in object.parts() {
            interrupt::unwind_if_cancelled();
            let part = &house.parts[id];
            let joint = joint_of_part[id];
            let stands = part.fixed || (joint.is_none() && object.mobility != Mobility::Movable);
            if stands {
                let place = to_rapier(&part.world_from_part);
                let pieces = part_pieces(&house, &mut meshes, id, 0.0);
                statics.extend(pieces.into_iter().map(|piece| moved(piece, &place)));
                continue;
            }
            let place = match (joint, root) {
                (None, Some(body)) => {
                    // Parts without a joint move with the object's first such part.
                    let plan: &mut BodyDefinition = &mut bodies[body];
                    let frame = house.parts[plan.parts[0].0].world_from_part;
                    let body_from_part = frame.inverse() * part.world_from_part;
                    plan.parts.push((id, body_from_part));
                    body_of_part[id] = Some(body as u32);
                    Some((body, to_rapier(&body_from_part)))
                }
                _ => None,
            };
            let pieces = moving_pieces(&house, &mut meshes, id);
            if let Some((body, body_from_part)) = place {
                let pieces = pieces
                    .into_iter()
                    .map(|piece| moved(piece, &body_from_part));
                bodies[body].pieces.extend(pieces);
                continue;
            }
            if joint.is_none() {
                root = Some(bodies.len());
            }
            body_of_part[id] = Some(bodies.len() as u32);
            bodies.push(BodyDefinition {
                object: object_id,
                parts: vec![(id, Pose::IDENTITY)],
                pieces,
                joint,
                part_mass_kg: Vec::new(),
                has_explicit_inertia: false,
            });
        }
        for body in &mut bodies[first_body..] {
            if body.pieces.is_empty() {
                body.pieces = stand_in_pieces(&house, &mut meshes, body);
                stand_ins.push(object_id);
            }
            let stated = |part: &(PartId, Pose)| {
                stated_mass_properties(&house, part, house.parts[part.0].inertial, 1.0)
            };
            let mass = |part: &(PartId, Pose)| {
                let own = body
                    .pieces
                    .iter()
                    .filter(|piece| piece.owner.part() == Some(part.0));
                let own = own.map(|piece| piece.shape.mass_properties(piece.density_kg_m3).mass());
                own.sum::<f32>() + stated(part).map_or(0.0, |given| given.mass())
            };
            body.part_mass_kg = body.parts.iter().map(mass).collect();
            body.has_explicit_inertia = body.parts.iter().any(|part| stated(part).is_some());
        }
    }
    stand_ins.dedup();
    let bounds = bounds(&house, &statics, &bodies);
    let sides = shapes::bounding_box_walls(&bounds).map(|(shape, place)| CollisionPiece {
        owner: PieceOwner::BoundingBox,
        shape,
        pose: to_rapier(&place),
        density_kg_m3: 0.0,
        materials: MaterialAssignment::Uniform(None),
    });
    statics.extend(sides);
    PhysicsModel {
        house,
        rolling_cylinders: rolling_cylinder::rolling_cylinders(&bodies),
        static_pieces: statics,
        bodies,
        body_of_part,
        fallback_collider_objects: stand_ins,
        bounds,
    }
}

fn structure_pieces(house: &House, meshes: &mut ShapeCache) -> Vec<CollisionPiece> {
    let mut pieces = Vec::new();
    for (id, structure) in house.structure.iter_ids() {
        interrupt::unwind_if_cancelled();
        let exact = meshes.exact(house, structure.mesh, &Affine3A::IDENTITY);
        if let Some((shape, triangles)) = exact {
            pieces.push(CollisionPiece {
                owner: PieceOwner::Structure(id),
                shape,
                pose: RapierPose::IDENTITY,
                density_kg_m3: 0.0,
                materials: assign_materials(
                    house,
                    structure.mesh,
                    &structure.materials,
                    &triangles,
                ),
            });
        }
    }
    pieces
}

/// Returns convex pieces of the visible meshes of a body's parts, for a body without collision pieces.
fn stand_in_pieces(
    house: &House,
    meshes: &mut ShapeCache,
    body: &BodyDefinition,
) -> Vec<CollisionPiece> {
    let mut pieces = Vec::new();
    for (id, body_from_part) in &body.parts {
        let part = &house.parts[*id];
        let place = to_rapier(body_from_part);
        let convex = meshes.convex(house, *id).into_iter();
        let mut own: Vec<CollisionPiece> = convex
            .map(|(shape, part_from_shape)| {
                let shaped = PlacedShape {
                    shape,
                    part_from_shape,
                    triangles: Vec::new(),
                };
                part_collision_piece(house, *id, shaped, part.density_kg_m3)
            })
            .collect();
        set_part_density(&mut own, part);
        substance::assign_face_materials(house, *id, &mut own);
        pieces.extend(own.into_iter().map(|piece| moved(piece, &place)));
    }
    if pieces.is_empty() {
        // A body without mesh and colliders gets a tiny piece, so that it has mass.
        let crumb = PlacedShape {
            shape: SharedShape::ball(0.005),
            part_from_shape: RapierPose::IDENTITY,
            triangles: Vec::new(),
        };
        let root = &house.parts[body.root()];
        let density = if root.inertial.is_some() {
            0.0
        } else {
            root.density_kg_m3
        };
        pieces.push(part_collision_piece(house, body.root(), crumb, density));
    }
    pieces
}

fn bounds(house: &House, statics: &[CollisionPiece], bodies: &[BodyDefinition]) -> Aabb {
    let mut all = Aabb::EMPTY;
    for piece in statics {
        all = all.union(&shapes::bounds(&piece.shape, &piece.pose));
    }
    for body in bodies {
        let place = to_rapier(&house.parts[body.parts[0].0].world_from_part);
        for piece in &body.pieces {
            all = all.union(&shapes::bounds(&piece.shape, &(place * piece.pose)));
        }
    }
    if all.is_empty() {
        Aabb::new(glam::Vec3::ZERO, glam::Vec3::ZERO)
    } else {
        all
    }
}

impl PieceOwner {
    /// Returns the part, if it is one.
    pub(crate) fn part(self) -> Option<PartId> {
        match self {
            Self::Part(part) => Some(part),
            _ => None,
        }
    }

    /// Returns a name for reports.
    pub(crate) fn name(self, house: &House) -> String {
        match self {
            Self::Structure(id) => house.structure[id].name.clone(),
            Self::Part(id) => house.objects[house.parts[id].object].name.clone(),
            Self::BoundingBox => "the box of last resort".to_owned(),
        }
    }
}

impl BodyDefinition {
    /// Returns the first part, whose frame is the body's.
    pub(crate) fn root(&self) -> PartId {
        self.parts[0].0
    }

    /// Returns the box around its pieces under a pose, m.
    pub(crate) fn bounds(&self, world_from_body: &RapierPose) -> Aabb {
        self.pieces.iter().fold(Aabb::EMPTY, |all, piece| {
            all.union(&shapes::bounds(
                &piece.shape,
                &(*world_from_body * piece.pose),
            ))
        })
    }

    /// Returns the stated mass properties of its parts in a world, each times its factor. Shape of `factors`: (part,).
    pub(crate) fn explicit_mass_properties(
        &self,
        house: &House,
        state: &State,
        factors: &[f32],
    ) -> Option<MassProperties> {
        let parts = self.parts.iter().zip(factors);
        let stated = parts.filter_map(|(part, factor)| {
            stated_mass_properties(house, part, state.part_inertial(house, part.0), *factor)
        });
        stated.reduce(|all, one| all + one)
    }

    /// Returns the mass with the densities of its parts multiplied, kg. Shape of `factors`: (part,).
    pub(crate) fn mass_kg(&self, factors: &[f32]) -> f32 {
        let parts = self.part_mass_kg.iter().zip(factors);
        parts.map(|(mass, factor)| mass * factor).sum()
    }

    /// Returns the factor of a piece: that of its part. Shape of `factors`: (part,).
    pub(crate) fn mass_factor_of(&self, piece: &CollisionPiece, factors: &[f32]) -> f32 {
        let owner = piece.owner.part();
        let place = self.parts.iter().position(|(id, _)| Some(*id) == owner);
        place
            .and_then(|place| factors.get(place))
            .copied()
            .unwrap_or(1.0)
    }

    /// Returns a number that orders bodies: that of the first part.
    pub(crate) fn sort_key(&self) -> usize {
        self.root().index()
    }
}
