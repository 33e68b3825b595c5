//! States of what motions lead, moved onto the constraints.
//!
//! What a motion leads without prescribing its coordinates, such as a crank, has no error of position that could make steps
//! shorter: at the ends of steps it is where it has to be. But the velocities of the generalized-α family are off by `O(h²)` there,
//! and an interpolation takes over what they are off by. Samples and the balance of energy take what the constraints say instead.

use super::Simulation;
use super::dense::Dense;
use crate::model::constraint::{MOST_ROWS, RowKind};
use crate::model::node::retract;
use crate::model::term::{Energy, Power};
use crate::solve::integrator::{MOST_MOVES, Which, agree, agree_in_velocity, move_velocities, way_back};
use crate::solve::linear::SolveError;

/// What velocities are off the constraints by that the balance of energy takes as it is, in parts of the fastest.
const STRAYS: f64 = 1e-4;
/// What energy the trapezoidal rule may leave to doubt in a step, in parts of what there is …
const ROUGH: f64 = 1e-4;
/// … what Simpson's rule may change of it to be taken at its word, and how often a step is halved for that.
const MENDED: f64 = 0.03;
const MOST_HALVINGS: u32 = 4;

impl Simulation {
    /// Makes the scratch state the one at the end of the step with the velocities that motions lead to, of bodies with
    /// the forces as well, by which they bring energy in; whether there are such motions, and it could be done.
    pub(super) fn led_to_end(&mut self) -> bool {
        if !self.model.is_led() || !self.is_of_bodies() && !self.strays() {
            return false;
        }
        self.scratch.clone_from(&self.state);
        self.lead_with(self.is_of_bodies()).is_ok()
    }

    fn is_of_bodies(&self) -> bool {
        self.work.norms.groups.iter().all(|group| group.single)
    }

    /// Leads the scratch state to where motions want it, and finds its forces if they are asked for.
    ///
    /// # Errors
    /// A matrix is singular.
    pub(super) fn lead_with(&mut self, forces: bool) -> Result<(), SolveError> {
        // at the end of a step, forces by its factors bring velocities onto the constraints as well
        let inside = self.scratch.t < self.state.t;
        if !forces || inside || self.weights().is_none() {
            self.lead(!forces)?;
        }
        if forces { self.find_forces() } else { Ok(()) }
    }

    /// What the trapezoidal rule misses of the work of motions over the last step, or its beginning, with the energies at its
    /// end: where powers at its ends differ, those inside of it are summed up, as no error of position makes the steps
    /// of what is led shorter.
    pub(super) fn missed(&mut self, span: [f64; 2], ends: [Power; 2], energy: Energy) -> Power {
        if !self.model.is_led() || !self.is_of_bodies() {
            return Power::zero();
        }
        let scale = self.audit.scale_with(energy);
        let rough = Power::between(ends[0], ends[1], 0.5);
        let h = span[1] - span[0];
        let net = |p: &Power| p.supplied + p.carried - p.dissipated;
        if h * (net(&ends[1]) - net(&ends[0])).abs() <= ROUGH * scale {
            return Power::zero();
        }
        self.mean_power(span, ends, MENDED * scale, MOST_HALVINGS).map_or(Power::zero(), |mean| Power {
            dissipated: h * (mean.dissipated - rough.dissipated),
            supplied: h * (mean.supplied - rough.supplied),
            carried: h * (mean.carried - rough.carried),
        })
    }

    /// The power of motions in the scratch state, which lies inside the last step, and what the trapezoidal rule misses of their
    /// work until there, where the energies are these; nothing unless they lead bodies. The state is left as it is.
    pub(super) fn led_inside(
        &mut self,
        span: [f64; 2],
        begin: Power,
        energy: Energy,
    ) -> Option<(Power, Power)> {
        if !self.model.is_led() || !self.is_of_bodies() {
            return None;
        }
        let kept = self.scratch.clone();
        let found = self.lead_with(true).is_ok().then(|| {
            let then = self.model.power(&self.scratch.at(), &self.scratch.lambda);
            (then, self.missed(span, [begin, then], energy))
        });
        self.scratch = kept;
        found
    }

