//! How stiff a contact is.

/// How stiff a contact is, with an exponent `p` other than 1 at a depth of 1 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// Of a single point [N/m^p].
    pub point: f64,
    /// Of what is slender, per length [N/m^p/m].
    pub per_length: f64,
    /// Of the tip of what is slender [N/m^p]; if none is told, that of a length as long as it is thick.
    pub end: Option<f64>,
    /// Instead of these, per area of what lies on a plane, as thick as it is [N/m^p/m²].
    pub area: Option<f64>,
}

impl Stiffness {
    /// Of a ball of this radius.
    pub(super) fn of_point(&self, radius: f64) -> f64 {
        self.area.map_or(self.point, |k| k * std::f64::consts::PI * radius * radius)
    }
    /// Per length of what is slender with this radius.
    pub(super) fn of_length(&self, radius: f64) -> f64 {
        self.area.map_or(self.per_length, |k| k * 2.0 * radius)
    }
}
