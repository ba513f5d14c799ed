//! The acoustic scene: the acoustic model of a house.

mod early_paths;

pub use early_paths::EarlyPath;

use crate::config::AcousticConfig;
use crate::echogram::{Echogram, PropagationPath};
use crate::error::{AcousticsError, check_finite};
use crate::head::{Head, HeadSet};
use crate::laws::{self, PathEffects, microphone_stage::StageContext};
use crate::material_report::MaterialReport;
use crate::microphone_chain::MicrophoneChain;
use crate::planes::{DiffractionEdge, Plane};
use crate::propagation_scene::PropagationScene;
use crate::receiver::{Receiver, ReceiverKind, SoundSourcePose};
use crate::response::ImpulseResponse;
use crate::synthesis::{CachedGains, PathFilter, ReceiverContext, Synthesizer, UpperAirAbsorption};
use crate::tail::LateReverberation;
use crate::{image_sources, tail};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{House, LawSpec, State};
use glam::Vec3;
use std::sync::Arc;

/// Size of the cells within which places have the same random arrivals, m.
const CELL_M: f64 = 0.1;
/// Offset of the cells: off the round numbers at which things are placed.
const CELL_START: f64 = 0.32;

/// The acoustic model of a house in the state of one world.
///
/// Data of the house (its planes) is shared by clones; data of the world (overridden materials, moved planes) is not, and
/// is small. Make one, and clone it for each world.
#[derive(Clone, Debug)]
pub struct AcousticScene {
    /// The original settings.
    stated: AcousticConfig,
    laws: Vec<LawSpec>,
    data: PropagationScene,
    synthesizer: Arc<Synthesizer>,
    heads: Arc<HeadSet>,
    /// Absorption by air above the highest band, where that can be heard.
    upper_air: Option<Arc<UpperAirAbsorption>>,
}

impl AcousticScene {
    /// A scene of `house` in its initial state.
    ///
    /// # Errors
    /// [`AcousticsError::Range`] for a setting out of range.
    pub fn new(house: Arc<House>, config: AcousticConfig) -> Result<Self, AcousticsError> {
        config.check()?;
        let data = PropagationScene::new(house, config);
        let synthesizer = Synthesizer::shared(&config);
        Ok(Self {
            upper_air: synthesizer.upper_air_absorption(&config, 1.0).map(Arc::new),
            synthesizer,
            heads: Arc::new(HeadSet::new(&config)),
            stated: config,
            laws: Vec::new(),
            data,
        })
    }

    /// Applies overridden materials, moved parts and laws; cheap when nothing changed.
    pub fn update(&mut self, state: &State) {
        if state.laws != self.laws {
            self.laws.clone_from(&state.laws);
            self.apply_laws(laws::path_effects(&self.laws));
        }
        self.data.update(state);
    }

    fn apply_laws(&mut self, effects: PathEffects) {
        let air = self.config().air;
        let absorption = self.effects().air_absorption_share();
        self.data.apply_effects(effects, &self.stated);
        let config = *self.config();
        if config.air != air {
            // Interaural delays depend on the speed of sound.
            self.heads = Arc::new(self.heads.with_speed_of_sound_of(&config));
        }
        let share = self.effects().air_absorption_share();
        if config.air != air || share != absorption {
            self.upper_air = self
                .synthesizer
                .upper_air_absorption(&config, share)
                .map(Arc::new);
        }
    }

    /// Adds a head that receivers of this scene may use ([`Receiver::with_head`]). A head that is known already costs nothing.
    pub fn add_head(&mut self, head: &Head) {
        if !self.heads.contains(head.id()) {
            Arc::make_mut(&mut self.heads).add(head);
        }
    }

    /// Returns the same scene under other effects of laws.
    pub(crate) fn with_effects(&self, effects: PathEffects) -> Self {
        let mut scene = self.clone();
        scene.apply_laws(effects);
        scene
    }

    /// Returns a receiver at the pose that the laws of microphones' poses give it.
    pub fn true_receiver(&self, receiver: &Receiver) -> Receiver {
        self.effects().true_receiver(receiver)
    }

    /// Returns laws' effects on air and sources.
    pub(crate) fn effects(&self) -> &PathEffects {
        self.data.effects()
    }

    /// Returns the data that rays, images and edges read.
    pub(crate) fn data(&self) -> &PropagationScene {
        &self.data
    }

    /// The house.
    pub fn house(&self) -> &Arc<House> {
        self.data.house()
    }

    /// Returns the settings, with the air as changed by laws.
    pub fn config(&self) -> &AcousticConfig {
        self.data.config()
    }

    /// Returns all planes at their present positions, largest of the static ones first.
    pub fn planes(&self) -> &[Plane] {
        self.data.planes()
    }

    /// Returns all diffraction edges at their present positions.
    pub fn edges(&self) -> impl Iterator<Item = &DiffractionEdge> {
        self.data.edges()
    }

