//! Directivity of sources and microphones.

use crate::bands::{self, BAND_COUNT, BandValues};
use crate::error::{AcousticsError, check_range};
use crate::head::sphere_response;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Angles in the table of a sphere: every 3 degrees.
const ANGLES: usize = 61;
/// Most angles of a measured pattern: every half degree.
const MOST_ANGLES: f64 = 361.0;

/// A directivity that is symmetric about its forward axis (-Z). Its gain on the axis is 1 in every band.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Directivity {
    /// Equal in all directions.
    #[default]
    Omni,
    /// 1 - g + g cos(angle) in each band: g = 0 omnidirectional, 0.5 cardioid, 0.75 hypercardioid, 1 figure of eight.
    /// Pressure is inverted where the gain is negative.
    FirstOrder {
        /// g, 0 to 1. Shape (band,).
        gradient: BandValues,
    },
    /// A point on a rigid sphere: omnidirectional at low frequencies, ever narrower at high ones. With 0.0875 m a talking
    /// head, with 0.15 m a small loudspeaker.
    ///
    /// # Source
    /// J. L. Flanagan, JASA 32, 1613 (1960), for the mouth; the field by reciprocity from R. O. Duda, W. L. Martens,
    /// JASA 104, 3048 (1998).
    Sphere {
        /// 0.01 to 1 m.
        radius_m: f32,
    },
    /// A measured pattern: amplitudes at angles to the axis.
    Polar {
        /// Amplitudes over that on the axis, from the axis (0 degrees) to behind (180) at equal steps, interpolated
        /// between. At most 2. Shape (angle, band), 2 to 361 angles.
        gain: Vec<BandValues>,
    },
}

impl Directivity {
    /// A cardioid.
    pub const CARDIOID: Self = Self::FirstOrder {
        gradient: [0.5; BAND_COUNT],
    };
    /// A figure of eight.
    pub const FIGURE_OF_EIGHT: Self = Self::FirstOrder {
        gradient: [1.0; BAND_COUNT],
    };
    /// A talking person.
    pub const TALKER: Self = Self::Sphere { radius_m: 0.0875 };

    /// Returns the directivity called `name`: `"omni"`, `"cardioid"`, `"figure_of_eight"`, `"talker"` or `"loudspeaker"`.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "omni" => Some(Self::Omni),
            "cardioid" => Some(Self::CARDIOID),
            "figure_of_eight" => Some(Self::FIGURE_OF_EIGHT),
            "talker" => Some(Self::TALKER),
            "loudspeaker" => Some(Self::Sphere { radius_m: 0.15 }),
            _ => None,
        }
    }

    /// Checks every range.
    ///
    /// # Errors
    /// [`AcousticsError::Range`] names the field.
    pub fn check(&self) -> Result<(), AcousticsError> {
        const AT: &str = "directivity";
        match self {
            Self::Omni => Ok(()),
            Self::FirstOrder { gradient } => gradient
                .iter()
                .try_for_each(|g| check_range(AT, "gradient", f64::from(*g), (0.0, 1.0), "0 to 1")),
            Self::Sphere { radius_m } => check_range(
                AT,
                "radius_m",
                f64::from(*radius_m),
                (0.01, 1.0),
                "0.01 to 1",
            ),
            Self::Polar { gain } => {
                let angles = gain.len() as f64;
                check_range(AT, "angles", angles, (2.0, MOST_ANGLES), "2 to 361")?;
                for on_axis in gain.iter().take(1).flatten() {
                    let allowed = "1 on the axis";
                    check_range(AT, "gain", f64::from(*on_axis), (0.999, 1.001), allowed)?;
                }
                let mut all = gain.iter().flatten();
                all.try_for_each(|g| check_range(AT, "gain", f64::from(*g), (-2.0, 2.0), "-2 to 2"))
            }
        }
    }

    /// Returns it tabulated, in air with `speed_m_s`.
    pub(crate) fn pattern(&self, speed_m_s: f64) -> TabulatedPattern {
        match self {
            Self::Omni => TabulatedPattern::Omni,
            Self::FirstOrder { gradient } => TabulatedPattern::FirstOrder(*gradient),
            Self::Polar { gain } => TabulatedPattern::Table(gain.clone()),
            Self::Sphere { radius_m } => {
                let cosines: Vec<f64> = (0..ANGLES)
                    .map(|k| libm::cos(PI * k as f64 / (ANGLES - 1) as f64))
                    .collect();
                let mut table = vec![[0.0; BAND_COUNT]; ANGLES];
                for band in 0..BAND_COUNT {
                    let omega = TAU * bands::exact_centre_hz(band);
                    let found = sphere_response(omega * f64::from(*radius_m) / speed_m_s, &cosines);
                    let size = |value: &realfft::num_complex::Complex<f64>| {
                        libm::hypot(value.re, value.im)
                    };
                    let front = size(&found[0]);
                    for (row, value) in table.iter_mut().zip(found) {
                        row[band] = (size(&value) / front) as f32;
                    }
                }
                TabulatedPattern::Table(table)
            }
        }
    }
}

