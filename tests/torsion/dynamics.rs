//! Motion in time.

use super::{last, place, run, scene};
use ropewalk::{Options, Simulation};
use ropewalk_core::integrator::{Scheme, Stepping};

/// Large bending and twisting at once keep their energy.
#[test]
fn a_twisted_cable_that_swings_keeps_its_energy() {
    let mut seen = Vec::new();
    for tol in [1e-5, 1e-7] {
        let h = run(include_str!("swing.toml"), &[format!("tol={tol}")]);
        let s = h.summary();
        println!("{tol}: {:?}", s);
        seen.push((place(&h, "rod.end"), last(&h, "rod.end.angle")));
    }
    let [(a, x), (b, y)] = [seen[0], seen[1]];
    assert!(super::apart(a, b) < 1e-3 && (x - y).abs() < 1e-2, "{seen:?}");
}

/// Positions and twist at the end of a short motion, by fixed steps of either scheme.
fn end(scheme: Scheme, h: f64) -> Vec<f64> {
    let scene = scene(include_str!("swing.toml"), &["n=2".into()]);
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let options = Options { scheme, stepping: Stepping::Fixed { h }, ..Options::default() };
    let mut s = Simulation::new(model, &options, 0.1).unwrap_or_else(|e| panic!("{e}"));
    s.advance(0.1, 0.1, &mut ()).unwrap_or_else(|e| panic!("{e}"));
    let part = s.model.part("rod").expect("rod");
    let at = s.state.at();
    let (x, _) = part.point(1.0, &at).expect("its end");
    let angle = part.observe(ropewalk_core::Quantity::Angle, 1.0, &at).expect("an angle");
    vec![x[0], x[1], x[2], angle]
}

#[test]
fn schemes_have_their_orders() {
    let exact = end(Scheme::RadauIia5, 2.5e-4);
    for (scheme, h, order) in
        [(Scheme::GeneralizedAlpha { rho_inf: 0.8 }, 1e-3, 1.8), (Scheme::RadauIia5, 4e-3, 3.5)]
    {
        let errors = [h, 0.5 * h]
            .map(|h| end(scheme, h).iter().zip(&exact).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())));
        println!("{scheme:?}: {errors:?}");
        assert!((errors[0] / errors[1]).log2() > order, "{scheme:?}: {errors:?}");
    }
}

/// A checkpoint holds all there is: going on from it gives the same to the last bit.
#[test]
fn a_run_goes_on_from_a_checkpoint() {
    let options = Options::default();
    let build =
        || scene(include_str!("swing.toml"), &["n=4".into()]).build().unwrap_or_else(|e| panic!("{e}"));
    let mut one = Simulation::new(build(), &options, 0.2).unwrap_or_else(|e| panic!("{e}"));
    one.advance(0.1, 0.1, &mut ()).unwrap_or_else(|e| panic!("{e}"));
    let kept = one.checkpoint().unwrap_or_else(|e| panic!("{e}"));
    let mut other = Simulation::restore(build(), &options, 0.2, kept).unwrap_or_else(|e| panic!("{e:?}"));
    for s in [&mut one, &mut other] {
        s.advance(0.2, 0.1, &mut ()).unwrap_or_else(|e| panic!("{e}"));
    }
    assert_eq!(one.state.q, other.state.q);
    assert_eq!(one.state.v, other.state.v);
}
