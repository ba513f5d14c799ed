//! Impulse responses of a box by its image sources, and bundles of them. Nothing here is shared with the engines.

use super::{Files, Random};
use std::fmt::Write as _;
use std::path::Path;

pub(crate) const RATE_HZ: u32 = 16_000;
const DURATION_S: f64 = 0.25;
pub(crate) const SIDES: [&str; 6] = ["west", "east", "floor", "ceiling", "north", "south"];
/// What manifests state: lengths, and absorption in the order of [`SIDES`].
pub(crate) const STATED_SIZE: [f64; 3] = [5.2, 2.7, 4.1];
pub(crate) const STATED: [f64; 6] = [0.12, 0.1, 0.2, 0.15, 0.08, 0.12];

/// A room and a recorder as they are.
#[derive(Clone, Debug)]
pub(crate) struct Truth {
    pub(crate) absorption: [f64; 6],
    /// How far each side lies further out than stated, m, in the order of [`SIDES`].
    pub(crate) further_m: [f64; 6],
    pub(crate) speed_m_s: f64,
    /// Written times over true ones.
    pub(crate) clock: f64,
    /// Delay, s, and part of an echo in the recording chain.
    pub(crate) comb: (f64, f64),
    /// Attenuation of air, dB/m, at the frequencies of [`AIR_HZ`].
    pub(crate) air_db_per_m: [f64; 7],
    pub(crate) gain: f64,
}

impl Default for Truth {
    fn default() -> Self {
        Self {
            absorption: STATED,
            further_m: [0.0; 6],
            speed_m_s: 343.2,
            clock: 1.0,
            comb: (0.0, 0.0),
            air_db_per_m: AIR_50_PCT,
            gain: 1.0,
        }
    }
}

pub(crate) const AIR_HZ: [f64; 7] = [125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0];
/// Pure-tone attenuation at 20 degrees Celsius, dB/m, as ISO 9613-1 prints it, at 50 and at 10 % humidity.
pub(crate) const AIR_50_PCT: [f64; 7] = [0.000_45, 0.0013, 0.0027, 0.0047, 0.0099, 0.0297, 0.105];
pub(crate) const AIR_10_PCT: [f64; 7] = [0.000_78, 0.0016, 0.0043, 0.0141, 0.0453, 0.109, 0.175];

/// An impulse response of the box, with reflections that keep sqrt(1 - absorption) of the pressure.
///
/// J. B. Allen, D. A. Berkley, JASA 65, 943 (1979).
pub(crate) fn response(
    truth: &Truth,
    source: [f64; 3],
    receiver: [f64; 3],
    random: &mut Random,
) -> Vec<f32> {
    let low = [0, 2, 4].map(|side| -truth.further_m[side]);
    let edges: [f64; 3] = std::array::from_fn(|k| {
        STATED_SIZE[k] + truth.further_m[2 * k] + truth.further_m[2 * k + 1]
    });
    let (source, receiver) = (from_corner(source, low), from_corner(receiver, low));
    let rate = f64::from(RATE_HZ) * truth.clock;
    let mut response = vec![0.0_f64; (DURATION_S * f64::from(RATE_HZ)) as usize];
    let order = edges.map(|edge| (DURATION_S * truth.speed_m_s / edge / 2.0).ceil() as i64 + 1);
    // Along each axis: position of the image, and how often it met the lower and the upper side.
    let axis = |k: usize| {
        let mut all = Vec::new();
        for n in -order[k]..=order[k] {
            for mirrored in [false, true] {
                let at = 2.0 * n as f64 * edges[k] + if mirrored { -source[k] } else { source[k] };
                let lower = (n - i64::from(mirrored)).unsigned_abs();
                all.push((at - receiver[k], lower, n.unsigned_abs()));
            }
        }
        all
    };
    let (xs, ys, zs) = (axis(0), axis(1), axis(2));
    let kept = truth.absorption.map(|a| (1.0 - a).sqrt());
    let power = |base: f64, exponent: u64| base.powi(exponent as i32);
    for x in &xs {
        let x_gain = power(kept[0], x.1) * power(kept[1], x.2);
        for y in &ys {
            let xy_gain = x_gain * power(kept[2], y.1) * power(kept[3], y.2);
            for z in &zs {
                let distance = (x.0 * x.0 + y.0 * y.0 + z.0 * z.0).sqrt();
                let place = distance / truth.speed_m_s * rate;
                if place as usize + 8 >= response.len() {
                    continue;
                }
                // Reflections keep their sign at random: real walls are not flat to a fraction of a wavelength.
                let reflected = x.1 + x.2 + y.1 + y.2 + z.1 + z.2 > 0;
                let sign = if reflected && random.uniform() < 0.5 {
                    -1.0
                } else {
                    1.0
                };
                let gain = sign * xy_gain * power(kept[4], z.1) * power(kept[5], z.2) / distance;
                add_pulse(&mut response, place, gain);
            }
        }
    }
    let (delay_s, part) = truth.comb;
    if part != 0.0 {
        let late = (delay_s * rate).round() as usize;
        for k in (late..response.len()).rev() {
            response[k] += part * response[k - late];
        }
    }
    let heard = through_air(&response, truth.speed_m_s, &truth.air_db_per_m);
    heard
        .iter()
        .map(|p| (truth.gain * p + 1e-5 * random.normal()) as f32)
        .collect()
}

