//! Laws of sound act alike in streams and in impulse responses, without clicks, and are in snapshots.

#![allow(clippy::unwrap_used, reason = "tests may stop at the first surprise")]

use crate::common;

use common::{Hall, dry, law, material};
use dwell_acoustics::{
    AcousticConfig, ActiveSource, Receiver, SoundSourcePose, Stream, StreamConfig, laws,
};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{LawSpec, Pose, State};
use glam::Vec3;

const BLOCK: usize = 800;
const SOURCE: Vec3 = Vec3::new(1.2, 1.5, 1.4);
/// The number of the source that sounds.
const ID: u64 = 5;

/// Every law with parameters at which it is clearly audible.
fn each() -> Vec<LawSpec> {
    let response = [("db_250", -6.0), ("db_2000", 4.0), ("db_4000", -9.0)];
    let every = vec![
        law("temperature_error", &[("offset_k", 12.0)]),
        law("humidity_error", &[("offset_pct", -40.0)]),
        law("no_air_absorption", &[("missing", 1.0)]),
        law("source_gain", &[("gain_db", -3.0)]),
        law("source_response", &response),
        law(
            "source_directivity_error",
            &[("yaw_deg", 40.0), ("beam_db", 9.0)],
        ),
        law("microphone_position_error", &[("right_m", 0.12)]),
        law("microphone_orientation_error", &[("yaw_deg", -25.0)]),
        law("background_noise", &[("level_pa", 0.01), ("hum_pa", 0.003)]),
        law("microphone_gain", &[("gain_db", 5.0)]),
        law("microphone_response", &response),
        law("microphone_noise", &[("sigma_pa", 0.01)]),
        law("microphone_clipping", &[("limit_pa", 0.05)]),
        law("automatic_gain", &[("strength", 0.7), ("release_s", 0.1)]),
        law("recording_delay", &[("delay_s", 0.0831)]),
        law("clock_drift", &[("drift_ppm", 1500.0), ("offset_s", 0.02)]),
    ];
    assert!(
        laws::all()
            .map(|law| law.id)
            .eq(every.iter().map(|law| law.id.as_str()))
    );
    every
}

/// Returns whether a law has an impulse response: it depends on neither level nor clock, and adds nothing.
fn has_response(law: &LawSpec) -> bool {
    let others = [
        "background_noise",
        "microphone_noise",
        "microphone_clipping",
        "automatic_gain",
        "clock_drift",
    ];
    !others.contains(&law.id.as_str())
}

fn room() -> Hall {
    let config = AcousticConfig {
        max_duration_s: 0.4,
        air_absorption: true,
        image_order: 2,
        ..dry(200)
    };
    Hall::shoebox([6.0, 3.0, 5.0], &material(0.3, 0.5), config)
}

fn head() -> Receiver {
    Receiver::binaural(Pose::from_position_yaw(Vec3::new(4.6, 1.2, 3.3), 0.7))
}

fn stream(hall: &Hall) -> Stream {
    let key = RandomKey::root(8);
    let stream = Stream::new(hall.scene.clone(), StreamConfig::full(), key, Threads::ONE).unwrap();
    // The place in which the offline responses are computed.
    stream.with_room_key(key.child("source").child(ID).child("room"))
}

fn noise(samples: usize) -> Vec<f32> {
    let mut stream = RandomKey::root(77).stream();
    (0..samples).map(|_| 0.3 * stream.normal() as f32).collect()
}

/// Plays `signal`; `laws(block)` are those installed. Shape (channel, sample).
fn play(
    hall: &Hall,
    stream: &mut Stream,
    signal: &[f32],
    laws: impl Fn(usize) -> Vec<LawSpec>,
) -> [Vec<f32>; 2] {
    let mut state = State::new(&hall.house);
    let mut heard = [Vec::new(), Vec::new()];
    for (k, block) in signal.chunks_exact(BLOCK).enumerate() {
        state.laws = laws(k);
        let source = ActiveSource {
            id: ID,
            position: SOURCE,
            signal: block,
        };
        let mut out = vec![0.0; 2 * BLOCK];
        stream
            .render_block(&hall.rays, &state, &[source], &head(), &mut out)
            .unwrap();
        for (all, channel) in heard.iter_mut().zip(out.chunks_exact(BLOCK)) {
            all.extend_from_slice(channel);
        }
    }
    heard
}

/// Returns the response that [`Stream`] convolves with, computed offline under the laws. Shape (channel, sample).
fn response(hall: &Hall, laws: &[LawSpec]) -> [Vec<f32>; 2] {
    let mut scene = hall.scene.clone();
    let mut state = State::new(&hall.house);
    state.laws = laws.to_vec();
    scene.update(&state);
    let key = RandomKey::root(8).child("source").child(ID);
    let (source, threads) = (SoundSourcePose::omni(SOURCE), Threads::ONE);
    let response = scene
        .impulse_response(&hall.rays, &source, &head(), key, threads)
        .unwrap();
    [0, 1].map(|channel| response.channel(channel).to_vec())
}

/// Sample `n` of the convolution.
fn convolved(h: &[f32], x: &[f32], n: usize) -> f64 {
    let taps = h.iter().enumerate().take(n + 1);
    taps.map(|(k, h)| f64::from(*h) * f64::from(*x.get(n - k).unwrap_or(&0.0)))
        .sum()
}

