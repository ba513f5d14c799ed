//! Canonical spelling of parameter addresses.
//!
//! An object has an id and a name, a pair two orders, a number many spellings. An override is stored under one of them
//! alone, so that nothing is overridden twice.

use super::State;
use super::address::Address;
use super::names::{find_joint_of, find_object, find_part_of};
use crate::error::SceneError;
use crate::house::House;

impl State {
    /// Returns the canonical spelling of `address`: objects by id, joints and parts by number, pairs in alphabetical order,
    /// numbers as they are printed. An address that names nothing stays as it is.
    ///
    /// # Errors
    /// [`SceneError::Address`] for an object that does not exist.
    pub fn canonical(&self, house: &House, address: &Address) -> Result<Address, SceneError> {
        let text = match address.words()[..] {
            ["object", object, field] => {
                let id = find_object(house, address, object)?;
                format!("object/{}/{field}", house.entity_of_object(id).0)
            }
            ["joint", object, name, field] => {
                let joint = find_joint_of(house, address, object, name)?;
                return Ok(Address::of_joint(joint, field));
            }
            ["part", object, name, field] => {
                let part = find_part_of(house, address, object, name)?;
                return Ok(Address::of_part(part, field));
            }
            ["pair", pair, field] => match pair.split_once('~') {
                Some((a, b)) => pair_address(a, b, field),
                None => return Ok(address.clone()),
            },
            ["material", name, field, hz] => match hz.parse::<f32>() {
                Ok(hz) => format!("material/{name}/{field}/{hz}"),
                Err(_) => return Ok(address.clone()),
            },
            [kind @ ("joint" | "part" | "agent"), number, ref rest @ ..] => {
                match number.parse::<u32>() {
                    Ok(number) => format!("{kind}/{number}/{}", rest.join("/")),
                    Err(_) => return Ok(address.clone()),
                }
            }
            _ => return Ok(address.clone()),
        };
        text.parse()
    }
}

/// The spelling of a pair's field.
pub(super) fn pair_address(a: &str, b: &str, field: &str) -> String {
    format!("pair/{}~{}/{field}", a.min(b), a.max(b))
}

#[cfg(test)]
mod tests {
    use crate::{Address, House, ShoeboxMaterials, State};

    fn room() -> House {
        House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap()
    }

    #[test]
    fn aliases_are_one_parameter() {
        let house = room();
        let groups = [
            vec!["pair/steel~oak/friction", "pair/oak~steel/friction"],
            vec![
                "material/floor/absorption/1e3",
                "material/floor/absorption/1000",
                "material/floor/absorption/1000.0",
            ],
        ];
        for aliases in groups {
            let mut state = State::new(&house);
            for (k, alias) in aliases.iter().enumerate() {
                let value = 0.25 + 0.125 * k as f64;
                let set: Address = alias.parse().unwrap();
                state.set_parameter(&house, &set, value).unwrap();
                assert_eq!(state.overrides.len(), 1, "{alias}");
                for other in &aliases {
                    let read = state.parameter(&house, &other.parse().unwrap()).unwrap();
                    assert!((read.value - value).abs() < 1e-6, "{alias} is not {other}");
                }
            }
        }
    }

    #[test]
    fn numbers_of_agents_and_joints_have_one_spelling_too() {
        let house = room();
        let state = State::new(&house);
        for (found, expected) in [
            (
                "agent/00/base/wheel_radius_m",
                "agent/0/base/wheel_radius_m",
            ),
            ("joint/+3/friction", "joint/3/friction"),
            ("world/gravity_m_s2", "world/gravity_m_s2"),
            ("pair/oak/friction", "pair/oak/friction"),
        ] {
            let address = state.canonical(&house, &found.parse().unwrap()).unwrap();
            assert_eq!(address.as_str(), expected);
        }
    }
}
