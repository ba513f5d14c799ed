//! The sounds of the house's own objects.

use super::fade::Fade;
use dwell_scene::units::pa_from_db_spl;
use dwell_scene::{House, State};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What was told to an object's own sound.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Told {
    pub(super) silent: bool,
    pub(super) level_db: Option<f32>,
}

/// What changes about them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Emitters {
    /// By number; who was told nothing is as the house says.
    pub(super) told: BTreeMap<u64, Told>,
    /// Shape (emitter,); empty before the first step.
    pub(super) fades: Vec<Fade>,
}

impl Emitters {
    pub(super) fn level_db(&self, house: &House, k: usize) -> f32 {
        let told = self.told.get(&(k as u64)).and_then(|told| told.level_db);
        told.unwrap_or(house.emitters[k].level_db)
    }

    pub(super) fn is_on(&self, house: &House, state: &State, k: usize) -> bool {
        let silent = self.told.get(&(k as u64)).is_some_and(|told| told.silent);
        !silent && state.is_on(house, house.emitters[k].object)
    }

    /// The block that ends now goes to where the state has them.
    pub(super) fn go(&mut self, house: &House, state: &State) {
        let targets = self.targets(house, state);
        if self.fades.is_empty() {
            self.fades = targets.into_iter().map(Fade::steady).collect();
            return;
        }
        for (fade, target) in self.fades.iter_mut().zip(targets) {
            fade.go(target);
        }
    }

    /// How loud each was in the block that ended last. Shape (emitter,).
    pub(super) fn fades(&self, house: &House, state: &State) -> Vec<Fade> {
        if self.fades.is_empty() {
            let targets = self.targets(house, state).into_iter();
            return targets.map(Fade::steady).collect();
        }
        self.fades.clone()
    }

    fn targets(&self, house: &House, state: &State) -> Vec<f32> {
        let target = |k| {
            if self.is_on(house, state, k) {
                pa_from_db_spl(self.level_db(house, k))
            } else {
                0.0
            }
        };
        (0..house.emitters.len()).map(target).collect()
    }
}
