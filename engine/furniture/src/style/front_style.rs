//! The appearance of doors and drawers.

use crate::finishes::Finish;

/// Finishes, handles and panels of the fronts of doors and drawers.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontStyle {
    /// The board's finish.
    pub board: Finish,
    /// The handle's finish.
    pub handle: Finish,
    /// Round knobs instead of bars.
    pub knobs: bool,
    /// A frame around a panel instead of a plain board.
    pub panelled: bool,
}
