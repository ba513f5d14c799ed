//! The real sample house, where it is there, and generated ones.
#![allow(dead_code, reason = "each test file uses what it needs")]
#![allow(clippy::print_stdout, reason = "a skipped test says so")]
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

pub(crate) mod generate;
pub(crate) mod habitat_set;
pub(crate) mod procthor_set;
pub(crate) mod samples;

use std::path::PathBuf;
use std::sync::OnceLock;

use dwell_houses::LoadReport;
use dwell_houses::suncg::{ParsedSuncgFiles, convert, locate};
use dwell_scene::House;
use dwell_scene::parallel::Threads;

/// The one house of the sample data.
pub(crate) const SCENE_ID: &str = "0004d52d1aeeb8ae6de39d6bd993e992";

/// The real house: files, what became of them, and what was reported.
pub(crate) struct Real {
    pub(crate) root: PathBuf,
    pub(crate) files: ParsedSuncgFiles,
    pub(crate) house: House,
    pub(crate) report: LoadReport,
}

/// The folder of the shared sample data, if this machine has it.
pub(crate) fn data_root() -> Option<PathBuf> {
    let shared = std::env::var_os("DWELL_SHARED_DATA").map(PathBuf::from);
    let beside = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let root = shared.unwrap_or(beside).join("suncg");
    root.join("house").is_dir().then_some(root)
}

/// The real house, loaded once a test program; `None`, with a line, where it is absent.
pub(crate) fn real() -> Option<&'static Real> {
    static REAL: OnceLock<Option<Real>> = OnceLock::new();
    let real = REAL.get_or_init(|| {
        let root = data_root()?;
        let (data, path) = locate(&root.join("house").join(SCENE_ID).join("house.json")).unwrap();
        let mut report = LoadReport::new();
        let files = ParsedSuncgFiles::read(&data, &path, Threads::new(2), &mut report).unwrap();
        let house = convert(&files, Threads::new(2), &mut report).unwrap();
        Some(Real {
            root,
            files,
            house,
            report,
        })
    });
    if real.is_none() {
        println!("skipped: no sample house in ../shared/data/suncg or $DWELL_SHARED_DATA");
    }
    real.as_ref()
}

/// Bytes as base64 (RFC 4648).
pub(crate) fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for chunk in bytes.chunks(3) {
        let word = chunk
            .iter()
            .fold(0_u32, |word, byte| word << 8 | u32::from(*byte))
            << (8 * (3 - chunk.len()));
        for k in 0..4 {
            text.push(if k <= chunk.len() {
                char::from(DIGITS[(word >> (18 - 6 * k)) as usize & 63])
            } else {
                '='
            });
        }
    }
    text
}
