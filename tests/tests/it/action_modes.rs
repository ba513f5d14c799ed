//! Actions of environments in their forms: velocities, places in pictures, ids; and which are possible.

use dwell::{
    ActionMode, ActionTarget, Batch, DiscreteAction, Engines, Env, EnvConfig, SensorConfig,
    StepAction,
};
use dwell_physics::AgentPlacement;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, EntityId, ObjectId};
use glam::Vec3;
use std::sync::Arc;

fn config(task: &str) -> EnvConfig {
    EnvConfig {
        task: task.to_owned(),
        sensors: Some(vec![SensorConfig {
            kind: "depth".to_owned(),
            settings: serde_json::json!({"width": 64, "height": 48, "fov_deg": 80.0}),
        }]),
        ..EnvConfig::default()
    }
}

fn engines(house: &str) -> Arc<Engines> {
    let (house, _) = dwell_houses::open(house).unwrap_or_else(|error| panic!("{error}"));
    Engines::new(Arc::new(house))
}

fn env(house: &str, task: &str) -> Env {
    let made = Env::new(engines(house), &config(task)).and_then(|mut env| {
        env.reset(3)?;
        Ok(env)
    });
    made.unwrap_or_else(|error| panic!("{error}"))
}

/// A fair share of random play comes near things; there each action that the mask rules out fails when it is tried in a copy, and of
/// those that it allows most succeed.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn what_a_mask_rules_out_fails() {
    let (mut ruled_out, mut allowed, mut done) = (0, 0, 0);
    for house in ["builtin:apartment", "seed:900031"] {
        let mut env = env(house, "Free");
        let mut trial = Env::new(env.world().engines().clone(), &config("Free")).unwrap();
        let mut stream = RandomKey::root(8).child(house).stream();
        for step in 0..if dwell_tests::runs_all() { 120 } else { 48 } {
            let object = ObjectId(stream.below(env.world().house().objects.len()) as u32);
            if step % 4 == 0 {
                stand_before(
                    &mut env,
                    object,
                    stream.range(0.5, 1.4),
                    stream.range(-3.1, 3.1),
                );
            }
            let mask = env.action_masks().unwrap()[0];
            let saved = env.snapshot().unwrap();
            for (possible, action) in mask.iter().zip(DiscreteAction::ALL) {
                if !action.kind().is_hand_action() {
                    assert!(possible, "{action:?}");
                    continue;
                }
                // Every sixth of those that are ruled out, to save time.
                if !possible && stream.below(6) > 0 {
                    continue;
                }
                trial.restore(&saved).unwrap();
                let info = &trial.step(&[Some(action)]).unwrap()[0];
                if *possible {
                    allowed += 1;
                    done += u32::from(info.action_success);
                } else {
                    ruled_out += 1;
                    assert!(!info.action_success, "{house} step {step}: {action:?}");
                    assert!(!info.action_error.is_empty());
                }
            }
            let hands: Vec<DiscreteAction> = DiscreteAction::ALL
                .into_iter()
                .zip(mask)
                .filter(|(action, on)| *on && *action != DiscreteAction::Stop)
                .map(|(action, _)| action)
                .collect();
            let action = hands[stream.below(hands.len())];
            env.step(&[Some(action)]).unwrap();
        }
    }
    assert!(ruled_out > 100 && allowed > 60, "{ruled_out} {allowed}");
    assert!(
        f64::from(done) > 0.7 * f64::from(allowed),
        "{done} of {allowed}"
    );
}

/// Puts the agent at a distance from a thing, looking at it.
fn stand_before(env: &mut Env, object: ObjectId, apart_m: f32, around_rad: f32) {
    let world = env.world_mut();
    let middle = world.house().object_bounds(world.state(), object).center();
    let feet = middle.with_y(0.0) + apart_m * Vec3::new(around_rad.sin(), 0.0, around_rad.cos());
    let eye_m = world.state().agents[AgentId(0)].body.eye_height_m;
    let placement = AgentPlacement {
        agent: AgentId(0),
        position: feet,
        yaw_rad: around_rad,
        pitch_rad: ((middle.y - eye_m) / apart_m).atan().clamp(-1.4, 1.4),
        velocity: Vec3::ZERO,
        yaw_rate_rad_s: 0.0,
        crouched_by_m: 0.0,
        wheel_rad_s: None,
    };
    if let Err(error) = world.set_agents(&[placement]) {
        panic!("{error}");
    }
}

