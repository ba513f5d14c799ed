//! Stairs of two flights beside each other with a landing, and railings.

use crate::finishes::{Finish, steel};
use crate::model::{Model, PartBuilder};
use crate::shapes::block;

/// Thickness of a step, m.
const STEP_M: f32 = 0.28;
/// Thickness of a landing, m.
const LANDING_M: f32 = 0.2;
/// Depth of a tread, m.
const TREAD_M: f32 = 0.25;
/// Height of railings, m (DIN 18065: 0.9 in homes).
const RAIL_M: f32 = 0.9;
/// The highest riser, m (DIN 18065: 0.2 in homes).
const RISER_M: f32 = 0.175;
/// Thickness of the wall between the flights, m.
const SPINE_M: f32 = 0.08;

/// Stairs from one storey to the next.
///
/// The first flight starts at z = 0 at the left (-X) and climbs towards -Z, the second comes back at the right; the origin
/// is the middle of the front edge on the lower floor.
#[derive(Clone, Debug)]
pub struct Stairs {
    /// Of both flights together, m.
    pub width_m: f32,
    /// From the front edge to the landing's far end, m.
    pub depth_m: f32,
    /// From floor to floor, m.
    pub rise_m: f32,
    /// True if another flight starts above.
    pub continues_up: bool,
    /// True if the first flight is at the right instead.
    pub mirrored: bool,
    /// Finish of the wooden parts.
    pub wood: Finish,
    /// Finish of the painted parts.
    pub paint: Finish,
}

impl Stairs {
    /// The number of risers: the first flight takes one more tread than the second.
    fn risers(&self) -> usize {
        let least = (self.rise_m / RISER_M).ceil() as usize;
        // Two treads and the landing between are odd in number.
        if least % 2 == 1 { least } else { least + 1 }
    }

    /// The model of these sizes and finishes.
    pub fn build(&self) -> Model {
        let risers = self.risers();
        let riser = self.rise_m / risers as f32;
        let first = (risers - 1) / 2;
        let x = 0.5 * self.width_m;
        let spine = 0.5 * SPINE_M;
        let way = if self.mirrored { -1.0 } else { 1.0 };
        let landing = riser * (first + 1) as f32;
        let mut body = PartBuilder::new("body");
        let step = |side: f32, k: usize, top: f32| {
            let (a, b) = if side * way < 0.0 {
                (-x, -spine)
            } else {
                (spine, x)
            };
            let z = -TREAD_M * k as f32;
            block([a, (top - STEP_M).max(0.0), z - TREAD_M], [b, top, z])
        };
        let second_top = |k: usize| self.rise_m - riser * (k + 1) as f32;
        for k in 0..first {
            let top = riser * (k + 1) as f32;
            body = body.with(&self.wood, step(-1.0, k, top));
        }
        for k in 0..first - 1 {
            body = body.with(&self.wood, step(1.0, k, second_top(k)));
        }
        let (near, back) = (-TREAD_M * (first - 1) as f32, -TREAD_M * first as f32);
        let low = landing - LANDING_M;
        let (a, b) = if self.mirrored {
            (-x, -spine)
        } else {
            (spine, x)
        };
        body = body
            .with(
                &self.wood,
                block([-x, low, -self.depth_m], [x, landing, back]),
            )
            .with(&self.wood, block([a, low, back], [b, landing, near]));
        for k in 0..first {
            let z = -TREAD_M * k as f32;
            let second = if k < first - 1 {
                second_top(k)
            } else {
                landing
            };
            let own = second + RAIL_M;
            let next = self.rise_m + (riser * (k + 1) as f32 - STEP_M).max(0.0);
            let top = if self.continues_up {
                own.min(next)
            } else {
                own
            };
            body = body.with(
                &self.paint,
                block([-spine, 0.0, z - TREAD_M], [spine, top, z]),
            );
        }
        Model::fixed("stairs", "stairs").part(body)
    }
}

/// A railing along x; the origin is the middle of its foot.
pub fn railing(length_m: f32, metal: &Finish) -> Model {
    let (x, z) = (0.5 * length_m, 0.02);
    let bars = ((length_m - 0.06) / 0.11).ceil().max(1.0) as usize;
    let pitch = (length_m - 0.04) / bars as f32;
    let bar = |k: usize| {
        let at = -x + 0.02 + pitch * k as f32;
        block(
            [at - 0.008, 0.08, -0.008],
            [at + 0.008, RAIL_M + 0.06, 0.008],
        )
    };
    let body = PartBuilder::new("body")
        .with(metal, block([-x, RAIL_M + 0.06, -z], [x, RAIL_M + 0.1, z]))
        .with(metal, block([-x, 0.05, -z], [x, 0.08, z]))
        .with_all(
            metal,
            [-x, x - 0.04].map(|at| block([at, 0.0, -z], [at + 0.04, 0.05, z])),
        )
        .with_all(&steel(), (1..bars).map(bar));
    Model::fixed("railing", "fence").part(body)
}
