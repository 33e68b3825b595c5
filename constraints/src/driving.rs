//! A point that follows a prescribed motion.

use crate::check::{markers, moves_linearly};
use ropewalk_core::build::{BuildError, finite};
use ropewalk_core::{Jet, Joint, Marker, Motion, Node, Place, Relation, RowKind, V3, lift};
use std::sync::Arc;

/// A marker follows a motion: `x - x_0 - X(t) = 0`, three equations.
///
/// Use it for: the end of a hose on a moving ship, a vehicle's path. The reaction is what it takes to drive it.
#[derive(Clone, Debug)]
pub struct Driving {
    /// Where the marker starts, `x_0` [m].
    pub start: V3<f64>,
    /// The displacement from there, `X(t)`.
    pub motion: Arc<dyn Motion>,
    /// Whether the marker moves linearly with its node: it isn't beside the point of a rigid body.
    pub linear: bool,
}

impl Driving {
    /// Drives a marker that starts at `start`; defined for as long as the motion.
    ///
    /// # Errors
    /// A marker on the ground or on a node without position; a start that isn't finite.
    pub fn joint(
        name: impl Into<String>,
        nodes: &[Node],
        marker: Marker,
        start: V3<f64>,
        motion: Arc<dyn Motion>,
    ) -> Result<Joint<Self>, BuildError> {
        let name = name.into();
        finite(&format!("{name}: start"), &start)?;
        markers(&name, nodes, &[marker])?;
        let (linear, range) = (moves_linearly(nodes, &marker), motion.range());
        Ok(Joint::new(name, Driving { start, motion, linear }, vec![marker]).within(range))
    }
}

impl Relation for Driving {
    fn rows(&self) -> Vec<RowKind> {
        vec![RowKind::Position; 3]
    }
    fn linear(&self) -> bool {
        self.linear
    }
    fn g<S: Jet>(&self, t: S, at: &[Place<S>], g: &mut [S]) {
        let m = self.motion.at(t.re());
        for i in 0..3 {
            g[i] = at[0].x[i] - self.start[i] - lift(t, [m.x[i], m.v[i], m.a[i]]);
        }
    }
}
