//! The parsed model into a [`Robot`].

use std::path::Path;

use dwell_scene::Pose;
use glam::{DMat3, DVec3, Vec3};
use mjcf_rs::body::{Body, InertiaSpec, Inertial, JointType};
use mjcf_rs::equality::Equality;
use mjcf_rs::{BodyId, Model};

use super::geoms::{self, Piece};
use super::{actuators, includes};
use crate::damage::Damage;
use crate::error::HousesError;
use crate::report::{At, Report};
use crate::robot::{Files, Joint, Link, Motion, Robot, Weight, check};
use crate::root::folder_of;

/// Reads an MJCF file: the first body of the world and what hangs on it.
///
/// # Errors
/// Those of [`open_robot`](crate::open_robot).
pub(crate) fn read(path: &Path, report: &mut Report) -> Result<Robot, HousesError> {
    let mut files = Files::around(path)?;
    let text = files.text()?;
    includes::check(&files, &text)?;
    let at = At::file(&files.file);
    let folder = files.root.folder().join(folder_of(&files.file));
    let model = Model::from_str(&text, folder).map_err(|error| HousesError::Syntax {
        at: at.clone(),
        message: error.to_string(),
    })?;
    let mut roots = model
        .bodies_iter()
        .filter(|(_, entry)| entry.parent == Some(0));
    let Some((root, _)) = roots.next() else {
        return Err(HousesError::Field {
            at,
            expected: "a <body> in <worldbody>",
            found: "none".to_owned(),
        });
    };
    let left_out = roots.count() + model.bodies[0].body.geoms.len();
    if left_out > 0 {
        let what = format!("{left_out} bodies or geoms of the world beside the robot are not read");
        report.warn(at.field("worldbody"), Damage::Simplified { what });
    }
    let bodies = below(&model, root);
    let (mut links, mut joints) = (Vec::new(), Vec::new());
    let mut fixed_base = true;
    for id in &bodies {
        let entry = &model.bodies[*id];
        let name = name_of(&model, *id);
        let at = at.field(format_args!("body[{name}]"));
        let pieces = geoms::pieces(&model, &entry.body, &mut files, &at, report)?;
        let of = |takes: fn(&Piece) -> bool| {
            let taken = pieces.iter().filter(|piece| takes(piece));
            taken.map(|piece| piece.shape.clone()).collect()
        };
        links.push(Link {
            weight: weight(&model, &entry.body, &pieces, &at)?,
            name,
            visuals: of(|piece| piece.seen),
            collisions: of(|piece| piece.touches),
        });
        if *id == root {
            fixed_base = !is_free(&entry.body, &at)?;
            continue;
        }
        let place = |id: BodyId| bodies.iter().position(|other| *other == id).unwrap_or(0);
        let parent = place(entry.parent.unwrap_or(root));
        joints.push(joint(&model, *id, [parent, place(*id)], &at)?);
    }
    for equality in &model.equality {
        follow(equality, &mut joints, &at, report);
    }
    actuators::add(&model, &mut joints, &at, report);
    check(Robot {
        name: model.name.clone().unwrap_or_else(|| "robot".to_owned()),
        source: files.file.clone(),
        format: "mjcf",
        links,
        joints,
        fixed_base,
    })
}

/// The name of a body; those without one are numbered.
fn name_of(model: &Model, id: BodyId) -> String {
    let name = model.bodies[id].body.name.clone();
    name.unwrap_or_else(|| format!("body_{id}"))
}

/// The name of a body's joint; those without one are called after the body.
fn joint_name(model: &Model, id: BodyId) -> String {
    let joint = model.bodies[id].body.joints.first();
    let name = joint.and_then(|joint| joint.name.clone());
    name.unwrap_or_else(|| format!("{}_joint", name_of(model, id)))
}

fn below(model: &Model, root: BodyId) -> Vec<BodyId> {
    let mut found = vec![root];
    let mut next = 0;
    while let Some(&id) = found.get(next) {
        let children = model
            .bodies_iter()
            .filter(|(_, entry)| entry.parent == Some(id));
        found.extend(children.map(|(child, _)| child));
        next += 1;
    }
    found
}

/// A pose in the scene's numbers.
pub(super) fn pose(pose: &mjcf_rs::Pose) -> Pose {
    let rotation = pose.rotation.normalize().as_quat();
    Pose::new(pose.translation.as_vec3(), rotation)
}

fn refuse<T>(at: At, expected: &'static str, found: impl Into<String>) -> Result<T, HousesError> {
    Err(HousesError::Field {
        at,
        expected,
        found: found.into(),
    })
}

/// Whether the root floats.
fn is_free(root: &Body, at: &At) -> Result<bool, HousesError> {
    match root.joints[..] {
        [] => Ok(false),
        [ref joint] if joint.type_ == JointType::Free => Ok(true),
        _ => refuse(
            at.field("joint"),
            "a free joint or none for the root",
            "another joint",
        ),
    }
}

