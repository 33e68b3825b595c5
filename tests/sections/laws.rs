//! Stiffness that changes along a cable or isn't proportional, against closed forms, differences and the balance of energy.

use crate::{last, run, scene};
use ropewalk_core::testing::{check_constraint, check_tangent, difference};
use ropewalk_core::{At, Simulation, Width};
use std::fmt::Write;

/// A straight cable from the origin along x, clamped there, with what else there is.
fn beam(length: f64, made_of: &str, rest: &str) -> String {
    format!(
        r#"
        run = {{ analysis = "statics" }}
        [[elements]]
        type = "cable"
        name = "beam"
        points = [[0, 0, 0], [{length}, 0, 0]]
        {made_of}
        [[constraints]]
        type = "clamp"
        name = "root"
        marker = "beam.start"
        [[records]]
        type = "position"
        of = "beam.end"
        [[records]]
        type = "reaction"
        of = "root"
        {rest}"#
    )
}

fn pull(force: [f64; 3]) -> String {
    format!("[[forces]]\ntype = \"point_force\"\nmarker = \"beam.end\"\nforce = {force:?}\n")
}

/// A table of a function at `n` places from 0 on, `{ x = […], y = […] }`.
fn table(x: &str, y: &str, n: usize, to: f64, of: impl Fn(f64) -> f64) -> String {
    let places: Vec<f64> = (0..n).map(|k| to * k as f64 / (n - 1) as f64).collect();
    let values: Vec<f64> = places.iter().map(|x| of(*x)).collect();
    format!("{{ {x} = {places:?}, {y} = {values:?} }}")
}

#[test]
fn a_beam_that_tapers_bends_as_the_integral_of_its_moment() {
    let (length, force): (f64, f64) = (2.0, 1e-3);
    for [a, b] in [[100.0, 20.0], [20.0, 100.0], [50.0, 49.0]] {
        // δ = F ∫ (L-x)²/EI dx
        let c: f64 = (b - a) / length;
        let exact = force / c.powi(3) * (b * b * f64::ln(b / a) - 2.0 * b * (b - a) + 0.5 * (b * b - a * a));
        let mut errors = Vec::new();
        for n in [8, 16, 32] {
            let made_of = format!(
                "elements = {n}\nsections = [{{ section = {{ mass = 1, ea = 1e6, ei = {a} }}, end_section = {{ mass = 1, ea = \
                 1e6, ei = {b} }} }}]"
            );
            let curvature = "[[records]]\ntype = \"along\"\nof = \"beam\"\nwhat = \"moment\"\nat = \"30 %\"\nname = \"m\"\n";
            let h = run(&beam(length, &made_of, &(pull([0.0, 0.0, force]) + curvature)));
            errors.push((last(&h, "beam.end.z") / exact - 1.0).abs());
            let moment = last(&h, "m") / (force * 0.7 * length) - 1.0;
            assert!(moment.abs() < 2e-2, "{moment:e}");
        }
        println!("EI {a} to {b}: {errors:?}");
        assert!(errors[2] < 2e-6 && (errors[2] < 1e-8 || errors[1] / errors[2] > 12.0), "{errors:?}");
    }
}

#[test]
fn a_rod_that_tapers_stretches_as_the_integral_of_its_strain() {
    let (length, force, [a, b]): (f64, f64, [f64; 2]) = (3.0, 40.0, [1e4, 2e3]);
    let exact = force * length * f64::ln(b / a) / (b - a);
    let tension = |s: f64| {
        format!(
            "[[records]]\ntype = \"along\"\nof = \"beam\"\nwhat = \"tension\"\nat = {s}\nname = \"t{s}\"\n"
        )
    };
    let errors = [12, 24].map(|n| {
        let made_of = format!(
            "elements = {n}\nsections = [{{ section = {{ mass = 1, ea = {a}, ei = 1 }}, end_section = {{ mass = 1, ea = {b}, ei = 1 \
             }} }}]"
        );
        let h = run(&beam(length, &made_of, &(pull([force, 0.0, 0.0]) + &tension(0.4) + &tension(2.9))));
        assert!((last(&h, "t0.4") / force - 1.0).abs() < 1e-8 && (last(&h, "t2.9") / force - 1.0).abs() < 1e-8);
        ((last(&h, "beam.end.x") - length) / exact - 1.0).abs()
    });
    println!("stretch {errors:?}");
    assert!(errors[1] < 2e-6 && errors[0] / errors[1] > 12.0, "{errors:?}");
}

