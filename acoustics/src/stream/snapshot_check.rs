//! Validation of a stream's snapshot. Its checksum detects damage, not its author: whatever it holds must not lead to
//! unbounded memory, endless loops or panics.

use super::early::TrackedPath;
use super::source_state::{ResponseInputs, SourceSnapshot};
use crate::directions::CELL_COUNT;
use crate::echogram::{Echogram, EnergyHistogram, PropagationPath};
use crate::response::ImpulseResponse;
use crate::scene::AcousticScene;

/// Range of the speed of sound in any air of a scene, with a margin, m/s.
const SPEEDS_M_S: (f64, f64) = (200.0, 500.0);

/// Checks the sources of a snapshot for a stream in `scene`.
///
/// # Errors
/// The violated condition, in words.
pub(super) fn check(scene: &AcousticScene, voices: &[SourceSnapshot]) -> Result<(), String> {
    if !voices.is_sorted_by(|a, b| a.id < b.id) {
        return Err("its sources are not in the order of their ids".to_owned());
    }
    voices.iter().try_for_each(|voice| {
        check_voice(scene, voice).map_err(|what| format!("source {}: {what}", voice.id))
    })
}

fn check_voice(scene: &AcousticScene, voice: &SourceSnapshot) -> Result<(), String> {
    let all = |samples: &[f32]| samples.iter().all(|x| x.is_finite());
    require(all(&voice.history), "what it played are no finite numbers")?;
    if let Some((situation, response)) = &voice.current_response {
        check_response(scene, situation, response)?;
    }
    if let Some(job) = &voice.pending_update.job {
        let checked = scene.check_receiver(&job.situation.receiver);
        checked.map_err(|error| error.to_string())?;
        require(job.situation.source.is_finite(), "its place is none")?;
        let sound = job.progress.is_valid(scene.config());
        require(sound, "the rays that were traced so far are none")?;
    }
    for TrackedPath { path, wavelets } in voice.tracked.paths.iter().flatten() {
        check_path(path)?;
        for wavelet in wavelets {
            let sound = wavelet.pre_ringing_samples <= wavelet.response.len()
                && wavelet.delay_s.is_finite()
                && wavelet.amplitude.is_finite()
                && all(&wavelet.response);
            require(sound, "the filter of an early path is none")?;
        }
    }
    Ok(())
}

fn check_response(
    scene: &AcousticScene,
    situation: &ResponseInputs,
    response: &ImpulseResponse,
) -> Result<(), String> {
    let receiver = &situation.receiver;
    let checked = scene.check_receiver(receiver);
    checked.map_err(|error| error.to_string())?;
    require(situation.source.is_finite(), "its place is none")?;
    let (found, channels) = (response.channels, receiver.channels());
    if found != channels {
        return Err(format!("{found} channels at a receiver of {channels}"));
    }
    // Samples of arrays are stored, all others follow from energies.
    let whole = response.samples.len().is_multiple_of(channels);
    let finite = response.samples.iter().all(|x| x.is_finite());
    require(whole && finite, "its response is none")?;
    check_echogram(scene, &response.echogram)
}

fn check_echogram(scene: &AcousticScene, echogram: &Echogram) -> Result<(), String> {
    let (slow, fast) = SPEEDS_M_S;
    let speed_m_s = echogram.speed_m_s;
    if !(slow..=fast).contains(&speed_m_s) {
        return Err(format!(
            "sound at {speed_m_s} m/s, allowed {slow} to {fast}"
        ));
    }
    let direct = echogram.direct_length_m;
    require(direct.is_finite() && direct >= 0.0, "its way has no length")?;
    echogram.paths.iter().try_for_each(check_path)?;
    check_tail(scene, &echogram.tail)
}

