//! Whatever is wrong with a scene or a command: one message that says where and what to do, exit code 2, and nothing
//! else.

use crate::program::{Said, run};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// A scene with nearly every field that takes a number.
const FULL: &str = include_str!("../data/full.toml");

/// A scene of rigid bodies and joints.
const BODIES: &str = include_str!("../data/bodies.toml");

/// Runs a scene that is wrong and checks what must be so whatever is wrong.
#[track_caller]
fn refuse(folder: &Path, arguments: &[&str]) -> Said {
    let start = Instant::now();
    let said = run(folder, arguments);
    said.refused(&[]);
    assert!(start.elapsed() < Duration::from_secs(5), "{arguments:?} took {:?}", start.elapsed());
    said
}

/// Writes a scene that is wrong, and runs it: no folder of results is left behind.
#[track_caller]
fn refuse_scene(folder: &Path, scene: &str) -> Said {
    fs::write(folder.join("bad.toml"), scene).unwrap();
    let said = refuse(folder, &["run", "bad.toml", "--out", "out"]);
    assert!(!folder.join("out").exists(), "{}", said.stderr);
    said
}

/// The line and the text under the caret that a message points at.
#[track_caller]
fn place(said: &Said) -> (usize, String) {
    let lines: Vec<&str> = said.stderr.lines().collect();
    let arrow = lines.iter().position(|l| l.trim_start().starts_with("--> bad.toml:"));
    let arrow = arrow.unwrap_or_else(|| panic!("no place in\n{}", said.stderr));
    let mut numbers = lines[arrow].split(':').skip(1).map(|n| n.split(' ').next().unwrap().parse::<usize>());
    let (line, column) = (numbers.next().unwrap().unwrap(), numbers.next().unwrap().unwrap());
    let bar = lines[arrow + 3].find('|').unwrap() + 2;
    let carets = lines[arrow + 3][bar..].chars().filter(|c| *c == '^').count();
    let before = lines[arrow + 3][bar..].chars().count() - carets;
    assert!(column > 0 && carets > 0, "{}", said.stderr);
    let source: Vec<char> = lines[arrow + 2][bar..].chars().collect();
    (line, source.iter().skip(before).take(carets).collect())
}

/// Where the numbers of a line start and end.
fn numbers(line: &str) -> Vec<(usize, usize)> {
    let bytes = line.as_bytes();
    let (mut found, mut quoted, mut k) = (Vec::new(), false, 0);
    while k < bytes.len() && (quoted || bytes[k] != b'#') {
        quoted ^= bytes[k] == b'"';
        let begins = bytes[k].is_ascii_digit() || bytes[k] == b'-';
        if !quoted && begins && !(bytes[k - 1].is_ascii_alphanumeric() || bytes[k - 1] == b'_') {
            let end = k + line[k..].find([',', ' ', ']', '}']).unwrap_or(line.len() - k);
            found.push((k, end));
            k = end;
        } else {
            k += 1;
        }
    }
    found
}

#[test]
fn the_scenes_are_right_otherwise() {
    let folder = tempfile::tempdir().unwrap();
    for (name, scene) in [("full.toml", FULL), ("bodies.toml", BODIES)] {
        fs::write(folder.path().join(name), scene).unwrap();
        let said = run(folder.path(), &["run", name, "--quiet"]);
        assert_eq!((said.code, said.stderr.as_str()), (Some(0), ""));
    }
}

#[test]
fn no_number_may_be_infinite_or_none() {
    let folder = tempfile::tempdir().unwrap();
    let mut count = 0;
    for (k, line) in FULL.lines().enumerate() {
        for (start, end) in numbers(line) {
            for bad in ["nan", "inf", "-inf", "1e999", "\"nan m\"", "\"1e999 s\""] {
                let mut lines: Vec<&str> = FULL.lines().collect();
                let line = format!("{}{bad}{}", &line[..start], &line[end..]);
                lines[k] = &line;
                let said = refuse_scene(folder.path(), &lines.join("\n"));
                let (at, marked) = place(&said);
                assert_eq!((at, marked.as_str()), (k + 1, bad), "{}", said.stderr);
                count += 1;
            }
        }
    }
    assert!(count > 400, "{count}");
}

