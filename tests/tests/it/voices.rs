//! What agents say is sound: it is located, delayed and masked like any sound, and understood as its level allows.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use dwell::{
    Engines, HeardToken, Listener, MountedReceiver, PlayRequest, SoundName, SoundPlace, Utterance,
    VocalEffort, World, WorldConfig,
};
use dwell_acoustics::{
    AcousticConfig, AcousticScene, Microphone, Receiver, ReceiverKind, SoundSourcePose,
};
use dwell_houses::authoring::{FileAccess, HousePlan, build};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentBody, AgentId, Bands, House, Pose, ShoeboxMaterials};
use glam::Vec3;
use serde_json::json;
use std::sync::Arc;

const SPEAKER: AgentId = AgentId(0);
const LISTENER: AgentId = AgentId(1);

fn engines(house: House) -> Arc<Engines> {
    Engines::new(Arc::new(house))
}

/// A room of 8 by 3 by 8 m with walls that absorb.
fn room() -> Arc<Engines> {
    engines(House::shoebox([8.0, 3.0, 8.0], &ShoeboxMaterials::default()).unwrap())
}

/// A world in which the listener listens; both where they are told, looking along their yaw.
fn world(engines: &Arc<Engines>, places: [(Vec3, f32); 2], config: WorldConfig) -> World {
    let config = WorldConfig {
        agents: vec![AgentBody::default(); 2],
        ..config
    };
    let mut world = World::new(engines.clone(), &config).unwrap();
    world.reset(RandomKey::root(3)).unwrap();
    for (k, (position, yaw_rad)) in places.into_iter().enumerate() {
        let agent = AgentId(k as u32);
        world.place_agent(agent, position, yaw_rad).unwrap();
    }
    let block = world.config().samples_per_step();
    world.enable_listeners(&[(LISTENER, block)]).unwrap();
    world
}

fn said(tokens: &[u32], effort: VocalEffort) -> Utterance {
    Utterance {
        tokens: tokens.to_vec(),
        effort,
    }
}

/// Steps until nothing more can arrive; what the listener heard, with the step in which it did.
fn listen(world: &mut World) -> Vec<(usize, HeardToken)> {
    let mut all = Vec::new();
    for step in 1..=120 {
        world.step(&[]).unwrap();
        let heard = world.heard_tokens(LISTENER).into_iter().cloned();
        all.extend(heard.map(|token| (step, token)));
    }
    all
}

/// Facing each other at 3 m in a quiet room.
const FACING: [(Vec3, f32); 2] = [
    (Vec3::new(4.0, 0.0, 2.5), std::f32::consts::PI),
    (Vec3::new(4.0, 0.0, 5.5), 0.0),
];

/// Nearly every word arrives as it was said, in order, each in the step in which it can have ended at the listener's head at the earliest,
/// from the speaker's direction; and nobody hears himself.
#[test]
fn words_arrive_in_order_from_their_speaker() {
    let mut world = world(&room(), FACING, WorldConfig::default());
    let tokens = [10, 20, 30, 40, 50, 60, 70, 80];
    assert!(
        world
            .say(SPEAKER, said(&tokens, VocalEffort::Loud))
            .unwrap()
    );
    assert!(world.is_speaking(SPEAKER) && !world.is_speaking(LISTENER));
    // Who speaks does not begin anew.
    assert!(!world.say(SPEAKER, said(&[5], VocalEffort::Loud)).unwrap());
    let heard = listen(&mut world);
    assert_eq!(heard.len(), tokens.len(), "{heard:?}");
    assert!(!world.is_speaking(SPEAKER));
    let right = heard.iter().zip(tokens);
    let right = right.filter(|((_, heard), token)| heard.token == Some(*token));
    assert!(right.count() >= 6, "{heard:?}");
    for (place, (step, token)) in heard.iter().enumerate() {
        let ended_s = dwell_acoustics::utterance::duration_s(&tokens[..=place]).unwrap();
        let arrived_s = ended_s + 3.0 / 343.0;
        assert_eq!(*step, (arrived_s * 20.0).ceil() as usize, "{place}");
        assert_eq!(token.speaker, SPEAKER);
        // The mouth is a little below the eyes and ahead of them.
        assert!(
            token.direction.dot(Vec3::NEG_Z) > 0.998,
            "{}",
            token.direction
        );
    }
}

