//! Arrays, ambisonics and directional sources.

use crate::common;

use common::{Hall, dry, material};
use dwell_acoustics::bands::BAND_COUNT;
use dwell_acoustics::{
    AcousticConfig, DirectionalEnergy, Directivity, Echogram, EnergyHistogram, Microphone,
    Receiver, SoundSourcePose,
};
use dwell_scene::Pose;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;

const C: f64 = 343.2;
const RATE_HZ: f64 = 48_000.0;

fn config(rays: usize) -> AcousticConfig {
    AcousticConfig {
        rate_hz: RATE_HZ as u32,
        ..dry(rays)
    }
}

fn box_of(absorption: f32, scattering: f32, rays: usize) -> Hall {
    let material = material(absorption, scattering);
    Hall::shoebox([6.0, 3.0, 5.0], &material, config(rays))
}

/// Phase-delay-compensated value of a signal's spectrum at one frequency.
fn at_frequency(samples: &[f32], frequency_hz: f64) -> Complex<f64> {
    let omega = TAU * frequency_hz / RATE_HZ;
    samples
        .iter()
        .enumerate()
        .map(|(k, x)| Complex::from_polar(f64::from(*x), -omega * k as f64))
        .sum()
}

/// V19 on closed-form ground: in a tail from all sides, two microphones d apart have the coherence sin(kd)/(kd) of a diffuse
/// field (R. K. Cook et al., JASA 27, 1072 (1955)); in one from a single cell they agree but for its delay.
#[test]
fn the_tail_is_as_coherent_as_a_diffuse_field() {
    let hall = box_of(0.1, 0.5, 0);
    let d = 0.1;
    let pair = vec![
        Microphone::omni(Vec3::X * (0.5 * d)),
        Microphone::omni(Vec3::NEG_X * (0.5 * d)),
    ];
    let receiver = Receiver::array(Pose::from_position_yaw(Vec3::splat(1.0), 0.4), pair);
    let bins = 250;
    let echogram = |directions: DirectionalEnergy| Echogram {
        tail: EnergyHistogram {
            bin_s: 0.004,
            bins: vec![[1.0; BAND_COUNT]; bins],
            bins_per_direction: bins,
            directions: vec![directions],
        },
        speed_m_s: C,
        ..Echogram::default()
    };
    let coherence = |directions: DirectionalEnergy, frequencies_hz: &[f64]| -> Vec<Complex<f64>> {
        let size = 512;
        let mut sums = vec![(0.0, 0.0, Complex::default()); frequencies_hz.len()];
        for seed in 0..4 {
            let heard = hall.scene.impulse_response_from_echogram(
                echogram(directions.clone()),
                &receiver,
                RandomKey::root(seed),
            );
            let (left, right) = (heard.channel(0), heard.channel(1));
            for start in (2000..left.len() - 4000).step_by(size) {
                for (sum, f) in sums.iter_mut().zip(frequencies_hz) {
                    let a = at_frequency(&left[start..start + size], *f);
                    let b = at_frequency(&right[start..start + size], *f);
                    sum.0 += a.norm_sqr();
                    sum.1 += b.norm_sqr();
                    sum.2 += a * b.conj();
                }
            }
        }
        sums.iter().map(|(a, b, ab)| ab / (a * b).sqrt()).collect()
    };
    let frequencies_hz: Vec<f64> = (0..40).map(|k| 200.0 + 95.0 * f64::from(k)).collect();
    let found = coherence(DirectionalEnergy::default(), &frequencies_hz);
    let squares = found.iter().zip(&frequencies_hz).map(|(found, f)| {
        let kd = TAU * f * f64::from(d) / C;
        (found.re - kd.sin() / kd).powi(2)
    });
    let rms = (squares.sum::<f64>() / frequencies_hz.len() as f64).sqrt();
    // 350 windows: a standard error of 0.05 at most where the law is 0.
    assert!(rms < 0.06, "{rms}");

    let mut one_side = DirectionalEnergy::default();
    one_side.energy[20] = [1.0; BAND_COUNT];
    let found = coherence(one_side, &[500.0, 1000.0]);
    assert!(found.iter().all(|value| value.norm() > 0.9), "{found:?}");
}

