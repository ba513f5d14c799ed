//! Reflection factor of a surface by angle of incidence.

use crate::bands::BandValues;

/// The admittance of largest random-incidence absorption: 1 / 1.567.
const HIGHEST_ADMITTANCE: f64 = 0.638_163;
/// Steps of Newton's method; the last half is for the flat maximum, where each only halves the error.
const STEPS: usize = 40;
/// Smallest cosine of incidence.
const GRAZING: f32 = 1e-4;

/// Reflected energy by angle of incidence.
///
/// A table's absorption coefficients are measured at random incidence. Here a surface is a real admittance in every band,
/// the one whose random-incidence absorption is the table's: it absorbs more at grazing incidence, and less at normal. In a
/// room of parallel walls all directions then decay nearly alike, as its modes do (P. M. Morse, K. U. Ingard, *Theoretical
/// Acoustics* (1968), section 9.5), where one coefficient for all angles leaves the sound along its length.
///
/// # Source
/// H. Kuttruff, *Room Acoustics* (5th ed., 2009), sections 2.3 (one angle) and 2.5 (all angles) for real impedances. 0.951
/// is the largest absorption of such a surface; above it, the rest is subtracted at all angles alike. J. H. Rindel, Applied
/// Acoustics 38, 223 (1993) proposes this for room acoustics programs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ReflectionCoefficients {
    /// Ratio of air's to the surface's impedance; 0 for a surface that does not depend on the angle. Shape (band,).
    admittance: BandValues,
    /// Reflected energy at the admittance of full reflection. Shape (band,).
    most: BandValues,
}

impl ReflectionCoefficients {
    /// A surface that absorbs nothing.
    pub(crate) const RIGID: Self = Self {
        admittance: [0.0; crate::bands::BAND_COUNT],
        most: [1.0; crate::bands::BAND_COUNT],
    };

    /// The reflection with `absorption` (from 0 to 1) at all angles alike.
    pub(crate) fn uniform(absorption: &BandValues) -> Self {
        Self {
            most: absorption.map(|a| 1.0 - a),
            ..Self::RIGID
        }
    }

    /// The reflection with a random-incidence `absorption` (from 0 to 1).
    pub(crate) fn angle_dependent(absorption: &BandValues) -> Self {
        let highest = random_incidence_absorption(HIGHEST_ADMITTANCE);
        let rest = |a: f32| (1.0 - f64::from(a)) / (1.0 - highest);
        Self {
            admittance: absorption.map(|a| admittance(f64::from(a).min(highest)) as f32),
            most: absorption.map(|a| rest(a).min(1.0) as f32),
        }
    }

    /// Returns the reflected share of energy, at a cosine of incidence. Shape (band,).
    pub(crate) fn reflected_share(&self, cosine: f32) -> BandValues {
        let cosine = cosine.max(GRAZING);
        std::array::from_fn(|band| {
            let admittance = self.admittance[band];
            // The reflection factor (zeta cos - 1) / (zeta cos + 1) for an impedance of zeta, 1 over the admittance.
            let pressure = (cosine - admittance) / (cosine + admittance);
            self.most[band] * pressure * pressure
        })
    }
}

/// Returns the random-incidence absorption of an admittance.
fn random_incidence_absorption(admittance: f64) -> f64 {
    8.0 * admittance * admittance * paris_bracket(admittance)
}

/// Returns the bracket of the equation.
fn paris_bracket(b: f64) -> f64 {
    1.0 + 1.0 / b - b / (1.0 + b) + 2.0 * libm::log(b / (1.0 + b))
}

/// Returns the lower of the two admittances with this random-incidence absorption.
fn admittance(absorption: f64) -> f64 {
    // The curve bends downwards: from the left, Newton's steps never go too far.
    let mut b = absorption / 8.0;
    if b <= 0.0 {
        return 0.0;
    }
    for _ in 0..STEPS {
        let slope = 16.0 * b * paris_bracket(b) - 8.0 / ((1.0 + b) * (1.0 + b));
        if slope <= 1e-9 {
            break;
        }
        b = (b + (absorption - random_incidence_absorption(b)) / slope)
            .clamp(0.0, HIGHEST_ADMITTANCE);
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bands::BAND_COUNT;

    /// Returns the mean of a function of the cosine over random incidence, by the midpoint rule.
    fn over_all_sides(f: impl Fn(f64) -> f64) -> f64 {
        let n = 200_000;
        let cosines = (0..n).map(|k| (f64::from(k) + 0.5) / f64::from(n));
        cosines.map(|c| f(c) * 2.0 * c).sum::<f64>() / f64::from(n)
    }

    #[test]
    fn what_comes_from_all_sides_is_absorbed_as_the_table_has_it() {
        let absorption: BandValues = [0.0, 0.01, 0.1, 0.3, 0.6, 0.9, 0.97, 1.0];
        let reflection = ReflectionCoefficients::angle_dependent(&absorption);
        for (band, wanted) in absorption.into_iter().map(f64::from).enumerate() {
            let absorbed =
                over_all_sides(|c| 1.0 - f64::from(reflection.reflected_share(c as f32)[band]));
            assert!((absorbed - wanted).abs() < 2e-4, "{wanted}: {absorbed}");
        }
        assert_eq!(reflection.reflected_share(0.3)[0], 1.0);
        assert_eq!(reflection.reflected_share(0.3)[7], 0.0);
    }

    /// An impedance tube measures half of a reverberation room's absorption, where little is absorbed (Kuttruff, section
    /// 2.5): 4 of 8 admittances.
    #[test]
    fn head_on_hard_walls_absorb_half_of_it() {
        let kept =
            ReflectionCoefficients::angle_dependent(&[0.002; BAND_COUNT]).reflected_share(1.0)[3];
        assert!((f64::from(1.0 - kept) / 0.002 - 0.5).abs() < 2e-3, "{kept}");
    }

    #[test]
    fn more_is_absorbed_the_flatter_it_comes() {
        let reflection = ReflectionCoefficients::angle_dependent(&[0.2; BAND_COUNT]);
        let mut before = 1.0;
        for k in (3..=20).rev() {
            let kept = reflection.reflected_share(0.05 * k as f32)[0];
            assert!(kept < before, "{k}");
            before = kept;
        }
    }

    #[test]
    fn along_a_surface_numbers_stay_numbers() {
        for absorption in [0.0, 1e-30, 0.5, 1.0] {
            for reflection in [
                ReflectionCoefficients::angle_dependent(&[absorption; BAND_COUNT]),
                ReflectionCoefficients::uniform(&[absorption; BAND_COUNT]),
            ] {
                for cosine in [0.0, 1e-20, 1.0] {
                    let kept = reflection.reflected_share(cosine)[0];
                    assert!((0.0..=1.0).contains(&kept), "{absorption} {cosine}: {kept}");
                }
            }
        }
    }
}
