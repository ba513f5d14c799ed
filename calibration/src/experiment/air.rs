//! Air and gravity of a measurement.

use crate::bundle::file::MeasurementDescription;
use dwell_scene::units::STANDARD_GRAVITY_M_S2;

/// Specific gas constant of dry air, J/(kg K).
const GAS_CONSTANT: f64 = 287.05;

/// Density of dry air, kg/m³; at 20 °C and 101,325 Pa where the manifest does not say.
pub(crate) fn air_density_kg_m3(manifest: &MeasurementDescription) -> f64 {
    let air = &manifest.scene.environment;
    let kelvin = air.temperature_c.unwrap_or(20.0) + 273.15;
    air.pressure_pa.unwrap_or(101_325.0) / (GAS_CONSTANT * kelvin)
}

/// Acceleration of free fall, m/s²; standard gravity where the manifest does not say.
pub(crate) fn gravity_m_s2(manifest: &MeasurementDescription) -> f64 {
    let known = manifest.scene.environment.g_m_s2;
    known.unwrap_or(f64::from(STANDARD_GRAVITY_M_S2))
}
