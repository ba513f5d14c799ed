//! Masses with overrides: an object's own precedes its parts', a part's own precedes its materials' densities.

use super::State;
use crate::house::House;
use crate::ids::{Id, ObjectId, PartId};

impl State {
    /// Returns the overridden mass of an object, kg; `None` without an override of the object itself.
    pub fn overridden_mass_kg(&self, house: &House, object: ObjectId) -> Option<f32> {
        self.override_value(format!(
            "object/{}/mass_kg",
            house.entity_of_object(object).0
        ))
    }

    /// Returns the sum of an object's part masses, kg; parts that state no mass are left out.
    pub fn mass_of_parts_kg(&self, house: &House, object: ObjectId) -> f32 {
        let parts = house.objects[object].parts();
        let masses = parts.filter_map(|id| {
            let nominal = house.parts[id].mass_kg?;
            Some(nominal * self.part_mass_factor(house, id))
        });
        // A sum of nothing is -0.
        masses.sum::<f32>() + 0.0
    }

    /// Returns the factor on a part's mass: 1 without overrides.
    ///
    /// A part whose mass is overridden has that mass. Else its mass follows the densities of its materials
    /// (`material/NAME/density_kg_m3`), weighted by their shares of its surface: a house does not give the volume of each
    /// material.
    pub fn part_mass_factor(&self, house: &House, part: PartId) -> f32 {
        let own = self.override_value(format!("part/{}/mass_kg", part.index()));
        match (own, house.parts[part].mass_kg) {
            (Some(now), Some(nominal)) if nominal > 0.0 => now / nominal,
            _ => self.density_factor(house, part),
        }
    }

    fn density_factor(&self, house: &House, part: PartId) -> f32 {
        let part = &house.parts[part];
        let factors: Vec<f32> = part
            .materials
            .iter()
            .map(|id| {
                let material = &house.materials[*id];
                let now = self.override_value(format!("material/{}/density_kg_m3", material.name));
                now.map_or(1.0, |now| now / material.density_kg_m3)
            })
            .collect();
        if factors.iter().all(|factor| *factor == 1.0) {
            return 1.0;
        }
        let mesh = &house.meshes[part.mesh];
        let (mut sum, mut area) = (0.0_f64, 0.0_f64);
        for k in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(k);
            let own = f64::from((b - a).cross(c - a).length());
            let factor = factors.get(usize::from(mesh.slot(k))).unwrap_or(&1.0);
            (sum, area) = (sum + own * f64::from(*factor), area + own);
        }
        if area > 0.0 {
            (sum / area) as f32
        } else {
            factors[0]
        }
    }
}
