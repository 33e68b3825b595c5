//! The scenes of the gallery. `gallery/NAME.toml` is named here, described by itself, and drawn in the book.

use ropewalk_scene::Bundled;

/// `gallery/NAME.toml` under its name.
macro_rules! scenes {
    ($($name:literal),* $(,)?) => {
        &[$(Bundled { name: $name, text: include_str!(concat!("../gallery/", $name, ".toml")) }),*]
    };
}

/// All of them, by name.
pub(crate) const ALL: &[Bundled] = scenes![
    "atwood",
    "atwood-wheel",
    "bend-stiffener",
    "bouncing-ball",
    "breaking-line",
    "buckling-column",
    "bungee",
    "cable-over-edge",
    "cantilever-tip-load",
    "capstan",
    "clump-weights",
    "conical-pendulum",
    "constant-tension-winch",
    "crane-trolley",
    "current-profile",
    "double-pendulum",
    "driven-oscillator",
    "dropped-load",
    "engine-mounts",
    "falling-chain",
    "folded-whip",
    "four-bar",
    "four-falls",
    "free-disc",
    "guyed-mast",
    "hanging-cable-modes",
    "heaving-cylinder",
    "helix-spring",
    "hockle",
    "lazy-wave",
    "moored-float",
    "mooring",
    "mooring-line",
    "munk-moment",
    "net",
    "overhand-knot",
    "pay-out",
    "pinched-ring",
    "pipe-conveying-fluid",
    "power-line",
    "rolled-up-strip",
    "rolling-ball",
    "rotating-arm",
    "rov-umbilical",
    "simple-pendulum",
    "sinking-ball",
    "slider-crank",
    "sliding-block",
    "spar-buoy",
    "spinning-top",
    "taut-string",
    "three-ropes",
    "tightrope",
    "tow-straight",
    "universal-joint",
    "vehicle-launch",
    "whirling-bob",
    "winch-hoist",
];
