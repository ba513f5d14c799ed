//! A house as sound sees it.

use crate::bands::{self, BAND_COUNT, Banded};
use crate::config::AcousticConfig;
use crate::echogram::Echogram;
use crate::error::{AcousticsError, finite};
use crate::explain::Explanation;
use crate::laws::{self, Effects, stage::Listener};
use crate::microphones::Microphones;
use crate::planes::{Plane, PlaneTable};
use crate::receiver::{Receiver, Source};
use crate::response::ImpulseResponse;
use crate::synthesis::Synthesizer;
use crate::{images, tail};
use dwell_scene::parallel::Threads;
use dwell_scene::random::Key;
use dwell_scene::rays::RayScene;
use dwell_scene::{Address, House, LawSpec, Material, MaterialId, Pose, State};
use glam::Vec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What a material does to sound energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Surface {
    /// Energy that stays after a reflection, 1 - absorption.
    pub(crate) kept: Banded,
    /// Fraction of it that is scattered.
    pub(crate) scattering: Banded,
    /// Whether it scatters at all.
    pub(crate) scatters: bool,
    /// Energy that passes through, from 0 to 1.
    pub(crate) passed: Banded,
}

impl Surface {
    const HARD: Self = Self {
        kept: [1.0; BAND_COUNT],
        scattering: [0.0; BAND_COUNT],
        scatters: false,
        passed: [0.0; BAND_COUNT],
    };

    fn new(house: &House, state: Option<&State>, id: MaterialId) -> Self {
        let material = &house.materials[id];
        let (absorption, scattering, loss_db) = match state {
            Some(state) => (
                state.absorption(house, id),
                state.scattering(house, id),
                state.transmission_loss_db(house, id),
            ),
            None => (
                material.absorption.clone(),
                material.scattering.clone(),
                material.transmission_loss_db.clone(),
            ),
        };
        let scattering = bands::sample(&scattering).map(|s| s.clamp(0.0, 1.0));
        let loss_db = bands::sample(&loss_db);
        Self {
            kept: bands::sample(&absorption).map(|a| (1.0 - a).clamp(0.0, 1.0)),
            scattering,
            scatters: scattering.iter().any(|s| *s > 0.0),
            passed: loss_db.map(|db| {
                if db >= Material::OPAQUE_TO_SOUND_DB {
                    0.0
                } else {
                    libm::powf(10.0, -db / 10.0)
                }
            }),
        }
    }
}

/// A house prepared for sound, as it stands in one world.
///
/// What belongs to the house (its planes) is shared by clones; what belongs to the world (overridden materials, moved
/// planes) is not, and is small. Make one, and clone it for each world.
#[derive(Clone, Debug)]
pub struct AcousticScene {
    house: Arc<House>,
    /// As it was asked for.
    stated: AcousticConfig,
    /// As laws make it.
    config: AcousticConfig,
    effects: Effects,
    laws: Vec<LawSpec>,
    table: Arc<PlaneTable>,
    synthesizer: Arc<Synthesizer>,
    /// Where all planes are now.
    planes: Vec<Plane>,
    /// Where the moving parts are now. Shape (moving part,).
    poses: Vec<Pose>,
    /// Shape (material,).
    surfaces: Vec<Surface>,
    overrides: BTreeMap<Address, f64>,
}

impl AcousticScene {
    /// Prepares `house`, with everything where it stands at the start.
    ///
    /// # Errors
    /// [`AcousticsError::Range`] for a setting out of range.
    pub fn new(house: Arc<House>, config: AcousticConfig) -> Result<Self, AcousticsError> {
        config.check()?;
        let table = Arc::new(PlaneTable::new(&house));
        tracing::debug!(planes = table.len(), "acoustic planes built");
        Ok(Self {
            planes: table.at_start.clone(),
            poses: table.poses_at_start(&house),
            surfaces: house
                .materials
                .ids()
                .map(|id| Surface::new(&house, None, id))
                .collect(),
            synthesizer: Arc::new(Synthesizer::new(&config)),
            overrides: BTreeMap::new(),
            stated: config,
            effects: Effects::default(),
            laws: Vec::new(),
            table,
            config,
            house,
        })
    }

    /// Takes over overridden materials, moved parts and laws; cheap when nothing changed.
    pub fn update(&mut self, state: &State) {
        if state.laws != self.laws {
            self.laws.clone_from(&state.laws);
            self.obey(laws::effects(&self.laws));
        }
        if state.overrides != self.overrides {
            self.overrides.clone_from(&state.overrides);
            let ids = self.house.materials.ids();
            self.surfaces = ids
                .map(|id| Surface::new(&self.house, Some(state), id))
                .collect();
        }
        self.table.update(&mut self.planes, &mut self.poses, state);
    }

    fn obey(&mut self, effects: Effects) {
        let before = self.config.air;
        self.config = effects.config(&self.stated);
        self.effects = effects;
        if self.config.air != before {
            // Ears are as far apart as sound is slow.
            self.synthesizer = Arc::new(Synthesizer::new(&self.config));
        }
    }

    /// What laws do to air and sources.
    pub(crate) fn effects(&self) -> &Effects {
        &self.effects
    }

    /// The house.
    pub fn house(&self) -> &Arc<House> {
        &self.house
    }

    /// The settings, with the air as laws make it.
    pub fn config(&self) -> &AcousticConfig {
        &self.config
    }

