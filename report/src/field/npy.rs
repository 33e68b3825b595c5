//! A field record as two files that NumPy reads: structured arrays with a row for each snapshot and point of a line, or
//! body.
//!
//! ```text
//! field = np.load("field.npy")      part t s x y z vx vy vz, then the lines' quantities: speed, tension, …
//! bodies = np.load("bodies.npy")    part t x y z qw qx qy qz
//! ```
//!
//! Format: [NEP 1](https://numpy.org/neps/nep-0001-npy-format.html), version 1.0 (2.0 where a header is long).

use std::fs;
use std::path::Path;

use super::{BodyRecord, FieldRecord, LineRecord, LineSnapshot, Pose, Quantity};
use crate::{OutputError, write_atomic_bytes};

const MAGIC: &[u8; 6] = b"\x93NUMPY";
/// What both files begin a row with, and what lines and bodies have besides.
const POINT: [&str; 8] = ["t", "s", "x", "y", "z", "vx", "vy", "vz"];
const BODY: [&str; 8] = ["t", "x", "y", "z", "qw", "qx", "qy", "qz"];

/// Rows of a name and some numbers.
pub(super) struct Rows {
    /// What the name is the name of.
    first: &'static str,
    /// Longest name, in characters.
    wide: usize,
    fields: Vec<String>,
    bytes: Vec<u8>,
    count: usize,
}

impl Rows {
    pub fn new<'a>(
        first: &'static str,
        names: impl Iterator<Item = &'a str>,
        fields: impl Iterator<Item = String>,
    ) -> Self {
        let wide = names.map(|name| name.chars().count()).max().unwrap_or(0).max(1);
        Rows { first, wide, fields: fields.collect(), bytes: Vec::new(), count: 0 }
    }

    pub fn push(&mut self, name: &[u8], numbers: impl IntoIterator<Item = f64>) {
        self.bytes.extend(name);
        self.bytes.extend(numbers.into_iter().flat_map(f64::to_le_bytes));
        self.count += 1;
    }

    /// A name as NumPy keeps it: characters of four bytes, filled up with zeros.
    pub fn name(&self, name: &str) -> Vec<u8> {
        let mut bytes: Vec<u8> = name.chars().flat_map(|c| u32::from(c).to_le_bytes()).collect();
        bytes.resize(4 * self.wide, 0);
        bytes
    }

    pub fn write(self, path: &Path) -> Result<(), OutputError> {
        let fields: String =
            self.fields.iter().map(|name| format!(", ('{}', '<f8')", quoted(name))).collect();
        let text = format!(
            "{{'descr': [('{}', '<U{}'){fields}], 'fortran_order': False, 'shape': ({},), }}",
            self.first, self.wide, self.count
        );
        // the numbers begin at a multiple of 64 bytes
        let short = text.len() + 11 + 64 <= usize::from(u16::MAX);
        let before = if short { 10 } else { 12 };
        let whole = (before + text.len() + 1).next_multiple_of(64);
        let length = whole - before;
        let mut bytes = Vec::with_capacity(whole + self.bytes.len());
        bytes.extend(MAGIC);
        if short {
            bytes.extend([1, 0]);
            bytes.extend((length as u16).to_le_bytes());
        } else {
            bytes.extend([2, 0]);
            bytes.extend((length as u32).to_le_bytes());
        }
        bytes.extend(text.as_bytes());
        bytes.resize(whole - 1, b' ');
        bytes.push(b'\n');
        bytes.extend(&self.bytes);
        write_atomic_bytes(path, &bytes)
    }
}

/// Text between the quotes of a Python literal.
fn quoted(text: &str) -> String {
    text.replace('\\', "\\\\").replace('\'', "\\'")
}

/// The name of a quantity as that of a field.
fn field_name(quantity: &str) -> String {
    quantity.replace(' ', "_")
}

