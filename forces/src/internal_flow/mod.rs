//! `type = "internal_flow"`: a hose or pipe that carries a flow.
//!
//! The fluid, of mass `m` per unstretched length, moves with `r̊ = ṙ + u r'`: as plug flow at the rate `u` of the material
//! coordinate, which fills a bore that keeps its volume per unstretched length however the hose is stretched. With this
//! assumption `m` and `m u` are the same everywhere, and the tension `EA ε` of the cable is the effective one, that of the
//! wall less the pressure inside and plus the pressure outside, each over its area. Hamilton's principle of the open system
//! (McIver 1973) gives, per length and conjugate to `r` and `r'`,
//!
//! ```text
//! f = -m (r̈ + u ṙ' + u̇ r'),    g = m u (ṙ + u r')
//! ```
//!
//! and at the ends the thrust `∓m u (ṙ + u r')`: towards the outlet where fluid enters, against the jet where it leaves.
//! Together these are the familiar `-m (r̈ + 2 u ṙ' + u² r'' + u̇ r')`. Pressure and friction of the fluid do nothing to the
//! motion by themselves. What ends are held by carries the effective tension.
//!
//! Clamped at both ends a pipe buckles at `u = 2π √(EI/m)/L`; a cantilever flutters (Païdoussis, *Fluid-Structure
//! Interactions*, vol. 1, ch. 3).

mod pressure;
mod record;
mod spec;
mod term;

pub use pressure::Bore;
pub(crate) use pressure::{PRESSURE, WALL};
pub use record::WallTensionSpec;
pub use spec::InternalFlowSpec;
pub use term::InternalFlow;
