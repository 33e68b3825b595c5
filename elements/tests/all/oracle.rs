//! The elastic force of every model against the reference, and what must hold for all of them.

use crate::common::*;
use ropewalk_core::{Element, LaneTask, Local, Real, Relaxation, Share, Weights, Width, run};
use ropewalk_elements::cable::longitudinal::Longitudinal;
use ropewalk_elements::cable::quadrature::{Gauss2, Gauss3, Gauss5, Lobatto3, Quadrature, Rule};
use ropewalk_elements::cable::transverse::Transverse;
use ropewalk_elements::cable::*;
use serde_json::Value;
use std::marker::PhantomData;

/// One quadrature for both parts.
#[derive(Clone, Copy)]
struct Both<Q>(PhantomData<Q>);
impl<Q: Quadrature> Rule for Both<Q> {
    const LABEL: &'static str = Q::LABEL;
    type Axial = Q;
    type Bending = Q;
}

fn params(o: &Value, ea: f64, ei: f64, rho_a: f64) -> CableParams {
    let get = |name: &str, by: f64| o[name].as_f64().expect("a number") * by;
    CableParams { l: get("L", 1.0), ea: get("EA", ea), ei: get("EI", ei), rho_a: get("rhoA", rho_a) }
}

/// The largest error over all configurations: energy, force, tangent, in units of the largest tangent entry.
fn errors<E: Element<12, 12, Lanes<f64> = CableParams>>(
    model: &str,
    rule: &str,
    p: &CableParams,
    o: &Value,
) -> [f64; 3] {
    let mut worst = [0.0_f64; 3];
    for (name, e) in configurations(o) {
        let reference = &o["configs"][&name]["models"][model][rule];
        let k: Vec<[f64; 12]> = (0..12).map(|i| numbers(&reference["K"][i])).collect();
        let scale = largest(k.iter().flatten());
        let x = at(e, [0.0; 12], [0.0; 12]);
        let out = eval::<E>(p, &x, STIFFNESS);
        let energy = E::energy(p, &x).potential - reference["U"].as_f64().expect("U");
        let force = apart(&out.r, &numbers::<12>(&reference["f"]));
        let tangent = largest((0..12).map(|i| apart(&out.k[i], &k[i])).collect::<Vec<_>>().iter());
        for (w, x) in worst.iter_mut().zip([energy.abs() / (p.l * p.l), force / p.l, tangent]) {
            *w = w.max(if x.is_nan() { f64::INFINITY } else { x / scale });
        }
    }
    println!("{model} {rule}: energy {:.1e}, force {:.1e}, tangent {:.1e}", worst[0], worst[1], worst[2]);
    worst
}

fn holds(worst: [f64; 3]) {
    assert!(worst.iter().all(|&e| e < 1e-12), "{worst:?}");
}

fn axial<L: Longitudinal, Q: Quadrature>(model: &str, rule: &str, o: &Value) {
    holds(errors::<Cable<L, T1, Both<Q>>>(model, rule, &params(o, 1.0, 0.0, 0.0), o));
}
fn bending<T: Transverse, Q: Quadrature>(model: &str, rule: &str, o: &Value) {
    holds(errors::<Cable<L2, T, Both<Q>>>(model, rule, &params(o, 0.0, 1.0, 0.0), o));
}

#[test]
fn longitudinal_models_agree_with_the_oracle() {
    let o = oracle();
    axial::<L1, Gauss2>("L1", "exact", &o);
    axial::<L1n, Gauss2>("L1n", "exact", &o);
    axial::<L2, Gauss2>("L2", "exact", &o);
    axial::<L3, Gauss2>("L3", "g2", &o);
    axial::<L3, Gauss3>("L3", "g3", &o);
    axial::<L3, Gauss5>("L3", "g5", &o);
    axial::<L3, Gauss5>("L3", "exact", &o);
    axial::<L3, Lobatto3>("L3", "lob3", &o);
    axial::<L4, Gauss2>("L4", "g2", &o);
    axial::<L4, Gauss3>("L4", "g3", &o);
    axial::<L4, Gauss5>("L4", "g5", &o);
    axial::<L4, Lobatto3>("L4", "lob3", &o);
}

