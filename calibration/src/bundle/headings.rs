//! Whether the headings of a robot agree with its way and its wheels, and which slip explains that they do not.
//!
//! Ways and turns are compared over windows of a second, so that a tracker's noise counts little, under every reading of
//! the columns: headings in another unit, growing clockwise or counted from another axis, wheels exchanged or backwards,
//! positions mirrored.

use super::file::{DriveRow, WheeledBaseManifest};
use super::unit_checks::{DEGREES, degrees_hint};
use crate::error::CalibrationError;
use std::f64::consts::{PI, TAU};

/// Length of a window, s.
const WINDOW_S: f64 = 1.0;
/// Way by the wheels from which on its direction is compared, m.
const TELLING_WAY_M: f64 = 1.0;
/// Sum of squared turns in windows by the wheels from which on turns are compared, rad2.
const TELLING_TURN_RAD2: f64 = 0.2;
/// Misfits of the way's direction and of turns up to which columns are what they are said to be.
const RIGHT: [f64; 2] = [0.1, 0.3];
/// Misfit of either up to which another reading explains them,
const EXPLAINED: f64 = 0.3;
/// and the share of the misfit as said that it leaves at most.
const LEFT: f64 = 0.3;
/// Readings are told together whose misfits are below so many times the least and this.
const CLOSE: [f64; 2] = [2.0, 0.01];
/// Turns by the wheels may be wrong by such factors, as by a wrong wheel base.
const TURN_FACTORS: [f64; 2] = [0.5, 2.0];
/// Most that a heading within a turn to either side, in degrees, may vary by, rad: beyond it those are no degrees.
const MOST_DEGREES_RAD: f64 = 2.0 * TAU / DEGREES;

/// What headings are written in, and what one of them is then, in what was meant.
const SCALES: [f64; 3] = [1.0, 1.0 / DEGREES, DEGREES];

/// What the columns may hold instead of what is said of them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ColumnReading {
    /// Position in [`SCALES`].
    scale: usize,
    /// True if headings as written grow clockwise of the way.
    is_clockwise: bool,
    /// Quarter turns to the left that are added to headings.
    quarters: usize,
    /// True if the wheels turn the other way than headings, as read, do.
    turns_against_wheels: bool,
}

impl ColumnReading {
    const AS_SAID: Self = Self {
        scale: 0,
        is_clockwise: false,
        quarters: 0,
        turns_against_wheels: false,
    };

    fn all() -> impl Iterator<Item = Self> {
        (0..SCALES.len() * 16).map(|k| Self {
            scale: k / 16,
            is_clockwise: k & 8 != 0,
            quarters: k & 3,
            turns_against_wheels: k & 4 != 0,
        })
    }

    /// The number of slips that make it.
    fn slips(self) -> usize {
        let of_axes = match (self.is_clockwise, self.turns_against_wheels, self.quarters) {
            (false, false, 0) => 0,
            (false, true, 1 | 3) | (true, false, 2 | 3) | (true, true, 3) => 2,
            _ => 1,
        };
        of_axes + usize::from(self.scale != 0)
    }

    /// What to write of headings: they are the written ones less a zero, times a factor.
    fn heading_units(self) -> String {
        let sense = if self.is_clockwise { -1.0 } else { 1.0 };
        let factor = sense * SCALES[self.scale];
        let added = [0.0, 0.5 * PI, PI, -0.5 * PI][self.quarters];
        if added == 0.0 {
            return format!("{{\"heading\": {{\"factor\": {factor}}}}}");
        }
        let zero = -added / factor;
        format!("{{\"heading\": {{\"factor\": {factor}, \"zero\": {zero}}}}}")
    }

