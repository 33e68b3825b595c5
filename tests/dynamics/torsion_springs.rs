//! Torsion springs that are wound up by whole turns, and bushings, which can't be.

use ropewalk::scene::{Format, SceneFile};
use ropewalk::{History, simulate};

const SHOWN: &str = "[[records]]\ntype = \"force\"\nof = \"spring\"\n";

fn hinged(more: &str) -> Result<History, String> {
    let hinge =
        "[[constraints]]\ntype = \"revolute\"\nname = \"hinge\"\nmarker = \"wheel\"\naxis = [0, 0, 1]\n";
    scene(more, hinge)
}

fn scene(more: &str, hinge: &str) -> Result<History, String> {
    let text = format!(
        r#"
        gravity = [0, 0, 0]
        [[elements]]
        type = "rigid_body"
        name = "wheel"
        position = [0, 0, 0]
        mass = 1
        inertia = [1, 1, 1]
        angular_velocity = [0, 0, 10]
        {hinge}
        [[records]]
        type = "angular_velocity"
        of = "wheel"
        [[records]]
        type = "orientation"
        of = "wheel"
        {more}
        "#
    );
    let file = SceneFile::parse(&text, "wheel", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}\n{text}"));
    simulate(file.scene()).map_err(|e| e.to_string())
}

fn spring(stiffness: f64, angle: f64) -> String {
    format!(
        "[[forces]]\ntype = \"rotational_spring\"\nname = \"spring\"\nmarker = \"wheel\"\naxis = [0, 0, 1]\nstiffness = {stiffness}\n\
         angle = {angle}\n"
    )
}

/// A wheel on a spring swings by 14 rad, as `φ₀ - φ₀ cos ωt + Ω/ω sin ωt` does from the angle 0 with the speed `Ω`.
#[test]
fn a_torsion_spring_is_wound_up_by_whole_turns() {
    let (k, rest, t) = (0.5_f64, 2.0, 20.0);
    let w = k.sqrt();
    let right = rest * w * (w * t).sin() + 10.0 * (w * t).cos();
    for solver in ["", "scheme = \"radau-iia-5\"", "stepping = { fixed = { h = 2e-3 } }"] {
        let run = format!("{}[solver]\n{solver}\n[run]\nduration = {t}\noutput = 1\n", spring(k, rest));
        let history = hinged(&run).unwrap_or_else(|e| panic!("{e}"));
        let found = history.last("wheel.wz").expect("a speed");
        println!("{solver}: {found} of {right}");
        assert!((found - right).abs() < 1e-2 && history.warnings.is_empty(), "{solver}: {found}, {right}");
    }
}

/// A moment that grows to 5 N m winds a spring of 0.5 N m/rad up by 10 rad, and from there back by 2 rad that it was wound before.
#[test]
fn a_torsion_spring_comes_to_rest_turns_away() {
    for wound in [0.0, -2.0] {
        let load = "[[forces]]\ntype = \"point_moment\"\nmarker = \"wheel\"\nmoment = [0, 0, 5]\n\
                    time = { table = { t = [0, 1], value = [0, 1] } }\n";
        let run = format!(
            "{}{load}[run]\nanalysis = \"statics\"\n[statics]\nsteps = 10\n{SHOWN}",
            spring(0.5, wound)
        );
        let history = hinged(&run).unwrap_or_else(|e| panic!("{e}"));
        let last = |name: &str| history.last(name).unwrap_or_else(|| panic!("no {name}"));
        let (angle, right) = (last("wheel.phi3"), 10.0 + wound);
        assert!((last("spring.angle") - right).abs() < 1e-6 && (last("spring.moment") + 5.0).abs() < 1e-6);
        let turns = (angle - right) / std::f64::consts::TAU;
        assert!((turns - turns.round()).abs() < 1e-6, "{angle} instead of {right}");
    }
}

/// A wheel on a mount that turns with it: under a force and a moment the mount shows their opposites, in its own axes.
#[test]
fn a_bushing_shows_its_force_and_moment() {
    let text = "[[forces]]\ntype = \"bushing\"\nname = \"spring\"\nmarker = \"wheel\"\naxis_x = [0, 0, 1]\naxis_y = [1, 0, 0]\n\
                stiffness = [100, 200, 300]\nrotational_stiffness = [20, 30, 40]\n\
                [[forces]]\ntype = \"point_force\"\nmarker = \"wheel\"\nforce = [1, 2, 3]\n\
                [[forces]]\ntype = \"point_moment\"\nmarker = \"wheel\"\nmoment = [0, 0, 0.7]\n\
                [run]\nanalysis = \"statics\"\n";
    let history = scene(&format!("{text}{SHOWN}"), "").unwrap_or_else(|e| panic!("{e}"));
    for (name, right) in [("fx", -3.0), ("fy", -1.0), ("fz", -2.0), ("mx", -0.7), ("my", 0.0), ("mz", 0.0)] {
        let found = history.last(&format!("spring.{name}")).expect("a column");
        assert!((found - right).abs() < 1e-6, "{name}: {found}");
    }
}

#[test]
fn a_bushing_that_is_turned_round_ends_the_run() {
    let bushing = "[[forces]]\ntype = \"bushing\"\nname = \"mount\"\nmarker = \"wheel\"\nstiffness = [0, 0, 0]\nrotational_stiffness = [1, 1, 0.5]\n";
    for solver in ["", "scheme = \"radau-iia-5\"", "stepping = { fixed = { h = 2e-3 } }"] {
        let run = format!("{bushing}[solver]\n{solver}\n[run]\nduration = 2\noutput = 1\n");
        let error = hinged(&run).err().expect("an error");
        assert!(
            error.contains("`mount` is turned by more than half a turn")
                && error.contains("rotational_spring"),
            "{error}"
        );
    }
}
