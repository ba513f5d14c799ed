//! The content of `arch.json`, lengths in metres.

use serde::Deserialize;
use serde_json::Value;

use super::super::file::SuncgMaterial;
use crate::error::HousesError;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// Largest number of corners of a slab; ear clipping takes their cube.
const MAX_POINTS: usize = crate::limits::MAX_OUTLINE;
/// Largest number of holes of a wall; their edges cut it into squared many cells.
const MAX_HOLES: usize = 64;
/// Largest number of elements of a house.
const MAX_ELEMENTS: usize = 20_000;

/// All elements in file order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ArchFile {
    /// Walls, floors, ceilings and grounds.
    pub elements: Vec<ArchElement>,
}

/// The kind of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ElementKind {
    /// Upright, between two points.
    Wall,
    /// A slab to stand on.
    Floor,
    /// A slab above.
    Ceiling,
    /// A slab outside.
    Ground,
}

/// A wall or a slab.
#[derive(Debug, Clone, PartialEq)]
pub struct ArchElement {
    /// Its id.
    pub id: String,
    /// Its kind.
    pub kind: ElementKind,
    /// The rooms it belongs to: node ids.
    pub rooms: Vec<String>,
    /// Height of a wall with the extra height of all walls, m.
    pub height_m: f64,
    /// Thickness, m.
    pub depth_m: f64,
    /// The ends of a wall or the outline of a slab, offset included, m.
    pub points: Vec<[f64; 3]>,
    /// Openings of a wall.
    pub holes: Vec<ArchHole>,
    /// Looks of its sides.
    pub materials: Vec<SuncgMaterial>,
}

/// An opening of a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArchHole {
    /// Smallest (along the wall, up), m.
    pub min: [f64; 2],
    /// Largest (along the wall, up), m.
    pub max: [f64; 2],
}

/// Parses an `arch.json`. Elements that cannot be read are reported and left out.
///
/// # Errors
/// [`HousesError::Syntax`] when the text is no JSON, [`HousesError::TooLarge`] for too many elements.
pub fn parse(text: &[u8], name: &str, report: &mut LoadReport) -> Result<ArchFile, HousesError> {
    let at = FileLocation::file(name);
    let value = crate::json::value_of_unique_keys(text).map_err(|error| HousesError::Syntax {
        at: at.line(u32::try_from(error.line()).unwrap_or(u32::MAX)),
        message: format!("no valid JSON: {error}"),
    })?;
    let elements = value
        .get("elements")
        .and_then(Value::as_array)
        .map_or(&[][..], Vec::as_slice);
    if elements.len() > MAX_ELEMENTS {
        let (found, allowed) = (elements.len() as u64, MAX_ELEMENTS as u64);
        return Err(HousesError::TooLarge {
            at: at.field("elements"),
            what: "element count",
            found,
            allowed,
        });
    }
    let scale = number(value.get("scaleToMeters"))
        .filter(|s| (1e-6..=1e6).contains(s))
        .unwrap_or(1.0);
    let mut file = ArchFile::default();
    for (k, element) in elements.iter().enumerate() {
        match read_element(element, &value, scale) {
            Ok(element) => file.elements.push(element),
            Err(reason) => report.warn(
                at.field(format_args!("elements[{k}]")),
                WarningKind::BadRow { reason },
            ),
        }
    }
    Ok(file)
}

fn number(value: Option<&Value>) -> Option<f64> {
    let number = match value? {
        Value::Number(number) => number.as_f64(),
        Value::String(text) => text.trim().parse().ok(),
        _ => None,
    };
    number.filter(|x| x.is_finite())
}

fn vector<const N: usize>(value: &Value) -> Option<[f64; N]> {
    let numbers: Vec<f64> = value
        .as_array()?
        .iter()
        .map_while(|x| number(Some(x)))
        .collect();
    numbers.try_into().ok()
}

fn read_element(element: &Value, file: &Value, scale: f64) -> Result<ArchElement, String> {
    let text = |field: &str| {
        element
            .get(field)
            .and_then(Value::as_str)
            .unwrap_or_default()
            .to_owned()
    };
    let (kind, usual_depth) = match text("type").as_str() {
        "Wall" => (ElementKind::Wall, 0.1),
        "Floor" => (ElementKind::Floor, 0.05),
        "Ceiling" => (ElementKind::Ceiling, 0.05),
        "Ground" => (ElementKind::Ground, 0.05),
        other => {
            return Err(format!(
                "type {other:?} is no Wall, Floor, Ceiling or Ground"
            ));
        }
    };
    let default =
        |field: &str| number(file.pointer(&format!("/defaults/{}/{field}", text("type"))));
    let depth = number(element.get("depth")).or_else(|| default("depth"));
    let depth_m = depth.map_or(usual_depth, |depth| depth * scale);
    let offset = element
        .get("offset")
        .and_then(vector::<3>)
        .unwrap_or_default();
    let given = element
        .get("points")
        .and_then(Value::as_array)
        .ok_or("no points")?;
    if given.len() > MAX_POINTS {
        return Err(format!("{} points; allowed are {MAX_POINTS}", given.len()));
    }
    let place = |point: &Value| {
        Some(
            [0, 1, 2].map(|k| (vector::<3>(point).unwrap_or([f64::NAN; 3])[k] + offset[k]) * scale),
        )
    };
    let points: Vec<[f64; 3]> = given.iter().filter_map(place).collect();
    let needed = if kind == ElementKind::Wall { 2 } else { 3 };
    if points.len() < needed
        || points
            .iter()
            .flatten()
            .any(|x| !x.is_finite() || x.abs() > 30_000.0)
    {
        return Err(format!(
            "expected at least {needed} points of three numbers"
        ));
    }
    let height = number(element.get("height"))
        .or_else(|| default("height"))
        .unwrap_or(0.0);
    let height_m = (height + default("extraHeight").unwrap_or(0.0)) * scale;
    if kind == ElementKind::Wall && !(0.01..=1000.0).contains(&height_m)
        || !(1e-4..=10.0).contains(&depth_m)
    {
        return Err(format!("height {height_m} m, depth {depth_m} m"));
    }
    let hole = |hole: &Value| {
        let corner = |name: &str| {
            Some(vector::<2>(hole.pointer(&format!("/box/{name}"))?)?.map(|x| x * scale))
        };
        Some(ArchHole {
            min: corner("min")?,
            max: corner("max")?,
        })
    };
    let list = |field: &str| {
        element
            .get(field)
            .and_then(Value::as_array)
            .map_or(&[][..], Vec::as_slice)
    };
    let rooms = match element.get("roomId") {
        Some(Value::String(room)) => vec![room.clone()],
        Some(Value::Array(rooms)) => rooms
            .iter()
            .filter_map(|room| Some(room.as_str()?.to_owned()))
            .collect(),
        _ => Vec::new(),
    };
    Ok(ArchElement {
        id: text("id"),
        kind,
        rooms,
        height_m,
        depth_m,
        points,
        holes: list("holes")
            .iter()
            .take(MAX_HOLES)
            .filter_map(hole)
            .collect(),
        materials: list("materials")
            .iter()
            .map(|m| SuncgMaterial::deserialize(m).unwrap_or_default())
            .collect(),
    })
}