    /// All planes where they are now, largest of the static ones first.
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    pub(crate) fn table(&self) -> &PlaneTable {
        &self.table
    }

    pub(crate) fn surface(&self, id: MaterialId) -> &Surface {
        use dwell_scene::Id;
        // An id of another house counts as a hard wall; houses are compared where calls come in.
        self.surfaces.get(id.index()).unwrap_or(&Surface::HARD)
    }

    /// Whether the state overrides a number of the material called `name`.
    pub(crate) fn is_overridden(&self, name: &str) -> bool {
        let prefix = format!("material/{name}/");
        let mut addresses = self.overrides.keys();
        addresses.any(|address| address.as_str().starts_with(&prefix))
    }

    /// Energy decay of air in each band, 1/m; zeros where air does not absorb.
    pub(crate) fn air_decay_per_m(&self) -> [f64; BAND_COUNT] {
        if self.config.air_absorption {
            let whole = self.config.air.energy_decay_per_m();
            self.effects.air_decay_per_m(whole)
        } else {
            [0.0; BAND_COUNT]
        }
    }

    /// What sound meets: areas, mean absorption, which materials are guesses.
    pub fn explain(&self) -> Explanation {
        Explanation::new(self)
    }

    /// Whether points are somewhere, and rays meet this house.
    pub(crate) fn check(
        &self,
        rays: &RayScene,
        source: Vec3,
        receiver: Vec3,
    ) -> Result<(), AcousticsError> {
        finite("the source", source)?;
        finite("the receiver", receiver)?;
        if !Arc::ptr_eq(rays.house(), &self.house) && **rays.house() != *self.house {
            return Err(AcousticsError::OtherHouse {
                rays: rays.house().name.clone(),
                scene: self.house.name.clone(),
            });
        }
        Ok(())
    }

    /// The energies that reach `receiver` from `source`: exact early paths and the traced tail, without any noise.
    ///
    /// `rays` must show the house of this scene in the state that was last given to [`Self::update`].
    ///
    /// # Errors
    /// [`AcousticsError::Position`] for a point that is nowhere, [`AcousticsError::OtherHouse`].
    ///
    /// # Determinism
    /// Equal scene, points and key give equal bits for any number of threads.
    pub fn echogram(
        &self,
        rays: &RayScene,
        source: &Source,
        receiver: Vec3,
        key: Key,
        threads: Threads,
    ) -> Result<Echogram, AcousticsError> {
        self.check(rays, source.position, receiver)?;
        let early = images::find(self, rays, source.position, receiver);
        let late = tail::trace(
            self,
            rays,
            source.position,
            receiver,
            key.child("tail"),
            threads,
        );
        let mut echogram = Echogram {
            paths: early,
            tail: late.histogram,
            trace: late.statistics,
            direct_length_m: source.position.as_dvec3().distance(receiver.as_dvec3()),
            speed_m_s: self.config.air.speed_of_sound_m_s(),
        };
        self.effects.at_source(&mut echogram);
        Ok(echogram)
    }

    /// What `receiver` hears when `source` makes an impulse, as the laws of the state that was last given to [`Self::update`]
    /// have it.
    ///
    /// A law of microphones that has no impulse response (clipping, automatic gain, noise, clocks) does to this what it does to
    /// a recording of the impulse.
    ///
    /// # Errors
    /// As [`Self::echogram`].
    ///
    /// # Determinism
    /// Equal scene, points and key give equal bits for any number of threads.
    pub fn impulse_response(
        &self,
        rays: &RayScene,
        source: &Source,
        receiver: &Receiver,
        key: Key,
        threads: Threads,
    ) -> Result<ImpulseResponse, AcousticsError> {
        let echogram = self.echogram(rays, source, receiver.position(), key, threads)?;
        Ok(self.respond(echogram, receiver, key))
    }

    /// The impulse response that belongs to an echogram: another turn of the head needs no new rays. Laws of microphones act as
    /// in [`Self::impulse_response`].
    pub fn respond(&self, echogram: Echogram, receiver: &Receiver, key: Key) -> ImpulseResponse {
        let mut response = self.arrive(echogram, receiver, key);
        let listener = self.listener(
            receiver,
            key.child("room"),
            key.child("microphone").child(0),
        );
        let rate_hz = f64::from(self.config.rate_hz);
        response.samples = Microphones::record(&self.laws, rate_hz, &listener, response.samples);
        response
    }

    /// Who listens; `room` and `own` as in [`Listener`].
    pub(crate) fn listener<'a>(
        &'a self,
        receiver: &'a Receiver,
        room: Key,
        own: Key,
    ) -> Listener<'a> {
        Listener {
            receiver,
            head: self.synthesizer.head(),
            speed_m_s: self.config.air.speed_of_sound_m_s(),
            room,
            own,
        }
    }

    /// The impulse response up to the microphones, without their laws.
    pub(crate) fn arrive(
        &self,
        echogram: Echogram,
        receiver: &Receiver,
        key: Key,
    ) -> ImpulseResponse {
        let samples = self
            .synthesizer
            .render(&echogram, receiver, key.child("noise"));
        let channels = receiver.channels();
        ImpulseResponse {
            channels,
            rate_hz: self.config.rate_hz,
            samples,
            echogram,
        }
    }
}
