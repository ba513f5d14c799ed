//! Sound in the free field.

#![allow(clippy::unwrap_used, reason = "tests may stop at the first surprise")]

use crate::common;

use common::{Hall, dry};
use dwell_acoustics::{AcousticConfig, Receiver, SoundSourcePose, bands};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{House, HouseData, Pose};
use glam::Vec3;

fn nowhere(config: AcousticConfig) -> Hall {
    Hall::new(House::new(HouseData::default()).unwrap(), config)
}

fn response(hall: &Hall, source: Vec3, receiver: &Receiver) -> dwell_acoustics::ImpulseResponse {
    let source = SoundSourcePose::omni(source);
    let (key, threads) = (RandomKey::root(0), Threads::ONE);
    hall.scene
        .impulse_response(&hall.rays, &source, receiver, key, threads)
        .unwrap()
}

/// Gain and delay in seconds of a response at a frequency, the phase taken near `delay_s`.
fn at_frequency(samples: &[f32], rate_hz: f64, frequency_hz: f64, delay_s: f64) -> (f64, f64) {
    let omega = std::f64::consts::TAU * frequency_hz;
    let (mut re, mut im) = (0.0, 0.0);
    for (k, x) in samples.iter().enumerate() {
        let phase = omega * (k as f64 / rate_hz - delay_s);
        re += f64::from(*x) * phase.cos();
        im -= f64::from(*x) * phase.sin();
    }
    (re.hypot(im), delay_s - im.atan2(re) / omega)
}

/// V1: 1/d within 0.1 dB and the delay within a sample at any distance; far beyond that from a metre on.
#[test]
fn level_falls_as_one_over_distance_and_delay_grows_with_it() {
    for rate_hz in [16_000_u32, 48_000] {
        let hall = nowhere(AcousticConfig {
            rate_hz,
            max_duration_s: 3.0,
            ..dry(0)
        });
        let rate = f64::from(rate_hz);
        for distance in [0.1_f32, 0.17, 0.3, 0.7, 1.0, 2.0, 5.0, 10.0, 33.3, 300.0] {
            let source = Vec3::new(3.0, 1.5, -2.0);
            let direction = Vec3::new(0.48, 0.6, -0.64);
            let ear = Receiver::omni(source + direction * distance);
            let heard = response(&hall, source, &ear);
            let d = f64::from(source.distance(ear.position()));
            for frequency_hz in [125.0, 1000.0] {
                let (gain, delay_s) = at_frequency(heard.channel(0), rate, frequency_hz, d / 343.2);
                let (error_db, error_s) = (20.0 * (gain * d).log10(), delay_s - d / 343.2);
                assert!(
                    error_db.abs() < 0.1,
                    "{d} m {frequency_hz} Hz: {error_db} dB"
                );
                assert!(error_s.abs() * rate < 1.0, "{d} m: {error_s} s");
                if d >= 1.0 {
                    assert!(
                        (gain * d - 1.0).abs() < 1e-4 && error_s.abs() < 1e-6,
                        "{d} m"
                    );
                }
            }
        }
    }
}

#[test]
fn air_takes_what_iso_9613_says() {
    let hall = nowhere(AcousticConfig::full());
    let (source, distance) = (Vec3::ZERO, 50.0);
    let heard = response(&hall, source, &Receiver::omni(Vec3::X * distance));
    let air = hall.scene.config().air;
    for band in 3..7 {
        let frequency_hz = bands::exact_centre_hz(band);
        let delay_s = 50.0 / air.speed_of_sound_m_s();
        let (gain, _) = at_frequency(heard.channel(0), 16_000.0, frequency_hz, delay_s);
        let wanted_db = -20.0 * 50.0_f64.log10() - 50.0 * air.attenuation_db_per_m(frequency_hz);
        assert!(
            (20.0 * gain.log10() - wanted_db).abs() < 0.3,
            "{frequency_hz}: {}",
            20.0 * gain.log10() - wanted_db
        );
    }
}

/// Cross-correlation below 1.5 kHz, as in V17: delay of the right channel, s.
fn interaural_delay_s(left: &[f32], right: &[f32], rate_hz: f64) -> f64 {
    // Correlation of band-limited signals by their cross spectrum, sampled every microsecond.
    let spectrum = |x: &[f32], f: f64| {
        let omega = std::f64::consts::TAU * f / rate_hz;
        let sums = x.iter().enumerate().map(|(k, v)| {
            let phase = omega * k as f64;
            (f64::from(*v) * phase.cos(), -f64::from(*v) * phase.sin())
        });
        sums.fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1))
    };
    let lines: Vec<(f64, f64, f64)> = (5..75)
        .map(|k| {
            let f = 20.0 * f64::from(k);
            let ((a, b), (c, d)) = (spectrum(left, f), spectrum(right, f));
            // left times conjugate of right
            (f, a * c + b * d, b * c - a * d)
        })
        .collect();
    let correlation = |delay: f64| {
        let sum = lines.iter().map(|(f, re, im)| {
            let phase = std::f64::consts::TAU * f * delay;
            re * phase.cos() + im * phase.sin()
        });
        sum.sum::<f64>()
    };
    (-1000..=1000)
        .map(|k| f64::from(k) * 1e-6)
        .max_by(|a, b| correlation(*a).total_cmp(&correlation(*b)))
        .unwrap()
}

