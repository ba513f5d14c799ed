//! HOUSE strings: the list of all formats, and the one function that opens them all.

use std::ops::Range;
use std::path::Path;
use std::sync::LazyLock;

use dwell_scene::House;
use dwell_scene::parallel::Threads;

use crate::authoring::{self, NameMapping};
use crate::error::HousesError;
use crate::formats::{FORMATS, Format, open_by};
use crate::opened::OpenResult;
use crate::report::LoadReport;

/// Number of formats that are tried before plans.
const BEFORE_PLANS: usize = 2;

/// All formats, in the order in which they are tried.
pub fn formats() -> &'static [Format] {
    static ALL: LazyLock<Vec<Format>> = LazyLock::new(|| {
        let mut all = FORMATS.to_vec();
        all.insert(BEFORE_PLANS, PLAN);
        all
    });
    &ALL
}

/// Plans, which may rest on a house of any other format.
const PLAN: Format = Format {
    name: "plan",
    example: "a path to a .plan.json",
    recognizes: |house| authoring::recognizes(Path::new(house)),
    open: |house, threads| authoring::open(Path::new(house), threads),
};

/// Opens the house that `house` names, on as many threads as the machine gives. `HOUSE?map=FILE` opens it with a map of its
/// foreign names ([`crate::authoring::NameMapping`]).
///
/// What begins with `builtin:` or `seed:` is never a path, so that it means the same in every folder: `./seed:1.obj` is the path.
/// A path that exists is itself, also where `?map=` is in its name.
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
        return Err(name_path(house)(HousesError::Spec {
            field: "seed".to_owned(),
            found: range.to_owned(),
            possible: format!("A..B with whole numbers A < B, up to {}", u64::MAX),
        }));
    };
    crate::generate::spec_of(fields.strip_prefix('?').unwrap_or(fields))
        .map_err(name_path(house))?;
    Ok(Some((from..to, fields)))
}

/// [`open`] on `threads` threads.
///
/// # Errors
/// Those of [`open`].
pub fn open_with(house: &str, threads: Threads) -> Result<(House, LoadReport), HousesError> {
    match house.rsplit_once("?map=").filter(|_| !is_path(house)) {
        None => open_by(formats(), house, threads).map_err(name_path(house)),
        Some((foreign, map)) => {
            let _span = tracing::debug_span!("open", house).entered();
            open_mapped(foreign, map, threads)
        }
    }
}

/// Returns whether a HOUSE string is a path that exists.
fn is_path(house: &str) -> bool {
    !house.starts_with("builtin:") && !house.starts_with("seed:") && Path::new(house).exists()
}

/// Adds, to the error of a HOUSE string that is never a path, how the path of that name is written, if there is one.
fn name_path(house: &str) -> impl Fn(HousesError) -> HousesError {
    move |mut error| {
        if is_path(house) || !Path::new(house).exists() {
            return error;
        }
        if let HousesError::Spec { possible: told, .. }
        | HousesError::UnknownBuiltin { hint: told, .. } = &mut error
        {
            told.push_str("; the path of this name is ./");
            told.push_str(house);
        }
        error
    }
}

/// Opens a house with a map of its foreign names: `HOUSE?map=FILE`.
fn open_mapped(house: &str, map: &str, threads: Threads) -> OpenResult {
    if house.contains("?map=") && !is_path(house) {
        return Err(HousesError::Spec {
            field: "map".to_owned(),
            found: "two maps".to_owned(),
            possible: "one".to_owned(),
        });
    }
    if map.is_empty() {
        return Err(HousesError::Spec {
            field: "map".to_owned(),
            found: "nothing".to_owned(),
            possible: "HOUSE?map=FILE with the name of a file".to_owned(),
        });
    }
    let mapping = NameMapping::read(Path::new(map))?;
    let (house, mut report) = open_with(house, threads)?;
    let house = mapping
        .apply(&house, &mut report)
        .map_err(|error| error.in_file(map))?;
    Ok((house, report))
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
        // An impossible value for every house is reported before any of them is made.
        let told = seed_range("seed:0..3?home=studio&storeys=99").unwrap_err();
        assert_eq!(told.to_string(), "storeys: found 99; possible: 1 to 3");
    }

    #[test]
    fn a_map_without_a_name_says_what_is_needed() {
        let told = open("builtin:studio?map=").unwrap_err().to_string();
        assert_eq!(
            told,
            "map: found nothing; possible: HOUSE?map=FILE with the name of a file"
        );
    }

    #[test]
    fn a_range_opened_as_one_house_says_where_ranges_are_taken() {
        let told = open("seed:0..3").unwrap_err().to_string();
        assert!(told.contains("0..3") && told.contains("several"), "{told}");
    }

    /// A triangle as an OBJ file.
    const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 1 0 1\nf 1 2 3\n";

    #[test]
    fn a_path_that_exists_is_itself_also_with_a_map_in_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
        for name in ["a.obj", "a?map=m.obj"] {
            std::fs::write(at(name), OBJ).unwrap();
        }
        std::fs::write(at("m.toml"), "[nodes]\n\"*\" = \"chair\"\n").unwrap();
        let map = at("m.toml");
        let category = |house: &str| {
            let (house, _) = open(house).unwrap();
            house.objects.iter().next().unwrap().category.coarse.clone()
        };
        assert_eq!(category(&at("a?map=m.obj")), "");
        for name in ["a.obj", "a?map=m.obj"] {
            assert_eq!(category(&format!("{}?map={map}", at(name))), "chair");
        }
        let two = open(&format!("{}?map=b?map={map}", at("a.obj"))).unwrap_err();
        assert_eq!(two.to_string(), "map: found two maps; possible: one");
    }

    #[test]
    fn what_is_never_a_path_says_how_the_path_of_its_name_is_written() {
        for begin in ["seed:", "seed:0..", "builtin:"] {
            let mut file = tempfile::Builder::new();
            let file = file.prefix(begin).suffix(".obj").tempfile_in(".").unwrap();
            std::fs::write(file.path(), OBJ).unwrap();
            let house = file.path().file_name().unwrap().to_str().unwrap();
            let hint = format!("; the path of this name is ./{house}");
            let told = open(house).unwrap_err().to_string();
            assert!(told.ends_with(&hint), "{told}");
            if let Err(error) = seed_range(house) {
                assert!(error.to_string().ends_with(&hint), "{error}");
            }
            assert_eq!(open(&format!("./{house}")).unwrap().0.objects.len(), 1);
        }
        let told = open("seed:none.obj").unwrap_err().to_string();
        assert!(!told.contains("path"), "{told}");
    }
}
