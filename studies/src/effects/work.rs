//! What every effect does: the work that it does on the motion, and how strongly it acts.

use ropewalk_core::integrator::StepReport;
use ropewalk_core::{At, Energy, Model, NodeId, NodeKind, Observer, Power, Sample, State, Term, difference};
use ropewalk_report::Watch;
use ropewalk_scene::Analysis;
use std::ops::ControlFlow;

/// The work and the forces of an effect in a run.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct EffectWork {
    /// The term that it belongs to.
    pub term: String,
    /// The effect; of terms that are a single one, the same.
    pub effect: String,
    /// Work done on the motion since the start [J]: the energy that it has given, or taken if negative. NaN where it isn't
    /// followed.
    pub work: f64,
    /// The largest that its forces on all nodes together came to, sizes added up [N]; of constraints the largest reaction.
    pub peak: f64,
}

/// Adds up work over a run, step by step: energies exactly, powers by the trapezoidal rule.
pub(super) struct WorkObserver {
    pub all: Vec<EffectWork>,
    analysis: Analysis,
    watch: Watch,
    /// Address of the model that `before` belongs to.
    bound: usize,
    before: Option<Before>,
}

/// Where the last step ended.
struct Before {
    t: f64,
    q: Vec<f64>,
    each: Vec<Now>,
    /// Power of moving constraints [W].
    driven: f64,
}

/// An effect at one instant.
struct Now {
    energy: Energy,
    power: Power,
    residual: Vec<f64>,
}

/// What constraints are called together.
const CONSTRAINTS: &str = "constraints";

impl WorkObserver {
    pub fn new(analysis: Analysis, watch: Watch) -> Self {
        WorkObserver { all: Vec::new(), analysis, watch, bound: 0, before: None }
    }

    fn of(&mut self, term: &str, effect: &str) -> &mut EffectWork {
        let found = self.all.iter().position(|d| d.term == term && d.effect == effect);
        let k = found.unwrap_or_else(|| {
            let (term, effect) = (term.to_string(), effect.to_string());
            self.all.push(EffectWork { term, effect, ..EffectWork::default() });
            self.all.len() - 1
        });
        &mut self.all[k]
    }

    fn look(&mut self, model: &Model, at: &At<'_>, lambda: &[f64]) {
        let address = std::ptr::from_ref(model) as usize;
        if self.bound != address {
            // energies of different meshes can't be compared: the first step on a new one isn't counted
            self.before = None;
            self.bound = address;
        }
        let statics = self.analysis == Analysis::Statics;
        let (mut each, mut power) = (Vec::new(), 0.0);
        for term in model.terms() {
            let effects = term.effects();
            let shares: Vec<&dyn Term> = match effects.is_empty() {
                true => vec![term.as_ref()],
                false => effects.iter().map(AsRef::as_ref).collect(),
            };
            for share in shares {
                let now = Now {
                    energy: share.energy(at),
                    power: share.power(at),
                    residual: model.share_of(share, at),
                };
                power += now.power.supplied;
                let work = self
                    .before
                    .as_ref()
                    .and_then(|b| Some(work(model, b, b.each.get(each.len())?, &now, at, statics)));
                let sum = self.of(&term.label(), &share.label());
                sum.peak = larger(sum.peak, size(model, &now.residual));
                sum.work += work.unwrap_or(0.0);
                each.push(now);
            }
        }
        let driven = model.power(at, lambda).supplied - power;
        if !model.constraints().is_empty() {
            let h = self.before.as_ref().map_or(0.0, |b| at.t - b.t);
            let before = self.before.as_ref().map_or(driven, |b| b.driven);
            let most =
                (0..model.constraints().len()).map(|c| reaction(model, c, at, lambda)).fold(0.0, larger);
            let sum = self.of(CONSTRAINTS, CONSTRAINTS);
            sum.work += if statics { f64::NAN } else { 0.5 * h * (before + driven) };
            sum.peak = larger(sum.peak, most);
        }
        self.before = Some(Before { t: at.t, q: at.q.to_vec(), each, driven });
    }
}

/// Work of an effect over a step. In statics nothing has a velocity: what has no energy either does work along the way.
fn work(model: &Model, before: &Before, was: &Now, now: &Now, at: &At<'_>, statics: bool) -> f64 {
    let stored = |n: &Now| n.energy.kinetic + n.energy.potential;
    let gain = stored(now) - stored(was);
    if !statics {
        let rate = |p: &Power| p.supplied + p.carried - p.dissipated;
        return 0.5 * (at.t - before.t) * (rate(&was.power) + rate(&now.power)) - gain;
    }
    if was.energy != Energy::default() || now.energy != Energy::default() {
        return -gain;
    }
    let mut way = vec![0.0; now.residual.len()];
    difference(model.nodes(), &before.q, at.q, &mut way);
    let both = was.residual.iter().zip(&now.residual);
    both.zip(&way).map(|((a, b), d)| -0.5 * (a + b) * d).sum()
}

/// The larger; NaN counts as failure and stays.
fn larger(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

fn norm(f: &[f64]) -> f64 {
    f.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Sum of the sizes of the forces on all nodes [N].
fn size(model: &Model, residual: &[f64]) -> f64 {
    let points = model.nodes().iter().filter(|n| !matches!(n.kind, NodeKind::Scalars(_)));
    points.map(|n| norm(&residual[n.v..n.v + 3])).sum()
}

/// The force of a constraint on the node that it presses hardest [N].
fn reaction(model: &Model, c: usize, at: &At<'_>, lambda: &[f64]) -> f64 {
    if !model.holds(c, at.internal) {
        return 0.0;
    }
    let on = |k: &NodeId| match model.node(*k).kind {
        NodeKind::Scalars(_) => 0.0,
        _ => norm(&model.reaction(c, *k, at, lambda)[..3]),
    };
    model.constraints()[c].nodes().iter().map(on).fold(0.0, larger)
}

impl Observer for WorkObserver {
    fn step(&mut self, model: &Model, state: &State, _: &StepReport) -> ControlFlow<()> {
        self.look(model, &state.at(), &state.lambda);
        self.watch.check()
    }
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        if self.before.is_none() {
            self.look(sample.model, &sample.at, sample.lambda);
        }
        ControlFlow::Continue(())
    }
}
