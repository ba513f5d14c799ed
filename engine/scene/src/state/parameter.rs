//! The parameter at an address, and setting it.
//!
//! An override in [`State::overrides`](super::State) precedes the house's value, per world, without rebuilding the house.
//! Engines read through [`State::object_mass_kg`](super::State::object_mass_kg) and the like. An agent's body is not part
//! of the house: its numbers are set in the state.

use super::joint::FIELDS;
use super::names::{find_joint, find_material, find_object, find_part, no_substance};
use super::{Address, State};
use crate::error::SceneError;
use crate::house::House;
use crate::ids::{AgentId, IdVec};
use crate::material::{Material, library};
use serde::Serialize;
use std::collections::BTreeSet;

/// The parameter at an address.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// The value in force: the override, else the house's.
    pub value: f64,
    /// SI unit, `"1"` for none.
    pub unit: &'static str,
    /// The lowest value allowed.
    pub low: f64,
    /// The highest value allowed.
    pub high: f64,
}

impl Parameter {
    /// Returns whether a value is within the bounds at the precision of f32: bounds and values may come from f32s.
    pub(super) fn admits(&self, value: f64) -> bool {
        (self.low as f32..=self.high as f32).contains(&(value as f32))
    }
}

impl State {
    /// Returns the parameter at `address`.
    ///
    /// # Errors
    /// [`SceneError::Address`] names the wrong word and the allowed ones.
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
                make(self.overridden_mass_kg(house, object).unwrap_or_else(of_parts), "kg", 1e-6, 1e6)
            }
            ["material", material, field] => {
                let material = &house.materials[find_material(house, address, material)?];
                match field {
                    "friction" => make(self.override_or(&known, material.friction), "1", 0.0, 10.0),
                    "restitution" => make(self.override_or(&known, material.restitution), "1", 0.0, 1.0),
                    "density_kg_m3" => make(self.override_or(&known, material.density_kg_m3), "kg/m3", 0.01, 30_000.0),
                    _ => Err(address.invalid(format!(
                        "no field {field:?}; a material has friction, restitution, density_kg_m3, absorption/HZ, scattering/HZ, transmission_loss_db/HZ"
                    ))),
                }
            }
            ["material", material, field, hz] => {
                let id = find_material(house, address, material)?;
                let frequency: f32 = hz.parse().ok().filter(|f| (1.0..=1e5).contains(f)).ok_or_else(|| {
                    address.invalid(format!("{hz:?} is no frequency; allowed are 1 to 100000 Hz"))
                })?;
                match field {
                    "absorption" => make(self.absorption(house, id).at(frequency), "1", 0.0, 1.0),
                    "scattering" => make(self.scattering(house, id).at(frequency), "1", 0.0, 1.0),
                    "transmission_loss_db" => {
                        let loss = self.transmission_loss_db(house, id).at(frequency);
                        make(loss, "dB", 0.0, f64::from(Material::MAX_TRANSMISSION_LOSS_DB))
                    }
                    _ => Err(address.invalid(format!(
                        "no field {field:?} by frequency; there are absorption, scattering and transmission_loss_db"
                    ))),
                }
            }
            ["pair", pair, field] => {
                let (a, b) = pair.split_once('~').ok_or_else(|| address.invalid("a pair is written a~b"))?;
                if let Some(name) = [a, b].into_iter().find(|name| library().get(name).is_none()) {
                    return Err(address.invalid(no_substance(name)));
                }
                let contact = self.pair_contact(a, b);
                match field {
                    "friction" => make(contact.friction, "1", 0.0, 10.0),
                    "restitution" => make(contact.restitution, "1", 0.0, 1.0),
                    _ => Err(address.invalid(format!("no field {field:?}; a pair has friction and restitution"))),
                }
            }
            ["joint", joint, field] => {
                let id = find_joint(house, address, joint)?;
                let joint = &house.joints[id];
                let here: Vec<_> = FIELDS.iter().filter(|field| (field.get)(joint).is_some()).collect();
                let found = here.iter().find(|here| here.name == field);
                let found = found.ok_or_else(|| {
                    let names: Vec<_> = here.iter().map(|field| field.name).collect();
                    address.invalid(format!("no field {field:?}; this joint has {names:?}"))
                })?;
                let base = (found.get)(joint).unwrap_or(0.0);
                let [low, high] = self.joint_range(house, id, found);
                make(self.override_or(&known, base), found.unit, low, high)
            }
            ["part", part, "mass_kg"] => {
                let part = &house.parts[find_part(house, address, part)?];
                let base = part.mass_kg.ok_or_else(|| {
                    address.invalid("the part has no mass of its own: it follows from its material's density")
                })?;
                make(self.override_or(&known, base), "kg", 1e-6, 1e6)
            }
            ["part", part, field] => {
                let part = find_part(house, address, part)?;
                self.inertial_parameter(house, address, part, field)
            }
            ["agent", agent, ref words @ ..] => self.agent_parameter(address, agent, words),
            ["world", "gravity_m_s2"] => make(self.gravity_m_s2(), "m/s2", 0.0, 100.0),
            ["world", "hand_effort"] => make(self.default_hand_effort(), "N m or N", 0.0, 1e4),
            ["law", ..] => Err(address.invalid(
                "parameters of laws are read and set through the world, which knows the laws of all engines",
            )),
            _ => Err(address.invalid(
                "known are law/ID/PARAM, object/ID/mass_kg, part/N/FIELD, material/NAME/FIELD[/HZ], pair/A~B/FIELD, joint/N/FIELD, agent/N/body/FIELD, agent/N/base/FIELD, agent/N/camera/fov_deg, world/gravity_m_s2, world/hand_effort",
            )),
        }
    }

    /// Sets the parameter at `address`.
    ///
    /// # Errors
    /// [`SceneError::Address`] for an address that names nothing or a value outside its range.
    pub fn set_parameter(
        &mut self,
        house: &House,
        address: &Address,
        value: f64,
    ) -> Result<(), SceneError> {
        self.set_parameters(house, &[(address.clone(), value)])
    }

    /// Sets parameters together: all of them, or none. A value that equals the default is not stored. Ranges that depend on
    /// each other (a joint's two limits, a part's three moments, an agent's height and radius) are checked when all are
    /// set, so that their order does not matter.
    ///
    /// # Errors
    /// [`SceneError::Address`] for an address that names nothing or that is given twice, in whatever spelling, and for a
    /// value outside its range given the others. Nothing has changed then.
    pub fn set_parameters(
        &mut self,
        house: &House,
        values: &[(Address, f64)],
    ) -> Result<(), SceneError> {
        let before = (self.overrides.clone(), self.agents.clone());
        let set = self.try_set(house, values);
        if set.is_err() {
            (self.overrides, self.agents) = before;
            return set;
        }
        self.keep_crouched_heights(&before.1);
        Ok(())
    }

    fn try_set(&mut self, house: &House, values: &[(Address, f64)]) -> Result<(), SceneError> {
        let mut known = BTreeSet::new();
        for (address, value) in values {
            self.parameter(house, address)?;
            let canonical = self.canonical(house, address)?;
            if !known.insert(canonical.clone()) {
                return Err(
                    address.invalid("it is set twice at once, in one or two spellings; allowed is each parameter once")
                );
            }
            self.store_value(canonical, *value);
        }
        for (address, value) in values {
            let now = self.parameter(house, address)?;
            if !now.admits(*value) {
                address.check_range(*value, now.low, now.high, now.unit)?;
            }
        }
        for canonical in &known {
            self.check_axis(house, canonical)?;
        }
        self.remove_default_overrides(house, &known)
    }

    /// Removes overrides equal to the value without them, so that setting a value and setting it back leaves no trace. Only
    /// when all are set: that value may follow from the others. A band of a material is kept, since bands without a value
    /// of their own lie between their neighbours: one that is pinned stays when a neighbour changes.
    fn remove_default_overrides(
        &mut self,
        house: &House,
        known: &BTreeSet<Address>,
    ) -> Result<(), SceneError> {
        let follows = |known: &&Address| matches!(known.words()[..], ["material", _, _, _]);
        for canonical in known.iter().filter(|known| !follows(known)) {
            if let Some(value) = self.overrides.remove(canonical)
                && self.parameter(house, canonical)?.value as f32 != value as f32
            {
                self.overrides.insert(canonical.clone(), value);
            }
        }
        Ok(())
    }

    fn store_value(&mut self, canonical: Address, value: f64) {
        if let ["agent", agent, "body", field] = canonical.words()[..] {
            let agent = agent.parse().ok().map(AgentId);
            if let Some(agent) = agent.and_then(|agent| self.agents.get_mut(agent)) {
                agent.body.set(field, value as f32);
            }
            return;
        }
        self.overrides.insert(canonical, value);
    }

    /// Keeps the height of a crouching agent when its body changes, as far as its radius allows.
    fn keep_crouched_heights(&mut self, before: &IdVec<AgentId, super::AgentState>) {
        for (now, before) in self.agents.iter_mut().zip(before) {
            if now.crouched_by_m > 0.0 && now.body != before.body {
                let most = (now.body.height_m - 2.0 * now.body.radius_m).max(0.0);
                now.crouched_by_m = (now.body.height_m - before.height_m()).clamp(0.0, most);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Locomotion, ShoeboxMaterials};

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

    /// Regression: a body could not shrink or grow as a whole, because each number alone did not fit the others.
    #[test]
    fn numbers_that_bound_each_other_are_set_together_or_not_at_all() {
        use crate::{AgentBody, AgentState};
        let house = House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap();
        let mut state = State::new(&house);
        state
            .agents
            .push(AgentState::new(AgentBody::default(), glam::Vec3::ZERO, 0.0));
        let values = |pairs: &[(&str, f64)]| -> Vec<(Address, f64)> {
            let row = |(address, value): &(&str, f64)| (address.parse().unwrap(), *value);
            pairs.iter().map(row).collect()
        };
        let small = [
            ("agent/0/body/height_m", 0.3),
            ("agent/0/body/radius_m", 0.15),
            ("agent/0/body/eye_height_m", 0.3),
            ("world/gravity_m_s2", 1.62),
        ];
        let start = state.hash();
        assert!(state.set_parameters(&house, &values(&small[..1])).is_err());
        for order in [vec![0, 1, 2, 3], vec![3, 2, 1, 0], vec![1, 0, 3, 2]] {
            let mut state = state.clone();
            let rows: Vec<_> = order.iter().map(|k| small[*k]).collect();
            state.set_parameters(&house, &values(&rows)).unwrap();
            for (address, value) in values(&small) {
                let now = state.parameter(&house, &address).unwrap().value;
                assert_eq!(now as f32, value as f32, "{address}");
            }
            let again = State::from_bytes(&house, &state.to_bytes(&house)).unwrap();
            assert_eq!(again, state);
        }
        for (bad, part) in [
            (("agent/0/body/reach_m", 0.05), "0.1 to 5"),
            (("agent/0/body/reach_m", f64::NAN), "0.1 to 5"),
            (("agent/0/body/girth_m", 0.5), "push_force_n"),
            (("agent/00/body/height_m", 0.4), "twice"),
        ] {
            let mut rows = small.to_vec();
            rows.push(bad);
            let message = state.set_parameters(&house, &values(&rows)).unwrap_err();
            let message = message.to_string();
            assert!(
                message.contains(bad.0) && message.contains(part),
                "{message}"
            );
            assert_eq!(state.hash(), start, "{message}");
        }
    }

    #[test]
    fn an_agent_that_crouches_stays_low_when_its_body_changes() {
        use crate::{AgentBody, AgentState};
        let house = House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap();
        let mut state = State::new(&house);
        let low = AgentState {
            crouched_by_m: 0.6,
            ..AgentState::new(AgentBody::default(), glam::Vec3::ZERO, 0.0)
        };
        let agent = state.agents.push(low);
        let mut set = |field: &str, value: f64| {
            let address = format!("agent/0/body/{field}").parse().unwrap();
            state.set_parameter(&house, &address, value).unwrap();
            state.agents[agent].height_m()
        };
        assert!((set("height_m", 1.8) - 0.9).abs() < 1e-6);
        assert!((set("radius_m", 0.5) - 1.0).abs() < 1e-6);
    }
}
