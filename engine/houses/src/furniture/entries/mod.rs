//! How entries of the catalogue draw sizes and looks of the models that take them as arguments.

pub(super) mod bath;
pub(super) mod kitchen;
pub(super) mod living;
pub(super) mod sleeping;
pub(super) mod small;
pub(super) mod walls;

use super::style::Style;
use crate::furniture::draw::Draw;
use crate::furniture::finish::{Finish, lampshade};
use crate::furniture::models::lamps::linen_shade;

/// A lit shade in a calm tone of the style.
fn shade(style: &Style, d: &Draw) -> Finish {
    if d.chance("linen", 0.5) {
        linen_shade()
    } else {
        let tone = style.cloths[d.below("shade", 2)].srgb;
        lampshade("lampshade", tone)
    }
}
