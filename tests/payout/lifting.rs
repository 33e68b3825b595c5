//! A rope that lifts off from its wheel and comes down on it again, against d'Alembert's solution for a taut string over a
//! support that moves, which knows no elements and no wheel.

use ropewalk::{SceneFile, scene::Format};
use ropewalk_core::{Observer, Remeshed, Simulation};
use ropewalk_scene::Scene;
use std::f64::consts::TAU;

/// Half of the rope [m], its tension [N], its stiffness [N], and mass per unstretched length [kg/m].
const HALF: f64 = 2.0;
const TENSION: f64 = 1000.0;
const EA: f64 = 20e3;
const MASS: f64 = 1.0;

/// Height of the support [m]: it starts here and swings down by twice the amplitude, so often a second.
const HEIGHT: f64 = 0.06;
const AMPLITUDE: f64 = 0.04;
const FREQUENCY: f64 = 2.5;

fn height(t: f64) -> [f64; 2] {
    let w = TAU * FREQUENCY;
    [HEIGHT + AMPLITUDE * ((w * t).cos() - 1.0), -AMPLITUDE * w * (w * t).sin()]
}

/// The middle of a string by its two waves: `y = f(t - x/c) + g(t + x/c)`, with `g(t) = -f(t - 2 L/c)` from the ends. On the
/// support `f + g = h`, and `N = 2 T/c (f' - g')`; off it `f' = g'`. Heights at these times, and when it lifts and lands.
fn string(times: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let c = (TENSION * (1.0 + TENSION / EA) / MASS).sqrt();
    let delay = 2.0 * HALF / c;
    let steps = 4000;
    let dt = delay / steps as f64;
    let before = |t: f64| 0.5 * HEIGHT + 0.5 * HEIGHT * c / HALF * t;
    let mut f: Vec<f64> = (0..=steps).map(|k| before((k as f64 - steps as f64) * dt)).collect();
    let (mut on, mut switches, mut all) = (true, Vec::new(), vec![HEIGHT]);
    let last = times.last().expect("times") + dt;
    let mut k = 0;
    while (k as f64) * dt < last {
        k += 1;
        let t = k as f64 * dt;
        let n = f.len();
        let [g, g_before] = [-f[n - steps], -f[n - steps - 1]];
        let [h, rate] = height(t);
        let free = f[n - 1] + g - g_before;
        if on && rate < 2.0 * (g - g_before) / dt {
            (on, _) = (false, switches.push(t));
        } else if !on && free + g < h {
            (on, _) = (true, switches.push(t));
        }
        f.push(if on { h - g } else { free });
        all.push(f[n] + g);
    }
    let look = |t: f64| {
        let (k, part) = ((t / dt).floor() as usize, (t / dt).fract());
        all[k] * (1.0 - part) + all[k + 1] * part
    };
    (times.iter().map(|t| look(*t)).collect(), switches)
}

/// A wheel below the middle of a taut rope, on a body that swings up and down.
fn swings(elements: usize, solver: &str, more: &str) -> String {
    format!(
        r#"
        run = {{ duration = 1.2, output = 0.01 }}
        {solver}
        [[elements]]
        type = "rigid_body"
        name = "carrier"
        position = [0, 0, {centre}]
        mass = 10
        inertia = [1, 1, 1]
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = {MASS}, ea = {EA}{more} }}
        elements = {elements}
        tension = {TENSION}
        route = [{{ end = [-{HALF}, 0, 0] }}, {{ over = "wheel" }}, {{ end = [{HALF}, 0, 0] }}]
        [[constraints]]
        type = "spherical"
        name = "start"
        marker = "rope.start"
        [[constraints]]
        type = "spherical"
        name = "end"
        marker = "rope.end"
        [[constraints]]
        type = "driving"
        name = "led"
        marker = "carrier"
        motion = "swing"
        [[motions]]
        type = "harmonic"
        name = "swing"
        amplitude = [0, 0, {AMPLITUDE}]
        frequency = {FREQUENCY}
        phase = "90 deg"
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = "carrier"
        axis = [0, 1, 0]
        radius = 0.05
        [[records]]
        type = "sheave"
        of = "wheel"
        [[records]]
        type = "position"
        of = "rope.1.end"
        name = "middle"
        [[records]]
        type = "position"
        of = "carrier"
        [[records]]
        type = "energy"
        "#,
        centre = HEIGHT - 0.05,
    )
}

fn read(text: &str) -> Scene {
    SceneFile::parse(text, "scene", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}")).into_scene()
}

/// What a run told: its events, and the energy that switches took [J].
#[derive(Default)]
struct Told {
    events: Vec<(String, f64)>,
    taken: Vec<f64>,
}

impl Observer for Told {
    fn event(&mut self, name: &str, t: f64) {
        self.events.push((name.to_string(), t));
    }
    fn remeshed(&mut self, report: &Remeshed) {
        self.taken.push(-report.kinetic - report.potential);
    }
}

impl Told {
    fn times(&self, what: &str) -> Vec<f64> {
        self.events.iter().filter(|(name, _)| name.contains(what)).map(|(_, t)| *t).collect()
    }
}

/// Runs a scene, with the height of the middle of the rope at some times.
fn follow(scene: &Scene, times: &[f64]) -> (Vec<f64>, Told, Simulation) {
    let mut told = Told::default();
    let mut s = Simulation::new(scene.build().expect("model"), &scene.solver, scene.run.duration).expect("start");
    let mut all = Vec::new();
    for t in times {
        if *t > 0.0 {
            s.advance(*t, 1.0, &mut told).unwrap_or_else(|e| panic!("{e}"));
        }
        let rope = s.model.part("rope.1").expect("rope");
        let end = rope.boundary(1).expect("an end that feeds");
        all.push(s.state.q[end.end_q + 2]);
    }
    (all, told, s)
}

#[test]
fn a_rope_lifts_off_from_a_wheel_and_comes_back_as_a_string_does() {
    let t: Vec<f64> = (0..=120).map(|k| 0.01 * f64::from(k)).collect();
    let (exact, switches) = string(&t);
    println!("{switches:?}");
    for elements in [2, 4, 8, 16] {
        let (all, told, s) = follow(&read(&swings(elements, "", "")), &t);
        let mut most = 0.0_f64;
        for ((t, exact), own) in t.iter().zip(&exact).zip(&all) {
            if elements == 8 {
                println!("{t:.2} {exact:.5} {own:.5}");
            }
            most = most.max((own - exact).abs());
        }
        println!("{elements}: {most} m, {:?}", told.events.iter().map(|e| format!("{:.4} {}", e.1, e.0)).collect::<Vec<_>>());
        println!("taken {:?} imbalance {} of {} {:?}", told.taken, s.audit.imbalance(), s.audit.scale, s.work.counts);
    }
    panic!();
}
