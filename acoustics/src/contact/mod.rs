//! Contact sounds: impacts, sliding, rolling, creaking hinges, footsteps.
//!
//! Every sound here is a force on two bodies. The force comes from the kind of contact (`impact_force`, `friction_noise`,
//! `creak`, `footstep`); the response of each body from its modes (`modes`, `elastic_properties`) and its radiation
//! (`radiation`). Values of substances stand in `assets/ringing.toml`, with sources.
//!
//! It is a model of plain bars, panels and walls, not of a violin: a body is replaced by the simplest one of its size, mass
//! and substance.

mod creak;
mod elastic_properties;
mod footstep;
mod friction_noise;
mod impact;
mod impact_force;
mod mode_bank;
pub mod modes;
mod radiation;

pub use creak::CreakSound;
pub use elastic_properties::{ElasticProperties, elastic};
pub use footstep::FootstepSound;
pub use friction_noise::{FrictionSound, FrictionSoundKind};
pub use impact::ImpactSound;

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A moving body, for its sound.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactBody {
    /// kg; above 0.
    pub mass_kg: f32,
    /// The edges of a box around it, m, in any order.
    pub size_m: [f32; 3],
}

/// One of two bodies in contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactPartner {
    /// Its substance at the contact: a name of the materials' library; unknown ones count as its default.
    pub substance: String,
    /// Its kind.
    pub kind: PartnerKind,
}

/// The kind of a body in contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum PartnerKind {
    /// A body with modes.
    Body(ContactBody),
    /// A wall, floor or ceiling, infinite for the impact: surface density of the struck leaf, kg/m².
    Panel(f32),
}

impl ContactPartner {
    /// A moving body.
    pub fn body(substance: &str, mass_kg: f32, size_m: [f32; 3]) -> Self {
        Self {
            substance: substance.to_owned(),
            kind: PartnerKind::Body(ContactBody { mass_kg, size_m }),
        }
    }

    /// A wall, floor or ceiling.
    pub fn panel(substance: &str, surface_density_kg_m2: f32) -> Self {
        Self {
            substance: substance.to_owned(),
            kind: PartnerKind::Panel(surface_density_kg_m2),
        }
    }

    /// Returns its mass, kg; `None` for a leaf.
    fn mass_kg(&self) -> Option<f64> {
        match self.kind {
            PartnerKind::Body(body) => Some(f64::from(body.mass_kg).max(1e-4)),
            PartnerKind::Panel(_) => None,
        }
    }
}

/// A contact sound.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ContactSound {
    /// An impact.
    Impact(ImpactSound),
    /// A segment of sliding or rolling.
    Friction(FrictionSound),
    /// A segment of a hinge's creaking.
    Creak(CreakSound),
    /// A footstep.
    Footstep(FootstepSound),
}

impl ContactSound {
    /// Returns its position, m.
    pub fn position(&self) -> Vec3 {
        match self {
            Self::Impact(sound) => sound.position,
            Self::Friction(sound) => sound.position,
            Self::Creak(sound) => sound.position,
            Self::Footstep(sound) => sound.position,
        }
    }

    /// Returns its duration with ringing, s; at most 6.
    pub fn duration_s(&self) -> f64 {
        match self {
            Self::Impact(sound) => sound.duration_s(),
            Self::Friction(sound) => sound.duration_s(),
            Self::Creak(sound) => sound.duration_s(),
            Self::Footstep(sound) => sound.duration_s(),
        }
    }

    /// Returns the whole sound: pressure at 1 m in the free field, Pa. Shape (`duration_s` * `rate_hz`, rounded up,).
    ///
    /// # Determinism
    /// The samples depend on the sound and the rate alone.
    pub fn render(&self, rate_hz: u32) -> Vec<f32> {
        match self {
            Self::Impact(sound) => sound.render(rate_hz),
            Self::Friction(sound) => sound.render(rate_hz),
            Self::Creak(sound) => sound.render(rate_hz),
            Self::Footstep(sound) => sound.render(rate_hz),
        }
    }
}

/// Returns the number of samples of a sound of a duration.
fn samples(duration_s: f64, rate_hz: u32) -> usize {
    (duration_s * f64::from(rate_hz)).ceil() as usize
}
