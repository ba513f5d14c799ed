//! Effects hidden in balls that bounce, slide and roll on a board, made by closed forms between located impacts, and the
//! verdicts they must get.

#![expect(
    clippy::unwrap_used,
    reason = "a test stops at the first surprise, in its helpers too"
)]

use crate::calibration_support;

use calibration_support::{Files, Random, table};
use dwell_calibration::{CalibrationReport, CalibrationVerdict, Options, calibrate};

const G: f64 = 9.806_65;
const MASS_KG: f64 = 0.4;
const RADIUS_M: f64 = 0.05;
const RATE_HZ: f64 = 120.0;
const SAMPLES: usize = 150;
/// Bouncing episodes, then those that begin on the board.
const EPISODES: [usize; 2] = [8, 8];
const NOISE_M: f64 = 1e-3;
const NOISE_RAD_S: f64 = 0.3;
/// What the bundle says.
const FRICTION: f64 = 0.3;
const RESTITUTION: f64 = 0.8;
/// I / (m r²) of a solid ball.
const INERTIA: f64 = 0.4;
/// Slower rebounds are none, m/s.
const STAYS_M_S: f64 = 1e-3;

#[derive(Clone, Copy)]
struct Contact {
    friction: f64,
    restitution: f64,
    /// Fall of the restitution with the speed of approach beyond 1 m/s, s/m.
    slope_s_m: f64,
    rolling: f64,
    /// The tracker's zero above the board, m.
    zero_m: f64,
}

impl Default for Contact {
    fn default() -> Self {
        Self {
            friction: FRICTION,
            restitution: RESTITUTION,
            slope_s_m: 0.0,
            rolling: 0.0,
            zero_m: 0.0,
        }
    }
}

/// A ball over a plane: place, velocity and spin.
#[derive(Clone, Copy)]
struct Ball {
    place: [f64; 3],
    speed: [f64; 3],
    spin: [f64; 3],
    rests: bool,
}

impl Ball {
    /// Velocity of the lowest point along x and z: v + w x (0, -r, 0).
    fn slip(&self) -> [f64; 2] {
        [
            self.speed[0] + RADIUS_M * self.spin[2],
            self.speed[2] - RADIUS_M * self.spin[0],
        ]
    }

    /// A blow along the plane, as a change of velocity.
    fn push(&mut self, [x, z]: [f64; 2]) {
        self.speed[0] += x;
        self.speed[2] += z;
        self.spin[2] += x / (INERTIA * RADIUS_M);
        self.spin[0] -= z / (INERTIA * RADIUS_M);
    }

    /// Friction that changes the velocity by at most `most`, and stops the slip if it can.
    fn rub(&mut self, most: f64) {
        let [x, z] = self.slip();
        let size = x.hypot(z);
        if size > 0.0 {
            // A blow b changes the slip by b (1 + m r² / I).
            let blow = most.min(size / (1.0 + 1.0 / INERTIA));
            self.push([-blow * x / size, -blow * z / size]);
        }
    }

    fn bounce(&mut self, contact: &Contact) {
        let approach = -self.speed[1];
        let e = (contact.restitution - contact.slope_s_m * (approach - 1.0)).clamp(0.0, 0.99);
        self.speed[1] = e * approach;
        self.rub(contact.friction * (1.0 + e) * approach);
        if self.speed[1] < STAYS_M_S {
            (self.speed[1], self.place[1], self.rests) = (0.0, RADIUS_M, true);
        }
    }

    /// On the plane, by small steps.
    fn slide(&mut self, contact: &Contact, duration_s: f64) {
        let steps = 40;
        let h = duration_s / f64::from(steps);
        for _ in 0..steps {
            self.rub(contact.friction * G * h);
            let rolling = self.spin[0].hypot(self.spin[2]);
            if contact.rolling > 0.0 && rolling > 0.0 {
                // A torque c N r against the rolling; the friction of rolling shares it between speed and spin.
                let slower = contact.rolling * G * h / (INERTIA * RADIUS_M);
                let share = (slower / rolling).min(1.0);
                self.spin[0] -= share * self.spin[0];
                self.spin[2] -= share * self.spin[2];
                self.rub(contact.friction * G * h);
            }
            for axis in [0, 2] {
                self.place[axis] += h * self.speed[axis];
            }
        }
    }

    fn advance(&mut self, contact: &Contact, mut duration_s: f64) {
        while duration_s > 0.0 {
            if self.rests {
                self.slide(contact, duration_s);
                return;
            }
            let over = self.place[1] - RADIUS_M;
            let v = self.speed[1];
            let impact_s = (v + (v * v + 2.0 * G * over.max(0.0)).sqrt()) / G;
            let flown = impact_s.min(duration_s);
            for axis in [0, 2] {
                self.place[axis] += flown * self.speed[axis];
            }
            self.place[1] += flown * v - 0.5 * G * flown * flown;
            self.speed[1] -= G * flown;
            duration_s -= flown;
            if impact_s <= flown {
                self.place[1] = RADIUS_M;
                self.bounce(contact);
            }
        }
    }
}

