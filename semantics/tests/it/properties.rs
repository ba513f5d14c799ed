//! Properties over random inputs.

use dwell_semantics::color::{ColorVocabulary, Oklab};
use dwell_semantics::geometry::Hull;
use dwell_semantics::{english, vocabulary};
use glam::Vec2;
use proptest::prelude::*;

fn cloud() -> impl Strategy<Value = Vec<Vec2>> {
    let point = (-4.0f32..4.0, -4.0f32..4.0).prop_map(|(x, z)| Vec2::new(x, z));
    prop::collection::vec(point, 1..24)
}

proptest! {
    #[test]
    fn hulls_measure_alike_from_both_sides(p in cloud(), q in cloud()) {
        let (a, b) = (Hull::around(p.clone()), Hull::around(q));
        prop_assert!((a.distance(&b) - b.distance(&a)).abs() < 1e-5);
        let (ab, ba) = (a.overlap_m2(&b), b.overlap_m2(&a));
        prop_assert!((ab - ba).abs() < 1e-3 * (1.0 + ab), "{ab} {ba}");
        prop_assert!(ab <= a.area_m2().min(b.area_m2()) * 1.001 + 1e-4);
        prop_assert!(ab < 1e-4 || a.distance(&b) <= 0.0);
        for point in &p {
            prop_assert!(a.distance_to(*point) < 2e-3);
        }
    }

    #[test]
    fn the_chosen_word_is_never_beaten(r in 0.0f32..1.0, g in 0.0f32..1.0, b in 0.0f32..1.0) {
        let color = Oklab::from_linear([r, g, b]);
        for list in [ColorVocabulary::Basic, ColorVocabulary::Web, ColorVocabulary::Xkcd] {
            let lab = |word| {
                let srgb = list.srgb(word).expect("a word of the list").map(|c| f32::from(c) / 255.0);
                Oklab::from_srgb(srgb)
            };
            let chosen = lab(list.word([r, g, b])).distance(color);
            prop_assert!(list.words().iter().all(|word| lab(word).distance(color) >= chosen));
        }
        prop_assert!(ColorVocabulary::Plain.words().contains(&ColorVocabulary::Plain.word([r, g, b])));
    }

    #[test]
    fn texts_of_known_words_come_back(picks in prop::collection::vec(0usize..10_000, 1..vocabulary::LENGTH)) {
        let known = vocabulary::vocabulary();
        let text = picks.iter().map(|k| known[k % known.len()]).collect::<Vec<_>>().join(" ");
        let tokens = vocabulary::tokenize(&text).expect("all words are known");
        prop_assert_eq!(tokens.len(), vocabulary::LENGTH);
        prop_assert_eq!(vocabulary::detokenize(&tokens), text);
    }

    #[test]
    fn no_text_makes_the_tokenizer_panic(text in ".{0,200}") {
        let _ = vocabulary::tokenize(&text);
        let _ = english::with_article(&text);
        let _ = english::capitalized(&text);
    }
}
