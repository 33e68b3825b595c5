//! Times by the shortest of many short samples, and peak memory.

use super::{Cost, FullIteration, Links, Memory, Pendulum, Share, StepCost, Steps, VariantCost};
use crate::error::Error;
use ropewalk_core::Width;
use ropewalk_elements::cable::CableModel;
use std::time::{Duration, Instant};

/// Samples shorter than this measure the clock.
const LEAST_SAMPLE: f64 = 50e-6;
/// Fewest samples, however slow they are.
const LEAST_SAMPLES: usize = 4;

/// The shortest time of one call among many short samples [s].
///
/// # Errors
/// The first error of a call.
pub fn shortest(budget: Duration, mut call: impl FnMut() -> Result<(), Error>) -> Result<f64, Error> {
    // the first call warms up, the second tells how long one takes
    call()?;
    let begin = Instant::now();
    call()?;
    let mut best = begin.elapsed().as_secs_f64();
    let calls = (LEAST_SAMPLE / best.max(1e-9)).ceil().clamp(1.0, 1e4) as usize;
    let mut samples = 0;
    while samples < LEAST_SAMPLES || begin.elapsed() < budget {
        let start = Instant::now();
        for _ in 0..calls {
            call()?;
        }
        best = best.min(start.elapsed().as_secs_f64() / calls as f64);
        samples += 1;
    }
    Ok(best)
}

/// A pendulum or a chain of links that is measured in rounds: a machine that is busy in one may be quiet in the next.
pub struct Meter {
    elements: usize,
    iteration: FullIteration,
    steps: Steps,
    full: f64,
    residual: f64,
    solution: f64,
    phases: Vec<(String, f64)>,
    step: f64,
}

impl Meter {
    /// Builds it; nothing is measured yet.
    ///
    /// # Errors
    /// A pendulum that can't be built.
    pub fn new(problem: &Pendulum, width: Width) -> Result<Self, Error> {
        let iteration = FullIteration::new(problem, width)?;
        Ok(Meter::of(problem.elements, iteration, Steps::new(problem, width)?))
    }

    /// The same for a chain of links, whose iteration is measured in the midst of its fall.
    ///
    /// # Errors
    /// A chain that can't be built.
    pub fn links(problem: &Links, width: Width) -> Result<Self, Error> {
        let mut steps = Steps::links(problem, width)?;
        steps.run(100)?;
        let model = problem.scene().build()?.with_width(width);
        let iteration = FullIteration::at(model, steps.state().clone())?;
        Ok(Meter::of(problem.links, iteration, steps))
    }

    fn of(elements: usize, iteration: FullIteration, steps: Steps) -> Self {
        Meter {
            elements,
            iteration,
            steps,
            full: f64::INFINITY,
            residual: f64::INFINITY,
            solution: f64::INFINITY,
            phases: Vec::new(),
            step: f64::INFINITY,
        }
    }

    /// Measures everything once more, in about this time.
    ///
    /// # Errors
    /// A step that doesn't converge.
    pub fn round(&mut self, budget: Duration) -> Result<(), Error> {
        let (long, short) = (budget / 4, budget / 8);
        let i = &mut self.iteration;
        self.full = self.full.min(shortest(long, || i.run())?);
        self.solution = self.solution.min(shortest(short, || i.solve())?);
        self.residual = self.residual.min(shortest(short, || {
            i.residual();
            Ok(())
        })?);
        self.time_phases(long)?;
        self.time_steps(long)
    }

    fn time_phases(&mut self, budget: Duration) -> Result<(), Error> {
        let clock = (0..1000).map(|_| Instant::now().elapsed().as_secs_f64()).fold(f64::INFINITY, f64::min);
        let i = &mut self.iteration;
        let (begin, mut samples) = (Instant::now(), 0);
        while samples < LEAST_SAMPLES || begin.elapsed() < budget {
            i.work.profile();
            i.run()?;
            for (k, (label, _, time)) in i.work.times(&i.model).into_iter().enumerate() {
                let time = (time.as_secs_f64() - clock).max(0.0);
                match self.phases.get_mut(k) {
                    Some((_, shortest)) => *shortest = shortest.min(time),
                    None => self.phases.push((label, time)),
                }
            }
            samples += 1;
        }
        i.work.unprofile();
        Ok(())
    }

    fn time_steps(&mut self, budget: Duration) -> Result<(), Error> {
        let (count, begin) = (self.count(), Instant::now());
        loop {
            self.steps.rewind();
            let start = Instant::now();
            self.steps.run(count)?;
            self.step = self.step.min(start.elapsed().as_secs_f64() / count as f64);
            if begin.elapsed() >= budget {
                return Ok(());
            }
        }
    }

    /// Steps in a sample.
    fn count(&self) -> usize {
        (100_000 / self.elements).clamp(20, 500)
    }

