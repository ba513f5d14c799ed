//! Surfaces of the things of generated houses: none coincide where they can be seen.

use dwell_furniture::testing::coincident::{coincidences, object_facets};
use dwell_scene::parallel::Threads;

#[test]
fn no_two_visible_surfaces_of_a_thing_coincide() {
    let seeds: Vec<String> = (1..9).map(|k| format!("seed:{k}")).collect();
    let faults = Threads::default().map(seeds.len(), |k| {
        let house = dwell_houses::open(&seeds[k]).unwrap().0;
        let mut faults = Vec::new();
        for (id, object) in house.objects.iter_ids() {
            for one in coincidences(&object_facets(&house, id)) {
                let [p, q] = one.materials.map(|k| &house.materials.as_slice()[k].name);
                faults.push(format!(
                    "{}, {}: {p} and {q}: {:.1} cm² at {}, facing {}",
                    seeds[k],
                    object.name,
                    one.area_m2 * 1e4,
                    one.place,
                    one.normal
                ));
            }
        }
        faults
    });
    let faults = faults.concat();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
