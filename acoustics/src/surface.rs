//! Acoustic surface properties from materials.

use crate::bands::{self, BAND_COUNT, BandValues};
use crate::config::AcousticConfig;
use crate::reflection::ReflectionCoefficients;
use dwell_scene::{House, Material, MaterialId, State};

/// The acoustic properties of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AcousticSurface {
    /// Random-incidence absorption of energy.
    pub(crate) absorption: BandValues,
    pub(crate) reflection: ReflectionCoefficients,
    /// Scattered fraction of the reflected energy.
    pub(crate) scattering: BandValues,
    /// Transmitted energy, 0 to 1.
    pub(crate) transmitted: BandValues,
}

/// The scattered and the mirrored energy of a reflection. Shapes (band,).
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReflectedEnergy {
    pub(crate) scattered: BandValues,
    pub(crate) specular: BandValues,
}

impl AcousticSurface {
    pub(crate) const RIGID: Self = Self {
        absorption: [0.0; BAND_COUNT],
        reflection: ReflectionCoefficients::RIGID,
        scattering: [0.0; BAND_COUNT],
        transmitted: [0.0; BAND_COUNT],
    };

    pub(crate) fn new(
        house: &House,
        state: Option<&State>,
        id: MaterialId,
        config: &AcousticConfig,
    ) -> Self {
        let material = &house.materials[id];
        let (absorption, scattering, loss_db) = match state {
            Some(state) => (
                state.absorption(house, id),
                state.scattering(house, id),
                state.transmission_loss_db(house, id),
            ),
            None => (
                material.absorption.clone(),
                material.scattering.clone(),
                material.transmission_loss_db.clone(),
            ),
        };
        let scattering = bands::values_at_bands(&scattering).map(|s| s.clamp(0.0, 1.0));
        let loss_db = bands::values_at_bands(&loss_db);
        let absorption = bands::values_at_bands(&absorption).map(|a| a.clamp(0.0, 1.0));
        Self {
            absorption,
            reflection: if config.absorption_by_angle {
                ReflectionCoefficients::angle_dependent(&absorption)
            } else {
                ReflectionCoefficients::uniform(&absorption)
            },
            scattering,
            transmitted: loss_db.map(|db| {
                if db >= Material::MAX_TRANSMISSION_LOSS_DB {
                    0.0
                } else {
                    libm::powf(10.0, -db / 10.0)
                }
            }),
        }
    }

    /// Returns the reflected energy of a wave at a cosine of incidence, with `scattering` per band.
    ///
    /// Scattered energy does not depend on the angle of incidence, so that a path and its reverse have equal losses.
    pub(crate) fn reflected_energy(&self, cosine: f32, scattering: &BandValues) -> ReflectedEnergy {
        let kept = self.reflection.reflected_share(cosine);
        ReflectedEnergy {
            scattered: std::array::from_fn(|b| (1.0 - self.absorption[b]) * scattering[b]),
            specular: std::array::from_fn(|b| kept[b] * (1.0 - scattering[b])),
        }
    }
}
