//! Members of sets and surfaces: fields to compact arrays.

use super::card::{Faces, Members};
use super::lex::{self, fields, looks_numeric};
use super::report::{At, excerpt};

/// Remedy for a line of an element-based surface.
pub const FACE_REMEDY: &str = "write: element or element set, S1 to S6";

impl Members {
    /// Takes a label or the name of a set; the error says what is wrong with it.
    pub fn add(&mut self, field: &[u8], at: At) -> Result<(), String> {
        if looks_numeric(field) {
            let label = lex::label(field).map_err(|fault| format!("{} {}", excerpt(field), fault.text()))?;
            self.labels.push((label, at));
        } else {
            self.names.push((name(field)?.into(), at));
        }
        Ok(())
    }

    /// Takes a line `first, last, increment`; the error says what is wrong with it.
    pub fn add_range(&mut self, line: &[u8], at: At) -> Result<(), String> {
        let mut numbers = [0, 0, 1];
        let mut row = fields(line);
        for (i, number) in numbers.iter_mut().enumerate() {
            match row.next() {
                Some(field) if i < 2 || !field.is_empty() => {
                    *number = lex::label(field).map_err(|fault| format!("{} {}", excerpt(field), fault.text()))?;
                }
                None if i < 2 => return Err("the range has no end".into()),
                _ => {}
            }
        }
        if let Some(extra) = row.find(|field| !field.is_empty()) {
            return Err(format!("item 4 of a range is not read: {}", excerpt(extra)));
        }
        if numbers[1] < numbers[0] {
            return Err(format!("the range ends before it begins: {} to {}", numbers[0], numbers[1]));
        }
        self.ranges.push((numbers, at));
        Ok(())
    }
}

/// Face of a facet on the side of its normal, in place of a number.
pub const SPOS: u8 = 7;
/// Face of a facet on the other side.
pub const SNEG: u8 = 8;

impl Faces {
    /// Takes an element or element set and its face; the error says what is wrong, and the remedy.
    pub fn add(&mut self, region: &[u8], face: &[u8], at: At) -> Result<(), (String, &'static str)> {
        let face = match face {
            b"" => 0,
            [b'S' | b's', digit @ b'1'..=b'6'] => digit - b'0',
            // Sides of a facet.
            _ if face.eq_ignore_ascii_case(b"SPOS") => SPOS,
            _ if face.eq_ignore_ascii_case(b"SNEG") => SNEG,
            _ => return Err((format!("no element has a face {}", excerpt(face)), FACE_REMEDY)),
        };
        if looks_numeric(region) {
            let label =
                lex::label(region).map_err(|fault| (format!("{} {}", excerpt(region), fault.text()), FACE_REMEDY))?;
            self.labels.push((label, face, at));
        } else {
            let name = name(region).map_err(|message| (message, FACE_REMEDY))?;
            self.names.push((name.into(), face, at));
        }
        Ok(())
    }
}

fn name(field: &[u8]) -> Result<&str, String> {
    match std::str::from_utf8(field).map(lex::unquoted) {
        Ok("") => Err("a name is missing".into()),
        Ok(name) => Ok(name),
        Err(_) => Err(format!("{} is not UTF-8 text", excerpt(field))),
    }
}
