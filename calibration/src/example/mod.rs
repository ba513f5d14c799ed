//! A small measured bundle with a hidden effect, made by an integrator that shares nothing with the engines.

mod flight;

use crate::error::CalibrationError;
use crate::report::write_atomically;
use dwell_scene::random::RandomKey;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Throws in the example.
const THROWS: usize = 15;
/// Samples per second.
const RATE_HZ: f64 = 100.0;
/// Standard deviation of the camera's noise, m.
const NOISE_M: f64 = 0.002;
/// A table-tennis ball.
const MASS_KG: f64 = 0.0027;
/// A table-tennis ball.
const RADIUS_M: f64 = 0.02;
/// Air at 20 degrees Celsius, kg/m³.
const AIR_KG_M3: f64 = 1.204;

/// Writes a bundle into `folder` (made where it is missing): a light ball is thrown across a room and filmed, and air
/// drag, which the simulation lacks, slows it down. Returns the hidden effect, in a sentence.
///
/// # Errors
/// [`CalibrationError::Write`] names the file.
///
/// # Determinism
/// Equal seeds write equal files.
pub fn write(folder: &Path, seed: u64) -> Result<String, CalibrationError> {
    fs::create_dir_all(folder).map_err(|source| CalibrationError::Write {
        path: folder.to_owned(),
        source,
    })?;
    let key = RandomKey::root(seed).child("calibration example");
    let mut stream = key.child("throws").stream();
    let c_d = 0.4 + 0.12 * stream.uniform();
    let drag_per_m = 0.5 * AIR_KG_M3 * c_d * std::f64::consts::PI * RADIUS_M * RADIUS_M / MASS_KG;
    let mut episodes = String::from("episode,split_group,conditions\n");
    let mut trajectory = String::from("episode,t_s,entity,channel,value\n");
    for throw in 0..THROWS {
        let session = throw / 3;
        let _ = writeln!(
            episodes,
            "throw_{throw:02},session_{session},thrown by hand"
        );
        let speed_m_s = 2.0 + 6.0 * stream.uniform();
        let elevation = 0.2 + 0.9 * stream.uniform();
        let heading = std::f64::consts::TAU * stream.uniform();
        let level = speed_m_s * elevation.cos();
        let start = [3.0, 1.2 + 0.3 * stream.uniform(), 3.0];
        let velocity = [
            level * heading.cos(),
            speed_m_s * elevation.sin(),
            level * heading.sin(),
        ];
        let samples = (RATE_HZ * (0.45 + 0.2 * stream.uniform())) as usize;
        let path = flight::trajectory(start, velocity, drag_per_m, 1.0 / RATE_HZ, samples);
        let mut noise = key.child("noise").child(throw as u64).stream();
        for (k, point) in path.iter().enumerate() {
            let t_s = 12.5 + 2.0 * throw as f64 + k as f64 / RATE_HZ;
            for (axis, value) in ["x", "y", "z"].iter().zip(point) {
                let measured = value + NOISE_M * noise.normal();
                let _ = writeln!(
                    trajectory,
                    "throw_{throw:02},{t_s:.5},ball,{axis},{measured:.6}"
                );
            }
        }
    }
    let channel = |name: &str| serde_json::json!({"name": name, "unit": "m", "clock": "camera", "noise_sd": null});
    let manifest = serde_json::json!({
        "version": 1,
        "title": "Throws of a table-tennis ball (made up, with a hidden effect)",
        "licence": "CC0-1.0",
        "kind": "trajectory",
        "scene": {
            "environment": {"temperature_c": 20.0, "humidity_pct": 50.0, "pressure_pa": 101_325.0, "g_m_s2": null},
            "bodies": [{"name": "ball", "mass_kg": MASS_KG, "radius_m": RADIUS_M}],
        },
        "channels": [channel("x"), channel("y"), channel("z")],
        "notes": "Written by dwell's example, not by a camera.",
    });
    write_atomically(folder, "episodes.csv", episodes.as_bytes())?;
    write_atomically(folder, "trajectory.csv", trajectory.as_bytes())?;
    write_atomically(
        folder,
        "manifest.json",
        format!("{manifest:#}\n").as_bytes(),
    )?;
    Ok(format!(
        "quadratic air drag with c_d = {c_d:.3} on a ball of {} g, filmed at {RATE_HZ:.0} Hz with {} mm of noise",
        1000.0 * MASS_KG,
        1000.0 * NOISE_M
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_seeds_write_equal_bundles_that_can_be_read() {
        let (a, b) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        assert_eq!(write(a.path(), 4).unwrap(), write(b.path(), 4).unwrap());
        for name in ["manifest.json", "episodes.csv", "trajectory.csv"] {
            assert_eq!(
                fs::read(a.path().join(name)).unwrap(),
                fs::read(b.path().join(name)).unwrap()
            );
        }
        let bundle = crate::bundle::read(a.path()).unwrap();
        assert_eq!(bundle.episodes.len(), THROWS);
        assert_ne!(write(b.path(), 5).unwrap(), write(a.path(), 4).unwrap());
    }
}
