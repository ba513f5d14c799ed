//! Streams: blocks of sound in step with a world.

#![allow(clippy::unwrap_used, reason = "tests may stop at the first surprise")]

use crate::common;

use common::{Hall, box_sides, dry, material, pieces, rectangle};
use dwell_acoustics::{
    AcousticConfig, ActiveSource, Microphone, Receiver, SoundSourcePose, Stream, StreamConfig,
    signals,
};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{House, HouseData, LawSpec, Pose, State};
use glam::Vec3;

pub(crate) const BLOCK: usize = 800;
pub(crate) const SOURCE: Vec3 = Vec3::new(1.2, 1.5, 1.4);

pub(crate) fn room() -> Hall {
    let config = AcousticConfig {
        max_duration_s: 0.7,
        image_order: 2,
        ..dry(300)
    };
    Hall::shoebox([6.0, 3.0, 5.0], &material(0.25, 0.5), config)
}

fn nowhere() -> Hall {
    Hall::new(
        House::new(HouseData::default()).unwrap(),
        AcousticConfig {
            max_duration_s: 0.2,
            ..dry(0)
        },
    )
}

pub(crate) fn stream(hall: &Hall, config: StreamConfig) -> Stream {
    Stream::new(hall.scene.clone(), config, RandomKey::root(8), Threads::ONE).unwrap()
}

pub(crate) fn head(position: Vec3, yaw_rad: f32) -> Receiver {
    Receiver::binaural(Pose::from_position_yaw(position, yaw_rad))
}

/// Plays `signal` block by block; `place(block)` says where the source is and who listens. Returns the channels.
fn play(
    hall: &Hall,
    stream: &mut Stream,
    signal: &[f32],
    place: impl Fn(usize) -> (Vec3, Receiver),
) -> Vec<Vec<f32>> {
    let state = State::new(&hall.house);
    let channels = place(0).1.channels();
    let mut heard = vec![Vec::new(); channels];
    for (k, block) in signal.chunks_exact(BLOCK).enumerate() {
        let (position, receiver) = place(k);
        let source = ActiveSource {
            id: 5,
            position,
            signal: block,
        };
        let mut out = vec![0.0; channels * BLOCK];
        stream
            .render_block(&hall.rays, &state, &[source], &receiver, &mut out)
            .unwrap();
        for (all, channel) in heard.iter_mut().zip(out.chunks_exact(BLOCK)) {
            all.extend_from_slice(channel);
        }
    }
    heard
}

pub(crate) fn radio(samples: usize) -> Vec<f32> {
    let mut signal = vec![0.0; samples];
    signals::synthesize("radio", 16_000, 0, &mut signal).unwrap();
    signal
}

/// A scene in which nothing moves gives the convolution with its impulse response, within 1e-5.
#[test]
fn a_still_scene_is_a_convolution() {
    let hall = room();
    let receiver = head(Vec3::new(4.6, 1.2, 3.3), 0.7);
    let signal = radio(16 * BLOCK);
    let heard = play(
        &hall,
        &mut stream(&hall, StreamConfig::full()),
        &signal,
        |_| (SOURCE, receiver.clone()),
    );
    let key = RandomKey::root(8).child("source").child(5);
    let response = hall
        .scene
        .impulse_response(
            &hall.rays,
            &SoundSourcePose::omni(SOURCE),
            &receiver,
            key,
            Threads::ONE,
        )
        .unwrap();
    for (channel, found) in heard.iter().enumerate() {
        let h = response.channel(channel);
        assert!(h.len() > 4 * BLOCK);
        let peak = found.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
        for (n, y) in found.iter().enumerate().step_by(7) {
            let wanted: f64 = (0..h.len().min(n + 1))
                .map(|k| f64::from(h[k]) * f64::from(signal[n - k]))
                .sum();
            assert!(
                (f64::from(*y) - wanted).abs() < 1e-5 * f64::from(peak.max(1.0)),
                "{n}: {y} {wanted}"
            );
        }
    }
}

