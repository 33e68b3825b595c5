//! Loads of water in waves at a station: their derivatives and their work.

use ropewalk_core::testing::check_law;
use ropewalk_core::{Law, Load, Station, V3, dot};
use ropewalk_forces::{
    AddedMass, Buoyancy, Drag, FroudeKrylov, NormalLaw, Surface, TangentialLaw, Theory, Wetted,
};
use ropewalk_scene::{Current, Evaluation, Sea, WaveComponent, WaveStretching, WavesSpec};
use std::f64::consts::PI;
use std::sync::Arc;

const LEVEL: f64 = 0.4;

/// Three waves of different directions, as many times longer than at first.
fn sea(stretching: WaveStretching, doppler: bool, longer: f64) -> Arc<Sea> {
    let wave = |amplitude, period: f64, phase, direction| WaveComponent {
        amplitude,
        period: period * longer.sqrt(),
        phase,
        direction: Some(direction),
    };
    let spec = WavesSpec {
        components: vec![wave(0.8, 5.0, 0.3, 0.0), wave(0.3, 3.5, 1.3, 0.7), wave(0.4, 6.5, -2.0, -0.4)],
        depth: Some(25.0 * longer),
        ramp: 20.0,
        stretching,
        doppler,
        ..WavesSpec::default()
    };
    Arc::new(Sea::new(&spec, LEVEL, 9.81, [0.5, 0.1, 0.0]).unwrap_or_else(|e| panic!("{e}")))
}

/// The same sea from a table.
fn table(spec: WavesSpec) -> Arc<Sea> {
    let spec = WavesSpec { evaluation: Some(Evaluation::Lattice), ..spec };
    Arc::new(Sea::new(&spec, LEVEL, 9.81, [0.0; 3]).unwrap_or_else(|e| panic!("{e}")))
}

fn drag(sea: &Arc<Sea>) -> Drag {
    let law =
        Drag::new(1025.0, 1e-3, NormalLaw::Constant(1.2), TangentialLaw::Quadratic(0.05)).expect("drag");
    Drag { sea: Some(sea.clone()), current: shear(), ..law }
}

fn shear() -> Current {
    Current::Linear { z0: 1.0, velocity: [0.4, 0.1, 0.0], gradient: [0.1, -0.3, 0.0] }
}

fn mass(sea: &Arc<Sea>, theory: Theory) -> AddedMass {
    let law = AddedMass::new(1025.0, 1.0).and_then(|law| law.in_current(shear())).expect("added mass");
    law.in_waves(Some(sea.clone())).by(theory)
}

fn pressure(sea: &Arc<Sea>, theory: Theory) -> FroudeKrylov {
    FroudeKrylov { density: 1025.0, current: shear(), sea: sea.clone(), theory }
}

/// A station that moves, as a function of time: its cell of 0.5 m lies about its middle.
struct Course {
    x: V3<f64>,
    v: V3<f64>,
    a: V3<f64>,
    slope: V3<f64>,
    rate: V3<f64>,
}

impl Course {
    fn at(&self, t: f64) -> Station<f64> {
        Station {
            x: [0, 1, 2].map(|i| self.x[i] + t * (self.v[i] + 0.5 * t * self.a[i])),
            v: [0, 1, 2].map(|i| self.v[i] + t * self.a[i]),
            a: self.a,
            slope: [0, 1, 2].map(|i| self.slope[i] + t * self.rate[i]),
            slope_rate: self.rate,
            s: 2.0,
            weight: 0.5,
            before: 0.2,
            element: 1.4,
            diameter: 0.3,
            area: PI * 0.0225,
            who: 0,
        }
    }
}

/// Courses whose stations are this high above the surface at a time.
fn courses(sea: &Sea, t: f64, above: f64) -> Vec<Course> {
    let slopes = [[1.0, 0.1, 0.05], [0.5, 0.6, 0.7], [0.05, -0.1, -1.02], [0.3, -0.9, 0.2]];
    let place = |k: usize| [3.0 * k as f64, -1.0 + k as f64, 0.0];
    let course = |(k, slope): (usize, V3<f64>)| {
        let mut x = place(k);
        x[2] = LEVEL + sea.at(t, &x).top.elevation + above;
        let twist = k as f64;
        Course {
            x,
            v: [0.7, -0.4 + 0.1 * twist, 0.5],
            a: [-0.3, 0.9, 0.4 - 0.2 * twist],
            slope,
            rate: [0.2, 0.1 * twist, -0.3],
        }
    };
    slopes.into_iter().enumerate().map(course).collect()
}

