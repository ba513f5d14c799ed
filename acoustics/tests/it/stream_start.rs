//! How streams and sources begin.

use crate::stream::{BLOCK, SOURCE, head, radio, room, stream};
use dwell_acoustics::{ActiveSource, StreamConfig};
use dwell_scene::State;
use glam::Vec3;

/// What rattles in one place needs the rays of one source, and five fifths of a sound are the sound.
#[test]
fn sources_that_begin_side_by_side_share_a_response() {
    let hall = room();
    let state = State::new(&hall.house);
    let receiver = head(Vec3::new(4.6, 1.2, 3.3), 0.7);
    let whole = radio(6 * BLOCK);
    let fifth: Vec<f32> = whole.iter().map(|x| x / 5.0).collect();
    let hear = |count: u64, whole: &[f32]| {
        let (mut heard, mut traced) = (Vec::new(), Vec::new());
        let mut config = StreamConfig {
            start_share: 1.0,
            ..StreamConfig::rl()
        };
        config.max_sources = 5;
        let mut stream = stream(&hall, config);
        for signal in whole.chunks_exact(BLOCK) {
            let position = SOURCE;
            let source = |id| ActiveSource {
                id,
                position,
                signal,
            };
            let sources: Vec<_> = (5..5 + count).map(source).collect();
            let mut out = vec![0.0; 2 * BLOCK];
            let report = stream
                .render_block(&hall.rays, &state, &sources, &receiver, &mut out)
                .unwrap();
            traced.push(report.traced_responses);
            heard.extend_from_slice(&out);
        }
        (heard, traced)
    };
    let (one, rays_of_one) = hear(1, &whole);
    let (five, rays_of_five) = hear(5, &fifth);
    assert_eq!(rays_of_one, [1, 0, 0, 0, 0, 0]);
    assert_eq!(rays_of_five, rays_of_one);
    let peak = one.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
    for (a, b) in one.iter().zip(&five) {
        assert!((a - b).abs() < 1e-5 * peak, "{a} {b} of {peak}");
    }
}

/// A stream begins at once: rays of the first block's responses are few, the rest follows one source a block while the listener
/// stays, and from then on what is heard is what a stream hears that began with all.
#[test]
fn a_stream_that_begins_with_few_rays_traces_the_rest_source_by_source() {
    let hall = room();
    let state = State::new(&hall.house);
    let receiver = head(Vec3::new(4.6, 1.2, 3.3), 0.7);
    let whole = radio(60 * BLOCK);
    let hear = |start_share: f64| {
        let config = StreamConfig {
            start_share,
            ..StreamConfig::rl()
        };
        let mut stream = stream(&hall, config);
        let blocks = whole.chunks_exact(BLOCK).map(|signal| {
            let source = |id: u64| ActiveSource {
                id,
                position: SOURCE + Vec3::new(0.0, 0.0, 1.2 * id as f32),
                signal,
            };
            let mut out = vec![0.0; 2 * BLOCK];
            let sources = [0, 1, 2].map(source);
            let report = stream
                .render_block(&hall.rays, &state, &sources, &receiver, &mut out)
                .unwrap();
            (report.rays, out)
        });
        blocks.collect::<Vec<_>>()
    };
    let (few, all) = (hear(0.2), hear(1.0));
    let rays = |blocks: &[(usize, Vec<f32>)]| blocks.iter().map(|one| one.0).collect::<Vec<_>>();
    let (of_few, of_all) = (rays(&few), rays(&all));
    assert!(3 * of_few[0] < of_all[0], "{} {}", of_few[0], of_all[0]);
    assert_eq!(of_all[1..].iter().sum::<usize>(), 0);
    assert!(
        of_few[1..4].iter().all(|rays| 3 * rays == of_all[0]),
        "{of_few:?}"
    );
    assert_eq!(of_few[4..].iter().sum::<usize>(), 0);
    let level_db = |blocks: &[(usize, Vec<f32>)]| {
        let samples = blocks.iter().flat_map(|one| &one.1);
        10.0 * samples.map(|x| x * x).sum::<f32>().log10()
    };
    // 0.5 s at first, where tails are those of few rays, and the last second, where they are the same.
    assert!((level_db(&few[..10]) - level_db(&all[..10])).abs() < 1.0);
    let peak = all[40..].iter().flat_map(|one| &one.1);
    let peak = peak.fold(0.0_f32, |peak, x| peak.max(x.abs()));
    for (a, b) in few[40..].iter().zip(&all[40..]) {
        for (x, y) in a.1.iter().zip(&b.1) {
            assert!((x - y).abs() < 1e-4 * peak, "{x} {y} of {peak}");
        }
    }
}
