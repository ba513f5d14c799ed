//! Conversion of the parsed model into a [`Robot`].

use std::collections::BTreeMap;
use std::path::Path;

use dwell_scene::{Pose, interrupt};
use glam::{DMat3, DVec3, Vec3};
use mjcf_rs::body::{Body, InertiaSpec, Inertial, JointType};
use mjcf_rs::equality::Equality;
use mjcf_rs::{BodyId, Model};

use super::geoms::{self, BodyGeom};
use super::{actuators, includes};
use crate::data_root::parent_folder;
use crate::error::{HousesError, refuse_field};
use crate::limits::MAX_NODES;
use crate::report::{FileLocation, LoadReport};
use crate::robot::{
    LinkInertia, Robot, RobotFileLoader, RobotJoint, RobotJointKind, RobotLink, check,
};
use crate::warning_kind::WarningKind;

/// A parsed file with its folder.
pub(super) struct MjcfSource {
    pub(super) model: Model,
    files: RobotFileLoader,
    pub(super) at: FileLocation,
    /// The child bodies of each body.
    children: Vec<Vec<BodyId>>,
}

impl MjcfSource {
    /// Reads and parses the file at `path`.
    ///
    /// # Errors
    /// Those of [`open_robot`](crate::open_robot) for files that cannot be read or are not this format.
    pub(super) fn load(path: &Path, report: &mut LoadReport) -> Result<Self, HousesError> {
        let files = RobotFileLoader::of_file(path)?;
        let text = files.text()?;
        includes::check(&files, &text, report)?;
        let at = FileLocation::file(&files.file);
        let folder = files.root.folder().join(parent_folder(&files.file));
        let model = Model::from_str(&text, folder).map_err(|error| HousesError::Syntax {
            at: at.clone(),
            message: error.to_string(),
        })?;
        let count = model.bodies.len();
        if count > MAX_NODES {
            return Err(HousesError::TooLarge {
                at: at.field("worldbody"),
                what: "body count",
                found: count as u64,
                allowed: MAX_NODES as u64,
            });
        }
        let mut children = vec![Vec::new(); count];
        for (id, entry) in model.bodies_iter() {
            if let Some(parent) = entry.parent {
                children[parent].push(id);
            }
        }
        Ok(Self {
            model,
            files,
            at,
            children,
        })
    }

    /// The file's name inside its folder.
    pub(super) fn name(&self) -> &str {
        &self.files.file
    }

    /// The bodies without a parent.
    pub(super) fn root_bodies(&self) -> Vec<BodyId> {
        let roots = self.model.bodies_iter();
        let roots = roots.filter(|(_, entry)| entry.parent == Some(0));
        roots.map(|(id, _)| id).collect()
    }

    /// The child bodies of a body.
    pub(super) fn children(&self, id: BodyId) -> &[BodyId] {
        &self.children[id]
    }

    /// A body with its descendants, parents first.
    fn subtree(&self, root: BodyId) -> Vec<BodyId> {
        let mut found = vec![root];
        let mut next = 0;
        while let Some(&id) = found.get(next) {
            found.extend(&self.children[id]);
            next += 1;
        }
        found
    }

    /// The geoms of a body.
    ///
    /// # Errors
    /// [`HousesError::Field`] for a mesh that cannot be read.
    pub(super) fn body_geoms(
        &mut self,
        id: BodyId,
        report: &mut LoadReport,
    ) -> Result<Vec<BodyGeom>, HousesError> {
        let name = name_of(&self.model, id);
        let at = self.at.field(format_args!("body[{name}]"));
        let body = &self.model.bodies[id].body;
        geoms::body_geoms(&self.model, body, &mut self.files, &at, report)
    }

