//! Columns of a history.

/// A named column of the history.
///
/// ```
/// use ropewalk_core::Column;
/// let column = Column::new("hose.end.x", "m");
/// assert_eq!((column.name.as_str(), column.unit.as_str()), ("hose.end.x", "m"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name, such as `hose.end.x`.
    pub name: String,
    /// SI unit, such as `m`.
    pub unit: String,
}

impl Column {
    /// A column.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Column { name: name.into(), unit: unit.into() }
    }
}