impl FieldRecord {
    /// Writes the lines, and the bodies if there are any: `field.npy` and `bodies.npy`, all or nothing.
    ///
    /// ```
    /// # use ropewalk_report::{FieldRecord, LineRecord, LineSnapshot, OutputError};
    /// let mut hose = LineRecord::new("hose", "cable", 0.05);
    /// hose.snapshots.push(LineSnapshot { s: vec![0.0], position: vec![[1.0, 2.0, 3.0]], ..LineSnapshot::default() });
    /// let field = FieldRecord { times: vec![0.5], lines: vec![hose], ..FieldRecord::default() };
    /// # let folder = tempfile::tempdir().unwrap();
    /// let [lines, bodies] = ["field.npy", "bodies.npy"].map(|name| folder.path().join(name));
    /// field.write_npy(&lines, &bodies)?;
    /// let back = FieldRecord::read_npy(&lines, &bodies)?;
    /// assert_eq!(back.lines[0].snapshots[0].position, [[1.0, 2.0, 3.0]]);
    /// # Ok::<(), OutputError>(())
    /// ```
    ///
    /// # Errors
    /// [`OutputError::Field`] for a record with a hole, [`OutputError::Io`] for what can't be written.
    pub fn write_npy(&self, lines: &Path, bodies: &Path) -> Result<(), OutputError> {
        self.check()?;
        let mut names: Vec<String> = Vec::new();
        for quantity in self.lines.iter().flat_map(|line| &line.quantities) {
            let name = field_name(&quantity.name);
            if !names.contains(&name) {
                names.push(name);
            }
        }
        let fields = POINT.iter().map(ToString::to_string).chain(names.iter().cloned());
        let mut rows = Rows::new("part", self.lines.iter().map(|l| l.name.as_str()), fields);
        for (k, t) in self.times.iter().enumerate() {
            for line in &self.lines {
                let (name, at) = (rows.name(&line.name), &line.snapshots[k]);
                let own: Vec<Option<&Vec<f64>>> = names
                    .iter()
                    .map(|name| line.quantities.iter().position(|q| field_name(&q.name) == *name))
                    .map(|own| own.map(|i| &at.values[i]))
                    .collect();
                for (i, (s, x)) in at.s.iter().zip(&at.position).enumerate() {
                    let v = at.velocity.get(i).copied().unwrap_or([f64::NAN; 3]);
                    let values = own.iter().map(|values| values.map_or(f64::NAN, |v| v[i]));
                    rows.push(&name, [*t, *s].into_iter().chain(*x).chain(v).chain(values));
                }
            }
        }
        rows.write(lines)?;
        if self.bodies.is_empty() {
            return Ok(());
        }
        let fields = BODY.iter().map(ToString::to_string);
        let mut rows = Rows::new("part", self.bodies.iter().map(|b| b.name.as_str()), fields);
        for (k, t) in self.times.iter().enumerate() {
            for body in &self.bodies {
                let pose = &body.poses[k];
                let name = rows.name(&body.name);
                rows.push(&name, [*t].into_iter().chain(pose.position).chain(pose.orientation));
            }
        }
        rows.write(bodies)
    }

