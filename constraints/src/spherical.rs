//! Two points held together.

use crate::check::{markers, moves_linearly};
use ropewalk_core::build::BuildError;
use ropewalk_core::{Jet, Joint, Marker, Node, Place, Relation, RowKind};

/// Two markers are at the same point: `x_1 - x_0 = 0`, three equations. Directions stay free.
///
/// Use it for: pinning a cable's end to the ground or to a body, the links of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spherical {
    /// Whether both markers move linearly with their nodes: no marker beside the point of a rigid body.
    pub linear: bool,
}

impl Spherical {
    /// The joint of two markers, one of which may be on the ground.
    ///
    /// # Errors
    /// Both on the ground or on the same node; a node without position.
    pub fn joint(
        name: impl Into<String>,
        nodes: &[Node],
        between: [Marker; 2],
    ) -> Result<Joint<Self>, BuildError> {
        let name = name.into();
        markers(&name, nodes, &between)?;
        let linear = between.iter().all(|m| moves_linearly(nodes, m));
        Ok(Joint::new(name, Spherical { linear }, between.to_vec()))
    }
}

impl Relation for Spherical {
    fn rows(&self) -> Vec<RowKind> {
        vec![RowKind::Position; 3]
    }
    fn linear(&self) -> bool {
        self.linear
    }
    fn g<S: Jet>(&self, _: S, at: &[Place<S>], g: &mut [S]) {
        for i in 0..3 {
            g[i] = at[1].x[i] - at[0].x[i];
        }
    }
}
