//! The pieces of a person: which mesh stands where, and in which colour.

use super::meshes::PieceKind;
use super::skeleton::{PersonSkeleton, limb_rotation};
use crate::space::Pose;
use crate::state::ResolvedPersonColors;
use glam::{Affine3A, Quat, Vec3};

/// The colour of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ColorRole {
    Skin,
    Hair,
    Face,
    Shirt,
    Trousers,
    Shoes,
}

/// Eyes and mouth, sRGB.
const FACE: [u8; 3] = [44, 24, 24];

/// The pieces of a person.
pub const PERSON_PIECES: usize = 22;

/// Their kinds and colours; those of arms and legs left first.
pub(super) const PIECES: [(PieceKind, ColorRole); PERSON_PIECES] = [
    (PieceKind::Head, ColorRole::Skin),
    (PieceKind::Hair, ColorRole::Hair),
    (PieceKind::Face, ColorRole::Face),
    (PieceKind::Neck, ColorRole::Skin),
    (PieceKind::Trunk, ColorRole::Shirt),
    (PieceKind::Pelvis, ColorRole::Trousers),
    (PieceKind::UpperArm, ColorRole::Shirt),
    (PieceKind::Forearm, ColorRole::Skin),
    (PieceKind::LeftPalm, ColorRole::Skin),
    (PieceKind::Fingers, ColorRole::Skin),
    (PieceKind::PointingFinger, ColorRole::Skin),
    (PieceKind::UpperArm, ColorRole::Shirt),
    (PieceKind::Forearm, ColorRole::Skin),
    (PieceKind::RightPalm, ColorRole::Skin),
    (PieceKind::Fingers, ColorRole::Skin),
    (PieceKind::PointingFinger, ColorRole::Skin),
    (PieceKind::Thigh, ColorRole::Trousers),
    (PieceKind::Shin, ColorRole::Trousers),
    (PieceKind::Foot, ColorRole::Shoes),
    (PieceKind::Thigh, ColorRole::Trousers),
    (PieceKind::Shin, ColorRole::Trousers),
    (PieceKind::Foot, ColorRole::Shoes),
];

/// A piece of a person where it stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PersonPiece {
    /// `world_from_piece`; the mesh is as many times larger as the person is high, m.
    pub pose: Pose,
    /// Its size over the mesh's: the person's height; 0 for what is not shown.
    pub scale: f32,
}

impl PersonPiece {
    /// From its mesh to the world.
    pub fn world_from_mesh(&self) -> Affine3A {
        if self.scale == 0.0 {
            return Affine3A::ZERO;
        }
        Affine3A::from_scale_rotation_translation(
            Vec3::splat(self.scale),
            self.pose.rotation,
            self.pose.position,
        )
    }
}

impl ResolvedPersonColors {
    /// The colour of a piece, sRGB.
    pub fn color(&self, piece: usize) -> [u8; 3] {
        match PIECES[piece % PERSON_PIECES].1 {
            ColorRole::Skin => self.skin,
            ColorRole::Hair => self.hair,
            ColorRole::Face => FACE,
            ColorRole::Shirt => self.shirt,
            ColorRole::Trousers => self.trousers,
            ColorRole::Shoes => self.shoes,
        }
    }
}

/// The pieces of a person with these joints, in the order of [`super::person_meshes`].
pub fn person_pieces(joints: &PersonSkeleton) -> [PersonPiece; PERSON_PIECES] {
    let body = joints.trunk.rotation;
    let limb = |from: Vec3, to: Vec3| {
        let along = (to - from).normalize_or(Vec3::NEG_Y);
        Pose::new(from, limb_rotation(body, along).normalize())
    };
    let neck = {
        let along = joints
            .trunk
            .transform_point(Vec3::Y * (super::proportions::TRUNK * joints.height_m));
        limb(joints.head_joint.position, along)
    };
    let still = |position: Vec3, rotation: Quat| Pose::new(position, rotation.normalize());
    let head = still(joints.head_joint.position, joints.head_joint.rotation);
    let trunk = still(joints.trunk.position, body);
    let shown = |pose: Pose| PersonPiece {
        pose,
        scale: joints.height_m,
    };
    let mut pieces = [shown(trunk); PERSON_PIECES];
    pieces[..4].copy_from_slice(&[head, head, head, neck].map(shown));
    for (arm, pieces) in joints.arms.iter().zip(pieces[6..16].chunks_exact_mut(5)) {
        let hand = limb(arm.wrist, arm.finger_tip);
        pieces.copy_from_slice(
            &[
                limb(arm.shoulder, arm.elbow),
                limb(arm.elbow, arm.wrist),
                hand,
                hand,
                hand,
            ]
            .map(shown),
        );
        // Either stretched fingers, or one and a fist.
        pieces[if arm.is_pointing { 3 } else { 4 }].scale = 0.0;
    }
    for (leg, pieces) in joints.legs.iter().zip(pieces[16..].chunks_exact_mut(3)) {
        let parts = [
            limb(leg.hip, leg.knee),
            limb(leg.knee, leg.ankle),
            still(leg.ankle, leg.foot),
        ];
        pieces.copy_from_slice(&parts.map(shown));
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::person::{person_meshes, skeleton_of};
    use crate::random::RandomKey;
    use crate::{AgentBody, AgentState, House, PersonState, ShoeboxMaterials, State};

    /// From sole to crown a figure is as high as its person, within 1 %, and wide as shoulders are: 0.259 of that.
    #[test]
    fn a_figure_is_as_large_as_its_person() {
        let house = House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        for height_m in [1.45, 1.7, 2.0] {
            let mut state = State::new(&house);
            let body = AgentBody::person(height_m);
            let feet = Vec3::new(1.0, 0.2, -2.0);
            let id = state.agents.push(AgentState::new(body, feet, 0.0));
            let person = PersonState::new(body.person.unwrap(), RandomKey::root(1));
            state.persons.insert(id, person);
            let joints = skeleton_of(&house, &state, id).unwrap();
            let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
            let (mut left, mut right) = (f32::INFINITY, f32::NEG_INFINITY);
            for (k, (piece, mesh)) in person_pieces(&joints)
                .iter()
                .zip(person_meshes())
                .enumerate()
            {
                if piece.scale == 0.0 {
                    continue;
                }
                let map = piece.world_from_mesh();
                for point in &mesh.mesh.positions {
                    let point = map.transform_point3(*point);
                    (low, high) = (low.min(point.y), high.max(point.y));
                    // The upper arms are the widest at the shoulders.
                    if PIECES[k].0 == PieceKind::UpperArm && point.y > joints.arms[0].shoulder.y {
                        (left, right) = (left.min(point.x), right.max(point.x));
                    }
                }
            }
            assert!((low - feet.y).abs() < 0.005 * height_m, "{low}");
            assert!(
                (high - low - height_m).abs() < 0.01 * height_m,
                "{high} {low}"
            );
            let wide = (right - left) / height_m;
            assert!((wide - 0.259).abs() < 0.01, "{wide}");
        }
    }
}