    /// The remedy, by what is wrong.
    fn hint(self) -> String {
        let units = |units: &str| format!("import with \"units\": {units} in the map's table");
        let scale = match (self.scale, self.slips()) {
            (0, _) => String::new(),
            (1, 1) => return degrees_hint("headings", DEGREES).unwrap_or_default(),
            (1, _) => "headings in degrees? ".to_owned(),
            (_, 1) => {
                return "were headings in radians read as degrees? Leave their unit out of the map's table (\"units\" or \
                        \"radians_per_unit\")"
                    .to_owned();
            }
            _ => "were headings in radians read as degrees? ".to_owned(),
        };
        let rescaled = Self {
            scale: self.scale,
            ..Self::AS_SAID
        };
        // Beside a unit of headings: what else is wrong, in columns of its own.
        let beside = || {
            if self.scale == 0 {
                String::new()
            } else {
                let headings = rescaled.heading_units();
                format!("{scale}{}; and ", capital(&units(&headings)))
            }
        };
        match (self.is_clockwise, self.turns_against_wheels, self.quarters) {
            (false, true, 0) => format!(
                "{}are left and right exchanged, or are positions and headings of a left-handed frame? Exchange \
                 \"ticks_left\" and \"ticks_right\" in the map's table",
                beside()
            ),
            (false, true, 2) => format!(
                "{}do wheels count backwards? Turn the sign, or {}",
                beside(),
                units("{\"left_rad\": {\"factor\": -1}, \"right_rad\": {\"factor\": -1}}")
            ),
            (true, true, 0) => format!(
                "{}are positions mirrored? Turn the sign of y, or {}",
                beside(),
                units("{\"y\": {\"factor\": -1}}")
            ),
            (true, true, 2) => format!(
                "{}are positions mirrored? Turn the sign of x, or {}",
                beside(),
                units("{\"x\": {\"factor\": -1}}")
            ),
            (true, true, 1) => format!(
                "{}are positions mirrored? Exchange the two columns of \"position\" in the map's table",
                beside()
            ),
            (true, true, _) => format!(
                "{}are positions mirrored? Exchange the two columns of \"position\" in the map's table, and {}",
                beside(),
                units("{\"x\": {\"factor\": -1}, \"y\": {\"factor\": -1}}")
            ),
            (is_clockwise, against, quarters) => {
                let asked = match (is_clockwise, quarters) {
                    (true, 0) => "do headings grow clockwise? Turn the sign",
                    (true, 1) => {
                        "do headings grow clockwise, as of a compass (pi/2 - heading is meant)? Turn them"
                    }
                    (true, _) => "do headings grow clockwise, and from another axis? Turn them",
                    (false, 2) => "do headings point to the back? Turn them",
                    (false, _) => "do headings count from another axis than x? Turn them",
                };
                let exchanged = if against {
                    "; and are left and right exchanged? Exchange \"ticks_left\" and \"ticks_right\" in the map's table"
                } else {
                    ""
                };
                format!(
                    "{scale}{asked}, or {}{exchanged}",
                    units(&self.heading_units())
                )
            }
        }
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}

/// An angle between -pi and pi.
fn wrapped(angle: f64) -> f64 {
    libm::remainder(angle, TAU)
}

/// Sums over the windows, for headings in one unit.
#[derive(Clone, Copy, Debug, Default)]
struct HeadingSums {
    /// Squared ways that headings and wheels make together, m2; the same for headings of either sense.
    predicted: f64,
    /// Their products with the tracker's ways, along and to the left, m2: of headings as they are, and mirrored.
    along: [[f64; 2]; 2],
    /// Squared turns by headings, and products with those by the wheels, rad2.
    turned: f64,
    turned_both: f64,
}

/// What headings, wheels and the tracker show of drives.
#[derive(Clone, Debug, Default)]
pub(super) struct HeadingEvidence {
    by_scale: [HeadingSums; SCALES.len()],
    /// Ways by the tracker, m2; by the wheels, m.
    tracked: f64,
    way_m: f64,
    /// Squared turns by the wheels, rad2.
    turned_by_wheels: f64,
    /// Most that an episode's heading varies by, by the wheels, rad.
    most_turn_rad: f64,
    /// Largest heading to either side, as written.
    largest: f64,
}

impl HeadingEvidence {
    /// Adds an episode. `rows`: by time.
    pub(super) fn add(&mut self, rows: &[DriveRow], base: &WheeledBaseManifest) {
        let pairs: Vec<[&DriveRow; 2]> = rows
            .iter()
            .zip(rows.iter().skip(1))
            .map(Into::into)
            .collect();
        let way_m = |now: &DriveRow| 0.5 * base.wheel_radius_m * (now.left_rad + now.right_rad);
        let turn_rad = |now: &DriveRow| {
            base.wheel_radius_m * (now.right_rad - now.left_rad) / base.wheel_base_m
        };
        let (mut turn, mut turns) = (0.0, [0.0_f64; 2]);
        for [_, now] in &pairs {
            turn += turn_rad(now);
            turns = [turns[0].min(turn), turns[1].max(turn)];
        }
        self.most_turn_rad = self.most_turn_rad.max(turns[1] - turns[0]);
        self.largest = rows
            .iter()
            .map(|row| row.heading.abs())
            .fold(self.largest, f64::max);
        let count = ((WINDOW_S * base.rate_hz) as usize).clamp(1, pairs.len().max(1));
        for window in pairs.chunks(count) {
            let (first, last) = (window[0][0], window[window.len() - 1][1]);
            let shown = [last.x - first.x, last.y - first.y];
            self.tracked += shown[0] * shown[0] + shown[1] * shown[1];
            self.way_m += window.iter().map(|[_, now]| way_m(now)).sum::<f64>().abs();
            let by_wheels: f64 = window.iter().map(|[_, now]| turn_rad(now)).sum();
            self.turned_by_wheels += by_wheels * by_wheels;
            for (sums, scale) in self.by_scale.iter_mut().zip(SCALES) {
                let (mut way, mut turned) = ([0.0; 2], 0.0);
                for [before, now] in window {
                    let turn = wrapped(scale * (now.heading - before.heading));
                    let (sin, cos) = libm::sincos(scale * before.heading + 0.5 * turn);
                    way[0] += way_m(now) * cos;
                    way[1] += way_m(now) * sin;
                    turned += turn;
                }
                sums.predicted += way[0] * way[0] + way[1] * way[1];
                for (along, left) in sums.along.iter_mut().zip([way[1], -way[1]]) {
                    along[0] += way[0] * shown[0] + left * shown[1];
                    along[1] += way[0] * shown[1] - left * shown[0];
                }
                sums.turned += turned * turned;
                sums.turned_both += turned * by_wheels;
            }
        }
    }

