//! The tangent of the equations against differences.

use super::bordered::Bordered;
use super::path::Ring;
use super::problem::{Cable, Eyelet, LiftOff, Pull, Rule, Unwinding};
use super::state::{Column, M3, Now, Rates, State, plus, times};
use ropewalk_constraints::motion::Rest;
use ropewalk_core::{Current, V3};
use ropewalk_forces::{AddedMass, Drag, NormalLaw, TangentialLaw};
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
    let cable = Cable { mass: 0.9, diameter: 0.1, bending: 0.02, curvature_limit: 1e3 };
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
        let n = p.segments;
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
