//! Laws of air and sources in closed form, path by path and band by band.

#![allow(clippy::unwrap_used, reason = "tests may stop at the first surprise")]

mod common;

use common::{Hall, dry, law, material};
use dwell_acoustics::bands::BAND_COUNT;
use dwell_acoustics::{
    AcousticConfig, ActiveSource, Air, Echogram, Receiver, Source, Stream, StreamConfig,
};
use dwell_scene::parallel::Threads;
use dwell_scene::random::Key;
use dwell_scene::{LawSpec, State};
use glam::Vec3;

const SOURCE: Vec3 = Vec3::new(1.2, 1.5, 1.4);
const EAR: Vec3 = Vec3::new(7.0, 1.2, 4.0);

fn hall() -> Hall {
    let config = AcousticConfig {
        max_duration_s: 0.3,
        image_order: 2,
        air_absorption: true,
        ..dry(300)
    };
    Hall::shoebox([9.0, 3.0, 6.0], &material(0.3, 0.5), config)
}

fn echogram(hall: &Hall, laws: Vec<LawSpec>) -> Echogram {
    let mut state = State::new(&hall.house);
    state.laws = laws;
    let mut scene = hall.scene.clone();
    scene.update(&state);
    let (key, threads) = (Key::root(3), Threads::ONE);
    scene
        .echogram(&hall.rays, &Source::at(SOURCE), EAR, key, threads)
        .unwrap()
}

/// A3: all arrivals stretch by c0 / c from time 0, and the air absorbs as it does at its temperature.
#[test]
fn warmth_stretches_all_arrivals_alike() {
    let hall = hall();
    let stated = echogram(&hall, Vec::new());
    for offset_k in [-15.0, 12.0] {
        let warm = echogram(
            &hall,
            vec![law("temperature_error", &[("offset_k", offset_k)])],
        );
        let air = Air {
            temperature_c: 20.0 + offset_k,
            ..Air::default()
        };
        let (before, now) = (
            Air::default().energy_decay_per_m(),
            air.energy_decay_per_m(),
        );
        let stretch = (293.15 / (293.15 + offset_k)).sqrt();
        assert!(stated.paths.len() > 10 && stated.paths.len() == warm.paths.len());
        for (a, b) in stated.paths.iter().zip(&warm.paths) {
            assert!((warm.delay_s(b) / stated.delay_s(a) / stretch - 1.0).abs() < 1e-12);
            for band in 0..BAND_COUNT {
                let wanted = (-(now[band] - before[band]) * a.length_m).exp();
                let found = f64::from(b.energy[band]) / f64::from(a.energy[band]);
                assert!(
                    (found / wanted - 1.0).abs() < 1e-5,
                    "{band}: {found} {wanted}"
                );
            }
        }
    }
}

/// A2: what is missing is decibels for every metre, more the higher the frequency, in the direct sound too.
#[test]
fn missing_air_is_decibels_for_every_metre() {
    let hall = hall();
    let stated = echogram(&hall, Vec::new());
    let per_m = Air::default().energy_decay_per_m();
    for missing in [0.4, 1.0] {
        let less = echogram(
            &hall,
            vec![law("no_air_absorption", &[("missing", missing)])],
        );
        for (a, b) in stated.paths.iter().zip(&less.paths) {
            for (band, m) in per_m.iter().enumerate() {
                let wanted = (missing * m * a.length_m).exp();
                let found = f64::from(b.energy[band]) / f64::from(a.energy[band]);
                assert!(
                    (found / wanted - 1.0).abs() < 1e-5,
                    "{band}: {found} {wanted}"
                );
            }
        }
        // A bin of the tail holds what went as far as sound goes in its time.
        let bins = stated.tail.bins.iter().zip(&less.tail.bins).enumerate();
        let heard = bins.filter(|(_, (a, _))| a[7] > 0.0);
        let mut count = 0;
        for (k, (a, b)) in heard {
            let least_m = k as f64 * stated.tail.bin_s * stated.speed_m_s;
            let most_m = least_m + stated.tail.bin_s * stated.speed_m_s;
            for (band, m) in per_m.iter().enumerate() {
                let gain = b[band] / a[band];
                let [least, most] = [least_m, most_m].map(|d| (missing * m * d).exp());
                let within = (1.0 - 1e-5) * least..(1.0 + 1e-5) * most;
                assert!(
                    within.contains(&gain),
                    "bin {k} band {band}: {gain} {within:?}"
                );
            }
            count += 1;
        }
        assert!(count > 20);
    }
}

/// A6, A7: the same decibels on every path and in every bin of the tail, together where two laws act.
#[test]
fn sources_change_direct_and_late_sound_alike() {
    let hall = hall();
    let stated = echogram(&hall, Vec::new());
    let gain = law("source_gain", &[("gain_db", -3.0)]);
    let response = law("source_response", &[("db_125", 6.0), ("db_4000", -11.0)]);
    let of_response = [0.0, 6.0, 0.0, 0.0, 0.0, 0.0, -11.0, 0.0];
    for (laws, wanted_db) in [
        (vec![gain.clone()], [-3.0; BAND_COUNT]),
        (vec![response.clone()], of_response),
        (vec![gain, response], of_response.map(|db| db - 3.0)),
    ] {
        let now = echogram(&hall, laws);
        let is_wanted = |band: usize, before: f64, now: f64| {
            let wanted = before * 10.0_f64.powf(wanted_db[band] / 10.0);
            assert!(
                (now - wanted).abs() <= 1e-5 * wanted,
                "{band}: {now} {wanted}"
            );
        };
        for band in 0..BAND_COUNT {
            for (a, b) in stated.paths.iter().zip(&now.paths) {
                is_wanted(band, a.energy[band].into(), b.energy[band].into());
            }
            for (a, b) in stated.tail.bins.iter().zip(&now.tail.bins) {
                is_wanted(band, a[band], b[band]);
            }
        }
    }
}

/// A stream asks for new rays when air or sources change, and not when microphones do.
#[test]
fn streams_follow_changes_of_air_and_sources() {
    let hall = hall();
    let config = StreamConfig::rl();
    let stream = Stream::new(hall.scene.clone(), config, Key::root(1), Threads::ONE);
    let (mut stream, mut state) = (stream.unwrap(), State::new(&hall.house));
    let signal = vec![0.1; 800];
    let mut traced = |laws: Vec<LawSpec>| {
        state.laws = laws;
        let source = ActiveSource {
            id: 1,
            position: SOURCE,
            signal: &signal,
        };
        let mut out = vec![0.0; 800];
        let ear = Receiver::omni(EAR);
        let report = stream.block(&hall.rays, &state, &[source], &ear, &mut out);
        report.unwrap().traced
    };
    let warm = law("temperature_error", &[("offset_k", 5.0)]);
    let gain = law("source_gain", &[("gain_db", 5.0)]);
    let microphone = law("microphone_gain", &[("gain_db", 5.0)]);
    assert_eq!(traced(Vec::new()), 1);
    assert_eq!(traced(vec![microphone.clone()]), 0);
    assert_eq!(traced(vec![microphone.clone(), warm.clone()]), 1);
    assert_eq!(traced(vec![warm.clone()]), 0);
    assert_eq!(traced(vec![warm, gain]), 1);
    assert_eq!(traced(Vec::new()), 1);
}