    /// Reads back what [`write_npy`](Self::write_npy) wrote: names and numbers of lines and bodies. Units, diameters and
    /// shapes aren't in the files. Either file may be missing; then there are no lines, or no bodies.
    ///
    /// # Errors
    /// [`OutputError::Npy`] for a file that isn't such a one, [`OutputError::Io`] for one that can't be read.
    pub fn read_npy(lines: &Path, bodies: &Path) -> Result<Self, OutputError> {
        let lines = if lines.exists() { Read::file(lines, &POINT)? } else { Read::default() };
        let bodies = if bodies.exists() { Read::file(bodies, &BODY)? } else { Read::default() };
        let mut times: Vec<f64> = Vec::new();
        for t in lines.rows.iter().chain(&bodies.rows).map(|(_, row)| row[0]) {
            if times.last() != Some(&t) {
                times.push(t);
            }
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        let place = |t: f64| times.partition_point(|x| x.total_cmp(&t).is_lt());
        let mut field = FieldRecord { times: times.clone(), ..FieldRecord::default() };
        let quantities: Vec<Quantity> = lines
            .fields
            .iter()
            .skip(POINT.len())
            .map(|name| Quantity::new(name.replace('_', " "), ""))
            .collect();
        for (name, row) in &lines.rows {
            let line = match field.lines.iter().position(|line| line.name == *name) {
                Some(k) => &mut field.lines[k],
                None => {
                    let values = vec![Vec::new(); quantities.len()];
                    let empty = LineSnapshot { values, ..LineSnapshot::default() };
                    let snapshots = vec![empty; times.len()];
                    let quantities = quantities.clone();
                    field.lines.push(LineRecord {
                        quantities,
                        snapshots,
                        ..LineRecord::new(name, "line", 0.0)
                    });
                    field.lines.last_mut().unwrap_or_else(|| unreachable!("it was just added"))
                }
            };
            let at = &mut line.snapshots[place(row[0])];
            at.s.push(row[1]);
            at.position.push([row[2], row[3], row[4]]);
            at.velocity.push([row[5], row[6], row[7]]);
            at.values.iter_mut().zip(&row[8..]).for_each(|(values, x)| values.push(*x));
        }
        for (name, row) in &bodies.rows {
            let body = match field.bodies.iter().position(|body| body.name == *name) {
                Some(k) => &mut field.bodies[k],
                None => {
                    let nowhere = Pose { position: [f64::NAN; 3], ..Pose::default() };
                    let poses = vec![nowhere; times.len()];
                    field.bodies.push(BodyRecord { poses, ..BodyRecord::new(name, "body") });
                    field.bodies.last_mut().unwrap_or_else(|| unreachable!("it was just added"))
                }
            };
            let (position, orientation) = ([row[1], row[2], row[3]], [row[4], row[5], row[6], row[7]]);
            body.poses[place(row[0])] = Pose { position, orientation };
        }
        Ok(field)
    }
}

/// What is in a file.
#[derive(Default)]
pub(super) struct Read {
    fields: Vec<String>,
    pub rows: Vec<(String, Vec<f64>)>,
}

impl Read {
    pub fn file(path: &Path, known: &[&str]) -> Result<Self, OutputError> {
        let bytes = fs::read(path).map_err(OutputError::io("read", path))?;
        let fail = |message: &str| OutputError::Npy { path: path.into(), message: message.into() };
        let read = Self::bytes(&bytes).map_err(fail)?;
        if !read.fields.iter().map(String::as_str).take(known.len()).eq(known.iter().copied()) {
            return Err(fail("its fields are others than those of a field record"));
        }
        Ok(read)
    }

    fn bytes(bytes: &[u8]) -> Result<Self, &'static str> {
        let rest = bytes.strip_prefix(MAGIC).ok_or("it doesn't begin as a .npy file does")?;
        let (length, rest) = match rest {
            [1, 0, a, b, rest @ ..] => (usize::from(u16::from_le_bytes([*a, *b])), rest),
            [2, 0, a, b, c, d, rest @ ..] => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, rest),
            _ => return Err("it is of an unknown version of the format"),
        };
        let (head, data) = rest.split_at_checked(length).ok_or("it is cut off")?;
        let head = std::str::from_utf8(head).map_err(|_| "its header is no text")?;
        // ('part', '<U5'), ('t', '<f8'), …: pairs of quoted texts
        let list =
            head.split_once('[').and_then(|(_, rest)| rest.split_once(']')).ok_or("it has no fields")?.0;
        let texts: Vec<String> = quotes(list);
        let (pairs, _) = texts.as_chunks::<2>();
        let Some(([_, wide], numbers)) = pairs.split_first() else { return Err("it has no fields") };
        let wide: usize =
            wide.strip_prefix("<U").and_then(|n| n.parse().ok()).ok_or("its first field is no name")?;
        if numbers.iter().any(|[_, kind]| kind != "<f8") {
            return Err("it has fields that are no double-precision numbers");
        }
        // a file that was tampered with may name any width
        let size = wide.checked_mul(4).and_then(|name| name.checked_add(8 * numbers.len()));
        let size = size.filter(|size| *size > 0).ok_or("its rows have no width that can be")?;
        if data.len() % size != 0 {
            return Err("it is cut off");
        }
        let row = |row: &[u8]| {
            let (name, numbers) = row.split_at(4 * wide);
            let (characters, _) = name.as_chunks::<4>();
            let name = characters.iter().filter_map(|c| char::from_u32(u32::from_le_bytes(*c)));
            let (numbers, _) = numbers.as_chunks::<8>();
            (
                name.take_while(|c| *c != '\0').collect(),
                numbers.iter().map(|b| f64::from_le_bytes(*b)).collect(),
            )
        };
        let fields = numbers.iter().map(|[name, _]| name.clone()).collect();
        Ok(Read { fields, rows: data.chunks_exact(size).map(row).collect() })
    }
}