/// From the left it is heard from the left, whichever way the listener looks.
#[test]
fn directions_are_those_of_the_listeners_head() {
    for (yaw_rad, towards) in [
        (0.0, Vec3::NEG_Z),
        (std::f32::consts::FRAC_PI_2, Vec3::X),
        (std::f32::consts::PI, Vec3::Z),
        (-std::f32::consts::FRAC_PI_2, Vec3::NEG_X),
    ] {
        let places = [FACING[0], (FACING[1].0, yaw_rad)];
        let mut world = world(&room(), places, WorldConfig::default());
        world.say(SPEAKER, said(&[7], VocalEffort::Normal)).unwrap();
        let heard = listen(&mut world);
        let angle = heard[0].1.direction.dot(towards).clamp(-1.0, 1.0).acos();
        assert!(
            angle.to_degrees() < 5.0,
            "{} from {towards}",
            heard[0].1.direction
        );
    }
}

/// The level of an utterance is that which its sound has behind the static response of the room, at any distance; efforts differ as
/// their levels at 1 m do.
#[test]
fn levels_are_those_of_the_static_response() {
    let engines = room();
    let tokens = [11, 12, 13, 14];
    let level = |distance: f32, effort: VocalEffort| {
        let mut places = FACING;
        places[0].0.z = 5.5 - distance;
        let mut world = world(&engines, places, WorldConfig::default());
        world.say(SPEAKER, said(&tokens, effort)).unwrap();
        let heard = listen(&mut world);
        assert_eq!(heard.len(), 4);
        let energy: f32 = heard
            .iter()
            .map(|(_, own)| 10f32.powf(0.1 * own.level_db))
            .sum();
        let agents = &world.state().agents;
        let mouth = Vec3::new(0.0, -0.08, -0.1);
        let mouth = agents[SPEAKER].world_from_head().transform_point(mouth);
        let ear = Receiver::omni(agents[LISTENER].world_from_head().position);
        (10.0 * (energy / 4.0).log10(), mouth, ear)
    };
    let scene = AcousticScene::new(engines.house().clone(), AcousticConfig::rl()).unwrap();
    let rays = RayScene::new(engines.house().clone());
    // The octaves of speech that carry it, by the efforts' own spectrum.
    let spectrum = VocalEffort::Normal
        .octave_levels_db()
        .map(|db| 10f64.powf(0.1 * db));
    let mut near_and_far = Vec::new();
    for distance in [0.5, 1.0, 2.0, 4.0] {
        let (heard_db, mouth, ear) = level(distance, VocalEffort::Normal);
        let source = SoundSourcePose::omni(mouth);
        let echogram = scene.echogram(
            &rays,
            &source,
            ear.position(),
            RandomKey::root(1),
            Threads::ONE,
        );
        let gains = echogram.unwrap().total();
        let energy: f64 = spectrum
            .iter()
            .zip(&gains[1..])
            .map(|(own, gain)| own * gain)
            .sum();
        let expected_db = 10.0 * energy.log10();
        // Four tokens of one voice differ by some dB from the mean spectrum of all voices.
        near_and_far.push(f64::from(heard_db) - expected_db);
    }
    let spread = near_and_far.iter().fold(f64::MIN, |a, b| a.max(*b))
        - near_and_far.iter().fold(f64::MAX, |a, b| a.min(*b));
    assert!(spread < 1.0, "{near_and_far:?}");
    assert!(
        near_and_far.iter().all(|own| own.abs() < 5.0),
        "{near_and_far:?}"
    );
    let (far, shouted) = (
        level(4.0, VocalEffort::Normal).0,
        level(4.0, VocalEffort::Shout).0,
    );
    let raised_by = VocalEffort::Shout.level_db() - VocalEffort::Normal.level_db();
    assert!(
        (shouted - far - raised_by as f32).abs() < 3.0,
        "{far} {shouted}"
    );
}

