//! The files of the suite, compiled into the program.

/// `studies/verification/NAME` with this ending, under its name.
macro_rules! files {
    ($ending:literal: $($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../verification/", $name, $ending)))),*]
    };
}

/// The references of every case, by name.
pub(super) const REFERENCES: &[(&str, &str)] = files![".json":
    "a01_simple_pendulum",
    "a02_n_four_bar",
    "a03_andrews_squeezer",
    "bend45_cantilever",
    "cable_in_current_equilibrium",
    "contact_bounce_friction_pulley",
    "door_two_hinges_redundant",
    "double_pendulum_chaotic",
    "driven_rod_inverse_dynamics",
    "elastic_catenary",
    "elastica_cantilever",
    "flexible_pendulum_released_horizontally",
    "flying_spaghetti_2d",
    "free_rigid_body_dzhanibekov",
    "hooke_joint_driven",
    "inconsistent_initial_conditions_pendulum",
    "integrator_signature_linear_oscillator",
    "modes_string_chain_beam",
    "nlink_chain_10_horizontal_release",
    "princeton_beam",
    "rod_pendulum_near_separatrix",
    "rollup_cantilever",
    "rotating_beam_modes",
    "sinking_cylinder_drag",
    "spatial_slider_crank",
    "spinup_flexible_arm",
];

/// The scenes that cases run, by name.
pub(super) const SCENES: &[(&str, &str)] = files![".toml":
    "a01_simple_pendulum",
    "a02_n_four_bar",
    "a02_n_four_bar_40",
    "a03_andrews_squeezer",
    "bend45_cantilever",
    "cable_in_current_buoy",
    "cable_in_current_equilibrium",
    "contact_block",
    "contact_bounce",
    "contact_damper",
    "contact_incline",
    "contact_pulley",
    "door_two_hinges_redundant",
    "double_pendulum_chaotic",
    "driven_rod_inverse_dynamics",
    "elastic_catenary",
    "elastica_cantilever",
    "flexible_pendulum_released_horizontally",
    "flying_spaghetti_2d",
    "free_rigid_body_dzhanibekov",
    "hooke_joint_driven",
    "inconsistent_initial_conditions_pendulum",
    "integrator_signature_linear_oscillator",
    "modes_clamped_beam",
    "modes_hanging_chain",
    "modes_taut_string",
    "nlink_chain_10_horizontal_release",
    "princeton_beam",
    "rod_pendulum_near_separatrix",
    "rollup_cantilever",
    "rotating_beam_modes",
    "sinking_cylinder_drag",
    "spatial_slider_crank",
    "spinup_flexible_arm",
    "spinup_flexible_arm_steady",
];