/// The texts between single quotes.
fn quotes(text: &str) -> Vec<String> {
    let (mut all, mut chars) = (Vec::new(), text.chars());
    while chars.any(|c| c == '\'') {
        let mut one = String::new();
        while let Some(c) = chars.next() {
            match c {
                '\'' => break,
                '\\' => one.extend(chars.next()),
                c => one.push(c),
            }
        }
        all.push(one);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field() -> FieldRecord {
        let snapshot = |points: usize, t: f64| LineSnapshot {
            s: (0..points).map(|k| k as f64).collect(),
            position: (0..points).map(|k| [k as f64, t, 1.0 / 3.0]).collect(),
            velocity: vec![[0.0, -1e-300, t]; points],
            values: vec![vec![t; points]],
        };
        let line = |name: &str, quantity: &str, points: [usize; 2]| LineRecord {
            quantities: vec![Quantity::new(quantity, "")],
            snapshots: vec![snapshot(points[0], 0.0), snapshot(points[1], 0.25)],
            ..LineRecord::new(name, "line", 0.0)
        };
        let body =
            BodyRecord { poses: vec![Pose::at([1.0, 2.0, 3.0]); 2], ..BodyRecord::new("Schiff", "body") };
        FieldRecord {
            times: vec![0.0, 0.25],
            // one isn't there at first
            lines: vec![
                line("hose's \\ märe", "bending moment", [2, 3]),
                line("b", "bending moment", [0, 1]),
            ],
            bodies: vec![body],
            ..FieldRecord::default()
        }
    }

    #[test]
    fn what_is_written_reads_back() {
        let folder = tempfile::tempdir().unwrap();
        let [lines, bodies] = ["field.npy", "bodies.npy"].map(|name| folder.path().join(name));
        field().write_npy(&lines, &bodies).unwrap();
        assert_eq!(FieldRecord::read_npy(&lines, &bodies).unwrap(), field());
        let bytes = fs::read(&lines).unwrap();
        let head = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
        assert_eq!((10 + head) % 64, 0);
        let text = std::str::from_utf8(&bytes[10..10 + head]).unwrap();
        assert!(text.starts_with("{'descr': [('part', '<U13'), ('t', '<f8'), ('s', '<f8'), "), "{text}");
        assert!(
            text.trim_end().ends_with("('bending_moment', '<f8')], 'fortran_order': False, 'shape': (6,), }")
        );
        assert_eq!(bytes.len(), 10 + head + 6 * (4 * 13 + 8 * 9));
    }

    #[test]
    fn what_is_no_field_record_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("field.npy");
        let none = folder.path().join("none");
        assert_eq!(FieldRecord::read_npy(&none, &none).unwrap(), FieldRecord::default());
        field().write_npy(&path, &none).unwrap();
        let whole = fs::read(&path).unwrap();
        let headed = |fields: &str| {
            let length = u8::try_from(fields.len()).unwrap();
            [MAGIC, &[1, 0, length, 0][..], fields.as_bytes()].concat()
        };
        let (no_width, too_wide) =
            (headed("[('part', '<U0')]"), headed("[('part', '<U18446744073709551615')]"));
        for (bytes, words) in [
            (&b"t,x\n0,1\n"[..], "doesn't begin"),
            (&no_width, "no width"),
            (&too_wide, "no width"),
            (&whole[..40], "cut off"),
            (&whole[..whole.len() - 3], "cut off"),
        ] {
            fs::write(&path, bytes).unwrap();
            let message = FieldRecord::read_npy(&path, &none).unwrap_err().to_string();
            assert!(message.contains(words) && message.contains("field.npy"), "{message}");
        }
    }
}
