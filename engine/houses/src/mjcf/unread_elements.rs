//! Elements among bodies that are not read, and invalid rotations: they are reported, so that nothing vanishes silently.

use roxmltree::Node;

use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// Elements that hold bodies.
const HOLDERS: [&str; 3] = ["worldbody", "body", "frame"];
/// Elements that `mjcf-rs` reads in them, and those that the format's page lists as ignored: cameras, lights and sites.
const KNOWN: [&str; 11] = [
    "attach",
    "body",
    "camera",
    "frame",
    "freejoint",
    "geom",
    "include",
    "inertial",
    "joint",
    "light",
    "site",
];
/// Elements that make bodies, wherever an included file holds them.
const MAKERS: [&str; 3] = ["composite", "flexcomp", "replicate"];
/// Characters of an element's name that a report shows.
const SHOWN: usize = 60;

/// Reports the losses of an element; `at` gives its line.
pub(super) fn report_unread_elements(
    node: Node<'_, '_>,
    at: impl Fn() -> FileLocation,
    report: &mut LoadReport,
) {
    let tag = node.tag_name().name();
    let holder = node.parent_element().map(|parent| parent.tag_name().name());
    let is_lost = holder.is_some_and(|holder| {
        let known = KNOWN.contains(&tag) && !(holder == "frame" && tag == "attach");
        (HOLDERS.contains(&holder) && !known)
            || (holder == "mujocoinclude" && MAKERS.contains(&tag))
    });
    if is_lost {
        let all = node.descendants().skip(1);
        let bodies = all.filter(|inner| inner.has_tag_name("body")).count();
        let shown: String = tag.chars().take(SHOWN).collect();
        let what = format!("<{shown}> is not read; with it {bodies} bodies are left out");
        report.warn(at(), WarningKind::Simplified { what });
    }
    if node.attribute("quat").is_some_and(is_zero) {
        // MuJoCo reads it so, too (mju_normalize4).
        let what = format!("<{tag} quat> of length 0 is no rotation; it is not turned");
        report.warn(at(), WarningKind::Simplified { what });
    }
}

fn is_zero(quat: &str) -> bool {
    let mut words = quat.split_ascii_whitespace().map(str::parse::<f64>);
    words.clone().count() == 4 && words.all(|number| number == Ok(0.0))
}
