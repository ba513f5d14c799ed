//! Captions, descriptions, referring expressions and instructions.

use crate::common;

use common::{Builder, small_house};
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentBody, AgentId, AgentState, Pose, State};
use dwell_semantics::check::{Addressee, Checker};
use dwell_semantics::describe::{
    TextOptions, caption, describe_house, describe_room, describe_view,
};
use dwell_semantics::form::{Description, Form, Noun, Phrase, Quantifier};
use dwell_semantics::graph::{SceneGraph, scene_graph};
use dwell_semantics::instruct::{
    CHARSET, InstructionKind, InstructionProgress, MAX_TEXT_LEN, candidates, choose, instruction,
};
use dwell_semantics::refer::{refer, refer_to_room};
use dwell_semantics::{SemanticScene, Semantics, Term, Viewer, predicates, vocabulary};
use glam::Vec3;

/// The words of a description.
fn said(semantics: &Semantics, description: &Description) -> String {
    let form = Form::NounPhrase(description.clone().into());
    let said = semantics.language().say(&form, None);
    said.expect("the language has words for it").text
}

/// What a description fits, without a viewer.
fn fitting(scene: &SemanticScene<'_>, description: &Description) -> Vec<Term> {
    Checker::new(scene, Addressee::default()).matching_terms(description)
}

#[test]
fn captions_read_aloud() {
    let s = small_house();
    let semantics = Semantics::new(&s.house);
    let mut state = State::new(&s.house);
    let scene = semantics.scene(&state);
    assert_eq!(
        caption(&scene, s.cup, TextOptions::default()).text,
        "a white porcelain cup on the table in the kitchen"
    );
    assert_eq!(
        caption(&scene, s.red_chair, TextOptions::default()).text,
        "a red plastic chair next to the table in the kitchen"
    );
    assert_eq!(
        caption(&scene, s.apple, TextOptions::default()).text,
        "a red plastic portion of food in the bowl in the kitchen"
    );
    assert_eq!(
        caption(&scene, s.stool, TextOptions::default()).text,
        "a brown wooden stool on the rug in the hallway"
    );
    assert_eq!(
        caption(&scene, s.picture, TextOptions::default()).text,
        "a yellow picture on the wall in the kitchen"
    );
    assert_eq!(
        caption(&scene, s.bed_b, TextOptions::default()).text,
        "a green double bed in the second bedroom"
    );
    state.agents.push(AgentState::new(
        AgentBody::default(),
        Vec3::new(2.0, 0.0, 7.0),
        0.0,
    ));
    state.held_by[s.cup] = Some(AgentId(0));
    let scene = semantics.scene(&state);
    assert_eq!(
        caption(&scene, s.cup, TextOptions::default()).text,
        "a white porcelain cup in somebody's hand in the hallway"
    );
}