/// A directivity, tabulated.
#[derive(Clone, Debug)]
pub(crate) enum TabulatedPattern {
    Omni,
    FirstOrder(BandValues),
    Table(Vec<BandValues>),
}

impl TabulatedPattern {
    /// Returns the gain of amplitude at an angle to the axis, by its cosine. Shape (band,).
    pub(crate) fn gain(&self, cosine: f32) -> BandValues {
        match self {
            Self::Omni => [1.0; BAND_COUNT],
            Self::FirstOrder(gradient) => gradient.map(|g| 1.0 - g + g * cosine),
            Self::Table(table) => {
                let last = (table.len() - 1) as f64;
                let place = libm::acos(f64::from(cosine).clamp(-1.0, 1.0)) / PI * last;
                let below = (place as usize).min(table.len() - 2);
                let way = (place - below as f64) as f32;
                let (a, b) = (&table[below], &table[below + 1]);
                std::array::from_fn(|band| a[band] + (b[band] - a[band]) * way)
            }
        }
    }

    /// Returns it with other gains; `change` gets the cosine of the angle to the axis and the gain there.
    pub(crate) fn map_gains(&self, change: impl Fn(f32, BandValues) -> BandValues) -> Self {
        let cosine = |k: usize| libm::cos(PI * k as f64 / (ANGLES - 1) as f64) as f32;
        let cosines = (0..ANGLES).map(cosine);
        Self::Table(cosines.map(|c| change(c, self.gain(c))).collect())
    }

    /// Returns whether it is equal in all directions.
    pub(crate) fn is_omni(&self) -> bool {
        matches!(self, Self::Omni)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_are_one_on_the_axis_and_named_ones_have_their_zeros() {
        for name in [
            "omni",
            "cardioid",
            "figure_of_eight",
            "talker",
            "loudspeaker",
        ] {
            let directivity = Directivity::named(name).unwrap();
            directivity.check().unwrap();
            for gain in directivity.pattern(343.2).gain(1.0) {
                assert!((gain - 1.0).abs() < 1e-6, "{name}");
            }
        }
        assert!(Directivity::CARDIOID.pattern(343.2).gain(-1.0)[4].abs() < 1e-6);
        assert!(Directivity::FIGURE_OF_EIGHT.pattern(343.2).gain(0.0)[4].abs() < 1e-6);
        assert_eq!(
            Directivity::FIGURE_OF_EIGHT.pattern(343.2).gain(-1.0)[4],
            -1.0
        );
        assert!(Directivity::named("laser").is_none());
        assert!(Directivity::Sphere { radius_m: f32::NAN }.check().is_err());
    }

    /// A cardioid measured at 37 angles is one, between them too, and passes its bounds as any other does.
    #[test]
    fn a_measured_pattern_is_what_was_measured() {
        let cosine = |k: u16| (f32::from(k) * 5.0).to_radians().cos();
        let gain = (0..37).map(|k| [0.5 + 0.5 * cosine(k); BAND_COUNT]);
        let measured = Directivity::Polar {
            gain: gain.collect(),
        };
        measured.check().unwrap();
        let (found, wanted) = (
            measured.pattern(343.2),
            Directivity::CARDIOID.pattern(343.2),
        );
        for degrees in 0..=180_u16 {
            let cosine = f32::from(degrees).to_radians().cos();
            let off = found.gain(cosine)[3] - wanted.gain(cosine)[3];
            assert!(off.abs() < 1e-3, "{degrees}: {off}");
        }
        let refused = |gain: Vec<BandValues>| Directivity::Polar { gain }.check().unwrap_err();
        let one = [1.0; BAND_COUNT];
        for gain in [
            vec![],
            vec![one],
            vec![one; 362],
            vec![[0.5; BAND_COUNT], one],
            vec![one, [f32::NAN; BAND_COUNT]],
            vec![one, [3.0; BAND_COUNT]],
        ] {
            assert!(refused(gain).to_string().contains("directivity"));
        }
    }

    /// Long waves are diffracted around a head; short ones leave its back faint.
    #[test]
    fn a_talker_is_faint_behind_at_high_frequencies() {
        let pattern = Directivity::TALKER.pattern(343.2);
        let level = |cosine: f32, band: usize| 20.0 * libm::log10f(pattern.gain(cosine)[band]);
        assert!(level(-1.0, 1) > -2.0 && level(-1.0, 1) <= 0.0);
        // Straight behind, waves around a sphere meet in phase; beside that they do not.
        assert!(level(-0.85, 6) < -8.0, "{}", level(-0.85, 6));
    }
}
