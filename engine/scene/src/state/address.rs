//! Parameters have addresses: `object/12/mass_kg`, `material/carpet/absorption/1000`, `pair/oak~steel/friction`.
//!
//! An override in [`State::overrides`](super::State) goes before the house's value, per world, without rebuilding the
//! house. Engines read through [`State::object_mass_kg`](super::State::object_mass_kg) and kin.

use super::canonical::pair_address;
use super::joint::FIELDS;
use super::names::{find_joint, find_material, find_object, find_part};
use super::{Locomotion, State};
use crate::error::SceneError;
use crate::house::House;
use crate::ids::{AgentId, Id, JointId, MaterialId, PartId};
use crate::material::{Bands, Material, PairContact, library};
use crate::units::STANDARD_GRAVITY_M_S2;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// The address of a parameter: two to five words or numbers with slashes between them.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Address(String);

impl Address {
    /// The words, at least two.
    pub fn words(&self) -> Vec<&str> {
        self.0.split('/').collect()
    }

    /// The text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The address of a joint's field.
    pub(super) fn of_joint(joint: JointId, field: &str) -> Self {
        Self(format!("joint/{}/{field}", joint.0))
    }

    /// Refuses a value out of bounds.
    pub(super) fn check_range(
        &self,
        value: f64,
        low: f64,
        high: f64,
        unit: &str,
    ) -> Result<(), SceneError> {
        if (low..=high).contains(&value) {
            return Ok(());
        }
        Err(self.fault(format!(
            "{value} is out of range; allowed are {low} to {high} {unit}"
        )))
    }

    /// The address of a part's field.
    pub(super) fn of_part(part: PartId, field: &str) -> Self {
        Self(format!("part/{}/{field}", part.0))
    }

    pub(super) fn fault(&self, what: impl Into<String>) -> SceneError {
        SceneError::Address {
            address: self.0.clone(),
            what: what.into(),
        }
    }
}

impl FromStr for Address {
    type Err = SceneError;
    fn from_str(text: &str) -> Result<Self, SceneError> {
        let fault = |what: &str| {
            Err(SceneError::Address {
                address: text.to_owned(),
                what: what.to_owned(),
            })
        };
        let words: Vec<&str> = text.split('/').collect();
        if !(2..=5).contains(&words.len()) {
            return fault(
                "an address has two to five words with slashes between them, as in object/12/mass_kg",
            );
        }
        if words
            .iter()
            .any(|word| word.is_empty() || word.len() > 128 || word.chars().any(char::is_control))
        {
            return fault("each word has 1 to 128 printable characters");
        }
        Ok(Self(text.to_owned()))
    }
}

impl TryFrom<String> for Address {
    type Error = SceneError;
    fn try_from(text: String) -> Result<Self, SceneError> {
        text.parse()
    }
}

impl From<Address> for String {
    fn from(address: Address) -> Self {
        address.0
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// What stands at an address.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// The value in force: the override, else the house's.
    pub value: f64,
    /// SI unit, `"1"` for none.
    pub unit: &'static str,
    /// The lowest value that is allowed.
    pub low: f64,
    /// The highest value that is allowed.
    pub high: f64,
}

impl State {
    fn find_agent(&self, address: &Address, word: &str) -> Result<AgentId, SceneError> {
        let index = word
            .parse::<usize>()
            .ok()
            .filter(|index| *index < self.agents.len());
        index.map(AgentId::from_index).ok_or_else(|| {
            address.fault(format!(
                "no agent {word:?}; there are {}, counted from 0",
                self.agents.len()
            ))
        })
    }

    /// How an agent gets about in this world: its body's numbers with overrides.
    ///
    /// # Panics
    /// For an agent that does not exist.
    pub fn locomotion(&self, agent: AgentId) -> Locomotion {
        let nominal = self.agents[agent].body.locomotion;
        if self.overrides.is_empty() {
            return nominal;
        }
        nominal.with(|field| self.lookup(format!("agent/{}/base/{field}", agent.index())))
    }