#[test]
fn a_source_that_stops_rings_out_and_is_forgotten() {
    let hall = room();
    let state = State::new(&hall.house);
    let receiver = Receiver::omni(Vec3::new(4.6, 1.2, 3.3));
    let mut stream = stream(&hall, StreamConfig::rl());
    let signal = radio(BLOCK);
    let source = ActiveSource {
        id: 1,
        position: SOURCE,
        signal: &signal,
    };
    let mut out = vec![0.0; BLOCK];
    let report = stream
        .render_block(&hall.rays, &state, &[source], &receiver, &mut out)
        .unwrap();
    assert_eq!((report.traced_responses, report.audible_sources), (1, 1));
    let silent = stream.hash();
    let mut levels = Vec::new();
    for _ in 0..20 {
        stream
            .render_block(&hall.rays, &state, &[], &receiver, &mut out)
            .unwrap();
        levels.push(out.iter().map(|x| x * x).sum::<f32>());
    }
    assert!(levels[0] > 0.0 && levels[4] < 0.2 * levels[0] && levels[4] > 0.0);
    assert!(levels[19] <= 0.0);
    assert_ne!(stream.hash(), silent);
    let report = stream
        .render_block(&hall.rays, &state, &[], &receiver, &mut out)
        .unwrap();
    assert_eq!(report.audible_sources, 0);
}

/// V21: a listener walks past a tone of 1 kHz; the frequency is that of Doppler, and no block begins with a step.
#[test]
fn a_moving_listener_hears_doppler_and_no_clicks() {
    let hall = nowhere();
    let n = 40 * BLOCK;
    let omega = std::f64::consts::TAU * 1000.0 / 16_000.0;
    let tone: Vec<f32> = (0..n).map(|k| (omega * k as f64).sin() as f32).collect();
    // Straight towards the source at 1 m/s, from 6 m.
    let walk = |k: usize| {
        (
            Vec3::ZERO,
            Receiver::omni(Vec3::X * (6.0 - 0.05 * (k + 1) as f32)),
        )
    };
    let heard = &play(&hall, &mut stream(&hall, StreamConfig::full()), &tone, walk)[0];
    // The phase at the ends of blocks, where no crossfade is under way.
    let phase = |end: usize| {
        let (mut re, mut im) = (0.0, 0.0);
        for (k, x) in heard.iter().enumerate().take(end).skip(end - 48) {
            let (s, c) = (omega * k as f64).sin_cos();
            re += f64::from(*x) * c;
            im += f64::from(*x) * s;
        }
        re.atan2(im)
    };
    let mut turned = 0.0;
    let blocks: Vec<f64> = (4..=40).map(|k| phase(k * BLOCK)).collect();
    for pair in blocks.windows(2) {
        turned += (pair[1] - pair[0] + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU)
            - std::f64::consts::PI;
    }
    let shift_hz = turned / std::f64::consts::TAU / (36.0 * 0.05);
    assert!((shift_hz - 1000.0 / 343.2).abs() < 0.1, "{shift_hz} Hz");
    // A sine follows x[n] = 2 cos(omega) x[n-1] - x[n-2]; a click does not.
    let peak = heard.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
    // It begins to walk in block 2, all at once.
    for k in 2 * BLOCK + 2..n {
        let residual = f64::from(heard[k]) - 2.0 * omega.cos() * f64::from(heard[k - 1])
            + f64::from(heard[k - 2]);
        let at = format!("sample {} of block {}: {residual}", k % BLOCK, k / BLOCK);
        // -60 dB of the tone; its Doppler shift alone leaves 5e-4.
        assert!(residual.abs() < 1e-3 * f64::from(peak), "{at}");
    }
}

/// Two rooms and a doorway between, in which sound bends.
fn flat() -> Hall {
    let hard = material(0.2, 0.4);
    let mut items: Vec<_> = box_sides(Vec3::new(8.0, 2.5, 4.0), 1)
        .map(|side| (side, hard.clone()))
        .into();
    for (z, width) in [(0.0, 1.5), (2.5, 1.5)] {
        let corner = Vec3::new(4.0, 0.0, z);
        items.push((
            rectangle(corner, Vec3::Y * 2.5, Vec3::Z * width, 1),
            hard.clone(),
        ));
    }
    let config = AcousticConfig {
        max_duration_s: 0.7,
        image_order: 2,
        diffraction: true,
        ..dry(300)
    };
    Hall::new(pieces(items), config)
}

