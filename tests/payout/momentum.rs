//! Momentum of all that moves when a tackle hoists, against the impulse of all that acts on it from outside: the force and the
//! moment with which a tower is held that carries drum, sheaves and the dead end, weight, and what the drum takes in.

use crate::hoist::Hoist;
use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};
use ropewalk_core::V3;
use ropewalk_core::rotation::cross;

const FALLS: usize = 4;
const WHEELS: usize = FALLS / 2;
const G: f64 = 9.81;
/// Of the rope by unstretched length [kg/m], and of the sheaves [m].
const MASS: f64 = 1.5;
const RADIUS: f64 = 0.25;
const HEAD: f64 = 12.0;

/// The tackle on a tower that is held at its foot, with what is looked at.
fn text(hoist: &Hoist<'_>) -> String {
    let side = 0.5 * 0.06 * (WHEELS as f64 - 1.0);
    let tower = format!(
        r#"
        [[elements]]
        type = "rigid_body"
        name = "tower"
        position = [0, 0, 0]
        mass = 1000
        inertia = [100, 100, 100]
        points = {{ head = [0, 0, {HEAD}], drum = [-6, {}, 2], dead_end = [-0.25, {side}, {HEAD}] }}
        [[constraints]]
        type = "weld"
        name = "foot"
        marker = "tower"
        [[elements]]"#,
        -side
    );
    let dead_end = "[[constraints]]\n        type = \"spherical\"\n        name = \"dead_end\"\n        marker = \"hoist.end\"\n";
    let centres: Vec<String> =
        (1..=WHEELS).map(|k| format!("w{k} = [0, {}, 0]", 0.06 * (k as f64 - 1.0) - side)).collect();
    let mut text = hoist.text();
    for (from, to) in [
        (dead_end, ""),
        ("[[elements]]", &tower),
        (&format!("{{ end = [-0.25, {side}, {HEAD}] }}"), "{ end = \"tower.dead_end\" }"),
        (&format!("marker = [0, 0, {HEAD}]"), "marker = \"tower.head\""),
        (&format!("marker = [-6, {}, 2]", -side), "marker = \"tower.drum\""),
        ("centre = [0, 0, -0.6]", &format!("centre = [0, 0, -0.6]\npoints = {{ {} }}", centres.join(", "))),
    ] {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let mut record = |kind: &str, of: &str| {
        text += &format!("[[records]]\ntype = \"{kind}\"\nof = \"{of}\"\n");
    };
    record("reaction", "foot");
    record("position", "hoist.start");
    for k in 1..=WHEELS {
        record("position", &format!("block.w{k}"));
        record("sheave", &format!("blocks.{k}"));
        if k > 1 {
            record("sheave", &format!("head.{k}"));
        }
    }
    for k in 1..=2 * WHEELS {
        record("position", &format!("hoist.{k}.end"));
        record("position", &format!("hoist.{}.start", k + 1));
    }
    text + "[[records]]\ntype = \"momentum\"\n"
}

fn run(text: &str) -> History {
    let file = SceneFile::parse(text, "tackle", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    simulate(&file.into_scene()).unwrap_or_else(|e| panic!("{e}"))
}

fn column<'a>(history: &'a History, name: &str) -> &'a [f64] {
    history.column(name).unwrap_or_else(|| panic!("no {name}"))
}

/// Three columns with this beginning.
fn three<'a>(history: &'a History, of: &str) -> impl Fn(usize) -> V3<f64> + use<'a> {
    let columns = ["x", "y", "z"].map(|x| column(history, &format!("{of}{x}")));
    move |i| columns.map(|x| x[i])
}

fn place<'a>(history: &'a History, of: &str) -> impl Fn(usize) -> V3<f64> + use<'a> {
    three(history, &format!("{of}."))
}

/// How far what lies on the sheaves is from their centres along x, by its mass [kg m]: the record of the momentum takes it to be
/// there as far as motions across the wheels go, which is where the centre of mass comes from.
fn aside(history: &History) -> Vec<f64> {
    let mut sum = vec![0.0; history.times().len()];
    for k in 1..=2 * WHEELS {
        let (head, number) = (k % 2 == 1, k.div_ceil(2));
        let wheel = if head { format!("head.{number}") } else { format!("blocks.{number}") };
        let centre = (!head).then(|| place(history, &format!("block.w{number}")));
        let from = place(history, &format!("hoist.{k}.end"));
        let to = place(history, &format!("hoist.{}.start", k + 1));
        let [wrap, length] = ["wrap", "length"].map(|what| column(history, &format!("{wheel}.{what}")));
        for (i, sum) in sum.iter_mut().enumerate() {
            let height = centre.as_ref().map_or(HEAD, |centre| centre(i)[2]);
            // the mean of cos along the arc, by the sines at its ends
            let sines = (from(i)[2] - to(i)[2]) / RADIUS;
            debug_assert!((from(i)[2] - height).abs() < 1.01 * RADIUS);
            *sum += MASS * length[i] * RADIUS * sines / wrap[i];
        }
    }
    sum
}

