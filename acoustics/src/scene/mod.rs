//! A house as sound sees it.

mod early_paths;

pub use early_paths::EarlyPath;

use crate::config::AcousticConfig;
use crate::echogram::{Echogram, PropagationPath};
use crate::error::{AcousticsError, finite};
use crate::head::{Head, HeadSet};
use crate::laws::{self, PathEffects, microphone_stage::StageContext};
use crate::material_report::AcousticReport;
use crate::microphone_chain::MicrophoneChain;
use crate::planes::{DiffractionEdge, Plane};
use crate::propagation_data::PropagationData;
use crate::receiver::{Receiver, ReceiverKind, SoundSourcePose};
use crate::response::ImpulseResponse;
use crate::synthesis::{CachedGains, HearingContext, Synthesizer, UpperAir, Wavelet};
use crate::tail::LateReverberation;
use crate::{image_sources, tail};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{House, LawSpec, State};
use glam::Vec3;
use std::sync::Arc;

/// Places within a cell of this size have the same random arrivals, m.
const CELL_M: f64 = 0.1;
/// Offset of the cells: off the round numbers at which things are placed.
const CELL_START: f64 = 0.32;

/// The acoustic model of a house in the state of one world.
///
/// Data of the house (its planes) is shared by clones; data of the world (overridden materials, moved planes) is not, and
/// is small. Make one, and clone it for each world.
#[derive(Clone, Debug)]
pub struct AcousticScene {
    /// As it was asked for.
    stated: AcousticConfig,
    laws: Vec<LawSpec>,
    data: PropagationData,
    synthesizer: Arc<Synthesizer>,
    heads: Arc<HeadSet>,
    /// Absorption by air above the highest band, where that can be heard.
    upper_air: Option<Arc<UpperAir>>,
}

impl AcousticScene {
    /// Prepares `house`, with everything where it stands at the start.
    ///
    /// # Errors
    /// [`AcousticsError::Range`] for a setting out of range.
    pub fn new(house: Arc<House>, config: AcousticConfig) -> Result<Self, AcousticsError> {
        config.check()?;
        let data = PropagationData::new(house, config);
        let synthesizer = Synthesizer::shared(&config);
        Ok(Self {
            upper_air: synthesizer.upper_air(&config, 1.0).map(Arc::new),
            synthesizer,
            heads: Arc::new(HeadSet::new(&config)),
            stated: config,
            laws: Vec::new(),
            data,
        })
    }

    /// Takes over overridden materials, moved parts and laws; cheap when nothing changed.
    pub fn update(&mut self, state: &State) {
        if state.laws != self.laws {
            self.laws.clone_from(&state.laws);
            self.apply_laws(laws::path_effects(&self.laws));
        }
        self.data.update(state);
    }

    fn apply_laws(&mut self, effects: PathEffects) {
        let air = self.config().air;
        let absorption = self.effects().air_absorption();
        self.data.apply(effects, &self.stated);
        let config = *self.config();
        if config.air != air {
            // Ears are as far apart as sound is slow.
            self.heads = Arc::new(self.heads.in_air(&config));
        }
        let share = self.effects().air_absorption();
        if config.air != air || share != absorption {
            self.upper_air = self.synthesizer.upper_air(&config, share).map(Arc::new);
        }
    }

    /// One more head that receivers of this scene may wear ([`Receiver::wearing`]). A head that is known already costs nothing.
    pub fn add_head(&mut self, head: &Head) {
        if !self.heads.knows(head.id()) {
            Arc::make_mut(&mut self.heads).add(head);
        }
    }

    /// The same scene as laws with some effects have it.
    pub(crate) fn as_heard(&self, effects: PathEffects) -> Self {
        let mut scene = self.clone();
        scene.apply_laws(effects);
        scene
    }

    /// Returns what laws do to air and sources.
    pub(crate) fn effects(&self) -> &PathEffects {
        self.data.effects()
    }

    /// Returns what rays, images and edges read.
    pub(crate) fn data(&self) -> &PropagationData {
        &self.data
    }

    /// The house.
    pub fn house(&self) -> &Arc<House> {
        self.data.house()
    }

    /// The settings, with the air as laws make it.
    pub fn config(&self) -> &AcousticConfig {
        self.data.config()
    }

