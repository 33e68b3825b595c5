//! The effects of a scene: those that it has, and those that it could have.

use ropewalk_scene::{Analysis, ConstraintSpec, ElementSpec, ForceSpec, Scene, registered};
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::sync::Arc;

/// A change of a scene.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Edit {
    /// A force less.
    DropForce(usize),
    /// A constraint less.
    DropConstraint(usize),
    /// Water at rest.
    StillWater,
    /// Water everywhere, and so no air.
    NoSurface,
    /// Still water.
    NoWaves,
    /// No air.
    NoAir,
    /// No balance of energy.
    NoAudit,
    /// A field of an element, by pointer, with another value.
    Element(usize, String, Value),
    /// An element with all of its fields anew.
    Replace(usize, Value),
    /// Fields of a force with other values.
    Force(usize, Value),
    /// A force more.
    AddForce(Value),
}

/// An effect that is tried: with it if the scene lacks it, without it if the scene has it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Candidate {
    pub name: String,
    /// What the scene is changed by.
    pub edits: Vec<Edit>,
    /// What was assumed.
    pub note: String,
}

/// An effect that can't be guessed from the scene, and what to write to try it.
pub(super) type Hint = (String, String);

/// Fields of elements, or of their sections, that are an effect each; 0 switches it off.
const FIELDS: [(&str, &str); 11] = [
    ("ei", "bending"),
    ("axial_retardation_time", "damping of stretching"),
    ("bending_retardation_time", "damping of bending"),
    ("torsional_retardation_time", "damping of torsion"),
    ("torque_tension", "torque by tension"),
    ("laid_twist", "twist as laid"),
    ("joint_damping", "damping of joints"),
    ("flooded", "water inside"),
    ("added_mass", "added mass"),
    ("drag_area", "drag"),
    ("strain", "strain at rest"),
];

/// A scene with these changes.
///
/// # Errors
/// A spec that can't be written and read again with the change.
pub(super) fn edited(scene: &Scene, edits: &[Edit]) -> Result<Scene, String> {
    let mut new = scene.clone();
    let (mut forces, mut constraints) = (Vec::new(), Vec::new());
    let read_force = |v: Value| serde_json::from_value::<Box<dyn ForceSpec>>(v).map_err(|e| e.to_string());
    for edit in edits {
        match edit {
            Edit::DropForce(k) => forces.push(*k),
            Edit::DropConstraint(k) => constraints.push(*k),
            Edit::StillWater => {
                if let Some(water) = &mut new.water {
                    water.current = [0.0; 3].map(Into::into);
                    water.profile.clear();
                }
            }
            Edit::NoSurface => {
                new.air = None;
                if let Some(water) = &mut new.water {
                    (water.level, water.waves) = (None, None);
                }
            }
            Edit::NoWaves => {
                if let Some(water) = &mut new.water {
                    water.waves = None;
                }
            }
            Edit::NoAir => new.air = None,
            Edit::NoAudit => new.run.audit = false,
            Edit::Element(k, at, value) => {
                let mut spec = serde_json::to_value(&*new.elements[*k]).map_err(|e| e.to_string())?;
                let fields = inner(&mut spec).ok_or("not a table")?;
                *fields.pointer_mut(at).ok_or("no such field")? = value.clone();
                let spec: Box<dyn ElementSpec> = serde_json::from_value(spec).map_err(|e| e.to_string())?;
                new.elements[*k] = spec.into();
            }
            Edit::Replace(k, fields) => {
                let mut spec = serde_json::to_value(&*new.elements[*k]).map_err(|e| e.to_string())?;
                *inner(&mut spec).ok_or("not a table")? = fields.clone();
                let spec: Box<dyn ElementSpec> = serde_json::from_value(spec).map_err(|e| e.to_string())?;
                new.elements[*k] = spec.into();
            }
            Edit::Force(k, values) => {
                let mut spec = serde_json::to_value(&*new.forces[*k]).map_err(|e| e.to_string())?;
                let fields = inner(&mut spec).ok_or("not a table")?;
                for (name, value) in values.as_object().into_iter().flatten() {
                    fields[name] = value.clone();
                }
                new.forces[*k] = read_force(spec)?.into();
            }
            Edit::AddForce(spec) => new.forces.push(read_force(spec.clone())?.into()),
        }
    }
    let keep = |gone: &[usize], k: &mut usize| {
        *k += 1;
        !gone.contains(&(*k - 1))
    };
    let mut k = 0;
    new.forces.retain(|_: &Arc<dyn ForceSpec>| keep(&forces, &mut k));
    k = 0;
    new.constraints.retain(|_: &Arc<dyn ConstraintSpec>| keep(&constraints, &mut k));
    Ok(new)
}