/// How far linear and angular momentum about the origin get from the impulses, and how large they become.
fn audit(history: &History) -> [[V3<f64>; 2]; 2] {
    let t = history.times();
    let [force, moment, linear, angular] =
        ["foot.f", "foot.m", "momentum.p", "momentum.l"].map(|of| three(history, of));
    let (centre, leaves) = (place(history, "momentum"), place(history, "hoist.start"));
    let (payout, spin, aside) =
        (column(history, "drum.payout"), column(history, "drum.spin"), aside(history));
    // what hangs on the tower at rest, by geometry: 1000 kg and 2000 kg, spans and what lies on sheaves
    let distance = |a: V3<f64>, b: V3<f64>| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
    let mut rope = 0.0;
    let last = [-RADIUS, 0.03, HEAD];
    for k in 1..=2 * WHEELS + 1 {
        let from = if k == 1 { leaves(0) } else { place(history, &format!("hoist.{k}.start"))(0) };
        let to = if k > 2 * WHEELS { last } else { place(history, &format!("hoist.{k}.end"))(0) };
        rope += distance(from, to) / (1.0 + 5000.0 / 15e6);
    }
    for k in 1..=WHEELS {
        rope +=
            ["head", "blocks"].map(|w| column(history, &format!("{w}.{k}.length"))[0]).iter().sum::<f64>();
    }
    let first = 3000.0 + MASS * rope;
    assert!((force(0)[2] / (first * G) - 1.0).abs() < 1e-5, "{} N for {} N", force(0)[2], first * G);
    let first = force(0)[2] / G;
    let rates = |i: usize| -> [V3<f64>; 2] {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(t.len() - 1));
        let rate = (payout[after] - payout[before]) / (t[after] - t[before]);
        let d: V3<f64> = std::array::from_fn(|k| leaves(i)[k] - [-6.0, -0.03, 2.0][k]);
        let carried = cross(&[0.0, spin[i], 0.0], &d).map(|v| MASS * rate * v);
        let mass = first + MASS * (payout[i] - payout[0]);
        let weight = [0.0, 0.0, -mass * G];
        let (heavy, taken) = (cross(&centre(i), &weight), cross(&leaves(i), &carried));
        let (f, m) = (force(i), moment(i));
        let off = [0.0, aside[i] * G, 0.0];
        [
            std::array::from_fn(|k| f[k] + weight[k] + carried[k]),
            std::array::from_fn(|k| m[k] + heavy[k] + taken[k] + off[k]),
        ]
    };
    let (mut impulse, mut worst, mut most) = ([[0.0; 3]; 2], [[0.0_f64; 3]; 2], [[0.0_f64; 3]; 2]);
    let (mut a, start) = (rates(0), [linear(0), angular(0)]);
    for i in (2..t.len()).step_by(2) {
        let [b, c, h] = [rates(i - 1), rates(i), [[t[i] - t[i - 2]; 3]; 2]];
        let now = [linear(i), angular(i)];
        for (what, k) in (0..6).map(|n| (n / 3, n % 3)) {
            impulse[what][k] += h[what][k] / 6.0 * (a[what][k] + 4.0 * b[what][k] + c[what][k]);
            let change = now[what][k] - start[what][k];
            assert!(change.is_finite() && impulse[what][k].is_finite());
            worst[what][k] = worst[what][k].max((change - impulse[what][k]).abs());
            most[what][k] = most[what][k].max(change.abs());
        }
        a = c;
    }
    [worst, most]
}

fn largest(x: &V3<f64>) -> f64 {
    x.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

#[test]
fn impulses_on_a_tackle_are_the_change_of_its_momentum() {
    let hoist =
        Hoist { falls: FALLS, wheel: "efficiency = 0.98", duration: 2.0, output: 0.001, ..Hoist::default() };
    let text = text(&hoist);
    // settings by default, and what is left is that of the steps
    for (more, bound) in
        [("", 2e-3), ("solver = { stepping = { controlled = { tolerance = 1e-6 } } }\n", 1e-4)]
    {
        let [worst, most] = audit(&run(&format!("{more}{text}")));
        println!("{more}: {worst:?} of {most:?}");
        assert!(most[0][2] > 590.0 && most[1][1] > 140.0, "{most:?}");
        let p = largest(&most[0]);
        assert!(largest(&worst[0]) <= bound * p, "{worst:?} of {most:?}");
        // about the origin, from which the sheaves are this far
        assert!(largest(&worst[1]) <= bound * p * HEAD, "{worst:?} of {most:?}");
    }
}

/// Up and down by 5.7 m of rope, sixty times.
#[test]
#[ignore = "an hour of hoisting takes minutes"]
fn an_hour_of_hoisting_keeps_its_momentum() {
    let hoist = Hoist {
        falls: FALLS,
        wheel: "efficiency = 0.98",
        duration: 3600.0,
        output: 0.02,
        ..Hoist::default()
    };
    let text = super::falls::up_and_down(&text(&hoist));
    let history = run(&text);
    let [worst, most] = audit(&history);
    println!("{worst:?} of {most:?}");
    assert!(largest(&most[0]) > 200.0, "{most:?}");
    // the weight alone gives it this much
    let impulse = 3070.0 * G * 3600.0;
    assert!(largest(&worst[0]) <= 1e-6 * impulse && largest(&worst[1]) <= 1e-6 * impulse * HEAD, "{worst:?}");
}