    /// Converts a body with its descendants. A root with a hinge or slide gets a fixed empty link as its parent.
    ///
    /// # Errors
    /// Those of [`open_robot`](crate::open_robot).
    pub(super) fn robot(
        &mut self,
        root: BodyId,
        report: &mut LoadReport,
    ) -> Result<Robot, HousesError> {
        let bodies = self.subtree(root);
        let (mut links, mut joints) = (Vec::new(), Vec::new());
        let root_at = self
            .at
            .field(format_args!("body[{}]", name_of(&self.model, root)));
        let base = root_attachment(&self.model.bodies[root].body, &root_at)?;
        let hung = usize::from(base == RootAttachment::Hung);
        if base == RootAttachment::Hung {
            links.push(RobotLink {
                name: format!("{}_frame", name_of(&self.model, root)),
                inertial: None,
                visuals: Vec::new(),
                collisions: Vec::new(),
            });
        }
        let places: BTreeMap<BodyId, usize> = bodies.iter().copied().zip(hung..).collect();
        for id in &bodies {
            interrupt::unwind_if_cancelled();
            let pieces = self.body_geoms(*id, report)?;
            let entry = &self.model.bodies[*id];
            let name = name_of(&self.model, *id);
            let at = self.at.field(format_args!("body[{name}]"));
            let of = |takes: fn(&BodyGeom) -> bool| {
                let taken = pieces.iter().filter(|piece| takes(piece));
                taken.map(|piece| piece.shape.clone()).collect()
            };
            links.push(RobotLink {
                inertial: link_inertia(&self.model, &entry.body, &pieces, &at, report)?,
                name,
                visuals: of(|piece| piece.is_visible),
                collisions: of(|piece| piece.has_contacts),
            });
            let place = |id: BodyId| places.get(&id).copied().unwrap_or(hung);
            if *id == root {
                if base == RootAttachment::Hung {
                    let mut joint = joint(&self.model, root, [0, 1], &at)?;
                    // The frame stands where the body does.
                    joint.parent_from_joint = joint.child_from_joint;
                    joints.push(joint);
                }
                continue;
            }
            let parent = place(entry.parent.unwrap_or(root));
            joints.push(joint(&self.model, *id, [parent, place(*id)], &at)?);
        }
        // The first of a name, where files give it twice.
        let names = joints.iter().enumerate().rev();
        let by_name: BTreeMap<String, usize> =
            names.map(|(k, joint)| (joint.name.clone(), k)).collect();
        for equality in &self.model.equality {
            interrupt::unwind_if_cancelled();
            apply_joint_equality(equality, &mut joints, &by_name, &self.at, report);
        }
        actuators::add_servos(&self.model, &mut joints, &by_name, &self.at, report);
        check(Robot {
            name: self
                .model
                .name
                .clone()
                .unwrap_or_else(|| "robot".to_owned()),
            source: self.files.file.clone(),
            format: "mjcf",
            links,
            joints,
            fixed_base: base != RootAttachment::Free,
        })
    }

    /// The first body of the world with its descendants; other contents of the world are reported.
    ///
    /// # Errors
    /// Those of [`open_robot`](crate::open_robot).
    pub(super) fn first_robot(&mut self, report: &mut LoadReport) -> Result<Robot, HousesError> {
        let roots = self.root_bodies();
        let Some(root) = roots.first() else {
            let expected = "a <body> in <worldbody> (what <replicate>, <composite> and <flexcomp> make is not read)";
            return refuse_field(self.at.clone(), expected, "none");
        };
        let left_out = roots.len() - 1 + self.model.bodies[0].body.geoms.len();
        if left_out > 0 {
            let what =
                format!("{left_out} bodies or geoms of the world beside the robot are not read");
            let at = self.at.field("worldbody");
            report.warn(at, WarningKind::Simplified { what });
        }
        self.robot(*root, report)
    }
}

/// Reads an MJCF file: the first body of the world with its descendants.
///
/// # Errors
/// Those of [`open_robot`](crate::open_robot).
pub(crate) fn read(path: &Path, report: &mut LoadReport) -> Result<Robot, HousesError> {
    MjcfSource::load(path, report)?.first_robot(report)
}

/// The name of a body; those without one are numbered.
pub(super) fn name_of(model: &Model, id: BodyId) -> String {
    let name = model.bodies[id].body.name.clone();
    name.unwrap_or_else(|| format!("body_{id}"))
}

/// The name of a body's joint; those without one are called after the body.
fn joint_name(model: &Model, id: BodyId) -> String {
    let joint = model.bodies[id].body.joints.first();
    let name = joint.and_then(|joint| joint.name.clone());
    name.unwrap_or_else(|| format!("{}_joint", name_of(model, id)))
}

/// A pose in the scene's numbers.
pub(super) fn pose(pose: &mjcf_rs::Pose) -> Pose {
    let rotation = pose.rotation.normalize().as_quat();
    Pose::new(pose.translation.as_vec3(), rotation)
}

