//! Two points at a fixed distance.

use crate::check::markers;
use ropewalk_core::build::{BuildError, positive};
use ropewalk_core::{Jet, Joint, Marker, Node, Place, Relation, RowKind};

/// Two markers stay at a distance: `|x_1 - x_0| - L = 0`, one equation; a massless rod with a ball at each end.
///
/// The points must start at about that distance: where they coincide the rod has no direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// The distance `L` [m].
    pub length: f64,
}

impl Distance {
    /// The rod between two markers, one of which may be on the ground.
    ///
    /// # Errors
    /// A length that isn't above zero (hold the points together by [`Spherical`](crate::Spherical) instead); markers as
    /// for that one.
    pub fn joint(
        name: impl Into<String>,
        nodes: &[Node],
        between: [Marker; 2],
        length: f64,
    ) -> Result<Joint<Self>, BuildError> {
        let name = name.into();
        positive("length", length)?;
        markers(&name, nodes, &between)?;
        Ok(Joint::new(name, Distance { length }, between.to_vec()))
    }
}

impl Relation for Distance {
    fn rows(&self) -> Vec<RowKind> {
        vec![RowKind::Position]
    }
    fn g<S: Jet>(&self, _: S, at: &[Place<S>], g: &mut [S]) {
        let d: [S; 3] = std::array::from_fn(|i| at[1].x[i] - at[0].x[i]);
        g[0] = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt() - self.length;
    }
}
