//! Several agents act in one environment, at once and at one clock.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use dwell::DiscreteAction::{MoveForward, Stop, TurnLeft, TurnRight, Wait};
use dwell::{
    AgentConfig, Batch, DiscreteAction, Env, EnvConfig, SensorConfig, StepInfo, WorldConfig,
};
use dwell_scene::parallel::Threads;
use dwell_scene::{AgentBody, AgentId, LawSpec};
use dwell_tests::observations::observe;
use serde_json::{Value, json};

/// Sensors of an agent's position and motion.
const OWN: [&str; 4] = ["gps", "compass", "gyro", "proprioception"];

fn sensors(rows: &[(&str, Value)]) -> Vec<SensorConfig> {
    let sensor = |(kind, settings): &(&str, Value)| SensorConfig {
        kind: (*kind).to_owned(),
        settings: settings.clone(),
    };
    rows.iter().map(sensor).collect()
}

fn own_sensors() -> Vec<SensorConfig> {
    sensors(&OWN.map(|kind| (kind, Value::Null)))
}

fn acting(agent: u32) -> AgentConfig {
    AgentConfig {
        agent,
        ..AgentConfig::default()
    }
}

/// An environment of the apartment with two bodies, in which `agents` act, in this order.
fn env(agents: Vec<AgentConfig>, sensors: Vec<SensorConfig>) -> Env {
    let noise = LawSpec {
        id: "shot_read_noise".to_owned(),
        version: 1,
        target: None,
        params: [("gain".to_owned(), 0.002), ("read".to_owned(), 0.01)]
            .into_iter()
            .collect(),
    };
    let config = EnvConfig {
        task: "Free".to_owned(),
        task_settings: json!({"start": "anywhere"}),
        world: WorldConfig {
            agents: vec![AgentBody::default(); 2],
            laws: vec![noise],
            ..WorldConfig::default()
        },
        sensors: Some(sensors),
        agents,
        ..EnvConfig::default()
    };
    Env::new(dwell_tests::apartment(), &config).unwrap()
}

fn batch(env: Env) -> Batch {
    Batch::new(vec![env], Threads::new(2)).unwrap()
}

/// Returns the observations of each agent of a batch of one environment, in order. Shape (agent,) of (sensor,).
fn seen(batch: &mut Batch) -> Vec<Vec<Vec<u8>>> {
    let mut by_agent = vec![Vec::new(); batch.acting_agents().len()];
    for (agent, bits) in batch.sensor_agents().into_iter().zip(observe(batch)) {
        by_agent[agent].push(bits);
    }
    by_agent
}

/// Plays actions of shape (step, agent): after each the agents' infos, and what they observe.
type Moment = (Vec<StepInfo>, Vec<Vec<Vec<u8>>>);

fn play(batch: &mut Batch, actions: &[Vec<DiscreteAction>]) -> Vec<Moment> {
    let step = |actions: &Vec<DiscreteAction>| {
        let actions: Vec<_> = actions.iter().copied().map(Some).collect();
        let infos = batch.step(&actions).unwrap();
        (infos.into_iter().flatten().collect(), seen(batch))
    };
    actions.iter().map(step).collect()
}

/// A seed for which two agents start in different rooms.
const SEED: u64 = 4;
const FIRST: [DiscreteAction; 6] = [
    TurnLeft,
    MoveForward,
    MoveForward,
    TurnRight,
    MoveForward,
    Wait,
];
const SECOND: [DiscreteAction; 6] = [
    MoveForward,
    TurnRight,
    TurnRight,
    MoveForward,
    TurnLeft,
    TurnLeft,
];

fn both(first: &[DiscreteAction], second: &[DiscreteAction]) -> Vec<Vec<DiscreteAction>> {
    let pairs = first.iter().zip(second);
    pairs.map(|(first, second)| vec![*first, *second]).collect()
}

