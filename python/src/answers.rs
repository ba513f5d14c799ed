//! Results of the engines as values of Python: mappings, lists, text and numbers, without JSON text in between.

use crate::errors::PyFault;
use dwell_scene::interrupt;
use pyo3::IntoPyObject;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde::ser::{
    Error as _, Serialize, SerializeMap, SerializeSeq, SerializeStruct, SerializeStructVariant,
    SerializeTuple, SerializeTupleStruct, SerializeTupleVariant, Serializer,
};
use serde_json::Error;
use std::borrow::Cow;

/// The name of a field.
type Name = Cow<'static, str>;

/// An answer that is put together without Python, and becomes Python's own when the call returns. Fields keep their order;
/// numbers that are not finite become `None`.
#[derive(Debug, PartialEq)]
pub(crate) enum PyValue {
    Nothing,
    Flag(bool),
    Signed(i64),
    Unsigned(u64),
    Number(f64),
    Text(String),
    Rows(Vec<Self>),
    Fields(Vec<(Name, Self)>),
}

impl PyValue {
    /// An answer of what the engine says.
    pub(crate) fn of(value: &(impl Serialize + ?Sized)) -> Result<Self, PyFault> {
        Ok(value.serialize(AnswerSerializer)?)
    }

    fn number(number: f64) -> Self {
        if number.is_finite() {
            Self::Number(number)
        } else {
            Self::Nothing
        }
    }

    /// As the content of an enum's variant, where it is of one.
    fn of_variant(self, variant: Option<&'static str>) -> Self {
        match variant {
            Some(name) => Self::Fields(vec![(name.into(), self)]),
            None => self,
        }
    }
}

impl<'py> IntoPyObject<'py> for PyValue {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(match self {
            Self::Nothing => py.None().into_bound(py),
            Self::Flag(flag) => flag.into_pyobject(py)?.to_owned().into_any(),
            Self::Signed(number) => number.into_pyobject(py)?.into_any(),
            Self::Unsigned(number) => number.into_pyobject(py)?.into_any(),
            Self::Number(number) => number.into_pyobject(py)?.into_any(),
            Self::Text(text) => text.into_pyobject(py)?.into_any(),
            Self::Rows(rows) => {
                let list = PyList::empty(py);
                for row in rows {
                    // Lists may be long, and nobody else asks while Python's objects are made.
                    py.check_signals()?;
                    list.append(row)?;
                }
                list.into_any()
            }
            Self::Fields(fields) => {
                let dict = PyDict::new(py);
                for (name, field) in fields {
                    dict.set_item(name, field)?;
                }
                dict.into_any()
            }
        })
    }
}

/// Makes answers of what can be serialized.
struct AnswerSerializer;

/// Rows that are being put together, of an enum's variant where they have one.
struct SequenceSerializer {
    variant: Option<&'static str>,
    rows: Vec<PyValue>,
}

/// Fields that are being put together, of an enum's variant where they have one.
struct MapSerializer {
    variant: Option<&'static str>,
    /// Of the value that comes next.
    name: Option<Name>,
    fields: Vec<(Name, PyValue)>,
}

fn rows(variant: Option<&'static str>, count: usize) -> SequenceSerializer {
    SequenceSerializer {
        variant,
        rows: Vec::with_capacity(count),
    }
}

fn fields(variant: Option<&'static str>, count: usize) -> MapSerializer {
    MapSerializer {
        variant,
        name: None,
        fields: Vec::with_capacity(count),
    }
}

impl SequenceSerializer {
    fn push(&mut self, value: &(impl Serialize + ?Sized)) -> Result<(), Error> {
        interrupt::unwind_if_cancelled();
        self.rows.push(value.serialize(AnswerSerializer)?);
        Ok(())
    }

    fn finish(self) -> PyValue {
        PyValue::Rows(self.rows).of_variant(self.variant)
    }
}

impl MapSerializer {
    fn push(
        &mut self,
        name: impl Into<Name>,
        value: &(impl Serialize + ?Sized),
    ) -> Result<(), Error> {
        let value = value.serialize(AnswerSerializer)?;
        self.fields.push((name.into(), value));
        Ok(())
    }

    fn finish(self) -> PyValue {
        PyValue::Fields(self.fields).of_variant(self.variant)
    }
}

/// Whole numbers of all lengths are kept as the longest.
macro_rules! whole_numbers {
    ($($serialize:ident: $Number:ty = $Kind:ident,)+) => {$(
        fn $serialize(self, value: $Number) -> Result<PyValue, Error> {
            Ok(PyValue::$Kind(value.into()))
        }
    )+};
}

impl Serializer for AnswerSerializer {
    type Ok = PyValue;
    type Error = Error;
    type SerializeSeq = SequenceSerializer;
    type SerializeTuple = SequenceSerializer;
    type SerializeTupleStruct = SequenceSerializer;
    type SerializeTupleVariant = SequenceSerializer;
    type SerializeMap = MapSerializer;
    type SerializeStruct = MapSerializer;
    type SerializeStructVariant = MapSerializer;