/// The fields inside of `{"type": {...}}`.
fn inner(spec: &mut Value) -> Option<&mut Value> {
    spec.as_object_mut()?.values_mut().next()
}

/// The fields of a spec.
fn fields(spec: impl serde::Serialize) -> Value {
    let mut whole = serde_json::to_value(spec).unwrap_or_default();
    inner(&mut whole).map(Value::take).unwrap_or_default()
}

/// A number somewhere in a spec; 0 if it isn't there.
fn number(of: &Value, at: &str) -> f64 {
    of.pointer(at).and_then(Value::as_f64).unwrap_or(0.0)
}

/// What a spec acts on, as its fields tell.
fn whereabouts(of: &Value) -> String {
    let texts = |v: &Value| -> Vec<String> {
        v.as_array().into_iter().flatten().filter_map(Value::as_str).map(String::from).collect()
    };
    if let Some(name) = of["name"].as_str() {
        return format!(" {name}");
    }
    if let Some(marker) = of["marker"].as_str() {
        return format!(" at {marker}");
    }
    match texts(&of["on"]) {
        on if on.is_empty() => String::new(),
        on => format!(" on {}", on.join(", ")),
    }
}

fn spoken(kind: &str) -> String {
    kind.replace('_', " ")
}

/// The effects that a scene has.
pub(super) fn present(scene: &Scene) -> Vec<Candidate> {
    let mut all: Vec<Candidate> = Vec::new();
    let mut push = |name: String, edit: Edit| {
        let twice = all.iter().filter(|c| c.name == name || c.name.starts_with(&format!("{name} ("))).count();
        let name = if twice > 0 { format!("{name} ({})", twice + 1) } else { name };
        all.push(Candidate { name, edits: vec![edit], note: String::new() });
    };
    for (k, force) in scene.forces.iter().enumerate() {
        let of = fields(&**force);
        let (kind, place) = (force.typetag_name(), whereabouts(&of));
        push(format!("{}{place}", spoken(kind)), Edit::DropForce(k));
        if kind == "added_mass" && of["theory"] != "morison" {
            push(
                format!("flow along what has added mass{place}"),
                Edit::Force(k, json!({ "theory": "morison" })),
            );
        }
        if kind == "drag" && number(&of, "/end") != 0.0 {
            push(format!("drag of ends{place}"), Edit::Force(k, json!({ "end": 0.0 })));
        }
    }
    for (k, element) in scene.elements.iter().enumerate() {
        let of = fields(&**element);
        for (field, what) in FIELDS {
            let places = [format!("/section/{field}"), format!("/{field}")];
            for at in places.into_iter().filter(|at| number(&of, at) != 0.0) {
                push(format!("{what} of {}", element.name()), Edit::Element(k, at, json!(0.0)));
            }
        }
    }
    for (k, element) in scene.elements.iter().enumerate() {
        if let Some(untwisted) = untwisted(fields(&**element)) {
            push(format!("torsion of {}", element.name()), Edit::Replace(k, untwisted));
        }
    }
    for (k, c) in scene.constraints.iter().enumerate() {
        if let Some((marker, _)) = c.feeds() {
            push(
                format!("material flow at {}", marker.to_string().replace('`', "")),
                Edit::DropConstraint(k),
            );
        } else if c.typetag_name() == "break" {
            push(format!("breaking {}", c.name()), Edit::DropConstraint(k));
        }
    }
    if scene.water.as_ref().is_some_and(|w| !w.current.iter().all(|u| u.is(0.0)) || !w.profile.is_empty()) {
        push("current".into(), Edit::StillWater);
    }
    if scene.water.as_ref().is_some_and(|w| w.waves.is_some()) {
        push("waves".into(), Edit::NoWaves);
    }
    if scene.water.as_ref().is_some_and(|w| w.level.is_some()) {
        push("surface of the water".into(), Edit::NoSurface);
    }
    if scene.air.is_some() && scene.water.is_some() {
        push("air".into(), Edit::NoAir);
    }
    if scene.run.audit && scene.run.analysis == Analysis::Dynamics {
        push("audit of energy".into(), Edit::NoAudit);
    }
    all
}

