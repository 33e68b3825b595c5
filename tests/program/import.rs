//! Decks of MoorDyn as scenes.

use crate::program::run;
use std::fs;
use tempfile::TempDir;

/// A folder of its own with files in it.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (file, text) in files {
        fs::write(folder.path().join(file), text).unwrap();
    }
    folder
}

/// The moorings of the OC3-Hywind spar: Jonkman, NREL/TP-500-47535 (2010), table 5-1.
const SPAR: &str = "\
----------- deck of a test -----------
Moorings of a spar
--------- LINE TYPES ---------
TypeName  Diam   Mass/m   EA         BA/-zeta  EI  Cd   Ca   CdAx  CaAx
(name)    (m)    (kg/m)   (N)        (N-s/-)   (-) (-)  (-)  (-)   (-)
main      0.09   77.7066  384.243E6  -0.8      0   1.6  1.0  0.1   0.0
--------- POINTS ---------
ID  Type    X        Y        Z       Mass  Volume  CdA  Ca
(#) (-)     (m)      (m)      (m)     (kg)  (m^3)   (m^2) (-)
1   Fixed   853.87   0        -320.0  0     0       0    0
2   Fixed   -426.94  739.47   -320.0  0     0       0    0     # an anchor
4   Vessel  5.2      0.0      -70.0   0     0       0    0
5   Vessel  -2.6     4.5      -70.0   0     0       0    0
--------- LINES ---------
ID  LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name)   (#)     (#)     (m)      (-)     (-)
1   main     1       4       902.2    20      -
2   main     2       5       902.2    40      p
--------- OPTIONS ---------
0.002   dtM       time step
3.0e6   kBot      bottom stiffness
3.0e5   cBot      bottom damping
1025.0  WtrDnsty  water density
320     WtrDpth   water depth
--------- OUTPUTS ---------
FairTen1 AnchTen1 Point4pz
END
--------- need this line ---------
";

/// Tension at the upper end of an elastic line that partly lies on a level bed, by its closed form.
fn catenary(span: f64, height: f64, length: f64, weight: f64, ea: f64) -> f64 {
    let miss = |h: f64, v: f64| {
        let along = length - v / weight + h / weight * (v / h).asinh() + h * length / ea;
        let up = h / weight * ((1.0 + (v / h).powi(2)).sqrt() - 1.0) + v * v / (2.0 * ea * weight);
        [along - span, up - height]
    };
    let (mut h, mut v) = (weight * length, 0.9 * weight * length);
    for _ in 0..100 {
        let [a, b] = miss(h, v);
        let (dh, dv) = (1e-6 * h, 1e-6 * v);
        let ([ah, bh], [av, bv]) = (miss(h + dh, v), miss(h, v + dv));
        let [[aa, ab], [ba, bb]] = [[(ah - a) / dh, (av - a) / dv], [(bh - b) / dh, (bv - b) / dv]];
        let det = aa * bb - ab * ba;
        let step = [(bb * a - ab * b) / det, (aa * b - ba * a) / det];
        (h, v) = ((h - step[0]).max(0.2 * h), (v - step[1]).clamp(0.2 * v, weight * length));
    }
    h.hypot(v)
}

#[test]
fn the_moorings_of_a_spar_have_the_tension_of_their_catenary() {
    let here = folder(&[("spar.txt", SPAR)]);
    let made = run(here.path(), &["import", "spar.txt", "--out", "spar.toml"]);
    assert!(made.stdout.contains("spar.toml: 2 line(s)"), "{}{}", made.stdout, made.stderr);
    assert!(!made.stderr.contains("END"), "{}", made.stderr);
    let text = fs::read_to_string(here.path().join("spar.toml")).unwrap();
    // damping by the length of segments: two sections of one type
    assert!(text.contains("name = \"main\"") && text.contains("name = \"main-2\""), "{text}");
    fs::write(here.path().join("spar.toml"), text.replace("60 s", "1 s")).unwrap();
    let out = run(here.path(), &["run", "spar.toml", "--no-report", "--no-plots"]).stdout;
    let weight = 9.80665 * (77.7066 - 1025.0 * std::f64::consts::PI / 4.0 * 0.09f64.powi(2));
    let wanted = catenary(853.87 - 5.2, 250.0, 902.2, weight, 384.243e6);
    for name in ["FairTen1", "FairTen2"] {
        let line = out.lines().find(|l| l.contains(name)).unwrap_or_else(|| panic!("{out}"));
        let found: f64 = line.split_whitespace().rev().nth(1).unwrap().parse().unwrap();
        assert!((found / wanted - 1.0).abs() < 1e-3, "{name}: {found} for {wanted}");
    }
    // 911 kN in the literature
    assert!((wanted / 911e3 - 1.0).abs() < 1e-3, "{wanted}");
}

#[test]
fn current_waves_floats_and_bodies_are_taken_over() {
    let deck = SPAR
        .replace("4   Vessel  5.2      0.0      -70.0   0 ", "4   Free    5.2      0.0      -70.0   2e4 ")
        .replace("5   Vessel  -2.6     4.5", "5   Body1   0.0      0.5")
        .replace(
            "--------- POINTS",
            "--------- BODIES ---------\nID At X Y Z r p y Mass CG I Volume CdA Ca\n(#)\n\
             1 Free -2.6 4 -70 0 0 0 1e5 -1 1e6|1e6|2e5 120 0 0\n--------- POINTS",
        )
        .replace("320     WtrDpth", "1 Currents\n7 WaveKin\n320 WtrDpth");
    let here = folder(&[
        ("deck.txt", deck.as_str()),
        ("current_profile.txt", "currents\n\nz ux uy uz\n-320 0 0 0\n0 1.5 0.5 0\n"),
        // |A| sin(ωt + π/2) is a crest at t = 0
        ("wave_frequencies.txt", "0.0 0.0 0.0\n0.4 0.0 5.0\n"),
    ]);
    let told = run(here.path(), &["import", "deck.txt"]);
    assert_eq!(told.code, Some(0), "{}", told.stderr);
    let text = told.stdout;
    for part in [
        "{ z = 0.0, velocity = [1.5, 0.5, 0.0] }",
        "{ amplitude = 5.0, period = 15.707963267948966, phase = 0.0 }",
        "points = { point5 = [0.0, 0.5, -70.0] }",
        "inertia = [1000000.0, 1000000.0, 200000.0]",
        "centre = [0.0, 0.0, -1.0]",
        "mass = 20000.0",
        "to = \"body1.point5\"",
        "of = \"line1.end\"",
    ] {
        assert!(text.contains(part), "{part} isn't in\n{text}");
    }
}

#[test]
fn what_has_no_counterpart_is_refused_where_it_stands() {
    let refused = |from: &str, to: &str, what: &str| {
        assert!(SPAR.contains(from), "{from}");
        let here = folder(&[("deck.txt", &SPAR.replacen(from, to, 1))]);
        let told = run(here.path(), &["import", "deck.txt"]);
        assert_eq!((told.code, told.stdout.as_str()), (Some(2), ""));
        assert!(told.stderr.contains(what), "{what} isn't in\n{}", told.stderr);
    };
    refused("384.243E6", "1e8|2e8|0.4", "deck.txt:6:27");
    refused("384.243E6", "much", "a stiffness EA that isn't one number");
    refused(
        "-0.8      0   1.6",
        "-0.8      0   x",
        "`x` is no number: the drag coefficient Cd is expected here",
    );
    refused("1   Fixed", "1   Turbine1", "a point of type `Turbine1` isn't taken over");
    refused("1   main     1 ", "1   main     R1A ", "there is no point `R1A`");
    refused("1   main     1 ", "1   chain    1 ", "there is no line type `chain`");
    refused("AttachA AttachB UnstrLen", "UnstrLen NumSegs NodeA", "MoorDyn's version 1");
    refused("kBot", "kBed", "the option `kBed` has no counterpart");
    refused("320     WtrDpth", "4 WaveKin\n320 WtrDpth", "waves of this kind");
    refused("320     WtrDpth", "3 WaveKin\n320 WtrDpth", "wave_elevation.txt`, which the deck needs");
    refused("902.2    20 ", "902.2    2.5", "the number of segments must be whole, not 2.5");
    refused("1       4       902.2", "1       1       902.2", "both ends of this line are at point `1`");
    refused("2   main     2 ", "1   main     2 ", "another line of the deck has the number 1 too");
    refused("320     WtrDpth", "1 Currents\n320 WtrDpth", "current_profile.txt`, which the deck needs");
    refused("902.2    20      -", "", "this row ends before its unstretched length");
    for units in [
        "(name)    (m)    (kg/m)   (N)        (N-s/-)   (-) (-)  (-)  (-)   (-)\n",
        "(#) (name)   (#)     (#)     (m)      (-)     (-)\n",
    ] {
        refused(units, "", "this row would be skipped as heads");
    }
    refused("--------- OPTIONS", "--- RODS ---\nID\n(#)\n1 can\n--- OPTIONS", "there is no rod type `can`");
    refused("--------- LINES", "--------- ROPES", "no section of a MoorDyn deck has this name");
    let here = folder(&[("deck.txt", "nothing\n")]);
    let told = run(here.path(), &["import", "deck.txt"]);
    assert!(told.stderr.contains("has no lines: it isn't a MoorDyn deck"), "{}", told.stderr);
}

#[test]
fn waves_of_all_kinds_that_are_sums_are_taken_over() {
    let deck = |kind: &str| SPAR.replacen("320     WtrDpth", &format!("{kind} WaveKin\n320 WtrDpth"), 1);
    let import = |kind: &str, file: &str, text: &str| {
        let here = folder(&[("deck.txt", &deck(kind)), (file, text)]);
        let told = run(here.path(), &["import", "deck.txt", "--out", "scene.toml"]);
        let scene = fs::read_to_string(here.path().join("scene.toml")).unwrap_or_default();
        (told, scene)
    };
    let even = "0.0 0 0\n0.5 1.5 0.0 0.25\n1.0 0.0 2.0\n";
    let period = 2.0 * std::f64::consts::TAU;
    // kind 2: A cos(ωt - kx + arg A), kind 7: A sin(…)
    let (told, scene) = import("2", "wave_frequencies.txt", even);
    assert_eq!(told.code, Some(0), "{}", told.stderr);
    assert!(
        scene.contains(&format!("{{ amplitude = 1.5, period = {period:?}, phase = 0.0, direction = 0.25 }}")),
        "{scene}"
    );
    assert!(scene.contains("phase = -1.5707963267948966 }"), "{scene}");
    let (_, scene) = import("7", "wave_frequencies.txt", even);
    assert!(scene.contains("phase = 1.5707963267948966, direction = 0.25 }"), "{scene}");
    let (told, _) = import("2", "wave_frequencies.txt", &even.replace("1.0 0.0", "1.3 0.0"));
    assert!(told.code == Some(2) && told.stderr.contains("at equal intervals"), "{}", told.stderr);
    // kind 3: a record, which the scene reads
    let record: String = (0..400)
        .map(|k| format!("{} {}\n", 0.25 * f64::from(k), (0.25 * f64::from(k) * 0.628).sin()))
        .collect();
    let (told, scene) = import("3", "wave_elevation.txt", &record);
    assert_eq!(told.code, Some(0), "{}", told.stderr);
    assert!(scene.contains("measured = { file = "), "{scene}");
}

#[test]
fn what_drifts_starts_where_the_deck_puts_it_and_bodies_without_mass_are_held() {
    let rod = HANGING.replace("1 rope 1 R1A 450 45 -\n2 rope 2 R1B 450 45 -\n", "3 rope 1 2 1000 10 -\n");
    assert!(HANGING.len() > rod.len());
    let here = folder(&[("rod.txt", &rod)]);
    let told = run(here.path(), &["import", "rod.txt"]);
    assert!(told.stdout.contains("from_equilibrium = false"), "{}{}", told.stdout, told.stderr);
    let body = "--- BODIES ---\nID\n(#)\n1 Coupled 0 0 -70 0 0 0 0 0 0 0 0 0\n--- POINTS";
    let here = folder(&[("deck.txt", &SPAR.replacen("--------- POINTS", body, 1))]);
    let told = run(here.path(), &["import", "deck.txt", "--out", "scene.toml"]);
    assert_eq!(told.code, Some(0), "{}", told.stderr);
    let ran = run(here.path(), &["check", "scene.toml"]);
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    let here =
        folder(&[("deck.txt", &SPAR.replacen("--------- POINTS", &body.replace("Coupled", "Free"), 1))]);
    run(here.path(), &["import", "deck.txt"]).refused(&["a free body without mass"]);
}

const HANGING: &str = "\
--- MoorDyn Input File ---
A rod that hangs from two ropes
--- LINE TYPES ---
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
rope 0.09 77.7066 384.243E6 -0.3 0 1.6 1.0 0.1 0.2
--- ROD TYPES ---
TypeName Diam Mass/m Cd Ca CdEnd CaEnd
(name) (m) (kg/m) (-) (-) (-) (-)
rod 0.25 77.7066 1.6 1.0 1.6 1.0
--- RODS ---
ID RodType Attachment Xa Ya Za Xb Yb Zb NumSegs RodOutputs
(#) (name) (#/key) (m) (m) (m) (m) (m) (m) (-) (-)
1 rod Free -10 0 -75 10 0 -75 1 -
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m3) (m^2) (-)
1 Fixed -450 0 0 0 0 0 0
2 Fixed 450 0 0 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name) (#) (#) (m) (-) (-)
1 rope 1 R1A 450 45 -
2 rope 2 R1B 450 45 -
--- OPTIONS ---
150 WtrDpth depth
--- need this line ---
";

/// Two catenaries carry half of the rod's weight in water each, and it hangs level.
#[test]
fn a_rod_hangs_from_the_lines_of_its_deck() {
    let here = folder(&[("rod.txt", HANGING)]);
    let made = run(here.path(), &["import", "rod.txt", "--out", "rod.toml"]);
    assert!(made.stderr.contains("CaEnd"), "{}", made.stderr);
    let text = fs::read_to_string(here.path().join("rod.toml")).unwrap();
    for part in [
        "name = \"rod1\"",
        "to = \"rod1.b\"",
        "ca_axial = 0.2",
        "hull = { from = [0, 0, 0], to = [20.0, 0.0, 0.0], diameter = 0.25 }",
    ] {
        assert!(text.contains(part), "{part} isn't in\n{text}");
    }
    let more = "\n[[records]]\ntype = \"position\"\nof = \"rod1.a\"\n\n[[records]]\ntype = \"position\"\nof = \"rod1.b\"\n";
    fs::write(here.path().join("rod.toml"), text.replace("60 s", "1 s") + more).unwrap();
    let told = run(here.path(), &["run", "rod.toml", "--out", "rod", "--no-report", "--no-plots"]);
    assert_eq!(told.code, Some(0), "{}", told.stderr);
    let table = fs::read_to_string(here.path().join("rod/history.csv")).unwrap();
    let [names, .., values] = &table.lines().collect::<Vec<_>>()[..] else { panic!("{table}") };
    let last = |name: &str| -> f64 {
        let k = names
            .split(',')
            .position(|n| n.starts_with(name))
            .unwrap_or_else(|| panic!("no {name}: {names}"));
        values.split(',').nth(k).unwrap().parse().unwrap()
    };
    let (a, b) = (last("rod1.a.z"), last("rod1.b.z"));
    assert!((a - b).abs() < 1e-3, "{a} {b}");
    // at the rod, each line carries half of it upwards: T_A² = T_rod² by heights, T = H + w z of the elastic catenary
    let water = |mass: f64, d: f64| 9.80665 * (mass - 1025.0 * std::f64::consts::PI / 4.0 * d * d);
    let half = 10.0 * water(77.7066, 0.25);
    let weight = water(77.7066, 0.09);
    let (foot, top) = (last("FairTen1"), last("AnchTen1"));
    let level = (foot * foot - half * half).sqrt();
    let wanted = level.hypot(half + 450.0 * weight);
    assert!((top / wanted - 1.0).abs() < 2e-3, "{top} {wanted}");
}

#[test]
fn rods_that_have_no_counterpart_are_refused() {
    for (from, to, what) in [
        ("1 rod Free", "1 rod Body1", "a rod of type `Body1` isn't taken over"),
        ("1 rod Free", "1 pole Free", "there is no rod type `pole`"),
        ("10 0 -75 1 -", "-10 0 -75 1 -", "a rod without length"),
        ("2 R1B", "2 R2B", "there is no point `R2B`"),
    ] {
        assert!(HANGING.contains(from), "{from}");
        let here = folder(&[("deck.txt", &HANGING.replacen(from, to, 1))]);
        let told = run(here.path(), &["import", "deck.txt"]);
        assert_eq!((told.code, told.stdout.as_str()), (Some(2), ""));
        assert!(told.stderr.contains(what), "{what} isn't in\n{}", told.stderr);
    }
}

/// A deck that is made of a scene of a deck says the same: number by number from there on, and in tension.
#[test]
fn scenes_go_back_into_decks() {
    let joined = SPAR
        .replace("4   Vessel  5.2      0.0      -70.0   0 ", "4   Free    5.2      0.0      -70.0   2e4 ")
        .replace("2   main     2       5  ", "2   main     2       4  ");
    for deck in [SPAR, &joined] {
        let here = folder(&[("first.txt", deck)]);
        let there = |name: &str| here.path().join(name);
        let done = |args: &[&str]| {
            let told = run(here.path(), args);
            assert_eq!(told.code, Some(0), "{args:?}: {}", told.stderr);
            told.stdout
        };
        done(&["import", "first.txt", "--out", "first.toml"]);
        done(&["export", "first.toml", "--out", "second.txt"]);
        done(&["import", "second.txt", "--out", "second.toml"]);
        done(&["export", "second.toml", "--out", "third.txt"]);
        let [second, third] =
            ["second.txt", "third.txt"].map(|name| fs::read_to_string(there(name)).unwrap());
        assert!(second.split_whitespace().count() > 80, "{second}");
        assert_eq!(second.split_whitespace().count(), third.split_whitespace().count(), "{second}{third}");
        for (a, b) in second.split_whitespace().zip(third.split_whitespace()) {
            match (a.parse::<f64>(), b.parse::<f64>()) {
                (Ok(x), Ok(y)) => assert!((x - y).abs() <= 1e-12 * x.abs(), "{a} {b}"),
                _ => assert_eq!(a, b, "{second}{third}"),
            }
        }
        if deck == SPAR {
            let tension = |name: &str| {
                let text = fs::read_to_string(there(name)).unwrap().replace("60 s", "1 s");
                fs::write(there(name), text).unwrap();
                let out = done(&["run", name, "--no-report", "--no-plots"]);
                let line = out.lines().find(|l| l.contains("FairTen1")).unwrap_or_else(|| panic!("{out}"));
                line.split_whitespace().rev().nth(1).unwrap().parse::<f64>().unwrap()
            };
            let (a, b) = (tension("first.toml"), tension("second.toml"));
            assert!((a / b - 1.0).abs() < 1e-5, "{a} {b}");
        }
    }
}

#[test]
fn what_a_deck_has_no_place_for_is_refused_by_name() {
    let here = folder(&[("spar.txt", SPAR)]);
    run(here.path(), &["import", "spar.txt", "--out", "spar.toml"]);
    let text = fs::read_to_string(here.path().join("spar.toml")).unwrap();
    for (more, what) in [
        (
            "[[elements]]\ntype = \"rigid_body\"\nname = \"b\"\nposition = [0, 0, 0]\nmass = 1\ninertia = [1, 1, 1]\n",
            "`rigid_body`",
        ),
        ("[[forces]]\ntype = \"vortex_shedding\"\n", "`vortex_shedding`"),
        (
            "[[constraints]]\ntype = \"distance\"\nname = \"foot\"\nmarker = \"line1.end\"\nto = \"line2.end\"\n",
            "the constraint `foot` of type `distance`",
        ),
    ] {
        fs::write(here.path().join("more.toml"), format!("{text}\n{more}")).unwrap();
        let told = run(here.path(), &["export", "more.toml"]);
        assert_eq!((told.code, told.stdout.as_str()), (Some(2), ""), "{}", told.stderr);
        assert!(
            told.stderr.contains(what) && told.stderr.contains("no counterpart"),
            "{what}: {}",
            told.stderr
        );
    }
    let wet = text.replace("level = 0", "level = 0\ncurrent = [1, 0, 0]");
    fs::write(here.path().join("wet.toml"), wet).unwrap();
    let told = run(here.path(), &["export", "wet.toml"]);
    assert!(told.stderr.contains("a current or waves"), "{}", told.stderr);
}
