//! Lines of several sections that a winch pays out and reels in.

use crate::statics::cases;
use crate::{last, number, run, scene};
use ropewalk_core::statics::{Statics, StaticsOptions};
use ropewalk_core::{Model, Quantity, State};
use serde_json::Value;

/// A line of a case in which this much of the section at each of these ends (0 and 1) isn't out yet, and winches that pay it out.
fn fed(case: &Value, ends: &[usize], d: f64, per_section: usize) -> String {
    let own = case["sections"].as_array().expect("sections");
    let (mut s, mut sections) = (0.0, String::new());
    for (k, section) in own.iter().enumerate() {
        let [length, weight, ea] = [0, 1, 2].map(|i| number(&section[i]));
        let feeds = ends.iter().any(|&end| k == if end == 0 { 0 } else { own.len() - 1 });
        s += if feeds { length - d } else { length };
        let mass = weight / 9.81;
        sections += &format!(
            "{{ to = {s}, section = {{ mass = {mass:e}, ea = {ea:e}, diameter = 0.1, displaced = {:e} }}, elements = {per_section} }},",
            1e-4 * mass
        );
    }
    // laid as it will hang, stretched, or straight
    let curve: Vec<[f64; 3]> = case["rows"]
        .as_array()
        .expect("rows")
        .iter()
        .map(|row| [number(&row[1]), 0.0, number(&row[2])])
        .collect();
    let lay = if curve.len() > 2 { "curve" } else { "points" };
    let winch = |end: &usize| {
        let at = ["start", "end"][*end];
        format!(
            r#"
        [[constraints]]
        type = "winch"
        name = "winch at the {at}"
        marker = "line.{at}"
        speed = 1
        payout = {d}
        ramp = 1e-3
        "#
        )
    };
    let winches: String = ends.iter().map(winch).collect();
    format!(
        r#"
        run = {{ duration = 1000 }}
        [[elements]]
        type = "cable"
        name = "line"
        {lay} = {curve:?}
        sections = [{sections}]
        [[constraints]]
        type = "spherical"
        name = "anchor"
        marker = "line.start"
        [[constraints]]
        type = "spherical"
        name = "fairlead"
        marker = "line.end"
        {winches}
        [[forces]]
        type = "gravity"
        "#
    )
}

/// The line at rest once all of it is out.
fn paid_out(case: &Value, ends: &[usize], d: f64, per_section: usize) -> (Model, State) {
    let model = scene(&fed(case, ends, d, per_section)).build().unwrap_or_else(|e| panic!("{e}"));
    let mut state = model.state();
    for &end in ends {
        let boundary = model.part("line").and_then(|line| line.boundary(end)).expect("a boundary");
        state.q[boundary.q] += boundary.sign * d;
    }
    state.t = 500.0;
    let mut statics = Statics::new(&model, &StaticsOptions::default()).expect("statics");
    statics.find(&mut state, true).unwrap_or_else(|e| panic!("{e}"));
    drop(statics);
    (model, state)
}

/// What has been paid out hangs as if it had been laid so: the section at the winch has become longer, the others haven't.
#[test]
fn a_line_that_is_paid_out_hangs_as_the_closed_form() {
    for case in cases() {
        if case["loads"].as_array().is_some_and(|all| all.iter().any(|x| number(x) != 0.0)) {
            continue;
        }
        let length: f64 = case["sections"].as_array().expect("sections").iter().map(|s| number(&s[0])).sum();
        let [t0, t1] = ["T0", "T1"].map(|name| number(&case[name]));
        for ends in [&[0][..], &[1], &[0, 1]] {
            for (n, limit) in [(20, 1e-5), (60, 1e-7)] {
                let d = 0.05 * length;
                let (model, state) = paid_out(&case, ends, d, n);
                let (part, at) = (model.part("line").expect("line"), state.at());
                let pull = [(0.0, t0), (part.length_now(&at), t1)]
                    .map(|(s, t)| part.observe(Quantity::Tension, s, &at).expect("a tension") / t - 1.0);
                let short = part.length_now(&at) / length - 1.0;
                assert!(short.abs() < 1e-12, "{short}");
                let mut shape = 0.0_f64;
                for row in case["rows"].as_array().expect("rows") {
                    let [s, x, z] = [0, 1, 2].map(|i| number(&row[i]));
                    let (r, _) = part.point(s, &at).expect("a place on it");
                    let off = (r[0] - x).hypot(r[2] - z) / length;
                    shape = if off <= shape { shape } else { off };
                }
                println!(
                    "{} {ends:?} n {n}: shape {shape:.1e}, pull {:.1e} {:.1e}",
                    case["name"], pull[0], pull[1]
                );
                assert!(shape < limit && pull.iter().all(|p| p.abs() < limit), "{} {ends:?}", case["name"]);
            }
        }
    }
}