#[test]
fn a_rope_that_stiffens_hangs_as_the_integral_of_its_strain() {
    // T = A (exp(k ε) - 1), so ε = ln(1 + T/A)/k
    let (stiff, k, length, mass, load) = (2000.0, 20.0, 50.0, 4.0, 1500.0);
    let weight = mass * 9.81;
    let force = table("strain", "force", 401, 0.12, |e| stiff * ((k * e).exp() - 1.0));
    let made_of = format!("elements = 25\nsection = {{ mass = {mass}, axial_force = {force} }}");
    let text = beam(length, &made_of, &pull([0.0, 0.0, -load]))
        .replace(&format!("[{length}, 0, 0]]"), &format!("[0, 0, {}]]", -length))
        .replace("type = \"clamp\"", "type = \"spherical\"");
    let h = run(&format!("{text}\n[[forces]]\ntype = \"gravity\"\n"));
    // ∫ ln(1 + (P + w s)/A)/k ds, with u = A + P + w s: [u ln(u/A) - u]/(k w)
    let part = |u: f64| u * (u / stiff).ln() - u;
    let exact = (part(stiff + load + weight * length) - part(stiff + load)) / (k * weight);
    let stretched = -last(&h, "beam.end.z") - length;
    println!("stretch {stretched} of {exact}: {:.1e}", stretched / exact - 1.0);
    assert!((stretched / exact - 1.0).abs() < 1e-5);
    assert!((last(&h, "root.magnitude") / (load + weight * length) - 1.0).abs() < 1e-8);
}

#[test]
fn a_pipe_that_slips_bends_into_the_circle_of_its_moment() {
    // M = M₀ tanh(κ/κ₀); beyond a quarter of a circle a couple that is fixed in space turns the beam out of its plane
    let (most, by, length) = (80.0, 0.4, 3.0);
    let moment = table("curvature", "moment", 301, 1.5, |kappa| most * (kappa / by).tanh());
    for couple in [20.0, 60.0] {
        let made_of = format!("elements = 24\nsection = {{ mass = 1, ea = 1e6, bending_moment = {moment} }}");
        let rest = format!(
            "statics = {{ steps = 8 }}\n[[forces]]\ntype = \"point_moment\"\nmarker = \"beam.end\"\nmoment = [0, {couple}, 0]\ntime = {{ ramp = {{ from = 0, to = 1, t0 = 0, t1 = 1 }} }}\n\
             [[records]]\ntype = \"along\"\nof = \"beam\"\nwhat = \"moment\"\nat = \"40 %\"\nname = \"m\"\n"
        );
        // the options of statics stand above all sections
        let (head, tail) = rest.split_once('\n').expect("two lines");
        let h = run(&format!("{head}\n{}", beam(length, &made_of, tail)));
        let kappa = by * f64::atanh(couple / most);
        let (x, z) = ((kappa * length).sin() / kappa, (1.0 - (kappa * length).cos()) / kappa);
        let off = (last(&h, "beam.end.x") - x).hypot(last(&h, "beam.end.z").abs() - z);
        println!(
            "couple {couple}: κ {kappa:.4}, tip off by {off:.1e}, moment {:.1e}",
            last(&h, "m") / couple - 1.0
        );
        assert!(off < 1e-4 * length && (last(&h, "m") / couple - 1.0).abs() < 1e-3);
    }
}

#[test]
fn a_rope_that_only_pulls_does_not_push() {
    let text = |only: bool| {
        format!(
            r#"
        run = {{ duration = 0.01, output = 0.001 }}
        gravity = [0, 0, 0]
        [[elements]]
        type = "cable"
        name = "rope"
        points = [[0, 0, 0], [1, 0, 0]]
        length = 1.05
        elements = 4
        section = {{ mass = 0.2, ea = 1e4, tension_only = {only} }}
        [[constraints]]
        type = "spherical"
        name = "a"
        marker = "rope.start"
        [[constraints]]
        type = "spherical"
        name = "b"
        marker = "rope.end"
        [[records]]
        type = "along"
        of = "rope"
        what = "tension"
        at = "50 %"
        name = "pull"
        [[records]]
        type = "position"
        of = "rope@25%"
        name = "p"
        "#
        )
    };
    let (slack, stiff) = (run(&text(true)), run(&text(false)));
    assert_eq!(last(&slack, "pull"), 0.0);
    assert!((last(&slack, "p.x") - 0.25).abs() < 1e-12);
    assert!((last(&stiff, "pull") + 1e4 * (1.0 - 1.0 / 1.05)).abs() < 1e-6);
}

