//! The files that a file includes or attaches: all inside the data root, few, and not nested without end, or refused.
//!
//! `mjcf-rs` opens them itself, as large and as often as files say, so all of them are checked beforehand.

use std::mem;

use dwell_scene::interrupt;
use roxmltree::Node;

use super::default_classes::DefaultClasses;
use super::{finite_check, unread_elements};
use crate::data_root::parent_folder;
use crate::error::HousesError;
use crate::limits::{MAX_TEXT_BYTES, MAX_XML_ELEMENTS, MAX_XML_FILES};
use crate::report::{FileLocation, LoadReport};
use crate::robot::RobotFileLoader;
use crate::xml::{self, LineIndex};

/// Checks the text of `files` and everything it includes or attaches; also that all its numbers are finite. Parts that the parser
/// skips is reported.
///
/// # Errors
/// [`HousesError::PathLeavesRoot`], [`HousesError::Syntax`] for what is no XML or includes itself without end,
/// [`HousesError::TooLarge`] for elements nested too deep, or too many, [`HousesError::Field`] for numbers that are not finite.
pub(super) fn check(
    files: &RobotFileLoader,
    text: &str,
    report: &mut LoadReport,
) -> Result<(), HousesError> {
    let mut walk = IncludeChecker {
        files,
        report,
        seen: 0,
        open: Vec::new(),
        classes: DefaultClasses::default(),
    };
    walk.check_file(&files.file, text)?;
    walk.classes.report_undefined(walk.report);
    Ok(())
}

struct IncludeChecker<'a> {
    files: &'a RobotFileLoader,
    report: &'a mut LoadReport,
    /// Number of checked files, those that are named again counted again.
    seen: usize,
    /// The current file and those that name it.
    open: Vec<String>,
    /// The classes of the current model.
    classes: DefaultClasses,
}

impl IncludeChecker<'_> {
    /// Returns the number of elements of a file, with all that it includes and attaches.
    fn check_file(&mut self, name: &str, text: &str) -> Result<u64, HousesError> {
        self.seen += 1;
        let at = FileLocation::file(name);
        let refuse = |message: String| HousesError::Syntax {
            at: at.clone(),
            message,
        };
        if self.seen > MAX_XML_FILES {
            return Err(refuse(format!(
                "more than {MAX_XML_FILES} files are included"
            )));
        }
        if self.open.iter().any(|other| other == name) {
            let chain = self.open.join(" > ");
            return Err(refuse(format!("it includes itself: {chain} > {name}")));
        }
        let document = xml::parse(text, &at)?;
        let root = document.root_element().tag_name().name();
        if self.open.is_empty() && root != "mujoco" {
            return Err(refuse(format!(
                "no model of MuJoCo: its root is <{root}>, expected <mujoco>"
            )));
        }
        let lines = LineIndex::new(&document);
        self.open.push(name.to_owned());
        let too_many = |found: u64| HousesError::TooLarge {
            at: at.clone(),
            what: "count of elements, with those of included files,",
            found,
            allowed: MAX_XML_ELEMENTS,
        };
        let (mut elements, mut largest) = (0_u64, 0_u64);
        for node in document.descendants().filter(Node::is_element) {
            elements = elements.saturating_add(1);
            if elements % 4096 == 0 {
                interrupt::unwind_if_cancelled();
            }
            let node_at = || at.line(lines.line(node));
            finite_check::check(node, node_at)?;
            unread_elements::report_unread_elements(node, node_at, self.report);
            self.classes.record(node, node_at, self.report);
            match node.tag_name().name() {
                "include" => {
                    elements = elements.saturating_add(self.check_referenced_file(
                        node,
                        name,
                        &node_at(),
                    )?);
                }
                // Models of `<asset>` are copied by each `<attach>`.
                "model" if node.has_attribute("file") => {
                    // It has classes of its own.
                    let outer = mem::take(&mut self.classes);
                    largest = largest.max(self.check_referenced_file(node, name, &node_at())?);
                    mem::replace(&mut self.classes, outer).report_undefined(self.report);
                }
                _ => {}
            }
            if elements > MAX_XML_ELEMENTS {
                return Err(too_many(elements));
            }
        }
        let attached = document
            .descendants()
            .filter(|node| node.tag_name().name() == "attach")
            .count() as u64;
        let all = elements.saturating_add(largest.saturating_mul(attached.max(1)));
        if all > MAX_XML_ELEMENTS {
            return Err(too_many(all));
        }
        self.open.pop();
        Ok(all)
    }

    /// The elements of the file that `node` of the file `name`, at the line `at`, names.
    fn check_referenced_file(
        &mut self,
        node: Node<'_, '_>,
        name: &str,
        at: &FileLocation,
    ) -> Result<u64, HousesError> {
        let tag = node.tag_name().name();
        let at = at.field(format_args!("{tag}.file"));
        // The parser resolves paths from the folder of the file that names them.
        let stated = node.attribute("file").unwrap_or("");
        let path = self.files.resolve(parent_folder(name), stated, &at)?;
        let bytes = self.files.root.read(&path, MAX_TEXT_BYTES)?;
        let text = String::from_utf8(bytes).map_err(|error| HousesError::Syntax {
            at,
            message: error.to_string(),
        })?;
        self.check_file(&path, &text)
    }
}
