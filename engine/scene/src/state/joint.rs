//! Joint parameters in force: the house's values with the state's overrides.

use super::{Address, State};
use crate::articulation::{Joint, JointKind, Mimic, Servo, motion_along};
use crate::error::SceneError;
use crate::house::House;
use crate::ids::JointId;
use crate::space::Pose;
use glam::Vec3;

/// The shortest axis with a defined direction.
const SHORTEST_AXIS: f32 = 1e-3;

/// The parameters in force at a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointParameters {
    /// Hinge or slide.
    pub kind: JointKind,
    /// The axis in joint space, unit length.
    pub axis: Vec3,
    /// The joint's frame on the parent; its distance from the parent's origin is `length_m`.
    pub parent_from_joint: Pose,
    /// Coulomb friction, N·m or N.
    pub friction: f32,
    /// Viscous damping, N·m·s/rad or N·s/m.
    pub damping: f32,
    /// Inertia of the joint itself, kg·m² or kg, with the gear that is in force.
    pub armature: f32,
    /// The motor.
    pub servo: Option<Servo>,
    /// The share of the weight on the joint that the motor's controller compensates; 1 in a house whose motor has
    /// [`Servo::feed_forward`].
    pub feed_forward: f32,
    /// Its coupling to another joint, if it is a mimic joint.
    pub mimic: Option<Mimic>,
    /// Lowest and highest position, rad or m; `None`: it turns or slides without end.
    pub limits: Option<[f32; 2]>,
}

impl JointParameters {
    /// `position` within the limits.
    pub fn clamp(&self, position: f32) -> f32 {
        // Limits are always in order.
        self.limits
            .map_or(position, |[low, high]| position.max(low).min(high))
    }

    /// Returns the displacement of the joint at `position` (rad or m).
    pub fn motion(&self, position: f32) -> Pose {
        motion_along(self.kind, self.axis, position)
    }
}

/// A field with its unit and range. `None` in the house means that the joint does not have it.
pub(super) struct JointField {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) range: [f64; 2],
    pub(super) get: fn(&Joint) -> Option<f32>,
}

/// The fields of a joint that have an address.
pub(super) const FIELDS: [JointField; 18] = [
    JointField {
        name: "friction",
        unit: "N m or N",
        range: [0.0, 1e6],
        get: |joint| Some(joint.friction),
    },
    JointField {
        name: "damping",
        unit: "N m s/rad or N s/m",
        range: [0.0, 1e6],
        get: |joint| Some(joint.damping),
    },
    JointField {
        name: "armature",
        unit: "kg m2 or kg",
        range: [0.0, 1e6],
        get: |joint| Some(joint.armature),
    },
    JointField {
        name: "length_m",
        unit: "m",
        range: [1e-6, 100.0],
        get: |joint| {
            let length = joint.parent_from_joint.position.length();
            (joint.parent.is_some() && length > 0.0).then_some(length)
        },
    },
    JointField {
        name: "lower",
        unit: "rad or m",
        range: [-1e4, 1e4],
        get: |joint| joint.limits.map(|[low, _]| low),
    },
    JointField {
        name: "upper",
        unit: "rad or m",
        range: [-1e4, 1e4],
        get: |joint| joint.limits.map(|[_, high]| high),
    },
    JointField {
        name: "stiffness",
        unit: "N m/rad or N/m",
        range: [0.0, 1e9],
        get: |joint| joint.servo.map(|servo| servo.stiffness),
    },
    JointField {
        name: "servo_damping",
        unit: "N m s/rad or N s/m",
        range: [0.0, 1e9],
        get: |joint| joint.servo.map(|servo| servo.damping),
    },
    JointField {
        name: "velocity_gain",
        unit: "N m s/rad or N s/m",
        range: [0.0, 1e9],
        get: |joint| joint.servo.map(|servo| servo.velocity_gain),
    },
    JointField {
        name: "max_effort",
        unit: "N m or N",
        range: [0.0, 1e9],
        get: |joint| joint.servo.map(|servo| servo.max_effort),
    },
    JointField {
        name: "max_velocity",
        unit: "rad/s or m/s",
        range: [0.0, 1e6],
        get: |joint| joint.servo.and_then(|servo| servo.max_velocity),
    },
    JointField {
        name: "gear",
        unit: "1",
        range: [1e-6, 1e6],
        get: |joint| joint.servo.map(|servo| servo.gear),
    },
    JointField {
        name: "axis_x",
        unit: "1",
        range: [-2.0, 2.0],
        get: |joint| Some(joint.axis.x),
    },
    JointField {
        name: "axis_y",
        unit: "1",
        range: [-2.0, 2.0],
        get: |joint| Some(joint.axis.y),
    },
    JointField {
        name: "axis_z",
        unit: "1",
        range: [-2.0, 2.0],
        get: |joint| Some(joint.axis.z),
    },
    JointField {
        name: "mimic_multiplier",
        unit: "rad or m per rad or m",
        range: [-1e3, 1e3],
        get: |joint| joint.mimic.map(|mimic| mimic.multiplier),
    },
    JointField {
        name: "mimic_offset",
        unit: "rad or m",
        range: [-1e4, 1e4],
        get: |joint| joint.mimic.map(|mimic| mimic.offset),
    },
    JointField {
        name: "feed_forward",
        unit: "1",
        range: [0.0, 2.0],
        get: |joint| joint.servo.map(|servo| gravity_compensation(&servo)),
    },
];