    /// Returns the report of acoustic materials: areas, mean absorption, default materials.
    pub fn material_report(&self) -> MaterialReport {
        MaterialReport::new(&self.data)
    }

    /// Checks that source and receiver have finite positions, and that rays are of this house.
    pub(crate) fn check_trace_inputs(
        &self,
        rays: &RayScene,
        source: &SoundSourcePose,
        receivers: &[Vec3],
    ) -> Result<(), AcousticsError> {
        source.check()?;
        for receiver in receivers {
            check_finite("the receiver", *receiver)?;
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

    /// Returns the energies at `receiver` from `source`: exact early paths and the traced tail, without any noise.
    ///
    /// `rays` must show the house of this scene in the state last passed to [`Self::update`].
    ///
    /// # Errors
    /// [`AcousticsError::Position`] for a point that is not finite, [`AcousticsError::OtherHouse`].
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
        self.check_trace_inputs(rays, source, receivers)?;
        Ok(
            self.echograms_with_ray_count(
                rays,
                source,
                receivers,
                self.config().rays,
                key,
                threads,
            ),
        )
    }

    /// As [`Self::echograms`] with this many rays.
    pub(crate) fn echograms_with_ray_count(
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
            image_sources::find_specular_paths(&self.data, rays, source, receivers[k])
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
        both.map(|((paths, late), receiver)| {
            self.join_paths_and_tail(paths, late, position, *receiver)
        })
        .collect()
    }

    /// Returns the echogram of early paths and a tail.
    pub(crate) fn join_paths_and_tail(
        &self,
        paths: Vec<PropagationPath>,
        late: LateReverberation,
        source: Vec3,
        receiver: Vec3,
    ) -> Echogram {
        let mut echogram = Echogram {
            paths,
            tail: late.histogram,
            ray_statistics: late.statistics,
            source,
            direct_length_m: source.as_dvec3().distance(receiver.as_dvec3()),
            speed_m_s: self.config().air.speed_of_sound_m_s(),
        };
        self.effects().apply_to_echogram(&mut echogram);
        echogram
    }

    /// Returns the impulse response from `source` to `receiver`, under the laws of the state last passed to
    /// [`Self::update`].
    ///
    /// A microphone law without an impulse response (clipping, automatic gain, noise, clocks) is applied as to a recording
    /// of the impulse.
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
        let placed: Vec<Receiver> = receivers
            .iter()
            .map(|r| self.effects().true_receiver(r))
            .collect();
        let noise = |receiver: &Receiver| arrival_key(key, source.position(), receiver.position());
        let arrived =
            self.responses_before_microphones(rays, source, &placed, key, noise, threads)?;
        let both = arrived.into_iter().zip(&placed);
        Ok(both
            .map(|(response, receiver)| self.apply_microphone_laws(response, receiver, key))
            .collect())
    }

    /// Returns the impulse response of an echogram: rotating the head needs no new rays. Microphone laws act as in
    /// [`Self::impulse_response`].
    ///
    /// With the key of [`Self::impulse_response`] it has the same random arrivals. The microphones of an array receive the
    /// centre's early paths as plane waves here. A head that is unknown to the scene is replaced by the built-in one.
    pub fn impulse_response_from_echogram(
        &self,
        echogram: Echogram,
        receiver: &Receiver,
        key: RandomKey,
    ) -> ImpulseResponse {
        let receiver = &self.effects().true_receiver(receiver);
        let noise = arrival_key(key, echogram.source, receiver.position());
        self.apply_microphone_laws(
            self.response_before_microphones(echogram, receiver, None, noise),
            receiver,
            key,
        )
    }

    /// Returns a response after the microphone laws.
    fn apply_microphone_laws(
        &self,
        response: ImpulseResponse,
        receiver: &Receiver,
        key: RandomKey,
    ) -> ImpulseResponse {
        let own = key.child("microphone").child(0);
        let listener = self.stage_context(receiver, key.child("room"), own);
        let rate_hz = f64::from(self.config().rate_hz);
        ImpulseResponse {
            samples: MicrophoneChain::record_until_silent(
                &self.laws,
                rate_hz,
                &listener,
                response.samples,
            ),
            ..response
        }
    }