/// While source and listener walk, what is heard has no clicks: a tone of 200 Hz stays smooth from sample to sample, also where it
/// begins to move, where responses change, where the source goes out of sight, and where the listener stops.
#[test]
fn a_walk_through_a_room_is_smooth() {
    let n = 70 * BLOCK;
    let omega = std::f64::consts::TAU * 200.0 / 16_000.0;
    let tone: Vec<f32> = (0..n).map(|k| (omega * k as f64).sin() as f32).collect();
    for (hall, start, step) in [
        (room(), Vec3::new(4.6, 1.2, 3.3), Vec3::new(-0.05, 0.0, 0.0)),
        (flat(), Vec3::new(5.2, 1.2, 2.1), Vec3::new(0.02, 0.0, 0.03)),
    ] {
        for config in [StreamConfig::rl(), StreamConfig::full()] {
            let walk = |k: usize| {
                // It stands, walks, and stands again.
                let way = k.clamp(14, 60) as f32 - 14.0;
                let source = SOURCE + Vec3::Z * (0.02 * way);
                (source, head(start + step * way, 0.7 + 0.05 * way))
            };
            let heard = play(&hall, &mut stream(&hall, config), &tone, walk);
            for channel in &heard {
                // The tone itself begins with a click, and it takes the room a while to be full of it.
                let settled = 13 * BLOCK;
                let peak = channel[settled..]
                    .iter()
                    .fold(0.0_f32, |peak, x| peak.max(x.abs()));
                for k in settled..n {
                    // The second difference of 200 Hz is omega² of it; a step of -60 dB of the peak would stand out by 1e-3.
                    let curve = channel[k] - 2.0 * channel[k - 1] + channel[k - 2];
                    let residual = curve + (omega * omega) as f32 * channel[k - 1];
                    let at = format!("sample {} of block {}: {residual}", k % BLOCK, k / BLOCK);
                    assert!(residual.abs() < 1e-3 * peak, "{at} of {peak}");
                }
            }
        }
    }
}

/// A listener walks through a box of mirrors: what is heard is the sum of the images, each at the moment that its sound left.
#[test]
fn moving_images_sum_up_as_theory_has_it() {
    let size = [6.0, 3.0, 5.0];
    let config = AcousticConfig {
        image_order: 1,
        ..dry(0)
    };
    let hall = Hall::shoebox(size, &material(0.36, 0.0), config);
    // Five tones that fit no block.
    let tones = [130.7, 411.3, 987.1, 2203.9, 4011.3];
    let played = |t: f64| -> f64 {
        tones
            .iter()
            .map(|hz| (std::f64::consts::TAU * hz * t).sin())
            .sum()
    };
    let n = 30 * BLOCK;
    let signal: Vec<f32> = (0..n).map(|k| played(k as f64 / 16_000.0) as f32).collect();
    // At the end of block k.
    let at = |k: f64| glam::DVec3::new(4.6 - 0.06 * k, 1.2 + 0.01 * k, 3.3 - 0.04 * k);
    let walk = |k: usize| (SOURCE, Receiver::omni(at(k as f64).as_vec3()));
    let settings = StreamConfig {
        tracked_reflections: 64,
        ..StreamConfig::full()
    };
    let heard = &play(&hall, &mut stream(&hall, settings), &signal, walk)[0];
    let source = SOURCE.as_dvec3();
    let mut images = vec![(source, 1.0)];
    for axis in 0..3 {
        for wall in [0.0, f64::from(size[axis])] {
            let mut image = source;
            image[axis] = 2.0 * wall - image[axis];
            images.push((image, 0.8));
        }
    }
    let (mut error, mut power) = (0.0, 0.0);
    // In block 0 it stands, in block 1 it starts.
    for (k, found) in heard.iter().enumerate().skip(3 * BLOCK) {
        let block = (k + 1) as f64 / BLOCK as f64 - 1.0;
        // Between the ends of blocks each path's length changes evenly.
        let (before, way) = (block.floor(), block - block.floor());
        let wanted: f64 = images
            .iter()
            .map(|(image, amplitude)| {
                let (a, b) = (image.distance(at(before)), image.distance(at(before + 1.0)));
                let length = a + (b - a) * way;
                amplitude / length * played(k as f64 / 16_000.0 - length / 343.2)
            })
            .sum();
        error += (f64::from(*found) - wanted).powi(2);
        power += wanted * wanted;
    }
    let off_db = 10.0 * (error / power).log10();
    assert!(off_db < -50.0, "{off_db} dB");
}