#[test]
fn words_know_what_is_open_and_what_is_on() {
    let mut b = Builder::new("states");
    b.room("kitchen", [0.05, 0.05], [3.95, 3.95]);
    let wood = b.material("wood", [150, 111, 72]);
    let black = b.material("electronics", [20, 20, 20]);
    let door = b.thing("door", &[([1.0, 0.0, 1.0], [1.85, 2.05, 1.05])], wood);
    let cabinet = b.thing(
        "wardrobe_cabinet",
        &[([2.4, 0.0, 2.0], [3.6, 2.1, 2.6])],
        wood,
    );
    let radio = b.thing("radio", &[([0.5, 0.0, 3.0], [0.8, 0.18, 3.12])], black);
    b.data.objects[radio].switch = Some(false);
    for object in [door, cabinet] {
        let part = &mut b.data.parts[dwell_scene::PartId(object.0)];
        let pose = part.world_from_part;
        b.data.objects[object].mobility = dwell_scene::Mobility::Articulated;
        b.data.joints.push(dwell_scene::Joint {
            parent_from_joint: pose,
            limits: Some([0.0, 1.5]),
            open: 1.5,
            ..dwell_scene::Joint::new(
                "hinge",
                object,
                dwell_scene::PartId(object.0),
                dwell_scene::JointKind::Hinge,
                Vec3::Y,
            )
        });
    }
    let house = b.build();
    let semantics = Semantics::new(&house);
    let mut state = State::new(&house);
    let says = |state: &State, object| {
        caption(&semantics.scene(state), object, TextOptions::default()).text
    };
    assert_eq!(
        says(&state, door),
        "a closed brown wooden door in the kitchen"
    );
    assert_eq!(
        says(&state, cabinet),
        "a brown wooden wardrobe in the kitchen"
    );
    assert_eq!(says(&state, radio), "a black radio in the kitchen");
    for joint in house.joints.ids() {
        state.joint_position[joint] = 1.5;
    }
    state.switched_on[radio] = true;
    assert_eq!(
        says(&state, door),
        "an open brown wooden door in the kitchen"
    );
    assert_eq!(
        says(&state, cabinet),
        "an open brown wooden wardrobe in the kitchen"
    );
    assert_eq!(
        says(&state, radio),
        "a switched-on black radio in the kitchen"
    );
    let graph = scene_graph(&semantics.scene(&state), None);
    let node = graph.object(house.entity_of_object(radio).0).unwrap();
    assert_eq!((node.switched_on, node.openness), (Some(true), None));
}

#[test]
fn descriptions_read_aloud() {
    let s = small_house();
    let semantics = Semantics::new(&s.house);
    let state = State::new(&s.house);
    let scene = semantics.scene(&state);
    assert_eq!(
        describe_room(&scene, s.kitchen, TextOptions::default()).text,
        "The kitchen is about 15 square metres. It has a brown parquet floor and white walls. In the kitchen there is a brown \
         wooden table, a white refrigerator and two plastic chairs. On the table there is a white porcelain bowl and a white \
         porcelain cup. There is a red plastic portion of food in the bowl. There is a yellow picture on the wall in the \
         kitchen."
    );
    let text = describe_house(&scene, TextOptions::default()).text;
    println!("{text}");
    assert!(text.starts_with(
        "There are four rooms and 13 things. There are two bedrooms, a hallway and a kitchen.\n"
    ));
    assert!(text.contains("The second bedroom"));
    // What is said is counted against what is there.
    assert_eq!(text.matches("double bed").count(), 2);
    // Somebody in the kitchen's south, who looks north.
    let mut state = State::new(&s.house);
    let feet = Vec3::new(1.7, 0.0, 3.5);
    let body = AgentBody {
        eye_height_m: 1.3,
        ..AgentBody::default()
    };
    state.agents.push(AgentState::new(body, feet, 0.0));
    let scene = semantics.scene(&state);
    let view = describe_view(
        &scene,
        Addressee::agent(&scene, AgentId(0)),
        TextOptions::default(),
    );
    assert_eq!(
        view.text,
        "You are in the kitchen. The kitchen has a brown parquet floor and white walls. Straight ahead you see a \
         brown wooden table and a yellow picture. On your left you see a red plastic chair. On your right you see \
         a blue plastic chair. The table is about 2 metres away. The red chair is next to the table. The blue \
         chair is next to the table. You see a white porcelain bowl on the table."
    );
    // Without eyes nothing is seen.
    assert_eq!(
        describe_view(&scene, Addressee::default(), TextOptions::default()).text,
        ""
    );
}

