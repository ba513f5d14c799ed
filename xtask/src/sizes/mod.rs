//! Sizes that grow unless someone looks: source files, the number of crates, the wheel; and how long the cold build took.

mod ceilings;
mod files;

use crate::findings::CheckOutcome;
use crate::tree;
use std::path::Path;

pub(crate) fn run(root: &Path) -> Result<CheckOutcome, String> {
    let mut outcome = files::check(root)?;
    let ceilings = ceilings::read(root)?;
    let build = tree::workspace(root)?;
    let wheel = tree::tree(root, &["--package", "dwell-python", "--edges", "normal"])?;
    let measured = [
        (
            "crates_in_build",
            "crates in the build of tests and extension",
            as_f64(build.packages.len()),
        ),
        (
            "crates_in_wheel",
            "crates in the extension",
            as_f64(wheel.packages.len()),
        ),
        ("wheel_mb", "wheel in dist/, MB", ceilings::wheel_mb(root)),
    ];
    for (key, what, value) in measured {
        outcome.merge(ceilings.compare(key, what, value));
    }
    // A time says as much of the machine as of the code: it is shown, and nothing fails by it.
    if let Some(minutes) = ceilings::cold_build_minutes(root) {
        outcome.notes.push(format!(
            "last build from an empty target: {minutes:.1} minutes"
        ));
    }
    Ok(outcome)
}

fn as_f64(count: usize) -> Option<f64> {
    u32::try_from(count).ok().map(f64::from)
}
