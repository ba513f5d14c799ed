//! Rays against triangles: brute force, cracks, coincident surfaces, moving things, bad input.

mod bvh_support;

use bvh_support::{Oracle, Soup, ground, joined, permuted, rays_at, room};
use dwell_scene::bvh::{
    Hit, Instance, InstanceSet, PacketHits, Ray, RayMask, RayPacket, SceneBvh, TriangleAttributes,
    TriangleBvh,
};
use dwell_scene::random::RandomKey;
use glam::{Affine3A, Quat, Vec3};
use proptest::prelude::*;
use std::sync::Arc;

/// Equal answers, but for the numbering of triangles.
fn same(a: Option<Hit>, b: Option<Hit>) -> bool {
    let plain = |hit: Hit| (hit.distance_m.to_bits(), hit.id, hit.instance);
    a.map(plain) == b.map(plain)
}

/// Asks in packets of `N` rays from one origin each and compares with single rays.
fn packets_agree<const N: usize>(scene: &SceneBvh<'_>, rays: &[Ray], mask: RayMask) {
    for chunk in rays.chunks(N) {
        let mut packet = RayPacket::<N>::new(chunk[0].origin);
        for (k, ray) in chunk.iter().enumerate() {
            packet.set(k, ray.direction, ray.near_m, ray.far_m);
        }
        let mut hits = PacketHits::new();
        scene.closest_packet(&packet, mask, None, &mut hits);
        let blocked = scene.occluded_packet(&packet, mask, None);
        for k in 0..N {
            let single = packet.ray(k);
            let expected = scene.closest(&single, mask);
            assert_eq!(scene.packet_hit(&packet, &hits, k), expected, "{single:?}");
            assert_eq!(hits.is_hit(k), expected.is_some());
            assert_eq!(
                blocked >> k & 1 == 1,
                scene.occluded(&single, mask),
                "{single:?}"
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn the_tree_finds_what_brute_force_finds(seed in any::<u64>(), count in 0_usize..400, far in 0_usize..3) {
        let key = RandomKey::root(seed);
        let offset = [Vec3::ZERO, Vec3::new(40.0, 1.0, 45.0), Vec3::splat(-3e3)][far];
        let soup = Soup::random(key, count, offset);
        let oracle = Oracle::new(&soup);
        let tree = soup.tree();
        for ray in rays_at(key.child("rays"), 64, &soup) {
            let found = tree.closest(&ray, RayMask::ALL);
            oracle.check(&ray, found);
            prop_assert_eq!(found.is_some(), tree.occluded(&ray, RayMask::ALL));
            if let Some(hit) = found {
                let until = |far_m| tree.occluded(&ray.with_range(ray.near_m, far_m), RayMask::ALL);
                prop_assert!(until(hit.distance_m));
                prop_assert!(!until(hit.distance_m * 0.999));
            }
        }
    }

    #[test]
    fn packets_and_single_rays_give_the_same_bits(seed in any::<u64>(), count in 0_usize..600) {
        let key = RandomKey::root(seed);
        let soup = Soup::random(key, count, Vec3::new(40.0, 1.0, 45.0));
        let (fixed, moving) = soup.split(key.child("poses"));
        let scene = SceneBvh { fixed: &fixed, moving: &moving };
        let rays = soup.fans(key.child("fans"));
        for mask in [RayMask::ALL, RayMask::EYE] {
            packets_agree::<8>(&scene, &rays, mask);
            packets_agree::<16>(&scene, &rays, mask);
            packets_agree::<64>(&scene, &rays, mask);
        }
    }

    #[test]
    fn packets_and_single_rays_agree_on_coincident_surfaces(seed in any::<u64>(), count in 1_usize..300) {
        let key = RandomKey::root(seed);
        let soup = Soup::flat(key, count, Vec3::new(40.0, 1.0, 45.0));
        let tree = soup.tree();
        let moving = InstanceSet::default();
        let scene = SceneBvh { fixed: &tree, moving: &moving };
        packets_agree::<16>(&scene, &soup.fans(key.child("fans")), RayMask::ALL);
    }

    #[test]
    fn the_order_of_triangles_does_not_matter(seed in any::<u64>(), count in 1_usize..300) {
        let key = RandomKey::root(seed);
        // Many triangles in few planes: coincident surfaces everywhere.
        let soup = Soup::flat(key, count, Vec3::new(40.0, 1.0, 45.0));
        let other = permuted(&soup, key.child("order"));
        let (a, b) = (soup.tree(), other.tree());
        for ray in rays_at(key.child("rays"), 128, &soup) {
            let (a, b) = (a.closest(&ray, RayMask::ALL), b.closest(&ray, RayMask::ALL));
            prop_assert!(same(a, b), "{ray:?}: {a:?}, {b:?}");
        }
    }

    #[test]
    fn instances_are_as_good_as_baked_triangles(seed in any::<u64>(), count in 1_usize..300) {
        let key = RandomKey::root(seed);
        let soup = Soup::random(key, count, Vec3::ZERO);
        let (fixed, moving) = soup.split(key.child("poses"));
        let scene = SceneBvh { fixed: &fixed, moving: &moving };
        let baked = soup.baked(key.child("poses"));
        let oracle = Oracle::new(&baked);
        for ray in rays_at(key.child("rays"), 64, &baked) {
            oracle.check(&ray, scene.closest(&ray, RayMask::ALL));
        }
    }

    #[test]
    fn moved_one_by_one_or_all_at_once_is_the_same(seed in any::<u64>(), count in 1_usize..200) {
        let key = RandomKey::root(seed);
        let soup = Soup::random(key, count, Vec3::ZERO);
        let (fixed, mut one_by_one) = soup.split(key.child("poses"));
        let mut at_once = one_by_one.clone();
        let poses = Soup::poses(key.child("new"), one_by_one.len());
        for (k, pose) in poses.iter().enumerate() {
            one_by_one.set_pose(k as u32, pose);
        }
        at_once.set_poses(&poses);
        prop_assert_eq!(one_by_one.bounds(), at_once.bounds());
        let (a, b) = (SceneBvh { fixed: &fixed, moving: &one_by_one }, SceneBvh { fixed: &fixed, moving: &at_once });
        for ray in rays_at(key.child("rays"), 64, &soup) {
            prop_assert_eq!(a.closest(&ray, RayMask::ALL), b.closest(&ray, RayMask::ALL));
        }
    }

    #[test]
    fn masks_and_hidden_ids_remove_what_they_name(seed in any::<u64>(), count in 1_usize..200) {
        let key = RandomKey::root(seed);
        let soup = Soup::random(key, count, Vec3::ZERO);
        let (fixed, moving) = soup.split(key.child("poses"));
        let scene = SceneBvh { fixed: &fixed, moving: &moving };
        for ray in rays_at(key.child("rays"), 64, &soup) {
            let mut all = Vec::new();
            scene.all_hits(&ray, RayMask::ALL, &mut all);
            prop_assert!(all.is_sorted_by(|a, b| a.distance_m <= b.distance_m));
            let Some(first) = scene.closest(&ray, RayMask::ALL) else {
                prop_assert!(all.is_empty());
                continue;
            };
            prop_assert_eq!(all[0].distance_m.to_bits(), first.distance_m.to_bits());
            let behind = scene.closest_excluding(&ray, RayMask::ALL, first.id);
            let expected = all.iter().find(|hit| hit.id != first.id);
            prop_assert_eq!(behind.map(|hit| hit.distance_m), expected.map(|hit| hit.distance_m));
            prop_assert_eq!(scene.occluded_excluding(&ray, RayMask::ALL, first.id), expected.is_some());
            // Odd ids are for ears only in the soup.
            let seen = scene.closest(&ray, RayMask::EYE);
            let expected = all.iter().find(|hit| hit.id % 2 == 0);
            prop_assert_eq!(seen.map(|hit| hit.distance_m), expected.map(|hit| hit.distance_m));
            prop_assert_eq!(scene.closest(&ray, RayMask::NONE), None);
        }
    }
}

#[test]
fn no_ray_leaves_a_closed_room() {
    for (center, seed) in [(Vec3::new(41.3, 1.2, 38.7), 1), (Vec3::ZERO, 2)] {
        let (positions, triangles) = room(center, 9, RandomKey::root(seed));
        let tree = TriangleBvh::build(&positions, &triangles);
        assert_eq!(tree.skipped_triangles(), 0);
        let mut stream = RandomKey::root(seed).child("rays").stream();
        let eye = center + stream.direction() * 0.3;
        let mut targets = positions.clone();
        for [a, b, c] in triangles.iter().map(|t| t.map(|k| positions[k as usize])) {
            targets.extend([
                (a + b) / 2.0,
                (b + c) / 2.0,
                a.lerp(c, stream.uniform_f32()),
            ]);
        }
        targets.extend((0..20_000).map(|_| eye + stream.direction()));
        for target in targets {
            let ray = Ray::new(eye, target - eye);
            let hit = tree
                .closest(&ray, RayMask::ALL)
                .unwrap_or_else(|| panic!("leak at {target}"));
            assert!(hit.u >= 0.0 && hit.v >= 0.0 && hit.u + hit.v <= 1.000_001);
            let [a, b, c] = triangles[hit.triangle as usize].map(|k| positions[k as usize]);
            let on_triangle = a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
            assert!(ray.point_at(hit.distance_m).distance(on_triangle) < 2e-5);
        }
    }
}

#[test]
fn of_two_floors_in_one_plane_the_lower_id_is_seen_everywhere() {
    let mut stream = RandomKey::root(7).stream();
    // The same rectangle, cut differently, at the coordinates of a real house.
    let first = ground(Vec3::new(30.0, 0.04, 33.0), [14.0, 11.0], 1);
    let second = ground(Vec3::new(30.0, 0.04, 33.0), [14.0, 11.0], 7);
    let trees = [
        joined(&first, &second, [3, 9]),
        joined(&first, &second, [9, 3]),
    ];
    for _ in 0..50_000 {
        // From robot height to ceiling, also at grazing angles.
        let eye = Vec3::new(
            stream.range(31.0, 43.0),
            stream.range(0.1, 2.5),
            stream.range(34.0, 43.0),
        );
        let target = Vec3::new(stream.range(30.1, 43.9), 0.04, stream.range(33.1, 43.9));
        let ray = Ray::new(eye, target - eye);
        for tree in &trees {
            assert_eq!(
                tree.closest(&ray, RayMask::ALL).map(|hit| hit.id),
                Some(3),
                "{ray:?}"
            );
        }
    }
}

#[test]
fn a_sheet_a_tenth_of_a_millimetre_above_another_is_seen_from_above() {
    let lower = ground(Vec3::new(40.0, 1.0, 40.0), [1.0, 1.0], 2);
    let upper = ground(Vec3::new(40.0, 1.0001, 40.0), [1.0, 1.0], 3);
    let tree = joined(&lower, &upper, [1, 2]);
    for x in 0..40 {
        let target = Vec3::new(40.1 + 0.02 * x as f32, 1.0, 40.5);
        let above = Vec3::new(40.5, 2.5, 40.5);
        let below = Vec3::new(40.5, -0.5, 40.5);
        let seen = |eye: Vec3| {
            tree.closest(&Ray::new(eye, target - eye), RayMask::ALL)
                .map(|hit| hit.id)
        };
        assert_eq!((seen(above), seen(below)), (Some(2), Some(1)));
    }
}

#[test]
fn bad_triangles_are_left_out_and_the_rest_keep_their_numbers() {
    let positions = [
        Vec3::ZERO,
        Vec3::X,
        Vec3::Z,
        Vec3::new(f32::NAN, 0.0, 0.0),
        Vec3::splat(f32::INFINITY),
        Vec3::splat(1e30),
        Vec3::X * 2.0,
    ];
    let triangles = [
        [0, 1, 3],
        [0, 1, 99],
        [0, 0, 1],
        [0, 1, 6],
        [0, 1, 4],
        [0, 1, 5],
        [0, 1, 2],
        [u32::MAX, 0, 1],
    ];
    let tree = TriangleBvh::build(&positions, &triangles);
    assert_eq!((tree.len(), tree.skipped_triangles()), (1, 7));
    let hit = tree
        .closest(
            &Ray::new(Vec3::new(0.2, 1.0, 0.25), Vec3::NEG_Y),
            RayMask::ALL,
        )
        .unwrap();
    assert_eq!((hit.triangle, hit.distance_m), (6, 1.0));
    assert!((hit.u - 0.2).abs() < 1e-6 && (hit.v - 0.25).abs() < 1e-6);
}

#[test]
fn empty_scenes_and_bad_rays_meet_nothing() {
    let nothing = TriangleBvh::build(&[], &[]);
    assert!(nothing.is_empty() && nothing.bounds().is_empty());
    let ray = Ray::new(Vec3::Y, Vec3::NEG_Y);
    assert_eq!(nothing.closest(&ray, RayMask::ALL), None);
    let (positions, triangles) = ground(Vec3::new(-5.0, 0.0, -5.0), [10.0, 10.0], 2);
    let floor = TriangleBvh::build(&positions, &triangles);
    let instance = |world_from_mesh| Instance {
        mesh: Arc::new(TriangleBvh::build(&positions, &triangles)),
        world_from_mesh,
        id: 5,
        mask: RayMask::ALL,
    };
    let hidden = InstanceSet::new([
        instance(Affine3A::from_translation(Vec3::splat(f32::NAN))),
        instance(Affine3A::from_scale(Vec3::new(1.0, 1.0, 0.0))),
        instance(Affine3A::from_scale(Vec3::splat(f32::INFINITY))),
        Instance {
            mesh: Arc::new(TriangleBvh::default()),
            ..instance(Affine3A::IDENTITY)
        },
    ]);
    let scene = SceneBvh {
        fixed: &nothing,
        moving: &hidden,
    };
    assert_eq!(scene.closest(&ray, RayMask::ALL), None);
    let scene = SceneBvh {
        fixed: &floor,
        moving: &hidden,
    };
    assert_eq!(
        scene.closest(&ray, RayMask::ALL).map(|hit| hit.distance_m),
        Some(1.0)
    );
    packets_agree::<16>(&scene, &[ray; 4], RayMask::ALL);
    let bad = [
        Ray {
            origin: Vec3::splat(f32::NAN),
            ..ray
        },
        Ray {
            origin: Vec3::splat(f32::INFINITY),
            ..ray
        },
        Ray {
            direction: Vec3::ZERO,
            ..ray
        },
        Ray {
            direction: Vec3::new(0.0, f32::NAN, 0.0),
            ..ray
        },
        Ray {
            direction: Vec3::new(0.0, f32::NEG_INFINITY, 0.0),
            ..ray
        },
        ray.with_range(f32::NAN, 5.0),
        ray.with_range(0.0, f32::NAN),
        ray.with_range(2.0, 1.0),
        ray.with_range(-1.0, 5.0),
        ray.with_range(1.5, f32::INFINITY),
        ray.with_range(0.0, 0.5),
    ];
    for ray in bad {
        assert_eq!(scene.closest(&ray, RayMask::ALL), None, "{ray:?}");
        assert!(!scene.occluded(&ray, RayMask::ALL), "{ray:?}");
        let mut all = vec![];
        scene.all_hits(&ray, RayMask::ALL, &mut all);
        assert!(all.is_empty());
        let mut packet = RayPacket::<8>::new(ray.origin);
        packet.set(3, ray.direction, ray.near_m, ray.far_m);
        let mut hits = PacketHits::new();
        scene.closest_packet(&packet, RayMask::ALL, None, &mut hits);
        assert!((0..8).all(|k| !hits.is_hit(k)), "{ray:?}");
        assert_eq!(
            scene.occluded_packet(&packet, RayMask::ALL, None),
            0,
            "{ray:?}"
        );
    }
}

#[test]
fn ranges_include_both_ends_and_surfaces_have_two_sides() {
    let (positions, triangles) = ground(Vec3::new(-5.0, 0.0, -5.0), [10.0, 10.0], 3);
    let floor = TriangleBvh::build(&positions, &triangles);
    let down = Ray::new(Vec3::new(0.3, 2.0, 0.2), Vec3::NEG_Y);
    let up = Ray::new(Vec3::new(0.3, -2.0, 0.2), Vec3::Y);
    for ray in [down, up] {
        for (near, far, meets) in [
            (0.0, 2.0, true),
            (2.0, 3.0, true),
            (0.0, 1.999, false),
            (2.001, 9.0, false),
        ] {
            let ray = ray.with_range(near, far);
            assert_eq!(
                floor.closest(&ray, RayMask::ALL).is_some(),
                meets,
                "{ray:?}"
            );
            assert_eq!(floor.occluded(&ray, RayMask::ALL), meets, "{ray:?}");
        }
    }
    // A ray that starts on the surface meets it at once, unless it is told to start a little off.
    let on = Ray::new(Vec3::new(0.3, 0.0, 0.2), Vec3::new(0.6, 0.8, 0.0));
    assert_eq!(
        floor.closest(&on, RayMask::ALL).map(|hit| hit.distance_m),
        Some(0.0)
    );
    assert_eq!(
        floor.closest(&on.with_range(1e-4, 10.0), RayMask::ALL),
        None
    );
    // Within the plane there is nothing to meet, and nothing hangs.
    assert_eq!(
        floor.closest(&Ray::new(Vec3::new(-9.0, 0.0, 0.1), Vec3::X), RayMask::ALL),
        None
    );
}

#[test]
fn rays_along_axes_in_the_planes_of_box_faces_are_not_lost() {
    // Coordinates without rounding: these rays run exactly in the faces of boxes, where zero times infinity lurks.
    let (positions, triangles) = ground(Vec3::ZERO, [4.0, 4.0], 1);
    let step = |k: u32| Vec3::new(0.5 * k as f32, 0.25 * k as f32, 0.0);
    let (mut all, mut list) = (Vec::new(), Vec::new());
    for k in 0..8 {
        list.extend(triangles.iter().map(|t| t.map(|v| v + all.len() as u32)));
        all.extend(positions.iter().map(|p| *p + step(k)));
    }
    let tree = TriangleBvh::build(&all, &list);
    for k in 0..8 {
        for x in [0.0, 0.5, 1.0, 3.5, 4.0] {
            for z in [0.0, 2.0, 4.0] {
                let ray = Ray::new(step(k) + Vec3::new(x, 0.125, z), Vec3::NEG_Y);
                let hit = tree.closest(&ray, RayMask::ALL);
                assert_eq!(hit.map(|hit| hit.distance_m), Some(0.125), "{k} {x} {z}");
            }
        }
    }
}

#[test]
fn trees_of_hopeless_input_are_right() {
    // All in one place; and each beside an ever smaller one: builders from the bottom up go deep.
    let tree = TriangleBvh::build_tagged(
        &[Vec3::ZERO, Vec3::X, Vec3::Z],
        &vec![[0, 1, 2]; 5000],
        |k| TriangleAttributes::new(5000 - k as i32),
    );
    let hit = tree
        .closest(
            &Ray::new(Vec3::new(0.2, 1.0, 0.2), Vec3::NEG_Y),
            RayMask::ALL,
        )
        .unwrap();
    assert_eq!((hit.id, hit.triangle), (1, 4999));
    let mut positions = Vec::new();
    for k in 0..120 {
        let x = 1.3_f32.powi(-k) * 1000.0;
        positions.extend([
            Vec3::new(x, 0.0, 0.0),
            Vec3::new(x * 1.2, 0.0, 0.0),
            Vec3::new(x, 0.0, x),
        ]);
    }
    let triangles: Vec<[u32; 3]> = (0..120).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let tree = TriangleBvh::build(&positions, &triangles);
    for (k, triangle) in triangles.iter().enumerate() {
        let middle = triangle
            .iter()
            .map(|v| positions[*v as usize])
            .sum::<Vec3>()
            / 3.0;
        // From so near that rounding is smaller than the triangle.
        let above = middle + Vec3::Y * middle.x * 0.1;
        let hit = tree.closest(&Ray::new(above, Vec3::NEG_Y), RayMask::ALL);
        assert_eq!(hit.map(|hit| hit.triangle), Some(k as u32));
    }
}

#[test]
fn instances_keep_their_accuracy_far_from_the_origin() {
    let (positions, triangles) = room(Vec3::ZERO, 3, RandomKey::root(11));
    let mesh = Arc::new(TriangleBvh::build(&positions, &triangles));
    let turn = Quat::from_axis_angle(Vec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
    let eye = Vec3::new(47.0, 1.0, 39.0);
    let place = Affine3A::from_scale_rotation_translation(Vec3::new(-0.5, 0.5, 0.5), turn, eye);
    let moving = InstanceSet::new([Instance {
        mesh,
        world_from_mesh: place,
        id: 4,
        mask: RayMask::ALL,
    }]);
    let fixed = TriangleBvh::default();
    let scene = SceneBvh {
        fixed: &fixed,
        moving: &moving,
    };
    let mut stream = RandomKey::root(12).stream();
    for _ in 0..5000 {
        let ray = Ray::new(eye, stream.direction());
        let hit = scene.closest(&ray, RayMask::ALL).expect("a closed room");
        let [a, b, c] =
            triangles[hit.triangle as usize].map(|k| place.transform_point3(positions[k as usize]));
        let expected = a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
        assert!(ray.point_at(hit.distance_m).distance(expected) < 3e-5);
        assert_eq!((hit.instance, hit.id), (Some(0), 4));
    }
}