/// The colour is that of the surfaces that the room sees, not of those behind a front or before a wall.
#[test]
fn the_colour_is_that_of_what_is_seen() {
    let mut b = common::Builder::new("fronts");
    b.room("kitchen", [0.05, 0.05], [3.95, 3.95]);
    let gray = b.material("particle_board", [128, 128, 128]);
    let orange = b.material("particle_board", [240, 130, 20]);
    // Boards one behind another, and a front before them all, against the wall at z 0.05.
    let boards: Vec<common::Corners> = (0..8)
        .map(|k| 0.06 + 0.07 * k as f32)
        .map(|z| ([1.0, 0.0, z], [2.2, 2.0, z + 0.02]))
        .collect();
    let cabinet = b.thing("wardrobe_cabinet", &boards, gray);
    let part = &mut b.data.parts.as_mut_slice()[0];
    part.materials.push(orange);
    let middle = part.world_from_part.position;
    let front = dwell_scene::Mesh::cuboid(
        Vec3::new(1.0, 0.0, 0.58) - middle,
        Vec3::new(2.2, 2.0, 0.6) - middle,
    );
    let mesh = part.mesh;
    let mut whole = (*b.data.meshes[mesh]).clone();
    whole.append(&front, 1);
    b.data.meshes[mesh] = std::sync::Arc::new(whole);
    let house = b.build();
    let semantics = Semantics::new(&house);
    let colors = &semantics.facts(cabinet).colors;
    assert_eq!(colors[0].0, "orange", "{colors:?}");
    assert!(colors[0].1 > 0.5, "{colors:?}");
    let state = State::new(&house);
    let text = describe_house(&semantics.scene(&state), TextOptions::default()).text;
    assert!(text.contains("an orange and gray wardrobe"), "{text}");
}

#[test]
fn texts_are_the_same_every_time() {
    let s = small_house();
    let text = || {
        let semantics = Semantics::new(&s.house);
        let state = State::new(&s.house);
        let scene = semantics.scene(&state);
        let graph = serde_json::to_string(&scene_graph(&scene, None)).unwrap();
        (describe_house(&scene, TextOptions::default()).text, graph)
    };
    assert_eq!(text(), text());
}

#[test]
fn the_graph_holds_exactly_what_the_predicates_say() {
    let s = small_house();
    let semantics = Semantics::new(&s.house);
    let state = State::new(&s.house);
    let scene = semantics.scene(&state);
    let viewer = Viewer {
        world_from_camera: Pose::from_position_yaw(Vec3::new(1.7, 1.3, 3.5), 0.0),
    };
    let graph = scene_graph(&scene, Some(&viewer));
    let again: SceneGraph = serde_json::from_str(&serde_json::to_string(&graph).unwrap()).unwrap();
    assert_eq!(again.relations, graph.relations);
    let mut count = 0;
    for a in s.house.objects.ids() {
        for b in s.house.objects.ids() {
            for code in dwell_semantics::graph::default_relation_codes(true) {
                let predicate = predicates::all()[code];
                let pair = [Term::Object(a), Term::Object(b)];
                let holds = predicate.holds(&scene, &pair, Some(&viewer)).is_true();
                let edge = dwell_semantics::graph::RelationEdge {
                    subject: s.house.entity_of_object(a).0,
                    predicate: predicate.name().to_owned(),
                    object: s.house.entity_of_object(b).0,
                };
                let kinds = predicate.argument_kinds()[1];
                let things = kinds.contains(&dwell_semantics::TermKind::Object);
                let in_graph = things && graph.relations.contains(&edge);
                assert_eq!(holds, in_graph, "{edge:?}");
                count += usize::from(holds);
            }
        }
    }
    assert!(count > 10);
    let rooms = graph
        .relations
        .iter()
        .filter(|edge| edge.predicate == "in_room")
        .count();
    assert_eq!(rooms, s.house.objects.len());
}

