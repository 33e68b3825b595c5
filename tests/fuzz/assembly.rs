//! Random assemblies of cables, bodies, chains, joints and forces, as texts of scenes. Most of them make sense.

use super::random::Rng;
use std::fmt::Write;

/// A part that others can be joined to.
struct Part {
    start: String,
    end: String,
    at: [[f64; 3]; 2],
    kind: &'static str,
}

fn list(x: [f64; 3]) -> String {
    format!("[{:.4}, {:.4}, {:.4}]", x[0], x[1], x[2])
}

/// The text of a scene.
pub fn scene(rng: &mut Rng) -> String {
    let mut text = "[run]\nduration = 1.0\n\n".to_string();
    solver(rng, &mut text);
    let water = rng.chance(0.4);
    if water {
        text += "[water]\n";
        if rng.chance(0.5) {
            _ = writeln!(text, "current = {}", list(rng.vector(1.0)));
        }
        text.push('\n');
    }
    let mut parts: Vec<Part> = Vec::new();
    for k in 0..=rng.below(4) {
        part(rng, &mut text, k, water, &mut parts);
    }
    if rng.chance(0.85) {
        hold(rng, &mut text, &parts[0]);
    }
    if rng.chance(0.15) {
        closing(rng, &mut text, &parts);
    }
    forces(rng, &mut text, &parts, water);
    if rng.chance(0.35) {
        inputs(rng, &mut text, &parts);
    }
    // now and then, one number is out of all proportion
    if rng.chance(0.15) {
        let odd = rng.pick(&["0", "-1", "1e-12", "1e12", "1e300", "nan", "1e-300", "1e9"]);
        let digits: Vec<usize> = text.match_indices(" = ").map(|(k, _)| k + 3).collect();
        let from = digits[rng.below(digits.len())];
        let length = text[from..].find('\n').unwrap_or(text.len() - from);
        // the number of elements is the one thing that may make a scene too large for a test
        let line = &text[text[..from].rfind('\n').map_or(0, |k| k + 1)..from];
        if text.as_bytes()[from].is_ascii_digit()
            && !(line.starts_with("elements") || line.starts_with("links"))
        {
            text.replace_range(from..from + length, odd);
        }
    }
    text
}

fn solver(rng: &mut Rng, text: &mut String) {
    let h = rng.log(1e-5, 0.1);
    let stepping = match rng.below(3) {
        0 => format!("{{ fixed = {{ h = {h:.3e} }} }}"),
        _ => format!("{{ controlled = {{ tolerance = {:.1e} }} }}", rng.log(1e-7, 1e-2)),
    };
    let scheme = match rng.below(6) {
        0 => "\"radau-iia-5\"".to_string(),
        1 => format!("{{ hht = {{ alpha = {:.2} }} }}", rng.between(-0.3, -0.02)),
        _ => format!("{{ generalized-alpha = {{ rho_inf = {:.2} }} }}", rng.between(0.0, 0.95)),
    };
    let ggl = if rng.chance(0.15) && !scheme.contains("radau") { "constraints = \"ggl\"\n" } else { "" };
    _ = writeln!(text, "[solver]\nstepping = {stepping}\nscheme = {scheme}\n{ggl}");
}

