//! Patterns of things, by their predicates and in their captions.

use crate::common;

use common::Builder;
use dwell_scene::{ObjectId, State};
use dwell_semantics::describe::{TextOptions, caption};
use dwell_semantics::{Semantics, Term, predicates};

#[test]
fn patterns_are_told_of_things() {
    let is_red = |x: bool| if x { [180, 20, 25] } else { [250; 3] };
    let mut b = Builder::new("patterns");
    b.room("living_room", [0.05, 0.05], [7.95, 7.95]);
    let images = [
        b.textured("textile", |x, _| is_red(x / 6 % 2 == 0)),
        b.textured("textile", |x, y| is_red(x / 6 % 2 == 0 || y / 6 % 2 == 0)),
        b.textured("textile", |x, y| is_red((x / 6 + y / 6) % 2 == 0)),
    ];
    let names = ["striped", "checked", "patterned"];
    let rugs: Vec<ObjectId> = (0..names.len())
        .map(|k| {
            let at = 0.5 + 2.5 * k as f32;
            b.thing("rug", &[([at, 0.0, 1.0], [at + 1.5, 0.02, 3.0])], images[k])
        })
        .collect();
    let house = b.build();
    let (semantics, state) = (Semantics::new(&house), State::new(&house));
    let scene = semantics.scene(&state);
    for (rug, own) in rugs.into_iter().zip(names) {
        let text = caption(&scene, rug, TextOptions::default()).text;
        assert!(text.starts_with(&format!("a {own} ")), "{text}");
        for name in names {
            let predicate = predicates::find(name).expect("it exists");
            let holds = predicate
                .holds(&scene, &[Term::Object(rug)], None)
                .is_true();
            assert_eq!(holds, name == own || name == "patterned", "{own} {name}");
        }
    }
}
