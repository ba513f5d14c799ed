//! Findings of a check.

use std::fmt::Write;

/// Notes, and findings that must be fixed.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct CheckOutcome {
    /// Printed, never a failure.
    pub notes: Vec<String>,
    /// Each says where, what was found, what is allowed. One is enough to fail.
    pub findings: Vec<String>,
}

impl CheckOutcome {
    pub(crate) fn passed(&self) -> bool {
        self.findings.is_empty()
    }

    pub(crate) fn merge(&mut self, other: Self) {
        self.notes.extend(other.notes);
        self.findings.extend(other.findings);
    }

    /// The lines a person reads, the verdict last.
    pub(crate) fn report(&self, name: &str) -> String {
        let mut text = String::new();
        for note in &self.notes {
            let _ = writeln!(text, "  {note}");
        }
        for finding in &self.findings {
            let _ = writeln!(text, "  MEND {finding}");
        }
        let verdict = match self.findings.len() {
            0 => "ok".to_owned(),
            count => format!("{count} to mend"),
        };
        let _ = writeln!(text, "{name}: {verdict}");
        text
    }
}
