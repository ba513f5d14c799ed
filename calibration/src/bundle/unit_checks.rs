//! Checks for the commonest mistakes in measured data, found by what cannot be otherwise, and reported with the remedy.

use super::MeasuredEpisode;
use super::file::{BundleKind, MeasurementDescription};
use crate::error::CalibrationError;
use crate::median::median;
use std::collections::BTreeMap;

type UnitCheck = Result<(), CalibrationError>;

/// Largest deviation of a sample's time from its place in an even row, as a share of the spacing.
const SPACING_TOLERANCE: f64 = 0.05;
/// Largest deviation of a factor from the one that explains it.
const FACTOR_TOLERANCE: f64 = 0.3;
/// Spacing above which samples show no motion, s.
const LONGEST_STEP_S: f64 = 0.5;
/// Share of a motion that must fall as things fall for no fault to be reported.
const FALLING_SHARE: f64 = 0.1;
/// Share that must fall in another unit or along another axis, for two of three reaches at least, for a fault to be reported.
const TELLING_SHARE: f64 = 0.25;
/// Height below which a rise after a fall is no bounce, m; nor below so many standard deviations of the noise.
const LEAST_RISE_M: f64 = 0.02;
const RISE_SD: f64 = 12.0;

/// A unit that may be mistaken for the SI one: its name, and how many of it are one of SI.
type UnitScale = (&'static str, f64);

const LENGTHS: [UnitScale; 4] = [
    ("millimetres", 1e3),
    ("centimetres", 1e2),
    ("inches", 1.0 / 0.0254),
    ("feet", 1.0 / 0.3048),
];
const TIMES: [UnitScale; 3] = [
    ("milliseconds", 1e3),
    ("microseconds", 1e6),
    ("nanoseconds", 1e9),
];
/// Units that lengths in metres may be read as, by mistake, and the metres in one of them.
const SMALL_LENGTHS: [UnitScale; 3] = [
    ("millimetres", 1e-3),
    ("centimetres", 1e-2),
    ("inches", 0.0254),
];
/// Units that times in seconds may be read as, by mistake, and the seconds in one of them.
const WRONG_TIMES: [UnitScale; 4] = [
    ("milliseconds", 1e-3),
    ("microseconds", 1e-6),
    ("nanoseconds", 1e-9),
    ("minutes", 60.0),
];
/// Degrees in a radian.
pub(super) const DEGREES: f64 = 180.0 / std::f64::consts::PI;

fn is_near(found: f64, wanted: f64, tolerance: f64) -> bool {
    (found / wanted - 1.0).abs() <= tolerance
}

/// Returns the remedy for numbers in another unit. `key`: of the map of `dwell measure import`.
fn unit_conversion_hint(what: &str, unit: UnitScale, key: &str) -> String {
    let (name, factor) = unit;
    let digits = if factor.fract() == 0.0 { 0 } else { 4 };
    format!(
        "{what} in {name}? Divide by {factor:.digits$}, or import with \"{key}\": {} in the map's table",
        1.0 / factor
    )
}

/// Returns the remedy for angles that are larger by `factor` than radians; empty where degrees do not explain it.
pub(super) fn degrees_hint(what: &str, factor: f64) -> Option<String> {
    is_near(factor, DEGREES, FACTOR_TOLERANCE)
        .then(|| unit_conversion_hint(what, ("degrees", DEGREES), "radians_per_unit"))
}

/// Returns the remedy for lengths that are larger by `factor` than metres; empty where no unit explains it.
pub(super) fn length_unit_hint(what: &str, factor: f64) -> Option<String> {
    let unit = LENGTHS
        .iter()
        .find(|unit| is_near(factor, unit.1, FACTOR_TOLERANCE))?;
    Some(unit_conversion_hint(what, *unit, "metres_per_unit"))
}

/// Refuses times that occur twice, or that do not rise evenly at a rate. `times`: rising.
pub(super) fn check_even_sampling(at: &str, times: &[f64], rate_hz: f64) -> UnitCheck {
    let Some(first) = times.first() else {
        return Ok(());
    };
    let place = |k: usize| first + k as f64 / rate_hz;
    let is_off = |k: &usize| (times[*k] - place(*k)).abs() * rate_hz > SPACING_TOLERANCE;
    let Some(k) = (0..times.len()).find(is_off) else {
        return Ok(());
    };
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let last = steps[k - 1];
    let usual = median(&mut steps);
    let unit = TIMES
        .iter()
        .find(|unit| is_near(usual * rate_hz, unit.1, SPACING_TOLERANCE));
    let missing = (last * rate_hz).round() - 1.0;
    let told = if last == 0.0 {
        "; it stands twice: leave one of the two rows out".to_owned()
    } else if let Some(unit) = unit {
        format!(
            "; times {}",
            unit_conversion_hint("are", *unit, "seconds_per_unit")
        )
    } else if is_near(usual, 1.0, 1e-6) && rate_hz > 1.0 {
        let (unit, key) = (("frames", rate_hz), "seconds_per_unit");
        format!("; times {}", unit_conversion_hint("are counted", unit, key))
    } else if !is_near(usual * rate_hz, 1.0, SPACING_TOLERANCE) {
        let found = 1.0 / usual;
        format!(
            "; times rise by {usual:.6} s as a rule: write {found:.6} for rate_hz if that is meant"
        )
    } else if missing >= 1.0 && is_near(last * rate_hz, missing + 1.0, SPACING_TOLERANCE) {
        format!(
            "; {missing} missing before it: fill them in, or end the episode there and give the rows after it \
             another episode's name"
        )
    } else {
        "; bring the samples to even times".to_owned()
    };
    let allowed = format!(
        "{:.6}, sample {k} of an even row at {rate_hz} Hz{told}",
        place(k)
    );
    Err(CalibrationError::field(at, "t_s", times[k], allowed))
}

/// A coordinate of a body over time.
pub(super) struct CoordinateTrack {
    pub(super) t_s: Vec<f64>,
    pub(super) m: Vec<f64>,
}

impl CoordinateTrack {
    /// Accelerations, m/s2: of each sample with those so many before and after it.
    fn accelerations(&self, reach: usize) -> impl Iterator<Item = f64> {
        let (t, y) = (&self.t_s, &self.m);
        (reach..t.len().saturating_sub(reach)).map(move |k| {
            let (a, b) = (k - reach, k + reach);
            let speed = |from: usize, to: usize| (y[to] - y[from]) / (t[to] - t[from]);
            2.0 * (speed(k, b) - speed(a, k)) / (t[b] - t[a])
        })
    }

    /// Standard deviation of the noise, m: third differences hold little of a motion.
    fn noise_m(&self) -> f64 {
        let third = |w: &[f64]| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).abs();
        let mut sizes: Vec<f64> = self.m.windows(4).map(third).collect();
        median(&mut sizes) / (0.674_5 * 20.0_f64.sqrt())
    }

    /// Returns the point where the body turns from falling to rising, which no flight does, and the height of the rise: (s, m).
    fn bounce(&self) -> Option<(f64, f64)> {
        let least = LEAST_RISE_M.max(RISE_SD * self.noise_m());
        // Without outliers of one sample.
        let calm: Vec<f64> = self
            .m
            .windows(3)
            .map(|w| w[0].max(w[1]).min(w[0].min(w[1]).max(w[2])))
            .collect();
        let (mut top, mut low, mut at) = (f64::NEG_INFINITY, f64::INFINITY, 0);
        for (k, y) in calm.iter().enumerate() {
            if *y > top {
                // Still rising.
                (top, low, at) = (*y, *y, k);
            } else if *y < low {
                (low, at) = (*y, k);
            }
            if top - low >= least && *y > low + least {
                let peak = calm[k..].iter().copied().fold(*y, f64::max);
                return Some((self.t_s[at + 1], peak - low));
            }
        }
        None
    }
}