fn from_corner(point: [f64; 3], corner: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| point[k] - corner[k])
}

/// Adds a pulse at a fraction of a sample, by a windowed sinc.
fn add_pulse(response: &mut [f64], place: f64, gain: f64) {
    let k = place.floor() as usize;
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

fn air_db(hz: f64, db_per_m: &[f64; 7]) -> f64 {
    let k = AIR_HZ[1..6].iter().take_while(|f| **f < hz).count();
    let t = (hz / AIR_HZ[k]).ln() / (AIR_HZ[k + 1] / AIR_HZ[k]).ln();
    (db_per_m[k].ln() + t * (db_per_m[k + 1].ln() - db_per_m[k].ln())).exp()
}

/// Returns what air leaves: each 10 ms of the response through a symmetric filter for the way it has come.
fn through_air(response: &[f64], speed: f64, db_per_m: &[f64; 7]) -> Vec<f64> {
    const TAPS: usize = 33;
    let mut out = vec![0.0; response.len()];
    let rate = f64::from(RATE_HZ);
    let block = RATE_HZ as usize / 100;
    for (index, part) in response.chunks(block).enumerate() {
        let way = (index as f64 + 0.5) * block as f64 / rate * speed;
        let gains: Vec<f64> = (0..=64)
            .map(|k| {
                let hz = (f64::from(k) * rate / 128.0).max(20.0);
                10.0_f64.powf(-air_db(hz, db_per_m) * way / 20.0)
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

/// Writes the bundle of a room as it is; the manifest states what it is taken for, and the `environment`.
pub(crate) fn write(folder: &Path, truth: &Truth, positions: usize, environment: &str, seed: u64) {
    let mut random = Random::new(seed);
    let surfaces: Vec<String> = SIDES
        .iter()
        .zip(STATED)
        .map(|(side, absorption)| {
            format!(
                r#""{side}": {{"absorption": {{"centres_hz": [1000.0], "values": [{absorption}]}}, "scattering": 0.0}}"#
            )
        })
        .collect();
    let mut files = Files::new(format!(
        r#"{{"version": 1, "title": "room", "licence": "CC0-1.0", "kind": "impulse_response",
            "scene": {{"environment": {environment}, "room": {{"size_m": {STATED_SIZE:?}, "surfaces": {{{}}}}}}}}}"#,
        surfaces.join(", ")
    ));
    std::fs::create_dir(folder.join("ir")).unwrap();
    for position in 0..positions {
        let mut place =
            || -> [f64; 3] { std::array::from_fn(|k| random.range(0.6, STATED_SIZE[k] - 0.6)) };
        let (source, mut receiver) = (place(), place());
        let near =
            |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>() < 1.0;
        while near(source, receiver) {
            receiver = place();
        }
        let samples = response(truth, source, receiver, &mut random);
        let file = format!("ir/{position}.wav");
        write_wav(&folder.join(&file), &samples);
        let name = format!("p{position}");
        files.episode(&name, &name);
        let [a, b, c] = source;
        let [d, e, f] = receiver;
        writeln!(files.ir, "{name},{file},{a},{b},{c},{d},{e},{f},{RATE_HZ}").unwrap();
    }
    files.write(folder);
}