    /// The shortest times so far.
    pub fn cost(&self) -> Cost {
        let us = 1e6 / self.elements as f64;
        let share = |(label, s): &(String, f64)| Share { label: label.clone(), us: us * s };
        let mut phases: Vec<Share> = self.phases.iter().map(share).collect();
        // the last phase is the solution with its check; without the check it was timed by itself
        if let Some(both) = phases.pop() {
            let solution = us * self.solution;
            phases.push(Share { label: "solution".into(), us: solution });
            phases.push(Share { label: "check of the solution".into(), us: (both.us - solution).max(0.0) });
        }
        let known: f64 = phases.iter().map(|p| p.us).sum();
        phases.push(Share { label: "rest".into(), us: (us * self.full - known).max(0.0) });
        let (count, counts) = (self.count() as f64, self.steps.work.counts);
        Cost {
            elements: self.elements,
            iteration: us * self.full,
            residual: us * self.residual,
            phases,
            fallbacks: self.iteration.work.counts.fallbacks,
            step: StepCost {
                us: us * self.step,
                iterations: counts.newton_iterations as f64 / count,
                factorizations: counts.factorizations as f64 / count,
            },
        }
    }
}

/// A stiffness model that is measured in rounds: its kernel with gather and scatter, and a full iteration.
pub struct VariantMeter {
    models: CableModel,
    elements: usize,
    iteration: FullIteration,
    full: f64,
    force: f64,
    tangent: f64,
}

impl VariantMeter {
    /// Builds a pendulum of these models; nothing is measured yet.
    ///
    /// # Errors
    /// Models that don't go together.
    pub fn new(models: CableModel, elements: usize, width: Width) -> Result<Self, Error> {
        let iteration = FullIteration::new(&Pendulum::new(elements).with_models(models), width)?;
        let never = f64::INFINITY;
        Ok(VariantMeter { models, elements, iteration, full: never, force: never, tangent: never })
    }

    /// Measures once more, in about this time.
    ///
    /// # Errors
    /// A matrix that can't be factored.
    pub fn round(&mut self, budget: Duration) -> Result<(), Error> {
        let i = &mut self.iteration;
        self.full = self.full.min(shortest(budget / 3, || i.run())?);
        for (tangent, best) in [(false, &mut self.force), (true, &mut self.tangent)] {
            let (begin, mut samples) = (Instant::now(), 0);
            while samples < LEAST_SAMPLES || begin.elapsed() < budget / 3 {
                i.work.profile();
                if tangent {
                    i.assemble();
                } else {
                    i.residual();
                }
                // the first term is the cable
                let times = i.work.times(&i.model);
                *best = best.min(times.first().map_or(f64::NAN, |(.., time)| time.as_secs_f64()));
                samples += 1;
            }
        }
        i.work.unprofile();
        Ok(())
    }

    /// The shortest times so far.
    pub fn cost(&self) -> VariantCost {
        let us = 1e6 / self.elements as f64;
        VariantCost {
            label: self.iteration.model.terms()[0].label(),
            models: self.models,
            elements: self.elements,
            force: us * self.force,
            tangent: us * self.tangent,
            iteration: us * self.full,
        }
    }
}

/// Peak memory per element, dry and in water: what the peak of the process grows by from a mesh to one four times
/// as fine, over the elements in between. `None` where the system doesn't tell or the mesh is too small to be seen.
///
/// Measure it first: the peak of a process never falls.
///
/// # Errors
/// A pendulum that can't be built or doesn't converge.
pub fn memory(elements: usize, width: Width) -> Result<Option<Memory>, Error> {
    if elements < 2048 || peak().is_none() {
        return Ok(None);
    }
    let (few, more) = (Pendulum::new(elements / 4), Pendulum::new(elements));
    // each of these needs more than the one before, so that each sets the peak anew
    let mut peaks = [0.0; 4];
    for (problem, p) in [few, few.in_water(), more, more.in_water()].iter().zip(&mut peaks) {
        let mut steps = Steps::new(problem, width)?;
        steps.run(1)?;
        *p = peak().unwrap_or(f64::NAN);
    }
    let between = (more.elements - few.elements) as f64;
    let [dry, water] = [peaks[2] - peaks[0], peaks[3] - peaks[1]].map(|bytes| bytes / between);
    Ok((dry > 0.0 && water > dry).then_some(Memory { elements: [few.elements, more.elements], dry, water }))
}

/// The most memory that the process has held so far [bytes].
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    Some(1024.0 * line.trim().strip_suffix(" kB")?.trim().parse::<f64>().ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_phases_of_an_iteration_are_those_of_its_terms_and_of_the_solver() {
        let mut meter = Meter::new(&Pendulum::new(8).in_water(), Width::best()).expect("model");
        for _ in 0..2 {
            meter.round(Duration::from_millis(20)).expect("times");
        }
        let cost = meter.cost();
        let labels: Vec<&str> = cost.phases.iter().map(|p| p.label.as_str()).collect();
        for part in
            ["cable L4", "weight", "drag", "constraints", "factorisation", "solution", "check", "rest"]
        {
            assert!(labels.iter().any(|l| l.contains(part)), "no {part} in {labels:?}");
        }
        assert!(cost.phases.iter().all(|p| p.us >= 0.0 && p.us.is_finite()));
        assert!(cost.iteration > 0.0 && cost.residual > 0.0 && cost.step.us > 0.0);
        assert!(cost.step.iterations >= 1.0 && cost.fallbacks == 0);
    }
}