fn check_tail(scene: &AcousticScene, tail: &EnergyHistogram) -> Result<(), String> {
    let config = scene.config();
    let most = config.bin_count();
    if !tail.bins.is_empty() && (tail.bin_s != config.bin_s || tail.bins.len() > most) {
        return Err(format!(
            "a tail of {} bins of {} s, allowed {most} of {}",
            tail.bins.len(),
            tail.bin_s,
            config.bin_s
        ));
    }
    let energy = |e: f64| e.is_finite() && e >= 0.0;
    let bins = tail.bins.iter().flatten();
    let cells = tail.directions.iter().flat_map(|seen| &seen.energy);
    let sound = bins.copied().all(energy)
        && cells.flatten().all(|e| energy(f64::from(*e)))
        && tail
            .directions
            .iter()
            .all(|seen| seen.energy.len() == CELL_COUNT);
    require(sound, "its tail has energies that are none")
}

fn check_path(path: &PropagationPath) -> Result<(), String> {
    let sound = path.length_m.is_finite()
        && path.length_m >= 0.0
        && path.energy.iter().all(|e| e.is_finite() && *e >= 0.0)
        && path.arrival.is_finite();
    require(sound, "an early path has no length, energy or direction")
}

fn require(so: bool, what: &str) -> Result<(), String> {
    so.then_some(()).ok_or_else(|| what.to_owned())
}

#[cfg(test)]
mod tests {
    use super::super::source_state::TraceJob;
    use super::super::{ActiveSource, Stream, StreamConfig, StreamSnapshot};
    use super::*;
    use crate::config::AcousticConfig;
    use crate::receiver::Receiver;
    use crate::tail::TraceProgress;
    use dwell_scene::parallel::Threads;
    use dwell_scene::random::RandomKey;
    use dwell_scene::rays::RayScene;
    use dwell_scene::{House, HouseData, Pose, State};
    use glam::Vec3;
    use std::sync::Arc;
    use xxhash_rust::xxh3::xxh3_64;

    const BLOCK: usize = 800;

    /// A stream outdoors after three blocks of two sources, with a moving listener.
    fn stream() -> Stream {
        let house = Arc::new(House::new(HouseData::default()).unwrap());
        let config = AcousticConfig {
            rays: 100,
            ..AcousticConfig::rl()
        };
        let scene = AcousticScene::new(house, config).unwrap();
        let settings = StreamConfig {
            block_samples: BLOCK,
            ..StreamConfig::rl()
        };
        let mut stream = Stream::new(scene, settings, RandomKey::root(3), Threads::ONE).unwrap();
        for k in 0..3 {
            hear(&mut stream, k);
        }
        stream
    }

    /// Renders the `k`th block.
    fn hear(stream: &mut Stream, k: usize) {
        let house = stream.scene().house().clone();
        let (rays, state) = (RayScene::new(house.clone()), State::new(&house));
        let signal = [0.1; BLOCK];
        let source = |id| ActiveSource {
            id,
            position: Vec3::new(0.0, 1.0, 2.0),
            signal: &signal,
        };
        let head = Pose::from_position_yaw(Vec3::new(0.1 * k as f32, 1.0, 0.0), 0.0);
        let receiver = Receiver::binaural(head);
        let mut out = vec![0.0; 2 * BLOCK];
        let sources = [source(4), source(7)];
        stream
            .render_block(&rays, &state, &sources, &receiver, &mut out)
            .unwrap();
        assert!(out.iter().all(|x| x.is_finite()));
    }

    /// Returns the snapshot with a change, and a valid checksum.
    fn forged(stream: &Stream, change: impl FnOnce(&mut Vec<SourceSnapshot>)) -> Vec<u8> {
        let bytes = stream.snapshot();
        let mut snapshot: StreamSnapshot = postcard::from_bytes(&bytes[8..]).unwrap();
        change(&mut snapshot.voices);
        let body = postcard::to_stdvec(&snapshot).unwrap();
        let mut bytes = xxh3_64(&body).to_le_bytes().to_vec();
        bytes.extend(body);
        bytes
    }