#[test]
fn transverse_models_agree_with_the_oracle() {
    let o = oracle();
    bending::<T1, Gauss2>("T1", "exact", &o);
    bending::<T1, Gauss5>("T1", "g5", &o);
    bending::<T2, Gauss2>("T2", "g2", &o);
    bending::<T2, Gauss3>("T2", "g3", &o);
    bending::<T2, Gauss5>("T2", "g5", &o);
    bending::<T2, Lobatto3>("T2", "lob3", &o);
    bending::<T3, Gauss2>("T3", "g2", &o);
    bending::<T3, Gauss3>("T3", "g3", &o);
    bending::<T3, Gauss5>("T3", "g5", &o);
    bending::<T3, Lobatto3>("T3", "lob3", &o);
}

#[test]
fn mass_agrees_with_the_oracle() {
    let o = oracle();
    let p = params(&o, 0.0, 0.0, 1.0);
    type E = Cable<L4, T3, LockingFree>;
    let straight = configurations(&o)[0].1;
    let a = noise(3, 1.0);
    let out = eval::<E>(&p, &at(straight, a, a), Weights { a: 1.0, ..Weights::default() });
    let mut kinetic = 0.0;
    let mut inertia = [0.0; 12];
    for i in 0..12 {
        for j in 0..12 {
            let m = if i % 3 == j % 3 { o["mass4"][i / 3][j / 3].as_f64().expect("a number") } else { 0.0 };
            approx::assert_abs_diff_eq!(out.k[i][j], m, epsilon = 1e-15);
            inertia[i] += m * a[j];
        }
        kinetic += 0.5 * a[i] * inertia[i];
    }
    assert!(apart(&out.r, &inertia) < 1e-15);
    approx::assert_relative_eq!(E::energy(&p, &at(straight, a, a)).kinetic, kinetic, max_relative = 1e-14);
}

/// Runs one check on every legal pair of models.
fn all_models(f: &mut dyn FnMut(CableModel)) {
    use {LongitudinalModel as L, TransverseModel as T};
    for longitudinal in [L::L1, L::L1n, L::L2, L::L3, L::L4] {
        for transverse in [T::T1, T::T2, T::T3] {
            for integration in [Integration::Full, Integration::LockingFree] {
                if legal(longitudinal, transverse).is_ok() {
                    f(CableModel { longitudinal, transverse, integration });
                }
            }
        }
    }
}

/// Evaluates a whole row of states over lanes.
struct Row<'a, E> {
    p: &'a CableParams,
    states: &'a [Local<f64, 12, 12>],
    out: &'a mut Vec<Share<f64, 12>>,
    element: PhantomData<E>,
}
/// `Element` with its lanes known to the tests.
trait Kernel {
    fn add<R: Real>(p: &CableParams, x: &Local<R, 12, 12>, w: &Weights, out: &mut Share<R, 12>);
}
impl<L: Longitudinal, T: Transverse, Q: Rule> Kernel for Cable<L, T, Q> {
    #[inline(always)]
    fn add<R: Real>(p: &CableParams, x: &Local<R, 12, 12>, w: &Weights, out: &mut Share<R, 12>) {
        <Self as Element<12, 12>>::add::<R, true>(&p.lanes(), x, w, out);
    }
}
impl<E: Kernel> LaneTask for Row<'_, E> {
    #[inline(always)]
    fn go<R: Real>(self) {
        for s in self.states.chunks(R::LANES) {
            let pick = |f: &dyn Fn(&Local<f64, 12, 12>, usize) -> f64| -> [R; 12] {
                std::array::from_fn(|i| R::each(|l| f(&s[l.min(s.len() - 1)], i)))
            };
            let x = Local {
                q: pick(&|s, i| s.q[i]),
                v: pick(&|s, i| s.v[i]),
                a: pick(&|s, i| s.a[i]),
                last: pick(&|s, i| s.last[i]),
                relaxed: s[0].relaxed,
            };
            let mut out = Share::zero();
            E::add(self.p, &x, &Weights { q: 1.0, v: 0.5, a: 3.0 }, &mut out);
            for l in 0..s.len() {
                let k = std::array::from_fn(|i| std::array::from_fn(|j| out.k[i][j].lane(l)));
                self.out.push(Share { r: std::array::from_fn(|i| out.r[i].lane(l)), k });
            }
        }
    }
}

