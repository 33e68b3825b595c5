//! The tangent of the equations against differences.

use super::bordered::Bordered;
use super::path::Ring;
use super::problem::{Cable, Eyelet, LiftOff, Pull, Rule, Unwinding};
use super::state::{Column, M3, Now, Rates, State, plus, times};
use ropewalk_constraints::motion::Rest;
use ropewalk_core::V3;
use ropewalk_forces::{AddedMass, Drag, NormalLaw, TangentialLaw};
use ropewalk_scene::Current;
use std::sync::Arc;

/// Numbers without pattern in (-1, 1).
fn number(k: usize) -> f64 {
    2.0 * ((k as f64 * 0.754_877_666_2).fract() - 0.5)
}
fn vector(k: usize, scale: f64) -> V3<f64> {
    [scale * number(3 * k + 1), scale * number(5 * k + 2), scale * number(7 * k + 3)]
}
fn matrix(k: usize, scale: f64) -> M3 {
    [vector(k, scale), vector(k + 10, scale), vector(k + 20, scale)]
}

fn problem(through: Eyelet, lift_off: LiftOff, rule: Rule) -> Unwinding {
    let cable = Cable { mass: 0.9, diameter: 0.1, ei: 0.02, curvature_limit: 1e3 };
    let ring = Ring { radius: 0.6, height: 1.0, climb: 0.1, inner: true };
    let mut p = Unwinding::new(cable, Arc::new(ring), Arc::new(Rest), rule, 8);
    let mut drag = Drag::new(3.0, 1e-2, NormalLaw::ChooCasarella, TangentialLaw::Quadratic(0.4)).unwrap();
    drag.current = Current::Linear { z0: 0.1, velocity: [0.3, 0.2, -0.1], gradient: [0.2, -0.3, 0.1] };
    p.drag = Some(drag);
    p.added_mass = Some(AddedMass::new(30.0, 1.0).unwrap());
    p.weight = [0.1, 0.2, -0.5];
    (p.through, p.lift_off) = (through, lift_off);
    p
}

fn state(n: usize, now: &Now) -> State {
    let node = |j: usize| {
        let z = j as f64 / n as f64;
        [0.6 * z + 0.1 * (3.0 * z).sin(), 0.2 * z * (1.0 - z), z]
    };
    let mut y = State {
        t: 0.0,
        x: (0..=n).map(|j| plus(&node(j), 0.01, &vector(j, 1.0))).collect(),
        v: (0..=n).map(|j| vector(50 + j, 1.5)).collect(),
        a: (0..=n).map(|j| vector(90 + j, 4.0)).collect(),
        lambda: (0..n).map(|j| 2.0 + number(j)).collect(),
        peeled: [0.3, 1.2, 0.4],
        length: [1.25, 0.3, -0.7],
    };
    now.hold(&mut y);
    (y.x[0], y.v[0], y.a[0]) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    y
}

/// Residuals, with the scalar's row if the problem has one.
fn residual(
    p: &Unwinding,
    y: &State,
    now: &Now,
    rates: &Rates,
    column: &Column,
    out: &mut Bordered,
) -> Vec<f64> {
    p.assemble(y, now, rates, Some(column), [40.0, 7.0, 1.0], out);
    p.find(y, now, rates, column, out);
    out.rhs.iter().map(|r| -r).collect()
}

#[test]
fn the_tangent_is_that_of_differences() {
    let pull = Rule::Tension(Pull::constant(1.7));
    let guided = Eyelet::Guided([0.0, 0.0, 1.0]);
    let cases = [
        problem(Eyelet::Hinged, LiftOff::Free, pull.clone()),
        problem(guided, LiftOff::Tangent, pull),
        problem(guided, LiftOff::Tangent, Rule::Peel(0.3)),
    ];
    for p in &cases {
        let n = p.elements;
        let mut now = p.now(0.0, 0.3).unwrap();
        now.speed = [1.1, 0.6];
        let y = state(n, &now);
        let rates = Rates { x: 1.0, v: matrix(5, 3.0), a: matrix(40, 5.0) };
        let column = Column {
            length: [1.0, 2.5, -1.5],
            end: [vector(70, 1.0), vector(75, 1.0), vector(79, 1.0)],
            clamp: vector(83, 1.0),
        };
        let size = 4 * n - 2;
        let mut system = p.system(true);
        let h = 1e-5;
        let moved = |k: usize, h: f64| {
            let (mut y, mut now) = (y.clone(), now);
            if k == size - 1 {
                for i in 0..3 {
                    y.length[i] += h * column.length[i];
                }
                y.x[n] = plus(&y.x[n], h, &column.end[0]);
                y.v[n] = plus(&y.v[n], h, &column.end[1]);
                y.a[n] = plus(&y.a[n], h, &column.end[2]);
                now.clamp = plus(&now.clamp, h, &column.clamp);
            } else if k.is_multiple_of(4) {
                y.lambda[k / 4] += h;
            } else {
                let mut d = [0.0; 3];
                d[k % 4 - 1] = h;
                let j = k / 4 + 1;
                y.x[j] = plus(&y.x[j], 1.0, &d);
                y.v[j] = plus(&y.v[j], 1.0, &times(&rates.v, &d));
                y.a[j] = plus(&y.a[j], 1.0, &times(&rates.a, &d));
            }
            (y, now)
        };
        for k in 0..size {
            let ((a, now_a), (b, now_b)) = (moved(k, -h), moved(k, h));
            let ra = residual(p, &a, &now_a, &rates, &column, &mut system);
            let rb = residual(p, &b, &now_b, &rates, &column, &mut system);
            residual(p, &y, &now, &rates, &column, &mut system);
            for row in 0..size {
                let difference = (rb[row] - ra[row]) / (2.0 * h);
                let exact = system.entry(row, k);
                let close = 1e-5 * (1.0 + difference.abs().max(exact.abs()));
                assert!(
                    (difference - exact).abs() < close,
                    "{:?} row {row} by {k}: {difference} {exact}",
                    p.rule
                );
            }
        }
    }
}

