//! One coordinate of a point, held or driven.

use crate::check::{markers, moves_linearly, unit};
use ropewalk_core::build::{BuildError, finite};
use ropewalk_core::{Jet, Joint, Marker, Motion, Node, Place, Relation, RowKind, V3, lift};
use std::sync::Arc;

/// A marker stays in a plane, or in a plane that moves: `d·(x - x_0 - X(t)) = 0`, one equation.
///
/// Use it for: symmetry planes, a slider (two of them), a ship that holds a depth but not a course.
#[derive(Clone, Debug)]
pub struct Coordinate {
    /// Unit normal of the plane, `d`.
    pub direction: V3<f64>,
    /// A point of the plane, `x_0` [m].
    pub start: V3<f64>,
    /// Displacement of the plane, `X(t)`; `None` if it is at rest.
    pub motion: Option<Arc<dyn Motion>>,
    /// Whether the marker moves linearly with its node: it isn't beside the point of a rigid body.
    pub linear: bool,
}

impl Coordinate {
    /// Holds a marker in the plane through `start` with normal `direction` (of any length).
    ///
    /// # Errors
    /// A direction without length; a start that isn't finite; a marker on the ground or on a node without position.
    pub fn joint(
        name: impl Into<String>,
        nodes: &[Node],
        marker: Marker,
        direction: V3<f64>,
        start: V3<f64>,
        motion: Option<Arc<dyn Motion>>,
    ) -> Result<Joint<Self>, BuildError> {
        let name = name.into();
        let direction = unit("direction", direction)?;
        finite(&format!("{name}: start"), &start)?;
        markers(&name, nodes, &[marker])?;
        let linear = moves_linearly(nodes, &marker);
        let range = motion.as_ref().map_or((f64::NEG_INFINITY, f64::INFINITY), |m| m.range());
        Ok(Joint::new(name, Coordinate { direction, start, motion, linear }, vec![marker]).within(range))
    }
}

impl Relation for Coordinate {
    fn rows(&self) -> Vec<RowKind> {
        vec![RowKind::Position]
    }
    fn linear(&self) -> bool {
        self.linear
    }
    fn g<S: Jet>(&self, t: S, at: &[Place<S>], g: &mut [S]) {
        let m = self.motion.as_ref().map(|m| m.at(t.re())).unwrap_or_default();
        g[0] = S::zero();
        for i in 0..3 {
            g[0] += (at[0].x[i] - self.start[i] - lift(t, [m.x[i], m.v[i], m.a[i]])) * self.direction[i];
        }
    }
}