    /// One less the cosine of the angle between the ways that are predicted and those of the tracker, by their lengths; `None`
    /// where the robot stays in its place.
    fn direction_misfit(&self, reading: ColumnReading) -> Option<f64> {
        let sums = &self.by_scale[reading.scale];
        let lengths = (sums.predicted * self.tracked).sqrt();
        if self.way_m < TELLING_WAY_M || lengths <= 0.0 {
            return None;
        }
        let [along, left] = sums.along[usize::from(reading.is_clockwise)];
        let along = [along, left, -along, -left][reading.quarters];
        Some(1.0 - along / lengths)
    }

    /// Mean square of turns by headings less those by the wheels, over the latter's; `None` where the robot goes straight on.
    fn turn_misfit(&self, reading: ColumnReading) -> Option<f64> {
        if self.turned_by_wheels < TELLING_TURN_RAD2 {
            return None;
        }
        let sums = &self.by_scale[reading.scale];
        let is_turned = reading.is_clockwise != reading.turns_against_wheels;
        let both = if is_turned {
            -sums.turned_both
        } else {
            sums.turned_both
        };
        let [least, most] = TURN_FACTORS;
        let factor = if sums.turned > 0.0 {
            (both / sums.turned).clamp(least, most)
        } else {
            most
        };
        let left = factor * (factor * sums.turned - 2.0 * both);
        Some(1.0 + left / self.turned_by_wheels)
    }

    /// Returns whether headings of these sizes may be what the reading says.
    fn may_be(&self, reading: ColumnReading) -> bool {
        let no_degrees = self.largest <= TAU && self.most_turn_rad > MOST_DEGREES_RAD;
        // Where one of the two shows nothing, what would be told of it alone is not asked.
        (reading.scale != 1 || !no_degrees)
            && (self.way_m >= TELLING_WAY_M || reading.quarters == 0)
    }

    /// Both misfits; 0 for what nothing is known of.
    fn misfits(&self, reading: ColumnReading) -> [f64; 2] {
        [self.direction_misfit(reading), self.turn_misfit(reading)].map(Option::unwrap_or_default)
    }

    /// Returns whether the way goes where headings and wheels say, however far.
    pub(super) fn is_along_headings(&self) -> bool {
        self.misfits(ColumnReading::AS_SAID)[0] <= EXPLAINED
    }

    /// The readings that explain the drives where they are not as said; those with the fewest slips of those that do it
    /// equally well.
    fn explanations(&self) -> Vec<ColumnReading> {
        let said = self.misfits(ColumnReading::AS_SAID);
        if said[0] <= RIGHT[0] && said[1] <= RIGHT[1] {
            return Vec::new();
        }
        let sum = |misfits: [f64; 2]| misfits[0] + misfits[1];
        let explaining: Vec<(f64, ColumnReading)> = ColumnReading::all()
            .filter(|reading| self.may_be(*reading))
            .map(|reading| (self.misfits(reading), reading))
            .filter(|(misfits, _)| {
                misfits.iter().all(|one| *one <= EXPLAINED) && sum(*misfits) <= LEFT * sum(said)
            })
            .map(|(misfits, reading)| (sum(misfits), reading))
            .collect();
        let least = explaining
            .iter()
            .map(|(misfit, _)| *misfit)
            .fold(f64::INFINITY, f64::min);
        let near = |misfit: f64| misfit <= CLOSE[0] * least + CLOSE[1];
        let near: Vec<ColumnReading> = explaining
            .into_iter()
            .filter(|(misfit, _)| near(*misfit))
            .map(|(_, reading)| reading)
            .collect();
        let fewest = near.iter().map(|reading| reading.slips()).min();
        near.into_iter()
            .filter(|reading| Some(reading.slips()) == fewest)
            .collect()
    }

    /// Refuses headings that another reading of the columns explains.
    pub(super) fn check(&self, at: &str) -> Result<(), CalibrationError> {
        let explanations = self.explanations();
        if explanations.is_empty() {
            return Ok(());
        }
        let hints: Vec<String> = explanations.into_iter().map(ColumnReading::hint).collect();
        let mut found = Vec::new();
        if let Some(misfit) = self.direction_misfit(ColumnReading::AS_SAID) {
            let angle = libm::acos((1.0 - misfit).clamp(-1.0, 1.0)) * DEGREES;
            found.push(format!("off the way by about {angle:.0} degrees"));
        }
        if self.turn_misfit(ColumnReading::AS_SAID).is_some() {
            let turns = self.by_scale[0].turned_both / self.turned_by_wheels;
            found.push(format!("turning {turns:.2} times as far as by the wheels"));
        }
        Err(CalibrationError::field(
            at,
            "heading",
            found.join(" and "),
            format!(
                "the way's direction, and turns as by the wheels; {}",
                hints.join("; or ")
            ),
        ))
    }
}

#[cfg(test)]
mod tests;