/// The tracks of an episode along x, y and z; empty where there is none.
pub(super) fn tracks(
    manifest: &MeasurementDescription,
    episode: &MeasuredEpisode,
) -> [CoordinateTrack; 3] {
    ["x", "y", "z"].map(|axis| {
        let samples = episode.samples.iter();
        let of_axis = samples.filter(|s| manifest.channels[s.channel].name == axis);
        let flown = of_axis.map(|s| (s.t_s, s.value));
        let posed = episode.poses.iter().map(|pose| {
            let [x, y, z] = pose.position.to_array();
            (
                pose.t_s,
                if axis == "x" {
                    x
                } else if axis == "y" {
                    y
                } else {
                    z
                },
            )
        });
        let (t_s, m) = flown.chain(posed).unzip();
        CoordinateTrack { t_s, m }
    })
}

/// The table that holds the places of bodies; none for kinds without such.
pub(super) fn table_of_places(kind: BundleKind) -> Option<&'static str> {
    match kind {
        BundleKind::Trajectory => Some("trajectory.csv"),
        BundleKind::PoseTrajectory => Some("poses.csv"),
        BundleKind::Servo | BundleKind::ImpulseResponse | BundleKind::Drive => None,
    }
}

/// Checks that bodies fall along y by what the manifest says, in metres and seconds.
pub(super) fn check_falls(
    name: &str,
    manifest: &MeasurementDescription,
    episodes: &[MeasuredEpisode],
) -> UnitCheck {
    let Some(file) = table_of_places(manifest.kind) else {
        return Ok(());
    };
    let all: Vec<[CoordinateTrack; 3]> = episodes.iter().map(|e| tracks(manifest, e)).collect();
    check_fall_direction(&format!("{name}/{file}"), manifest, &all)
}

