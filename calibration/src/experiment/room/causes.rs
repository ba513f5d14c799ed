//! What may be missing or wrong in a room: its surfaces and walls, the air, what is recorded with.

use super::scan::{self, BoxRecording};
use super::setup::RoomSetup;
use crate::bundle::file::{MeasurementDescription, RoomManifest};
use crate::bundle::{Bundle, ROOM_SURFACES};
use crate::error::CalibrationError;
use crate::experiment::{Cause, CauseBinding, FitParameter, MeasurementFault};
use dwell_acoustics::bands::NOMINAL_CENTRES_HZ;
use dwell_scene::{House, State};

/// Step of a finite difference of an absorption.
pub(super) const ABSORPTION_STEP: f64 = 0.04;
/// Number of materials of a house that are fitted, those with the largest area.
const MOST_MATERIALS: usize = 8;
/// Temperatures of rooms, degrees Celsius.
const ROOM_TEMPERATURES_C: [f64; 2] = [0.0, 40.0];
/// Standard deviations within which a measured temperature is plausible.
const TEMPERATURE_SDS: f64 = 3.0;
/// Share of an edge by which a wall may stand elsewhere.
const WALL_SHARE: f64 = 0.3;
/// Standard deviations of places within which a wall is plausible, where they are told.
const WALL_SDS: f64 = 4.0;
/// Temperature at which the speed of sound is 343.2 m/s, K.
const REFERENCE_K: f64 = 293.15;
/// Causes that change all times in one proportion: in one room at one temperature they are one.
const STRETCHING: [&str; 4] = [
    "temperature_error",
    "clock_scale",
    "length_scale",
    "clock_drift",
];

/// The sides of a box: axis, and whether it begins there, in the order of [`ROOM_SURFACES`].
pub(super) const SIDES: [(usize, bool); 6] = [
    (1, true),
    (1, false),
    (0, true),
    (0, false),
    (2, true),
    (2, false),
];

