//! A tackle of many falls, one element each, as tests and benches hoist it.

use std::fmt::Write as _;

/// A hook block of 2 t on falls of 1.5 kg/m, hoisted by a drum from 4 m up.
pub struct Hoist<'a> {
    /// Number of falls, even.
    pub falls: usize,
    /// What resists at the sheaves, in their section of the scene.
    pub wheel: &'a str,
    /// Speed of the block [m/s], and how long it takes to get there [s], half a second after the start.
    pub speed: f64,
    pub ramp: f64,
    /// Height of the upper sheaves [m].
    pub head: f64,
    /// How long it runs [s], and every when it records.
    pub duration: f64,
    pub output: f64,
    /// Whether the block runs on a vertical rail, so that it can't swing.
    pub guided: bool,
    /// More of the scene.
    pub more: &'a str,
}

impl Default for Hoist<'_> {
    fn default() -> Self {
        Hoist {
            falls: 12,
            wheel: "",
            speed: 0.3,
            ramp: 1.0,
            head: 12.0,
            duration: 6.0,
            output: 0.1,
            guided: false,
            more: "",
        }
    }
}

const RAIL: &str = r#"
        [[constraints]]
        type = "prismatic"
        name = "rail"
        marker = "block"
        to = [0, 0, 0]
        axis = [0, 0, 1]"#;

impl Hoist<'_> {
    /// The scene.
    pub fn text(&self) -> String {
        let Hoist { falls, wheel, ramp, head, duration, output, more, .. } = self;
        let wheels = falls / 2;
        let mut route = String::from("{ wound = \"drum\" }");
        for k in 1..=wheels {
            let _ = write!(route, ", {{ over = \"head.{k}\" }}, {{ under = \"blocks.{k}\" }}");
        }
        let spacing = 0.06;
        let side = 0.5 * spacing * (wheels as f64 - 1.0);
        let tension = 2300.0 * 9.81 / *falls as f64;
        let rail = if self.guided { RAIL } else { "" };
        format!(
            r#"
        run = {{ duration = {duration}, output = {output}, from_equilibrium = true }}
        [[elements]]
        type = "rigid_body"
        name = "block"
        position = [0, 0, 4]
        mass = 2000
        inertia = [200, 200, 100]
        centre = [0, 0, -0.6]
        [[elements]]
        type = "cable"
        name = "hoist"
        section = {{ mass = 1.5, ea = "15 MN", axial_retardation_time = "2 ms" }}
        elements = 1
        tension = {tension}
        route = [{route}, {{ end = [-0.25, {side}, {head}] }}]
        [[constraints]]
        type = "drum"
        name = "drum"
        marker = [-6, {}, 2]
        axis = [0, 1, 0]
        radius = 0.3
        speed = {}
        start = 0.5
        ramp = {ramp}
        wound_tension = {tension}
        [[constraints]]
        type = "spherical"
        name = "dead_end"
        marker = "hoist.end"
        [[constraints]]
        type = "sheave"
        name = "head"
        marker = [0, 0, {head}]
        axis = [0, 1, 0]
        radius = 0.25
        count = {wheels}
        spacing = {spacing}
        {wheel}
        [[constraints]]
        type = "sheave"
        name = "blocks"
        marker = "block"
        axis = [0, 1, 0]
        radius = 0.25
        count = {wheels}
        spacing = {spacing}
        {wheel}{rail}
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "block"
        [[records]]
        type = "drum"
        of = "drum"
        [[records]]
        type = "sheave"
        of = "head.1"
        [[records]]
        type = "energy"
        {more}
        "#,
            -side,
            -self.speed * *falls as f64,
        )
    }
}
