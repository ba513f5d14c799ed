//! Listing of all addresses in a house.

use super::joint::FIELDS;
use super::part::INERTIAL_FIELDS;
use super::{Address, State};
use crate::house::House;
use crate::ids::Id;
use std::collections::BTreeSet;

impl State {
    /// Returns the address of every parameter of this world but those of laws: gravity, masses, joints, agents, materials
    /// at their own band centres, and pairs of substances that the house contains. Each in its canonical spelling, in a
    /// fixed order.
    pub fn addresses(&self, house: &House) -> Vec<Address> {
        let mut texts = ["world/gravity_m_s2", "world/hand_effort"]
            .map(str::to_owned)
            .to_vec();
        for object in house.objects.ids() {
            texts.push(format!(
                "object/{}/mass_kg",
                house.entity_of_object(object).0
            ));
        }
        for (id, part) in house.parts.iter_ids() {
            if part.mass_kg.is_some() {
                texts.push(format!("part/{}/mass_kg", id.0));
            }
            if part.inertial.is_some() {
                let fields = INERTIAL_FIELDS.iter();
                texts.extend(fields.map(|field| format!("part/{}/{field}", id.0)));
            }
        }
        for (id, joint) in house.joints.iter_ids() {
            let here = FIELDS.iter().filter(|field| (field.get)(joint).is_some());
            texts.extend(here.map(|field| format!("joint/{}/{}", id.0, field.name)));
        }
        for (id, agent) in self.agents.iter_ids() {
            let fields = agent.body.parameters();
            let fields = fields.iter();
            texts.extend(fields.map(|(field, _)| format!("agent/{}/body/{field}", id.index())));
            let fields = agent.body.locomotion.parameters();
            let fields = fields.iter();
            texts.extend(fields.map(|(field, _)| format!("agent/{}/base/{field}", id.index())));
            texts.push(format!("agent/{}/camera/fov_deg", id.index()));
        }
        let mut substances = BTreeSet::new();
        for material in &house.materials {
            substances.insert(material.substance.as_str());
            for field in ["friction", "restitution", "density_kg_m3"] {
                texts.push(format!("material/{}/{field}", material.name));
            }
            for (field, bands) in [
                ("absorption", &material.absorption),
                ("scattering", &material.scattering),
                ("transmission_loss_db", &material.transmission_loss_db),
            ] {
                let centres = bands.centres_hz.iter();
                texts.extend(centres.map(|hz| format!("material/{}/{field}/{hz}", material.name)));
            }
        }
        for a in &substances {
            for b in substances.range(*a..) {
                texts.push(format!("pair/{a}~{b}/friction"));
                texts.push(format!("pair/{a}~{b}/restitution"));
            }
        }
        let mut addresses: Vec<Address> = Vec::with_capacity(texts.len());
        // A material whose name is empty or has a slash has no address.
        for address in texts.iter().filter_map(|text| text.parse::<Address>().ok()) {
            if self.parameter(house, &address).is_ok() {
                addresses.push(address);
            }
        }
        addresses
    }
}

#[cfg(test)]
mod tests {
    use crate::{AgentBody, AgentState, House, ShoeboxMaterials, State};

    /// Every listed address can be read and set to its value, and is spelled as it is stored.
    #[test]
    fn listed_addresses_are_read_and_set() {
        let house = House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap();
        let mut state = State::new(&house);
        let body = AgentBody::default();
        state
            .agents
            .push(AgentState::new(body, glam::Vec3::ZERO, 0.0));
        let addresses = state.addresses(&house);
        assert!(addresses.len() > 20, "{addresses:?}");
        for wanted in [
            "world/gravity_m_s2",
            "material/floor/absorption/1000",
            "agent/0/base/max_speed_m_s",
            "agent/0/body/radius_m",
        ] {
            assert!(addresses.iter().any(|a| a.as_str() == wanted), "{wanted}");
        }
        for address in &addresses {
            assert_eq!(&state.canonical(&house, address).unwrap(), address);
            let value = state.parameter(&house, address).unwrap().value;
            state.set_parameter(&house, address, value).unwrap();
            let after = state.parameter(&house, address).unwrap().value;
            assert!((after - value).abs() <= 1e-6 * value.abs(), "{address}");
        }
        assert_eq!(state.addresses(&house), addresses);
    }
}
