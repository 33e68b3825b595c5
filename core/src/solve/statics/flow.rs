//! Material that runs through cables of steady shape: fed at one end as fast as it is drawn off at the other.

use super::outcome::StaticsError;
use super::problem::Statics;
use crate::algebra::lane::V3;
use crate::algebra::rotation::{cross, transposed_times};
use crate::model::assembly::System;
use crate::model::node::NodeKind;
use crate::model::state::State;

/// A speed below this part of that of the material is none.
const STILL: f64 = 1e-6;

impl Statics<'_> {
    /// Sets the rates at which material runs through the ends of cables at the time of a state: as prescribed, and at an
    /// end that gives way to a force as fast as at the other. Accelerations are left out: what still speeds up is
    /// taken as if it were steady.
    ///
    /// # Errors
    /// More material comes in than goes out: there is no steady shape.
    pub(crate) fn run_material(&mut self, state: &State) -> Result<(), StaticsError> {
        self.flow.clear();
        let model = self.model;
        for part in model.parts().iter().filter(|_| self.flows) {
            let boundaries: Vec<_> = [0, 1].iter().filter_map(|&end| part.boundary(end)).collect();
            let given = |v: usize| model.prescribed(v, state.t, &state.internal).map(|[_, rate, _]| rate);
            let rates: Vec<Option<f64>> = boundaries.iter().map(|f| given(f.v)).collect();
            let known = || rates.iter().flatten().copied();
            let fastest = known().fold(0.0, |m: f64, r| if r.abs() > m.abs() { r } else { m });
            let still = STILL * fastest.abs();
            let (name, speed) = (part.name(), fastest.abs());
            let refused = match () {
                () if fastest == 0.0 => None,
                () if boundaries.len() == 1 => Some(format!(
                    "`{name}` feeds at one end only, at {speed} m/s, so its length changes and no shape is steady: \
                     let as much run through its other end, or compute the motion in time"
                )),
                () if known().any(|r| (r - fastest).abs() > still) => {
                    let grows: f64 =
                        boundaries.iter().zip(&rates).filter_map(|(f, r)| Some(f.sign * (*r)?)).sum();
                    Some(format!(
                        "the free length of `{name}` changes by {grows} m/s, so no shape is steady: let as much run \
                         out of one end as into the other, or compute the motion in time"
                    ))
                }
                () if part.line().is_some_and(|line| [0, 1].iter().any(|&end| line.makes_elements(end))) => {
                    Some(format!(
                        "elements of `{name}` are born and swallowed, so no mesh stands still while material runs \
                     through: leave out `element` of what feeds it"
                    ))
                }
                () => None,
            };
            if let Some(why) = refused {
                return Err(StaticsError::refused(state.t, why));
            }
            self.flow.extend(boundaries.iter().map(|f| (f.v, f.q, fastest)));
        }
        Ok(())
    }

    /// Whether material runs through something.
    fn runs(&self) -> bool {
        self.flow.iter().any(|&(.., rate)| rate != 0.0)
    }

    /// Says if what holds an end that material runs through moves otherwise than the frame, as a lift-off point does that
    /// runs round its package.
    pub(super) fn refuse_unsteady(&mut self, state: &State) -> Result<(), StaticsError> {
        if !self.runs() {
            return Ok(());
        }
        let model = self.model;
        let fastest = self.flow.iter().fold(0.0, |m: f64, &(.., rate)| m.max(rate.abs()));
        let mut rates = vec![0.0; model.multipliers()];
        model.constraint_rates(&state.at(), &mut System::default(), &mut rates);
        for (c, constraint) in model.constraints().iter().enumerate() {
            let at_front = |v: usize| constraint.nodes().iter().any(|&n| model.node(n).v == v);
            if !self.flow.iter().any(|&(v, ..)| at_front(v)) {
                continue;
            }
            let off = rates[model.rows_of(c)].iter().fold(0.0, |m: f64, r| m.max(r.abs()));
            if !(off <= STILL.sqrt() * fastest) {
                let why = format!(
                    "`{}` moves by {off:.3e} m/s in the frame of the search while material runs through it at \
                     {fastest} m/s, so no shape is steady: give the frame in which it stands still, `frame` in [run]",
                    constraint.name()
                );
                return Err(StaticsError::refused(state.t, why));
            }
        }
        Ok(())
    }

    /// Moves a state to a later time as frame and material run on: the guess at the next equilibrium where ends of
    /// cables wander as material passes them.
    pub(super) fn run_on(&self, state: &mut State, dt: f64) {
        if !self.runs() {
            return;
        }
        for &(_, q, rate) in &self.flow {
            state.q[q] += rate * dt;
        }
        let Some(frame) = self.frame else { return };
        let omega = frame.omega;
        let speed = omega.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (sin, cos) = (speed * dt).sin_cos();
        // Rodrigues' rotation; both factors are finite for a frame that doesn't turn
        let (first, second) =
            if speed > 0.0 { (sin / speed, (1.0 - cos) / (speed * speed)) } else { (dt, 0.0) };
        let mut spin = vec![0.0; self.model.velocities()];
        for n in self.model.nodes().iter().filter(|n| n.kind == NodeKind::Frame) {
            let own = transposed_times(&crate::model::marker::frame(&state.q[n.coords()]), &omega);
            (0..3).for_each(|i| spin[n.v + 3 + i] = dt * own[i]);
        }
        let before = state.q.clone();
        self.model.retract(&before, &spin, &mut state.q);
        for n in self.model.nodes() {
            let vectors = match n.kind {
                NodeKind::Point | NodeKind::Frame => 1,
                NodeKind::Slope => 2,
                // the reference director turns with all the others
                NodeKind::Twist => 3,
                NodeKind::Scalars(_) => 0,
            };
            for b in 0..vectors {
                let at = n.q + 3 * b;
                let origin = if b == 0 { frame.centre } else { [0.0; 3] };
                let arm: V3<f64> = std::array::from_fn(|i| before[at + i] - origin[i]);
                let turn = cross(&omega, &arm);
                let pull = cross(&omega, &turn);
                for i in 0..3 {
                    let shift = if b == 0 { frame.velocity[i] * dt } else { 0.0 };
                    state.q[at + i] = before[at + i] + first * turn[i] + second * pull[i] + shift;
                }
            }
        }
    }
}
