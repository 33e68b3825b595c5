//! One `.vtp` file: points, lines and triangles with numbers.

use std::fmt::Write as _;

/// A name with as many numbers for each point as it is wide.
pub(super) struct Values {
    pub name: String,
    pub width: usize,
    pub values: Vec<f64>,
}

/// Cells of one kind.
#[derive(Default)]
struct Cells {
    /// The points of all cells, one cell after the other.
    connectivity: Vec<i64>,
    /// Where each cell ends among them.
    offsets: Vec<i64>,
    /// Number of the part that each is of.
    part: Vec<i32>,
}

impl Cells {
    fn add(&mut self, points: impl IntoIterator<Item = usize>, part: i32) {
        self.connectivity.extend(points.into_iter().map(|k| k as i64));
        self.offsets.push(self.connectivity.len() as i64);
        self.part.push(part);
    }
}

/// Points and the cells over them.
#[derive(Default)]
pub(super) struct Poly {
    points: Vec<[f64; 3]>,
    verts: Cells,
    lines: Cells,
    polys: Cells,
    /// Names of the parts by number; a comment of the file, since VTK has no names of cells.
    parts: Vec<(i32, String)>,
    point_data: Vec<Values>,
}

impl Poly {
    /// A line through points.
    pub fn add_line(&mut self, points: &[[f64; 3]], name: &str, part: i32) {
        let first = self.points.len();
        self.points.extend(points);
        self.lines.add(first..self.points.len(), part);
        self.name(name, part);
    }

    /// A point by itself.
    pub fn add_point(&mut self, point: [f64; 3], name: &str, part: i32) {
        self.verts.add([self.points.len()], part);
        self.points.push(point);
        self.name(name, part);
    }

    /// A surface.
    pub fn add_triangles(&mut self, points: &[[f64; 3]], triangles: &[[u32; 3]], name: &str, part: i32) {
        let first = self.points.len();
        self.points.extend(points);
        for triangle in triangles {
            self.polys.add(triangle.map(|k| first + k as usize), part);
        }
        self.name(name, part);
    }

    /// Adds numbers of the points of lines, which come first; other points have none.
    pub fn add_values(&mut self, name: String, width: usize, mut of_lines: Vec<f64>) {
        of_lines.resize(width * self.points.len(), f64::NAN);
        self.point_data.push(Values { name, width, values: of_lines });
    }

    /// Adds vectors of the points with these numbers; those of others are zero, so that they have no arrow.
    pub fn add_vectors(&mut self, name: String, vectors: &[(usize, [f64; 3])]) {
        let mut values = vec![0.0; 3 * self.points.len()];
        for (k, v) in vectors {
            values[3 * k..3 * k + 3].copy_from_slice(v);
        }
        self.point_data.push(Values { name, width: 3, values });
    }

    /// How many points there are.
    pub fn points(&self) -> usize {
        self.points.len()
    }

    fn name(&mut self, name: &str, part: i32) {
        if !self.parts.iter().any(|(known, _)| *known == part) {
            self.parts.push((part, name.to_string()));
        }
    }

    /// The file.
    pub fn bytes(&self) -> Vec<u8> {
        let mut file = Appended::default();
        let (points, verts, lines, polys) = (&self.points, &self.verts, &self.lines, &self.polys);
        file.head += "<?xml version=\"1.0\"?>\n";
        for (part, name) in &self.parts {
            // two hyphens would end the comment
            let _ = writeln!(file.head, "<!-- part {part}: {} -->", name.replace('-', "‐"));
        }
        let _ = write!(
            file.head,
            "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n\
             <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n<Points>\n",
            points.len(),
            verts.offsets.len(),
            lines.offsets.len(),
            polys.offsets.len()
        );
        file.array("Points", "Float64", 3, points.iter().flatten().map(|x| x.to_le_bytes()));
        file.head += "</Points>\n";
        for (tag, cells) in [("Verts", verts), ("Lines", lines), ("Polys", polys)] {
            let _ = writeln!(file.head, "<{tag}>");
            file.array("connectivity", "Int64", 1, cells.connectivity.iter().map(|k| k.to_le_bytes()));
            file.array("offsets", "Int64", 1, cells.offsets.iter().map(|k| k.to_le_bytes()));
            let _ = writeln!(file.head, "</{tag}>");
        }
        file.head += "<PointData>\n";
        for Values { name, width, values } in &self.point_data {
            file.array(name, "Float64", *width, values.iter().map(|x| x.to_le_bytes()));
        }
        file.head += "</PointData>\n<CellData>\n";
        // VTK counts cells in this order
        let part = [verts, lines, polys].into_iter().flat_map(|cells| &cells.part);
        file.array("part", "Int32", 1, part.map(|k| k.to_le_bytes()));
        file.head += "</CellData>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
        let mut bytes = file.head.into_bytes();
        bytes.extend(file.raw);
        bytes.extend(b"\n</AppendedData>\n</VTKFile>\n");
        bytes
    }
}

/// A text that names arrays, and the bytes that follow it.
#[derive(Default)]
struct Appended {
    head: String,
    raw: Vec<u8>,
}

impl Appended {
    fn array<const N: usize>(
        &mut self,
        name: &str,
        kind: &str,
        width: usize,
        values: impl Iterator<Item = [u8; N]>,
    ) {
        let (name, offset) = (super::escaped(name), self.raw.len());
        let _ = writeln!(
            self.head,
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{width}\" format=\"appended\" offset=\"{offset}\"/>"
        );
        // the length stands before the bytes
        self.raw.extend([0; 8]);
        self.raw.extend(values.flatten());
        let length = (self.raw.len() - offset - 8) as u64;
        self.raw[offset..offset + 8].copy_from_slice(&length.to_le_bytes());
    }
}
