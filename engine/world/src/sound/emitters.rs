//! The sounds of the house's own objects.

use super::fade::GainRamp;
use crate::engines::Engines;
use crate::error::WorldError;
use dwell_acoustics::signals::Signal;
use dwell_scene::units::pa_from_db_spl;
use dwell_scene::{House, SoundEmitter, State};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Writes the block that begins at sample `start` of an emitter's sound, root mean square 1 over the whole sound. `time`: samples
/// a second, samples a block, `start`; the world starts with the second block.
///
/// # Errors
/// [`WorldError`] for a signal that nobody knows and a sound file that is none.
pub(super) fn read_emitter_block(
    engines: &Engines,
    emitter: &SoundEmitter,
    (rate_hz, block, start): (u32, u64, u64),
    out: &mut [f32],
) -> Result<(), WorldError> {
    let signal = match emitter.sound_file {
        Some(file) => engines.house_sound_file(file, rate_hz)?,
        None => Signal::open(&emitter.signal, rate_hz)?,
    };
    if emitter.loops && emitter.start_s == 0.0 {
        signal.read(start, out);
        return Ok(());
    }
    let begins = block + (f64::from(emitter.start_s) * f64::from(rate_hz)).round() as u64;
    let skip = begins.saturating_sub(start).min(out.len() as u64) as usize;
    let elapsed = start.saturating_sub(begins);
    out[..skip].fill(0.0);
    if emitter.loops {
        signal.read(elapsed, &mut out[skip..]);
    } else {
        signal.read_once(elapsed, &mut out[skip..]);
    }
    Ok(())
}

/// An override of an object's own sound.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct EmitterOverride {
    pub(super) silent: bool,
    pub(super) level_db: Option<f32>,
}

/// The changing part of all emitters.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct EmitterStates {
    /// By number; emitters without an entry are as the house says.
    pub(super) overrides: BTreeMap<u64, EmitterOverride>,
    /// Shape (emitter,); empty before the first step.
    pub(super) fades: Vec<GainRamp>,
}

impl EmitterStates {
    pub(super) fn level_db(&self, house: &House, k: usize) -> f32 {
        let own = self.overrides.get(&(k as u64));
        let level_db = own.and_then(|own| own.level_db);
        level_db.unwrap_or(house.emitters[k].level_db)
    }

    pub(super) fn is_on(&self, house: &House, state: &State, k: usize) -> bool {
        let silent = self
            .overrides
            .get(&(k as u64))
            .is_some_and(|own| own.silent);
        !silent && state.is_on(house, house.emitters[k].object)
    }

    /// The block that ends now goes to where the state has them.
    pub(super) fn update(&mut self, house: &House, state: &State) {
        let targets = self.target_pressures_pa(house, state);
        if self.fades.is_empty() {
            self.fades = targets.into_iter().map(GainRamp::steady).collect();
            return;
        }
        for (fade, target) in self.fades.iter_mut().zip(targets) {
            fade.update(target);
        }
    }

    /// Returns the gains in the block that ended last. Shape (emitter,).
    pub(super) fn gain_ramps(&self, house: &House, state: &State) -> Vec<GainRamp> {
        if self.fades.is_empty() {
            let targets = self.target_pressures_pa(house, state).into_iter();
            return targets.map(GainRamp::steady).collect();
        }
        self.fades.clone()
    }

    fn target_pressures_pa(&self, house: &House, state: &State) -> Vec<f32> {
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