/// Nodes of lines laid straight are far from their places: no winch, mesh or length leads the search into what is folded.
#[test]
fn a_line_that_is_laid_straight_and_fed_hangs_as_the_closed_form() {
    let mut looked = 0;
    for case in cases() {
        if case["loads"].as_array().is_some_and(|all| all.iter().any(|x| number(x) != 0.0)) {
            continue;
        }
        let length: f64 = case["sections"].as_array().expect("sections").iter().map(|s| number(&s[0])).sum();
        let rows = case["rows"].as_array().expect("rows");
        let straight = serde_json::json!([rows[0], rows[rows.len() - 1]]);
        let mut laid = case.clone();
        laid["rows"] = straight;
        for ends in [&[0][..], &[1], &[0, 1]] {
            for (n, limit) in [(5, 2e-4), (10, 2e-5), (20, 1e-6), (40, 5e-8), (60, 1e-8)] {
                for part in [0.01, 0.025, 0.05, 0.07, 0.1] {
                    let (model, state) = paid_out(&laid, ends, part * length, n);
                    let (line, at) = (model.part("line").expect("line"), state.at());
                    for row in rows {
                        let [s, x, z] = [0, 1, 2].map(|i| number(&row[i]));
                        let (r, _) = line.point(s, &at).expect("a place on it");
                        let off = (r[0] - x).hypot(r[2] - z) / length;
                        assert!(off <= limit, "{} {ends:?}, {n}, {part}: {off:e} at {s} m", case["name"]);
                    }
                    looked += 1;
                }
            }
        }
    }
    assert!(looked >= 150, "{looked}");
}

/// Wire above, chain below, that hang from a winch: as much is paid out as is reeled in again, with all that the balance of energy
/// knows; at rest they hang by their weights, each with its own stretch.
fn hanging(speed: f64, payout: f64, h: f64, more: &str) -> String {
    format!(
        r#"
        run = {{ duration = 8, output = 0.1, from_equilibrium = true }}
        solver = {{ scheme = "radau-iia-5", stepping = {{ fixed = {{ h = {h} }} }} }}
        [[elements]]
        type = "cable"
        name = "line"
        points = [[0, 0, 0], [0, 0, -5]]
        sections = [
          {{ to = 3, section = {{ mass = 0.5, ea = 2e4, ei = 1, axial_retardation_time = 0.02 }}, elements = 4 }},
          {{ to = 5, section = {{ mass = 4, ea = 1e5, axial_retardation_time = 0.02 }}, elements = 3 }},
        ]
        [[constraints]]
        type = "spherical"
        name = "fairlead"
        marker = "line.start"
        [[constraints]]
        type = "winch"
        name = "winch"
        marker = "line.start"
        speed = {speed}
        payout = {payout}
        ramp = 1
        {more}
        [[forces]]
        type = "gravity"
        [[records]]
        type = "reaction"
        of = "fairlead"
        [[records]]
        type = "position"
        of = "line.end"
        [[records]]
        type = "along"
        of = "line"
        what = "tension"
        at = "start"
        [[records]]
        type = "length"
        of = "line"
        [[records]]
        type = "energy"
        "#
    )
}

