//! Scenes that nobody should write, one by one.

const CABLE: &str = r#"[[elements]]
type = "cable"
name = "rope"
points = [[0, 0, 0], [1, 0, 0]]
elements = 4
section = { mass = 0.5, ea = 1000, ei = 0.1 }
"#;
const BODY: &str = r#"[[elements]]
type = "rigid_body"
name = "body"
position = [0, 0, 0]
mass = 1
inertia = [1, 1, 1]
"#;
const PIN: &str = r#"[[constraints]]
type = "spherical"
name = "pin"
marker = "rope.start"
"#;
const GRAVITY: &str = "[[forces]]\ntype = \"gravity\"\n";

/// The same with something else in it.
fn with(text: &str, old: &str, new: &str) -> String {
    assert!(text.contains(old), "{old} in {text}");
    text.replace(old, new)
}

/// All of them.
pub fn all() -> Vec<String> {
    let run = |text: String| {
        format!("[run]\nduration = 1.0\n\n[solver]\nstepping = {{ fixed = {{ h = 1e-3 }} }}\n\n{text}")
    };
    let hung = || [CABLE, PIN, GRAVITY].join("\n");
    let pinned = |body: String| format!("{body}\n{}{GRAVITY}", with(PIN, "rope.start", "body"));
    let second = with(PIN, "\"pin\"", "\"again\"");
    let mut all = vec![
        // no length, no mass, no stiffness, too much of each
        with(&hung(), "[1, 0, 0]", "[0, 0, 0]"),
        with(&hung(), "[1, 0, 0]", "[1e-200, 0, 0]"),
        with(&hung(), "mass = 0.5", "mass = 0"),
        with(&hung(), "mass = 0.5", "mass = 1e-300"),
        with(&hung(), "ea = 1000", "ea = 0"),
        with(&hung(), "ea = 1000", "ea = 1e300"),
        with(&hung(), "ei = 0.1", "ei = 0"),
        with(&hung(), "ei = 0.1", "ei = 1e200"),
        with(&hung(), "elements = 4", "elements = 4\nlength = 100"),
        with(&hung(), "elements = 4", "elements = 4\nlength = 0.01"),
        with(&hung(), "elements = 4", "elements = 4\nvelocity = [1e200, 0, 0]"),
        pinned(with(BODY, "mass = 1\n", "mass = 0\n")),
        pinned(with(BODY, "[1, 1, 1]", "[0, 0, 0]")),
        pinned(with(BODY, "[1, 1, 1]", "[1e-300, 1e-300, 1e-300]")),
        pinned(with(BODY, "[1, 1, 1]", "[1, 1, 1]\nangular_velocity = [1e9, 0, 0]")),
        // joints that coincide, or ask for what can't be
        format!("{}\n{second}", hung()),
        format!("{}\n{second}to = [0, 0, 1]\n", hung()),
        format!("{}\n{}", hung(), with(&second, "rope.start", "rope.end")),
        format!("{}\n{}to = \"rope.end\"\n", hung(), with(&second, "rope.start", "rope.end")),
        // loads and motions beyond all measure
        format!("gravity = [0, 0, -1e9]\n{}", hung()),
        format!("gravity = [0, 0, -1e300]\n{}", hung()),
        format!(
            "{CABLE}\n[[motions]]\ntype = \"table\"\nname = \"jump\"\nt = [0, 1e-9, 2]\nx = [0, 5, 5]\n\n\
             [[constraints]]\ntype = \"driving\"\nname = \"drive\"\nmarker = \"rope.start\"\nmotion = \"jump\"\n"
        ),
        format!(
            "{}\n[[forces]]\ntype = \"point_force\"\nmarker = \"rope.end\"\nforce = [1e12, 0, 0]\n",
            hung()
        ),
        String::new(),
        "[run]\nduration = 1e-300\n".to_string(),
    ];
    all = all.into_iter().map(run).collect();
    for stepping in
        ["{ fixed = { h = 1e6 } }", "{ fixed = { h = 1e-300 } }", "{ controlled = { tolerance = 1e-300 } }"]
    {
        all.push(with(&run(hung()), "{ fixed = { h = 1e-3 } }", stepping));
    }
    all
}
