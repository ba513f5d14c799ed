//! Checks of measured spins.

use super::MeasuredEpisode;
use super::file::{BundleKind, MeasurementDescription};
use super::unit_checks::DEGREES;
use crate::error::CalibrationError;

/// Speed of a ball's surface about its centre above which no spin is believed, m/s: the fastest balls of table tennis, golf and
/// tennis reach about 25 m/s.
const MOST_SURFACE_SPEED_M_S: f64 = 40.0;
/// Revolutions a minute in 1 rad/s.
const RPM: f64 = 30.0 / std::f64::consts::PI;

/// Refuses spins at which a ball's surface would move faster than any ball's, and says which unit would explain them.
pub(super) fn check_spins(
    name: &str,
    manifest: &MeasurementDescription,
    episodes: &[MeasuredEpisode],
) -> Result<(), CalibrationError> {
    if manifest.kind != BundleKind::Trajectory {
        return Ok(());
    }
    let is_spin = |channel: usize| manifest.channels[channel].unit == "rad/s";
    for episode in episodes {
        let fastest = episode
            .samples
            .iter()
            .filter(|sample| is_spin(sample.channel))
            .max_by(|a, b| a.value.abs().total_cmp(&b.value.abs()));
        let Some(fastest) = fastest else { continue };
        let body = &manifest.scene.bodies[fastest.entity];
        let speed_m_s = body.radius_m.unwrap_or(0.0) * fastest.value.abs();
        if speed_m_s <= MOST_SURFACE_SPEED_M_S {
            continue;
        }
        let units = [("deg/s", DEGREES), ("rpm", RPM)];
        let units: Vec<&str> = units
            .iter()
            .filter(|(_, factor)| speed_m_s / factor <= MOST_SURFACE_SPEED_M_S)
            .map(|(unit, _)| *unit)
            .collect();
        let hint = match units[..] {
            [] => "; no ball spins so fast: leave the episode out".to_owned(),
            _ => format!(
                "; in {}? Import with \"units\": {{\"COLUMN\": \"{}\"}} in the map's table",
                units.join(" or "),
                units[0]
            ),
        };
        return Err(CalibrationError::field(
            format!("{name}/trajectory.csv, episode {}", episode.name),
            manifest.channels[fastest.channel].name.clone(),
            format!(
                "{}, at which the surface of {:?} moves at {speed_m_s:.0} m/s",
                fastest.value, body.name
            ),
            format!("rad/s, and at most {MOST_SURFACE_SPEED_M_S} m/s at the surface{hint}"),
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bundle::MeasuredSample;

    fn told(spin: f64) -> String {
        let manifest: MeasurementDescription = serde_json::from_str(
            r#"{"version": 1, "title": "t", "licence": "l", "kind": "trajectory",
                "scene": {"bodies": [{"name": "ball", "mass_kg": 0.0027, "radius_m": 0.02}]},
                "channels": [{"name": "wx", "unit": "rad/s", "clock": "camera", "noise_sd": null}]}"#,
        )
        .unwrap();
        let sample = MeasuredSample {
            entity: 0,
            channel: 0,
            t_s: 0.0,
            value: spin,
        };
        let episode = MeasuredEpisode {
            name: "a".to_owned(),
            samples: vec![sample],
            ..MeasuredEpisode::default()
        };
        let found = check_spins("x.measured", &manifest, &[episode]);
        found.err().map_or_else(String::new, |e| e.to_string())
    }

    /// A table tennis ball at 150 turns a second, in each unit.
    #[test]
    fn the_unit_of_a_spin_that_no_ball_has_is_told() {
        let rad_s = 150.0 * std::f64::consts::TAU;
        assert_eq!(told(rad_s), "");
        assert_eq!(told(-rad_s), "");
        let degrees = told(rad_s * DEGREES);
        assert!(
            degrees.contains("episode a") && degrees.contains("in deg/s? Import"),
            "{degrees}"
        );
        let rpm = told(-rad_s * RPM);
        assert!(rpm.contains("in deg/s or rpm?"), "{rpm}");
        assert!(told(1e6).contains("leave the episode out"));
    }
}
