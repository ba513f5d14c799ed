//! Checks of a bundle's manifest: required fields, and ranges that make sense.

use super::file::{BodyManifest, BundleKind, MeasurementDescription, SurfaceManifest, VERSION};
use super::limits;
use crate::error::CalibrationError;
use dwell_scene::material::library;
use std::collections::BTreeMap;

type CheckResult = Result<(), CalibrationError>;

/// The sides of a box-shaped room, as scene's shoebox names them.
pub(crate) const ROOM_SURFACES: [&str; 6] = ["floor", "ceiling", "west", "east", "north", "south"];
/// Densities of bodies, kg/m3: from a balloon, which is mostly what it floats in, to beyond osmium.
const DENSITIES_KG_M3: [f64; 2] = [0.05, 25_000.0];
/// Positions by the names of a manifest.
pub(super) struct NameIndex {
    entities: BTreeMap<String, usize>,
    channels: BTreeMap<String, usize>,
}

impl NameIndex {
    pub(super) fn new(manifest: &MeasurementDescription) -> Self {
        let scene = &manifest.scene;
        let bodies = scene.bodies.iter().map(|body| body.name.clone());
        let joints = scene.joints.iter().map(|joint| joint.name.clone());
        let channels = manifest.channels.iter().map(|channel| channel.name.clone());
        Self {
            entities: bodies
                .chain(joints)
                .enumerate()
                .map(|(k, name)| (name, k))
                .collect(),
            channels: channels.enumerate().map(|(k, name)| (name, k)).collect(),
        }
    }

    pub(super) fn entity(
        &self,
        at: &str,
        field: &str,
        name: &str,
    ) -> Result<usize, CalibrationError> {
        find(&self.entities, at, field, name)
    }

    pub(super) fn channel(&self, at: &str, name: &str) -> Result<usize, CalibrationError> {
        find(&self.channels, at, "channel", name)
    }
}

fn find(
    names: &BTreeMap<String, usize>,
    at: &str,
    field: &str,
    name: &str,
) -> Result<usize, CalibrationError> {
    names.get(name).copied().ok_or_else(|| {
        let known: Vec<_> = names.keys().take(12).collect();
        CalibrationError::field(
            at,
            field,
            format!("{name:?}"),
            format!("one of the manifest's: {known:?}"),
        )
    })
}

/// Checks a name of 1 to 128 printable characters.
pub(super) fn check_name(at: &str, field: &str, name: &str) -> CheckResult {
    let fits = (1..=limits::MAX_NAME_CHARS).contains(&name.chars().count())
        && !name.chars().any(char::is_control);
    if fits {
        return Ok(());
    }
    let shown: String = name.chars().take(40).collect();
    Err(CalibrationError::field(
        at,
        field,
        format!("{shown:?}"),
        "1 to 128 printable characters",
    ))
}

/// Checks a finite number of at most `limit`.
pub(super) fn check_finite(at: &str, field: &str, value: f64, limit: f64) -> CheckResult {
    range(at, field, value, -limit, limit)
}

/// Checks a position along an axis, m.
pub(super) fn check_position(at: &str, field: &str, value: f64) -> CheckResult {
    let allowed = "-1000 to 1000 m; are lengths in millimetres? Divide them by 1000, or import with \"metres_per_unit\": \
                   0.001 in the map's table";
    check_finite(at, field, value, 1e3)
        .map_err(|_| CalibrationError::field(at, field, value, allowed))
}

/// Checks a time on a clock, s.
pub(super) fn check_time(at: &str, t_s: f64) -> CheckResult {
    range(at, "t_s", t_s, -1e6, 1e6)
}

fn range(at: &str, field: &str, value: f64, low: f64, high: f64) -> CheckResult {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(CalibrationError::field(
        at,
        field,
        value,
        format!("{low} to {high}"),
    ))
}

/// Checks a point in the room.
pub(super) fn check_point_in_room(
    at: &str,
    field: &str,
    point: [f64; 3],
    manifest: &MeasurementDescription,
) -> CheckResult {
    for (k, axis) in ["x", "y", "z"].iter().enumerate() {
        let field = format!("{field}_{axis}");
        match &manifest.scene.room {
            Some(room) => range(at, &field, point[k], 0.01, room.size_m[k] - 0.01)?,
            None => check_finite(at, &field, point[k], 1e4)?,
        }
    }
    Ok(())
}

