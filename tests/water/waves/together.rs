//! What laws of the water do together is what each does by itself.

use ropewalk_core::testing::dense;
use ropewalk_core::{At, Weights, Width};
use ropewalk_scene::{Format, SceneFile};

/// A cable that lies across the surface and one that is all below, in a scene with this water and these laws.
fn scene(water: &str, added_mass: &str) -> String {
    let cable = |name: &str, z: [f64; 2]| {
        format!(
            r#"
            [[elements]]
            type = "cable"
            name = "{name}"
            points = [[0, 0, {}], [9, 4, {}]]
            elements = 11
            section = {{ mass = 20, ea = 1e6, ei = 1e3, diameter = 0.3, displaced = 0.05 }}
            "#,
            z[0], z[1]
        )
    };
    format!(
        r#"
        [water]
        level = 0.3
        {water}
        {}
        {}
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "buoyancy"
        [[forces]]
        type = "drag"
        [[forces]]
        type = "added_mass"
        {added_mass}
        "#,
        cable("across", [-4.0, 4.0]),
        cable("below", [-9.0, -6.0])
    )
}

#[test]
fn laws_together_do_what_each_does() {
    let waves = "current = [0.4, -0.2, 0]\n[air]\n[water.waves]\njonswap = { hs = 2, tp = 6 }\ndepth = 40";
    for (water, added_mass) in
        [("", ""), ("", "theory = \"morison\""), (waves, "ca_axial = 0.2"), (waves, "theory = \"morison\"")]
    {
        let file = SceneFile::parse(&scene(water, added_mass), "scene", Format::Toml, &[]).expect("scene");
        let model = file.build().unwrap_or_else(|e| panic!("{e}"));
        let state = model.state();
        let some = |n: usize, size: f64| -> Vec<f64> {
            (0..n).map(|k| size * (1.7 * k as f64 + 0.3 * (k * k) as f64).sin()).collect()
        };
        let (v, a) = (some(state.v.len(), 0.8), some(state.v.len(), 0.5));
        let at = At { t: 17.3, q: &state.q, v: &v, a: &a, internal: &[], relaxed: None };
        let weights = Weights { q: 1.0, v: 0.7, a: 0.3 };
        let mut seen = 0;
        for term in model.terms() {
            let effects = term.effects();
            if effects.len() < 2 {
                continue;
            }
            seen += 1;
            for width in [Width::One, Width::best()] {
                let of = |term: &dyn ropewalk_core::Term| dense(term, model.nodes(), &at, weights, width);
                let (residual, tangent) = of(term.as_ref());
                let (mut sum, mut sums) = (vec![0.0; residual.len()], vec![0.0; residual.len().pow(2)]);
                for effect in &effects {
                    let (residual, tangent) = of(effect.as_ref());
                    sum.iter_mut().zip(residual).for_each(|(s, r)| *s += r);
                    sums.iter_mut().zip(tangent.concat()).for_each(|(s, r)| *s += r);
                }
                let apart = |a: &[f64], b: &[f64]| {
                    let size = b.iter().fold(0.0_f64, |m, b| b.abs().max(m));
                    assert!(size > 1.0 && a.iter().all(|a| a.is_finite()));
                    a.iter().zip(b).fold(0.0_f64, |m, (a, b)| (a - b).abs().max(m)) / size
                };
                let off = [apart(&residual, &sum), apart(&tangent.concat(), &sums)];
                assert!(off.iter().all(|off| *off < 1e-12), "{}: {off:?}", term.label());
            }
        }
        assert!(seen >= 2, "{seen}");
    }
}
