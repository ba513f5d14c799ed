//! What stands for things that were named before: "it", "one", "both of them".
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use dwell_semantics::form::{Form, Noun, Phrase, RequestStep};
use dwell_semantics::language::{Language, ParseError};

fn preferred(text: &str) -> Form {
    let mut reading = Language::english()
        .read(text)
        .unwrap_or_else(|error| panic!("{text}: {error}"));
    reading.forms.remove(0)
}

fn said(text: &str) -> String {
    let said = Language::english().say(&preferred(text), None);
    said.unwrap_or_else(|| panic!("{text}: {:?}", preferred(text)))
        .text
}

#[test]
fn one_has_the_noun_of_a_thing_in_the_same_role() {
    for (text, meant) in [
        (
            "Take the red cup and not the blue one.",
            "Pick up the red cup, then do not pick up the blue cup.",
        ),
        (
            "Is the chair near the door larger than the one near the bed?",
            "Is the chair near the door larger than the chair near the bed?",
        ),
        (
            "There are more red chairs than blue ones.",
            "There are more red chairs than blue chairs.",
        ),
        (
            "Which door is open, the left one or the right one?",
            "Is the first door from the left open, or is the first door from the right open?",
        ),
        (
            "If there is no towel on the rail, get one.",
            "If there is no towel on the rail, pick up a towel.",
        ),
        (
            "There are two mats in the bathroom, a gray one and an orange one.",
            "There are two mats in the bathroom, there is a gray mat in the bathroom, and there is an orange mat in the bathroom.",
        ),
    ] {
        assert_eq!(said(text), meant, "{text}");
    }
    // A landmark after a landmark: the second shelf, not a second plant.
    let Form::Request(steps) =
        preferred("Take the plant from the lowest shelf and put it on the highest one.")
    else {
        panic!("no request");
    };
    let RequestStep::Put { object, to, .. } = &steps[1] else {
        panic!("{steps:?}");
    };
    assert_eq!(noun_of(object), "plant");
    assert_eq!(noun_of(to), "shelf");
}

fn noun_of(phrase: &Phrase) -> &str {
    match phrase {
        Phrase::Described(own) => match &own.noun {
            Noun::Object(noun) => noun,
            other => panic!("{other:?}"),
        },
        other => panic!("{other:?}"),
    }
}

#[test]
fn it_is_the_last_thing_that_the_verb_suits() {
    for (text, meant) in [
        (
            "Open the fridge, take the bottle and close it.",
            "Open the fridge, then pick up the bottle, then close the fridge.",
        ),
        (
            "Open the wardrobe next to the bed, get a pillow and put it on the bed.",
            "Open the wardrobe next to the bed, then put a pillow on the bed.",
        ),
        (
            "Close the door if it is open.",
            "If the door is open, close the door.",
        ),
        (
            "Are there books on the shelf or is it empty?",
            "Are there at least two books on the shelf, or is the shelf empty?",
        ),
        (
            "Is the cooker under the hood or next to it?",
            "Is the cooker under the hood, or is the cooker next to the hood?",
        ),
        (
            "Find the coffee machine and tell me whether it's on.",
            "Find the coffee machine, then tell me whether the coffee machine is on.",
        ),
        (
            "The television is larger than the TV stand that supports it.",
            "The television is larger than the TV stand that supports the television.",
        ),
        (
            "There are two chairs near the bed and both are red.",
            "There are two chairs near the bed, and both chairs near the bed are red.",
        ),
    ] {
        assert_eq!(said(text), meant, "{text}");
    }
    // Every other thing is a further reading.
    let forms = Language::english()
        .read("Open the fridge, take the bottle and close it.")
        .unwrap()
        .forms;
    let closes = |form: &Form, noun: &str| match form {
        Form::Request(steps) => matches!(
            &steps[2],
            RequestStep::Do { object, .. } if noun_of(object) == noun
        ),
        _ => false,
    };
    assert!(forms.iter().any(|form| closes(form, "bottle")), "{forms:?}");
}

