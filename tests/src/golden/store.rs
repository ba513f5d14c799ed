//! Golden pictures as files: PNG for images, JSON for lists.

use super::compare::{Difference, compare};
use dwell::sensors::{Observation, ObservationData};
use image::{ImageBuffer, Luma, Rgb};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

type Gray16 = ImageBuffer<Luma<u16>, Vec<u16>>;
type Color16 = ImageBuffer<Rgb<u16>, Vec<u16>>;
type Color8 = ImageBuffer<Rgb<u8>, Vec<u8>>;

/// The content of an observation's file.
#[derive(Clone, Debug, PartialEq)]
pub enum StoredObservation {
    /// sRGB bytes. Shape (height, width, 3).
    Color {
        /// Pixels across.
        width: usize,
        /// Rows from the top.
        rgb: Vec<u8>,
    },
    /// Ids. Shape (height, width).
    Ids {
        /// Pixels across.
        width: usize,
        /// Rows from the top.
        ids: Vec<u16>,
    },
    /// Numbers as steps of their range. Shape (panel, height, width, 3), panels below one another; what a panel has less than
    /// three of is 0.
    Steps {
        /// Pixels across.
        width: usize,
        /// Length of a step in each panel.
        step: Vec<f64>,
        /// Rows from the top.
        steps: Vec<u16>,
    },
    /// Rows of a list.
    List(Vec<Vec<f64>>),
}

/// The lowest and highest number of each panel of an image, three numbers a panel, in the sensor's unit. The golden views stay
/// within them.
fn ranges(sensor: &str) -> Option<&'static [(f64, f64)]> {
    const UNIT: (f64, f64) = (0.0, 1.0);
    const DIRECTION: (f64, f64) = (-1.0, 1.0);
    const PLACE_M: (f64, f64) = (-super::views::FAR_M, super::views::FAR_M);
    Some(match sensor {
        "depth" => &[(0.0, super::views::FAR_M)],
        "normals" => &[DIRECTION],
        "albedo" => &[UNIT],
        "surfels" => &[PLACE_M, DIRECTION, UNIT],
        "flow" => &[(-32.0, 32.0)],
        _ => return None,
    })
}

impl StoredObservation {
    /// Returns what a file can hold of an observation.
    ///
    /// # Errors
    /// A sentence, for numbers without a range and for ids beyond 16 bits.
    pub fn of(observation: &Observation) -> Result<Self, String> {
        let Observation { spec, data } = observation;
        let name = &spec.name;
        let [height, width, parts] = match spec.shape[..] {
            [height, width, parts] => [height, width, parts],
            [_, parts] => return Ok(Self::List(rows(data, parts))),
            _ => return Err(format!("{name}: neither an image nor a list")),
        };
        match data {
            ObservationData::Uint8(rgb) => Ok(Self::Color {
                width,
                rgb: rgb.clone(),
            }),
            ObservationData::Int32(ids) => {
                let ids = ids.iter().map(|id| u16::try_from(*id));
                let ids = ids.collect::<Result<_, _>>();
                let ids = ids.map_err(|_| format!("{name}: ids beyond 16 bits"))?;
                Ok(Self::Ids { width, ids })
            }
            ObservationData::Float32(numbers) => {
                let ranges = ranges(name)
                    .ok_or_else(|| format!("{name}: say its range in tests/src/golden/store.rs"))?;
                let mut steps = vec![0; ranges.len() * height * width * 3];
                for (k, number) in numbers.iter().enumerate() {
                    let (pixel, part) = (k / parts, k % parts);
                    let (low, high) = ranges[part / 3];
                    let place = (f64::from(*number) - low) / (high - low);
                    if !(-1e-4..=1.0001).contains(&place) {
                        return Err(format!("{name}: {number} lies outside {low} to {high}"));
                    }
                    steps[(part / 3 * height * width + pixel) * 3 + part % 3] =
                        (place.clamp(0.0, 1.0) * 65_535.0).round() as u16;
                }
                let step = ranges.iter().map(|(low, high)| (high - low) / 65_535.0);
                Ok(Self::Steps {
                    width,
                    step: step.collect(),
                    steps,
                })
            }
        }
    }

