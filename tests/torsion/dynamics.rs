//! Motion in time.

use super::{last, place, run, scene};
use ropewalk::{Options, Simulation};
use ropewalk_core::integrator::{Scheme, Stepping};
use ropewalk_core::{Model, Quantity};

fn built(set: &str) -> Model {
    scene(include_str!("swing.toml"), &[set.into()]).build().unwrap_or_else(|e| panic!("{e}"))
}

/// Large bending and twisting at once keep their energy, of which there are 14 J.
#[test]
fn a_twisted_cable_that_swings_keeps_its_energy() {
    let mut seen = Vec::new();
    for (tol, most) in [(1e-5, 1e-4), (1e-7, 1e-6), (1e-8, 1e-7)] {
        let h = run(include_str!("swing.toml"), &[format!("tol={tol}")]);
        let energy = h.summary().energy;
        println!("{tol}: {energy:?}");
        assert!(energy.imbalance.abs() < most && energy.initial > 14.0, "{tol}: {energy:?}");
        seen.push((place(&h, "rod.end"), last(&h, "rod.end.angle")));
    }
    let [(a, x), .., (b, y)] = seen[..] else { unreachable!() };
    assert!(super::apart(a, b) < 1e-4 && (x - y).abs() < 1e-3, "{seen:?}");
}

/// Positions and twist at the end of a short motion, by fixed steps of a scheme.
fn end(scheme: Scheme, h: f64) -> Vec<f64> {
    let options = Options { scheme, stepping: Stepping::Fixed { h }, ..Options::default() };
    let mut s = Simulation::new(built("n=2"), &options, 0.1).unwrap_or_else(|e| panic!("{e}"));
    s.advance(0.1, 0.1, &mut ()).unwrap_or_else(|e| panic!("{e}"));
    let part = s.model.part("rod").expect("rod");
    let at = s.state.at();
    let (x, _) = part.point(1.0, &at).expect("its end");
    let angle = part.observe(Quantity::Angle, 1.0, &at).expect("an angle");
    vec![x[0], x[1], x[2], angle]
}

#[test]
fn schemes_have_their_orders() {
    let exact = end(Scheme::RadauIia5, 2.5e-4);
    for (scheme, h, order) in [
        (Scheme::GeneralizedAlpha { rho_inf: 0.8 }, 1e-3, 1.8),
        (Scheme::Hht { alpha: -0.1 }, 1e-3, 1.8),
        (Scheme::RadauIia5, 4e-3, 3.5),
    ] {
        let errors = [h, 0.5 * h]
            .map(|h| end(scheme, h).iter().zip(&exact).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())));
        println!("{scheme:?}: {errors:?}");
        assert!((errors[0] / errors[1]).log2() > order, "{scheme:?}: {errors:?}");
    }
}

/// A checkpoint holds all there is: going on from it gives the same to the last bit.
#[test]
fn a_run_goes_on_from_a_checkpoint() {
    for scheme in [Scheme::GeneralizedAlpha { rho_inf: 0.8 }, Scheme::Hht { alpha: -0.1 }, Scheme::RadauIia5]
    {
        let options = Options { scheme, ..Options::default() };
        let build = || built("n=4");
        let mut one = Simulation::new(build(), &options, 0.2).unwrap_or_else(|e| panic!("{e}"));
        one.advance(0.1, 0.1, &mut ()).unwrap_or_else(|e| panic!("{e}"));
        let kept = one.checkpoint().unwrap_or_else(|e| panic!("{e}"));
        let mut other = Simulation::restore(build(), &options, 0.2, kept).unwrap_or_else(|e| panic!("{e:?}"));
        for s in [&mut one, &mut other] {
            s.advance(0.2, 0.1, &mut ()).unwrap_or_else(|e| panic!("{e}"));
        }
        assert_eq!(one.state.q, other.state.q, "{scheme:?}");
        assert_eq!(one.state.v, other.state.v, "{scheme:?}");
    }
}

/// A state that is brought over to another mesh keeps its turns, and how it looks and spins.
#[test]
fn a_finer_mesh_takes_the_twist_over() {
    let (coarse, fine) = (built("n=8"), built("n=24"));
    let mut s = Simulation::new(coarse, &Options::default(), 0.3).unwrap_or_else(|e| panic!("{e}"));
    s.advance(0.3, 0.3, &mut ()).unwrap_or_else(|e| panic!("{e}"));
    let carried = fine.carry(&s.model, &s.state);
    for what in [Quantity::Angle, Quantity::Spin, Quantity::Torque] {
        for at in [0.3125, 0.6875, 1.0] {
            let see = |model: &Model, state: &ropewalk_core::State| {
                let part = model.part("rod").expect("rod");
                part.observe(what, at, &state.at()).expect("seen")
            };
            let (before, after) = (see(&s.model, &s.state), see(&fine, &carried));
            println!("{what:?} at {at}: {before} {after}");
            assert!(
                (before - after).abs() < 2e-3 * (1.0 + before.abs()),
                "{what:?} at {at}: {before} {after}"
            );
        }
    }
}