    #[test]
    fn what_was_made_up_is_refused_and_changes_nothing() {
        type Forgery = (&'static str, fn(&mut Vec<SourceSnapshot>));
        let forgeries: [Forgery; 16] = [
            ("in the order", |voices| voices.reverse()),
            ("source 4: what it played", |voices| {
                voices[0].history[5] = f32::NAN;
            }),
            ("its place", |voices| {
                situation(voices).source.x = f32::INFINITY;
            }),
            ("the receiver", |voices| {
                situation(voices).receiver.pose.position.x = f32::NAN;
            }),
            (
                "18446744073709551615 channels at a receiver of 2",
                |voices| {
                    response(voices).channels = usize::MAX;
                },
            ),
            ("its response", |voices| response(voices).samples.push(0.0)),
            ("sound at 0 m/s", |voices| {
                response(voices).echogram.speed_m_s = 0.0;
            }),
            ("its way", |voices| {
                response(voices).echogram.direct_length_m = f64::NAN;
            }),
            ("a tail of 1 bins of 1000000000 s", |voices| {
                let tail = &mut response(voices).echogram.tail;
                (tail.bin_s, tail.bins) = (1e9, vec![[1.0; 8]]);
            }),
            ("bins of 0.00", |voices| {
                let tail = &mut response(voices).echogram.tail;
                (tail.bin_s, tail.bins) = (AcousticConfig::rl().bin_s, vec![[1.0; 8]; 100_000]);
            }),
            ("its tail has energies", |voices| {
                let tail = &mut response(voices).echogram.tail;
                (tail.bin_s, tail.bins) = (AcousticConfig::rl().bin_s, vec![[-1.0; 8]]);
            }),
            ("an early path", |voices| {
                response(voices).echogram.paths[0].length_m = f64::INFINITY;
            }),
            ("an early path", |voices| {
                followed(voices).path.length_m = -1.0;
            }),
            ("the rays that were traced so far", |voices| {
                job(voices).progress = TraceProgress::new(&AcousticConfig::rl(), 2);
            }),
            ("the rays that were traced so far", |voices| {
                job(voices).progress = TraceProgress::new(&AcousticConfig::full(), 1);
            }),
            ("the filter of an early path", |voices| {
                followed(voices).wavelets[0].pre_ringing_samples = usize::MAX;
            }),
        ];
        let mut stream = stream();
        let hash = stream.hash();
        for (words, forge) in forgeries {
            let refusal = stream.restore(&forged(&stream, forge)).unwrap_err();
            assert!(refusal.to_string().contains(words), "{refusal}");
            assert_eq!(stream.hash(), hash, "{words}");
        }
        stream.restore(&forged(&stream, |_| {})).unwrap();
        assert_eq!(stream.hash(), hash);
    }

    /// Finite lengths may be arbitrarily long: sound after the longest response is left out.
    #[test]
    fn early_paths_of_light_years_take_no_memory() {
        let mut stream = stream();
        let far = forged(&stream, |voices| {
            response(voices).echogram.paths[0].length_m = 1e300;
            followed(voices).wavelets[0].delay_s = 1e300;
        });
        stream.restore(&far).unwrap();
        let heard = &stream.voices[0].current_response.as_ref().unwrap().1;
        assert!(heard.duration_s() < 1.1 * AcousticConfig::rl().max_duration_s);
        hear(&mut stream, 3);
    }

    fn situation(voices: &mut [SourceSnapshot]) -> &mut ResponseInputs {
        &mut voices[0].current_response.as_mut().unwrap().0
    }

    fn job(voices: &mut [SourceSnapshot]) -> &mut TraceJob {
        let (situation, _) = voices[0].current_response.clone().unwrap();
        let progress = TraceProgress::new(&AcousticConfig::rl(), 1);
        let job = TraceJob {
            situation,
            progress,
        };
        voices[0].pending_update.job.insert(Box::new(job))
    }

    fn response(voices: &mut [SourceSnapshot]) -> &mut ImpulseResponse {
        &mut voices[0].current_response.as_mut().unwrap().1
    }

    fn followed(voices: &mut [SourceSnapshot]) -> &mut TrackedPath {
        &mut voices[0].tracked.paths.as_mut().unwrap()[0]
    }
}
