//! The files that a file includes: all inside the data root, or refused.

use roxmltree::Document;

use crate::error::HousesError;
use crate::limits::MAX_TEXT_BYTES;
use crate::report::At;
use crate::robot::Files;
use crate::root::folder_of;

/// Most files that include each other.
const MOST_FILES: usize = 64;

/// Checks the text of `files` and everything it includes.
///
/// # Errors
/// [`HousesError::PathLeavesRoot`], [`HousesError::Syntax`] for what is no XML or includes itself without end.
pub(super) fn check(files: &Files, text: &str) -> Result<(), HousesError> {
    let mut waiting = vec![(files.file.clone(), text.to_owned())];
    let mut seen = 0;
    // MuJoCo takes included paths from the folder of the main file.
    let folder = folder_of(&files.file).to_owned();
    while let Some((name, text)) = waiting.pop() {
        seen += 1;
        let at = At::file(&name);
        if seen > MOST_FILES {
            let message = format!("more than {MOST_FILES} files are included");
            return Err(HousesError::Syntax { at, message });
        }
        let document = Document::parse(&text).map_err(|error| HousesError::Syntax {
            at: at.line(error.pos().row),
            message: error.to_string(),
        })?;
        let includes = document
            .descendants()
            .filter(|node| node.tag_name().name() == "include");
        for node in includes {
            let at = at.line(document.text_pos_at(node.range().start).row);
            let at = at.field("include.file");
            let path = files.resolve(&folder, node.attribute("file").unwrap_or(""), &at)?;
            let bytes = files.root.read(&path, MAX_TEXT_BYTES)?;
            let text = String::from_utf8(bytes).map_err(|error| HousesError::Syntax {
                at,
                message: error.to_string(),
            })?;
            waiting.push((path, text));
        }
    }
    Ok(())
}
