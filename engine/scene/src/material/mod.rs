//! Materials: the optical, acoustic and mechanical properties of surfaces and bodies.

mod bands;
mod library;

pub use bands::Bands;
pub use library::{MaterialLibrary, PairContact, Substance, library};

use crate::error::SceneError;
use crate::ids::TextureId;
use serde::{Deserialize, Serialize};

/// A material with the properties that all engines need.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// The name, unique in its house; used in addresses `material/<name>/...`.
    pub name: String,
    /// The substance, by its name in [`library`].
    pub substance: String,
    /// Colour in linear light, each 0 to 1; multiplies the texture.
    pub base_color: [f32; 3],
    /// The image on the surface.
    pub texture: Option<TextureId>,
    /// Emitted light, linear, each at least 0.
    pub emission: [f32; 3],
    /// The fraction of light that does not pass straight through, 0 to 1.
    pub opacity: f32,
    /// 0 (dielectric) to 1 (metal), as in glTF 2.0.
    pub metallic: f32,
    /// Perceptual roughness, 0 to 1, as in glTF 2.0.
    pub roughness: f32,
    /// Density of the substance in the house, kg/m³.
    pub density_kg_m3: f32,
    /// Coefficient of kinetic friction on itself; the pair's value comes from [`MaterialLibrary::pair_contact`].
    pub friction: f32,
    /// Coefficient of restitution on itself.
    pub restitution: f32,
    /// Random-incidence absorption of sound **energy**, 0 to 1.
    pub absorption: Bands,
    /// Random-incidence scattering of sound energy, 0 to 1.
    pub scattering: Bands,
    /// Sound reduction index R, dB: the transmitted energy is 10^(-R/10). `f32::INFINITY` cannot pass JSON: 200 dB is the
    /// ceiling and counts as opaque.
    pub transmission_loss_db: Bands,
}

impl Material {
    /// The loss at and above which nothing is transmitted, dB.
    pub const MAX_TRANSMISSION_LOSS_DB: f32 = 200.0;

    /// A material of a substance, with its properties and default colour.
    pub fn from_substance(name: impl Into<String>, substance: &Substance) -> Self {
        Self {
            name: name.into(),
            substance: substance.name.clone(),
            base_color: substance
                .default_color
                .map(|c| crate::units::linear_from_srgb(f32::from(c) / 255.0)),
            texture: None,
            emission: [0.0; 3],
            opacity: substance.opacity,
            metallic: substance.metallic,
            roughness: substance.roughness,
            density_kg_m3: substance.density_kg_m3,
            friction: substance.friction,
            restitution: substance.restitution,
            absorption: substance.absorption.clone(),
            scattering: substance.scattering.clone(),
            transmission_loss_db: substance.transmission_loss_db.clone(),
        }
    }

    /// The same material with an sRGB-encoded colour, each 0 to 255.
    #[must_use]
    pub fn with_srgb(mut self, color: [u8; 3]) -> Self {
        self.base_color = color.map(|c| crate::units::linear_from_srgb(f32::from(c) / 255.0));
        self
    }

    /// The same material with a texture; its colour becomes white, so that the image shows as it is.
    #[must_use]
    pub fn with_texture(mut self, texture: TextureId) -> Self {
        self.texture = Some(texture);
        self.base_color = [1.0; 3];
        self
    }

    /// Checks every range.
    ///
    /// # Errors
    /// [`SceneError::Range`] or [`SceneError::Bands`] names the field, the value found and the allowed ones.
    pub fn check(&self, at: &str) -> Result<(), SceneError> {
        let range =
            |field: &'static str, value: f32, low: f32, high: f32, allowed: &'static str| {
                if (low..=high).contains(&value) {
                    Ok(())
                } else {
                    Err(SceneError::Range {
                        at: at.to_owned(),
                        field,
                        found: value.to_string(),
                        allowed,
                    })
                }
            };
        for value in self.base_color {
            range("base_color", value, 0.0, 1.0, "0 to 1")?;
        }
        for value in self.emission {
            range("emission", value, 0.0, 1e6, "0 to 1e6")?;
        }
        range("opacity", self.opacity, 0.0, 1.0, "0 to 1")?;
        range("metallic", self.metallic, 0.0, 1.0, "0 to 1")?;
        range("roughness", self.roughness, 0.0, 1.0, "0 to 1")?;
        range(
            "density_kg_m3",
            self.density_kg_m3,
            0.01,
            30_000.0,
            "0.01 to 30000",
        )?;
        range("friction", self.friction, 0.0, 10.0, "0 to 10")?;
        range("restitution", self.restitution, 0.0, 1.0, "0 to 1")?;
        self.absorption
            .check(&format!("{at}.absorption"), 0.0, 1.0)?;
        self.scattering
            .check(&format!("{at}.scattering"), 0.0, 1.0)?;
        self.transmission_loss_db.check(
            &format!("{at}.transmission_loss_db"),
            0.0,
            Self::MAX_TRANSMISSION_LOSS_DB,
        )
    }
}
