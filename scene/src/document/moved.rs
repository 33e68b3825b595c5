//! What version 0.1 of the language called by another name: one table, from which a scene that still uses it gets its
//! message, and [`migrate`](super::migrate) its edits.

use super::source::Span;
use super::value::{Key, Kind, Table, Value};

/// The version since which the names below are no longer read.
pub(super) const SINCE: &str = "0.2";

/// A field that has another name now.
struct Field {
    section: &'static str,
    kind: &'static str,
    /// The tables inside the part that lead to it, with a dot between them; empty for a field of the part itself.
    inside: &'static str,
    old: &'static str,
    new: &'static str,
}

const fn field(
    section: &'static str,
    kind: &'static str,
    inside: &'static str,
    old: &'static str,
    new: &'static str,
) -> Field {
    Field { section, kind, inside, old, new }
}

const FIELDS: &[Field] = &[
    field("elements", "cable", "section", "axial_damping", "axial_retardation_time"),
    field("elements", "cable", "section", "bending_damping", "bending_retardation_time"),
    field("elements", "point_mass", "", "at", "marker"),
    field("constraints", "winch", "", "total", "payout"),
    field("constraints", "winch", "", "slip", "slip_speed"),
    field("constraints", "winch", "", "pace", "reference_speed"),
    field("constraints", "winch", "", "stock", "stored_length"),
    field("constraints", "winch", "", "element", "element_length"),
    field("constraints", "winch", "", "release", "fade"),
    field("constraints", "eyelet", "", "pace", "reference_speed"),
    field("constraints", "eyelet", "", "element", "element_length"),
    field("constraints", "eyelet", "", "release", "fade"),
    field("constraints", "lift_off", "", "peel", "adhesion_energy"),
    field("constraints", "lift_off", "", "slip", "slip_speed"),
    field("constraints", "lift_off", "package", "bend_limit", "min_bend_radius"),
    field("constraints", "break", "", "of", "constraint"),
    field("forces", "contact", "", "at", "points"),
    field("forces", "contact", "damping.kelvin_voigt", "time", "retardation_time"),
    field("forces", "latch", "", "of", "on"),
    field("forces", "latch", "", "hold", "force"),
    field("motions", "sum", "", "of", "motions"),
    field("processes", "unwound_cable", "", "bending", "ei"),
    field("processes", "unwound_cable", "", "segments", "elements"),
    field("processes", "unwound_cable", "", "step", "h"),
    field("processes", "unwound_cable", "", "damping", "numerical_damping"),
    field("processes", "unwound_cable", "package", "bend_limit", "min_bend_radius"),
    field("processes", "unwound_cable", "rule.tension", "rest", "tension"),
    field("processes", "unwound_cable", "rule.length", "start", "tension"),
    field("processes", "unwound_cable", "rule.peel", "energy", "adhesion_energy"),
    field("processes", "unwound_cable", "rule.peel", "start", "tension"),
];

/// Choices inside of a part that have another name now: section, type, tables that lead to the choice, old, new.
const CHOICES: &[(&str, &str, &str, &str, &str)] =
    &[("processes", "unwound_cable", "rule", "peel", "adhesion")];

/// Types that have another name now: section, old, new.
const TYPES: &[(&str, &str, &str)] = &[("records", "feeding", "payout")];

/// The columns of a record of type `feeding`, old and new.
pub(super) const COLUMNS: &[(&str, &str)] = &[("fed", "payout"), ("speed", "payout_rate")];

/// Fields that are gone: section, type, field, what to do instead.
const GONE: &[(&str, &str, &str, &str)] = &[
    (
        "forces",
        "contact",
        "per_element",
        "contact is found everywhere along an element: leave `per_element` out",
    ),
    (
        "forces",
        "contact",
        "slip_speed",
        "friction holds up to a displacement: leave `slip_speed` out, or give that length, \
         `friction = { mu = 0.3, elastic_slip = \"0.1 mm\" }`",
    ),
];

/// Where gravity stood: section, type, field.
const GRAVITY: &[(&str, &str, &str)] =
    &[("forces", "gravity", "g"), ("forces", "buoyancy", "g"), ("processes", "unwound_cable", "gravity")];

/// Constraints that hold the position of their `marker`, so that a `clamp` there held only the direction.
const HOLD_POSITION: &[&str] =
    &["spherical", "driving", "eyelet", "lift_off", "coordinate", "point_on_line", "point_on_plane"];

