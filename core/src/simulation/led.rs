//! States of what motions lead, moved onto the constraints.
//!
//! What a motion leads without prescribing its coordinates, such as a crank, has no error of position that could make steps
//! shorter: at the ends of steps it is where it has to be. But the velocities of the generalized-α family are off by `O(h²)` there,
//! and an interpolation takes over what they are off by. Samples and the balance of energy take what the constraints say instead.

use super::Simulation;
use super::dense::Dense;
use crate::model::Model;
use crate::model::constraint::{MOST_ROWS, RowKind};
use crate::model::node::retract;
use crate::model::term::{Energy, Power};
use crate::solve::integrator::{MOST_MOVES, Which, agree, agree_in_velocity, move_velocities, way_back};
use crate::solve::linear::SolveError;

/// What velocities are off the constraints by that the balance of energy takes as it is, in parts of the fastest.
const STRAYS: f64 = 1e-4;
/// What accelerations are off them by where forces swing, in parts of the largest.
const SWINGS: f64 = 0.03;
/// What energy the trapezoidal rule may leave to doubt in a step, in parts of what there is …
const ROUGH: f64 = 1e-4;
/// … what Simpson's rule may change of it to be taken at its word, and how often a step is halved for that.
const MENDED: f64 = 0.03;
const MOST_HALVINGS: u32 = 4;

impl Simulation {
    /// Energies and powers at the end of the last step, with the velocities that motions lead to, of bodies with the forces as
    /// well, by which they bring energy in; of others only where these swing.
    pub(super) fn balance_at_end(&mut self) -> (Energy, Power) {
        if !self.model.is_led() {
            return self.model.balance(&self.state.at(), &self.state.lambda);
        }
        self.scratch.clone_from(&self.state);
        let bodies = self.is_of_bodies();
        if bodies || self.strays() {
            self.lead_end(bodies);
        }
        let (energy, power) = self.model.balance(&self.scratch.at(), &self.scratch.lambda);
        let doubt = (self.state.t - self.previous.t) * (power.supplied - self.power.supplied).abs();
        if bodies || doubt <= ROUGH * self.audit.scale_with(energy) || !self.swings() {
            return (energy, power);
        }
        self.lead_end(true);
        self.model.balance(&self.scratch.at(), &self.scratch.lambda)
    }

    /// Leads the scratch state at the end of the step; where that can't be done it stays as it is.
    fn lead_end(&mut self, forces: bool) {
        if self.lead_with(forces).is_err() {
            self.scratch.clone_from(&self.state);
        }
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
    /// of what is led shorter. Nothing where they aren't.
    pub(super) fn missed(&mut self, span: [f64; 2], ends: [Power; 2], energy: Energy) -> Option<Power> {
        if !self.model.is_led() || !self.is_of_bodies() {
            return None;
        }
        let scale = self.audit.scale_with(energy);
        let rough = Power::between(ends[0], ends[1], 0.5);
        let h = span[1] - span[0];
        let net = |p: &Power| p.supplied + p.carried - p.dissipated;
        if h * (net(&ends[1]) - net(&ends[0])).abs() <= ROUGH * scale {
            return None;
        }
        self.mean_power(span, ends, MENDED * scale, MOST_HALVINGS).map(|mean| Power {
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
    ) -> Option<(Power, Option<Power>)> {
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
        if self.keep_audit && !self.model.inputs().is_empty() && self.model.is_led() {
            self.power = self.balance_at_end().1;
        }
    }

    /// Whether velocities at the end of the step are off what motions lead to by a share of them that shows in energies.
    fn strays(&mut self) -> bool {
        let most = STRAYS * self.fastest(&self.state.v);
        let (model, at, system) = (&*self.model, self.state.at(), &mut self.work.system);
        !model.are_met(most, |c, rates| model.constraint_rate(c, &at, system, rates))
    }

    /// Whether accelerations at the end of the step are off what motions lead to by so much that forces swing about those of
    /// the motion.
    fn swings(&mut self) -> bool {
        let most = SWINGS * self.fastest(&self.state.a);
        let (model, at, system) = (&*self.model, self.state.at(), &mut self.work.system);
        !model.are_met(most, |c, drift| model.constraint_drift(c, &at, system, drift))
    }

    /// The largest rate of a place.
    fn fastest(&self, rates: &[f64]) -> f64 {
        let places = self.model.nodes().iter().filter(|n| n.kind.has_position());
        places.flat_map(|n| &rates[n.v..n.v + 3]).fold(0.0, |m, rate| m.max(rate.abs()))
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

impl Model {
    /// Whether what constraints that move are off by, which is asked for one by one, is at most this; what is no length,
    /// such as an angle, counts at the size of the model.
    fn are_met(&self, most: f64, mut off: impl FnMut(usize, &mut [f64])) -> bool {
        let mut rows = [0.0; MOST_ROWS];
        self.moving_constraints().all(|(c, constraint)| {
            let rows = &mut rows[..constraint.rows().len()];
            off(c, rows);
            // a NaN isn't met
            let met = |(off, kind): (&f64, &RowKind)| {
                off.abs() <= if *kind == RowKind::Position { most } else { most / self.length() }
            };
            rows.iter().zip(constraint.rows()).all(met)
        })
    }
}