/// Checks the manifest's own ranges.
pub(super) fn check_manifest(at: &str, manifest: &MeasurementDescription) -> CheckResult {
    if !(1..=VERSION).contains(&manifest.version) {
        let allowed = format!("1 to {VERSION}, the versions this build reads");
        return Err(CalibrationError::field(
            at,
            "version",
            manifest.version,
            allowed,
        ));
    }
    let scene = &manifest.scene;
    for (what, count) in [
        ("bodies", scene.bodies.len()),
        ("joints", scene.joints.len()),
        ("channels", manifest.channels.len()),
    ] {
        if count as u64 > limits::MAX_MANIFEST_ENTRIES {
            let (found, limit) = (count as u64, limits::MAX_MANIFEST_ENTRIES);
            return Err(CalibrationError::TooLarge {
                at: at.to_owned(),
                what,
                found,
                limit,
            });
        }
    }
    let air = &scene.environment;
    for (field, value, low, high) in [
        ("temperature_c", air.temperature_c, -40.0, 60.0),
        ("temperature_sd_k", air.temperature_sd_k, 0.01, 20.0),
        ("humidity_pct", air.humidity_pct, 0.0, 100.0),
        ("pressure_pa", air.pressure_pa, 3e4, 2e5),
        ("g_m_s2", air.g_m_s2, 0.0, 100.0),
    ] {
        let of = format!("scene.environment.{field}");
        match value {
            Some(value) if field == "g_m_s2" && value < 0.0 => {
                let allowed = format!("{low} to {high}: how strong it is, which is {}", -value);
                return Err(CalibrationError::field(at, of, value, allowed));
            }
            Some(value) => range(at, &of, value, low, high)?,
            None => {}
        }
    }
    for (k, body) in scene.bodies.iter().enumerate() {
        let of = |field: &str| format!("scene.bodies[{k}].{field}");
        check_name(at, &of("name"), &body.name)?;
        range(at, &of("mass_kg"), body.mass_kg, 1e-6, 1e4)?;
        shape(at, &of, body)?;
    }
    if let Some(board) = &scene.board {
        range(at, "scene.board.friction", board.friction, 0.0, 10.0)?;
        range(at, "scene.board.restitution", board.restitution, 0.0, 1.0)?;
        for substance in board.substances.iter().flatten() {
            known_substance(at, "scene.board.substances", substance)?;
        }
    }
    if let Some(base) = &scene.base {
        range(
            at,
            "scene.base.wheel_radius_m",
            base.wheel_radius_m,
            1e-3,
            1.0,
        )?;
        range(at, "scene.base.wheel_base_m", base.wheel_base_m, 0.01, 5.0)?;
        range(at, "scene.base.rate_hz", base.rate_hz, 1.0, 1000.0)?;
    }
    if manifest.kind == BundleKind::PoseTrajectory {
        pose_form(at, manifest)?;
    }
    for (k, joint) in scene.joints.iter().enumerate() {
        let of = |field: &str| format!("scene.joints[{k}].{field}");
        check_name(at, &of("name"), &joint.name)?;
        range(at, &of("inertia_kg_m2"), joint.inertia_kg_m2, 1e-7, 1e3)?;
        range(
            at,
            &of("stiffness_n_m_rad"),
            joint.stiffness_n_m_rad,
            1e-3,
            1e6,
        )?;
        range(
            at,
            &of("damping_n_m_s_rad"),
            joint.damping_n_m_s_rad,
            0.0,
            1e5,
        )?;
        range(at, &of("max_torque_n_m"), joint.max_torque_n_m, 1e-4, 1e6)?;
        range(at, &of("friction_n_m"), joint.friction_n_m, 0.0, 1e5)?;
    }
    if let Some(room) = &scene.room {
        for edge in room.size_m {
            range(at, "scene.room.size_m", edge, 0.5, 200.0)?;
        }
        for side in ROOM_SURFACES {
            let Some(surface) = room.surfaces.get(side) else {
                return Err(missing(
                    at,
                    &format!("scene.room.surfaces.{side}"),
                    "all six sides must be described",
                ));
            };
            surface_of(at, side, surface)?;
        }
        if let Some(other) = room
            .surfaces
            .keys()
            .find(|name| !ROOM_SURFACES.contains(&name.as_str()))
        {
            return Err(CalibrationError::field(
                at,
                "scene.room.surfaces",
                format!("{other:?}"),
                format!("{ROOM_SURFACES:?}"),
            ));
        }
    }
    channels(at, manifest)
}

