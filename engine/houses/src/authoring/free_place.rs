//! Search for a free place on top of an object.

use dwell_scene::{Aabb, HouseData, Id, ObjectId};
use glam::{Vec2, Vec3};

use super::place::{triangle_height_at, triangles};

/// Spacing of the places that are tried, m, and the most of them along a side.
const STEP_M: f32 = 0.05;
const MOST_STEPS: f32 = 40.0;
/// Largest unevenness of the ground under an object, m.
const EVEN_M: f32 = 0.01;
/// Inset of an object's feet from the sides of its box, a share of its size.
const INSET: f32 = 0.1;
/// Clearance between objects, m.
const APART_M: f32 = 0.01;
/// Horizontal clearance beyond which nothing is in the way, m.
const REACH_M: f32 = 0.1;

/// The surfaces of an object.
pub(super) struct SupportSurface {
    triangles: Vec<[Vec3; 3]>,
}

impl SupportSurface {
    pub(super) fn of(data: &HouseData, object: ObjectId) -> Self {
        let triangles = triangles(data, object);
        Self { triangles }
    }

    /// The highest point on an upright line, m.
    pub(super) fn height_m(&self, xz: Vec2) -> Option<f32> {
        let heights = self
            .triangles
            .iter()
            .filter_map(|t| triangle_height_at(*t, xz));
        heights.reduce(f32::max)
    }
}

/// A search for a place on a carrier.
pub(super) struct PlacementSearch<'a> {
    top: SupportSurface,
    bounds: Aabb,
    /// The thing's box around its anchor, m.
    around: &'a Aabb,
    /// Boxes of other objects that may be in the way, m.
    others: Vec<Aabb>,
}

impl<'a> PlacementSearch<'a> {
    /// A search on `carrier` for `thing`, which has the box `around` its anchor; `boxes`: those around all objects, m.
    pub(super) fn new(
        data: &HouseData,
        boxes: &[Aabb],
        carrier: ObjectId,
        thing: ObjectId,
        around: &'a Aabb,
    ) -> Self {
        let bounds = boxes[carrier.index()];
        // The box that the thing may reach with its anchor over the carrier.
        let reach = Aabb {
            min: bounds.min + around.min - REACH_M,
            max: bounds.max + around.max + REACH_M,
        };
        let others = data.objects.ids().zip(boxes);
        let others = others.filter(|(id, b)| *id != carrier && *id != thing && !b.is_empty());
        // A building contains all that stands in it.
        let others = others.filter(|(_, b)| b.intersects(&reach) && !b.encloses(&bounds));
        Self {
            top: SupportSurface::of(data, carrier),
            bounds,
            around,
            others: others.map(|(_, b)| *b).collect(),
        }
    }

    /// The free place nearest to the carrier's middle where the thing stands on even ground; for one that is larger than all even ground,
    /// the one nearest where its middle is carried.
    pub(super) fn find_free_position(&self) -> Option<Vec3> {
        let even = self.free_positions().find(|place| self.is_even(*place));
        even.or_else(|| self.free_positions().next())
    }

    /// Returns the places without overlap, the nearest to the carrier's middle first.
    fn free_positions(&self) -> impl Iterator<Item = Vec3> {
        let (middle, size) = (self.bounds.center(), self.bounds.size());
        let step = |size: f32| (size / MOST_STEPS).max(STEP_M);
        let steps = |size: f32| (0.5 * size / step(size)) as i32;
        let (columns, rows) = (steps(size.x), steps(size.z));
        let mut all: Vec<(i32, i32)> = (-rows..=rows)
            .flat_map(|row| (-columns..=columns).map(move |column| (column, row)))
            .collect();
        all.sort_by_key(|(column, row)| (column * column + row * row, *row, *column));
        let place = move |(column, row): (i32, i32)| {
            let x = middle.x + column as f32 * step(size.x);
            let z = middle.z + row as f32 * step(size.z);
            let top = self.top.height_m(Vec2::new(x, z))?;
            let place = Vec3::new(x, top, z);
            self.is_free(place).then_some(place)
        };
        all.into_iter().filter_map(place)
    }

    fn is_free(&self, place: Vec3) -> bool {
        let own = Aabb {
            min: place + self.around.min,
            max: place + self.around.max,
        };
        // It touches its carrier.
        let low = Vec3::new(own.min.x - APART_M, own.min.y + 1e-3, own.min.z - APART_M);
        let high = Vec3::new(own.max.x + APART_M, own.max.y, own.max.z + APART_M);
        let mut others = self.others.iter();
        !others.any(|other| other.min.cmplt(high).all() && other.max.cmpgt(low).all())
    }

    fn is_even(&self, place: Vec3) -> bool {
        let (low, size) = (self.around.min, self.around.size());
        let mut feet = [INSET, 1.0 - INSET]
            .into_iter()
            .flat_map(|u| [INSET, 1.0 - INSET].map(|v| (u, v)));
        feet.all(|(u, v)| {
            let foot = Vec2::new(place.x + low.x + u * size.x, place.z + low.z + v * size.z);
            let top = self.top.height_m(foot);
            top.is_some_and(|top| (top - place.y).abs() < EVEN_M)
        })
    }
}