/// What is replaced by what, the text that the message points at, and what it says.
type Change<'a> = (&'a str, &'a str, &'a str, &'a [&'a str]);

/// Checks changes of the full scene.
fn cases(cases: &[Change<'_>]) {
    changes(FULL, cases);
}

/// Checks changes of a scene.
fn changes(scene: &str, cases: &[Change<'_>]) {
    let folder = tempfile::tempdir().unwrap();
    let mut wrong = String::new();
    for (old, new, marked, holds) in cases {
        assert_eq!(scene.matches(old).count(), 1, "{old:?}");
        let said = refuse_scene(folder.path(), &scene.replace(old, new));
        let (line, text) = place(&said);
        // a part as a whole is marked at its head, anything else in what was changed
        let first = scene[..scene.find(old).unwrap()].matches('\n').count() + 1;
        let there = (first..=first + new.matches('\n').count()).contains(&line) || marked.starts_with("[[");
        if text != *marked || !there || holds.iter().any(|h| !said.stderr.contains(h)) {
            wrong += &format!(
                "{old} -> {new}: not {marked:?} in line {first}, or not {holds:?}\n{}\n",
                said.stderr
            );
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused_as_scene_table_and_mesh() {
    use std::process::Command;
    let folder = tempfile::tempdir().unwrap();
    let fifo = folder.path().join("fifo.toml");
    if !Command::new("mkfifo").arg(&fifo).status().is_ok_and(|s| s.success()) {
        return; // not every machine has the program
    }
    for ending in ["csv", "stl", "obj"] {
        assert!(
            Command::new("mkfifo")
                .arg(folder.path().join(format!("fifo.{ending}")))
                .status()
                .unwrap()
                .success()
        );
    }
    refuse(folder.path(), &["run", "fifo.toml"])
        .refused(&["`fifo.toml` is a pipe or a device", "/dev/stdin"]);
    refuse(folder.path(), &["run", "/dev/zero"]).refused(&["`/dev/zero` is a pipe or a device"]);
    let mass = "[[elements]]\ntype = \"point_mass\"\nname = \"m\"\nmarker = [0, 0, 0]\nmass = 1\n";
    for file in ["fifo.csv", "/dev/zero"] {
        let motion = format!("[[motions]]\ntype = \"speed_table\"\nname = \"launch\"\nfile = \"{file}\"\n");
        refuse_scene(folder.path(), &(mass.to_string() + &motion)).refused(&["is a pipe or a device"]);
    }
    if cfg!(feature = "contact") {
        for file in ["fifo.stl", "fifo.obj"] {
            let contact = format!(
                "[[forces]]\ntype = \"contact\"\nname = \"c\"\nshape = {{ mesh = {{ file = \"{file}\" }} }}\nradius = 0.1\nstiffness = 1\n"
            );
            refuse_scene(folder.path(), &(mass.to_string() + &contact)).refused(&["is a pipe or a device"]);
        }
    }
}

#[test]
fn a_history_without_end_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mass = "[[elements]]\ntype = \"point_mass\"\nname = \"m\"\nmarker = [0, 0, 0]\nmass = 1\n";
    let said = refuse_scene(folder.path(), &format!("[run]\noutput = 1e-300\n{mass}"));
    said.refused(&["a history of 1e300 rows is too long"]);
    assert_eq!(place(&said), (2, "1e-300".into()));
}

#[test]
fn zero_and_negative_numbers_are_refused_where_they_make_no_sense() {
    cases(&[
        ("length = 4.2", "length = 0", "0", &["`length` must be positive"]),
        ("length = 4.2", "length = -1", "-1", &["`length` must be positive"]),
        ("mass = 0.5 ", "mass = 0 ", "0", &["`mass` must be positive"]),
        ("mass = 0.5 ", "mass = -0.5 ", "-0.5", &["`mass` must be positive"]),
        ("ea = 2e4 ", "ea = 0 ", "0", &["`ea` must be positive"]),
        ("ei = 0.5 ", "ei = -1 ", "-1", &["`ei` must not be negative"]),
        ("diameter = 0.02 ", "diameter = -0.02 ", "-0.02", &["`diameter` must not be negative"]),
        ("diameter = 0.02 ", "diameter = 0 ", "[[forces]]", &["drag needs a diameter, and `line` has none"]),
        ("flooded = 0.1 ", "flooded = -0.1 ", "-0.1", &["`flooded` must not be negative"]),
        (
            "axial_retardation_time = 0.001",
            "axial_retardation_time = -1",
            "-1",
            &["`axial_retardation_time` must not be negative"],
        ),
        ("elements = 4 # line", "elements = 0", "0", &["`elements` must be between 1 and 1000000"]),
        ("elements = 4 # line", "elements = -4", "-4", &[]),
        ("elements = 4 # line", "elements = 2.5", "2.5", &[]),
        ("elements = 4 # line", "elements = 2000000", "2000000", &["`elements`"]),
        (
            "[4, 0, 0] # end",
            "[0, 0, 0] # end",
            "[[0, 0, 0], [0, 0, 0] # end",
            &["points 1 and 2 are the same"],
        ),
        ("mass = 8 ", "mass = 0 ", "0", &["`mass` must be positive"]),
        ("volume = 0.001", "volume = -0.001", "-0.001", &["`volume` must not be negative"]),
        ("added_mass = 1", "added_mass = -1", "-1", &["`added_mass` must not be negative"]),
        ("drag_area = 0.01", "drag_area = -0.01", "-0.01", &["`drag_area` must not be negative"]),
        ("h_max = 0.5", "h_max = 0", "0", &["`h_max` must be positive"]),
        ("h_min = 1e-9", "h_min = -1", "-1", &["`h_min` must be positive"]),
        ("h_min = 1e-9", "h_min = 1", "1", &["`h_min` = 1 s must not be above `h_max` = 0.5 s"]),
        ("h_max = 0.5\nh_min = 1e-9", "h_max = 1e-19\nh_min = 1e-20", "1e-19", &["more than a year"]),
        (
            "stepping = { controlled = { tolerance = 0.001 } }",
            "stepping = { fixed = { h = 1e-30 } }",
            "1e-30",
            &["`h` = 1e-30 s makes 2e29 steps", "more than a year"],
        ),
        ("length = 4.2", "length = 1e-12", "1e-12", &["stretched to 4.0e12 times"]),
        ("strain = 0.001", "strain = -1", "-1", &["between -0.9 and 9"]),
        ("h_start = 0.001", "h_start = 0", "0", &["`h_start` must be positive"]),
        ("horizon = 5", "horizon = -5", "-5", &["`horizon` must not be negative"]),
        ("newton_tolerance = 1", "newton_tolerance = 0", "0", &["`newton_tolerance` must be positive"]),
        ("max_iterations = 20", "max_iterations = 1", "1", &["`max_iterations` must be at least 2"]),
        ("controlled = { tolerance = 0.001 }", "fixed = { h = 0 }", "0", &["`h` must be positive"]),
        ("controlled = { tolerance = 0.001 }", "fixed = { h = -1 }", "-1", &["`h` must be positive"]),
        ("{ tolerance = 0.001 }", "{ tolerance = 0 }", "0", &["`tolerance` must be positive"]),
        ("rho_inf = 0.8", "rho_inf = 1.5", "1.5", &["`rho_inf` must be between 0 and 1"]),
        ("duration = 0.2", "duration = 0", "0", &["`duration` must be positive"]),
        ("output = 0.02", "output = -1", "-1", &["`output` must not be negative"]),
        ("output = 0.02", "output = 1e-9", "1e-9", &["make `output` longer"]),
        (
            "snapshots = 3",
            "snapshots = 1000000000000",
            "1000000000000",
            &["`snapshots` must be at most 10000"],
        ),
        ("steps = 10", "steps = 0", "0", &["`steps` must be between 1 and 1000000"]),
        ("max_iterations = 60", "max_iterations = 0", "0", &["`max_iterations` must be at least 1"]),
        ("tolerance = 1e-9", "tolerance = 0", "0", &["`tolerance` must be positive"]),
        ("radius = 20", "radius = 1e-300", "[[motions]]", &["before speed and yaw rate are steady"]),
        ("density = 1025", "density = 0", "0", &["`density` must be positive"]),
        ("viscosity = 0.00108", "viscosity = -1", "-1", &["`viscosity` must not be negative"]),
        (
            "z = 0, ",
            "z = -20, ",
            "[{ z = -10, velocity = [0, 0, 0] }, { z = -20, velocity = [0.5, 0, 0] }]",
            &["ascend"],
        ),
        ("cn = 1.2", "cn = -1", "-1", &["`cn` must not be negative"]),
        ("ct = 0.01", "ct = -1", "-1", &["`ct` must not be negative"]),
        ("blend = 0.1", "blend = 0", "0", &["`blend` must be above 0"]),
        ("ca = 1", "ca = -1", "-1", &["`ca` must not be negative"]),
        ("stiffness = 50", "stiffness = -50", "-50", &["`stiffness` must not be negative"]),
        ("damping = 3", "damping = -3", "-3", &["`damping` must not be negative"]),
        ("radius = 20", "radius = 0", "0", &["`radius` must be positive"]),
        ("speed = 2 ", "speed = 0 ", "0", &["`speed` must be positive"]),
        ("turn_ramp = 3", "turn_ramp = 0", "0", &["jump of velocity", "try 1 s"]),
        ("turn_ramp = 3", "turn_ramp = -1", "-1", &["`turn_ramp` must be positive"]),
        ("turn_start = 2", "turn_start = 0.5", "0.5", &["must begin at 1 s or later"]),
        ("heading = [1, 0, 0]", "heading = [0, 0, 0]", "[0, 0, 0]", &["`heading` has no length"]),
        ("heading = [1, 0, 0]", "heading = [0, 0, 1]", "[0, 0, 1]", &["horizontal"]),
        ("frequency = 0.5 # heave", "frequency = 0", "0", &["`frequency` must be positive"]),
        ("ramp = 4 # heave", "ramp = -4", "-4", &["`ramp` must be positive"]),
        ("direction = [0, 1, 0]", "direction = [0, 0, 0]", "[0, 0, 0]", &["`direction` has no length"]),
        (
            "t0 = 0, t1 = 1",
            "t0 = 1, t1 = 1",
            "{ ramp = { from = 0, to = 1, t0 = 1, t1 = 1 } }",
            &["must end after its start"],
        ),
        ("length = 0.5 # rod", "length = 0", "0", &["`length` must be positive"]),
    ]);
}

#[test]
fn names_that_do_not_exist_are_told_those_that_do() {
    cases(&[
        (
            "marker = \"line.start\"",
            "marker = \"line.begin\"",
            "\"line.begin\"",
            &["`line.begin`", "start", "end"],
        ),
        (
            "marker = \"line.start\"",
            "marker = \"lime.start\"",
            "\"lime.start\"",
            &["no part `lime`", "`line`, `bob`"],
        ),
        ("\"line@1.5m\"", "\"line@9m\"", "\"line@9m\"", &["4.2"]),
        ("\"line@1.5m\"", "\"line@1.5kg\"", "\"line@1.5kg\"", &["is a mass, expected a length"]),
        (
            "motion = \"heave\"",
            "motion = \"haeve\"",
            "\"haeve\"",
            &["no motion `haeve`", "`course`, `heave`"],
        ),
        ("on = [\"line\"]", "on = [\"lime\"]", "[\"lime\"]", &["no part `lime`", "`line`, `bob`"]),
        ("name = \"bob\"", "name = \"line\"", "\"line\"", &["two parts named `line`"]),
        ("name = \"hand\"", "name = \"hook\"", "\"hook\"", &["two constraints named `hook`"]),
        ("name = \"heave\"", "name = \"course\"", "\"course\"", &["two motions named `course`"]),
        ("name = \"bob\"", "name = \"\"", "\"\"", &["can't be a name"]),
        ("cn = 1.2", "cm = 1.2", "cm", &["unknown field `cm`", "`cn`", "did you mean `cn`?"]),
        ("flooded = 0.1 ", "floded = 0.1 ", "floded", &["unknown field `floded`", "did you mean `flooded`?"]),
        ("[statics]", "[static]", "static", &["unknown field `static`", "`statics`"]),
        ("type = \"buoyancy\"", "type = \"boyancy\"", "\"boyancy\"", &["`boyancy`", "`buoyancy`", "`drag`"]),
        ("type = \"buoyancy\"", "kind = \"buoyancy\"", "[[forces]]", &["`type`"]),
        ("longitudinal = \"L4\"", "longitudinal = \"L5\"", "\"L5\"", &["`L5`", "`L1n`"]),
        ("longitudinal = \"L4\"\ntransverse", "longitudinal = \"L1\"\ntransverse", "\"T3\"", &["T3"]),
        ("of = \"hook\"", "of = \"hoop\"", "\"hoop\"", &["`hoop`", "`hook`, `hand`"]),
        ("at = 2.5 # tension", "at = 25 # tension", "25", &["from 0 to 4.2"]),
        (
            "of = \"bob\"",
            "of = \"bob\"\nname = \"line.end\"",
            "\"line.end\"",
            &["two records named `line.end`", "give one of them a `name`"],
        ),
    ]);
}

#[test]
fn contradictions_are_named() {
    let again = "[[constraints]]\ntype = \"spherical\"\nname = \"again\"\nmarker = \"line.start\"\n\n[[motions]]\ntype = \"turn\"";
    cases(&[
        (
            "[[motions]]\ntype = \"turn\"",
            again,
            "[[constraints]]",
            &["`again`, `hook` contradict each other", "prescribe different velocities", "Remove one"],
        ),
        (
            "t = [0, 0.1, 0.5] # sway",
            "t = [0, 0.1, 0.15]",
            "[[constraints]]",
            &["`sway`", "up to t = 0.15 s", "shorten `duration`"],
        ),
        (
            "t = [0, 0.1, 0.5] # sway",
            "t = [0.05, 0.1, 0.5]",
            "[[constraints]]",
            &["`sway`", "from t = 0.05 s on"],
        ),
        ("t = [0, 0.1, 0.5] # sway", "t = [0, 0.5, 0.1]", "[0, 0.5, 0.1]", &["must ascend"]),
        ("0.1, 0.5] # sway\nx", "0.5]\nx", "[0, 0.01, 0.02]", &["`x` has 3 entries, but `t` has 2"]),
        (
            "current = [0, 0, 0]\nprofile",
            "current = [1, 0, 0]\nprofile",
            "[{ z = -10, velocity = [0, 0, 0] }, { z = 0, velocity = [0.5, 0, 0] }]",
            &["both `current` and `profile`"],
        ),
    ]);
}

#[test]
fn units_of_the_wrong_kind_are_refused() {
    let mass = "\"25 kg\" is a mass, expected a speed like \"25 kn\" or a number in m/s";
    cases(&[
        ("speed = 2 ", "speed = \"25 kg\" ", "\"25 kg\"", &[mass]),
        ("speed = 2 ", "speed = \"25\" ", "\"25\"", &["has no unit"]),
        ("speed = 2 ", "speed = \"fast\" ", "\"fast\"", &["does not begin with a number"]),
        ("speed = 2 ", "speed = true ", "true", &["expected a speed"]),
        ("speed = 2 ", "speed = [2] ", "[2]", &["expected a speed"]),
        ("speed = 2 ", "speed = \"25 furlongs\" ", "\"25 furlongs\"", &["expected a speed"]),
        ("mass = 8 ", "mass = \"8 kg/m\" ", "\"8 kg/m\"", &["is a mass per length, expected a mass"]),
        (
            "amplitude = [0, 0, 0.1]",
            "amplitude = [0, 0, \"1 s\"]",
            "\"1 s\"",
            &["is a time, expected a length"],
        ),
        ("amplitude = [0, 0, 0.1]", "amplitude = [0, 0]", "[0, 0]", &["three entries"]),
        ("duration = 0.2", "duration = \"2 m\"", "\"2 m\"", &["is a length, expected a time"]),
    ]);
}

#[test]
fn syntax_errors_are_placed() {
    cases(&[
        ("cn = 1.2", "cn = 1.2.3", ".3", &["invalid float"]),
        ("cn = 1.2", "cn = 1.2\ncn = 1.3", "cn", &["`cn`"]),
        ("cn = 1.2", "cn =", "", &[]),
    ]);
}

#[test]
fn parameters_from_outside_are_checked_as_well() {
    let folder = tempfile::tempdir().unwrap();
    let scene =
        FULL.replace("title =", "parameters = { v = 2 }\ntitle =").replace("speed = 2 ", "speed = \"$v\" ");
    fs::write(folder.path().join("full.toml"), scene).unwrap();
    for (set, holds) in [
        ("v=nan", "not a finite number"),
        ("v=25 kg", "is a mass, expected a speed"),
        ("v=0", "`speed` must be positive"),
        ("w=1", "`w`"),
        ("v", "v"),
        ("=1", "="),
    ] {
        let said = refuse(folder.path(), &["run", "full.toml", "--out", "out", "--set", set]);
        said.refused(&[holds]);
        assert!(!folder.path().join("out").exists());
    }
}

#[test]
fn bodies_that_cannot_be_are_refused() {
    changes(
        BODIES,
        &[
            (
                "density = 7850\nshape = { cylinder",
                "shape = { cylinder",
                "{ cylinder = { length = 0.5, radius = 0.02 } }",
                &["either a `mass` or a `density`"],
            ),
            (
                "density = 7850\nshape = { cylinder",
                "density = 7850\nmass = 1\nshape = { cylinder",
                "{ cylinder = { length = 0.5, radius = 0.02 } }",
                &["either a `mass` or a `density`"],
            ),
            ("mass = 2 # crank", "", "[[elements]]", &["`mass` is missing"]),
            ("mass = 2 # crank", "mass = 0", "0", &["`mass` must be positive"]),
            ("mass = 2 # crank", "mass = \"2 m\"", "\"2 m\"", &["is a length, expected a mass"]),
            ("[0.01, 0.02, 0.025] # crank", "[0.01, 0.02, 0.04]", "[0.01, 0.02, 0.04]", &["exceeds the sum"]),
            ("[0.01, 0.02, 0.025] # crank", "[0, 0.02, 0.02]", "[0, 0.02, 0.02]", &["must be positive"]),
            ("inertia = [0.01, 0.02, 0.025] # crank", "", "[[elements]]", &["`inertia`", "`shape`"]),
            ("density = 7850", "density = -1", "-1", &["`density` must be positive"]),
            (
                "radius = 0.02 } } # link",
                "radius = 0 } }",
                "{ cylinder = { length = 0.5, radius = 0 } }",
                &["`radius` must be positive"],
            ),
            (
                "radius = 0.02 } } # link",
                "radius = 0.02, inner = 0.02 } }",
                "{ cylinder = { length = 0.5, radius = 0.02, inner = 0.02 } }",
                &["`inner` must be"],
            ),
            (
                "{ cuboid = { edges = [0.2, 0.3, 0.01] } }",
                "{ cube = { edges = [0.2, 0.3, 0.01] } }",
                "{ cube = { edges = [0.2, 0.3, 0.01] } }",
                &["`cuboid`"],
            ),
            (
                "mass = 3 # plate",
                "mass = 3\ninertia = [1, 1, 1]",
                "[1, 1, 1]",
                &["either `inertia`", "or a `shape`"],
            ),
        ],
    );
}

#[test]
fn joints_that_hold_nothing_are_refused() {
    changes(
        BODIES,
        &[
            ("to = \"crank.pin\"", "to = \"link.end\"", "[[constraints]]", &["same body", "nothing to join"]),
            (
                "to = \"crank.pin\"",
                "to = \"crank.pim\"",
                "\"crank.pim\"",
                &["no such place", "`crank.pin`", "`points`"],
            ),
            ("to = \"crank.pin\"", "to = \"crank@0.3\"", "\"crank@0.3\"", &["no such place", "`crank.com`"]),
            ("to = \"crank.pin\"", "to = \"crunk.pin\"", "\"crunk.pin\"", &["no part `crunk`", "`crank`"]),
            (
                "to = \"crank.pin\"",
                "to = \"bob\"",
                "[[constraints]]",
                &["is a point, which has no axis to hold"],
            ),
            ("axis = [0, 0, 1] # bearing", "axis = [0, 0, 0]", "[0, 0, 0]", &["`axis` has no length"]),
            ("axis = [0, 0, 1] # cross", "axis = [0, 0, 0]", "[0, 0, 0]", &["`axis` has no length"]),
            ("axis = [0, 0, 1] # cross", "", "[[constraints]]", &["`axis` is missing"]),
            ("axis = [1, 0, 0] # guide", "axis = [0, 0]", "[0, 0]", &["expected a list of 3"]),
            (
                "constraint = \"cross\"",
                "constraint = \"gross\"",
                "\"gross\"",
                &["no constraint `gross`", "`bearing`, `cross`, `guide`"],
            ),
            ("force = 1000", "force = 0", "0", &["`force` must be positive"]),
            (
                "axis = [0, 0, 1] # cross",
                "axis = [0, 1, 0]",
                "[[constraints]]",
                &["must start at 90°, but are at 0.0°", "`axis_to`"],
            ),
        ],
    );
}

#[test]
fn files_that_are_no_scenes_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    fs::create_dir(folder.path().join("folder.toml")).unwrap();
    fs::create_dir(folder.path().join("folder")).unwrap();
    write("binary.toml", &[0x7f, b'E', b'L', b'F', 0, 1, 2, 0xff, 0xfe]);
    write("latin.toml", b"title = \"caf\xe9\"\n");
    write("empty.toml", b"");
    write("blank.toml", b"\n# nothing\n");
    write("bare.toml", b"title = \"nothing\"\n");
    write("picture.svg", b"<svg/>");
    write("open.json", b"{ \"title\": \"x\", ");
    write("list.json", b"[1, 2]");
    // sparse: takes no place on the disk
    let large = fs::File::create(folder.path().join("large.toml")).unwrap();
    large.set_len(100 << 20).unwrap();
    let mut text = b"title = \"".to_vec();
    text.resize(100 << 20, b'x');
    write("long.toml", &text);
    let deep = format!("title = {}", "[".repeat(100_000));
    write("deep.toml", deep.as_bytes());
    write("deep.json", format!("{{\"title\": {}", "[".repeat(100_000)).as_bytes());

    for verb in ["run", "check", "describe"] {
        for (file, holds) in [
            ("missing.toml", "no file `missing.toml`"),
            ("no/such/folder.toml", "no file"),
            ("pendulm", "did you mean `pendulum`?"),
            ("folder.toml", "is a directory"),
            ("folder", "is a directory"),
            ("binary.toml", "not a text file"),
            ("latin.toml", "not a text file"),
            ("empty.toml", "is empty"),
            ("blank.toml", "is empty"),
            ("picture.svg", "neither `.toml` nor `.json`"),
            ("open.json", "open.json:1:"),
            ("list.json", ""),
            ("large.toml", "larger than 8 MB"),
            ("long.toml", "larger than 8 MB"),
            ("deep.toml", "deep.toml:1:"),
            ("deep.json", "deep.json:1:"),
        ] {
            refuse(folder.path(), &[verb, file]).refused(&[holds]);
        }
    }
    refuse(folder.path(), &["run", "bare.toml"]).refused(&["the scene is empty: add at least one element"]);
    assert!(!folder.path().join("runs").exists());
}

#[test]
fn run_folders_that_cannot_be_written_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("full.toml"), FULL).unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    for out in ["file", "file/inside"] {
        refuse(folder.path(), &["run", "full.toml", "--out", out])
            .refused(&["is a file, not a folder", "--out"]);
    }
    // not even root may write there
    #[cfg(target_os = "linux")]
    refuse(folder.path(), &["run", "full.toml", "--out", "/proc/runs"])
        .refused(&["can't create folder /proc/runs"]);
    // without --out, and a file where the folder of all runs should be
    fs::write(folder.path().join("runs"), "").unwrap();
    refuse(folder.path(), &["run", "full.toml"]).refused(&["runs", "is a file, not a folder"]);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let locked = folder.path().join("locked");
        fs::create_dir(&locked).unwrap();
        fs::set_permissions(&locked, fs::Permissions::from_mode(0o555)).unwrap();
        // root may write anywhere
        if fs::write(locked.join("probe"), "").is_err() {
            refuse(folder.path(), &["run", "full.toml", "--out", "locked"]).refused(&["you may write to"]);
        }
    }
}

