//! Hostile inputs, format by format: each ends in an error or an entry of the report that names file, place and field, within bounded
//! memory. `docs/hostile-input.md` says what is capped.
#![expect(clippy::unwrap_used, reason = "tests stop at the first surprise")]

#[path = "../it/common/mod.rs"]
mod common;
mod gltf;
mod kit;
#[cfg(unix)]
mod matrix;
mod native;
mod obj;
mod robots;
mod scenes;
mod suncg;

use std::alloc::System;
use std::path::Path;
use std::sync::Mutex;

use dwell_houses::suncg::read_binvox;
use dwell_houses::{HousesError, LoadReport, open_with};
use dwell_scene::parallel::Threads;
use kit::{Case, Ends};
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};

#[global_allocator]
static HEAP: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// One test at a time counts.
static ALONE: Mutex<()> = Mutex::new(());

/// The most that reading a hostile input may ask of the system, bytes, all that is given back in between counted as well: more than
/// was ever held at once. The images of one house may have 1 GiB.
const MOST_BYTES: u64 = 2 << 30;
/// The same of one that is refused at sight.
const MOST_PLAIN_BYTES: u64 = 192 << 20;

/// Words that no sentence for users holds.
const JARGON: [&str; 14] = [
    "Some(", "None,", "usize", "u8 ", "u16", "u32", "u64", "i32", "i64", "f32", "f64", "Vec3",
    "struct ", "islice",
];

/// Everything that was ever asked for, bytes.
fn asked() -> u64 {
    HEAP.stats().bytes_allocated as u64
}

/// Opens a HOUSE; also how many bytes that asked for.
fn opened(house: &Path) -> (Result<LoadReport, HousesError>, u64) {
    let before = asked();
    let opened = open_with(&house.to_string_lossy(), Threads::new(2));
    let taken = asked() - before;
    (opened.map(|(_, report)| report), taken)
}

fn check(cases: &[Case]) {
    let wrong = wrong(cases);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A sentence for each of the inputs that end otherwise than they should.
fn wrong<'a>(cases: impl IntoIterator<Item = &'a Case>) -> Vec<String> {
    let _alone = ALONE
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner);
    let mut wrong = Vec::new();
    for case in cases {
        let folder = tempfile::tempdir().unwrap();
        let house = (case.make)(folder.path());
        let (ended, taken) = opened(&house);
        let has = |text: &str, words: &[&str]| words.iter().all(|word| text.contains(word));
        let (good, told) = match (&case.ends, &ended) {
            (Ends::Fails(words), Err(error)) => {
                let told = error.to_string();
                (has(&told, words), told)
            }
            (Ends::Warns(words), Ok(report)) => {
                let mut warnings = report.warnings().iter();
                let found = warnings.any(|warning| has(&warning.to_string(), words));
                (found, report.to_string())
            }
            (Ends::Fails(_), Ok(report)) => (false, format!("it was opened: {report}")),
            (Ends::Warns(_), Err(error)) => (false, format!("it was refused: {error}")),
        };
        // Words that say something to programmers of Rust or Python alone.
        let spoken = |word: &&&str| {
            let mut found = told.match_indices(**word).map(|(at, _)| at);
            found.any(|at| !told[..at].ends_with(|c: char| c.is_alphanumeric()))
        };
        if let Some(word) = JARGON.iter().find(spoken) {
            wrong.push(format!("{}: it says {word:?}: {told:.600}", case.name));
        }
        if !good {
            wrong.push(format!(
                "{}: {}",
                case.name,
                told.chars().take(600).collect::<String>()
            ));
        }
        let most = if case.heavy {
            MOST_BYTES
        } else {
            MOST_PLAIN_BYTES
        };
        if taken > most {
            wrong.push(format!("{}: {taken} bytes were asked for", case.name));
        }
    }
    wrong
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn gltf_files() {
    check(gltf::CASES);
}

#[test]
fn obj_files() {
    check(obj::CASES);
}

#[test]
fn suncg_houses() {
    check(suncg::CASES);
}

#[test]
fn native_houses() {
    check(native::CASES);
}

#[test]
fn habitat_scenes() {
    check(scenes::HABITAT);
}

#[test]
fn procthor_houses() {
    check(scenes::PROCTHOR);
}

#[test]
fn measured_rooms() {
    check(scenes::MEASURED);
}

#[test]
fn urdf_robots() {
    check(robots::URDF_CASES);
}

#[test]
fn mjcf_files() {
    check(robots::MJCF_CASES);
}

