//! Persons: what their figure looks like, how far they are in their step, and what they look at and reach for.
//!
//! What stands here is plain data; [`crate::person`] makes a figure's joints and pieces of it.

use crate::random::RandomKey;
use glam::{Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A side of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The left one.
    Left,
    /// The right one.
    #[default]
    Right,
}

/// The colours of a person, sRGB, 0 to 255; what is not stated is drawn from the episode's key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PersonColors {
    /// Of the skin.
    pub skin: Option<[u8; 3]>,
    /// Of the hair.
    pub hair: Option<[u8; 3]>,
    /// Of what the upper body wears.
    pub shirt: Option<[u8; 3]>,
    /// Of what the legs wear.
    pub trousers: Option<[u8; 3]>,
    /// Of the shoes.
    pub shoes: Option<[u8; 3]>,
}

/// What makes a body a person's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PersonBody {
    /// The hand that holds and reaches.
    pub hand: Side,
    /// Stated colours.
    pub colors: PersonColors,
}

impl PersonBody {
    /// The range of a person's height, m.
    pub const HEIGHT_RANGE_M: [f32; 2] = [1.45, 2.0];
    /// A person's height where none is stated, m.
    pub const HEIGHT_M: f32 = 1.7;
    /// Eye height as a part of the height.
    ///
    /// # Source
    /// R. Drillis, R. Contini, "Body Segment Parameters", Office of Vocational Rehabilitation report 1166-03, New York 1966, as
    /// printed in D. A. Winter, "Biomechanics and Motor Control of Human Movement", 4th edition, 2009, figure 4.1.
    pub const EYE_HEIGHT: f32 = 0.936;
}

/// The colours of a person's skin, hair, shirt, trousers and shoes, sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ResolvedPersonColors {
    /// Of the skin.
    pub skin: [u8; 3],
    /// Of the hair.
    pub hair: [u8; 3],
    /// Of what the upper body wears.
    pub shirt: [u8; 3],
    /// Of what the legs wear.
    pub trousers: [u8; 3],
    /// Of the shoes.
    pub shoes: [u8; 3],
}

/// Skins.
///
/// # Source
/// The patches "light skin" and "dark skin" of the `ColorChecker` (C. S. `McCamy` et al., J. Appl. Photogr. Eng. 2, 1976), and the
/// tones 5, 6 and 8 of E. Monk, "The Monk Skin Tone Scale", 2023. Its lightest are paler than walls when they are lit.
const SKINS: [[u8; 3]; 5] = [
    [194, 150, 130],
    [115, 82, 68],
    [0xd7, 0xbd, 0x96],
    [0xa0, 0x7e, 0x56],
    [0x60, 0x41, 0x34],
];
const HAIRS: [[u8; 3]; 5] = [
    [28, 22, 20],
    [62, 40, 28],
    [110, 72, 44],
    [176, 140, 92],
    [150, 148, 146],
];
const SHIRTS: [[u8; 3]; 8] = [
    [178, 42, 48],
    [44, 88, 160],
    [46, 122, 82],
    [226, 176, 56],
    [232, 230, 224],
    [112, 62, 128],
    [226, 120, 60],
    [60, 146, 158],
];
const TROUSERS: [[u8; 3]; 5] = [
    [38, 50, 84],
    [48, 48, 52],
    [128, 112, 84],
    [86, 92, 98],
    [74, 56, 44],
];
const SHOES: [[u8; 3]; 3] = [[32, 30, 30], [222, 220, 216], [110, 70, 42]];

impl ResolvedPersonColors {
    /// The look of a person: what is stated, and for the rest a draw of `key`.
    pub fn draw(stated: &PersonColors, key: RandomKey) -> Self {
        let pick = |what: &str, table: &[[u8; 3]], stated: Option<[u8; 3]>| {
            let drawn = key.child(what).stream().choose(table).copied();
            stated.or(drawn).unwrap_or_default()
        };
        Self {
            skin: pick("skin", &SKINS, stated.skin),
            hair: pick("hair", &HAIRS, stated.hair),
            shirt: pick("shirt", &SHIRTS, stated.shirt),
            trousers: pick("trousers", &TROUSERS, stated.trousers),
            shoes: pick("shoes", &SHOES, stated.shoes),
        }
    }
}

/// How far a person is in its stride.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PersonGait {
    /// The part of a stride (two steps) that is done, 0 to 1; the left heel comes down at 0.
    pub phase: f32,
    /// Length of the stride, m; 0 while standing.
    pub stride_m: f32,
    /// Where it walks, in its own frame: to the right and ahead; unit length.
    pub direction: Vec2,
}

/// What a person shows with an arm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PointingGesture {
    /// The hand.
    pub hand: Side,
    /// What is pointed at, m; `None`: what is looked at.
    pub at: Option<Vec3>,
}

/// Targets of a person's eyes and hands, in world coordinates, m.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Gesture {
    /// What the head turns to; `None`: where the camera looks.
    pub look_at: Option<Vec3>,
    /// The place of the left palm; `None`: the arm hangs or swings.
    pub left_hand: Option<Vec3>,
    /// The place of the right palm; `None`: the arm hangs or swings.
    pub right_hand: Option<Vec3>,
    /// The hand whose index finger is stretched.
    pub pointing: Option<PointingGesture>,
}

impl Gesture {
    /// The target of a hand.
    pub fn hand_target(&self, side: Side) -> Option<Vec3> {
        match side {
            Side::Left => self.left_hand,
            Side::Right => self.right_hand,
        }
    }

    /// Its points, by name.
    pub fn named_points(&self) -> impl Iterator<Item = (&'static str, Vec3)> {
        let at = self.pointing.and_then(|pointing| pointing.at);
        let named = [
            ("look_at", self.look_at),
            ("left_hand", self.left_hand),
            ("right_hand", self.right_hand),
            ("point_at", at),
        ];
        let stated = |(name, point): (_, Option<Vec3>)| Some((name, point?));
        named.into_iter().filter_map(stated)
    }
}

/// A hand that has just acted on something.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReachGesture {
    /// Where it acted, m.
    pub point: Vec3,
    /// How long it stays there, s.
    pub left_s: f32,
}

/// The state of a person beside that of its agent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PersonState {
    /// Its body, as it was made.
    pub body: PersonBody,
    /// Its colours.
    pub look: ResolvedPersonColors,
    /// Its stride.
    pub gait: PersonGait,
    /// What it looks at and reaches for.
    pub gesture: Gesture,
    /// What its hand acted on a moment ago.
    pub reach: Option<ReachGesture>,
}

impl PersonState {
    /// A person who stands still, with the colours that `key` draws.
    pub fn new(body: PersonBody, key: RandomKey) -> Self {
        Self {
            body,
            look: ResolvedPersonColors::draw(&body.colors, key),
            gait: PersonGait::default(),
            gesture: Gesture::default(),
            reach: None,
        }
    }

    /// Returns whether every number is finite.
    pub(super) fn is_finite(&self) -> bool {
        let gait = &self.gait;
        let reach = self.reach.is_none_or(|reach| {
            reach.point.is_finite() && reach.left_s.is_finite() && reach.left_s >= 0.0
        });
        let stride = gait.stride_m.is_finite() && gait.stride_m >= 0.0;
        (0.0..=1.0).contains(&gait.phase)
            && stride
            && gait.direction.is_finite()
            && reach
            && self
                .gesture
                .named_points()
                .all(|(_, point)| point.is_finite())
    }
}