    /// All planes where they are now, largest of the static ones first.
    pub fn planes(&self) -> &[Plane] {
        self.data.planes()
    }

    /// All edges that sound bends around, where they are now.
    pub fn edges(&self) -> impl Iterator<Item = &DiffractionEdge> {
        self.data.edges()
    }

    /// Returns what sound meets: areas, mean absorption, which materials are guesses.
    pub fn explain(&self) -> AcousticReport {
        AcousticReport::new(&self.data)
    }

    /// Returns whether source and receiver are somewhere, and rays meet this house.
    pub(crate) fn check(
        &self,
        rays: &RayScene,
        source: &SoundSourcePose,
        receivers: &[Vec3],
    ) -> Result<(), AcousticsError> {
        source.check()?;
        for receiver in receivers {
            finite("the receiver", *receiver)?;
        }
        let house = self.house();
        if !Arc::ptr_eq(rays.house(), house) && **rays.house() != **house {
            return Err(AcousticsError::OtherHouse {
                rays: rays.house().name.clone(),
                scene: house.name.clone(),
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
        source: &SoundSourcePose,
        receiver: Vec3,
        key: RandomKey,
        threads: Threads,
    ) -> Result<Echogram, AcousticsError> {
        let echograms = self.echograms(rays, source, &[receiver], key, threads)?;
        Ok(echograms.into_iter().next().unwrap_or_default())
    }

    /// As [`Self::echogram`] for many receivers, which share the source's rays. Shape (receiver,).
    ///
    /// # Errors
    /// As [`Self::echogram`].
    ///
    /// # Determinism
    /// As [`Self::echogram`]; where [`AcousticConfig::max_error`] ends the rays early, all receivers must be good enough.
    pub fn echograms(
        &self,
        rays: &RayScene,
        source: &SoundSourcePose,
        receivers: &[Vec3],
        key: RandomKey,
        threads: Threads,
    ) -> Result<Vec<Echogram>, AcousticsError> {
        self.check(rays, source, receivers)?;
        Ok(self.echograms_of(rays, source, receivers, self.config().rays, key, threads))
    }

    /// As [`Self::echograms`] with so many rays.
    pub(crate) fn echograms_of(
        &self,
        rays: &RayScene,
        source: &SoundSourcePose,
        receivers: &[Vec3],
        count: usize,
        key: RandomKey,
        threads: Threads,
    ) -> Vec<Echogram> {
        let position = source.position();
        let early = threads.map(receivers.len(), |k| {
            image_sources::find(&self.data, rays, source, receivers[k])
        });
        let late = tail::trace(
            &self.data,
            rays,
            source,
            receivers,
            count,
            key.child("tail"),
            threads,
        );
        let both = early.into_iter().zip(late).zip(receivers);
        both.map(|((paths, late), receiver)| self.joined(paths, late, position, *receiver))
            .collect()
    }

    /// The echogram of early paths and a tail.
    pub(crate) fn joined(
        &self,
        paths: Vec<PropagationPath>,
        late: LateReverberation,
        source: Vec3,
        receiver: Vec3,
    ) -> Echogram {
        let mut echogram = Echogram {
            paths,
            tail: late.histogram,
            trace: late.statistics,
            source,
            direct_length_m: source.as_dvec3().distance(receiver.as_dvec3()),
            speed_m_s: self.config().air.speed_of_sound_m_s(),
        };
        self.effects().at_source(&mut echogram);
        echogram
    }

    /// Returns what `receiver` hears when `source` makes an impulse, as the laws of the state that was last given to [`Self::update`]
    /// have it.
    ///
    /// A law of microphones that has no impulse response (clipping, automatic gain, noise, clocks) does to this what it does to
    /// a recording of the impulse.
    ///
    /// # Errors
    /// As [`Self::echogram`], [`AcousticsError::Range`] for a receiver or directivity out of range, and
    /// [`AcousticsError::UnknownHead`].
    ///
    /// # Determinism
    /// Equal scene, points and key give equal bits for any number of threads.
    pub fn impulse_response(
        &self,
        rays: &RayScene,
        source: &SoundSourcePose,
        receiver: &Receiver,
        key: RandomKey,
        threads: Threads,
    ) -> Result<ImpulseResponse, AcousticsError> {
        let responses =
            self.impulse_responses(rays, source, std::slice::from_ref(receiver), key, threads)?;
        Ok(responses.into_iter().next().unwrap_or_default())
    }

    /// As [`Self::impulse_response`] for many receivers, which share the source's rays. Shape (receiver,).
    ///
    /// # Errors
    /// As [`Self::impulse_response`].
    ///
    /// # Determinism
    /// As [`Self::echograms`].
    pub fn impulse_responses(
        &self,
        rays: &RayScene,
        source: &SoundSourcePose,
        receivers: &[Receiver],
        key: RandomKey,
        threads: Threads,
    ) -> Result<Vec<ImpulseResponse>, AcousticsError> {
        let placed: Vec<Receiver> = receivers.iter().map(|r| self.effects().placed(r)).collect();
        let noise = |receiver: &Receiver| between(key, source.position(), receiver.position());
        let arrived = self.arrivals(rays, source, &placed, key, noise, threads)?;
        let both = arrived.into_iter().zip(&placed);
        Ok(both
            .map(|(response, receiver)| self.record(response, receiver, key))
            .collect())
    }

    /// The impulse response that belongs to an echogram: another turn of the head needs no new rays. Laws of microphones act as
    /// in [`Self::impulse_response`].
    ///
    /// With the key of [`Self::impulse_response`] it has the same random arrivals. The microphones of an array hear the centre's
    /// early paths as plane waves here. A head that the scene does not know is heard as the built-in one.
    pub fn respond(
        &self,
        echogram: Echogram,
        receiver: &Receiver,
        key: RandomKey,
    ) -> ImpulseResponse {
        let receiver = &self.effects().placed(receiver);
        let noise = between(key, echogram.source, receiver.position());
        self.record(self.arrive(echogram, receiver, None, noise), receiver, key)
    }

    /// Returns what the laws of microphones make of a response.
    fn record(
        &self,
        response: ImpulseResponse,
        receiver: &Receiver,
        key: RandomKey,
    ) -> ImpulseResponse {
        let own = key.child("microphone").child(0);
        let listener = self.listener(receiver, key.child("room"), own);
        let rate_hz = f64::from(self.config().rate_hz);
        ImpulseResponse {
            samples: MicrophoneChain::record(&self.laws, rate_hz, &listener, response.samples),
            ..response
        }
    }

    /// Returns who listens; `room` and `own` as in [`StageContext`].
    pub(crate) fn listener<'a>(
        &'a self,
        receiver: &'a Receiver,
        room: RandomKey,
        own: RandomKey,
    ) -> StageContext<'a> {
        StageContext {
            receiver,
            heads: &self.heads,
            speed_m_s: self.config().air.speed_of_sound_m_s(),
            room,
            own,
        }
    }

    /// Returns whether a receiver is in range, and its head known.
    pub(crate) fn check_receiver(&self, receiver: &Receiver) -> Result<(), AcousticsError> {
        receiver.check()?;
        match receiver.kind {
            ReceiverKind::Head(id) if !self.heads.knows(id) => {
                Err(AcousticsError::UnknownHead { id: id.0 })
            }
            _ => Ok(()),
        }
    }

    /// The impulse responses up to the microphones, without their laws; `noise` keys the random arrivals at a receiver. Shape
    /// (receiver,).
    pub(crate) fn arrivals(
        &self,
        rays: &RayScene,
        source: &SoundSourcePose,
        receivers: &[Receiver],
        key: RandomKey,
        noise: impl Fn(&Receiver) -> RandomKey + Sync,
        threads: Threads,
    ) -> Result<Vec<ImpulseResponse>, AcousticsError> {
        for receiver in receivers {
            self.check_receiver(receiver)?;
        }
        let centres: Vec<Vec3> = receivers.iter().map(Receiver::position).collect();
        let echograms = self.echograms(rays, source, &centres, key, threads)?;
        Ok(threads.map(receivers.len(), |k| {
            let receiver = &receivers[k];
            let early = self.early_of_microphones(rays, source, receiver);
            let echogram = echograms[k].clone();
            self.arrive(echogram, receiver, early.as_deref(), noise(receiver))
        }))
    }

    /// The early paths of each microphone of an array; `None` where the centre's serve.
    pub(crate) fn early_of_microphones(
        &self,
        rays: &RayScene,
        source: &SoundSourcePose,
        receiver: &Receiver,
    ) -> Option<Vec<Vec<PropagationPath>>> {
        let positions = receiver.microphone_positions()?;
        let found = positions.iter().map(|position| {
            let mut paths = image_sources::find(&self.data, rays, source, *position);
            self.effects().on_paths(&mut paths);
            paths
        });
        Some(found.collect())
    }

    /// Early paths that a listener knew, where source and receiver are now: the straight way or those around what hides it, and
    /// `known` reflections that are still there.
    pub(crate) fn follow(
        &self,
        rays: &RayScene,
        source: Vec3,
        receiver: Vec3,
        known: &[PropagationPath],
    ) -> Vec<PropagationPath> {
        let mut paths = image_sources::follow(&self.data, rays, source, receiver, known);
        self.effects().on_paths(&mut paths);
        paths
    }

    /// Paths as each channel of a receiver hears them. Shape (path, channel).
    pub(crate) fn wavelets(
        &self,
        speed_m_s: f64,
        paths: &[PropagationPath],
        receiver: &Receiver,
    ) -> Vec<Vec<Wavelet>> {
        let hearing = self.hearing(receiver);
        self.synthesizer.wavelets(speed_m_s, paths, &hearing)
    }

    fn hearing<'a>(&'a self, receiver: &'a Receiver) -> HearingContext<'a> {
        HearingContext {
            receiver,
            heads: &self.heads,
            air: self.upper_air.as_deref(),
        }
    }

    /// A response without some of its echogram's `paths`, as they are followed. Shape (channel, sample), flat.
    pub(crate) fn without(
        &self,
        response: &ImpulseResponse,
        paths: &[PropagationPath],
        receiver: &Receiver,
    ) -> Vec<f32> {
        let mut samples = response.samples.clone();
        let wavelets = self.wavelets(response.echogram.speed_m_s, paths, receiver);
        self.synthesizer.subtract_wavelets(&wavelets, &mut samples);
        samples
    }

    /// The impulse response that belongs to an echogram, up to the microphones. `early`: the paths of each channel where they are
    /// not the centre's.
    pub(crate) fn arrive(
        &self,
        echogram: Echogram,
        receiver: &Receiver,
        early: Option<&[Vec<PropagationPath>]>,
        key: RandomKey,
    ) -> ImpulseResponse {
        self.arrive_with(CachedGains::default(), echogram, receiver, early, key)
    }

    /// The same response for a receiver that has turned in its place and is otherwise the same; `key` as it was.
    pub(crate) fn turn(
        &self,
        response: &ImpulseResponse,
        receiver: &Receiver,
        key: RandomKey,
    ) -> ImpulseResponse {
        let (levels, echogram) = (response.levels.clone(), response.echogram.clone());
        self.arrive_with(levels, echogram, receiver, None, key)
    }

    fn arrive_with(
        &self,
        mut levels: CachedGains,
        echogram: Echogram,
        receiver: &Receiver,
        early: Option<&[Vec<PropagationPath>]>,
        key: RandomKey,
    ) -> ImpulseResponse {
        let (hearing, key) = (self.hearing(receiver), key.child("noise"));
        let synthesizer = &self.synthesizer;
        let samples = synthesizer.render(&echogram, &hearing, early, &mut levels, key);
        ImpulseResponse {
            channels: receiver.channels(),
            rate_hz: self.config().rate_hz,
            samples,
            echogram,
            levels,
        }
    }
}

/// The key of the random arrivals from one place to another: tails of places apart have nothing in common, and nobody who
/// stands a hair elsewhere hears others.
pub(crate) fn between(key: RandomKey, source: Vec3, receiver: Vec3) -> RandomKey {
    let places = source.to_array().into_iter().chain(receiver.to_array());
    let cell = |x: f32| (f64::from(x) / CELL_M + CELL_START).floor() as i64;
    places.fold(key, |key, x| key.child(cell(x).cast_unsigned()))
}
