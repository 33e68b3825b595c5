//! The surface of the water: what floats, what crosses it, and the air above.

use ropewalk::scene::Format;
use ropewalk::{History, ModesOptions, SceneFile, modes, simulate};
use std::f64::consts::{PI, TAU};

fn scene(text: &str) -> SceneFile {
    SceneFile::parse(text, "afloat", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"))
}

fn run(text: &str) -> History {
    simulate(scene(text).scene()).unwrap_or_else(|e| panic!("{e}"))
}

fn refused(text: &str) -> String {
    match SceneFile::parse(text, "afloat", Format::Toml, &[]) {
        Err(e) => e.to_string(),
        Ok(file) => file.build().err().expect("is refused").to_string(),
    }
}

fn frequencies(text: &str) -> Vec<f64> {
    let options = ModesOptions { count: 6, ..ModesOptions::default() };
    let found = modes(scene(text).scene(), &options).unwrap_or_else(|e| panic!("{e}"));
    found.modes.iter().map(|m| m.frequency()).collect()
}

fn near(all: &[f64], wanted: f64, tolerance: f64, what: &str) {
    let best = all.iter().map(|f| (f / wanted - 1.0).abs()).fold(f64::INFINITY, f64::min);
    println!("{what}: {wanted:.6} Hz, off by {best:.1e}");
    assert!(best < tolerance, "{what}: {wanted} Hz isn't among {all:?}");
}

const WEIGHT: &str = "[[forces]]\ntype = \"gravity\"\n[[forces]]\ntype = \"buoyancy\"\n";

/// A buoy released under water comes up, and floats with the share of its volume that carries it.
#[test]
fn a_buoy_floats() {
    let buoy = |level: &str| {
        format!(
            r#"
            [run]
            duration = "40 s"
            output = "0.5 s"
            [water]
            {level}
            [[elements]]
            type = "point_mass"
            name = "buoy"
            marker = [0, 0, -10]
            mass = 100
            volume = 0.2
            added_mass = 50
            drag_area = 0.5
            {WEIGHT}
            [[forces]]
            type = "spring"
            name = "leash"
            marker = "buoy"
            to = [0, 0, -20]
            stiffness = 0
            damping = 300
            [[records]]
            type = "position"
            of = "buoy"
            [[records]]
            type = "energy"
            "#
        )
    };
    let h = run(&buoy("level = 0"));
    let radius = f64::cbrt(0.75 * 0.2 / PI);
    let u = -h.last("buoy.z").expect("a row") / radius;
    let share = 0.5 + 0.75 * u - 0.25 * u.powi(3);
    assert!((share - 100.0 / (1025.0 * 0.2)).abs() < 1e-4, "{share}");
    assert!(h.last("energy.imbalance").expect("energy").abs() < 1e-2 * 9.81 * 100.0);
    assert!(h.warnings.is_empty(), "{:?}", h.warnings);
    // water that is everywhere says so where it matters
    let h = run(&buoy(""));
    assert!(h.last("buoy.z").expect("a row") > 10.0);
    let said = h.warnings.iter().find(|w| w.contains("`buoy` rises above z = 0")).expect("a warning");
    assert!(said.contains("level = 0"), "{said}");
}

/// A cylinder of 4 m and 0.5 m, its centre of mass 0.8 m below its middle.
fn spar(angle: f64, more: &str) -> String {
    format!(
        r#"
        [water]
        density = 1000
        level = 0.5
        [[elements]]
        type = "rigid_body"
        name = "spar"
        position = [0, 0, 0]
        angles = [0, {angle}, 0]
        mass = {SPAR}
        inertia = [300, 300, 20]
        centre = [0, 0, -0.8]
        volume = {}
        hull = {{ from = [0, 0, -2], to = [0, 0, 2], diameter = 0.5 }}
        {WEIGHT}
        {more}
        "#,
        PI * 0.0625 * 4.0,
    )
}
const SPAR: f64 = 500.0;

/// A limp line as heavy as the water stays where it is: what lifts its slopes comes of whole elements.
#[test]
fn a_neutral_line_stays() {
    let mass = 1025.0 * PI * 1e-4;
    let h = run(&format!(
        r#"
        [run]
        duration = "20 s"
        [water]
        level = 0
        [[elements]]
        type = "cable"
        name = "line"
        points = [[0, 0, -5], [3, 0, -9]]
        elements = 10
        section = {{ mass = {mass}, ea = "50 kN", diameter = "20 mm", axial_retardation_time = "0.4 ms" }}
        [[constraints]]
        type = "spherical"
        name = "hook"
        marker = "line.start"
        {WEIGHT}
        [[forces]]
        type = "drag"
        [[records]]
        type = "position"
        of = "line.end"
        "#
    ));
    let end = [h.last("line.end.x").expect("a row"), h.last("line.end.z").expect("a row")];
    assert!((end[0] - 3.0).hypot(end[1] + 9.0) < 1e-6, "{end:?}");
}

/// A pole made of a cable floats upright with the draught of its weight, wherever the surface cuts its elements.
#[test]
fn a_pole_has_the_draught_of_its_weight() {
    let area = PI * 0.0025;
    for draught in [2.1, 2.35, 2.6, 2.85] {
        let ballast = 1000.0 * area * draught - 3.0 * 4.0;
        let h = run(&format!(
            r#"
            [run]
            analysis = "statics"
            [water]
            density = 1000
            level = 0
            [[elements]]
            type = "cable"
            name = "pole"
            points = [[0, 0, -2.5], [0, 0, 1.5]]
            elements = 4
            section = {{ mass = 3, ea = "1 GN", ei = "1 MN m^2", diameter = 0.1 }}
            [[elements]]
            type = "point_mass"
            name = "ballast"
            marker = "pole.start"
            mass = {ballast}
            [[constraints]]
            type = "point_on_line"
            name = "lower"
            marker = "pole.start"
            axis = [0, 0, 1]
            to = [0, 0, 0]
            [[constraints]]
            type = "point_on_line"
            name = "upper"
            marker = "pole.end"
            axis = [0, 0, 1]
            to = [0, 0, 0]
            {WEIGHT}
            [[records]]
            type = "position"
            of = "pole.start"
            "#
        ));
        let found = -h.last("pole.start.z").expect("a row");
        println!("draught {found:.6} for {draught}");
        assert!((found - draught).abs() < 2e-3, "{found} for {draught}");
    }
}

/// Upright: draught, heave and pitch by the waterplane and the metacentric height.
#[test]
fn an_upright_cylinder_floats_as_in_the_books() {
    let area = PI * 0.0625;
    let draught = SPAR / (1000.0 * area);
    let h = run(&spar(
        0.0,
        "[run]\nanalysis = \"statics\"\n[[records]]\ntype = \"position\"\nof = \"spar.com\"\n\
         [[constraints]]\ntype = \"point_on_line\"\nname = \"guide\"\nmarker = \"spar.com\"\naxis = [0, 0, 1]\nto = [0, 0, 0]\n",
    ));
    let com = h.last("spar.com.z").expect("a row");
    // the keel is 1.2 m below the centre of mass
    let found = 0.5 - (com - 1.2);
    println!("draught {found:.9} for {draught:.9}");
    assert!((found - draught).abs() < 1e-8, "{found} for {draught}");

    let heave = (1000.0 * 9.81 * area / SPAR).sqrt() / TAU;
    let (kb, bm, kg) = (0.5 * draught, (PI / 4.0 * 0.25f64.powi(4)) / (area * draught), 1.2);
    let pitch = (SPAR * 9.81 * (kb + bm - kg) / 300.0).sqrt() / TAU;
    let all = frequencies(
        &spar(0.0, "").replace("position = [0, 0, 0]", &format!("position = [0, 0, {}]", com + 0.8)),
    );
    near(&all, heave, 1e-6, "heave");
    near(&all, pitch, 1e-4, "pitch");
}

/// Lying: draught of the circular segment, heave by its chord.
#[test]
fn a_lying_cylinder_floats_as_in_the_books() {
    let (radius, length, mass) = (0.25, 4.0, 500.0);
    // area of the segment below the surface
    let wanted = mass / (1000.0 * length);
    let segment = |u: f64| radius * radius * ((-u).acos() + u * (1.0 - u * u).sqrt());
    let (mut low, mut high) = (-1.0, 1.0);
    for _ in 0..80 {
        let mid = 0.5 * (low + high);
        if segment(mid) < wanted { low = mid } else { high = mid }
    }
    let (u, volume) = (low, PI * radius * radius * length);
    let log = |z: f64, more: &str| {
        format!(
            r#"
            [water]
            density = 1000
            level = 0.5
            [[elements]]
            type = "rigid_body"
            name = "log"
            position = [0, 0, {z}]
            mass = {mass}
            inertia = [20, 300, 300]
            volume = {volume}
            hull = {{ from = [-2, 0, 0], to = [2, 0, 0], diameter = 0.5 }}
            {WEIGHT}
            {more}
            "#
        )
    };
    let settled = 0.5 - u * radius;
    let h = run(&log(
        settled - 0.05,
        "[run]\nanalysis = \"statics\"\n[[records]]\ntype = \"position\"\nof = \"log\"\n\
         [[constraints]]\ntype = \"prismatic\"\nname = \"guide\"\nmarker = \"log\"\naxis = [0, 0, 1]\nto = [0, 0, 0]\n",
    ));
    let z = h.last("log.z").expect("a row");
    assert!((z - settled).abs() < 1e-8, "{z} for {settled}");
    let chord = 2.0 * radius * (1.0 - u * u).sqrt();
    let heave = (1000.0 * 9.81 * chord * length / mass).sqrt() / TAU;
    // the middle of what is wet lies below the axis, where the centre of mass is
    let below = 2.0 / 3.0 * (0.5 * chord).powi(3) / wanted;
    let righting = 1000.0 * 9.81 * chord * length.powi(3) / 12.0 - mass * 9.81 * below;
    let pitch = (righting / 300.0).sqrt() / TAU;
    let all = frequencies(&log(settled, ""));
    near(&all, heave, 1e-6, "heave of a log");
    near(&all, pitch, 1e-4, "pitch of a log");
}

/// A cable drawn up through the surface keeps its balance of energy, ever better with smaller steps.
#[test]
fn a_cable_that_is_drawn_through_the_surface_keeps_its_balance() {
    for theory in ["energy", "morison"] {
        let left = |h: f64| {
            let h = run(&format!(
                r#"
                [run]
                duration = "2 s"
                output = "0.1 s"
                [solver]
                stepping = {{ fixed = {{ h = {h} }} }}
                newton_tolerance = 1e-3
                [water]
                density = 1000
                level = 0
                current = [0.5, 0, 0]
                [[elements]]
                type = "cable"
                name = "cable"
                points = [[0, 0, 0.2], [2, 0, -2]]
                elements = 12
                section = {{ mass = 2.0, ea = 2e3, ei = 5, diameter = 0.05 }}
                {WEIGHT}
                [[forces]]
                type = "drag"
                [[forces]]
                type = "added_mass"
                theory = "{theory}"
                [[motions]]
                type = "table"
                name = "up"
                t = [0, 0.5, 1, 1.5, 2]
                z = [0, 0.15, 0.6, 1.35, 2.4]
                [[constraints]]
                type = "driving"
                name = "lift"
                marker = "cable.start"
                motion = "up"
                [[records]]
                type = "energy"
                "#
            ));
            let imbalance = h.column("energy.imbalance").expect("energy");
            imbalance.iter().fold(0.0, |most: f64, x| if x.is_nan() { x.abs() } else { most.max(x.abs()) })
        };
        let (coarse, fine) = (left(2e-3), left(1e-3));
        println!("{theory}: imbalance {coarse:.3e} and {fine:.3e} J");
        assert!(coarse < 0.05 && coarse / fine > 3.0, "{theory}: {coarse} J, {fine} J");
    }
}

/// Wind on a mast: drag of the air above the water alone.
#[test]
fn wind_blows_above_the_surface_alone() {
    let mast = |more: &str| {
        let text = format!(
            r#"
            {more}
            [[elements]]
            type = "rigid_body"
            name = "mast"
            position = [0, 0, 0]
            mass = 100
            inertia = [10, 10, 1]
            hull = {{ from = [0, 0, -1], to = [0, 0, 3], diameter = 0.2 }}
            [[constraints]]
            type = "weld"
            name = "foot"
            marker = "mast"
            to = [0, 0, 0]
            [[forces]]
            type = "drag"
            cn = 1.1
            [[records]]
            type = "reaction"
            of = "foot"
            [run]
            duration = 1
            "#
        );
        run(&text).last("foot.fx").expect("a reaction").abs()
    };
    let per_metre = |density: f64, speed: f64| 0.5 * density * 0.2 * 1.1 * speed * speed;
    let dry = mast("[air]\ndensity = 1.2\nwind = [20, 0, 0]");
    assert!((dry - 4.0 * per_metre(1.2, 20.0)).abs() < 1e-3 * dry, "{dry}");
    let both = mast(
        "[air]\ndensity = 1.2\nwind = [20, 0, 0]\n[water]\ndensity = 1000\nlevel = 0\ncurrent = [0.5, 0, 0]",
    );
    let right = 3.0 * per_metre(1.2, 20.0) + per_metre(1000.0, 0.5);
    assert!((both - right).abs() < 2e-3 * right, "{both} for {right}");
}

/// A hull in a flow along it, across it, and turning: its ends, its side and its skin each take their share.
#[test]
fn a_hull_has_the_drag_of_its_faces_its_side_and_its_skin() {
    let (length, diameter, density) = (3.0, 0.4, 1000.0);
    let held = |current: &str, drag: &str| {
        let text = format!(
            r#"
            [run]
            duration = 1
            [water]
            density = {density}
            current = {current}
            [[elements]]
            type = "rigid_body"
            name = "hull"
            position = [0, 0, 0]
            mass = 100
            inertia = [10, 10, 1]
            hull = {{ from = [0, 0.5, -1], to = [0, 0.5, 2], diameter = {diameter} }}
            [[constraints]]
            type = "weld"
            name = "stand"
            marker = "hull"
            to = [0, 0, 0]
            [[forces]]
            type = "drag"
            {drag}
            [[records]]
            type = "reaction"
            of = "stand"
            "#
        );
        let h = run(&text);
        ["fx", "fy", "fz"].map(|c| -h.last(&format!("stand.{c}")).expect("a reaction"))
    };
    let face = PI / 4.0 * diameter * diameter;
    let [_, _, ends] = held("[0, 0, 2]", "ct = 0\nend = 0.4");
    assert!((ends - 2.0 * 0.5 * density * 0.4 * face * 4.0).abs() < 1e-6 * ends, "{ends} N");
    let [_, _, skin] = held("[0, 0, 2]", "ct = 0.004");
    assert!((skin - 0.5 * density * 0.004 * PI * diameter * length * 4.0).abs() < 1e-6 * skin, "{skin} N");
    let [side, _, along] = held("[2, 0, 0]", "cn = 1.1\nct = 0.004\nend = 0.4");
    assert!((side - 0.5 * density * 1.1 * diameter * length * 4.0).abs() < 1e-6 * side, "{side} N");
    assert!(along.abs() < 1e-9, "{along} N");
}

#[test]
fn what_makes_no_sense_is_refused() {
    let ball =
        "[[elements]]\ntype = \"point_mass\"\nname = \"b\"\nmarker = [0, 0, 0]\nmass = 1\nvolume = 1\n";
    let tilted = refused(&format!("gravity = [1, 0, -9]\n[water]\nlevel = 0\n{ball}{WEIGHT}"));
    assert!(tilted.contains("make it point down"), "{tilted}");
    let air = refused(&format!("[water]\n[air]\n{ball}{WEIGHT}"));
    assert!(air.contains("no air"), "{air}");
    let level = refused(&format!("[water]\nlevel = nan\n{ball}{WEIGHT}"));
    assert!(level.contains("level"), "{level}");
    let beside = refused(&spar(0.0, "").replace("volume = ", "centre_of_volume = [0, 0, 0.5]\nvolume = "));
    assert!(beside.contains("centre_of_volume"), "{beside}");
}
