//! What older scenes wrote elsewhere.

/// Type, field, and where what it said belongs now.
const MOVED: [(&str, &str, &str); 3] = [
    ("gravity", "g", "gravity belongs to the scene: write `gravity = [0, 0, -9.81]` above its first section"),
    (
        "buoyancy",
        "g",
        "gravity belongs to the scene: write `gravity = [0, 0, -9.81]` above its first section",
    ),
    (
        "unwound_cable",
        "gravity",
        "gravity belongs to the scene: write `weight = true` here, and `gravity = [0, 0, -9.81]` above its first section",
    ),
];

/// Where a field went that a type no longer has.
pub(super) fn hint(kind: &str, field: &str) -> Option<&'static str> {
    MOVED.iter().find(|(k, f, _)| *k == kind && *f == field).map(|&(_, _, hint)| hint)
}
