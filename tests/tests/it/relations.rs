//! On and in: what physics says from contacts agrees with what words say from geometry.

use dwell::{World, WorldConfig};
use dwell_scene::{Mobility, ObjectId};
use dwell_semantics::Term;

/// Everything loose in the apartment, after it has stood for a second.
#[test]
fn physics_and_words_agree_on_what_rests_on_what() {
    let mut world = World::new(dwell_tests::apartment(), &WorldConfig::default()).unwrap();
    for _ in 0..20 {
        world.step(&[]).unwrap();
    }
    let engines = world.engines().clone();
    let (house, state) = (engines.house(), world.state());
    let scene = engines.semantics().scene(state);
    let on = dwell_semantics::predicates::find("on").unwrap();
    let inside = dwell_semantics::predicates::find("in").unwrap();
    let loose: Vec<ObjectId> = house
        .objects
        .iter_ids()
        .filter(|(_, object)| object.mobility == Mobility::Movable)
        .map(|(id, _)| id)
        .collect();
    let name = |id: ObjectId| &house.objects[id].name;
    let (mut same, mut other) = (0, Vec::new());
    for thing in &loose {
        let mut felt = state.supports_of(house, *thing);
        felt.sort_unstable();
        let own = Term::Object(*thing);
        let is_in = |by: &ObjectId| {
            inside
                .holds(&scene, &[own, Term::Object(*by)], None)
                .is_true()
        };
        let carries = |by: &ObjectId| {
            let rests = |by: Term| {
                let mut supports = scene.supporting_surfaces(*thing).iter();
                supports.any(|support| support.by == by && support.share * 3.0 >= 1.0)
            };
            // What lies in a bowl is in it, not on it.
            let by_words = on.holds(&scene, &[own, Term::Object(*by)], None).is_true();
            by_words || (is_in(by) && rests(Term::Object(*by)))
        };
        let mut said: Vec<Option<ObjectId>> =
            house.objects.ids().filter(carries).map(Some).collect();
        let floor = house.structure.ids().any(|piece| {
            on.holds(&scene, &[own, Term::Structure(piece)], None)
                .is_true()
        });
        said.extend(floor.then_some(None));
        said.sort_unstable();
        if felt == said {
            same += 1;
        } else {
            let names = |ids: &[Option<ObjectId>]| -> Vec<String> {
                let one =
                    |id: &Option<ObjectId>| id.map_or("building".to_owned(), |id| name(id).clone());
                ids.iter().map(one).collect()
            };
            other.push(format!(
                "{}: felt on {:?}, said on {:?}",
                name(*thing),
                names(&felt),
                names(&said)
            ));
        }
        // In is one definition, asked in two ways; of seats words say on.
        let lain_upon = |id: &ObjectId| {
            let row = scene.facts(*id).category;
            row.is_some_and(|row| ["chair", "sofa", "bed"].contains(&row.nyu40_name))
        };
        let mut felt_in = state.containers_of(house, *thing, &house.object_boxes(state));
        felt_in.retain(|container| !lain_upon(container));
        let mut said_in: Vec<ObjectId> = house.objects.ids().filter(is_in).collect();
        said_in.retain(|container| !lain_upon(container));
        assert_eq!(felt_in, said_in, "{}", name(*thing));
    }
    println!("{same} of {} alike; others: {other:#?}", loose.len());
    // Words count a third of the sole; a contact may be less, and a thing may lean on a neighbour.
    assert!(same * 50 >= loose.len() * 49, "{other:#?}");
}
