//! Laws of air and sources in closed form, path by path and band by band.

#![allow(clippy::unwrap_used, reason = "tests may stop at the first surprise")]

use crate::common;

use common::{Hall, dry, law, material};
use dwell_acoustics::bands::BAND_COUNT;
use dwell_acoustics::{
    AcousticConfig, ActiveSource, Air, Directivity, Echogram, Microphone, Receiver,
    SoundSourcePose, Stream, StreamConfig,
};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{LawSpec, Pose, State};
use glam::{Quat, Vec3};

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
    let (key, threads) = (RandomKey::root(3), Threads::ONE);
    scene
        .echogram(
            &hall.rays,
            &SoundSourcePose::omni(SOURCE),
            EAR,
            key,
            threads,
        )
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

/// Dry air takes decibels a metre as ISO 9613-1 has them, and lets sound be as fast as before.
#[test]
fn dry_air_absorbs_for_every_metre() {
    let hall = hall();
    let stated = echogram(&hall, Vec::new());
    for offset_pct in [-35.0, 30.0, 80.0] {
        let other = echogram(
            &hall,
            vec![law("humidity_error", &[("offset_pct", offset_pct)])],
        );
        let air = Air {
            humidity_pct: (50.0_f64 + offset_pct).min(100.0),
            ..Air::default()
        };
        let (before, now) = (
            Air::default().energy_decay_per_m(),
            air.energy_decay_per_m(),
        );
        assert_eq!(stated.speed_m_s, other.speed_m_s);
        for (a, b) in stated.paths.iter().zip(&other.paths) {
            for band in 0..BAND_COUNT {
                let wanted = ((before[band] - now[band]) * a.length_m).exp();
                let found = f64::from(b.energy[band]) / f64::from(a.energy[band]);
                assert!(
                    (found / wanted - 1.0).abs() < 1e-5,
                    "{offset_pct} {band}: {found} {wanted}"
                );
            }
        }
    }
}

/// A2: the missing absorption is decibels a metre, more the higher the frequency, in the direct sound too.
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

/// A12: all paths change by the pattern's gain in their direction of departure, the level on the axis stays, and sources
/// with an orientation error equal sources stated with that orientation.
#[test]
fn sources_turn_and_narrow() {
    let hall = hall();
    let stated = echogram(&hall, Vec::new());
    let beam = law(
        "source_directivity_error",
        &[("beam_db", 8.0), ("yaw_deg", 70.0), ("pitch_deg", 20.0)],
    );
    let now = echogram(&hall, vec![beam.clone()]);
    let (sy, cy) = 70.0_f64.to_radians().sin_cos();
    let (sp, cp) = 20.0_f64.to_radians().sin_cos();
    let axis = [-sy * cp, sp, -cy * cp];
    for (a, b) in stated.paths.iter().zip(&now.paths) {
        let u = a.departure.as_dvec3().to_array();
        let cosine: f64 = axis.iter().zip(u).map(|(x, y)| x * y).sum();
        for band in 0..BAND_COUNT {
            let ratio = dwell_acoustics::bands::exact_centre_hz(band) / 1000.0;
            let behind_db = 8.0 * 2.0 * ratio / (1.0 + ratio);
            let wanted_db = -0.5 * (1.0 - cosine) * behind_db;
            let found_db = 10.0 * (f64::from(b.energy[band]) / f64::from(a.energy[band])).log10();
            assert!(
                (found_db - wanted_db).abs() < 0.02,
                "{found_db} {wanted_db}"
            );
        }
    }
    // Less goes into the room: late sound has the mean of the pattern's energy over all directions.
    let sum = |e: &Echogram, band: usize| {
        let first = (0.06 / e.tail.bin_s) as usize;
        let late = e.tail.bins.iter().skip(first);
        late.map(|bin| bin[band]).sum::<f64>()
    };
    let x = 16.0 * (std::f64::consts::LN_10 / 10.0) * 0.8;
    let mean_db = 10.0 * ((1.0 - (-x).exp()) / x).log10();
    let found_db = 10.0 * (sum(&now, 6) / sum(&stated, 6)).log10();
    assert!((found_db - mean_db).abs() < 1.0, "{found_db} {mean_db}");
    // A cardioid that is said to face the wall and does not, and one whose pattern is squared.
    let facing = |yaw_rad: f32, laws: Vec<LawSpec>| {
        let mut state = State::new(&hall.house);
        state.laws = laws;
        let mut scene = hall.scene.clone();
        scene.update(&state);
        let pose = Pose::from_position_yaw(SOURCE, yaw_rad);
        let source = SoundSourcePose::directional(pose, Directivity::CARDIOID);
        let (key, threads) = (RandomKey::root(3), Threads::ONE);
        scene
            .echogram(&hall.rays, &source, EAR, key, threads)
            .unwrap()
    };
    let turned = law("source_directivity_error", &[("yaw_deg", 50.0)]);
    let (a, b) = (
        facing(0.4, vec![turned]),
        facing(0.4 + 50.0_f32.to_radians(), Vec::new()),
    );
    for (a, b) in a.paths.iter().zip(&b.paths) {
        assert!((a.energy[3] / b.energy[3] - 1.0).abs() < 1e-3);
    }
    let sharp = law("source_directivity_error", &[("sharpness", 1.0)]);
    let (a, b) = (facing(0.4, vec![sharp]), facing(0.4, Vec::new()));
    for (a, b) in a.paths.iter().zip(&b.paths) {
        let plain = stated.paths.iter().find(|p| p.planes == a.planes).unwrap();
        let gain = f64::from(b.energy[3] / plain.energy[3]);
        let found = f64::from(a.energy[3] / plain.energy[3]);
        assert!((found - gain * gain).abs() < 1e-3, "{found} {gain}");
    }
}

