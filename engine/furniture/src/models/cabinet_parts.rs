//! The common parts of cupboards: carcass, doors, drawers, handles.

use crate::finishes::Finish;
use crate::model::PartBuilder;
use crate::shapes::{SolidMesh, block, cylinder, frame, rod};
use crate::style::FrontStyle;
use std::f32::consts::FRAC_PI_2;

/// Thickness of boards, m.
pub(super) const BOARD_M: f32 = 0.018;
/// Thickness of back panels, m.
const BACK_M: f32 = 0.006;
/// The index of the top among a carcass' boards.
pub(super) const TOP_BOARD: usize = 3;
/// Gap between neighbouring fronts, m.
pub(super) const GAP_M: f32 = 0.005;

/// The names of a bookcase's compartments, from below.
pub(super) const SHELVES: [&str; 6] = [
    "shelf_1", "shelf_2", "shelf_3", "shelf_4", "shelf_5", "shelf_6",
];

/// A box of boards with an open front.
#[derive(Clone, Copy, Debug)]
pub(super) struct Carcass {
    /// Outer corners, m; the front is at the larger z.
    pub(super) min: [f32; 3],
    /// The highest corner, m.
    pub(super) max: [f32; 3],
}

impl Carcass {
    /// A carcass on the floor (from `base_m` up), its back at z = `-depth_m / 2`.
    pub(super) fn floor_standing(width_m: f32, base_m: f32, top_m: f32, depth_m: f32) -> Self {
        Self {
            min: [-0.5 * width_m, base_m, -0.5 * depth_m],
            max: [0.5 * width_m, top_m, 0.5 * depth_m],
        }
    }

    /// Sides, bottom, top and back; shelves at `shelves` (share of the height, 0 to 1); walls between bays at `walls`
    /// (share of the width).
    pub(super) fn boards(&self, shelves: &[f32], walls: &[f32]) -> Vec<SolidMesh> {
        let ([x0, y0, z0], [x1, y1, z1]) = (self.min, self.max);
        let b = BOARD_M;
        let mut boards = vec![
            block([x0, y0, z0], [x0 + b, y1, z1]),
            block([x1 - b, y0, z0], [x1, y1, z1]),
            block([x0 + b, y0, z0], [x1 - b, y0 + b, z1]),
            block([x0 + b, y1 - b, z0], [x1 - b, y1, z1]),
            block([x0 + b, y0 + b, z0], [x1 - b, y1 - b, z0 + BACK_M]),
        ];
        let mut edges = vec![x0 + b];
        for share in walls {
            let x = x0 + share * (x1 - x0);
            boards.push(block(
                [x - 0.5 * b, y0 + b, z0 + BACK_M],
                [x + 0.5 * b, y1 - b, z1],
            ));
            edges.extend([x - 0.5 * b, x + 0.5 * b]);
        }
        edges.push(x1 - b);
        for share in shelves {
            let y = y0 + share * (y1 - y0);
            for bay in edges.chunks_exact(2) {
                boards.push(block(
                    [bay[0], y - 0.5 * b, z0 + BACK_M],
                    [bay[1], y + 0.5 * b, z1 - 0.01],
                ));
            }
        }
        boards
    }

    /// The free space above the shelf at `share` (0: the bottom) up to the one at `next` (1: the top), over the whole width.
    pub(super) fn space_between_shelves(&self, share: f32, next: f32) -> ([f32; 3], [f32; 3]) {
        let height = self.max[1] - self.min[1];
        let surface = |s: f32| {
            if s <= 0.0 {
                self.min[1] + BOARD_M
            } else {
                self.min[1] + s * height + 0.5 * BOARD_M
            }
        };
        let ceiling = |s: f32| {
            if s >= 1.0 {
                self.max[1] - BOARD_M
            } else {
                self.min[1] + s * height - 0.5 * BOARD_M
            }
        };
        (
            [self.min[0] + BOARD_M, surface(share), self.min[2] + BACK_M],
            [self.max[0] - BOARD_M, ceiling(next), self.max[2] - 0.01],
        )
    }
}

impl FrontStyle {
    /// Adds the frame of a panel to a leaf between two corners whose face is at `z`.
    fn trim(&self, leaf: PartBuilder, low: [f32; 2], high: [f32; 2], z: f32) -> PartBuilder {
        const BAR_M: f32 = 0.045;
        let (width, height) = (high[0] - low[0], high[1] - low[1]);
        if !self.panelled || width.min(height) < 3.2 * BAR_M {
            return leaf;
        }
        let (x, y) = (0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]));
        let shade = Finish {
            srgb: self.board.srgb.map(|c| (f32::from(c) * 0.88) as u8),
            ..self.board.clone()
        };
        let edge = BAR_M + 0.004;
        leaf.with(
            &self.board,
            frame(width, height, BAR_M, 0.005)
                .translated(x, y, z)
                .visual_only(),
        )
        .with(
            &shade,
            block(
                [low[0] + edge, low[1] + edge, z],
                [high[0] - edge, high[1] - edge, z + 0.0015],
            )
            .visual_only(),
        )
    }
}