/// A short line of sections with all that there is, bent and stretched.
fn lively(rest: &str) -> String {
    let mut text = String::from(
        r#"
        run = { duration = 0.4, output = 0.01 }
        solver = { stepping = { controlled = { tolerance = 1e-7 } }, scheme = "radau-iia-5" }
        [[elements]]
        type = "cable"
        name = "line"
        curve = [[0, 0, 0], [0.5, 0.1, 0.2], [1, 0, 0.1]]
        sections = [
            { to = 0.3, section = { mass = 0.3, ea = 4e3, ei = 0.3 }, end_section = { mass = 0.2, ea = 2e3, ei = 0.1 }, elements = 2 },
            { to = 0.6, section = { mass = 0.2, axial_force = { strain = [-0.5, 0, 0.01, 0.4], force = [-500, 0, 30, 900] }, bending_moment = { curvature = [0, 0.5, 1.5, 4], moment = [0, 0.1, 0.15, 0.2] } }, elements = 2 },
            { section = { mass = 0.2, ea = 1e3, ei = 0.05, tension_only = true }, elements = 2 },
        ]
        [[constraints]]
        type = "spherical"
        name = "pin"
        marker = "line.start"
        [[forces]]
        type = "gravity"
        "#,
    );
    let _ = write!(text, "{rest}");
    text
}

#[test]
fn tangents_and_forces_are_derivatives_of_the_energy() {
    let model = scene(&lively("")).build().expect("model");
    let (nodes, mut state) = (model.nodes().to_vec(), model.state());
    // moved somewhere by no more than strains of some percent
    let mut seed = 7u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    state.q.iter_mut().for_each(|q| *q += 0.02 * random());
    state.v.iter_mut().for_each(|v| *v = random());
    let at = At { relaxed: None, ..state.at() };
    let elastic: Vec<_> = model.terms().iter().filter(|t| t.label().starts_with("elasticity")).collect();
    assert!(!elastic.is_empty(), "{:?}", model.terms().iter().map(|t| t.label()).collect::<Vec<_>>());
    for term in elastic {
        for width in [Width::One, Width::Four] {
            let worst = check_tangent(term.as_ref(), &nodes, &at, width);
            println!("{}: tangent {worst:.1e}", term.label());
            assert!(worst < 1e-6, "{}: {worst:e}", term.label());
        }
        let (force, _) =
            ropewalk_core::testing::dense(term.as_ref(), &nodes, &at, Default::default(), Width::One);
        let slope: Vec<f64> = (0..state.q.len())
            .map(|j| {
                difference(|h| {
                    let mut q = state.q.clone();
                    q[j] += h;
                    let e = term.energy(&At { q: &q, ..at });
                    vec![e.potential]
                })[0]
            })
            .collect();
        let size = force.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        let worst = force.iter().zip(&slope).map(|(f, s)| (f - s).abs() / size).fold(0.0, f64::max);
        println!("{}: force {worst:.1e}", term.label());
        assert!(worst < 1e-7, "{}: {worst:e}", term.label());
    }
    let mut spliced = 0;
    for constraint in model.constraints().iter().filter(|c| c.name().contains("splice")) {
        let worst = check_constraint(constraint.as_ref(), &nodes, &at);
        println!("{}: {worst:.1e}", constraint.name());
        assert!(worst < 1e-6);
        spliced += 1;
    }
    assert_eq!(spliced, 2);
}

#[test]
fn a_line_of_tables_keeps_its_energy() {
    let scene = scene(&lively(""));
    let mut s = Simulation::new(scene.build().expect("model"), &scene.solver, 0.4).expect("start");
    s.advance(0.4, f64::INFINITY, &mut ()).expect("run");
    let missed = s.audit.imbalance() / s.audit.scale;
    println!("energy {missed:.1e} of {:.3} J", s.audit.scale);
    assert!(missed.abs() < 1e-5, "{missed:e}");
}