#[test]
fn turning_the_head_needs_no_rays_and_swaps_the_ears() {
    let hall = room();
    let place = Vec3::new(1.7, 1.5, 1.8);
    // The source is to the left at first, then to the right.
    let towards = dwell_scene::space::yaw_from_forward(SOURCE - place);
    let half = std::f32::consts::FRAC_PI_2;
    let state = State::new(&hall.house);
    let mut stream = stream(
        &hall,
        StreamConfig {
            start_share: 1.0,
            ..StreamConfig::rl()
        },
    );
    let mut signal = vec![0.0; BLOCK];
    signals::synthesize("tap", 16_000, 0, &mut signal).unwrap();
    let mut levels = Vec::new();
    for k in 0..12 {
        let yaw = if k < 6 {
            towards - half
        } else {
            towards + half
        };
        let source = ActiveSource {
            id: 1,
            position: SOURCE,
            signal: &signal,
        };
        let mut out = vec![0.0; 2 * BLOCK];
        let report = stream
            .render_block(&hall.rays, &state, &[source], &head(place, yaw), &mut out)
            .unwrap();
        assert_eq!(report.traced_responses, usize::from(k == 0));
        assert_eq!(report.rotated, usize::from(k == 6));
        levels.push([0, 1].map(|c| {
            out[c * BLOCK..(c + 1) * BLOCK]
                .iter()
                .map(|x| x * x)
                .sum::<f32>()
        }));
    }
    assert!(
        levels[4][0] > 1.2 * levels[4][1] && levels[11][1] > 1.2 * levels[11][0],
        "{levels:?}"
    );
}

/// Snapshots hold everything: a restored stream goes on bit for bit, also where the next impulse response is another.
#[test]
fn a_restored_stream_continues_bit_for_bit() {
    let hall = room();
    let signal = radio(12 * BLOCK);
    let walk = |k: usize| {
        (
            SOURCE,
            head(Vec3::new(4.6, 1.2, 3.3 - 0.1 * k as f32), 0.1 * k as f32),
        )
    };
    let mut first = stream(&hall, StreamConfig::rl());
    play(&hall, &mut first, &signal[..6 * BLOCK], walk);
    let bytes = first.snapshot();
    let mut second = stream(&hall, StreamConfig::rl());
    second.restore(&bytes).unwrap();
    assert_eq!(first.hash(), second.hash());
    let on = |stream: &mut Stream| play(&hall, stream, &signal[6 * BLOCK..], |k| walk(k + 6));
    let (a, b) = (on(&mut first), on(&mut second));
    assert_eq!(a, b);
    assert_eq!(first.hash(), second.hash());

    for k in [0, 9, bytes.len() / 2, bytes.len() - 1] {
        let mut damaged = bytes.clone();
        damaged[k] ^= 1;
        assert!(second.restore(&damaged).is_err());
    }
    assert!(second.restore(&[]).is_err());
    let mut other = stream(
        &hall,
        StreamConfig {
            block_samples: 400,
            ..StreamConfig::rl()
        },
    );
    assert!(
        other
            .restore(&bytes)
            .unwrap_err()
            .to_string()
            .contains("800")
    );
}

/// Responses are not stored but rendered again from their energies, wherever the noise of their tails came from: a rotated
/// head, a second source that reused the first one's, warmer air. An array's are stored, with each microphone's own paths.
#[test]
fn responses_come_back_to_the_bit() {
    let hall = room();
    let blocks = 14;
    let signal = radio(blocks * BLOCK);
    let around = |yaw: f32| Pose::from_position_yaw(Vec3::new(4.6, 1.2, 3.3), yaw);
    let pair = [-0.1, 0.1].map(|x| Microphone::omni(Vec3::new(x, 0.0, 0.0)));
    let receivers: [&dyn Fn(f32) -> Receiver; 4] = [
        &|yaw| Receiver::binaural(around(yaw)),
        &|yaw| Receiver::omni(around(yaw).position),
        &|yaw| Receiver::ambisonics(around(yaw), 1),
        &|yaw| Receiver::array(around(yaw), pair.to_vec()),
    ];
    for (kind, receiver) in receivers.into_iter().enumerate() {
        let mut state = State::new(&hall.house);
        let mut through = stream(&hall, StreamConfig::rl());
        for (k, block) in signal.chunks_exact(BLOCK).enumerate() {
            if k == 9 {
                let warmer = [("offset_k", 10.0)];
                state
                    .laws
                    .push(LawSpec::new("temperature_error", 1, &warmer));
            }
            let one = |id| ActiveSource {
                id,
                position: SOURCE,
                signal: block,
            };
            let sources = [one(5), one(9)];
            let sources = if k < 4 { &sources[..1] } else { &sources[..] };
            let receiver = receiver(if k < 6 { 0.0 } else { 0.3 * k as f32 });
            let bytes = through.snapshot();
            let mut again = stream(&hall, StreamConfig::rl());
            again.restore(&bytes).unwrap();
            let hear = |stream: &mut Stream| {
                let mut out = vec![0.0; receiver.channels() * BLOCK];
                let report = stream.render_block(&hall.rays, &state, sources, &receiver, &mut out);
                (out, report.unwrap())
            };
            assert_eq!(hear(&mut through), hear(&mut again), "{kind}, block {k}");
            assert_eq!(through.hash(), again.hash(), "{kind}, block {k}");
        }
    }
}