/// A cable with torsion that could do without: its fields without all that only torsion has.
fn untwisted(mut of: Value) -> Option<Value> {
    let straight = of["stress_free"] != "as-laid" && number(&of, "/curvature") == 0.0;
    if number(&of, "/section/gj") == 0.0 || of["section"]["ei"].is_array() || !straight {
        return None;
    }
    let section = of["section"].as_object_mut()?;
    for field in ["gj", "rotary_inertia", "torsional_retardation_time", "gyroscopic", "torque_tension"] {
        section.remove(field);
    }
    let whole = of.as_object_mut()?;
    for field in ["normal", "twist", "laid_twist"] {
        whole.remove(field);
    }
    Some(of)
}

/// The effects that a scene could have, with data that follow from it; and those of which it says too little.
pub(super) fn absent(scene: &Scene) -> (Vec<Candidate>, Vec<Hint>) {
    let (mut all, mut hints): (Vec<Candidate>, Vec<Hint>) = (Vec::new(), Vec::new());
    let mut add = |name: String, edits: Vec<Edit>, note: String| all.push(Candidate { name, edits, note });

    for (kind, note) in [
        ("gravity", "the scene's gravity"),
        ("buoyancy", "of the displaced volume"),
        ("drag", "constant law, cn = 1.2, ct = 0.01"),
        ("added_mass", "ca = 1"),
    ] {
        if !scene.forces.iter().any(|f| f.typetag_name() == kind) {
            add(spoken(kind), vec![Edit::AddForce(json!({ kind: {} }))], note.into());
        }
    }
    for (k, force) in scene.forces.iter().enumerate().filter(|(_, f)| f.typetag_name() == "drag") {
        let of = fields(&**force);
        let constant = of["normal"] == "constant" && of["tangential"] == "constant";
        let (law, name, note) = match constant {
            true => ("choo-casarella", "drag by Reynolds number", "law of Choo and Casarella instead"),
            false => {
                ("constant", "drag with constant coefficients", "instead of the law of Choo and Casarella")
            }
        };
        let name = format!("{name}{}", whereabouts(&of));
        add(name, vec![Edit::Force(k, json!({ "normal": law, "tangential": law }))], note.into());
    }

    absent_of_elements(scene, &mut all, &mut hints);
    let mut hint = |name: &str, text: String| hints.push((name.to_string(), text));
    if scene.water.as_ref().is_some_and(|w| w.current.iter().all(|u| u.is(0.0)) && w.profile.is_empty()) {
        hint("current", "`current = [\"0.5 m/s\", 0, 0]` in [water]".into());
    }
    if scene.water.as_ref().is_some_and(|w| w.level.is_none()) {
        hint("surface of the water", "`level = 0` in [water]".into());
    }
    let offered = registered().iter().any(|s| s.name == "contact");
    if offered && !scene.forces.iter().any(|f| f.typetag_name() == "contact") {
        let text = "[[forces]]: type = \"contact\", name = \"ground\", shape = { plane = {} }, marker = [0, 0, -10], \
                    stiffness_per_length = 1e4";
        hint("contact", text.into());
    }
    for cable in scene.elements.iter().filter(|e| e.typetag_name() == "cable") {
        let of = fields(&**cable);
        if of["section"]["gj"].is_null() && number(&of, "/section/ei") > 0.0 {
            let name = cable.name();
            hint(&format!("torsion of {name}"), format!("`gj` in the section of `{name}`"));
        }
    }
    (all, hints)
}