fn part(rng: &mut Rng, text: &mut String, k: usize, water: bool, parts: &mut Vec<Part>) {
    let name = format!("part{k}");
    let last = parts.last().map(|p| (p.end.clone(), p.at[1], p.kind));
    let size = rng.log(0.1, 30.0);
    let joined = last.is_some() && rng.chance(0.8);
    let start = match &last {
        Some((_, at, _)) if joined => *at,
        _ => rng.vector(5.0),
    };
    let way = rng.vector(1.0);
    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-3);
    let end: [f64; 3] = std::array::from_fn(|i| start[i] + size * way[i] / length);
    let mut new =
        Part { start: format!("{name}.start"), end: format!("{name}.end"), at: [start, end], kind: "cable" };
    match rng.below(10) {
        0..=4 => {
            let mass = rng.log(1e-3, 10.0);
            let ea = rng.log(10.0, 1e8);
            let ei = if rng.chance(0.3) { 0.0 } else { ea * rng.log(1e-9, 1e-3) };
            _ = write!(
                text,
                "[[elements]]\ntype = \"cable\"\nname = \"{name}\"\npoints = [{}, {}]\nelements = {}\n",
                list(start),
                list(end),
                1 + rng.below(10)
            );
            _ = write!(text, "section = {{ mass = {mass:.4e}, ea = {ea:.4e}, ei = {ei:.4e}");
            if water || rng.chance(0.4) {
                _ = write!(text, ", diameter = {:.4e}", rng.log(1e-3, 0.1));
            }
            if rng.chance(0.4) {
                _ = write!(
                    text,
                    ", axial_retardation_time = {0:.2e}, bending_retardation_time = {0:.2e}",
                    rng.log(1e-5, 0.1)
                );
            }
            text.push_str(" }\n");
            if rng.chance(0.3) {
                let models =
                    rng.pick(&["L1 T1", "L1n T1", "L2 T1", "L3 T1", "L3 T2", "L4 T2", "L3 T3", "L4 T3"]);
                let (l, t) = models.split_at(models.len() - 2);
                _ = writeln!(text, "longitudinal = \"{}\"\ntransverse = \"{t}\"", l.trim());
            }
            if rng.chance(0.2) {
                _ = writeln!(text, "strain = {:.2e}", rng.between(-0.02, 0.02));
            }
        }
        5..=6 => {
            let (mass, inertia) = (rng.log(1e-2, 1e3), rng.between(1.0, 2.0));
            let j = mass * size * size / 12.0;
            _ = write!(
                text,
                "[[elements]]\ntype = \"rigid_body\"\nname = \"{name}\"\nposition = {}\nmass = {mass:.4e}\n\
                 inertia = [{:.4e}, {j:.4e}, {:.4e}]\nangles = {}\npoints = {{ end = {} }}\n",
                list(start),
                j * rng.between(0.02, 1.0),
                j * inertia.min(1.02),
                list([0.0; 3]),
                list(std::array::from_fn(|i| end[i] - start[i])),
            );
            if rng.chance(0.3) && parts.is_empty() {
                _ = writeln!(text, "angular_velocity = {}", list(rng.vector(3.0)));
            }
            new.start = name.clone();
            new.kind = "body";
        }
        7..=8 => {
            _ = write!(
                text,
                "[[elements]]\ntype = \"point_mass\"\nname = \"{name}\"\nmass = {:.4e}\nmarker = ",
                rng.log(1e-3, 1e4)
            );
            match &last {
                // a mass on a cable is part of its node
                Some((marker, at, "cable")) if joined => {
                    _ = write!(text, "\"{marker}\"\n\n");
                    new = Part { start: marker.clone(), end: marker.clone(), at: [*at, *at], kind: "cable" };
                    parts.push(new);
                    return;
                }
                _ => {
                    _ = writeln!(text, "{}", list(start));
                    new = Part { start: name.clone(), end: name.clone(), at: [start, start], kind: "mass" };
                }
            }
        }
        _ => {
            _ = write!(
                text,
                "[[elements]]\ntype = \"rigid_chain\"\nname = \"{name}\"\npoints = [{}, {}]\nlinks = {}\n\
                 section = {{ mass = {:.4e}, diameter = {:.4e} }}\n",
                list(start),
                list(end),
                1 + rng.below(6),
                rng.log(1e-2, 10.0),
                rng.log(1e-3, 0.1),
            );
            new.kind = "chain";
        }
    }
    text.push('\n');
    if let (true, Some((marker, _, kind))) = (joined, &last) {
        join(rng, text, &format!("joint{k}"), &new.start, marker, kind, new.kind);
    }
    parts.push(new);
}

