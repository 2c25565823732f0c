//! The file format of one frame: VTK's XML for unstructured grids with raw appended data.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Number type of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Float64,
    Int32,
    Int8,
    UInt8,
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Float64 => "Float64",
            Self::Int32 => "Int32",
            Self::Int8 => "Int8",
            Self::UInt8 => "UInt8",
        }
    }
}

/// An array of the file: little-endian bytes, `components` values per point or cell.
#[derive(Clone, Debug)]
pub(super) struct Array {
    name: &'static str,
    kind: Kind,
    components: &'static [&'static str],
    bytes: Vec<u8>,
}

impl Array {
    /// Of real numbers; `components` names the columns, empty for a scalar.
    pub(super) fn real(
        name: &'static str,
        components: &'static [&'static str],
        values: impl Iterator<Item = f64>,
    ) -> Self {
        let bytes = values.flat_map(f64::to_le_bytes).collect();
        Self { name, kind: Kind::Float64, components, bytes }
    }

    /// Of whole numbers.
    pub(super) fn whole(name: &'static str, values: impl Iterator<Item = u32>) -> Self {
        Self { name, kind: Kind::Int32, components: &[], bytes: values.flat_map(u32::to_le_bytes).collect() }
    }

    /// Of small signed numbers.
    pub(super) fn small(name: &'static str, values: impl Iterator<Item = i8>) -> Self {
        Self { name, kind: Kind::Int8, components: &[], bytes: values.flat_map(i8::to_le_bytes).collect() }
    }

    /// Of bytes.
    pub(super) fn byte(name: &'static str, values: impl Iterator<Item = u8>) -> Self {
        Self { name, kind: Kind::UInt8, components: &[], bytes: values.collect() }
    }
}

/// Arrays of a file, by the element of the format that they belong to.
pub(super) struct Grid<'a> {
    pub points: usize,
    pub cells: usize,
    pub point_data: Vec<&'a Array>,
    pub cell_data: Vec<&'a Array>,
    pub coordinates: &'a Array,
    /// Connectivity, offsets, types.
    pub topology: [&'a Array; 3],
}

impl Grid<'_> {
    /// Writes the file.
    pub(super) fn write(&self, path: &Path) -> io::Result<()> {
        let mut head = String::from(concat!(
            "<?xml version=\"1.0\"?>\n",
            "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n",
            "<UnstructuredGrid>\n",
        ));
        // Writing to a string does not fail.
        let _ = writeln!(head, "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">", self.points, self.cells);
        let mut arrays: Vec<&Array> = Vec::new();
        let mut offset = 0;
        let sections: [(&str, &[&Array]); 4] = [
            ("PointData", &self.point_data),
            ("CellData", &self.cell_data),
            ("Points", &[self.coordinates]),
            ("Cells", &self.topology),
        ];
        for (section, members) in sections {
            let _ = writeln!(head, "<{section}>");
            for array in members {
                declare(&mut head, array, offset);
                offset += size_of::<u64>() + array.bytes.len();
                arrays.push(array);
            }
            let _ = writeln!(head, "</{section}>");
        }
        head.push_str("</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
        let mut file = BufWriter::new(File::create(path)?);
        file.write_all(head.as_bytes())?;
        for array in arrays {
            file.write_all(&(array.bytes.len() as u64).to_le_bytes())?;
            file.write_all(&array.bytes)?;
        }
        file.write_all(b"\n</AppendedData>\n</VTKFile>\n")?;
        file.flush()
    }
}

fn declare(head: &mut String, array: &Array, offset: usize) {
    let _ = write!(head, "<DataArray type=\"{}\" Name=\"{}\"", array.kind.name(), array.name);
    if !array.components.is_empty() {
        let _ = write!(head, " NumberOfComponents=\"{}\"", array.components.len());
        for (i, name) in array.components.iter().enumerate().filter(|(_, name)| !name.is_empty()) {
            let _ = write!(head, " ComponentName{i}=\"{name}\"");
        }
    }
    let _ = writeln!(head, " format=\"appended\" offset=\"{offset}\"/>");
}
