//! Checks that links and joints form a tree; loops, orphans and impossible numbers are refused.

use std::collections::BTreeSet;

use dwell_scene::Pose;
use glam::DMat3;

use super::masses::FixedJointTree;
use super::model::{Robot, RobotJoint, RobotJointKind, RobotLink};
use crate::error::{HousesError, refuse_field};
use crate::limits::MAX_NODES;
use crate::report::FileLocation;

/// Sorts links and joints so that parents come first, and checks every number.
///
/// # Errors
/// [`HousesError::Field`] names the link or joint and the field.
pub(crate) fn check(mut robot: Robot) -> Result<Robot, HousesError> {
    let at = FileLocation::file(&robot.source);
    let count = robot.links.len();
    if count > MAX_NODES {
        let (found, allowed) = (count as u64, MAX_NODES as u64);
        return Err(HousesError::TooLarge {
            at,
            what: "link count",
            found,
            allowed,
        });
    }
    unique(&at, "link", robot.links.iter().map(|link| &link.name))?;
    unique(&at, "joint", robot.joints.iter().map(|joint| &joint.name))?;
    let mut above: Vec<Option<usize>> = vec![None; count];
    for (k, joint) in robot.joints.iter().enumerate() {
        let at = at.field(format_args!("joint[{}]", joint.name));
        if let Some(other) = above[joint.child].replace(k) {
            let found = format!(
                "link {:?}, which joint {:?} moves already: the links form a loop",
                robot.links[joint.child].name, robot.joints[other].name
            );
            return refuse_field(at.field("child"), "a link that no other joint moves", found);
        }
    }
    let roots: Vec<usize> = (0..count).filter(|k| above[*k].is_none()).collect();
    let [root] = roots[..] else {
        let names: Vec<_> = roots
            .iter()
            .map(|k| &robot.links[*k].name)
            .take(8)
            .collect();
        let found = if count == 0 {
            "no link at all".to_owned()
        } else if names.is_empty() {
            "none: the links form a loop".to_owned()
        } else {
            format!("{} of them, {names:?}", roots.len())
        };
        return refuse_field(at.field("link"), "one link that no joint moves", found);
    };
    let mut below: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (k, joint) in robot.joints.iter().enumerate() {
        below[joint.parent].push(k);
    }
    let mut order = vec![root];
    let mut joints = Vec::with_capacity(robot.joints.len());
    // Position of each link in `order`; `None` for links that are not connected to the root.
    let mut places: Vec<Option<usize>> = vec![None; count];
    let mut next = 0;
    while let Some(&link) = order.get(next) {
        places[link] = Some(next);
        for k in &below[link] {
            order.push(robot.joints[*k].child);
            joints.push(*k);
        }
        next += 1;
    }
    if order.len() != count {
        let left = places.iter().position(Option::is_none).unwrap_or(0);
        let at = at.field(format_args!("link[{}]", robot.links[left].name));
        return refuse_field(at, "links that hang on the root", "a loop of links");
    }
    let place = |link: usize| places[link].unwrap_or(0);
    robot.joints = joints
        .into_iter()
        .map(|k| {
            let joint = robot.joints[k].clone();
            RobotJoint {
                parent: place(joint.parent),
                child: place(joint.child),
                ..joint
            }
        })
        .collect();
    robot.links = order.iter().map(|k| robot.links[*k].clone()).collect();
    let leads = |joint: &&RobotJoint| joint.kind != RobotJointKind::Fixed && joint.mimic.is_none();
    let leaders = robot.joints.iter().filter(leads);
    let leaders: BTreeSet<&str> = leaders.map(|joint| joint.name.as_str()).collect();
    for joint in &robot.joints {
        check_joint(
            &leaders,
            joint,
            &at.field(format_args!("joint[{}]", joint.name)),
        )?;
    }
    for link in &robot.links {
        check_link(link, &at.field(format_args!("link[{}]", link.name)))?;
    }
    check_masses(&robot, &at)?;
    Ok(robot)
}

fn unique<'a>(
    at: &FileLocation,
    what: &str,
    names: impl Iterator<Item = &'a String>,
) -> Result<(), HousesError> {
    let mut seen = BTreeSet::new();
    for name in names {
        let at = at.field(format_args!("{what}[{name}]")).field("name");
        if name.is_empty() || name.contains('/') {
            return refuse_field(at, "a name without a slash", format!("{name:?}"));
        }
        if !seen.insert(name) {
            return refuse_field(at, "a name that is used once", format!("{name:?} again"));
        }
    }
    Ok(())
}

