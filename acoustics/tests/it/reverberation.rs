//! The tail against the statistics of rooms.

#![allow(clippy::unwrap_used, reason = "tests may stop at the first surprise")]

use crate::common;

use common::{Hall, dry, material};
use dwell_acoustics::{AcousticConfig, Receiver, SoundSourcePose, bands, metrics};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{Bands, Material};
use glam::Vec3;

const C: f64 = 343.2;

/// Eyring's time with air, s.
///
/// # Source
/// C. F. Eyring, JASA 1, 217 (1930): 24 ln 10 / c V / (4 m V - S ln(1 - alpha)).
fn eyring_s(size: [f32; 3], absorption: f64, air_per_m: f64) -> f64 {
    let [x, y, z] = size.map(f64::from);
    let (volume, surface) = (x * y * z, 2.0 * (x * y + y * z + z * x));
    24.0 * std::f64::consts::LN_10 / C * volume
        / (4.0 * air_per_m * volume - surface * (1.0 - absorption).ln())
}

/// The claim: T30 within 10 % of Eyring in every band at scattering 1, here with absorption and air that differ by band.
#[test]
fn a_scattering_room_decays_as_eyring_says_in_every_band() {
    let size = [6.0, 3.0, 5.0];
    let wall = Material {
        absorption: Bands::octaves([0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4]),
        ..material(0.0, 1.0)
    };
    let hall = Hall::shoebox(
        size,
        &wall,
        AcousticConfig {
            rays: 3000,
            ..AcousticConfig::full()
        },
    );
    let found = hall.echogram(
        Vec3::new(1.2, 1.5, 1.4),
        Vec3::new(4.6, 1.2, 3.3),
        RandomKey::root(10),
    );
    let air = hall.scene.config().air.energy_decay_per_m();
    for (band, metrics) in metrics::echogram_metrics(&found).iter().enumerate() {
        let absorption = f64::from(wall.absorption.at(bands::NOMINAL_CENTRES_HZ[band]));
        let wanted = eyring_s(size, absorption, air[band]);
        let t30 = metrics.t30_s.unwrap();
        assert!(
            (t30 / wanted - 1.0).abs() < 0.1,
            "band {band}: {t30}, Eyring {wanted}"
        );
    }
}

/// V10, with what theory says about the difference to Eyring: free paths vary, which makes decays longer by
/// 1 / (1 + gamma²/2 ln(1 - alpha)), where gamma² is their relative variance, 0.342 in a cube.
///
/// # Source
/// H. Kuttruff, *Room Acoustics* (5th ed.), equation (5.26) and table 5.1.
#[test]
fn three_rooms_have_their_times() {
    for (size, absorption, printed, variance, tolerance) in [
        ([6.0, 3.0, 5.0], 0.2, 0.515, 0.36, 0.05),
        ([10.0, 3.5, 7.5], 0.1, 1.472, 0.37, 0.05),
        ([5.0, 5.0, 5.0], 0.3, 0.376, 0.342, 0.08),
    ] {
        let eyring = eyring_s(size, f64::from(absorption), 0.0);
        assert!((eyring - printed).abs() < 1e-3);
        let kuttruff = eyring / (1.0 + 0.5 * variance * (1.0 - f64::from(absorption)).ln());
        let [x, y, z] = size;
        let source = Vec3::new(0.2 * x, 0.5 * y, 0.3 * z);
        let ear = Vec3::new(0.77 * x, 0.4 * y, 0.66 * z);
        for scattering in [1.0, 0.5] {
            let config = AcousticConfig {
                max_duration_s: 1.6 * printed,
                ..dry(1500)
            };
            let hall = Hall::shoebox(size, &material(absorption, scattering), config);
            let found = metrics::echogram_metrics(&hall.echogram(source, ear, RandomKey::root(3)));
            let t30 = found[4].t30_s.unwrap();
            let at =
                format!("{size:?} s {scattering}: {t30}, Eyring {eyring}, Kuttruff {kuttruff}");
            if scattering > 0.9 {
                assert!((t30 / eyring - 1.0).abs() < tolerance, "{at}");
                assert!((t30 / kuttruff - 1.0).abs() < 0.025, "{at}");
            } else {
                assert!((t30 / kuttruff - 1.0).abs() < 0.08, "{at}");
            }
        }
    }
}

