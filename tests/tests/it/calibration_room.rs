//! A wrong absorption hidden in impulse responses by an independent image-source code, and the verdicts it must get.

#![expect(
    clippy::unwrap_used,
    reason = "a test stops at the first surprise, in its helpers too"
)]

use crate::calibration_support;

use calibration_support::{Files, Random, table};
use dwell_calibration::{CalibrationReport, CalibrationVerdict, Options, calibrate};
use std::fmt::Write as _;
use std::path::Path;

const SIZE: [f64; 3] = [5.2, 2.7, 4.1];
const RATE_HZ: u32 = 16_000;
const DURATION_S: f64 = 0.25;
const SIDES: [&str; 6] = ["west", "east", "floor", "ceiling", "north", "south"];
/// The absorption that the manifest states, in the order of `SIDES`.
const STATED: [f64; 6] = [0.12, 0.1, 0.2, 0.15, 0.08, 0.12];
const POSITIONS: usize = 12;

/// An impulse response of a box by its image sources, with reflections that keep sqrt(1 - absorption) of the pressure.
///
/// J. B. Allen, D. A. Berkley, JASA 65, 943 (1979).
fn images(
    source: [f64; 3],
    receiver: [f64; 3],
    absorption: [f64; 6],
    random: &mut Random,
) -> Vec<f32> {
    let speed = 343.2;
    let mut response = vec![0.0_f64; (DURATION_S * f64::from(RATE_HZ)) as usize];
    let order = SIZE.map(|edge| (DURATION_S * speed / edge / 2.0).ceil() as i64 + 1);
    // Along each axis: position of the image, and how often it met the lower and the upper side.
    let axis = |k: usize| {
        let mut all = Vec::new();
        for n in -order[k]..=order[k] {
            for mirrored in [false, true] {
                let at = 2.0 * n as f64 * SIZE[k] + if mirrored { -source[k] } else { source[k] };
                let lower = (n - i64::from(mirrored)).unsigned_abs();
                all.push((at - receiver[k], lower, n.unsigned_abs()));
            }
        }
        all
    };
    let (xs, ys, zs) = (axis(0), axis(1), axis(2));
    let kept = absorption.map(|a| (1.0 - a).sqrt());
    let power = |base: f64, exponent: u64| base.powi(exponent as i32);
    for x in &xs {
        let x_gain = power(kept[0], x.1) * power(kept[1], x.2);
        for y in &ys {
            let xy_gain = x_gain * power(kept[2], y.1) * power(kept[3], y.2);
            for z in &zs {
                let distance = (x.0 * x.0 + y.0 * y.0 + z.0 * z.0).sqrt();
                let place = distance / speed * f64::from(RATE_HZ);
                let k = place.floor() as usize;
                if k + 8 >= response.len() {
                    continue;
                }
                // Reflections keep their sign at random: real walls are not flat to a fraction of a wavelength.
                let sign = if x.1 + x.2 + y.1 + y.2 + z.1 + z.2 > 0 && random.uniform() < 0.5 {
                    -1.0
                } else {
                    1.0
                };
                let gain = sign * xy_gain * power(kept[4], z.1) * power(kept[5], z.2) / distance;
                // A delay of a fraction of a sample, by a windowed sinc.
                let first = k.saturating_sub(7);
                for (j, sample) in response[first..=k + 8].iter_mut().enumerate() {
                    let t = (first + j) as f64 - place;
                    let sinc = if t.abs() < 1e-9 {
                        1.0
                    } else {
                        (std::f64::consts::PI * t).sin() / (std::f64::consts::PI * t)
                    };
                    *sample += gain * sinc * (0.5 + 0.5 * (std::f64::consts::PI * t / 8.5).cos());
                }
            }
        }
    }
    through_air(&response, speed)
        .iter()
        .map(|p| *p as f32)
        .collect()
}

/// Pure-tone attenuation at 20 degrees Celsius and 50 % humidity, (Hz, dB/m), as ISO 9613-1 prints it.
const AIR: [(f64, f64); 7] = [
    (125.0, 0.000_45),
    (250.0, 0.0013),
    (500.0, 0.0027),
    (1000.0, 0.0047),
    (2000.0, 0.0099),
    (4000.0, 0.0297),
    (8000.0, 0.105),
];

fn air_db_per_m(hz: f64) -> f64 {
    let place = |pair: &[(f64, f64)]| {
        let t = (hz / pair[0].0).ln() / (pair[1].0 / pair[0].0).ln();
        (pair[0].1.ln() + t * (pair[1].1 / pair[0].1).ln()).exp()
    };
    let pair = AIR
        .windows(2)
        .find(|pair| hz <= pair[1].0)
        .unwrap_or(&AIR[5..]);
    place(pair)
}

/// Returns what air leaves: each 10 ms of the response through a symmetric filter for the way it has come.
fn through_air(response: &[f64], speed: f64) -> Vec<f64> {
    const TAPS: usize = 33;
    let mut out = vec![0.0; response.len()];
    let rate = f64::from(RATE_HZ);
    let block = RATE_HZ as usize / 100;
    for (index, part) in response.chunks(block).enumerate() {
        let way = (index as f64 + 0.5) * block as f64 / rate * speed;
        let gains: Vec<f64> = (0..=64)
            .map(|k| {
                10.0_f64.powf(-air_db_per_m((f64::from(k) * rate / 128.0).max(20.0)) * way / 20.0)
            })
            .collect();
        for tap in 0..TAPS {
            let shift = tap as f64 - 16.0;
            // Inverse Fourier transform of a real, even response, with a Hann window.
            let sum: f64 = (1..64)
                .map(|k| 2.0 * gains[k] * (std::f64::consts::TAU * k as f64 * shift / 128.0).cos())
                .sum();
            let edge = gains[64] * (std::f64::consts::PI * shift).cos();
            let weight = (gains[0] + sum + edge) / 128.0
                * (0.5 + 0.5 * (std::f64::consts::PI * shift / 17.0).cos());
            for (k, p) in part.iter().enumerate() {
                let place = (index * block + k + tap).checked_sub(16);
                if let Some(sample) = place.and_then(|place| out.get_mut(place)) {
                    *sample += weight * p;
                }
            }
        }
    }
    out
}

