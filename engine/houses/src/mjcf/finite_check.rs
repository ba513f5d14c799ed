//! Numbers of MJCF: finite, and with spaces between them, wherever they stand.
//!
//! `mjcf-rs` reads `nan` and `inf` as any other number, and their effect on the root spreads to every pose below.

use roxmltree::Node;

use crate::error::HousesError;
use crate::report::FileLocation;

/// Attributes with numbers that must all be finite.
const FINITE: [&str; 34] = [
    "pos",
    "quat",
    "axisangle",
    "xyaxes",
    "zaxis",
    "euler",
    "size",
    "fromto",
    "rgba",
    "rgb1",
    "rgb2",
    "scale",
    "refpos",
    "refquat",
    "axis",
    "mass",
    "density",
    "diaginertia",
    "fullinertia",
    "friction",
    "frictionloss",
    "damping",
    "stiffness",
    "armature",
    "ref",
    "springref",
    "polycoef",
    "gear",
    "kp",
    "kv",
    "gravity",
    "timestep",
    "boundmass",
    "boundinertia",
];
/// Attributes whose ends may be infinite.
const RANGES: [&str; 4] = ["range", "ctrlrange", "forcerange", "actfrcrange"];

/// Refuses an element with a number that is none or not finite, or with commas between numbers; `at` gives its line.
///
/// # Errors
/// [`HousesError::Field`] names line, element and attribute.
pub(super) fn check(node: Node<'_, '_>, at: impl Fn() -> FileLocation) -> Result<(), HousesError> {
    // Its `gravity` is `enable` or `disable`.
    if node.has_tag_name("flag") {
        return Ok(());
    }
    for attribute in node.attributes() {
        let name = attribute.name();
        let finite = FINITE.contains(&name);
        if !finite && !RANGES.contains(&name) {
            continue;
        }
        if attribute.value().contains(',') {
            return refuse(
                node,
                name,
                &at(),
                "numbers with spaces between them, no commas",
                attribute.value(),
            );
        }
        // Of 32 bits, as all numbers of a house.
        let is_bad = |x: f32| x.is_nan() || (finite && x.is_infinite());
        let mut words = attribute.value().split_ascii_whitespace();
        if attribute.value().trim_ascii().is_empty() {
            return refuse(node, name, &at(), "numbers", attribute.value());
        }
        if let Some(word) = words.find(|word| word.parse().map_or(true, is_bad)) {
            return refuse(node, name, &at(), "finite numbers below 3.4e38", word);
        }
    }
    Ok(())
}

fn refuse(
    node: Node<'_, '_>,
    name: &str,
    at: &FileLocation,
    expected: &'static str,
    found: &str,
) -> Result<(), HousesError> {
    let field = format!("{}.{name}", node.tag_name().name());
    Err(HousesError::Field {
        at: at.field(field),
        expected,
        found: format!("{found:.200?}"),
    })
}
