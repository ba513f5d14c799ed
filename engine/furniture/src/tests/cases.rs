//! The whole catalogue, drawn many times.

use crate::catalogue::{CatalogueEntry, entries};
use crate::model::Model;
use crate::style::{STYLES, Style};
use crate::testing::meshes::collider_bounds;
use dwell_scene::Aabb;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use std::sync::OnceLock;

/// Draws of each entry in each style.
fn keys() -> u64 {
    if std::env::var_os("DWELL_TEST_ALL").is_some() {
        20
    } else {
        6
    }
}

/// One thing of the catalogue.
pub(super) struct Case {
    pub entry: &'static CatalogueEntry,
    pub style: &'static Style,
    pub key: RandomKey,
    pub model: Model,
}

impl Case {
    fn new(entry: &'static CatalogueEntry, style: &'static Style, number: u64) -> Self {
        let key = RandomKey::root(number);
        let model = (entry.build)(style, key);
        Self {
            entry,
            style,
            key,
            model,
        }
    }
}

/// The properties of one draw of an entry in a style.
pub(super) struct Summary {
    pub entry: &'static CatalogueEntry,
    style: &'static str,
    pub name: &'static str,
    pub bounds: Aabb,
    pub mass_kg: f32,
    pub triangles: usize,
    /// Name, box around what is seen, box around what is felt.
    pub parts: Vec<(&'static str, Aabb, Option<Aabb>)>,
}

impl Summary {
    fn new(case: &Case) -> Self {
        let model = &case.model;
        let parts = model.parts.iter().map(|part| {
            let felt = collider_bounds(&part.colliders);
            (part.name, part.mesh.bounds(), felt)
        });
        Self {
            entry: case.entry,
            style: case.style.name,
            name: model.name,
            bounds: model.bounds(),
            mass_kg: model.parts.iter().map(|part| part.mass_kg).sum(),
            triangles: model
                .parts
                .iter()
                .map(|part| part.mesh.triangles.len())
                .sum(),
            parts: parts.collect(),
        }
    }
}

/// Draws of each entry in each style, built once for all tests.
fn summaries() -> &'static [Vec<Summary>] {
    static ALL: OnceLock<Vec<Vec<Summary>>> = OnceLock::new();
    ALL.get_or_init(|| {
        let all = entries();
        Threads::default().map(all.len(), |k| {
            let styles = STYLES.iter().filter(|style| all[k].suits(style));
            let cases = styles.flat_map(|style| (0..keys()).map(move |number| (style, number)));
            cases
                .map(|(style, number)| Summary::new(&Case::new(&all[k], style, number)))
                .collect()
        })
    })
}

/// Fails with what `check` finds at any draw of each entry in each style.
pub(super) fn every_draw_in_every_style(check: impl Fn(&Summary) -> Vec<String>) {
    let faults = summaries().iter().flat_map(|draws| {
        let found = draws.iter().flat_map(|draw| {
            let at = format!("{} ({})", draw.entry.kind, draw.style);
            let faults = check(draw).into_iter();
            faults.map(move |fault| format!("{at}: {fault}"))
        });
        shortened(found.collect())
    });
    judge(&faults.collect::<Vec<_>>());
}

/// The same for costly checks: draws of each entry, the styles in turn.
pub(super) fn every_draw(check: impl Fn(&Case) -> Vec<String> + Sync) {
    let all = entries();
    let found = Threads::default().map(all.len(), |k| {
        let entry = &all[k];
        let styles: Vec<&'static Style> =
            STYLES.iter().filter(|style| entry.suits(style)).collect();
        let found = (0..keys()).flat_map(|number| {
            let case = Case::new(entry, styles[number as usize % styles.len()], number);
            let at = format!("{} ({})", entry.kind, case.style.name);
            let faults = check(&case).into_iter();
            faults.map(move |fault| format!("{at}: {fault}"))
        });
        shortened(found.collect())
    });
    judge(&found.concat());
}

/// The first three faults of one entry, and how many more there are.
fn shortened(mut faults: Vec<String>) -> Vec<String> {
    let count = faults.len();
    faults.truncate(3);
    if count > 3 {
        faults.push(format!("  and {} more", count - 3));
    }
    faults
}

fn judge(faults: &[String]) {
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
