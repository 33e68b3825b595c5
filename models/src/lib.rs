//! The cases that come with Ropewalk: scene files, compiled into the program; and solvers of their own kind for single
//! problems.

mod gallery;
pub mod unwinding;

pub use ropewalk_scene::Bundled;
use std::sync::LazyLock;

/// `scenes/NAME.toml` under its name.
macro_rules! scenes {
    ($($name:literal),* $(,)?) => {
        &[$(Bundled { name: $name, text: include_str!(concat!("../scenes/", $name, ".toml")) }),*]
    };
}

/// All bundled scenes, by name.
pub fn bundled() -> &'static [Bundled] {
    const ALL: &[Bundled] = scenes![
        "cantilever",
        "catenary",
        "hose-straight",
        "hose-turn",
        "pendulum",
        "shear-pin",
        "unwinding",
        "unwinding-paper"
    ];
    ALL
}

/// The scenes of the gallery, by name: small ones, each of which shows one thing and says what is known about its answer.
pub fn gallery() -> &'static [Bundled] {
    gallery::ALL
}

/// All scenes that are known by their names: the [`bundled`] ones and those of the [`gallery`].
pub fn scenes() -> &'static [Bundled] {
    static ALL: LazyLock<Vec<Bundled>> = LazyLock::new(|| [bundled(), gallery()].concat());
    &ALL
}

/// All bundled atlases, by name: figures and tables of a document, computed from scenes.
pub fn atlases() -> &'static [Bundled] {
    const ALL: &[Bundled] = &[Bundled { name: "thesis", text: include_str!("../atlases/thesis.toml") }];
    ALL
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_ascend_and_are_names() {
        assert!(bundled().windows(2).all(|w| w[0].name < w[1].name));
        assert!(gallery().windows(2).all(|w| w[0].name < w[1].name));
        assert!(scenes().iter().all(|b| !b.name.contains(['/', '\\', '.']) && !b.text.is_empty()));
        let mut names: Vec<&str> = scenes().iter().map(|b| b.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), scenes().len());
    }
}