/// Twelve chairs in four colours and two materials over three rooms, with tables as landmarks.
fn crowded(seed: u64) -> std::sync::Arc<dwell_scene::House> {
    let mut stream = RandomKey::root(seed).stream();
    let mut b = Builder::new("crowded");
    let kinds = ["kitchen", "bedroom", "bedroom", "office"];
    for (k, kind) in kinds.iter().enumerate() {
        let (x, z) = (4.0 * (k % 2) as f32, 4.0 * (k / 2) as f32);
        b.room(kind, [x + 0.05, z + 0.05], [x + 3.95, z + 3.95]);
    }
    let colors = [[180, 20, 25], [30, 60, 150], [250, 250, 250], [30, 110, 40]];
    let nouns = [
        "chair",
        "stool",
        "coffee_table",
        "table",
        "vase",
        "ottoman",
        "piano",
    ];
    for _ in 0..24 {
        let substance = ["plastic", "wood", "leather"][stream.below(3)];
        let material = b.material(substance, colors[stream.below(4)]);
        let size = [0.2, 0.45, 0.9][stream.below(3)];
        let (x, z) = (stream.range(0.2, 6.8), stream.range(0.2, 6.8));
        b.thing(
            nouns[stream.below(nouns.len())],
            &[([x, 0.0, z], [x + size, size, z + size])],
            material,
        );
    }
    b.build()
}

/// The reading of a description by other code: words are looked up in the graph, not in the engine.
fn read_by_graph(graph: &SceneGraph, house: &dwell_scene::House, e: &Description) -> Vec<i32> {
    let Noun::Object(noun) = &e.noun else {
        panic!("a thing: {e:?}");
    };
    assert!(e.state.is_none() && e.selection.is_none(), "{e:?}");
    let called = |id: i32| {
        let said = &graph.object(id).expect("a node").noun;
        let object = match house.entity(dwell_scene::EntityId(id)) {
            Some(dwell_scene::Entity::Object(object)) => &house.objects[object],
            _ => return false,
        };
        let row = dwell_semantics::category::categories()
            .of(&object.category)
            .expect("a category of the table");
        let names = row
            .synonyms
            .iter()
            .map(|s| (*s).to_owned())
            .chain([said.clone()]);
        names
            .into_iter()
            .any(|name| name == *noun || name.ends_with(&format!(" {noun}")))
    };
    let matching = graph.objects.iter().filter(|node| {
        let colors = e.colors.iter().all(|color| node.colors.contains(color));
        let material = e.material.as_ref().is_none_or(|word| {
            let library = dwell_scene::material::library();
            node.substances
                .iter()
                .any(|name| library.get(name).expect("a substance").adjective == *word)
        });
        let size = e.size.is_none_or(|size| node.size == size);
        let modified = e.modifiers.iter().all(|modifier| {
            let [Phrase::Described(other)] = &modifier.arguments[..] else {
                panic!("one other thing: {modifier:?}");
            };
            assert!(!modifier.negated, "{modifier:?}");
            if let Noun::Room(noun) = &other.noun {
                let called = |name: &String| name == noun || name.ends_with(&format!(" {noun}"));
                // "The bedroom" only where there is one.
                let rooms = graph.rooms.iter().filter(|room| called(&room.name)).count();
                let article = if rooms == 1 {
                    Quantifier::The
                } else {
                    Quantifier::Some
                };
                assert_eq!(
                    **other,
                    Description::new(article, other.noun.clone()),
                    "{e:?}"
                );
                assert_eq!(modifier.predicate, "in_room");
                return node
                    .room
                    .is_some_and(|room| called(&graph.rooms[room as usize].name));
            }
            let landmarks = read_by_graph(graph, house, other);
            // "The table" only where there is one.
            let definite = other.quantifier == Quantifier::The;
            assert!(definite == (landmarks.len() == 1), "{e:?}: {landmarks:?}");
            graph.relations_of(node.id).any(|edge| {
                edge.predicate == modifier.predicate && landmarks.contains(&edge.object)
            })
        });
        called(node.id) && colors && material && size && modified
    });
    matching.map(|node| node.id).collect()
}

/// Returns whether a description says on, in or next to what its thing is.
fn has_landmark(description: &Description) -> bool {
    let mut modifiers = description.modifiers.iter();
    modifiers.any(|modifier| modifier.predicate != "in_room")
}

