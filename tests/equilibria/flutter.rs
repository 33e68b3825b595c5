//! Loads without a potential: what they make flutter, and what diverges under them.

use crate::paths::{COLUMN, run, set, tip};
use ropewalk_core::statics::CriticalKind;

#[test]
fn becks_column_flutters_and_does_not_diverge() {
    let load = "[[forces]]\ntype = \"point_force\"\nmarker = \"column.end\"\nfollower = \"$load\"\n\
                time = { table = { t = [0, 1], value = [0, 1] } }\n";
    for (p, flutters) in [(10.0, false), (19.9, false), (20.2, true)] {
        let h = run(&format!("{COLUMN}{load}"), &set(&[("load", -p)])).unwrap_or_else(|e| panic!("{e}"));
        println!("{p}: {:?} {:?}", h.warnings, h.critical);
        assert_eq!(h.warnings.iter().any(|w| w.contains("flutter")), flutters, "{p}: {:?}", h.warnings);
        let [x, y, z] = tip(&h, "column");
        assert!(x.hypot(y) < 1e-6 && (z - 1.0).abs() < 1e-4, "{p}: {x} {y} {z}");
        assert!(h.critical.is_empty() || flutters, "{p}: {:?}", h.critical);
    }
}

/// A rod between guides that hold its ends straight, in tension, whose torque grows: it diverges in two directions at once, which
/// rounding makes pairs of complex eigenvalues of. With `x = e^{ikz}` in the plane across, `EI x'''' - i M x''' - T x'' = 0` has
/// solutions that are clamped at both ends at M = 9.718 N m.
#[test]
fn torque_makes_a_rod_diverge_and_not_flutter() {
    for steps in [13, 20, 21] {
        let text = format!(
            r#"
            gravity = [0, 0, 0]
            run = {{ analysis = "statics", duration = 1 }}
            statics = {{ steps = {steps} }}
            [[elements]]
            type = "cable"
            name = "c"
            points = [[0, 0, 0], [1, 0, 0]]
            elements = 24
            section = {{ mass = 1, ea = 1e6, ei = 1, gj = 0.8 }}
            [[constraints]]
            type = "clamp"
            name = "s"
            marker = "c.start"
            [[constraints]]
            type = "point_on_line"
            name = "g"
            marker = "c.end"
            axis = [1, 0, 0]
            [[constraints]]
            type = "direction"
            name = "d"
            marker = "c.end"
            twist = false
            [[forces]]
            type = "point_force"
            marker = "c.end"
            force = [5, 0, 0]
            [[forces]]
            type = "point_moment"
            marker = "c.end"
            torque = 10.5
            time = {{ table = {{ t = [0, 1], value = [0, 1] }} }}
            "#
        );
        // behind it the rod jumps into a loop
        let e = run(&text, &[]).err().expect("no equilibrium nearby").to_string();
        let said = "behind a bifurcation at load factor ";
        let at = e.split(said).nth(1).unwrap_or_else(|| panic!("{e}"));
        let factor: f64 = at.split(',').next().unwrap_or_default().parse().unwrap_or_else(|_| panic!("{e}"));
        assert!((10.5 * factor - guided(5.0)).abs() < 2e-3 * 9.7, "{steps} steps: {factor}, {}", guided(5.0));
    }
}

/// The torque at which a rod of `EI = 1`, `L = 1` in tension `T` diverges between guides: `x = e^{iaz} (A cos bz + B sin bz) + C + D z`
/// with `a = M/2`, `b² = a² - T` has none but the trivial solution until then.
fn guided(tension: f64) -> f64 {
    type C = [f64; 2];
    let mul = |x: C, y: C| [x[0] * y[0] - x[1] * y[1], x[0] * y[1] + x[1] * y[0]];
    let determinant = |torque: f64| {
        let a = 0.5 * torque;
        let b = (a * a - tension).sqrt();
        // what e^{ikz} - 1 - ikz and ik (e^{ikz} - 1) are at the other end, for both k
        let [one, two] = [a + b, a - b].map(|k: f64| {
            let e = [k.cos() - 1.0, k.sin()];
            ([e[0], e[1] - k], mul([0.0, k], e))
        });
        let (p, q) = (mul(one.0, two.1), mul(two.0, one.1));
        // its phase is that of e^{ia}
        let phase = [a.cos(), -a.sin()];
        let all = mul([p[0] - q[0], p[1] - q[1]], phase);
        if all[0].abs() > all[1].abs() { all[0] } else { all[1] }
    };
    let (mut low, step) = (2.0 * tension.sqrt() + 0.5, 0.05);
    while determinant(low) * determinant(low + step) > 0.0 {
        low += step;
    }
    let mut high = low + step;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if determinant(low) * determinant(middle) > 0.0 { low = middle } else { high = middle }
    }
    low
}