#[test]
fn wire_and_chain_that_hang_from_a_winch_have_their_own_weight_and_stretch() {
    let g = 9.81;
    for (speed, payout) in [(0.5, 1.5), (-0.5, -1.5)] {
        let h = run(&hanging(speed, payout, 0.02, ""));
        let (wire, chain) = (3.0 + payout, 2.0);
        let [light, heavy] = [0.5 * g, 4.0 * g];
        let top = light * wire + heavy * chain;
        let stretch =
            (heavy * chain * wire + 0.5 * light * wire * wire) / 2e4 + 0.5 * heavy * chain * chain / 1e5;
        let off =
            [last(&h, "fairlead.magnitude") / top - 1.0, last(&h, "line.end.z") + wire + chain + stretch];
        println!("{payout}: {off:?}");
        assert!(off.iter().all(|x| x.abs() < 1e-7), "{payout}: {off:?}");
        // power is taken at the steps, by the trapezoidal rule
        let finer = run(&hanging(speed, payout, 0.005, ""));
        let lost = [&h, &finer].map(|h| h.summary().energy.imbalance.abs());
        println!("{lost:?} J, {:?}", finer.summary().energy);
        assert!(lost[1] < 1e-4 && lost[0] / lost[1] > 12.0, "{lost:?}");
    }
}

/// Length of the line at the end of a run [m], what holds both its ends [N], and how far its balance of energy is off [J].
fn at_the_end(h: &ropewalk::History) -> [f64; 4] {
    let energy = h.summary().energy;
    [last(h, "line.length"), last(h, "left.magnitude"), last(h, "right.magnitude"), energy.imbalance.abs()]
}

/// Elements are born and swallowed in the sections at both ends, and the line goes where it goes when these grow and shrink as a whole.
#[test]
fn elements_of_sections_are_born_and_swallowed() {
    let go = |element: &str, [start, end]: [f64; 2], h: f64| {
        let text = between(start, end, h).replace("ramp = 1\n", &format!("ramp = 1\n{element}\n")).replace(
            "records = [",
            "records = [{ type = \"reaction\", of = \"left\" }, { type = \"reaction\", of = \"right\" }, ",
        );
        run(&text)
    };
    for ways in [[-1.5, 2.0], [2.5, 2.5], [2.0, -1.8]] {
        let whole = at_the_end(&go("", ways, 0.01));
        let born = at_the_end(&go("element_length = 0.6\nfade = 0.4", ways, 0.01));
        let finer = at_the_end(&go("element_length = 0.6\nfade = 0.4", ways, 0.005));
        println!("{ways:?}: {whole:?} {born:?} {finer:?}");
        assert!((whole[0] - born[0]).abs() <= 1e-8 * whole[0], "{ways:?}");
        for i in 1..3 {
            assert!((whole[i] - born[i]).abs() <= 1e-2 * whole[i], "{ways:?}: {whole:?} {born:?}");
        }
        assert!(born[3] <= 2e-2 && finer[3] <= 2e-2, "{ways:?}: {born:?} {finer:?}");
    }
}

/// Chain is never taken for the wire that a winch reels in: a line of both that is paid out with new elements has its tension.
#[test]
fn wire_that_is_born_above_chain_has_its_own_weight() {
    let g = 9.81;
    for (speed, payout) in [(0.5, 1.5), (-0.5, -1.5)] {
        let h = run(&hanging(speed, payout, 0.02, "element_length = 0.5\nfade = 0.3"));
        let (wire, chain) = (3.0 + payout, 2.0);
        let top = 0.5 * g * wire + 4.0 * g * chain;
        let stretch = (4.0 * g * chain * wire + 0.25 * g * wire * wire) / 2e4 + 2.0 * g * chain * chain / 1e5;
        let off =
            [last(&h, "fairlead.magnitude") / top - 1.0, last(&h, "line.end.z") + wire + chain + stretch];
        println!("{payout}: {off:?} {} changes", h.summary().status);
        assert!(off.iter().all(|x| x.abs() < 1e-6), "{payout}: {off:?}");
    }
}

