//! Equilibria that come back: what is carried round a closed way ends as it began, however often.

use super::{last, run};
use ropewalk::History;
use std::f64::consts::TAU;

/// By how much records differ between two load factors, at most.
#[track_caller]
fn change(h: &History, names: &[&str], [a, b]: [f64; 2]) -> f64 {
    let row = |x: f64| h.times().iter().position(|t| (t - x).abs() < 1e-9).unwrap_or_else(|| panic!("{x}"));
    let off = |name: &&str| {
        let x = h.column(name).unwrap_or_else(|| panic!("{name}"));
        (x[row(a)] - x[row(b)]).abs()
    };
    names.iter().map(off).fold(0.0, |most, off| if off <= most { most } else { off })
}

const TIP: [&str; 6] =
    ["rod.end.x", "rod.end.y", "rod.end.z", "rod.end.phi2", "energy.potential", "rod.end.angle"];

#[test]
fn a_force_that_goes_round_thrice_leaves_a_free_tip_as_it_was() {
    let h = run(include_str!("tip.toml"), &[]);
    for loops in [1.0, 2.0, 3.0] {
        let off = change(&h, &TIP, [0.0, loops]);
        assert!(off < 1e-9, "{loops}: {off}");
    }
    assert!(change(&h, &TIP, [0.0, 0.5]) > 0.5, "in between it is elsewhere");
}

/// Reference directors gather the solid angle of each loop: if they weren't laid anew, the twist would jump by 2π in the
/// seventh.
#[test]
fn a_rod_that_whirls_twelve_times_forgets_it() {
    let h = run(include_str!("whirl.toml"), &[]);
    let seen = ["rod@50%.x", "rod@50%.y", "rod@50%.z", "energy.potential", "rod.start.torque"];
    for loops in 2..=13 {
        let off = change(&h, &seen, [1.0, f64::from(loops)]);
        assert!(off < 1e-9, "{loops}: {off}");
    }
    // what the reference tells of its own whirl
    assert!((last(&h, "energy.potential") / 14.208 - 1.0).abs() < 1e-4);
}

/// A rod whose end is carried by a body that turns to the edge of a cone of 0.6 rad, goes round it, and moves on a circle
/// meanwhile.
fn carried(ei: &str) -> History {
    let (mut t, mut yaw, mut pitch) = (Vec::new(), Vec::new(), Vec::new());
    let (mut x, mut y, mut z) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..=50 {
        let out = (0.1 * f64::from(k)).min(1.0);
        let (sin, cos) = (TAU * f64::from((k - 10).max(0)) / 40.0).sin_cos();
        t.push(if k < 10 { 0.1 * f64::from(k) } else { 1.0 + f64::from(k - 10) / 40.0 });
        yaw.push(0.6 * out * cos);
        pitch.push(0.6 * out * sin);
        x.push(-0.03 * out);
        y.push(0.15 * out * cos);
        z.push(0.15 * out * sin);
    }
    let moving = format!(
        "[[motions]]\ntype = \"table\"\nname = \"yaw\"\nt = {t:?}\nangle = {yaw:?}\n\
         [[motions]]\ntype = \"table\"\nname = \"pitch\"\nt = {t:?}\nangle = {pitch:?}\n\
         [[motions]]\ntype = \"table\"\nname = \"round\"\nt = {t:?}\nx = {x:?}\ny = {y:?}\nz = {z:?}\n"
    );
    let scene = include_str!("carried.toml").replace("ei = [1, 1.7]", &format!("ei = {ei}"));
    run(&(scene + &moving), &[])
}

#[test]
fn an_end_that_is_carried_round_a_cone_finds_the_rod_as_it_was() {
    let seen = ["rod@50%.x", "rod@50%.y", "rod@50%.z", "rod.end.torque", "grip.mx", "grip.my", "grip.mz"];
    let h = carried("[1, 1.7]");
    let off = change(&h, &seen, [1.0, 2.0]);
    assert!(off < 1e-9, "{off}");
    assert!(change(&h, &seen, [1.0, 1.5]) > 0.1);
}

/// Of a rod that bends alike to all sides the moment along its end is the twisting moment, that of each of its elements.
#[test]
fn the_moment_that_holds_an_end_is_the_torque_along_the_tangent() {
    let h = carried("1");
    for row in 0..h.times().len() {
        let of = |name: &str| h.column(name).unwrap_or_else(|| panic!("{name}"))[row];
        // Bryant angles 1-2-3: the third axis is the tangent
        let [one, two] = ["rod.end.phi1", "rod.end.phi2"].map(of);
        let t = [two.sin(), -one.sin() * two.cos(), one.cos() * two.cos()];
        let held: f64 = ["grip.mx", "grip.my", "grip.mz"].map(of).iter().zip(t).map(|(m, t)| m * t).sum();
        for own in [of("rod.end.torque"), of("rod@30%.torque")] {
            assert!((held - own).abs() < 1e-10, "{held} {own}");
        }
    }
}
