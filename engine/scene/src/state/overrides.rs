//! Values in force: the house's, or their overrides.

use super::canonical::pair_address;
use super::{Address, AgentBody, State};
use crate::house::House;
use crate::ids::{MaterialId, PartId};
use crate::material::{Bands, PairContact, library};
use crate::units::STANDARD_GRAVITY_M_S2;

impl State {
    pub(super) fn override_or(&self, address: &Address, base: f32) -> f32 {
        self.overrides
            .get(address)
            .map_or(base, |value| *value as f32)
    }

    pub(super) fn override_value(&self, text: String) -> Option<f32> {
        if self.overrides.is_empty() {
            None
        } else {
            self.overrides
                .get(&Address(text))
                .map(|value| *value as f32)
        }
    }

    /// Returns friction and restitution between two substances, with overrides.
    pub fn pair_contact(&self, a: &str, b: &str) -> PairContact {
        let base = library().pair_contact(a, b);
        let field = |name: &str| self.override_value(pair_address(a, b, name));
        PairContact {
            friction: field("friction").unwrap_or(base.friction),
            restitution: field("restitution").unwrap_or(base.restitution),
        }
    }

    /// Returns the substance of most of a part: that of its first material.
    pub fn part_substance<'a>(&self, house: &'a House, part: PartId) -> &'a str {
        house.parts[part]
            .materials
            .first()
            .map_or("", |material| house.materials[*material].substance.as_str())
    }

    /// Returns the acceleration of gravity, m/s².
    pub fn gravity_m_s2(&self) -> f32 {
        self.override_value("world/gravity_m_s2".to_owned())
            .unwrap_or(STANDARD_GRAVITY_M_S2)
    }

    /// Returns the strongest pull on a joint without a motor by commands that come from no agent, N·m or N.
    pub fn default_hand_effort(&self) -> f32 {
        self.override_value("world/hand_effort".to_owned())
            .unwrap_or(AgentBody::HAND_EFFORT)
    }

    /// Returns the absorption of a material, with overrides.
    pub fn absorption(&self, house: &House, material: MaterialId) -> Bands {
        let material = &house.materials[material];
        self.bands_with_overrides(&material.name, "absorption", &material.absorption)
    }

    /// Returns the scattering of a material, with overrides.
    pub fn scattering(&self, house: &House, material: MaterialId) -> Bands {
        let material = &house.materials[material];
        self.bands_with_overrides(&material.name, "scattering", &material.scattering)
    }

    /// Returns the transmission loss of a material, dB, with overrides.
    pub fn transmission_loss_db(&self, house: &House, material: MaterialId) -> Bands {
        let material = &house.materials[material];
        let base = &material.transmission_loss_db;
        self.bands_with_overrides(&material.name, "transmission_loss_db", base)
    }

    /// Returns the bands of one material field, with bands replaced or added by overrides.
    fn bands_with_overrides(&self, material: &str, field: &str, base: &Bands) -> Bands {
        let prefix = format!("material/{material}/{field}/");
        let mut bands = base.clone();
        // A slash sorts before '0', so that this range holds exactly the addresses that begin with the prefix.
        for (address, value) in self.overrides.range(Address(prefix.clone())..) {
            let Some(hz) = address.0.strip_prefix(&prefix) else {
                break;
            };
            let Ok(frequency) = hz.parse::<f32>() else {
                continue;
            };
            let place = bands
                .centres_hz
                .partition_point(|centre| *centre < frequency);
            if bands.centres_hz.get(place) == Some(&frequency) {
                bands.values[place] = *value as f32;
            } else {
                bands.centres_hz.insert(place, frequency);
                bands.values.insert(place, *value as f32);
            }
        }
        bands
    }
}
