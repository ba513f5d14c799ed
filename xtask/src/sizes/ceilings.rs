//! Figures that may only rise on purpose: `xtask/ceilings.toml`.

use crate::findings::CheckOutcome;
use std::collections::BTreeMap;
use std::path::Path;

const FILE: &str = "xtask/ceilings.toml";

pub(crate) struct SizeLimits(BTreeMap<String, f64>);

pub(crate) fn read(root: &Path) -> Result<SizeLimits, String> {
    let text =
        std::fs::read_to_string(root.join(FILE)).map_err(|error| format!("{FILE}: {error}"))?;
    toml::from_str(&text)
        .map(SizeLimits)
        .map_err(|error| format!("{FILE}: {error}"))
}

impl SizeLimits {
    /// A figure beside its ceiling; `None` is a figure that was not taken in this checkout.
    pub(crate) fn compare(&self, key: &str, what: &str, value: Option<f64>) -> CheckOutcome {
        let mut outcome = CheckOutcome::default();
        match (self.0.get(key), value) {
            (None, _) => outcome
                .findings
                .push(format!("{FILE}: has no {key} ({what})")),
            (Some(ceiling), None) => outcome
                .notes
                .push(format!("{what}: not measured here (ceiling {ceiling})")),
            (Some(ceiling), Some(value)) if value > *ceiling => {
                outcome.findings.push(format!(
                    "{what}: {value:.1}, above the ceiling {key} = {ceiling} of {FILE}"
                ));
            }
            (Some(ceiling), Some(value)) => outcome
                .notes
                .push(format!("{what}: {value:.1} (ceiling {ceiling})")),
        }
        outcome
    }
}

/// The largest wheel that `make wheel` left, in 10^6 bytes.
pub(crate) fn wheel_mb(root: &Path) -> Option<f64> {
    let files = std::fs::read_dir(root.join("dist")).ok()?;
    let wheels = files.flatten().filter(|file| {
        file.path()
            .extension()
            .is_some_and(|ending| ending == "whl")
    });
    let largest = wheels
        .filter_map(|file| file.metadata().ok())
        .map(|data| data.len())
        .max()?;
    u32::try_from(largest)
        .ok()
        .map(|bytes| f64::from(bytes) / 1e6)
}

/// Returns what `make build` noted when it began with an empty target folder.
pub(crate) fn cold_build_minutes(root: &Path) -> Option<f64> {
    let folder =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), Into::into);
    let seconds = std::fs::read_to_string(folder.join("cold-build-seconds")).ok()?;
    seconds
        .trim()
        .parse::<f64>()
        .ok()
        .map(|seconds| seconds / 60.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ceilings() -> SizeLimits {
        SizeLimits([("crates".to_owned(), 10.0)].into())
    }

    #[test]
    fn up_to_the_ceiling_passes_and_above_fails() {
        assert!(ceilings().compare("crates", "crates", Some(10.0)).passed());
        assert!(!ceilings().compare("crates", "crates", Some(11.0)).passed());
    }

    #[test]
    fn what_was_not_measured_is_said() {
        let outcome = ceilings().compare("crates", "crates", None);
        assert_eq!(outcome.notes, ["crates: not measured here (ceiling 10)"]);
    }

    #[test]
    fn a_figure_without_a_ceiling_fails() {
        assert!(!ceilings().compare("wheel_mb", "wheel", None).passed());
    }
}