    /// The horizontal field of view of a camera that states none, degrees.
    pub const CAMERA_FOV_DEG: f32 = 90.0;

    /// The overridden horizontal field of view of the cameras at an agent's eyes, degrees; `None`: each has its own, which is
    /// [`State::CAMERA_FOV_DEG`] unless its settings say otherwise.
    pub fn camera_fov_deg(&self, agent: AgentId) -> Option<f32> {
        self.lookup(format!("agent/{}/camera/fov_deg", agent.index()))
    }

    /// What stands at `address`.
    ///
    /// # Errors
    /// [`SceneError::Address`] says which word is wrong and what is allowed there.
    pub fn parameter(&self, house: &House, address: &Address) -> Result<Parameter, SceneError> {
        let make = |value: f32, unit, low, high| {
            Ok(Parameter {
                value: f64::from(value),
                unit,
                low,
                high,
            })
        };
        let known = self.canonical(house, address)?;
        match known.words()[..] {
            ["object", object, "mass_kg"] => {
                let object = find_object(house, address, object)?;
                let of_parts = || self.mass_of_parts_kg(house, object);
                make(self.object_mass_kg(house, object).unwrap_or_else(of_parts), "kg", 1e-6, 1e6)
            }
            ["material", material, field] => {
                let material = &house.materials[find_material(house, address, material)?];
                match field {
                    "friction" => make(self.scalar(&known, material.friction), "1", 0.0, 10.0),
                    "restitution" => make(self.scalar(&known, material.restitution), "1", 0.0, 1.0),
                    "density_kg_m3" => make(self.scalar(&known, material.density_kg_m3), "kg/m3", 0.01, 30_000.0),
                    _ => Err(address.fault(format!(
                        "no field {field:?}; a material has friction, restitution, density_kg_m3, absorption/HZ, scattering/HZ, transmission_loss_db/HZ"
                    ))),
                }
            }
            ["material", material, field, hz] => {
                let id = find_material(house, address, material)?;
                let frequency: f32 = hz.parse().ok().filter(|f| (1.0..=1e5).contains(f)).ok_or_else(|| {
                    address.fault(format!("{hz:?} is no frequency; allowed are 1 to 100000 Hz"))
                })?;
                match field {
                    "absorption" => make(self.absorption(house, id).at(frequency), "1", 0.0, 1.0),
                    "scattering" => make(self.scattering(house, id).at(frequency), "1", 0.0, 1.0),
                    "transmission_loss_db" => {
                        let loss = self.transmission_loss_db(house, id).at(frequency);
                        make(loss, "dB", 0.0, f64::from(Material::OPAQUE_TO_SOUND_DB))
                    }
                    _ => Err(address.fault(format!(
                        "no field {field:?} by frequency; there are absorption, scattering and transmission_loss_db"
                    ))),
                }
            }
            ["pair", pair, field] => {
                let (a, b) = pair.split_once('~').ok_or_else(|| address.fault("a pair is written a~b"))?;
                if let Some(name) = [a, b].into_iter().find(|name| library().get(name).is_none()) {
                    return Err(address.fault(format!("no substance {name:?} in the library")));
                }
                let contact = self.pair_contact(a, b);
                match field {
                    "friction" => make(contact.friction, "1", 0.0, 10.0),
                    "restitution" => make(contact.restitution, "1", 0.0, 1.0),
                    _ => Err(address.fault(format!("no field {field:?}; a pair has friction and restitution"))),
                }
            }
            ["joint", joint, field] => {
                let id = find_joint(house, address, joint)?;
                let joint = &house.joints[id];
                let here: Vec<_> = FIELDS.iter().filter(|field| (field.get)(joint).is_some()).collect();
                let found = here.iter().find(|here| here.name == field);
                let found = found.ok_or_else(|| {
                    let names: Vec<_> = here.iter().map(|field| field.name).collect();
                    address.fault(format!("no field {field:?}; this joint has {names:?}"))
                })?;
                let base = (found.get)(joint).unwrap_or(0.0);
                let [low, high] = self.joint_range(house, id, found);
                make(self.scalar(&known, base), found.unit, low, high)
            }
            ["part", part, "mass_kg"] => {
                let part = &house.parts[find_part(house, address, part)?];
                let base = part.mass_kg.ok_or_else(|| {
                    address.fault("the part has no mass of its own: it follows from its material's density")
                })?;
                make(self.scalar(&known, base), "kg", 1e-6, 1e6)
            }
            ["part", part, field] => {
                let part = find_part(house, address, part)?;
                self.inertial_parameter(house, address, part, field)
            }
            ["agent", agent, "base", field] => {
                let id = self.find_agent(address, agent)?;
                let parameters = self.locomotion(id).parameters();
                let found = parameters.iter().find(|(name, _)| *name == field);
                found.map(|(_, parameter)| *parameter).ok_or_else(|| {
                    let names: Vec<_> = parameters.iter().map(|(name, _)| *name).collect();
                    let kind = self.agents[id].body.locomotion.name();
                    address.fault(format!("no field {field:?}; agent {agent} ({kind}) has {names:?}"))
                })
            }
            ["agent", agent, "camera", "fov_deg"] => {
                let agent = self.find_agent(address, agent)?;
                let value = self.camera_fov_deg(agent).unwrap_or(Self::CAMERA_FOV_DEG);
                make(value, "deg", 1.0, 170.0)
            }
            ["world", "gravity_m_s2"] => make(self.gravity_m_s2(), "m/s2", 0.0, 100.0),
            ["law", ..] => Err(address.fault(
                "parameters of laws are read and set through the world, which knows the laws of all engines",
            )),
            _ => Err(address.fault(
                "known are law/ID/PARAM, object/ID/mass_kg, part/N/FIELD, material/NAME/FIELD[/HZ], pair/A~B/FIELD, joint/N/FIELD, agent/N/base/FIELD, agent/N/camera/fov_deg, world/gravity_m_s2",
            )),
        }
    }