/// V7: without absorption the energy of every bin is 4 pi c dt / V for ever; V8: the mean free path is 4 V / S.
#[test]
fn energy_is_conserved_and_rays_fly_their_mean_free_path() {
    let (x, y, z) = (6.0, 3.0, 5.555_556);
    let config = AcousticConfig {
        max_duration_s: 5.0,
        bin_s: 0.01,
        ..dry(4500)
    };
    let hall = Hall::shoebox([x, y, z], &material(0.0, 0.3), config);
    let found = hall.echogram(
        Vec3::new(1.2, 1.5, 1.4),
        Vec3::new(4.6, 1.2, 3.3),
        RandomKey::root(7),
    );
    let (volume, surface) = (
        f64::from(x * y * z),
        f64::from(2.0 * (x * y + y * z + z * x)),
    );
    let wanted = 4.0 * std::f64::consts::PI * C * 0.01 / volume;
    assert!((wanted - 0.431_28).abs() < 1e-4);
    let late: Vec<f64> = found.tail.bins[20..].iter().map(|bin| bin[4]).collect();
    let mean = late.iter().sum::<f64>() / late.len() as f64;
    assert!(
        (mean / wanted - 1.0).abs() < 0.01,
        "{mean}, wanted {wanted}"
    );
    // The decay of the straight line through the levels: slower than 200 s for 60 dB either way.
    let n = late.len() as f64;
    let (mut st, mut sl, mut stt, mut stl) = (0.0, 0.0, 0.0, 0.0);
    for (k, e) in late.iter().enumerate() {
        let (t, level) = (0.01 * k as f64, 10.0 * e.log10());
        st += t;
        sl += level;
        stt += t * t;
        stl += t * level;
    }
    let slope_db_per_s = (n * stl - st * sl) / (n * stt - st * st);
    assert!(slope_db_per_s.abs() < 60.0 / 200.0, "{slope_db_per_s} dB/s");
    let leak = found.ray_statistics.escaped as f64 / found.ray_statistics.segments as f64;
    assert!(
        leak < 1e-5,
        "{} of {} escaped",
        found.ray_statistics.escaped,
        found.ray_statistics.segments
    );
    assert!((found.ray_statistics.mean_free_path_m / (4.0 * volume / surface) - 1.0).abs() < 5e-3);
    assert!((found.ray_statistics.visible_volume_m3 / volume - 1.0).abs() < 0.1);
}

/// V9: all energy but the direct sound is 16 pi (1 - alpha)/A in a scattering room, within 0.5 dB.
#[test]
fn the_reverberant_level_is_that_of_a_diffuse_field() {
    let size = [6.0, 3.0, 5.0];
    let hall = Hall::shoebox(size, &material(0.1, 1.0), dry(3000));
    let found = hall.echogram(
        Vec3::new(1.2, 1.5, 1.4),
        Vec3::new(4.6, 1.2, 3.3),
        RandomKey::root(9),
    );
    let wanted = 16.0 * std::f64::consts::PI * 0.9 / (0.1 * 126.0);
    let error_db = 10.0 * (found.tail.total()[4] / wanted).log10();
    assert!(error_db.abs() < 0.5, "{error_db}");
}

/// The order up to which image sources are used does not change the energy: each path is counted once.
#[test]
fn the_order_of_the_images_does_not_change_the_energy() {
    let totals = [0, 1, 2, 3].map(|image_order| {
        let config = AcousticConfig {
            image_order,
            ..dry(20_000)
        };
        let hall = Hall::shoebox([6.0, 3.0, 5.0], &material(0.3, 0.2), config);
        let found = hall.echogram(
            Vec3::new(1.2, 1.5, 1.4),
            Vec3::new(4.6, 1.2, 3.3),
            RandomKey::root(2),
        );
        found.total()[4]
    });
    for total in totals {
        assert!(
            (10.0 * (total / totals[3]).log10()).abs() < 0.15,
            "{totals:?}"
        );
    }
}

/// Thinning out faint rays is fair: it changes neither level nor decay beyond chance. Of one trace that is thinned, the late energy has
/// an error of 4.5 %: eight bring it to 0.07 dB. With `DWELL_TEST_ALL=1`: it traces for as long as all others here; those with
/// closed forms trace with roulette, too.
#[test]
fn roulette_is_unbiased() {
    const TRACES: u64 = 8;
    if std::env::var_os("DWELL_TEST_ALL").is_none() {
        println!("skipped: slow; DWELL_TEST_ALL=1 runs it");
        return;
    }
    let [all, thinned] = [120.0, 15.0].map(|roulette_db| {
        let config = AcousticConfig {
            roulette_db,
            ..dry(20_000)
        };
        let hall = Hall::shoebox([6.0, 3.0, 5.0], &material(0.3, 0.5), config);
        let (source, ear) = (Vec3::new(1.2, 1.5, 1.4), Vec3::new(4.6, 1.2, 3.3));
        let found = (0..TRACES).map(|key| hall.echogram(source, ear, RandomKey::root(key)));
        found.collect::<Vec<_>>()
    });
    assert!(thinned[0].ray_statistics.segments < all[0].ray_statistics.segments / 2);
    let late = |found: &[dwell_acoustics::Echogram]| {
        let bins = found.iter().flat_map(|found| &found.tail.bins[40..60]);
        bins.map(|bin| bin[4]).sum::<f64>()
    };
    let difference_db = 10.0 * (late(&thinned) / late(&all)).log10();
    assert!(difference_db.abs() < 0.21, "{difference_db}");
}

