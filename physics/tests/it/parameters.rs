//! Parameters that change while a world runs.

use crate::common::{Build, Piece, Run};
use dwell_physics::PhysicsConfig;
use dwell_scene::{Address, ObjectId, State};
use glam::Vec3;

fn sled() -> (Run, ObjectId) {
    let mut build = Build::room_of([10.0, 3.0, 4.0], "parquet");
    let sled = build.movable(
        "sled",
        Piece::cuboid(Vec3::new(0.3, 0.1, 0.3), Vec3::new(1.0, 0.1, 2.0)),
    );
    let mut run = build.run();
    run.steps(30);
    (run, sled)
}

fn set(run: &mut Run, address: &str, value: f64) {
    let address: Address = address.parse().unwrap();
    run.state
        .set_parameter(&run.house, &address, value)
        .unwrap();
    run.world.apply_parameters(&mut run.state).unwrap();
}

fn slide(run: &mut Run, sled: ObjectId) -> f32 {
    let from = run.position(sled).x;
    run.throw(sled, Vec3::new(2.0, 0.0, 0.0));
    run.steps(60);
    run.position(sled).x - from
}

#[test]
fn friction_of_a_pair_takes_effect_at_once() {
    let (mut run, sled) = sled();
    for mu in [0.2, 0.8] {
        set(&mut run, "pair/parquet~wood/friction", mu);
        let expected = 4.0 / (2.0 * mu as f32 * crate::common::gravity());
        let found = slide(&mut run, sled);
        assert!(
            (found / expected - 1.0).abs() < 0.04,
            "{mu}: {found} expected {expected}"
        );
    }
    let before = set_and_slide(&mut run, sled, "material/floor/friction", 0.01);
    assert!(
        (before - 4.0 / (2.0 * 0.8 * crate::common::gravity())).abs() < 0.02,
        "a named pair goes before a material"
    );
}

fn set_and_slide(run: &mut Run, sled: ObjectId, address: &str, value: f64) -> f32 {
    set(run, address, value);
    slide(run, sled)
}

#[test]
fn gravity_wakes_what_sleeps() {
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let thing = build.movable(
        "thing",
        Piece::cuboid(Vec3::splat(0.1), Vec3::new(2.0, 0.1, 2.0)),
    );
    let mut run = build.run();
    run.steps(60);
    assert_eq!(run.world.awake_count(), 0);
    set(&mut run, "world/gravity_m_s2", 1.62);
    assert_eq!(run.world.awake_count(), 1);
    run.throw(thing, Vec3::new(0.0, 1.0, 0.0));
    run.steps(10);
    assert!(
        (run.velocity(thing).y - (1.0 - 1.62 * 0.5)).abs() < 0.01,
        "{}",
        run.velocity(thing).y
    );
}

/// The mass of an object decides how far an agent's bounded push takes it, and what it lifts.
#[test]
fn an_overridden_mass_is_what_it_weighs() {
    let (mut run, sled) = sled();
    let agent = run.agent(Vec3::new(1.0, 0.0, 3.0), 0.0);
    let told = |run: &mut Run| run.act(agent, dwell_physics::actions::Pick::new(sled));
    assert!(
        told(&mut run).sentence.contains("36.0 kg"),
        "{}",
        told(&mut run).sentence
    );
    let id = run.house.entity_of_object(sled).0;
    set(&mut run, &format!("object/{id}/mass_kg"), 2.0);
    let outcome = told(&mut run);
    assert!(outcome.success, "{}", outcome.sentence);
}

/// Half the density is half the mass; a part's own mass precedes its material's, and the whole object's precedes both.
#[test]
fn an_overridden_density_is_what_a_thing_weighs() {
    let (mut run, sled) = sled();
    let agent = run.agent(Vec3::new(1.0, 0.0, 3.0), 0.0);
    let weighs = |run: &mut Run, words: &str| {
        let told = run.act(agent, dwell_physics::actions::Pick::new(sled));
        assert!(told.sentence.contains(words), "{}", told.sentence);
    };
    let root = run.house.objects[sled].first_part;
    let material = &run.house.materials[run.house.parts[root].materials[0]];
    let (density, address) = (
        material.density_kg_m3,
        format!("material/{}/density_kg_m3", material.name),
    );
    let id = run.house.entity_of_object(sled).0;
    let object = format!("object/{id}/mass_kg");
    weighs(&mut run, "36.0 kg");
    set(&mut run, &address, 0.75 * f64::from(density));
    weighs(&mut run, "27.0 kg");
    let read = run.state.parameter(&run.house, &object.parse().unwrap());
    let stated = run.house.parts[root].mass_kg.unwrap_or(0.0);
    assert!((read.unwrap().value - f64::from(0.75 * stated)).abs() < 1e-3);
    if run.house.parts[root].mass_kg.is_some() {
        set(&mut run, &format!("part/{}/mass_kg", root.0), 31.0);
        weighs(&mut run, "31.0 kg");
    }
    set(&mut run, &object, 29.0);
    weighs(&mut run, "29.0 kg");
}

#[test]
fn applying_nothing_changes_nothing() {
    let (mut run, _) = sled();
    let before = run.hash();
    run.world.apply_parameters(&mut run.state).unwrap();
    assert!(before == run.hash());
    // And a world that starts with the overrides is the one that gets them at run time, as far as values go.
    let mut state = State::new(&run.house);
    let address: Address = "pair/parquet~wood/friction".parse().unwrap();
    state.set_parameter(&run.house, &address, 0.2).unwrap();
    let mut other = Run::from_state(run.house.clone(), PhysicsConfig::default(), state);
    let sled = ObjectId(0);
    other.steps(30);
    set(&mut run, "pair/parquet~wood/friction", 0.2);
    assert!((slide(&mut run, sled) - slide(&mut other, sled)).abs() < 1e-3);
}