/// Checks that flights are flights alone.
pub(super) fn check_bounces(
    name: &str,
    manifest: &MeasurementDescription,
    episodes: &[MeasuredEpisode],
) -> UnitCheck {
    if manifest.kind != BundleKind::Trajectory {
        return Ok(());
    }
    for episode in episodes {
        let [_, height, _] = tracks(manifest, episode);
        if let Some((t_s, rise_m)) = height.bounce() {
            return Err(CalibrationError::field(
                format!("{name}/trajectory.csv, episode {}", episode.name),
                "y",
                format!("falling until t_s {t_s:.4} and rising by {rise_m:.3} m after it"),
                "free flight, which never rises again: a bounce, or a hand? Leave out the rows from there on, or give them \
                 another episode's name",
            ));
        }
    }
    Ok(())
}

/// What makes things fall by another acceleration.
#[derive(Clone, Copy)]
enum FallScale {
    /// Nothing: metres and seconds.
    Right,
    /// Lengths are in a smaller unit.
    Lengths(UnitScale),
    /// Lengths in metres were read as a smaller unit.
    LengthsReadAs(UnitScale),
    /// Times in seconds were read as another unit.
    TimesReadAs(UnitScale),
}

impl FallScale {
    /// All of them; the right one first.
    fn all() -> Vec<Self> {
        let lengths = LENGTHS.map(Self::Lengths).into_iter();
        let small = SMALL_LENGTHS.map(Self::LengthsReadAs);
        let times = WRONG_TIMES.map(Self::TimesReadAs);
        std::iter::once(Self::Right)
            .chain(lengths)
            .chain(small)
            .chain(times)
            .collect()
    }

    /// The acceleration that it makes of 1 m/s2.
    fn factor(self) -> f64 {
        match self {
            Self::Right => 1.0,
            Self::Lengths((_, factor)) | Self::LengthsReadAs((_, factor)) => factor,
            Self::TimesReadAs((_, factor)) => factor.powi(-2),
        }
    }

    /// Returns whether it may be along an axis: things that fly slow down by little along the others.
    fn may_be_along(self, axis: usize) -> bool {
        axis == 1 || matches!(self, Self::Right | Self::Lengths(_))
    }

    /// The remedy; empty where nothing is wrong.
    fn hint(self) -> String {
        match self {
            Self::Right => String::new(),
            Self::Lengths(unit) => {
                format!(
                    "; {}",
                    unit_conversion_hint("lengths", unit, "metres_per_unit")
                )
            }
            Self::LengthsReadAs((name, factor)) => format!(
                "; were lengths in metres read as {name}? Multiply by {}, or leave their unit out of the map's table (\"units\" \
                 or \"metres_per_unit\")",
                1.0 / factor
            ),
            Self::TimesReadAs((name, factor)) => format!(
                "; were times in seconds read as {name}? Multiply by {}, or leave their unit out of the map's table (\"units\" \
                 or \"seconds_per_unit\")",
                1.0 / factor
            ),
        }
    }
}