/// Checks a length of a body, m: 1 mm to 10 m.
fn length(at: &str, field: &str, value: f64) -> CheckResult {
    let allowed = "0.001 to 10 m; is it in millimetres? Divide it by 1000";
    range(at, field, value, 1e-3, 10.0)
        .map_err(|_| CalibrationError::field(at, field, value, allowed))
}

/// Checks that something of this volume can have a mass.
fn density(at: &str, field: &str, mass_kg: f64, volume_m3: f64) -> CheckResult {
    let found = mass_kg / volume_m3;
    let hint = if found > DENSITIES_KG_M3[1] {
        "is the mass in grams, or are lengths too small?"
    } else if found < DENSITIES_KG_M3[0] {
        "are lengths in millimetres or centimetres, or is the mass too small?"
    } else {
        return Ok(());
    };
    let [low, high] = DENSITIES_KG_M3;
    let found = format!("{mass_kg} in {volume_m3:.3e} m3, which is {found:.3e} kg/m3");
    let allowed = format!("{low} to {high} kg/m3; {hint}");
    Err(CalibrationError::field(at, field, found, allowed))
}

/// Checks a sphere or a box, and an inertia that such a body can have.
fn shape(at: &str, of: &dyn Fn(&str) -> String, body: &BodyManifest) -> CheckResult {
    match (body.radius_m, body.half_extents_m) {
        (Some(radius), None) => {
            length(at, &of("radius_m"), radius)?;
            let volume_m3 = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
            density(at, &of("mass_kg"), body.mass_kg, volume_m3)?;
        }
        (None, Some(half)) => {
            for half in half {
                length(at, &of("half_extents_m"), half)?;
            }
            let volume_m3 = 8.0 * half.iter().product::<f64>();
            density(at, &of("mass_kg"), body.mass_kg, volume_m3)?;
        }
        (found, _) => {
            let found = if found.is_some() { "both" } else { "neither" };
            let allowed = "one of them: a sphere or a box";
            let field = of("radius_m and half_extents_m");
            return Err(CalibrationError::field(at, field, found, allowed));
        }
    }
    if let Some(inertia) = body.inertia_kg_m2 {
        for moment in inertia {
            range(at, &of("inertia_kg_m2"), moment, 1e-12, 1e6)?;
        }
        let [x, y, z] = inertia;
        if x > y + z || y > x + z || z > x + y {
            let allowed = "three moments of which none is larger than the sum of the others";
            let found = format!("{inertia:?}");
            return Err(CalibrationError::field(
                at,
                of("inertia_kg_m2"),
                found,
                allowed,
            ));
        }
    }
    Ok(())
}

fn pose_form(at: &str, manifest: &MeasurementDescription) -> CheckResult {
    if manifest.version < 2 {
        let allowed = "2 for pose trajectories";
        return Err(CalibrationError::field(
            at,
            "version",
            manifest.version,
            allowed,
        ));
    }
    let Some(form) = &manifest.poses else {
        return Err(missing(
            at,
            "poses",
            "the rate and the frame of the velocities must be said",
        ));
    };
    range(at, "poses.rate_hz", form.rate_hz, 10.0, 1000.0)?;
    if manifest.scene.board.is_none() {
        return Err(missing(
            at,
            "scene.board",
            "its friction and restitution before any fit",
        ));
    }
    if manifest.scene.bodies.len() != 1 {
        let found = manifest.scene.bodies.len();
        return Err(CalibrationError::field(
            at,
            "scene.bodies",
            found,
            "exactly one body",
        ));
    }
    Ok(())
}