/// A pipe between clamps that water runs through ever faster buckles once, at u = 2π, and stays on the path that branches off.
#[test]
fn a_pipe_with_faster_and_faster_flow_buckles_once() {
    let text = r#"
        gravity = [0, 0, 0]
        run = { analysis = "statics", duration = 1 }
        statics = { steps = 20 }
        [[elements]]
        type = "cable"
        name = "c"
        points = [[0, 0, 0], [1, 0, 0]]
        elements = 8
        section = { mass = 0.5, ea = 1e5, ei = 1 }
        [[constraints]]
        type = "clamp"
        name = "s"
        marker = "c.start"
        [[constraints]]
        type = "clamp"
        name = "e"
        marker = "c.end"
        [[forces]]
        type = "internal_flow"
        cable = "c"
        density = 1000
        bore = 0.025231325220201602
        speed = 9.899494936611665
        time = { table = { t = [0, 1], value = [0, 1] } }
        [[records]]
        type = "position"
        of = "c@50%"
    "#;
    let h = run(text, &[]).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(h.critical.len(), 1, "{:?}", h.critical);
    let u = 7.0 * h.critical[0].load_factor;
    assert!((u / std::f64::consts::TAU - 1.0).abs() < 2e-3, "{u}");
    let [y, z] = ["c@50%.y", "c@50%.z"].map(|name| h.last(name).expect("recorded"));
    assert!(y.hypot(z) > 5e-3, "{y} {z}");
    // which way it bends nothing tells
    assert!(h.warnings.iter().all(|w| w.contains("turns about the axis (1, 0, 0)")), "{:?}", h.warnings);
}

/// Two rods in a row under a follower load, held upright by springs of 1 N m (Ziegler): the pair that flutters becomes two motions that go
/// one way at a higher load. Nothing branches off there, and what is told doesn't hang on the steps.
#[test]
fn flutter_is_told_whatever_comes_after_it() {
    let told = [1, 5, 13].map(|steps| {
        let rod = |name: &str, z: f64| {
            format!(
                r#"
                [[elements]]
                type = "rigid_body"
                name = "{name}"
                position = [0, 0, {z}]
                mass = 1
                inertia = [0.0833333333333333, 0.0833333333333333, 1e-3]
                points = {{ low = [0, 0, -0.5], top = [0, 0, 0.5] }}
                "#
            )
        };
        let joint = |name: &str, marker: &str, to: &str| {
            format!(
                r#"
                [[constraints]]
                type = "revolute"
                name = "{name}"
                marker = "{marker}"
                {to}
                axis = [0, 1, 0]
                [[forces]]
                type = "rotational_spring"
                name = "{name}s"
                marker = "{marker}"
                {to}
                axis = [0, 1, 0]
                stiffness = 1
                "#
            )
        };
        let text = format!(
            r#"
            gravity = [0, 0, 0]
            run = {{ analysis = "statics", duration = 8 }}
            statics = {{ steps = {steps} }}
            {}
            {}
            {}
            {}
            [[forces]]
            type = "point_force"
            marker = "b.top"
            local = true
            force = [0, 0, -1]
            time = {{ table = {{ t = [0, 100], value = [0, 100] }} }}
            "#,
            rod("a", 0.5),
            rod("b", 1.5),
            joint("foot", "a.low", ""),
            joint("knee", "b.low", "to = \"a.top\"")
        );
        let h = run(&text, &[]).unwrap_or_else(|e| panic!("{steps} steps: {e}"));
        let kinds: Vec<CriticalKind> = h.critical.iter().map(|c| c.kind).collect();
        assert_eq!(kinds, [CriticalKind::Flutter], "{steps} steps: {:?}", h.critical);
        assert!(h.warnings.iter().any(|w| w.contains("not stable")), "{steps} steps: {:?}", h.warnings);
        h.critical[0].load_factor
    });
    // of uniform rods: M = [[4/3, 1/2], [1/2, 1/3]], K = [[2 - P, P - 1], [-1, 1]]; the square of the trace of M⁻¹K is four times
    // its determinant
    let meets = |p: f64| {
        let det = 4.0 / 9.0 - 0.25;
        let trace = ((2.0 - p) / 3.0 + 0.5 + 4.0 / 3.0 - (p - 1.0) / 2.0) / det;
        trace * trace - 4.0 / det
    };
    let (mut low, mut high) = (0.0, 3.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if meets(middle) > 0.0 { low = middle } else { high = middle }
    }
    assert!(told.iter().all(|p| (p - low).abs() < 1e-4 * low), "{told:?} {low}");
}
