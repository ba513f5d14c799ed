//! Numbers of plain structs by name, with units and ranges: the fields of agents' addresses.

use super::Parameter;

/// A number of a `T`: name, unit, range, and its accessor.
pub(super) struct NumericField<T> {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) range: [f64; 2],
    pub(super) get: fn(&T) -> f32,
    pub(super) set: fn(&mut T, f32),
}

macro_rules! number {
    ($name:ident, $unit:literal, $low:literal to $high:literal) => {
        NumericField {
            name: stringify!($name),
            unit: $unit,
            range: [$low, $high],
            get: |of| of.$name,
            set: |of, value| of.$name = value,
        }
    };
}
pub(super) use number;

/// Returns all numbers of `of` by name.
pub(super) fn parameters<T>(numbers: &[NumericField<T>], of: &T) -> Vec<(&'static str, Parameter)> {
    let parameter = |number: &NumericField<T>| Parameter {
        value: f64::from((number.get)(of)),
        unit: number.unit,
        low: number.range[0],
        high: number.range[1],
    };
    numbers
        .iter()
        .map(|number| (number.name, parameter(number)))
        .collect()
}

/// Sets each number for whose name `value_of` gives a value.
pub(super) fn set<T>(
    numbers: &[NumericField<T>],
    of: &mut T,
    value_of: impl Fn(&str) -> Option<f32>,
) {
    for number in numbers {
        if let Some(value) = value_of(number.name) {
            (number.set)(of, value);
        }
    }
}