/// What a scene still says in the words of version 0.1.
pub(super) struct Found<'a> {
    /// Where it stands.
    pub span: Span,
    /// Which part it belongs to, as `constraints[0]`.
    pub path: String,
    pub message: String,
    pub help: Option<&'static str>,
    pub edit: Edit<'a>,
}

/// What puts it right.
pub(super) enum Edit<'a> {
    /// The name at the place becomes this one.
    Rename(&'static str),
    /// The value becomes the scene's gravity, and the field goes, or becomes `weight = true`.
    Gravity { key: &'a Key, value: &'a Value, weight: bool },
    /// Nothing that is certain.
    None,
}

/// The values that a place can have: itself, or where parameters are not replaced yet, what they and `choose` stand for.
pub(super) struct Reach<'a> {
    /// The declarations; none where they are replaced.
    pub parameters: Option<&'a Table>,
}

impl<'a> Reach<'a> {
    pub(super) fn of(&self, value: &'a Value) -> Vec<&'a Value> {
        let mut all = Vec::new();
        self.add(value, 0, &mut all);
        all
    }

    fn add(&self, value: &'a Value, depth: usize, all: &mut Vec<&'a Value>) {
        const DEEPEST: usize = 16;
        let Some(parameters) = self.parameters.filter(|_| depth < DEEPEST) else {
            all.push(value);
            return;
        };
        match &value.kind {
            Kind::String(text) if text.starts_with('$') && !text.starts_with("$$") => {
                let declared = parameters.get(&text[1..]).map(|d| match d.as_table() {
                    Some(table) => table.get("default"),
                    None => Some(d),
                });
                if let Some(Some(value)) = declared {
                    self.add(value, depth + 1, all);
                }
            }
            Kind::Table(table) if table.get("choose").is_some() => {
                let others = table.iter().filter(|(key, _)| key.name != "choose");
                others.for_each(|(_, value)| self.add(value, depth + 1, all));
            }
            _ => all.push(value),
        }
    }

    fn tables(&self, value: &'a Value) -> Vec<&'a Table> {
        self.of(value).into_iter().filter_map(Value::as_table).collect()
    }

    /// The parts of a list, with their places in it.
    pub(super) fn parts(&self, list: &'a Value) -> Vec<(usize, &'a Table)> {
        let lists = self.of(list).into_iter().filter_map(|v| match &v.kind {
            Kind::Array(list) => Some(list),
            _ => None,
        });
        let items = lists.flat_map(|list| list.iter().enumerate());
        items.flat_map(|(i, item)| self.tables(item).into_iter().map(move |table| (i, table))).collect()
    }

    /// Texts that a field can have, with their places.
    pub(super) fn texts(&self, table: &'a Table, name: &str) -> Vec<(&'a str, Span)> {
        let values = table.get(name).map(|v| self.of(v)).unwrap_or_default();
        values.into_iter().filter_map(|v| Some((v.as_str()?, v.span))).collect()
    }

    fn is(&self, table: &'a Table, kind: &str) -> bool {
        self.texts(table, "type").iter().any(|(text, _)| *text == kind)
    }

    /// The tables that a path leads to; a choice is a key, or the `type` of its table.
    fn inside(&self, table: &'a Table, path: &str) -> Vec<&'a Table> {
        let mut here = vec![table];
        for step in path.split('.').filter(|step| !step.is_empty()) {
            let next = here.iter().flat_map(|table| match table.get(step) {
                Some(value) => self.tables(value),
                None if self.is(table, step) => vec![*table],
                None => Vec::new(),
            });
            here = next.collect();
        }
        here
    }
}

/// All that a list of parts says in the words of version 0.1.
pub(super) fn found<'a>(section: &str, list: &'a Value, reach: &Reach<'a>) -> Vec<Found<'a>> {
    let parts = reach.parts(list);
    let mut all = Vec::new();
    for &(i, part) in &parts {
        let path = format!("{section}[{i}]");
        renamed(section, &path, part, reach, &mut all);
        let belongs = |s: &str, kind: &str| s == section && reach.is(part, kind);
        for &(_, _, name, help) in GONE.iter().filter(|(s, kind, ..)| belongs(s, kind)) {
            if let Some((key, _)) = part.entry(name) {
                let (path, message) = (path.clone(), format!("`{name}` is gone since version {SINCE}"));
                all.push(Found { span: key.span, path, message, help: Some(help), edit: Edit::None });
            }
        }
        for &(_, kind, name) in GRAVITY.iter().filter(|(s, kind, _)| belongs(s, kind)) {
            if let Some((key, value)) = part.entry(name) {
                let weight = kind == "unwound_cable";
                let message = match weight {
                    true => {
                        "gravity belongs to the scene: write `weight = true` here, and `gravity = [0, 0, -9.81]` \
                             above its first section"
                    }
                    false => {
                        "gravity belongs to the scene: write `gravity = [0, 0, -9.81]` above its first section"
                    }
                };
                let edit = Edit::Gravity { key, value, weight };
                all.push(Found {
                    span: key.span,
                    path: path.clone(),
                    message: message.into(),
                    help: None,
                    edit,
                });
            }
        }
        if section == "constraints" && reach.is(part, "clamp") {
            clamp(&path, part, &parts, reach, &mut all);
        }
    }
    all
}

fn renamed<'a>(section: &str, path: &str, part: &'a Table, reach: &Reach<'a>, all: &mut Vec<Found<'a>>) {
    let mut name = |span, path: String, what: &str, old: &str, new: &'static str| {
        let message = format!("{what}`{old}` is called `{new}` since version {SINCE}");
        all.push(Found { span, path, message, help: None, edit: Edit::Rename(new) });
    };
    let belongs = |s: &str, kind: &str| s == section && reach.is(part, kind);
    let below = |inside: &str| if inside.is_empty() { path.to_string() } else { format!("{path}.{inside}") };
    for f in FIELDS.iter().filter(|f| belongs(f.section, f.kind)) {
        for (key, _) in reach.inside(part, f.inside).into_iter().filter_map(|table| table.entry(f.old)) {
            name(key.span, below(f.inside), "", f.old, f.new);
        }
    }
    for &(_, _, inside, old, new) in CHOICES.iter().filter(|(s, kind, ..)| belongs(s, kind)) {
        let (tables, last) = match inside.rsplit_once('.') {
            Some((before, last)) => (reach.inside(part, before), last),
            None => (vec![part], inside),
        };
        for value in tables.into_iter().filter_map(|t| t.get(last)).flat_map(|v| reach.of(v)) {
            let bare = value.as_str().filter(|text| *text == old).map(|_| value.span);
            let key = value.as_table().and_then(|t| t.entry(old)).map(|(key, _)| key.span);
            let tags = value.as_table().map(|t| reach.texts(t, "type")).unwrap_or_default();
            let tags = tags.into_iter().filter(|(text, _)| *text == old).map(|(_, span)| span);
            bare.into_iter().chain(key).chain(tags).for_each(|span| name(span, below(inside), "", old, new));
        }
    }
    for &(_, old, new) in TYPES.iter().filter(|(s, ..)| *s == section) {
        for (_, span) in reach.texts(part, "type").into_iter().filter(|(text, _)| *text == old) {
            name(span, format!("{path}.type"), "type ", old, new);
        }
    }
}

/// A clamp held the direction alone, beside a constraint that held the position: now it does both.
fn clamp<'a>(
    path: &str,
    part: &'a Table,
    parts: &[(usize, &'a Table)],
    reach: &Reach<'a>,
    all: &mut Vec<Found<'a>>,
) {
    let texts = |table: &'a Table, name: &str| -> Vec<&'a str> {
        reach.texts(table, name).into_iter().map(|(text, _)| text.trim()).collect()
    };
    let marker = texts(part, "marker");
    let here = |other: &[&str]| other.iter().any(|m| marker.contains(m));
    let body = |m: &str| m.split(['.', '@']).next().unwrap_or_default().to_string();
    let bodies: Vec<String> = texts(part, "to").iter().map(|to| body(to)).collect();
    let holder = parts.iter().find_map(|(_, other)| {
        let kind = *texts(other, "type").iter().find(|kind| HOLD_POSITION.contains(kind))?;
        // the other way round, if both go to the same body
        let swapped = here(&texts(other, "to"))
            && texts(other, "marker").iter().any(|m| bodies.iter().any(|to| *to == body(m)));
        (here(&texts(other, "marker")) || swapped).then_some(kind)
    });
    for (_, span) in reach.texts(part, "type").into_iter().filter(|(text, _)| *text == "clamp") {
        if let Some(kind) = holder {
            let message = format!(
                "a `clamp` holds the position as well since version {SINCE}, which a `{kind}` holds here already: what \
                 holds the direction alone is called `direction`"
            );
            let edit = Edit::Rename("direction");
            all.push(Found { span, path: format!("{path}.type"), message, help: None, edit });
        }
    }
}
