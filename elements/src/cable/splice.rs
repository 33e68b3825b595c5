//! Splices, which join two sections that each have a node of their own.
//!
//! Neighbours of an ANCF cable share the slope `r'`, and with it the strain. Where the axial stiffness changes, equal strains
//! would be unequal tensions, so two sections that stretch differently have a node each, at the same arc length, and a
//! splice joins them: their points coincide and their tangents are parallel, the stretch of each is its own.

use super::section::{Section, SectionAlong};
use ropewalk_core::rotation::{around, cross};
use ropewalk_core::{
    BuildError, Equation, Jet, Joint, Marker, NodeId, Place, Related, Relation, RowKind, V3,
};
use ropewalk_scene::Builder;

/// Where two sections are joined that each have a node of their own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Splice {
    /// The node at the end of the section before; the next one is at the start of the section behind.
    pub node: usize,
    /// Whether the sections turn freely against each other, since one of them resists no bending.
    pub hinged: bool,
}

/// The splice between two sections; none where they can share a node.
pub(super) fn splice(a: &Section, along: &SectionAlong, node: usize) -> Option<Splice> {
    let b = &along.section;
    let limp = [a, b].map(|s| s.ei.largest() == 0.0 && s.bending_moment.is_none());
    // of ropes that turn when they are pulled, equal strains are equal tensions only if all of this is equal
    let laid = |s: &Section| (s.torque_tension, if s.torque_tension == 0.0 { None } else { s.gj });
    let stretches =
        |s: &Section| (s.ea, s.axial_force.clone(), s.tension_only, s.axial_retardation_time, laid(s));
    let alike = stretches(a) == stretches(b);
    if alike && limp[0] == limp[1] && !along.hinged {
        return None;
    }
    Some(Splice { node, hinged: limp[0] || limp[1] || along.hinged })
}

impl Splice {
    /// Joins its two nodes, where tangents have this direction at the start.
    pub fn join(
        self,
        b: &mut Builder,
        name: String,
        nodes: &[NodeId],
        direction: V3<f64>,
        twists: bool,
    ) -> Result<(), BuildError> {
        let markers = [nodes[self.node], nodes[self.node + 1]].map(Marker::node);
        let mut equations = Equation::coincide();
        if self.hinged {
            return b.constraint(Joint::new(name, b.nodes(), markers, equations)?);
        }
        if twists {
            // both sections look the same way as they are laid
            equations.extend([(0, 1), (1, 2), (2, 0)].map(|(i, k)| Equation::normal(i, k)));
            return b.constraint(Joint::new(name, b.nodes(), markers, equations)?);
        }
        let [across, _, along] = around(direction);
        b.constraint(Related::new(name, Tangents { along, across }, markers.to_vec()))
    }
}

/// Two cables end at the same point with the same tangent, and each has its own stretch there.
///
/// The tangent of the second is normal to two vectors that are normal to the tangent `t` of the first: those which the
/// smallest rotation to `t` makes of two vectors across the first direction. No such pair is continuous for all directions;
/// where `t` has turned far from the first direction, the rotation begins at the opposite one.
#[derive(Clone, Copy, Debug)]
struct Tangents {
    /// The first direction, a unit vector, and one across it.
    along: V3<f64>,
    across: V3<f64>,
}

/// Cosine of the angle from which on the rotation begins at the opposite direction: no angle at which anything comes to rest.
const FAR: f64 = -0.4321;

impl Relation for Tangents {
    fn rows(&self) -> Vec<RowKind> {
        vec![RowKind::Position, RowKind::Position, RowKind::Position, RowKind::Direction, RowKind::Direction]
    }
    fn g<S: Jet>(&self, _t: S, at: &[Place<S>], g: &mut [S]) {
        for i in 0..3 {
            g[i] = at[1].x[i] - at[0].x[i];
        }
        let (p, q) = (at[0].axes[0], at[1].axes[0]);
        let size = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
        let t = p.map(|p| p / size);
        let along = |e: &V3<f64>| t[0] * e[0] + t[1] * e[1] + t[2] * e[2];
        let from = if along(&self.along).re() > FAR { self.along } else { self.along.map(|x| -x) };
        let turn = along(&self.across) / (along(&from) + 1.0);
        let u: V3<S> = std::array::from_fn(|i| (t[i] + from[i]) * -turn + self.across[i]);
        let w = cross(&t, &u);
        g[3] = q[0] * u[0] + q[1] * u[1] + q[2] * u[2];
        g[4] = q[0] * w[0] + q[1] * w[1] + q[2] * w[2];
    }
}
