//! Initial opening of doors, drawers and lids.

use std::collections::BTreeSet;

use dwell_scene::{HouseData, JointId, ObjectId};

use super::edit_errors::{check_range, invalid_field, unknown_name};
use super::edits::SetOpening;
use crate::error::HousesError;

/// Sets the initial opening of one of an object's `joints`, or of all that open.
///
/// # Errors
/// [`HousesError::Spec`] for an object that has nothing that opens.
pub(super) fn set_opening(
    data: &mut HouseData,
    id: ObjectId,
    joints: &[JointId],
    change: &SetOpening,
) -> Result<(), HousesError> {
    let open = check_range("open", change.open, [0.0, 1.0], "")?;
    let own = joints.iter().copied();
    let own: Vec<JointId> = own
        .filter(|joint| data.joints[*joint].is_openable())
        .collect();
    if own.is_empty() {
        let openable = data.objects.iter_ids().filter(|(id, _)| {
            data.joints
                .iter()
                .any(|joint| joint.object == *id && joint.is_openable())
        });
        let names: Vec<&str> = openable
            .map(|(_, object)| object.name.as_str())
            .take(8)
            .collect();
        let found = format!("{:?}, which has nothing that opens", change.object);
        let possible = format!(
            "an object with a door, drawer or lid, such as {}",
            names.join(", ")
        );
        return Err(invalid_field("object", found, possible));
    }
    let named = |joint: &JointId| {
        let wanted = change.joint.as_ref();
        wanted.is_none_or(|name| data.joints[*joint].name == *name)
    };
    let chosen: BTreeSet<JointId> = own.iter().copied().filter(named).collect();
    if let (true, Some(name)) = (chosen.is_empty(), &change.joint) {
        let known = own.iter().map(|joint| data.joints[*joint].name.as_str());
        return Err(unknown_name("joint", name, "joints that open", known));
    }
    // Parents stand before their children, so that one pass moves all that hangs on a joint.
    let mut moved = BTreeSet::new();
    let mut joints = joints.to_vec();
    joints.sort_by_key(|joint| data.joints[*joint].child);
    for joint in joints {
        if chosen.contains(&joint) {
            let start = data.joints[joint].position_at(open);
            data.joints[joint].initial = start;
        }
        let (parent, child) = (data.joints[joint].parent, data.joints[joint].child);
        if !chosen.contains(&joint) && !parent.is_some_and(|parent| moved.contains(&parent)) {
            continue;
        }
        let world_from_parent = parent.map_or(dwell_scene::Pose::IDENTITY, |parent| {
            data.parts[parent].world_from_part
        });
        let joint = &data.joints[joint];
        data.parts[child].world_from_part =
            joint.world_from_child(&world_from_parent, joint.initial);
        moved.insert(child);
    }
    let switches = chosen
        .iter()
        .any(|joint| data.joints[*joint].toggles_switch);
    if switches {
        data.objects[id].switch = Some(open > 0.5);
    }
    Ok(())
}
