use super::*;
use dwell_scene::random::RandomKey;

const BASE: WheeledBaseManifest = WheeledBaseManifest {
    wheel_radius_m: 0.042,
    wheel_base_m: 0.2,
    rate_hz: 20.0,
};

/// Turns of the wheels, rad in a sample, over the time of an episode, s.
type Wheels = fn(usize, f64) -> [f64; 2];

const CURVES: Wheels = |k, t| {
    let k = k as f64;
    [
        0.2 + 0.1 * libm::sin(t / 1.5 + k),
        0.2 + 0.1 * libm::cos(t / 2.0 + k),
    ]
};
/// A square with turns on the spot, to either side.
const SQUARE: Wheels = |k, t| {
    let turn = if k % 2 == 0 { 0.11 } else { -0.11 };
    if libm::fmod(t, 3.0) < 2.0 {
        [0.3, 0.3]
    } else {
        [-turn, turn]
    }
};
/// Hardly any turn.
const GENTLE: Wheels = |_, t| [0.24, 0.24 + 0.012 * libm::sin(t)];
/// Forwards and backwards.
const REVERSING: Wheels = |k, t| {
    let speed = 0.3 * libm::cos(t / 2.0);
    [speed - 0.04, speed + 0.04 * k as f64]
};

/// Four episodes of 15 s with noise of so many metres and radians, and a wheel base that is wrong by a factor.
fn drives(wheels: Wheels, noise: [f64; 2], base_factor: f64, seed: u64) -> Vec<Vec<DriveRow>> {
    let mut stream = RandomKey::root(seed).stream();
    let mut episode = |k: usize| {
        let (mut x, mut y, mut heading) = (0.0, 0.0, 0.6 * k as f64 - 0.9);
        let mut rows = Vec::new();
        for j in 0..300 {
            let t_s = f64::from(j) / BASE.rate_hz;
            let [left, right] = if j == 0 { [0.0; 2] } else { wheels(k, t_s) };
            let turn = BASE.wheel_radius_m * (right - left) / (BASE.wheel_base_m * base_factor);
            let way = 0.5 * BASE.wheel_radius_m * (left + right);
            x += way * libm::cos(heading + 0.5 * turn);
            y += way * libm::sin(heading + 0.5 * turn);
            heading += turn;
            rows.push(DriveRow {
                episode: k.to_string(),
                t_s,
                x: x + noise[0] * stream.normal(),
                y: y + noise[0] * stream.normal(),
                heading: wrapped(heading + noise[1] * stream.normal()),
                left_rad: left,
                right_rad: right,
            });
        }
        rows
    };
    (0..4).map(&mut episode).collect()
}

fn evidence(drives: &[Vec<DriveRow>]) -> HeadingEvidence {
    let mut evidence = HeadingEvidence::default();
    for rows in drives {
        evidence.add(rows, &BASE);
    }
    evidence
}

fn changed(drives: &[Vec<DriveRow>], change: impl Fn(&mut DriveRow)) -> Vec<Vec<DriveRow>> {
    let mut drives = drives.to_vec();
    drives.iter_mut().flatten().for_each(change);
    drives
}

/// Does what a reading's hint says.
fn followed(drives: &[Vec<DriveRow>], reading: ColumnReading) -> Vec<Vec<DriveRow>> {
    changed(drives, |row| {
        row.heading *= SCALES[reading.scale];
        match (
            reading.is_clockwise,
            reading.turns_against_wheels,
            reading.quarters,
        ) {
            (false, true, 2) => {
                (row.left_rad, row.right_rad) = (-row.left_rad, -row.right_rad);
                return;
            }
            (true, true, 0) => return row.y = -row.y,
            (true, true, 1) => return (row.x, row.y) = (row.y, row.x),
            (true, true, 2) => return row.x = -row.x,
            (true, true, _) => return (row.x, row.y) = (-row.y, -row.x),
            (false, true, _) => (row.left_rad, row.right_rad) = (row.right_rad, row.left_rad),
            _ => {}
        }
        if reading.is_clockwise {
            row.heading = -row.heading;
        }
        row.heading += 0.5 * PI * reading.quarters as f64;
    })
}

