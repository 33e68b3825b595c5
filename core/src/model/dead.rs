//! Dead loads: forces that never change.

use crate::algebra::lane::{V3, dot};
use crate::error::{BuildError, need};
use crate::model::held::{Held, Pull, pull};
use crate::model::marker::Marker;
use crate::model::node::Node;
use crate::model::pattern::Pattern;
use crate::model::state::At;
use crate::model::term::{Assembly, Energy, Term, Weights};

/// One component of a dead load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeadEntry {
    /// Index of the velocity (and equation) that it acts on.
    pub dof: usize,
    /// Index of the coordinate that goes with it.
    pub coordinate: usize,
    /// Generalised force [N, for a position].
    pub value: f64,
}

/// A constant vector of generalised forces, worked out once: weight, buoyancy.
///
/// The shape functions of an element carry a weight to its nodes once and for all; during a run only this vector is
/// added. Its potential energy is `-F·q`, so it acts only on coordinates that move by addition: not on orientations.
#[derive(Clone, Debug, PartialEq)]
pub struct DeadLoad {
    /// A name, such as `hose: weight`.
    pub label: String,
    /// Its components; several may act on the same coordinate.
    pub entries: Vec<DeadEntry>,
}

impl DeadLoad {
    /// A dead load of these components.
    ///
    /// # Errors
    /// A component that isn't finite.
    pub fn new(label: impl Into<String>, entries: Vec<DeadEntry>) -> Result<Self, BuildError> {
        let label = label.into();
        for e in &entries {
            need(e.value.is_finite(), || format!("{label}: force on unknown {} isn't finite", e.dof))?;
        }
        Ok(DeadLoad { label, entries })
    }

    /// The components of a force in space [N] on a marker; none on ground.
    ///
    /// # Errors
    /// A marker beside the point of a rigid body, or on a node without position.
    pub fn at_marker(nodes: &[Node], marker: &Marker, force: V3<f64>) -> Result<Vec<DeadEntry>, BuildError> {
        match Held::new(nodes, marker, "dead load")? {
            Held::Ground(_) => Ok(Vec::new()),
            Held::Beside { .. } | Held::Lever { .. } | Held::Between { .. } => {
                Err(BuildError::new("a dead load on a body beside its node turns it, which isn't constant"))
            }
            Held::Moves { q, v } => Ok((0..3)
                .filter(|&i| force[i] != 0.0)
                .map(|i| DeadEntry { dof: v + i, coordinate: q + i, value: force[i] })
                .collect()),
        }
    }
}

impl Term for DeadLoad {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, _: &mut Pattern) {}
    fn has_tangent(&self, _: &Weights) -> bool {
        false
    }
    fn is_load(&self) -> bool {
        true
    }
    fn add(&self, _: &At<'_>, out: &mut Assembly<'_>) {
        for e in &self.entries {
            out.add(e.dof, -e.value);
        }
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let work: f64 = self.entries.iter().map(|e| e.value * at.q[e.coordinate]).sum();
        Energy { potential: -work, ..Energy::default() }
    }
}

/// A constant force in space on a point whose way back to its node changes, such as buoyancy beside the centre of mass
/// of a rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct DeadPull {
    /// A name, such as `vehicle: buoyancy`.
    pub label: String,
    /// Where it acts.
    pub held: Held,
    /// The force [N].
    pub force: V3<f64>,
}

impl Term for DeadPull {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(self.held.dofs());
    }
    fn symmetric(&self) -> bool {
        !matches!(self.held, Held::Beside { .. })
    }
    fn is_load(&self) -> bool {
        true
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let force = Pull { f: self.force, ..Pull::default() };
        pull(&[Held::Ground([0.0; 3]), self.held], at, &force, 0, out);
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        Energy { potential: -dot(&self.force, &self.held.x(at)), ..Energy::default() }
    }
}
