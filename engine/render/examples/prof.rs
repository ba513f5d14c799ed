#![allow(warnings)]
use dwell_render::*;
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::*;
use glam::*;
use std::sync::Arc;
fn cpu() -> f64 {
    std::fs::read_to_string("/proc/thread-self/schedstat")
        .unwrap()
        .split_whitespace()
        .next()
        .unwrap()
        .parse::<f64>()
        .unwrap()
        * 1e-9
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let (house, _) = dwell_houses::open(&a[1]).unwrap();
    let house = Arc::new(house);
    let scene = RayScene::new(house.clone());
    let state = State::new(&house);
    let r = CpuRenderer::new(&house);
    #[derive(serde::Deserialize)]
    struct L {
        position: [f32; 3],
        forward: [f32; 3],
    }
    let l: Vec<L> = serde_json::from_slice(&std::fs::read(&a[2]).unwrap()).unwrap();
    let cam = Camera::from_fov(128, 128, 90.0).unwrap();
    for m in a[3].split(',') {
        let ch = Channels {
            rgb: m.contains('r'),
            depth: m.contains('d'),
            instance: m.contains('i'),
            semantic: m.contains('s'),
            ..Channels::NONE
        };
        let views: Vec<View> = l
            .iter()
            .map(|l| {
                let mut v = View::new(
                    cam,
                    Pose::new(
                        Vec3::from_array(l.position),
                        space::rotation_from_forward(Vec3::from_array(l.forward)).unwrap(),
                    ),
                );
                if m.contains('L') {
                    v.preset = Preset::Lit;
                }
                v
            })
            .collect();
        let t = Threads::exactly(a[4].parse().unwrap());
        let secs: f64 = a[5].parse().unwrap();
        let mut frames: Vec<Frame> = views.iter().map(|v| Frame::new(&cam, ch)).collect();
        let mut times = vec![];
        let s = std::time::Instant::now();
        let mut best = 1e9f64;
        let c0 = cpu();
        while s.elapsed().as_secs_f64() < secs {
            let mut f: Vec<FrameMut> = frames.iter_mut().map(Frame::as_mut).collect();
            let b = std::time::Instant::now();
            let c = cpu();
            r.render(&scene, &state, &views, &mut f, t).unwrap();
            times.push(b.elapsed().as_secs_f64());
            best = best.min(cpu() - c);
        }
        times.sort_by(f64::total_cmp);
        println!(
            "{m} {} threads: cpu best {:.0}/s | wall best {:.0}/s median {:.0}/s",
            a[4],
            200.0 / best,
            200.0 / times[0],
            200.0 / times[times.len() / 2]
        );
    }
}