const ALL: [(WaveStretching, bool); 4] = [
    (WaveStretching::Wheeler, false),
    (WaveStretching::Wheeler, true),
    (WaveStretching::Constant, false),
    (WaveStretching::None, true),
];
/// Times while the waves rise and after.
const TIMES: [f64; 3] = [7.0, 33.0, 51.7];
/// Dry, cut by the surface from above and below, wet, deep.
const HEIGHTS: [f64; 6] = [1.0, 0.07, -0.02, -0.16, -1.0, -6.0];

/// A field with what it is tried with.
type Tried = (fn(&mut Station<f64>) -> &mut V3<f64>, [V3<f64>; 3], [V3<f64>; 3]);

#[test]
fn laws_in_waves_have_their_derivatives() {
    for (stretching, doppler) in ALL {
        let sea = sea(stretching, doppler, 1.0);
        let surface = Surface { level: LEVEL, sea: Some(sea.clone()) };
        for t in TIMES {
            for above in HEIGHTS {
                for course in courses(&sea, t, above) {
                    let at = course.at(0.0);
                    let near = |law: &dyn Fn() -> f64, what: &str| {
                        let error = law();
                        assert!(error < 3e-6, "{what} {stretching:?} {t} {above}: {error:e}");
                    };
                    near(&|| check_law(&Wetted::below(surface.clone(), drag(&sea)), t, &at), "drag");
                    near(&|| check_law(&Wetted::above(surface.clone(), drag(&sea)), t, &at), "drag above");
                    for couple in [true, false] {
                        let law = Buoyancy { specific_weight: 1e4, surface: surface.clone(), couple };
                        near(&|| check_law(&law, t, &at), "buoyancy");
                    }
                    let law = mass(&sea, Theory::Morison);
                    near(&|| check_law(&Wetted::below(surface.clone(), law.clone()), t, &at), "added mass");
                    let law = pressure(&sea, Theory::Morison);
                    near(&|| check_law(&Wetted::below(surface.clone(), law.clone()), t, &at), "pressure");
                }
            }
        }
    }
}

/// With the energy of the water derivatives by place lack how the gradient of velocity changes, and nothing else.
#[test]
fn with_the_energy_of_the_water_derivatives_lack_the_curvature_of_the_flow_alone() {
    let (t, e) = (33.0, 1e-4);
    for doppler in [false, true] {
        let sea = sea(WaveStretching::Constant, doppler, 1.0);
        let law = mass(&sea, Theory::Energy);
        let mut largest = 0.0_f64;
        for course in courses(&sea, t, -3.0) {
            let at = course.at(0.0);
            let mut load = Load::zero();
            law.load::<f64, true>(t, &at, &mut load);
            let moved = |j: usize, by: f64, field: fn(&mut Station<f64>) -> &mut V3<f64>| {
                let mut at = at;
                field(&mut at)[j] += by;
                let mut load = Load::zero();
                law.load::<f64, false>(t, &at, &mut load);
                [load.f, load.g]
            };
            let nought = [[0.0; 3]; 3];
            let fields: [Tried; 5] = [
                (|s| &mut s.x, load.d_x, load.g_x),
                (|s| &mut s.slope, load.d_slope, load.g_slope),
                (|s| &mut s.v, load.d_v, load.g_v),
                (|s| &mut s.a, load.d_a, nought),
                (|s| &mut s.slope_rate, load.d_rate, nought),
            ];
            let square = dot(&at.slope, &at.slope);
            let across = |w: V3<f64>| {
                let along = dot(&w, &at.slope) / square;
                [0, 1, 2].map(|i| w[i] - along * at.slope[i])
            };
            let u = sea.at(t, &at.x).u;
            let (current, _) = shear().at(at.x[2]);
            let n = across([0, 1, 2].map(|i| at.v[i] - u[i] - current[i]));
            let m = 1025.0 * at.area;
            for (k, (field, of_f, of_g)) in fields.into_iter().enumerate() {
                for j in 0..3 {
                    let [a, b] = [-e, e].map(|by| moved(j, by, field));
                    // how the gradient changes along this axis
                    let [before, after] = [-e, e].map(|by| {
                        let mut x = at.x;
                        x[j] += by;
                        sea.at(t, &x).gradient
                    });
                    let bend: [V3<f64>; 3] =
                        [0, 1, 2].map(|i| [0, 1, 2].map(|j| (after[i][j] - before[i][j]) / (2.0 * e)));
                    let pushed = across([0, 1, 2].map(|i| dot(&bend[i], &at.v)));
                    // who drifts sees the gradient in the acceleration as well
                    let seen = |i: usize| if doppler { 0.5 * bend[i][0] + 0.1 * bend[i][1] } else { 0.0 };
                    let carried = across([0, 1, 2].map(seen));
                    for i in 0..3 {
                        let mut left = 0.0;
                        if k == 0 {
                            left =
                                m * (pushed[i] - carried[i] - (0..3).map(|l| bend[l][i] * n[l]).sum::<f64>());
                            largest = largest.max(
                                left.abs() / of_f.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs())),
                            );
                        }
                        let by = (b[0][i] - a[0][i]) / (2.0 * e);
                        assert!(
                            (by - of_f[i][j] - left).abs() < 1e-3,
                            "{k} {i} {j}: {by} {} {left}",
                            of_f[i][j]
                        );
                        let by = (b[1][i] - a[1][i]) / (2.0 * e);
                        assert!((by - of_g[i][j]).abs() < 1e-3, "{k} {i} {j}: {by} {}", of_g[i][j]);
                    }
                }
            }
        }
        println!("left out: {largest:.2} of the largest derivative by place");
    }
}

