//! Contact models whose parameters are fitted to tosses.

use crate::bundle::file::BoardManifest;
use crate::rollout::RigSettings;
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
    /// True if the search takes equal ratios for equal steps.
    #[serde(rename = "by_ratio")]
    pub is_logarithmic: bool,
}

/// A way to compute contacts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContactModel {
    /// A short name.
    pub name: &'static str,
    /// A description in a sentence.
    pub about: &'static str,
    /// The friction solver where faces touch.
    #[serde(skip)]
    pub contact_friction: ContactFriction,
    /// The fitted parameters; none: the nominal values stand.
    pub parameters: Vec<ContactParameter>,
}

const FRICTION: ContactParameter = ContactParameter {
    name: "friction",
    unit: "1",
    range: [0.1, 0.4],
    is_logarithmic: true,
};

const fn contact_parameter(
    name: &'static str,
    unit: &'static str,
    range: [f64; 2],
    by_ratio: bool,
) -> ContactParameter {
    ContactParameter {
        name,
        unit,
        range,
        is_logarithmic: by_ratio,
    }
}

const RESTITUTION: ContactParameter = contact_parameter("restitution", "1", [0.0, 0.5], false);
const FREQUENCY: ContactParameter =
    contact_parameter("natural_frequency_hz", "Hz", [8.0, 120.0], true);
const DAMPING: ContactParameter = contact_parameter("damping_ratio", "1", [0.2, 3.0], true);
/// Negative slopes, restitution that grows with speed, exist in no material; they are searched so that a fit may say so.
const SLOPE: ContactParameter =
    contact_parameter("restitution_slope_s_m", "s/m", [-0.2, 0.4], false);
const TORSION: ContactParameter = contact_parameter("torsion_radius_m", "m", [0.0, 0.03], false);

/// The models of a study: as the engine comes; the engine's own two numbers fitted; friction by point with compliance.
pub fn standard_models() -> Vec<ContactModel> {
    vec![
        ContactModel {
            name: "nominal",
            about: "friction by patch, hard contacts, the bundle's own friction and restitution",
            contact_friction: ContactFriction::Patch,
            parameters: Vec::new(),
        },
        ContactModel {
            name: "basic",
            about: "friction by patch, hard contacts, no laws; friction and restitution fitted",
            contact_friction: ContactFriction::Patch,
            parameters: vec![FRICTION, RESTITUTION],
        },
        ContactModel {
            name: "extended",
            about: "friction by point, and the law contact_compliance; friction, natural frequency and damping ratio fitted",
            contact_friction: ContactFriction::Point,
            parameters: vec![FRICTION, FREQUENCY, DAMPING],
        },
    ]
}

/// Further models that were tried beside [`standard_models`].
pub fn further_models() -> Vec<ContactModel> {
    vec![
        ContactModel {
            name: "point",
            about: "friction by point, hard contacts, no laws; friction and restitution fitted",
            contact_friction: ContactFriction::Point,
            parameters: vec![FRICTION, RESTITUTION],
        },
        ContactModel {
            name: "by_speed",
            about: "friction by point, hard contacts, and the law velocity_restitution; friction, restitution at 1 m/s and its slope fitted",
            contact_friction: ContactFriction::Point,
            parameters: vec![FRICTION, RESTITUTION, SLOPE],
        },
        ContactModel {
            name: "torsion",
            about: "as extended, and the law torsional_friction; its radius fitted too",
            contact_friction: ContactFriction::Point,
            parameters: vec![FRICTION, FREQUENCY, DAMPING, TORSION],
        },
    ]
}

impl ContactParameter {
    /// The value at a place in 0..1 of its range.
    pub(super) fn value_at(&self, place: f64) -> f64 {
        let [low, high] = self.range;
        if self.is_logarithmic {
            low * libm::pow(high / low, place)
        } else {
            low + place * (high - low)
        }
    }

    /// The place in 0..1 of a value, the inverse of [`ContactParameter::value_at`]. Values outside the range are clamped.
    pub(super) fn position_of(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        let place = if self.is_logarithmic {
            libm::log(value.max(low) / low) / libm::log(high / low)
        } else {
            (value - low) / (high - low)
        };
        place.clamp(0.0, 1.0)
    }
}

impl ContactModel {
    /// Returns the settings of a rig for these values, one for each parameter.
    pub fn settings(&self, values: &[f64], nominal: &BoardManifest) -> RigSettings {
        let value = |name: &str| {
            let mut pairs = self.parameters.iter().zip(values);
            pairs.find(|(p, _)| p.name == name).map(|(_, v)| *v)
        };
        let law = |id: &str, params: &[(&str, f64)]| LawSpec::new(id, 1, params);
        let mut laws = Vec::new();
        if let Some(frequency) = value("natural_frequency_hz") {
            let damping = value("damping_ratio").unwrap_or(1.0);
            let params = [
                ("natural_frequency_hz", frequency),
                ("damping_ratio", damping),
            ];
            laws.push(law("contact_compliance", &params));
        }
        if let Some(slope) = value("restitution_slope_s_m") {
            let params = [("slope_s_m", slope), ("reference_m_s", 1.0)];
            laws.push(law("velocity_restitution", &params));
        }
        if let Some(radius) = value("torsion_radius_m") {
            laws.push(law("torsional_friction", &[("radius_m", radius)]));
        }
        RigSettings {
            friction: value("friction").unwrap_or(nominal.friction),
            restitution: value("restitution").unwrap_or(nominal.restitution),
            laws,
        }
    }
}