/// Returns the share of words that are understood, and the mean speech transmission index.
fn understood(world: &mut World, effort: VocalEffort) -> (f64, f64) {
    let (mut right, mut sti, mut count) = (0, 0.0, 0);
    for round in 0..5_u32 {
        let tokens: Vec<u32> = (0..8).map(|k| 1 + 97 * round + 11 * k).collect();
        world.say(SPEAKER, said(&tokens, effort)).unwrap();
        let heard = listen(world);
        count += tokens.len();
        right += tokens
            .iter()
            .filter(|token| heard.iter().any(|(_, own)| own.token == Some(**token)))
            .count();
        sti += heard.iter().map(|(_, own)| f64::from(own.sti)).sum::<f64>();
    }
    (right as f64 / count as f64, sti / count as f64)
}

/// Noise at the listener's side masks: the louder it is the less is understood, and a shout comes through again.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn noise_masks_and_shouting_helps() {
    let engines = room();
    let run = |noise_db: Option<f32>, effort| {
        let mut world = world(&engines, FACING, WorldConfig::default());
        if let Some(level_db) = noise_db {
            let request = PlayRequest {
                sound: SoundName::Signal("noise".to_owned()),
                place: SoundPlace::Point(Vec3::new(4.8, 1.5, 5.5)),
                level_db,
                loops: true,
            };
            world.play(request).unwrap();
        }
        understood(&mut world, effort)
    };
    let quiet = run(None, VocalEffort::Normal);
    let noisy = run(Some(55.0), VocalEffort::Normal);
    let masked = run(Some(80.0), VocalEffort::Normal);
    let shouted = run(Some(80.0), VocalEffort::Shout);
    assert!(quiet.0 > 0.75, "{quiet:?}");
    assert!(
        quiet.1 > noisy.1 + 0.05 && noisy.1 > masked.1 + 0.05,
        "{quiet:?} {noisy:?} {masked:?}"
    );
    assert!(masked.0 < 0.1, "{masked:?}");
    assert!(shouted.0 > masked.0 + 0.2, "{masked:?} {shouted:?}");
}

/// Behind a wall of stone without a door nobody hears a word, and with the world muted neither.
#[test]
fn nothing_passes_a_wall_and_nothing_is_said_when_muted() {
    let of = |name: &str| json!({"substance": name});
    let room = |name: &str, west: f64, east: f64| {
        json!({"name": name, "outline": [[west, 0], [east, 0], [east, 4], [west, 4]],
            "walls": of("concrete"), "floor": of("carpet"), "ceiling": of("acoustic_panel")})
    };
    let plan = json!({"building": {"storeys": [{"height_m": 2.5,
        "rooms": [room("west", 0.0, 4.0), room("east", 4.4, 8.0)]}]}});
    let plan: HousePlan = serde_json::from_value(plan).unwrap();
    let (house, _) = build(&plan, &FileAccess::Anywhere).unwrap();
    let engines = engines(house);
    let apart = [
        (Vec3::new(2.0, 0.0, 2.0), 0.0),
        (Vec3::new(6.0, 0.0, 2.0), 0.0),
    ];
    let mut walled = world(&engines, apart, WorldConfig::default());
    assert!(
        walled
            .say(SPEAKER, said(&[3, 4, 5], VocalEffort::Normal))
            .unwrap()
    );
    let heard = listen(&mut walled);
    assert!(
        heard.iter().all(|(_, own)| own.token.is_none()),
        "{heard:?}"
    );

    let muted = WorldConfig {
        muted: true,
        ..WorldConfig::default()
    };
    let mut muted = world(&self::room(), FACING, muted);
    assert!(
        !muted
            .say(SPEAKER, said(&[3, 4, 5], VocalEffort::Shout))
            .unwrap()
    );
    assert!(!muted.is_speaking(SPEAKER) && listen(&mut muted).is_empty());
}