/// Bending, damping and material flow of the elements.
fn absent_of_elements(scene: &Scene, all: &mut Vec<Candidate>, hints: &mut Vec<Hint>) {
    let mut add = |name: String, edits: Vec<Edit>, note: String| all.push(Candidate { name, edits, note });
    let mut hint = |name: &str, text: String| hints.push((name.to_string(), text));
    let statics = scene.run.analysis == Analysis::Statics;
    let mut flows = statics || scene.constraints.iter().any(|c| c.feeds().is_some());
    for (k, element) in scene.elements.iter().enumerate() {
        let (of, name) = (fields(&**element), element.name());
        let section = |field: &str| number(&of, &format!("/section/{field}"));
        if element.typetag_name() == "rigid_chain" && section("joint_damping") == 0.0 {
            hint(&format!("damping of {name}"), format!("`joint_damping` in the section of `{name}`"));
        }
        if element.typetag_name() != "cable" {
            continue;
        }
        if !flows {
            flows = true;
            let idle = scene.constraints.iter().find(|c| c.typetag_name() == "winch").map(|c| c.name());
            let idle = idle.map(|winch| format!("`speed` of the winch `{winch}`"));
            let text = idle.unwrap_or_else(|| format!(
                "[[constraints]]: type = \"winch\", name = \"winch\", marker = \"{name}.start\", speed = \"0.5 m/s\""
            ));
            hint("material flow", text);
        }
        // one number, or one for each direction
        let ei = section("ei").max(section("ei/0")).max(section("ei/1"));
        let (ea, d) = (section("ea"), section("diameter"));
        if ei == 0.0 && d > 0.0 {
            let ei = ea * d * d / 16.0;
            let note = format!("ei = EA d^2/16 = {ei:.2e} N m^2, as of a solid rod: the most it can be");
            add(format!("bending of {name}"), vec![Edit::Element(k, "/section/ei".into(), json!(ei))], note);
        } else if ei == 0.0 {
            hint(&format!("bending of {name}"), format!("`ei` in the section of `{name}`"));
        }
        if statics {
            continue;
        }
        // the same retardation time for stretching and bending, as in one material
        let length = length(&of);
        let time = 0.02 * 2.0 * length / PI * ((section("mass") + section("flooded")) / ea).sqrt();
        let fresh = ["axial_retardation_time", "bending_retardation_time"]
            .into_iter()
            .filter(|f| section(f) == 0.0 && (*f == "axial_retardation_time" || ei > 0.0));
        let edits: Vec<Edit> =
            fresh.map(|f| Edit::Element(k, format!("/section/{f}"), json!(time))).collect();
        if !edits.is_empty() && time > 0.0 && time.is_finite() {
            let note = format!("{time:.1e} s: 1 % of critical in the first longitudinal mode");
            add(format!("damping of {name}"), edits, note);
        }
    }
}

/// Unstretched length of a cable, as its fields tell [m].
fn length(of: &Value) -> f64 {
    if let Some(length) = of["length"].as_f64() {
        return length;
    }
    let points = of["points"].as_array().filter(|p| !p.is_empty()).or(of["curve"].as_array());
    let points: Vec<[f64; 3]> = points
        .into_iter()
        .flatten()
        .map(|p| std::array::from_fn(|i| p.get(i).and_then(Value::as_f64).unwrap_or(0.0)))
        .collect();
    let way = |w: &[[f64; 3]]| (0..3).map(|i| (w[1][i] - w[0][i]).powi(2)).sum::<f64>().sqrt();
    points.windows(2).map(way).sum()
}
