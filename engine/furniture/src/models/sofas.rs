//! Sofas and armchairs: the same build with more or fewer seats.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, oak, upholstery};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{SolidMesh, block, cushion, cylinder, rounded_block, tapered_leg};
use crate::style::{LegStyle, Style};
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("sofa", "sofa", 0, sofa),
    CatalogueEntry::new("armchair", "armchair", 1, armchair),
];

/// The construction of a seat's arms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ArmStyle {
    /// An upholstered block.
    Block,
    /// An upholstered panel under a roll.
    Rolled,
    /// A frame of wood.
    Wood,
}

/// An upholstered seat for one or more.
#[derive(Clone, Debug)]
struct Sofa {
    /// Seats beside each other.
    seats: usize,
    /// Width of one seat, m.
    seat_width_m: f32,
    /// m.
    depth_m: f32,
    /// Height of the back, m.
    back_m: f32,
    /// The shape of the arm rests.
    arm: ArmStyle,
    /// Width of an arm, m.
    arm_m: f32,
    /// Height of the arms, m.
    arm_top_m: f32,
    /// Height of the legs, m.
    leg_m: f32,
    /// Finish of the cushions' covers.
    cover: Finish,
    /// Finish of the frame.
    wood: Finish,
}

impl Default for Sofa {
    fn default() -> Self {
        let cover = upholstery("slate_blue_cloth", [92, 112, 134]);
        Self {
            seats: 3,
            seat_width_m: 0.62,
            depth_m: 0.92,
            back_m: 0.82,
            arm: ArmStyle::Block,
            arm_m: 0.15,
            arm_top_m: 0.6,
            leg_m: 0.12,
            cover,
            wood: oak(),
        }
    }
}

impl Sofa {
    /// An armchair of the same family.
    fn armchair(cover: Finish) -> Self {
        Self {
            seats: 1,
            seat_width_m: 0.56,
            depth_m: 0.82,
            back_m: 0.86,
            cover,
            ..Self::default()
        }
    }

    /// The model of these sizes and finishes.
    fn build(&self) -> Model {
        let inner = 0.5 * self.seat_width_m * self.seats as f32;
        let (x, z) = (inner + self.arm_m, 0.5 * self.depth_m);
        let mut body = PartBuilder::new("body")
            .with_padding(
                &self.cover,
                rounded_block([-x, self.leg_m, -z], [x, 0.28, z - 0.03], 0.03, 1),
            )
            .with_padding(
                &self.cover,
                rounded_block([-x, 0.28, -z], [x, self.back_m - 0.06, -z + 0.16], 0.06, 2),
            );
        for side in [-1.0_f32, 1.0] {
            body = self.add_arm(body, side * x, side * inner, z);
            for depth in [-z + 0.1, z - 0.12] {
                let leg = side * (x - 0.1);
                body = body.with(
                    &self.wood,
                    tapered_leg([leg, 0.0, depth], [leg, self.leg_m, depth], 0.03, 0.05),
                );
            }
        }
        for k in 0..self.seats {
            let left = -inner + self.seat_width_m * k as f32 + 0.004;
            let right = left + self.seat_width_m - 0.008;
            body = body
                .with_padding(
                    &self.cover,
                    cushion([left, 0.28, -z + 0.16], [right, 0.45, z]),
                )
                .with_padding(
                    &self.cover,
                    cushion([left, 0.44, -z + 0.15], [right, self.back_m, -z + 0.34]),
                );
        }
        let (name, category) = if self.seats == 1 {
            ("armchair", "armchair")
        } else {
            ("sofa", "sofa")
        };
        Model::movable(name, category)
            .part(body)
            .with_support_surface(
                "seat",
                [-inner + 0.02, 0.45, -z + 0.34],
                [inner - 0.02, 0.95, z - 0.04],
            )
    }

    /// The arm between its outer face at x = `outer` and the seat at x = `inner`.
    fn add_arm(&self, body: PartBuilder, outer: f32, inner: f32, z: f32) -> PartBuilder {
        let (left, right) = (outer.min(inner), outer.max(inner));
        let (back, front, top) = (-z + 0.16, z - 0.02, self.arm_top_m);
        let padded = |low: f32, high: f32, radius: f32| {
            rounded_block([left, low, back], [right, high, front], radius, 2)
        };
        match self.arm {
            ArmStyle::Block => body.with_padding(&self.cover, padded(0.28, top, 0.06)),
            ArmStyle::Rolled => {
                let radius = 0.5 * self.arm_m;
                let roll = cylinder(radius, front - back, 18)
                    .rotated_x(std::f32::consts::FRAC_PI_2)
                    .translated(0.5 * (left + right), top - radius, back);
                // Into the back, and short of the roll's end: faces in one plane would show through each other.
                let panel = [
                    [left + 0.02, 0.28, back - 0.02],
                    [right - 0.02, top - radius, front - 0.01],
                ];
                body.with_padding(&self.cover, block(panel[0], panel[1]))
                    .with_padding(&self.cover, roll)
            }
            ArmStyle::Wood => {
                let (low, middle) = (0.28, 0.5 * (left + right));
                let post = |at: f32| {
                    block(
                        [middle - 0.02, low, at - 0.025],
                        [middle + 0.02, top - 0.03, at + 0.025],
                    )
                };
                let rest = rounded_block(
                    [left, top - 0.03, back - 0.02],
                    [right, top, front],
                    0.012,
                    1,
                );
                [post(front - 0.06), post(back + 0.06)]
                    .into_iter()
                    .fold(body, |body: PartBuilder, solid: SolidMesh| {
                        body.with(&self.wood, solid)
                    })
                    .with(&self.wood, rest)
            }
        }
    }
}

/// Builds and proportions that seats of one family share.
fn sample_seating(style: &Style, d: &SizeSampler, cover: Finish) -> Sofa {
    let arm = match style.leg {
        LegStyle::Turned => d.choose("arm", [ArmStyle::Rolled, ArmStyle::Rolled, ArmStyle::Block]),
        LegStyle::Metal => ArmStyle::Block,
        LegStyle::Tapered | LegStyle::Square => {
            d.choose("arm", [ArmStyle::Block, ArmStyle::Block, ArmStyle::Wood])
        }
    };
    Sofa {
        arm,
        arm_m: match arm {
            ArmStyle::Block => d.range("arm_m", 0.09, 0.2),
            ArmStyle::Rolled => d.range("arm_m", 0.14, 0.19),
            ArmStyle::Wood => 0.06,
        },
        arm_top_m: d.range("arm_top", 0.54, 0.65),
        leg_m: d.range("leg", 0.07, 0.18),
        depth_m: d.sample_m("depth"),
        back_m: d.sample_m("height"),
        wood: style.wood.clone(),
        ..Sofa::armchair(cover)
    }
}

fn sofa(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("sofa", key);
    let family = sample_seating(
        style,
        &d,
        style.random_upholstery(&mut d.stream("cover")).clone(),
    );
    let width = d.sample_m("width") - 2.0 * family.arm_m;
    let seats = ((width / 0.64).round() as usize).clamp(2, 3);
    Sofa {
        seats,
        seat_width_m: width / seats as f32,
        ..family
    }
    .build()
}

fn armchair(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("armchair", key);
    let family = sample_seating(
        style,
        &d,
        style.random_upholstery(&mut d.stream("cover")).clone(),
    );
    Sofa {
        seat_width_m: d.sample_m("width") - 2.0 * family.arm_m,
        ..family
    }
    .build()
}