/// What a law does and what it stores is what it is given, less what it takes: on any course, also through the surface.
#[test]
fn work_and_energy_balance() {
    let e = 1e-4;
    let mut worst = 0.0_f64;
    for (stretching, doppler) in ALL {
        let sea = sea(stretching, doppler, 1.0);
        let surface = Surface { level: LEVEL, sea: Some(sea.clone()) };
        for t in TIMES {
            for above in HEIGHTS {
                for course in courses(&sea, t, above) {
                    let wet = surface.clone();
                    worst = worst.max(left(&Wetted::below(wet.clone(), drag(&sea)), &course, t, e));
                    for theory in [Theory::Energy, Theory::Morison] {
                        worst =
                            worst.max(left(&Wetted::below(wet.clone(), mass(&sea, theory)), &course, t, e));
                        worst = worst.max(left(
                            &Wetted::below(wet.clone(), pressure(&sea, theory)),
                            &course,
                            t,
                            e,
                        ));
                    }
                    let law = Buoyancy { specific_weight: 1e4, surface: wet, couple: true };
                    worst = worst.max(left(&law, &course, t, e));
                }
            }
        }
    }
    println!("work and energy differ by {worst:.1e}");
    assert!(worst < 1e-6, "{worst:e}");
}

/// What is left of the balance of a law, in parts of its largest power.
fn left(law: &impl Law, course: &Course, t: f64, e: f64) -> f64 {
    let at = course.at(0.0);
    let mut load = Load::zero();
    law.load::<f64, false>(t, &at, &mut load);
    let done = dot(&load.f, &at.v) + dot(&load.g, &at.slope_rate);
    let stored = |e: f64| law.kinetic(t + e, &course.at(e)) + law.potential(t + e, &course.at(e));
    // of fourth order, but for where a cell begins to be wet
    let rate = (8.0 * (stored(e) - stored(-e)) - (stored(2.0 * e) - stored(-2.0 * e))) / (12.0 * e);
    let power = law.power(t, &at, &load);
    let size = load.f.iter().fold(1.0_f64, |m, f| m.max(f.abs()));
    (done + rate - power.supplied + power.dissipated).abs() / size
}

/// The table answers with its own derivatives, and is as near to the sum as it says.
#[test]
fn a_lattice_stands_for_the_sum() {
    let spec = WavesSpec {
        jonswap: Some(ropewalk_scene::Jonswap { hs: 4.0, tp: 9.0, gamma: 3.3 }),
        direction: 0.4,
        depth: Some(60.0),
        seed: 3,
        ..WavesSpec::default()
    };
    let exact = WavesSpec { evaluation: Some(Evaluation::Exact), ..spec.clone() };
    let exact = Sea::new(&exact, LEVEL, 9.81, [0.0; 3]).expect("sea");
    let lattice = table(spec);
    println!("{}", lattice.about());
    assert!(lattice.about().contains("lattice") && !exact.about().contains("lattice"));
    let surface = Surface { level: LEVEL, sea: Some(lattice.clone()) };
    for t in TIMES {
        for above in HEIGHTS {
            for course in courses(&lattice, t, above) {
                let at = course.at(0.0);
                let error = check_law(&Wetted::below(surface.clone(), drag(&lattice)), t, &at);
                assert!(error < 1e-5, "{error:e}");
                let [a, b] = [&exact, &*lattice].map(|sea| sea.at(t, &at.x));
                assert!(
                    (a.top.elevation - b.top.elevation).abs() < 4e-3,
                    "{} {}",
                    a.top.elevation,
                    b.top.elevation
                );
                for i in 0..3 {
                    assert!((a.u[i] - b.u[i]).abs() < 4e-3, "{:?} {:?}", a.u, b.u);
                }
            }
        }
    }
}