#[test]
fn microphones_are_silent_unless_a_law_says_otherwise() {
    let hall = nowhere();
    let mut state = State::new(&hall.house);
    let mut stream = stream(&hall, StreamConfig::rl());
    let mut out = vec![1.0; BLOCK];
    stream
        .render_block(
            &hall.rays,
            &state,
            &[],
            &Receiver::omni(Vec3::ZERO),
            &mut out,
        )
        .unwrap();
    assert!(out.iter().all(|x| *x == 0.0));
    let noise = LawSpec::new("microphone_noise", 1, &[("sigma_pa", 0.01)]);
    state.laws.push(noise);
    let mut blocks = Vec::new();
    for k in 0..3 {
        stream
            .render_block(
                &hall.rays,
                &state,
                &[],
                &Receiver::omni(Vec3::ZERO),
                &mut out,
            )
            .unwrap();
        if k == 0 {
            // A law that comes while the stream runs fades in over one block.
            continue;
        }
        let power = out.iter().map(|x| x * x).sum::<f32>() / BLOCK as f32;
        assert!((power / 1e-4 - 1.0).abs() < 0.3);
        blocks.push(out.clone());
    }
    assert_ne!(blocks[0], blocks[1]);
}

#[test]
fn wrong_buffers_are_refused_and_change_nothing() {
    let hall = nowhere();
    let state = State::new(&hall.house);
    let mut stream = stream(&hall, StreamConfig::rl());
    let before = stream.hash();
    let short = [0.5; 10];
    let source = ActiveSource {
        id: 1,
        position: Vec3::X,
        signal: &short,
    };
    let ear = Receiver::omni(Vec3::ZERO);
    let mut out = vec![0.0; BLOCK];
    let message = stream
        .render_block(&hall.rays, &state, &[source], &ear, &mut out)
        .unwrap_err()
        .to_string();
    assert_eq!(message, "a source's signal: expected 800 samples, found 10");
    let message = stream
        .render_block(&hall.rays, &state, &[], &head(Vec3::ZERO, 0.0), &mut out)
        .unwrap_err()
        .to_string();
    assert_eq!(message, "out: expected 1600 samples, found 800");
    assert_eq!(stream.hash(), before);
}

/// Of two sources only the first may be heard. The second rings out without further input.
#[test]
fn a_source_that_is_left_out_rings_out_and_is_not_fed() {
    let hall = room();
    let state = State::new(&hall.house);
    let listener = Receiver::omni(Vec3::new(4.0, 1.5, 3.5));
    let config = StreamConfig {
        block_samples: BLOCK,
        max_sources: 1,
        ..StreamConfig::default()
    };
    let (loud, silent) = (radio(BLOCK), vec![0.0; BLOCK]);
    let hear = |goes_on: bool| {
        let mut stream = stream(&hall, config);
        let (mut heard, mut out) = (Vec::new(), vec![0.0; BLOCK]);
        for block in 0..4 {
            let second = ActiveSource {
                id: 2,
                position: SOURCE,
                signal: if block == 0 || goes_on {
                    &loud
                } else {
                    &silent
                },
            };
            let first = ActiveSource {
                id: 1,
                position: Vec3::new(2.5, 1.2, 3.0),
                signal: &loud,
            };
            let sources = if block == 0 {
                vec![second]
            } else {
                vec![first, second]
            };
            let rays = &hall.rays;
            let report = stream
                .render_block(rays, &state, &sources, &listener, &mut out)
                .unwrap();
            assert_eq!(report.dropped_sources, usize::from(block > 0));
            heard.extend_from_slice(&out);
        }
        heard
    };
    assert_eq!(hear(true), hear(false));
}
