//! Which columns are drawn together.

use serde::Serialize;

use super::Panel;
use crate::Column;

/// Columns over one axis.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct Drawn {
    pub title: String,
    pub unit: String,
    /// Their numbers in the history.
    pub columns: Vec<usize>,
}

/// All panels: those asked for, a panel for each unit, then what is in none of them.
pub(super) fn drawn(columns: &[Column], asked: &[Panel]) -> Vec<Drawn> {
    let mut panels: Vec<Drawn> = Vec::new();
    let mut add = |title: &str, columns: &[Column], members: &[usize]| {
        for &k in members {
            let unit = &columns[k].unit;
            match panels.iter_mut().find(|panel| panel.title == title && panel.unit == *unit) {
                Some(panel) => panel.columns.push(k),
                None => panels.push(Drawn { title: title.into(), unit: unit.clone(), columns: vec![k] }),
            }
        }
    };
    let mut left: Vec<usize> = (1..columns.len()).collect();
    for panel in asked {
        let members: Vec<usize> =
            panel.columns.iter().filter_map(|name| columns.iter().position(|c| c.name == *name)).collect();
        left.retain(|k| !members.contains(k));
        add(&panel.title, columns, &members);
    }
    let stem = |name: &'_ str| name.rsplit_once('.').map_or(name.len(), |(stem, _)| stem.len());
    for &k in &left {
        let name = columns[k].name.as_str();
        let alike = |j: &&usize| {
            let other = columns[**j].name.as_str();
            other[..stem(other)] == name[..stem(name)] && columns[**j].unit == columns[k].unit
        };
        // what is by itself has its whole name
        let alone = left.iter().filter(alike).count() == 1;
        add(if alone { name } else { &name[..stem(name)] }, columns, &[k]);
    }
    panels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_column_is_drawn_once_with_those_of_its_unit() {
        let columns = ["t", "end.x", "end.y", "end.tension", "depth", "lost", "tip.x", "tip.y"];
        let units = ["s", "m", "m", "N", "m", "m", "m", "m"];
        let columns: Vec<Column> = columns.iter().zip(units).map(|(c, u)| Column::new(*c, u)).collect();
        let asked = [Panel {
            title: "The end".into(),
            columns: ["end.x", "end.tension", "none"].map(String::from).into(),
        }];
        let panels = drawn(&columns, &asked);
        let told: Vec<_> =
            panels.iter().map(|p| (p.title.as_str(), p.unit.as_str(), p.columns.clone())).collect();
        assert_eq!(
            told,
            [
                ("The end", "m", vec![1]),
                ("The end", "N", vec![3]),
                ("end.y", "m", vec![2]),
                ("depth", "m", vec![4]),
                ("lost", "m", vec![5]),
                ("tip", "m", vec![6, 7])
            ]
        );
        assert!(drawn(&[], &[]).is_empty());
    }
}
