//! What is understood of what others say.
//!
//! A token is understood with a probability that the speech transmission index gives, of the levels of its voice and of everything else
//! that sounds meanwhile, by octave at the middle of the listener's head, and of the room's response. It is heard when its
//! last sound has arrived.

use super::WorldSound;
use super::ears::AgentListener;
use crate::listener::Listener;
use dwell_acoustics::bands::BAND_COUNT;
use dwell_acoustics::intelligibility::ModulationTransfer;
use dwell_acoustics::utterance::SPEECH_BAND_COUNT;
use dwell_acoustics::{Echogram, intelligibility};
use dwell_scene::random::RandomKey;
use dwell_scene::units::{db_spl_from_pa, pa_from_db_spl};
use dwell_scene::{AgentId, State};
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Speech below this in every octave is not noticed at all, dB SPL.
const UNNOTICED_DB: f64 = 0.0;

/// A word of somebody else that has arrived.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeardToken {
    /// Who said it, which no sensor tells.
    pub speaker: AgentId,
    /// The number of the word, as it was understood; `None`: that something was said was heard, but not what.
    pub token: Option<u32>,
    /// Towards the first sound that arrived, in the space of the listener's head (X right, Y up, -Z ahead), unit length; zero where
    /// only the room's tail arrives.
    pub direction: Vec3,
    /// Level at the middle of the head while it was said, dB SPL.
    pub level_db: f32,
    /// The speech transmission index, 0 to 1.
    pub sti: f32,
}

/// Energies of a token and of all other sounds at a listener so far, Pa² times samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct TokenEnergies {
    speech: [f64; SPEECH_BAND_COUNT],
    noise: [f64; SPEECH_BAND_COUNT],
    samples: u64,
}

/// A token on its way to a listener.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct ArrivingToken {
    /// The sample since the world's start at which its last sound arrives.
    arrives: u64,
    listener: AgentId,
    heard: HeardToken,
}

/// What the listeners of a world have heard of the utterances under way.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Hearing {
    /// By listener, utterance and place of its token.
    energies: BTreeMap<(AgentId, u64, u32), TokenEnergies>,
    arriving: Vec<ArrivingToken>,
    /// What arrived in the last block, by listener.
    heard: Vec<(AgentId, HeardToken)>,
}

impl Hearing {
    /// Returns whether nothing is under way and nothing has arrived.
    pub(super) fn is_idle(&self) -> bool {
        self.energies.is_empty() && self.arriving.is_empty() && self.heard.is_empty()
    }

    /// What an agent heard in the last block, the loudest first.
    pub(super) fn heard_by(&self, agent: AgentId) -> Vec<&HeardToken> {
        let own = self.heard.iter().filter(|(listener, _)| *listener == agent);
        let mut found: Vec<&HeardToken> = own.map(|(_, token)| token).collect();
        found.sort_by(|a, b| b.level_db.total_cmp(&a.level_db));
        found
    }

    /// Gives what has arrived up to sample `end`.
    fn deliver(&mut self, end: u64) {
        let (now, later) = std::mem::take(&mut self.arriving)
            .into_iter()
            .partition(|token: &ArrivingToken| token.arrives <= end);
        self.arriving = later;
        self.heard = now
            .into_iter()
            .map(|token: ArrivingToken| (token.listener, token.heard))
            .collect();
    }
}

/// A source's energy in a block at 1 m in the free field, by octave of speech, as [`TokenEnergies`] has it.
type SourceEnergies = BTreeMap<u64, [f64; SPEECH_BAND_COUNT]>;

/// Returns the octaves of speech, which are all but the lowest.
fn speech_bands(energies: &[f64; BAND_COUNT]) -> [f64; SPEECH_BAND_COUNT] {
    std::array::from_fn(|band| energies[band + BAND_COUNT - SPEECH_BAND_COUNT])
}

impl WorldSound {
    /// Hears the block that has just been rendered. `key`: of the world's sounds.
    pub(super) fn hear(&mut self, state: &State, block: &[super::BlockSource], key: RandomKey) {
        let begin = self.blocks * self.block as u64;
        let end = begin + self.block as u64;
        if self.spoken.iter().any(|own| own.start < end) {
            let energies = block.iter().map(|one| (one.id, self.octave_energies(one)));
            let energies: SourceEnergies = energies.collect();
            let mut hearing = std::mem::take(&mut self.hearing);
            let ears = self.ears.iter();
            for ears in ears.filter(|own| own.listener == Listener::ears(own.listener.agent)) {
                self.hear_at(&mut hearing, ears, state, (&energies, begin, key));
            }
            self.hearing = hearing;
        }
        self.hearing.deliver(end);
    }

