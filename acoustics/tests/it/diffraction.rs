//! Diffraction around edges, against the exact solution for a wedge, and properties of any edge.

#![allow(clippy::unwrap_used, reason = "tests may stop at the first surprise")]

use crate::common;

use common::{Hall, box_sides, dry, material, pieces, rectangle};
use dwell_acoustics::bands::{BAND_COUNT, NOMINAL_CENTRES_HZ};
use dwell_acoustics::{AcousticConfig, Receiver, SoundSourcePose};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{Bands, Material};
use glam::Vec3;
use std::f64::consts::{PI, TAU};

const SPEED_M_S: f64 = 343.2;

/// No tail and no reflections: diffraction alone.
fn bending() -> AcousticConfig {
    AcousticConfig {
        image_order: 0,
        diffraction: true,
        ..dry(0)
    }
}

/// A screen in the plane x = 0, 40 m long, from far below up to y = 0: nearly a half-plane.
fn screen() -> Hall {
    let sheet = rectangle(
        Vec3::new(0.0, -40.0, -20.0),
        Vec3::Y * 40.0,
        Vec3::Z * 40.0,
        1,
    );
    Hall::new(pieces(vec![(sheet, material(0.0, 0.0))]), bending())
}

/// Energy of all paths re 1/d² of the straight line. Shape (band,).
fn level(hall: &Hall, source: Vec3, receiver: Vec3) -> [f64; BAND_COUNT] {
    let paths = hall
        .scene
        .early_paths(&hall.rays, &SoundSourcePose::omni(source), receiver)
        .unwrap();
    let d = f64::from(source.distance(receiver));
    let mut sum = [0.0; BAND_COUNT];
    for one in &paths {
        for (sum, e) in sum.iter_mut().zip(one.path.energy) {
            *sum += f64::from(e) * d * d;
        }
    }
    sum
}

/// The pressure behind a hard screen, re a free path over its edge: the integral over the edge that is exact for hard wedges, with
/// the angles of source and receiver from the screen's face.
///
/// Source: M. A. Biot, I. Tolstoy, JASA 29, 381 (1957); as a line integral U. P. Svensson, R. I. Fred, J. Vanderkooy, JASA 106,
/// 2331 (1999), equations 22 to 26.
fn exact_db(source: (f64, f64), receiver: (f64, f64), frequency_hz: f64) -> f64 {
    const STEPS: usize = 400_000;
    let half_m = 20.0;
    let nu = 0.5;
    let (rs, ts, rr, tr) = (source.0, source.1, receiver.0, receiver.1);
    let (mut re, mut im) = (0.0, 0.0);
    for k in 0..STEPS {
        let z = half_m * (2.0 * (k as f64 + 0.5) / STEPS as f64 - 1.0);
        let (m, l) = (rs.hypot(z), rr.hypot(z));
        let eta = ((m * l + z * z) / (rs * rr)).max(1.0).acosh();
        let turn = (nu * eta).cosh();
        let angles = [PI + ts + tr, PI + ts - tr, PI - ts + tr, PI - ts - tr];
        let beta: f64 = angles
            .iter()
            .map(|a| (nu * a).sin() / (turn - (nu * a).cos()))
            .sum();
        // The far ends fade out, so that they do not sound.
        let fade = (2.0 * (half_m - z.abs()) / half_m).clamp(0.0, 1.0);
        let weight = beta / (m * l) * (0.5 - 0.5 * (PI * fade).cos());
        let phase = -TAU * frequency_hz / SPEED_M_S * (m + l);
        re += weight * phase.cos();
        im += weight * phase.sin();
    }
    let step_m = 2.0 * half_m / STEPS as f64;
    let h = nu / (4.0 * PI) * step_m * re.hypot(im);
    20.0 * (h * (rs + rr)).log10()
}

