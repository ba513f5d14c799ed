//! Friction and restitution of every pair of substances in a house, looked up in a step without strings.

use super::collider_entry::SurfaceContactClasses;
use crate::model::MaterialAssignment;
use dwell_scene::material::{PairContact, library};
use dwell_scene::{Address, House, IdVec, MaterialId, State};
use std::sync::Arc;

/// A class of equal contact behaviour: a substance, and its own values where a world overrides a material's.
#[derive(Clone, Debug, PartialEq)]
struct ContactClass {
    substance: &'static str,
    friction: Option<f32>,
    restitution: Option<f32>,
}

/// The contact behaviour of all pairs of classes in a house.
///
/// Friction and restitution of a pair are those of `State::pair_contact` for the two substances, bit for bit. Where a world
/// overrides `material/NAME/friction` or `/restitution`, and not the pair, the geometric mean with the overridden value
/// holds, as the materials table defines it for pairs without a row of their own.
#[derive(Clone, Debug)]
pub(crate) struct ContactTable {
    classes: Vec<ContactClass>,
    class_of_material: IdVec<MaterialId, u16>,
    unknown: u16,
    human: u16,
    /// Shape (class, class).
    pairs: Vec<PairContact>,
    /// The value of a class with itself under the geometric mean. Shape (class,).
    own: Vec<PairContact>,
    /// Set for classes whose pairs rapier asks the hook about. Of two classes whose pair differs from the geometric mean,
    /// at least one is set. Shape (class,).
    special: Vec<bool>,
}

fn overridden(state: &State, address: &str) -> Option<f32> {
    if state.overrides.is_empty() {
        return None;
    }
    let address: Address = address.parse().ok()?;
    state.overrides.get(&address).map(|value| *value as f32)
}

fn geometric_mean(a: f32, b: f32) -> f32 {
    // As in rapier's `GeometricMean` rule and the library, so that the bits agree.
    (a.max(0.0) * b.max(0.0)).sqrt()
}

impl ContactTable {
    pub(crate) fn new(house: &House, state: &State) -> Self {
        let default = library().default_substance().name.as_str();
        let mut classes: Vec<ContactClass> = Vec::new();
        let mut intern = |class: ContactClass| -> u16 {
            let found = classes.iter().position(|old| *old == class);
            let index = found.unwrap_or_else(|| {
                classes.push(class);
                classes.len() - 1
            });
            u16::try_from(index).unwrap_or(0)
        };
        let plain = |substance: &'static str| ContactClass {
            substance,
            friction: None,
            restitution: None,
        };
        let unknown = intern(plain(default));
        let human = intern(plain(
            library().get("human").map_or(default, |s| s.name.as_str()),
        ));
        let class_of_material = house
            .materials
            .iter()
            .map(|material| {
                intern(ContactClass {
                    substance: library().get_or_default(&material.substance).name.as_str(),
                    friction: overridden(state, &format!("material/{}/friction", material.name)),
                    restitution: overridden(
                        state,
                        &format!("material/{}/restitution", material.name),
                    ),
                })
            })
            .collect();
        let own: Vec<PairContact> = classes
            .iter()
            .map(|class| {
                let substance = library().get_or_default(class.substance);
                PairContact {
                    friction: class.friction.unwrap_or(substance.friction),
                    restitution: class.restitution.unwrap_or(substance.restitution),
                }
            })
            .collect();
        let count = classes.len();
        let mut pairs = Vec::with_capacity(count * count);
        let mut exceptions = Vec::new();
        for (i, a) in classes.iter().enumerate() {
            for (j, b) in classes.iter().enumerate() {
                let pair = pair(state, (a, own[i]), (b, own[j]));
                let by_rule = PairContact {
                    friction: geometric_mean(own[i].friction, own[j].friction),
                    restitution: geometric_mean(own[i].restitution, own[j].restitution),
                };
                if pair != by_rule && i <= j {
                    exceptions.push((i, j));
                }
                pairs.push(pair);
            }
        }
        let special = vertex_cover(
            &exceptions,
            &piece_count_by_class(house, &class_of_material, count),
        );
        Self {
            classes,
            class_of_material,
            unknown,
            human,
            pairs,
            own,
            special,
        }
    }

    /// Returns the class or classes of a piece.
    pub(crate) fn surface_materials(&self, cover: &MaterialAssignment) -> SurfaceContactClasses {
        let class = |material: Option<MaterialId>| {
            material.map_or(self.unknown, |material| self.class_of_material[material])
        };
        match cover {
            MaterialAssignment::Uniform(material) => {
                SurfaceContactClasses::Uniform(class(*material))
            }
            MaterialAssignment::PerTriangle(materials) => {
                let classes: Arc<[u16]> = materials.iter().map(|m| class(Some(*m))).collect();
                SurfaceContactClasses::PerTriangle(classes)
            }
        }
    }

    /// Returns the class of an agent's body.
    pub(crate) fn agent_material(&self) -> SurfaceContactClasses {
        SurfaceContactClasses::Uniform(self.human)
    }

    /// Returns the values between two classes.
    pub(crate) fn pair_contact(&self, a: u16, b: u16) -> PairContact {
        self.pairs[usize::from(a) * self.classes.len() + usize::from(b)]
    }

    /// Returns the values of a surface on itself, for rapier's own rule, and whether its pairs need a look-up instead.
    pub(crate) fn self_contact_and_hook(
        &self,
        surface: &SurfaceContactClasses,
    ) -> (PairContact, bool) {
        match surface {
            SurfaceContactClasses::Uniform(class) => {
                let class = usize::from(*class);
                (self.own[class], self.special[class])
            }
            SurfaceContactClasses::PerTriangle(_) => {
                (self.own[usize::from(surface.class(0))], true)
            }
        }
    }

    /// Returns whether some pair has other values than in `other`.
    pub(crate) fn pairs_differ(&self, other: &Self) -> bool {
        self.classes != other.classes || self.pairs != other.pairs
    }

    /// Returns the substance of a class.
    pub(crate) fn substance(&self, class: u16) -> &'static str {
        self.classes[usize::from(class)].substance
    }
}