/// The largest difference between the widths.
fn widths<L: Longitudinal, T: Transverse, Q: Rule>(p: &CableParams, states: &[Local<f64, 12, 12>]) {
    let [one, four, eight] = [Width::One, Width::Four, Width::Eight].map(|width| {
        let mut out = Vec::new();
        run(width, Row::<Cable<L, T, Q>> { p, states, out: &mut out, element: PhantomData });
        out
    });
    let mut worst = 0.0_f64;
    for wide in [four, eight] {
        for (a, b) in one.iter().zip(&wide) {
            let scale = largest(a.k.iter().flatten());
            for i in 0..12 {
                worst = worst.max(apart(&a.k[i], &b.k[i]) / scale);
            }
            worst = worst.max(apart(&a.r, &b.r) / (scale * p.l));
        }
    }
    println!("{}: widths differ by {worst:.1e}", <Cable<L, T, Q> as Element<12, 12>>::label());
    assert!(worst < 1e-13);
}

#[test]
fn widths_agree() {
    let o = oracle();
    let p = params(&o, 1.0, 1.0, 1.0);
    let states: Vec<_> =
        configurations(&o).into_iter().map(|(_, e)| at(e, noise(1, 1.0), noise(2, 1.0))).collect();
    // every strain and every curvature once: kernels over lanes take long to compile
    widths::<L4, T3, LockingFree>(&p, &states);
    widths::<L3, T2, Full>(&p, &states);
    widths::<L2, T1, LockingFree>(&p, &states);
    widths::<L1, T1, LockingFree>(&p, &states);
    widths::<L1n, T1, LockingFree>(&p, &states);
}

struct Symmetry<'a>(&'a CableParams, &'a [f64; 12]);
impl WithModels for Symmetry<'_> {
    type Output = (bool, f64);
    fn go<L: Longitudinal, T: Transverse, Q: Rule>(self) -> (bool, f64) {
        let k = eval::<Cable<L, T, Q>>(self.0, &at(*self.1, [0.0; 12], [0.0; 12]), STIFFNESS).k;
        let mut skew = 0.0_f64;
        for i in 0..12 {
            for j in 0..i {
                skew = skew.max((k[i][j] - k[j][i]).abs());
            }
        }
        (Cable::<L, T, Q>::SYMMETRIC, skew)
    }
}

#[test]
fn tangents_are_symmetric_where_they_say_so() {
    let o = oracle();
    let p = params(&o, 1.0, 1.0, 1.0);
    let e: [f64; 12] = numbers(&o["configs"]["random_3d"]["e"]);
    all_models(&mut |m| {
        let (symmetric, skew) = with_models(m, Symmetry(&p, &e)).expect("legal");
        assert_eq!(symmetric, m.longitudinal != LongitudinalModel::L1n);
        assert_eq!(symmetric, skew == 0.0, "{m:?}: {skew}");
    });
}

struct Objectivity<'a>(&'a CableParams, &'a [f64; 12]);
impl WithModels for Objectivity<'_> {
    type Output = [f64; 2];
    fn go<L: Longitudinal, T: Transverse, Q: Rule>(self) -> [f64; 2] {
        let f = |e: &[f64; 12]| eval::<Cable<L, T, Q>>(self.0, &at(*e, [0.0; 12], [0.0; 12]), STIFFNESS);
        let here = f(self.1);
        let scale = largest(here.k.iter().flatten()) * self.0.l;
        let turn = apart(&f(&rotated(self.1)).r, &rotated(&here.r)) / scale;
        // the shifted positions are rounded, so compare with what those rounded numbers mean at the origin
        let far = shifted(self.1, [1e4, -2e4, 3e4]);
        let back = shifted(&far, [-1e4, 2e4, -3e4]);
        let shift = apart(&f(&far).r, &f(&back).r) / scale;
        [turn, shift]
    }
}

#[test]
fn rigid_motion_changes_nothing() {
    let o = oracle();
    let p = params(&o, 1.0, 1.0, 1.0);
    let mut worst = [0.0_f64; 2];
    for (_, e) in configurations(&o) {
        all_models(&mut |m| {
            let x = with_models(m, Objectivity(&p, &e)).expect("legal");
            worst = [worst[0].max(x[0]), worst[1].max(x[1])];
        });
    }
    println!("rotation {:.1e}, translation {:.1e}", worst[0], worst[1]);
    assert!(worst[0] < 5e-15);
    assert_eq!(worst[1], 0.0, "only r2 - r1 counts, and that is exact once positions are rounded");
}