/// Refuses motions of which hardly any falls along y, while most fall along another axis or in another unit.
fn check_fall_direction(
    at: &str,
    manifest: &MeasurementDescription,
    all: &[[CoordinateTrack; 3]],
) -> UnitCheck {
    let told = manifest.scene.environment.g_m_s2;
    let g = told.unwrap_or(9.806_65);
    if g == 0.0 {
        return Ok(());
    }
    let scales = FallScale::all();
    // Reaches of an acceleration, samples: near ones catch short flights, far ones see through noise.
    let shares = [4, 8, 16].map(|part| {
        let mut found: BTreeMap<(usize, i8, usize), usize> = BTreeMap::new();
        let mut counts = [0_usize; 3];
        for (axis, track) in all.iter().flat_map(|tracks| tracks.iter().enumerate()) {
            let reach = (track.m.len() / part).max(1);
            for a in track.accelerations(reach).filter(|a| a.is_finite()) {
                counts[axis] += 1;
                for (k, scale) in scales.iter().enumerate() {
                    if is_near(a.abs(), g * scale.factor(), FACTOR_TOLERANCE) {
                        let sign = if a < 0.0 { -1 } else { 1 };
                        *found.entry((axis, sign, k)).or_default() += 1;
                    }
                }
            }
        }
        move |(axis, sign, k): (usize, i8, usize)| {
            let times = found.get(&(axis, sign, k)).copied().unwrap_or(0);
            times as f64 / counts[axis].max(1) as f64
        }
    });
    let share = |key| shares.iter().map(|of| of(key)).fold(0.0, f64::max);
    // Quantization steps, a millimetre each, look like any fall to near samples, but not to further ones.
    let telling = |key| {
        let mut found = shares.each_ref().map(|of| of(key));
        found.sort_by(f64::total_cmp);
        found[1]
    };
    let in_metres = share((1, -1, 0));
    let keys = (0..3).flat_map(|axis| [-1, 1].map(|sign| (axis, sign)));
    let keys = keys.flat_map(|(axis, sign)| (0..scales.len()).map(move |k| (axis, sign, k)));
    let possible = keys.filter(|(axis, _, k)| scales[*k].may_be_along(*axis));
    let best = possible.max_by(|a, b| telling(*a).total_cmp(&telling(*b)));
    // What drag slows in another unit passes through the metres' range too: then more must fall in that unit.
    let explains = |(axis, sign, k): &(usize, i8, usize)| {
        let share = telling((*axis, *sign, *k));
        let falls_along_y =
            (*axis, *sign) == (1, -1) && matches!(scales[*k], FallScale::Lengths(_));
        share >= TELLING_SHARE
            && (in_metres < FALLING_SHARE || (falls_along_y && share > in_metres))
    };
    let Some((axis, sign, k)) = best.filter(explains) else {
        return Ok(());
    };
    let letter = ["x", "y", "z"][axis];
    let found = f64::from(sign) * g * scales[k].factor();
    let by = told.map_or("", |_| " by g_m_s2");
    Err(CalibrationError::field(
        at,
        "the acceleration in free flight",
        format!("about {found:.4} m/s2 along {letter}"),
        format!(
            "{:.4} along y{by}, which points up{}",
            -g,
            suggested_fix(axis, f64::from(sign), scales[k], manifest.kind)
        ),
    ))
}

/// Returns the remedy for a guess.
fn suggested_fix(axis: usize, sign: f64, scale: FallScale, kind: BundleKind) -> String {
    let mut told = String::new();
    if axis != 1 {
        told.push_str(if kind == BundleKind::PoseTrajectory {
            "; is another axis up? Turn positions and rotations, or import with \"up\": \"z\" in the map"
        } else {
            "; is another axis up? Make the column of heights \"y\" (in the map: \"channels\")"
        });
    }
    if sign > 0.0 {
        told.push_str(
            "; do heights grow downwards? Turn their sign (for a flight, \"metres_per_unit\": -1 in the map's table does)",
        );
    }
    told.push_str(&scale.hint());
    told
}

/// Refuses samples of an episode at one time, those too far apart to show a motion, and gaps. `times`: of one channel, rising.
pub(super) fn check_sample_times(at: &str, times: &[f64]) -> UnitCheck {
    let mut pairs = times.iter().zip(times.iter().skip(1));
    if let Some((twice, _)) = pairs.find(|(a, b)| a == b) {
        let allowed = "each time once for a channel: leave one of the two rows out, or give recordings that were put together \
                       episodes' names of their own";
        let found = format!("{twice} twice");
        return Err(CalibrationError::field(at, "t_s", found, allowed));
    }
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let gap = steps.iter().position(|step| *step >= LONGEST_STEP_S);
    let step = median(&mut steps);
    if step.is_nan() || step < LONGEST_STEP_S {
        return gap.map_or(Ok(()), |k| {
            let found = format!("{} after {}", times[k + 1], times[k]);
            let allowed = format!(
                "less than {LONGEST_STEP_S} s from sample to sample: fill the gap in, or end the episode there and give the rows \
                 after it another episode's name"
            );
            Err(CalibrationError::field(at, "t_s", found, allowed))
        });
    }
    let unit = if steps.iter().all(|step| *step == 1.0) {
        "; are frames counted? Divide by the frames a second, or import with \"seconds_per_unit\" in the map's table (1/60 is \
         0.0166667)"
            .to_owned()
    } else {
        format!(
            "; {}",
            unit_conversion_hint("times", TIMES[0], "seconds_per_unit")
        )
    };
    Err(CalibrationError::field(
        at,
        "t_s",
        format!("rising by {step} from sample to sample"),
        format!("seconds, less than {LONGEST_STEP_S} from sample to sample{unit}"),
    ))
}
