//! Surfaces of a thing that coincide: which of them is seen would be chance.

use super::cases::{Case, every_draw};
use crate::testing::coincident::{Facet, coincidences, facets};
use dwell_scene::Pose;

#[test]
fn no_two_visible_surfaces_coincide() {
    every_draw(|case: &Case| {
        let mut names = Vec::new();
        let mut all: Vec<Facet> = Vec::new();
        let mut finishes = Vec::new();
        for part in &case.model.parts {
            let slots: Vec<usize> = part
                .finishes
                .iter()
                .map(|finish| {
                    finishes
                        .iter()
                        .position(|known| *known == finish)
                        .unwrap_or_else(|| {
                            finishes.push(finish);
                            names.push(format!("{}/{}", part.name, finish.name));
                            finishes.len() - 1
                        })
                })
                .collect();
            all.extend(facets(&part.mesh, &Pose::IDENTITY, |slot| {
                (slots[slot], part.finishes[slot].pattern.is_some())
            }));
        }
        let found = coincidences(&all);
        found
            .iter()
            .map(|one| {
                let [p, q] = one.materials.map(|k| &names[k]);
                format!(
                    "{p} and {q}: {:.1} cm² at {}, facing {}",
                    one.area_m2 * 1e4,
                    one.place,
                    one.normal
                )
            })
            .collect()
    });
}
