//! Texts of three lengths and two styles.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use dwell_scene::State;
use dwell_semantics::Semantics;
use dwell_semantics::color::ColorVocabulary;
use dwell_semantics::describe::{
    TextLength, TextOptions, TextStyle, captions, describe_house, describe_rooms,
};
use std::sync::Arc;

#[test]
fn longer_texts_tell_more() {
    for name in ["builtin:apartment", "builtin:studio", "seed:7"] {
        let house = Arc::new(dwell_houses::open(name).unwrap().0);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        let [short, normal, long] =
            TextLength::ALL.map(|length| describe_rooms(&scene, length.into()));
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
        let [short, normal, long] = TextLength::ALL.map(|length| captions(&scene, length.into()));
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
            TextLength::ALL.map(|length| describe_house(&scene, length.into()).text);
        assert_eq!(short, normal.lines().next().unwrap());
        assert!(long.len() > normal.len());
        if name == "builtin:studio" {
            println!("{long}");
            for caption in captions(&scene, TextLength::Long.into()) {
                println!("- {}", caption.text);
            }
        }
    }
}

/// Plain captions have the nouns of the rich ones and none of their colours; plain rooms tell of no fewer things.
#[test]
fn plain_texts_have_no_colours() {
    for name in ["builtin:apartment", "seed:7"] {
        let house = Arc::new(dwell_houses::open(name).unwrap().0);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        let plain = TextOptions {
            style: TextStyle::Plain,
            ..TextLength::Short.into()
        };
        let mut shorter = 0;
        for (id, plain) in house.objects.ids().zip(captions(&scene, plain)) {
            let facts = semantics.facts(id);
            assert!(
                plain.text.ends_with(&facts.noun),
                "{name}: {:?} of a {}",
                plain.text,
                facts.noun
            );
            for (word, _) in facts.color_shares(ColorVocabulary::Spoken) {
                let is_said = plain.text.split(' ').any(|own| own == word);
                assert!(!is_said || facts.noun.contains(word), "{}", plain.text);
            }
            shorter += usize::from(plain.text.split(' ').count() == 2);
        }
        assert!(shorter > 20, "{name}");
        let rooms = |style| {
            let options = TextOptions {
                style,
                ..TextOptions::default()
            };
            describe_rooms(&scene, options)
        };
        let [plain, rich] = TextStyle::ALL.map(rooms);
        for (plain, rich) in plain.iter().zip(&rich) {
            println!("{}\n{}", plain.text, rich.text);
            assert!(plain.text.len() < rich.text.len(), "{name}");
            let terms = |text: &dwell_semantics::describe::GroundedText| {
                let claims = text.claims.iter().flat_map(|claim| &claim.terms);
                claims.copied().collect::<std::collections::BTreeSet<_>>()
            };
            let missing: Vec<_> = terms(rich).difference(&terms(plain)).copied().collect();
            assert!(
                missing.iter().all(|term| term.object().is_none()),
                "{name}: {missing:?} in {}",
                plain.text
            );
        }
    }
}