/// V18: a 6-microphone array of 10 cm receives a distant source with the delays r.u/c, within 1 microsecond.
#[test]
fn an_array_hears_differences_of_time() {
    let hall = Hall::shoebox([400.0, 400.0, 400.0], &material(1.0, 0.0), config(0));
    let (r, q) = (0.05_f32, 0.05 / 2.0_f32.sqrt());
    let places = [
        Vec3::new(0.0, 0.0, -r),
        Vec3::new(0.0, 0.0, r),
        Vec3::new(q, q, 0.0),
        Vec3::new(-q, q, 0.0),
        Vec3::new(q, -q, 0.0),
        Vec3::new(-q, -q, 0.0),
    ];
    let middle = Vec3::splat(200.0);
    let microphones = places.iter().copied().map(Microphone::omni).collect();
    let receiver = Receiver::array(Pose::from_position(middle), microphones);
    for azimuth in 0..12 {
        let angle = f32::to_radians(30.0 * azimuth as f32);
        let towards = Vec3::new(-angle.sin(), 0.0, -angle.cos());
        let source = SoundSourcePose::omni(middle + 50.0 * towards);
        let heard = hall
            .scene
            .impulse_response(
                &hall.rays,
                &source,
                &receiver,
                RandomKey::root(0),
                Threads::ONE,
            )
            .unwrap();
        for (k, place) in places.iter().enumerate().skip(1) {
            let f = 1000.0;
            let (a, b) = (
                at_frequency(heard.channel(0), f),
                at_frequency(heard.channel(k), f),
            );
            let found_s = (b / a).arg() / (TAU * f);
            let way = |place: Vec3| (source.position() - middle - place).as_dvec3().length();
            let wanted_s = -(way(*place) - way(places[0])) / C;
            assert!(
                (found_s - wanted_s).abs() < 1e-6,
                "{azimuth} {k}: {found_s} {wanted_s}"
            );
        }
    }
}

/// Each microphone has its own early paths: in a mirroring room it receives what a single microphone there does.
#[test]
fn the_microphones_of_an_array_hear_their_own_early_paths() {
    let hall = box_of(0.2, 0.0, 0);
    let source = SoundSourcePose::omni(Vec3::new(1.2, 1.5, 1.4));
    let (pose, place) = (
        Pose::from_position_yaw(Vec3::new(4.4, 1.2, 3.2), 0.7),
        Vec3::new(0.11, 0.2, -0.3),
    );
    let array = Receiver::array(pose, vec![Microphone::omni(place)]);
    let alone = Receiver::omni(pose.transform_point(place));
    let hear = |receiver: &Receiver| {
        hall.scene
            .impulse_response(
                &hall.rays,
                &source,
                receiver,
                RandomKey::root(0),
                Threads::ONE,
            )
            .unwrap()
            .samples
    };
    let (a, b) = (hear(&array), hear(&alone));
    let n = a.len().min(b.len());
    assert!(n > 1000);
    let difference = a[..n].iter().zip(&b[..n]).map(|(a, b)| (a - b).abs());
    assert!(difference.fold(0.0, f32::max) < 1e-6);
}

/// A plane wave in ambisonics is the spherical harmonics of its direction: from the left only W and Y, turned with the receiver.
#[test]
fn ambisonics_encode_where_sound_comes_from() {
    let hall = Hall::shoebox([400.0, 400.0, 400.0], &material(1.0, 0.0), config(0));
    let middle = Vec3::splat(200.0);
    for (yaw_deg, wanted) in [(0.0, [1.0, 1.0, 0.0, 0.0]), (90.0, [1.0, 0.0, 0.0, 1.0])] {
        let pose = Pose::from_position_yaw(middle, f32::to_radians(yaw_deg));
        let heard = hall
            .scene
            .impulse_response(
                &hall.rays,
                &SoundSourcePose::omni(middle - 10.0 * Vec3::X),
                &Receiver::ambisonics(pose, 1),
                RandomKey::root(0),
                Threads::ONE,
            )
            .unwrap();
        for (channel, wanted) in wanted.into_iter().enumerate() {
            let found = at_frequency(heard.channel(channel), 1000.0).norm() * 10.0;
            assert!(
                (found - wanted).abs() < 1e-3,
                "{yaw_deg} {channel}: {found}"
            );
        }
    }
}

/// A cardioid radiates a third of the energy that a source as loud on its axis does on all sides, and nothing behind.
#[test]
fn a_directive_source_fills_the_room_with_less() {
    let hall = box_of(0.2, 1.0, 20_000);
    let (place, ear) = (Vec3::new(3.0, 1.5, 2.5), Vec3::new(4.6, 1.5, 2.5));
    let hear = |source: &SoundSourcePose| {
        let threads = Threads::new(2);
        hall.scene
            .echogram(&hall.rays, source, ear, RandomKey::root(3), threads)
            .unwrap()
    };
    // Forward -Z turned to -X: away from the ear.
    let pose = Pose::from_position_yaw(place, std::f32::consts::FRAC_PI_2);
    let away = hear(&SoundSourcePose::directional(pose, Directivity::CARDIOID));
    let equal = hear(&SoundSourcePose::omni(place));
    let direct = |echogram: &Echogram| echogram.direct().map_or(0.0, |path| path.energy[4]);
    assert!(direct(&equal) > 0.3 && direct(&away) < 1e-9);
    // What has gone two ways through the room no longer knows where it came from.
    let late = |echogram: &Echogram| -> f64 {
        let bins = echogram.tail.bins[15..].iter();
        bins.map(|bin| bin[4]).sum()
    };
    let ratio_db = 10.0 * (3.0 * late(&away) / late(&equal)).log10();
    assert!(ratio_db.abs() < 0.3, "{ratio_db} dB");
    let error = f64::from(equal.ray_statistics.relative_error[4]);
    assert!(error > 0.0 && error < 0.02, "{error}");
}

