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

#[cfg(test)]
mod tests {
    use super::*;

    /// Attribute of the n-th `DataArray`.
    fn attribute<'a>(line: &'a str, name: &str) -> &'a str {
        let start = line.find(&format!(" {name}=\"")).unwrap_or_else(|| panic!("no {name} in {line}")) + name.len() + 3;
        line[start..].split('"').next().unwrap()
    }

    #[test]
    fn offsets_and_lengths_find_every_array() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("one.vtu");
        let coordinates = Array::real("Points", &["", "", ""], (0..24).map(f64::from));
        let connectivity = Array::whole("connectivity", 0..8);
        let offsets = Array::whole("offsets", std::iter::once(8));
        let types = Array::byte("types", std::iter::once(12));
        let status = Array::small("CSTATUS", [-1, 0, 1, -1, -1, -1, -1, -1].into_iter());
        let grid = Grid {
            points: 8,
            cells: 1,
            point_data: vec![&status],
            cell_data: vec![],
            coordinates: &coordinates,
            topology: [&connectivity, &offsets, &types],
        };
        grid.write(&path).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let marker = b"<AppendedData encoding=\"raw\">\n_";
        let data = bytes.windows(marker.len()).position(|w| w == marker).unwrap() + marker.len();
        let head = std::str::from_utf8(&bytes[..data]).unwrap();
        assert!(head.contains("NumberOfPoints=\"8\" NumberOfCells=\"1\""));
        let expected = [
            ("CSTATUS", &status),
            ("Points", &coordinates),
            ("connectivity", &connectivity),
            ("offsets", &offsets),
            ("types", &types),
        ];
        let declared: Vec<&str> = head.lines().filter(|l| l.starts_with("<DataArray")).collect();
        assert_eq!(declared.len(), expected.len());
        for (line, (name, array)) in declared.iter().zip(expected) {
            assert_eq!(attribute(line, "Name"), name);
            let at = data + attribute(line, "offset").parse::<usize>().unwrap();
            let length = u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
            assert_eq!(&bytes[at + 8..at + 8 + length], &array.bytes[..], "{name}");
        }
        assert_eq!(attribute(declared[1], "NumberOfComponents"), "3");
        assert!(bytes.ends_with(b"\n</AppendedData>\n</VTKFile>\n"));
    }
}