/// V17 against Woodworth's law for 8.75 cm (which is the one for high frequencies): sign, and 120 us below 1.5 kHz.
#[test]
fn a_source_to_the_left_comes_to_the_left_ear_first_and_louder() {
    let hall = nowhere(dry(0));
    let head = Pose::from_position_yaw(Vec3::new(10.0, 1.2, -3.0), 0.6);
    for (azimuth_deg, woodworth_us) in [
        (0.0_f64, 0.0),
        (30.0, 261.0),
        (45.0, 381.0),
        (60.0, 488.0),
        (90.0, 655.0),
        (120.0, 488.0),
        (150.0, 261.0),
        (180.0, 0.0),
    ] {
        for side in [1.0, -1.0] {
            let azimuth = side * azimuth_deg.to_radians();
            let in_head = Vec3::new(-azimuth.sin() as f32, 0.0, -azimuth.cos() as f32);
            let source = head.transform_point(in_head * 3.0);
            let heard = response(&hall, source, &Receiver::binaural(head));
            let (left, right) = (heard.channel(0), heard.channel(1));
            let delay_us = 1e6 * interaural_delay_s(left, right, 16_000.0);
            assert!(
                (delay_us - side * woodworth_us).abs() < 120.0,
                "{azimuth_deg}: {delay_us}"
            );
            let level =
                |x: &[f32]| 10.0 * x.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>().log10();
            let difference = side * (level(left) - level(right));
            if (30.0..=150.0).contains(&azimuth_deg) {
                assert!(
                    delay_us * side > 150.0 && difference > 3.0,
                    "{azimuth_deg}: {difference} dB"
                );
            } else {
                assert!(
                    delay_us.abs() < 5.0 && difference.abs() < 0.1,
                    "{azimuth_deg}: {difference} dB"
                );
            }
        }
    }
}

/// A head is small against long waves: both ears receive what a microphone at its centre does.
#[test]
fn low_frequencies_are_equal_at_both_ears_and_at_a_microphone() {
    let hall = nowhere(dry(0));
    let (position, source) = (Vec3::new(0.0, 1.2, 0.0), Vec3::new(-2.0, 1.9, -1.0));
    let head = response(
        &hall,
        source,
        &Receiver::binaural(Pose::from_position(position)),
    );
    let delay_s = f64::from(source.distance(position)) / 343.2;
    for channel in 0..2 {
        let (gain, _) = at_frequency(head.channel(channel), 16_000.0, 40.0, delay_s);
        assert!(
            (20.0 * (gain * delay_s * 343.2).log10()).abs() < 0.3,
            "{channel}: {gain}"
        );
    }
}

#[test]
fn a_point_that_is_nowhere_is_refused() {
    let hall = nowhere(dry(10));
    let source = SoundSourcePose::omni(Vec3::new(f32::NAN, 0.0, 0.0));
    let refused = hall.scene.impulse_response(
        &hall.rays,
        &source,
        &Receiver::omni(Vec3::ZERO),
        RandomKey::root(0),
        Threads::ONE,
    );
    assert!(refused.unwrap_err().to_string().contains("the source"));
}

/// Returns the absorption by air by ISO 9613-1:1993, equations (3) to (5), computed independently: dB/m at 20 degrees
/// Celsius, 50 % and 101.325 kPa.
fn iso_9613_1_db_per_m(frequency_hz: f64) -> f64 {
    let (t, t0, t01) = (293.15_f64, 293.15_f64, 273.16_f64);
    let vapour = 50.0 * 10.0_f64.powf(-6.8346 * (t01 / t).powf(1.261) + 4.6151);
    let oxygen_hz = 24.0 + 4.04e4 * vapour * (0.02 + vapour) / (0.391 + vapour);
    let nitrogen_hz = 9.0 + 280.0 * vapour * (-4.170 * ((t / t0).powf(-1.0 / 3.0) - 1.0)).exp();
    let relaxed = |share: f64, theta_k: f64, at_hz: f64| {
        share * (-theta_k / t).exp() * at_hz / (at_hz * at_hz + frequency_hz * frequency_hz)
    };
    let both = relaxed(0.012_75, 2239.1, oxygen_hz) + relaxed(0.1068, 3352.0, nitrogen_hz);
    8.686 * frequency_hz.powi(2) * (1.84e-11 * (t / t0).sqrt() + (t / t0).powf(-2.5) * both)
}

/// Above the highest band, too, absorption by air is that of ISO 9613-1 at each frequency: 0.36 dB/m at 16 kHz, not the 0.10 dB/m of 8 kHz.
#[test]
fn air_takes_of_every_frequency_what_the_standard_says() {
    assert!((iso_9613_1_db_per_m(16_000.0) - 0.365).abs() < 2e-3);
    for rate_hz in [44_100_u32, 48_000, 96_000] {
        let rate = f64::from(rate_hz);
        let hall = nowhere(AcousticConfig {
            rate_hz,
            air_absorption: true,
            max_duration_s: 1.0,
            ..dry(0)
        });
        let level_db = |distance_m: f32, frequency_hz: f64| {
            let heard = response(&hall, Vec3::ZERO, &Receiver::omni(Vec3::X * distance_m));
            let d = f64::from(distance_m);
            let (gain, _) = at_frequency(heard.channel(0), rate, frequency_hz, d / 343.2);
            20.0 * (gain * d).log10()
        };
        for frequency_hz in [8_000.0, 10_000.0, 12_500.0, 16_000.0, 20_000.0] {
            let wanted_db = 99.0 * iso_9613_1_db_per_m(frequency_hz);
            let lost_db = level_db(1.0, frequency_hz) - level_db(100.0, frequency_hz);
            assert!(
                (lost_db - wanted_db).abs() < 0.5,
                "{frequency_hz} Hz at {rate_hz} Hz: {lost_db} dB, {wanted_db} by the standard"
            );
        }
    }
}
