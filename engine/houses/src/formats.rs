//! The list of formats that rest on no other, and the function that opens a house by a list.

use std::path::Path;
use std::time::Instant;

use dwell_scene::parallel::Threads;

use crate::data_root::read_up_to;
use crate::error::HousesError;
use crate::opened::OpenResult;
use crate::report::LoadReport;

/// A format of houses.
#[derive(Clone, Copy)]
pub struct Format {
    /// The format's name.
    pub name: &'static str,
    /// The form of a HOUSE string of this format.
    pub example: &'static str,
    /// Returns whether a HOUSE string means this format.
    pub recognizes: fn(&str) -> bool,
    /// Opens it.
    pub open: fn(&str, Threads) -> OpenResult,
}

/// All formats but plans, which rest on these, in the order in which they are tried. A new one is one folder and one entry here.
pub(crate) const FORMATS: &[Format] = &[
    Format {
        name: "builtin",
        example: "builtin:NAME",
        recognizes: |house| house.starts_with("builtin:"),
        open: |house, _| open_builtin(house.strip_prefix("builtin:").unwrap_or(house)),
    },
    Format {
        name: "seed",
        example: "seed:N or seed:N?field=value&field=value",
        recognizes: |house| house.starts_with("seed:"),
        open: |house, _| crate::generate::open(house),
    },
    Format {
        name: "native",
        example: "a path to a .dwell",
        recognizes: |house| crate::native::recognizes(Path::new(house)),
        open: |house, threads| crate::native::open(Path::new(house), threads),
    },
    Format {
        name: "habitat",
        example: "a path to a .scene_instance.json of Habitat",
        recognizes: |house| crate::habitat::recognizes(Path::new(house)),
        open: |house, threads| crate::habitat::open(Path::new(house), threads),
    },
    Format {
        name: "procthor",
        example: "a path to a house's .json of ProcTHOR",
        recognizes: |house| crate::procthor::recognizes(Path::new(house)),
        open: |house, _| crate::procthor::open(Path::new(house)),
    },
    Format {
        name: "measured",
        example: "a path to a measured room's .json",
        recognizes: |house| crate::measured::recognizes(Path::new(house)),
        open: |house, _| crate::measured::open(Path::new(house)),
    },
    Format {
        name: "suncg",
        example: "a path to a house.json, its folder, or a data root with one house",
        recognizes: |house| crate::suncg::recognizes(Path::new(house)),
        open: |house, threads| crate::suncg::open(Path::new(house), threads),
    },
    Format {
        name: "gltf",
        example: "a path to a .glb or .gltf",
        recognizes: |house| crate::gltf::recognizes(Path::new(house)),
        open: |house, threads| crate::gltf::open(Path::new(house), threads),
    },
    Format {
        name: "obj",
        example: "a path to an .obj",
        recognizes: |house| crate::obj::recognizes(Path::new(house)),
        open: |house, threads| crate::obj::open(Path::new(house), threads),
    },
    Format {
        name: "urdf",
        example: "a path to a .urdf",
        recognizes: |house| crate::urdf::recognizes(Path::new(house)),
        open: |house, _| crate::urdf::open(Path::new(house)),
    },
    Format {
        name: "mjcf",
        example: "a path to a .xml of MuJoCo",
        recognizes: |house| crate::mjcf::recognizes(Path::new(house)),
        open: |house, _| crate::mjcf::open(Path::new(house)),
    },
];

fn open_builtin(name: &str) -> OpenResult {
    let known = || {
        crate::builtin::names()
            .iter()
            .map(|name| (*name).to_owned())
            .collect()
    };
    let house = crate::builtin::build(name).ok_or_else(|| HousesError::UnknownBuiltin {
        name: name.to_owned(),
        known: known(),
        hint: String::new(),
    })?;
    Ok((house, LoadReport::new()))
}

/// Opens `house` by the first of `formats` that recognizes it.
///
/// # Errors
/// [`HousesError::UnknownHouse`] lists what is allowed; otherwise what the format says.
pub(crate) fn open_by(formats: &[Format], house: &str, threads: Threads) -> OpenResult {
    let _span = tracing::debug_span!("open", house).entered();
    let Some(format) = formats.iter().find(|format| (format.recognizes)(house)) else {
        refuse_irregular(Path::new(house))?;
        let allowed = formats
            .iter()
            .map(|format| format.example)
            .collect::<Vec<_>>()
            .join("; ");
        return Err(HousesError::UnknownHouse {
            house: house.to_owned(),
            allowed,
        });
    };
    let start = Instant::now();
    let name = house;
    let (house, report) = (format.open)(house, threads)?;
    // The report is the caller's; here only its existence is logged.
    if let Some(first) = report.warnings().first() {
        tracing::info!(house = name, warnings = report.len(), %first, "house opened with damage");
    }
    tracing::debug!(
        house = name,
        took_ms = start.elapsed().as_millis() as u64,
        format = format.name,
        rooms = house.rooms.len(),
        objects = house.objects.len(),
        triangles = house.triangle_count(),
        warnings = report.len(),
        "house opened"
    );
    Ok((house, report))
}

/// Refuses named pipes, sockets and devices, which are no house whatever their names end with.
fn refuse_irregular(path: &Path) -> Result<(), HousesError> {
    let is_known = |meta: std::fs::Metadata| meta.is_file() || meta.is_dir();
    if std::fs::metadata(path).map_or(true, is_known) {
        return Ok(());
    }
    // Opens nothing: the error says what it is.
    read_up_to(path, "", 0).map(|_| ())
}