/// Over all bands and angles within 3.2 dB of the exact solution, and within 1.8 dB in the mean of squares.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn a_screen_shadows_as_the_exact_solution_has_it() {
    let hall = screen();
    let (mut squares, mut count) = (0.0, 0);
    for (rs, ts, rr, tr) in [
        (2.0, 90.0_f64, 2.0, 280.0_f64),
        (2.0, 90.0, 2.0, 300.0),
        (2.0, 90.0, 2.0, 330.0),
        (2.0, 45.0, 2.0, 240.0),
        (2.0, 45.0, 2.0, 300.0),
        (2.0, 135.0, 2.0, 340.0),
        (1.0, 90.0, 3.0, 275.0),
        (2.0, 20.0, 2.0, 300.0),
    ] {
        let (ts, tr) = (ts.to_radians(), tr.to_radians());
        // Angle 0 is straight down, and grows over the side of positive x.
        let place = |r: f64, t: f64| Vec3::new((r * t.sin()) as f32, (-r * t.cos()) as f32, 0.0);
        let (source, receiver) = (place(rs, ts), place(rr, tr));
        let found = level(&hall, source, receiver);
        let d = f64::from(source.distance(receiver));
        let over = rs + rr;
        for (band, centre_hz) in NOMINAL_CENTRES_HZ.into_iter().enumerate() {
            let found_db = 10.0 * (found[band] * over * over / (d * d)).log10();
            let off = found_db - exact_db((rs, ts), (rr, tr), f64::from(centre_hz));
            assert!(
                off.abs() < 3.2,
                "{rs} {ts} {rr} {tr}: {centre_hz} Hz, {off} dB off"
            );
            squares += off * off;
            count += 1;
        }
    }
    let rms = (squares / f64::from(count)).sqrt();
    assert!(rms < 1.8, "{rms} dB");
}

/// A receiver that climbs out of the shadow of a screen hears no jump in any band, and the whole sound in the end.
#[test]
fn nothing_jumps_at_the_border_of_the_shadow() {
    let hall = screen();
    let source = Vec3::new(-1.5, -0.4, 0.3);
    let mut before: Option<[f64; BAND_COUNT]> = None;
    for k in 0..=400 {
        let receiver = Vec3::new(2.0, -2.0 + 0.01 * k as f32, -0.2);
        let now = level(&hall, source, receiver);
        for (band, now) in now.iter().enumerate() {
            assert!(*now > 0.0 && *now < 1.0 + 1e-4, "{receiver} {band}: {now}");
            if let Some(before) = before {
                let step_db = 10.0 * (now / before[band]).log10();
                assert!(step_db.abs() < 0.8, "{receiver} {band}: {step_db} dB");
            }
        }
        before = Some(now);
    }
    let high = level(&hall, source, Vec3::new(2.0, 9.0, 0.0));
    assert!(high.iter().all(|e| (e - 1.0).abs() < 1e-4), "{high:?}");
}

/// Forth and back the same ways, the same energies.
#[test]
fn ways_around_edges_are_reciprocal() {
    let hall = doorway();
    let source = Vec3::new(1.0, 1.2, 1.0);
    for ear in [
        Vec3::new(7.0, 1.5, 3.3),
        Vec3::new(5.0, 1.2, 0.6),
        Vec3::new(4.4, 0.5, 3.5),
        Vec3::new(4.2, 1.9, 1.0),
    ] {
        let there = level(&hall, source, ear);
        let back = level(&hall, ear, source);
        for (there, back) in there.iter().zip(back) {
            assert!(*there > 0.0 && (there / back - 1.0).abs() < 1e-3, "{ear}");
        }
    }
}

/// Two rooms with a wall 0.1 m thick between and an opening of 1 x 2 m in it; nothing gets through the wall.
fn doorway() -> Hall {
    let hard = material(0.1, 0.1);
    let mut items: Vec<_> = box_sides(Vec3::new(8.0, 2.5, 4.0), 1)
        .map(|side| (side, hard.clone()))
        .into();
    for x in [3.95, 4.05] {
        let at = |y, z| Vec3::new(x, y, z);
        for (corner, y, z) in [
            (at(0.0, 0.0), 2.5, 1.5),
            (at(0.0, 2.5), 2.5, 1.5),
            (at(2.0, 1.5), 0.5, 1.0),
        ] {
            items.push((rectangle(corner, Vec3::Y * y, Vec3::Z * z, 1), hard.clone()));
        }
    }
    let depth = Vec3::X * 0.1;
    for (corner, along) in [
        (Vec3::new(3.95, 0.0, 1.5), Vec3::Y * 2.0),
        (Vec3::new(3.95, 0.0, 2.5), Vec3::Y * 2.0),
        (Vec3::new(3.95, 2.0, 1.5), Vec3::Z),
    ] {
        items.push((rectangle(corner, along, depth, 1), hard.clone()));
    }
    Hall::new(pieces(items), bending())
}