/// Laws that have an impulse response: the offline one, convolved with a signal, is what the stream gives.
#[test]
fn a_stream_is_the_convolution_with_the_response_under_the_same_law() {
    let hall = room();
    let signal = noise(10 * BLOCK);
    let plain = response(&hall, &[]);
    for law in each().into_iter().filter(has_response) {
        let installed = std::slice::from_ref(&law);
        let h = response(&hall, installed);
        let heard = play(&hall, &mut stream(&hall), &signal, |_| installed.to_vec());
        let mut differs = 0.0_f64;
        for (h, (heard, plain)) in h.iter().zip(heard.iter().zip(&plain)) {
            let peak = f64::from(heard.iter().fold(0.0_f32, |peak, x| peak.max(x.abs())));
            for n in (0..heard.len()).step_by(37) {
                let wanted = convolved(h, &signal, n);
                let found = f64::from(heard[n]);
                let at = format!("{} {n}: {found} {wanted}", law.id);
                assert!((found - wanted).abs() < 1e-5 * peak, "{at}");
                differs = differs.max((wanted - convolved(plain, &signal, n)).abs() / peak);
            }
        }
        assert!(differs > 1e-2, "{} is not heard: {differs}", law.id);
    }
}

/// An impulse through the stream is the offline response in every sample, for every law but self-noise, which is drawn anew in
/// every block.
#[test]
fn an_impulse_in_a_stream_is_the_response() {
    let hall = room();
    let mut impulse = vec![0.0; 12 * BLOCK];
    impulse[0] = 1.0;
    for law in each()
        .into_iter()
        .filter(|law| law.id != "microphone_noise")
    {
        let installed = std::slice::from_ref(&law);
        let h = response(&hall, installed);
        let heard = play(&hall, &mut stream(&hall), &impulse, |_| installed.to_vec());
        for (h, heard) in h.iter().zip(&heard) {
            assert!(h.len() > 2 * BLOCK && h.len() < heard.len());
            let peak = h.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
            // Noise of the place goes on when the response is over.
            let goes_on = law.id == "background_noise";
            let until = if goes_on { h.len() } else { heard.len() };
            for (n, y) in heard[..until].iter().enumerate() {
                let wanted = h.get(n).copied().unwrap_or(0.0);
                let at = format!("{} {n}: {y} {wanted}", law.id);
                assert!((y - wanted).abs() < 1e-5 * peak.max(0.01), "{at}");
            }
        }
    }
}

/// Not installed, or installed at its default: the same bits, in streams and responses.
#[test]
fn a_law_at_its_default_changes_no_bit() {
    let hall = room();
    let signal = noise(4 * BLOCK);
    let defaults: Vec<LawSpec> = laws::all().map(|info| info.spec(&[])).collect();
    let plain = play(&hall, &mut stream(&hall), &signal, |_| Vec::new());
    let with = play(&hall, &mut stream(&hall), &signal, |_| defaults.clone());
    assert_eq!(plain, with);
    assert_eq!(response(&hall, &[]), response(&hall, &defaults));
}

/// All laws at once, installed during sound, and a snapshot of their state: the restored stream goes on bit for bit.
#[test]
fn a_restored_stream_goes_on_bit_for_bit_under_all_laws() {
    let hall = room();
    let signal = noise(10 * BLOCK);
    let laws = |k: usize| if k < 2 { Vec::new() } else { each() };
    let mut first = stream(&hall);
    play(&hall, &mut first, &signal[..5 * BLOCK], laws);
    let bytes = first.snapshot();
    let mut second = stream(&hall);
    second.restore(&bytes).unwrap();
    assert_eq!(first.hash(), second.hash());
    let on = |stream: &mut Stream| play(&hall, stream, &signal[5 * BLOCK..], |_| each());
    let heard = on(&mut first);
    assert_eq!(heard, on(&mut second));
    assert_eq!(first.hash(), second.hash());
    // After a reset it is as new.
    first.reset();
    let again = play(&hall, &mut first, &signal, |_| each());
    assert_eq!(again, play(&hall, &mut stream(&hall), &signal, |_| each()));
}

/// A law that comes, changes and goes amid a tone: no sample leaves the course of the tone by more than a crossfade does.
#[test]
fn laws_come_change_and_go_without_clicks() {
    let hall = room();
    let omega = std::f64::consts::TAU * 440.0 / 16_000.0;
    let tone: Vec<f32> = (0..24 * BLOCK)
        .map(|k| (omega * k as f64).sin() as f32)
        .collect();
    // Noise follows no course, and what is clipped is no sine.
    let tonal = |law: &LawSpec| !law.id.ends_with("_noise") && law.id != "microphone_clipping";
    for law in each().into_iter().filter(tonal) {
        let mut less = law.clone();
        for value in less.params.values_mut() {
            *value *= 0.6;
        }
        let installed = |k: usize| match k {
            8..14 => vec![law.clone()],
            14..18 => vec![less.clone()],
            _ => Vec::new(),
        };
        for heard in play(&hall, &mut stream(&hall), &tone, installed) {
            let peak = heard.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
            // A sine follows x[n] = 2 cos(omega) x[n-1] - x[n-2], and a step does not.
            for n in 6 * BLOCK..heard.len() {
                let [a, b, c] = [heard[n], heard[n - 1], heard[n - 2]].map(f64::from);
                let residual = a - 2.0 * omega.cos() * b + c;
                let at = format!("{} sample {} of block {}", law.id, n % BLOCK, n / BLOCK);
                assert!(residual.abs() < 3e-3 * f64::from(peak), "{at}: {residual}");
            }
        }
    }
}
