//! Levers: points beside the axis of a cable with torsion, which its sections carry along.

use super::CableSpec;
use ropewalk_core::error::finite;
use ropewalk_core::model::twist::section;
use ropewalk_core::rotation::transposed_times;
use ropewalk_core::{BuildError, Marker, NodeId, Spot, V3};
use ropewalk_scene::{quantity, split_marker};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A point that is rigidly attached to a section of a cable with torsion, at an offset from its axis: the end of a crank, an eye
/// welded on a rod. Joints, masses, springs and loads hold on to it by its marker, `cable.lever`, and pull, bend and twist the
/// cable by the arm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LeverSpec {
    /// Where on the cable: `"start"`, `"end"`, or an unstretched arc length or share of the length, `"12.5 m"`, `"40%"`.
    pub at: String,
    /// From the axis of the cable to the point, in space as the cable is laid [m]. It turns with the section from there.
    #[serde(deserialize_with = "quantity::vec3::length")]
    pub offset: V3<f64>,
}

impl LeverSpec {
    /// The arc length at which it stands on a cable of this length; none at an end [m].
    fn place(&self, length: f64) -> Result<Option<f64>, String> {
        let on = format!("c@{}", self.at);
        let s = match self.at.as_str() {
            "start" | "end" => return Ok(None),
            _ => match split_marker(&on)
                .map_err(|e| format!("a lever is at \"start\", at \"end\", or at a length or share: {e}"))?
                .1
            {
                Spot::Along(s) => s,
                Spot::Share(share) => share * length,
                Spot::Named(_) => f64::NAN,
            },
        };
        if (0.0..=length).contains(&s) {
            Ok(Some(s))
        } else {
            Err(format!("the cable has no place \"{}\": it goes from 0 to {length} m", self.at))
        }
    }
}

impl CableSpec {
    /// Arc lengths at which levers need nodes [m].
    pub(super) fn pins_of_levers(&self, length: f64) -> Result<Vec<f64>, BuildError> {
        let place = |(name, lever): (&String, &LeverSpec)| {
            lever.place(length).map_err(|e| BuildError::at(format!("levers.{name}.at"), e)).transpose()
        };
        self.levers.iter().filter_map(place).collect()
    }

    /// The markers of its levers, on nodes at these arc lengths that are laid like this, where torsion gives them sections.
    pub(super) fn markers_of_levers(
        &self,
        nodes: &[NodeId],
        mesh: &[f64],
        laid: Option<&[[f64; 10]]>,
        feeds: [bool; 2],
    ) -> Result<Vec<(String, Marker)>, BuildError> {
        let mut all = Vec::with_capacity(self.levers.len());
        for (name, lever) in &self.levers {
            let wrong =
                |field: &str, message: String| BuildError::at(format!("levers.{name}{field}"), message);
            if matches!(name.as_str(), "start" | "end") || name.is_empty() || name.contains(['.', '@']) {
                let message = format!("`{name}` can't name a lever: take another name, without `.` and `@`");
                return Err(wrong("", message));
            }
            finite("offset", &lever.offset).map_err(|e| wrong(".offset", e.message))?;
            let Some(laid) = laid else {
                let message = "a cable without torsion doesn't know how a lever on it turns: give its section a torsional \
                               stiffness, `gj`";
                return Err(wrong("", message.into()));
            };
            let last = mesh.len() - 1;
            let k = match (lever.at.as_str(), lever.place(mesh[last]).map_err(|e| wrong(".at", e))?) {
                ("start", _) => 0,
                (_, None) => last,
                (_, Some(_)) if feeds != [false; 2] => {
                    let message =
                        "material flows past this place: put the lever at the end that doesn't feed";
                    return Err(wrong(".at", message.into()));
                }
                (_, Some(s)) => {
                    let off = |k: &usize| (mesh[*k] - s).abs();
                    (0..=last).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0)
                }
            };
            if feeds[usize::from(k == last)] && (k == 0 || k == last) {
                let message = "material flows through this end: put the lever at the end that doesn't feed";
                return Err(wrong(".at", message.into()));
            }
            let arm = transposed_times(&section(&laid[k]), &lever.offset);
            all.push((name.clone(), Marker::beside(nodes[k], arm)));
        }
        Ok(all)
    }
}
