//! What fuzzing found, as small as it became. Each once hung, or asked for more memory than there is.

/// A chain whose links are lost in the rounding of its path.
const LOST_LINKS: &str = r#"
[[elements]]
type = "rigid_chain"
name = "hose"
points = [[0, 0, 0], [1, 0, 0]]
links = 12
length = 1e-300
section = { mass = 1, diameter = 0.02 }
"#;

fn unwound(segments: &str, layers: &str) -> String {
    format!(
        "[[motions]]\ntype = \"straight\"\nname = \"draw\"\nspeed = 5\n\n[[processes]]\ntype = \"unwound_cable\"\n\
         name = \"cable\"\nmass = 0.001\nmotion = \"draw\"\nrule = {{ tension = {{ rest = 0.02, per_speed2 = 0.0227 }} }}\n\
         elements = {segments}\n[processes.package]\nlength = 0.2\nradius = 0.06\ndiameter = 0.0009\nlayers = {layers}\n"
    )
}

/// All of them.
pub fn all() -> Vec<String> {
    let most = "9223372036854775807";
    vec![LOST_LINKS.to_string(), unwound(most, "4"), unwound("24", most)]
}