fn joint(
    model: &Model,
    id: BodyId,
    [parent, child]: [usize; 2],
    at: &At,
) -> Result<Joint, HousesError> {
    let body = &model.bodies[id].body;
    let name = joint_name(model, id);
    let fixed = Joint {
        name: name.clone(),
        parent,
        child,
        motion: Motion::Fixed,
        parent_from_joint: pose(&body.pose),
        child_from_joint: Pose::IDENTITY,
        axis: Vec3::X,
        limits: None,
        initial: 0.0,
        friction: 0.0,
        damping: 0.0,
        armature: 0.0,
        servo: None,
        mimic: None,
    };
    let joint = match &body.joints[..] {
        [] => return Ok(fixed),
        [joint] => joint,
        several => {
            let found = format!("{} joints", several.len());
            return refuse(at.field("joint"), "at most one joint a body", found);
        }
    };
    let at = at.field(format_args!("joint[{name}]"));
    let motion = match joint.type_ {
        JointType::Hinge => Motion::Hinge,
        JointType::Slide => Motion::Slide,
        JointType::Ball => return refuse(at.field("type"), "hinge or slide", "ball"),
        JointType::Free => {
            return refuse(at.field("type"), "hinge or slide below the root", "free");
        }
    };
    let Some(axis) = DVec3::from_array(joint.axis).try_normalize() else {
        return refuse(at.field("axis"), "a direction", format!("{:?}", joint.axis));
    };
    if joint.ref_ != 0.0 || joint.stiffness != 0.0 {
        let field = if joint.ref_ == 0.0 {
            "stiffness"
        } else {
            "ref"
        };
        return refuse(
            at.field(field),
            "0: springs and references are not read",
            "another value",
        );
    }
    let anchor = Pose::from_position(DVec3::from_array(joint.pos).as_vec3());
    let limited = joint
        .limited
        .resolve(model.compiler.autolimits, joint.range.is_some());
    let range = joint.range.map(|range| range.map(|x| x as f32));
    Ok(Joint {
        motion,
        parent_from_joint: pose(&body.pose) * anchor,
        child_from_joint: anchor,
        axis: axis.as_vec3(),
        limits: range.filter(|_| limited),
        friction: joint.frictionloss as f32,
        damping: joint.damping as f32,
        armature: joint.armature as f32,
        ..fixed
    })
}

/// Mass as stated, else that of the geoms.
fn weight(
    model: &Model,
    body: &Body,
    pieces: &[Piece],
    at: &At,
) -> Result<Option<Weight>, HousesError> {
    use mjcf_rs::compiler::InertiaFromGeom;
    let from_geoms = model.compiler.inertia_from_geom;
    match &body.inertial {
        Some(stated) if from_geoms != InertiaFromGeom::True => {
            let weight = stated_weight(stated);
            if !(1e-6..=1e6).contains(&weight.mass) {
                let at = at.field("inertial.mass");
                return refuse(at, "a mass of 1e-6 to 1e6 kg", weight.mass.to_string());
            }
            Ok(Some(weight))
        }
        _ => geoms::weight(pieces, at),
    }
}

fn stated_weight(stated: &Inertial) -> Weight {
    let local = match stated.inertia {
        InertiaSpec::Diagonal(moments) => DMat3::from_diagonal(DVec3::from_array(moments)),
        InertiaSpec::Full([xx, yy, zz, xy, xz, yz]) => {
            DMat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz])
        }
    };
    let frame = pose(&stated.pose);
    let turn = DMat3::from_quat(frame.rotation.as_dquat().normalize());
    Weight {
        mass: stated.mass,
        center: frame.position.as_dvec3(),
        inertia: turn * local * turn.transpose(),
    }
}

/// A joint that an equality ties to another.
fn follow(equality: &Equality, joints: &mut [Joint], at: &At, report: &mut Report) {
    let Equality::Joint(tie) = equality else {
        let what = "equalities other than between two joints are not read".to_owned();
        return report.warn(at.field("equality"), Damage::Simplified { what });
    };
    let [offset, multiplier, higher @ ..] = tie.polycoef.map(|x| x as f32);
    let named = |name: &str| joints.iter().position(|joint| joint.name == name);
    let leader = tie.joint2.as_deref().and_then(named);
    match (named(&tie.joint1), leader) {
        (Some(follower), Some(leader)) if tie.common.active && higher == [0.0; 3] => {
            // Leaders come first in a house.
            let (follower, leader, multiplier, offset) = if follower > leader {
                (follower, leader, multiplier, offset)
            } else {
                (leader, follower, 1.0 / multiplier, -offset / multiplier)
            };
            let name = joints[leader].name.clone();
            joints[follower].mimic = Some((name, multiplier, offset));
        }
        _ => {
            let what = format!("the equality of joint {:?} is not read", tie.joint1);
            report.warn(at.field("equality"), Damage::Simplified { what });
        }
    }
}