/// All causes of a room.
pub(super) fn causes(
    bundle: &Bundle,
    stage: &RoomSetup,
    room: Option<&RoomManifest>,
    bands: &std::ops::Range<usize>,
    recordings: &[BoxRecording<'_>],
) -> Result<Vec<Cause>, CalibrationError> {
    let manifest = &bundle.manifest;
    let mut state = State::new(&stage.house);
    let mut all = if bands.is_empty() {
        Vec::new()
    } else {
        absorptions(&stage.house, &mut state, bands, room)?
    };
    let config = stage.scene.config();
    let speed_m_s = config.air.speed_of_sound_m_s();
    let stretch = room.map_or(1.0, |room| {
        scan::best_stretch(recordings, room.size_m, speed_m_s, manifest.response_times)
    });
    // The scale of a recording's pressure is unknown, so that it shows no pressures.
    let in_pascal = |law: &&dwell_scene::LawInfo| law.params.iter().any(|p| p.unit == "Pa");
    for law in dwell_acoustics::laws::all().filter(|law| !in_pascal(law)) {
        let mut cause = Cause::of_law(law, &[], &[]);
        if cause.id == "temperature_error" {
            judge_temperature(&mut cause, manifest, config.air.temperature_c, stretch);
        }
        all.push(cause);
    }
    for (fault, scale) in [
        (MeasurementFault::ClockScale, stretch),
        (MeasurementFault::LengthScale, 1.0 / stretch),
    ] {
        let mut cause = fault.cause();
        if (scale - 1.0).abs() > 1e-9 {
            cause.probes.push(vec![scale]);
        }
        let (name, experiment) = match fault {
            MeasurementFault::ClockScale => (
                "another rate of the recorder's clock",
                "record a known clock for ten minutes with the recorder, or measure the length of the excitation in the recording",
            ),
            _ => (
                "another scale of the lengths of the room",
                "measure one length of the room again, with another instrument",
            ),
        };
        name.clone_into(&mut cause.name);
        experiment.clone_into(&mut cause.separating_experiment);
        all.push(cause);
    }
    if let Some(room) = room {
        let walls = (0..SIDES.len()).map(|side| wall(side, room, recordings, speed_m_s, manifest));
        all.extend(walls);
    }
    Ok(all)
}

/// The positions of causes that cannot be told from one of the causes by times alone.
pub(super) fn indistinguishable_causes(causes: &[Cause], of: usize) -> Vec<usize> {
    if !STRETCHING.contains(&causes[of].id.as_str()) {
        return Vec::new();
    }
    let others = (0..causes.len()).filter(|k| *k != of);
    others
        .filter(|k| STRETCHING.contains(&causes[*k].id.as_str()))
        .collect()
}

/// Where a temperature was measured, only its own error is plausible; else any of a room.
fn judge_temperature(
    cause: &mut Cause,
    manifest: &MeasurementDescription,
    stated_c: f64,
    stretch: f64,
) {
    let Some(parameter) = cause.parameters.first_mut() else {
        return;
    };
    parameter.plausible = match manifest.scene.environment.temperature_sd_k {
        Some(sd) => [-TEMPERATURE_SDS * sd, TEMPERATURE_SDS * sd],
        None => ROOM_TEMPERATURES_C.map(|end| end - stated_c),
    };
    let stated_k = stated_c - 20.0 + REFERENCE_K;
    let offset_k = stated_k / (stretch * stretch) - stated_k;
    if offset_k != 0.0 && (parameter.low..=parameter.high).contains(&offset_k) {
        cause.probes.push(vec![offset_k]);
    }
    cause.separating_experiment = "read a thermometer beside the microphone, to 1 K: a kelvin is 0.17 % of all times; or measure \
                                   again when the room is 10 K warmer or cooler: only what the air does changes"
        .into();
}

/// Another place of a side.
fn wall(
    side: usize,
    room: &RoomManifest,
    recordings: &[BoxRecording<'_>],
    speed_m_s: f64,
    manifest: &MeasurementDescription,
) -> Cause {
    let name = ROOM_SURFACES[side];
    let edge_m = room.size_m[SIDES[side].0];
    let inward_m = scan::inward_clearance_m(recordings, room.size_m, SIDES[side]);
    let low = -inward_m.min(WALL_SHARE * edge_m);
    // Where it is told how well places are known, only that is plausible.
    let known = room.position_sd_m.map(|sd| WALL_SDS * sd);
    let plausible_m = known.unwrap_or(WALL_SHARE * edge_m);
    let probe = scan::best_wall_offset_m(
        recordings,
        room.size_m,
        SIDES[side],
        speed_m_s,
        manifest.response_times,
    );
    Cause {
        id: format!("wall_position/{name}"),
        name: format!("another place of the {name} side"),
        equation:
            "the side lies offset_m further out than described (m), with all images behind it"
                .into(),
        parameters: vec![FitParameter {
            name: "offset_m".into(),
            unit: "m".into(),
            default: 0.0,
            low,
            high: WALL_SHARE * edge_m,
            plausible: [-plausible_m, plausible_m],
            step: 0.01,
        }],
        probes: probe.map(|offset| vec![offset]).into_iter().collect(),
        separating_experiment: format!(
            "measure the distance to the {name} side with a tape: its own reflections come later, those of the others stay"
        ),
        binding: CauseBinding::Wall(side),
        fixed: Vec::new(),
    }
}

/// One cause for each surface's material: its absorption in every band.
fn absorptions(
    house: &House,
    state: &mut State,
    bands: &std::ops::Range<usize>,
    room: Option<&RoomManifest>,
) -> Result<Vec<Cause>, CalibrationError> {
    let mut areas = vec![0.0_f32; house.materials.len()];
    for piece in &house.structure {
        let mesh = &house.meshes[piece.mesh];
        for (k, triangle) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|corner| mesh.positions[corner as usize]);
            if let Some(material) = piece.materials.get(usize::from(mesh.slot(k))) {
                areas[material.0 as usize] += 0.5 * (b - a).cross(c - a).length();
            }
        }
    }
    let mut order: Vec<usize> = (0..areas.len()).filter(|k| areas[*k] > 0.0).collect();
    order.sort_by(|a, b| areas[*b].total_cmp(&areas[*a]));
    order.truncate(MOST_MATERIALS);
    order.sort_unstable();
    // Sides of a box may be of one material.
    let mut groups: Vec<(String, Vec<String>)> = Vec::new();
    for index in order {
        let (_, material) = house
            .materials
            .iter_ids()
            .nth(index)
            .expect("areas are indexed by material");
        let told = room.and_then(|room| room.surfaces.get(&material.name)?.material.clone());
        let name = told.unwrap_or_else(|| material.name.clone());
        match groups.iter_mut().find(|(other, _)| *other == name) {
            Some((_, members)) => members.push(material.name.clone()),
            None => groups.push((name, vec![material.name.clone()])),
        }
    }
    let mut causes = Vec::new();
    for (name, members) in groups {
        let (mut parameters, mut addresses) = (Vec::new(), Vec::new());
        for band in bands.clone() {
            let centre = NOMINAL_CENTRES_HZ[band];
            let texts: Vec<String> = members
                .iter()
                .map(|member| format!("material/{member}/absorption/{centre}"))
                .collect();
            let fault =
                |error: &dyn std::fmt::Display| CalibrationError::simulation(&texts[0], error);
            let address = texts[0].parse().map_err(|e| fault(&e))?;
            let here = state.parameter(house, &address).map_err(|e| fault(&e))?;
            parameters.push(FitParameter {
                name: format!("absorption at {centre} Hz"),
                unit: "1".into(),
                default: here.value,
                low: 0.0,
                high: 1.0,
                plausible: [0.003, 0.999],
                step: ABSORPTION_STEP,
            });
            addresses.push(texts);
        }
        causes.push(Cause {
            id: format!("absorption/{name}"),
            name: format!("another absorption of {name}"),
            equation: "a reflection keeps 1 - alpha of the energy, alpha by band".into(),
            parameters,
            separating_experiment: format!(
                "measure close to {name} and far from it: its own early reflections change their level, the late decay \
                 shows the sum over all surfaces alone; or cover it and measure again"
            ),
            binding: CauseBinding::SharedAddresses(addresses),
            fixed: Vec::new(),
            probes: Vec::new(),
        });
    }
    Ok(causes)
}