/// The multipliers of a wheel are no force on it.
#[test]
fn the_reaction_of_a_sheave_is_refused_with_what_tells_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let scene = r#"
        [run]
        duration = 0.1
        [[elements]]
        type = "point_mass"
        name = "a"
        marker = [-0.2, 0, -2]
        mass = 5
        [[elements]]
        type = "point_mass"
        name = "b"
        marker = [0.2, 0, -2]
        mass = 5
        [[elements]]
        type = "cable"
        name = "r"
        section = { mass = 0.1, ea = 1e6 }
        elements = 4
        tension = 49.05
        route = [{ end = "a" }, { over = "wheel" }, { end = "b" }]
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.2
        [[records]]
        type = "reaction"
        of = "wheel"
        "#;
    let said = refuse_scene(folder.path(), scene);
    assert!(said.stderr.contains("`axle_force` of a record of type `sheave`"), "{}", said.stderr);
}

/// A column that is misspelt would be as if it weren't there.
#[test]
fn a_column_of_a_vessels_motion_that_is_misspelt_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("motion.csv"), "t,surge,heeve\n0,0,0\n1,0.1,0.2\n2,0,0\n").unwrap();
    let scene = r#"
        [run]
        duration = 1
        [[elements]]
        type = "rigid_body"
        name = "ship"
        position = [0, 0, 0]
        mass = 1e3
        inertia = [1e3, 1e3, 1e3]
        [[constraints]]
        type = "vessel"
        name = "moves"
        marker = "ship"
        file = "motion.csv"
        "#;
    let said = refuse_scene(folder.path(), scene);
    for part in ["motion.csv, line 1", "`heeve`", "did you mean `heave`?"] {
        assert!(said.stderr.contains(part), "no {part}: {}", said.stderr);
    }
}