fn known_substance(at: &str, field: &str, name: &str) -> CheckResult {
    if library().get(name).is_some() {
        return Ok(());
    }
    let allowed = "a substance of the engine's table, such as plaster, carpet or parquet";
    Err(CalibrationError::field(
        at,
        field,
        format!("{name:?}"),
        allowed,
    ))
}

fn surface_of(at: &str, side: &str, surface: &SurfaceManifest) -> CheckResult {
    let of = |field: &str| format!("scene.room.surfaces.{side}.{field}");
    if let Some(substance) = &surface.substance {
        known_substance(at, &of("substance"), substance)?;
    }
    if surface.substance.is_none() && surface.absorption.is_none() {
        return Err(missing(
            at,
            &of("absorption"),
            "a surface needs its absorption or a substance",
        ));
    }
    if let Some(bands) = &surface.absorption {
        let rising = bands.centres_hz.windows(2).all(|pair| pair[0] < pair[1]);
        if bands.centres_hz.is_empty()
            || bands.centres_hz.len() != bands.values.len()
            || !rising
            || bands.values.len() > 64
        {
            let found = format!(
                "{} centres and {} values",
                bands.centres_hz.len(),
                bands.values.len()
            );
            return Err(CalibrationError::field(
                at,
                of("absorption"),
                found,
                "1 to 64 rising centres with a value each",
            ));
        }
        for (centre, value) in bands.centres_hz.iter().zip(&bands.values) {
            range(at, &of("absorption.centres_hz"), *centre, 10.0, 1e5)?;
            range(at, &of("absorption.values"), *value, 0.0, 1.0)?;
        }
    }
    if let Some(scattering) = surface.scattering {
        range(at, &of("scattering"), scattering, 0.0, 1.0)?;
    }
    Ok(())
}

/// The unit of a channel of a kind of measurement; `None`: there is no such channel.
fn channel_unit(kind: BundleKind, name: &str) -> Option<&'static str> {
    let known: &[(&str, &[&str])] = match kind {
        BundleKind::Trajectory => &[("m", &["x", "y", "z"]), ("rad/s", &["wx", "wy", "wz"])],
        BundleKind::Servo => &[("rad", &["position"])],
        BundleKind::ImpulseResponse | BundleKind::PoseTrajectory | BundleKind::Drive => &[],
    };
    let found = known.iter().find(|(_, names)| names.contains(&name));
    found.map(|(unit, _)| *unit)
}

fn channels(at: &str, manifest: &MeasurementDescription) -> CheckResult {
    let allowed = match manifest.kind {
        BundleKind::Trajectory => "one of x, y, z (m) and wx, wy, wz (rad/s)",
        BundleKind::Servo => "position (rad)",
        BundleKind::ImpulseResponse | BundleKind::PoseTrajectory | BundleKind::Drive => {
            return Ok(());
        }
    };
    for (k, channel) in manifest.channels.iter().enumerate() {
        let of = |field: &str| format!("channels[{k}].{field}");
        let Some(unit) = channel_unit(manifest.kind, &channel.name) else {
            return Err(CalibrationError::field(
                at,
                of("name"),
                format!("{:?}", channel.name),
                allowed,
            ));
        };
        if manifest.channels[..k]
            .iter()
            .any(|other| other.name == channel.name)
        {
            return Err(CalibrationError::field(
                at,
                of("name"),
                format!("{:?} again", channel.name),
                "each name once",
            ));
        }
        if channel.unit != unit {
            return Err(CalibrationError::field(
                at,
                of("unit"),
                format!("{:?}", channel.unit),
                format!("{unit:?}"),
            ));
        }
        check_name(at, &of("clock"), &channel.clock)?;
        if let Some(sd) = channel.noise_sd {
            range(at, &of("noise_sd"), sd, 1e-9, 10.0)?;
        }
    }
    Ok(())
}

/// The error of something that is not there.
pub(super) fn missing(at: &str, what: &str, needed: &str) -> CalibrationError {
    CalibrationError::Missing {
        at: at.to_owned(),
        what: what.to_owned(),
        needed: needed.to_owned(),
    }
}