#[test]
fn referring_expressions_mean_exactly_one_thing() {
    let (mut found, mut total, mut with_landmark) = (0, 0, 0);
    for seed in 0..12 {
        let house = crowded(seed);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        let graph = scene_graph(&scene, None);
        for object in house.objects.ids() {
            total += 1;
            if let Some(expression) = refer(&scene, object) {
                found += 1;
                with_landmark += usize::from(has_landmark(&expression));
                assert_eq!(fitting(&scene, &expression), [Term::Object(object)]);
                assert_eq!(
                    read_by_graph(&graph, &house, &expression),
                    [house.entity_of_object(object).0],
                    "{expression:?}"
                );
                let text = said(&semantics, &expression);
                assert!(text.starts_with("the "), "{text}");
                let read = semantics.language().read(&text).expect("it is read");
                assert_eq!(read.forms[0], Form::NounPhrase(expression.into()), "{text}");
            }
        }
    }
    println!("{found} of {total} things can be told apart, {with_landmark} by a landmark");
    assert!(found * 10 >= total * 6 && with_landmark > 0);
}

#[test]
fn a_shorter_word_that_also_fits_another_thing_is_not_used() {
    let mut b = Builder::new("tables");
    b.room("kitchen", [0.0, 0.0], [8.0, 8.0]);
    let wood = b.material("wood", [150, 111, 72]);
    let red = b.material("plastic", [180, 20, 25]);
    let plain = b.thing("table", &[([1.0, 0.0, 1.0], [2.2, 0.75, 1.8])], red);
    let coffee = b.thing("coffee_table", &[([5.0, 0.0, 5.0], [6.0, 0.42, 5.6])], wood);
    let house = b.build();
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    // "The table" could be the coffee table.
    assert_eq!(
        said(&semantics, &refer(&scene, plain).unwrap()),
        "the red table"
    );
    assert_eq!(
        said(&semantics, &refer(&scene, coffee).unwrap()),
        "the coffee table"
    );
}

#[test]
fn rooms_are_told_apart_by_what_they_hold() {
    let s = small_house();
    let semantics = Semantics::new(&s.house);
    let state = State::new(&s.house);
    let scene = semantics.scene(&state);
    let says = |room| refer_to_room(&scene, room).map(|e| said(&semantics, &e));
    assert_eq!(says(s.kitchen).as_deref(), Some("the kitchen"));
    assert_eq!(
        says(s.bedroom_b).as_deref(),
        Some("the bedroom with a desk")
    );
    // Nothing is in the first bedroom that is not in the second.
    assert_eq!(says(s.bedroom_a), None);
    for room in s.house.rooms.ids() {
        if let Some(expression) = refer_to_room(&scene, room) {
            assert_eq!(fitting(&scene, &expression), [Term::Room(room)]);
        }
    }
}

#[test]
fn every_instruction_tokenises_and_keeps_to_its_charset() {
    let mut texts = 0;
    for seed in 0..12 {
        let house = crowded(seed);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        for kind in InstructionKind::ALL {
            let all = candidates(&scene, kind);
            for draw in 0..30 {
                let Some(chosen) = choose(&semantics, &all, RandomKey::root(draw)) else {
                    continue;
                };
                texts += 1;
                assert!(
                    chosen.text.len() <= MAX_TEXT_LEN
                        && chosen.text.chars().all(|c| CHARSET.contains(c))
                );
                let tokens = chosen.tokens().unwrap();
                assert_eq!(tokens.len(), vocabulary::LENGTH);
                let again = vocabulary::detokenize(&tokens)
                    .replace(" .", ".")
                    .replace(" ,", ",");
                assert_eq!(again, chosen.text.to_lowercase());
                assert_eq!(
                    Some(&chosen),
                    choose(&semantics, &all, RandomKey::root(draw)).as_ref()
                );
            }
        }
    }
    assert!(texts > 300, "{texts}");
}

/// An agent whose feet are at `position`, with eyes towards `target`.
fn agent_towards(position: Vec3, target: Vec3) -> AgentState {
    let mut agent = AgentState::new(AgentBody::default(), position, 0.0);
    let way = target - agent.eye_position();
    agent.yaw_rad = dwell_scene::space::yaw_from_forward(way);
    agent.pitch_rad = dwell_scene::space::pitch_from_forward(way);
    agent
}