    /// Returns the energy of a block of a source at 1 m; none where its signal is none that has levels.
    fn octave_energies(&self, block: &super::BlockSource) -> [f64; SPEECH_BAND_COUNT] {
        let levels_db = intelligibility::octave_levels_db(&block.signal, self.rate_hz);
        let samples = block.signal.len() as f64;
        levels_db.map_or([0.0; SPEECH_BAND_COUNT], |levels| {
            levels.map(|db| samples * f64::from(pa_from_db_spl(db as f32)).powi(2))
        })
    }

    fn hear_at(
        &self,
        hearing: &mut Hearing,
        ears: &AgentListener,
        state: &State,
        (energies, begin, key): (&SourceEnergies, u64, RandomKey),
    ) {
        let agent = ears.listener.agent;
        let Some(listener) = state.agents.get(agent) else {
            return;
        };
        let echograms: BTreeMap<u64, Echogram> = ears.stream.echograms().collect();
        let received = |id: &u64| {
            let (own, echogram) = (energies.get(id)?, echograms.get(id)?);
            let gain = speech_bands(&echogram.total());
            Some(std::array::from_fn::<f64, SPEECH_BAND_COUNT, _>(|band| {
                own[band] * gain[band]
            }))
        };
        let mut all = [0.0; SPEECH_BAND_COUNT];
        for own in energies.keys().filter_map(received) {
            for (sum, energy) in all.iter_mut().zip(own) {
                *sum += energy;
            }
        }
        let end = begin + self.block as u64;
        let others = self.spoken.iter().filter(|own| own.spoken.agent != agent);
        for own in others {
            let id = own.spoken.id();
            let speech = received(&id).unwrap_or_default();
            let since = own.start;
            // A block in which one token ends and the next begins counts for both.
            for (place, token_end) in own.token_ends.iter().enumerate() {
                let token_begin = place
                    .checked_sub(1)
                    .map_or(0, |before| own.token_ends[before]);
                if since + token_begin >= end || since + token_end <= begin {
                    continue;
                }
                let at = (agent, id, place as u32);
                let sum = hearing.energies.entry(at).or_default();
                for band in 0..SPEECH_BAND_COUNT {
                    sum.speech[band] += speech[band];
                    sum.noise[band] += (all[band] - speech[band]).max(0.0);
                }
                sum.samples += self.block as u64;
                if since + token_end > end {
                    continue;
                }
                let sums = hearing.energies.remove(&at).unwrap_or_default();
                let Some(echogram) = echograms.get(&id) else {
                    continue;
                };
                let own_key = key.child("hearing").child(u64::from(agent.0));
                let own_key = own_key.child(id).child(place as u64);
                let token = own.spoken.utterance.tokens[place];
                let Some(mut heard) = understand(&sums, echogram, token, own_key) else {
                    continue;
                };
                heard.speaker = own.spoken.agent;
                let first = echogram.paths.first();
                let world_from_head = listener.world_from_head();
                heard.direction = first.map_or(Vec3::ZERO, |path| {
                    world_from_head.inverse().transform_vector(path.arrival)
                });
                let way_m = first.map_or(echogram.direct_length_m, |path| path.length_m);
                let delay = (way_m / echogram.speed_m_s * f64::from(self.rate_hz)).round();
                hearing.arriving.push(ArrivingToken {
                    arrives: since + token_end + delay as u64,
                    listener: agent,
                    heard,
                });
            }
        }
    }
}

/// Returns what is understood of a token; `None` where nobody notices it. Speaker and direction are left open.
fn understand(
    sums: &TokenEnergies,
    echogram: &Echogram,
    token: u32,
    key: RandomKey,
) -> Option<HeardToken> {
    let samples = sums.samples.max(1) as f64;
    let level_db = |energy: &f64| f64::from(db_spl_from_pa((energy / samples).sqrt() as f32));
    let speech_db = sums.speech.each_ref().map(level_db);
    let noise_db = sums.noise.each_ref().map(level_db);
    if speech_db.iter().all(|level| *level < UNNOTICED_DB) {
        return None;
    }
    let transfer = ModulationTransfer::of_echogram(echogram);
    let transmission =
        intelligibility::speech_transmission_index(&speech_db, &noise_db, &transfer).ok()?;
    let sti = transmission.sti;
    // Number 0 is no word.
    let words = dwell_semantics::vocabulary::size() as u32 - 1;
    let probability = intelligibility::token_recognition_probability(sti, words).ok()?;
    let word = token.checked_sub(1)?;
    let heard = intelligibility::hear_tokens(&[word], probability, words, key).ok()?;
    let token = heard.first().copied().flatten().map(|word| word + 1);
    Some(HeardToken {
        speaker: AgentId(0),
        token,
        direction: Vec3::ZERO,
        level_db: level_db(&sums.speech.iter().sum()) as f32,
        sti: sti as f32,
    })
}
