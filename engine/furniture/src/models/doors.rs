//! Doors with their frames.

use crate::finishes::{Finish, chrome, glass, white_lacquer};
use crate::model::{Model, PartBuilder};
use crate::shapes::{block, cylinder, frame, rod};
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

/// Width of a door's jambs and lintel, m.
const JAMB_M: f32 = 0.04;
/// Thickness of a door's leaf, m.
const LEAF_M: f32 = 0.04;
/// Gap between leaf and floor, m.
const SILL_M: f32 = 0.012;
/// Gap between leaf and jambs, m.
const GAP_M: f32 = 0.003;

/// A hinged door in an opening.
///
/// x = 0 is the middle of the opening, z = 0 the middle of the wall, y = 0 the floor. The leaf hangs on the left (-X) jamb
/// or the right one and swings towards +Z.
#[derive(Clone, Debug)]
pub struct Door {
    /// Of the opening, m.
    pub width_m: f32,
    /// Of the opening, m.
    pub height_m: f32,
    /// Thickness of the wall, m.
    pub wall_m: f32,
    /// Finish of the leaf.
    pub leaf: Finish,
    /// Finish of the frame.
    pub frame: Finish,
    /// True if the leaf has a pane.
    pub glazed: bool,
    /// True if the leaf hangs on the right (+X) jamb instead.
    pub hinge_right: bool,
}

impl Default for Door {
    fn default() -> Self {
        let leaf = Finish::plain("white_door", "hollow_door", [236, 234, 228]);
        Self {
            width_m: 0.98,
            height_m: 2.06,
            wall_m: 0.1,
            leaf,
            frame: white_lacquer(),
            glazed: false,
            hinge_right: false,
        }
    }
}

impl Door {
    /// Lower left and upper right corner of the leaf.
    fn leaf_corners(&self) -> [[f32; 2]; 2] {
        let half = 0.5 * self.width_m - JAMB_M - GAP_M;
        [[-half, SILL_M], [half, self.height_m - JAMB_M - GAP_M]]
    }

    fn frame(&self) -> PartBuilder {
        const TRIM_M: f32 = 0.012;
        let (x, h, z) = (0.5 * self.width_m, self.height_m, 0.5 * self.wall_m);
        let jambs = [
            block([-x, 0.0, -z], [-x + JAMB_M, h, z]),
            block([x - JAMB_M, 0.0, -z], [x, h, z]),
            block([-x + JAMB_M, h - JAMB_M, -z], [x - JAMB_M, h, z]),
        ];
        // Architraves cover the joint between frame and wall on both faces.
        let (inner, outer, top) = (x - 0.01, x + 0.05, h + 0.05);
        let trims = [z, -z - TRIM_M].map(|back| {
            let face = back + TRIM_M;
            block([-outer, 0.0, back], [-inner, top, face])
                .merged(block([inner, 0.0, back], [outer, top, face]))
                .merged(block([-inner, h - 0.01, back], [inner, top, face]))
                .visual_only()
        });
        PartBuilder::new("frame")
            .with_all(&self.frame, jambs)
            .with_all(&self.frame, trims)
    }

    fn panels(&self, leaf: PartBuilder) -> PartBuilder {
        let [[left, bottom], [right, top]] = self.leaf_corners();
        let face = 0.5 * self.wall_m;
        let back = face - LEAF_M;
        let mut leaf = leaf.with(&self.leaf, block([left, bottom, back], [right, top, face]));
        // Raised mouldings around panels of a slightly darker paint, two on each side.
        let shade = Finish {
            srgb: self.leaf.srgb.map(|c| (f32::from(c) * 0.95) as u8),
            ..self.leaf.clone()
        };
        for (low, high) in [(0.16, 0.86), (1.0, top - 0.14)] {
            let (width, height) = (right - left - 0.26, high - low);
            let moulding = frame(width, height, 0.018, 0.006).visual_only();
            let middle = low + 0.5 * height;
            let (x, y) = (0.5 * width - 0.018, 0.5 * height - 0.018);
            let plate =
                |z: f32| block([-x, middle - y, z], [x, middle + y, z + 0.002]).visual_only();
            leaf = leaf
                .with(&self.leaf, moulding.clone().translated(0.0, middle, face))
                .with(&self.leaf, moulding.translated(0.0, middle, back - 0.006))
                .with(&shade, plate(face))
                .with(&shade, plate(back - 0.002));
        }
        leaf
    }

    fn pane(&self, leaf: PartBuilder) -> PartBuilder {
        let [[left, bottom], [right, top]] = self.leaf_corners();
        let face = 0.5 * self.wall_m;
        let (back, middle) = (face - LEAF_M, face - 0.5 * LEAF_M);
        let (a, b, low, high) = (left + 0.13, right - 0.13, bottom + 0.3, top - 0.14);
        let rails = [
            block([left, bottom, back], [a, top, face]),
            block([b, bottom, back], [right, top, face]),
            block([a, bottom, back], [b, low, face]),
            block([a, high, back], [b, top, face]),
        ];
        let pane = block([a, low, middle - 0.004], [b, high, middle + 0.004]);
        leaf.with_all(&self.leaf, rails).with(&glass(), pane)
    }

    /// A lever on either side.
    fn handles(&self, mut leaf: PartBuilder) -> PartBuilder {
        const HEIGHT_M: f32 = 1.02;
        let [[left, _], [right, _]] = self.leaf_corners();
        let (grip, inward) = if self.hinge_right {
            (left + 0.06, -1.0)
        } else {
            (right - 0.06, 1.0)
        };
        let face = 0.5 * self.wall_m;
        for (side, at) in [(1.0, face), (-1.0, face - LEAF_M)] {
            let out = at + side * 0.045;
            let point = |way: f32, z: f32| [grip - inward * way, HEIGHT_M, z];
            let plate = cylinder(0.025, 0.006, 18).rotated_x(side * FRAC_PI_2);
            leaf = leaf.with_all(
                &chrome(),
                [
                    rod(point(0.0, at), point(0.0, out), 0.009),
                    rod(point(-0.008, out), point(0.115, out), 0.009),
                    plate.translated(grip, HEIGHT_M, at).visual_only(),
                ],
            );
        }
        leaf
    }

    /// The model of these sizes and finishes.
    pub fn build(&self) -> Model {
        let leaf = PartBuilder::new("leaf");
        let leaf = if self.glazed {
            self.pane(leaf)
        } else {
            self.panels(leaf)
        };
        let [[left, _], [right, _]] = self.leaf_corners();
        let face = 0.5 * self.wall_m;
        let (hinge, axis) = if self.hinge_right {
            (right, Vec3::Y)
        } else {
            (left, Vec3::NEG_Y)
        };
        Model::articulated("door", "door")
            .part(self.frame())
            .part(self.handles(leaf))
            .hinged("hinge", [hinge, 0.0, face], axis, 1.65)
    }
}