// Small vibrations of a straight cable that runs between the eyelet and a guide.

/// A complex number.
#[derive(Clone, Copy)]
struct C(f64, f64);

impl C {
    fn times(self, o: C) -> C {
        C(self.0 * o.0 - self.1 * o.1, self.0 * o.1 + self.1 * o.0)
    }
    fn less(self, o: C) -> C {
        C(self.0 - o.0, self.1 - o.1)
    }
    fn over(self, o: C) -> C {
        let d = o.0 * o.0 + o.1 * o.1;
        C((self.0 * o.0 + self.1 * o.1) / d, (self.1 * o.0 - self.0 * o.1) / d)
    }
}

/// Eliminates below the diagonal without row exchanges; the product of the pivots' signs tells the determinant's sign,
/// as the matrix is Hermitian.
fn eliminate(a: &mut [Vec<C>], b: &mut [C]) -> bool {
    let n = a.len();
    let mut positive = true;
    for k in 0..n {
        positive ^= a[k][k].0 < 0.0;
        for row in k + 1..n {
            let f = a[row][k].over(a[k][k]);
            for column in k..n {
                a[row][column] = a[row][column].less(f.times(a[k][column]));
            }
            b[row] = b[row].less(f.times(b[k]));
        }
    }
    positive
}

/// Stiffness, gyroscopic and mass matrices across the straight cable, `[K, C, M]`.
fn matrices(p: &Unwinding, length: f64, tension: f64, speed: f64) -> [Vec<Vec<f64>>; 3] {
    let n = p.elements;
    let mut now = p.now(0.0, 0.0).unwrap();
    now.speed = [speed, 0.0];
    let mut y = State {
        t: 0.0,
        x: (0..=n).map(|j| [0.0, 0.0, length * j as f64 / n as f64]).collect(),
        v: vec![[0.0; 3]; n + 1],
        a: vec![[0.0; 3]; n + 1],
        lambda: vec![tension; n],
        peeled: [0.0, speed, 0.0],
        length: [length, 0.0, 0.0],
    };
    now.hold(&mut y);
    let zero = [[0.0; 3]; 3];
    let one = super::state::identity(1.0);
    [Rates { x: 1.0, v: zero, a: zero }, Rates { x: 0.0, v: one, a: zero }, Rates { x: 0.0, v: zero, a: one }]
        .map(|rates| {
            let mut system = p.system(false);
            p.assemble(&y, &now, &rates, None, [0.0, 0.0, 1.0], &mut system);
            let entry = |i: usize, j: usize| system.entry(4 * i + 1, 4 * j + 1);
            (0..n - 1).map(|i| (0..n - 1).map(|j| entry(i, j)).collect()).collect()
        })
}

fn string(segments: usize, bending: f64) -> Unwinding {
    let cable = Cable { mass: 1e-3, diameter: 0.9e-3, ei: bending, curvature_limit: 1e3 };
    let guide = super::Guide { x: [0.0, 0.0, 0.25], direction: [0.0, 0.0, 1.0] };
    Unwinding::new(cable, Arc::new(guide), Arc::new(Rest), Rule::Length, segments)
}