type Slip = (&'static str, fn(&mut DriveRow));
const SLIPS: [Slip; 14] = [
    ("do headings grow clockwise? Turn the sign", |row| {
        row.heading = -row.heading;
    }),
    ("as of a compass", |row| {
        row.heading = 0.5 * PI - row.heading;
    }),
    ("headings in degrees? Divide by 57.2958", |row| {
        row.heading *= DEGREES;
    }),
    ("headings in degrees? Divide by 57.2958", |row| {
        row.heading = libm::fmod(row.heading + TAU, TAU) * DEGREES;
    }),
    ("headings in degrees? do headings grow clockwise?", |row| {
        row.heading *= -DEGREES;
    }),
    (
        "headings in degrees? do headings grow clockwise, as of a compass",
        |row| {
            row.heading = 90.0 - row.heading * DEGREES;
        },
    ),
    ("were headings in radians read as degrees? Leave", |row| {
        row.heading /= DEGREES;
    }),
    (
        "were headings in radians read as degrees? do headings grow clockwise?",
        |row| {
            row.heading /= -DEGREES;
        },
    ),
    ("are left and right exchanged", |row| {
        (row.left_rad, row.right_rad) = (row.right_rad, row.left_rad);
    }),
    ("do wheels count backwards", |row| {
        (row.left_rad, row.right_rad) = (-row.left_rad, -row.right_rad);
    }),
    ("do headings point to the back", |row| row.heading += PI),
    ("from another axis than x", |row| row.heading -= 0.5 * PI),
    ("Turn the sign of y", |row| row.y = -row.y),
    ("Exchange the two columns of \"position\"", |row| {
        (row.x, row.y) = (row.y, row.x);
    }),
];

#[test]
fn a_slip_is_told_by_name_and_what_is_told_mends_it() {
    for (index, wheels) in [CURVES, SQUARE, REVERSING].into_iter().enumerate() {
        for (noise, factor) in [([0.0; 2], 1.0), ([0.003, 0.02], 1.2)] {
            let right = drives(wheels, noise, factor, 7);
            assert!(evidence(&right).check("d").is_ok(), "{index}");
            for (told, slip) in SLIPS {
                let wrong = changed(&right, slip);
                let said = evidence(&wrong).check("d").unwrap_err().to_string();
                assert!(
                    said.contains(told) && !said.contains("; or "),
                    "{index} {told}: {said}"
                );
                let [reading] = evidence(&wrong).explanations()[..] else {
                    panic!("{index} {told}: {said}");
                };
                let mended = evidence(&followed(&wrong, reading));
                assert!(
                    mended.check("d").is_ok() && mended.is_along_headings(),
                    "{index} {told}"
                );
            }
        }
    }
}

#[test]
fn two_slips_are_told_together() {
    let right = drives(CURVES, [0.001, 0.005], 1.0, 3);
    let wrong = changed(&right, |row| {
        row.heading *= DEGREES;
        (row.left_rad, row.right_rad) = (row.right_rad, row.left_rad);
    });
    let said = evidence(&wrong).check("d").unwrap_err().to_string();
    assert!(
        said.contains("headings in degrees? Import") && said.contains("exchanged"),
        "{said}"
    );
    let [reading] = evidence(&wrong).explanations()[..] else {
        panic!("{said}");
    };
    assert!(evidence(&followed(&wrong, reading)).check("d").is_ok());
}

/// Nearly straight: what cannot be told apart is told as what it may be, and each of it mends.
#[test]
fn drives_that_hardly_turn_have_hints_that_mend() {
    let right = drives(GENTLE, [0.001, 0.005], 1.0, 5);
    assert!(evidence(&right).check("d").is_ok());
    for (told, slip) in SLIPS {
        let wrong = changed(&right, slip);
        for reading in evidence(&wrong).explanations() {
            let mended = evidence(&followed(&wrong, reading));
            assert!(
                mended.check("d").is_ok() && mended.is_along_headings(),
                "{told}"
            );
        }
    }
}

#[test]
fn what_is_right_is_never_refused_for_its_noise() {
    for wheels in [CURVES, SQUARE, GENTLE, REVERSING] {
        for (k, noise) in [0.0, 0.001, 0.01, 0.05, 0.3].into_iter().enumerate() {
            for (j, angle) in [0.0, 0.02, 0.2, 1.0].into_iter().enumerate() {
                for factor in [0.6, 1.0, 1.5] {
                    let right = drives(wheels, [noise, angle], factor, (4 * k + j) as u64);
                    let said = evidence(&right).check("d");
                    assert!(said.is_ok(), "{noise} {angle} {factor}: {said:?}");
                }
            }
        }
    }
    let still = drives(|_, _| [0.0; 2], [0.002, 0.01], 1.0, 1);
    assert!(evidence(&still).check("d").is_ok());
    assert!(HeadingEvidence::default().check("d").is_ok());
}

#[test]
fn what_stays_within_a_turn_is_never_told_as_degrees() {
    for wheels in [CURVES, SQUARE, REVERSING] {
        let right = drives(wheels, [0.002, 0.01], 1.0, 2);
        for (told, slip) in SLIPS {
            let wrong = changed(&right, slip);
            if wrong.iter().flatten().all(|row| row.heading.abs() <= TAU) {
                let said = evidence(&wrong).check("d").unwrap_err().to_string();
                assert!(!said.contains("headings in degrees"), "{told}: {said}");
            }
        }
    }
}