/// Bands that scatter differently share their rays, and still each has the decay of a room that scatters like it.
#[test]
fn a_band_does_not_feel_how_others_scatter() {
    let mixed = Material {
        scattering: Bands::octaves([0.02, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8]),
        ..material(0.1, 0.0)
    };
    let (source, ear) = (Vec3::new(1.2, 1.5, 1.4), Vec3::new(4.6, 1.2, 3.3));
    let level = |wall: &Material| {
        let hall = Hall::shoebox([6.0, 3.0, 5.0], wall, dry(6000));
        let found = hall.echogram(source, ear, RandomKey::root(21));
        let windows = found.tail.bins[50..200].chunks(50);
        windows
            .map(|bins| {
                bins.iter().fold([0.0; 8], |sum: [f64; 8], bin| {
                    std::array::from_fn(|band| sum[band] + bin[band])
                })
            })
            .collect::<Vec<_>>()
    };
    let together = level(&mixed);
    for band in [2, 4, 6] {
        let alone = level(&material(
            0.1,
            mixed.scattering.at(bands::NOMINAL_CENTRES_HZ[band]),
        ));
        for (a, b) in together.iter().zip(&alone) {
            let difference_db = 10.0 * (a[band] / b[band]).log10();
            assert!(difference_db.abs() < 0.7, "band {band}: {difference_db} dB");
        }
    }
}

/// V23: the same bits for 1, 2 and 7 threads.
#[test]
fn threads_do_not_change_a_bit() {
    let hall = Hall::shoebox([6.0, 3.0, 5.0], &material(0.2, 0.4), dry(700));
    let source = SoundSourcePose::omni(Vec3::new(1.2, 1.5, 1.4));
    let ear = Receiver::omni(Vec3::new(4.6, 1.2, 3.3));
    let [one, two, seven] = [1, 2, 7].map(|threads| {
        let threads = Threads::new(threads);
        hall.scene
            .impulse_response(&hall.rays, &source, &ear, RandomKey::root(5), threads)
            .unwrap()
    });
    assert_eq!(one, two);
    assert_eq!(one, seven);
    let other = hall
        .scene
        .impulse_response(&hall.rays, &source, &ear, RandomKey::root(6), Threads::ONE)
        .unwrap();
    assert_ne!(one.samples, other.samples);
}

/// The pressure carries the histogram's energy: decay and level of the impulse response are those of the echogram.
#[test]
fn the_impulse_response_decays_as_its_echogram() {
    let hall = Hall::shoebox([6.0, 3.0, 5.0], &material(0.15, 0.6), dry(2000));
    let source = SoundSourcePose::omni(Vec3::new(1.2, 1.5, 1.4));
    for receiver in [
        Receiver::omni(Vec3::new(4.6, 1.2, 3.3)),
        Receiver::binaural(dwell_scene::Pose::from_position_yaw(
            Vec3::new(4.6, 1.2, 3.3),
            1.0,
        )),
    ] {
        let response = hall
            .scene
            .impulse_response(
                &hall.rays,
                &source,
                &receiver,
                RandomKey::root(4),
                Threads::ONE,
            )
            .unwrap();
        let energies = metrics::echogram_metrics(&response.echogram);
        for channel in 0..receiver.channels() {
            let pressure = metrics::impulse_response_metrics(
                response.channel(channel),
                16_000.0,
                metrics::BandWidth::Octave,
            );
            // Above 250 Hz a band holds enough independent values for 15 %.
            for band in 3..7 {
                let (a, b) = (energies[band].t30_s.unwrap(), pressure[band].t30_s.unwrap());
                assert!((b / a - 1.0).abs() < 0.15, "band {band}: {a} {b}");
                if receiver.channels() == 1 {
                    let (a, b) = (energies[band].g_db.unwrap(), pressure[band].g_db.unwrap());
                    assert!((a - b).abs() < 1.2, "band {band}: {a} dB {b} dB");
                }
            }
        }
    }
}