/// The attachment of a root body to the world.
#[derive(Clone, Copy, PartialEq, Eq)]
enum RootAttachment {
    /// Nothing: it falls.
    Free,
    /// The world.
    Fixed,
    /// A hinge or slide on the world: a door.
    Hung,
}

fn root_attachment(root: &Body, at: &FileLocation) -> Result<RootAttachment, HousesError> {
    match root.joints[..] {
        [] => Ok(RootAttachment::Fixed),
        [ref joint] if joint.type_ == JointType::Free => Ok(RootAttachment::Free),
        [ref joint] if matches!(joint.type_, JointType::Hinge | JointType::Slide) => {
            Ok(RootAttachment::Hung)
        }
        _ => refuse_field(
            at.field("joint"),
            "a free joint, a hinge, a slide or none for the root",
            "another joint",
        ),
    }
}

fn joint(
    model: &Model,
    id: BodyId,
    [parent, child]: [usize; 2],
    at: &FileLocation,
) -> Result<RobotJoint, HousesError> {
    let body = &model.bodies[id].body;
    let name = joint_name(model, id);
    let fixed = RobotJoint {
        name: name.clone(),
        parent,
        child,
        kind: RobotJointKind::Fixed,
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
            return refuse_field(at.field("joint"), "at most one joint a body", found);
        }
    };
    let at = at.field(format_args!("joint[{name}]"));
    let motion = match joint.type_ {
        JointType::Hinge => RobotJointKind::Hinge,
        JointType::Slide => RobotJointKind::Slide,
        JointType::Ball => return refuse_field(at.field("type"), "hinge or slide", "ball"),
        JointType::Free => {
            return refuse_field(at.field("type"), "hinge or slide below the root", "free");
        }
    };
    let Some(axis) = DVec3::from_array(joint.axis).try_normalize() else {
        return refuse_field(at.field("axis"), "a direction", format!("{:?}", joint.axis));
    };
    if joint.ref_ != 0.0 || joint.stiffness != 0.0 {
        let field = if joint.ref_ == 0.0 {
            "stiffness"
        } else {
            "ref"
        };
        return refuse_field(
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
    Ok(RobotJoint {
        kind: motion,
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
fn link_inertia(
    model: &Model,
    body: &Body,
    pieces: &[BodyGeom],
    at: &FileLocation,
    report: &mut LoadReport,
) -> Result<Option<LinkInertia>, HousesError> {
    use mjcf_rs::compiler::InertiaFromGeom;
    let from_geoms = model.compiler.inertia_from_geom;
    match &body.inertial {
        Some(stated) if from_geoms != InertiaFromGeom::True => {
            let weight = stated_inertia(stated);
            if !(1e-6..=1e6).contains(&weight.mass) {
                let at = at.field("inertial.mass");
                return refuse_field(at, "a mass of 1e-6 to 1e6 kg", weight.mass.to_string());
            }
            weight.report_impossible(&at.field("inertial"), report);
            Ok(Some(weight))
        }
        _ => geoms::mass_of_geoms(pieces, at),
    }
}

fn stated_inertia(stated: &Inertial) -> LinkInertia {
    let local = match stated.inertia {
        InertiaSpec::Diagonal(moments) => DMat3::from_diagonal(DVec3::from_array(moments)),
        InertiaSpec::Full([xx, yy, zz, xy, xz, yz]) => {
            DMat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz])
        }
    };
    let frame = pose(&stated.pose);
    let turn = DMat3::from_quat(frame.rotation.as_dquat().normalize());
    LinkInertia {
        mass: stated.mass,
        center: frame.position.as_dvec3(),
        inertia: turn * local * turn.transpose(),
    }
}

/// Ties a joint to another by an equality; `by_name` gives positions in `joints`.
fn apply_joint_equality(
    equality: &Equality,
    joints: &mut [RobotJoint],
    by_name: &BTreeMap<String, usize>,
    at: &FileLocation,
    report: &mut LoadReport,
) {
    let Equality::Joint(tie) = equality else {
        let what = "equalities other than between two joints are not read".to_owned();
        return report.warn(at.field("equality"), WarningKind::Simplified { what });
    };
    let [offset, multiplier, higher @ ..] = tie.polycoef.map(|x| x as f32);
    let named = |name: &str| by_name.get(name).copied();
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
            report.warn(at.field("equality"), WarningKind::Simplified { what });
        }
    }
}