/// Velocities at their ends are the movement actions, to the bit; halves go half as far.
#[test]
fn velocities_are_shares_of_what_actions_make() {
    let ends = [
        (DiscreteAction::MoveForward, [1.0, 0.0, 0.0, 0.0]),
        (DiscreteAction::TurnLeft, [0.0, 0.0, 1.0, 0.0]),
        (DiscreteAction::TurnRight, [0.0, 0.0, -1.0, 0.0]),
        (DiscreteAction::LookUp, [0.0, 0.0, 0.0, 1.0]),
        (DiscreteAction::LookDown, [0.0, 0.0, 0.0, -1.0]),
    ];
    let by = |velocity| StepAction {
        velocity: Some(velocity),
        ..DiscreteAction::Wait.into()
    };
    for (action, velocity) in ends {
        let mut one = env("builtin:studio", "Free");
        let mut other = env("builtin:studio", "Free");
        one.step(&[Some(action)]).unwrap();
        other.step(&[Some(by(velocity))]).unwrap();
        assert_eq!(one.world().hash(), other.world().hash(), "{action:?}");
    }
    let mut env = env("builtin:studio", "Free");
    let before = env.world().state().agents[AgentId(0)];
    env.step(&[Some(by([0.0, 0.0, 0.5, 0.25]))]).unwrap();
    let after = env.world().state().agents[AgentId(0)];
    let turn_deg = (after.yaw_rad - before.yaw_rad).to_degrees();
    let look_deg = (after.pitch_rad - before.pitch_rad).to_degrees();
    assert!((turn_deg - 4.5).abs() < 1e-3, "{turn_deg}");
    assert!((look_deg - 2.25).abs() < 1e-3, "{look_deg}");
    for wrong in [[1.5, 0.0, 0.0, 0.0], [0.0, f32::NAN, 0.0, 0.0]] {
        let error = env.step(&[Some(by(wrong))]).unwrap_err().to_string();
        assert!(
            error.contains("velocity is") && error.contains("-1 to 1"),
            "{error}"
        );
    }
}

/// The middle of the picture is what one looks at; another place means what the depth camera shows there; an id means its thing.
#[test]
fn hands_take_what_places_of_pictures_and_ids_mean() {
    let mut env = env("builtin:apartment", "Free");
    let house = env.world().house().clone();
    let lamp = house
        .objects
        .ids()
        .find(|id| house.objects[*id].switch.is_some())
        .unwrap();
    // From some side one reaches its switch.
    let toggle = DiscreteAction::ALL
        .iter()
        .position(|action| *action == DiscreteAction::Toggle)
        .unwrap();
    let reached = (0..24).any(|side| {
        stand_before(&mut env, lamp, 0.8, 0.26 * side as f32);
        env.action_masks().unwrap()[0][toggle]
    });
    assert!(reached);
    let saved = env.snapshot().unwrap();
    let mut told = |action: StepAction| {
        env.restore(&saved).unwrap();
        let info = env.step(&[Some(action)]).unwrap().remove(0);
        (info.action_success, info.action_error, env.world().hash())
    };
    let on = |target| StepAction {
        target,
        ..DiscreteAction::Toggle.into()
    };
    let looked = told(DiscreteAction::Toggle.into());
    assert_eq!(told(on(ActionTarget::Picture([0.5, 0.5]))), looked);
    let id = house.entity_of_object(lamp);
    assert_eq!(told(on(ActionTarget::Entity(id))), looked);
    assert!(looked.0, "{}", looked.1);
    let (done, error, _) = told(on(ActionTarget::Entity(EntityId(i32::MAX))));
    assert!(!done && !error.is_empty());
    let (done, _, _) = told(on(ActionTarget::Picture([0.0, 0.0])));
    assert!(!done);
    let outside = Some(on(ActionTarget::Picture([1.2, 0.0])));
    let error = env.step(&[outside]).unwrap_err().to_string();
    assert!(error.contains("pixel is [1.2, 0.0]"), "{error}");
}

/// What is in the hand is looked past: with it before its eyes an agent switches the lamp that it looks at.
#[test]
fn a_full_hand_does_not_hide_what_is_looked_at() {
    let mut env = env("builtin:apartment", "Free");
    let house = env.world().house().clone();
    let me = AgentId(0);
    let held: Vec<ObjectId> = (house.objects.ids())
        .filter(|id| house.objects[*id].pickable)
        .filter(|id| {
            let size = house.object_bounds(env.world().state(), *id).size();
            size.y > 0.2 && size.max_element() < 0.5
        })
        .collect();
    let lamps = house.objects.ids();
    let lamps: Vec<ObjectId> = lamps
        .filter(|id| house.objects[*id].switch.is_some())
        .collect();
    let start = env.snapshot().unwrap();
    let (mut hidden, mut switched) = (0, 0);
    for thing in held.into_iter().take(3) {
        for side in 0..12 {
            env.restore(&start).unwrap();
            stand_before(&mut env, thing, 0.8, 0.52 * side as f32);
            env.step(&[Some(DiscreteAction::Pick)]).unwrap();
            if env.world().state().agents[me].holding == Some(thing) {
                break;
            }
        }
        if env.world().state().agents[me].holding != Some(thing) {
            continue;
        }
        let carrying = env.snapshot().unwrap();
        for (lamp, side) in lamps
            .iter()
            .flat_map(|lamp| (0..12).map(move |side| (*lamp, side)))
        {
            if hidden >= 6 && switched >= 1 {
                return;
            }
            env.restore(&carrying).unwrap();
            stand_before(&mut env, lamp, 1.0, 0.52 * side as f32);
            let world = env.world();
            let agent = &world.state().agents[me];
            let eye = agent.world_from_eye();
            let ray = Ray::new(eye.position, eye.transform_vector(Vec3::NEG_Z));
            let hit = world.rays().closest(&ray, RayMask::EYE);
            let entity = hit.map(|hit| world.rays().surface(&hit).entity);
            let before_eyes = entity == Some(house.entity_of_object(thing));
            if agent.holding != Some(thing)
                || !before_eyes
                || world.object_in_view_centre(me) != Some(lamp)
            {
                continue;
            }
            hidden += 1;
            let info = env.step(&[Some(DiscreteAction::Toggle)]).unwrap();
            switched += u32::from(info[0].action_success);
            if !info[0].action_success {
                assert!(
                    !info[0].action_error.contains("hold"),
                    "{}",
                    info[0].action_error
                );
            }
        }
    }
    panic!("{switched} of {hidden} were switched");
}