    /// Overrides the parameter at `address`.
    ///
    /// # Errors
    /// [`SceneError::Address`] for an address that names nothing or a value outside its range.
    pub fn set_parameter(
        &mut self,
        house: &House,
        address: &Address,
        value: f64,
    ) -> Result<(), SceneError> {
        let parameter = self.parameter(house, address)?;
        address.check_range(value, parameter.low, parameter.high, parameter.unit)?;
        self.overrides
            .insert(self.canonical(house, address)?, value);
        Ok(())
    }

    fn scalar(&self, address: &Address, base: f32) -> f32 {
        self.overrides
            .get(address)
            .map_or(base, |value| *value as f32)
    }

    pub(super) fn lookup(&self, text: String) -> Option<f32> {
        if self.overrides.is_empty() {
            None
        } else {
            self.overrides
                .get(&Address(text))
                .map(|value| *value as f32)
        }
    }

    /// Friction and restitution between two substances, with overrides.
    pub fn pair_contact(&self, a: &str, b: &str) -> PairContact {
        let base = library().pair(a, b);
        let field = |name: &str| self.lookup(pair_address(a, b, name));
        PairContact {
            friction: field("friction").unwrap_or(base.friction),
            restitution: field("restitution").unwrap_or(base.restitution),
        }
    }