/// A door in front of a carcass: from the lower left corner (x, y) to the upper right one, its back at z. The handle is an
/// upright bar at the right edge, or at the left one.
pub(super) fn door(
    name: &'static str,
    low: [f32; 2],
    high: [f32; 2],
    z: f32,
    handle_right: bool,
    front: &FrontStyle,
) -> PartBuilder {
    let leaf = block([low[0], low[1], z], [high[0], high[1], z + BOARD_M]);
    let x = if handle_right {
        high[0] - 0.04
    } else {
        low[0] + 0.04
    };
    let middle = if low[1] > 1.2 {
        low[1] + 0.12
    } else {
        (high[1] - 0.12).min(1.05_f32.max(0.5 * (low[1] + high[1])))
    };
    let half = 0.07_f32.min(0.3 * (high[1] - low[1]));
    let face = z + BOARD_M;
    let pull = if front.knobs {
        knob(x, middle, face)
    } else {
        vertical_handle(x, middle - half, middle + half, face)
    };
    front
        .trim(
            PartBuilder::new(name).with(&front.board, leaf),
            low,
            high,
            face,
        )
        .with(&front.handle, pull)
}

/// A round knob on the face at `z`.
fn knob(x: f32, y: f32, z: f32) -> SolidMesh {
    let stem = cylinder(0.006, 0.014, 8).visual_only();
    stem.merged(cylinder(0.014, 0.014, 14).translated(0.0, 0.012, 0.0))
        .rotated_x(FRAC_PI_2)
        .translated(x, y, z)
}

/// An upright bar handle on the face at `z`.
pub(super) fn vertical_handle(x: f32, low: f32, high: f32, z: f32) -> SolidMesh {
    let bar = rod(
        [x, low - 0.015, z + 0.025],
        [x, high + 0.015, z + 0.025],
        0.005,
    );
    let foot = |y: f32| rod([x, y, z], [x, y, z + 0.022], 0.004).visual_only();
    bar.merged(foot(low)).merged(foot(high))
}

/// A level bar handle on the face at `z`.
pub(super) fn horizontal_handle(x: f32, y: f32, z: f32, half: f32) -> SolidMesh {
    let bar = rod(
        [x - half - 0.015, y, z + 0.025],
        [x + half + 0.015, y, z + 0.025],
        0.005,
    );
    let foot = |x: f32| rod([x, y, z], [x, y, z + 0.022], 0.004).visual_only();
    bar.merged(foot(x - half)).merged(foot(x + half))
}

/// A drawer: its front from the lower left corner to the upper right one with its back at z, and a box of `depth_m` behind.
pub(super) fn drawer(
    name: &'static str,
    low: [f32; 2],
    high: [f32; 2],
    z: f32,
    depth_m: f32,
    front: &FrontStyle,
) -> PartBuilder {
    let (x0, x1) = (low[0] + 0.025, high[0] - 0.025);
    let (y0, y1) = (low[1] + 0.02, high[1] - 0.03);
    let thin = 0.012;
    let walls = [
        block([x0, y0, z - depth_m], [x0 + thin, y1, z]),
        block([x1 - thin, y0, z - depth_m], [x1, y1, z]),
        block(
            [x0 + thin, y0, z - depth_m],
            [x1 - thin, y1, z - depth_m + thin],
        ),
        block(
            [x0 + thin, y0, z - depth_m + thin],
            [x1 - thin, y0 + thin, z],
        ),
    ];
    let wood = crate::finishes::pine();
    let face = z + BOARD_M;
    let half = 0.08_f32.min(0.25 * (high[0] - low[0]));
    let (x, y) = (0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]));
    let pull = if front.knobs {
        knob(x, y, face)
    } else {
        horizontal_handle(x, y, face, half)
    };
    let leaf = block([low[0], low[1], z], [high[0], high[1], face]);
    front
        .trim(
            PartBuilder::new(name).with(&front.board, leaf),
            low,
            high,
            face,
        )
        .with_all(&wood, walls)
        .with(&front.handle, pull)
}

/// The free space in a [`drawer`].
pub(super) fn drawer_space(
    low: [f32; 2],
    high: [f32; 2],
    z: f32,
    depth_m: f32,
) -> ([f32; 3], [f32; 3]) {
    (
        [low[0] + 0.037, low[1] + 0.032, z - depth_m + 0.012],
        [high[0] - 0.037, high[1] - 0.03, z],
    )
}
