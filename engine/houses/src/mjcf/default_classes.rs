//! Classes of defaults that a model names and does not define, or defines twice: the parser ignores them, MuJoCo refuses them.

use std::collections::BTreeSet;

use roxmltree::Node;

use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// The class at the top of all defaults.
const TOP: &str = "main";
/// Characters of a class's name that a report shows.
const SHOWN: usize = 60;

/// The classes of one model, with all files that it includes.
#[derive(Debug, Default)]
pub(super) struct DefaultClasses {
    defined: BTreeSet<String>,
    named: Vec<(FileLocation, String)>,
}

impl DefaultClasses {
    /// Records the classes that `node` defines or names; `at` gives its line.
    pub(super) fn record(
        &mut self,
        node: Node<'_, '_>,
        at: impl Fn() -> FileLocation,
        report: &mut LoadReport,
    ) {
        let tag = node.tag_name().name();
        let at = |field: &str| at().field(format_args!("{tag}.{field}"));
        for field in ["class", "childclass"] {
            let Some(name) = node.attribute(field) else {
                continue;
            };
            if tag != "default" {
                self.named.push((at(field), name.to_owned()));
            } else if !self.defined.insert(name.to_owned()) {
                let name = shortened(name);
                let what = format!("the class {name:?} is defined twice; MuJoCo refuses that");
                report.warn(at(field), WarningKind::Simplified { what });
            }
        }
    }

    /// Reports the names without a definition.
    pub(super) fn report_undefined(self, report: &mut LoadReport) {
        for (at, name) in self.named {
            if name != TOP && !self.defined.contains(&name) {
                let name = shortened(&name);
                let what = format!("the class {name:?} is not defined; nothing is taken from it");
                report.warn(at, WarningKind::Simplified { what });
            }
        }
    }
}

fn shortened(name: &str) -> String {
    name.chars().take(SHOWN).collect()
}
