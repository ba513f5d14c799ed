//! HOUSE strings: the list of formats, and the one function that opens them all.

use std::path::Path;

use dwell_scene::House;
use dwell_scene::parallel::Threads;

use crate::error::HousesError;
use crate::report::Report;

/// A house and the damage that was survived on the way to it.
pub type Opened = Result<(House, Report), HousesError>;

/// A way to get a house.
pub struct Format {
    /// The format's name.
    pub name: &'static str,
    /// What a HOUSE string of this format looks like.
    pub spelling: &'static str,
    /// Whether a HOUSE string means this format.
    pub recognizes: fn(&str) -> bool,
    /// Opens it.
    pub open: fn(&str, Threads) -> Opened,
}

/// All formats, in the order in which they are tried. A new one is one folder and one entry here.
pub fn formats() -> &'static [Format] {
    &[
        Format {
            name: "builtin",
            spelling: "builtin:NAME",
            recognizes: |house| house.starts_with("builtin:"),
            open: |house, _| open_builtin(house.trim_start_matches("builtin:")),
        },
        Format {
            name: "seed",
            spelling: "seed:N or seed:N?field=value&field=value",
            recognizes: |house| house.starts_with("seed:"),
            open: |house, _| crate::generate::open(house),
        },
        Format {
            name: "native",
            spelling: "a path to a .dwell",
            recognizes: |house| crate::native::recognizes(Path::new(house)),
            open: |house, threads| crate::native::open(Path::new(house), threads),
        },
        Format {
            name: "habitat",
            spelling: "a path to a .scene_instance.json of Habitat",
            recognizes: |house| crate::habitat::recognizes(Path::new(house)),
            open: |house, threads| crate::habitat::open(Path::new(house), threads),
        },
        Format {
            name: "procthor",
            spelling: "a path to a house's .json of ProcTHOR",
            recognizes: |house| crate::procthor::recognizes(Path::new(house)),
            open: |house, _| crate::procthor::open(Path::new(house)),
        },
        Format {
            name: "suncg",
            spelling: "a path to a house.json, its folder, or a data root with one house",
            recognizes: |house| crate::suncg::recognizes(Path::new(house)),
            open: |house, threads| crate::suncg::open(Path::new(house), threads),
        },
        Format {
            name: "gltf",
            spelling: "a path to a .glb or .gltf",
            recognizes: |house| crate::gltf::recognizes(Path::new(house)),
            open: |house, threads| crate::gltf::open(Path::new(house), threads),
        },
        Format {
            name: "obj",
            spelling: "a path to an .obj",
            recognizes: |house| crate::obj::recognizes(Path::new(house)),
            open: |house, threads| crate::obj::open(Path::new(house), threads),
        },
        Format {
            name: "urdf",
            spelling: "a path to a .urdf",
            recognizes: |house| crate::urdf::recognizes(Path::new(house)),
            open: |house, _| crate::urdf::open(Path::new(house)),
        },
        Format {
            name: "mjcf",
            spelling: "a path to a .xml of MuJoCo",
            recognizes: |house| crate::mjcf::recognizes(Path::new(house)),
            open: |house, _| crate::mjcf::open(Path::new(house)),
        },
    ]
}

fn open_builtin(name: &str) -> Opened {
    let known = || {
        crate::builtin::names()
            .iter()
            .map(|name| (*name).to_owned())
            .collect()
    };
    let house = crate::builtin::build(name).ok_or_else(|| HousesError::UnknownBuiltin {
        name: name.to_owned(),
        known: known(),
    })?;
    Ok((house, Report::new()))
}

/// Opens the house that `house` names, on as many threads as the machine gives.
///
/// # Errors
/// [`HousesError::UnknownHouse`] lists what is allowed; otherwise what the format says.
///
/// # Determinism
/// The same files give the same house and report for any number of threads.
pub fn open(house: &str) -> Result<(House, Report), HousesError> {
    open_with(house, Threads::default())
}

/// [`open`] on `threads` threads.
///
/// # Errors
/// Those of [`open`].
pub fn open_with(house: &str, threads: Threads) -> Result<(House, Report), HousesError> {
    let _span = tracing::debug_span!("open", house).entered();
    let Some(format) = formats().iter().find(|format| (format.recognizes)(house)) else {
        let allowed = formats()
            .iter()
            .map(|format| format.spelling)
            .collect::<Vec<_>>()
            .join("; ");
        return Err(HousesError::UnknownHouse {
            house: house.to_owned(),
            allowed,
        });
    };
    let (house, report) = (format.open)(house, threads)?;
    tracing::debug!(
        format = format.name,
        rooms = house.rooms.len(),
        objects = house.objects.len(),
        triangles = house.triangle_count(),
        warnings = report.len(),
        "house opened"
    );
    Ok((house, report))
}