    /// The substance a part is mostly made of: that of its first material.
    pub fn part_substance<'a>(&self, house: &'a House, part: PartId) -> &'a str {
        house.parts[part]
            .materials
            .first()
            .map_or("", |material| house.materials[*material].substance.as_str())
    }

    /// Acceleration of free fall, m/s².
    pub fn gravity_m_s2(&self) -> f32 {
        self.lookup("world/gravity_m_s2".to_owned())
            .unwrap_or(STANDARD_GRAVITY_M_S2)
    }

    /// Absorption of a material with overrides.
    pub fn absorption(&self, house: &House, material: MaterialId) -> Bands {
        let material = &house.materials[material];
        self.bands(&material.name, "absorption", &material.absorption)
    }

    /// Scattering of a material with overrides.
    pub fn scattering(&self, house: &House, material: MaterialId) -> Bands {
        let material = &house.materials[material];
        self.bands(&material.name, "scattering", &material.scattering)
    }

    /// Loss of sound that passes through a material, dB, with overrides.
    pub fn transmission_loss_db(&self, house: &House, material: MaterialId) -> Bands {
        let material = &house.materials[material];
        let base = &material.transmission_loss_db;
        self.bands(&material.name, "transmission_loss_db", base)
    }

    /// The bands of one material field, each band replaced or a band added where an override stands.
    fn bands(&self, material: &str, field: &str, base: &Bands) -> Bands {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ShoeboxMaterials;

    #[test]
    fn overrides_replace_one_band_and_leave_the_house_alone() {
        let house = House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap();
        let mut state = State::new(&house);
        let address: Address = "material/floor/absorption/1000".parse().unwrap();
        let before = state.parameter(&house, &address).unwrap();
        state.set_parameter(&house, &address, 0.77).unwrap();
        assert!((state.parameter(&house, &address).unwrap().value - 0.77).abs() < 1e-6);
        assert_ne!(before.value, 0.77);
        let other: Address = "material/floor/absorption/500".parse().unwrap();
        assert_eq!(
            state.parameter(&house, &other).unwrap(),
            State::new(&house).parameter(&house, &other).unwrap()
        );
    }

    #[test]
    fn a_base_is_measured_anew_in_one_world_and_its_body_stays_nominal() {
        use crate::{AgentBody, AgentState, DifferentialDrive};
        let house = House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap();
        let mut state = State::new(&house);
        let body = AgentBody {
            locomotion: Locomotion::DifferentialDrive(DifferentialDrive::default()),
            ..AgentBody::default()
        };
        for _ in 0..2 {
            state
                .agents
                .push(AgentState::new(body, glam::Vec3::ZERO, 0.0));
        }
        let address: Address = "agent/1/base/wheel_base_m".parse().unwrap();
        state.set_parameter(&house, &address, 0.31).unwrap();
        assert_eq!(
            state.parameter(&house, &address).unwrap().value as f32,
            0.31
        );
        let base = |agent| match state.locomotion(AgentId(agent)) {
            Locomotion::DifferentialDrive(base) => base,
            other => panic!("{other:?}"),
        };
        assert_eq!((base(0).wheel_base_m, base(1).wheel_base_m), (0.3, 0.31));
        assert_eq!(state.agents[AgentId(1)].body, body);
        for (text, part) in [
            ("agent/2/base/wheel_base_m", "there are 2"),
            ("agent/0/base/max_speed_m_s", "left_wheel_radius_m"),
        ] {
            let address: Address = text.parse().unwrap();
            let message = state.parameter(&house, &address).unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        }
        assert!(state.set_parameter(&house, &address, 0.0).is_err());
    }

    #[test]
    fn wrong_addresses_say_what_is_allowed() {
        let house = House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap();
        let mut state = State::new(&house);
        for text in [
            "mass",
            "object/99/mass_kg",
            "material/oka/friction",
            "pair/oak/friction",
            "world/gravity",
            "a//b",
        ] {
            let message = match text.parse::<Address>() {
                Ok(address) => state.parameter(&house, &address).unwrap_err().to_string(),
                Err(error) => error.to_string(),
            };
            assert!(message.contains(text), "{message}");
        }
        let gravity: Address = "world/gravity_m_s2".parse().unwrap();
        assert!(state.set_parameter(&house, &gravity, f64::NAN).is_err());
        assert!(state.set_parameter(&house, &gravity, 1.62).is_ok());
        assert!((state.gravity_m_s2() - 1.62).abs() < 1e-6);
    }
}
