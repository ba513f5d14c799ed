//! Canonical spelling of a law's target.
//!
//! A joint has a number, a name, and a name qualified by its object's; a part moves with all others that no joint
//! separates; a pair of substances has two orders. A law on one of them must not act twice because it was given in two
//! spellings.

use super::{LawInfo, LawSpec};
use crate::error::SceneError;
use crate::house::House;
use crate::ids::{Id, JointId, PartId};

impl LawSpec {
    /// Returns the canonical spelling of a law's target. A joint is `OBJECT/JOINT`, or its number where those names are
    /// ambiguous; a name of several joints stays, as it means all of them. An object's part is the object where all of it
    /// moves as one, else the first part that moves with it. An agent is its number. A name of nothing stays as it is.
    pub fn canonical_target(house: &House, info: &LawInfo, target: &str) -> String {
        let found = match info.acts_on {
            "joint" => canonical_joint(house, target),
            "object" => canonical_part(house, target),
            "agent" => target.parse::<u32>().ok().map(|agent| agent.to_string()),
            _ => None,
        };
        found.unwrap_or_else(|| target.to_owned())
    }

    /// Returns whether two targets of a law are the same: in two spellings, or as a pair of substances in two orders.
    pub fn is_same_target(house: &House, info: &LawInfo, a: &str, b: &str) -> bool {
        let [a, b] = [a, b].map(|target| Self::canonical_target(house, info, target));
        let turned = || {
            let (one, other) = a.split_once('~')?;
            Some(format!("{other}~{one}") == b)
        };
        a == b || (info.acts_on == "contact" && turned() == Some(true))
    }

    /// Refuses two laws of one kind on one target in two spellings, which are ambiguous. A name of several joints means
    /// each of them, and is refused beside another name of one of them. Two in one spelling are two laws one after the
    /// other, such as two lags. `known`: the laws to check; others are left out.
    ///
    /// # Errors
    /// [`SceneError::Range`] names the law and the two spellings.
    pub fn check_targets(
        house: &House,
        known: &[&LawInfo],
        laws: &[Self],
    ) -> Result<(), SceneError> {
        for (k, spec) in laws.iter().enumerate() {
            let Ok(info) = LawInfo::find(known.iter().copied(), &spec.id) else {
                continue;
            };
            let same = |other: &&Self| {
                other.id == spec.id
                    && match (&other.target, &spec.target) {
                        (Some(a), Some(b)) => {
                            a != b
                                && (Self::is_same_target(house, info, a, b)
                                    || (info.acts_on == "joint" && share_a_joint(house, a, b)))
                        }
                        _ => false,
                    }
            };
            if let Some(other) = laws[..k].iter().find(same) {
                let name = |spec: &Self| spec.target.clone().unwrap_or_default();
                return Err(SceneError::Range {
                    at: format!("law {}", spec.id),
                    field: "target",
                    found: format!(
                        "{:?} beside {:?}, which names the same",
                        name(spec),
                        name(other)
                    ),
                    allowed: "one spelling for one target",
                });
            }
        }
        Ok(())
    }
}

/// `OBJECT/JOINT`.
fn qualified_joint_name(house: &House, id: JointId) -> String {
    let joint = &house.joints[id];
    format!("{}/{}", house.objects[joint.object].name, joint.name)
}

/// Returns whether a law's target names a joint: by its name, as `OBJECT/JOINT`, or by its number.
pub fn is_joint_named(house: &House, id: JointId, target: &str) -> bool {
    target == house.joints[id].name
        || target == qualified_joint_name(house, id)
        || target == id.index().to_string()
}

/// Returns whether a law's target names a part as `OBJECT/PART`.
pub fn is_part_named(house: &House, id: PartId, target: &str) -> bool {
    let part = &house.parts[id];
    let object = &house.objects[part.object];
    let rest = target
        .strip_prefix(&object.name)
        .and_then(|rest| rest.strip_prefix('/'));
    rest == Some(&part.name)
}

/// The joints that a target names.
fn joints_named(house: &House, target: &str) -> impl Iterator<Item = JointId> {
    let joints = house.joints.ids();
    joints.filter(move |id| is_joint_named(house, *id, target))
}

fn share_a_joint(house: &House, a: &str, b: &str) -> bool {
    let of_b: Vec<JointId> = joints_named(house, b).collect();
    joints_named(house, a).any(|id| of_b.contains(&id))
}

fn canonical_joint(house: &House, target: &str) -> Option<String> {
    let named = |target: &str| {
        let mut found = joints_named(house, target);
        let (first, more) = (found.next(), found.next().is_some());
        first.filter(|_| !more)
    };
    // +3 is 3.
    let number = |target: &str| {
        let id = JointId(target.parse().ok()?);
        house.joints.get(id).map(|_| id)
    };
    let id = named(target).or_else(|| {
        let any = house.joints.iter().any(|joint| joint.name == target);
        number(target).filter(|_| !any)
    })?;
    [qualified_joint_name(house, id), id.index().to_string()]
        .into_iter()
        .find(|spelling| named(spelling) == Some(id))
}

fn canonical_part(house: &House, target: &str) -> Option<String> {
    let mut found = house.objects.iter().filter_map(|object| {
        let mut parts = object.parts();
        let id = parts.find(|id| is_part_named(house, *id, target))?;
        Some((object, id))
    });
    let (object, part) = found.next()?;
    let names = |name: &str| {
        house
            .objects
            .iter()
            .filter(|other| other.name == name)
            .count()
    };
    if found.next().is_some() || names(target) > 0 || names(&object.name) > 1 {
        return None;
    }
    let on_joint = |id: PartId| house.joints.iter().any(|joint| joint.child == id);
    if on_joint(part) {
        return (object.part_count == 1).then(|| object.name.clone());
    }
    let mut alike = object
        .parts()
        .filter(|id| !on_joint(*id) && !house.parts[*id].fixed);
    let first = alike.next()?;
    if object.parts().any(on_joint) {
        return Some(format!("{}/{}", object.name, house.parts[first].name));
    }
    Some(object.name.clone())
}
