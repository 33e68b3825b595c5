//! What friction of wheels and rings does at equilibria.

use ropewalk_core::BuildError;
use ropewalk_scene::Passage;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What friction of a wheel or a ring does at equilibria, which aren't unique with it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sliding {
    /// Nothing: they are those without friction.
    #[default]
    None,
    /// It acts in full against a cable that slowly goes to its drum or winch.
    Hoisting,
    /// It acts in full against a cable that slowly comes from its drum or winch.
    Lowering,
    /// It acts in full against a cable that slowly goes to its start.
    ToStart,
    /// It acts in full against a cable that slowly goes to its end.
    ToEnd,
}

impl Sliding {
    pub(super) fn is_none(&self) -> bool {
        *self == Sliding::None
    }

    /// What the equilibrium is called.
    pub(super) fn name(self) -> Option<&'static str> {
        match self {
            Sliding::None => None,
            Sliding::Hoisting => Some("hoisting"),
            Sliding::Lowering => Some("lowering"),
            Sliding::ToStart => Some("cables that go to their start"),
            Sliding::ToEnd => Some("cables that go to their end"),
        }
    }

    /// 1 where the cable of a passage goes to its start, -1 where it goes to its end, 0 where that doesn't matter.
    pub(super) fn way(self, passage: &Passage) -> Result<f64, BuildError> {
        let to_drum = match passage.fed {
            [true, false] => Some(1.0),
            [false, true] => Some(-1.0),
            _ => None,
        };
        let (word, sign) = match self {
            Sliding::None => return Ok(0.0),
            Sliding::ToStart => return Ok(1.0),
            Sliding::ToEnd => return Ok(-1.0),
            Sliding::Hoisting => ("hoisting", 1.0),
            Sliding::Lowering => ("lowering", -1.0),
        };
        to_drum.map(|way: f64| way * sign).ok_or_else(|| {
            let number = if passage.fed[0] { "one at each end" } else { "none" };
            let span = &passage.spans[0];
            let cable = span.rsplit_once('.').map_or(span.as_str(), |(cable, _)| cable);
            let message = format!(
                "`{word}` tells by its drum or winch which way a cable goes, and `{cable}` has {number}: say `to_start` or `to_end`"
            );
            BuildError::at("equilibrium", message)
        })
    }
}

/// Says whether friction acts in full, from an equilibrium on or no more; whether that is new.
pub(super) fn set(place: Option<usize>, memory: &mut [f64], on: f64) -> bool {
    let Some(x) = place.and_then(|place| memory.get_mut(place)) else { return false };
    std::mem::replace(x, on) != on
}