/// Receivers computed together hear what they hear alone, within the reported errors.
#[test]
fn receivers_share_rays() {
    let hall = box_of(0.2, 0.4, 4000);
    let source = SoundSourcePose::omni(Vec3::new(1.2, 1.5, 1.4));
    let ears = [
        Vec3::new(4.6, 1.2, 3.3),
        Vec3::new(2.0, 1.0, 4.0),
        Vec3::new(5.0, 2.0, 1.0),
    ];
    let together = hall
        .scene
        .echograms(&hall.rays, &source, &ears, RandomKey::root(1), Threads::ONE)
        .unwrap();
    for (ear, together) in ears.iter().zip(&together) {
        let alone = hall
            .scene
            .echogram(&hall.rays, &source, *ear, RandomKey::root(2), Threads::ONE)
            .unwrap();
        assert_eq!(alone.paths, together.paths);
        for band in 0..BAND_COUNT {
            let (a, b) = (alone.tail.total()[band], together.tail.total()[band]);
            let error =
                |echogram: &Echogram| f64::from(echogram.ray_statistics.relative_error[band]);
            let bound = 4.0 * error(&alone).hypot(error(together));
            assert!((a / b - 1.0).abs() < bound, "{band}: {a} {b} {bound}");
        }
    }
}

/// Rays end when the error is small enough, after the same number of them for any number of threads.
#[test]
fn tracing_ends_when_the_error_is_small_enough() {
    let material = material(0.2, 0.4);
    let config = AcousticConfig {
        max_error: 0.02,
        ..config(1_000_000)
    };
    let hall = Hall::shoebox([6.0, 3.0, 5.0], &material, config);
    let (source, ear) = (
        SoundSourcePose::omni(Vec3::new(1.2, 1.5, 1.4)),
        Vec3::new(4.6, 1.2, 3.3),
    );
    let [one, seven] = [1, 7].map(|threads| {
        hall.scene
            .echogram(
                &hall.rays,
                &source,
                ear,
                RandomKey::root(1),
                Threads::new(threads),
            )
            .unwrap()
    });
    assert_eq!(one, seven);
    assert!(
        one.ray_statistics.rays < 100_000,
        "{}",
        one.ray_statistics.rays
    );
    assert!(one.ray_statistics.relative_error.iter().all(|e| *e <= 0.02));
}

#[test]
fn receivers_and_sources_out_of_range_are_refused() {
    let hall = box_of(0.2, 0.4, 64);
    let source = SoundSourcePose::omni(Vec3::new(1.2, 1.5, 1.4));
    let pose = Pose::from_position(Vec3::new(4.6, 1.2, 3.3));
    let ask = |source: &SoundSourcePose, receiver: &Receiver| {
        let (rays, key) = (&hall.rays, RandomKey::root(0));
        let heard = hall
            .scene
            .impulse_response(rays, source, receiver, key, Threads::ONE);
        heard.map(|heard| heard.channels).map_err(|e| e.to_string())
    };
    let crowd = |count| Receiver::array(pose, vec![Microphone::omni(Vec3::ZERO); count]);
    assert_eq!(ask(&source, &crowd(3)), Ok(3));
    assert_eq!(ask(&source, &Receiver::ambisonics(pose, 3)), Ok(16));
    let message = ask(&source, &crowd(200)).unwrap_err();
    assert_eq!(
        message,
        "receiver: microphones is 200; allowed are 1 to 128"
    );
    assert!(ask(&source, &crowd(0)).is_err());
    assert!(ask(&source, &Receiver::ambisonics(pose, 4)).is_err());
    let mut turned = pose;
    turned.rotation = glam::Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    assert!(ask(&source, &Receiver::binaural(turned)).is_err());
    let loud = SoundSourcePose::directional(pose, Directivity::Sphere { radius_m: -1.0 });
    assert!(ask(&loud, &crowd(1)).is_err());
}
