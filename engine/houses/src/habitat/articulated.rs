//! Articulated objects: URDF files with a pose.

use dwell_scene::{Aabb, Mobility};
use serde_json::Value;

use super::dataset::TemplateKind;
use super::file::{ArticulatedTemplate, ObjectInstance};
use super::objects::{coarse_category, containing_room_and_level};
use super::{HabitatReader, place};
use crate::data_root::DataRoot;
use crate::report::FileLocation;
use crate::robot::{self, Robot};
use crate::urdf;
use crate::warning_kind::WarningKind;

impl HabitatReader<'_> {
    /// Adds the articulated object that `instance` places: a URDF by name, or a template that names one.
    pub(super) fn articulated(&mut self, instance: &ObjectInstance, at: &FileLocation) {
        let name = &instance.template_name;
        let config = self
            .dataset
            .template(TemplateKind::Articulated, name, self.report);
        let template = match &config {
            Some(found) => match self.parse::<ArticulatedTemplate>(found) {
                Some(template) => template,
                None => return,
            },
            None => ArticulatedTemplate::default(),
        };
        let Some(found) = config.or_else(|| self.template(TemplateKind::Urdf, name, at)) else {
            return;
        };
        let path = if template.urdf_filepath.is_empty() {
            Ok(found.path.clone())
        } else {
            DataRoot::resolve(&found.folder, &template.urdf_filepath)
        };
        let Ok(path) = path else {
            let path = template.urdf_filepath;
            return self
                .report
                .warn(found.at, WarningKind::PathRefused { path });
        };
        let (Some(pose), Some(scale)) = (place::pose(instance), place::scale(instance)) else {
            let reason = "numbers that are no place or no scale".to_owned();
            return self
                .report
                .warn(at.clone(), WarningKind::BadTransform { reason });
        };
        let mut robot = match self.robot(&path) {
            Ok(robot) => robot,
            Err(reason) => {
                return self
                    .report
                    .warn(at.clone(), WarningKind::UnreadableMesh { path, reason });
            }
        };
        if (scale.max_element() - scale.min_element()).abs() > 1e-3 * scale.x.abs() || scale.x < 0.0
        {
            let what = format!("scale {scale} of an articulated object; its first number counts");
            self.report
                .warn(at.clone(), WarningKind::Simplified { what });
        }
        let usual = |value: Option<f32>| value.filter(|x| *x > 0.0 && x.is_finite()).unwrap_or(1.0);
        let factor = scale.x.abs() * usual(template.uniform_scale);
        let grown = if instance.apply_scale_to_mass {
            factor.powi(3)
        } else {
            1.0
        };
        let mass = usual(template.mass_scale) * usual(Some(instance.mass_scale)) * grown;
        if (factor, mass) != (1.0, 1.0) {
            robot = robot.scaled(factor, mass);
        }
        set_initial_positions(&mut robot, &instance.initial_joint_pose);
        let of_template = || {
            template
                .base_type
                .as_deref()
                .is_some_and(|base| base == "fixed")
        };
        let fixed = instance.fixed_base.unwrap_or_else(of_template);
        let row = self.category(name, template.semantic_id, &found);
        let word = name.rsplit('/').next().unwrap_or(name);
        let unique = self
            .names
            .numbered(row.map_or(word, |row| row.name.as_str()));
        let (first_joint, object) = (self.data.joints.len(), self.data.objects.len());
        robot::add(
            &mut self.data,
            &robot,
            &unique,
            pose,
            fixed,
            &mut self.material_names,
        );
        // Joints of a robot state no direction: doors and drawers of furniture open towards their farther limit.
        for joint in &mut self.data.joints.as_mut_slice()[first_joint..] {
            if let (Some([low, high]), None) = (joint.limits, &joint.mimic) {
                joint.closed = 0.0_f32.clamp(low, high);
                joint.open = if high.abs() >= low.abs() { high } else { low };
            }
        }
        let mut bounds = Aabb::EMPTY;
        for part in self.data.objects.as_slice()[object].parts() {
            let part = &self.data.parts[part];
            let place = part.world_from_part.to_affine();
            bounds = bounds.union(&self.data.meshes[part.mesh].bounds().transformed(&place));
        }
        let (room, level) = containing_room_and_level(&self.data, &bounds);
        let added = &mut self.data.objects.as_mut_slice()[object];
        instance.template_name.clone_into(&mut added.source_id);
        (added.room, added.level, added.category) = (room, level, coarse_category(row));
        if !fixed {
            added.mobility = Mobility::Movable;
        }
    }

    fn robot(&mut self, path: &str) -> Result<Robot, String> {
        if let Some(known) = self.robots.get(path) {
            return known.clone();
        }
        let full = self.dataset.root.folder().join(path);
        // A link out of the data set is refused before the URDF's own folder becomes a root.
        let inside = self.dataset.root.check_inside(&full, path);
        let read = inside.and_then(|()| urdf::read(&full, self.report));
        let read = read.map_err(|error| error.to_string());
        self.robots.insert(path.to_owned(), read.clone());
        read
    }
}

/// Positions in order or by name, brought into the limits.
fn set_initial_positions(robot: &mut Robot, pose: &Value) {
    let moving = robot
        .joints
        .iter_mut()
        .filter(|joint| joint.kind != robot::RobotJointKind::Fixed);
    for (k, joint) in moving.enumerate() {
        let stated = match pose {
            Value::Array(list) => list.get(k),
            Value::Object(by_name) => by_name.get(&joint.name),
            _ => None,
        };
        if let Some(position) = stated.and_then(Value::as_f64) {
            joint.initial = position as f32;
        }
    }
}