fn write_wav(path: &Path, samples: &[f32]) {
    // Written by hand: RIFF with one channel of 32-bit floats.
    let bytes = (samples.len() * 4) as u32;
    let mut out = Vec::new();
    out.extend(b"RIFF");
    out.extend((36 + bytes).to_le_bytes());
    out.extend(b"WAVEfmt ");
    out.extend(16_u32.to_le_bytes());
    out.extend(3_u16.to_le_bytes());
    out.extend(1_u16.to_le_bytes());
    out.extend(RATE_HZ.to_le_bytes());
    out.extend((RATE_HZ * 4).to_le_bytes());
    out.extend(4_u16.to_le_bytes());
    out.extend(32_u16.to_le_bytes());
    out.extend(b"data");
    out.extend(bytes.to_le_bytes());
    for sample in samples {
        out.extend(sample.to_le_bytes());
    }
    std::fs::write(path, out).unwrap();
}

/// Measures a room whose sides absorb as `true_absorption` says, with a source `gain` times too loud.
fn measure(true_absorption: [f64; 6], gain: f32, seed: u64) -> CalibrationReport {
    let mut random = Random::new(seed);
    let mut surfaces = String::new();
    for (side, absorption) in SIDES.iter().zip(STATED) {
        let comma = if surfaces.is_empty() { "" } else { "," };
        write!(
            surfaces,
            r#"{comma}"{side}": {{"absorption": {{"centres_hz": [1000.0], "values": [{absorption}]}}, "scattering": 0.0}}"#
        )
        .unwrap();
    }
    let mut files = Files::new(format!(
        r#"{{"version": 1, "title": "room", "licence": "CC0-1.0", "kind": "impulse_response",
            "scene": {{"environment": {{"temperature_c": 20.0, "humidity_pct": 50.0, "pressure_pa": 101325.0}},
                       "room": {{"size_m": [{}, {}, {}], "surfaces": {{{surfaces}}}}}}}}}"#,
        SIZE[0], SIZE[1], SIZE[2]
    ));
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("ir")).unwrap();
    for position in 0..POSITIONS {
        let mut place =
            || -> [f64; 3] { std::array::from_fn(|k| random.range(0.6, SIZE[k] - 0.6)) };
        let (source, mut receiver) = (place(), place());
        while (0..3)
            .map(|k| (source[k] - receiver[k]).powi(2))
            .sum::<f64>()
            < 1.0
        {
            receiver = place();
        }
        let mut samples = images(source, receiver, true_absorption, &mut random);
        for sample in &mut samples {
            *sample = *sample * gain + 1e-5 * random.normal() as f32;
        }
        let file = format!("ir/{position}.wav");
        write_wav(&folder.path().join(&file), &samples);
        let name = format!("p{position}");
        files.episode(&name, &name);
        let [a, b, c] = source;
        let [d, e, f] = receiver;
        writeln!(files.ir, "{name},{file},{a},{b},{c},{d},{e},{f},{RATE_HZ}").unwrap();
    }
    files.write(folder.path());
    calibrate(
        folder.path(),
        &Options {
            seed,
            ..Options::default()
        },
        &mut |_, _| true,
    )
    .unwrap()
}

/// A floor and, with `DWELL_TEST_ALL=1`, a wall that absorb much more than the manifest says, one seed each.
#[test]
fn the_surface_with_another_absorption_is_named() {
    let cases = [(2_usize, 1), (1, 2)];
    let count = if dwell_tests::runs_all() { 2 } else { 1 };
    for (side, seed) in cases.into_iter().take(count) {
        let mut absorption = STATED;
        absorption[side] = 0.6;
        let report = measure(absorption, 3.0, seed);
        println!("{}: {}", SIDES[side], table(&report));
        let CalibrationVerdict::Named { law, effects, .. } = &report.verdict else {
            panic!("{}: {}", SIDES[side], table(&report));
        };
        assert_eq!(
            *law,
            format!("absorption/{}", SIDES[side]),
            "{}",
            table(&report)
        );
        for parameter in &effects[0].parameters {
            // In low bands few waves fit into a window: there the interval must hold the truth.
            let [low, high] = parameter.interval;
            let close = (parameter.value - 0.6).abs() < 0.12 || (low..=high).contains(&0.6);
            assert!(close, "{}", table(&report));
        }
        let addresses = report.found_parameters();
        assert!(
            addresses.contains_key(&format!("material/{}/absorption/1000", SIDES[side])),
            "{addresses:?}"
        );
    }
}

/// A source that is too soft and, with `DWELL_TEST_ALL=1`, one that is too loud: no name, and nothing unexplained.
#[test]
fn nothing_is_found_where_nothing_is_hidden() {
    let cases = [(11, 0.1), (12, 5.0)];
    let count = if dwell_tests::runs_all() { 2 } else { 1 };
    for (seed, gain) in cases.into_iter().take(count) {
        let report = measure(STATED, gain, seed);
        assert_eq!(
            report.verdict,
            CalibrationVerdict::NoEffect,
            "seed {seed}: {}",
            table(&report)
        );
    }
}
