//! Convex outlines seen from above.

use glam::Vec2;

/// Points nearer than this to a straight outline are left out, m.
const STRAIGHT_M: f32 = 5e-4;

/// Number of points up to which all are sorted.
const FEW_POINTS: usize = 32;

/// A convex outline in the ground plane: points (x, z), m, in one turning sense; may be a point or a line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hull {
    points: Vec<Vec2>,
}

fn segment_to_point(a: Vec2, b: Vec2, p: Vec2) -> f32 {
    nearest_on_segment(a, b, p).distance(p)
}

fn nearest_on_segment(a: Vec2, b: Vec2, p: Vec2) -> Vec2 {
    let along = b - a;
    let length2 = along.length_squared();
    let t = if length2 > 0.0 {
        ((p - a).dot(along) / length2).clamp(0.0, 1.0)
    } else {
        0.0
    };
    a + along * t
}

fn segments_cross(a: Vec2, b: Vec2, c: Vec2, d: Vec2) -> bool {
    let side = |p: Vec2, q: Vec2, r: Vec2| (q - p).perp_dot(r - p);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

/// The extreme points along eight directions, an eighth of a turn apart.
fn extreme_points(points: &[Vec2]) -> Vec<Vec2> {
    let along = [Vec2::X, Vec2::ONE, Vec2::Y, Vec2::new(-1.0, 1.0)];
    let extremes = along.map(|axis| {
        let mut found = [points[0]; 2];
        let [mut least, mut largest] = [axis.dot(points[0]); 2];
        for point in points {
            let at = axis.dot(*point);
            if at < least {
                (least, found[0]) = (at, *point);
            }
            if at > largest {
                (largest, found[1]) = (at, *point);
            }
        }
        found
    });
    extremes.into_iter().flatten().collect()
}

/// The half planes, as normals and offsets, whose intersection lies so deep inside that no outline around these corners and others has a
/// corner there.
fn inner_sides(outline: &Hull) -> Vec<(Vec2, f32)> {
    let sides = outline.edges().map(|(a, b)| {
        let normal = (b - a).perp().normalize_or_zero();
        (normal, normal.dot(a) + 2.0 * STRAIGHT_M)
    });
    sides.collect()
}

impl Hull {
    /// The smallest convex outline around `points`.
    ///
    /// # Source
    /// A. M. Andrew, Inf. Proc. Letters 9, 216 (1979): monotone chain; S. G. Akl, G. T. Toussaint, Inf. Proc. Letters 7, 219 (1978): points
    /// within the outline of the extreme ones are left out first.
    pub fn around(points: impl IntoIterator<Item = Vec2>) -> Self {
        let mut points: Vec<Vec2> = points.into_iter().filter(|p| p.is_finite()).collect();
        if points.len() > FEW_POINTS {
            let sides = inner_sides(&Self::of_few(extreme_points(&points)));
            let is_deep_inside = |point: Vec2| {
                let mut depths = sides
                    .iter()
                    .map(|(normal, offset)| normal.dot(point) - offset);
                depths.all(|depth| depth > 0.0)
            };
            if sides.len() > 2 {
                points.retain(|point| !is_deep_inside(*point));
            }
        }
        Self::of_few(points)
    }

    fn of_few(mut sorted: Vec<Vec2>) -> Self {
        // Equal points are the same bits, but for the sign of zero.
        sorted.sort_unstable_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
        sorted.dedup();
        if sorted.len() < 3 {
            return Self { points: sorted };
        }
        let chain = |points: &mut dyn Iterator<Item = Vec2>| {
            let mut chain: Vec<Vec2> = Vec::new();
            for point in points {
                while let [.., a, b] = chain[..] {
                    let edge = point - a;
                    if (b - a).perp_dot(edge) > STRAIGHT_M * edge.length() {
                        break;
                    }
                    chain.pop();
                }
                chain.push(point);
            }
            chain.pop();
            chain
        };
        let mut points = chain(&mut sorted.iter().copied());
        points.extend(chain(&mut sorted.iter().rev().copied()));
        Self { points }
    }

    /// The corners.
    pub fn points(&self) -> &[Vec2] {
        &self.points
    }

    fn edges(&self) -> impl Iterator<Item = (Vec2, Vec2)> + '_ {
        let next = self.points.iter().cycle().skip(1);
        self.points.iter().copied().zip(next.copied())
    }

    /// The area, m².
    pub fn area_m2(&self) -> f32 {
        let origin = self.points.first().copied().unwrap_or_default();
        self.edges()
            .map(|(a, b)| (a - origin).perp_dot(b - origin))
            .sum::<f32>()
            .abs()
            * 0.5
    }

    /// Returns whether `point` lies inside or on the border.
    pub fn contains(&self, point: Vec2) -> bool {
        self.points.len() > 2
            && self
                .edges()
                .all(|(a, b)| (b - a).perp_dot(point - a) >= 0.0)
    }

    /// Distance to a point, m; 0 inside.
    pub fn distance_to(&self, point: Vec2) -> f32 {
        if self.contains(point) {
            return 0.0;
        }
        self.edges()
            .map(|(a, b)| segment_to_point(a, b, point))
            .fold(f32::INFINITY, f32::min)
    }

    /// The point of the outline or within it that is nearest to `point`; `None` of an outline without points.
    pub fn nearest_point(&self, point: Vec2) -> Option<Vec2> {
        if self.contains(point) {
            return Some(point);
        }
        let nearest = self.edges().map(|(a, b)| nearest_on_segment(a, b, point));
        nearest.min_by(|p, q| {
            p.distance_squared(point)
                .total_cmp(&q.distance_squared(point))
        })
    }

    /// The least and the largest coordinate along `axis`, m; the least is the larger one for an outline without points.
    pub fn range_along(&self, axis: Vec2) -> (f32, f32) {
        let along = self.points.iter().map(|point| axis.dot(*point));
        along.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        })
    }

    /// The width across the narrowest way, m.
    pub fn min_width_m(&self) -> f32 {
        let across = self.edges().filter_map(|(a, b)| {
            let (low, high) = self.range_along((b - a).try_normalize()?.perp());
            Some(high - low)
        });
        across.reduce(f32::min).unwrap_or(0.0)
    }

    /// The length of the border that lies at most `gap_m` from `other`, m: by steps of 2 cm, at least 8 an edge.
    pub fn border_length_near_m(&self, other: &Self, gap_m: f32) -> f32 {
        let mut length_m = 0.0;
        for (a, b) in self.edges() {
            let edge_m = a.distance(b);
            let steps = ((edge_m / 0.02).ceil() as usize).clamp(8, 256);
            let near = (0..steps).filter(|k| {
                let at = a.lerp(b, (*k as f32 + 0.5) / steps as f32);
                other.distance_to(at) <= gap_m
            });
            length_m += edge_m * near.count() as f32 / steps as f32;
        }
        length_m
    }

    /// The area that two outlines share, m².
    ///
    /// # Source
    /// I. E. Sutherland, G. W. Hodgman, Comm. ACM 17, 32 (1974): clipping edge by edge.
    pub fn overlap_m2(&self, other: &Self) -> f32 {
        if other.points.len() < 3 {
            return 0.0;
        }
        let mut points = self.points.clone();
        for (a, b) in other.edges() {
            let depth = |p: Vec2| (b - a).perp_dot(p - a);
            let mut kept = Vec::with_capacity(points.len() + 1);
            for (k, p) in points.iter().enumerate() {
                let q = points[(k + 1) % points.len()];
                let (from, to) = (depth(*p), depth(q));
                if from >= 0.0 {
                    kept.push(*p);
                }
                if (from >= 0.0) != (to >= 0.0) {
                    kept.push(*p + (q - *p) * (from / (from - to)));
                }
            }
            points = kept;
        }
        Self { points }.area_m2()
    }

    /// The smallest distance between two outlines, m; 0 when they touch or overlap.
    pub fn distance(&self, other: &Self) -> f32 {
        let mut best = f32::INFINITY;
        for (points, hull) in [(&self.points, other), (&other.points, self)] {
            for point in points {
                best = best.min(hull.distance_to(*point));
            }
        }
        let crosses = |(a, b)| other.edges().any(|(c, d)| segments_cross(a, b, c, d));
        if best > 0.0 && self.edges().any(crosses) {
            0.0
        } else {
            best
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;

    fn square(x: f32, z: f32, half: f32) -> Hull {
        Hull::around(
            [
                (-1.0, -1.0),
                (1.0, -1.0),
                (1.0, 1.0),
                (-1.0, 1.0),
                (0.0, 0.0),
                (0.0, 1.0),
            ]
            .map(|(u, v)| Vec2::new(x + u * half, z + v * half)),
        )
    }

    #[test]
    fn squares_have_their_distances() {
        let a = square(0.0, 0.0, 1.0);
        assert_eq!(a.points().len(), 4);
        assert!((a.area_m2() - 4.0).abs() < 1e-5);
        assert!((a.distance(&square(3.0, 0.0, 1.0)) - 1.0).abs() < 1e-6);
        assert!((a.distance(&square(3.0, 3.0, 1.0)) - 2.0_f32.sqrt()).abs() < 1e-6);
        assert!(a.distance(&square(0.1, 0.0, 0.2)) <= 0.0);
        assert!(a.distance(&square(1.5, 0.0, 1.0)) <= 0.0);
        assert!((a.overlap_m2(&square(1.5, 0.5, 1.0)) - 0.75).abs() < 1e-5);
        assert!(a.overlap_m2(&square(3.0, 0.0, 1.0)) <= 0.0);
        // A long bar through the square: no corner of either lies in the other.
        let bar = Hull::around(
            [(-5.0, -0.1), (5.0, -0.1), (5.0, 0.1), (-5.0, 0.1)].map(|(x, z)| Vec2::new(x, z)),
        );
        assert!(a.distance(&bar) <= 0.0);
    }

    /// Leaving out the points deep inside changes no bit of an outline.
    #[test]
    fn inner_points_change_no_outline() {
        for seed in 0..200 {
            let mut stream = RandomKey::root(seed).stream();
            // Clouds round, flat and on a grid, where many lie on one line.
            let (width, grid) = ([1.0, 0.02, 1.0][seed as usize % 3], seed % 3 == 2);
            let mut coordinate = |half: f32| {
                let at = stream.range(-half, half);
                if grid { (at * 8.0).round() / 8.0 } else { at }
            };
            let cloud: Vec<Vec2> = (0..400)
                .map(|_| Vec2::new(coordinate(1.0), coordinate(width)))
                .collect();
            assert_eq!(Hull::around(cloud.clone()), Hull::of_few(cloud), "{seed}");
        }
    }

    /// Against the least distance between points sampled in both outlines.
    #[test]
    fn distances_agree_with_sampling() {
        for seed in 0..20 {
            let mut stream = RandomKey::root(seed).stream();
            let mut cloud = |x: f32| -> Vec<Vec2> {
                (0..12)
                    .map(|_| Vec2::new(x + stream.range(-1.0, 1.0), stream.range(-1.0, 1.0)))
                    .collect()
            };
            let (p, q) = (cloud(0.0), cloud(1.5));
            let (a, b) = (Hull::around(p.clone()), Hull::around(q));
            assert!(p.iter().all(|point| a.distance_to(*point) < 1e-3));
            let grid = |hull: &Hull| -> Vec<Vec2> {
                (0..60)
                    .flat_map(|i| {
                        (0..60).map(move |j| {
                            Vec2::new(-1.0 + 0.06 * i as f32, -1.0 + 0.034 * j as f32)
                        })
                    })
                    .filter(|point| hull.contains(*point))
                    .chain(hull.points().iter().copied())
                    .collect()
            };
            let (u, v) = (grid(&a), grid(&b));
            let sampled = u
                .iter()
                .flat_map(|x| v.iter().map(move |y| x.distance(*y)))
                .fold(f32::INFINITY, f32::min);
            assert!(
                (a.distance(&b) - sampled).abs() < 0.07,
                "{} {sampled}",
                a.distance(&b)
            );
        }
    }
}