/// Listed the other way round, the same world runs, and rows change their places.
#[test]
fn the_order_of_agents_permutes_what_they_get_and_nothing_else() {
    let sensors = || {
        let small = json!({"width": 16, "height": 12});
        let mut all = own_sensors();
        all.extend(self::sensors(&[("rgb", small.clone()), ("depth", small)]));
        all
    };
    let mut forth = batch(env(vec![acting(0), acting(1)], sensors()));
    let mut back = batch(env(vec![acting(1), acting(0)], sensors()));
    forth.reset(&[Some(SEED)]).unwrap();
    back.reset(&[Some(SEED)]).unwrap();
    let forth_moments = play(&mut forth, &both(&FIRST, &SECOND));
    let mut back_moments = play(&mut back, &both(&SECOND, &FIRST));
    for (infos, seen) in &mut back_moments {
        infos.reverse();
        seen.reverse();
    }
    for (step, (forth, back)) in forth_moments.iter().zip(&back_moments).enumerate() {
        assert_eq!(forth.0, back.0, "step {step}");
        for (agent, (forth, back)) in forth.1.iter().zip(&back.1).enumerate() {
            for (sensor, (forth, back)) in forth.iter().zip(back).enumerate() {
                assert!(forth == back, "step {step}, agent {agent}, sensor {sensor}");
            }
        }
    }
    assert_eq!(
        forth.envs()[0].world().hash(),
        back.envs()[0].world().hash()
    );
    // Agents of different streams see different noise, and begin elsewhere.
    let [first, second] = forth_moments[0].1.clone().try_into().unwrap();
    assert_ne!(first[4], second[4]);
}

/// Two agents that exchange places and actions exchange their results.
#[test]
fn exchanged_agents_get_exchanged_results() {
    let mut batch = batch(env(vec![acting(0), acting(1)], own_sensors()));
    batch.reset(&[Some(SEED)]).unwrap();
    let agents = &batch.envs()[0].world().state().agents;
    let places = [0, 1].map(|k| (agents[AgentId(k)].position, agents[AgentId(k)].yaw_rad));
    assert!((places[0].0 - places[1].0).length() > 3.0);
    let mut run = |places: [(glam::Vec3, f32); 2], actions: &[Vec<DiscreteAction>]| {
        batch.reset(&[Some(SEED)]).unwrap();
        let env = batch.env_mut(0).unwrap();
        for (k, (position, yaw_rad)) in places.into_iter().enumerate() {
            let agent = AgentId(k as u32);
            env.world_mut()
                .place_agent(agent, position, yaw_rad)
                .unwrap();
        }
        for agent in 0..2 {
            env.set_goal(agent, None).unwrap();
        }
        play(&mut batch, actions)
    };
    let straight = run(places, &both(&FIRST, &SECOND));
    let crossed = run([places[1], places[0]], &both(&SECOND, &FIRST));
    for ((infos, seen), (other_infos, other_seen)) in straight.iter().zip(&crossed) {
        for k in 0..2 {
            assert_eq!(seen[k], other_seen[1 - k]);
            assert_eq!(infos[k].progress, other_infos[1 - k].progress);
            assert_eq!(infos[k].collision, other_infos[1 - k].collision);
        }
    }
}

/// Beside one that stands far away, an agent gets the bits that it gets where it alone acts: its starts and noise are its own.
#[test]
fn an_agent_in_company_gets_what_it_gets_alone() {
    for (agent, own) in [(0, FIRST), (1, SECOND)] {
        let mut alone = batch(env(vec![acting(agent)], own_sensors()));
        alone.reset(&[Some(SEED)]).unwrap();
        let actions: Vec<_> = own.iter().map(|action| vec![*action]).collect();
        let alone = play(&mut alone, &actions);
        let mut company = batch(env(vec![acting(0), acting(1)], own_sensors()));
        company.reset(&[Some(SEED)]).unwrap();
        let waits = [Wait; 6];
        let actions = match agent {
            0 => both(&own, &waits),
            _ => both(&waits, &own),
        };
        let company = play(&mut company, &actions);
        let place = agent as usize;
        for ((infos, seen), (all_infos, all_seen)) in alone.iter().zip(&company) {
            assert_eq!(infos[0], all_infos[place]);
            assert_eq!(seen[0], all_seen[place]);
        }
    }
}