/// The frame of a door has three edges on either side; floor, walls and the seams within the wall have none.
#[test]
fn a_doorway_has_six_edges() {
    let hall = doorway();
    let edges: Vec<_> = hall.scene.edges().collect();
    let frame = |edge: &&&dwell_acoustics::DiffractionEdge| {
        let middle = edge.ends[0].lerp(edge.ends[1], 0.5);
        (middle.z - 2.0).abs() < 0.51
            && middle.y < 2.01
            && edge.air_angle_rad < 4.8
            && middle.y > 0.9
    };
    assert_eq!(edges.iter().filter(frame).count(), 6, "{edges:?}");
    let seam = |edge: &&&dwell_acoustics::DiffractionEdge| {
        edge.ends
            .iter()
            .all(|end| end.y > 1.99 && (end.z - 1.5).abs() < 0.01)
    };
    assert_eq!(edges.iter().filter(seam).count(), 0, "{edges:?}");
}

/// Around one corner of the frame where the other is not in the way, around both where it is; low frequencies are
/// diffracted more.
#[test]
fn sound_goes_around_a_door_frame() {
    let hall = doorway();
    let source = Vec3::new(1.0, 1.2, 1.0);
    let bends = |receiver: Vec3| {
        let paths = hall
            .scene
            .early_paths(&hall.rays, &SoundSourcePose::omni(source), receiver)
            .unwrap();
        assert!(!paths.is_empty(), "nothing reaches {receiver}");
        for one in &paths {
            let legs = one.points.windows(2).map(|leg| leg[0].distance(leg[1]));
            let off = f64::from(legs.sum::<f32>()) - one.path.length_m;
            assert!(off.abs() < 2e-3, "{one:?}");
            let e = one.path.energy;
            assert!(e[7] < 0.5 * e[3], "{e:?}");
        }
        paths[0].path.diffraction_points.len()
    };
    // Straight through the opening to the far jamb, then behind the near one.
    assert_eq!(bends(Vec3::new(5.5, 1.2, 3.7)), 1);
    assert_eq!(bends(Vec3::new(5.0, 1.2, 0.6)), 2);
}

/// A board of 0.8 m in the way of a wave of 5.5 m: the wave hardly notices; the board shadows 8 kHz.
#[test]
fn small_things_shadow_short_waves_only() {
    let board = rectangle(Vec3::new(0.0, -0.4, -0.4), Vec3::Y * 0.8, Vec3::Z * 0.8, 1);
    let hall = Hall::new(pieces(vec![(board, material(0.0, 0.0))]), bending());
    let (source, receiver) = (Vec3::new(-2.0, 0.02, 0.0), Vec3::new(2.0, 0.1, 0.15));
    let found = level(&hall, source, receiver);
    assert!(found[0] > 0.6 && found[0] <= 1.0 + 1e-6, "{found:?}");
    assert!(found[7] < 0.1, "{found:?}");
    // What is heard begins when the wave around the nearest edge is there.
    let response = hall
        .scene
        .impulse_response(
            &hall.rays,
            &SoundSourcePose::omni(source),
            &Receiver::omni(receiver),
            RandomKey::root(1),
            Threads::ONE,
        )
        .unwrap();
    let peak = response.samples.iter().fold(0.0_f32, |m, x| m.max(x.abs()));
    assert!(peak > 0.05 && response.samples.iter().all(|x| x.is_finite()));
}

/// A post 0.1 m wide and 2 m tall: long waves go around both of its sides and meet again behind it.
#[test]
fn a_post_is_nothing_to_long_waves() {
    let post = rectangle(Vec3::new(0.0, -1.0, -0.05), Vec3::Y * 2.0, Vec3::Z * 0.1, 1);
    let hall = Hall::new(pieces(vec![(post, material(0.0, 0.0))]), bending());
    let found = level(&hall, Vec3::new(-2.0, 0.02, 0.01), Vec3::new(2.0, 0.1, 0.0));
    for (band, level) in found.iter().enumerate().take(3) {
        assert!(*level > 0.5 && *level <= 1.0 + 1e-6, "{band}: {found:?}");
    }
}

