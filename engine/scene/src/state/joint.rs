//! What is in force at a joint: the house's values with the state's overrides.

use super::{Address, State};
use crate::articulation::{Articulation, Servo};
use crate::house::House;
use crate::ids::JointId;
use crate::space::Pose;

/// What is in force at a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointValues {
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
    /// Lowest and highest position, rad or m; `None`: it turns or slides without end.
    pub limits: Option<[f32; 2]>,
}

impl JointValues {
    /// `position` within the limits.
    pub fn clamp(&self, position: f32) -> f32 {
        // Limits are only set in order.
        self.limits
            .map_or(position, |[low, high]| position.max(low).min(high))
    }
}

/// A field with its unit and range. `None` in the house means that the joint has no such thing.
pub(super) struct Field {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) range: [f64; 2],
    pub(super) get: fn(&Articulation) -> Option<f32>,
}

/// The fields of a joint that have an address.
pub(super) const FIELDS: [Field; 12] = [
    Field {
        name: "friction",
        unit: "N m or N",
        range: [0.0, 1e6],
        get: |joint| Some(joint.friction),
    },
    Field {
        name: "damping",
        unit: "N m s/rad or N s/m",
        range: [0.0, 1e6],
        get: |joint| Some(joint.damping),
    },
    Field {
        name: "armature",
        unit: "kg m2 or kg",
        range: [0.0, 1e6],
        get: |joint| Some(joint.armature),
    },
    Field {
        name: "length_m",
        unit: "m",
        range: [1e-6, 100.0],
        get: |joint| {
            let length = joint.parent_from_joint.position.length();
            (joint.parent.is_some() && length > 0.0).then_some(length)
        },
    },
    Field {
        name: "lower",
        unit: "rad or m",
        range: [-1e4, 1e4],
        get: |joint| joint.limits.map(|[low, _]| low),
    },
    Field {
        name: "upper",
        unit: "rad or m",
        range: [-1e4, 1e4],
        get: |joint| joint.limits.map(|[_, high]| high),
    },
    Field {
        name: "stiffness",
        unit: "N m/rad or N/m",
        range: [0.0, 1e9],
        get: |joint| joint.servo.map(|servo| servo.stiffness),
    },
    Field {
        name: "servo_damping",
        unit: "N m s/rad or N s/m",
        range: [0.0, 1e9],
        get: |joint| joint.servo.map(|servo| servo.damping),
    },
    Field {
        name: "velocity_gain",
        unit: "N m s/rad or N s/m",
        range: [0.0, 1e9],
        get: |joint| joint.servo.map(|servo| servo.velocity_gain),
    },
    Field {
        name: "max_effort",
        unit: "N m or N",
        range: [0.0, 1e9],
        get: |joint| joint.servo.map(|servo| servo.max_effort),
    },
    Field {
        name: "max_velocity",
        unit: "rad/s or m/s",
        range: [0.0, 1e6],
        get: |joint| joint.servo.and_then(|servo| servo.max_velocity),
    },
    Field {
        name: "gear",
        unit: "1",
        range: [1e-6, 1e6],
        get: |joint| joint.servo.map(|servo| servo.gear),
    },
];

impl State {
    /// The range of a joint's field: a limit stays on its side of the other one.
    pub(super) fn joint_range(&self, house: &House, id: JointId, field: &Field) -> [f64; 2] {
        let [low, high] = field.range;
        match (field.name, self.joint_values(house, id).limits) {
            ("lower", Some([_, upper])) => [low, upper.into()],
            ("upper", Some([lower, _])) => [lower.into(), high],
            _ => [low, high],
        }
    }

    /// What is in force at a joint.
    pub fn joint_values(&self, house: &House, id: JointId) -> JointValues {
        let joint = &house.joints[id];
        let mut values = JointValues {
            parent_from_joint: joint.parent_from_joint,
            friction: joint.friction,
            damping: joint.damping,
            armature: joint.armature,
            servo: joint.servo,
            limits: joint.limits,
        };
        if self.overrides.is_empty() {
            return values;
        }
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
                _ => {}
            }
        }
        if let (Some(now), Some(before)) = (&values.servo, &joint.servo) {
            let share = now.gear / before.gear;
            values.armature *= share * share;
        }
        values
    }

    /// Where a joint's child stands when the parent stands at `world_from_parent` and the joint at `position`.
    pub fn world_from_child(
        &self,
        house: &House,
        id: JointId,
        world_from_parent: &Pose,
        position: f32,
    ) -> Pose {
        let joint = &house.joints[id];
        *world_from_parent
            * self.joint_values(house, id).parent_from_joint
            * joint.motion(position)
            * joint.child_from_joint.inverse()
    }
}