#[test]
fn a_sentence_may_say_it_of_the_one_before() {
    let english = Language::english();
    let texts = |text: &str| {
        let read = english.read_text(text).unwrap();
        let texts = read
            .iter()
            .map(|one| english.say(&one.forms[0], None).unwrap().text);
        texts.collect::<Vec<_>>()
    };
    assert_eq!(
        texts("Find the red cup. Pick it up. The blue one is in the sink."),
        [
            "Find the red cup.",
            "Pick up the red cup.",
            "The blue cup is in the sink."
        ]
    );
    assert_eq!(
        texts("There is a red chair in the hall. It is near the blue one.")[1],
        "A red chair in the hall is near the blue chair."
    );
}

#[test]
fn what_nothing_stands_for_stays() {
    for text in [
        "The red one is on the table.",
        "It is red.",
        "Both of them are open.",
    ] {
        assert!(!preferred(text).is_free_of_anaphora(), "{text}");
        let error = Language::english().read_text(text).unwrap_err();
        assert_eq!(error.error, ParseError::NoAntecedent, "{text}");
    }
}

#[test]
fn nothing_stands_for_itself() {
    for text in [
        "The chair next to it is larger than the table near it.",
        "Put the cup next to it on the tray next to it and take it.",
        "The red one next to it is near the blue one next to it.",
        "It is on it, it is on it, and it is on it.",
    ] {
        assert!(!preferred(text).phrases().is_empty(), "{text}");
    }
}

#[test]
fn the_other_is_not_the_one_that_was_named() {
    for (text, meant) in [
        (
            "The bed near the door is larger than the other bed.",
            "The bed near the door is larger than the bed other than the bed that is near the door.",
        ),
        // The other one is named first where the comparison is turned around.
        (
            "The bed near the door is smaller than the other bed.",
            "The bed other than the bed that is near the door is larger than the bed near the door.",
        ),
        // It shares the place of the first, and is told from it by what was said of that.
        (
            "One of the mats in the hall is red and the other is gray.",
            "A mat in the hall is red, and the mat in the hall other than the red mat that is in the hall is gray.",
        ),
    ] {
        let form = preferred(text);
        assert!(form.is_free_of_anaphora(), "{text}: {form:?}");
        let said = Language::english().say(&form, None).map(|said| said.text);
        assert_eq!(said.as_deref(), Some(meant), "{text}: {form:?}");
    }
    for text in [
        "The other chair is red.",
        "Put the cup on the other table.",
        "Does the other bathroom have a window?",
        "Is there another sofa?",
    ] {
        let error = Language::english().read_text(text).unwrap_err();
        assert_eq!(error.error, ParseError::NoAntecedent, "{text}");
    }
}

#[test]
fn they_are_what_the_sentence_was_about() {
    for (text, meant) in [
        (
            "Three cups are on the shelf, and all of them are red.",
            "Three cups are on the shelf, and every cup on the shelf is red.",
        ),
        (
            "There are three mugs on the table, and they are red.",
            "There are three mugs on the table, and every mug on the table is red.",
        ),
        (
            "Open the curtains and then close them.",
            "Open the curtains, then close the curtains.",
        ),
        (
            "Put the purple vase on the shelf next to the yellow one.",
            "Put the purple vase on the shelf next to the yellow vase.",
        ),
        (
            "Is the plant in the yellow pot in front of the desk or behind it?",
            "Is the plant in the yellow pot in front of the desk, or is the plant in the yellow pot behind the desk?",
        ),
    ] {
        let form = preferred(text);
        assert!(form.is_free_of_anaphora(), "{text}: {form:?}");
        assert_eq!(said(text), meant, "{text}");
    }
}

