//! Where the time goes: calls and times of terms, constraints and the phases of a solution. The clocks stand still unless
//! profiling was asked for.

use crate::model::Model;
use crate::model::assembly::{Spent, System};
use std::time::{Duration, Instant};

/// What an analysis does beside evaluating terms and constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Phase {
    Factorisation,
    Solution,
    Stability,
    Audit,
    Output,
}

const PHASES: [(&str, Phase); 5] = [
    ("factorisation", Phase::Factorisation),
    ("solution and its check", Phase::Solution),
    ("test of stability", Phase::Stability),
    ("audit of energy", Phase::Audit),
    ("forces for output", Phase::Output),
];

/// The clocks of the phases.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Clocks(Option<[Spent; PHASES.len()]>);

impl Clocks {
    /// Clocks that run.
    pub fn running() -> Self {
        Clocks(Some(Default::default()))
    }
    /// When a phase begins.
    pub fn start(&self) -> Option<Instant> {
        self.0.map(|_| Instant::now())
    }
    /// A phase that began then has ended.
    pub fn stop(&mut self, phase: Phase, begin: Option<Instant>) {
        if let (Some(all), Some(begin)) = (&mut self.0, begin) {
            let (calls, time) = &mut all[phase as usize];
            *calls += 1;
            *time += begin.elapsed();
        }
    }
}

/// Calls and times by label, in the order in which the labels came first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Times(Vec<(String, Spent)>);

impl Times {
    fn add(&mut self, label: String, spent: Spent) {
        match self.0.iter_mut().find(|(l, _)| *l == label) {
            Some((_, sum)) => *sum = (sum.0 + spent.0, sum.1 + spent.1),
            None => self.0.push((label, spent)),
        }
    }
    /// Adds what was spent on assembling a model into systems, and in phases.
    pub fn adding<'a>(
        mut self,
        model: &Model,
        systems: impl IntoIterator<Item = &'a System>,
        clocks: &Clocks,
    ) -> Self {
        for system in systems {
            let labels = model.terms().iter().map(|t| t.label()).chain(["constraints".to_string()]);
            labels.zip(system.profile.iter().flatten()).for_each(|(label, &spent)| self.add(label, spent));
        }
        for ((name, phase), spent) in PHASES.iter().zip(clocks.0.iter().flatten()) {
            if spent.0 > 0 || matches!(phase, Phase::Factorisation | Phase::Solution) {
                self.add((*name).to_string(), *spent);
            }
        }
        self
    }
    /// As a list.
    pub fn list(self) -> Vec<(String, u64, Duration)> {
        self.0.into_iter().map(|(label, (calls, time))| (label, calls, time)).collect()
    }
}