/// The one agent by default is agent 0; the others of its world stand still.
#[test]
fn an_environment_is_about_the_agents_that_it_lists() {
    let mut unsaid = batch(env(EnvConfig::default().agents, own_sensors()));
    let mut said = batch(env(vec![acting(0)], own_sensors()));
    let actions: Vec<_> = FIRST.iter().map(|action| vec![*action]).collect();
    unsaid.reset(&[Some(SEED)]).unwrap();
    said.reset(&[Some(SEED)]).unwrap();
    assert!(play(&mut unsaid, &actions) == play(&mut said, &actions));

    for agent in [0, 1] {
        let other = 1 - agent;
        let rows = [
            ("compass", Value::Null),
            ("gps", json!({"name": "other_gps", "agent": other})),
            ("compass", json!({"name": "other_compass", "agent": other})),
        ];
        let mut batch = batch(env(vec![acting(agent)], sensors(&rows)));
        batch.reset(&[Some(3)]).unwrap();
        let before = batch.envs()[0].world().state().agents[AgentId(other)].position;
        let moments = play(&mut batch, &[vec![TurnLeft], vec![MoveForward]]);
        assert_eq!(moments[1].0[0].agent, AgentId(agent));
        let state = batch.envs()[0].world().state();
        assert!((state.agents[AgentId(other)].position - before).length() < 1e-3);
        let numbers = moments[1].1[0].iter().map(|bits| {
            let numbers = bits.chunks_exact(4);
            let number = |bits: &[u8]| f32::from_le_bytes(bits.try_into().unwrap());
            numbers.map(number).collect::<Vec<_>>()
        });
        let [own, gps, compass] = numbers.collect::<Vec<_>>().try_into().unwrap();
        assert!((own[0] - 9_f32.to_radians()).abs() < 1e-3);
        assert!(gps.iter().all(|way| way.abs() < 1e-3) && compass[0].abs() < 1e-6);
    }
}

/// Each has its own task and sensors; what an agent is asked is its own.
#[test]
fn agents_have_tasks_and_sensors_of_their_own() {
    let follower = AgentConfig {
        task: Some("InstructionFollowing".to_owned()),
        sensors: Some(sensors(&[
            ("instruction", Value::Null),
            ("gps", Value::Null),
        ])),
        ..acting(1)
    };
    let mut batch = batch(env(vec![acting(0), follower], own_sensors()));
    let names: Vec<String> = batch
        .sensor_specs()
        .into_iter()
        .map(|spec| spec.name)
        .collect();
    assert_eq!(
        names,
        [&OWN[..], &["instruction", "gps"]].concat(),
        "those of the first agent, then of the second"
    );
    assert_eq!(batch.sensor_agents(), [0, 0, 0, 0, 1, 1]);
    batch.reset(&[Some(SEED)]).unwrap();
    let env = &batch.envs()[0];
    assert_eq!(env.episode(0).unwrap().instruction, "Explore.");
    let asked = env.episode(1).unwrap().instruction.clone();
    assert_ne!(asked, "Explore.");
    assert_eq!(batch.text_observations(4), [asked]);
    assert!(batch.envs()[0].episode(2).is_err());
    let experts = batch.expert_actions().unwrap();
    assert_eq!((experts.len(), experts[0]), (2, Stop));
    let infos = batch.step(&[Some(Wait), Some(Wait)]).unwrap();
    let distances = infos.iter().flatten().map(|info| info.progress.distance_m);
    let [free, following] = distances.collect::<Vec<_>>().try_into().unwrap();
    assert!(free.is_none() && following.is_some());
}

/// An agent whose episode has ended stands still, gets no more reward, and goes on observing; the other plays on.
#[test]
fn one_agent_may_end_before_the_other() {
    let rows = [
        ("gps", Value::Null),
        ("compass", json!({"name": "other", "agent": 0})),
    ];
    let mut batch = batch(env(vec![acting(0), acting(1)], sensors(&rows)));
    batch.reset(&[Some(SEED)]).unwrap();
    let first = play(&mut batch, &[vec![TurnLeft, Stop]]);
    let [going, ended] = first[0].0.clone().try_into().unwrap();
    assert!(!going.result.terminated && ended.result.terminated);
    // Whatever its action is, or none.
    let hash = |actions: &[Option<DiscreteAction>]| {
        let saved = batch.env(0).unwrap().snapshot().unwrap();
        let infos = batch.step(actions).unwrap();
        let after = (infos, seen(&mut batch), batch.envs()[0].world().hash());
        batch.restore(0, &saved).unwrap();
        after
    };
    let mut hash = hash;
    let none = hash(&[Some(TurnLeft), None]);
    assert!(none == hash(&[Some(TurnLeft), Some(MoveForward)]));
    let rest = none.0[1].clone().unwrap();
    assert_eq!((rest.agent, rest.result.reward), (AgentId(1), 0.0));
    assert!(rest.result.terminated && !rest.action_success);
    assert_eq!(rest.action_error, "Its episode has ended.");
    assert_eq!(rest.progress, ended.progress);
    // It stands where it was, and sees the other turn.
    assert_eq!(none.1[1][0], first[0].1[1][0]);
    assert_ne!(none.1[1][1], first[0].1[1][1]);

    let refused = |batch: &mut Batch, actions: &[Option<DiscreteAction>]| {
        let before = batch.envs()[0].world().hash();
        let told = batch.step(actions).unwrap_err().to_string();
        assert_eq!(batch.envs()[0].world().hash(), before);
        told
    };
    assert_eq!(
        refused(&mut batch, &[None, Some(MoveForward)]),
        "step: no action for agent 0, whose episode goes on"
    );
    assert_eq!(
        refused(&mut batch, &[Some(Wait)]),
        "actions: expected one for each of 2 agents in each of 1 environments, found 1"
    );
    batch.step(&[Some(Stop), None]).unwrap();
    assert_eq!(
        refused(&mut batch, &[Some(Wait), Some(Wait)]),
        "step: the episode has ended; call reset first"
    );
    batch.reset(&[Some(SEED)]).unwrap();
    batch.step(&[Some(Wait), Some(Wait)]).unwrap();
}