fn check_pose(pose: &Pose, at: &FileLocation, field: &str) -> Result<(), HousesError> {
    if pose.is_valid() {
        return Ok(());
    }
    refuse_field(at.field(field), "finite numbers", format!("{pose:?}"))
}

/// `leaders`: the names of joints that others may follow.
fn check_joint(
    leaders: &BTreeSet<&str>,
    joint: &RobotJoint,
    at: &FileLocation,
) -> Result<(), HousesError> {
    check_pose(&joint.parent_from_joint, at, "origin")?;
    check_pose(&joint.child_from_joint, at, "origin")?;
    if !joint.axis.is_finite() || (joint.axis.length() - 1.0).abs() > 1e-3 {
        return refuse_field(at.field("axis"), "a direction", format!("{}", joint.axis));
    }
    if let Some([low, high]) = joint.limits
        && !(low.is_finite() && high.is_finite() && low <= high)
    {
        return refuse_field(
            at.field("limit"),
            "lower <= upper",
            format!("{low} to {high}"),
        );
    }
    let servo = joint.servo.unwrap_or_default();
    for (field, value) in [
        ("friction", joint.friction),
        ("damping", joint.damping),
        ("armature", joint.armature),
        ("limit.effort", servo.max_effort),
        ("limit.velocity", servo.max_velocity.unwrap_or(0.0)),
    ] {
        if !(0.0..=1e9).contains(&value) {
            return refuse_field(at.field(field), "0 to 1e9", value.to_string());
        }
    }
    let Some((leader, multiplier, offset)) = &joint.mimic else {
        return Ok(());
    };
    let at = at.field("mimic");
    if !leaders.contains(leader.as_str()) {
        let expected = "a joint that moves and follows none";
        return refuse_field(at.field("joint"), expected, format!("{leader:?}"));
    }
    if !(-1e3..=1e3).contains(multiplier) {
        let found = multiplier.to_string();
        return refuse_field(at.field("multiplier"), "-1000 to 1000", found);
    }
    if !(-1e4..=1e4).contains(offset) {
        return refuse_field(at.field("offset"), "-10000 to 10000", offset.to_string());
    }
    Ok(())
}

fn check_link(link: &RobotLink, at: &FileLocation) -> Result<(), HousesError> {
    let shapes = [("visual", &link.visuals), ("collision", &link.collisions)];
    for (what, shapes) in shapes {
        for (k, shape) in shapes.iter().enumerate() {
            let at = at.field(format_args!("{what}[{k}]"));
            check_pose(&shape.link_from_shape, &at, "origin")?;
            if !shape.geometry.is_valid() {
                let found = format!("{:?}", shape.geometry.dimensions());
                return refuse_field(at.field("geometry"), "sizes of 1e-6 to 1000 m", found);
            }
        }
    }
    let Some(weight) = &link.inertial else {
        return Ok(());
    };
    let at = at.field("inertial");
    if !(1e-6..=1e6).contains(&weight.mass) {
        return refuse_field(at.field("mass"), "1e-6 to 1e6 kg", weight.mass.to_string());
    }
    if !weight.center.is_finite() {
        return refuse_field(
            at.field("origin"),
            "finite numbers",
            weight.center.to_string(),
        );
    }
    let m = weight.inertia;
    let whole = m.is_finite() && is_positive_definite(&m);
    if !whole {
        let found = format!("{:?}", m.to_cols_array());
        return refuse_field(at.field("inertia"), "a positive definite matrix", found);
    }
    Ok(())
}

/// Sylvester's criterion.
fn is_positive_definite(m: &DMat3) -> bool {
    let (a, b) = (m.x_axis, m.y_axis);
    a.x > 0.0 && a.x * b.y - a.y * b.x > 0.0 && m.determinant() > 0.0
}

/// Checks that moving links have a mass.
fn check_masses(robot: &Robot, at: &FileLocation) -> Result<(), HousesError> {
    let fixed = FixedJointTree::new(robot);
    for joint in robot
        .joints
        .iter()
        .filter(|joint| joint.kind != RobotJointKind::Fixed)
    {
        let group = fixed.rigid_group(joint.child);
        if group
            .iter()
            .all(|(link, _)| robot.links[*link].inertial.is_none())
        {
            let name = &robot.links[joint.child].name;
            let at = at
                .field(format_args!("link[{name}]"))
                .field("inertial.mass");
            return refuse_field(at, "a mass above 0 for what a joint moves", "none");
        }
    }
    Ok(())
}
