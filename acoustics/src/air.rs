//! Air: speed of sound and absorption.

use crate::bands::{self, BAND_COUNT};
use crate::error::{AcousticsError, check_range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Reference temperature, K.
const T0_K: f64 = 293.15;
/// Temperature of the triple point of water, K.
const T01_K: f64 = 273.16;
/// Reference pressure, kPa.
const REFERENCE_KPA: f64 = 101.325;

/// The state of the air.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Air {
    /// Temperature, degrees Celsius; -40 to 60.
    pub temperature_c: f64,
    /// Relative humidity, percent; 0 to 100.
    pub humidity_pct: f64,
    /// Static pressure, kPa; 30 to 200.
    pub pressure_kpa: f64,
}

impl Default for Air {
    /// 20 °C, 50 %, 101.325 kPa.
    fn default() -> Self {
        Self {
            temperature_c: 20.0,
            humidity_pct: 50.0,
            pressure_kpa: REFERENCE_KPA,
        }
    }
}

impl Air {
    /// Checks every range.
    ///
    /// # Errors
    /// [`AcousticsError::Range`] names the field.
    pub fn check(&self) -> Result<(), AcousticsError> {
        check_range(
            "air",
            "temperature_c",
            self.temperature_c,
            (-40.0, 60.0),
            "-40 to 60",
        )?;
        check_range(
            "air",
            "humidity_pct",
            self.humidity_pct,
            (0.0, 100.0),
            "0 to 100",
        )?;
        check_range(
            "air",
            "pressure_kpa",
            self.pressure_kpa,
            (30.0, 200.0),
            "30 to 200",
        )
    }

    fn temperature_k(&self) -> f64 {
        self.temperature_c + 273.15
    }

    /// Speed of sound, m/s.
    ///
    /// # Source
    /// ISO 9613-1:1993, equation (A.5): 343.2 sqrt(T / 293.15 K).
    pub fn speed_of_sound_m_s(&self) -> f64 {
        343.2 * (self.temperature_k() / T0_K).sqrt()
    }

    /// Returns the attenuation of a pure tone, dB/m.
    ///
    /// # Source
    /// ISO 9613-1:1993, equations (3) to (6), (B.1) to (B.3).
    pub fn attenuation_db_per_m(&self, frequency_hz: f64) -> f64 {
        let (f2, t) = (frequency_hz * frequency_hz, self.temperature_k());
        let (pressure, ratio) = (self.pressure_kpa / REFERENCE_KPA, t / T0_K);
        // (B.2), (B.3): the saturation pressure; (B.1): the molar concentration of water vapour, %.
        let saturation = libm::pow(10.0, -6.8346 * libm::pow(T01_K / t, 1.261) + 4.6151);
        let h = self.humidity_pct * saturation / pressure;
        // (3), (4): the relaxation frequencies of oxygen and nitrogen.
        let oxygen_hz = pressure * (24.0 + 4.04e4 * h * (0.02 + h) / (0.391 + h));
        let nitrogen_hz = pressure / ratio.sqrt()
            * (9.0 + 280.0 * h * libm::exp(-4.170 * (libm::cbrt(1.0 / ratio) - 1.0)));
        // (5): classical and rotational losses, then the vibration of oxygen and of nitrogen.
        let classical = 1.84e-11 * ratio.sqrt() / pressure;
        let oxygen = 0.012_75 * libm::exp(-2239.1 / t) / (oxygen_hz + f2 / oxygen_hz);
        let nitrogen = 0.1068 * libm::exp(-3352.0 / t) / (nitrogen_hz + f2 / nitrogen_hz);
        8.686 * f2 * (classical + libm::pow(ratio, -2.5) * (oxygen + nitrogen))
    }

    /// Returns the attenuation of **energy**, 1/m, in each band at its exact centre: after d metres exp(-m d) is left. Shape (band,).
    pub fn energy_decay_per_m(&self) -> [f64; BAND_COUNT] {
        std::array::from_fn(|band| {
            let db = self.attenuation_db_per_m(bands::exact_centre_hz(band));
            db / (10.0 * std::f64::consts::LOG10_E)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ISO 9613-1:1993 Table 1 prints three digits; the formula meets it within 0.3 % at exact midband frequencies.
    #[test]
    fn attenuation_meets_the_printed_table() {
        let rows = [
            (10.0, 10.0, -10, 0.585),
            (10.0, 10.0, 0, 21.6),
            (-20.0, 30.0, -1, 4.92),
            (35.0, 60.0, 6, 25.8),
            (20.0, 10.0, 7, 133.0),
            (20.0, 80.0, 7, 30.6),
            (50.0, 70.0, 0, 8.03),
            (20.0, 50.0, 0, 4.66),
            (10.0, 70.0, 6, 32.8),
            (20.0, 70.0, 9, 76.6),
            (15.0, 20.0, 3, 28.2),
            (20.0, 70.0, -9, 0.339),
        ];
        for (temperature_c, humidity_pct, third_octave, db_per_km) in rows {
            let air = Air {
                temperature_c,
                humidity_pct,
                ..Air::default()
            };
            let frequency_hz = 1000.0 * libm::pow(10.0, f64::from(third_octave) / 10.0);
            let found = 1000.0 * air.attenuation_db_per_m(frequency_hz);
            assert!(
                (found / db_per_km - 1.0).abs() < 3e-3,
                "{temperature_c} C {humidity_pct} % {frequency_hz:.0} Hz: {found:.4}, printed {db_per_km}"
            );
        }
    }

    #[test]
    fn pressure_matters() {
        // ISO 9613-1 evaluated independently (in Python) at 80 kPa, 20 C, 50 %.
        let air = Air {
            pressure_kpa: 80.0,
            ..Air::default()
        };
        let at = |f| 1000.0 * air.attenuation_db_per_m(f);
        assert!((at(1000.0) - 4.618_841).abs() < 1e-5, "{}", at(1000.0));
        assert!((at(3_981.071_706) - 28.930_497).abs() < 1e-5);
        assert!((air.speed_of_sound_m_s() - 343.2).abs() < 1e-9);
    }

    #[test]
    fn sound_is_faster_in_warm_air() {
        let warm = Air {
            temperature_c: 30.0,
            ..Air::default()
        };
        assert!((warm.speed_of_sound_m_s() - 349.0).abs() < 0.1);
        assert!(
            Air {
                humidity_pct: 101.0,
                ..warm
            }
            .check()
            .is_err()
        );
    }
}
