//! One direction: `cargo metadata` compared with the list of the layers, the page that draws it, and the modules within each crate.

mod circles;
mod page;
mod rules;
mod uses;
mod walls;

use crate::findings::CheckOutcome;
use crate::manifests::{self, Member};
use crate::tree;
use std::path::Path;

pub(crate) fn run(root: &Path) -> Result<CheckOutcome, String> {
    let members = manifests::members(root)?;
    let tree = tree::workspace_on_all_targets(root)?;
    let mut outcome = CheckOutcome::default();
    outcome
        .findings
        .extend(uses::check(&members, rules::CRATES, root));
    outcome
        .findings
        .extend(walls::check(&members, &tree, rules::WALLS));
    outcome.findings.extend(circles::check(root, &members)?);
    outcome.findings.extend(check_page(root, &members));
    outcome.notes.push(format!(
        "{} crates, {} walls",
        members.len(),
        rules::WALLS.len()
    ));
    Ok(outcome)
}

fn check_page(root: &Path, members: &[Member]) -> Vec<String> {
    match std::fs::read_to_string(root.join(page::PAGE)) {
        Ok(text) => page::check(&text, members),
        Err(error) => vec![format!("{} cannot be read: {error}", page::PAGE)],
    }
}
