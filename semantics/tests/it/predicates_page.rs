//! `docs/predicates.md` lists the predicates and orders that there are.

use dwell_semantics::predicates::{Predicate, all};
use dwell_semantics::selections;
use std::fmt::Write as _;
use std::path::Path;

const HEAD: &str = "# Predicates

What can be true of things in a house as it stands, with definition, threshold and source. What is said and what is checked rest on
these alone. This page is written by the test `predicates_page` (`UPDATE_GOLDEN=1 cargo test -p dwell-semantics --test
predicates_page`) from what the engine says.

```python
import dwell
import dwell.relations

world = dwell.World(\"builtin:apartment\")
world.holds(\"on\", \"radio_1\", \"stand_1\")  # True, False, or None where it cannot be asked
world.holds(\"left_of\", \"radio_1\", \"stand_1\", viewer=0)  # for agent 0
print(world.why_undecided(\"open\", \"radio_1\"))  # It does not open.
world.relations([\"in_room\", \"on\"])  # [(subject, predicate, object), ...]
world.relation_array()  # int32 (relation, 3)
world.select(\"largest\", [\"radio_1\", \"refrigerator_1\"])
dwell.relations.predicates()  # this page, as data
```

A thing is named by its name or its id in instance images; a room as `room:NAME`, a storey as `storey:0`, an agent as `agent:0`, a
part as `part:OBJECT/PART`. A viewer is an agent's number or `{\"position\": (x, y, z), \"yaw_deg\": 0, \"pitch_deg\": 0}`.

Truth has three values (strong logic of S. C. Kleene, *Introduction to Metamathematics*, 1952, § 64). A question is *undecided* where
it makes no sense for these things here: of another number or kind of things, without the viewer that it needs or of what that
viewer does not have in front of it, of the openness of what does not open, the colour of glass, the front of what has none.

Two pairs of words are apart in English only by what is meant. `in_front_of` and `behind` are meant from a viewer: what is in front
is nearer to it. `at_front_of` and `at_back_of` are meant from the reference's own front, which does not depend on who looks; kinds
of things with a front are marked in `assets/categories.csv` (seats, beds, desks, cabinets, appliances, screens, pictures), and it is
the side that is used or looked at. For one pair of things `in` and `on` exclude each other: what lies in a bowl is in it; what lies on its
lid, and on a seat or a bed, is on it.

Outlines are convex and seen from above. A gap between things is that between these outlines, each taken from the thing's lowest to
its highest point. *Listed* relations are those in tables of relations and in scene graphs unasked; a house with n things costs n log n
steps for all of them. Others may hold of all pairs and are told where they are asked for.
";

fn row(cells: &[String]) -> String {
    let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
    format!("| {} |\n", cells.join(" | "))
}

fn kinds(predicate: &dyn Predicate) -> String {
    let places = predicate.argument_kinds().iter().map(|kinds| {
        let names: Vec<&str> = kinds.iter().map(|kind| kind.name()).collect();
        names.join(" or ")
    });
    places.collect::<Vec<String>>().join("; ")
}

fn page() -> String {
    let mut text = HEAD.to_owned();
    for (arity, title) in [
        (1, "Of one thing"),
        (2, "Of two things"),
        (3, "Of three things"),
    ] {
        let _ = write!(
            text,
            "\n## {title}\n\n| predicate | of | holds when | always | source |\n| --- | --- | --- | --- | --- |\n"
        );
        for predicate in all().iter().filter(|predicate| predicate.arity() == arity) {
            let mut laws = predicate.properties().names();
            laws.extend(
                predicate
                    .needs_viewer()
                    .then(|| "needs a viewer".to_owned()),
            );
            laws.extend(predicate.is_listed().then(|| "listed".to_owned()));
            text += &row(&[
                format!("`{}`", predicate.name()),
                kinds(*predicate),
                predicate.definition().to_owned(),
                laws.join(", "),
                predicate.source().to_owned(),
            ]);
        }
    }
    text += "\n## Orders\n\nSuperlatives and ordinals choose one out of several things by its place in an order (`World.select`). Neighbours that
differ by less than the margin are not told apart.\n\n| order | first comes | needs | margin | source |\n| --- | --- | --- | --- | --- |\n";
    for selection in selections::all() {
        let needs = [
            (selection.needs_viewer(), "a viewer"),
            (selection.needs_reference(), "a reference"),
        ];
        let needs: Vec<&str> = needs
            .into_iter()
            .filter_map(|(needed, name)| needed.then_some(name))
            .collect();
        text += &row(&[
            format!("`{}`", selection.name()),
            selection.definition().to_owned(),
            needs.join(", "),
            format!("{:.3}", selection.margin()),
            selection.source().to_owned(),
        ]);
    }
    text
}

#[test]
fn the_page_says_what_there_is() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/predicates.md");
    let page = page();
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, &page).expect("the page can be written");
    }
    let known = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(known == page, "stale: run with UPDATE_GOLDEN=1");
}
