//! Constraints that contradict each other end a run, whatever loads act and however it is solved, with the names of both.

use ropewalk::SceneFile;
use ropewalk::scene::Format;
use ropewalk_core::integrator::{ConstraintForm, Options, Scheme, Stepping};
use ropewalk_core::{End, Simulation};

const BODY: &str = "[[elements]]\ntype='rigid_body'\nname='b'\nposition=[0,0,0]\nmass=1\ninertia=[1,1,1]\n";
const CABLE: &str = "[[elements]]\ntype='cable'\nname='c'\npoints=[[0,0,0],[2,0,0]]\nelements=4\nsection={mass=0.5,ea=1e4,ei=0.1}\n";
const BALL: &str = "[[elements]]\ntype='point_mass'\nname='b'\nmarker=[1,0,0]\nmass=1\n";
const RUN: &str = "[[motions]]\ntype='straight'\nname='run'\nspeed=1\n";
const SPIN: &str = "[[motions]]\ntype='spin'\nname='turn'\nrate=1\n";

/// Parts with two constraints each, `one` and `two`, that ask for different things: from the start, or once they move.
fn pairs() -> [(&'static str, String); 7] {
    let constraint = |name: &str, rest: &str| format!("[[constraints]]\nname='{name}'\n{rest}\n");
    let scene = |parts: &[&str], one: &str, two: &str| {
        parts.concat() + &constraint("one", one) + &constraint("two", two)
    };
    let across = "[[motions]]\ntype='straight'\nname='across'\nspeed=0.5\ndirection=[0,1,0]\nstart=0\n";
    let faster = "[[motions]]\ntype='spin'\nname='faster'\nrate=1.5\n";
    let hinge = constraint("hinge", "type='revolute'\nmarker='b'\naxis=[0,0,1]");
    [
        (
            "welded and driven",
            scene(&[BODY, RUN], "type='weld'\nmarker='b'", "type='driving'\nmarker='b'\nmotion='run'"),
        ),
        (
            "two motions",
            scene(
                &[BALL, RUN, across],
                "type='driving'\nmarker='b'\nmotion='run'",
                "type='driving'\nmarker='b'\nmotion='across'",
            ),
        ),
        (
            "pinned and driven",
            scene(
                &[CABLE, RUN],
                "type='spherical'\nmarker='c.end'",
                "type='driving'\nmarker='c.end'\nmotion='run'",
            ),
        ),
        (
            "pinned to two points",
            scene(
                &[CABLE],
                "type='spherical'\nmarker='c.end'\nto=[2,0,0]",
                "type='spherical'\nmarker='c.end'\nto=[2,0.5,0]",
            ),
        ),
        (
            "on a rod and driven along it",
            scene(
                &[BALL, RUN],
                "type='distance'\nmarker='b'\nto=[0,0,0]",
                "type='driving'\nmarker='b'\nmotion='run'",
            ),
        ),
        (
            "turned in two ways",
            scene(
                &[BODY, SPIN, faster, &hinge],
                "type='rotation'\nmarker='b'\naxis=[0,0,1]\nmotion='turn'",
                "type='rotation'\nmarker='b'\naxis=[0,0,1]\nmotion='faster'",
            ),
        ),
        (
            "welded and turned",
            scene(
                &[BODY, SPIN],
                "type='weld'\nmarker='b'",
                "type='rotation'\nmarker='b'\naxis=[0,0,1]\nmotion='turn'",
            ),
        ),
    ]
}

fn settings() -> [(&'static str, Options); 4] {
    let new = Options::default;
    [
        ("default", new()),
        ("fixed", Options { stepping: Stepping::Fixed { h: 1e-2 }, ..new() }),
        ("ggl", Options { constraints: ConstraintForm::Ggl, ..new() }),
        ("radau", Options { scheme: Scheme::RadauIia5, ..new() }),
    ]
}

/// What a run of a scene says, if it doesn't get to its end; projects the start if it has to.
fn trouble(text: &str, options: &Options, duration: f64) -> Option<String> {
    let file = SceneFile::parse(text, "pair", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let model = match file.scene().build() {
        Ok(model) => model,
        Err(e) => return Some(e.to_string()),
    };
    let options = Options { project: true, ..options.clone() };
    let mut s = match Simulation::new(model, &options, duration) {
        Ok(s) => s,
        Err(e) => return Some(e.to_string()),
    };
    match s.advance(duration, f64::INFINITY, &mut ()) {
        Ok(end) => {
            assert_eq!(end, End::Done);
            None
        }
        Err(e) => Some(e.to_string()),
    }
}

#[test]
fn none_of_280_is_silent() {
    let mut wrong = Vec::new();
    for (pair, scene) in pairs() {
        for gravity in ["", "[[forces]]\ntype='gravity'\n"] {
            for (setting, options) in settings() {
                for duration in [0.05, 0.5, 2.0, 10.0, 100.0] {
                    let said = trouble(&format!("{scene}{gravity}"), &options, duration);
                    if !said.as_ref().is_some_and(|s| s.contains("`one`") && s.contains("`two`")) {
                        wrong.push(format!("{pair}, {setting}, {duration} s, {gravity:?}: {said:?}"));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} of 280:\n{}", wrong.len(), wrong.join("\n"));
}

/// Constraints that come to contradict each other only on the way, so that nothing at the start tells: a ball on a rod is
/// driven across it.
#[test]
fn what_contradicts_only_on_the_way_ends_there() {
    let across = "[[motions]]\ntype='straight'\nname='run'\nspeed=1\ndirection=[0,1,0]\n";
    let rod = "[[constraints]]\nname='one'\ntype='distance'\nmarker='b'\nto=[0,0,0]\n";
    let driven = "[[constraints]]\nname='two'\ntype='driving'\nmarker='b'\nmotion='run'\n";
    for gravity in ["", "[[forces]]\ntype='gravity'\n"] {
        for (setting, options) in settings() {
            let said = trouble(&[BALL, across, rod, driven, gravity].concat(), &options, 10.0);
            let named = said.as_ref().is_some_and(|s| s.contains("`one`") && s.contains("`two`"));
            assert!(named, "{setting}: {said:?}");
        }
    }
}

/// A crank that starts in line with its rod, which holds it from then on: what drives it is named, too.
#[test]
fn what_drives_into_a_contradiction_is_named() {
    let crank = "[[constraints]]\nname='hinge'\ntype='revolute'\nmarker='b'\naxis=[0,0,1]\n\
                 [[constraints]]\nname='rod'\ntype='distance'\nmarker='b.e'\nto=[0.5,0,0]\n\
                 [[constraints]]\nname='motor'\ntype='rotation'\nmarker='b'\naxis=[0,0,1]\nmotion='turn'\n";
    let body = BODY.replace("name='b'", "name='b'\npoints={ e = [0.2, 0, 0] }");
    for (setting, options) in settings() {
        let said = trouble(&[&body, SPIN, crank].concat(), &options, 2.0).unwrap_or_default();
        assert!(["`hinge`", "`rod`", "`motor`"].iter().all(|name| said.contains(name)), "{setting}: {said}");
    }
}

/// The same things said twice are no contradiction.
#[test]
fn what_is_said_twice_runs() {
    let twice = |one: &str, two: &str| {
        format!("[[constraints]]\nname='one'\n{one}\n[[constraints]]\nname='two'\n{two}\n")
    };
    let driven = "type='driving'\nmarker='b'\nmotion='run'";
    let turned = "type='rotation'\nmarker='b'\naxis=[0,0,1]\nmotion='turn'";
    let hinge = "[[constraints]]\nname='hinge'\ntype='revolute'\nmarker='b'\naxis=[0,0,1]\n";
    let pinned = "type='spherical'\nmarker='c.start'";
    for scene in [
        [BALL, RUN, &twice(driven, driven)].concat(),
        [BODY, SPIN, hinge, &twice(turned, turned)].concat(),
        [CABLE, &twice(pinned, pinned)].concat(),
    ] {
        for gravity in ["", "[[forces]]\ntype='gravity'\n"] {
            for (setting, options) in settings() {
                let said = trouble(&format!("{scene}{gravity}"), &options, 2.0);
                assert_eq!(said, None, "{setting}\n{scene}");
            }
        }
    }
}