#[test]
fn a_step_after_a_fetch_says_where_the_thing_goes() {
    for (text, meant) in [
        (
            "Fetch the red blanket from the bed and put it in the wardrobe.",
            "Put the red blanket that is from the bed in the wardrobe.",
        ),
        (
            "Take one of the candles from the glass table and hand it to me.",
            "Bring me a candle from the glass table.",
        ),
        ("Fetch the cup.", "Bring me the cup."),
        (
            "Bring me the cup, then put it on the table.",
            "Bring me the cup, then put the cup on the table.",
        ),
        (
            "Push the basket into the corner.",
            "Put the basket in the corner.",
        ),
        (
            "Push the basket in the corner.",
            "Push the basket in the corner.",
        ),
        (
            "Walk around the table without touching the chairs.",
            "Go around the table, then do not touch a chair.",
        ),
        ("Do not touch every chair.", "Do not touch every chair."),
    ] {
        assert_eq!(said(text), meant, "{text}");
    }
}

#[test]
fn a_side_is_that_of_the_landmark_before() {
    for (text, meant) in [
        (
            "The trash can is to the left of the toilet and the basket is to the right.",
            "The trash can is to the left of the toilet, and the basket is to the right of the toilet.",
        ),
        (
            "The trash can is to the left of the toilet and the basket is on your right.",
            "The trash can is to the left of the toilet, and the basket is on your right.",
        ),
        (
            "The basket is to the right.",
            "The basket is on your right.",
        ),
    ] {
        assert_eq!(said(text), meant, "{text}");
    }
}

#[test]
fn a_bare_plural_is_two_or_more_of_what_is_told_and_any_under_a_plural() {
    for (text, meant) in [
        (
            "There are two plants in white pots on the balcony.",
            "There are two plants in a white pot on the balcony.",
        ),
        (
            "None of the windows in the bedroom have curtains.",
            "No window in the bedroom has a curtain.",
        ),
        (
            "The table has chairs.",
            "The table has at least two chairs.",
        ),
        (
            "Cups are on the table.",
            "At least two cups are on the table.",
        ),
        (
            "Are the walls in the kitchen yellow?",
            "Is every wall of the kitchen yellow?",
        ),
        (
            "There's only one bottle in the storeroom, and it's on the lowest shelf.",
            "There is exactly one bottle in the storeroom, and the bottle in the storeroom is on the lowest shelf.",
        ),
    ] {
        assert_eq!(said(text), meant, "{text}");
    }
}

#[test]
fn the_same_place_and_what_somebody_left() {
    for (text, meant) in [
        (
            "The bed is in the same room as the curtain.",
            "The bed is in a room with the curtain.",
        ),
        (
            "The gray vase is on the same shelf as a purple book.",
            "The gray vase is on a shelf that supports a purple book.",
        ),
        (
            "Somebody left a tablet on the coffee table.",
            "A tablet is on the coffee table.",
        ),
        ("No one is in the kitchen.", "No person is in the kitchen."),
        (
            "A black pan is standing on the stove, and it's empty.",
            "A black pan is on the stove, and a black pan on the stove is empty.",
        ),
        ("Is anything on the shelves?", "Is a thing on a shelf?"),
        (
            "The room with the red sofas has a glass door.",
            "There is a glass door in the room with at least two red sofas.",
        ),
        (
            "There isn't any bottle or cup on the counter.",
            "There is no bottle on the counter, and there is no cup on the counter.",
        ),
        (
            "There are more jars on the shelf than there are mugs on the table.",
            "There are more jars on the shelf than mugs on the table.",
        ),
        (
            "Where's the nearest bin to the toilet?",
            "Where is the bin closest to the toilet?",
        ),
        (
            "Walk to the end of the corridor.",
            "Stand at the end of the corridor.",
        ),
        ("Hand me the cup, would you?", "Bring me the cup."),
    ] {
        assert_eq!(said(text), meant, "{text}");
    }
    // What a picture shows is not what belongs to it, and a bed is no room with an end.
    for text in [
        "A picture of some blue bottles hangs on the wall.",
        "Bring me the magazine that's lying at the end of the bed.",
    ] {
        assert!(matches!(
            Language::english().read(text),
            Err(ParseError::NotASentence { .. } | ParseError::Undefined { .. })
        ));
    }
    let two = Language::english()
        .read("There is a bed. There is a sofa.")
        .unwrap_err();
    assert!(
        two.to_string()
            .ends_with("nothing can follow: expected one sentence"),
        "{two}"
    );
}
