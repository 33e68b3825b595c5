//! States of what motions lead, moved onto the constraints.
//!
//! What a motion leads without prescribing its coordinates, such as a crank, has no error of position that could make steps
//! shorter: at the ends of steps it is where it has to be. But the velocities of the generalized-α family are off by `O(h²)` there,
//! and an interpolation takes over what they are off by. Samples and the balance of energy take what the constraints say instead.

use super::Simulation;
use crate::model::node::retract;
use crate::solve::integrator::{Which, agree, agree_in_velocity, move_velocities, way_back};
use crate::solve::linear::SolveError;

/// Most moves of positions onto the constraints.
const MOST_MOVES: usize = 4;

impl Simulation {
    /// Makes the scratch state the one at the end of the step with the velocities that motions lead to, of bodies with
    /// the forces as well, by which they bring energy in; whether there are such motions, and it could be done.
    pub(super) fn led_to_end(&mut self) -> bool {
        self.model.is_led() && {
            self.scratch.clone_from(&self.state);
            let forces = self.work.norms.groups.iter().all(|group| group.single);
            self.lead().and_then(|()| if forces { self.find_forces() } else { Ok(()) }).is_ok()
        }
    }

    /// Moves the velocities of the scratch state onto constraints that move, and inside a step its positions first.
    ///
    /// # Errors
    /// A matrix is singular.
    pub(super) fn lead(&mut self) -> Result<(), SolveError> {
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
        move_velocities(model, s, work)
    }
}