/// Through a doorway out of sight: no band rises or falls by more than 1.5 dB in a step of 1 cm, in the doorway and past its jamb.
#[test]
fn walking_out_of_sight_is_smooth() {
    let hall = doorway();
    let source = Vec3::new(2.0, 1.2, 2.1);
    let mut before: Option<[f64; BAND_COUNT]> = None;
    let mut kinds = std::collections::BTreeSet::new();
    for k in 0..=140 {
        let receiver = Vec3::new(5.5, 1.3, 2.0 + 0.01 * k as f32);
        let paths = hall
            .scene
            .early_paths(&hall.rays, &SoundSourcePose::omni(source), receiver)
            .unwrap();
        kinds.extend(paths.iter().map(|one| one.path.diffraction_points.len()));
        let now = level(&hall, source, receiver);
        if let Some(before) = before {
            for (band, (now, before)) in now.iter().zip(before).enumerate() {
                let step_db = 10.0 * (now / before).log10();
                assert!(step_db.abs() < 1.5, "{receiver} {band}: {step_db} dB");
            }
        }
        before = Some(now);
    }
    assert!(kinds.contains(&0) && kinds.contains(&1), "{kinds:?}");
}

/// A curtain that transmits most sound: transmitted and diffracted sound together are no more than a free path.
#[test]
fn what_comes_through_does_not_go_around_as_well() {
    for loss_db in [0.5, 3.0, 20.0] {
        let curtain = Material {
            transmission_loss_db: Bands::constant(loss_db),
            ..material(0.0, 0.0)
        };
        let sheet = rectangle(Vec3::new(0.0, -2.0, -1.0), Vec3::Y * 2.0, Vec3::Z * 2.0, 1);
        let config = AcousticConfig {
            transmission: true,
            ..bending()
        };
        let hall = Hall::new(pieces(vec![(sheet, curtain)]), config);
        let found = level(&hall, Vec3::new(-1.5, -0.3, 0.1), Vec3::new(1.5, -0.2, 0.0));
        let through = f64::from(10.0_f32.powf(-0.1 * loss_db));
        for (band, level) in found.iter().enumerate() {
            assert!(
                *level >= 0.999 * through && *level <= 1.0,
                "{loss_db} {band}: {level}"
            );
        }
    }
}

/// So far away that air leaves nothing of high notes: what is left is a number in every band.
#[test]
fn far_away_behind_a_thin_screen_every_energy_is_a_number() {
    let curtain = Material {
        transmission_loss_db: Bands::constant(3.0),
        ..material(0.0, 0.0)
    };
    let sheet = rectangle(Vec3::new(0.0, -2.0, -1.0), Vec3::Y * 2.0, Vec3::Z * 2.0, 1);
    let config = AcousticConfig {
        transmission: true,
        air_absorption: true,
        ..bending()
    };
    let hall = Hall::new(pieces(vec![(sheet, curtain)]), config);
    let found = level(&hall, Vec3::new(-1.5, -0.3, 0.1), Vec3::new(9e5, -0.2, 0.0));
    assert!(
        found.iter().all(|e| e.is_finite() && *e >= 0.0),
        "{found:?}"
    );
    assert!(found[7] <= 0.0, "{found:?}");
}

/// A source on an edge, a receiver in its line, points in one place: no panic, no number that is none.
#[test]
fn points_on_edges_are_no_trouble() {
    let hall = screen();
    let on = Vec3::new(0.0, 0.0, 1.0);
    for (source, receiver) in [
        (on, Vec3::new(0.0, 0.0, -3.0)),
        (on, Vec3::new(1.0, -1.0, 0.0)),
        (Vec3::new(1.0, -1.0, 0.0), on),
        (on, on),
        (Vec3::new(0.0, -1.0, 0.0), Vec3::new(0.0, -1.0, 1.0)),
    ] {
        let found = level(&hall, source, receiver);
        assert!(
            found.iter().all(|e| e.is_finite() && *e >= 0.0),
            "{found:?}"
        );
    }
}
