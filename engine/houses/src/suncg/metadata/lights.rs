//! `suncgModelLights.json`: the lamps' lights; and the slots that glow, where `suncg.lights.json` lists them.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{base_model, unreadable};
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// One light of a model, in the model's space.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub struct SuncgLight {
    /// `SpotLight`, `PointLight` or `LineLight`.
    #[serde(rename = "type")]
    pub kind: String,
    /// W.
    pub power: f64,
    /// `#rrggbb`.
    pub color: String,
    /// m.
    pub position: [f64; 3],
    /// The other end of a line, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position2: Option<[f64; 3]>,
    /// Direction of a spot or a line.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// Half of the cone's opening angle, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cutoff_angle: Option<f64>,
    /// Exponent of the cosine away from the axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dropoff_rate: Option<f64>,
    /// Constant, linear and quadratic, over metres.
    pub attenuation: [f64; 3],
}

/// The lights of all models.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LightTable {
    lights: BTreeMap<String, Vec<SuncgLight>>,
    /// Slots that glow.
    emissive: BTreeMap<String, Vec<usize>>,
}

impl LightTable {
    /// Reads either file: `{model: [light, ...]}` or `{model: {lights: [...], materials: {emissive: [slot, ...]}}}`.
    pub fn read(text: &[u8], file: &str, report: &mut LoadReport) -> Self {
        let at = FileLocation::file(file);
        let mut table = Self::default();
        let models = crate::json::value_of_unique_keys(text).and_then(serde_json::from_value);
        let models: BTreeMap<String, Value> = match models {
            Ok(models) => models,
            Err(error) => {
                let reason = crate::plain_parse_error(&error);
                unreadable(&at, reason, "no lamp shines", report);
                return table;
            }
        };
        for (model, value) in models {
            let lights = if value.is_array() {
                Some(&value)
            } else {
                value.get("lights")
            };
            for (i, light) in lights
                .and_then(Value::as_array)
                .into_iter()
                .flatten()
                .enumerate()
            {
                match SuncgLight::deserialize(light) {
                    Ok(light) => table.lights.entry(model.clone()).or_default().push(light),
                    Err(error) => {
                        let at = at.field(format_args!("{model}[{i}]"));
                        report.warn(
                            at,
                            WarningKind::BadRow {
                                reason: crate::plain_parse_error(&error),
                            },
                        );
                    }
                }
            }
            let slots = value
                .pointer("/materials/emissive")
                .and_then(Value::as_array);
            let slots: Vec<usize> = slots
                .into_iter()
                .flatten()
                .filter_map(Value::as_u64)
                .map(|slot| slot as usize)
                .collect();
            if !slots.is_empty() {
                table.emissive.insert(model, slots);
            }
        }
        table
    }

    /// The lights of a model; none for most.
    pub fn get(&self, model: &str) -> &[SuncgLight] {
        let found = self
            .lights
            .get(model)
            .or_else(|| self.lights.get(base_model(model)));
        found.map_or(&[], Vec::as_slice)
    }

    /// The slots of a model that glow.
    pub fn emissive_slots(&self, model: &str) -> &[usize] {
        let found = self
            .emissive
            .get(model)
            .or_else(|| self.emissive.get(base_model(model)));
        found.map_or(&[], Vec::as_slice)
    }

    /// All lights, by model id.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &[SuncgLight])> {
        self.lights
            .iter()
            .map(|(id, lights)| (id.as_str(), lights.as_slice()))
    }

    /// Returns the number of models with lights.
    pub fn len(&self) -> usize {
        self.lights.len()
    }

    /// Returns whether no model has lights.
    pub fn is_empty(&self) -> bool {
        self.lights.is_empty()
    }

    /// Takes over the glowing slots of `other`.
    pub fn take_emissive(&mut self, other: Self) {
        self.emissive = other.emissive;
    }
}