/// The share of the weight that a motor of the house compensates.
fn gravity_compensation(servo: &Servo) -> f32 {
    f32::from(u8::from(servo.feed_forward))
}

impl State {
    /// The range of a joint's field: a limit stays on its side of the other one.
    pub(super) fn joint_range(&self, house: &House, id: JointId, field: &JointField) -> [f64; 2] {
        let [low, high] = field.range;
        match (field.name, self.joint_parameters(house, id).limits) {
            ("lower", Some([_, upper])) => [low, upper.into()],
            ("upper", Some([lower, _])) => [lower.into(), high],
            _ => [low, high],
        }
    }

    /// Returns the parameters in force at a joint.
    pub fn joint_parameters(&self, house: &House, id: JointId) -> JointParameters {
        let joint = &house.joints[id];
        let mut values = JointParameters {
            kind: joint.kind,
            axis: joint.axis,
            parent_from_joint: joint.parent_from_joint,
            friction: joint.friction,
            damping: joint.damping,
            armature: joint.armature,
            servo: joint.servo,
            feed_forward: joint.servo.as_ref().map_or(0.0, gravity_compensation),
            mimic: joint.mimic,
            limits: joint.limits,
        };
        if self.overrides.is_empty() {
            return values;
        }
        let mut turned = false;
        for field in &FIELDS {
            let address = Address::of_joint(id, field.name);
            let Some(value) = self.overrides.get(&address).map(|value| *value as f32) else {
                continue;
            };
            match (field.name, &mut values.servo) {
                ("lower" | "upper", _) => {
                    if let Some(limits) = &mut values.limits {
                        limits[usize::from(field.name == "upper")] = value;
                    }
                }
                ("friction", _) => values.friction = value,
                ("damping", _) => values.damping = value,
                ("armature", _) => values.armature = value,
                ("length_m", _) => {
                    let direction = joint.parent_from_joint.position.normalize_or_zero();
                    values.parent_from_joint.position = direction * value;
                }
                ("stiffness", Some(servo)) => servo.stiffness = value,
                ("servo_damping", Some(servo)) => servo.damping = value,
                ("velocity_gain", Some(servo)) => servo.velocity_gain = value,
                ("max_effort", Some(servo)) => servo.max_effort = value,
                ("max_velocity", Some(servo)) => servo.max_velocity = Some(value),
                ("gear", Some(servo)) => servo.gear = value,
                ("feed_forward", _) => values.feed_forward = value,
                ("axis_x" | "axis_y" | "axis_z", _) => {
                    turned = true;
                    let place = usize::from(field.name.as_bytes()[5] - b'x');
                    values.axis[place] = value;
                }
                ("mimic_multiplier" | "mimic_offset", _) => {
                    if let Some(mimic) = &mut values.mimic {
                        if field.name == "mimic_offset" {
                            mimic.offset = value;
                        } else {
                            mimic.multiplier = value;
                        }
                    }
                }
                _ => {}
            }
        }
        if turned {
            values.axis = values.axis.normalize_or(joint.axis);
        }
        if let (Some(now), Some(before)) = (&values.servo, &joint.servo) {
            let share = now.gear / before.gear;
            values.armature *= share * share;
        }
        values
    }

    /// Returns the pose of a joint's child with the parent at `world_from_parent` and the joint at `position`.
    pub fn world_from_child(
        &self,
        house: &House,
        id: JointId,
        world_from_parent: &Pose,
        position: f32,
    ) -> Pose {
        let values = self.joint_parameters(house, id);
        *world_from_parent
            * values.parent_from_joint
            * values.motion(position)
            * house.joints[id].child_from_joint.inverse()
    }

    /// Refuses a joint axis without a direction. The three numbers of an axis may have any length but 0: only their
    /// direction counts, so that each of them can be set alone.
    pub(super) fn check_axis(&self, house: &House, canonical: &Address) -> Result<(), SceneError> {
        let ["joint", id, "axis_x" | "axis_y" | "axis_z"] = canonical.words()[..] else {
            return Ok(());
        };
        let Some((id, joint)) = id
            .parse()
            .ok()
            .map(JointId)
            .and_then(|id| Some((id, house.joints.get(id)?)))
        else {
            return Ok(());
        };
        let number = |field, base| self.override_or(&Address::of_joint(id, field), base);
        let axis = Vec3::new(
            number("axis_x", joint.axis.x),
            number("axis_y", joint.axis.y),
            number("axis_z", joint.axis.z),
        );
        if axis.length() >= SHORTEST_AXIS {
            return Ok(());
        }
        Err(canonical.invalid(format!(
            "the joint's axis would be {axis}, which has no direction; allowed is a length of at least {SHORTEST_AXIS}"
        )))
    }
}