/// Returns the number of the house's pieces in each class.
fn piece_count_by_class(
    house: &House,
    class_of_material: &IdVec<MaterialId, u16>,
    count: usize,
) -> Vec<usize> {
    let mut usage = vec![0; count];
    let parts = house.parts.iter().map(|part| &part.materials);
    for materials in parts.chain(house.structure.iter().map(|piece| &piece.materials)) {
        if let Some(material) = materials.first() {
            usage[usize::from(class_of_material[*material])] += 1;
        }
    }
    usage
}

/// Returns classes such that every exception contains one, the rarer of the two: contacts of a pair with a hook are
/// computed anew in every step, so that fewer are better.
fn vertex_cover(exceptions: &[(usize, usize)], usage: &[usize]) -> Vec<bool> {
    let mut covered = vec![false; usage.len()];
    for (i, j) in exceptions {
        if i == j {
            covered[*i] = true;
        }
    }
    for (i, j) in exceptions {
        if !covered[*i] && !covered[*j] {
            covered[if usage[*i] <= usage[*j] { *i } else { *j }] = true;
        }
    }
    covered
}

fn pair(
    state: &State,
    a: (&ContactClass, PairContact),
    b: (&ContactClass, PairContact),
) -> PairContact {
    let table = state.pair_contact(a.0.substance, b.0.substance);
    let named = |field: &str| {
        let (a, b) = (a.0.substance, b.0.substance);
        overridden(state, &format!("pair/{a}~{b}/{field}"))
            .or_else(|| overridden(state, &format!("pair/{b}~{a}/{field}")))
    };
    let friction = match (a.0.friction, b.0.friction) {
        (None, None) => table.friction,
        _ => named("friction").unwrap_or_else(|| geometric_mean(a.1.friction, b.1.friction)),
    };
    let restitution = match (a.0.restitution, b.0.restitution) {
        (None, None) => table.restitution,
        _ => {
            named("restitution").unwrap_or_else(|| geometric_mean(a.1.restitution, b.1.restitution))
        }
    };
    PairContact {
        friction,
        restitution,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::{Material, ShoeboxMaterials};

    fn room(floor: &str, walls: &str) -> House {
        let of = |name: &str, substance: &str| {
            Material::from_substance(name, library().get_or_default(substance))
        };
        let materials = ShoeboxMaterials {
            floor: of("floor", floor),
            ..ShoeboxMaterials::uniform(&of("wall", walls))
        };
        House::shoebox([4.0, 3.0, 4.0], &materials).unwrap()
    }

    #[test]
    fn every_pair_has_the_bits_that_the_state_says() {
        let house = room("cast_iron", "oak");
        let mut state = State::new(&house);
        let address: Address = "pair/oak~human/friction".parse().unwrap();
        state.set_parameter(&house, &address, 0.125).unwrap();
        let table = ContactTable::new(&house, &state);
        for (i, a) in table.classes.iter().enumerate() {
            for (j, b) in table.classes.iter().enumerate() {
                let expected = state.pair_contact(a.substance, b.substance);
                assert_eq!(table.pair_contact(i as u16, j as u16), expected);
            }
        }
        // Cast iron on oak is a published pair: one of the two needs the look-up.
        let special = |k: u32| {
            let surface = SurfaceContactClasses::Uniform(table.class_of_material[MaterialId(k)]);
            table.self_contact_and_hook(&surface).1
        };
        assert!(special(0) || special(1));
    }

    #[test]
    fn without_special_pairs_no_look_up_is_needed() {
        let house = room("plaster", "glass");
        let table = ContactTable::new(&house, &State::new(&house));
        assert!(table.special.iter().all(|special| !special));
    }

    #[test]
    fn an_overridden_material_enters_the_mean_but_not_a_named_pair() {
        let house = room("plaster", "glass");
        let mut state = State::new(&house);
        let address: Address = "material/floor/friction".parse().unwrap();
        state.set_parameter(&house, &address, 0.0).unwrap();
        let table = ContactTable::new(&house, &state);
        let (floor, wall) = (MaterialId(0), MaterialId(1));
        let pair = |t: &ContactTable| {
            t.pair_contact(t.class_of_material[floor], t.class_of_material[wall])
        };
        assert_eq!(pair(&table).friction, 0.0);
        let address: Address = "pair/glass~plaster/friction".parse().unwrap();
        state.set_parameter(&house, &address, 0.3).unwrap();
        assert_eq!(pair(&ContactTable::new(&house, &state)).friction, 0.3);
    }
}