fn thrown(contact: Contact, seed: u64) -> CalibrationReport {
    let mut random = Random::new(seed);
    let channels = ["x", "y", "z", "wx", "wy", "wz"].map(|name| {
        let unit = if name.starts_with('w') { "rad/s" } else { "m" };
        format!(r#"{{"name": "{name}", "unit": "{unit}", "clock": "camera", "noise_sd": null}}"#)
    });
    let mut files = Files::new(format!(
        r#"{{"version": 3, "title": "balls on a board", "licence": "CC0-1.0", "kind": "trajectory",
            "scene": {{"environment": {{"g_m_s2": {G}}},
                       "bodies": [{{"name": "ball", "mass_kg": {MASS_KG}, "radius_m": {RADIUS_M}}}],
                       "board": {{"friction": {FRICTION}, "restitution": {RESTITUTION}}}}},
            "channels": [{}]}}"#,
        channels.join(",")
    ));
    for index in 0..EPISODES[0] + EPISODES[1] {
        let name = format!("e{index}");
        files.episode(&name, &format!("g{}", index / 2));
        let rests = index >= EPISODES[0];
        let height = if rests { 0.0 } else { random.range(0.2, 1.6) };
        let spin = if rests { 0.0 } else { 15.0 };
        let mut ball = Ball {
            place: [0.0, RADIUS_M + height, 0.0],
            speed: [
                random.range(-1.5, 1.5),
                if rests { 0.0 } else { random.range(-0.5, 0.5) },
                random.range(-1.5, 1.5),
            ],
            spin: [
                random.range(-1.0, 1.0) * spin,
                random.range(-1.0, 1.0) * 5.0,
                random.range(-1.0, 1.0) * spin,
            ],
            rests,
        };
        for k in 0..SAMPLES {
            if k > 0 {
                ball.advance(&contact, 1.0 / RATE_HZ);
            }
            let t = k as f64 / RATE_HZ;
            for (axis, channel) in ["x", "y", "z"].into_iter().enumerate() {
                let zero = if axis == 1 { contact.zero_m } else { 0.0 };
                let seen = ball.place[axis] - zero + NOISE_M * random.normal();
                files.sample(&name, t, "ball", channel, seen);
            }
            for (axis, channel) in ["wx", "wy", "wz"].into_iter().enumerate() {
                let seen = ball.spin[axis] + NOISE_RAD_S * random.normal();
                files.sample(&name, t, "ball", channel, seen);
            }
        }
    }
    let folder = tempfile::tempdir().unwrap();
    files.write(folder.path());
    let options = Options {
        seed,
        ..Options::default()
    };
    let report = calibrate(folder.path(), &options, &mut |_, _| true).unwrap();
    println!("{}", table(&report));
    report
}

/// The one effect that must be named, and the value of its first parameter.
fn expect_named(report: &CalibrationReport, law: &str, hidden: f64, within: f64) {
    let CalibrationVerdict::Named {
        law: found,
        effects,
        ..
    } = &report.verdict
    else {
        panic!("{}", table(report));
    };
    assert_eq!(
        (found.as_str(), effects.len()),
        (law, 1),
        "{}",
        table(report)
    );
    let value = effects[0].parameters[0].value;
    assert!((value / hidden - 1.0).abs() < within, "{}", table(report));
}

#[test]
fn nothing_is_found_where_the_board_is_as_the_bundle_says() {
    let contact = Contact {
        zero_m: 0.004,
        ..Contact::default()
    };
    let report = thrown(contact, 41);
    assert_eq!(
        report.verdict,
        CalibrationVerdict::NoEffect,
        "{}",
        table(&report)
    );
    let found = report.nuisances[0].value;
    assert!((found - 0.004).abs() < 3e-4, "{found}");
}

#[test]
fn another_restitution_is_named() {
    let contact = Contact {
        restitution: 0.7,
        ..Contact::default()
    };
    expect_named(&thrown(contact, 42), "restitution", 0.7, 0.02);
}

#[test]
fn restitution_that_falls_with_speed_is_named() {
    let contact = Contact {
        slope_s_m: 0.05,
        ..Contact::default()
    };
    expect_named(&thrown(contact, 43), "velocity_restitution", 0.05, 0.1);
}

#[test]
fn another_friction_is_named() {
    let contact = Contact {
        friction: 0.2,
        ..Contact::default()
    };
    expect_named(&thrown(contact, 44), "friction", 0.2, 0.05);
}

#[test]
fn rolling_resistance_is_named() {
    let contact = Contact {
        rolling: 0.02,
        ..Contact::default()
    };
    expect_named(&thrown(contact, 45), "rolling_resistance", 0.02, 0.1);
}
