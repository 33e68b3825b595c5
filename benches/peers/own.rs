//! Ropewalk's side: a scene in, CPU time and counts out.

use cpu_time::ThreadTime;
use ropewalk::core::integrator::Options;
use ropewalk::core::statics::Statics;
use ropewalk::core::{Observer, Simulation};
use ropewalk::scene::Scene;

/// A run that came to its end.
pub struct Run {
    pub simulation: Simulation,
    /// CPU time of the steps, without building the model and without its start [s].
    pub cpu: f64,
}

impl Run {
    /// Where a part is at an unstretched arc length.
    pub fn place(&self, part: &str, s: f64) -> Result<[f64; 3], String> {
        let (model, state) = (&self.simulation.model, &self.simulation.state);
        let place = model.part(part).and_then(|p| p.point(s, &state.at()));
        place.map(|p| p.0).ok_or_else(|| format!("{part} has no point at {s}"))
    }
}

/// Runs a scene, from its equilibrium or as it is laid.
pub fn run(
    scene: &Scene,
    options: &Options,
    duration: f64,
    from_equilibrium: bool,
    observer: &mut dyn Observer,
) -> Result<Run, String> {
    let model = scene.build().map_err(|e| e.to_string())?;
    let mut state = model.state();
    if from_equilibrium {
        let mut statics = Statics::new(&model, &scene.statics).map_err(|e| e.to_string())?;
        statics.find(&mut state, true).map_err(|e| e.to_string())?;
    }
    let mut simulation = Simulation::from(model, state, options, duration).map_err(|e| e.to_string())?;
    simulation.keep_audit(false);
    let clock = ThreadTime::now();
    simulation.advance(duration, f64::INFINITY, observer).map_err(|e| e.to_string())?;
    Ok(Run { cpu: clock.elapsed().as_secs_f64(), simulation })
}