/// A snapshot in the middle of an utterance goes on with the same bits, and the same words.
#[test]
fn an_utterance_goes_on_from_a_snapshot() {
    let engines = room();
    let mut first = world(&engines, FACING, WorldConfig::default());
    first
        .say(SPEAKER, said(&[100, 200, 300, 400], VocalEffort::Raised))
        .unwrap();
    for _ in 0..13 {
        first.step(&[]).unwrap();
    }
    let saved = first.snapshot();
    let mut second = world(&engines, FACING, WorldConfig::default());
    second.restore(&saved).unwrap();
    assert_eq!(first.hash(), second.hash());
    assert_eq!(listen(&mut first), listen(&mut second));
    assert_eq!(first.hash(), second.hash());
}

#[test]
fn what_cannot_be_said_is_refused() {
    let mut world = world(&room(), FACING, WorldConfig::default());
    let mut refusal = |agent: u32, tokens: &[u32]| {
        let utterance = said(tokens, VocalEffort::Normal);
        world
            .say(AgentId(agent), utterance)
            .unwrap_err()
            .to_string()
    };
    assert_eq!(refusal(2, &[1]), "no agent 2; there are 2");
    assert!(refusal(0, &[]).contains("1 to 8"));
    assert!(refusal(0, &[1; 9]).contains("1 to 8"));
    assert!(refusal(0, &[0]).contains("tokens is 0; allowed is numbers of words, 1 to"));
    assert!(refusal(0, &[1_000_000]).contains("1000000"));
}

/// In the free line a voice reaches two microphones of an agent one after the other, by the way to each of them, within 0.1 ms.
#[test]
fn a_voice_arrives_at_each_microphone_in_its_time() {
    let apart_m = 0.3;
    let sides = [-0.5, 0.5].map(|side| Microphone::omni(Vec3::X * (side * apart_m)));
    let array = Listener {
        agent: LISTENER,
        receiver: Some(MountedReceiver {
            kind: ReceiverKind::Array(sides.to_vec()),
            head_from_receiver: Pose::IDENTITY,
        }),
    };
    // Walls that absorb all but 1 %: between mouth and microphones there is the straight way alone.
    let mut wall = ShoeboxMaterials::default().floor;
    wall.absorption = Bands::constant(0.99);
    let free = House::shoebox([8.0, 3.0, 8.0], &ShoeboxMaterials::uniform(&wall)).unwrap();
    let free = engines(free);
    // The speaker stands 3 m away; the listener looks past it by so many degrees to the right.
    for turned_deg in [-90.0_f32, -40.0, 0.0, 25.0, 90.0] {
        let config = WorldConfig {
            sound_rate_hz: 48_000,
            ..WorldConfig::default()
        };
        let places = [FACING[0], (FACING[1].0, -turned_deg.to_radians())];
        let mut world = world(&free, places, config);
        let window = 48_000 / 2;
        world.enable_receivers(&[(array.clone(), window)]).unwrap();
        world.say(SPEAKER, said(&[42], VocalEffort::Loud)).unwrap();
        for _ in 0..9 {
            world.step(&[]).unwrap();
        }
        let [left, right] = [0, 1].map(|channel| {
            let mut samples = vec![0.0; window];
            world.newest_samples_of(&array, channel, &mut samples);
            samples
        });
        // The lag at which the two agree best.
        let most = (apart_m / 343.0 * 48_000.0 * 1.2) as i32;
        let agreement = |lag: i32| -> f64 {
            let pairs = (most..window as i32 - most).map(|n| {
                let at = |samples: &[f32], n: i32| f64::from(samples[n as usize]);
                at(&left, n) * at(&right, n + lag)
            });
            pairs.sum()
        };
        let best = (-most..=most)
            .max_by(|a, b| agreement(*a).total_cmp(&agreement(*b)))
            .unwrap();
        let found_s = f64::from(best) / 48_000.0;
        let agents = &world.state().agents;
        let mouth = Vec3::new(0.0, -0.08, -0.1);
        let mouth = agents[SPEAKER].world_from_head().transform_point(mouth);
        let head = agents[LISTENER].world_from_head();
        let ways = [-0.5, 0.5].map(|side| {
            head.transform_point(Vec3::X * (side * apart_m))
                .distance(mouth)
        });
        let expected_s = f64::from(ways[1] - ways[0]) / 343.2;
        assert!(
            (found_s - expected_s).abs() < 1e-4,
            "{turned_deg}: {found_s} {expected_s}"
        );
    }
}
