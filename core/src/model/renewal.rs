//! Models whose terms couple other unknowns as the state goes on.

use crate::model::Model;
use crate::model::pattern::Pattern;
use crate::model::state::At;
use crate::model::structure::Structure;
use std::sync::OnceLock;

impl Model {
    /// Whether what is coupled depends on the state.
    pub fn recouples(&self) -> bool {
        !self.coupling.is_empty()
    }

    /// The same model as it couples around this state: nodes, states, parts and the order of terms stay. `None` where this
    /// one covers the state as it is, or if nothing in it depends on that; with `anyhow` only the latter.
    pub fn renewed(&self, at: &At<'_>, anyhow: bool) -> Option<Model> {
        if self.coupling.is_empty() {
            return None;
        }
        let mut terms = self.terms.clone();
        let mut any = false;
        for &k in &self.coupling {
            if let Some(new) = self.terms[k].couples().and_then(|c| c.renewed(at, anyhow)) {
                (terms[k], any) = (new, true);
            }
        }
        if !any {
            return None;
        }
        let (mut pattern, mut cliques) = (Pattern::default(), Vec::with_capacity(self.cliques.len()));
        for term in &terms {
            let first = pattern.len();
            term.pattern(&mut pattern);
            cliques.push(first..pattern.len());
        }
        for own in &self.cliques[terms.len()..] {
            let first = pattern.len();
            for k in own.clone() {
                pattern.clique(self.pattern.get(k).iter().map(|&d| d as usize));
            }
            cliques.push(first..pattern.len());
        }
        let structure = if pattern == self.pattern {
            self.structure.clone()
        } else {
            Structure::new(&self.nodes, &self.touched, &pattern, self.structure.symmetric)
        };
        Some(Model { terms, structure, pattern, cliques, ..self.copy() })
    }

    /// What has gone through something between two states that it is only coupled with where they are near.
    pub(crate) fn coupled_passes(&self, before: &At<'_>, after: &At<'_>) -> Option<String> {
        let mut terms = self.coupling.iter().filter_map(|&k| self.terms[k].foresees());
        terms.find_map(|term| term.passes(before, after))
    }

    /// Whether another model of the same scene couples the same.
    pub(crate) fn couples_as(&self, other: &Model) -> bool {
        self.pattern == other.pattern
    }

    /// Keeps a model that this one became, as long as it lives itself.
    pub(crate) fn keep(&self, renewed: Model) -> &Model {
        let mut last = self;
        while let Some(next) = last.next.get() {
            last = next;
        }
        last.next.get_or_init(|| Box::new(renewed))
    }

    fn copy(&self) -> Model {
        Model {
            nodes: self.nodes.clone(),
            terms: Vec::new(),
            constraints: self.constraints.clone(),
            parts: self.parts.clone(),
            start: self.start.clone(),
            switches: self.switches.clone(),
            inputs: self.inputs.clone(),
            controls: self.controls.clone(),
            redundancy: self.redundancy.clone(),
            recipe: self.recipe.clone(),
            plan: self.plan.clone(),
            structure: self.structure.clone(),
            pattern: Pattern::default(),
            touched: self.touched.clone(),
            velocities: self.velocities,
            rows: self.rows.clone(),
            cliques: Vec::new(),
            length: self.length,
            rounding: self.rounding,
            mechanism: self.mechanism,
            linkage: self.linkage,
            width: self.width,
            flat: self.flat,
            finest: self.finest,
            watchful: self.watchful.clone(),
            timed: self.timed.clone(),
            moving: self.moving.clone(),
            led: self.led,
            driven: self.driven.clone(),
            kinked: self.kinked,
            remembering: self.remembering.clone(),
            twisted: self.twisted.clone(),
            coupling: self.coupling.clone(),
            next: OnceLock::new(),
        }
    }
}