/// The inputs that only the matrix of kinds and formats has.
#[cfg(unix)]
#[test]
fn every_kind_of_input_in_every_format() {
    let wrong: Vec<String> = matrix::columns()
        .into_iter()
        .flat_map(|column| {
            let told = wrong(matrix::inputs(column)).into_iter();
            told.map(|told| format!("{}: {told}", column.format))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Every file of a small house in every format, cut at 24 places: an error that names a file, or a house.
#[test]
fn files_that_are_cut() {
    let _alone = ALONE
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner);
    let mut refused = 0;
    for (sample, (house, files)) in common::samples::samples().iter().enumerate() {
        for (k, file) in files.iter().enumerate() {
            for cut in 0..24 {
                let before = asked();
                let ended = common::samples::open_changed(sample, k, |bytes| {
                    bytes.truncate(bytes.len() * cut / 24);
                });
                let taken = asked() - before;
                assert!(
                    taken < MOST_PLAIN_BYTES,
                    "{}: {taken} bytes",
                    file.display()
                );
                let Err(error) = ended else { continue };
                refused += 1;
                let told = error.to_string();
                let name = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
                let named = told.contains(&name(file)) || told.contains(&name(house));
                // What is recognized by its content is nobody's when cut.
                let nobody = matches!(error, HousesError::UnknownHouse { .. });
                assert!(named || nobody, "{}: {told}", file.display());
            }
        }
    }
    assert!(refused > 200, "{refused}");
}

#[test]
fn voxel_files() {
    let _alone = ALONE
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner);
    let head = |side: &str| format!("#binvox 1\ndim {side}\ntranslate 0 0 0\nscale 1\ndata\n");
    for (bytes, words) in [
        (
            head("4000000000 4000000000 4000000000").into_bytes(),
            "dim: voxels a side 4000000000",
        ),
        (head("0 1 1").into_bytes(), "dim: voxels a side 0"),
        (head("nan 1 1").into_bytes(), "a.binvox:2"),
        (
            head("1e39 1 1").into_bytes(),
            "dim: voxels a side 4294967295",
        ),
        (
            head("512 512 512").into_bytes(),
            "data: the runs end after 0 of 134217728 voxels",
        ),
        (
            [head("1 1 1").as_bytes(), &[7, 1]].concat(),
            "data: run 0 (7 for 1 voxels)",
        ),
        (vec![b'#'; 1 << 20], "a.binvox:1"),
        (Vec::new(), "a.binvox:1"),
    ] {
        let before = asked();
        let told = read_binvox(&bytes, "a.binvox").unwrap_err().to_string();
        assert!(told.contains(words) && told.contains("a.binvox"), "{told}");
        assert!(asked() - before < 1 << 20);
    }
}

#[test]
fn house_strings() {
    let _alone = ALONE
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner);
    let long = "x".repeat(100_000);
    for (house, words) in [
        ("builtin:", "no built-in house \"\""),
        (
            "builtin:builtin:apartment",
            "no built-in house \"builtin:apartment\"",
        ),
        ("builtin:../studio", "no built-in house \"../studio\""),
        ("seed:", "seed"),
        ("seed:-1", "seed"),
        ("seed:18446744073709551616", "seed"),
        ("seed:1?home=castle", "castle"),
        ("seed:1?storeys=1000000000", "storeys"),
        ("seed:1?nothing=1", "nothing"),
        ("seed:1?home=studio&home=house", "home: found it twice"),
        ("seed:seed:7", "seed: found seed:7"),
        ("\0", "is no house this version opens"),
        ("a\0.glb", "a\0.glb"),
        ("/dev/zero", "is a device, not a regular file"),
        (".", "is no house this version opens"),
        (long.as_str(), "is no house this version opens"),
        ("/.dwell", "/.dwell"),
    ] {
        let told = opened(Path::new(house))
            .0
            .map(|_| ())
            .unwrap_err()
            .to_string();
        assert!(
            told.contains(words),
            "{:?}: {told}",
            &house[..house.len().min(60)]
        );
    }
}

#[cfg(unix)]
#[test]
fn files_that_are_no_files_do_not_hang() {
    let _alone = ALONE
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner);
    for name in [
        "p.glb",
        "p.gltf",
        "p.obj",
        "p.urdf",
        "p.xml",
        "p.json",
        "p.scene_instance.json",
    ] {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join(name);
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        let told = opened(&pipe).0.map(|_| ()).unwrap_err().to_string();
        assert!(told.contains(name), "{told}");
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("a.dwell")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", folder.path().join("a.dwell/house.json")).unwrap();
    let told = opened(&folder.path().join("a.dwell"))
        .0
        .map(|_| ())
        .unwrap_err();
    assert!(told.to_string().contains("house.json"), "{told}");
}