/// The number of zero modes of a straight element, by elimination with complete pivoting.
fn nullity(mut k: [[f64; 12]; 12]) -> usize {
    let scale = largest(k.iter().flatten());
    for n in 0..12 {
        let mut pivot = (n, n);
        for i in n..12 {
            for j in n..12 {
                if k[i][j].abs() > k[pivot.0][pivot.1].abs() {
                    pivot = (i, j);
                }
            }
        }
        if k[pivot.0][pivot.1].abs() < 1e-12 * scale {
            return 12 - n;
        }
        k.swap(n, pivot.0);
        for row in &mut k {
            row.swap(n, pivot.1);
        }
        for i in n + 1..12 {
            let f = k[i][n] / k[n][n];
            for j in n..12 {
                k[i][j] -= f * k[n][j];
            }
        }
    }
    0
}

struct Nullity<'a>(&'a CableParams, &'a [f64; 12]);
impl WithModels for Nullity<'_> {
    type Output = usize;
    fn go<L: Longitudinal, T: Transverse, Q: Rule>(self) -> usize {
        nullity(eval::<Cable<L, T, Q>>(self.0, &at(*self.1, [0.0; 12], [0.0; 12]), STIFFNESS).k)
    }
}

#[test]
fn nothing_but_rigid_modes_is_free() {
    let o = oracle();
    let p = params(&o, 1.0, 1.0, 1.0);
    let straight: [f64; 12] = numbers(&o["configs"]["straight"]["e"]);
    // three translations and two rotations: spinning about its own axis, a straight element doesn't move
    all_models(&mut |m| assert_eq!(with_models(m, Nullity(&p, &straight)).expect("legal"), 5, "{m:?}"));
    // and what is refused would have two modes more
    let k = eval::<Cable<L2, T3, LockingFree>>(&p, &at(straight, [0.0; 12], [0.0; 12]), STIFFNESS).k;
    assert_eq!(nullity(k), 7);
    assert!(legal(LongitudinalModel::L2, TransverseModel::T3).is_err());
}

struct Mixed<'a>(&'a CableParams, &'a [f64; 12]);
impl WithModels for Mixed<'_> {
    type Output = [f64; 2];
    fn go<L: Longitudinal, T: Transverse, Q: Rule>(self) -> [f64; 2] {
        let mut x = at(*self.1, [0.0; 12], [0.0; 12]);
        let exact = eval::<Cable<L, T, Q>>(self.0, &x, STIFFNESS);
        let scale = largest(exact.k.iter().flatten());
        let distance = |x: &Local<f64, 12, 12>| {
            let mixed = eval::<Cable<L, T, Q>>(self.0, x, STIFFNESS);
            assert_eq!(mixed.r, exact.r);
            (0..12).map(|i| apart(&mixed.k[i], &exact.k[i])).fold(0.0, f64::max) / scale
        };
        let free = f64::INFINITY;
        x.relaxed = Some(Relaxation { smooth: true, ramp: free, ramp_before: free, load: 0.0, floor: None });
        let none = distance(&x);
        x.last = noise(9, 1e-3);
        [none, distance(&x)]
    }
}

#[test]
fn mixed_stress_is_the_exact_tangent_where_nothing_moved() {
    let o = oracle();
    let p = params(&o, 1.0, 1.0, 1.0);
    let e: [f64; 12] = numbers(&o["configs"]["random_3d"]["e"]);
    all_models(&mut |m| {
        let [none, some] = with_models(m, Mixed(&p, &e)).expect("legal");
        assert!(none < 1e-15, "{m:?}: {none}");
        // the linearised strain is off by the square of the increment
        assert!(some > 1e-9 && some < 1e-4, "{m:?}: {some}");
    });
}

#[test]
fn models_have_their_names_in_scenes() {
    let m: CableModel =
        serde_json::from_str(r#"{"longitudinal": "L1n", "transverse": "T1", "integration": "locking-free"}"#)
            .expect("names");
    assert_eq!(m.longitudinal, LongitudinalModel::L1n);
    assert_eq!(serde_json::to_value(m.integration).expect("name"), "locking-free");
    assert_eq!(CableModel::default().longitudinal, LongitudinalModel::L4);
}