/// A16: a microphone with a position error hears what one at that position hears, and a head with an orientation error what
/// one with that orientation does.
#[test]
fn receivers_are_where_laws_put_them() {
    let hall = hall();
    let hear = |receiver: &Receiver, laws: Vec<LawSpec>| {
        let mut state = State::new(&hall.house);
        state.laws = laws;
        let mut scene = hall.scene.clone();
        scene.update(&state);
        let (source, key) = (SoundSourcePose::omni(SOURCE), RandomKey::root(3));
        let threads = Threads::ONE;
        let heard = scene.impulse_response(&hall.rays, &source, receiver, key, threads);
        heard.unwrap().samples
    };
    let off = law(
        "microphone_position_error",
        &[("right_m", 0.25), ("up_m", -0.125), ("back_m", 0.5)],
    );
    let there = EAR + Vec3::new(0.25, -0.125, 0.5);
    let found = hear(&Receiver::omni(EAR), vec![off.clone()]);
    assert_eq!(found, hear(&Receiver::omni(there), Vec::new()));
    assert_ne!(found, hear(&Receiver::omni(EAR), Vec::new()));
    // In the head's axes: with a quarter turn to the left, its right is -Z and its back +X.
    let quarter = Pose {
        position: EAR,
        rotation: Quat::from_xyzw(0.0, 0.5_f32.sqrt(), 0.0, 0.5_f32.sqrt()),
    };
    let moved = Pose {
        position: EAR + Vec3::new(0.5, -0.125, -0.25),
        ..quarter
    };
    let (found, wanted) = (
        hear(&Receiver::binaural(quarter), vec![off]),
        hear(&Receiver::binaural(moved), Vec::new()),
    );
    let most = wanted.iter().fold(0.0_f32, |m, x| m.max(x.abs()));
    assert_eq!(found.len(), wanted.len());
    let close = |a: &[f32], b: &[f32]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 2e-3 * most);
    assert!(close(&found, &wanted));
    let turned = law("microphone_orientation_error", &[("yaw_deg", 90.0)]);
    let (found, wanted) = (
        hear(
            &Receiver::binaural(Pose::from_position(EAR)),
            vec![turned.clone()],
        ),
        hear(&Receiver::binaural(quarter), Vec::new()),
    );
    assert_eq!(found.len(), wanted.len());
    assert!(close(&found, &wanted));
    assert!(!close(
        &found,
        &hear(&Receiver::binaural(Pose::from_position(EAR)), Vec::new())
    ));
    // Nothing turns a microphone.
    let omni = Receiver::omni(EAR);
    assert_eq!(hear(&omni, vec![turned]), hear(&omni, Vec::new()));
}

/// A stream asks for new rays when air or sources change, and not when microphones do.
#[test]
fn streams_follow_changes_of_air_and_sources() {
    let hall = hall();
    let config = StreamConfig {
        start_share: 1.0,
        ..StreamConfig::rl()
    };
    let stream = Stream::new(hall.scene.clone(), config, RandomKey::root(1), Threads::ONE);
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
        let report = stream.render_block(&hall.rays, &state, &[source], &ear, &mut out);
        report.unwrap().traced_responses
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

/// The microphones of an array have early paths of their own: a source's gain reaches them as it reaches the tail.
#[test]
fn an_array_hears_the_gain_of_its_source_early_and_late() {
    let hall = hall();
    let hear = |laws: Vec<LawSpec>| {
        let mut state = State::new(&hall.house);
        state.laws = laws;
        let mut scene = hall.scene.clone();
        scene.update(&state);
        let microphones = [Vec3::X * 0.05, Vec3::X * -0.05].map(Microphone::omni);
        let array = Receiver::array(Pose::from_position(EAR), microphones.into());
        let (key, threads) = (RandomKey::root(3), Threads::ONE);
        scene
            .impulse_response(
                &hall.rays,
                &SoundSourcePose::omni(SOURCE),
                &array,
                key,
                threads,
            )
            .unwrap()
            .samples
    };
    let stated = hear(Vec::new());
    let faint = hear(vec![law("source_gain", &[("gain_db", -20.0)])]);
    assert_eq!(stated.len(), faint.len());
    let peak = stated.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
    for (stated, faint) in stated.iter().zip(&faint) {
        assert!((0.1 * stated - faint).abs() < 1e-4 * peak);
    }
}