/// A snapshot of two agents, of whom one has ended, goes on bit for bit, in company and on any number of threads.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn episodes_of_two_go_on_from_snapshots_on_any_number_of_threads() {
    let make = || {
        let small = json!({"width": 16, "height": 12});
        let mut all = own_sensors();
        all.extend(sensors(&[("rgb", small), ("audio", Value::Null)]));
        env(vec![acting(0), acting(1)], all)
    };
    let actions = |k: usize, ended: bool| [Some(FIRST[k]), (!ended).then_some(SECOND[k])];
    let mut alone = Batch::new(vec![make()], Threads::ONE).unwrap();
    alone.reset(&[Some(SEED)]).unwrap();
    for k in 0..2 {
        alone.step(&actions(k, false)).unwrap();
    }
    alone.step(&[Some(FIRST[2]), Some(Stop)]).unwrap();
    let saved = alone.env(0).unwrap().snapshot().unwrap();
    let rest = |batch: &mut Batch, place: usize| {
        let count = batch.envs().len();
        let mut seen = Vec::new();
        for k in 3..6 {
            let mut all = vec![None; 2 * count];
            all[2 * place..2 * place + 2].copy_from_slice(&actions(k, true));
            let infos = batch.step(&all).unwrap();
            assert!((0..2 * count).all(|row| infos[row].is_some() == (row / 2 == place)));
            let own = observe(batch).into_iter().map(|bits| {
                let one = bits.len() / count;
                bits[place * one..(place + 1) * one].to_vec()
            });
            let own: Vec<Vec<u8>> = own.collect();
            let infos: Vec<StepInfo> = infos.into_iter().flatten().collect();
            seen.push((infos, own, batch.envs()[place].world().hash()));
        }
        seen
    };
    let expected = rest(&mut alone, 0);
    for threads in [2, 7] {
        let mut company = Batch::new(vec![make(), make(), make()], Threads::new(threads)).unwrap();
        company.reset(&[Some(7), Some(8), Some(9)]).unwrap();
        company.restore(1, &saved).unwrap();
        assert!(rest(&mut company, 1) == expected, "{threads} threads");
    }
    // Environments of other agents refuse it.
    let mut one = env(vec![acting(0)], own_sensors());
    assert!(one.restore(&saved).is_err() && !one.has_episode());
    let mut turned = env(vec![acting(1), acting(0)], own_sensors());
    let told = turned.restore(&saved).unwrap_err().to_string();
    assert!(told.contains("agent 0 acts in it where agent 1"), "{told}");
    assert!(Batch::new(vec![make(), turned], Threads::ONE).is_err());
}

#[test]
fn starts_that_are_drawn_keep_clear_of_each_other() {
    let (house, _) = dwell_houses::open("builtin:studio").unwrap();
    let engines = dwell::Engines::new(std::sync::Arc::new(house));
    let config = EnvConfig {
        task: "Free".to_owned(),
        task_settings: json!({"start": "anywhere"}),
        world: WorldConfig {
            agents: vec![AgentBody::default(); 4],
            ..WorldConfig::default()
        },
        sensors: Some(Vec::new()),
        agents: (0..4).map(acting).collect(),
        ..EnvConfig::default()
    };
    let mut env = Env::new(engines, &config).unwrap();
    let apart_m = 2.0 * AgentBody::default().radius_m;
    for seed in 0..40 {
        env.reset(seed).unwrap();
        let agents = &env.world().state().agents;
        let at: Vec<_> = agents.iter().map(|agent| agent.position).collect();
        for (k, one) in at.iter().enumerate() {
            assert!(at[..k].iter().all(|other| one.distance(*other) > apart_m));
        }
    }
}
