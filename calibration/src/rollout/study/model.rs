//! Contact models whose parameters are fitted to tosses.

use crate::rollout::{Nominal, Settings};
use dwell_physics::ContactFriction;
use dwell_scene::LawSpec;
use serde::Serialize;

/// A parameter of a contact model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContactParameter {
    /// Its name.
    pub name: &'static str,
    /// SI unit, `"1"` for none.
    pub unit: &'static str,
    /// The range that is searched.
    pub range: [f64; 2],
    /// Whether the search takes equal ratios for equal steps.
    pub by_ratio: bool,
}

/// A way to compute contacts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContactModel {
    /// A short name.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub about: &'static str,
    /// How friction is solved where faces touch.
    #[serde(skip)]
    pub contact_friction: ContactFriction,
    /// What is fitted; none: the nominal values stand.
    pub parameters: Vec<ContactParameter>,
}

const FRICTION: ContactParameter = ContactParameter {
    name: "friction",
    unit: "1",
    range: [0.05, 0.5],
    by_ratio: true,
};

/// The models of a study: as the engine comes, friction by point with compliance, and the engine's own two numbers fitted.
pub fn all() -> Vec<ContactModel> {
    let number = |name, unit, range, by_ratio| ContactParameter {
        name,
        unit,
        range,
        by_ratio,
    };
    vec![
        ContactModel {
            name: "nominal",
            about: "friction by patch, hard contacts, the bundle's own friction and restitution",
            contact_friction: ContactFriction::Patch,
            parameters: Vec::new(),
        },
        ContactModel {
            name: "extended",
            about: "friction by point, and the law contact_compliance; friction, natural frequency and damping ratio fitted",
            contact_friction: ContactFriction::Point,
            parameters: vec![
                FRICTION,
                number("natural_frequency_hz", "Hz", [8.0, 60.0], true),
                number("damping_ratio", "1", [0.2, 3.0], true),
            ],
        },
        ContactModel {
            name: "basic",
            about: "friction by patch, hard contacts; friction and restitution fitted",
            contact_friction: ContactFriction::Patch,
            parameters: vec![FRICTION, number("restitution", "1", [0.0, 0.5], false)],
        },
    ]
}

impl ContactParameter {
    /// The value at a place in 0..1 of its range.
    pub(super) fn at(&self, place: f64) -> f64 {
        let [low, high] = self.range;
        if self.by_ratio {
            low * libm::pow(high / low, place)
        } else {
            low + place * (high - low)
        }
    }
}

impl ContactModel {
    /// What a rig is set to for these values, one for each parameter.
    pub fn settings(&self, values: &[f64], nominal: Nominal) -> Settings {
        let value = |name: &str| {
            let mut pairs = self.parameters.iter().zip(values);
            pairs.find(|(p, _)| p.name == name).map(|(_, v)| *v)
        };
        let frequency = value("natural_frequency_hz");
        let laws = frequency.map(|natural_frequency_hz| LawSpec {
            id: "contact_compliance".to_owned(),
            version: 1,
            target: None,
            params: [
                ("natural_frequency_hz".to_owned(), natural_frequency_hz),
                (
                    "damping_ratio".to_owned(),
                    value("damping_ratio").unwrap_or(1.0),
                ),
            ]
            .into_iter()
            .collect(),
        });
        Settings {
            friction: value("friction").unwrap_or(nominal.friction),
            restitution: value("restitution").unwrap_or(nominal.restitution),
            laws: laws.into_iter().collect(),
        }
    }
}