fn join(rng: &mut Rng, text: &mut String, name: &str, marker: &str, to: &str, one: &str, other: &str) {
    let axis = list(rng.vector(1.0));
    let both = one == "body" && other == "body";
    let kind = match rng.below(5) {
        0 if both => "weld",
        1 if both => "revolute",
        2 if both => "prismatic",
        _ => "spherical",
    };
    _ = write!(
        text,
        "[[constraints]]\ntype = \"{kind}\"\nname = \"{name}\"\nmarker = \"{marker}\"\nto = \"{to}\"\n"
    );
    if kind == "revolute" || kind == "prismatic" {
        _ = writeln!(text, "axis = {axis}");
    }
    text.push('\n');
}

/// Holds the first part in space.
fn hold(rng: &mut Rng, text: &mut String, part: &Part) {
    let marker = &part.start;
    let axis = list(rng.vector(1.0));
    let kinds: &[&str] = match part.kind {
        "body" => &["spherical", "revolute", "prismatic", "weld", "point_on_line", "cylindrical"],
        "cable" => &["spherical", "clamped", "winch", "point_on_line"],
        _ => &["spherical", "point_on_line"],
    };
    let kind = rng.pick(kinds);
    let one = |text: &mut String, kind: &str, more: &str| {
        _ = write!(
            text,
            "[[constraints]]\ntype = \"{kind}\"\nname = \"{kind}\"\nmarker = \"{marker}\"\n{more}\n"
        );
    };
    match kind {
        "clamped" => {
            one(text, "spherical", "");
            one(text, "direction", "");
        }
        "winch" => {
            one(text, "spherical", "");
            let speed = rng.between(-0.5, 2.0);
            one(text, "winch", &format!("speed = {speed:.3}\nramp = {:.3}\n", rng.log(0.01, 1.0)));
        }
        "spherical" | "weld" => one(text, kind, ""),
        _ => one(text, kind, &format!("axis = {axis}\n")),
    }
}

/// A joint between any two parts, which may contradict everything.
fn closing(rng: &mut Rng, text: &mut String, parts: &[Part]) {
    let (a, b) = (&parts[rng.below(parts.len())], &parts[rng.below(parts.len())]);
    let kind = rng.pick(&["spherical", "weld", "revolute", "distance", "universal", "prismatic"]);
    _ = write!(
        text,
        "[[constraints]]\ntype = \"{kind}\"\nname = \"closing\"\nmarker = \"{}\"\nto = \"{}\"\n",
        a.end, b.start
    );
    if kind == "revolute" || kind == "prismatic" {
        _ = writeln!(text, "axis = {}", list(rng.vector(1.0)));
    }
    text.push('\n');
}

fn forces(rng: &mut Rng, text: &mut String, parts: &[Part], water: bool) {
    if rng.chance(0.8) {
        text.push_str("[[forces]]\ntype = \"gravity\"\n\n");
    }
    if water && parts.iter().any(|p| p.kind == "cable") {
        for (kind, p) in [("buoyancy", 0.7), ("drag", 0.7), ("added_mass", 0.5)] {
            if rng.chance(p) {
                _ = write!(text, "[[forces]]\ntype = \"{kind}\"\n\n");
            }
        }
    }
    let end = parts[rng.below(parts.len())].end.clone();
    let start = parts[rng.below(parts.len())].start.clone();
    if rng.chance(0.3) {
        let size = rng.log(0.1, 1e4);
        _ = write!(
            text,
            "[[forces]]\ntype = \"point_force\"\nmarker = \"{end}\"\nforce = {}\n\n",
            list(rng.vector(size))
        );
    }
    if rng.chance(0.3) {
        _ = write!(
            text,
            "[[forces]]\ntype = \"spring\"\nname = \"spring\"\nmarker = \"{end}\"\nto = {}\nstiffness = {:.3e}\n\
             damping = {:.3e}\n\n",
            if rng.chance(0.5) { format!("\"{start}\"") } else { list(rng.vector(5.0)) },
            rng.log(1e-2, 1e7),
            rng.log(1e-3, 1e2)
        );
    }
    if rng.chance(0.25) && cfg!(feature = "contact") {
        let height = rng.between(-40.0, 3.0);
        let stiffness = rng.log(1e3, 1e6);
        let friction = if rng.chance(0.5) { "friction = 0.3\n" } else { "" };
        _ = write!(
            text,
            "[[forces]]\ntype = \"contact\"\nname = \"floor\"\nshape = {{ plane = {{}} }}\nmarker = [0, 0, {height:.3}]\nradius = 0.01\n\
             stiffness = {stiffness:.2e}\nstiffness_per_length = {stiffness:.2e}\n{friction}\n"
        );
    }
}

