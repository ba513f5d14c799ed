//! What the first episode over a house waits for, and what can be made beside it.

use crate::engines::Engines;
use crate::env::Env;
use dwell_acoustics::signals;
use dwell_render::BackEnd;
use dwell_scene::parallel::Threads;
use std::collections::BTreeSet;
use std::sync::Arc;

/// What the sensors of environments use first when an episode begins, and nobody has made yet.
#[derive(Default)]
pub(crate) struct FirstUse {
    /// Houses to be prepared for sound, with the preset and the sample rate.
    sounds: Vec<(Arc<Engines>, String, u32)>,
    /// Houses to be prepared for pictures.
    pictures: Vec<(Arc<Engines>, BackEnd)>,
    /// Loops of sound.
    signals: BTreeSet<String>,
    signal_rate_hz: u32,
}

impl FirstUse {
    /// That of these environments.
    pub(crate) fn of<'a>(envs: impl Iterator<Item = &'a Env>) -> Self {
        let mut all = Self::default();
        for env in envs {
            let (engines, config) = (env.world().engines(), env.world().config());
            let requests = env.requests();
            let is_new = |other: &Arc<Engines>| !Arc::ptr_eq(other, engines);
            if !requests.listeners.is_empty() {
                let (names, rate_hz) = env.world().active_signals_and_rate();
                let unmade = names.into_iter();
                all.signals
                    .extend(unmade.filter(|name| signals::needs_synthesis(name, rate_hz)));
                all.signal_rate_hz = all.signal_rate_hz.max(rate_hz);
                if all.sounds.iter().all(|(other, ..)| is_new(other))
                    && !engines.has_acoustic_scene(&config.sound_preset, config.sound_rate_hz)
                {
                    let preset = config.sound_preset.clone();
                    all.sounds
                        .push((engines.clone(), preset, config.sound_rate_hz));
                }
            }
            if !requests.views.is_empty()
                && all.pictures.iter().all(|(other, _)| is_new(other))
                && !engines.has_renderer()
            {
                all.pictures
                    .push((engines.clone(), config.renderer.clone()));
            }
        }
        all
    }

    /// Returns whether all is made.
    pub(crate) fn is_empty(&self) -> bool {
        self.sounds.is_empty() && self.pictures.is_empty() && self.signals.is_empty()
    }

    /// Makes it. What fails here fails again where it is used, and is told there.
    pub(crate) fn make(&self, threads: Threads) {
        let names: Vec<&str> = self.signals.iter().map(String::as_str).collect();
        signals::presynthesize(&names, self.signal_rate_hz, threads);
        for (engines, preset, rate_hz) in &self.sounds {
            let _told_at_use = engines.acoustic_scene(preset, *rate_hz);
        }
        for (engines, back_end) in &self.pictures {
            let _told_at_use = engines.image_renderer(back_end);
        }
    }
}
