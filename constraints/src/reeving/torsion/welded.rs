//! Ends of two spans whose sections look alike.

use crate::reeving::arc::angle;
use ropewalk_core::rotation::along;
use ropewalk_core::{Jet, Place, Relation, RowKind};

/// The section at the end of a span and that at the start of the next look alike, one carried to the other by the smallest rotation:
/// of a cable that turns sharply in between, as in a ring. The markers are those of [`end`](crate::reeving::tangent::end).
pub(in crate::reeving) struct Welded;

impl Relation for Welded {
    fn rows(&self) -> Vec<RowKind> {
        vec![RowKind::Direction]
    }
    fn g<S: Jet>(&self, _t: S, at: &[Place<S>], g: &mut [S]) {
        let ([t1, d1, n1], [t2, d2, n2]) = (&at[0].axes, &at[1].axes);
        let across = along(n1, d2) - along(d1, n2);
        g[0] = angle(across, along(d1, d2) + along(n1, n2) + along(t1, t2) + 1.0) * 2.0;
    }
}