fn dynamic(m: &[Vec<Vec<f64>>; 3], omega: f64) -> Vec<Vec<C>> {
    let n = m[0].len();
    let entry = |i: usize, j: usize| C(m[0][i][j] - omega * omega * m[2][i][j], omega * m[1][i][j]);
    (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
}

/// The natural frequency next to a guess.
fn frequency(m: &[Vec<Vec<f64>>; 3], guess: f64) -> f64 {
    let sign = |omega: f64| eliminate(&mut dynamic(m, omega), &mut vec![C(0.0, 0.0); m[0].len()]);
    let (mut low, mut high) = (0.9 * guess, 1.1 * guess);
    let below = sign(low);
    assert!(below != sign(high), "no frequency near {guess}");
    while high - low > 1e-10 * guess {
        let middle = 0.5 * (low + high);
        if sign(middle) == below { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

fn reference() -> serde_json::Value {
    serde_json::from_str(include_str!("../../tests/data/moving_string.json")).unwrap()
}

#[test]
fn a_moving_string_has_its_frequencies() {
    for case in reference()["f1"].as_array().unwrap() {
        let speed = case["V"].as_f64().unwrap();
        for k in 0..3 {
            let exact = case["omega"][k].as_f64().unwrap();
            let error = [20, 40].map(|n| {
                let m = matrices(&string(n, 0.0), 0.25, 2.0, speed);
                (frequency(&m, exact) / exact - 1.0).abs()
            });
            assert!(error[1] < 1.2e-2 * ((k + 1) as f64 / 3.0).powi(2), "{speed} {k}: {error:?}");
            let order = (error[0] / error[1]).log2();
            assert!((1.9..2.2).contains(&order), "{speed} {k}: {error:?}");
        }
    }
}

#[test]
fn a_moving_beam_has_its_frequencies() {
    for case in reference()["f2"].as_array().unwrap() {
        let [speed, bending] = ["V", "EI"].map(|k| case[k].as_f64().unwrap());
        let exact = case["omega"][0].as_f64().unwrap();
        let error = [20, 40].map(|n| {
            let mut p = string(n, bending);
            p.lift_off = LiftOff::Free;
            (frequency(&matrices(&p, 0.25, 2.0, speed), exact) / exact - 1.0).abs()
        });
        assert!(error[1] < 2e-3, "{speed} {bending}: {error:?}");
        assert!((1.8..2.3).contains(&(error[0] / error[1]).log2()), "{speed} {bending}: {error:?}");
    }
}

/// `w = sin(nπs/L) cos(ωt + κs)`, `κ = -ωV/(c² - V²)` as the material runs against `s`: frequencies alone are blind to the
/// sign of the Coriolis term, the shapes aren't.
#[test]
fn a_moving_string_has_its_mode_shapes() {
    let off = |n: usize, mode: usize, coriolis: f64| {
        let (speed, tension, len) = (30.0, 2.0, 0.25);
        let mut p = string(n, 0.0);
        p.coriolis = coriolis;
        let m = matrices(&p, len, tension, speed);
        let c2 = tension / 1e-3;
        let omega = mode as f64 * std::f64::consts::PI * (c2 - speed * speed) / (c2.sqrt() * len);
        let found = frequency(&m, omega);
        let kappa = -omega * speed / (c2 - speed * speed);
        // one inverse iteration at the frequency itself
        let mut a = dynamic(&m, found);
        let mut b: Vec<C> = (0..n - 1).map(|k| C(1.0 + number(k), number(7 * k))).collect();
        eliminate(&mut a, &mut b);
        for k in (0..n - 1).rev() {
            let rest = (k + 1..n - 1).fold(b[k], |sum, c| sum.less(a[k][c].times(b[c])));
            b[k] = rest.over(a[k][k]);
        }
        let exact: Vec<C> = (1..n)
            .map(|j| {
                let s = len * j as f64 / n as f64;
                let amplitude = (mode as f64 * std::f64::consts::PI * s / len).sin();
                C(amplitude * (kappa * s).cos(), amplitude * (kappa * s).sin())
            })
            .collect();
        // scaled for the least squares of the difference
        let conjugate = |a: C| C(a.0, -a.1);
        let dot = |a: &[C], b: &[C]| {
            a.iter().zip(b).fold(C(0.0, 0.0), |sum, (a, b)| {
                let t = conjugate(*a).times(*b);
                C(sum.0 + t.0, sum.1 + t.1)
            })
        };
        let scale = dot(&b, &exact).over(dot(&b, &b));
        (0..n - 1).fold(0.0_f64, |worst, k| {
            let d = b[k].times(scale).less(exact[k]);
            worst.max(d.0.hypot(d.1))
        })
    };
    for mode in 1..=3 {
        let (coarse, fine) = (off(20, mode, -2.0), off(40, mode, -2.0));
        assert!(fine < 6e-3 * (mode * mode) as f64, "{mode}: {fine}");
        assert!((1.8..2.3).contains(&(coarse / fine).log2()), "{mode}: {coarse} {fine}");
        assert!(off(40, mode, 2.0) > 0.3, "a wrong sign must show");
    }
}

/// The water moves with the curve, not with the material: `ω = nπ (T - mV²)/(L √(m²V² + (T - mV²)(m + m_a)))`.
#[test]
fn water_is_carried_by_the_curve_alone() {
    let (speed, tension, len, m) = (30.0, 2.0, 0.25, 1e-3);
    let mut p = string(80, 0.0);
    p.added_mass = Some(AddedMass::new(1025.0, 1.0).unwrap());
    let carried = 1025.0 * std::f64::consts::PI / 4.0 * 0.9e-3_f64.powi(2);
    let net = tension - m * speed * speed;
    let exact = std::f64::consts::PI * net / len / (m * m * speed * speed + net * (m + carried)).sqrt();
    let found = frequency(&matrices(&p, len, tension, speed), exact);
    assert!((found / exact - 1.0).abs() < 3e-4, "{found} {exact}");
}
