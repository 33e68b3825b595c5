//! Strings and beams that run along themselves between two eyelets, against the lowest eigenvalues of their own matrices,
//! found by inverse iteration in complex arithmetic.

use super::winch::steadily;
use crate::common::{data, number};
use faer::Mat;
use faer::c64;
use faer::prelude::Solve;
use ropewalk_constraints::{SphericalSpec, WinchSpec};
use ropewalk_core::{System, Weights};
use ropewalk_elements::{CableSpec, Section};
use ropewalk_scene::Scene;

struct Line {
    m: f64,
    tension: f64,
    length: f64,
    ei: f64,
    v: f64,
    elements: usize,
}

/// Mass, gyroscopic and stiffness matrix of the transverse motion.
fn matrices(line: &Line) -> [Mat<f64>; 3] {
    let n = line.elements;
    let ea = 1e6 * line.tension;
    let stretch = 1.0 + line.tension / ea;
    let mut scene = Scene::new();
    scene
        .element(
            CableSpec::straight(
                "rope",
                [0.0; 3],
                [line.length, 0.0, 0.0],
                n,
                Section::new(line.m * stretch, ea, line.ei / stretch),
            )
            .unstretched(line.length / stretch),
        )
        .constraint(SphericalSpec::new("a", "rope.start", [0.0; 3]))
        .constraint(SphericalSpec::new("b", "rope.end", [line.length, 0.0, 0.0]))
        .constraint(WinchSpec::motion("in", "rope.start", "in"))
        .constraint(WinchSpec::motion("out", "rope.end", "out"))
        .motion(steadily("in", -line.v / stretch))
        .motion(steadily("out", line.v / stretch));
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut state = model.state();
    // fixed in space while the material runs through
    let boundaries = 6 * (n + 1);
    state.v.fill(0.0);
    (state.v[boundaries], state.v[boundaries + 1]) = (line.v / stretch, line.v / stretch);
    // unknowns: y and y' of every node, without y at both ends
    let dofs: Vec<usize> =
        (0..=n).flat_map(|k| [6 * k + 1, 6 * k + 4]).filter(|&d| d != 1 && d != 6 * n + 1).collect();
    let lambda = vec![0.0; model.multipliers()];
    [(0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)].map(|(q, v, a)| {
        let mut system = System::default();
        model.assemble(&state.at(), &lambda, Some(Weights { q, v, a }), &mut system);
        let structure = model.structure();
        let mut all = Mat::<f64>::zeros(structure.n, structure.n);
        for (row, columns, at) in structure.rows() {
            for (k, value) in system.values[at].iter().enumerate() {
                all[(row, columns.get(k))] = *value;
            }
        }
        let p = &structure.position;
        Mat::from_fn(dofs.len(), dofs.len(), |i, j| all[(p[dofs[i]], p[dofs[j]])])
    })
}

/// The eigenvalue next to a guess, and its vector: `(λ² M + λ C + K) x = 0` as `A z = λ B z` with `z = (x, λ x)`.
fn mode(line: &Line, guess: f64) -> (c64, Vec<c64>) {
    let [m, c, k] = matrices(line);
    let n = m.nrows();
    let mut shift = c64::new(0.0, guess * (1.0 + 1e-3));
    let (mut x, mut y) = (vec![c64::new(1.0, 0.3); n], vec![c64::new(0.2, 1.0); n]);
    for round in 0..12 {
        let s = shift;
        let p = Mat::from_fn(n, n, |i, j| {
            s * s * c64::new(m[(i, j)], 0.0) + s * c64::new(c[(i, j)], 0.0) + c64::new(k[(i, j)], 0.0)
        });
        let lu = p.full_piv_lu();
        // (A - s B) z' = B z for companion form: y' = s x' + x, P x' = -(M (y + s x) + C x)
        let rhs = Mat::from_fn(n, 1, |i, _| {
            let mut sum = c64::new(0.0, 0.0);
            for j in 0..n {
                sum = sum - c64::new(m[(i, j)], 0.0) * (y[j] + s * x[j]) - c64::new(c[(i, j)], 0.0) * x[j];
            }
            sum
        });
        let solved = lu.solve(&rhs);
        let new_x: Vec<c64> = (0..n).map(|i| solved[(i, 0)]).collect();
        let new_y: Vec<c64> = (0..n).map(|i| s * new_x[i] + x[i]).collect();
        let biggest = (0..n).max_by(|&a, &b| new_x[a].norm().total_cmp(&new_x[b].norm())).unwrap_or_default();
        // 1/(λ - s) is how much the vector grew
        let gain = new_x[biggest] / x[biggest];
        let eigenvalue = s + c64::new(1.0, 0.0) / gain;
        let size = new_x[biggest];
        x = new_x.iter().map(|z| *z / size).collect();
        y = new_y.iter().map(|z| *z / size).collect();
        if round > 3 {
            shift = eigenvalue;
        }
        if (eigenvalue - s).norm() < 1e-11 * guess && round > 5 {
            return (eigenvalue, x);
        }
    }
    (shift, x)
}

#[test]
fn strings_that_run_along_themselves_have_the_right_modes() {
    let data = data("flow/moving_string.json");
    for row in data["f1"].as_array().expect("rows") {
        let [m, tension, length, v] = ["m", "T", "L", "V"].map(|k| number(&row[k]));
        let omega: Vec<f64> = serde_json::from_value(row["omega"].clone()).expect("frequencies");
        let mut errors = Vec::new();
        for elements in [8, 16] {
            let line = Line { m, tension, length, ei: 0.0, v, elements };
            let (lambda, x) = mode(&line, omega[0]);
            let frequency = (lambda.im / omega[0] - 1.0).abs();
            assert!((lambda.re / omega[0]).abs() < 1e-9, "V = {v}: {lambda}");
            // material runs towards the start, so the phase falls along the string: the frequencies can't tell
            let kappa = number(&row["kappa1"]);
            let mut shape = 0.0_f64;
            let at = |k: usize| {
                let s = k as f64 / elements as f64;
                let angle = -kappa * s * length;
                faer::c64::new(angle.cos(), angle.sin()) * (std::f64::consts::PI * s).sin()
            };
            // unknowns: y' of the first node, then y and y' of each
            let value = |k: usize| x[2 * k - 1];
            let middle = value(elements / 2) / at(elements / 2);
            for k in 1..elements {
                shape = shape.max((value(k) / middle - at(k)).norm());
            }
            errors.push((frequency, shape));
        }
        eprintln!("V = {v}: {errors:?}");
        let order = (errors[0].0 / errors[1].0).log2();
        assert!(errors[1].0 < 1.2e-5 && order > 3.0, "V = {v}: {errors:?}, order {order}");
        assert!(errors[1].1 < 1e-3, "V = {v}: {errors:?}");
    }
}