    fn serialize_bool(self, value: bool) -> Result<PyValue, Error> {
        Ok(PyValue::Flag(value))
    }

    whole_numbers! {
        serialize_i8: i8 = Signed, serialize_i16: i16 = Signed, serialize_i32: i32 = Signed, serialize_i64: i64 = Signed,
        serialize_u8: u8 = Unsigned, serialize_u16: u16 = Unsigned, serialize_u32: u32 = Unsigned, serialize_u64: u64 = Unsigned,
    }

    fn serialize_f32(self, value: f32) -> Result<PyValue, Error> {
        // 0.1, not 0.10000000149011612: of all numbers that are this one in 32 bits the one with the fewest digits.
        let shortest = value.to_string().parse().map_err(Error::custom)?;
        Ok(PyValue::number(shortest))
    }

    fn serialize_f64(self, value: f64) -> Result<PyValue, Error> {
        Ok(PyValue::number(value))
    }

    fn serialize_char(self, value: char) -> Result<PyValue, Error> {
        Ok(PyValue::Text(value.to_string()))
    }

    fn serialize_str(self, value: &str) -> Result<PyValue, Error> {
        Ok(PyValue::Text(value.to_owned()))
    }

    fn serialize_bytes(self, value: &[u8]) -> Result<PyValue, Error> {
        let bytes = value.iter().map(|byte| PyValue::Unsigned((*byte).into()));
        Ok(PyValue::Rows(bytes.collect()))
    }

    fn serialize_none(self) -> Result<PyValue, Error> {
        Ok(PyValue::Nothing)
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<PyValue, Error> {
        value.serialize(self)
    }

    fn serialize_unit(self) -> Result<PyValue, Error> {
        Ok(PyValue::Nothing)
    }

    fn serialize_unit_struct(self, _: &'static str) -> Result<PyValue, Error> {
        Ok(PyValue::Nothing)
    }

    fn serialize_unit_variant(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
    ) -> Result<PyValue, Error> {
        Ok(PyValue::Text(variant.to_owned()))
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        value: &T,
    ) -> Result<PyValue, Error> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<PyValue, Error> {
        Ok(value.serialize(self)?.of_variant(Some(variant)))
    }

    fn serialize_seq(self, count: Option<usize>) -> Result<SequenceSerializer, Error> {
        Ok(rows(None, count.unwrap_or(0)))
    }

    fn serialize_tuple(self, count: usize) -> Result<SequenceSerializer, Error> {
        Ok(rows(None, count))
    }

    fn serialize_tuple_struct(
        self,
        _: &'static str,
        count: usize,
    ) -> Result<SequenceSerializer, Error> {
        Ok(rows(None, count))
    }

    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        count: usize,
    ) -> Result<SequenceSerializer, Error> {
        Ok(rows(Some(variant), count))
    }

    fn serialize_map(self, count: Option<usize>) -> Result<MapSerializer, Error> {
        Ok(fields(None, count.unwrap_or(0)))
    }

    fn serialize_struct(self, _: &'static str, count: usize) -> Result<MapSerializer, Error> {
        Ok(fields(None, count))
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        count: usize,
    ) -> Result<MapSerializer, Error> {
        Ok(fields(Some(variant), count))
    }
}

/// Rows are all alike, whatever they are called.
macro_rules! rows_are_pushed {
    ($($Kind:ident::$push:ident,)+) => {$(
        impl $Kind for SequenceSerializer {
            type Ok = PyValue;
            type Error = Error;

            fn $push<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Error> {
                self.push(value)
            }

            fn end(self) -> Result<PyValue, Error> {
                Ok(self.finish())
            }
        }
    )+};
}

rows_are_pushed! {
    SerializeSeq::serialize_element,
    SerializeTuple::serialize_element,
    SerializeTupleStruct::serialize_field,
    SerializeTupleVariant::serialize_field,
}

/// So are fields.
macro_rules! fields_are_pushed {
    ($($Kind:ident,)+) => {$(
        impl $Kind for MapSerializer {
            type Ok = PyValue;
            type Error = Error;

            fn serialize_field<T: Serialize + ?Sized>(
                &mut self,
                name: &'static str,
                value: &T,
            ) -> Result<(), Error> {
                self.push(name, value)
            }

            fn end(self) -> Result<PyValue, Error> {
                Ok(self.finish())
            }
        }
    )+};
}

fields_are_pushed! { SerializeStruct, SerializeStructVariant, }

impl SerializeMap for MapSerializer {
    type Ok = PyValue;
    type Error = Error;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), Error> {
        self.name = Some(match key.serialize(AnswerSerializer)? {
            PyValue::Text(name) => name.into(),
            PyValue::Signed(number) => number.to_string().into(),
            PyValue::Unsigned(number) => number.to_string().into(),
            _ => return Err(Error::custom("a name must be text or a whole number")),
        });
        Ok(())
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Error> {
        let name = self.name.take();
        let name = name.ok_or_else(|| Error::custom("a value without a name"))?;
        self.push(name, value)
    }

    fn end(self) -> Result<PyValue, Error> {
        Ok(self.finish())
    }
}
