//! A hinge for a node of a foreign house, so that it opens.

use dwell_scene::{Collider, HouseData, Joint, JointKind, Mobility, ObjectId, Pose};
use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

use super::edit_errors::{check_range, checked_point, invalid_field};
use super::edits::ObjectAttributes;
use super::{describe, place};
use crate::error::HousesError;
use crate::import::convex_pieces;

/// Friction of the hinge, N·m, and its damping, N·m·s/rad: those of the doors of other foreign houses.
const FRICTION_N_M: f32 = 0.6;
const DAMPING_N_M_S: f32 = 1.5;

/// The hinge of a node. All values are in the axes of the house: x, y up, z.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NodeHinge {
    /// Direction of the axis.
    #[serde(default)]
    pub axis: HingeAxis,
    /// The side of the box around the node in whose middle the axis lies; not beside `at`.
    #[serde(default)]
    pub edge: Option<BoxSide>,
    /// A point of the axis, m.
    #[serde(default)]
    pub at: Option<[f32; 3]>,
    /// Rotation when it is fully open, degrees, right-handed about the axis from the pose in the file; -360 to 360.
    #[serde(default = "default_open_deg")]
    pub open_deg: f32,
    /// The same when it is closed.
    #[serde(default)]
    pub closed_deg: f32,
}

const fn default_open_deg() -> f32 {
    90.0
}

/// An axis of the house.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HingeAxis {
    /// Horizontal, along x: lids and flaps.
    X,
    /// Vertical: doors.
    #[default]
    Y,
    /// Horizontal, along z: lids and flaps.
    Z,
}

impl HingeAxis {
    const fn direction(self) -> Vec3 {
        match self {
            Self::X => Vec3::X,
            Self::Y => Vec3::Y,
            Self::Z => Vec3::Z,
        }
    }
}

/// A side of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum BoxSide {
    /// At the lowest x.
    #[serde(rename = "-x")]
    LowX,
    /// At the highest x.
    #[serde(rename = "+x")]
    HighX,
    /// The lower face.
    #[serde(rename = "-y")]
    LowY,
    /// The upper face.
    #[serde(rename = "+y")]
    HighY,
    /// At the lowest z.
    #[serde(rename = "-z")]
    LowZ,
    /// At the highest z.
    #[serde(rename = "+z")]
    HighZ,
}

impl BoxSide {
    const fn normal(self) -> Vec3 {
        match self {
            Self::LowX => Vec3::NEG_X,
            Self::HighX => Vec3::X,
            Self::LowY => Vec3::NEG_Y,
            Self::HighY => Vec3::Y,
            Self::LowZ => Vec3::NEG_Z,
            Self::HighZ => Vec3::Z,
        }
    }
}

/// Attaches an object of one rigid part to a hinge; it stays where it is.
///
/// # Errors
/// [`HousesError::Spec`] for an object of several parts, a hinge without place or with two, on a side that its axis runs
/// through, or that does not open.
pub(super) fn attach_hinge(
    data: &mut HouseData,
    id: ObjectId,
    hinge: &NodeHinge,
) -> Result<(), HousesError> {
    let object = &data.objects[id];
    if object.part_count != 1 || data.joints.iter().any(|joint| joint.object == id) {
        let found = format!("{:?}, which has joints or parts", object.name);
        return Err(invalid_field(
            "hinge",
            found,
            "a node that is one rigid part",
        ));
    }
    let bounds = place::world_bounds(data, id);
    let axis = hinge.axis.direction();
    let pivot = match (hinge.edge, hinge.at) {
        (None, Some(at)) => checked_point("hinge.at", at)?,
        (Some(edge), None) => {
            let normal = edge.normal();
            if normal.dot(axis) != 0.0 {
                let found = format!("the axis {:?} through that side", hinge.axis).to_lowercase();
                return Err(invalid_field(
                    "hinge.edge",
                    found,
                    "a side that the axis runs along",
                ));
            }
            bounds.center() + 0.5 * bounds.size() * normal
        }
        (edge, _) => {
            let found = if edge.is_some() { "both" } else { "neither" };
            return Err(invalid_field("hinge.edge, hinge.at", found, "one of them"));
        }
    };
    let turn = [-360.0, 360.0];
    let open = check_range("hinge.open_deg", hinge.open_deg, turn, "degrees")?.to_radians();
    let closed = check_range("hinge.closed_deg", hinge.closed_deg, turn, "degrees")?.to_radians();
    if open == closed {
        let possible = "another angle than `closed_deg`";
        return Err(invalid_field("hinge.open_deg", hinge.open_deg, possible));
    }
    // A moving part has a mass and convex pieces, as any movable object.
    let traits = ObjectAttributes {
        mobility: Some(Mobility::Movable),
        ..ObjectAttributes::default()
    };
    describe::set_attributes(data, id, &traits)?;
    let object = &mut data.objects[id];
    object.mobility = Mobility::Articulated;
    object.pickable = false;
    let child = object.first_part;
    let part = &mut data.parts[child];
    part.fixed = false;
    if part.colliders.contains(&Collider::ExactMesh) {
        part.colliders = convex_pieces(&data.meshes[part.mesh], &part.part_from_mesh);
    }
    let world_from_joint = Pose::new(pivot, Quat::IDENTITY);
    data.joints.push(Joint {
        parent_from_joint: world_from_joint,
        child_from_joint: part.world_from_part.inverse() * world_from_joint,
        limits: Some([open.min(closed).min(0.0), open.max(closed).max(0.0)]),
        closed,
        open,
        friction: FRICTION_N_M,
        damping: DAMPING_N_M_S,
        ..Joint::new("hinge", id, child, JointKind::Hinge, axis)
    });
    Ok(())
}
