//! What hangs from a turning axis: upright up to a critical speed, whirling beyond, with a free azimuth.

use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};

const G: f64 = 9.81;

/// A cable of 1 m and 1 kg that hangs straight down from the axis, turning at `ω² L/g = speed`.
fn hanging(speed: f64, elements: u32, section: &str) -> History {
    let omega = (speed * G).sqrt();
    let text = format!(
        r#"
        [run]
        analysis = "statics"
        frame = {{ omega = [0, 0, {omega}] }}
        [[elements]]
        type = "cable"
        name = "c"
        points = [[0, 0, 0], [0, 0, -1]]
        elements = {elements}
        section = {{ mass = 1, ea = 1e7, {section} }}
        [[constraints]]
        type = "spherical"
        name = "top"
        marker = "c.start"
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "c.end"
        [[records]]
        type = "along"
        of = "c"
        what = "tension"
        at = "start"
        "#
    );
    let file = SceneFile::parse(&text, "whirling", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    simulate(file.scene()).unwrap_or_else(|e| panic!("{speed}: {e}"))
}

/// Distance of the tip from the axis, its depth, and the tension at the top over the weight.
fn tip(h: &History) -> [f64; 3] {
    let last = |name: &str| h.last(name).unwrap();
    [last("c.end.x").hypot(last("c.end.y")), -last("c.end.z"), last("c.start.tension") / G]
}

/// Whether the run says that the azimuth is free.
fn turns(h: &History) -> bool {
    h.warnings.iter().any(|w| w.contains("`c` turns about the axis (0, 0, 1) through (0, 0, 0) m"))
}

/// `cos θ = 3g/(2ω² L)` above `ω² L/g = 3/2`: a balance of moments.
#[test]
fn a_bar_leaves_the_axis_at_its_critical_speed() {
    for (speed, cosine) in [(1.0, 1.0), (1.4, 1.0), (1.6, 0.9375), (2.0, 0.75), (6.0, 0.25)] {
        let h = hanging(speed, 4, "ei = 1e4");
        let [radius, depth, _] = tip(&h);
        println!("{speed}: {radius} {depth} {cosine}");
        assert!((depth - cosine).abs() < 1e-5, "{speed}: {depth}");
        assert!((radius - (1.0 - cosine * cosine).sqrt()).abs() < 1e-4, "{speed}: {radius}");
        assert_eq!(turns(&h), cosine < 1.0, "{speed}: {:?}", h.warnings);
    }
}

/// A string leaves the axis at a quarter of the square of the first zero of J0; the curves beyond by an independent solution of
/// the boundary value problem (shooting).
#[test]
fn a_string_whirls_as_its_equation_says() {
    let cases = [
        (1.0, [0.0, 1.0, 1.0]),
        (1.4, [0.0, 1.0, 1.0]),
        (1.5, [0.274_816_130_473_365_67, 0.959_529_886_021_829_5, 1.016_172_815_198_08]),
        (1.8, [0.606_658_766_691_012_7, 0.787_930_529_253_156_4, 1.119_161_902_535_781_7]),
        (3.0, [0.881_008_749_962_819_4, 0.465_381_816_153_373_43, 1.629_646_442_419_551]),
        (7.0, [0.979_353_402_905_876_4, 0.198_285_569_248_179_6, 3.555_251_376_490_178_7]),
    ];
    for (speed, right) in cases {
        // a limp one has a direction at its tip all the same
        for section in ["ei = 0", "ei = 1e-5"] {
            let h = hanging(speed, 32, section);
            let found = tip(&h);
            println!("{speed}, {section}: {found:?} {right:?}");
            for (found, right) in found.into_iter().zip(right) {
                assert!((found - right).abs() < 2e-4, "{speed}, {section}: {found} instead of {right}");
            }
            assert_eq!(turns(&h), right[0] > 0.0, "{speed}, {section}: {:?}", h.warnings);
            assert_eq!(h.warnings.len(), usize::from(turns(&h)), "{:?}", h.warnings);
        }
    }
}