/// Without a hand to open them, doors stand open when an episode begins, and the expert arrives without one.
#[test]
fn without_an_action_that_opens_all_doors_stand_open() {
    let mut config = config("PointNav");
    config.actions = Some(
        ["stop", "move_forward", "turn_left", "turn_right"]
            .map(str::to_owned)
            .to_vec(),
    );
    let engines = engines("builtin:apartment");
    let mut env = Env::new(engines.clone(), &config).unwrap();
    let mut closed = Env::new(engines, &self::config("PointNav")).unwrap();
    let openness = |env: &Env| {
        let house = env.world().house();
        let grid = env
            .world()
            .engines()
            .nav_grid(&env.world().state().agents[AgentId(0)].body)
            .unwrap();
        let state = env.world().state();
        let of = |joint| house.joints[joint].openness(state.joint_position[joint]);
        grid.doors()
            .iter()
            .map(|door| of(door.joint))
            .collect::<Vec<f32>>()
    };
    for seed in 0..4 {
        env.reset(seed).unwrap();
        closed.reset(seed).unwrap();
        let open = openness(&env);
        assert!(
            !open.is_empty() && open.iter().all(|share| *share > 0.9),
            "{open:?}"
        );
        assert!(openness(&closed).iter().any(|share| *share < 0.5));
        let mut success = false;
        for _ in 0..600 {
            let action = env.expert_action(0).unwrap();
            assert!(!action.kind().is_hand_action(), "{action:?}");
            let info = &env.step(&[Some(action)]).unwrap()[0];
            if info.result.terminated {
                success = info.result.success;
                break;
            }
        }
        assert!(success, "seed {seed}");
    }
}

#[test]
fn actions_to_choose_from_are_checked() {
    let chosen = |mode, names: Option<&[&str]>| {
        let config = EnvConfig {
            action_mode: mode,
            actions: names.map(|names| names.iter().map(|name| (*name).to_owned()).collect()),
            ..EnvConfig::default()
        };
        config.chosen_actions(0).map_err(|error| error.to_string())
    };
    assert_eq!(chosen(ActionMode::Discrete, None).unwrap().len(), 12);
    assert_eq!(chosen(ActionMode::Pointer, None).unwrap().len(), 18);
    let some = chosen(ActionMode::Discrete, Some(&["wait", "throw"])).unwrap();
    assert_eq!(some, [DiscreteAction::Wait, DiscreteAction::Throw]);
    for (mode, names, part) in [
        (ActionMode::Discrete, &["fly"][..], "fly"),
        (ActionMode::Discrete, &[][..], "at least one"),
        (ActionMode::Dict, &["wait", "wait"][..], "wait twice"),
        (ActionMode::Velocity, &["wait"][..], "velocities are all"),
    ] {
        let error = chosen(mode, Some(names)).unwrap_err();
        assert!(error.contains(part), "{error}");
    }
}

/// Batches take all forms at once, and give the bits of a single environment.
#[test]
fn a_batch_takes_what_an_environment_takes() {
    let mut single = env("builtin:studio", "Free");
    let mut batch = Batch::new(
        vec![env("builtin:studio", "Free"), env("builtin:studio", "Free")],
        Threads::ONE,
    )
    .unwrap();
    let action = StepAction {
        velocity: Some([0.5, -0.5, 0.2, -0.1]),
        target: ActionTarget::Picture([0.4, 0.6]),
        ..DiscreteAction::Push.into()
    };
    for _ in 0..5 {
        single.step(&[Some(action)]).unwrap();
        batch.step(&[Some(action), Some(action)]).unwrap();
    }
    for env in batch.envs() {
        assert_eq!(env.world().hash(), single.world().hash());
    }
}