    /// The mean power over a part of the last step by Simpson's rule, on halves where that mends more than `rest` [J].
    fn mean_power(
        &mut self,
        [from, to]: [f64; 2],
        ends: [Power; 2],
        rest: f64,
        halvings: u32,
    ) -> Option<Power> {
        let middle = 0.5 * (from + to);
        Dense::new(&self.model, &self.previous, &self.state).at(middle, &mut self.scratch);
        self.lead_with(true).ok()?;
        let there = self.model.power(&self.scratch.at(), &self.scratch.lambda);
        let rough = Power::between(ends[0], ends[1], 0.5);
        let off = (to - from) * (there.supplied - there.dissipated - rough.supplied + rough.dissipated).abs();
        // what Simpson's rule leaves is far less than what it mends
        if halvings == 0 || off <= rest {
            return Some(Power::between(rough, there, 2.0 / 3.0));
        }
        let first = self.mean_power([from, middle], [ends[0], there], rest, halvings - 1)?;
        let second = self.mean_power([middle, to], [there, ends[1]], rest, halvings - 1)?;
        Some(Power::between(first, second, 0.5))
    }

    /// Lets inputs set out for where they are to be at time `end`: motions may go on with another acceleration than they came with,
    /// and so with another power.
    pub(super) fn set_out(&mut self, end: f64) {
        if !(end > self.state.t) {
            return;
        }
        self.depart(end);
        if self.keep_audit && !self.model.inputs().is_empty() && self.led_to_end() {
            self.power = self.model.power(&self.scratch.at(), &self.scratch.lambda);
        }
    }

    /// Whether velocities at the end of the step are off what motions lead to by a share of them that shows in energies.
    fn strays(&mut self) -> bool {
        let (model, at, system) = (&*self.model, self.state.at(), &mut self.work.system);
        let places = model.nodes().iter().filter(|n| n.kind.has_position()).flat_map(|n| n.v..n.v + 3);
        let fastest = places.map(|i| self.state.v[i].abs()).fold(0.0, f64::max);
        let mut rates = [0.0; MOST_ROWS];
        // what is no length, such as an angle, counts at the size of the model; a NaN strays
        let most = |kind: RowKind| {
            STRAYS * if kind == RowKind::Position { fastest } else { fastest / model.length() }
        };
        !model.moving_constraints().all(|(c, constraint)| {
            let rates = &mut rates[..constraint.rows().len()];
            model.constraint_rate(c, &at, system, rates);
            rates.iter().zip(constraint.rows()).all(|(rate, kind)| rate.abs() <= most(*kind))
        })
    }

    /// Moves the scratch state onto constraints that move: inside a step its positions, then, if they are asked for, its
    /// `velocities`.
    ///
    /// # Errors
    /// A matrix is singular.
    fn lead(&mut self, velocities: bool) -> Result<(), SolveError> {
        if !self.model.is_led() {
            return Ok(());
        }
        let inside = self.scratch.t < self.state.t;
        if self.weights().is_none() {
            let mut aside = self.take_aside()?;
            let done = if inside { agree(&self.model, &mut self.scratch, &mut aside) } else { Ok(()) };
            let done = done.and_then(|()| agree_in_velocity(&self.model, &mut self.scratch, &mut aside));
            self.aside = Some(aside);
            return done;
        }
        let (model, s, work) = (&*self.model, &mut self.scratch, &mut self.work);
        if inside {
            let (start, mut d) = (s.q.clone(), vec![0.0; model.velocities()]);
            for _ in 0..MOST_MOVES {
                let Some(mut way) = way_back(model, &s.at(), work) else { break };
                work.solve(model, Which::Iteration, &mut way)?;
                d.iter_mut().zip(&way).for_each(|(d, x)| *d += x);
                retract(model.nodes(), &start, &d, &mut s.q);
            }
        }
        if velocities {
            move_velocities(model, s, work, MOST_MOVES, None)?;
        }
        Ok(())
    }
}
