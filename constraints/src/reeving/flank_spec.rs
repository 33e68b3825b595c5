//! The flanks of a sheave as scenes ask for them.

use super::flank::Flank;
use super::spec::SheaveSpec;
use ropewalk_core::BuildError;
use ropewalk_core::error::not_negative;
use ropewalk_scene::Passage;

impl SheaveSpec {
    /// The flank on which this cable rolls, if the scene asks for that.
    pub(super) fn flank(&self, passage: &Passage) -> Result<Option<Flank>, BuildError> {
        if self.fleet_twist == 0.0 {
            return Ok(None);
        }
        let (span, strand) = (&passage.spans[0], &passage.strand);
        let cable = span.rsplit_once('.').map_or(span.as_str(), |(cable, _)| cable);
        if strand.torsion.is_none() {
            let message =
                format!("`{cable}` has no torsion that a groove could twist: give its section a `gj`");
            return Err(BuildError::at("fleet_twist", message));
        }
        if strand.diameter == 0.0 {
            let message =
                format!("`{cable}` rolls in the groove by its diameter: give its section a `diameter`");
            return Err(BuildError::at("fleet_twist", message));
        }
        let Some(friction) = self.flank_friction.or(self.friction) else {
            let message =
                "a cable rolls down a flank by friction: give `flank_friction`, about 0.1 of greased steel";
            return Err(BuildError::at("fleet_twist", message));
        };
        let (radius, slip_speed) = (0.5 * strand.diameter, self.slip_speed);
        Ok(Some(Flank { share: self.fleet_twist, radius, friction, slip_speed }))
    }

    /// What is wrong with the numbers of its flanks.
    pub(super) fn check_flank(&self) -> Result<(), BuildError> {
        if !(0.0..=1.0).contains(&self.fleet_twist) {
            return Err(BuildError::at(
                "fleet_twist",
                "it is a share of pure rolling, from 0, none, to 1, all of it",
            ));
        }
        not_negative("flank_friction", self.flank_friction.unwrap_or(0.0))?;
        if self.flank_friction.is_some() && self.fleet_twist == 0.0 {
            return Err(BuildError::at(
                "flank_friction",
                "it matters only where the flank twists the cable: give `fleet_twist`",
            ));
        }
        Ok(())
    }
}
