//! Models of a base on two wheels.

use crate::rollout::series::{ModelParameter, SimulationModel};
use dwell_scene::LawSpec;

/// The angle by which the tracker's heading is off the robot's: a fault of the measurement, never put into the simulator.
pub(super) const HEADING_OFFSET: &str = "tracker_heading_offset_rad";

/// The base as it is believed to be; another wheel base; unequal wheels; with the tracker's heading off; with slip. There was
/// no gyro, so that its law cannot be judged.
pub fn models() -> Vec<SimulationModel> {
    let ratio = |name: &str| ModelParameter::new(name, "1", 1.0, [0.8, 1.25], 1e-4);
    let wheels = || {
        vec![
            ratio("radius_ratio"),
            ratio("base_ratio"),
            ratio("radius_scale"),
        ]
    };
    let with = |more: ModelParameter| {
        let mut all = wheels();
        all.push(more);
        all
    };
    let model = |name, about, extends, parameters| SimulationModel {
        name,
        about,
        extends,
        parameters,
    };
    vec![
        model(
            "nominal",
            "the base as it is believed to be, nothing fitted",
            None,
            Vec::new(),
        ),
        model(
            "base",
            "the law unequal_wheels with the wheel base fitted",
            Some("nominal"),
            vec![ratio("base_ratio")],
        ),
        model(
            "wheels",
            "the law unequal_wheels with all of its numbers fitted",
            Some("base"),
            wheels(),
        ),
        model(
            "tracker",
            "as wheels, and a tracker whose heading is off by a constant angle, fitted",
            Some("wheels"),
            with(ModelParameter::new(
                HEADING_OFFSET,
                "rad",
                0.0,
                [-0.3, 0.3],
                1e-4,
            )),
        ),
        model(
            "slip",
            "as wheels, and the law wheel_slip, fitted",
            Some("wheels"),
            with(ModelParameter::new(
                "slip_per_m_s2",
                "s2/m",
                0.0,
                [0.0, 1.0],
                1e-3,
            )),
        ),
    ]
}

/// The laws of a model with these values.
pub(super) fn laws(model: &SimulationModel, values: &[f64]) -> Vec<LawSpec> {
    let law = |id: &str, names: &[&str]| {
        let found = names.iter().filter_map(|name| {
            let place = model.parameters.iter().position(|p| p.name == *name)?;
            Some((*name, values[place]))
        });
        let spec = LawSpec::new(id, 1, &found.collect::<Vec<_>>());
        (!spec.params.is_empty()).then_some(spec)
    };
    let wheels = law(
        "unequal_wheels",
        &["radius_ratio", "base_ratio", "radius_scale"],
    );
    let slip = law("wheel_slip", &["slip_per_m_s2"]);
    wheels.into_iter().chain(slip).collect()
}