#[test]
fn going_to_a_room_succeeds_in_that_room_only() {
    let s = small_house();
    let semantics = Semantics::new(&s.house);
    let rays = RayScene::new(s.house.clone());
    let mut state = State::new(&s.house);
    state.agents.push(AgentState::new(
        AgentBody::default(),
        Vec3::new(1.0, 0.0, 5.0),
        0.0,
    ));
    let all = candidates(&semantics.scene(&state), InstructionKind::GoToRoom);
    let kitchen = all.iter().find(|i| i.goal.rooms == [s.kitchen]).unwrap();
    assert_eq!(kitchen.text, "Go to the kitchen.");
    let judge = |state: &State| kitchen.verify(&semantics.scene(state), &rays, AgentId(0));
    assert_eq!(judge(&state), InstructionProgress::Continue);
    assert_eq!(
        kitchen.verify_at_stop(&semantics.scene(&state), &rays, AgentId(0)),
        InstructionProgress::Failure
    );
    state.agents[AgentId(0)].position = Vec3::new(3.0, 0.0, 3.0);
    assert_eq!(judge(&state), InstructionProgress::Success);
    assert_eq!(
        kitchen.verify(&semantics.scene(&state), &rays, AgentId(7)),
        InstructionProgress::Failure
    );
}

#[test]
fn finding_needs_nearness_and_sight() {
    let s = small_house();
    let semantics = Semantics::new(&s.house);
    let mut rays = RayScene::new(s.house.clone());
    let mut state = State::new(&s.house);
    let fridge = s.house.object_bounds(&state, s.fridge).center();
    state
        .agents
        .push(agent_towards(Vec3::new(2.0, 0.0, 3.4), fridge));
    rays.update(&state);
    let all = candidates(&semantics.scene(&state), InstructionKind::FindObject);
    let find = all.iter().find(|i| i.goal.objects == [s.fridge]).unwrap();
    assert_eq!(find.text, "Find the refrigerator.");
    let judge = |state: &State| find.verify(&semantics.scene(state), &rays, AgentId(0));
    assert_eq!(judge(&state), InstructionProgress::Success);
    // Turned away.
    state.agents[AgentId(0)].yaw_rad += 2.0;
    assert_eq!(judge(&state), InstructionProgress::Continue);
    // Too far.
    state.agents[AgentId(0)] = agent_towards(Vec3::new(3.8, 0.0, 0.4), fridge);
    assert_eq!(judge(&state), InstructionProgress::Continue);
    // Near, but behind the wall: it stands in the hall, a step from the refrigerator.
    state.agents[AgentId(0)] = agent_towards(Vec3::new(0.4, 0.0, 4.6), fridge);
    assert_eq!(judge(&state), InstructionProgress::Continue);
    // In hand.
    state.agents[AgentId(0)].holding = Some(s.fridge);
    assert_eq!(judge(&state), InstructionProgress::Success);
    // Bound at reset: another colour of house changes nothing, the same thing counts.
    let bound: dwell_semantics::instruct::Instruction =
        serde_json::from_str(&serde_json::to_string(find).unwrap()).unwrap();
    assert_eq!(&bound, find);
}

#[test]
fn a_house_without_a_unique_thing_says_so() {
    let mut b = Builder::new("twins");
    b.room("", [0.0, 0.0], [8.0, 8.0]);
    let wood = b.material("wood", [150, 111, 72]);
    for x in [1.0, 5.0] {
        b.thing("stool", &[([x, 0.0, 1.0], [x + 0.4, 0.6, 1.4])], wood);
    }
    let house = b.build();
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let error = instruction(&scene, InstructionKind::FindObject, RandomKey::root(1)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "house \"twins\" offers no instruction of kind find_object: no object can be told from all others by words"
    );
}