/// Something that reads an input, and a controller that sets it.
fn inputs(rng: &mut Rng, text: &mut String, parts: &[Part]) {
    let end = &parts[rng.below(parts.len())].end;
    let (name, size) = ("u", rng.log(1e-2, 1e3));
    let join = rng.pick(&["hold", "linear", "smooth"]);
    let (unit, reads) = match rng.below(5) {
        0 | 1 => {
            let force = "force = [{ input = \"u\" }, 0, 1]";
            ("N", format!("[[forces]]\ntype = \"point_force\"\nmarker = \"{end}\"\n{force}\n\n"))
        }
        2 => {
            let spring = "stiffness = { input = \"u\" }\ndamping = 1";
            let to = list(rng.vector(5.0));
            (
                "N/m",
                format!(
                    "[[forces]]\ntype = \"spring\"\nname = \"set\"\nmarker = \"{end}\"\nto = {to}\n{spring}\n\n"
                ),
            )
        }
        3 => {
            let winch = "speed = { input = \"u\" }";
            (
                "m/s",
                format!(
                    "[[constraints]]\ntype = \"winch\"\nname = \"reel\"\nmarker = \"{end}\"\n{winch}\n\n"
                ),
            )
        }
        _ => {
            let swing = "amplitude = [{ input = \"u\" }, 0, 0]\nfrequency = 0.7\nramp = 0.5";
            let drive = format!(
                "[[constraints]]\ntype = \"driving\"\nname = \"shaken\"\nmarker = \"{end}\"\nmotion = \"sway\"\n"
            );
            ("m", format!("[[motions]]\ntype = \"harmonic\"\nname = \"sway\"\n{swing}\n{drive}\n"))
        }
    };
    let least = if unit == "N/m" || rng.chance(0.3) { 0.0 } else { -size };
    _ = write!(
        text,
        "[[inputs]]\nname = \"{name}\"\nunit = \"{unit}\"\njoin = \"{join}\"\nmin = {least:.3e}\nmax = {size:.3e}\n\n{reads}"
    );
    let every = rng.log(1e-3, 0.5);
    let control = match rng.below(3) {
        0 => format!(
            "type = \"expression\"\nvalue = \"{size:.3e} {unit} * sin({:.2} * t / 1 s)\"",
            rng.log(0.1, 50.0)
        ),
        1 => format!(
            "type = \"pid\"\nmeasures = \"seen.x\"\nsetpoint = 0\nkp = \"{:.3e} {unit} / 1 m\"\nki = \"{:.3e} {unit} / 1 m / 1 s\"",
            -rng.log(1e-3, 1e3),
            rng.log(1e-3, 1e3)
        ),
        _ => format!(
            "type = \"table\"\nover = \"t\"\nat = [0, 0.3, 0.6]\nvalue = [0, {size:.3e}, {least:.3e}]"
        ),
    };
    _ = write!(
        text,
        "[[records]]\ntype = \"position\"\nname = \"seen\"\nof = \"{end}\"\n\n[[controllers]]\n{control}\ninput = \"{name}\"\n\
         every = {every:.3e}\n\n"
    );
}
