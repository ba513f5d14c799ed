//! The laws in effect in a world, by the stage of the step at which they act.

use super::body_law::BodyLaw;
use crate::bases::BaseLaw;
use crate::contact::{ContactLaw, ContactProperties, ContactTable};
use crate::engine::ContactCompliance;
use crate::inertia::MassLaw;
use crate::joints::{LinkLaw, MotorLaw, ResistanceLaw, StatefulLaw};
use dwell_scene::{House, JointId, LawSpec};
use std::sync::Arc;

/// The effect of a law at one stage.
#[derive(Debug)]
pub(crate) enum LawEffect {
    /// Masses of bodies.
    Mass(Arc<dyn MassLaw>),
    /// Bodies between steps.
    Body(Arc<dyn BodyLaw>),
    /// Forces on the bodies of kinematic trees.
    Link(Arc<dyn LinkLaw>),
    /// The values of contacts.
    Contact(Arc<dyn ContactLaw>),
    /// Compliance of all contacts.
    Compliance(ContactCompliance),
    /// Motor efforts.
    Motor(Box<dyn MotorLaw>),
    /// Joint resistances.
    Resistance(Box<dyn ResistanceLaw>),
    /// Motion of bases.
    Base(Arc<dyn BaseLaw>),
}

/// An effect with state, with the index of its law among those installed.
#[derive(Clone, Debug)]
pub(crate) struct IndexedEffect<T> {
    law: usize,
    pub(crate) effect: T,
}

/// The laws in effect; each list is in the order of installation.
#[derive(Clone, Debug, Default)]
pub(crate) struct LawSet {
    /// The spec of each law.
    specs: Vec<LawSpec>,
    pub(crate) masses: Vec<Arc<dyn MassLaw>>,
    pub(crate) bodies: Vec<Arc<dyn BodyLaw>>,
    pub(crate) links: Vec<Arc<dyn LinkLaw>>,
    pub(crate) contacts: Vec<Arc<dyn ContactLaw>>,
    /// The contact compliance; of several laws the last decides.
    pub(crate) compliance: Option<ContactCompliance>,
    pub(crate) motors: Vec<IndexedEffect<Box<dyn MotorLaw>>>,
    pub(crate) resistances: Vec<IndexedEffect<Box<dyn ResistanceLaw>>>,
    pub(crate) bases: Vec<Arc<dyn BaseLaw>>,
}

impl LawSet {
    pub(super) fn add(&mut self, spec: LawSpec, effects: Vec<LawEffect>) {
        let law = self.specs.len();
        self.specs.push(spec);
        for effect in effects {
            match effect {
                LawEffect::Mass(effect) => self.masses.push(effect),
                LawEffect::Body(effect) => self.bodies.push(effect),
                LawEffect::Link(effect) => self.links.push(effect),
                LawEffect::Contact(effect) => self.contacts.push(effect),
                LawEffect::Compliance(effect) => self.compliance = Some(effect),
                LawEffect::Motor(effect) => self.motors.push(IndexedEffect { law, effect }),
                LawEffect::Resistance(effect) => {
                    self.resistances.push(IndexedEffect { law, effect });
                }
                LawEffect::Base(effect) => self.bases.push(effect),
            }
        }
    }

    /// Returns the laws' specs, in order of installation.
    pub(crate) fn specs(&self) -> &[LawSpec] {
        &self.specs
    }

    /// Returns the contact values of colliders under these laws.
    pub(crate) fn contact_properties<'a>(
        &'a self,
        house: &'a House,
        table: &'a ContactTable,
    ) -> ContactProperties<'a> {
        ContactProperties {
            house,
            table,
            laws: &self.contacts,
            is_compliant: self.compliance.is_some(),
        }
    }

    /// Notes that a joint was set to `position` (rad or m) from outside.
    pub(crate) fn notify_joint_set(&mut self, joint: JointId, position: f32) {
        for (_, effect) in self.stateful_laws() {
            effect.on_joint_set(joint, position);
        }
    }

    /// Returns the state of each law. Shape (law, number).
    pub(crate) fn law_states(&self) -> Vec<Vec<f32>> {
        let mut memory = vec![Vec::new(); self.specs.len()];
        for motor in &self.motors {
            memory[motor.law].extend(motor.effect.state());
        }
        for resistance in &self.resistances {
            memory[resistance.law].extend(resistance.effect.state());
        }
        memory
    }

    /// Restores a law's state.
    pub(crate) fn restore_law_state(&mut self, law: usize, memory: &[f32]) {
        for (owner, effect) in self.stateful_laws() {
            if owner == law {
                effect.restore_state(memory);
            }
        }
    }

    fn stateful_laws(&mut self) -> impl Iterator<Item = (usize, &mut dyn StatefulLaw)> {
        let motors = self.motors.iter_mut().map(|motor| {
            let effect: &mut dyn StatefulLaw = &mut *motor.effect;
            (motor.law, effect)
        });
        let resistances = self.resistances.iter_mut().map(|resistance| {
            let effect: &mut dyn StatefulLaw = &mut *resistance.effect;
            (resistance.law, effect)
        });
        motors.chain(resistances)
    }
}
