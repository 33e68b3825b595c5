//! What becomes of the sections of a cable with torsion where its elements are split and merged.
//!
//! A new node is turned such that both pieces have the same twist per length, which is that of the whole but for the order of
//! the mesh, and spins with the material there. A merge keeps the sections at both ends, and so the sum of the twists.

use super::change::Snapshot;
use crate::cable::torsion::Torsion;
use ropewalk_core::V3;
use ropewalk_core::model::twist::{FOLDS, across, carried, folds, tangent};
use std::f64::consts::TAU;

/// The sections at the nodes of a line, and what twists within its elements.
#[derive(Clone, Debug)]
pub(crate) struct Sections {
    /// Reference directors, the angles from these [rad], and the spins [rad/s].
    pub u: Vec<V3<f64>>,
    pub angle: Vec<f64>,
    pub spin: Vec<f64>,
    /// The bubble of each element and its rate; zero where it has none.
    pub bubble: Vec<[f64; 2]>,
    /// By how much the material at the start and at the end of the line is turned against the nodes there [rad], and the
    /// rates of that.
    pub fed: [[f64; 2]; 2],
}

/// How the material of an element is twisted and spins: twist [rad], and the spins at both its ends [rad/s].
pub(super) struct Turning {
    twist: f64,
    spin: [f64; 2],
}

impl Snapshot {
    /// Coordinates of node `i`.
    fn node(&self, sections: &Sections, i: usize) -> [f64; 10] {
        let (r, s, u) = (self.r[i], self.s[i], sections.u[i]);
        [r[0], r[1], r[2], s[0], s[1], s[2], u[0], u[1], u[2], sections.angle[i]]
    }

    /// Twist of element `k`, with what has been fed into it.
    fn twist(&self, sections: &Sections, k: usize) -> f64 {
        let (a, b) = (self.node(sections, k), self.node(sections, k + 1));
        let both = std::array::from_fn(|i| if i < 10 { a[i] } else { b[i - 10] });
        let fed = self.fed(sections, k).map(|fed| fed[0]);
        Torsion::twist(&both, self.l(k)) + fed[1] - fed[0]
    }

    /// What is turned by feeding at either end of element `k`.
    fn fed(&self, sections: &Sections, k: usize) -> [[f64; 2]; 2] {
        let is = [k == 0, k + 2 == self.p.len()];
        std::array::from_fn(|end| if is[end] { sections.fed[end] } else { [0.0; 2] })
    }

    /// Of element `k`; `None` without torsion.
    pub(super) fn turning(&self, k: usize) -> Option<Turning> {
        let sections = self.sections.as_ref()?;
        let (twist, fed) = (self.twist(sections, k), self.fed(sections, k));
        let at = |end: usize| sections.spin[k + end] + fed[end][1] - self.pd[k + end] * twist / self.l(k);
        Some(Turning { twist, spin: [at(0), at(1)] })
    }

    /// Lets the nodes of element `k` spin such that its material does so at its ends.
    fn spins(&mut self, k: usize, material: [f64; 2]) {
        let Some(mut sections) = self.sections.take() else { return };
        let (per_length, fed) = (self.twist(&sections, k) / self.l(k), self.fed(&sections, k));
        for (end, spin) in material.into_iter().enumerate() {
            sections.spin[k + end] = spin - fed[end][1] + self.pd[k + end] * per_length;
        }
        self.sections = Some(sections);
    }

    /// Turns the node that element `k` has been split at, which stands on its material at the share `xi` of its length.
    pub(super) fn split_twist(&mut self, k: usize, xi: f64, was: Turning) {
        let Some(mut sections) = self.sections.take() else { return };
        let (from, here) = (self.node_tangent(k), self.node_tangent(k + 1));
        let u = across(&carried(&sections.u[k], &from, &here), &here);
        let ([bubble, rate], bump) = (sections.bubble[k], 4.0 * xi * (1.0 - xi));
        let [a, b] = was.spin;
        let spin = a + xi * (b - a) + bump * rate;
        sections.u.insert(k + 1, u);
        sections.angle.insert(k + 1, sections.angle[k]);
        sections.spin.insert(k + 1, spin);
        let piece = |share: f64| [share * share * bubble, share * share * rate];
        sections.bubble[k] = piece(xi);
        sections.bubble.insert(k + 1, piece(1.0 - xi));
        let [first, second] = [self.twist(&sections, k), self.twist(&sections, k + 1)];
        sections.angle[k + 1] += xi * second - (1.0 - xi) * first + bump * bubble;
        self.sections = Some(sections);
        self.spins(k, [a, spin]);
        self.spins(k + 1, [spin, b]);
    }

    /// Takes the sections at node `k` out, after the node itself, between elements that were twisted like these, the first of
    /// which had the share `xi` of the length; `before` are the tangents that the nodes had.
    pub(super) fn merge_twist(
        &mut self,
        k: usize,
        xi: f64,
        was: [Turning; 2],
        before: [V3<f64>; 2],
    ) -> Result<(), String> {
        let Some(mut sections) = self.sections.take() else { return Ok(()) };
        for list in [&mut sections.angle, &mut sections.spin] {
            list.remove(k);
        }
        sections.u.remove(k);
        sections.bubble.remove(k);
        for (i, old) in [k - 1, k].into_iter().zip(&before) {
            let now = self.node_tangent(i);
            sections.u[i] = across(&carried(&sections.u[i], old, &now), &now);
        }
        if folds([&self.node(&sections, k - 1), &self.node(&sections, k)]) {
            return Err(FOLDS.into());
        }
        let whole = was[0].twist + was[1].twist;
        sections.bubble[k - 1] = [(was[0].twist - xi * whole) / (4.0 * xi * (1.0 - xi)), 0.0];
        // angles count whole turns, which directors alone don't tell
        let lost = ((whole - self.twist(&sections, k - 1)) / TAU).round() * TAU;
        sections.angle[k..].iter_mut().for_each(|angle| *angle += lost);
        self.sections = Some(sections);
        self.spins(k - 1, [was[0].spin[0], was[1].spin[1]]);
        Ok(())
    }

    /// Tangent at node `i`.
    pub(super) fn node_tangent(&self, i: usize) -> V3<f64> {
        let [x, y, z] = self.s[i];
        tangent(&[0.0, 0.0, 0.0, x, y, z])
    }
}
