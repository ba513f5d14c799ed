//! Values of Python as the engines read them: mappings, lists, text and numbers, without JSON text in between.

use crate::errors::{PyFault, to_python};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyInt, PyList, PyMapping, PyString, PyTuple};
use serde::de::DeserializeOwned;
use serde_json::{Map, Number, Value};

/// Largest nesting depth of lists and mappings.
const DEEPEST: usize = 100;

/// An argument of mappings, lists, text and numbers.
pub(crate) struct JsonArgument(Value);

impl<'py> FromPyObject<'_, 'py> for JsonArgument {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        value(&object, 0).map(Self)
    }
}

impl JsonArgument {
    /// With a field that a mapping has where it does not state it.
    pub(crate) fn with_default(mut self, field: &str, value: u32) -> Self {
        if let Value::Object(fields) = &mut self.0 {
            fields.entry(field).or_insert_with(|| value.into());
        }
        self
    }

    /// Returns it as JSON.
    pub(crate) fn into_value(self) -> Value {
        self.0
    }

    /// Reads what the engine takes.
    pub(crate) fn read<T: DeserializeOwned>(self) -> Result<T, PyFault> {
        Ok(serde_json::from_value(self.0)?)
    }
}

fn refused(what: &str) -> PyErr {
    to_python(PyFault::Config(what.to_owned()))
}

fn value(object: &Bound<'_, PyAny>, depth: usize) -> PyResult<Value> {
    if depth > DEEPEST {
        return Err(refused(
            "nested too deep; allowed are 100 lists and mappings in each other",
        ));
    }
    if object.is_none() {
        return Ok(Value::Null);
    }
    if let Ok(flag) = object.cast::<PyBool>() {
        return Ok(Value::Bool(flag.is_true()));
    }
    if let Ok(text) = object.cast::<PyString>() {
        return written(text).map(Value::String);
    }
    if object.is_instance_of::<PyInt>() {
        let number: Option<Number> = match object.extract::<i64>() {
            Ok(number) => Some(number.into()),
            Err(_) => match object.extract::<u64>() {
                Ok(number) => Some(number.into()),
                Err(_) => Number::from_f64(object.extract()?),
            },
        };
        return number
            .map(Value::Number)
            .ok_or_else(|| refused("a number that is not finite"));
    }
    if let Ok(number) = object.cast::<PyFloat>() {
        let number = Number::from_f64(number.value());
        return number
            .map(Value::Number)
            .ok_or_else(|| refused("a number that is not finite"));
    }
    if object.is_instance_of::<PyList>() || object.is_instance_of::<PyTuple>() {
        let rows = object.try_iter()?.map(|row| value(&row?, depth + 1));
        return rows.collect::<PyResult<_>>().map(Value::Array);
    }
    if let Ok(rows) = object.cast::<PyMapping>() {
        let mut map = Map::new();
        for row in rows.items()?.iter() {
            let (name, part): (Bound<'_, PyAny>, Bound<'_, PyAny>) = row.extract()?;
            let name = name
                .cast::<PyString>()
                .map_err(|_| refused("a name that is no text; expected text"))?;
            map.insert(written(name)?, value(&part, depth + 1)?);
        }
        return Ok(Value::Object(map));
    }
    Err(refused("expected numbers, text, lists or mappings"))
}

fn written(text: &Bound<'_, PyString>) -> PyResult<String> {
    match text.to_str() {
        Ok(text) => Ok(text.to_owned()),
        Err(_) => Err(refused("expected text that UTF-8 can hold")),
    }
}