    /// Returns the context of a receiver; `room` and `own` as in [`StageContext`].
    pub(crate) fn stage_context<'a>(
        &'a self,
        receiver: &'a Receiver,
        room: RandomKey,
        own: RandomKey,
    ) -> StageContext<'a> {
        StageContext {
            receiver,
            heads: &self.heads,
            speed_m_s: self.config().air.speed_of_sound_m_s(),
            room_key: room,
            microphone_key: own,
        }
    }

    /// Checks that a receiver is in range, and its head known.
    pub(crate) fn check_receiver(&self, receiver: &Receiver) -> Result<(), AcousticsError> {
        receiver.check()?;
        match receiver.kind {
            ReceiverKind::Head(id) if !self.heads.contains(id) => {
                Err(AcousticsError::UnknownHead { id: id.0 })
            }
            _ => Ok(()),
        }
    }

    /// Returns the impulse responses before microphone laws; `noise` keys the random arrivals at a receiver. Shape
    /// (receiver,).
    pub(crate) fn responses_before_microphones(
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
            let early = self.early_paths_per_microphone(rays, source, receiver);
            let echogram = echograms[k].clone();
            self.response_before_microphones(echogram, receiver, early.as_deref(), noise(receiver))
        }))
    }

    /// Returns the early paths of each microphone of an array; `None` where the centre's are used.
    pub(crate) fn early_paths_per_microphone(
        &self,
        rays: &RayScene,
        source: &SoundSourcePose,
        receiver: &Receiver,
    ) -> Option<Vec<Vec<PropagationPath>>> {
        let positions = receiver.microphone_positions()?;
        let found = positions.iter().map(|position| {
            let mut paths = image_sources::find_specular_paths(&self.data, rays, source, *position);
            self.effects().apply_to_paths(&mut paths);
            paths
        });
        Some(found.collect())
    }

    /// Returns early paths at the present positions of source and receiver: the direct path or diffracted ones, and the
    /// `known` reflections that still exist.
    pub(crate) fn updated_early_paths(
        &self,
        rays: &RayScene,
        source: Vec3,
        receiver: Vec3,
        known: &[PropagationPath],
    ) -> Vec<PropagationPath> {
        let mut paths = image_sources::revalidate_paths(&self.data, rays, source, receiver, known);
        self.effects().apply_to_paths(&mut paths);
        paths
    }

    /// Returns the filters of paths at each channel of a receiver. Shape (path, channel).
    pub(crate) fn path_filters(
        &self,
        speed_m_s: f64,
        paths: &[PropagationPath],
        receiver: &Receiver,
    ) -> Vec<Vec<PathFilter>> {
        let hearing = self.receiver_context(receiver);
        self.synthesizer.path_filters(speed_m_s, paths, &hearing)
    }

    fn receiver_context<'a>(&'a self, receiver: &'a Receiver) -> ReceiverContext<'a> {
        ReceiverContext {
            receiver,
            heads: &self.heads,
            upper_air: self.upper_air.as_deref(),
        }
    }

    /// Returns a response without some of its echogram's `paths`, as tracked. Shape (channel, sample), flat.
    pub(crate) fn response_without_paths(
        &self,
        response: &ImpulseResponse,
        paths: &[PropagationPath],
        receiver: &Receiver,
    ) -> Vec<f32> {
        let mut samples = response.samples.clone();
        let wavelets = self.path_filters(response.echogram.speed_m_s, paths, receiver);
        self.synthesizer
            .subtract_path_filters(&wavelets, &mut samples);
        samples
    }

    /// Returns the impulse response of an echogram, before microphone laws. `early`: the paths of each channel where they
    /// are not the centre's.
    pub(crate) fn response_before_microphones(
        &self,
        echogram: Echogram,
        receiver: &Receiver,
        early: Option<&[Vec<PropagationPath>]>,
        key: RandomKey,
    ) -> ImpulseResponse {
        self.render_response(CachedGains::default(), echogram, receiver, early, key)
    }

    /// Returns the same response for a receiver that has rotated in place; `key` as before.
    pub(crate) fn rotated_response(
        &self,
        response: &ImpulseResponse,
        receiver: &Receiver,
        key: RandomKey,
    ) -> ImpulseResponse {
        let (levels, echogram) = (response.noise_gains.clone(), response.echogram.clone());
        self.render_response(levels, echogram, receiver, None, key)
    }

    fn render_response(
        &self,
        mut levels: CachedGains,
        echogram: Echogram,
        receiver: &Receiver,
        early: Option<&[Vec<PropagationPath>]>,
        key: RandomKey,
    ) -> ImpulseResponse {
        let (hearing, key) = (self.receiver_context(receiver), key.child("noise"));
        let synthesizer = &self.synthesizer;
        let samples = synthesizer.render(&echogram, &hearing, early, &mut levels, key);
        ImpulseResponse {
            channels: receiver.channels(),
            rate_hz: self.config().rate_hz,
            samples,
            echogram,
            noise_gains: levels,
        }
    }
}

/// Returns the key of the random arrivals from one place to another: tails of separate places are uncorrelated, and tiny
/// displacements do not change them.
pub(crate) fn arrival_key(key: RandomKey, source: Vec3, receiver: Vec3) -> RandomKey {
    let places = source.to_array().into_iter().chain(receiver.to_array());
    let cell = |x: f32| (f64::from(x) / CELL_M + CELL_START).floor() as i64;
    places.fold(key, |key, x| key.child(cell(x).cast_unsigned()))
}
