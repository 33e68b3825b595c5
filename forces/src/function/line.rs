//! A function as a distributed load.

use super::{HALF, Scales};
use ropewalk_core::{
    Assembly, At, BuildError, Gives, Load, Pattern, Power, Station, Stations, Term, Timed, V3, dot,
};
use ropewalk_scene::functions::Called;
use std::sync::Arc;

/// A force per unstretched length that a function gives for all stations of a part at once. That at one station must only
/// depend on what is there: derivatives are found by moving all stations together.
pub struct FunctionLoad {
    label: String,
    stations: Arc<dyn Stations>,
    function: Called,
    scales: Scales,
}

/// Which numbers of a station a difference moves.
#[derive(Clone, Copy)]
enum By {
    Position,
    Slope,
    Velocity,
}

impl By {
    fn of(self, s: &mut Station<f64>) -> &mut V3<f64> {
        match self {
            By::Position => &mut s.x,
            By::Slope => &mut s.slope,
            By::Velocity => &mut s.v,
        }
    }
    fn into(self, load: &mut Load<f64>) -> &mut [V3<f64>; 3] {
        match self {
            By::Position => &mut load.d_x,
            By::Slope => &mut load.d_slope,
            By::Velocity => &mut load.d_v,
        }
    }
}

impl FunctionLoad {
    /// A load on these stations.
    ///
    /// # Errors
    /// The function looks at a body.
    pub fn new(
        label: String,
        stations: Arc<dyn Stations>,
        function: Called,
        scales: Scales,
    ) -> Result<Self, BuildError> {
        if function.reads.attitude || function.reads.angular_velocity {
            let message = "a function along cables sees `position`, `velocity` and `slope`, no attitude: give a `marker` on a body";
            return Err(BuildError::at("function", message));
        }
        Ok(FunctionLoad { label, stations, function, scales })
    }

    fn seen(&self, at: &At<'_>) -> Vec<Station<f64>> {
        let mut all = Vec::new();
        self.stations.each(at, &mut |s| all.push(*s));
        all
    }
}

impl Term for FunctionLoad {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        self.stations.pattern(p);
    }
    fn symmetric(&self) -> bool {
        let reads = self.function.reads;
        self.stations.fixed() && !(reads.position || reads.velocity || reads.slope)
    }
    fn is_load(&self) -> bool {
        true
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let stations = self.seen(at);
        let mut loads: Vec<Load<f64>> =
            self.function.load(at.t, &stations).into_iter().map(|f| Load { f, ..Load::zero() }).collect();
        let (reads, w) = (self.function.reads, out.weights());
        let mut gives = Gives::NOTHING;
        if out.wants_tangent() {
            gives.x = reads.position && w.q != 0.0;
            gives.slope = reads.slope && w.q != 0.0;
            gives.v = reads.velocity && w.v != 0.0;
            let position = || self.scales.position(stations.iter().map(|s| &s.x));
            let velocity = || self.scales.velocity(stations.iter().map(|s| &s.v));
            let each = [
                (gives.x, By::Position, position()),
                (gives.slope, By::Slope, HALF),
                (gives.v, By::Velocity, velocity()),
            ];
            let mut moved = stations.clone();
            for (_, by, h) in each.into_iter().filter(|(wanted, ..)| *wanted) {
                for j in 0..3 {
                    moved.copy_from_slice(&stations);
                    moved.iter_mut().for_each(|s| by.of(s)[j] += h);
                    for ((load, f), (to, from)) in loads
                        .iter_mut()
                        .zip(self.function.load(at.t, &moved))
                        .zip(moved.iter_mut().zip(&stations))
                    {
                        // by as much as rounding has let it move
                        let by_how_much = by.of(to)[j] - by.of(&mut from.clone())[j];
                        let base = load.f;
                        (0..3).for_each(|i| by.into(load)[i][j] = (f[i] - base[i]) / by_how_much);
                    }
                }
            }
        }
        self.stations.spread(&loads, gives, at, out);
    }
    fn power(&self, at: &At<'_>) -> Power {
        let stations = self.seen(at);
        let loads = self.function.load(at.t, &stations);
        let supplied = stations.iter().zip(&loads).map(|(s, f)| s.weight * dot(f, &s.v)).sum();
        Power { supplied, ..Power::default() }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        if self.function.reads.time { Some(self) } else { None }
    }
}

impl Timed for FunctionLoad {}
