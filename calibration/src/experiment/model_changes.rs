//! What a model changes in the simulation and in the measurement.

use super::cause::{Cause, CauseBinding};
use super::fault::FaultValues;
use dwell_scene::LawSpec;

/// The laws, values and faults of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ModelChanges {
    pub(crate) laws: Vec<LawSpec>,
    /// Values by address.
    pub(crate) overrides: Vec<(String, f64)>,
    pub(crate) faults: FaultValues,
    /// How far each side of the room lies further out, m.
    pub(crate) wall_offsets_m: [f64; 6],
}

impl ModelChanges {
    /// The causes that act at these values (one after the other, as in [`super::ParameterVector::causes`]). Laws act on all
    /// that they can: an experiment simulates one thing at a time.
    pub(crate) fn new(causes: &[Cause], values: &[f64]) -> Self {
        let mut found = Self::default();
        for (cause, values) in with_values(causes, values) {
            if !cause.acts(values) {
                continue;
            }
            match &cause.binding {
                CauseBinding::Law { version, .. } => {
                    found.laws.push(law_spec(cause, *version, None, values));
                }
                CauseBinding::Addresses(addresses) => {
                    let changed = addresses.iter().zip(&cause.parameters).zip(values);
                    found.overrides.extend(
                        changed
                            .filter(|((_, parameter), value)| {
                                (*value - parameter.default).abs() > 0.0
                            })
                            .map(|((address, _), value)| (address.clone(), *value)),
                    );
                }
                CauseBinding::SharedAddresses(groups) => {
                    for ((group, parameter), value) in
                        groups.iter().zip(&cause.parameters).zip(values)
                    {
                        if (*value - parameter.default).abs() > 0.0 {
                            let each = group.iter().map(|address| (address.clone(), *value));
                            found.overrides.extend(each);
                        }
                    }
                }
                CauseBinding::Wall(side) => found.wall_offsets_m[*side] += values[0],
                CauseBinding::Measurement(fault) => found.faults.set(*fault, values),
            }
        }
        found
    }

    /// What the causes with these positions change in a simulator that others run: each law on its targets, no faults.
    pub(crate) fn installable(causes: &[Cause], values: &[f64], which: &[usize]) -> Self {
        let mut found = Self::default();
        for (index, (cause, values)) in with_values(causes, values).enumerate() {
            if !which.contains(&index) {
                continue;
            }
            match &cause.binding {
                CauseBinding::Law { version, targets } => {
                    let mut install = |target: Option<String>| {
                        found.laws.push(law_spec(cause, *version, target, values));
                    };
                    if targets.is_empty() {
                        install(None);
                    }
                    for target in targets {
                        install(Some(target.clone()));
                    }
                }
                CauseBinding::Addresses(addresses) => {
                    let pairs = addresses.iter().cloned().zip(values.iter().copied());
                    found.overrides.extend(pairs);
                }
                CauseBinding::SharedAddresses(groups) => {
                    for (group, value) in groups.iter().zip(values) {
                        let each = group.iter().map(|address| (address.clone(), *value));
                        found.overrides.extend(each);
                    }
                }
                // The room's house is not that of those who install it.
                CauseBinding::Wall(_) | CauseBinding::Measurement(_) => {}
            }
        }
        found
    }
}

/// Each cause with its own part of the values.
fn with_values<'a>(
    causes: &'a [Cause],
    values: &'a [f64],
) -> impl Iterator<Item = (&'a Cause, &'a [f64])> {
    let mut first = 0;
    causes.iter().map(move |cause| {
        let range = first..first + cause.parameters.len();
        first = range.end;
        (cause, &values[range])
    })
}

fn law_spec(cause: &Cause, version: u32, target: Option<String>, values: &[f64]) -> LawSpec {
    let names = cause
        .parameters
        .iter()
        .map(|parameter| parameter.name.clone());
    LawSpec {
        id: cause.id.clone(),
        version,
        target,
        params: names
            .zip(values.iter().copied())
            .chain(cause.fixed.clone())
            .collect(),
    }
}