#[test]
fn what_a_line_of_sections_can_not_feed_is_said() {
    let says = |text: &str, message: &str| {
        let file = ropewalk_scene::SceneFile::parse(text, "scene", ropewalk_scene::Format::Toml, &[]);
        let error = match file {
            Ok(file) => file.into_scene().build().map(drop).expect_err("refused").to_string(),
            Err(e) => e.to_string(),
        };
        assert!(error.contains(message), "{error}");
    };
    says(&hanging(0.5, 1.0, 0.1, "element_length = 1.5"), "take elements of less than half of that");
    says(&hanging(-0.5, -1.0, 0.1, "shortest = 1.5"), "2 m lie behind the section");
}

/// Chain between two wires from two winches: one reels in while the other pays out.
fn between(start: f64, end: f64, h: f64) -> String {
    let winch = |at: &str, payout: f64| {
        format!(
            "[[constraints]]\ntype = \"winch\"\nname = \"{at} winch\"\nmarker = \"line.{at}\"\nspeed = {}\npayout = {payout}\nramp = 1\n",
            0.5 * payout.signum()
        )
    };
    let winches = winch("start", start) + &winch("end", end);
    format!(
        r#"
        run = {{ duration = 8, output = 0.1, from_equilibrium = true }}
        solver = {{ scheme = "radau-iia-5", stepping = {{ fixed = {{ h = {h} }} }} }}
        forces = [{{ type = "gravity" }}]
        records = [{{ type = "length", of = "line" }}, {{ type = "energy" }}]
        [[elements]]
        type = "cable"
        name = "line"
        points = [[0, 0, 0], [3, 0, -4], [6, 0, 0]]
        radius = 0.1
        sections = [
          {{ to = 3.5, section = {{ mass = 0.5, ea = 2e4, ei = 1, axial_retardation_time = 0.02 }}, elements = 4 }},
          {{ to = 6.5, section = {{ mass = 4, ea = 1e5, axial_retardation_time = 0.02 }}, elements = 4 }},
          {{ section = {{ mass = 0.5, ea = 2e4, ei = 1, axial_retardation_time = 0.02 }}, elements = 4 }},
        ]
        [[constraints]]
        type = "spherical"
        name = "left"
        marker = "line.start"
        [[constraints]]
        type = "spherical"
        name = "right"
        marker = "line.end"
        {winches}
        "#
    )
}

#[test]
fn two_winches_feed_the_sections_at_both_ends() {
    let runs = [0.02, 0.005].map(|h| run(&between(-1.5, 2.0, h)));
    let short =
        runs.each_ref().map(|h| last(h, "line.length") - (h.column("line.length").expect("length")[0] + 0.5));
    let lost = runs.each_ref().map(|h| h.summary().energy.imbalance.abs());
    println!("{short:?} m, {lost:?} J, {:?}", runs[1].summary().energy);
    assert!(short.iter().all(|x| x.abs() < 1e-9), "{short:?}");
    assert!(lost[1] < 1e-4 && lost[0] / lost[1] > 12.0, "{lost:?}");
}

/// What one winch pays out is none of the section at the other, which ends the run while that much of it is left.
#[test]
fn a_section_is_reeled_in_to_its_shortest_whatever_the_other_end_does() {
    for (end, least) in [(3.0, 0.05), (-0.5, 0.05)] {
        let h = run(&between(-3.4, end, 0.02));
        let summary = h.summary();
        let fed = last(&h, "line.length") - h.column("line.length").expect("length")[0];
        println!("{end}: {fed} {} {:?}", summary.status, summary.message);
        let own = fed - end + 3.5;
        assert!((own / 3.5 - least).abs() < 1e-3, "{end}: {own} m are left");
    }
}
