//! Texts of three lengths.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use dwell_scene::State;
use dwell_semantics::Semantics;
use dwell_semantics::describe::{TextLength, captions, describe_house, describe_rooms};
use std::sync::Arc;

#[test]
fn longer_texts_tell_more() {
    for name in ["builtin:apartment", "builtin:studio", "seed:7"] {
        let house = Arc::new(dwell_houses::open(name).unwrap().0);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        let [short, normal, long] =
            TextLength::ALL.map(|length| describe_rooms(&scene, length, None));
        let mut placed = 0;
        for (k, normal) in normal.iter().enumerate() {
            let (short, long) = (&short[k], &long[k]);
            // The area, and at most one sentence about what stands there.
            assert!(short.claims.len() <= 2, "{name}: {}", short.text);
            assert!(
                short.text.len() <= normal.text.len(),
                "{name}: {}",
                short.text
            );
            // All claims of the normal text in their order, and others between them.
            let mut rest = long.claims.iter();
            for claim in &normal.claims {
                assert!(
                    rest.any(|other| other.form == claim.form),
                    "{name}: {:?} is not in {}",
                    claim.form,
                    long.text
                );
            }
            placed += long.claims.len() - normal.claims.len();
        }
        assert!(placed > 0, "{name}: long texts say where nothing stands");
        let [short, normal, long] = TextLength::ALL.map(|length| captions(&scene, length, None));
        assert!(
            short
                .iter()
                .zip(&normal)
                .all(|(short, normal)| short.text.len() <= normal.text.len())
        );
        assert!(normal.iter().all(|caption| caption.claims.len() == 1));
        assert!(
            long.iter().any(|caption| caption.claims.len() > 2),
            "{name}"
        );
        let [short, normal, long] =
            TextLength::ALL.map(|length| describe_house(&scene, length, None).text);
        assert_eq!(short, normal.lines().next().unwrap());
        assert!(long.len() > normal.len());
        if name == "builtin:studio" {
            println!("{long}");
            for caption in captions(&scene, TextLength::Long, None) {
                println!("- {}", caption.text);
            }
        }
    }
}
