//! HOUSE strings: the list of formats, and the one function that opens them all.

use std::ops::Range;
use std::path::Path;
use std::time::Instant;

use dwell_scene::House;
use dwell_scene::parallel::Threads;

use crate::data_root::read_capped;
use crate::error::HousesError;
use crate::report::LoadReport;

/// A house and the damage that was survived on the way to it.
pub type Opened = Result<(House, LoadReport), HousesError>;

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
            open: |house, _| open_builtin(house.strip_prefix("builtin:").unwrap_or(house)),
        },
        Format {
            name: "seed",
            spelling: "seed:N or seed:N?field=value&field=value",
            recognizes: |house| house.starts_with("seed:"),
            open: |house, _| crate::generate::open(house),
        },
        Format {
            name: "plan",
            spelling: "a path to a .plan.json",
            recognizes: |house| crate::authoring::recognizes(Path::new(house)),
            open: |house, threads| crate::authoring::open(Path::new(house), threads),
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
            name: "measured",
            spelling: "a path to a measured room's .json",
            recognizes: |house| crate::measured::recognizes(Path::new(house)),
            open: |house, _| crate::measured::open(Path::new(house)),
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
    Ok((house, LoadReport::new()))
}

/// Opens the house that `house` names, on as many threads as the machine gives. `HOUSE?map=FILE` opens it with a map of its
/// foreign names ([`crate::authoring::NameMapping`]).
///
/// # Errors
/// [`HousesError::UnknownHouse`] lists what is allowed; otherwise what the format says.
///
/// # Determinism
/// The same files give the same house and report for any number of threads.
pub fn open(house: &str) -> Result<(House, LoadReport), HousesError> {
    open_with(house, Threads::default())
}

/// The seeds and the fields of a HOUSE string that stands for several houses: `seed:3..6?home=studio` is
/// `seed:3?home=studio`, `seed:4?home=studio` and `seed:5?home=studio`. Nothing for any other string, which is one house.
///
/// # Errors
/// [`HousesError::Spec`] for a range that is empty or none of whole numbers, and for fields that no house can have.
///
/// ```
/// let found = dwell_houses::seed_range("seed:3..5?home=studio")?;
/// assert_eq!(found, Some((3..5, "?home=studio")));
/// # Ok::<(), dwell_houses::HousesError>(())
/// ```
pub fn seed_range(house: &str) -> Result<Option<(Range<u64>, &str)>, HousesError> {
    let seeds = house.strip_prefix("seed:").unwrap_or_default();
    let (range, fields) = seeds.find('?').map_or((seeds, ""), |at| seeds.split_at(at));
    let Some((from, to)) = range.split_once("..") else {
        return Ok(None);
    };
    let ends = from.parse::<u64>().ok().zip(to.parse::<u64>().ok());
    let Some((from, to)) = ends.filter(|(from, to)| from < to) else {
        return Err(HousesError::Spec {
            field: "seed".to_owned(),
            found: range.to_owned(),
            possible: format!("A..B with whole numbers A < B, up to {}", u64::MAX),
        });
    };
    crate::generate::spec_of(fields.strip_prefix('?').unwrap_or(fields))?;
    Ok(Some((from..to, fields)))
}

/// [`open`] on `threads` threads.
///
/// # Errors
/// Those of [`open`].
pub fn open_with(house: &str, threads: Threads) -> Result<(House, LoadReport), HousesError> {
    let _span = tracing::debug_span!("open", house).entered();
    if let Some((foreign, map)) = house.rsplit_once("?map=") {
        return crate::authoring::open_mapped(foreign, map, threads);
    }
    let Some(format) = formats().iter().find(|format| (format.recognizes)(house)) else {
        refuse_irregular(Path::new(house))?;
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
    let start = Instant::now();
    let name = house;
    let (house, report) = (format.open)(house, threads)?;
    // The report is the caller's; here is only that there is one.
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
    // Opens nothing: what it is stands in the error.
    read_capped(path, "", 0).map(|_| ())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_of_seeds_is_its_houses_and_all_else_is_itself() {
        let one = |house: &str| seed_range(house).unwrap().is_none();
        assert!(one("seed:7") && one("seed:7?home=studio") && one("a..b/house.json"));
        let all = "seed:0..18446744073709551615";
        assert_eq!(seed_range("seed:0..3").unwrap(), Some((0..3, "")));
        assert_eq!(seed_range(all).unwrap(), Some((0..u64::MAX, "")));
        for wrong in [
            "seed:3..3",
            "seed:4..3",
            "seed:..3",
            "seed:a..b",
            "seed:0..18446744073709551616",
        ] {
            let told = seed_range(wrong).unwrap_err().to_string();
            assert!(told.starts_with("seed: found"), "{told}");
        }
        // What no house of it can have is told before any of them is made.
        let told = seed_range("seed:0..3?home=studio&storeys=99").unwrap_err();
        assert_eq!(told.to_string(), "storeys: found 99; possible: 1 to 3");
    }

    #[test]
    fn a_range_opened_as_one_house_says_where_ranges_are_taken() {
        let told = open("seed:0..3").unwrap_err().to_string();
        assert!(told.contains("0..3") && told.contains("several"), "{told}");
    }
}