    fn extension(&self) -> &'static str {
        if matches!(self, Self::List(_)) {
            "json"
        } else {
            "png"
        }
    }

    /// # Errors
    /// A sentence.
    fn write(&self, path: &Path) -> Result<(), String> {
        let fault = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let size = |width: usize, pixels: usize| (width as u32, (pixels / width) as u32);
        let lost = || fault(&"the picture has no whole rows");
        match self {
            Self::Color { width, rgb } => {
                let (across, down) = size(*width, rgb.len() / 3);
                let image = Color8::from_raw(across, down, rgb.clone()).ok_or_else(lost)?;
                image.save(path).map_err(|error| fault(&error))
            }
            Self::Ids { width, ids } => {
                let (across, down) = size(*width, ids.len());
                let image = Gray16::from_raw(across, down, ids.clone()).ok_or_else(lost)?;
                image.save(path).map_err(|error| fault(&error))
            }
            Self::Steps { width, steps, .. } => {
                let (across, down) = size(*width, steps.len() / 3);
                let image = Color16::from_raw(across, down, steps.clone()).ok_or_else(lost)?;
                image.save(path).map_err(|error| fault(&error))
            }
            Self::List(rows) => {
                let lines: Vec<String> = rows.iter().map(|row| json!(row).to_string()).collect();
                let text = format!("[\n{}\n]\n", lines.join(",\n"));
                std::fs::write(path, text).map_err(|error| fault(&error))
            }
        }
    }

    /// Returns what a file holds, in the form of `self`.
    fn read(&self, path: &Path) -> Result<Self, String> {
        let fault = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        if let Self::List(_) = self {
            let text = std::fs::read_to_string(path).map_err(|error| fault(&error))?;
            let rows: Value = serde_json::from_str(&text).map_err(|error| fault(&error))?;
            let numbers = |row: &Value| {
                let cells = row.as_array().into_iter().flatten();
                cells
                    .map(|cell| cell.as_f64().unwrap_or(f64::NAN))
                    .collect()
            };
            return Ok(Self::List(
                rows.as_array().into_iter().flatten().map(numbers).collect(),
            ));
        }
        let image = image::open(path).map_err(|error| fault(&error))?;
        let width = image.width() as usize;
        Ok(match self {
            Self::Ids { .. } => Self::Ids {
                width,
                ids: image.into_luma16().into_raw(),
            },
            Self::Steps { step, .. } => Self::Steps {
                width,
                step: step.clone(),
                steps: image.into_rgb16().into_raw(),
            },
            _ => Self::Color {
                width,
                rgb: image.into_rgb8().into_raw(),
            },
        })
    }
}

fn rows(data: &ObservationData, parts: usize) -> Vec<Vec<f64>> {
    let numbers: Vec<f64> = match data {
        ObservationData::Uint8(data) => data.iter().map(|x| f64::from(*x)).collect(),
        ObservationData::Int32(data) => data.iter().map(|x| f64::from(*x)).collect(),
        ObservationData::Float32(data) => data.iter().map(|x| f64::from(*x)).collect(),
    };
    // Zeros fill the end.
    let rows = numbers.chunks(parts.max(1)).map(<[f64]>::to_vec);
    rows.take_while(|row| row[0] != 0.0).collect()
}

/// The golden pictures of a run.
#[derive(Debug)]
pub struct Golden {
    /// The folder of the golden files.
    folder: PathBuf,
    /// The folder of pictures that differ.
    found: PathBuf,
    /// True to write them anew.
    update: bool,
    names: Vec<String>,
    faults: Vec<String>,
}

impl Golden {
    /// Those of `folder`; what differs is shown in `found`. They are written anew where `UPDATE_GOLDEN` is set.
    pub fn new(folder: &Path, found: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            found: found.to_owned(),
            update: std::env::var_os("UPDATE_GOLDEN").is_some(),
            names: Vec::new(),
            faults: Vec::new(),
        }
    }

    /// Compares an observation with the golden one of that name, or takes its place.
    pub fn check(&mut self, name: &str, observation: &Observation) {
        let checked =
            StoredObservation::of(observation).and_then(|kept| self.check_kept(name, &kept));
        if let Err(fault) = checked {
            self.faults.push(format!("{name}: {fault}"));
        }
    }

    /// The same for a picture. `rgb`: shape (height, `width`, 3).
    pub fn check_color(&mut self, name: &str, width: u32, rgb: Vec<u8>) {
        let width = width as usize;
        let checked = self.check_kept(name, &StoredObservation::Color { width, rgb });
        if let Err(fault) = checked {
            self.faults.push(format!("{name}: {fault}"));
        }
    }

    /// Returns how far something is from the golden picture of that name.
    ///
    /// # Errors
    /// A sentence, where there is none or where it has another size.
    pub fn difference(&self, name: &str, kept: &StoredObservation) -> Result<Difference, String> {
        let path = self.folder.join(format!("{name}.{}", kept.extension()));
        if !path.exists() {
            return Err(format!(
                "there is no {}; look at the picture, then write it with UPDATE_GOLDEN=1 cargo test --workspace --test it goldens",
                path.display()
            ));
        }
        compare(&kept.read(&path)?, kept)
    }

    fn check_kept(&mut self, name: &str, kept: &StoredObservation) -> Result<(), String> {
        let file = format!("{name}.{}", kept.extension());
        self.names.push(file.clone());
        if self.update {
            std::fs::create_dir_all(&self.folder).map_err(|error| error.to_string())?;
            return kept.write(&self.folder.join(file));
        }
        let difference = self.difference(name, kept)?;
        difference.judge().map_err(|sentence| {
            let shown = std::fs::create_dir_all(&self.found)
                .map_err(|error| error.to_string())
                .and_then(|()| kept.write(&self.found.join(&file)))
                .and_then(|()| {
                    let map = difference.picture();
                    map.write(&self.found.join(format!("{name}.difference.png")))
                });
            match shown {
                Ok(()) => format!("{sentence}; see {}", self.found.join(file).display()),
                Err(error) => format!("{sentence}; it cannot be shown: {error}"),
            }
        })
    }

    /// All that is wrong, a sentence each; a file that no picture has asked for is wrong, too.
    pub fn finish(mut self) -> Vec<String> {
        let files = std::fs::read_dir(&self.folder)
            .into_iter()
            .flatten()
            .flatten();
        let mut files: Vec<String> = files
            .map(|entry| entry.file_name().to_string_lossy().into_owned())
            .filter(|file| !self.names.contains(file) && file != "README.md")
            .collect();
        files.sort();
        for file in files {
            let fault = format!("{file}: no test looks at it; remove it");
            self.faults.push(fault);
        }
        self.faults
    }
}
